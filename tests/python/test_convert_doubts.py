"""Contradictions in an autopilot's log that ``convert`` warns of: velocity against position, height against the
distance sensor, attitude against motion."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from autopilot_logs import Fault, Flown, ulog_topics, write_detections, write_ulog
from goe_tools.__main__ import main

pytest.importorskip("pyulog", reason="pyulog is not installed (tools/setup.sh)")

FLOWN = Flown()
FOOT = 0.3048
Change = Callable[[np.ndarray], np.ndarray]
PLACE, SPEED, HEIGHT = ("x", "y", "z"), ("vx", "vy", "vz"), ("dist_bottom",)


def warnings_of(folder: Path, capsys: pytest.CaptureFixture[str], changes: dict[str, Change], *more: str,
                flown: Flown = FLOWN) -> list[str]:  # fmt: skip
    """Converts a PX4 log with changed fields of position and attitude; returns the warnings."""
    topics = ulog_topics(flown)
    for name in ("vehicle_local_position", "vehicle_attitude"):
        topics[name] = [(kind, field, changes.get(field, lambda x: x)(v)) for kind, field, v in topics[name]]
    log = write_ulog(folder / "a.ulg", topics)
    table, camera = write_detections(folder, flown, 0.0)
    words = ["--detections", str(table), "--camera", str(camera), "--out", str(folder / "log"), "--offset", "0"]
    assert main(["convert", "--ulog", str(log), *words, *more]) == 0
    lines = capsys.readouterr().err.splitlines()
    assert all(line.startswith(f"warning: {log}: ") for line in lines)
    return lines


def times(factor: float, *names: str) -> dict[str, Change]:
    return {name: lambda x: factor * x for name in names}


VELOCITIES: list[tuple[dict[str, Change], str]] = [
    (times(1.0 / FOOT, *SPEED), "is the velocity in feet?"),
    (times(100.0, *SPEED), "is the velocity in centimeters?"),
    (times(0.0, *SPEED), "is the velocity 0, or in another unit?"),
    (times(-1.0, "vx"), "is the sign of north wrong in one of them?"),
]


@pytest.mark.parametrize(("changes", "cause"), VELOCITIES)
def test_a_velocity_against_the_position(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], changes: dict[str, Change], cause: str
) -> None:
    (line,) = warnings_of(tmp_path, capsys, changes)
    assert ": from 20.000 s the position moves by +17.0, +0.3, +0.0 m (north, east, down) in 1 s, and " in line
    assert "such differences in 100 % of the time: " in line and line.endswith(cause)


def test_north_and_east_of_the_velocity_exchanged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    t = FLOWN.grid(FLOWN.rate_hz)
    north, east = FLOWN.velocity(t)[:, 0], FLOWN.velocity(t)[:, 1]
    (line,) = warnings_of(tmp_path, capsys, {"vx": lambda x: east, "vy": lambda x: north})
    assert line.endswith("are north and east exchanged in one of them?")


def test_resets_are_no_contradiction(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Neither those with a counter nor those without."""
    flown = Flown(faults=[Fault(25.34, (20.0, 0.0, -8.0))])
    assert warnings_of(tmp_path, capsys, {}, flown=flown) == []
    still = {"xy_reset_counter": lambda x: 0 * x, "z_reset_counter": lambda x: 0 * x}
    assert warnings_of(tmp_path, capsys, still, flown=flown) == []


HEIGHTS: list[tuple[dict[str, Change], str, str]] = [
    (times(1.0 / FOOT, "z"), "6", "is one of them in feet?"),
    ({"z": lambda x: x - 488.0}, "508", "then give --ground -486.0"),
    (times(-1.0, "z", "vz"), "-", "is the position's z up?"),
]


@pytest.mark.parametrize(("changes", "height", "cause"), HEIGHTS)
def test_a_height_against_the_distance_sensor(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], changes: dict[str, Change], height: str, cause: str
) -> None:
    """The sensor measures 22 m, above a ground 2 m below the origin."""
    (line,) = warnings_of(tmp_path, capsys, changes)
    assert "dist_bottom measures 22." in line or "dist_bottom measures 21." in line
    assert f"the height above the ground at d = 0 m is {height}" in line and line.endswith(cause)
    assert warnings_of(tmp_path, capsys, changes, "--height", "sensor") == []


def test_the_ground_that_the_warning_names_ends_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert warnings_of(tmp_path, capsys, {"z": lambda x: x - 488.0}, "--ground", "-486") == []


def test_a_flight_below_the_ground_without_a_sensor(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    changes = {**times(-1.0, "z", "vz"), "dist_bottom_valid": lambda x: 0 * x}
    (line,) = warnings_of(tmp_path, capsys, changes)
    assert "the aircraft is below the ground at d = 0 m, by 20.3 m at " in line and "is the position's z up" in line


def test_a_hill_is_no_contradiction(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert warnings_of(tmp_path, capsys, {"dist_bottom": lambda x: x + 15.0}) == []


def test_the_order_of_the_quaternion_is_hinted_at(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (line,) = warnings_of(tmp_path, capsys, {"q": lambda q: q[:, [1, 2, 3, 0]]})
    assert "does if the quaternion is in the order x, y, z, w" in line
