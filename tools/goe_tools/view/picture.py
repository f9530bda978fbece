"""One moment of a log as a picture: a map, a close map of the obstacle, distance and size over time.

PNG: light or dark, wide or for phones. SVG: follows the reader's color scheme (prefers-color-scheme), otherwise light.
"""

from __future__ import annotations

import math
import re
import textwrap
from dataclasses import dataclass
from io import BytesIO

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon

from . import words
from .charts import CHARTS, Chart, axis_range
from .charts import text as chart_text
from .outline import SIGMAS
from .story import Story, Track, map_bounds

LIGHT = {
    "panel": "#ffffff", "ink": "#17202b", "soft": "#566270", "faint": "#dfe4ea", "own": "#3b4653", "look": "#e8b931",
    "estimate": "#0068a8", "true": "#00795a", "course": "#b0368f", "suspect": "#c24e00", "other": "#7b8794",
}  # fmt: skip
DARK = {
    "panel": "#161d25", "ink": "#e9eef4", "soft": "#a3b0be", "faint": "#2b3540", "own": "#c9d3de", "look": "#d3a93a",
    "estimate": "#5cb8f2", "true": "#35cf9f", "course": "#ea86cc", "suspect": "#ff9a54", "other": "#8794a2",
}  # fmt: skip
THEMES = {"light": LIGHT, "dark": DARK}
SIZE_IN, DPI_SVG, DPI_PNG = (8.0, 5.2), 100, 200  # the SVG is 800 px wide
NARROW_IN = (3.8, 8.4)
NARROW_LETTERS = 42  # of a line, narrow
EARLIER = (0.0, 0.25, 0.55)  # shares of the time with estimates before the moment: earlier regions shown
CIRCLE_POINTS = 60
LEAST_M = 12.0  # half the width of the close view
LOOK_STEPS = 24
LINE_PT = 900.0  # font size times letters of a bold line that fills the width


def style(theme: dict[str, str]) -> dict[str, object]:
    ink, soft, faint = theme["ink"], theme["soft"], theme["faint"]
    return {
        "font.size": 8.5, "font.family": "DejaVu Sans", "text.color": ink, "axes.labelcolor": soft,
        "axes.edgecolor": faint,
        "axes.linewidth": 0.8, "axes.facecolor": "none", "xtick.color": faint, "ytick.color": faint,
        "xtick.labelcolor": soft, "ytick.labelcolor": soft, "axes.grid": True, "grid.color": faint,
        "grid.linewidth": 0.6, "axes.axisbelow": True, "axes.spines.top": False, "axes.spines.right": False,
        "figure.facecolor": theme["panel"],
        "savefig.facecolor": theme["panel"], "svg.fonttype": "path", "svg.hashsalt": "goe", "xtick.major.size": 0,
        "ytick.major.size": 0,
    }  # fmt: skip


# ----------------------------------------------------------------------------------------------------------------- map


def outline_points(track: Track, k: int) -> np.ndarray:
    """(P, 2) of the estimate's outline; NaN if there is none."""
    x, y, radius = track.circle[k]
    if not math.isfinite(x):
        return track.corner[k]
    turn = 2.0 * np.pi * np.arange(CIRCLE_POINTS) / CIRCLE_POINTS
    return np.stack([x + radius * np.sin(turn), y + radius * np.cos(turn)], -1)


def _area(ax: Axes, points: np.ndarray, fill: str, alpha: float, edge: str, edge_alpha: float, width: float) -> None:
    if len(points) and np.isfinite(points).all():
        ax.add_patch(Polygon(points, closed=True, facecolor=fill, alpha=alpha, edgecolor="none", zorder=2))
        ax.add_patch(
            Polygon(points, closed=True, fill=False, edgecolor=edge, alpha=edge_alpha, linewidth=width, zorder=3)
        )


def _earlier_rows(track: Track, row: int) -> list[int]:
    """Rows of earlier estimates whose regions are drawn, too."""
    answered = np.flatnonzero(track.answers.answered[: row + 1])
    if len(answered) < 2:
        return []
    first, last = track.time_s[answered[0]], track.time_s[row]
    times = [first + share * (last - first) for share in EARLIER]
    return sorted({int(answered[np.searchsorted(track.time_s[answered], t - 1e-9)]) for t in times} - {row})


def _draw_obstacle(ax: Axes, story: Story, track: Track, moment: int, theme: dict[str, str]) -> None:
    row = int(track.row_at[moment])
    if row >= 0:
        for earlier in _earlier_rows(track, row):
            _area(ax, track.region[earlier], theme["estimate"], 0.06, theme["estimate"], 0.3, 0.7)
        _area(ax, track.region[row], theme["estimate"], 0.18, theme["estimate"], 0.7, 0.9)
        _area(ax, outline_points(track, row), theme["estimate"], 0.35, theme["estimate"], 1.0, 1.8)
    for other in story.tracks:
        k = int(other.row_at[moment])
        if other is not track and k >= 0:
            _area(ax, other.region[k], theme["other"], 0.12, theme["other"], 0.4, 0.6)
            _area(ax, outline_points(other, k), theme["other"], 0.0, theme["other"], 1.0, 1.3)
        if len(other.truth_outline):
            closed = np.vstack([other.truth_outline, other.truth_outline[:1]])
            ax.plot(*closed.T, color=theme["true"], linewidth=1.3, linestyle=(0, (3, 2)), zorder=5)


def _draw_approach(ax: Axes, story: Story, track: Track, moment: int, theme: dict[str, str]) -> None:
    row = int(track.row_at[moment])
    if row < 0 or not np.isfinite(track.closest[row]).all():
        return
    start, closest, nearest = story.path[moment], track.closest[row], track.nearest[row]
    ax.plot(*np.stack([start, closest]).T, color=theme["course"], linewidth=1.4, linestyle=(0, (4, 2)), zorder=4)
    if np.isfinite(track.moved[row]).all():
        there = outline_points(track, row)
        then = np.vstack([there, there[:1]]) + track.moved[row] - there.mean(0)
        for line in (np.stack([there.mean(0), track.moved[row]]), then):
            ax.plot(*line.T, color=theme["course"], linewidth=1.1, linestyle=(0, (4, 2)), zorder=4)
    if np.isfinite(nearest).all():
        ax.plot(*np.stack([closest, nearest]).T, color=theme["course"], linewidth=1.4, zorder=4)
    ax.plot(*closest, marker="D", markersize=4.5, color=theme["course"], zorder=6)


def _draw_flight(ax: Axes, story: Story, track: Track, moment: int, theme: dict[str, str], look: bool = True) -> None:
    path = np.where(story.broken[:, None], np.nan, story.path)
    x, y = story.path[moment]
    ax.plot(*path[moment:].T, color=theme["own"], linewidth=0.9, linestyle=(0, (1, 2)), zorder=3)
    ax.plot(*path[: moment + 1].T, color=theme["own"], linewidth=1.9, zorder=4)
    left, right = story.look_rad[moment]
    row = int(track.row_at[moment])
    if look and math.isfinite(left + right):
        there = outline_points(track, row) if row >= 0 else np.full((1, 2), np.nan)
        reach = 1.08 * float(np.hypot(*(there - [x, y]).T).max())
        if not math.isfinite(reach):
            bounds = map_bounds(story)
            reach = 0.4 * math.hypot(bounds[1] - bounds[0], bounds[3] - bounds[2])
        turn = left + np.linspace(0.0, (right - left) % (2.0 * math.pi), LOOK_STEPS)
        rim = np.stack([x + reach * np.sin(turn), y + reach * np.cos(turn)], -1)
        _area(ax, np.vstack([[x, y], rim]), theme["look"], 0.22, theme["look"], 0.0, 0.0)
    vx, vy = story.velocity[moment]
    angle = -math.degrees(math.atan2(vx, vy)) if math.isfinite(vx + vy) else 0.0
    arrow = matplotlib.markers.MarkerStyle(
        "^", transform=matplotlib.transforms.Affine2D().scale(0.75, 1.25).rotate_deg(angle)
    )
    ax.plot(x, y, marker=arrow, markersize=10, color=theme["own"], markeredgecolor=theme["panel"], zorder=7)


def _same_scale(ax: Axes, bounds: tuple[float, ...] | list[float], margin: float = 1.12) -> None:
    """Axis limits that contain left, right, bottom, top with one scale on both axes."""
    box = ax.get_window_extent()
    x0, x1, y0, y1 = bounds
    scale = margin * max((x1 - x0) / box.width, (y1 - y0) / box.height, 1e-3)
    x, y = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    ax.set_xlim(x - 0.5 * scale * box.width, x + 0.5 * scale * box.width)
    ax.set_ylim(y - 0.5 * scale * box.height, y + 0.5 * scale * box.height)


def _close_bounds(track: Track, row: int) -> tuple[float, float, float, float] | None:
    """Around the obstacle: outline, truth and region."""
    if row < 0 or not track.answers.answered[row]:
        return None
    points = np.vstack([outline_points(track, row), track.region[row], track.truth_outline])
    middle = 0.5 * (points.min(0) + points.max(0)) if track.anchor is None else track.anchor
    half = max(1.1 * float(np.abs(points - middle).max()), LEAST_M)
    return middle[0] - half, middle[0] + half, middle[1] - half, middle[1] + half


def _meters(ax: Axes) -> None:
    ax.xaxis.set_major_formatter("{x:g}")
    ax.yaxis.set_major_formatter("{x:g}")
    ax.locator_params(axis="x", nbins=3)
    ax.locator_params(axis="y", nbins=7)


# -------------------------------------------------------------------------------------------------------------- charts


def _draw_chart(ax: Axes, chart: Chart, story: Story, track: Track, moment: int, theme: dict[str, str]) -> None:
    answers, row = track.answers, int(track.row_at[moment])
    value = chart.scale * answers.column[chart.key]
    limits = axis_range(chart, answers, track.truth)
    shown = chart_text(chart, answers, row) if row >= 0 else words.NOTHING
    ax.set_title(chart.title, loc="left", fontsize=8.5, fontweight="bold", pad=4)
    ax.set_title(shown, loc="right", fontsize=8.5, fontweight="bold", color=theme["estimate"], pad=4)
    first, last = track.time_s[0], track.time_s[-1]
    ax.set_xlim(first - (0.0 if last > first else 0.5), last + 1e-6)
    ax.set_yticks([]) if limits is None else ax.set_ylim(*limits)
    if chart.sigma:
        band = SIGMAS * chart.scale * answers.column[chart.sigma]
        low = value - band if chart.least is None else np.maximum(value - band, chart.least)
        ax.fill_between(track.time_s, low, value + band, color=theme["estimate"], alpha=0.2, linewidth=0, zorder=2)
    if chart.key in track.truth:
        ax.plot(track.time_s, chart.scale * track.truth[chart.key], color=theme["true"], linewidth=1.3,
                linestyle=(0, (4, 2)), zorder=4)  # fmt: skip
    ax.plot(
        track.time_s, value, color=theme["estimate"], linewidth=1.6, zorder=3, marker="o" if len(value) == 1 else None
    )
    ax.axvline(story.time_s[moment], color=theme["ink"], linewidth=0.9, zorder=5)
    if row >= 0 and math.isfinite(value[row]):
        ax.plot(track.time_s[row], value[row], "o", color=theme["estimate"], markeredgecolor=theme["panel"], zorder=6)
    ax.locator_params(axis="y", nbins=4 if chart.key == "z_m" else 2)
    ax.locator_params(axis="x", nbins=5)


# ---------------------------------------------------------------------------------------------------------- the whole


def _handles(theme: dict[str, str], truth: bool) -> list[Line2D | Patch]:
    """The legend: every kind of line and area in the picture."""

    def line(label: str, color: str, style: object = "solid", width: float = 1.8, **more: object) -> Line2D:
        return Line2D([], [], color=theme[color], linestyle=style, linewidth=width, label=label, **more)

    def area(label: str, color: str, alpha: float) -> Patch:
        return Patch(facecolor=matplotlib.colors.to_rgba(theme[color], alpha), edgecolor=theme[color], label=label)

    handles: list[Line2D | Patch] = [
        line("flown path", "own"), line("later path", "own", (0, (1, 2)), 1.0), area("estimate", "estimate", 0.35),
        area("2σ region or band (pale: earlier)", "estimate", 0.12), area("camera's view", "look", 0.22),
    ]  # fmt: skip
    if truth:
        handles.append(line("truth", "true", (0, (3, 2)), 1.3))
    closest = line("course, closest approach", "course", (0, (4, 2)), 1.4, marker="D", markersize=3.5)
    return [*handles, closest, line("this moment", "ink", width=0.9)]


def _legend(figure: Figure, theme: dict[str, str], truth: bool, narrow: bool) -> None:
    handles = _handles(theme, truth)
    figure.legend(
        handles=handles, loc="lower left", bbox_to_anchor=(0.02, 0.002), ncols=2 if narrow else 4, frameon=False,
        fontsize=7.6, labelcolor=theme["soft"], handlelength=1.5, handletextpad=0.5, columnspacing=1.0,
        labelspacing=0.35,
    )  # fmt: skip


def _sentence(figure: Figure, track: Track, row: int, now: float, theme: dict[str, str]) -> None:
    answers = track.answers
    place = words.place(answers, row) if row >= 0 else words.NOT_YET
    figure.text(0.037, 0.955, place, fontsize=min(13.5, LINE_PT / len(place)), fontweight="bold", va="center")
    if row >= 0:
        figure.text(0.037, 0.905, words.approach(answers, row), fontsize=9.5, color=theme["course"], va="center")
        doubt = words.doubt(answers, row)
        figure.text(0.037, 0.867, doubt, fontsize=8.5, color=theme["suspect"], va="center", fontweight="bold")
    figure.text(0.972, 0.867, f"At {now:.1f} s. ± is 1σ.", fontsize=8.5, color=theme["soft"], va="center", ha="right")


def _narrow_sentence(figure: Figure, track: Track, row: int, now: float, theme: dict[str, str]) -> None:
    """The same in short lines."""
    answers = track.answers
    texts = [(words.place(answers, row) if row >= 0 else words.NOT_YET, "ink", "bold")]
    if row >= 0:
        texts += [(words.approach(answers, row), "course", "normal"), (words.doubt(answers, row), "suspect", "bold")]
    texts.append((f"At {now:.1f} s. ± is 1σ.", "soft", "normal"))
    y = 0.985
    for text, color, weight in texts:
        lines = textwrap.wrap(text.replace(words.HARD, " "), NARROW_LETTERS)
        figure.text(0.04, y, "\n".join(lines), fontsize=9.2, color=theme[color], fontweight=weight, va="top")
        y -= 0.0195 * len(lines) + (0.004 if lines else 0.0)


@dataclass(frozen=True)
class _Places:
    """Left, bottom, width, height of the axes in shares of the figure."""

    whole: tuple[float, float, float, float]
    close: tuple[float, float, float, float]
    ahead: tuple[float, float, float, float]
    sizes: tuple[tuple[float, float, float, float], ...]


WIDE = _Places(
    (0.062, 0.165, 0.285, 0.632), (0.41, 0.165, 0.25, 0.265), (0.41, 0.545, 0.562, 0.24),
    ((0.735, 0.335, 0.237, 0.095), (0.735, 0.165, 0.237, 0.095)),
)  # fmt: skip
NARROW = _Places(
    (0.13, 0.475, 0.36, 0.325), (0.62, 0.475, 0.325, 0.325), (0.13, 0.335, 0.815, 0.09),
    ((0.13, 0.23, 0.815, 0.055), (0.13, 0.125, 0.815, 0.055)),
)  # fmt: skip


def draw(story: Story, track: Track, moment: int, theme: dict[str, str], narrow: bool = False) -> Figure:
    figure = plt.figure(figsize=NARROW_IN if narrow else SIZE_IN, dpi=DPI_SVG)
    row = int(track.row_at[moment])
    places = NARROW if narrow else WIDE
    whole, close, ahead = (figure.add_axes(place) for place in (places.whole, places.close, places.ahead))
    sizes = [figure.add_axes(place) for place in places.sizes]
    for ax in (whole, close):
        _draw_obstacle(ax, story, track, moment, theme)
        _draw_approach(ax, story, track, moment, theme)
        _draw_flight(ax, story, track, moment, theme, look=ax is whole)
        _meters(ax)
    _same_scale(whole, map_bounds(story, track if story.brief(track) else None))
    near = _close_bounds(track, row)
    _same_scale(close, near or map_bounds(story), 1.06)
    close.locator_params(axis="y", nbins=7 if narrow else 4)
    whole.set_title("From above, m", loc="left", fontsize=8.5, fontweight="bold", pad=4)
    close.set_title("The obstacle, m", loc="left", fontsize=8.5, fontweight="bold", pad=4)
    charts = {chart.key: chart for chart in CHARTS}
    _draw_chart(ahead, charts["z_m"], story, track, moment, theme)
    ahead.xaxis.set_major_formatter("{x:g} s")
    for ax, key in zip(sizes, ("width_m", "height_m")):
        _draw_chart(ax, charts[key], story, track, moment, theme)
        ax.xaxis.set_major_formatter("{x:g} s")
    for ax in (ahead, sizes[0]) if narrow else sizes[:1]:
        ax.set_xticklabels([])
    (_narrow_sentence if narrow else _sentence)(figure, track, row, float(story.time_s[moment]), theme)
    _legend(figure, theme, any(len(t.truth_outline) or t.truth for t in story.tracks), narrow)
    return figure


def _saved(
    story: Story, track: Track, moment: int, theme: dict[str, str], kind: str, dpi: int, narrow: bool = False
) -> bytes:
    with plt.rc_context(style(theme)):
        figure = draw(story, track, moment, theme, narrow)
        file = BytesIO()
        nothing = {"Date": None, "Creator": None} if kind == "svg" else {"Software": None}
        figure.savefig(file, format=kind, dpi=dpi, metadata=nothing)
        plt.close(figure)
    return file.getvalue()


def png(story: Story, track: Track, moment: int, theme: str = "light", narrow: bool = False) -> bytes:
    """1600 x 1040 px; narrow, for phones: 760 x 1680 px."""
    return _saved(story, track, moment, THEMES[theme], "png", DPI_PNG, narrow)


def _adapting(text: str, description: str) -> str:
    """An SVG with colors as variables, which follow the reader's color scheme, and a title for screen readers."""
    for name, color in LIGHT.items():
        text = re.sub(rf"\b(fill|stroke): {color}\b", rf"\1: {color}; \1: var(--{name})", text)
    rules = (" ".join(f"--{name}: {color};" for name, color in theme.items()) for theme in (LIGHT, DARK))
    style = "<style>:root {{ {} }} @media (prefers-color-scheme: dark) {{ :root {{ {} }} }}</style>".format(*rules)
    text = text.replace("<svg ", '<svg role="img" aria-labelledby="title" ', 1)
    return re.sub(r"(<svg [^>]*>)", rf'\1<title id="title">{description}</title>{style}', text, count=1)


def svg(story: Story, track: Track, moment: int) -> bytes:
    """800 x 520 px."""
    row = int(track.row_at[moment])
    title = f"{words.place(track.answers, row)}. {words.approach(track.answers, row)}" if row >= 0 else words.NOT_YET
    return _adapting(_saved(story, track, moment, LIGHT, "svg", DPI_SVG).decode("utf-8"), title).encode("utf-8")
