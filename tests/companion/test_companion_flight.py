"""Undisturbed flights towards a mast, one for each way of sending poses and detections, all simultaneous."""

from __future__ import annotations

import csv
import math
import re
import statistics
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from autopilot import ALT_M, ARDUPILOT, ASKING, SET_MESSAGE_INTERVAL, local_m
from camera import (
    AGE,
    AUTOPILOT,
    MAST,
    SENDER,
    Obstacle,
    aliases,
    as_printed,
    bare_list,
    of_class,
    of_second_camera,
    points,
    without_clock,
    without_ids,
)
from companion import PROGRAM, ROOT, is_missing, replay
from flights import Fleet, Flight, MakeFleet, Plan

NEAR = 0.35  # three sigmas of the range, about 12 % at 100 m
pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

FLIGHT_S = 12.8  # the mast is reached at 12.5
WRAP_S = 2.0**32 * 1e-6  # the autopilot's 32-bit microseconds wrap here
ALL = "obstacle_distance obstacle_distance_3d collision target_absolute"
TWO = (MAST, Obstacle(280.0, 70.0, 10.0, 35.0))
PLANS = [
    Plan("unix"),
    Plan("monotonic", clock="monotonic"),
    Plan("age", clock="age"),
    Plan("autopilot", clock="autopilot"),
    Plan("configured", clock="monotonic", line=without_clock, settings={"detections": {"clock": "monotonic"}}),
    Plan("features of the autopilot's time", source=AUTOPILOT),
    Plan("features of the sender's time", source=SENDER),
    Plan("features with their age", source=AGE, obstacles=TWO),
    Plan("aliases", line=aliases, settings={"detections": {"classes": "car mast"}}),
    Plan("bare list", line=bare_list, settings={"detections": {"delay_s": 0.1, "classes": "mast"}}),
    Plan("as printed", source="stdin", line=as_printed, settings={"detections": {"delay_s": 0.1}}),
    Plan("fifo", source="fifo"),
    Plan("stdin", source="stdin", autopilot={"make": ARDUPILOT}),
    Plan("udpout", link="udpout"),
    Plan("tcp", link="tcp"),
    Plan("serial", link="serial"),
    Plan("drift and wrap", autopilot={"boot_s": WRAP_S - 6.0, "drift": 2e-4}, recorded=True),
    Plan("standard", settings={"reports": {"standard": ALL}}),
]
PLANS += [
    Plan("no ids", line=without_ids, obstacles=TWO, recorded=True),
    Plan("second camera", line=of_second_camera, cameras=2),
]
NAMES = [plan.name for plan in PLANS]
OTHERS = [
    Plan("points", line=points),
    Plan("house", line=of_class, recorded=True),
    Plan("other class", line=aliases, settings={"detections": {"classes": "car tree"}}),
]


@pytest.fixture(scope="module", name="fleet")
def flown(make_fleet: MakeFleet) -> Iterator[Fleet]:
    fleet = make_fleet([*PLANS, *OTHERS, Plan("recorded", recorded=True)])
    fleet.start()
    fleet.run(FLIGHT_S)
    fleet.stop()
    yield fleet


@pytest.fixture(name="plain")
def plain_flight(fleet: Fleet) -> Flight:
    return fleet["unix"]


@pytest.mark.parametrize("name", NAMES)
def test_the_mast_is_found(fleet: Fleet, name: str) -> None:
    """For each way of sending poses and detections the error is within the reported sigmas."""
    fleet[name].assert_found()


@pytest.mark.parametrize("name", NAMES)
def test_the_hazard_rises(fleet: Fleet, name: str) -> None:
    """On a course towards the mast the probability becomes high in time, and the time to it counts down."""
    worst = [hazard for hazard in fleet[name].of("GOE_HAZARD") if hazard.flags & 8]
    ahead = [hazard for hazard in worst if hazard.tcpa > 1.0]
    assert len(ahead) >= 10
    assert max(hazard.conflict_probability for hazard in ahead[-5:]) > 0.95
    assert ahead[-1].conflict_probability >= ahead[0].conflict_probability
    assert ahead[-1].tcpa < 4.0 < ahead[0].tcpa


@pytest.mark.parametrize("name", [*NAMES, *(plan.name for plan in OTHERS)])
def test_the_status_comes_once_a_second(fleet: Fleet, name: str) -> None:
    flight = fleet[name]
    times = [heard.time_s for heard in flight.autopilot.heard_of("GOE_STATUS")]
    waited = 2.0 if flight.plan.link in ("udpout", "tcp") else 0.0
    assert FLIGHT_S - 2.5 - waited <= len(times) <= FLIGHT_S + 2.0
    steps = [after - before for before, after in zip(times, times[1:])]
    assert steps and max(abs(step - 1.0) for step in steps) < 0.3, steps


@pytest.mark.parametrize("name", NAMES)
def test_the_status_reports_the_inputs(fleet: Fleet, name: str) -> None:
    statuses = fleet[name].statuses()
    middle, last = statuses[len(statuses) // 2], statuses[-1]
    assert middle.alive == 7 and middle.self_check == 0 and middle.obstacles == len(fleet[name].plan.obstacles)
    assert last.taken > 80 and last.taken > middle.taken > 0
    counters = ("refused", "weak", "evicted", "full", "resets", "lost")
    assert {key: getattr(last, key) for key in counters} == dict.fromkeys(counters, 0)
    assert last.late <= 6  # the first were taken before there was a pose


@pytest.mark.parametrize("name", [*NAMES, *(plan.name for plan in OTHERS), "recorded"])
def test_an_interrupt_ends_it_with_a_summary(fleet: Fleet, name: str) -> None:
    fleet[name].assert_ended_well()
    assert fleet[name].ended and fleet[name].ended.out.strip()


@pytest.mark.parametrize("name", NAMES)
def test_no_command_is_sent_unless_allowed(fleet: Fleet, name: str) -> None:
    """reaction.mode is off by default: with a collision ahead the companion sends no command."""
    assert fleet[name].autopilot.commands() == []
    assert fleet[name].of("ADSB_VEHICLE") == []


# ---------------------------------------------------------------------------------------------------------------- time


@pytest.mark.parametrize(
    "name", [name for name in NAMES if name not in ("age", "bare list", "as printed", "features with their age")]
)
def test_the_delay_is_the_real_one(fleet: Fleet, name: str) -> None:
    """The companion determines the autopilot's clock, so the ages of exposures are right."""
    flight = fleet[name]
    reported = [status.delay_mean for status in flight.statuses()[3:] if status.delay_mean != 65535]
    assert len(reported) >= 5
    real_ms = 1e3 * statistics.median(flight.detector.delays)
    assert statistics.median(reported) == pytest.approx(real_ms, abs=15.0)
    assert statistics.median(status.delay_max for status in flight.statuses()[3:]) < real_ms + 60.0


def test_without_a_time_the_delay_is_the_configured_one(fleet: Fleet) -> None:
    reported = [status.delay_mean for status in fleet["bare list"].statuses()[3:]]
    assert reported and statistics.median(reported) == pytest.approx(100.0, abs=10.0)


def test_it_requests_the_clock_four_times_a_second(plain: Flight) -> None:
    requested = [message for message in plain.of("TIMESYNC") if message.tc1 == 0]
    assert len(requested) == pytest.approx(4 * FLIGHT_S, abs=12)
    assert len({message.ts1 for message in requested}) == len(requested)


@pytest.mark.parametrize("name", ["unix", "tcp", "serial", "stdin"])
def test_it_answers_the_autopilots_questions(fleet: Fleet, name: str) -> None:
    """Each once, with the time in the question and a time of its own steady clock."""
    autopilot = fleet[name].autopilot
    assert set(autopilot.answers) <= set(autopilot.questions)
    assert len(autopilot.answers) >= len(autopilot.questions) - 3
    assert set(autopilot.answers.values()) == {1}
    times = [message.tc1 for message in fleet[name].of("TIMESYNC") if message.tc1 != 0]
    steps = [1e-9 * (after - before) for before, after in zip(times, times[1:])]
    assert statistics.median(steps) == pytest.approx(1.0, abs=0.1)


# ------------------------------------------------------------------------------------------------------- sent messages


def test_who_it_is(plain: Flight) -> None:
    """System of the autopilot, component 196, one heartbeat a second."""
    assert {(m.get_srcSystem(), m.get_srcComponent()) for m in (heard.message for heard in plain.autopilot.heard)} == {
        (1, 196)
    }
    assert len(plain.of("HEARTBEAT")) == pytest.approx(FLIGHT_S, abs=2.5)
    assert plain.of("HEARTBEAT")[0].autopilot == 8  # MAV_AUTOPILOT_INVALID: it is none


def test_its_frames_are_numbered(plain: Flight) -> None:
    """The receiver can count its losses."""
    numbers = [heard.message.get_seq() for heard in plain.autopilot.heard]
    assert all((after - before) % 256 == 1 for before, after in zip(numbers, numbers[1:]))


def test_it_requests_its_rates(plain: Flight) -> None:
    requested = {m.param1: m.param2 for m in plain.of("COMMAND_LONG") if m.command == SET_MESSAGE_INTERVAL}
    for message in (31, 32):  # ATTITUDE_QUATERNION, LOCAL_POSITION_NED
        assert requested[message] == pytest.approx(40000.0)
    assert len([m for m in plain.of("COMMAND_LONG") if m.command in ASKING]) < 60


def test_obstacles_come_as_often_as_configured(plain: Flight) -> None:
    """5 Hz."""
    times = [heard.time_s for heard in plain.autopilot.heard_of("GOE_OBSTACLE")]
    steps = [after - before for before, after in zip(times, times[1:])]
    assert statistics.median(steps) == pytest.approx(0.2, abs=0.03)


def test_content_of_an_obstacle_message(plain: Flight) -> None:
    """Position with latitude and longitude, size, and the flag that it is in view."""
    reported = [heard.message for heard in plain.autopilot.heard_of("GOE_OBSTACLE") if 100 < 250 - heard.north_m < 180]
    assert reported
    for message in reported:
        assert local_m(message.lat, message.lon) == pytest.approx((message.north, message.east), abs=0.5)
        assert message.ground_down == pytest.approx(0.0, abs=1.0)
        assert abs(message.height - MAST.height_m) < 3.0 * message.height_sd
        assert 0.0 <= message.age < 1.0 and message.id == 1
        assert message.flags & 4 and not message.flags & 2
    assert len({message.slot for message in reported}) == 1


def test_times_are_of_the_autopilots_clock(fleet: Fleet) -> None:
    """It does not wrap in 64 bits, where 32 bits do."""
    for name in ("unix", "drift and wrap"):
        flight = fleet[name]
        clock = flight.autopilot.clock
        for heard in flight.autopilot.heard_of("GOE_HAZARD"):
            assert 1e-6 * heard.message.time_usec == pytest.approx(clock.at(heard.time_s), abs=1.0)
        for heard in flight.autopilot.heard_of("GOE_STATUS")[2:]:
            assert 1e-3 * heard.message.time_boot_ms == pytest.approx(clock.at(heard.time_s), abs=1.0)


def test_only_wanted_classes_are_taken(fleet: Fleet) -> None:
    """The detector counts as alive nevertheless."""
    flight = fleet["other class"]
    assert flight.of("GOE_OBSTACLE") == []
    assert flight.statuses()[-2].alive == 7


def test_points_are_taken(fleet: Fleet) -> None:
    last = fleet["points"].statuses()[-1]
    assert last.taken > 80 and last.refused == 0 and last.alive == 7


# --------------------------------------------------------------------------------------------------- standard messages


def near(flight: Flight, name: str) -> list[Any]:
    """(message, range) while the mast is known and ahead."""
    heard = [(heard.message, 250.0 - heard.north_m) for heard in flight.autopilot.heard_of(name)]
    return [(message, range_m) for message, range_m in heard if 60.0 < range_m < 150.0]


def test_standard_messages_only_where_named(plain: Flight) -> None:
    for name in ("OBSTACLE_DISTANCE", "OBSTACLE_DISTANCE_3D", "COLLISION", "TARGET_ABSOLUTE"):
        assert plain.of(name) == []


def test_obstacle_distance(fleet: Fleet) -> None:
    """Sectors of 5 degrees, the first one north: the mast is in the sector ahead, the sectors behind are unknown.

    The body frame is turned back by the heading, which is 0, because ArduPilot takes any message as one in the body
    frame.
    """
    reported = near(fleet["standard"], "OBSTACLE_DISTANCE")
    assert reported
    for message, range_m in reported:
        assert message.frame == 12 and message.angle_offset == pytest.approx(0.0, abs=0.5)
        assert 5 in (message.increment, message.increment_f)
        assert 0.01 * message.distances[0] == pytest.approx(range_m - 4.0, rel=NEAR)
        assert message.distances[36] == 65535
        assert message.distances[4] == message.max_distance + 1  # visible, and clear


def test_obstacle_distance_3d(fleet: Fleet) -> None:
    """Body frame: ahead."""
    reported = near(fleet["standard"], "OBSTACLE_DISTANCE_3D")
    assert reported
    for message, range_m in reported:
        assert message.x == pytest.approx(range_m - 4.0, rel=NEAR) and abs(message.y) < 0.1 * range_m


def test_collision(fleet: Fleet) -> None:
    reported = near(fleet["standard"], "COLLISION")
    assert reported
    for message, range_m in reported:
        assert message.threat_level == 2
        assert message.time_to_minimum_delta == pytest.approx(range_m / 20.0, rel=NEAR)


def test_target_absolute(fleet: Fleet) -> None:
    reported = near(fleet["standard"], "TARGET_ABSOLUTE")
    assert reported
    for message, range_m in reported:
        north, east = local_m(message.lat, message.lon)
        assert math.hypot(north - MAST.north_m, east - MAST.east_m) < 0.12 * range_m
        assert message.alt == pytest.approx(ALT_M, abs=3.0)


# -------------------------------------------------------------------------------------------------------------- record


@pytest.fixture(name="log")
def recorded_log(fleet: Fleet) -> Path:
    return fleet["recorded"].log


def rows_of(log: Path) -> list[dict[str, str]]:
    with open(log / "frames.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_the_log_contains_every_detection(fleet: Fleet, log: Path) -> None:
    assert {file.name for file in log.iterdir()} == {"camera.ini", "frames.csv", "orders.csv"}
    rows = rows_of(log)
    assert len(rows) > 0.9 * len(fleet["recorded"].detector.poses) - 5


def test_the_log_has_times_and_poses_of_the_exposure(fleet: Fleet, log: Path) -> None:
    """Against the truth: within a few ms of the exposure, by the autopilot's clock."""
    truth = fleet["recorded"].detector.poses
    times, places, rolls = [], [], []
    for row in rows_of(log)[20:]:
        boot_s = min(truth, key=lambda time_s: abs(time_s - float(row["t_s"])))
        times.append(abs(boot_s - float(row["t_s"])))
        places.append(abs(float(row["n_m"]) - truth[boot_s].position[0]))
        rolls.append(abs(2.0 * math.asin(float(row["qx"])) - truth[boot_s].angles[0]))
    assert statistics.median(times) < 0.004 and max(times) < 0.02
    assert statistics.median(places) < 0.15 and max(places) < 0.5
    assert statistics.median(rolls) < math.radians(0.1) and max(rolls) < math.radians(0.6)


@pytest.mark.parametrize("name", ["recorded", "no ids", "drift and wrap"])
def test_the_log_is_replayed(fleet: Fleet, name: str) -> None:
    """goe_replay accepts it unchanged and finds the mast, also without ids and where 32 bits of time wrap."""
    found = [row for row in replay(fleet[name].log) if row["status"] == "ok"]
    places = [(float(row["center_n_m"]), float(row["center_e_m"])) for row in found]
    assert min(math.dist(place, (MAST.north_m, MAST.east_m)) for place in places[-40:]) < 10.0


def test_the_log_has_the_size_of_the_class(fleet: Fleet) -> None:
    """goe_replay accepts it. A class without a size is counted."""
    columns = ("kind_width_m", "kind_width_sd_m", "kind_height_m", "kind_height_sd_m", "kind_shape")
    for name, kind in (("house", ("13", "4.0414", "8", "2.3094", "2")), ("recorded", ("", "", "", "", "0"))):
        rows = rows_of(fleet[name].log)
        assert {tuple(row[column][:6] for column in columns) for row in rows} == {kind}
    assert len(replay(fleet["house"].log)) == len(rows_of(fleet["house"].log))
    assert fleet["aliases"].ended.count("classes_unknown") > 50
    assert fleet["house"].ended.count("classes_unknown") == fleet["unix"].ended.count("classes_unknown") == 0


def status_line(flight: Flight) -> str:
    assert flight.ended
    (line,) = [line for line in flight.ended.said.splitlines() if "| obstacles" in line]
    return line


def test_images_are_counted_and_not_their_messages(fleet: Fleet) -> None:
    """Two obstacles are two GOE_FEATURES of one image: 10 Hz."""
    assert re.search(r"images (9|10|11) Hz", status_line(fleet["features with their age"]))


def test_the_status_line(fleet: Fleet) -> None:
    """Every ten seconds if there is no terminal."""
    for name in ("unix", "stdin"):
        line = status_line(fleet[name])
        for reported in (
            ("PX4" if name == "unix" else "ArduP"),
            r"pose 5\d Hz|pose 4\d Hz",
            r"clock \d+\.\d+ ms",
            r"images (9|10|11) Hz 1\d\d ms",
            r"obstacles 1  id 1: \d+ \+- \d+ m, \d+\.\d s, 100 %",
            r"lost \d",
        ):
            assert re.search(reported, line), (reported, line)


def test_changes_are_reported(fleet: Fleet) -> None:
    """On lines of their own; the first names the autopilot."""
    ended = fleet["stdin"].ended
    assert ended and re.search(r"ArduP\w+ found", ended.said)


def test_the_readme_has_every_key() -> None:
    """The README's table lists the sections of the example file."""
    folder = ROOT / "port" / "companion"
    example, readme = ((folder / name).read_text(encoding="utf-8") for name in ("companion.ini", "README.md"))
    sections = [line.strip("[]") for line in example.splitlines() if line.startswith("[")]
    assert sections and all(f"| `[{section}]` |" in readme for section in sections)
