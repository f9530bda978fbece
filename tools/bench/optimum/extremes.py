"""Scenes anywhere within the ranges of lib/goe.h, for a search for the worst float32 rounding.

A scene is a point of the unit cube; each coordinate is a figure of it, from the smallest to the largest, mostly on a
logarithmic scale. The two domains differ only in the ranges: ``USUAL`` covers real flights, ``WHOLE`` the limits of the
header."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from goe_tools.flights.flight import Obstacle
from goe_tools.flights.rotations import matrices, multiply, quaternions, small_rotations
from goe_tools.flights.scene import Scene, look
from goe_tools.library import LEVEL, METHODS, MODEL_DISC, Images
from goe_tools.logs.obslog import Camera

KINDS = ("disc", "outline", "corners", "boxes")  # visible features of the obstacle
NONE = np.zeros((0, 6))
SWAY_PERIOD_S = 3.0
PIXEL_MAX_PX = 1e5  # of a coordinate, lib/goe.h
SHARE = 0.3  # of the configured errors in a scene: the search is not about outliers


@dataclass(frozen=True)
class Range:
    name: str
    low: float
    high: float
    by_log: bool = True

    def at(self, share: float) -> float:
        if self.by_log:
            return float(self.low * (self.high / self.low) ** share)
        return self.low + (self.high - self.low) * share


@dataclass(frozen=True)
class Domain:
    name: str
    words: str
    ranges: tuple[Range, ...]

    def figures(self, point: np.ndarray) -> dict[str, float]:
        return {r.name: r.at(float(share)) for r, share in zip(self.ranges, point)}


def _domain(name: str, words: str, **changed: tuple[float, float]) -> Domain:
    ranges = {
        "range_m": (40.0, 2e3), "flown": (0.1, 0.85), "images": (30.0, 160.0), "step_s": (0.05, 0.5),
        "width": (0.01, 0.2), "long": (0.4, 3.0), "high": (0.01, 0.3), "above": (0.01, 0.3),
        "focal_px": (300.0, 3e3), "north_m": (1.0, 1e4), "east_m": (1.0, 1e4), "arm_m": (1e-3, 10.0),
        "bias_deg": (0.02, 2.0), "white_deg": (0.02, 0.5), "point_px": (0.3, 3.0), "height_m": (0.05, 5.0),
        "velocity_m_s": (0.01, 0.5), "walk_m": (0.01, 0.5), "sway_deg": (0.1, 15.0), "speed_m_s": (0.5, 15.0),
    } | changed  # fmt: skip
    linear = {
        "aside": (-0.5, 0.5),
        "turned": (-1.5, 1.5),
        "bend": (-0.3, 0.3),
        "phase": (0.0, 6.28),
        "seed": (0.0, 64.0),
    }
    return Domain(
        name, words,
        tuple(Range(n, *r) for n, r in ranges.items()) + tuple(Range(n, *r, False) for n, r in linear.items()),
    )  # fmt: skip


NEAR = _domain(
    "near",
    "positions within 1 km of the autopilot's origin, lever arms up to 3 m, focal lengths of 300 to 3,000 px, "
    "obstacles 40 m to 2 km away, an attitude sigma of at least 0.02 degrees, points of 0.3 px",
    north_m=(1.0, 1e3), east_m=(1.0, 1e3), arm_m=(1e-3, 3.0),
)  # fmt: skip
FAR = _domain("far", "the same, but positions within 10 km and lever arms up to 10 m")
LIMITS = {
    "range_m": (5.0, 1e5), "flown": (1e-3, 0.97), "step_s": (0.01, 25.0), "width": (1e-3, 0.3), "high": (1e-3, 0.4),
    "above": (1e-3, 0.4), "focal_px": (30.0, 1e5), "bias_deg": (1e-3, 30.0), "white_deg": (1e-4, 10.0),
    "point_px": (0.05, 50.0), "height_m": (1e-3, 1e3), "velocity_m_s": (1e-4, 50.0), "walk_m": (1e-4, 50.0),
    "sway_deg": (1e-3, 30.0), "speed_m_s": (0.5, 100.0),
}  # fmt: skip
SHARP = _domain(
    "sharp",
    "positions within 1 km, lever arms up to 3 m; focal lengths to 100,000 px, obstacles 5 m to 100 km away, a "
    "baseline of a thousandth of that, the smallest noise that the settings allow, tracks of up to 4,000 s",
    **LIMITS | {"north_m": (1.0, 1e3), "east_m": (1.0, 1e3), "arm_m": (1e-3, 3.0)},
)  # fmt: skip
WHOLE = _domain(
    "whole",
    "the same, but positions to 1,000 km and lever arms to 10 km, the limits of the header",
    **LIMITS | {"north_m": (1.0, 1e6), "east_m": (1.0, 1e6), "arm_m": (1e-3, 1e4)},
)  # fmt: skip
DOMAINS = (NEAR, FAR, SHARP, WHOLE)


@dataclass(frozen=True)
class Case:
    """Visible features, method, and whether the obstacle moves."""

    kind: str
    method: str = "filter"
    moves: bool = False

    @property
    def name(self) -> str:
        return f"{self.kind}, {self.method}" + (", moving" if self.moves else "")


CASES = (
    *(Case(kind) for kind in KINDS),
    *(Case(kind, moves=True) for kind in ("corners", "boxes")),
    Case("disc", "window"),
    Case("corners", "window"),
)


def _path(f: dict[str, float], time_s: np.ndarray) -> np.ndarray:
    """(K, 3) of the camera, meters north, east and down: northward, bent sideways."""
    share = time_s / time_s[-1]
    way_m = f["flown"] * f["range_m"]
    side_m = f["bend"] * way_m * share * (1.0 - share) * 4.0
    return np.stack([way_m * share, side_m, np.full(len(share), -f["above"] * f["range_m"])], 1)


def _seen(case: Case, f: dict[str, float], camera: Camera, time_s: np.ndarray, path_m: np.ndarray) -> Scene:
    box = case.kind != "disc"
    width_m, range_m = f["width"] * f["range_m"], f["range_m"]
    truth = Obstacle(
        "box" if box else "disc", f["aside"] * range_m, range_m, f["turned"] if box else 0.0, width_m,
        width_m * (f["long"] if box else 1.0), f["high"] * range_m,
    )  # fmt: skip
    sway = math.radians(f["sway_deg"]) * np.sin(2 * math.pi * time_s / SWAY_PERIOD_S + f["phase"])
    attitude = quaternions(0.3 * sway, 0.3 * sway[::-1], sway)
    scene = Scene("", "", camera, time_s, NONE, NONE, path_m, attitude, -path_m[:, 2], truth, 0.0)
    look(scene, 0.0)
    return scene


def _points(case: Case, scene: Scene, f: dict[str, float], rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    pixels = scene.pixel_px + SHARE * f["point_px"] * rng.standard_normal(scene.pixel_px.shape)
    seen = scene.seen.copy()
    if case.kind in ("disc", "outline"):
        seen[:, 3:] = False
    return np.where(seen[..., None], pixels, 0.0), seen


def _boxes(scene: Scene, pixels: np.ndarray) -> np.ndarray:
    """(K, 4): for an outline without roll, the sides from its points and from the nearest corner."""
    lowest = np.where(scene.seen[:, 3:], pixels[:, 3:, 1], -np.inf).max(1)
    boxes = np.stack([pixels[:, 0, 0], pixels[:, 2, 1], pixels[:, 1, 0], lowest], 1)
    known = scene.seen[:, :3].all(1) & np.isfinite(lowest)
    return np.where(known[:, None] & (boxes[:, :2] < boxes[:, 2:]).all(1)[:, None], boxes, np.nan)


def size_px(f: dict[str, float]) -> float:
    """Size of the image: 90 degrees, or the largest pixel coordinate of the header."""
    return min(2.0 * f["focal_px"], PIXEL_MAX_PX)


def settings_of(case: Case, f: dict[str, float]) -> dict[str, float]:
    middle_px = 0.5 * size_px(f)
    settings = {f"camera.f{axis}_px": f["focal_px"] for axis in "xy"}
    settings |= {f"camera.c{axis}_px": middle_px for axis in "xy"}
    settings |= {"camera.width_px": 0.0, "camera.height_px": 0.0}
    settings |= {f"camera.offset_m[{i}]": f["arm_m"] * share for i, share in enumerate((0.8, -0.5, 0.33))}
    settings |= {
        "heading_auto": 0.0, "heading_deg": 0.0, "method": float(METHODS[case.method]),
        "navigation.attitude_bias_sd_deg": f["bias_deg"], "navigation.attitude_white_sd_deg": f["white_deg"],
        "navigation.height_bias_sd_m": f["height_m"], "navigation.velocity_bias_sd_m_s": f["velocity_m_s"],
        "navigation.position_walk_sd_m": f["walk_m"], "detector.point_noise_px": f["point_px"],
        "detector.box_noise_px": f["point_px"],
        "filter.prior_width_m": min(max(f["width"] * f["range_m"], 0.1), 1e3),
    }  # fmt: skip
    return settings | LEVEL | ({"model": float(MODEL_DISC)} if case.kind == "disc" else {})


def scene_at(case: Case, domain: Domain, point: np.ndarray) -> tuple[Images, dict[str, float]]:
    """The images and the settings of a point of the unit cube."""
    f = domain.figures(point)
    rng = np.random.default_rng(int(f["seed"]))
    time_s = np.rint(np.arange(int(f["images"])) * f["step_s"] * 1e6) / 1e6
    size, middle = size_px(f), 0.5 * size_px(f)
    camera = Camera(size, size, f["focal_px"], f["focal_px"], middle, middle, heading_deg=0.0)
    path_m = _path(f, time_s)
    velocity = f["speed_m_s"] * np.array([0.6, 0.8, 0.0]) if case.moves else np.zeros(3)
    scene = _seen(case, f, camera, time_s, path_m - velocity * time_s[:, None])
    pixels, seen = _points(case, scene, f, rng)
    bias = math.radians(f["bias_deg"]) * rng.standard_normal(3)
    white = math.radians(f["white_deg"]) * rng.standard_normal((len(time_s), 3))
    attitude = multiply(scene.attitude, small_rotations(SHARE * (bias + white)))
    arm_m = f["arm_m"] * np.array([0.8, -0.5, 0.33])
    origin_m = np.array([f["north_m"], -f["east_m"], 0.0])
    position = np.clip(path_m + origin_m - matrices(attitude) @ arm_m, -1e6, 1e6)
    height = np.clip(-path_m[:, 2] + SHARE * f["height_m"] * rng.standard_normal(), -1e5, 1e5)
    boxes = None
    if case.kind == "boxes":
        boxes, seen = _boxes(scene, pixels), np.zeros_like(seen)
    return Images(time_s, position, attitude, height, pixels, seen, boxes), settings_of(case, f)
