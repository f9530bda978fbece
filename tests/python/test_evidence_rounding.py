"""Rounding at the ends of the ranges: the comparison, the search, and the bound near the autopilot's origin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from bench.optimum import rounding as compared
from bench.optimum.extremes import CASES, DOMAINS, FAR, NEAR, WHOLE, scene_at
from bench.optimum.rounding import DECISIONS, QUANTITIES, VELOCITY, difference, most
from ci.evidence import rounding
from ci.evidence.parts import Amount
from ci.evidence.rounding import GOALS, Found, Worst, moved, rows, search
from goe_tools.library import Images, package, ready

TRIES = 100


@pytest.fixture(scope="module", autouse=True)
def built() -> None:
    for double in (False, True):
        try:
            ready(double)
        except FileNotFoundError as reason:
            pytest.skip(str(reason))


@dataclass
class Run:
    status: np.ndarray
    estimates: Any


def run_of(images: int = 6) -> Run:
    """Answers with every quantity except a velocity. Each value is 10 and its sigma 2."""
    estimates = np.zeros(images, package().ESTIMATE)
    estimates["valid"], estimates["fresh"], estimates["nis"] = 0x3F, True, 1.0
    for name in QUANTITIES:
        estimates[name], estimates["sigma"][name] = 10.0, 2.0
    return Run(np.zeros(images, int), estimates)


def differ(monkeypatch: pytest.MonkeyPatch, single: Run, double: Run) -> compared.Difference:
    monkeypatch.setattr(compared, "package", lambda: type("P", (), {"run": staticmethod(lambda *_: single)}))
    monkeypatch.setattr(compared.double_precision, "run", lambda *_: double)
    monkeypatch.setattr(compared, "to_package", lambda images: None)
    monkeypatch.setattr(compared, "named_settings", lambda settings: None)
    nothing = np.zeros(0)
    return difference(Images(nothing, nothing, nothing, nothing, nothing, nothing), {})


def test_differences_are_in_sigmas_of_the_double_precision(monkeypatch: pytest.MonkeyPatch) -> None:
    single, double = run_of(), run_of()
    single.estimates["x0_m"][3] += 0.5
    single.estimates["orientation_deg"][2] = -169.0
    double.estimates["orientation_deg"][2] = 10.0  # one degree apart, as undirected lines
    single.estimates["sigma"]["width_m"][1] = 2.2
    found = differ(monkeypatch, single, double)
    assert [most(found.sigmas[name]) for name in ("x0_m", "orientation_deg", "z0_m")] == [0.25, 0.5, 0.0]
    assert most(found.sigma["width_m"]) == pytest.approx(0.1)
    assert np.isnan(found.sigmas["velocity_east_m_s"]).all()  # no bit of it
    assert VELOCITY & int(double.estimates["valid"][0]) == 0
    assert (found.answered, found.apart) == (6, 0)


@pytest.mark.parametrize("name", ["nis", "suspect", *DECISIONS])
def test_images_after_another_decision_are_counted_separately(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    single, double = run_of(), run_of()
    single.estimates["x0_m"][4] += 1.0
    if name == "suspect":
        double.estimates[name][2:] = True
    single.estimates[name][2:] = 1 if name != "nis" else 1.2
    if name == "valid":
        single.estimates[name][2:] = 0x1F
    if name == "fresh":
        single.estimates[name][2:] = False
    found = differ(monkeypatch, single, double)
    assert most(found.sigmas["x0_m"]) == 0.0
    assert most(found.ever["x0_m"]) == (0.5 if name in ("nis", "suspect") else 0.0)
    assert found.apart == 4


def test_scenes_lie_within_the_ranges_of_the_header() -> None:
    rng = np.random.default_rng(3)
    for case in CASES:
        for domain in DOMAINS:
            for point in (np.zeros(len(domain.ranges)), np.ones(len(domain.ranges)), rng.random(len(domain.ranges))):
                images, settings = scene_at(case, domain, point)
                assert np.isfinite(images.position_ned_m).all()
                assert np.abs(images.position_ned_m).max() <= 1e6
                assert np.abs(images.pixel_px).max() <= 1e5
                assert package().Settings.from_names(settings) is not None  # all values are in range
    named = {r.name: r for r in WHOLE.ranges}
    assert named["north_m"].at(1.0) == pytest.approx(1e6)
    assert named["aside"].at(0.25) == pytest.approx(-0.25)


@pytest.mark.release
def test_the_search_climbs() -> None:
    """The search ends with worse scenes than as many random ones. The worse a domain is, the farther the search
    moves."""
    case = CASES[0]
    random = Found(case, NEAR)
    rng = np.random.default_rng(7)
    for _ in range(TRIES):
        rounding.try_point(random, rng.random(len(NEAR.ranges)))
    worst = [search(case, domain, TRIES).worst["z0_m"].sigmas for domain in (NEAR, FAR, WHOLE)]
    assert random.worst["z0_m"].sigmas < worst[0] < worst[1] < worst[2]
    assert worst[0] == search(case, NEAR, TRIES).worst["z0_m"].sigmas  # the same each time
    point = rng.random(len(NEAR.ranges))
    assert 0.0 < np.count_nonzero(moved(point, rng) != point) < len(point)


@pytest.mark.release
def test_near_the_origin_rounding_is_far_below_a_sigma() -> None:
    """[A15]"""
    found = [search(case, NEAR, TRIES) for case in CASES if case.method == "filter"]
    assert sum(one.tracks for one in found) > 0.8 * TRIES * len(found)
    for name in QUANTITIES:
        assert 0.0 < max(one.worst[name].sigmas for one in found) <= GOALS[(NEAR.name, "filter")]
    table = list(rows([*found, search(CASES[-1], NEAR, 3)]))
    assert all(row.met is not False for row in table)
    assert "x0_m, filter, near domain" in rounding.report(found) + table[0].what


def test_an_exceeded_bound_is_missed() -> None:
    """[A15]"""
    found = [Found(case, domain) for case in CASES for domain in DOMAINS]
    for one in found:
        one.worst = {name: Worst(99.0, np.zeros(len(one.domain.ranges)), 99.0) for name in QUANTITIES}
    table = list(rows(found))
    assert sum(row.met is False for row in table) == len(GOALS) * len(QUANTITIES)
    assert any("at most" in row.goal for row in table)


def test_a_run_of_the_part_reports_every_domain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(rounding.TRIED, False, 2)
    for jobs in (1, 2):  # another process returns a copy
        result = rounding.run(Amount(False, jobs))
        assert all(domain.words in result.report for domain in DOMAINS)
        assert all(any(f"{domain.name} domain" in row.what for row in result.rows) for domain in DOMAINS)
