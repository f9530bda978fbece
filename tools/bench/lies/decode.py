"""The parameters of flights, in physical units, from unit numbers."""

from __future__ import annotations

import goe
import numpy as np

from .genes import (
    BASE,
    BOXES,
    BOXES_BASE,
    CLIMBING,
    DEFAULTS,
    INDEX,
    NO_RESET,
    ORBIT,
    OUTLINES,
    POINTS,
    SWAYING,
    TURNING,
    WEAVING,
    Array,
    Flights,
    Params,
)  # fmt: skip

CYLINDERS = (  # least and most diameter, least and most height, m
    (0.5, 3.0, 10.0, 80.0),  # mast
    (2.0, 12.0, 8.0, 80.0),  # chimney
    (4.0, 25.0, 3.0, 20.0),  # tank
)
CUBOIDS = (  # least and most width, least and most length, least and most height, m
    (1.6, 2.0, 3.6, 5.0, 1.3, 1.9),  # car
    (2.3, 2.6, 5.5, 16.0, 2.5, 4.2),  # truck
    (6.0, 15.0, 6.0, 20.0, 4.0, 12.0),  # house
    (10.0, 30.0, 10.0, 60.0, 8.0, 80.0),  # building
    (1.0, 4.0, 5.0, 40.0, 1.5, 10.0),  # wall
    (3.0, 10.0, 3.0, 10.0, 15.0, 80.0),  # tower
)
FLATTEST = 10.0  # length over width
RANGE_M = (30.0, 400.0)
IMAGES_LEAST, IMAGES_MOST = 30, 120
SIZES = np.array([640.0, 960.0, 1280.0, 1920.0])
ASPECTS = np.array([1.0, 4.0 / 3.0, 16.0 / 9.0])
MARGINS = np.array([3.0, 5.0, 10.0, 15.0, 25.0])
CLEARANCES = np.array([2.0, 5.0, 10.0, 20.0])
TYPICAL_M, TYPICAL_FACTOR = 6.0, 3.0
HIDDEN_MOST_M, HIDDEN_SHARE_MOST = 2.0, 0.3  # of the height
SPREAD = 4.0  # drawn noise is at most this factor above or below the default


def log(u: Array, low: Array | float, high: Array | float) -> Array:
    return np.asarray(low * (np.asarray(high) / low) ** u)


def linear(u: Array, low: Array | float, high: Array | float) -> Array:
    return np.asarray(low + (np.asarray(high) - low) * u)


def pick(u: Array, among: np.ndarray) -> np.ndarray:
    return np.asarray(among[np.minimum((u * len(among)).astype(int), len(among) - 1)])


def rest(u: Array, share: float) -> Array:
    """Maps the part below ``share`` to 0 to 1."""
    return np.minimum(u / share, 1.0)


class Units:
    """Columns by name."""

    def __init__(self, unit: Array) -> None:
        self.unit = unit

    def __getitem__(self, name: str) -> Array:
        return self.unit[:, INDEX[name]]


def _shape(g: Units, mix: np.ndarray) -> Params:
    is_round = np.where(mix == POINTS, True, np.where(mix == BOXES, g["round"] < 0.4, False))
    cylinder, cuboid = pick(g["kind"], np.array(CYLINDERS)), pick(g["kind"], np.array(CUBOIDS))
    a = np.where(
        is_round, log(g["size_a"], cylinder[:, 0], cylinder[:, 1]), log(g["size_a"], cuboid[:, 0], cuboid[:, 1])
    )
    b = np.where(is_round, a, log(g["size_b"], cuboid[:, 2], cuboid[:, 3]))
    b = np.where(~is_round & (g["square"] < 0.1), a, np.minimum(b, FLATTEST * a))
    low, high = (np.where(is_round, cylinder[:, i], cuboid[:, j]) for i, j in ((2, 4), (3, 5)))
    turned = np.where(g["turned"] < 0.15, 0.0, rest(g["turned"] - 0.15, 0.85) * 180.0)
    return {
        "round": is_round,
        "a_m": a,
        "b_m": b,
        "h_m": np.clip(log(g["size_h"], low, high), 1.0, 80.0),
        "turned_deg": turned,
    }


def _motion(g: Units, h_m: Array, around_m: Array) -> Params:
    above = g["roof"] < 0.5
    height = np.where(above, h_m + log(g["height"], 2.0, 40.0), np.maximum(h_m * linear(g["height"], 0.1, 1.0), 2.0))
    kind = np.minimum((g["flight_kind"] * 6).astype(int), ORBIT)
    signed = np.where(g["side"] < 0.5, -1.0, 1.0)
    images = np.floor(IMAGES_LEAST + (IMAGES_MOST - IMAGES_LEAST + 0.99) * g["images"] ** 8)
    rate, speed = log(g["rate"], 4.0, 15.0), log(g["speed"], 5.0, 30.0)
    flown = speed * images / rate
    climb = linear(g["climb"], -0.09, 0.09) * speed
    swaying = (kind == SWAYING) | (g["amplitude"] > 0.8)
    return {
        "speed_m_s": speed, "rate_hz": rate, "images": images.astype(int), "height_m": np.clip(height, 2.0, 60.0),
        "kind": kind, "range_m": np.maximum(np.clip(flown * log(g["reach"], 0.6, 4.0), *RANGE_M), around_m + 12.0),
        "side": signed,
        "course_deg": 360.0 * g["course"], "sway_deg": np.where(swaying, linear(g["amplitude"], 2.0, 20.0), 0.0),
        "weave_deg": np.where(kind == WEAVING, linear(g["amplitude"], 3.0, 25.0), 0.0),
        "period_s": log(g["period"], 3.0, 15.0), "phase_rad": 2.0 * np.pi * g["phase"],
        "climb_m_s": np.where(kind == CLIMBING, climb, 0.0),
        "turn_deg_s": np.where(kind == TURNING, signed * log(g["amplitude"], 1.0, 15.0), 0.0),
        "crab_deg": np.where(g["crab"] < 0.3, linear(rest(g["crab"], 0.3), -15.0, 15.0), 0.0),
        "mid": g["mid"], "jitter": np.where(g["jitter"] < 0.3, rest(g["jitter"], 0.3) * 0.6, 0.0),
    }  # fmt: skip


def _camera(g: Units) -> Params:
    width = pick(g["image_size"], SIZES)
    height = np.round(width / pick(g["aspect"], ASPECTS))
    fx = 0.5 * width / np.tan(np.radians(0.5 * linear(g["view_angle"], 45.0, 100.0)))
    corner = np.hypot(0.5 * width / fx, 0.5 * height / fx)
    lens, lever = g["lens"] < 0.2, g["lever"] < 0.4
    return {
        "width_px": width, "image_height_px": height, "fx_px": fx,
        "fy_px": fx * np.where(g["pixel_shape"] < 0.8, 1.0, linear(g["pixel_shape"], 0.9, 1.1)),
        "cx_px": width * linear(g["center"], 0.47, 0.53), "cy_px": height * linear(1.0 - g["center"], 0.47, 0.53),
        "k1": np.where(lens, linear(g["lens_k1"], -0.1, 0.08), 0.0) / corner**2,
        "k2": np.where(lens, linear(g["lens_k2"], -0.015, 0.02), 0.0) / corner**4,
        "p1": np.where(lens, linear(g["lens_p1"], -2e-3, 2e-3), 0.0),
        "p2": np.where(lens, linear(g["lens_p2"], -2e-3, 2e-3), 0.0),
        "look": g["look"] < 0.5,
        "mount_roll_deg": np.where(g["mount_roll"] < 0.7, 0.0, linear(g["mount_roll"], -10.0, 10.0)),
        "jitter_yaw_deg": linear(g["mount_jitter_yaw"], -8.0, 8.0),
        "jitter_pitch_deg": linear(g["mount_jitter_pitch"], -6.0, 6.0),
        "lever_x_m": np.where(lever, linear(g["lever_x"], -1.0, 3.0), 0.0),
        "lever_y_m": np.where(lever, linear(g["lever_y"], -2.0, 2.0), 0.0),
        "lever_z_m": np.where(lever, linear(g["lever_z"], -0.5, 0.5), 0.0), "size_configured": g["size_known"] < 0.85,
        "heading_auto": g["heading_auto"] < 0.75, "heading_off_deg": linear(g["heading"], -40.0, 40.0),
        "two_cameras": (g["cameras"] < 0.06) & (goe.CAMERAS_MAX > 1),
        "second_yaw_deg": linear(g["second_yaw"], -40.0, 40.0),
        "second_share": g["second_share"],
    }  # fmt: skip


def _noise(g: Units, mix: np.ndarray) -> Params:
    boxes = (mix == BOXES) | (mix == BOXES_BASE)
    found: Params = {}
    for name, usual in DEFAULTS.items():
        u = g[name]
        found[name] = np.where(u < 0.5, usual, log(rest(u - 0.5, 0.5), usual / SPREAD, usual * SPREAD))
    found["point_px"] = np.clip(found["point_px"], 0.1, 2.0)

    def some(name: str, share: float, low: float, high: float) -> Array:
        return np.where(g[name] < share, log(rest(g[name], share), low, high), 0.0)

    found["attitude_drift"] = some("attitude_drift", 0.2, 0.01, 0.2)
    found["position_white"] = np.where(boxes, some("position_white", 0.2, 0.02, 0.5), 0.0)
    found["height_white"] = some("height_white", 0.2, 0.05, 1.0)
    found["point_share"] = some("point_share", 0.2, 0.005, 0.1)
    found["point_correlation"] = np.where(g["point_correlation"] < 0.2, 0.9 * rest(g["point_correlation"], 0.2), 0.0)
    found["cut_noise"] = np.where(g["cut_noise"] < 0.3, log(rest(g["cut_noise"], 0.3), 0.03, 0.2), 1.0)
    found["cut_drawn"] = g["cut_noise"] < 0.3
    found["slope_drawn"] = g["slope_drawn"] < 0.5
    found["ground_drawn"] = (mix == BOXES) | ((mix == BOXES_BASE) & (g["ground_drawn"] < 0.5))
    return found


def _hidden(g: Units, mix: np.ndarray, h_m: Array) -> Params:
    """Bushes in front of the base: a box's bottom is that of the visible part, and base corners are invisible."""
    there = ((mix == BOXES) | (mix == BOXES_BASE)) & (g["hidden"] < 0.2)
    most = np.minimum(HIDDEN_MOST_M, HIDDEN_SHARE_MOST * h_m)
    return {"hidden_m": np.where(there, g["hidden_share"] * most, 0.0), "hidden_always": g["hidden_always"] < 0.5}


def _typical(g: Units, p: Params) -> Params:
    """The default if it is correct to a factor of 3."""
    width = np.sqrt(p["a_m"] * p["b_m"])
    near = (width > TYPICAL_M / TYPICAL_FACTOR) & (width < TYPICAL_M * TYPICAL_FACTOR) & (g["typical"] < 0.5)
    wide = width * TYPICAL_FACTOR ** linear(g["typical"], -1.0, 1.0)
    return {"typical_m": np.where(near, TYPICAL_M, np.clip(wide, 0.15, 900.0))}


def _features(g: Units, mix: np.ndarray, is_round: np.ndarray) -> Params:
    base = (mix == BASE) | (mix == BOXES_BASE)
    top = np.select([mix == OUTLINES, mix == BASE], [0.5, 0.8], 0.9)
    subset = 1 + (rest(g["base_subset"] - 0.75, 0.25) * 2.999).astype(int)
    return {
        "top_is_highest": (g["top_is_highest"] < 0.3) & (g["sides_raw"] < 0.5), "sides_raw": g["sides_raw"] < 0.5,
        "side_height": g["side_height"],
        "has_top": g["top_seen"] < top,
        "has_sides": np.where(mix == BASE, g["sides_seen"] < 0.75, True), "has_base": base,
        "has_box": (mix == BOXES) | (mix == BOXES_BASE),
        "base_subset": np.where(g["base_subset"] < 0.75, 0, subset),
        "has_bottom": g["bottom_seen"] < 0.88, "cut_reported": g["cut_reported"] < 0.5,
        "model": np.where(base & (g["model"] < 0.15), 3, np.where(is_round & (g["model"] < 0.15), 2, 1)),
        "range_share": np.where(g["range_share"] < 0.8, 0.25, linear(g["range_share"], 0.1, 0.5)),
    }  # fmt: skip


def _disturbances(g: Units) -> Params:
    any_of_them = g["disturbed"] > 0.25

    def on(name: str, share: float) -> np.ndarray:
        return np.asarray(any_of_them & (g[name] < share))

    def jump(name: str) -> Array:
        u = g[name]
        return np.where(u < 0.5, -1.0, 1.0) * log(np.abs(2.0 * u - 1.0), 0.3, 20.0)

    return {
        "missed_share": np.where(on("missed", 0.3), linear(g["missed_share"], 0.03, 0.4), 0.0),
        "every_n": np.where(on("every", 0.15), 2 + np.floor(4.99 * g["every_n"]), 0).astype(int),
        "runs": np.where(on("runs", 0.3), 1 + (g["two_runs"] < 0.3), 0), "run_s": linear(g["run_s"], 1.0, 3.0),
        "run_at": g["run_at"], "run_at_2": g["run_at_2"],
        "gap_s": np.where(on("gaps", 0.2), linear(g["gap_s"], 0.5, 3.0), 0.0),
        "gap_at": g["gap_at"], "partly_share": np.where(on("partly", 0.25), linear(g["partly_share"], 0.03, 0.5), 0.0),
        "reset_kind": np.where(on("reset", 0.35), 1 + np.minimum((3 * g["reset_kind"]).astype(int), 2), NO_RESET),
        "reset_n_m": jump("reset_n"), "reset_e_m": jump("reset_e"), "reset_d_m": jump("reset_d"),
        "reset_at": g["reset_at"],
        "resets": 1 + (g["reset_again"] < 0.3), "height_follows": g["height_follows"] < 0.5,
        "unknown": on("unknown", 0.12), "unknown_at": g["unknown_at"], "refused": on("refused", 0.12),
        "refused_at": g["refused_at"], "refused_kind": np.minimum((3 * g["refused_kind"]).astype(int), 2),
        "pre_turn": on("pre_turn", 0.2), "pre_turn_deg": linear(g["pre_turn_angle"], -180.0, 180.0),
    }  # fmt: skip


def _plan(g: Units) -> Params:
    kind, climb, sink = g["plan_kind"], linear(g["plan_climb"], 0.5, 6.0), linear(g["plan_climb"], -5.0, -0.5)
    return {
        "margin_m": pick(g["margin"], MARGINS), "clearance_m": pick(g["clearance"], CLEARANCES),
        "plan_climb_m_s": np.select([kind < 0.4, kind < 0.55, kind < 0.7], [0.0, climb, sink], np.nan),
        "plan_turn_deg": np.where(g["plan_turn"] < 0.25, linear(rest(g["plan_turn"], 0.25), -25.0, 25.0), 0.0),
        "plan_hold": np.where(g["plan_hold"] < 0.5, 1000, 10),
        "since_s": np.where(g["since"] < 0.3, rest(g["since"], 0.3), 0.0),
        "offset": g["offset"],
    }  # fmt: skip


def decode(flights: Flights) -> Params:
    """Parameters, in the units of their names; noise as in the settings of goe.h."""
    g, mix = Units(flights.unit), flights.mix
    p: Params = {"mix": mix, "seed": flights.seed} | _shape(g, mix)
    p |= _motion(g, p["h_m"], 0.5 * np.hypot(p["a_m"], p["b_m"])) | _camera(g) | _features(g, mix, p["round"])
    p |= _disturbances(g) | _plan(g) | _noise(g, mix) | _typical(g, p) | _hidden(g, mix, p["h_m"])
    origin = {f"origin_{axis}_m": linear(g[f"origin_{axis}"], -300.0, 300.0) for axis in "ned"}
    ones = {f"{name}_scale": np.ones(len(mix)) for name in ("constant", "pose", "pixel")}
    return p | origin | ones
