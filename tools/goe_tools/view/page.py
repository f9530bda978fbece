"""The page: one file that contains plotly.js and the numbers, both compressed; it fetches nothing.

plotly.js (MIT) comes from the pinned Python package ``plotly``: 4.8 MB, after deflate and base64 2.0 MB.
The browser inflates it by DecompressionStream (Chromium 80, Firefox 113, Safari 16.4). Numbers are the
library's float32, of at most ``story.MOST_ROWS`` images, under 1 MB.
"""

from __future__ import annotations

import base64
import json
import math
import zlib
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from ..library import package
from . import words
from .charts import Chart, axis_range, charts_of, text
from .story import Story, Track, map_bounds

LEVEL = 9  # of deflate
TALL = 0.6  # width over height of the flight on the map; below, the map is tall


class Numbers:
    """Concatenated arrays as float32, with the start of each."""

    def __init__(self) -> None:
        self.parts: list[np.ndarray] = []
        self.count = 0

    def put(self, values: np.ndarray) -> tuple[int, int]:
        """Start and length, in numbers."""
        flat = np.ascontiguousarray(values, np.float32).ravel()
        self.parts.append(flat)
        self.count += len(flat)
        return self.count - len(flat), len(flat)

    def bytes(self) -> bytes:
        return np.concatenate(self.parts).astype("<f4").tobytes() if self.parts else b""


def _packed(content: bytes) -> Markup:
    return Markup(base64.b64encode(zlib.compress(content, LEVEL)).decode("ascii"))


def _track_data(story: Story, track: Track, described: tuple[Chart, ...], numbers: Numbers) -> dict[str, Any]:
    answers, rows = track.answers, range(len(track.answers))
    columns = {"time": track.time_s, "rowAt": track.row_at, "suspect": answers.suspect, "fresh": answers.fresh}
    columns |= {"circle": track.circle, "corner": track.corner, "region": track.region, "closest": track.closest}
    columns |= {"nearest": track.nearest, "moved": track.moved, "act": answers.act}
    charts = []
    for chart in described:
        limits = axis_range(chart, answers, track.truth)
        if limits is None:
            charts.append(None)
            continue
        charts.append({"range": limits, "text": [text(chart, answers, k) for k in rows]})
        columns[chart.key] = chart.scale * answers.column[chart.key]
        if chart.sigma:
            columns[chart.sigma] = chart.scale * answers.column[chart.sigma]
        if chart.key in track.truth:
            columns["true_" + chart.key] = chart.scale * track.truth[chart.key]
    return {
        "id": track.id,
        "columns": {name: numbers.put(values) for name, values in columns.items()},
        "charts": charts,
        "first": story.first_look(track),
        "truth": track.truth_outline.round(3).tolist(),
        "anchor": None if track.anchor is None else track.anchor.round(3).tolist(),
        "place": [words.place(answers, k) for k in rows],
        "approach": [words.approach(answers, k) for k in rows],
        "state": [words.state(answers, k) for k in rows],
        "doubt": [words.doubt(answers, k) for k in rows],
        "model": answers.model,
        "status": answers.status,
    }


def _story_data(story: Story, chosen: Track, first: int, numbers: Numbers) -> dict[str, Any]:
    described = charts_of(story.options)
    own = {"time": story.time_s, "path": story.path, "look": story.look_rad, "velocity": story.velocity}
    own |= {"broken": story.broken, "reset": story.reset}
    return {
        "moments": {name: numbers.put(values) for name, values in own.items()},
        "bounds": map_bounds(story),
        "view": "ahead" if story.brief(chosen) else "whole",
        "north": math.degrees(story.north_rad),
        "first": first,
        "chosen": story.tracks.index(chosen),
        "charts": [
            {"key": c.key, "title": c.title, "unit": c.unit, "note": c.note, "sigma": c.sigma, "least": c.least,
             "limit": c.limit}
            for c in described
        ],
        "tracks": [_track_data(story, track, described, numbers) for track in story.tracks],
    }  # fmt: skip


@lru_cache(maxsize=1)
def _plotly() -> Markup:
    """plotly.js, compressed."""
    try:
        from plotly.offline import get_plotlyjs
    except ImportError:
        raise ValueError("the page needs the Python package plotly, which tools/setup.sh installs") from None
    return _packed(get_plotlyjs().encode("utf-8"))


def _facts(story: Story) -> list[str]:
    """The sentences in the page's footer."""
    options = story.options
    shown = sum(len(track.answers) for track in story.tracks)
    facts = [f"{story.rows:,} rows of {len(story.tracks):,} obstacle{'s' if len(story.tracks) != 1 else ''}."]
    if shown < story.rows:
        facts.append(
            f"{shown:,} of them are shown: evenly distributed, and those with a change of estimate, model, suspicion "
            "or filter reset."
        )
    changed = ", ".join(f"{name}={value:g}" for name, value in options.settings.items())
    facts.append(
        f"Replayed with method {options.method}, model {options.model}{', with ' + changed if changed else ''}."
    )
    rule = package().DecisionRule()
    facts.append(
        f"Conflict: less than {options.margin_m:g} m to the side and {options.clearance_m:g} m above the top. Both "
        f"distances are {rule.suspect_factor:g} times as large while the estimate is suspect, and grow by "
        f"{rule.stale_growth_m_s:g} m for each second of its age. Act now: decision of goe_decide(), "
        f"if the conflict probability is at least {100.0 * rule.conflict_probability_max:g} % "
        f"and the obstacle may be reached within {rule.act_within_s:g} s."
    )
    return facts


def _is_tall(story: Story) -> bool:
    """Whether the map of the whole flight fits into half of the map card's width."""
    left, right, bottom, top = map_bounds(story)
    return right - left < TALL * (top - bottom)


def render(story: Story, chosen: Track, first: int) -> str:
    """The page's text. ``first``: the initial moment."""
    numbers = Numbers()
    data = json.dumps(
        _story_data(story, chosen, first, numbers), ensure_ascii=False, separators=(",", ":"), allow_nan=False
    )
    folder = Path(__file__).parent
    environment = Environment(
        loader=PackageLoader(__package__, "."), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    row = max(int(chosen.row_at[first]), 0)
    return environment.get_template("page.html.j2").render(
        name=story.name,
        tracks=story.tracks,
        chosen=chosen,
        moments=len(story.time_s),
        first=first,
        summary=words.place(chosen.answers, row),
        answered=any(track.answers.answered.any() for track in story.tracks),
        truth=any(track.truth for track in story.tracks),
        tall=_is_tall(story),
        facts=_facts(story),
        style=Markup((folder / "page.css").read_text(encoding="utf-8")),
        script=Markup((folder / "page.js").read_text(encoding="utf-8")),
        plotly=_plotly(),
        data=_packed(data.encode("utf-8")),
        numbers=_packed(numbers.bytes()),
    )
