"""Reduces a find: leaves out or rounds everything that the find does not need.

First the parameters of its flight, which is flown again after each change; then its images as given to the library.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass

import goe
import numpy as np

from . import motion, search
from .finds import CAUSES, COLUMNS, CONFIDENT_SIGMA, JUDGED, KINDS, PROMISED
from .genes import DEFAULTS, STRAIGHT, Params
from .search import Flown
from .tally import Key
from .world import OF_IMAGES, World

KEPT_SHARE, KEPT_SIGMA = 0.6, 12.0  # of a confident error: share and limit of its size that must remain
ROUNDED = (  # parameter, and its digits or unit
    ("a_m", 1.0), ("b_m", 1.0), ("h_m", 1.0), ("speed_m_s", 1.0), ("rate_hz", 1.0), ("height_m", 1.0),
    ("range_m", 10.0), ("turned_deg", 5.0),
    ("a_m", 0.1), ("b_m", 0.1), ("h_m", 0.1), ("speed_m_s", 0.1), ("rate_hz", 0.1), ("height_m", 0.1),
    ("range_m", 1.0), ("turned_deg", 1.0),
    ("fx_px", 10.0), ("jitter_yaw_deg", 1.0), ("jitter_pitch_deg", 1.0), ("margin_m", 1.0), ("offset", 0.01),
    ("side_height", 0.1),
)  # fmt: skip
LEAST = {"a_m": 0.1, "b_m": 0.1, "h_m": 0.5, "speed_m_s": 1.0, "rate_hz": 1.0, "fx_px": 100.0, "margin_m": 1.0}
SIMPLE: tuple[dict[str, float], ...] = (
    {"constant_scale": 0.0, "pose_scale": 0.0, "pixel_scale": 0.0}, {"constant_scale": 0.0}, {"pose_scale": 0.0},
    {"pixel_scale": 0.0},
    {"unknown": 0}, {"reset_kind": 0}, {"resets": 1}, {"refused": 0}, {"runs": 0}, {"runs": 1}, {"every_n": 0},
    {"missed_share": 0.0},
    {"partly_share": 0.0}, {"gap_s": 0.0}, {"pre_turn": 0}, {"two_cameras": 0}, {"jitter": 0.0},
    {"k1": 0.0, "k2": 0.0, "p1": 0.0, "p2": 0.0}, {"lever_x_m": 0.0, "lever_y_m": 0.0, "lever_z_m": 0.0},
    {"mount_roll_deg": 0.0},
    {"sway_deg": 0.0}, {"weave_deg": 0.0}, {"climb_m_s": 0.0}, {"crab_deg": 0.0}, {"turn_deg_s": 0.0},
    {"kind": STRAIGHT},
    {"heading_auto": 1}, {"size_configured": 1}, {"cut_reported": 0}, {"cut_drawn": 0, "cut_noise": 1.0},
    {"sides_raw": 0},
    {"top_is_highest": 0},
    {"has_top": 1}, {"has_top": 0}, {"has_sides": 1}, {"has_sides": 0}, {"has_bottom": 1}, {"base_subset": 0},
    {"model": 1}, {"range_share": 0.25},
    {"height_white": 0.0}, {"position_white": 0.0}, {"attitude_drift": 0.0}, {"point_share": 0.0},
    {"point_correlation": 0.0},
    {"hidden_m": 0.0}, {"hidden_always": 1}, {"slope_drawn": 0},
    {"ground_drawn": 0}, *({name: value} for name, value in DEFAULTS.items()), {"typical_m": 6.0}, {"since_s": 0.0},
    {"plan_turn_deg": 0.0},
    {"plan_climb_m_s": 0.0}, {"plan_hold": 1000}, {"origin_n_m": 0.0, "origin_e_m": 0.0, "origin_d_m": 0.0},
    {"course_deg": 0.0},
    {"turned_deg": 0.0}, {"width_px": 1280.0, "image_height_px": 960.0, "cx_px": 640.0, "cy_px": 480.0},
    {"cx_px": 640.0, "cy_px": 480.0},
    {"fy_px": np.nan}, {"jitter_yaw_deg": 0.0}, {"jitter_pitch_deg": 0.0},
)  # fmt: skip


@dataclass
class Want:
    """The find to keep: its kind, and the wrong quantity or the cause of a vanished warning."""

    kind: str
    what: str
    least: float = CONFIDENT_SIGMA  # least error in sigmas


def hits(flown: Flown, want: Want) -> np.ndarray:
    """(N,): images with such a find."""
    lies = flown.lies
    if want.kind == KINDS[0]:
        with np.errstate(invalid="ignore"):
            return np.asarray(lies.ratio[:, COLUMNS.index(want.what)] > want.least)
    if want.kind == KINDS[1]:
        return np.asarray(lies.false_safety.any(1))
    return np.asarray((lies.vanished & (lies.cause == CAUSES.index(want.what))).any(1))


def all_wants() -> list[Want]:
    return [
        *(Want(KINDS[0], column) for column in JUDGED), Want(KINDS[1], "violation"),
        *(Want(KINDS[2], cause) for cause in CAUSES[PROMISED:]),
    ]  # fmt: skip


def want_of(key: Key) -> Want:
    return Want(key[0], key[2])


def changed(p: Params, change: dict[str, float]) -> Params:
    """``change``: new values; NaN of fy_px: fx_px."""
    found = {name: values.copy() for name, values in p.items()}
    for name, value in change.items():
        found[name][:] = found["fx_px"] if name == "fy_px" else value
    return found


def _kept(p: Params, want: Want) -> bool:
    try:
        return bool(hits(search.fly(p), want).any())
    except goe.SettingError:
        return False


def _changes(p: Params) -> Iterator[dict[str, float]]:
    yield from SIMPLE
    for name, unit in ROUNDED:
        value = float(p[name][0])
        yield {name: max(round(value / unit) * unit, LEAST.get(name, -np.inf))}


def parameters(p: Params, want: Want) -> Params:
    """Simplified parameters of one flight, which ends with the find."""
    flown = search.fly(p)
    last = int(np.flatnonzero(hits(flown, want))[0])
    shorter = changed(p, {"images": last + 1 - int(motion.pre_images(p)[0])})
    p = shorter if _kept(shorter, want) else p
    for change in _changes(p):
        same = all(np.array_equal(p[name][0], value) for name, value in change.items())
        if not same and _kept(candidate := changed(p, change), want):
            p = candidate
    return p


# -------------------------------------------------------------------------------------------------------------- images


def subset(world: World, keep: np.ndarray) -> World:
    """One flight with some of its images."""
    parts = {name: getattr(world, name)[keep] for name in OF_IMAGES}
    return dataclasses.replace(world, start=np.array([0, int(keep.sum())]), **parts)


def _still(world: World, want: Want) -> bool:
    return bool(hits(search.look_at(world), want).any())


def _noisy(world: World) -> bool:
    return any(world.p[f"{name}_scale"][0] != 0.0 for name in ("constant", "pose", "pixel"))


def fewer(world: World, want: Want) -> World:
    """Leaves out ever shorter runs of images. With noise only from both ends, since a choice among its values would
    change its distribution. An image with a reset stays; otherwise the next one would have to report the reset."""
    fixed = world.known | world.unknown | world.refused
    keep = np.ones(len(fixed), bool)
    last = int(np.flatnonzero(hits(search.look_at(world), want))[0])
    keep[last + 1 :] = fixed[last + 1 :] = False
    ends_only = _noisy(world)
    run = max(1, int(keep.sum()) // 2)
    while run >= 1:
        for begin in range(0, len(keep), run):
            tried = keep.copy()
            tried[begin : begin + run] &= fixed[begin : begin + run]
            if ends_only and keep[:begin].any():
                break
            if 0 < tried.sum() < keep.sum() and _still(subset(world, tried), want):
                keep = tried
        run //= 2
    return subset(world, keep)


def _rounded(images: np.ndarray, digits: dict[str, int]) -> np.ndarray:
    found = images.copy()
    for name in ("left", "right", "top", "base_left", "base_near", "base_right"):
        for axis in ("u_px", "v_px"):
            found[name][axis] = np.round(found[name][axis], digits["px"])
    for side in ("left_px", "top_px", "right_px", "bottom_px"):
        found["box"][side] = np.round(found["box"][side], digits["px"])
    for name in ("position_ned_m", "height_m"):
        found["pose"][name] = np.round(found["pose"][name], digits["m"])
    found["pose"]["attitude"] = np.round(found["pose"]["attitude"], digits["unit"])
    return found


def rounder(world: World, want: Want) -> World:
    """Numbers with few digits, still far finer than any noise."""
    for digits in ({"px": 1, "m": 2, "unit": 5}, {"px": 2, "m": 3, "unit": 6}):
        tried = dataclasses.replace(world, images=_rounded(world.images, digits))
        if _still(tried, want):
            return tried
    return world


def shrink(p: Params, want: Want) -> World:
    """``p``: of one flight with the find. Large errors stay large."""
    if want.kind == KINDS[0]:
        worst = np.nanmax(search.fly(p).lies.ratio[:, COLUMNS.index(want.what)])
        want = dataclasses.replace(want, least=max(CONFIDENT_SIGMA, min(KEPT_SHARE * worst, KEPT_SIGMA)))
    p = parameters(p, want)
    return rounder(fewer(search.fly(p).world, want), want)
