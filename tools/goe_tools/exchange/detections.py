"""A detector's output as a table: frames.csv without the pose.

t_s (time of exposure, s, the camera's clock), id, and the columns of frames.csv for points, boxes, the class's size and
the camera's number, with the same meaning; other columns are ignored."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from ..logs.fields import LogError, read_integer, read_number, read_rows, warn_of_misspelt
from ..logs.obslog import (
    BOX_COLUMNS,
    CAMERA_COLUMN,
    FEATURES,
    POINT_COLUMNS,
    SHAPE_COLUMN,
    SIZE_COLUMNS,
    Frame,
    check_pairs,
    read_features,
)

REQUIRED = ("t_s", "id")
NOWHERE = (math.nan,) * 3
NO_ATTITUDE = (math.nan,) * 4


def read_detections(path: Path, cameras: int) -> list[Frame]:
    """Rows in the order of time, with NaN poses. LogError: no detector column, a time that is not finite, or a time not
    after that of the same id's previous row."""
    path, result = Path(path), []
    latest: dict[int, float] = {}
    known = (*POINT_COLUMNS, *BOX_COLUMNS)
    used = (*REQUIRED, *known, *SIZE_COLUMNS, SHAPE_COLUMN, CAMERA_COLUMN)

    def check(header: list[str], path: Path, line: int) -> None:
        check_pairs(header, path, line)
        warn_of_misspelt(header, path, line, used)
        if not any(name in header for name in known):
            raise LogError(path, line, BOX_COLUMNS[0], "column is missing, and so are all others of points and boxes")

    for line, row in read_rows(path, REQUIRED, used, check):
        t_s, key = read_number(row["t_s"], path, line, "t_s"), read_integer(row["id"], path, line, "id")
        if not math.isfinite(t_s):
            raise LogError(path, line, "t_s", f"'{row['t_s']}' is not finite")
        if t_s <= latest.get(key, -math.inf):
            raise LogError(path, line, "t_s", f"{t_s:g} s does not come after {latest[key]:g} s, of the same id {key}")
        latest[key] = t_s
        features = read_features(row, path, line, cameras)
        result.append(Frame(t_s, key, NOWHERE, NO_ATTITUDE, **features))  # type: ignore[arg-type]
    if not result:
        raise LogError(path, 0, "", "there are no rows")
    return sorted(result, key=lambda frame: frame.t_s)


def sees(frame: Frame) -> bool:
    """Whether the row has a detection."""
    box = frame.box_px is not None
    return box or any(getattr(frame, name) is not None for name in FEATURES)


def by_id(frames: Sequence[Frame]) -> dict[int, list[Frame]]:
    result: dict[int, list[Frame]] = {}
    for frame in frames:
        result.setdefault(frame.id, []).append(frame)
    return result
