"""Prints goe_replay's estimates as a table that a pilot can read."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from .estimates import Estimate, read_estimates, sigma_name
from .obslog import LogError, Truth, read_truth

DEFAULT_ROWS = 12
NOTHING = "-"
MODEL_WORDS = {"disc": "disc", "line": "front edge", "box": "box", "prism": "upright", "none": NOTHING}
WIDTH_WORDS = {"disc": "diameter", "prism": "width across the line of sight"}
REASON_WORDS = {"late": "poses late"}
HINT = (
    "Ahead and aside: from the aircraft to the obstacle's reference point, along and across the direction of flight "
    "(disc and upright: its center; front edge and box: the middle of the front edge). Turned: the side edge from the "
    "direction of flight, clockwise. ± is one sigma. A row marked * repeats an older solution. Suspect: the track does "
    "not fit its model, so its sigmas may be too small; widen the margins."
)


def measured(estimate: Estimate, quantity: str, unit: str = "", side: bool = False) -> str:
    """A value with its sigma: "123.4 ±1.2 m"; with ``side``, left or right replaces the sign."""
    if quantity not in estimate.values:
        return NOTHING
    value, sigma = estimate.values[quantity], estimate.values[sigma_name(quantity)]
    places = decimals(sigma, value)
    sign = ""
    if side:
        sign = " left" if value < 0.0 else " right"
        value = abs(value)
    return f"{value:.{places}f} ±{sigma:.{places}f}{unit}{sign}"


def decimals(sigma: float, value: float) -> int:
    """Decimals that show two figures of the sigma: at most 2, and at least as many as a value of that size needs."""
    if not sigma > 0.0:
        return 1 if abs(value) >= 100.0 else 2
    return min(2, max(0, 1 - math.floor(math.log10(sigma))))


def remark(estimate: Estimate) -> str:
    """Status and suspicion, for a reader of the estimate's numbers."""
    parts = [] if estimate.status in ("ok", "partial") else [f"* {estimate.status.replace('_', ' ')}"]
    reason = REASON_WORDS.get(estimate.reason, estimate.reason)
    if estimate.suspect:
        parts.append(f"suspect: {reason}")
    elif estimate.reason != "none":
        parts.append(reason)
    return ", ".join(parts)


def true_values(truth: Truth) -> dict[str, float | None]:
    """The known truth of a track, by quantity. Positions relative to the start only if the log contains them."""

    def extra(name: str) -> float | None:
        try:
            return float(truth.extra.get(name, ""))
        except ValueError:
            return None

    return {
        "x0_m": extra("x0_m"),
        "z0_m": extra("z0_m"),
        "width_m": truth.width_m,
        "length_m": truth.length_m,
        "height_m": truth.height_m,
        "orientation_deg": extra("orientation_deg"),
        "center_n_m": truth.center_n_m,
        "center_e_m": truth.center_e_m,
    }


def chosen(rows: Sequence[tuple[float, int, Estimate]], count: int) -> list[tuple[float, int, Estimate]]:
    """Up to `count` rows, spread evenly over those with an estimate; includes the first and the last."""
    solved = [row for row in rows if row[2].model != "none"]
    if len(solved) <= count:
        return solved
    if count == 1:
        return solved[-1:]
    return [solved[round(k * (len(solved) - 1) / (count - 1))] for k in range(count)]


def flight_table(track: int, rows: Sequence[tuple[float, int, Estimate]], count: int) -> Table:
    table = Table(title=f"obstacle {track}", title_justify="left", box=None, pad_edge=False)
    for heading in ("time", "to go ahead", "aside", "wide", "long", "high", "turned", "model", ""):
        table.add_column(heading, justify="left" if heading in ("model", "") else "right")
    for t_s, _, estimate in chosen(rows, count):
        table.add_row(
            f"{t_s:.1f} s",
            measured(estimate, "z_m", " m"),
            measured(estimate, "x_m", " m", side=True),
            measured(estimate, "width_m", " m"),
            measured(estimate, "length_m", " m"),
            measured(estimate, "height_m", " m"),
            measured(estimate, "orientation_deg", "°"),
            MODEL_WORDS.get(estimate.model, estimate.model),
            remark(estimate),
        )
    return table


def summary_table(last: Estimate, truth: Truth | None) -> Table:
    """The last estimate, quantity by quantity, next to the truth."""
    known = true_values(truth) if truth else {}
    if truth and last.model == "prism" and truth.width_m != truth.length_m:
        known["width_m"] = None  # across the line of sight: the width of neither side
    table = Table(box=None, pad_edge=False)
    table.add_column("last estimate")
    for heading in ("estimate ± sigma", "truth", "error"):
        table.add_column(heading, justify="right")
    lines = (
        ("distance ahead at the start", "z0_m", " m"),
        ("distance to the right at the start", "x0_m", " m"),
        (WIDTH_WORDS.get(last.model, "width of the front"), "width_m", " m"),
        ("length of the side", "length_m", " m"),
        ("height", "height_m", " m"),
        ("side edge from the flight direction", "orientation_deg", "°"),
        ("center, north", "center_n_m", " m"),
        ("center, east", "center_e_m", " m"),
    )
    for words, quantity, unit in lines:
        value, true = last.values.get(quantity), known.get(quantity)
        if value is None and true is None:
            continue
        error = NOTHING
        if value is not None and true is not None:
            difference = value - true
            if quantity == "orientation_deg":
                difference = math.remainder(difference, 180.0)
            error = f"{difference:+.2f}{unit}"
        table.add_row(words, measured(last, quantity, unit), NOTHING if true is None else f"{true:.2f}{unit}", error)
    return table


def print_tables(
    console: Console, rows: Sequence[tuple[float, int, Estimate]], truths: dict[int, Truth], count: int
) -> None:
    for track in dict.fromkeys(row[1] for row in rows):
        own = [row for row in rows if row[1] == track]
        solved = [row for row in own if row[2].model != "none"]
        if not solved:
            console.print(f"obstacle {track}: no estimate in {len(own)} images (last: {own[-1][2].status})")
            continue
        console.print(flight_table(track, own, count))
        console.print()
        console.print(summary_table(solved[-1][2], truths.get(track)))
        console.print()
    console.print(HINT)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("estimates", type=Path, metavar="ESTIMATES.csv", help="goe_replay's output")
    parser.add_argument("--truth", type=Path, metavar="FILE", help="the log's truth.csv, to print with the estimates")
    parser.add_argument("--id", type=int, metavar="N", help="this track only")
    parser.add_argument(
        "--rows",
        type=int,
        default=DEFAULT_ROWS,
        metavar="N",
        help=f"lines for each track, evenly spread (default {DEFAULT_ROWS})",
    )


def run(arguments: argparse.Namespace) -> int:
    if arguments.rows < 1:
        raise ValueError("--rows must be at least 1")
    rows = read_estimates(arguments.estimates)
    if arguments.id is not None:
        rows = [row for row in rows if row[1] == arguments.id]
        if not rows:
            raise LogError(arguments.estimates, 0, "id", f"no track {arguments.id}")
    truths = read_truth(arguments.truth) if arguments.truth else {}
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(width=140, highlight=False)
    print_tables(console, rows, truths, arguments.rows)
    return 0
