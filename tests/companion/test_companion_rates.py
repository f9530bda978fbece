"""The requested rates of poses, and the reactions to an autopilot's refusal: simultaneous flights."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from autopilot import ARDUPILOT, ATTITUDE, DENIED, ODOMETRY, POSITION, PX4, REJECTED, SET_MESSAGE_INTERVAL
from companion import PROGRAM, is_missing
from flights import Fleet, Flight, MakeFleet, Plan

pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

FLIGHT_S = 14.0
FASTER = {"link": {"attitude_hz": 50, "position_hz": 50}}
STOCK, SLOW, FAST, SILENT, REBOOT = "stock", "slow", "more than its loop", "answers late", "restarts"
TEMPORARILY, DENYING, STUBBORN = "refuses for now", "denies", "refuses everything at first"


def plane(most_hz: float, **more: Any) -> dict[str, Any]:
    return {"make": ARDUPILOT, "most_hz": most_hz, "pose_hz": 200.0, "refused": (ODOMETRY,), **more}


PLANS = [
    Plan(STOCK, autopilot=plane(40.0)),
    Plan(SLOW, autopilot=plane(12.0)),
    Plan(FAST, autopilot=plane(40.0), settings=FASTER),
    Plan(SILENT, autopilot=plane(40.0, ignored={SET_MESSAGE_INTERVAL: 3})),
    Plan(REBOOT, autopilot=plane(40.0)),
    Plan(TEMPORARILY, autopilot=plane(12.0, refusal=REJECTED)),
    Plan(DENYING, autopilot=plane(12.0, refusal=DENIED)),
    Plan(STUBBORN, autopilot=plane(1.0)),
    Plan("px4", autopilot={"make": PX4, "most_hz": 100.0, "pose_hz": 200.0}),
]


@pytest.fixture(scope="module", name="fleet")
def flown(make_fleet: MakeFleet) -> Iterator[Fleet]:
    fleet = make_fleet(PLANS)
    fleet.start()
    fleet.loop.after(6.0, lambda: fleet[REBOOT].autopilot.restart(0.5))
    fleet.loop.after(2.0, lambda: setattr(fleet[STUBBORN].autopilot, "most_hz", 40.0))
    fleet.run(FLIGHT_S)
    fleet.stop()
    yield fleet


def requested_hz(flight: Flight, message: int) -> list[float]:
    requests = [m for m in flight.of("COMMAND_LONG") if m.command == SET_MESSAGE_INTERVAL and int(m.param1) == message]
    return [round(1e6 / m.param2, 1) for m in requests]


@pytest.mark.parametrize("name", [plan.name for plan in PLANS])
def test_poses_come(fleet: Fleet, name: str) -> None:
    """The mast is found by these poses."""
    flight = fleet[name]
    flight.assert_ended_well()
    assert len(flight.found()) > 5


def test_it_starts_at_25_hz(fleet: Fleet) -> None:
    """A stock ArduPlane accepts it, so one request is enough."""
    assert requested_hz(fleet[STOCK], ATTITUDE) == [25.0]
    assert requested_hz(fleet[STOCK], POSITION) == [25.0]
    assert fleet[STOCK].ended and "refuses ATT" not in fleet[STOCK].ended.err


LOWERED = [(SLOW, [25.0, 20.0, 10.0]), (FAST, [50.0, 40.0])]
LOWERED += [(name, [25.0, 20.0, 10.0]) for name in (TEMPORARILY, DENYING)]


@pytest.mark.parametrize("name, rates", LOWERED)
def test_a_refused_rate_is_lowered(fleet: Fleet, name: str, rates: list[float]) -> None:
    flight = fleet[name]
    assert requested_hz(flight, ATTITUDE) == rates
    assert requested_hz(flight, POSITION) == rates
    assert flight.ended and flight.ended.err.count("ATTITUDE_QUATERNION") == 1, flight.ended.err
    assert f"ATTITUDE_QUATERNION at {rates[0]:.0f} Hz is refused: {rates[-1]:.0f} Hz" in flight.ended.err


def test_an_unanswered_request_is_repeated(fleet: Fleet) -> None:
    assert requested_hz(fleet[SILENT], ATTITUDE) == 4 * [25.0]


def test_a_refused_request_is_repeated_while_no_poses_come(fleet: Fleet) -> None:
    assert requested_hz(fleet[STUBBORN], ATTITUDE) == [25.0, 20.0, 10.0, 5.0, 25.0]
    assert fleet[STUBBORN].ended and fleet[STUBBORN].ended.err.count("does not send ATTITUDE_QUATERNION") == 1


def test_requests_are_repeated_after_a_restart_of_the_autopilot(fleet: Fleet) -> None:
    """Without poses the new clock is noticed late: the requests are repeated once more."""
    assert requested_hz(fleet[REBOOT], ATTITUDE) in (2 * [25.0], 3 * [25.0])


def test_odometry_is_requested_of_every_autopilot(fleet: Fleet) -> None:
    """An autopilot without it gets no second request, and the refusal is reported once."""
    assert requested_hz(fleet["px4"], ODOMETRY) == [10.0]
    assert requested_hz(fleet[STOCK], ODOMETRY) == [10.0, 5.0]
    assert fleet[STOCK].ended and fleet[STOCK].ended.err.count("ODOMETRY") == 1
