"""Classifies answers as lies: confident errors, false safety, and warnings that vanish."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .answers import RULES, Answers
from .genes import ORBIT, TURNING
from .judge import (
    BOX,
    DISC,
    FILTER,
    FLIGHT_QUANTITIES,
    LENGTH,
    ORIENTATION,
    PRISM,
    QUANTITIES,
    REFUSED_STATUS,
    Judged,
)
from .world import World

CONFIDENT_SIGMA = 6.0
SAFE_MOST = 0.01  # violation
WARNS_LEAST, GONE_MOST = 0.5, 0.05
FRESH_MOST_S = 1.0
LEVEL_M_S = 0.05
HELD = 3
KINDS = ("confident", "false safety", "vanished")
CAUSES = (
    "moved on", "unknown reset", "refused image", "known reset", "no detection", "dropped", "filter restart",
    "other model",
    "held", "other",
)  # fmt: skip
PROMISED = 2  # the first causes are legal: the truth changed, or the track ends by goe.h
MOVED_M = 0.5  # of the true miss or clearance, from one image to the next
JUDGED = (*QUANTITIES, *FLIGHT_QUANTITIES)
CIRCLE = len(JUDGED)  # further columns: hazards with a circle in place of a cuboid of unknown outline
COLUMNS = (*JUDGED, *(f"{name} of a circle" for name in FLIGHT_QUANTITIES))


@dataclass
class Finds:
    """Of N images."""

    ratio: np.ndarray  # (N, COLUMNS) error over sigma of the filter answers that are not suspect; NaN otherwise
    confident: np.ndarray  # (N, COLUMNS)
    false_safety: np.ndarray  # (N, RULES)
    doubted: np.ndarray  # (N, RULES) false safety of suspect or old answers
    vanished: np.ndarray  # (N, RULES)
    cause: np.ndarray  # (N, RULES) cause if a warning vanishes with this image, index into CAUSES


def _causes(world: World, found: Answers, judged: Judged) -> np.ndarray:
    """(N, RULES): index into CAUSES."""
    e = found.estimates
    before = np.maximum(np.arange(len(e)) - 1, 0)
    late = world.refused[before] & world.unknown[before]  # the next image shows the counter of a refused one
    moved = np.any(np.abs(judged.met - judged.met[before]) > MOVED_M, -1)
    tests = [
        (world.unknown | late) & (found.hazard_status != 0).all(1),
        (found.status >= REFUSED_STATUS[0]) & (found.status <= REFUSED_STATUS[1]), world.known, ~world.detected,
        e["method"] != e["method"][before],
        e["images_used"] < e["images_used"][before], e["model"] != e["model"][before], found.status == HELD,
    ]  # fmt: skip
    cause = np.select(tests, range(1, len(tests) + 1), len(CAUSES) - 1)
    return np.where(moved, 0, cause[:, None])


def _vanished(world: World, found: Answers, judged: Judged) -> np.ndarray:
    n = len(world.flight)
    before = np.maximum(np.arange(n) - 1, 0)
    same = (world.flight == world.flight[before]) & (np.arange(n) > 0)
    same &= np.all(world.velocity == world.velocity[before], 1)
    warned = judged.violation[before] >= WARNS_LEAST
    gone = ~(judged.violation >= GONE_MOST)  # NaN: no answer at all
    return same[:, None] & warned & gone & judged.violated


def find(world: World, found: Answers, judged: Judged) -> Finds:
    e = found.estimates
    counts = (e["method"] == FILTER) & ~e["suspect"]
    is_round = world.solid.round[world.flight]
    whole_box = (e["model"] == BOX) & ((e["valid"] & LENGTH) != 0) & ((e["valid"] & ORIENTATION) != 0)
    outline_known = np.where(is_round, np.isin(e["model"], (DISC, PRISM)), whole_box) & counts
    hazard = np.abs(judged.hazard_ratio)
    worst = np.where(np.isnan(hazard).all(1), np.nan, np.nanmax(np.where(np.isnan(hazard), -1.0, hazard), 1))
    level = np.abs(world.velocity[:, 2]) < LEVEL_M_S  # the clearance then does not depend on the place of the outline
    exact = np.stack([outline_known, outline_known, outline_known | (counts & level)], 1)
    ratio = np.column_stack([
        np.where(counts[:, None], np.abs(judged.ratio), np.nan), np.where(exact, worst, np.nan),
        np.where(counts[:, None] & ~exact, worst, np.nan),
    ])  # fmt: skip
    trusted = ~e["suspect"] & (e["age_s"] <= FRESH_MOST_S)
    unsafe = (judged.violation < SAFE_MOST) & judged.violated
    assert unsafe.shape[1] == RULES
    with np.errstate(invalid="ignore"):
        confident = ratio > CONFIDENT_SIGMA
    return Finds(
        ratio, confident, unsafe & trusted[:, None], unsafe & ~trusted[:, None], _vanished(world, found, judged),
        _causes(world, found, judged),
    )  # fmt: skip


def flags(world: World) -> dict[str, np.ndarray]:
    """(F,) bool: unusual circumstances of each flight."""
    p = world.p

    def any_of(images: np.ndarray) -> np.ndarray:
        return np.bincount(world.flight, images, len(p["mix"])) > 0

    kind = p["reset_kind"]
    return {
        "round": p["round"],
        "flat": np.maximum(p["a_m"] / p["b_m"], p["b_m"] / p["a_m"]) > 4.0,
        "face_on": p["turned_deg"] == 0.0,
        "above_roof": p["height_m"] > p["h_m"],
        "rolls": any_of(np.abs(world.roll_deg) > 8.0),
        "turns": p["kind"] == TURNING,
        "orbit": p["kind"] == ORBIT,
        "climbs": p["climb_m_s"] != 0.0,
        "looks_aside": np.abs(world.mount_deg[:, 0, 0]) > 30.0,
        "lens": p["k1"] != 0.0,
        "heading_set": ~np.isnan(world.heading_deg),
        "two_cameras": p["two_cameras"],
        "size_unknown": ~p["size_configured"],
        "near_hidden": any_of(world.near_hidden),
        "cut": any_of(world.cut),
        "cut_drawn": p["cut_drawn"],
        "raw_sides": p["sides_raw"] & p["has_sides"],
        "top_is_highest": p["top_is_highest"],
        "no_top": ~p["has_top"],
        "no_sides": ~p["has_sides"],
        "no_bottom": ~p["has_bottom"],
        "base_subset": p["base_subset"] > 0,
        "line_forced": p["model"] == 3,
        "disc_forced": p["model"] == 2,
        "range_share": p["range_share"] != 0.25,
        "height_white": p["height_white"] > 0,
        "position_white": p["position_white"] > 0,
        "attitude_drift": p["attitude_drift"] > 0,
        "point_share": p["point_share"] > 0,
        "correlated": p["point_correlation"] > 0,
        "ground_drawn": p["ground_drawn"],
        "slope": p["slope_drawn"],
        "bushes": p["hidden_m"] > 0,
        "pre_turn": p["pre_turn"],
        "missed": any_of(~world.detected),
        "partly": p["partly_share"] > 0,
        "gap": p["gap_s"] > 0,
        "reset_level": any_of(world.known) & np.isin(kind, (1, 3)),
        "reset_down": any_of(world.known) & np.isin(kind, (2, 3)),
        "reset_down_follows": any_of(world.known) & np.isin(kind, (2, 3)) & p["height_follows"],
        "unknown_reset": any_of(world.unknown),
        "refused": any_of(world.refused),
        "no_mishap": ~any_of(~world.detected | world.known | world.unknown | world.refused) & (p["gap_s"] == 0),
    }
