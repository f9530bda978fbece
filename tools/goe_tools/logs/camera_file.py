"""camera.ini of an observation log: one camera or two. Errors carry file and line: LogError."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path

from .fields import LogError, read_number, read_text


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
SIZE_RANGE, PIXEL_RANGE, LENS_RANGE, ANGLE_RANGE = (1.0, 1e5), (-1e5, 1e5), (-100.0, 100.0), (-360.0, 360.0)
CAMERA_RANGES = {  # those of the library; an image has at least one pixel
    **dict.fromkeys(("width", "height", "fx", "fy"), SIZE_RANGE),
    **dict.fromkeys(("cx", "cy"), PIXEL_RANGE),
    **dict.fromkeys(("k1", "k2", "p1", "p2", "k3"), LENS_RANGE),
    **dict.fromkeys(("mount_roll_deg", "mount_pitch_deg", "mount_yaw_deg", "heading_deg"), ANGLE_RANGE),
    **dict.fromkeys(("offset_x_m", "offset_y_m", "offset_z_m"), (-1e4, 1e4)),
}
CAMERA_NAMES = ("camera", "camera2")  # prefixes of their keys


def shortest(value: float | None) -> str:
    """The shortest text that reads back as the same double, so a file adds no noise; empty for None."""
    return "" if value is None else repr(float(value))


def _key_of(key: str) -> tuple[str, str]:
    """Camera name and field of a key; both empty if it is none."""
    if key == HEADING_KEY:
        return CAMERA_NAMES[0], "heading_deg"
    owner, _, name = key.partition(".")
    return (owner, name) if owner in CAMERA_NAMES and name in CAMERA_FIELDS else ("", "")


SHORTEST = 0.05  # focal length over size, and ...
FARTHEST = 1.5  # ... focal lengths of the principal point outside the image, as in lib/goe_settings.c


def misfits(values: dict[str, float | None]) -> list[str]:
    """Keys that no camera of this size has, as goe_init() judges: a focal length too short for it, or a
    principal point too far outside."""
    bad = []
    for size_name, focal_name, center_name in (("width", "fx", "cx"), ("height", "fy", "cy")):
        size, focal, center = (values[name] or 0.0 for name in (size_name, focal_name, center_name))
        bad += [focal_name] if focal < SHORTEST * size else []
        bad += [center_name] if size and max(-center, center - size) > FARTHEST * focal else []
    return bad


def read_cameras(path: Path) -> list[Camera]:
    """Reads camera.ini with one or two cameras; an unknown, repeated, missing or non-numeric key is a LogError."""
    path = Path(path)
    found: dict[str, dict[str, float | None]] = {CAMERA_NAMES[0]: {}}
    for line, raw in enumerate(read_text(path).split("\n"), start=1):
        if "\0" in raw:
            raise LogError(path, line, "", "the line holds a NUL byte")
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
        number = read_number(value, path, line, key)
        if not math.isfinite(number):
            raise LogError(path, line, key, f"'{value}' is not finite")
        low, high = CAMERA_RANGES[name]
        if not low <= number <= high:
            raise LogError(path, line, key, f"'{value}' is out of range: {low:g} to {high:g}")
        values[name] = number
    for owner, values in found.items():
        for name in REQUIRED_CAMERA_FIELDS:
            if name not in values:
                raise LogError(path, 0, f"{owner}.{name}", "missing")
        for own in misfits(values):
            raise LogError(path, 0, f"{owner}.{own}", "does not fit the size of the image")
    heading = found[CAMERA_NAMES[0]].get("heading_deg")
    return [Camera(**values | {"heading_deg": heading}) for values in found.values()]  # type: ignore[arg-type]


def read_camera(path: Path) -> Camera:
    """Reads the camera.ini of one camera; a second camera is a LogError."""
    cameras = read_cameras(path)
    if len(cameras) > 1:
        raise LogError(path, 0, CAMERA_NAMES[1], "a second camera; this command reads logs of one camera only")
    return cameras[0]


def write_camera(path: Path, camera: Camera, comment: str = "", camera2: Camera | None = None) -> None:
    lines = [f"# {line}" for line in comment.splitlines()]
    for owner, described in zip(CAMERA_NAMES, (camera, camera2)):
        if described is not None:
            lines += [f"{owner}.{name} = {shortest(getattr(described, name))}" for name in CAMERA_FIELDS]
    lines.append(f"{HEADING_KEY} = {'auto' if camera.heading_deg is None else shortest(camera.heading_deg)}")
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")
