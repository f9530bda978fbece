"""Compares goe_replay with the window method in both precisions, value by value.

C against float32: the bits. C against float64: the difference relative to the size of the
quantity, over the rows with a well-conditioned solution, baseline / W > 0.5 (baseline: root of the summed squared
deviations of the camera's path over the window). Length and height are sliding means with one value per solution; they
count if every solution in the mean is well conditioned, and so does the center of a box, which depends on the length.

Meaning of "relative" for a column:
  * x0, z0, x, z, width, length, height: relative to the value. Coordinates and height are differences (z = z0 - dZ,
    height = h - y z), and inherit float32's absolute error of the terms; so the difference is relative to at least a
    tenth of the term: of the distance to the reference position, of the camera's height;
  * orientation: difference of undirected lines (modulo 180 degrees), relative to at least 1 degree;
  * center: relative to the distance between the reference position and the start, for any NED origin;
  * a sigma: it comes from residuals, which for noise-free data are only float32 rounding and carry no
    information. So the difference is relative to the sigma plus a multiple of the sigma that rounding of the
    rows alone would give (the float64 method propagates the rounding unit of the aligned points through the same
    covariance). At the limit of 1e-3 this allows 1e-3 of the sigma plus five such rounding sigmas.

Decisions. float32 and float64 may decide differently at a threshold if the value is within rounding of it; the rows
after that would then compare two different computations. The float64 method therefore follows the decisions of the
float32 method there, and only there (gates.py). Followed decisions are counted and limited to 1 % of a log's decisions,
which logs of whole pixels reach, since they meet a gate of 2 px exactly. Decisions that differ farther from the
threshold are *disputed*: none is allowed. No row is left out because of a decision, and statuses, models and numbers of
points must agree in all rows.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from goe_tools.logs.estimates import NUMBERS, QUANTITIES, Estimate, read_estimates, sigma_name
from goe_tools.logs.obslog import RESET_COLUMN, LogError, ObservationLog, read_log
from goe_tools.places import ROOT
from rich.console import Console
from rich.table import Table
from tqdm import tqdm

from .settings import Settings
from .window import Report, WindowMethod

MIN_SAME_BITS = 0.999  # share of values
MAX_ULP = 4
MAX_RELATIVE = 1e-3  # 99th percentile, C against float64
MIN_BASELINE_RATIO = 0.5
MAX_FOLLOWED = 1e-2  # share of decisions
PERCENTILE = 99.0
DIFFERENCE_FLOOR = 0.1  # of the terms of a difference
ANGLE_FLOOR_DEG = 1.0
ROUNDING_FACTOR = 5.0 / MAX_RELATIVE
CANDIDATES = ("build/sim_host/goe_replay", "build/bin/goe_replay", "build/goe_replay")
EXIT_BEYOND, EXIT_BAD_INPUT = 1, 2
SIGMA_OWNER = {sigma_name(quantity): quantity for quantity in QUANTITIES}


def ulp_index(value: np.ndarray) -> np.ndarray:
    """float32 -> integers that differ by one for neighboring floats; +0 and -0 are equal."""
    bits = np.asarray(value, dtype=np.float32).view(np.int32).astype(np.int64)
    return np.where(bits < 0, -(bits & 0x7FFFFFFF), bits)


@dataclass
class Column:
    """The differences of one output column."""

    ulp_single: list[int] = field(default_factory=list)
    same_bits: int = 0
    ulp_double: list[int] = field(default_factory=list)  # well-conditioned rows
    relative: list[float] = field(default_factory=list)  # well-conditioned rows
    presence: int = 0  # rows in which only one side has the value


@dataclass
class Labels:
    """Rows that differ in labels, not numbers."""

    status: int = 0
    model: int = 0
    images_used: int = 0

    def count(self, a: Estimate, b: Estimate) -> None:
        self.status += a.status != b.status
        self.model += a.model != b.model
        self.images_used += a.images_used != b.images_used

    @property
    def total(self) -> int:
        return self.status + self.model + self.images_used


@dataclass
class Result:
    """The findings in one log."""

    rows: int = 0
    solved: int = 0
    conditioned: int = 0
    columns: dict[str, Column] = field(default_factory=lambda: {name: Column() for name in NUMBERS})
    single: Labels = field(default_factory=Labels)
    double: Labels = field(default_factory=Labels)
    presence_single: int = 0
    decisions: int = 0
    followed: list[str] = field(default_factory=list)
    disputed: list[str] = field(default_factory=list)

    def failures(self) -> list[str]:
        """The exceeded limits, in words."""
        found = []
        values = sum(len(column.ulp_single) for column in self.columns.values())
        same = sum(column.same_bits for column in self.columns.values())
        worst = max((max(column.ulp_single, default=0) for column in self.columns.values()), default=0)
        if values and same < MIN_SAME_BITS * values:
            found.append(f"float32: {same} of {values} values have identical bits, minimum {MIN_SAME_BITS:.1%}")
        if worst > MAX_ULP:
            found.append(f"float32: {worst} ULP apart, {MAX_ULP} allowed")
        if self.single.total or self.presence_single:
            found.append(f"float32: {self.single.total} labels and {self.presence_single} empty fields differ")
        if self.double.total:
            found.append(f"float64: {self.double.total} statuses, models or numbers of points differ")
        presence = sum(column.presence for column in self.columns.values())
        if presence:
            found.append(f"float64: {presence} empty fields differ")
        for name, column in self.columns.items():
            relative = percentile(column.relative)
            if relative > MAX_RELATIVE:
                found.append(f"float64: {name}: 99th percentile {relative:.2g}, {MAX_RELATIVE:g} allowed")
        if len(self.followed) > MAX_FOLLOWED * self.decisions:
            found.append(f"float64: {len(self.followed)} of {self.decisions} decisions followed")
        if self.disputed:
            found.append(f"float64: {len(self.disputed)} disputed decisions: {', '.join(sorted(set(self.disputed)))}")
        return found


def percentile(values: Sequence[float]) -> float:
    return float(np.percentile(values, PERCENTILE, method="higher")) if values else 0.0


def relative_difference(name: str, value: float, report: Report) -> float:
    """|value - reference| in the column's measure; see the module docstring."""
    values = report.estimate.values
    quantity = SIGMA_OWNER.get(name)
    if quantity is not None:
        size = values[name] + ROUNDING_FACTOR * report.roundoff[quantity]
        return abs(value - values[name]) / max(size, 1e-30)
    distance = float(np.hypot(values.get("x0_m", 0.0), values.get("z0_m", 0.0)))
    difference, size = value - values[name], abs(values[name])
    if name == "orientation_deg":
        difference, size = np.remainder(difference + 90.0, 180.0) - 90.0, max(size, ANGLE_FLOOR_DEG)
    elif name.startswith("center"):
        size = distance
    elif name in ("x0_m", "z0_m", "x_m", "z_m"):
        size = max(size, DIFFERENCE_FLOOR * distance)
    elif name == "height_m":
        size = max(size, DIFFERENCE_FLOOR * abs(report.camera_height_m))
    return abs(float(difference)) / max(size, 1e-30)


def run_replay(replay: Path, folder: Path, settings: Settings) -> list[tuple[float, int, Estimate]]:
    """goe_replay's answers to a log."""
    with tempfile.TemporaryDirectory() as scratch:
        out = Path(scratch) / "estimates.csv"
        command = [
            str(replay),
            "--method",
            "window",
            "--model",
            settings.model,
            "--window",
            str(settings.window),
            "--out",
            str(out),
            str(folder),
        ]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False)
        except OSError as error:
            raise LogError(replay, 0, "", f"cannot be run: {error.strerror}") from None
        if done.returncode not in (0, 1):  # 1: no row gave an estimate, which is a valid result
            raise LogError(replay, 0, "", f"exit status {done.returncode}: {done.stderr.strip()}")
        return read_estimates(out)


def check_comparable(log: ObservationLog, folder: Path) -> None:
    """The method follows the paper: points, and a position that does not jump."""
    path = folder / "frames.csv"
    if any(frame.box_px is not None for frame in log.frames):
        raise LogError(path, 0, "", "contains bounding boxes, which the references do not support")
    if log.camera2 is not None:
        raise LogError(folder / "camera.ini", 0, "camera2", "a second camera, which the references do not support")
    if log.resets():
        raise LogError(path, 0, RESET_COLUMN, "changes within a track, and the references do not support resets")


def compare_rows(
    log: ObservationLog, answers: Sequence[tuple[float, int, Estimate]], settings: Settings, label: str = ""
) -> Result:
    """Runs the method over a log in both precisions and compares."""
    if len(answers) != len(log.frames):
        raise ValueError(f"{label}: {len(answers)} rows of estimates for {len(log.frames)} rows of frames")
    result = Result(rows=len(log.frames))
    singles: dict[int, WindowMethod] = {}
    doubles: dict[int, WindowMethod] = {}
    rows = zip(log.frames, answers)
    for frame, (t_s, track, answer) in tqdm(rows, total=len(log.frames), desc=label, leave=False, disable=None):
        if track != frame.id or (t_s != frame.t_s and t_s == t_s):
            raise ValueError(f"{label}: the estimate at {t_s!r} s of track {track} is at {frame.t_s!r} s")
        if frame.id not in singles:
            singles[frame.id] = WindowMethod(log.camera, settings, np.float32)
            doubles[frame.id] = WindowMethod(log.camera, settings, np.float64)
        single = singles[frame.id].update(frame)
        double = doubles[frame.id].update(frame, single.gates.taken)
        _count_row(result, answer, single.estimate, double)
    return result


def _count_row(result: Result, answer: Estimate, single: Estimate, report: Report) -> None:
    exact = report.estimate
    result.single.count(answer, single)
    result.double.count(answer, exact)
    result.solved += answer.status in ("ok", "partial")
    result.decisions += len(report.gates.taken)
    result.followed += report.gates.followed
    result.disputed += report.gates.disputed
    result.conditioned += report.conditioning["x0_m"] > MIN_BASELINE_RATIO
    for name, column in result.columns.items():
        value = answer.values.get(name)
        result.presence_single += (value is None) != (name not in single.values)
        column.presence += (value is None) != (name not in exact.values)
        if value is None:
            continue
        bits = np.float32(value)
        if name in single.values:
            column.same_bits += bits.tobytes() == np.float32(single.values[name]).tobytes()
            column.ulp_single.append(int(abs(ulp_index(bits) - ulp_index(single.values[name]))))
        conditioning = report.conditioning[SIGMA_OWNER.get(name, name)]
        if conditioning > MIN_BASELINE_RATIO and name in exact.values:
            column.ulp_double.append(int(abs(ulp_index(bits) - ulp_index(np.float32(exact.values[name])))))
            column.relative.append(relative_difference(name, value, report))


def print_result(console: Console, title: str, result: Result) -> None:
    table = Table(title=title, title_justify="left", box=None, pad_edge=False)
    table.add_column("column")
    for heading in ("values", "same bits", "worst ULP", "values", "99 % rel", "worst rel", "99 % ULP", "worst ULP"):
        table.add_column(heading, justify="right")
    table.add_row("", "", "C and float32", "", "", "C and float64", "(baseline/W", "> 0.5)", "", style="dim")
    for name, column in result.columns.items():
        values = len(column.ulp_single)
        if not values:
            continue
        table.add_row(
            name,
            str(values),
            f"{column.same_bits / values:.3%}",
            str(max(column.ulp_single)),
            str(len(column.relative)),
            f"{percentile(column.relative):.1e}",
            f"{max(column.relative, default=0.0):.1e}",
            f"{percentile(column.ulp_double):.0f}",
            str(max(column.ulp_double, default=0)),
        )
    console.print(table)
    console.print(
        f"rows {result.rows}, solved {result.solved}, with baseline/W > {MIN_BASELINE_RATIO:g}: {result.conditioned}; "
        f"differing status/model/images_used: float32 {_counts(result.single)}, float64 {_counts(result.double)}; "
        f"decisions {result.decisions}, followed within rounding {len(result.followed)}, "
        f"disputed {len(result.disputed)}"
    )


def _counts(labels: Labels) -> str:
    return f"{labels.status}/{labels.model}/{labels.images_used}"


def find_replay(given: Path | None) -> Path:
    """The program to compare: the given one, from GOE_REPLAY, or from the build folder below the working folder or the
    project."""
    if given is not None:
        return given
    if os.environ.get("GOE_REPLAY"):
        return Path(os.environ["GOE_REPLAY"])
    for root in (Path.cwd(), ROOT):
        for candidate in CANDIDATES:
            if (root / candidate).is_file():
                return root / candidate
    raise LogError(Path(CANDIDATES[0]), 0, "", "not built; use --replay for another place")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("logs", nargs="+", type=Path, metavar="DIR", help="folder of an observation log")
    parser.add_argument("--replay", type=Path, metavar="FILE", help="the built goe_replay")
    parser.add_argument("--model", choices=("auto", "disc", "line"), default="auto")
    parser.add_argument("--window", type=int, default=8, metavar="N", help="points in the window (default 8)")


def run(arguments: argparse.Namespace) -> int:
    replay = find_replay(arguments.replay)
    settings = Settings(model=arguments.model, window=arguments.window)
    console = Console(width=120, highlight=False)
    beyond = False
    for folder in arguments.logs:
        log = read_log(folder)
        check_comparable(log, folder)
        result = compare_rows(log, run_replay(replay, folder, settings), settings, str(folder))
        print_result(console, str(folder), result)
        for failure in result.failures():
            print(f"{folder}: BEYOND THE LIMITS: {failure}", file=sys.stderr)
            beyond = True
    return EXIT_BEYOND if beyond else 0
