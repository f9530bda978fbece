"""goe_replay's hints for logs in other units, signs and spellings; good logs get none. The Python tools print the same
hints.

GOE_REPLAY names the program; by default it is looked for in build/.
"""

from __future__ import annotations

import csv
import math
import os
import pty
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from goe_tools.logs.obslog import LogError, read_log

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("GOE_REPLAY", str(ROOT / "build" / "sim_host" / "goe_replay"))
CORNER = ROOT / "tests" / "data" / "corner"
FOOT = 1.0 / 0.3048
PLACE = "n_m", "e_m", "d_m"
NAMES = "qw", "qx", "qy", "qz"
Row = dict[str, str]

pytestmark = pytest.mark.skipif(
    "GOE_REPLAY" not in os.environ and not Path(PROGRAM).exists(), reason=f"{PROGRAM} is not built"
)


def rows() -> list[Row]:
    with (CORNER / "frames.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def write(folder: Path, table: list[Row], delimiter: str = ",") -> Path:
    folder.mkdir()
    (folder / "camera.ini").write_bytes((CORNER / "camera.ini").read_bytes())
    with (folder / "frames.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, list(table[0]), delimiter=delimiter, lineterminator="\n")
        writer.writeheader()
        writer.writerows(table)
    return folder


def said(folder: Path) -> tuple[int, str]:
    """Exit status, and standard error without the program's name."""
    done = subprocess.run([PROGRAM, "--out", os.devnull, str(folder)], capture_output=True, text=True, check=False)
    return done.returncode, done.stderr.replace("goe_replay: ", "")


def python_said(folder: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """The message of the tools' reader."""
    try:
        read_log(folder)
    except LogError as error:
        return str(error)
    return capsys.readouterr().err


def change(by: Callable[[Row], dict[str, object]]) -> Callable[[list[Row]], list[Row]]:
    return lambda table: [row | {name: str(value) for name, value in by(row).items()} for row in table]


def times(factor: float, *names: str) -> Callable[[list[Row]], list[Row]]:
    return change(lambda row: {name: factor * float(row[name]) for name in names})


def moved(row: Row) -> dict[str, object]:
    """The quaternion's parts in the order x, y, z, w."""
    return dict(zip(NAMES, [row[name] for name in (*NAMES[1:], "qw")]))


def turned(degrees: float) -> Callable[[list[Row]], list[Row]]:
    """The same flight on a course that is so far to the right."""
    angle = math.radians(degrees)
    c, s, w, z = math.cos(angle), math.sin(angle), math.cos(angle / 2.0), math.sin(angle / 2.0)

    def row_of(row: Row) -> dict[str, object]:
        n, e, *q = (float(row[name]) for name in ("n_m", "e_m", *NAMES))
        product = (w * q[0] - z * q[3], w * q[1] - z * q[2], w * q[2] + z * q[1], w * q[3] + z * q[0])
        return {"n_m": c * n - s * e, "e_m": s * n + c * e} | dict(zip(NAMES, product))

    return change(row_of)


def exchanged(row: Row) -> dict[str, object]:
    return {"n_m": row["e_m"], "e_m": row["n_m"]}


def inverse(row: Row) -> dict[str, object]:
    return {name: -float(row[name]) for name in NAMES[1:]}


def descending(table: list[Row]) -> list[Row]:
    """The same log above a ground at 0, from 90 m down to 30 m."""
    return [row | {"d_m": str(-90.0 + 0.5 * k), "agl_m": str(90.0 - 0.5 * k)} for k, row in enumerate(table)]


def renamed(old: str, new: str) -> Callable[[list[Row]], list[Row]]:
    return lambda table: [{new if name == old else name: text for name, text in row.items()} for row in table]


MILLISECONDS = "t_s: an image every 250 s of an aircraft that flies 0.017 m/s: milliseconds? t_s is in seconds"
TOO_FAST = "n_m, e_m: the aircraft flies 1.7e+03 m/s: feet? positions are in meters, t_s in seconds"
REAL_PART = "qw is its real part"
ORDER = f"qw: the attitude does not fit the motion, and does if the quaternion is in the order x, y, z, w: {REAL_PART}"
UPWARD = "d_m: it grows as agl_m does: is it up? d_m is down, negative above the origin"
BELOW = "d_m: the camera is below the ground, and agl_m is empty: is it up? d_m is down, negative above the origin"
EXCHANGED = (
    "n_m, e_m: the motion does not fit the heading, and does if the two are exchanged: is east the first? n_m is north"
)
INVERSE = (
    "qw: the attitude does not fit the motion, and its inverse does: "
    "the quaternion turns the body's axes into north, east, down"
)
BELOW_BY_AGL = "d_m: the camera is below the ground by agl_m: is it up? d_m is down, negative above the origin"
WARNINGS = [
    (times(1e3, "t_s"), MILLISECONDS),
    (times(1e-2, "t_s"), TOO_FAST),
    (change(moved), ORDER),
    (lambda table: change(exchanged)(turned(-25.0)(table)), EXCHANGED),
    (lambda table: change(exchanged)(turned(-80.0)(table)), EXCHANGED),
    (lambda table: change(inverse)(turned(70.0)(table)), INVERSE),
    (lambda table: change(inverse)(turned(15.0)(table)), INVERSE),
    (lambda table: times(-1.0, "d_m")(descending(table)), UPWARD),
    (change(lambda row: {"d_m": 40, "agl_m": ""}), BELOW),
    (change(lambda row: {"d_m": 40, "agl_m": -40}), BELOW_BY_AGL),
    (change(lambda row: {"d_m": -40, "agl_m": -3}), BELOW_BY_AGL),
    (lambda table: times(FOOT, "agl_m")(descending(table)), "agl_m: 3.28 times -d_m: feet? both are in meters"),
    (lambda table: times(FOOT, *PLACE)(descending(table)), "d_m: 3.28 times -agl_m: feet? both are in meters"),
]


@pytest.mark.parametrize(("spoil", "hint"), WARNINGS)
def test_other_units_signs_and_orders_are_hinted_at(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], spoil: Callable[[list[Row]], list[Row]], hint: str
) -> None:
    """A hint is no error: the log is read."""
    folder = write(tmp_path / "log", spoil(rows()))
    status, text = said(folder)
    warnings = [line for line in text.splitlines() if line.startswith("warning: ")]
    assert status in (0, 1) and len(warnings) == 1, text
    assert warnings[0] == f"warning: {folder / 'frames.csv'}: {hint}"
    assert python_said(folder, capsys) == warnings[0] + "\n"


@pytest.mark.parametrize(
    "spoil", [lambda t: t, descending, lambda t: t[:9], change(lambda row: {"agl_m": ""}), turned(70.0), turned(-120.0)]
)
def test_good_logs_are_not_remarked_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], spoil: Callable[[list[Row]], list[Row]]
) -> None:
    folder = write(tmp_path / "log", spoil(rows()))
    assert "warning" not in said(folder)[1] and python_said(folder, capsys) == ""


@pytest.mark.parametrize(("delimiter", "name"), [(";", "semicolons"), ("\t", "tabs"), ("|", "bars")])
def test_another_delimiter(tmp_path: Path, capsys: pytest.CaptureFixture[str], delimiter: str, name: str) -> None:
    folder = write(tmp_path / "log", rows(), delimiter)
    reason = f"{name} separate the columns; a log has commas between them, and points in its numbers\n"
    assert said(folder) == (2, f"{folder / 'frames.csv'}:1: t_s: missing column: {reason}")
    reason = f"{name} separate the columns; there must be commas, and points in the numbers"
    assert python_said(folder, capsys) == f"{folder / 'frames.csv'}:1: t_s: column is missing: {reason}"


def test_a_required_column_misspelt(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = write(tmp_path / "log", renamed("agl_m", "x")(renamed("e_m", "e_me")(rows())))
    place = f"{folder / 'frames.csv'}:1: e_m:"
    assert python_said(folder, capsys) == f"{place} column is missing; is 'e_me' meant to be it?"
    assert said(folder) == (2, f"{folder / 'frames.csv'}:1: e_m: missing column; is 'e_me' meant to be it?\n")


@pytest.mark.parametrize(
    ("name", "other"), [("t_s", "timestamp"), ("t_s", "TimeUS"), ("qw", "q0"), ("qw", "q[0]"), ("d_m", "down")]
)
def test_a_column_by_the_name_of_another_program(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, other: str
) -> None:
    folder = write(tmp_path / "log", renamed(name, other)(rows()))
    place = f"{folder / 'frames.csv'}:1: {name}:"
    assert python_said(folder, capsys) == f"{place} column is missing; is '{other}' meant to be it?"
    assert said(folder) == (2, f"{place} missing column; is '{other}' meant to be it?\n")


def test_all_missing_columns_are_named_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = write(tmp_path / "log", renamed("n_m", "p0")(renamed("qz", "p1")(renamed("qw", "p2")(rows()))))
    place = f"{folder / 'frames.csv'}:1: n_m:"
    assert python_said(folder, capsys) == f"{place} column is missing; also missing: qw, qz"
    assert said(folder) == (2, f"{place} missing column; also missing: qw, qz\n")


def test_a_header_of_one_column_is_missing_all_others(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = write(tmp_path / "log", [{"t_s": row["t_s"]} for row in rows()])
    place, others = f"{folder / 'frames.csv'}:1: id:", "also missing: n_m, e_m, d_m, qw, qx, qy, qz"
    assert python_said(folder, capsys) == f"{place} column is missing; {others}"
    assert said(folder) == (2, f"{place} missing column; {others}\n")


def test_an_optional_column_misspelt(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sides = {"box_left": 1, "y1": 2, "box_rigth_px": 3, "box_bottom_px": 4, "colour": 5, "x1": 6}
    folder = write(tmp_path / "log", change(lambda row: sides)(rows()))
    warnings = said(folder)[1].splitlines()[:4]
    assert (
        python_said(folder, capsys).splitlines()
        == warnings
        == [
            f"warning: {folder / 'frames.csv'}:1: {name}: unknown column, ignored; did you mean {meant}?"
            for name, meant in (
                ("box_left", "box_left_px"),
                ("y1", "box_top_px"),
                ("box_rigth_px", "box_right_px"),
                ("x1", "box_left_px"),
            )
        ]
    )


def test_rows_that_are_not_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = rows()
    table[3]["n_m"] = table[7]["left_u"] = "nan"
    table[9]["qw"] = ""
    folder = write(tmp_path / "log", table)
    text = "3 rows without a finite pose or with a number that is not finite, the first in line 5\n"
    assert said(folder) == (0, f"warning: {folder / 'frames.csv'}: {text}")
    assert python_said(folder, capsys) == f"warning: {folder / 'frames.csv'}: {text}"


def test_rows_out_of_the_order_of_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of each id on its own: the rows of one track after those of another are in order."""
    table = rows()
    other = [row | {"id": "99"} for row in table]
    folder = write(tmp_path / "log", [*table, *other])
    assert said(folder) == (0, "") and python_said(folder, capsys) == ""
    for moved_by, count in ((1, "1 row is"), (3, "3 rows are")):
        late = [*table[: 12 - moved_by], table[12], *table[12 - moved_by : 12], *table[13:]]
        folder = write(tmp_path / str(moved_by), [*late, *other])
        text = (
            f"warning: {folder / 'frames.csv'}: t_s: {count} not later than the rows of the same id before, "
            f"the first in line {15 - moved_by}: goe refuses this as bad_time; sort the rows by t_s\n"
        )
        assert said(folder) == (0, text) and python_said(folder, capsys) == text


@pytest.mark.parametrize("name", ["frames.csv", "camera.ini"])
def test_a_file_in_place_of_its_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    folder = write(tmp_path / "log", rows())
    assert said(folder / name) == (
        2,
        f"{folder / name}: is a file; name its folder, {folder} (see goe_replay --help)\n",
    )
    assert python_said(folder / name, capsys) == f"{folder / name}: is a file; name its folder, {folder}"


@pytest.mark.parametrize(("name", "option"), [("a.ulg", "ulog"), ("b.BIN", "dataflash"), ("c.tlog", "tlog")])
def test_an_autopilots_log_in_place_of_a_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, option: str
) -> None:
    (tmp_path / name).write_bytes(b"")
    reason = f"is an autopilot's log; make an observation log of it: python -m goe_tools convert --{option}"
    assert said(tmp_path / name) == (2, f"{tmp_path / name}: {reason} (see goe_replay --help)\n")
    assert python_said(tmp_path / name, capsys) == f"{tmp_path / name}: {reason}"


def test_a_long_read_shows_on_a_terminal_how_far_it_is(tmp_path: Path) -> None:
    """From a pipe that pauses for longer than the two seconds before the first progress line."""
    camera, text = str(CORNER / "camera.ini"), (CORNER / "frames.csv").read_text()
    row = text.splitlines()[1].split(",", 1)[1]
    lines = [f"{k}.5,{row}" for k in range(4000)]
    terminal, other = pty.openpty()
    words = [PROGRAM, "--out", os.devnull, "--camera", camera, "--frames", "/dev/stdin"]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stderr=other, text=True) as running:
        assert running.stdin is not None
        running.stdin.write("\n".join([text.splitlines()[0], *lines[:500], ""]))
        running.stdin.flush()
        time.sleep(2.2)
        running.stdin.write("\n".join([*lines[500:], ""]))
    os.close(other)
    shown = os.read(terminal, 4096).decode()
    os.close(terminal)
    assert running.returncode == 0 and "goe_replay: 1024 rows" in shown


def test_every_row_by_the_fast_way_or_the_careful_one(tmp_path: Path) -> None:
    """The same numbers in formats that only the slower parser reads."""
    fast = read_log(write(tmp_path / "fast", rows())).frames
    careful = change(
        lambda row: {"id": "+1", "agl_m": f"{row['agl_m']}e0" if row["agl_m"] else "", "left_u": row["left_u"]}
    )
    assert read_log(write(tmp_path / "careful", careful(rows()))).frames == fast
