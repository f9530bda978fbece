"""The log format. The programs and Python read logs that the schemas allow, and refuse other logs with file, line and
column. The page that describes the format agrees."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from goe_tools.logs.obslog import CAMERA_RANGES, LogError, read_cameras, read_frames, read_truth

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "sim_host" / "log"
FRAMES, TRUTH, CAMERA = (
    json.loads((FOLDER / f"{name}.schema.json").read_text(encoding="utf-8")) for name in ("frames", "truth", "camera")
)
PAGE = (FOLDER / "README.md").read_text(encoding="utf-8")
BIG = 2**63
Table = dict[str, str]  # column: its field in the one row

GOOD = {"number": ("1.5", "-2", "+3e-2", ".5", "nan", "-inf", "1e400"), "integer": ("0", "1")}
BAD = {
    "number": ("high", "1,5", "0x1f", "1_0", "1.5m", "--1", "1 2", "nan(3)", "\u0661", "\x0b1"),
    "integer": ("1.0", "1e3", "0x1", "x", "nan", str(BIG), str(-BIG - 1), "1_0"),
}


def write(path: Path, table: Table) -> Path:
    def quoted(text: str) -> str:
        return f'"{text}"' if "," in text else text

    path.write_text(",".join(table) + "\n" + ",".join(map(quoted, table.values())) + "\n", encoding="utf-8")
    return path


def fields(schema: dict, column: str | None = None) -> list[dict]:
    return [f for f in schema["fields"] if column is None or f["column"] == column]


def plain(schema: dict) -> Table:
    """The required columns and a good row."""
    return {f["name"]: "1" if f["type"] == "integer" else "0.5" for f in fields(schema, "required")}


def whole(schema: dict) -> Table:
    """Every column and a good row; the first camera."""
    sigmas = {f["name"]: "10" for f in fields(schema, "optional") if f["name"].endswith("_sd_m")}  # for any size
    return plain(schema) | {f["name"]: "0" for f in fields(schema, "optional")} | sigmas


def allowed(schema: dict) -> Iterator[tuple[str, Table]]:
    """Logs that the schema allows."""
    table = whole(schema)
    yield "the required columns", plain(schema)
    yield "all columns", table
    yield "all columns, backwards", dict(reversed(table.items()))
    yield "a column of one's own", table | {"score": "good"}
    for f in fields(schema):
        constraints = f.get("constraints", {})
        values = {str(constraints[end]) for end in ("minimum", "maximum") if end in constraints}
        values |= {"0"} if {"minimum", "maximum"} & set(constraints) else set(GOOD[f["type"]])
        values |= {str(end) for end in f.get("range", ())}
        if not constraints.get("required"):
            values.add("")
        for value in sorted(values):
            if not (f["name"] == "camera" and value == "1"):
                yield f"{f['name']} = '{value}'", table | {f["name"]: value}


def forbidden(schema: dict) -> Iterator[tuple[int, str, Table]]:
    """(line, column, log) for logs that the schema forbids."""
    table = whole(schema)
    for f in fields(schema):
        name, constraints = f["name"], f.get("constraints", {})
        if f["column"] == "required":
            yield 1, name, {other: text for other, text in table.items() if other != name}
        for value in BAD[f["type"]]:
            yield 2, name, table | {name: value}
        if constraints.get("required"):
            yield 2, name, table | {name: ""}
        for end, step in (("minimum", -1), ("maximum", 1)):
            if end in constraints:
                yield 2, name, table | {name: str(constraints[end] + step)}
    for pair in schema.get("together", ()):
        for absent in pair:
            yield 1, absent, {other: text for other, text in table.items() if other != absent}
    for needed in set(schema.get("needs", {}).values()):
        yield 1, needed, {other: text for other, text in table.items() if other != needed}


# ------------------------------------------------------------------------------------------------------------- readers


@pytest.fixture(scope="module")
def replay() -> Callable[[Path], str]:
    """Runs goe_replay over a folder and returns its error; empty if it read the log."""
    program = Path(os.environ.get("GOE_REPLAY", ROOT / "build" / "sim_host" / "goe_replay"))
    if not program.is_file():
        pytest.skip(f"{program} is not built")

    def run(folder: Path) -> str:
        words = [str(program), str(folder)]
        done = subprocess.run(words, capture_output=True, text=True, timeout=600, check=False)
        assert done.returncode in (0, 1, 2)
        return done.stderr.strip() if done.returncode == 2 else ""

    return run


CAMERA_LINES = [f"camera.{name} = 100" for name in ("width", "height", "fx", "fy", "cx", "cy")]


def camera_file(folder: Path, lines: list[str]) -> Path:
    path = folder / "camera.ini"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_frames_that_the_schema_allows_are_read(tmp_path: Path, replay: Callable[[Path], str]) -> None:
    camera_file(tmp_path, CAMERA_LINES)
    count = 0
    for what, table in allowed(FRAMES):
        path = write(tmp_path / "frames.csv", table)
        assert replay(tmp_path) == "", what
        (frame,) = read_frames(path, 1)
        assert math.isnan(frame.t_s) or float(table["t_s"]) == frame.t_s, what
        count += 1
    assert count > 200


def test_frames_that_the_schema_forbids_are_refused(tmp_path: Path, replay: Callable[[Path], str]) -> None:
    camera_file(tmp_path, CAMERA_LINES)
    count = 0
    for line, column, table in forbidden(FRAMES):
        path = write(tmp_path / "frames.csv", table)
        start = f"{path}:{line}: {column}: "
        assert replay(tmp_path).startswith(start), table
        with pytest.raises(LogError) as error:
            read_frames(path, 1)
        assert str(error.value).startswith(start), table
        count += 1
    assert count > 250


def test_a_field_too_many_or_too_few(tmp_path: Path, replay: Callable[[Path], str]) -> None:
    camera_file(tmp_path, CAMERA_LINES)
    path = write(tmp_path / "frames.csv", plain(FRAMES))
    good = path.read_text().splitlines()
    rows = ((good[1] + ",7", "qz"), (good[1].rpartition(",")[0], "qz"), ('"1,2', ""), (f'"{good[1]}', ""), ("\0", ""))
    for row, column in rows:
        path.write_text(f"{good[0]}\n{row}\n")
        start = f"{path}:2: " + (f"{column}: " if column else "")
        assert replay(tmp_path).startswith(start)
        with pytest.raises(LogError) as error:
            read_frames(path)
        assert str(error.value).startswith(start)


def test_a_last_row_that_may_be_cut_off(tmp_path: Path, replay: Callable[[Path], str]) -> None:
    """869.5 must not be read as 86. Without a line break at its end a row may be incomplete, also after blank lines and
    with quotes. Only LF ends a row, so both readers count the same lines."""
    camera_file(tmp_path, CAMERA_LINES)
    table = plain(FRAMES)
    path = write(tmp_path / "frames.csv", table)
    whole = path.read_bytes()
    last = whole.splitlines()[1]
    note = whole.replace(b"\n", b",note\n", 1)
    for content, line in (
        (whole[:-1], 2),
        (whole[:-2], 2),
        (whole.splitlines()[0], 1),
        (whole + b"\n\n" + last, 5),
        (whole + b"\n \r\n" + last + b"\r", 5),
        (whole + last.replace(b"0.5", b'"0.5"'), 3),
        (note[:-1] + b',"two\nlines"\n' + last + b",\x0b\x0c\x1c\xc2\x85\n" + last + b",x", 5),
    ):
        path.write_bytes(content)
        assert replay(tmp_path).startswith(f"{path}:{line}: "), content
        with pytest.raises(LogError, match="ends without a line break") as error:
            read_frames(path, 1)
        assert str(error.value).startswith(f"{path}:{line}: "), content
        path.write_bytes(content + b"\n")
        assert replay(tmp_path) == ""
        read_frames(path, 1)
    truth = write(tmp_path / "truth.csv", plain(TRUTH))
    truth.write_bytes(truth.read_bytes()[:-1])
    with pytest.raises(LogError, match=r"truth\.csv:2: the file ends without a line break"):
        read_truth(truth)


def test_a_row_out_of_range_is_read_and_its_image_refused(tmp_path: Path, replay: Callable[[Path], str]) -> None:
    """The library decides: the status of the row is out of range."""
    program = Path(os.environ.get("GOE_REPLAY", ROOT / "build" / "sim_host" / "goe_replay"))
    camera_file(tmp_path, CAMERA_LINES)
    level = plain(FRAMES) | {"qw": "1", "qx": "0", "qy": "0", "qz": "0", "agl_m": "1"}

    def status(table: Table) -> str:
        write(tmp_path / "frames.csv", table)
        done = subprocess.run([str(program), str(tmp_path)], capture_output=True, text=True, timeout=600, check=False)
        return done.stdout.splitlines()[1].split(",")[2]

    refused = {"out_of_range", "bad_time", "bad_attitude"}
    for f in fields(FRAMES):
        if "range" not in f or f["name"].startswith("reset"):  # the latter are read in a second image
            continue
        name = f["name"]
        box = {f"box_{side}_px": "" for side in ("left", "top", "right", "bottom")}
        pair = {other: "1" for pair in FRAMES["together"] if name in pair for other in pair}
        for end in f["range"]:
            beyond = end + math.copysign(max(abs(end), 1.0) * 1e-3, end)
            table = level | (box if name in box else pair) | {name: repr(float(beyond))}
            assert status(table) in refused, (name, beyond)
            if name != "t_s" and not name.startswith("q"):  # the ends of these are beyond, too
                assert status(table | {name: repr(float(end))}) not in refused, (name, end)


def test_truth(tmp_path: Path) -> None:
    for what, table in allowed(TRUTH):
        if table["static"] in ("0", "1"):
            assert len(read_truth(write(tmp_path / "truth.csv", table))) == 1, what
    for line, column, table in forbidden(TRUTH):
        path = write(tmp_path / "truth.csv", table)
        with pytest.raises(LogError) as error:
            read_truth(path)
        assert str(error.value).startswith(f"{path}:{line}: {column}: "), table


# -------------------------------------------------------------------------------------------------------------- camera


def number_of(key: str) -> dict:
    """The numbers that a key accepts."""
    entry = CAMERA["properties"][key]
    return next((one for one in entry.get("anyOf", ()) if "minimum" in one), entry)


def second(key: str) -> list[str]:
    """Keys that the second camera needs together with this one."""
    return [f"{name} = 100" for name in CAMERA["dependentRequired"].get(key, ())]


def test_cameras_that_the_schema_allows_are_read(tmp_path: Path, replay: Callable[[Path], str]) -> None:
    """Key by key: a size that suits every principal point, with a focal length that suits it, or the smallest size."""
    write(tmp_path / "frames.csv", plain(FRAMES))
    for key in CAMERA["properties"]:
        size, focal, center = (10, 1, 1) if key.endswith((".fx", ".fy")) else (100000, 100000, 1)
        of_name = {"width": size, "height": size, "fx": focal, "fy": focal, "cx": center, "cy": center}
        lines = [f"{camera}.{name} = {number}" for camera in ("camera", "camera2") for name, number in of_name.items()]
        needed = CAMERA["required"] + CAMERA["dependentRequired"].get(key, [])
        rest = [line for line in lines if line.split(" ")[0] in needed and not line.startswith(f"{key} ")]
        ends = [number_of(key)[end] for end in ("minimum", "maximum")]
        for value in (*ends, *(["auto"] if "anyOf" in CAMERA["properties"][key] else [])):
            path = camera_file(tmp_path, ["# mine", *rest, f"{key}={value}#"])
            assert replay(tmp_path) == ""
            cameras = read_cameras(path)
            assert len(cameras) == 1 + key.startswith("camera2.")
            name = key.partition(".")[2]
            assert getattr(cameras[-1], name) == (None if value == "auto" else value)


@pytest.mark.parametrize(
    ("key", "good", "bad"),
    [
        ("camera.fx", 64.0, 63.9),
        ("camera.fy", 36.0, 35.9),
        ("camera.cx", -1350.0, -1351.0),
        ("camera.cy", 2070.0, 2071.0),
    ],
)
def test_both_readers_refuse_a_lens_that_does_not_fit_the_size(
    tmp_path: Path, replay: Callable[[Path], str], key: str, good: float, bad: float
) -> None:
    """The limits are those of goe_init(), written again in Python."""
    write(tmp_path / "frames.csv", plain(FRAMES))
    usual = {"width": 1280, "height": 720, "fx": 900, "fy": 900, "cx": 640, "cy": 360}
    usual = {f"camera.{name}": number for name, number in usual.items()}
    path = camera_file(tmp_path, [f"{name} = {number}" for name, number in (usual | {key: good}).items()])
    assert replay(tmp_path) == "" and len(read_cameras(path)) == 1
    path = camera_file(tmp_path, [f"{name} = {number}" for name, number in (usual | {key: bad}).items()])
    reason = f"{path}: {key}: does not fit the size of the image"
    with pytest.raises(LogError, match=re.escape(reason)):
        read_cameras(path)
    assert f"{key}_px: does not fit the size of the image" in replay(tmp_path)


def test_cameras_that_the_schema_forbids_are_refused(tmp_path: Path, replay: Callable[[Path], str]) -> None:
    write(tmp_path / "frames.csv", plain(FRAMES))

    def refuse(lines: list[str], key: str, line: int | None) -> None:
        path = camera_file(tmp_path, lines)
        with pytest.raises(LogError) as error:
            read_cameras(path)
        where = f":{line}" if line else ""  # a missing key has no line of its own; the programs name the last line
        assert str(error.value).startswith(f"{path}{where}: {key}: ")
        assert re.match(re.escape(str(path)) + (f":{line}" if line else r":\d+") + f": {key}: ", replay(tmp_path))

    for key in CAMERA["properties"]:
        rest = [line for line in CAMERA_LINES if not line.startswith(f"{key} ")] + second(key)
        at = len(rest) + 1
        entry = number_of(key)
        low, high = (entry[end] for end in ("minimum", "maximum"))
        for value in ("wide", "", f"{low - 1e-3 * max(abs(low), 1):g}", f"{high + 1e-3 * high:g}", "nan", "inf"):
            refuse([*rest, f"{key} = {value}"], key, at)
        refuse([*rest, f"{key} = 1", f"{key} = 1"], key, at + 1)
        if key in CAMERA["required"]:
            refuse(rest, key, None)
        for needed in CAMERA["dependentRequired"].get(key, ()):
            lines = [line for line in rest if not line.startswith(f"{needed} ")]
            refuse([*lines, f"{key} = 1"], needed, None)
    refuse([*CAMERA_LINES, "camera.f = 1"], "camera.f", 7)


# ---------------------------------------------------------------------------------------------------- schemas and page


def test_the_camera_has_the_ranges_of_the_readers_and_of_the_library(replay: Callable[[Path], str]) -> None:
    program = Path(os.environ.get("GOE_REPLAY", ROOT / "build" / "sim_host" / "goe_replay"))
    output = subprocess.run([str(program), "--settings"], capture_output=True, text=True, check=True).stdout
    listed = {line.split("\t")[0]: [float(x) for x in line.split("\t")[2:4]] for line in output.splitlines()}
    index = dict(zip("xyz", "012"))
    for key in CAMERA["properties"]:
        owner, _, name = key.partition(".")
        low, high = (number_of(key)[end] for end in ("minimum", "maximum"))
        assert CAMERA_RANGES[name] == (low, high)
        field = re.sub(r"^offset_(.)_m$", lambda m: f"offset_m[{index[m[1]]}]", name)
        field = "heading_deg" if owner == "trajectory" else f"camera.{field}"
        in_library = listed.get(field) or listed[f"{field}_px"]
        assert in_library[1] == high
        assert in_library[0] == low or name in ("width", "height")  # there 0 means: not known


def test_the_page_has_every_column_and_key() -> None:
    rows = {}
    for line in re.findall(r"^\| (`.*)\|$", PAGE, re.MULTILINE):
        name, *cells = (cell.strip() for cell in line.split("|"))
        rows.setdefault(name, []).append(cells)
    for schema in (FRAMES, TRUTH):
        for f in fields(schema):
            optional = ", optional" if f["column"] == "optional" else ""
            (cells,) = [r for r in rows[f"`{f['name']}`{optional}"] if r[1] == f["description"]]
            assert cells[0] == f["unit"]
            constraints = f.get("constraints", {})
            if f["name"].startswith("kind_"):
                assert [float(x) for x in cells[2].split(" to ")] == [constraints["minimum"], constraints["maximum"]]
            if "range" in f:
                assert [float(x) for x in cells[2].split(" to ")] == f["range"]
            assert cells[-1] == f.get("empty", "not allowed")
            assert (cells[-1] == "not allowed") == bool(f.get("constraints", {}).get("required"))
    for key, entry in CAMERA["properties"].items():
        if key.startswith("camera2."):
            first = CAMERA["properties"][key.replace("camera2.", "camera.")]
            assert entry == first
            continue
        ((unit, text, span, default),) = rows[f"`{key}`"]
        assert (unit, text) == (entry["unit"], entry["description"])
        assert [float(x) for x in span.split(" to ")] == [number_of(key)["minimum"], number_of(key)["maximum"]]
        assert default == ("required" if key in CAMERA["required"] else str(entry["default"]))


def test_the_log_on_the_page(tmp_path: Path, replay: Callable[[Path], str]) -> None:
    camera, frames = re.findall(r"^```\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    (tmp_path / "camera.ini").write_text(camera)
    (tmp_path / "frames.csv").write_text(frames)
    assert replay(tmp_path) == ""
    assert len(read_frames(tmp_path / "frames.csv")) == 2
