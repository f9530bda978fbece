"""Writes the HTML page, which needs nothing but itself, and the figures as files beside it."""

from __future__ import annotations

import base64
import math
import multiprocessing
import os
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from tqdm import tqdm

from ..logs.obslog import read_log
from ..logs.whole_file import write_whole
from ..view.answers import Options
from ..view.picture import png
from ..view.story import story_of
from . import attacks, avoid, boxes, rare
from . import paper_table3 as t3
from . import refined as rf
from . import statistics as st
from .data import COVERED, Campaign
from .figures import FIGURES
from .figures.drawing import render
from .goals_file import QUANTITIES, GoalRow, Goals
from .prose import misses, studies, table3
from .prose import refined as rp
from .style import COLOURS, GOAL_SYMBOLS, NAMES, SYMBOLS, UNITS, number

VERDICT_MARKS = {
    st.BETTER: ("better", "▲"),
    st.REPRODUCED: ("reproduced", "✓"),
    st.MEANS_ONLY: ("means", "◐"),
    st.WORSE: ("worse", "✗"),
    st.NOT_IN_PAPER: ("none", ""),
}


@dataclass(frozen=True)
class PageFigure:
    """A figure as the template needs it: captions, and data URIs for wide pages and for phones."""

    key: str
    title: str
    section: str
    caption: str
    alt: str
    wide: str
    narrow: str


def _data_uri(kind: str, content: bytes) -> str:
    media = {"svg": "svg+xml", "png": "png"}[kind]
    return f"data:image/{media};base64,{base64.b64encode(content).decode('ascii')}"


@dataclass(frozen=True)
class Drawn:
    """A figure's files and words. ``wide`` and ``narrow``: content by format; empty where the data are lacking."""

    index: int
    wide: dict[str, bytes]
    narrow: dict[str, bytes]
    caption: str
    alt: str


def _draw(campaign: Campaign, index: int) -> Drawn:
    spec = FIGURES[index]
    wide = render(campaign, spec, False, ("svg", "png"))
    if not wide:
        return Drawn(index, {}, {}, "", "")
    return Drawn(index, wide, render(campaign, spec, True, (spec.in_page,)), *spec.describe(campaign))


_shared: list[Campaign] = []  # inherited by the drawing processes


def _draw_shared(index: int) -> Drawn:
    return _draw(_shared[0], index)


def _drawn(campaign: Campaign) -> Iterator[Drawn]:
    """All figures, in no particular order, on all cores where processes can be forked."""
    _shared[:] = [campaign]
    slowest_first = range(len(FIGURES) - 1, -1, -1)
    if "fork" not in multiprocessing.get_all_start_methods():
        yield from map(_draw_shared, slowest_first)
        return
    with ProcessPoolExecutor(os.cpu_count(), mp_context=multiprocessing.get_context("fork")) as pool:
        for job in as_completed([pool.submit(_draw_shared, index) for index in slowest_first]):
            yield job.result()


def draw_figures(campaign: Campaign, folder: Path) -> list[PageFigure]:
    """Draws what the campaign has the data for and writes it to ``folder`` as SVG and PNG."""
    folder.mkdir(parents=True, exist_ok=True)
    found: dict[int, PageFigure] = {}
    for drawn in tqdm(_drawn(campaign), total=len(FIGURES), desc="figures", disable=None):
        if not drawn.wide:
            continue
        spec = FIGURES[drawn.index]
        for kind, content in drawn.wide.items():
            write_whole(folder / f"{spec.key}.{kind}", content)
        wide, narrow = (_data_uri(spec.in_page, images[spec.in_page]) for images in (drawn.wide, drawn.narrow))
        found[drawn.index] = PageFigure(spec.key, spec.title, spec.section, drawn.caption, drawn.alt, wide, narrow)
    return [found[index] for index in sorted(found)]


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
            "colour": COLOURS[obstacle],
            "runs": len(st.paper_runs(campaign.cases, obstacle, model)),
            "cells": [_cell(cell) for cell in cells],
            "in_paper": (obstacle, model) in t3.PAPER_TABLE3,
        }
        for obstacle, model, cells in st.table3(campaign.cases)
    ]


def _fractions(campaign: Campaign) -> dict[str, Any]:
    """Table 3 again for every part of the run, one small table per quantity."""
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
        "refined": number(cell.refined),
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
            "told": model == "box",
            "colour": COLOURS[obstacle],
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
                {"refined": number(ours), "window": number(theirs), "worse": ours > theirs}
                for theirs, ours in row.errors.values()
            ],
        }
        for row in rf.studies(campaign)
    ]


def _goal_rows(rows: Iterable[GoalRow]) -> list[dict[str, Any]]:
    found, group = [], ""
    for row in rows:
        names = QUANTITIES if row.by_quantity else tuple(row.values)
        cells = []
        for name in names:
            value = row.values.get(name, math.nan)
            text = rp.goal_value(value) if math.isfinite(value) or name in row.asked else ""
            css = "miss" if name in row.missed else "unasked" if row.asked and name not in row.asked else ""
            cells.append({"name": rp.value_label(name), "text": text, "css": css})
        found.append({
            "group": rf.group_title(row.group) if row.group != group else "", "name": row.name,
            "unit": rp.unit_text(row), "wanted": rp.wanted(row), "by_quantity": row.by_quantity, "cells": cells,
            "met": row.met,
        })  # fmt: skip
        group = row.group
    return found


def _rivals(goals: Goals) -> list[dict[str, Any]]:
    tables = []
    for noise, rows in rf.rivals(goals).items():
        ours = next((row.errors for row in rows if row.name == "filter"), dict.fromkeys(QUANTITIES, math.nan))
        told = []
        for row in rows:
            cells = []
            for name in QUANTITIES:
                share = row.answers.get(name, math.nan)
                cells.append({
                    "text": number(row.errors[name]), "ahead": row.errors[name] < ours[name],
                    "share": number(share) if 0.0 < share < 99.95 else "",
                })  # fmt: skip
            told.append({
                "name": rp.METHOD_NAMES.get(row.name, row.name), "own": row.name == "filter", "cells": cells,
                "strength": "" if tables else rp.STRENGTHS.get(row.name, ""),
            })  # fmt: skip
        tables.append({"noise": rp.NOISE_NAMES.get(noise, noise), "flights": rows[0].flights, "rows": told,
                       "strengths": not tables})  # fmt: skip
    return tables


def _goals(goals: Goals) -> dict[str, Any] | None:
    """Without those of the attacks, which have a section of their own; None if there are no others."""
    goals = attacks.without(goals)
    if not goals.rows:
        return None
    parts = (
        ("early", rp.early(goals)), ("bound", rp.bounds(goals)), ("coverage", [*rp.coverage(goals), *rp.nees(goals)]),
        ("flags", rp.flags(goals)),
    )  # fmt: skip
    return {
        "verdict": rp.verdict(goals),
        "missed": rp.missed(goals),
        "asked": _goal_rows(goals.asked),
        "others": _goal_rows(row for row in goals.rows if row.met is None),
        "parts": [{"figure": figure, "sentences": sentences} for figure, sentences in parts],
        "rivals": _rivals(goals),
        "rival_heads": [(GOAL_SYMBOLS[name], "°" if name == "orientation" else "m") for name in QUANTITIES],
        "rival_sentences": rp.rivals(goals),
    }


def _refined(campaign: Campaign) -> dict[str, Any] | None:
    """The section on the filter method; None if the campaign has none of its rows and there are no goals."""
    if campaign.refined is None and campaign.goals is None:
        return None
    return {
        "lead": rp.lead(campaign),
        "table3": _refined_table3(campaign),
        "table3_sentences": rp.table3(campaign),
        "fivefold": rf.FIVEFOLD,
        "short": any(cell.factor < rf.FIVEFOLD for cell in rf.papers(campaign)),
        "studies": _refined_studies(campaign),
        "study_sentences": rp.studies(campaign),
        "goals": _goals(campaign.goals) if campaign.goals else None,
    }


def _boxes(campaign: Campaign) -> dict[str, Any] | None:
    """The section on upright boxes; None if they were not flown."""
    rows = boxes.by_roll(campaign)
    if not rows:
        return None
    told = []
    for row in rows:
        cells = [
            {"refined": number(of[0][q]), "window": number(of[1][q]), "head": f"{SYMBOLS[q]} {head}"}
            for head, of in (
                ("[m]", (row.refined.error_m, row.window.error_m)),
                ("in 2σ [%]", (row.refined.covered, row.window.covered)),
            )
            for q in COVERED
        ]  # fmt: skip
        told.append({"roll": f"{row.roll_deg:g}°", "flights": row.flights, "cells": cells})
    return {"rows": told, "heads": [cell["head"] for cell in told[0]["cells"]], "sentences": boxes.sentences(rows)}


def _attacks(campaign: Campaign) -> dict[str, Any] | None:
    """The section on hostile flights; None if the goals have none."""
    if campaign.goals is None:
        return None
    table, warnings = attacks.attack_table(campaign.goals), attacks.warning_table(campaign.goals)
    if not table and not warnings:
        return None
    return {
        "rows": table, "warnings": warnings, "sentences": attacks.sentences(campaign.goals),
        "heads": [*(GOAL_SYMBOLS[name] for name in QUANTITIES), "5σ off", "suspect"],
        "warning_heads": ["told: true", "in 2σ: time/miss/clearance", "unwarned", "false"],
    }  # fmt: skip


def _avoid(campaign: Campaign) -> dict[str, Any] | None:
    """The section on the flight layer's orders; None without goe_avoid's runs."""
    if campaign.avoid is None:
        return None
    return {
        "sentence": avoid.sentence(campaign.avoid), "heads": avoid.heads(campaign.avoid),
        "rows": avoid.table(campaign.avoid), **avoid.setup(campaign.avoid),
    }  # fmt: skip


def _rare(campaign: Campaign) -> dict[str, Any] | None:
    """The record of rare events; None without one."""
    if campaign.rare is None:
        return None
    return {"sentence": rare.sentence(campaign.rare), "heads": rare.HEADS, "rows": rare.table(campaign.rare)}


def _approach(campaign: Campaign) -> dict[str, str] | None:
    """One flight as a picture, by the page's theme."""
    if campaign.approach is None:
        return None
    log = read_log(campaign.approach)
    story = story_of(campaign.approach.resolve().name, log, Options())
    chosen = story.chosen(None)
    moment = story.first_look(chosen)
    return {theme: _data_uri("png", png(story, chosen, moment, theme)) for theme in ("light", "dark")}


def _version(campaign: Campaign) -> str:
    version = str(campaign.facts.get("version", ""))
    return version if version[:1].isdigit() else ""


def render_page(campaign: Campaign, figures: list[PageFigure]) -> str:
    environment = Environment(
        loader=PackageLoader(__package__, "."), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    cases = campaign.cases
    return environment.get_template("template.html.j2").render(
        counts=st.campaign_counts(campaign),
        version=_version(campaign),
        ended_early=campaign.facts.get("flights_ended_early", 0),
        most=f"{t3.MOST:.0%}",
        fraction=f"{t3.FRACTION:.0%}".replace("%", " %"),
        rounding=f"{st.ROUNDING:g}",
        quantities=[(SYMBOLS[q], UNITS[q]) for q in t3.TABLE3_QUANTITIES],
        study_quantities=[(SYMBOLS[q], UNITS[q]) for q in st.STUDY_QUANTITIES],
        table3=_table3(campaign),
        summary=table3.summary(cases),
        causes=misses.causes(cases),
        better=table3.better(cases),
        missing=table3.missing(cases),
        fractions=_fractions(campaign),
        fraction_effect=table3.fraction_effect(cases),
        studies=_studies(campaign),
        study_sentences=studies.studies(cases),
        outliers=studies.outliers(campaign),
        condition_effect=studies.condition_effect(campaign),
        line_apart=st.line_apart(cases),
        window_effect=studies.window_effect(campaign),
        refined=_refined(campaign),
        boxes=_boxes(campaign),
        attacks=_attacks(campaign),
        avoid=_avoid(campaign),
        rare=_rare(campaign),
        approach=_approach(campaign),
        real=rp.real_data(campaign),
        goal_symbols=[GOAL_SYMBOLS[name] for name in QUANTITIES],
        figures=figures,
        marks=VERDICT_MARKS,
    )


def write_page(campaign: Campaign, out: Path) -> None:
    """Writes ``out`` (whole or not at all) and the folder with its figures."""
    if out.is_dir():
        raise ValueError(f"{out} is a folder")
    out.parent.mkdir(parents=True, exist_ok=True)
    figures = draw_figures(campaign, out.with_name(out.stem + "_figures"))
    write_whole(out, render_page(campaign, figures))
