"""The settings that make the rows of many tracks most likely, and how well they are known.

With C the covariance of a track's rows and X what is unknown there, the likelihood of what X leaves (that of the
innovations of a filter which begins without knowing anything of X) is, but for a constant,

    -2 log L = log|C| + log|X' C^-1 X| + r' P r        P = C^-1 - C^-1 X (X' C^-1 X)^-1 X' C^-1

By the logarithms x of the settings, with C_i the derivative of C,

    slope_i = (r' P C_i P r - tr(P C_i)) / 2        information_ij = tr(P C_i P C_j) / 2

Steps are information^-1 slope (Fisher's scoring), with a weak prior about the start, which keeps what no row tells
where it was. The information's inverse is the covariance of x: one sigma of a setting is that share of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from .rows import Rows

PRIOR_SD = 1.0  # of a logarithm: a factor of 2.7
SMALL_START = 0.01  # of a setting that is given as 0
STEPS = 12
SETTLED = 1e-2  # of a step, logarithm
LARGEST_STEP = 0.4
SMALLEST, LARGEST = -4.0, 4.0  # of a logarithm, from the start: what goes to zero ends there
GATE = 5.0  # sigmas: a row that is farther off given all others is left out
KNOWN_SHARE = 0.3  # one sigma over the setting, above which the rows do not tell it
NUGGET = 1e-12  # of the mean variance, for the solver


@dataclass
class Fitted:
    """The settings that the rows tell, all values, and one sigma as a share of the value."""

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
    """Slope (m,) and information (m, m) of one track's log likelihood by the logarithms of the settings."""
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
    """Without the rows that all others do not expect."""
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
    tell: Callable[[], None],
) -> tuple[dict[str, float], np.ndarray]:
    """Values, and covariance (m, m) of their logarithms. The prior is about ``given``."""
    centre = np.log([given[name] for name in names])
    x, values = np.log([start[name] for name in names]), dict(start)
    prior = np.eye(len(names)) / PRIOR_SD**2
    told = np.zeros_like(prior)
    for _ in range(STEPS):
        gradient, told = _summed(tracks, values, names)
        step = np.linalg.solve(told + prior, gradient - prior @ (x - centre))
        step = np.clip(step, -LARGEST_STEP, LARGEST_STEP)
        x = np.clip(x + step, centre + SMALLEST, centre + LARGEST)
        values = {**start, **{name: float(value) for name, value in zip(names, np.exp(x))}}
        tell()
        if np.abs(step).max(initial=0.0) < SETTLED:
            break
    return values, np.linalg.inv(told + prior)


def fit(
    tracks: Sequence[Rows], given: dict[str, float], names: Sequence[str], more: Sequence[str] = (),
    tell: Callable[[], None] = lambda: None,
) -> Fitted:  # fmt: skip
    """``given``: all settings of the rows; ``names``: those that are fitted first, ``more``: those that are fitted with
    them then. What the rows do not tell to ``KNOWN_SHARE`` gets its given value back, and is not in the result."""
    start = {name: value if value > 0.0 else SMALL_START for name, value in given.items()}
    values, covariance = _climb(tracks, start, {**given, **_of(start, names)}, tuple(names), tell)
    kept = [without_outliers(rows, values) for rows in tracks]
    asked = (*names, *more)
    values = {**values, **_of(start, more)}
    while asked:
        values, covariance = _climb(kept, start, values, asked, tell)
        sd = np.sqrt(np.diag(covariance))
        told = tuple(name for name, one in zip(asked, sd) if one <= KNOWN_SHARE)
        if told == asked:
            break
        values = {**values, **{name: given[name] for name in asked if name not in told}}
        asked = told
    share = dict(zip(asked, np.sqrt(np.diag(covariance)).tolist())) if asked else {}
    count, rows = sum(len(r.residual) for r in tracks), sum(len(r.residual) for r in kept)
    return Fitted(asked, values, share, rows, count - rows)


def _of(values: dict[str, float], names: Sequence[str]) -> dict[str, float]:
    return {name: values[name] for name in names}
