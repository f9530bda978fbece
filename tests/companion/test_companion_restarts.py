"""Jumping clocks, and restarts of either side in flight: one flight for each, all simultaneous."""

from __future__ import annotations

import math
import re
import signal
from collections.abc import Callable, Iterator

import pytest
from autopilot import ARDUPILOT
from camera import Obstacle
from companion import PROGRAM, is_missing, replay
from flights import Fleet, Flight, MakeFleet, Plan

pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

FLIGHT_S = 14.5
EVENT_S = 5.05  # no message has exactly this time
FAR = (Obstacle(300.0),)  # reached after 15 s
SHIFT = (15.0, -10.0, 0.0)

BACK, FORWARD, REBOOT = "clock back to 0", "clock 3 s forward", "autopilot restarts"
INTERRUPTED, KILLED = "companion restarts", "companion is killed"
BLIND, UNIX, NO_POSE = "detector dies", "detector's clock jumps", "poses cease"
TCP, FIFO = "tcp peer restarts", "fifo's writer restarts"
STEP, ODOMETRY_RESET, TURN = "position jumps", "ODOMETRY reports a reset", "heading jumps"
RESTARTED = [BACK, FORWARD, REBOOT]
ALL = [*RESTARTED, INTERRUPTED, KILLED, BLIND, UNIX, NO_POSE, TCP, FIFO, STEP, ODOMETRY_RESET, TURN]

PLANS = [
    Plan(BACK, obstacles=FAR, recorded=True),
    Plan(FORWARD, obstacles=FAR),
    Plan(REBOOT, obstacles=FAR, autopilot={"make": ARDUPILOT}),
    Plan(INTERRUPTED, obstacles=FAR),
    Plan(KILLED, obstacles=FAR),
    Plan(BLIND, obstacles=FAR, settings={"reports": {"standard": "obstacle_distance"}}),
    Plan(UNIX, obstacles=FAR),
    Plan(NO_POSE, obstacles=FAR),
    Plan(TCP, link="tcp", obstacles=FAR),
    Plan(FIFO, source="fifo", obstacles=FAR),
    Plan(STEP, obstacles=FAR, recorded=True),
    Plan(ODOMETRY_RESET, obstacles=FAR),
    Plan(TURN, obstacles=FAR),
]


class Events:
    """Triggers the events in flight, and stores their times."""

    def __init__(self, fleet: Fleet) -> None:
        self.fleet = fleet
        self.begin_s = self.end_s = 0.0

    def prepare(self) -> None:
        self.fleet[ODOMETRY_RESET].autopilot.reset_counter = 3
        self.fleet[TURN].autopilot.yaw_shift = math.radians(12.0)  # wrong until the jump

    def now(self) -> None:
        self.begin_s = self.fleet.loop.now_s
        fleet = self.fleet
        fleet[BACK].autopilot.clock.restart()
        fleet[FORWARD].autopilot.clock.jump(3.0)
        fleet[REBOOT].autopilot.restart(2.0)
        fleet[TCP].autopilot.wire.reopen()
        fleet[TURN].autopilot.yaw_shift = 0.0
        fleet[STEP].autopilot.shift = SHIFT
        fleet[ODOMETRY_RESET].autopilot.reset_counter = 4
        self._for_a_while(self._blind, 3.0)
        self._restart_companion(INTERRUPTED, signal.SIGINT)
        self._restart_companion(KILLED, signal.SIGKILL)

    def _for_a_while(self, switch: Callable[[bool], None], seconds: float) -> None:
        switch(True)
        self.fleet.loop.after(seconds, lambda: switch(False))

    def _blind(self, off: bool) -> None:
        self.end_s = self.fleet.loop.now_s
        for name in (BLIND, FIFO):
            self.fleet[name].detector.blind = off
        self.fleet[NO_POSE].autopilot.posing = not off
        self.fleet[UNIX].detector.unix_error_s = 3600.0 if off else 0.0
        lines = self.fleet[FIFO].lines
        assert lines
        lines.close()

    def _restart_companion(self, name: str, number: int) -> None:
        flight = self.fleet[name]
        flight.companion.interrupt(number)

        def again() -> None:
            flight.companion.stop()
            flight.start()

        self.fleet.loop.after(0.5, again)


@pytest.fixture(scope="module", name="events")
def flown(make_fleet: MakeFleet) -> Iterator[Events]:
    fleet = make_fleet(PLANS)
    events = Events(fleet)
    events.prepare()
    fleet.start()
    fleet.run(EVENT_S)
    events.now()
    fleet.run(FLIGHT_S - EVENT_S)
    fleet.stop()
    yield events


@pytest.fixture(name="fleet")
def the_fleet(events: Events) -> Fleet:
    return events.fleet


def before(flight: Flight, events: Events) -> list[float]:
    return [found.time_s for found in flight.found() if found.time_s < events.begin_s]


@pytest.mark.parametrize("name", ALL)
def test_it_goes_on_until_it_is_interrupted(fleet: Fleet, name: str) -> None:
    fleet[name].assert_ended_well()


@pytest.mark.parametrize("name", ALL)
def test_the_mast_is_known_before_and_after(fleet: Fleet, events: Events, name: str) -> None:
    """No report in between is wrong either, once the aircraft's own jump is over."""
    assert before(fleet[name], events)
    fleet[name].assert_found(since_s=events.begin_s + (0.5 if name in (STEP, TURN) else 0.0))


@pytest.mark.parametrize("name", [*RESTARTED, INTERRUPTED, KILLED])
def test_it_is_found_again_soon(fleet: Fleet, events: Events, name: str) -> None:
    """Tracks end; two seconds of silence and three of new images are enough."""
    first = [found.time_s for found in fleet[name].found() if found.time_s > events.begin_s + 1.0]
    again = [time_s for time_s in first if time_s > events.begin_s]
    assert again and again[0] - events.begin_s < 6.0


@pytest.mark.parametrize("name", RESTARTED)
def test_a_clock_that_jumps_ends_all_tracks(fleet: Fleet, name: str) -> None:
    """The companion reports it once, not for every message with the new time."""
    flight = fleet[name]
    assert 1 <= flight.statuses()[-1].lost <= 3
    assert flight.ended and re.search(r"restart|jump|anew", flight.ended.said), flight.ended


@pytest.mark.parametrize("name", RESTARTED)
def test_times_are_of_the_new_clock(fleet: Fleet, events: Events, name: str) -> None:
    flight = fleet[name]
    heard = [h for h in flight.autopilot.heard_of("GOE_STATUS") if h.time_s > events.begin_s + 4.0]
    assert heard
    for status in heard:
        reported = 1e-3 * status.message.time_boot_ms
        assert reported == pytest.approx(flight.autopilot.clock.at(status.time_s), abs=1.0)
    assert heard[-1].message.alive == 7


def test_delays_are_right_again_after_a_restart(fleet: Fleet) -> None:
    for name in RESTARTED:
        reported = [status.delay_mean for status in fleet[name].statuses()[-4:]]
        assert all(60 <= delay <= 160 for delay in reported), (name, reported)


def test_the_first_run_of_a_restarted_companion_ended_well(fleet: Fleet) -> None:
    assert fleet[INTERRUPTED].companion.ends[0].status == 0
    assert fleet[KILLED].companion.ends[0].status == -signal.SIGKILL


def test_a_rebooted_autopilot_is_answered_where_it_is_now(fleet: Fleet, events: Events) -> None:
    """The autopilot comes back from another port."""
    heard = [h.time_s for h in fleet[REBOOT].autopilot.heard_of("HEARTBEAT") if h.time_s > events.begin_s + 2.0]
    assert heard and heard[0] < events.begin_s + 5.0 and len(heard) >= 4


def test_the_companion_calls_its_tcp_peer_again(fleet: Fleet, events: Events) -> None:
    wire = fleet[TCP].autopilot.wire
    assert getattr(wire, "calls", 0) == 2
    heard = [h.time_s for h in fleet[TCP].autopilot.heard_of("GOE_STATUS") if h.time_s > events.begin_s]
    assert heard and heard[0] < events.begin_s + 4.0


# --------------------------------------------------------------------------------------------------------- alive inputs


def alive_between(flight: Flight, bit: int, begin_s: float, end_s: float) -> list[bool]:
    heard = flight.autopilot.heard_of("GOE_STATUS")
    return [bool(h.message.alive & bit) for h in heard if begin_s <= h.time_s <= end_s]


@pytest.mark.parametrize(("name", "bit"), [(BLIND, 1), (FIFO, 1), (UNIX, 1), (NO_POSE, 2)])
def test_an_input_that_fails_is_reported_and_comes_back(fleet: Fleet, events: Events, name: str, bit: int) -> None:
    """A detector counts as dead after a second, a pose after half a second; a clock error of an hour has the same
    effect as no data."""
    flight = fleet[name]
    assert all(alive_between(flight, bit, events.begin_s - 2.0, events.begin_s))
    dead = alive_between(flight, bit, events.begin_s + 1.3, events.end_s)
    assert dead and not any(dead)
    again = alive_between(flight, bit, events.end_s + 1.3, events.end_s + 60.0)
    assert len(again) >= 3 and all(again)


def test_obstacle_distance_of_a_dead_detector_is_unknown(fleet: Fleet, events: Events) -> None:
    """Unknown is not clear."""
    heard = fleet[BLIND].autopilot.heard_of("OBSTACLE_DISTANCE")
    blind = [h.message for h in heard if events.begin_s + 1.3 < h.time_s < events.end_s]
    assert blind
    for message in blind:
        clear = [distance for distance in message.distances if distance == message.max_distance + 1]
        assert not clear
    assert all(h.message.distances[0] < 65535 for h in heard if h.time_s > events.end_s + 2.0)


# --------------------------------------------------------------------------------------------------- resets of a filter


def test_a_step_is_a_known_jump(fleet: Fleet, events: Events) -> None:
    """The track continues: the obstacle moves with the local frame, without a gap."""
    flight = fleet[STEP]
    last = flight.statuses()[-1]
    assert (last.resets, last.lost) == (1, 0)
    times = [found.time_s for found in flight.found() if found.time_s > events.begin_s - 1.0]
    assert max(after - before for before, after in zip(times, times[1:])) < 0.6
    assert len({message.slot for message in flight.of("GOE_OBSTACLE")}) == 1


@pytest.mark.parametrize("name", [TURN, ODOMETRY_RESET])
def test_a_reset_of_unknown_size_ends_the_tracks(fleet: Fleet, name: str) -> None:
    """A turn that the rates do not explain, and a counter of ODOMETRY without a step."""
    assert fleet[name].statuses()[-1].lost == 1


@pytest.mark.parametrize("name", [BACK, STEP])
def test_the_log_is_replayed(fleet: Fleet, name: str) -> None:
    """Also the log of a clock that starts again."""
    assert any(row["status"] == "ok" for row in replay(fleet[name].log)[-30:])
