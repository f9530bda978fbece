"""The page: one file without scripts, styled like the page of ``view``."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, StrictUndefined
from markupsafe import Markup

from . import words
from .figure import png, shown
from .flown import Scenario
from .summary import BAND_RUNS, Summary

STYLE = Path(__file__).resolve().parents[1] / "view" / "page.css"
OWN_STYLE = """
body { padding-bottom: 2rem; } header { display: block; }
h2 { font-size: 1.15rem; margin: 2rem 0 .4rem; } p { max-width: 52rem; }
.simulation { border-left: 4px solid var(--suspect); background: var(--panel); padding: .5rem .8rem; }
.sheet, pre { overflow-x: auto; background: var(--panel); padding: .4rem .7rem; }
.sheet, pre, figure img { border: 1px solid var(--faint); border-radius: .7rem; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; font-size: .9rem; }
th, td { text-align: right; padding: .3rem .5rem; border-bottom: 1px solid var(--faint); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; white-space: normal; min-width: 9rem; }
tbody tr:last-child td { border-bottom: 0; }
figure { margin: 1rem 0; } figure img { display: block; width: 100%; height: auto; }
"""
TEMPLATE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<link rel="icon" href="data:,">
<title>goe: {{ name }}, {{ runs }} runs</title>
<style>
{{ style }}
</style>
</head>
<body>
<header>
<div class="title"><h1>{{ name }}</h1>
<p>{{ runs }}{% if asked != runs %} of {{ asked }}{% endif %} runs, seeds {{ seeds }}; goe {{ version }}</p></div>
</header>
<main>
<p class="simulation">{{ simulation }}</p>
{% for one in obstacles %}
<section>
<h2>Obstacle {{ one.number }}</h2>
{% for sentence in one.warnings %}<p>{{ sentence }}</p>
{% endfor %}
<div class="sheet"><table>
<thead><tr>{% for head in heads %}<th scope="col">{{ head }}</th>{% endfor %}</tr></thead>
<tbody>
{% for row in one.rows %}<tr>{% for cell in row %}<td>{{ cell }}</td>{% endfor %}</tr>
{% endfor %}
</tbody></table></div>
{% if one.unanswered %}<p>{{ one.unanswered }}</p>{% endif %}
{% if one.wide_light %}
<figure>
<picture>
<source media="(max-width: 40rem) and (prefers-color-scheme: dark)" srcset="{{ one.narrow_dark }}">
<source media="(max-width: 40rem)" srcset="{{ one.narrow_light }}">
<source media="(prefers-color-scheme: dark)" srcset="{{ one.wide_dark }}">
<img src="{{ one.wide_light }}" alt="Error over sigma over time: {{ one.shown }}">
</picture>
<figcaption><span>line: median of the runs</span><span>dark band: 68 % of the runs</span>
<span>pale band: 95 %</span><span>dotted: 1 sigma, dashed: 2 sigma</span></figcaption>
</figure>
{% else %}
<p>Fewer than {{ band_runs }} runs have an answer at the same time: no plot over time.</p>
{% endif %}
</section>
{% endfor %}
<section>
<h2>How to read this</h2>
<p>{{ how_to_read }}</p>
<p>If the sigmas are right, the dark band reaches the dotted lines and the pale band the dashed ones.</p>
<h2>The scenario</h2>
<pre>{{ scenario }}</pre>
</section>
</main>
</body>
</html>
"""


def _uri(content: bytes) -> str:
    return f"data:image/png;base64,{base64.b64encode(content).decode('ascii')}" if content else ""


def _obstacle(summary: Summary, margin_m: float, clearance_m: float) -> dict[str, object]:
    pictures = {
        f"{width}_{theme}": _uri(png(summary, theme, width == "narrow"))
        for width in ("wide", "narrow")
        for theme in ("light", "dark")
    }
    rows = [words.cells(row) for row in summary.rows if row.runs]
    return {
        "number": summary.obstacle, "rows": rows, "unanswered": words.unanswered(summary),
        "warnings": words.warning_sentences(summary.warnings, margin_m, clearance_m),
        "shown": ", ".join(summary.rows[q].key for q in shown(summary)), **pictures,
    }  # fmt: skip


def render(scenario: Scenario, found: Sequence[Summary], seeds: Sequence[int], asked: int, version: str) -> str:
    options = scenario.options
    template = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    ).from_string(TEMPLATE)
    return template.render(
        name=Path(scenario.path).name, runs=len(seeds), asked=asked, seeds=f"{seeds[0]} to {seeds[-1]}",
        version=version, style=Markup(STYLE.read_text(encoding="utf-8") + OWN_STYLE), simulation=words.SIMULATION,
        obstacles=[_obstacle(one, options.margin_m, options.clearance_m) for one in found], heads=words.HEADS,
        band_runs=BAND_RUNS, how_to_read=words.HOW_TO_READ, scenario=scenario.text,
    )  # fmt: skip
