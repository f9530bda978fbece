"""The most likely settings for the rows of many tracks, and their uncertainty.

With C the covariance of a track's rows and X the derivatives by its unknowns, the likelihood of the rows with the
unknowns projected out (that is, of the innovations of a filter that starts without knowledge of them) is, up to a
constant,

    -2 log L = log|C| + log|X' C^-1 X| + r' P r        P = C^-1 - C^-1 X (X' C^-1 X)^-1 X' C^-1

With the logarithms x of the settings as parameters, and C_i the derivative of C,

    slope_i = (r' P C_i P r - tr(P C_i)) / 2        information_ij = tr(P C_i P C_j) / 2

A step is information^-1 slope (Fisher scoring), with a weak prior about the start, which fixes the settings that no row
determines. The inverse of the information is the covariance of x, so a sigma of x is a relative sigma of the
setting."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from .rows import Rows

PRIOR_SD = 1.0  # of a logarithm: a factor of 2.7
SMALL_START = 0.01  # start of a setting with the value 0
STEPS = 12
SETTLED = 1e-2  # step of a logarithm
LARGEST_STEP = 0.4
SMALLEST, LARGEST = -4.0, 4.0  # limits of a logarithm, from the start
GATE = 5.0  # sigmas: a row farther off, given all others, is left out
KNOWN_SHARE = 0.3  # largest relative sigma of a setting that the rows determine
NUGGET = 1e-12  # of the mean variance, for the solver


@dataclass
class Fitted:
    """Names of the settings that the rows determine, all values, and the relative sigmas."""

    names: tuple[str, ...]
    values: dict[str, float]
    share: dict[str, float]
    rows: int
    left_out: int


def projected(rows: Rows, values: dict[str, float]) -> np.ndarray:
    """(n, n): P of the formula above."""
    covariance = rows.covariance(values)
    covariance[np.diag_indices_from(covariance)] += NUGGET * float(np.mean(np.diag(covariance)))
    inverse = np.linalg.inv(covariance)
    if rows.unknown.shape[1] == 0:
        return inverse
    scale = np.maximum(np.linalg.norm(rows.unknown, axis=0), 1e-300)
    by = inverse @ (rows.unknown / scale)
    inner = (rows.unknown / scale).T @ by
    return inverse - by @ np.linalg.pinv(inner, rcond=1e-10, hermitian=True) @ by.T


def score(rows: Rows, values: dict[str, float], names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """Slope (m,) and information (m, m) of one track's log likelihood, with respect to the logarithms of the
    settings."""
    p = projected(rows, values)
    left = p @ rows.residual
    present = [i for i, name in enumerate(names) if name in rows.settings()]
    gradient, information = np.zeros(len(names)), np.zeros((len(names), len(names)))
    products = {i: rows.slope_after(p, values, names[i]) for i in present}
    for i, product in products.items():
        gradient[i] = 0.5 * (rows.residual @ (product @ left) - np.trace(product))
        for j in (j for j in present if j <= i):
            information[i, j] = information[j, i] = 0.5 * float(np.sum(product * products[j].T))
    return gradient, information


def without_outliers(rows: Rows, values: dict[str, float]) -> Rows:
    """Drops the rows that disagree with all others."""
    p = projected(rows, values)
    off = (p @ rows.residual) ** 2 / np.maximum(np.diag(p), 1e-300)
    return rows.only(off <= GATE**2)


def _summed(tracks: Sequence[Rows], values: dict[str, float], names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    parts = [score(rows, values, names) for rows in tracks]
    return sum((g for g, _ in parts), np.zeros(len(names))), sum(
        (f for _, f in parts), np.zeros((len(names), len(names)))
    )


def _climb(
    tracks: Sequence[Rows],
    given: dict[str, float],
    start: dict[str, float],
    names: Sequence[str],
    report: Callable[[], None],
) -> tuple[dict[str, float], np.ndarray]:
    """Values, and covariance (m, m) of their logarithms. ``given`` is the center of the prior."""
    center = np.log([given[name] for name in names])
    x, values = np.log([start[name] for name in names]), dict(start)
    prior = np.eye(len(names)) / PRIOR_SD**2
    information = np.zeros_like(prior)
    for _ in range(STEPS):
        gradient, information = _summed(tracks, values, names)
        step = np.linalg.solve(information + prior, gradient - prior @ (x - center))
        step = np.clip(step, -LARGEST_STEP, LARGEST_STEP)
        x = np.clip(x + step, center + SMALLEST, center + LARGEST)
        values = {**start, **{name: float(value) for name, value in zip(names, np.exp(x))}}
        report()
        if np.abs(step).max(initial=0.0) < SETTLED:
            break
    return values, np.linalg.inv(information + prior)


def fit(
    tracks: Sequence[Rows], given: dict[str, float], names: Sequence[str], more: Sequence[str] = (),
    report: Callable[[], None] = lambda: None,
) -> Fitted:  # fmt: skip
    """``given``: all settings of the rows. ``names``: those fitted first; ``more``: those fitted together with them
    afterwards. A setting that the rows do not determine to ``KNOWN_SHARE`` keeps its given value and is not in the
    result."""
    start = {name: value if value > 0.0 else SMALL_START for name, value in given.items()}
    values, covariance = _climb(tracks, start, {**given, **_of(start, names)}, tuple(names), report)
    kept = [without_outliers(rows, values) for rows in tracks]
    wanted = (*names, *more)
    values = {**values, **_of(start, more)}
    while wanted:
        values, covariance = _climb(kept, start, values, wanted, report)
        sd = np.sqrt(np.diag(covariance))
        determined = tuple(name for name, one in zip(wanted, sd) if one <= KNOWN_SHARE)
        if determined == wanted:
            break
        values = {**values, **{name: given[name] for name in wanted if name not in determined}}
        wanted = determined
    share = dict(zip(wanted, np.sqrt(np.diag(covariance)).tolist())) if wanted else {}
    count, rows = sum(len(r.residual) for r in tracks), sum(len(r.residual) for r in kept)
    return Fitted(wanted, values, share, rows, count - rows)


def _of(values: dict[str, float], names: Sequence[str]) -> dict[str, float]:
    return {name: values[name] for name in names}
