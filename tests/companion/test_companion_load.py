"""200 Hz of poses, eight obstacles at 30 Hz: nothing is lost and nothing grows. bench_companion.py reports the cost."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from camera import Obstacle
from companion import PROGRAM, SANITIZED_KIB, is_missing, replay
from flights import FAR_M, Fleet, Flight, MakeFleet, Plan

pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

WARM_S, LOAD_S = 3.0, 5.0
GROWTH_KIB = 128
FOREST = tuple(Obstacle(380.0 + 40.0 * (k % 2), -140.0 + 40.0 * k) for k in range(8))

PLAN = Plan(
    "forest",
    obstacles=FOREST,
    autopilot={"pose_hz": 200.0},
    detector={"hz": 30.0},
    settings={"link": {"attitude_hz": 200, "position_hz": 200}},
    recorded=True,
)


@dataclass
class Load:
    fleet: Fleet
    flight: Flight
    before_kib: int = 0
    after_kib: int = 0
    files_before: int = 0
    files_after: int = 0


@pytest.fixture(scope="module", name="load")
def flown(make_fleet: MakeFleet) -> Iterator[Load]:
    fleet = make_fleet([PLAN])
    flight, companion = fleet[PLAN.name], fleet[PLAN.name].companion
    fleet.start()
    fleet.run(WARM_S)
    load = Load(fleet, flight, before_kib=companion.rss_kib(), files_before=companion.files())
    fleet.run(LOAD_S)
    load.after_kib, load.files_after = companion.rss_kib(), companion.files()
    fleet.stop()
    yield load


def test_it_was_loaded(load: Load) -> None:
    """Checks the load behind the figures: the number of poses, and every image taken."""
    assert load.flight.autopilot.wire.sent > 0.8 * 400 * (WARM_S + LOAD_S)
    assert len(load.flight.detector.delays) > 0.8 * 30 * (WARM_S + LOAD_S)
    assert load.flight.statuses()[-1].taken > 0.95 * len(load.flight.detector.delays) - 40


def test_it_does_not_grow(load: Load) -> None:
    if load.before_kib > SANITIZED_KIB:
        pytest.skip("a sanitizer keeps freed memory")
    assert 0 < load.after_kib <= load.before_kib + GROWTH_KIB
    assert load.files_after == load.files_before


def test_all_eight_are_followed(load: Load) -> None:
    last = load.flight.statuses()[-1]
    assert last.obstacles == 8 and (last.full, last.evicted) == (0, 0)
    assert last.late <= 6  # the first were taken before there was a pose
    assert {message.id for message in load.flight.of("GOE_OBSTACLE")} == set(range(1, 9))


@pytest.mark.parametrize("number", range(8))
def test_each_is_where_it_is(load: Load, number: int) -> None:
    mine = load.flight.found(FOREST[number])
    assert len(mine) > 10
    assert all(found.sigmas <= FAR_M for found in mine)
    assert mine[-1].error_m < 0.1 * mine[-1].range_m


def test_the_log_of_eight_is_replayed(load: Load) -> None:
    assert {row["id"] for row in replay(load.flight.log) if row["status"] == "ok"} == {str(k) for k in range(1, 9)}


def test_it_ends_well(load: Load) -> None:
    load.flight.assert_ended_well()
