"""Observation logs: a folder with camera.ini, frames.csv and, if the truth is known, truth.csv.

Frames: NED earth (north, east, down), FRD body, camera with x right, y down and z along the optical axis. Lengths
are in meters, image points in pixels from the top left corner, attitudes Hamilton quaternions (w, x, y, z) body -> NED.
An empty field means "not measured": None here. Errors carry file, line and column: LogError.
"""

from __future__ import annotations

import csv
import gc
import math
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from operator import itemgetter
from pathlib import Path
from typing import Optional

from .camera_file import CAMERA_FIELDS as CAMERA_FIELDS
from .camera_file import CAMERA_NAMES, Camera, read_cameras, shortest, write_camera
from .camera_file import CAMERA_RANGES as CAMERA_RANGES
from .camera_file import read_camera as read_camera
from .fields import (
    LogError,
    Row,
    read_fields,
    read_integer,
    read_number,
    read_optional,
    read_rows,
    warn,
    warn_of_misspelt,
)
from .whole_file import replacing_all

Pixel = tuple[float, float]
Side = Optional[float]  # Python 3.9 syntax outside annotations
Box = tuple[Side, Side, Side, Side]  # left, top, right, bottom; None: not visible
Kind = tuple[float, float, float, float, int]  # width, its sigma, height, its sigma, m; shape; 0: unknown

TIME_LIMIT_US = 9.2e18  # just inside 64 bits
FEATURES = ("left", "right", "top", "base_left", "base_near", "base_right")
POSE_COLUMNS = ("n_m", "e_m", "d_m", "qw", "qx", "qy", "qz")
REQUIRED_COLUMNS = ("t_s", "id", *POSE_COLUMNS)
POINT_COLUMNS = tuple(f"{feature}_{axis}" for feature in FEATURES for axis in "uv")
BOX_COLUMNS = ("box_left_px", "box_top_px", "box_right_px", "box_bottom_px")
RESET_COLUMN = "reset_count"
CAMERA_COLUMN = "camera"
JUMP_COLUMNS = ("reset_n_m", "reset_e_m", "reset_d_m")
SIZE_COLUMNS = ("kind_width_m", "kind_width_sd_m", "kind_height_m", "kind_height_sd_m")
SHAPE_COLUMN = "kind_shape"
SIZE_MAX_M, SIZE_SHARE_MIN, SHAPE_MAX = 1000.0, 0.01, 2  # as in goe_kind_t
FRAME_COLUMNS = (
    *REQUIRED_COLUMNS, "agl_m", *POINT_COLUMNS, *BOX_COLUMNS, CAMERA_COLUMN, RESET_COLUMN, *JUMP_COLUMNS, *SIZE_COLUMNS,
    SHAPE_COLUMN,
)  # fmt: skip
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


HINT_ROWS_MAX = 20_000  # the beginning of a longer log suffices
CONVERT_OPTIONS = {".ulg": "ulog", ".bin": "dataflash", ".tlog": "tlog"}  # of the command that reads such a file
LOG_NAMES = ("camera.ini", "frames.csv", "truth.csv", "truth_frames.csv")
SLOTS = {"slots": True} if sys.version_info >= (3, 10) else {}  # a long log has a million objects


@dataclass(**SLOTS)
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
    box_px: Box | None = None  # upright bounding box in the raw image; None: no side is visible
    camera: int = 0  # number of the camera that took the image
    reset_count: int = 0  # of the autopilot's filter
    reset_delta_m: tuple[float, float, float] | None = None  # jump of the position, NED; None: unknown
    kind: Kind | None = None  # what the detector's class says of the obstacle; None: nothing

    @property
    def height_m(self) -> float:
        """Camera height above the ground at the obstacle, m."""
        return -self.position_m[2] if self.agl_m is None else self.agl_m

    @property
    def time_us(self) -> int | None:
        """Time stamp as in the replay program: microseconds, ties to even; None if not finite or too large."""
        time_us = self.t_s * 1e6
        return round(time_us) if abs(time_us) < TIME_LIMIT_US else None


@dataclass
class Truth:
    """One row of truth.csv. ``extra`` contains further columns as text."""

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
    camera2: Camera | None = None  # camera number 1

    def resets(self) -> set[int]:
        """Ids of the tracks with a reset of the autopilot's filter."""
        return {key for key, frames in self.tracks().items() if len({frame.reset_count for frame in frames}) > 1}

    def tracks(self) -> dict[int, list[Frame]]:
        """The frames of each id, in the log's order."""
        result: dict[int, list[Frame]] = {}
        for frame in self.frames:
            result.setdefault(frame.id, []).append(frame)
        return result


# ----------------------------------------------------------------------------------------------------------- reading


def check_pairs(header: list[str], path: Path, line: int) -> None:
    """An image point needs both its columns, the size of a kind its sigma, and the jump of a reset the count."""
    for first, second in (*((f"{name}_u", f"{name}_v") for name in FEATURES), SIZE_COLUMNS[:2], SIZE_COLUMNS[2:]):
        if (first in header) != (second in header):
            raise LogError(path, line, second if first in header else first, "column is missing")
    jumps = [name for name in JUMP_COLUMNS if name in header]
    if jumps and RESET_COLUMN not in header:
        raise LogError(path, line, RESET_COLUMN, f"column is missing, but {jumps[0]} is present")


def _pixel(row: Row, path: Path, line: int, feature: str) -> Pixel | None:
    u = read_optional(row, path, line, f"{feature}_u")
    v = read_optional(row, path, line, f"{feature}_v")
    return None if u is None or v is None else (u, v)


def _box(row: Row, path: Path, line: int) -> Box | None:
    left, top, right, bottom = (read_optional(row, path, line, column) for column in BOX_COLUMNS)
    box = (left, top, right, bottom)
    return None if box == (None, None, None, None) else box


def _jump(row: Row, path: Path, line: int) -> tuple[float, float, float] | None:
    n, e, d = (read_optional(row, path, line, column) for column in JUMP_COLUMNS)
    return None if n is None or e is None or d is None else (n, e, d)


def _camera_number(row: Row, path: Path, line: int, cameras: int) -> int:
    text = row.get(CAMERA_COLUMN, "")
    number = read_integer(text, path, line, CAMERA_COLUMN) if text else 0
    if not 0 <= number < cameras:
        raise LogError(path, line, CAMERA_COLUMN, f"there is no camera {number}")
    return number


def _fault_of_kind(kind: Kind) -> tuple[str, str] | None:
    """Column and reason."""
    for column, value in zip(SIZE_COLUMNS, kind):
        if not 0.0 <= value <= SIZE_MAX_M:
            return column, f"{value:g} is out of range: 0 to {SIZE_MAX_M:g}"
    for column, size, sd in ((SIZE_COLUMNS[1], *kind[:2]), (SIZE_COLUMNS[3], *kind[2:4])):
        if sd < SIZE_SHARE_MIN * size:
            return column, f"{sd:g} is less than 1 % of {column.replace('_sd', '')}"
    if not 0 <= kind[4] <= SHAPE_MAX:
        return SHAPE_COLUMN, f"{kind[4]} is no shape: 0 unknown, 1 round, 2 not round"
    return None


def _kind(row: Row, path: Path, line: int) -> Kind | None:
    width, width_sd, height, height_sd = (read_optional(row, path, line, column) or 0.0 for column in SIZE_COLUMNS)
    shape = read_integer(row[SHAPE_COLUMN], path, line, SHAPE_COLUMN) if row.get(SHAPE_COLUMN) else 0
    kind = (width, width_sd, height, height_sd, shape)
    fault = _fault_of_kind(kind)
    if fault is not None:
        raise LogError(path, line, *fault)
    return None if kind == NO_KIND else kind


def read_features(row: Row, path: Path, line: int, cameras: int) -> dict[str, object]:
    """A detector's fields in one row, as the fields of ``Frame`` with that name: points, box, kind, camera number."""
    return {
        **{feature: _pixel(row, path, line, feature) for feature in FEATURES},
        "box_px": _box(row, path, line),
        "kind": _kind(row, path, line),
        CAMERA_COLUMN: _camera_number(row, path, line, cameras),
    }


NUMBER_COLUMNS = ("t_s", *POSE_COLUMNS, "agl_m", *POINT_COLUMNS, *BOX_COLUMNS, *JUMP_COLUMNS, *SIZE_COLUMNS)
INTEGER_COLUMNS = ("id", RESET_COLUMN, CAMERA_COLUMN, SHAPE_COLUMN)
UNUSUAL = re.compile(r"[^-+.0-9eE,]").search  # words like nan, and numbers that only Python accepts
PAIRS = range(9, 9 + len(POINT_COLUMNS), 2)  # indices in a row's numbers
BOX, JUMP = slice(PAIRS.stop, PAIRS.stop + 4), slice(PAIRS.stop + 4, PAIRS.stop + 7)
SIZES = slice(JUMP.stop, JUMP.stop + 4)
ID_DIGITS_MAX = 18  # always fits 64 bits


def _plain_frame(texts: Sequence[str], integers: Sequence[str], cameras: int) -> Frame | None:
    """Parses a row's numbers in the order of the columns above. None: the row needs the thorough parser."""
    if UNUSUAL(",".join(texts)) or "" in texts[:8]:
        return None
    try:
        row = [float(text) if text else None for text in texts]
        key, resets, camera, shape = (
            int(text) if len(text) <= ID_DIGITS_MAX and text.isdigit() else -1 for text in integers
        )
    except ValueError:
        return None
    if key < 0 or (resets < 0 and integers[1]) or (camera < 0 and integers[2]) or camera >= cameras:
        return None
    kind = (*(size or 0.0 for size in row[SIZES]), max(shape, 0))
    if (shape < 0 and integers[3]) or (kind != NO_KIND and _fault_of_kind(kind)):  # type: ignore[arg-type]
        return None
    points = [None if row[i] is None or row[i + 1] is None else (row[i], row[i + 1]) for i in PAIRS]
    box, jump = tuple(row[BOX]), tuple(row[JUMP])
    return Frame(
        row[0], key, tuple(row[1:4]), tuple(row[4:8]), row[8], *points,  # type: ignore[arg-type]
        None if box == NO_BOX else box, max(camera, 0), max(resets, 0),  # type: ignore[arg-type]
        None if None in jump else jump,  # type: ignore[arg-type]
        None if kind == NO_KIND else kind,  # type: ignore[arg-type]
    )  # fmt: skip


NO_BOX = (None,) * len(BOX_COLUMNS)
NO_KIND = (0.0, 0.0, 0.0, 0.0, 0)


@contextmanager
def _no_collection() -> Iterator[None]:
    """Rows form no reference cycles; searching for cycles among millions of them takes a third of the time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def _frame(row: Row, path: Path, line: int, cameras: int) -> Frame:
    pose = [read_optional(row, path, line, column) for column in POSE_COLUMNS]
    n, e, d, qw, qx, qy, qz = (math.nan if value is None else value for value in pose)
    return Frame(
        t_s=read_number(row["t_s"], path, line, "t_s"),
        id=read_integer(row["id"], path, line, "id"),
        position_m=(n, e, d),
        attitude=(qw, qx, qy, qz),
        agl_m=read_optional(row, path, line, "agl_m"),
        **read_features(row, path, line, cameras),  # type: ignore[arg-type]
        reset_count=read_integer(row[RESET_COLUMN], path, line, RESET_COLUMN) if row.get(RESET_COLUMN) else 0,
        reset_delta_m=_jump(row, path, line),
    )


def _is_broken(frame: Frame) -> bool:
    """Whether the pose or another number is not finite."""
    numbers = [frame.t_s, *frame.position_m, *frame.attitude, 0.0 if frame.agl_m is None else frame.agl_m]
    for feature in FEATURES:
        numbers += getattr(frame, feature) or ()
    numbers += [side for side in (*(frame.box_px or ()), *(frame.reset_delta_m or ())) if side is not None]
    return not all(map(math.isfinite, numbers))


@_no_collection()
def read_frames(path: Path, cameras: int = len(CAMERA_NAMES)) -> list[Frame]:
    """Reads frames.csv for this number of cameras. An empty pose field becomes NaN: a bad measurement, not bad input; a
    warning reports how many rows have one."""
    path = Path(path)
    frames: list[Frame] = []
    broken, first = 0, 0
    late, first_late = 0, 0
    latest: dict[int, float] = {}

    def check(header: list[str], path: Path, line: int) -> None:
        check_pairs(header, path, line)
        warn_of_misspelt(header, path, line, FRAME_COLUMNS)

    for line, header, fields in read_fields(path, REQUIRED_COLUMNS, FRAME_COLUMNS, check):
        if not frames:
            place = {name: i for i, name in enumerate(header)}
            numbers, integers = (
                itemgetter(*(place.get(name, len(header)) for name in names))
                for names in (NUMBER_COLUMNS, INTEGER_COLUMNS)
            )
        fields.append("")  # for absent columns
        frame = _plain_frame(numbers(fields), integers(fields), cameras)
        if frame is None:
            frame = _frame(dict(zip(header, fields)), path, line, cameras)
            if _is_broken(frame):
                broken, first = broken + 1, first or line
        frames.append(frame)
        if frame.t_s > latest.get(frame.id, -math.inf):
            latest[frame.id] = frame.t_s
        elif not math.isnan(frame.t_s):
            late, first_late = late + 1, first_late or line
    if broken:
        rows = "1 row" if broken == 1 else f"{broken} rows"
        warn(path, f"{rows} without a finite pose or with a number that is not finite, the first in line {first}")
    if late:
        rows = "1 row is" if late == 1 else f"{late} rows are"
        where = f"not later than the rows of the same id before, the first in line {first_late}"
        warn(path, f"t_s: {rows} {where}: goe refuses this as bad_time; sort the rows by t_s")
    return frames


def read_truth(path: Path) -> dict[int, Truth]:
    """Reads truth.csv into a dictionary by id."""
    path = Path(path)
    result: dict[int, Truth] = {}
    for line, row in read_rows(path, TRUTH_COLUMNS, TRUTH_COLUMNS):
        key = read_integer(row["id"], path, line, "id")
        if key in result:
            raise LogError(path, line, "id", f"{key} is given twice")
        if row["static"] not in ("0", "1"):
            raise LogError(path, line, "static", f"'{row['static']}' is not 0 or 1")

        def value(column: str, row: Row = row, line: int = line) -> float:
            return read_number(row[column], path, line, column)

        result[key] = Truth(
            id=key,
            static=row["static"] == "1",
            center_n_m=value("center_n_m"),
            center_e_m=value("center_e_m"),
            ground_d_m=value("ground_d_m"),
            width_m=value("width_m"),
            length_m=read_optional(row, path, line, "length_m"),
            height_m=value("height_m"),
            heading_deg=read_optional(row, path, line, "heading_deg"),
            extra={name: text for name, text in row.items() if name not in TRUTH_COLUMNS},
        )
    return result


def log_folder(path: Path) -> Path:
    """The folder of a log, also if ``path`` is a file in it, as a shell's completion may produce."""
    path = Path(path)
    if path.is_file():
        option = CONVERT_OPTIONS.get(path.suffix.lower())
        if option is not None:
            remedy = f"make an observation log of it: python -m goe_tools convert --{option}"
            raise LogError(path, 0, "", f"is an autopilot's log; {remedy}")
        reason = "is a file; name its folder"
        raise LogError(path, 0, "", f"{reason}, {path.parent}" if path.name in LOG_NAMES else f"{reason}")
    if not path.is_dir():
        raise LogError(path, 0, "", "no such folder")
    return path


def _hint(path: Path, frames: Sequence[Frame]) -> None:
    import numpy as np  # imported here: the command line starts faster without it

    from .hints import hints_of

    pose = np.array([(frame.t_s, *frame.position_m, *frame.attitude) for frame in frames], float).reshape(-1, 8)
    agl = np.array([math.nan if frame.agl_m is None else frame.agl_m for frame in frames], float)
    given = np.array([frame.agl_m is not None for frame in frames], bool)
    for hint in hints_of(pose, agl, given):
        warn(path, hint)


def read_log(folder: Path) -> ObservationLog:
    """Reads a whole log; truth.csv may be absent. Warnings report probable mistakes in it."""
    folder = log_folder(folder)
    truth = folder / "truth.csv"
    cameras = read_cameras(folder / "camera.ini")
    frames = read_frames(folder / "frames.csv", len(cameras))
    _hint(folder / "frames.csv", frames[:HINT_ROWS_MAX])
    return ObservationLog(
        camera=cameras[0],
        frames=frames,
        truth=read_truth(truth) if truth.exists() else {},
        camera2=cameras[1] if len(cameras) > 1 else None,
    )


# ----------------------------------------------------------------------------------------------------------- writing


def write_frames(path: Path, frames: Sequence[Frame]) -> None:
    """Writes the columns of boxes, resets, kinds and the camera number only if a frame has a value other than 0."""
    boxes = any(frame.box_px is not None for frame in frames)
    resets = any(frame.reset_count != 0 or frame.reset_delta_m is not None for frame in frames)
    header = ["t_s", "id", "n_m", "e_m", "d_m", "agl_m", "qw", "qx", "qy", "qz", *POINT_COLUMNS]
    kinds = any(frame.kind is not None for frame in frames)
    numbered = any(frame.camera != 0 for frame in frames)
    header += [*BOX_COLUMNS] if boxes else []
    header += [*SIZE_COLUMNS] if kinds else []
    header += [*JUMP_COLUMNS, RESET_COLUMN] if resets else []
    header += [SHAPE_COLUMN] if kinds else []
    header += [CAMERA_COLUMN] if numbered else []
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for frame in frames:
            pixels = [getattr(frame, feature) or (None, None) for feature in FEATURES]
            numbers = [*frame.position_m, frame.agl_m, *frame.attitude, *(value for pixel in pixels for value in pixel)]
            numbers += (frame.box_px or (None,) * len(BOX_COLUMNS)) if boxes else ()
            numbers += (frame.kind[:4] if frame.kind else (None,) * len(SIZE_COLUMNS)) if kinds else ()
            numbers += (frame.reset_delta_m or (None,) * len(JUMP_COLUMNS)) if resets else ()
            row = [shortest(frame.t_s), frame.id, *(shortest(number) for number in numbers)]
            row += [frame.reset_count] if resets else []
            row += [frame.kind[4] if frame.kind else 0] if kinds else []
            row += [frame.camera] if numbered else []
            writer.writerow(row)


def write_truth(path: Path, truth: dict[int, Truth]) -> None:
    extra = list(dict.fromkeys(name for entry in truth.values() for name in entry.extra))
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*TRUTH_COLUMNS, *extra])
        for entry in truth.values():
            numbers = [shortest(getattr(entry, column)) for column in TRUTH_COLUMNS[2:]]
            writer.writerow([entry.id, int(entry.static), *numbers, *(entry.extra.get(name, "") for name in extra)])


def write_log(folder: Path, log: ObservationLog, comment: str = "", inputs: Sequence[Path] = ()) -> None:
    """Writes camera.ini, frames.csv and, if there is any truth, truth.csv: all of them or none. Makes the folder.
    ``inputs``: files that it must not replace."""
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise LogError(folder, 0, "", error.strerror or str(error)) from None
    names = ["camera.ini", "frames.csv", *(["truth.csv"] if log.truth else [])]
    with replacing_all([folder / name for name in names], inputs) as (camera, frames, *truth):
        write_camera(camera, log.camera, comment, log.camera2)
        write_frames(frames, log.frames)
        for path in truth:
            write_truth(path, log.truth)
