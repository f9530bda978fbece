"""One simulated flight of a scenario: ``goe_sim`` flies it, the library estimates, the truth gives the errors.

Errors are estimate minus truth. Z0 and X0 are relative to the camera at the start of the track, Z and X relative to the
camera at the image; the truth uses the true position of the camera, not the logged one.
"""

from __future__ import annotations

import math
import os
import subprocess
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..flights.rotations import fold
from ..logs.estimates import sigma_name
from ..logs.obslog import ObservationLog, Truth, read_frames, read_log
from ..places import ROOT
from ..view.answers import Answers, Options, answers_of
from ..view.motion import Motion, motion_of
from ..view.truth import true_columns
from .course import course_of

PROGRAM = ROOT / "build" / "sim_host" / "goe_sim"
ENDED_EARLY, FLOWN = 1, 0  # exit statuses of goe_sim with a log
WARNED, MISSED, FALSE, QUIET = "warned", "missed", "false", "quiet"


@dataclass(frozen=True)
class Quantity:
    key: str
    symbol: str
    unit: str
    name: str
    column: str  # of ``Answers``


QUANTITIES = (
    Quantity("z0", "Z₀", "m", "ahead, at the start", "z0_m"),
    Quantity("x0", "X₀", "m", "right, at the start", "x0_m"),
    Quantity("z", "Z", "m", "ahead, now", "z_m"),
    Quantity("x", "X", "m", "right, now", "x_m"),
    Quantity("orientation", "β", "°", "orientation", "orientation_deg"),
    Quantity("width", "W", "m", "width", "width_m"),
    Quantity("length", "L", "m", "length", "length_m"),
    Quantity("height", "H", "m", "height", "height_m"),
)
KEYS = tuple(quantity.key for quantity in QUANTITIES)


@dataclass(frozen=True)
class Scenario:
    """The input of a worker; its machine need not have the file."""

    path: str  # for messages
    text: str
    folder: str  # base of the relative paths in it
    program: str
    options: Options


@dataclass(frozen=True)
class Pass:
    """One obstacle in one run, K images. NaN: no answer, no truth to compare with, or never."""

    seed: int
    obstacle: int
    ended_early: bool
    time_s: np.ndarray  # (K,)
    error: np.ndarray  # (K, quantities)
    sigma: np.ndarray  # (K, quantities)
    suspect: np.ndarray  # (K,)
    closest_m: float
    violated_s: float  # first time at which the flown path violates margin and clearance
    warned_s: float  # time of the first image with goe_decide's answer act

    @property
    def verdict(self) -> str:
        if math.isnan(self.violated_s):
            return QUIET if math.isnan(self.warned_s) else FALSE
        return WARNED if self.warned_s < self.violated_s else MISSED

    @property
    def lead_s(self) -> float:
        return self.violated_s - self.warned_s if self.verdict == WARNED else math.nan


def _simulate(scenario: Scenario, seed: int, folder: Path) -> bool:
    """Writes the log; returns whether the flight ended early. ValueError: goe_sim's message, with file and line."""
    own = folder / "scenario.ini"
    own.write_text(scenario.text, encoding="utf-8")
    command = [scenario.program, "--scenario", str(own), "--seed", str(seed), "--out", str(folder / "log")]
    where = scenario.folder if os.path.isdir(scenario.folder) else None
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=where)
    if done.returncode not in (FLOWN, ENDED_EARLY):
        said = done.stderr.strip().replace(str(own), scenario.path)
        said = said[len("goe_sim: ") :] if said.startswith("goe_sim: ") else said
        raise ValueError(said or f"{scenario.program}: ended with {done.returncode}")
    return done.returncode == ENDED_EARLY


def _drift(motion: Motion, true_motion: Motion, answers: Answers) -> np.ndarray:
    """(K, 2) logged minus true position of the camera, north and east."""
    return (motion.camera_ne_m - true_motion.camera_ne_m)[answers.moment]


def _starts(motion: Motion, answers: Answers) -> np.ndarray:
    """(K,) the row at which each answer's track started; the answer and the place of that row are relative to it."""
    c, s = np.cos(answers.heading_rad), np.sin(answers.heading_rad)
    z = answers.column["z0_m"] - answers.column["z_m"]
    x = answers.column["x0_m"] - answers.column["x_m"]
    way = np.stack([z * c - x * s, z * s + x * c], -1)
    camera = motion.camera_ne_m[answers.moment]
    result = np.zeros(len(answers), int)
    for k in np.flatnonzero(np.isfinite(way).all(-1)):
        result[k] = int(np.argmin(np.hypot(*(camera[: k + 1] - (answers.camera_ne_m[k] - way[k])).T)))
    return result


def errors_of(truth: Truth, answers: Answers, motion: Motion, true_motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """(K, quantities) each: errors and sigmas."""
    true, c, s = true_columns(truth, answers), np.cos(answers.heading_rad), np.sin(answers.heading_rad)
    drift = _drift(motion, true_motion, answers)
    at_start = drift[_starts(motion, answers)]
    error, sigma = (np.full((len(answers), len(QUANTITIES)), np.nan) for _ in range(2))
    for i, quantity in enumerate(QUANTITIES):
        stem = quantity.column.replace("0", "")
        error[:, i] = answers.column[stem] - true[stem]
        sigma[:, i] = answers.column[sigma_name(quantity.column)]
        if quantity.key in ("z", "z0"):
            off = drift if quantity.key == "z" else at_start
            error[:, i] -= off[:, 0] * c + off[:, 1] * s
        elif quantity.key in ("x", "x0"):
            off = drift if quantity.key == "x" else at_start
            error[:, i] -= off[:, 1] * c - off[:, 0] * s
        elif quantity.key == "orientation":
            error[:, i] = np.degrees(fold(np.radians(error[:, i])))
    unknown = ~(np.isfinite(error) & np.isfinite(sigma))
    error[unknown] = sigma[unknown] = np.nan
    return error, sigma


def _true_log(log: ObservationLog, folder: Path) -> ObservationLog:
    return ObservationLog(log.camera, read_frames(folder / "truth_frames.csv"), camera2=log.camera2)


def shape_of(truth: Truth) -> Truth:
    """A cylinder has neither length nor heading: its width is the same from all sides."""
    if truth.extra.get("kind") == "cylinder":
        return replace(truth, length_m=None, heading_deg=None)
    return truth


def fly(scenario: Scenario, seed: int) -> list[Pass]:
    """A pass for each obstacle."""
    with tempfile.TemporaryDirectory() as name:
        early = _simulate(scenario, seed, Path(name))
        log = read_log(Path(name) / "log")
        true_log = _true_log(log, Path(name) / "log")
    if not log.frames:
        return []
    options, motion, true_motion = scenario.options, motion_of(log), motion_of(true_log)
    result = []
    for answers in answers_of(log, motion, options):
        truth, time_s = shape_of(log.truth[answers.id]), motion.time_s[answers.moment]
        error, sigma = errors_of(truth, answers, motion, true_motion)
        path = np.column_stack([true_motion.camera_ne_m, true_motion.down_m])
        course = course_of(truth, true_motion.time_s, path, options.margin_m, options.clearance_m)
        acts = np.flatnonzero(answers.act)
        warned_s = float(time_s[acts[0]]) if len(acts) else math.nan
        result.append(
            Pass(seed, answers.id, early, time_s, error, sigma, answers.suspect.astype(bool), course.closest_m,
                 course.violated_s, warned_s)
        )  # fmt: skip
    return result
