"""The page of the paper's campaign: Table 3, Figures 5 to 14, and the studies beyond the paper."""

from __future__ import annotations

import math
from typing import Any

from . import paper_table3 as t3
from . import refined as rf
from . import statistics as st
from .data import Campaign
from .prose import misses, studies, table3
from .prose import refined as rp
from .style import COLORS, NAMES, SYMBOLS, UNITS, number

VERDICT_MARKS = {
    st.BETTER: ("better", "▲"),
    st.REPRODUCED: ("reproduced", "✓"),
    st.MEANS_ONLY: ("means", "◐"),
    st.WORSE: ("worse", "✗"),
    st.NOT_IN_PAPER: ("none", ""),
}


def _cell(cell: st.Cell | None) -> dict[str, Any] | None:
    if cell is None:
        return None
    css, mark = VERDICT_MARKS[cell.verdict]
    verdict = cell.verdict
    if cell.verdict in (st.WORSE, st.MEANS_ONLY):
        verdict = f"{'not reproduced' if cell.verdict == st.WORSE else 'means only'}, ×{number(cell.factor)}"
    return {
        "paper": None if cell.paper is None else str(cell.paper),
        "ours": number(cell.bars),
        "means": number(cell.means),
        "unit": UNITS[cell.quantity],
        "runs": len(cell.errors.mean),
        "css": css,
        "mark": mark,
        "verdict": verdict,
        "there": math.isfinite(cell.bars),
    }


def _table3(campaign: Campaign) -> list[dict[str, Any]]:
    return [
        {
            "name": NAMES[obstacle],
            "model": model,
            "color": COLORS[obstacle],
            "runs": len(st.paper_runs(campaign.cases, obstacle, model)),
            "cells": [_cell(cell) for cell in cells],
            "in_paper": (obstacle, model) in t3.PAPER_TABLE3,
        }
        for obstacle, model, cells in st.table3(campaign.cases)
    ]


def _fractions(campaign: Campaign) -> dict[str, Any]:
    """Table 3 for every part of the run, one small table for each quantity."""
    levels = campaign.cases.levels("fraction")
    by_level = {level: st.table3(campaign.cases, level) for level in levels}
    tables = []
    for i, quantity in enumerate(t3.TABLE3_QUANTITIES):
        rows = []
        for j, (obstacle, model) in enumerate(t3.PAPER_TABLE3):
            cells = [by_level[level][j][2][i] for level in levels]
            if any(cell is not None for cell in cells):
                paper = cells[0].paper if cells[0] is not None else None
                ours = [
                    None if c is None else {"text": number(c.bars), "css": VERDICT_MARKS[c.verdict][0]} for c in cells
                ]
                rows.append({"name": f"{NAMES[obstacle]}/{model}", "paper": str(paper) if paper else "–", "ours": ours})
        tables.append({"symbol": SYMBOLS[quantity], "unit": UNITS[quantity], "rows": rows})
    return {"levels": levels, "chosen": t3.FRACTION, "tables": tables}


def _studies(campaign: Campaign) -> list[dict[str, Any]]:
    rows = []
    for variant in st.variants(campaign.cases):
        straight = st.like_for_like(campaign.cases, variant.runs)
        cells = []
        for quantity in st.STUDY_QUANTITIES:
            ours, base = st.median_rmse(variant.runs, quantity), st.median_rmse(straight, quantity)
            cells.append({
                "value": number(ours),
                "ratio": number(ours / base) if base > 0.0 else "–",
                "worse": bool(base > 0.0 and ours > 1.5 * base),
                "unit": UNITS[quantity],
                "symbol": SYMBOLS[quantity],
            })  # fmt: skip
        rows.append({"label": variant.label, "runs": len(variant.runs), "cells": cells})
    return rows


def _trio(cell: rf.Trio | None) -> dict[str, Any] | None:
    if cell is None or not math.isfinite(cell.refined):
        return None
    return {
        "ours": number(cell.refined),
        "window": number(cell.window) if math.isfinite(cell.window) else "",
        "paper": str(cell.paper) if cell.paper else "",
        "factor": number(cell.factor) if math.isfinite(cell.factor) else "",
        "short": cell.factor < rf.FIVEFOLD,
    }


def _refined_table3(campaign: Campaign) -> list[dict[str, Any]]:
    return [
        {
            "name": NAMES[obstacle],
            "model": model,
            "configured": model == "box",
            "color": COLORS[obstacle],
            "runs": max(cell.runs for cell in cells if cell is not None),
            "cells": [_trio(cell) for cell in cells],
        }
        for obstacle, model, cells in rf.table3(campaign)
    ]


def _refined_studies(campaign: Campaign) -> list[dict[str, Any]]:
    return [
        {
            "label": row.label,
            "cells": [
                {"ours": number(ours), "window": number(theirs), "worse": ours > theirs}
                for theirs, ours in row.errors.values()
            ],
        }
        for row in rf.studies(campaign)
    ]


def _refined(campaign: Campaign) -> dict[str, Any] | None:
    """The section on the default method; None if the campaign has none of its rows."""
    if campaign.refined is None:
        return None
    return {
        "lead": rp.lead(campaign),
        "table3": _refined_table3(campaign),
        "table3_sentences": rp.table3(campaign),
        "fivefold": rf.FIVEFOLD,
        "short": any(cell.factor < rf.FIVEFOLD for cell in rf.papers(campaign)),
        "studies": _refined_studies(campaign),
        "study_sentences": rp.studies(campaign),
    }


def variables(campaign: Campaign) -> dict[str, Any]:
    """Of the template."""
    cases = campaign.cases
    return {
        "counts": st.campaign_counts(campaign),
        "ended_early": campaign.facts.get("flights_ended_early", 0),
        "most": f"{t3.MOST:.0%}",
        "rounding": f"{st.ROUNDING:g}",
        "quantities": [(SYMBOLS[q], UNITS[q]) for q in t3.TABLE3_QUANTITIES],
        "study_quantities": [(SYMBOLS[q], UNITS[q]) for q in st.STUDY_QUANTITIES],
        "table3": _table3(campaign),
        "summary": table3.summary(cases),
        "causes": misses.causes(cases),
        "better": table3.better(cases),
        "missing": table3.missing(cases),
        "fractions": _fractions(campaign),
        "fraction_effect": table3.fraction_effect(cases),
        "studies": _studies(campaign),
        "study_sentences": studies.studies(cases),
        "outliers": studies.outliers(campaign),
        "condition_effect": studies.condition_effect(campaign),
        "line_apart": st.line_apart(cases),
        "window_effect": studies.window_effect(campaign),
        "own_method": _refined(campaign),
        "own_name": "filter",
    }
