"""Finds the noise settings that fit logs.

python -m goe_tools noise LOG..."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rich.console import Console
from rich.table import Table
from tqdm import tqdm

from .. import renamed
from ..flights.flight import Flight
from ..logs.fields import warn
from ..models.prism import ErrorModel
from .boxes import box_rows
from .judged import covered
from .likelihood import Fitted, fit
from .points import point_rows
from .rows import Rows
from .tracks import box_tracks, point_tracks

GIVEN = {  # the library's defaults
    "detector.box_noise_px": 1.0, "detector.box_noise_rel": 0.07, "detector.box_correlation_time_s": 1.2,
    "detector.point_noise_px": 0.5,
    "detector.point_noise_rel": 0.0, "navigation.attitude_white_sd_deg": 0.1, "navigation.attitude_bias_sd_deg": 0.5,
    "navigation.attitude_walk_sd_deg": 0.0, "navigation.velocity_bias_sd_m_s": 0.05,
    "navigation.position_walk_sd_m": 0.05,
    "navigation.position_white_sd_m": 0.0, "navigation.height_bias_sd_m": 0.5, "navigation.terrain_height_sd_m": 2.0,
}  # fmt: skip
RANGES = {  # of the library
    "detector.box_noise_px": (0.05, 100.0), "detector.box_noise_rel": (0.0, 1.0),
    "detector.point_noise_px": (0.05, 100.0),
    "detector.point_noise_rel": (0.0, 1.0), "navigation.attitude_white_sd_deg": (1e-4, 30.0),
    "navigation.attitude_bias_sd_deg": (1e-3, 30.0), "navigation.velocity_bias_sd_m_s": (0.0, 100.0),
    "navigation.height_bias_sd_m": (1e-3, 1e3),
}  # fmt: skip
WHITE = "navigation.attitude_white_sd_deg"
FIRST = {
    "boxes": ("detector.box_noise_px", "detector.box_noise_rel", WHITE),
    "points": ("detector.point_noise_px", WHITE),
}
WITH_TRUTH = ("navigation.attitude_bias_sd_deg", "navigation.height_bias_sd_m", "navigation.velocity_bias_sd_m_s")
LEAST_JUDGED = 4  # tracks in each half
COVER_LOW, COVER_HIGH, COVER_ROUNDS = -4.0, 1.0, 8  # logarithms of the factor, and halvings
COVER_TOLERANCE = 1.0  # percent
HEIGHT, GROUND = "navigation.height_bias_sd_m", "navigation.terrain_height_sd_m"


@dataclass
class Material:
    """The tracks of all logs: rows for the fit, and flights with truth for judging."""

    kind: str  # boxes or points
    rows: list[Rows] = field(default_factory=list)
    settling: list[Flight] = field(default_factory=list)
    judging: list[Flight] = field(default_factory=list)
    truth: bool = False
    left_out: int = 0


def _error_model(given: dict[str, float]) -> ErrorModel:
    """The configured errors on which the rows of boxes depend."""
    return ErrorModel(height_bias_sd_m=given[HEIGHT], terrain_height_sd_m=given[GROUND])


def _boxes(logs: Sequence[Path], given: dict[str, float], truth: bool, whole: bool) -> Material:
    tracks = [pair for log in logs for pair in box_tracks(log)]
    known = [flight for flight, has_truth in tracks if has_truth]
    result = Material("boxes", truth=truth and len(known) > 0)
    flights = known if result.truth else [flight for flight, _ in tracks]
    halves = result.truth and not whole and len(flights) >= 2 * LEAST_JUDGED
    result.settling, result.judging = (flights[0::2], flights[1::2]) if halves else (flights, [])
    for flight in tqdm(result.settling, desc="tracks", disable=None, leave=False):
        rows = box_rows(flight, _error_model(given), result.truth)
        if rows is None:
            result.left_out += 1
        else:
            result.rows += rows.pieces()
    return result


def _points(logs: Sequence[Path]) -> Material:
    result = Material("points", truth=True)
    for flight in (flight for log in logs for flight in point_tracks(log)):
        rows = point_rows(flight)
        if rows is None:
            result.left_out += 1
        else:
            result.rows += rows.pieces()
            result.settling.append(flight)
    return result


def gather(logs: Sequence[Path], given: dict[str, float], truth: bool, whole: bool) -> Material:
    """Boxes, if the logs have any; otherwise points, which need the truth."""
    material = _boxes(logs, given, truth, whole)
    if material.rows or material.left_out:
        return material
    if not truth:
        raise ValueError(f"{logs[0]}: no boxes, and points need the truth")
    return _points(logs)


def fitted(material: Material, given: dict[str, float]) -> Fitted:
    """``navigation.height_bias_sd_m`` includes the terrain height, which images cannot separate from it."""
    if not material.rows:
        raise ValueError(f"no track has enough images ({material.left_out} are too short or fit no obstacle)")
    start = dict(given)
    if material.kind == "boxes":
        start[HEIGHT] = math.hypot(given[HEIGHT], given[GROUND])
    more = WITH_TRUTH if material.truth else ()
    with tqdm(desc="steps", disable=None, leave=False) as bar:
        result = fit(material.rows, start, FIRST[material.kind], more, lambda: bar.update() and None)
    for name in result.names:
        low, high = RANGES[name]
        result.values[name] = min(max(result.values[name], low), high)
    return result


def settings_of(result: Fitted, given: dict[str, float], kind: str) -> dict[str, float]:
    """The settings to use: the fitted ones, and the given ones that differ from the defaults."""
    chosen = {name: value for name, value in given.items() if value != GIVEN[name]}
    chosen |= {name: result.values[name] for name in result.names}
    if kind == "boxes" and HEIGHT in result.names:
        chosen[GROUND] = 0.0
    return chosen


def scaled_to(
    material: Material, chosen: dict[str, float], names: Sequence[str], percent: float
) -> tuple[dict[str, float], float]:
    """Multiplies the fitted settings, except the height, by one factor, until this percentage of X0 and Z0 of the
    fitted tracks lies within two sigmas. Returns the settings and the percentage that they reach."""
    turned = [name for name in names if name != HEIGHT]

    def with_factor(logarithm: float) -> dict[str, float]:
        factor = math.exp(logarithm)
        return {**chosen, **{n: min(max(chosen[n] * factor, RANGES[n][0]), RANGES[n][1]) for n in turned}}

    def share(logarithm: float) -> float:
        shares = covered(material.settling, with_factor(logarithm))
        return 0.5 * (shares["X0"] + shares["Z0"])

    low, high = COVER_LOW, COVER_HIGH
    for _ in range(COVER_ROUNDS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if share(middle) > percent else (middle, high)
    middle = 0.5 * (low + high)
    return with_factor(middle), share(middle)


# ------------------------------------------------------------------------------------------------------------- printing


def _print_table(console: Console, result: Fitted, given: dict[str, float], kind: str, truth: bool) -> None:
    table = Table(box=None, pad_edge=False)
    for heading in ("setting", "given", "fitted", "one sigma"):
        table.add_column(heading, justify="left" if heading == "setting" else "right")
    for name in (*FIRST[kind], *(WITH_TRUTH if truth else ())):
        determined = name in result.names
        before = math.hypot(given[HEIGHT], given[GROUND]) if kind == "boxes" and name == HEIGHT else given[name]
        value = f"{result.values[name]:.4g}" if determined else "undetermined"
        table.add_row(name, f"{before:.4g}", value, f"{100 * result.share[name]:.0f} %" if determined else "")
    console.print(table)


def _print_coverage(console: Console, flights: Sequence[Flight], which: str, chosen: dict[str, float]) -> None:
    for label, settings in (("by default", {}), ("as fitted", chosen)):
        shares = ", ".join(f"{name} {share:.1f} %" for name, share in covered(flights, settings).items())
        console.print(f"within 2 sigma, {which} {len(flights)} tracks, {label}: {shares}")


def line_of(chosen: dict[str, float]) -> str:
    """Options for goe_replay."""
    return " ".join(f"--set {name}={value:.4g}" for name, value in sorted(chosen.items()))


def advice_of(chosen: dict[str, float]) -> str:
    """A warning next to the options. Empty: none is needed."""
    name = "detector.box_noise_rel"
    if chosen.get(name, GIVEN[name]) >= GIVEN[name]:
        return ""
    return (
        f"{name} = {chosen[name]:.4g} is the detector's noise alone. The filter assumes a smooth outline, and the "
        f"default {GIVEN[name]:g} includes the error of that assumption. Past obstacles with corners, such as "
        f"houses, keep {GIVEN[name]:g} or more."
    )


def _setting(text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    if name in renamed.names():
        raise argparse.ArgumentTypeError(f"unknown setting {name}: now {renamed.names()[name]}")
    if not equals or name not in GIVEN:
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=VALUE with one of {', '.join(GIVEN)}")
    try:
        number = float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{name}: '{value}' is not a number") from None
    if not (math.isfinite(number) and number >= 0.0):
        raise argparse.ArgumentTypeError(f"{name}: '{value}' must be at least 0")
    return name, number


def _percent(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 50.0 <= value <= 99.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a percentage from 50 to 99")
    return value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("logs", nargs="+", type=Path, metavar="LOG", help="log folders of one camera, detector and aircraft")
    add("--set", type=_setting, action="append", default=[], metavar="NAME=VALUE", help="starting point of the fit")
    add("--without-truth", action="store_true", help="use the innovations alone and ignore truth.csv")
    add("--all", action="store_true", help="fit all tracks; by default, every second one is only judged")
    add("--cover", type=_percent, metavar="PERCENT", help="then scale until this share of X0 and Z0 is within 2 sigma")


def run(arguments: argparse.Namespace) -> int:
    given = {**GIVEN, **dict(arguments.set)}
    material = gather(arguments.logs, given, not arguments.without_truth, arguments.all)
    result = fitted(material, given)
    chosen = settings_of(result, given, material.kind)
    console = Console(highlight=False, width=120)
    source = "the errors, as the truth is known" if material.truth else "the innovations"
    pieces = f"{result.rows} rows, {result.left_out} of them left out" if result.left_out else f"{result.rows} rows"
    console.print(f"{len(material.settling)} tracks with {material.kind}, {pieces}; from {source}")
    if material.left_out:
        console.print(f"{material.left_out} tracks are too short or fit no obstacle")
    _print_table(console, result, given, material.kind, material.truth)
    if arguments.cover is not None:
        if not material.truth or material.kind != "boxes":
            raise ValueError("--cover needs boxes and their truth")
        chosen, reached = scaled_to(material, chosen, result.names, arguments.cover)
        console.print(f"scaled: {reached:.1f} % of X0 and Z0 lie within 2 sigma on the fitted tracks")
        if not abs(reached - arguments.cover) <= COVER_TOLERANCE:
            warn(arguments.logs[0], f"--cover {arguments.cover:g}: no factor of the settings gives this share")
    if material.truth and material.kind == "boxes":
        fitted_on = "fitted on the 1st, 3rd, ...:" if material.judging else "the"
        _print_coverage(console, material.settling, fitted_on, chosen)
        if material.judging:
            _print_coverage(console, material.judging, "judged on the 2nd, 4th, ...:", chosen)
    console.print(line_of(chosen) if chosen else "the logs determine no further setting", soft_wrap=True)
    if advice_of(chosen):
        console.print(advice_of(chosen), soft_wrap=True)
    return 0
