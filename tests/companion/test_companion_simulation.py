"""The simulated autopilot and camera themselves, on which the other tests rely."""

from __future__ import annotations

import json
import math
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from autopilot import ALT_M, DO_REPOSITION, LAT_E7, LON_E7, Aircraft, Autopilot, Clock, Pose, local_m, quaternion
from camera import AGE, MAST, Box, Camera, Image, Obstacle, aliases, bare_list, features, plain_line, rotation
from links import Faults, UdpWire
from loop import Loop

CAMERA = Camera()
LEVEL = Pose((0.0, 0.0, -30.0), (20.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def rolled(degrees: float) -> Pose:
    return Pose(LEVEL.position, LEVEL.velocity, (math.radians(degrees), 0.0, 0.0), LEVEL.rates)


def test_level_camera_sees_a_mast_where_the_hand_puts_it() -> None:
    """Middle (640, 360), focal length 800: the nearest points of base and top are at 246 m, the flanks at 250 m."""
    box = CAMERA.see(LEVEL, MAST, 7)
    assert box and box.id == 7
    assert box.left == pytest.approx(640 - 800 * 4 / math.sqrt(250**2 - 16), abs=0.01)
    assert box.right == pytest.approx(640 + 800 * 4 / math.sqrt(250**2 - 16), abs=0.01)
    assert box.bottom == pytest.approx(360 + 800 * 30 / 246, abs=1e-6)
    assert box.top == pytest.approx(360 - 800 * 10 / 246, abs=1e-6)


def test_a_turned_box_shows_its_corners() -> None:
    """Its length axis points east: 20 m of front, 10 m deep, its front at 195 m."""
    box = CAMERA.see(LEVEL, Obstacle(200.0, 0.0, 10.0, 30.0, 20.0, 90.0), 1)
    assert box
    assert (box.left, box.right) == pytest.approx((640 - 800 * 10 / 195, 640 + 800 * 10 / 195))
    assert (box.top, box.bottom) == pytest.approx((360, 360 + 800 * 30 / 195))


def test_right_wing_down_lifts_the_right_side_of_the_image() -> None:
    """Rolled by 90 degrees to the right, the ground is on the image's left, and the former right is at the top."""
    pixels = CAMERA.project(rolled(90.0), np.array([[100.0, 0.0, 0.0], [100.0, 10.0, -30.0]]))
    assert pixels is not None
    assert pixels[0] == pytest.approx([640 + 800 * 0.3, 360], abs=1e-6)
    assert pixels[1] == pytest.approx([640, 360 - 800 * 0.1], abs=1e-6)


def test_a_cut_box_ends_at_the_border_of_the_image() -> None:
    box = CAMERA.see(Pose((200.0, 0.0, -30.0), *(LEVEL.velocity, LEVEL.angles, LEVEL.rates)), MAST, 1)
    assert box and box.bottom == 719.0 and 0.0 < box.top < 360.0


@pytest.mark.parametrize("north_m", [249.0, 260.0])
def test_an_obstacle_that_is_not_ahead_is_not_visible(north_m: float) -> None:
    assert CAMERA.see(Pose((north_m, 0.0, -30.0), *(LEVEL.velocity, LEVEL.angles, LEVEL.rates)), MAST, 1) is None


def test_attitude_turns_body_to_earth() -> None:
    nose_east = rotation(quaternion(0.0, 0.0, math.pi / 2))
    assert nose_east @ [1, 0, 0] == pytest.approx([0, 1, 0], abs=1e-12)
    nose_up = rotation(quaternion(0.0, math.pi / 2, 0.0))
    assert nose_up @ [1, 0, 0] == pytest.approx([0, 0, -1], abs=1e-12)
    right_down = rotation(quaternion(math.pi / 2, 0.0, 0.0))
    assert right_down @ [0, 1, 0] == pytest.approx([0, 0, 1], abs=1e-12)


def test_the_aircraft_flies_north_and_rolls() -> None:
    aircraft = Aircraft(time_s=100.0)
    pose = aircraft.advance(105.0)
    assert pose.position == pytest.approx((100.0, 0.0, -30.0))
    assert abs(math.degrees(pose.angles[0])) <= 3.0


@pytest.mark.parametrize("time_s", [0.3, 1.5])
def test_the_rates_are_those_of_the_angles(time_s: float) -> None:
    """While it rolls into a turn, and in the turn."""
    aircraft = Aircraft(time_s=0.0, goal=(300.0, 300.0))
    before, after = aircraft.advance(time_s), aircraft.advance(time_s + 0.001)
    assert (after.angles[0] - before.angles[0]) / 0.001 == pytest.approx(after.rates[0], abs=0.01)
    turn = (after.angles[2] - before.angles[2]) / 0.001
    assert math.hypot(*after.rates[1:]) == pytest.approx(turn, abs=0.01)
    assert turn == pytest.approx(9.81 * math.tan(aircraft.bank) / 20.0, abs=0.01)


def test_the_aircraft_turns_towards_its_goal() -> None:
    aircraft = Aircraft(time_s=0.0, goal=(200.0, 100.0))
    least = min(math.dist(aircraft.advance(0.02 * k).position[:2], (200.0, 100.0)) for k in range(800))
    assert least < 2.0


def test_clock() -> None:
    loop = Loop()
    clock = Clock(loop, 1000.0, drift=1e-3)
    assert clock.at(clock.begin_s + 10.0) == pytest.approx(1010.01)
    clock.jump(3.0)
    assert clock.at(clock.begin_s) == pytest.approx(1003.0)
    clock.restart()
    assert clock.at(loop.now_s) == 0.0


def test_latitude_and_longitude_of_the_origin() -> None:
    assert local_m(LAT_E7, LON_E7) == (0.0, 0.0)
    assert local_m(LAT_E7 + 10000, LON_E7)[0] == pytest.approx(111.32, abs=0.01)


def test_faults_lose_and_double_as_configured() -> None:
    faults = Faults(lost=0.2, doubled=0.5, delay_s=0.03)
    copies = [faults.copies() for _ in range(4000)]
    assert sum(not copy for copy in copies) == pytest.approx(800, abs=100)
    assert sum(len(copy) == 2 for copy in copies) == pytest.approx(1600, abs=120)
    assert all(0.0 <= delay <= 0.03 for copy in copies for delay in copy)


# --------------------------------------------------------------------------------------------------- sent messages


def image() -> Image:
    return Image(5000.0, 1.79e9, 77.5, (Box(3, 600.5, 300.0, 650.25, 500.0),), age_s=0.25)


def test_lines() -> None:
    plain = json.loads(plain_line(image(), "age"))
    assert plain["clock"] == "age" and plain["time"] == 0.25
    assert plain["detections"] == [{"id": 3, "score": 0.9, "box": [600.5, 300.0, 650.25, 500.0]}]
    assert "time" not in json.loads(plain_line(image(), None))
    assert json.loads(bare_list(image()))[0]["box"] == {"x1": 600.5, "y1": 300.0, "x2": 650.25, "y2": 500.0}
    named = json.loads(aliases(image(), "autopilot"))
    assert named["time"] == 77.5 and named["detections"][0]["track_id"] == 3
    for line in (plain_line(image(), "unix"), aliases(image(), "unix")):
        assert line.endswith("\n") and line.count("\n") == 1


def test_features_are_tenths_from_the_middle(dialect: ModuleType) -> None:
    times = {"time_usec": 0, "age_usec": 250000, "time_base": AGE}
    message = features(dialect, CAMERA, image().boxes[0], 1, times)
    sent = dialect.MAVLink(None).parse_buffer(message.pack(dialect.MAVLink(None)))[0]
    assert list(sent.box) == [-395, -600, round(10 * 10.25), 1400]
    assert (sent.visible, sent.number, sent.time_base, sent.age_usec) == (0xF, 1, 2, 250000)
    assert features(dialect, CAMERA, None, 0, times).visible == 0


@pytest.fixture(name="autopilot")
def one_autopilot(dialect: ModuleType) -> Any:
    loop = Loop()
    autopilot = Autopilot(loop, dialect, ignored={DO_REPOSITION: 1})
    sent: list[bytes] = []
    autopilot.wire.send = sent.append  # type: ignore[method-assign]
    yield loop, autopilot, sent
    autopilot.close()
    loop.close()


def parsed(dialect: ModuleType, sent: list[bytes]) -> list[Any]:
    return dialect.MAVLink(None).parse_buffer(b"".join(sent)) or []


def test_the_autopilot_sends_poses_and_who_it_is(autopilot: Any, dialect: ModuleType) -> None:
    loop, _, sent = autopilot
    loop.run(0.5)
    names = [message.get_type() for message in parsed(dialect, sent)]
    assert names.count("ATTITUDE_QUATERNION") == names.count("LOCAL_POSITION_NED") == pytest.approx(25, abs=5)
    numbers = [message.get_seq() for message in parsed(dialect, sent)]
    assert numbers == list(range(len(numbers)))
    assert {"HEARTBEAT", "GPS_GLOBAL_ORIGIN", "HOME_POSITION", "TIMESYNC"} <= set(names)


def test_the_autopilot_answers_for_its_clock(autopilot: Any, dialect: ModuleType) -> None:
    _, simulated, sent = autopilot
    simulated._receive(dialect.MAVLink_timesync_message(0, 12345).pack(dialect.MAVLink(None)))
    (answer,) = parsed(dialect, sent)
    assert answer.ts1 == 12345 and answer.tc1 == pytest.approx(simulated.boot_s() * 1e9, abs=1e8)


def test_the_autopilot_obeys_the_second_time(autopilot: Any, dialect: ModuleType) -> None:
    _, simulated, sent = autopilot
    order = dialect.MAVLink_command_int_message(
        1, 1, 0, 192, 0, 0, -1.0, 1.0, 0.0, math.nan, LAT_E7 + 10000, LON_E7, ALT_M + 30.0
    ).pack(dialect.MAVLink(None))
    simulated._receive(order)
    assert not sent and simulated.aircraft.goal is None
    simulated._receive(order)
    assert [message.get_type() for message in parsed(dialect, sent)] == ["COMMAND_ACK"]
    assert simulated.aircraft.goal == pytest.approx((111.3, 0.0), abs=0.1) and len(simulated.modes) == 2


def test_a_wire_bears_that_nobody_listens() -> None:
    loop, got = Loop(), []
    wire = UdpWire(loop, got.append)
    for _ in range(3):
        wire.send(b"x")
        loop.run(0.01)
    assert got == []
    wire.close()
    loop.close()
