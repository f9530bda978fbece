"""The companion's orders to the autopilot, for each kind of reaction and autopilot: simultaneous flights."""

from __future__ import annotations

import csv
import math
import signal
import statistics
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from autopilot import ALT_M, ARDUPILOT, DO_GO_AROUND, DO_REPOSITION, DO_SET_MODE, LOITER, MODES, PX4, Heard, local_m
from camera import MAST, Obstacle
from companion import PROGRAM, is_missing
from flights import Fleet, Flight, MakeFleet, Plan

pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

FLIGHT_S = 18.0
IGNORED = 3
MARGIN_M = 15.0
POSITION = 3 << 16  # PX4: POSCTL
ICAO = 0xABC120
LOW = Obstacle(250.0, height_m=22.0)
ASIDE = (Obstacle(250.0, 90.0),)
STOPS = {"loiter_m": 0}  # the simulated vehicle receives no further command
TO_PX4 = {"reaction": {"mode": "px4"}, "flight": STOPS}
TO_ARDUPLANE = {"reaction": {"mode": "arduplane"}}
AVOIDS, STAYS, PAST = "px4", "px4 without resume", "px4, mast aside"
OVERRULED, AT_ONCE = "px4 and its pilot", "px4 and its pilot, at once"
BLANK = "px4, no position after a reset of the heading"
KILLED, FORGETFUL = "px4, companion killed", "px4, companion killed without a log"
LANDING, LANDING_PLANE = "px4 on approach", "arduplane on approach"
TRAFFIC, LOW_TRAFFIC, NO_TRAFFIC = "arduplane", "arduplane, low mast", "arduplane, mast aside"
PILOT_OUT, BY_ITSELF = "arduplane, its pilot ends the avoidance", "arduplane ends its avoidance by itself"
PLANE = {"make": ARDUPILOT}
AVOID_ADSB = 14  # mode of ArduPlane
PLANS = [
    Plan(AVOIDS, settings=TO_PX4, autopilot={"ignored": {DO_REPOSITION: IGNORED, DO_SET_MODE: 1}}),
    Plan(STAYS, settings={"reaction": {"mode": "px4", "resume": 0}, "flight": STOPS}),
    Plan(OVERRULED, settings=TO_PX4),
    Plan(AT_ONCE, settings=TO_PX4),
    Plan(BLANK, settings=TO_PX4),
    Plan(KILLED, settings=TO_PX4, recorded=True),
    Plan(FORGETFUL, settings=TO_PX4),
    Plan(PAST, settings=TO_PX4, obstacles=ASIDE),
    Plan(LANDING, settings=TO_PX4, obstacles=(LOW,), autopilot={"landing": True}),
    Plan(LANDING_PLANE, settings=TO_ARDUPLANE, obstacles=(LOW,), autopilot={**PLANE, "landing": True}),
    Plan(TRAFFIC, settings={"reaction": {"mode": "arduplane", "icao": hex(ICAO)}}, autopilot=PLANE),
    Plan(LOW_TRAFFIC, settings=TO_ARDUPLANE, obstacles=(LOW,), autopilot=PLANE),
    Plan(PILOT_OUT, settings=TO_ARDUPLANE, autopilot=PLANE),
    Plan(BY_ITSELF, settings=TO_ARDUPLANE, autopilot=PLANE),
    Plan(NO_TRAFFIC, settings=TO_ARDUPLANE, obstacles=ASIDE, autopilot=PLANE),
]


class Pilot:
    """Takes over once, `after_s` after the order."""

    def __init__(self, flight: Flight, after_s: float) -> None:
        self.autopilot, self.after_s, self.loop = flight.autopilot, after_s, flight.loop
        self.seen, self.since_s = False, math.inf
        self.loop.every(0.005, self._look)

    def _look(self) -> None:
        if self.autopilot.mode == LOITER and not self.seen:
            self.seen = True
            self.loop.after(self.after_s, self._take_over)

    def _take_over(self) -> None:
        self.autopilot.set_mode(POSITION)
        self.since_s = self.loop.now_s


class Blank:
    """After the order, the heading jumps and no position comes for some time: nothing can be assessed."""

    FOR_S = 2.5

    def __init__(self, flight: Flight) -> None:
        self.autopilot, self.loop = flight.autopilot, flight.loop
        self.since_s = math.inf
        self.loop.every(0.05, self._look)

    def _look(self) -> None:
        if self.autopilot.mode == LOITER and math.isinf(self.since_s):
            self.since_s = self.loop.now_s
            self._switch(0.2)
            self.loop.after(0.1, lambda: self._switch(0.0))
            self.loop.after(self.FOR_S, self._end)

    def _switch(self, yaw: float) -> None:
        self.autopilot.positioning, self.autopilot.yaw_shift = False, yaw

    def _end(self) -> None:
        self.autopilot.positioning = True


class Avoidance:
    """ArduPlane's avoidance: into AVOID_ADSB when traffic comes, and back after 2 s, once. ArduPlane reports that it
    does so."""

    def __init__(self, flight: Flight, by_itself: bool) -> None:
        self.flight, self.by_itself = flight, by_itself
        self.since_s = math.inf  # on the way back
        self.seen = False
        flight.loop.every(0.05, self._look)

    def _look(self) -> None:
        if not self.seen and self.flight.of("ADSB_VEHICLE"):
            self.seen = True
            self.flight.autopilot.set_mode(AVOID_ADSB)
            self.flight.loop.after(2.0, self._back)

    def _back(self) -> None:
        autopilot = self.flight.autopilot
        autopilot.set_mode(MODES[ARDUPILOT])
        self.since_s = self.flight.loop.now_s
        if self.by_itself:
            autopilot.send(autopilot.dialect.MAVLink_statustext_message(6, b"Avoid: Resuming with action: 1"))


class Killer:
    """Kills the companion once, a set time after the order, and restarts it."""

    def __init__(self, flight: Flight, after_s: float) -> None:
        self.flight, self.after_s = flight, after_s
        self.seen = False
        flight.loop.every(0.05, self._look)

    def _look(self) -> None:
        if self.flight.autopilot.mode == LOITER and not self.seen:
            self.seen = True
            self.flight.loop.after(self.after_s, self._strike)

    def _strike(self) -> None:
        self.flight.companion.stop(signal.SIGKILL)
        self.flight.companion.start()


@pytest.fixture(scope="module", name="pilots")
def all_pilots() -> dict[str, Pilot]:
    return {}


@pytest.fixture(scope="module", name="blanks")
def all_blanks() -> list[Blank]:
    return []


@pytest.fixture(scope="module", name="avoidances")
def all_avoidances() -> dict[str, Avoidance]:
    return {}


@pytest.fixture(scope="module", name="fleet")
def flown(
    make_fleet: MakeFleet, pilots: dict[str, Pilot], avoidances: dict[str, Avoidance], blanks: list[Blank]
) -> Iterator[Fleet]:
    fleet = make_fleet(PLANS)
    fleet.start()
    blanks.append(Blank(fleet[BLANK]))
    pilots.update({name: Pilot(fleet[name], after_s) for name, after_s in ((OVERRULED, 2.0), (AT_ONCE, 0.01))})
    avoidances.update({name: Avoidance(fleet[name], name == BY_ITSELF) for name in (PILOT_OUT, BY_ITSELF)})
    killers = [Killer(fleet[name], 1.5) for name in (KILLED, FORGETFUL)]
    fleet.run(FLIGHT_S)
    fleet.stop()
    assert all(killer.seen for killer in killers)
    yield fleet


def orders(flight: Flight) -> list[Heard]:
    heard = flight.autopilot.heard_of("COMMAND_INT") + flight.autopilot.heard_of("COMMAND_LONG")
    return [h for h in heard if h.message.command == DO_REPOSITION]


def mode_changes(flight: Flight) -> list[Any]:
    sent = [m for m in flight.of("COMMAND_LONG") if m.command == DO_SET_MODE]
    return sent + flight.of("SET_MODE")


@pytest.mark.parametrize("name", [plan.name for plan in PLANS])
def test_it_ends_well(fleet: Fleet, name: str) -> None:
    fleet[name].assert_ended_well()


# ------------------------------------------------------------------------------------------------------------------ px4


def test_px4_is_sent_past_the_mast(fleet: Fleet) -> None:
    """DO_REPOSITION as COMMAND_INT with change of mode, to a place next to the mast at the aircraft's height."""
    first = orders(fleet[AVOIDS])[0].message
    assert first.get_type() == "COMMAND_INT" and (first.target_system, first.target_component) == (1, 1)
    assert int(first.param2) & 1
    north, east = local_m(first.x, first.y)
    assert abs(east) > MAST.width_m / 2 + MARGIN_M - 3.0
    assert 150.0 < north < 350.0
    over_sea = {0: 0.0, 5: 0.0, 3: ALT_M, 6: ALT_M}[first.frame]
    assert first.z + over_sea == pytest.approx(ALT_M + 30.0, abs=2.0)


def test_the_order_comes_in_time_and_not_at_once(fleet: Fleet) -> None:
    """At 20 m/s the mast is 12.5 s away. The order comes once little more time is left than the turn needs."""
    range_m = MAST.north_m - orders(fleet[AVOIDS])[0].north_m
    assert 60.0 < range_m < 240.0


def test_the_order_is_repeated_until_it_is_acknowledged(fleet: Fleet) -> None:
    """And not afterwards, as long as its target stays."""
    sent = orders(fleet[AVOIDS])
    assert len(sent) > IGNORED
    steps = [after.time_s - before.time_s for before, after in zip(sent[: IGNORED + 1], sent[1 : IGNORED + 1])]
    assert all(0.05 < step < 2.5 for step in steps), steps
    places = [local_m(h.message.x, h.message.y) for h in sent[IGNORED:]]
    assert all(math.dist(before, after) > 4.5 for before, after in zip(places, places[1:])), places


def test_the_aircraft_passes_clear(fleet: Fleet) -> None:
    """By a good part of the margin: the aircraft flies to the target and no farther."""
    for name in (AVOIDS, STAYS):
        least = min(math.dist(heard.place, (250.0, 0.0)) for heard in fleet[name].autopilot.heard)
        assert least > MAST.width_m / 2 + 0.5 * MARGIN_M


def test_the_mode_is_restored(fleet: Fleet) -> None:
    """Behind the mast, and repeatedly if the autopilot does not answer at once."""
    pilot = fleet[AVOIDS].autopilot
    assert pilot.modes == [MODES[PX4], LOITER, MODES[PX4]]
    assert 1 < len(mode_changes(fleet[AVOIDS])) < 8


def test_the_hazard_reports_the_action(fleet: Fleet) -> None:
    """The target equals that of the order."""
    flight = fleet[AVOIDS]
    acting = [m for m in flight.of("GOE_HAZARD") if m.action]
    assert acting and all(m.action in (1, 2) and m.flags & 0x20 for m in acting)
    first = orders(flight)[0].message
    least = min(math.dist(local_m(m.target_lat, m.target_lon), local_m(first.x, first.y)) for m in acting)
    assert least < 5.0
    assert {status.action for status in flight.statuses()} >= {0, acting[0].action}


def test_without_resume_the_mode_stays(fleet: Fleet) -> None:
    flight = fleet[STAYS]
    assert orders(flight) and mode_changes(flight) == []
    assert flight.autopilot.modes == [MODES[PX4], LOITER]


@pytest.mark.parametrize("name", [OVERRULED, AT_ONCE])
def test_a_mode_that_the_pilot_chose_is_not_ended(fleet: Fleet, name: str) -> None:
    """The mode is restored only from the mode of the order, even if no heartbeat reported that."""
    flight = fleet[name]
    assert flight.autopilot.modes[:3] == [MODES[PX4], LOITER, POSITION]
    assert mode_changes(flight) == []


@pytest.mark.parametrize("name", [OVERRULED, AT_ONCE])
def test_a_mode_that_the_pilot_chose_is_not_overridden(fleet: Fleet, pilots: dict[str, Pilot], name: str) -> None:
    """Once the companion can know of it, it sends no order that changes the mode again."""
    since_s = pilots[name].since_s + 1.2
    assert [heard.time_s - since_s for heard in orders(fleet[name]) if heard.time_s > since_s] == []
    assert fleet[name].autopilot.modes == [MODES[PX4], LOITER, POSITION]


def test_what_cannot_be_assessed_ends_no_order(fleet: Fleet, blanks: list[Blank]) -> None:
    """It is reported as a pose that does not come: neither the detector nor the velocity is at fault."""
    autopilot, since_s = fleet[BLANK].autopilot, blanks[0].since_s
    during = [h for h in autopilot.heard if since_s + 0.2 < h.time_s < since_s + Blank.FOR_S]
    statuses = [h.message for h in during if h.message.get_type() == "GOE_STATUS"]
    assert statuses and all(status.action and status.alive == 1 | 4 for status in statuses)
    texts = [h.message.text for h in during if h.message.get_type() == "STATUSTEXT"]
    assert "GOE: no poses come" in texts and not [text for text in texts if "silent" in text or "contradicts" in text]


def test_after_a_restart_in_an_order_the_mode_comes_back(fleet: Fleet) -> None:
    """From the log of the killed companion; without a log the aircraft keeps loitering."""
    assert fleet[KILLED].autopilot.modes == [MODES[PX4], LOITER, MODES[PX4]]
    assert fleet[FORGETFUL].autopilot.modes == [MODES[PX4], LOITER]
    assert [m.text for m in fleet[KILLED].of("STATUSTEXT") if "restarted in an order" in m.text]


def log_rows(folder: Path) -> list[dict[str, str]]:
    with open(folder / "orders.csv", encoding="ascii") as file:
        return list(csv.DictReader(file))


def test_the_log_has_the_orders(fleet: Fleet) -> None:
    """With both clocks, the previous mode and the sent command."""
    log = fleet[KILLED].log
    rows = log_rows(log)
    assert [row["event"] for row in rows][:3] == ["order", "reposition", "acknowledged"]
    assert rows[0]["active"] == "0" and rows[0]["action_name"] in ("left", "right")  # the command is not sent yet
    assert {row["active"] for row in rows[1:]} == {"1"}
    assert {int(row["mode_before"]) for row in rows} == {MODES[PX4]}
    assert float(rows[0]["obstacle_n_m"]) == pytest.approx(MAST.north_m, abs=25.0)
    times = [int(row["unix_us"]) for row in rows]
    assert times == sorted(times) and times[0] > 1_700_000_000 * 1_000_000
    after = log_rows(log.with_name(log.name + "-2"))
    assert after[-1]["active"] == "0" and {"end", "resume"} & {row["event"] for row in after}


@pytest.mark.parametrize("name", [PAST, NO_TRAFFIC])
def test_a_mast_aside_is_passed(fleet: Fleet, name: str) -> None:
    flight = fleet[name]
    assert flight.of("GOE_OBSTACLE")
    assert flight.autopilot.commands() == [] and flight.of("ADSB_VEHICLE") == []


@pytest.mark.parametrize("name", [LANDING, LANDING_PLANE])
def test_on_approach_it_goes_around(fleet: Fleet, name: str) -> None:
    """A climb over the obstacle is used once the autopilot reports that it lands."""
    sent = fleet[name].autopilot.commands()
    assert [m.command for m in sent if m.get_type().startswith("COMMAND")][:1] == [DO_GO_AROUND]
    assert orders(fleet[name]) == []


@pytest.mark.parametrize("name", [LANDING, LANDING_PLANE])
def test_the_go_around_carries_its_height(fleet: Fleet, name: str) -> None:
    """Above home: the mast's top, its uncertainty and the clearance of 10 m."""
    sent = [m for m in fleet[name].autopilot.commands() if m.command == DO_GO_AROUND]
    assert LOW.height_m + 9.0 < sent[0].param1 < LOW.height_m + 40.0


# ------------------------------------------------------------------------------------------------------------ arduplane


def ahead(flight: Flight) -> list[Heard]:
    return [h for h in flight.autopilot.heard_of("ADSB_VEHICLE") if h.north_m < 240.0]


@pytest.mark.parametrize("name", [TRAFFIC, LOW_TRAFFIC])
def test_the_mast_is_stationary_traffic(fleet: Fleet, name: str) -> None:
    """A point obstacle without a velocity, at the position of the mast."""
    sent = ahead(fleet[name])
    assert len(sent) >= 4
    for heard in sent:
        message = heard.message
        assert message.emitter_type == 19
        assert (message.hor_velocity, message.ver_velocity) == (0, 0)
        north, east = local_m(message.lat, message.lon)
        assert math.hypot(north - 250.0, east) < max(0.12 * (250.0 - heard.north_m), 4.0)
        assert message.flags & 3 == 3  # coordinates and altitude are valid
        assert message.tslc <= 2


def test_traffic_is_sent_at_its_rate(fleet: Fleet) -> None:
    """adsb_hz, by default 2, checked when the hazard is."""
    times = [heard.time_s for heard in ahead(fleet[TRAFFIC])]
    steps = [after - before for before, after in zip(times, times[1:])]
    assert 0.4 < statistics.median(steps) < 0.7 and min(steps) > 0.35, steps


def test_a_high_mast_lies_just_below_the_aircraft(fleet: Fleet) -> None:
    """min(top, own - 1 m): here the aircraft's own height."""
    for heard in ahead(fleet[TRAFFIC]):
        assert 1e-3 * heard.message.altitude == pytest.approx(ALT_M + 29.0, abs=0.5)


def test_a_low_mast_lies_at_its_top(fleet: Fleet) -> None:
    near = [heard for heard in ahead(fleet[LOW_TRAFFIC]) if heard.north_m > 120.0]
    assert near
    for heard in near:
        assert 1e-3 * heard.message.altitude == pytest.approx(ALT_M + LOW.height_m, abs=3.0)


def test_traffic_has_the_configured_address(fleet: Fleet) -> None:
    """The first obstacle has the address of `icao`."""
    assert {heard.message.ICAO_address for heard in ahead(fleet[TRAFFIC])} == {ICAO}
    assert {heard.message.ICAO_address for heard in ahead(fleet[LOW_TRAFFIC])} == {0xF0E000}


def test_traffic_ends_behind_the_mast(fleet: Fleet) -> None:
    """The mast is passed at 250 m, and soon after is behind by its radius and the margin."""
    for name in (TRAFFIC, LOW_TRAFFIC):
        flight = fleet[name]
        assert max(h.north_m for h in flight.autopilot.heard) > 320.0
        assert max(h.north_m for h in flight.autopilot.heard_of("ADSB_VEHICLE")) < 310.0


@pytest.mark.parametrize("name", [TRAFFIC, LOW_TRAFFIC])
def test_arduplane_is_given_no_order(fleet: Fleet, name: str) -> None:
    """Its own avoidance turns the aircraft away."""
    assert fleet[name].autopilot.commands() == []


def test_a_pilot_who_ends_the_avoidance_gets_no_more_traffic(fleet: Fleet, avoidances: dict[str, Avoidance]) -> None:
    """Once two heartbeats have shown the pilot's mode."""
    since_s = avoidances[PILOT_OUT].since_s
    times = [heard.time_s for heard in fleet[PILOT_OUT].autopilot.heard_of("ADSB_VEHICLE")]
    assert since_s < math.inf and max(times) < since_s + 2.3
    assert any("pilot" in message.text for message in fleet[PILOT_OUT].of("STATUSTEXT"))


def test_an_avoidance_that_ends_by_itself_gets_more_traffic(fleet: Fleet, avoidances: dict[str, Avoidance]) -> None:
    since_s = avoidances[BY_ITSELF].since_s
    times = [heard.time_s for heard in fleet[BY_ITSELF].autopilot.heard_of("ADSB_VEHICLE")]
    assert since_s < math.inf and len([time for time in times if time > since_s + 2.5]) > 3
