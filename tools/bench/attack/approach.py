"""Warnings against the true course of events: closest approach, violations, warned runs and warning times.

The aircraft continues straight at a constant climb rate, so the truth of a run is valid for all of its images."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from goe_tools.report.attack_lines import AHEAD_S

from . import harder
from .scenario import Scenario, Truth

MARGIN_M, CLEARANCE_M = 15.0, 10.0  # README.md, "The decision"

STEP_S = 0.01  # of the search for the closest approach
INSIDE_M = 1e-9
JUDGED_S = 1.0  # images nearer to the closest approach are not judged
EVERY_S = 1.0  # one image of each such interval of a run counts for the probabilities
BINS = (0.05, 0.2, 0.5, 0.8, 0.95)  # of predicted probabilities; judged between the first and the last
BIN_LEAST = 30  # least number of images in a judged bin
COVERED_SIGMA = 2.0
RUNS = 1000

HAZARD_BASE = Scenario(collides=True, size_m=(3.0, 25.0)).by(
    weave_m=0.0, climb_m_s=1.0, height_m=(5.0, 25.0), aside_m=(-15.0, 50.0), reach_s=(12.0, 22.0)
)


@dataclass(frozen=True)
class HazardRow:
    """Runs with the same errors. ``error_max``: largest difference of predicted and true probabilities;
    ``unwarned_most``: percent of the violators; ``false_most``: percent of the passes at twice the margin;
    ``sigmas``: whether probabilities and sigmas are judged."""

    name: str
    scenario: Scenario
    if_known: dict[str, float] = field(default_factory=dict)
    error_max: float = 0.1
    unwarned_most: float = 0.0
    false_most: float = 15.0
    sigmas: bool = True
    runs_share: float = 1.0  # of the usual number of runs


def _rows() -> list[HazardRow]:
    white = {"navigation.height_white_sd_m": 1.0}
    errors: tuple[tuple[str, dict[str, float], dict[str, float], float], ...] = (
        ("nominal", {}, {}, 0.0), ("50 ms late", {"late_s": 0.05}, {}, 0.0), ("100 ms late", {"late_s": 0.1}, {}, 0.4),
        ("altimeter 1 m", {"height_white_sd_m": 1.0}, white, 0.0),
        ("50 ms late + altimeter", {"late_s": 0.05, "height_white_sd_m": 1.0}, white, 0.0),
    )  # fmt: skip
    features = {"corners": ("corners", 0.1), "outline": ("outlines", 0.15), "boxes": ("boxes", 0.1)}
    return [
        HazardRow(f"{text}, {name}", HAZARD_BASE.by(features=kind, **changes), settings, within, most)
        for kind, (text, within) in features.items()
        for name, changes, settings, most in errors
    ]


HARDER_BASE = HAZARD_BASE.by(size_m=(0.3, 30.0), speed_m_s=(5.0, 30.0), **harder.BOX_ERRORS)
HARDER_ERRORS: tuple[tuple[str, dict[str, float], float], ...] = (
    ("nominal", {}, 3.0), ("20 ms late", {"late_s": 0.02}, 8.0), ("50 ms late", {"late_s": 0.05}, 8.0),
    ("100 ms late", {"late_s": 0.1}, 20.0), ("velocity 0.3 m/s wrong", {"velocity_off_m_s": 0.3}, 10.0),
    ("10 % of another obstacle", {"foreign": 0.1}, 10.0),
    ("vertical drift 0.1 m", {"down_walk_m": 0.1, "climb_off_m_s": 0.1}, 10.0),
    ("altimeter 1 m, not configured", {"height_white_sd_m": 1.0}, 10.0),
)  # fmt: skip


def _harder_rows() -> list[HazardRow]:
    return [
        HazardRow(f"harder, {kind}, {name}", HARDER_BASE.by(features=kind, **changes), false_most=most,
                  sigmas=name == "nominal", runs_share=0.3)
        for kind in ("corners", "outline", "boxes")
        for name, changes, most in HARDER_ERRORS
    ]  # fmt: skip


ROWS = (*_rows(), *_harder_rows())


# ---------------------------------------------------------------------------------------------------------- one run


@dataclass
class Approach:
    """The true outcome without a maneuver: times from the flight's first image; clearance at the closest approach."""

    time_s: float
    dcpa_m: float
    clearance_m: float

    @property
    def violates(self) -> bool:
        return self.dcpa_m < MARGIN_M and self.clearance_m < CLEARANCE_M


@dataclass
class Warnings:
    """Answers of goe_hazard over K images, with constant margins, and decisions of goe_decide. NaN without an
    answer."""

    time_s: np.ndarray
    refined: np.ndarray  # (K,) answered by the filter method: the window's sigmas are not judged
    to_go_s: np.ndarray
    to_go_sd_s: np.ndarray
    dcpa_m: np.ndarray
    dcpa_sd_m: np.ndarray
    clearance_m: np.ndarray
    clearance_sd_m: np.ndarray
    violation: np.ndarray
    acts: np.ndarray  # (K,) bool


@dataclass
class Run:
    warnings: Warnings
    approach: Approach


def outline_distance(truth: Truth, place_m: np.ndarray) -> np.ndarray:
    """(N,): distance from points (N, 2) north, east about the middle to the footprint of a cylinder or rectangle; 0
    inside."""
    solid, axis = truth.solid, truth.axis_rad
    z = place_m @ [math.cos(axis), math.sin(axis)]
    x = place_m @ [-math.sin(axis), math.cos(axis)]
    if solid.kind == "cylinder":
        return np.maximum(np.hypot(x, z) - 0.5 * solid.width_m, 0.0)
    flat = np.stack([x, z], 1)
    out = [
        np.abs(flat @ way) - 0.5 * size for way, size in ((solid.across, solid.width_m), (solid.along, solid.length_m))
    ]
    return np.hypot(*(np.maximum(part, 0.0) for part in out))


def closest(truth: Truth, image: int = 0, velocity_m_s: np.ndarray | None = None, until_s: float = 60.0) -> Approach:
    """The closest approach after an image, at the aircraft's velocity there (3,) relative to the obstacle. If the path
    crosses the outline: the time of entry; in descent, the clearance is that over the far edge."""
    velocity = truth.path_velocity_ned_m_s[image] if velocity_m_s is None else velocity_m_s
    t = np.arange(0.0, until_s, STEP_S)
    place = truth.eye_ned_m[image] + velocity * t[:, None]
    distance = outline_distance(truth, place[:, :2])
    k = int(np.argmin(distance))
    inside = np.flatnonzero(distance <= INSIDE_M)
    over = inside[-1] if len(inside) and velocity[2] > 0.0 else k
    return Approach(float(t[k]), float(distance[k]), float(-place[over, 2] - truth.solid.height_m))


def first_warning_s(warnings: Warnings) -> float:
    """Time of the first warning of the decision rule; infinite without one."""
    return float(warnings.time_s[np.argmax(warnings.acts)]) if warnings.acts.any() else math.inf


# --------------------------------------------------------------------------------------------------------- many runs


def _judged(run: Run) -> np.ndarray:
    """(K,): images that are compared with the truth."""
    w = run.warnings
    return w.refined & np.isfinite(w.violation) & (run.approach.time_s - w.time_s > JUDGED_S)


def probabilities(runs: Sequence[Run]) -> dict[str, tuple[float, float, int]]:
    """Bin of predicted probabilities -> predicted mean, true share, images: one image per ``EVERY_S`` of each run."""
    predicted, true = [], []
    for run in runs:
        chosen = np.flatnonzero(_judged(run))
        seconds = np.floor(run.warnings.time_s[chosen] / EVERY_S)
        chosen = chosen[np.unique(seconds, return_index=True)[1]]
        predicted.append(run.warnings.violation[chosen])
        true.append(np.full(len(chosen), run.approach.violates))
    all_predicted, all_true = np.concatenate(predicted), np.concatenate(true)
    result = {}
    for low, high in zip((0.0, *BINS), (*BINS, 1.0 + 1e-9)):
        inside = (all_predicted >= low) & (all_predicted < high)
        if inside.any():
            values = float(all_predicted[inside].mean()), float(all_true[inside].mean()), int(inside.sum())
            result[f"{low:g} to {min(high, 1.0):g}"] = values
    return result


def coverage(runs: Sequence[Run]) -> dict[str, float]:
    """Percent of a run's answers within two sigma of the truth, mean over the runs."""
    shares: dict[str, list[float]] = {"time": [], "miss": [], "clearance": []}
    for run in runs:
        w, a, judged = run.warnings, run.approach, _judged(run)
        errors = {
            "time": (w.to_go_s - (a.time_s - w.time_s), w.to_go_sd_s), "miss": (w.dcpa_m - a.dcpa_m, w.dcpa_sd_m),
            "clearance": (w.clearance_m - a.clearance_m, w.clearance_sd_m),
        }  # fmt: skip
        for name, (error, sigma) in errors.items():
            there = judged & np.isfinite(error) & (sigma > 0.0)
            if there.any():
                shares[name].append(float((np.abs(error) < COVERED_SIGMA * sigma)[there].mean()))
    return {name: 100.0 * float(np.mean(values)) if values else math.nan for name, values in shares.items()}


def unwarned(runs: Sequence[Run]) -> float:
    """Percent of the violators without a warning of the rule ``AHEAD_S`` ahead."""
    late = [
        run.approach.time_s - first_warning_s(run.warnings) < AHEAD_S
        for run in runs
        if run.approach.violates and run.approach.time_s > AHEAD_S
    ]
    return 100.0 * float(np.mean(late)) if late else math.nan


def false_warnings(runs: Sequence[Run]) -> float:
    """Percent of warned runs among those that keep twice the margin, below the clearance."""
    wide = [
        math.isfinite(first_warning_s(run.warnings))
        for run in runs
        if run.approach.dcpa_m >= 2 * MARGIN_M and run.approach.clearance_m < CLEARANCE_M
    ]
    return 100.0 * float(np.mean(wide)) if wide else math.nan


def counts(runs: Sequence[Run]) -> dict[str, float]:
    """Violators and passes at twice the margin."""
    violators = sum(run.approach.violates for run in runs)
    wide = sum(run.approach.dcpa_m >= 2 * MARGIN_M and run.approach.clearance_m < CLEARANCE_M for run in runs)
    return {"violators": float(violators), "at twice the margin": float(wide)}
