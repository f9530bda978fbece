"""A find as a log for goe_replay, plus find.json with the content that a log lacks: settings, plan, error."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import goe
import numpy as np
from goe_tools.logs.obslog import Camera, Frame, ObservationLog, Truth, write_log

from . import answers, judge, search
from .finds import CAUSES, COLUMNS, KINDS
from .genes import MIXES
from .search import Flown
from .shrink import Want, hits
from .world import World

TRACK = 1
POINTS = goe.POINTS
SIDE_BITS = (1, 2, 4, 8)
CAMERA_INI = ("fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2", "p1", "p2", "mount_", "offset_m", "heading")


def _camera(world: World, number: int) -> Camera:
    p, (yaw, pitch, roll) = world.p, (float(angle) for angle in world.mount_deg[0, number])

    def of(name: str) -> float:
        return float(p[name][0])

    heading = float(world.heading_deg[0])
    return Camera(
        of("width_px"), of("image_height_px"), of("fx_px"), of("fy_px"), of("cx_px"), of("cy_px"), of("k1"), of("k2"),
        of("p1"),
        of("p2"), 0.0, roll, pitch, yaw, of("lever_x_m"), of("lever_y_m"), of("lever_z_m"),
        None if np.isnan(heading) else heading,
    )  # fmt: skip


def _short(value: np.floating[Any] | float) -> float:
    """The shortest decimal number with the same single-precision value."""
    return float(str(np.float32(value))) + 0.0


def _triple(values: np.ndarray) -> tuple[float, float, float]:
    a, b, c = (_short(value) for value in values)
    return a, b, c


def _frame(image: np.ndarray, reset: bool) -> Frame:
    """``reset``: the filter's counter changed with this image."""
    pose, box = image["pose"], image["box"]
    w, x, y, z = (_short(value) for value in pose["attitude"])
    pixels = {
        name: (_short(image[name]["u_px"]), _short(image[name]["v_px"])) for name in POINTS if image[name]["visible"]
    }
    sides = tuple(_short(box[f"{side}_px"]) if box["sides"] & bit else None for side, bit in zip(goe.SIDES, SIDE_BITS))
    known = reset and pose["reset_delta_known"]
    return Frame(
        float(pose["time_us"]) / 1e6, TRACK, _triple(pose["position_ned_m"]), (w, x, y, z), _short(pose["height_m"]),
        **pixels, box_px=sides if box["sides"] else None, camera=int(image["camera"]),
        reset_count=int(pose["reset_count"]),
        reset_delta_m=_triple(pose["reset_delta_ned_m"]) if known else None,
    )  # type: ignore[arg-type]  # fmt: skip


def _truth(world: World) -> Truth:
    origin = [float(world.p[f"origin_{axis}_m"][0]) for axis in "ned"]
    solid, is_round = world.solid, bool(world.solid.round[0])
    north, east = (float(value) for value in solid.center[0])
    return Truth(
        TRACK, True, north + origin[0], east + origin[1], origin[2], 2.0 * float(solid.half[0, 1]),
        None if is_round else 2.0 * float(solid.half[0, 0]),
        float(world.height_m[0]), None if is_round else float(np.degrees(solid.heading[0])),
    )  # fmt: skip


def log_of(world: World) -> ObservationLog:
    """The log of one flight."""
    count = world.images["pose"]["reset_count"]
    frames = [_frame(world.images[k], k > 0 and count[k] != count[k - 1]) for k in range(len(count))]
    camera2 = _camera(world, 1) if world.p["two_cameras"][0] else None
    return ObservationLog(_camera(world, 0), frames, {TRACK: _truth(world)}, camera2)


def settings_beyond(world: World) -> dict[str, float]:
    """Settings that are not in camera.ini and differ from the defaults: for goe_replay --set."""
    numbers = answers.settings(world, 0).numbers()
    rows = {row.name: (number, row.default) for row, number in zip(goe.setting_rows(), numbers)}
    found = {name: float(number) for name, (number, usual) in rows.items() if number != np.float32(usual)}
    found = {name: value for name, value in found.items() if not name.startswith(("camera.", "heading"))}
    return found if world.p["size_configured"][0] else found | {"camera.width_px": 0.0, "camera.height_px": 0.0}


def _wrong(flown: Flown, want: Want, k: int) -> tuple[str, int]:
    """The error in words, and the plan in which it appears."""
    violation, lies = flown.found.hazards["conflict_probability"], flown.lies
    if want.kind == KINDS[0]:
        rule = int(np.argmax(np.nan_to_num(np.abs(flown.judged.hazard_ratio[k])).max(1)))
        return f"{want.what} is {lies.ratio[k, COLUMNS.index(want.what)]:.1f} sigma off", rule
    safe = want.kind == KINDS[1]
    rules = lies.false_safety[k] if safe else lies.vanished[k] & (lies.cause[k] == CAUSES.index(want.what))
    rule = int(np.argmax(rules))
    miss, clearance = flown.judged.met[k, rule]
    truth = f"in truth {miss:.1f} m from the outline and {clearance:.1f} m over the top"
    now = "no answer" if flown.found.hazard_status[k, rule] else f"{violation[k, rule]:.3g}"
    if safe:
        return f"violation {now}, {truth}", rule
    return f"violation {violation[k - 1, rule]:.3g}, then {now} ({want.what}); {truth}", rule


def describe(flown: Flown, want: Want) -> dict[str, Any]:
    k = int(np.flatnonzero(hits(flown, want))[0])
    world, e = flown.world, flown.found.estimates[k]
    wrong, rule = _wrong(flown, want, k)
    velocity, numbers = _triple(world.velocity[k]), answers.rule_numbers(world.p)[0, rule].tolist()
    plan = dict(zip(("velocity_ned_m_s", "margin_m", "clearance_m", "since_image_s"), (velocity, *numbers)))
    more = settings_beyond(world)
    model = more.pop("model", None)
    options = [f"--set {name}={value:.9g}" for name, value in more.items()]
    options += [] if model is None else [f"--model={goe.Shape(int(model))}"]
    return {
        "kind": want.kind, "what": want.what, "wrong": wrong, "image": k,
        "status": str(goe.Status(int(flown.found.status[k]))),
        "mix": MIXES[int(world.p["mix"][0])], "model": judge.MODELS[int(e["model"])], "library": goe.FINGERPRINT,
        "noise": {name: bool(world.p[f"{name}_scale"][0]) for name in ("constant", "pose", "pixel")},
        "plan": plan, "replay": " ".join(["goe_replay", *options]),
    }  # fmt: skip


def write(folder: Path, world: World, want: Want) -> dict[str, Any]:
    """Writes the log and find.json of one flight."""
    found = describe(search.look_at(world), want)
    write_log(folder, log_of(world), f"{found['mix']}, image {found['image']}: {found['wrong']}")
    (folder / "find.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    return found
