"""An observation log and its estimates as messages: Foxglove's schemas for drawings, plain numbers for plots.

Topics, all JSON; lengths in m, angles in degrees, quaternions (x, y, z, w). Foxglove draws with z up: its frame "map"
is east, north, up, and "body" is forward, left, up.

    /pose               foxglove.PoseInFrame     the vehicle in "map"
    /tf                 foxglove.FrameTransform  "map" -> "body"
    /obstacles          foxglove.SceneUpdate     for each id a cylinder or a box at the estimated place, and two sigmas
    /truth              foxglove.SceneUpdate     the content of truth.csv, once
    /estimate/ID        goe.Estimate             a row of goe_replay as numbers, without unknown quantities
    /observation/ID     goe.Observation          the row of frames.csv, likewise"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..logs.estimates import Estimate
from ..logs.obslog import BOX_COLUMNS, FEATURES, SHAPE_COLUMN, SIZE_COLUMNS, Frame, Truth

Json = dict[str, Any]
NS = 1_000_000_000
TWO_SIGMA = 2.0
UNKNOWN_HEIGHT_M = 1.0
FRESH = ("ok", "partial")  # status of an estimate solved from its own image
FOUND, STALE, TRUE = (0.10, 0.45, 0.85, 0.8), (0.85, 0.45, 0.10, 0.8), (0.25, 0.65, 0.30, 0.5)
REGION_ALPHA = 0.2
REGION_HEIGHT_M = 0.1

NUMBER = {"type": "number"}
TEXT = {"type": "string"}
TIME = {"type": "object", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}}


def _object(**properties: Json) -> Json:
    return {"type": "object", "properties": properties}


def _list(items: Json) -> Json:
    return {"type": "array", "items": items}


VECTOR = _object(x=NUMBER, y=NUMBER, z=NUMBER)
QUATERNION = _object(x=NUMBER, y=NUMBER, z=NUMBER, w=NUMBER)
POSE = _object(position=VECTOR, orientation=QUATERNION)
COLOR = _object(r=NUMBER, g=NUMBER, b=NUMBER, a=NUMBER)
CUBE = _object(pose=POSE, size=VECTOR, color=COLOR)
CYLINDER = _object(pose=POSE, size=VECTOR, bottom_scale=NUMBER, top_scale=NUMBER, color=COLOR)
PAIR = _object(key=TEXT, value=TEXT)
ENTITY = _object(
    timestamp=TIME, frame_id=TEXT, id=TEXT, lifetime=TIME, frame_locked={"type": "boolean"}, metadata=_list(PAIR),
    arrows=_list(_object()), cubes=_list(CUBE), spheres=_list(_object()), cylinders=_list(CYLINDER),
    lines=_list(_object()), triangles=_list(_object()), texts=_list(_object()), models=_list(_object()),
)  # fmt: skip
DELETION = _object(timestamp=TIME, type={"type": "integer"}, id=TEXT)
SCHEMAS = {
    "foxglove.PoseInFrame": _object(timestamp=TIME, frame_id=TEXT, pose=POSE),
    "foxglove.FrameTransform": _object(
        timestamp=TIME, parent_frame_id=TEXT, child_frame_id=TEXT, translation=VECTOR, rotation=QUATERNION
    ),
    "foxglove.SceneUpdate": _object(deletions=_list(DELETION), entities=_list(ENTITY)),
}


def plain_schema(names: list[str]) -> Json:
    """Schema of a message with these numbers, a time stamp and words."""
    words = {name: TEXT for name in ("status", "model", "reason")}
    return _object(timestamp=TIME, **words, **{name: NUMBER for name in names if name not in words})


def nanoseconds(t_s: float) -> int:
    return round(t_s * 1e6) * 1000


def _time(t_s: float) -> Json:
    sec, nsec = divmod(nanoseconds(t_s), NS)
    return {"sec": sec, "nsec": nsec}


def _vector(x: float, y: float, z: float) -> Json:
    return {"x": float(x), "y": float(y), "z": float(z)}


def _color(rgba: tuple[float, float, float, float], alpha: float | None = None) -> Json:
    r, g, b, a = rgba
    return {"r": r, "g": g, "b": b, "a": a if alpha is None else alpha}


# -------------------------------------------------------------------------------------------------------------- frames


def _up(n: float, e: float, d: float) -> Json:
    """NED as east, north, up."""
    return _vector(e, n, -d)


def turned_up(attitude: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    """(w, x, y, z) body FRD -> NED as (w, x, y, z) body forward, left, up -> east, north, up."""
    w, x, y, z = attitude
    half = math.sqrt(0.5)
    return half * (w + z), half * (x + y), half * (x - y), half * (w - z)


def _quaternion(wxyz: tuple[float, float, float, float]) -> Json:
    w, x, y, z = (float(value) for value in wxyz)
    return {"x": x, "y": y, "z": z, "w": w}


def heading_turn(heading_deg: float) -> tuple[float, float, float, float]:
    """(w, x, y, z): turns x to that heading, clockwise from north, in east, north, up."""
    angle = math.radians(90.0 - heading_deg)
    return math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)


def pose_messages(frame: Frame) -> tuple[Json, Json]:
    """PoseInFrame and FrameTransform of the vehicle."""
    place, turn, time = _up(*frame.position_m), _quaternion(turned_up(frame.attitude)), _time(frame.t_s)
    pose = {"timestamp": time, "frame_id": "map", "pose": {"position": place, "orientation": turn}}
    names = {"parent_frame_id": "map", "child_frame_id": "body"}
    return pose, {"timestamp": time, **names, "translation": place, "rotation": turn}


# --------------------------------------------------------------------------------------------------------------- scene


def _entity(t_s: float, name: str, cubes: list[Json], cylinders: list[Json], metadata: dict[str, str]) -> Json:
    empty: dict[str, list[Json]] = {kind: [] for kind in ("arrows", "spheres", "lines", "triangles", "texts", "models")}
    pairs = [{"key": key, "value": value} for key, value in metadata.items()]
    return {
        "timestamp": _time(t_s), "frame_id": "map", "id": name, "lifetime": {"sec": 0, "nsec": 0},
        "frame_locked": False, "metadata": pairs, "cubes": cubes, "cylinders": cylinders, **empty,
    }  # fmt: skip


def _update(entities: list[Json]) -> Json:
    return {"deletions": [], "entities": entities}


def _shape(place: Json, heading_deg: float, size: Json, color: Json, scale: bool) -> Json:
    pose = {"position": place, "orientation": _quaternion(heading_turn(heading_deg))}
    return {"pose": pose, "size": size, "color": color, **({"bottom_scale": 1.0, "top_scale": 1.0} if scale else {})}


def obstacle_message(frame: Frame, estimate: Estimate, heading_deg: float, ground_d_m: float) -> Json | None:
    """SceneUpdate of an estimate; None without an estimated center. ``heading_deg``: of the trajectory frame's Z axis.
    The region covers two sigmas north and east, without their correlation."""
    values = estimate.values
    if "center_n_m" not in values or "center_e_m" not in values:
        return None
    n, e = values["center_n_m"], values["center_e_m"]
    height = values.get("height_m", UNKNOWN_HEIGHT_M)
    width = values.get("width_m", UNKNOWN_HEIGHT_M)
    middle, ground = _up(n, e, ground_d_m - 0.5 * height), _up(n, e, ground_d_m)
    color = FOUND if estimate.status in FRESH else STALE
    cubes, cylinders = [], []
    if "length_m" in values and "orientation_deg" in values:
        size = _vector(values["length_m"], width, height)
        cubes.append(_shape(middle, heading_deg + values["orientation_deg"], size, _color(color), False))
    else:
        cylinders.append(_shape(middle, 90.0, _vector(width, width, height), _color(color), True))
    spread = [2.0 * TWO_SIGMA * values[f"center_{axis}_sd_m"] for axis in "en"]
    region = _vector(*spread, REGION_HEIGHT_M)
    cylinders.append(_shape(ground, 90.0, region, _color(color, REGION_ALPHA), True))
    metadata = {"model": estimate.model, "status": estimate.status}
    if estimate.suspect:
        metadata["suspect"] = estimate.reason
    return _update([_entity(frame.t_s, f"obstacle {frame.id}", cubes, cylinders, metadata)])


def truth_message(t_s: float, truth: Truth) -> Json:
    middle = _up(truth.center_n_m, truth.center_e_m, truth.ground_d_m - 0.5 * truth.height_m)
    if truth.length_m is None or truth.heading_deg is None:
        size = _vector(truth.width_m, truth.width_m, truth.height_m)
        shapes = [], [_shape(middle, 90.0, size, _color(TRUE), True)]
    else:
        size = _vector(truth.length_m, truth.width_m, truth.height_m)
        shapes = [_shape(middle, truth.heading_deg, size, _color(TRUE), False)], []
    return _update([_entity(t_s, f"truth {truth.id}", *shapes, {"static": str(int(truth.static))})])


# ------------------------------------------------------------------------------------------------------------- numbers


def estimate_message(t_s: float, estimate: Estimate) -> Json:
    words = {
        "timestamp": _time(t_s),
        "status": estimate.status,
        "model": estimate.model,
        "images_used": estimate.images_used,
    }
    doubt = {"suspect": int(estimate.suspect), "reason": estimate.reason}  # plots need numbers
    return {**words, **estimate.values, **doubt}


def observation_numbers(frame: Frame) -> dict[str, float | None]:
    """Every column of frames.csv, with the values of this row."""
    names = ("n_m", "e_m", "d_m", "qw", "qx", "qy", "qz")
    result: dict[str, float | None] = dict(zip(names, (*frame.position_m, *frame.attitude)))
    result["agl_m"] = frame.agl_m
    for name in FEATURES:
        point = getattr(frame, name)
        result[f"{name}_u"], result[f"{name}_v"] = (None, None) if point is None else point
    result |= dict(zip(BOX_COLUMNS, frame.box_px or (None,) * len(BOX_COLUMNS)))
    if frame.kind is not None:
        result |= dict(zip((*SIZE_COLUMNS, SHAPE_COLUMN), frame.kind))
    return result | {"reset_count": frame.reset_count, "camera": frame.camera}


def observation_message(frame: Frame) -> Json:
    numbers = {name: float(value) for name, value in observation_numbers(frame).items() if value is not None}
    return {"timestamp": _time(frame.t_s), **{name: value for name, value in numbers.items() if np.isfinite(value)}}
