"""The pilot's messages and the companion's behavior when the autopilot doubts its position: simultaneous flights."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from autopilot import ARDUPILOT, DO_REPOSITION, SET_MESSAGE_INTERVAL, local_m
from camera import Obstacle
from companion import PROGRAM, is_missing
from flights import Fleet, Flight, MakeFleet, Plan

pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

BEGIN_S, FLIGHT_S = 1.5, 21.0
FAR = (Obstacle(350.0),)  # reached after 17.5 s
NO_GPS, FIX_3D = 1, 3  # of GPS_RAW_INT.fix_type
GOOD = 1 + 2 + 4 + 8 + 16 + 32  # both makes: attitude, velocities, positions
TO_PX4 = {"reaction": {"mode": "px4"}, "flight": {"loiter_m": 0}}
TO_ARDUPLANE = {"reaction": {"mode": "arduplane"}}
HEALTHY, LOST, SILENT, FILTER = "healthy", "gps lost", "gps silent", "filter in doubt"
PLANE, GLITCH, AGAIN, OFF = "arduplane, gps lost", "arduplane, glitch", "gps comes back", "reactions off"
REBORN = "gps lost, and a restart"
ARDUPLANE = {"make": ARDUPILOT}
PLANS = [
    Plan(HEALTHY, settings=TO_PX4, obstacles=FAR),
    Plan(LOST, settings=TO_PX4, obstacles=FAR),
    Plan(SILENT, settings=TO_PX4, obstacles=FAR),
    Plan(FILTER, settings=TO_PX4, obstacles=FAR),
    Plan(AGAIN, settings=TO_PX4, obstacles=FAR),
    Plan(PLANE, settings=TO_ARDUPLANE, autopilot=ARDUPLANE, obstacles=FAR),
    Plan(GLITCH, settings=TO_ARDUPLANE, autopilot=ARDUPLANE, obstacles=FAR),
    Plan(OFF, settings={"flight": {"loiter_m": 60}}, obstacles=FAR),  # less than a turn's 71 m at 20 m/s and 30 degrees
    Plan(REBORN, settings={"flight": {"loiter_m": 80}}, obstacles=FAR),
]
ILL = [LOST, SILENT, FILTER, PLANE, GLITCH, AGAIN]


@pytest.fixture(scope="module", name="fleet")
def flown(make_fleet: MakeFleet) -> Iterator[Fleet]:
    fleet = make_fleet(PLANS)
    for flight in fleet.flights.values():
        flight.autopilot.gps_fix, flight.autopilot.filter_flags = FIX_3D, GOOD
    fleet.start()
    fleet.run(BEGIN_S)
    for name in (LOST, PLANE, AGAIN, REBORN):
        fleet[name].autopilot.gps_fix = NO_GPS
    fleet[SILENT].autopilot.gps_fix = None
    fleet[FILTER].autopilot.filter_flags = GOOD & ~2
    fleet[GLITCH].autopilot.filter_flags = GOOD | 32768
    fleet.run(2.5)
    fleet[AGAIN].autopilot.gps_fix, fleet[REBORN].autopilot.gps_fix = FIX_3D, None
    fleet[REBORN].autopilot.restart(0.5)
    fleet.run(FLIGHT_S - BEGIN_S - 2.5)
    fleet.stop()
    yield fleet


def texts(flight: Flight) -> list[str]:
    return [message.text.rstrip("\0") for message in flight.of("STATUSTEXT")]


def aside_m(flight: Flight) -> float:
    """Lateral distance of the first order."""
    first = next(m for m in flight.of("COMMAND_INT") if m.command == DO_REPOSITION)
    return abs(local_m(first.x, first.y)[1])


@pytest.mark.parametrize("name", [plan.name for plan in PLANS])
def test_it_ends_well(fleet: Fleet, name: str) -> None:
    fleet[name].assert_ended_well()


def test_health_messages_are_requested(fleet: Fleet) -> None:
    """GPS_RAW_INT for both makes, and the filter message of each."""
    for name, messages in ((HEALTHY, {24, 230, 331}), (PLANE, {24, 193, 331})):
        requests = [m for m in fleet[name].of("COMMAND_LONG") if m.command == SET_MESSAGE_INTERVAL]
        assert messages <= {int(m.param1) for m in requests}


@pytest.mark.parametrize("name", [LOST, SILENT, PLANE, AGAIN])
def test_a_loss_of_gps_is_reported(fleet: Fleet, name: str) -> None:
    """In the events and to the pilot, within seconds."""
    flight = fleet[name]
    assert flight.ended and "GPS" in flight.ended.err
    heard = [h for h in flight.autopilot.heard_of("STATUSTEXT") if "GPS" in h.message.text]
    assert heard and heard[0].message.severity <= 4
    assert heard[0].time_s - (flight.loop.now_s - FLIGHT_S + BEGIN_S) < 5.0


@pytest.mark.parametrize("name", [FILTER, GLITCH])
def test_a_filter_in_doubt_is_reported(fleet: Fleet, name: str) -> None:
    assert fleet[name].ended and "filter" in fleet[name].ended.err
    assert any("filter" in text for text in texts(fleet[name]))


def test_nothing_is_reported_of_a_healthy_autopilot(fleet: Fleet) -> None:
    assert not [text for text in texts(fleet[HEALTHY]) if "GPS" in text or "filter" in text]


def test_a_circle_below_the_radius_of_a_turn_is_reported_once(fleet: Fleet) -> None:
    assert [fleet[name].ended.err.count("flight.loiter_m") for name in (OFF, REBORN, HEALTHY)] == [1, 0, 0]  # type: ignore[union-attr]
    assert "flight.loiter_m 60 is smaller than the turn at 20 m/s and 30 degrees of bank: 71 m" in fleet[OFF].ended.err  # type: ignore[union-attr]


def test_the_end_of_a_doubt_is_reported(fleet: Fleet) -> None:
    shown = [text for text in texts(fleet[AGAIN]) if "GPS" in text or "navigation" in text]
    assert len(shown) == 2 and "good" in shown[-1]


def test_a_restart_of_the_autopilot_ends_its_faults(fleet: Fleet) -> None:
    assert fleet[REBORN].ended and "navigation: good again" in fleet[REBORN].ended.err


@pytest.mark.parametrize("name", [LOST, SILENT, FILTER])
def test_doubt_widens_the_margin(fleet: Fleet, name: str) -> None:
    """By half of 15 m, the default of flight.suspect_factor."""
    assert aside_m(fleet[name]) > aside_m(fleet[HEALTHY]) + 5.0


def test_a_doubt_ends_no_track(fleet: Fleet) -> None:
    for name in ILL:
        assert fleet[name].statuses()[-1].lost == 0
        fleet[name].assert_found()


@pytest.mark.parametrize("name", [HEALTHY, PLANE])
def test_orders_are_on_the_screen(fleet: Fleet, name: str) -> None:
    """The companion sends texts with the obstacle's time, and reports the end of the order."""
    shown = [text for text in texts(fleet[name]) if "order" in text or "traffic" in text]
    assert re.search(r"\d s", shown[0]) and "end" in shown[-1], shown
    assert {m.get_srcComponent() for m in fleet[name].of("STATUSTEXT")} == {196}


def test_without_reactions_the_pilot_is_warned(fleet: Fleet) -> None:
    assert any(re.search(r"advises (left|right)", text) for text in texts(fleet[OFF]))


@pytest.mark.parametrize("name", [plan.name for plan in PLANS])
def test_the_screen_is_not_flooded(fleet: Fleet, name: str) -> None:
    """At most two lines a second, none of them truncated."""
    times = [heard.time_s for heard in fleet[name].autopilot.heard_of("STATUSTEXT")]
    assert all(after - before > 0.45 for before, after in zip(times, times[1:])) and len(times) < 20
    assert all(len(text) < 50 for text in texts(fleet[name]))


@pytest.mark.parametrize("name", [plan.name for plan in PLANS])
def test_events_have_times(fleet: Fleet, name: str) -> None:
    ended = fleet[name].ended
    assert ended
    events = [line for line in ended.err.splitlines() if "goe_companion: " in line]
    assert events
    for line in events:
        assert re.match(r"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z goe_companion: ", line), line
