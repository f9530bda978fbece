"""Writes the HTML page, which needs nothing but itself, and the figures as files beside it."""

from __future__ import annotations

import base64
import math
import multiprocessing
import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from tqdm import tqdm

from . import prose
from . import statistics as st
from .data import Campaign
from .figures import FIGURES, render
from .style import COLOURS, NAMES, SYMBOLS, UNITS, number

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
            (folder / f"{spec.key}.{kind}").write_bytes(content)
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
            "in_paper": (obstacle, model) in st.PAPER_TABLE3,
        }
        for obstacle, model, cells in st.table3(campaign.cases)
    ]


def _fractions(campaign: Campaign) -> dict[str, Any]:
    """Table 3 again for every part of the run, one small table per quantity."""
    levels = campaign.cases.levels("fraction")
    by_level = {level: st.table3(campaign.cases, level) for level in levels}
    tables = []
    for i, quantity in enumerate(st.TABLE3_QUANTITIES):
        rows = []
        for j, (obstacle, model) in enumerate(st.PAPER_TABLE3):
            cells = [by_level[level][j][2][i] for level in levels]
            if any(cell is not None for cell in cells):
                paper = cells[0].paper if cells[0] is not None else None
                ours = [
                    None if c is None else {"text": number(c.bars), "css": VERDICT_MARKS[c.verdict][0]} for c in cells
                ]
                rows.append({"name": f"{NAMES[obstacle]}/{model}", "paper": str(paper) if paper else "–", "ours": ours})
        tables.append({"symbol": SYMBOLS[quantity], "unit": UNITS[quantity], "rows": rows})
    return {"levels": levels, "chosen": st.FRACTION, "tables": tables}


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
        most=f"{st.MOST:.0%}",
        fraction=f"{st.FRACTION:.0%}".replace("%", " %"),
        rounding=f"{st.ROUNDING:g}",
        quantities=[(SYMBOLS[q], UNITS[q]) for q in st.TABLE3_QUANTITIES],
        study_quantities=[(SYMBOLS[q], UNITS[q]) for q in st.STUDY_QUANTITIES],
        table3=_table3(campaign),
        summary=prose.summary(cases),
        causes=prose.causes(cases),
        better=prose.better(cases),
        missing=prose.missing(cases),
        fractions=_fractions(campaign),
        fraction_effect=prose.fraction_effect(cases),
        studies=_studies(campaign),
        study_sentences=prose.studies(cases),
        outliers=prose.outliers(campaign),
        condition_effect=prose.condition_effect(campaign),
        line_apart=st.line_apart(cases),
        window_effect=prose.window_effect(campaign),
        figures=figures,
        marks=VERDICT_MARKS,
    )


def write_page(campaign: Campaign, out: Path) -> None:
    """Writes ``out`` (whole or not at all) and the folder with its figures."""
    if out.is_dir():
        raise ValueError(f"{out} is a folder")
    out.parent.mkdir(parents=True, exist_ok=True)
    figures = draw_figures(campaign, out.with_name(out.stem + "_figures"))
    part = out.with_name(out.name + ".part")
    part.write_text(render_page(campaign, figures), encoding="utf-8")
    part.replace(out)
