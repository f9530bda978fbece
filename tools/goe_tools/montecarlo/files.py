"""The files of a Monte Carlo run: runs.csv, summary.json, a picture for each obstacle and the page."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..logs.whole_file import write_whole
from .figure import png
from .flown import KEYS, QUANTITIES, Pass, Scenario
from .page import render
from .summary import INSIDE, LEVELS, Summary, inside_of, last_of
from .words import SIMULATION

PAGE, RUNS, SUMMARY = "montecarlo.html", "runs.csv", "summary.json"
DIGITS = 6  # significant


def _known(value: float) -> float | None:
    """None in place of NaN, for JSON and CSV."""
    return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None


def _list(values: np.ndarray) -> list[float | None]:
    return [_known(float(value)) for value in values]


def _run_row(one: Pass) -> dict[str, object]:
    row: dict[str, object] = {
        "seed": one.seed, "obstacle": one.obstacle, "ended_early": int(one.ended_early), "images": len(one.time_s),
        "closest_m": _known(one.closest_m), "violated_s": _known(one.violated_s), "warned_s": _known(one.warned_s),
        "lead_s": _known(one.lead_s), "verdict": one.verdict, "suspect_images": int(one.suspect.sum()),
    }  # fmt: skip
    for q, quantity in enumerate(QUANTITIES):
        unit = "deg" if quantity.unit == "°" else quantity.unit
        error, sigma = last_of(one, q)
        row |= {f"{quantity.key}_error_{unit}": _known(error), f"{quantity.key}_sd_{unit}": _known(sigma)}
        row |= {f"{quantity.key}_within_{n}_sigma": _known(inside_of(one, q, n)) for n in INSIDE}
    return row


def runs_table(passes: Sequence[Pass]) -> str:
    """One row for each run and obstacle: the last answer, and the share of the answers within 1 and 2 sigma."""
    text = io.StringIO()
    rows = [_run_row(one) for one in passes]
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _obstacle(summary: Summary) -> dict[str, Any]:
    rows, times, warnings = {}, summary.over_time, summary.warnings
    for q, row in enumerate(summary.rows):
        rows[row.key] = {
            "runs": row.runs, "last_error": _known(row.last_error), "last_sigma": _known(row.last_sigma),
            "rms_ratio": _known(row.rms),
            **{f"within_{n}_sigma": _known(share.mean) for n, share in row.inside.items()},
            **{f"within_{n}_sigma_standard_error": _known(share.error) for n, share in row.inside.items()},
            "over_time": {
                "runs": times.runs[:, q].tolist(),
                **{f"percentile_{level:g}": _list(times.level[:, q, i]) for i, level in enumerate(LEVELS)},
            },
        }  # fmt: skip
    return {
        "obstacle": summary.obstacle, "quantities": rows, "time_s": times.time_s.tolist(),
        "warnings": {
            "runs": warnings.runs, "violated": warnings.violated, "warned": warnings.warned,
            "missed": warnings.missed, "false": warnings.false, "quiet": warnings.quiet,
            "suspect": warnings.suspect, "lead_s": [_known(lead) for lead in warnings.leads_s],
        },
    }  # fmt: skip


def summary_text(scenario: Scenario, found: Sequence[Summary], seeds: Sequence[int], asked: int, version: str) -> str:
    options = scenario.options
    facts = {
        "note": SIMULATION, "version": version, "scenario": scenario.text, "seeds": [seeds[0], seeds[-1]],
        "runs": len(seeds), "runs_asked": asked, "method": options.method, "model": options.model,
        "window": options.window, "settings": options.settings, "margin_m": options.margin_m,
        "clearance_m": options.clearance_m, "quantities": list(KEYS), "obstacles": [_obstacle(one) for one in found],
    }  # fmt: skip
    return json.dumps(facts, indent=1, ensure_ascii=False) + "\n"


def write(
    folder: Path, scenario: Scenario, passes: Sequence[Pass], found: Sequence[Summary], seeds: Sequence[int],
    asked: int, version: str,
) -> list[Path]:  # fmt: skip
    """Writes each file completely or not at all; replaces the files of an earlier run, but never the scenario. Pictures
    of obstacles that only the earlier run had are removed."""
    content: dict[str, str | bytes] = {
        RUNS: runs_table(passes), SUMMARY: summary_text(scenario, found, seeds, asked, version)
    }  # fmt: skip
    content |= {f"obstacle_{one.obstacle}.png": png(one, "light", narrow=False) for one in found}
    content[PAGE] = render(scenario, found, seeds, asked, version)
    if (folder / SUMMARY).is_file():
        for picture in folder.glob("obstacle_*.png"):
            if picture.name not in content and picture.stem.partition("_")[2].isdecimal():
                picture.unlink()
    paths = []
    for name, what in content.items():
        if what:
            write_whole(folder / name, what, [Path(scenario.path)])
            paths.append(folder / name)
    return paths
