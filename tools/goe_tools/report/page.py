"""Writes the report: three HTML pages, each in one file without network or scripts, and the figures as separate files.

report.html        how early, how certain, how many collisions; links to the others
report_paper.html  the paper's campaign
report_goals.html  all goals, if a file of goals is given
report_figures/    every figure as SVG and PNG
"""

from __future__ import annotations

import base64
import multiprocessing
import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from tqdm import tqdm

from ..logs.whole_file import write_whole
from ..view import words
from ..view.picture import png
from ..view.story import Story
from . import answers, goals_page, paper_page, rare
from . import paper_table3 as t3
from .data import Campaign
from .figures import FIGURES
from .figures.drawing import render
from .prose import refined as rp

ANSWERS, GOALS, PAPER = "answers", "goals", "paper"  # the pages


@dataclass(frozen=True)
class PageFigure:
    """A figure for the templates: caption, and data URIs for wide pages and for phones."""

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
    """A figure's files and words. ``wide`` and ``narrow``: content by format; empty if the data are missing."""

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
    """All figures, in no particular order, on all cores if processes can be forked."""
    _shared[:] = [campaign]
    slowest_first = range(len(FIGURES) - 1, -1, -1)
    if "fork" not in multiprocessing.get_all_start_methods():
        yield from map(_draw_shared, slowest_first)
        return
    with ProcessPoolExecutor(os.cpu_count(), mp_context=multiprocessing.get_context("fork")) as pool:
        for job in as_completed([pool.submit(_draw_shared, index) for index in slowest_first]):
            yield job.result()


def draw_figures(campaign: Campaign, folder: Path) -> list[PageFigure]:
    """Draws every figure that the campaign has data for and writes it to ``folder`` as SVG and PNG."""
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


def _approach(shown: Story | None) -> dict[str, str] | None:
    """One flight as a picture, for each theme, wide and for phones."""
    if shown is None:
        return None
    chosen = shown.chosen(None)
    moment = shown.first_look(chosen)
    pictures = {
        theme + ("_narrow" if narrow else ""): _data_uri("png", png(shown, chosen, moment, theme, narrow))
        for theme in ("light", "dark")
        for narrow in (False, True)
    }
    row = int(chosen.row_at[moment])
    alt = f"An approach from above, and range, width and height over time. {words.place(chosen.answers, max(row, 0))}."
    return {**pictures, "alt": alt}


def _version(campaign: Campaign) -> str:
    version = str(campaign.facts.get("version", ""))
    return version if version[:1].isdigit() else ""


def _rare(campaign: Campaign) -> dict[str, Any] | None:
    """The record of rare events; None without one."""
    if campaign.rare is None:
        return None
    return {"sentence": rare.sentence(campaign.rare), "heads": rare.HEADS, "rows": rare.table(campaign.rare)}


def _answers_variables(campaign: Campaign) -> dict[str, Any]:
    shown = answers.story(campaign)
    return {
        "cards": answers.cards(campaign, shown), "approach": _approach(shown), "early": answers.early(campaign, shown),
        "certain": answers.certain(campaign), "boxes": answers.upright_boxes(campaign),
        "avoid": answers.orders(campaign), "rare": _rare(campaign), "record": answers.record(campaign.goals),
        "lead": rp.lead(campaign),
    }  # fmt: skip


def page_files(campaign: Campaign, out: Path) -> dict[str, Path]:
    """The pages of this campaign and their files."""
    files = {ANSWERS: out, PAPER: out.with_name(f"{out.stem}_paper{out.suffix}")}
    if campaign.goals is not None:
        files[GOALS] = out.with_name(f"{out.stem}_goals{out.suffix}")
    return files


@dataclass(frozen=True)
class Doors:
    """Other pages that the first one links to, if they were made."""

    live: Path | None = None
    view: Path | None = None


def _links(files: dict[str, Path], doors: Doors) -> dict[str, str]:
    """Relative to the first page's folder. Empty: there is no such page."""
    links = {name: files[name].name if name in files else "" for name in (ANSWERS, GOALS, PAPER)}
    start = files[ANSWERS].absolute().parent
    for name in ("live", "view"):
        page = getattr(doors, name)
        links[name] = Path(os.path.relpath(page.absolute(), start)).as_posix() if page is not None else ""
    return links


def render_pages(
    campaign: Campaign, figures: list[PageFigure], out: Path = Path("report.html"), doors: Doors | None = None
) -> dict[str, str]:
    """The text of each page."""
    environment = Environment(
        loader=PackageLoader(__package__, "pages"), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    files = page_files(campaign, out)
    shared = {
        "style": Markup((Path(__file__).parent / "pages" / "page.css").read_text(encoding="utf-8")),
        "version": _version(campaign),
        "figures": figures,
        "real": rp.real_data(campaign),
        "fraction": f"{t3.FRACTION:.0%}".replace("%", "\u00a0%"),
        "links": _links(files, doors or Doors()),
    }
    makers = {ANSWERS: _answers_variables, GOALS: goals_page.variables, PAPER: paper_page.variables}
    return {
        name: environment.get_template(f"{name}.html.j2").render(**shared, **makers[name](campaign)) for name in files
    }


def write_page(campaign: Campaign, out: Path, doors: Doors | None = None) -> None:
    """Writes the pages (each whole or not at all, the first one last) and the folder with the figures."""
    if out.is_dir():
        raise ValueError(f"{out} is a folder")
    answers.story(campaign)  # a bad log of --approach is refused before anything is written
    out.parent.mkdir(parents=True, exist_ok=True)
    figures = draw_figures(campaign, out.with_name(out.stem + "_figures"))
    texts = render_pages(campaign, figures, out, doors)
    for name, file in reversed(page_files(campaign, out).items()):
        write_whole(file, texts[name])
