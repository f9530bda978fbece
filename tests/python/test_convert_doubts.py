"""Contradictions in an autopilot's log that ``convert`` warns of: velocity against position, height against the
distance sensor, attitude against motion."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from autopilot_logs import Fault, Flown, ulog_topics, write_detections, write_ulog
from goe_tools.__main__ import main
from goe_tools.exchange import offset

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


ATTITUDES: list[tuple[Change, str]] = [
    (lambda q: q[:, [1, 2, 3, 0]], "is the quaternion in the order x, y, z, w?"),
    (lambda q: q * [1.0, -1.0, -1.0, -1.0], "is it the inverse quaternion?"),
    (lambda q: np.repeat(q[:1], len(q), 0), "is the attitude frozen, or are the rates in degrees?"),
]


@pytest.mark.parametrize(("change", "cause"), ATTITUDES)
def test_an_attitude_against_the_rates(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: Change, cause: str
) -> None:
    line, *more = warnings_of(tmp_path, capsys, {"q": change})
    assert "vehicle_attitude.q turns by " in line and "% of the turns: " in line and line.endswith(cause)
    assert len(more) == ("order" in cause)
    assert all("does if the quaternion is in the order x, y, z, w" in other for other in more)


# ------------------------------------------------------------------------------------------------ offset and detections

Rewrite = Callable[[list[float]], list[float]]  # t_s, then the four sides


def converted(folder: Path, capsys: pytest.CaptureFixture[str], rewrite: Rewrite, *more: str,
              changes: dict[str, Change] | None = None) -> tuple[int, str, str]:  # fmt: skip
    """Converts a table with changed rows, and a log with changed fields; returns status, output and messages."""
    topics = ulog_topics(FLOWN)
    for name in ("vehicle_local_position", "vehicle_attitude"):
        topics[name] = [(kind, field, (changes or {}).get(field, lambda x: x)(v)) for kind, field, v in topics[name]]
    log = write_ulog(folder / "a.ulg", topics)
    table, camera = write_detections(folder, FLOWN, 0.0)
    header, *rows = [line.split(",") for line in table.read_text().splitlines()]
    lines = [",".join(header)]
    for row in rows:
        t_s, *sides = rewrite([float(row[0]), *map(float, row[2:6])])
        lines.append(",".join([repr(t_s), row[1], *map(repr, sides), row[6]]))
    table.write_text("\n".join(lines) + "\n")
    words = ["--detections", str(table), "--camera", str(camera), "--out", str(folder / "log")]
    status = main(["convert", "--ulog", str(log), *words, *more])
    printed = capsys.readouterr()
    return status, printed.out, printed.err


def test_the_offset_comes_with_its_fit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, text, messages = converted(tmp_path, capsys, lambda row: row)
    assert (status, messages) == (0, "")
    assert "time offset, from 144 of 144 rows: " in text and "residual 0.74 times the usual noise of boxes" in text


def test_width_and_height_in_place_of_right_and_bottom(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def rewrite(row: list[float]) -> list[float]:
        return [*row[:3], row[3] - row[1], row[4] - row[2]]

    status, _, messages = converted(tmp_path, capsys, rewrite)
    assert status == 2 and "are these width and height, or exchanged columns?" in messages
    assert "turns and boxes fit at no offset within -0.5 to 0.5 s: the best is " in messages
    assert "times the usual noise of boxes" in messages and "'Symptoms'" in messages and "none" not in messages
    assert converted(tmp_path, capsys, rewrite, "--offset", "0")[0] == 0


CONVENTIONS: list[Change] = [
    lambda q: q[:, [1, 2, 3, 0]],
    lambda q: q * [1.0, -1.0, -1.0, -1.0],
    lambda q: np.repeat(q[:1], len(q), 0),
]


@pytest.mark.parametrize("change", CONVENTIONS)
def test_another_convention_is_named_as_a_cause(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: Change
) -> None:
    status, _, messages = converted(tmp_path, capsys, lambda row: row, changes={"q": change})
    assert status == 2 and "another convention" in messages and "'Symptoms'" in messages
    symptoms = Path(__file__).resolve().parents[2] / "tools" / "goe_tools" / "exchange" / "README.md"
    assert "## Symptoms" in symptoms.read_text()


def test_a_poor_fit_is_warned_of(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(offset, "POOR", 0.5)
    status, _, messages = converted(tmp_path, capsys, lambda row: row)
    assert status == 0 and "the offset leaves 0.74 times the usual noise of boxes: see " in messages


def test_the_search_shows_its_progress(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    shares: list[float] = []
    monkeypatch.setattr(offset.Progress, "show", lambda self, share: shares.append(share))
    assert converted(tmp_path, capsys, lambda row: row)[0] == 0
    assert shares == sorted(shares) and shares[0] == 0.0 and 0.9 < shares[-1] <= 1.0 and len(shares) > 30


def test_few_rows_that_determine_the_offset(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The others are close to the image border."""

    def rewrite(row: list[float]) -> list[float]:
        return row if row[0] > 26.0 else [row[0], 1.0, *row[2:]]

    status, _, messages = converted(tmp_path, capsys, rewrite)
    assert status == 0 and "rows determine the offset: the others show no whole obstacle" in messages


TIMES: list[tuple[Rewrite, str, str]] = [
    (lambda row: [1e3 * row[0], *row[1:]], "t_s runs from 21000.000 to 2", "milliseconds? t_s is in seconds"),
    (lambda row: [1e6 * row[0], *row[1:]], "t_s runs from 21000000.000 to 2", "microseconds? t_s is in seconds"),
    (lambda row: [1.8e9 + row[0], *row[1:]], "t_s runs from 1800000021.000 to 18", "Unix time? the clocks have"),
    (
        lambda row: [row[0] - 100.0, *row[1:]],
        "t_s runs from -79.000 to -",
        "give --about, the autopilot's time minus t_s",
    ),
]


@pytest.mark.parametrize(("rewrite", "span", "hint"), TIMES)
def test_times_of_another_unit_or_epoch(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], rewrite: Rewrite, span: str, hint: str
) -> None:
    for more, reason in (((), "no track has known poses"), (("--offset", "0"), "no row has a pose")):
        status, _, messages = converted(tmp_path, capsys, rewrite, *more)
        assert status == 2 and reason in messages
        assert span in messages and "and the poses from 20.000 to 31.000 s" in messages and hint in messages


def test_boxes_in_shares_of_the_image(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, _, messages = converted(tmp_path, capsys, lambda row: [row[0], *(side / 1280.0 for side in row[1:])])
    assert status == 2 and "all sides are between 0 and 1: shares of the image?" in messages
    assert "0 of 144 rows show a whole obstacle" in messages


def test_boxes_of_a_larger_image(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, _, messages = converted(
        tmp_path, capsys, lambda row: [row[0], *(2.0 * side for side in row[1:])], "--offset", "0"
    )
    assert "boxes leave the image of 1280 x 1280 px" in messages


def test_few_rows_with_a_pose(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, text, messages = converted(tmp_path, capsys, lambda row: row, "--offset", "6")
    assert status == 0 and "left out: " in text
    assert "rows have a pose: t_s runs from 21.000 to " in messages and "+6 s to be added to t_s" in messages
