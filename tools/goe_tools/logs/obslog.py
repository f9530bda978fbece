"""Observation logs: a folder with camera.ini, frames.csv and, where the truth is known, truth.csv.

Frames: NED earth (north, east, down), FRD body, camera with x right, y down and z along the optical axis. Lengths
are in metres, image points in pixels from the top left corner, attitudes Hamilton quaternions (w, x, y, z) body -> NED.
An empty field means "not measured": None here. Errors carry file, line and column: LogError.
"""

from __future__ import annotations

import csv
import dataclasses
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

Pixel = tuple[float, float]
Box = tuple[float | None, float | None, float | None, float | None]  # left, top, right, bottom; None: not seen

TIME_LIMIT_US = 9.2e18  # just inside 64 bits
FEATURES = ("left", "right", "top", "base_left", "base_near", "base_right")
POSE_COLUMNS = ("n_m", "e_m", "d_m", "qw", "qx", "qy", "qz")
REQUIRED_COLUMNS = ("t_s", "id", *POSE_COLUMNS)
POINT_COLUMNS = tuple(f"{feature}_{axis}" for feature in FEATURES for axis in "uv")
BOX_COLUMNS = ("box_left_px", "box_top_px", "box_right_px", "box_bottom_px")
RESET_COLUMN = "reset_count"
CAMERA_COLUMN = "camera"
JUMP_COLUMNS = ("reset_n_m", "reset_e_m", "reset_d_m")
FRAME_COLUMNS = (*REQUIRED_COLUMNS, "agl_m", *POINT_COLUMNS, *BOX_COLUMNS, CAMERA_COLUMN, RESET_COLUMN, *JUMP_COLUMNS)
TRUTH_COLUMNS = (
    "id",
    "static",
    "center_n_m",
    "center_e_m",
    "ground_d_m",
    "width_m",
    "length_m",
    "height_m",
    "heading_deg",
)


class LogError(ValueError):
    """Bad input; its text is ``file:line: column: reason`` (without the parts that do not apply)."""

    def __init__(self, path: Path, line: int, column: str, reason: str) -> None:
        self.path, self.line, self.column, self.reason = Path(path), line, column, reason
        where = f"{path}:{line}: " if line else f"{path}: "
        super().__init__(where + (f"{column}: " if column else "") + reason)


@dataclass
class Camera:
    """One camera of camera.ini. ``heading_deg`` is the heading of T's Z axis, clockwise from north, the same for
    each camera; None: auto."""

    width: float
    height: float
    fx: float
    fy: float
    cx: float
    cy: float
    k1: float = 0.0
    k2: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    k3: float = 0.0
    mount_roll_deg: float = 0.0
    mount_pitch_deg: float = 0.0
    mount_yaw_deg: float = 0.0
    offset_x_m: float = 0.0
    offset_y_m: float = 0.0
    offset_z_m: float = 0.0
    heading_deg: float | None = None


CAMERA_FIELDS = tuple(f.name for f in dataclasses.fields(Camera) if f.name != "heading_deg")
REQUIRED_CAMERA_FIELDS = tuple(f.name for f in dataclasses.fields(Camera) if f.default is dataclasses.MISSING)
HEADING_KEY = "trajectory.heading_deg"
CAMERA_NAMES = ("camera", "camera2")  # their keys begin so


@dataclass
class Frame:
    """One row of frames.csv: one obstacle in one image."""

    t_s: float
    id: int
    position_m: tuple[float, float, float]  # vehicle, NED
    attitude: tuple[float, float, float, float]  # w, x, y, z
    agl_m: float | None = None  # camera above the ground at the obstacle; None: -down
    left: Pixel | None = None
    right: Pixel | None = None
    top: Pixel | None = None
    base_left: Pixel | None = None
    base_near: Pixel | None = None
    base_right: Pixel | None = None
    box_px: Box | None = None  # upright bounding box in the raw image; None: no side is seen
    camera: int = 0  # number of the one that took the image
    reset_count: int = 0  # of the autopilot's filter
    reset_delta_m: tuple[float, float, float] | None = None  # by how much the position jumped, NED; None: not known

    @property
    def height_m(self) -> float:
        """Camera height above the ground at the obstacle, m."""
        return -self.position_m[2] if self.agl_m is None else self.agl_m

    @property
    def time_us(self) -> int | None:
        """Time stamp as the replay program hands it on: microseconds, ties to even; None if not finite or too large."""
        time_us = self.t_s * 1e6
        return round(time_us) if abs(time_us) < TIME_LIMIT_US else None


@dataclass
class Truth:
    """One row of truth.csv. ``extra`` holds the columns beyond the contract's, as text."""

    id: int
    static: bool
    center_n_m: float
    center_e_m: float
    ground_d_m: float
    width_m: float
    length_m: float | None  # None: round
    height_m: float
    heading_deg: float | None  # of the length axis, clockwise from north; None: round
    extra: dict[str, str] = field(default_factory=dict)


@dataclass
class ObservationLog:
    camera: Camera
    frames: list[Frame]
    truth: dict[int, Truth] = field(default_factory=dict)  # by id
    camera2: Camera | None = None  # number 1

    def resets(self) -> set[int]:
        """Ids of the tracks in which the autopilot's filter was reset."""
        return {key for key, frames in self.tracks().items() if len({frame.reset_count for frame in frames}) > 1}

    def tracks(self) -> dict[int, list[Frame]]:
        """The frames of each id, in the log's order."""
        result: dict[int, list[Frame]] = {}
        for frame in self.frames:
            result.setdefault(frame.id, []).append(frame)
        return result


# ----------------------------------------------------------------------------------------------------------- reading


def _number(text: str, path: Path, line: int, column: str) -> float:
    try:
        if "_" in text:  # Python's digit grouping, unknown to every other reader
            raise ValueError
        return float(text)
    except ValueError:
        raise LogError(path, line, column, f"'{text}' is not a number") from None


def _integer(text: str, path: Path, line: int, column: str) -> int:
    try:
        if "_" in text:
            raise ValueError
        return int(text)
    except ValueError:
        raise LogError(path, line, column, f"'{text}' is not an integer") from None


def _read_text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None
    except UnicodeDecodeError as error:
        raise LogError(path, 0, "", f"not UTF-8 text: {error.reason}") from None


def _key_of(key: str) -> tuple[str, str]:
    """The camera's name and the field of a key; empty if there is none."""
    if key == HEADING_KEY:
        return CAMERA_NAMES[0], "heading_deg"
    owner, _, name = key.partition(".")
    return (owner, name) if owner in CAMERA_NAMES and name in CAMERA_FIELDS else ("", "")


def read_cameras(path: Path) -> list[Camera]:
    """Reads camera.ini, one camera or two; an unknown, doubled, missing or non-numeric key is a LogError."""
    path = Path(path)
    found: dict[str, dict[str, float | None]] = {CAMERA_NAMES[0]: {}}
    for line, raw in enumerate(_read_text(path).splitlines(), start=1):
        text = raw.split("#", 1)[0].strip()
        if not text:
            continue
        key, equals, value = (part.strip() for part in text.partition("="))
        if not equals:
            raise LogError(path, line, "", f"'{text}' is not of the form key = value")
        owner, name = _key_of(key)
        if not owner:
            raise LogError(path, line, key, "unknown key")
        values = found.setdefault(owner, {})
        if name in values:
            raise LogError(path, line, key, "given twice")
        if key == HEADING_KEY and value == "auto":
            values[name] = None
            continue
        number = _number(value, path, line, key)
        if not math.isfinite(number):
            raise LogError(path, line, key, f"'{value}' is not finite")
        if name in ("width", "height", "fx", "fy") and number <= 0.0:
            raise LogError(path, line, key, "must be positive")
        values[name] = number
    for owner, values in found.items():
        for name in REQUIRED_CAMERA_FIELDS:
            if name not in values:
                raise LogError(path, 0, f"{owner}.{name}", "missing")
    heading = found[CAMERA_NAMES[0]].get("heading_deg")
    return [Camera(**values | {"heading_deg": heading}) for values in found.values()]  # type: ignore[arg-type]


def read_camera(path: Path) -> Camera:
    """Reads the camera.ini of one camera; a second one is a LogError, too."""
    cameras = read_cameras(path)
    if len(cameras) > 1:
        raise LogError(path, 0, CAMERA_NAMES[1], "a second camera, of a log that must have one alone")
    return cameras[0]


def _rows(path: Path, required: Sequence[str], known: Sequence[str]) -> Iterator[tuple[int, dict[str, str]]]:
    """Yields (line number, column -> text) of a CSV file with a header line."""
    reader = csv.reader(_read_text(path).splitlines(keepends=True))
    header: list[str] | None = None
    for row in reader:
        if not any(text.strip() for text in row) and len(row) <= 1:
            continue
        if header is None:
            header = [name.strip() for name in row]
            for name in required:
                if name not in header:
                    raise LogError(path, reader.line_num, name, "column is missing")
            for name in known:
                if header.count(name) > 1:
                    raise LogError(path, reader.line_num, name, "column is given twice")
            for name in FEATURES:
                if (f"{name}_u" in header) != (f"{name}_v" in header):
                    absent = f"{name}_v" if f"{name}_u" in header else f"{name}_u"
                    raise LogError(path, reader.line_num, absent, "column is missing")
            jumps = [name for name in JUMP_COLUMNS if name in header]
            if jumps and RESET_COLUMN not in header:
                raise LogError(path, reader.line_num, RESET_COLUMN, f"column is missing, {jumps[0]} is there")
            continue
        if len(row) != len(header):
            raise LogError(path, reader.line_num, "", f"{len(row)} fields under {len(header)} columns")
        yield reader.line_num, {name: text.strip() for name, text in zip(header, row)}
    if header is None:
        raise LogError(path, 0, "", "empty: no header line")


def _optional(row: dict[str, str], path: Path, line: int, column: str) -> float | None:
    text = row.get(column, "")
    return _number(text, path, line, column) if text else None


def _pixel(row: dict[str, str], path: Path, line: int, feature: str) -> Pixel | None:
    u = _optional(row, path, line, f"{feature}_u")
    v = _optional(row, path, line, f"{feature}_v")
    return None if u is None or v is None else (u, v)


def _box(row: dict[str, str], path: Path, line: int) -> Box | None:
    left, top, right, bottom = (_optional(row, path, line, column) for column in BOX_COLUMNS)
    box = (left, top, right, bottom)
    return None if box == (None, None, None, None) else box


def _jump(row: dict[str, str], path: Path, line: int) -> tuple[float, float, float] | None:
    n, e, d = (_optional(row, path, line, column) for column in JUMP_COLUMNS)
    return None if n is None or e is None or d is None else (n, e, d)


def _camera_number(row: dict[str, str], path: Path, line: int, cameras: int) -> int:
    text = row.get(CAMERA_COLUMN, "")
    number = _integer(text, path, line, CAMERA_COLUMN) if text else 0
    if not 0 <= number < cameras:
        raise LogError(path, line, CAMERA_COLUMN, f"there is no camera {number}")
    return number


def read_frames(path: Path, cameras: int = len(CAMERA_NAMES)) -> list[Frame]:
    """Reads frames.csv of so many cameras. An empty pose field becomes NaN: a bad measurement, no bad input."""
    path = Path(path)
    frames = []
    for line, row in _rows(path, REQUIRED_COLUMNS, FRAME_COLUMNS):
        pose = [_optional(row, path, line, column) for column in POSE_COLUMNS]
        n, e, d, qw, qx, qy, qz = (math.nan if value is None else value for value in pose)
        frames.append(
            Frame(
                t_s=_number(row["t_s"], path, line, "t_s"),
                id=_integer(row["id"], path, line, "id"),
                position_m=(n, e, d),
                attitude=(qw, qx, qy, qz),
                agl_m=_optional(row, path, line, "agl_m"),
                **{feature: _pixel(row, path, line, feature) for feature in FEATURES},
                box_px=_box(row, path, line),
                camera=_camera_number(row, path, line, cameras),
                reset_count=_integer(row[RESET_COLUMN], path, line, RESET_COLUMN) if row.get(RESET_COLUMN) else 0,
                reset_delta_m=_jump(row, path, line),
            )
        )
    return frames


def read_truth(path: Path) -> dict[int, Truth]:
    """Reads truth.csv into a dictionary by id."""
    path = Path(path)
    result: dict[int, Truth] = {}
    for line, row in _rows(path, TRUTH_COLUMNS, TRUTH_COLUMNS):
        key = _integer(row["id"], path, line, "id")
        if key in result:
            raise LogError(path, line, "id", f"{key} is given twice")

        def value(column: str, row: dict[str, str] = row, line: int = line) -> float:
            return _number(row[column], path, line, column)

        result[key] = Truth(
            id=key,
            static=_integer(row["static"], path, line, "static") != 0,
            center_n_m=value("center_n_m"),
            center_e_m=value("center_e_m"),
            ground_d_m=value("ground_d_m"),
            width_m=value("width_m"),
            length_m=_optional(row, path, line, "length_m"),
            height_m=value("height_m"),
            heading_deg=_optional(row, path, line, "heading_deg"),
            extra={name: text for name, text in row.items() if name not in TRUTH_COLUMNS},
        )
    return result


def read_log(folder: Path) -> ObservationLog:
    """Reads a whole log; truth.csv may be absent."""
    folder = Path(folder)
    if not folder.is_dir():
        raise LogError(folder, 0, "", "no such folder")
    truth = folder / "truth.csv"
    cameras = read_cameras(folder / "camera.ini")
    return ObservationLog(
        camera=cameras[0],
        frames=read_frames(folder / "frames.csv", len(cameras)),
        truth=read_truth(truth) if truth.exists() else {},
        camera2=cameras[1] if len(cameras) > 1 else None,
    )


# ----------------------------------------------------------------------------------------------------------- writing


def _text(value: float | None) -> str:
    """The shortest text that reads back as the same double, so that a file adds no noise; empty for None."""
    return "" if value is None else repr(float(value))


def write_camera(path: Path, camera: Camera, comment: str = "", camera2: Camera | None = None) -> None:
    lines = [f"# {line}" for line in comment.splitlines()]
    for owner, described in zip(CAMERA_NAMES, (camera, camera2)):
        if described is not None:
            lines += [f"{owner}.{name} = {_text(getattr(described, name))}" for name in CAMERA_FIELDS]
    lines.append(f"{HEADING_KEY} = {'auto' if camera.heading_deg is None else _text(camera.heading_deg)}")
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_frames(path: Path, frames: Sequence[Frame]) -> None:
    """Columns of boxes, of resets and of the camera's number stand there if a frame has any, other than 0."""
    boxes = any(frame.box_px is not None for frame in frames)
    resets = any(frame.reset_count != 0 or frame.reset_delta_m is not None for frame in frames)
    header = ["t_s", "id", "n_m", "e_m", "d_m", "agl_m", "qw", "qx", "qy", "qz", *POINT_COLUMNS]
    numbered = any(frame.camera != 0 for frame in frames)
    header += [*BOX_COLUMNS] if boxes else []
    header += [*JUMP_COLUMNS, RESET_COLUMN] if resets else []
    header += [CAMERA_COLUMN] if numbered else []
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for frame in frames:
            pixels = [getattr(frame, feature) or (None, None) for feature in FEATURES]
            numbers = [*frame.position_m, frame.agl_m, *frame.attitude, *(value for pixel in pixels for value in pixel)]
            numbers += (frame.box_px or (None,) * len(BOX_COLUMNS)) if boxes else ()
            numbers += (frame.reset_delta_m or (None,) * len(JUMP_COLUMNS)) if resets else ()
            row = [_text(frame.t_s), frame.id, *(_text(number) for number in numbers)]
            row += [frame.reset_count] if resets else []
            row += [frame.camera] if numbered else []
            writer.writerow(row)


def write_truth(path: Path, truth: dict[int, Truth]) -> None:
    extra = list(dict.fromkeys(name for entry in truth.values() for name in entry.extra))
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*TRUTH_COLUMNS, *extra])
        for entry in truth.values():
            numbers = [_text(getattr(entry, column)) for column in TRUTH_COLUMNS[2:]]
            writer.writerow([entry.id, int(entry.static), *numbers, *(entry.extra.get(name, "") for name in extra)])


def write_log(folder: Path, log: ObservationLog, comment: str = "") -> None:
    """Writes camera.ini, frames.csv and, if there is any truth, truth.csv; makes the folder."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_camera(folder / "camera.ini", log.camera, comment, log.camera2)
    write_frames(folder / "frames.csv", log.frames)
    if log.truth:
        write_truth(folder / "truth.csv", log.truth)
