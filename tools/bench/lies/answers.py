"""Runs the library over all flights of a world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import goe
import numpy as np

from .genes import Params
from .world import World

RULES = 3


@dataclass
class Answers:
    """Flat, like the world: (N,) or (N, RULES)."""

    status: np.ndarray
    estimates: np.ndarray  # of goe_estimate_t
    hazard_status: np.ndarray
    hazards: np.ndarray  # of goe_hazard_t


def rules(p: Params, i: int) -> list[goe.Rule]:
    """Rules of a flight: margin and clearance; half the margin and little clearance; later, and more of both."""
    margin, clearance = float(p["margin_m"][i]), float(p["clearance_m"][i])
    since = float(p["since_s"][i])
    return [
        goe.Rule(margin, clearance), goe.Rule(0.5 * margin, 1.0), goe.Rule(1.5 * margin, 30.0, since_image_s=since)
    ]  # fmt: skip


def rule_numbers(p: Params) -> np.ndarray:
    """(F, RULES, 3): margin, clearance, since."""
    m, c, s, zero = p["margin_m"], p["clearance_m"], p["since_s"], np.zeros(len(p["mix"]))
    rows = [[m, c, zero], [0.5 * m, 1.0 + zero, zero], [1.5 * m, 30.0 + zero, s]]
    return np.stack([np.stack(row, -1) for row in rows], 1)


SETTINGS = {  # by group of goe_settings_t: its field, and the parameter with its value
    "navigation": (
        ("attitude_bias_sd_deg", "attitude_bias"), ("attitude_white_sd_deg", "attitude_white"),
        ("attitude_walk_sd_deg", "attitude_drift"), ("height_bias_sd_m", "height_bias"),
        ("velocity_bias_sd_m_s", "velocity_bias"),
        ("position_walk_sd_m", "position_walk"), ("position_white_sd_m", "position_white"),
        ("height_white_sd_m", "height_white"),
        ("terrain_height_sd_m", "ground"), ("terrain_slope_sd", "slope"),
    ),
    "detector": (
        ("point_noise_px", "point_px"), ("point_noise_rel", "point_share"), ("point_correlation", "point_correlation"),
        ("box_noise_px", "box_px"), ("box_noise_rel", "box_share"), ("box_correlation_time_s", "correlation_s"),
        ("truncation_noise_rel", "cut_noise"),
    ),
    "filter": (
        ("prior_width_m", "typical_m"), ("range_sd_rel_max", "range_share"), ("top_is_highest", "top_is_highest"),
    ),
}  # fmt: skip
LENS_AND_PINHOLE = ("fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2", "p1", "p2")


def _camera(world: World, i: int, number: int) -> dict[str, Any]:
    p, (yaw, pitch, roll) = world.p, world.mount_deg[i, number].tolist()
    found = {name: p[name][i].item() for name in LENS_AND_PINHOLE}
    found |= {"mount_yaw_deg": yaw, "mount_pitch_deg": pitch, "mount_roll_deg": roll}
    found["offset_m"] = tuple(p[f"lever_{axis}_m"][i].item() for axis in "xyz")
    known = p["size_configured"][i]
    for own, drawn in (("width_px", "width_px"), ("height_px", "image_height_px")):
        found[own] = p[drawn][i].item() if known else 0.0
    return found


def settings(world: World, i: int) -> goe.Settings:
    """The settings for a flight."""
    p, heading = world.p, world.heading_deg[i].item()
    group = {name: {field: p[own][i].item() for field, own in rows} for name, rows in SETTINGS.items()}
    level = {"terrain_height_sd_m": "ground_drawn", "terrain_slope_sd": "slope_drawn"}
    group["navigation"] |= {name: 0.0 for name, drawn in level.items() if not p[drawn][i]}
    return goe.Settings(
        camera=goe.Camera(**_camera(world, i, 0)),
        more_cameras=(goe.Camera(**_camera(world, i, 1)),) if p["two_cameras"][i] else (),
        shape=goe.Shape(int(p["model"][i])),
        heading_deg=None if np.isnan(heading) else heading,
        navigation=goe.Navigation(**group["navigation"]),
        detector=goe.Detector(**group["detector"]),
        filter=goe.FilterSettings(**group["filter"]),
    )


def fly(world: World) -> Answers:
    count = len(world.flight)
    found = Answers(
        np.zeros(count, np.int32), np.zeros(count, goe.ESTIMATE), np.zeros((count, RULES), np.int32),
        np.zeros((count, RULES), goe.HAZARD),
    )  # fmt: skip
    velocity = world.velocity.astype(np.float32)
    for i in range(len(world.start) - 1):
        part = world.slice(i)
        track = goe.run(
            settings(world, i), world.images[part], rules=rules(world.p, i), velocity_ned_m_s=velocity[part]
        )
        found.status[part], found.estimates[part] = track.status, track.estimates
        found.hazard_status[part], found.hazards[part] = track.hazard_status, track.hazards
    return found
