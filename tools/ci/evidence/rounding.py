"""Rounding error of float32: a search for the worst scenes that lib/goe.h allows.

The library in float32 and in double precision get the same numbers. They are compared up to the first image in which
their decisions differ (a model, an outlier at the edge of the gate, the association of a box's corners): noise also
makes such decisions either way. Differences after it are reported separately."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field

import numpy as np
from bench.optimum.extremes import CASES, DOMAINS, FAR, NEAR, Case, Domain, scene_at
from bench.optimum.rounding import QUANTITIES, difference, most
from goe_tools.library import ready

from .parts import Amount, NotHereError
from .record import Result, Row

TRIED = {False: 250, True: 6000}  # scenes for each case and domain; True: long run
RANDOM_SHARE = 0.3  # of them at random, before the local search
STEP, STEP_SHARE = 0.1, 0.35  # size of a step in the unit cube; share of the changed coordinates
METHODS = ("filter", "window")
GOALS = {(NEAR.name, "filter"): 0.5, (FAR.name, "filter"): 1.0}  # sigmas; results in lib/goe.h, Arithmetic


@dataclass
class Worst:
    """The worst scene of a quantity."""

    sigmas: float = 0.0
    point: np.ndarray | None = None
    ever: float = 0.0  # in any scene, also after a different decision that no output contains


@dataclass
class Found:
    case: Case
    domain: Domain
    worst: dict[str, Worst] = field(default_factory=lambda: {name: Worst() for name in QUANTITIES})
    sigma: float = 0.0  # of a sigma, relative
    tracks: int = 0  # with an answer
    answers: int = 0
    apart: int = 0
    parted: int = 0  # tracks with a different decision


def try_point(found: Found, point: np.ndarray) -> None:
    images, settings = scene_at(found.case, found.domain, point)
    one = difference(images, settings)
    found.tracks += one.answered > 0
    found.answers += one.answered
    found.apart += one.apart
    found.parted += one.apart > 0
    for name, worst in found.worst.items():
        sigmas = most(one.sigmas[name])
        found.sigma = max(found.sigma, most(one.sigma[name]))
        worst.ever = max(worst.ever, most(one.ever[name]))
        if sigmas > worst.sigmas:
            worst.sigmas, worst.point = sigmas, point


def moved(point: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    chosen = rng.random(len(point)) < STEP_SHARE
    return np.clip(point + chosen * STEP * rng.standard_normal(len(point)), 0.0, 1.0)


def search(case: Case, domain: Domain, tries: int, seed: int = 1) -> Found:
    """Random search first, then from the worst scene of each quantity in turn."""
    rng = np.random.default_rng([seed, CASES.index(case), DOMAINS.index(domain)])
    found = Found(case, domain)
    names = list(QUANTITIES)
    for number in range(tries):
        worst = found.worst[names[number % len(names)]].point
        random = number < RANDOM_SHARE * tries or worst is None
        try_point(found, rng.random(len(domain.ranges)) if random or worst is None else moved(worst, rng))
    return found


def _search(job: tuple[int, int, int]) -> Found:
    return search(CASES[job[0]], DOMAINS[job[1]], job[2])


def searched(amount: Amount) -> list[Found]:
    jobs = [(c, d, TRIED[amount.long]) for d in range(len(DOMAINS)) for c in range(len(CASES))]
    if amount.jobs < 2:
        return [_search(job) for job in jobs]
    with ProcessPoolExecutor(amount.jobs) as pool:
        return list(pool.map(_search, jobs))


def worst_of(found: Sequence[Found], name: str) -> Found:
    return max(found, key=lambda one: one.worst[name].sigmas)


def rows(found: Sequence[Found]) -> Iterator[Row]:
    for domain in DOMAINS:
        for method in METHODS:
            own = [f for f in found if f.domain == domain and f.case.method == method]
            goal = GOALS.get((domain.name, method))
            if not own:
                continue
            for name in QUANTITIES:
                best = worst_of(own, name)
                worst, ever = best.worst[name], max(f.worst[name].ever for f in own)
                if worst.point is not None:
                    yield Row(
                        f"{name}, {method}, {domain.name} domain: float32 against float64, the worst scene found",
                        f"{worst.sigmas:.2g} sigma ({best.case.name}); {ever:.2g} after a different decision",
                        f"at most {goal:g} sigma" if goal else "",
                        worst.sigmas <= goal if goal else None,
                    )
            tracks, parted = sum(f.tracks for f in own), sum(f.parted for f in own)
            yield Row(
                f"{method}, {domain.name} domain: rounding of a sigma; tracks with a different decision",
                f"{max(f.sigma for f in own):.2g} of it; {parted} of {tracks} searched tracks",
                "",
                None,
            )


def report(found: Sequence[Found]) -> str:
    lines = [f"{domain.name}: {domain.words}" for domain in DOMAINS]
    for one in found:
        lines += [
            "",
            f"{one.domain.name}, {one.case.name}: {one.tracks} tracks, {one.answers} answers, {one.apart} apart",
        ]
        for name, worst in one.worst.items():
            if worst.point is not None:
                figures = ", ".join(f"{k} {v:.3g}" for k, v in one.domain.figures(worst.point).items())
                lines.append(f"  {name}: {worst.sigmas:.3g} sigma; {figures}")
    return "\n".join(lines)


def run(amount: Amount) -> Result:
    try:
        ready()
        ready(double=True)
    except FileNotFoundError as reason:
        raise NotHereError(str(reason)) from None
    found = searched(amount)
    return Result(list(rows(found)), report(found))
