"""Results of the default method (filter): Table 3, studies; and of the goals: early warning, bounds, other methods."""

from __future__ import annotations

import math
from dataclasses import dataclass

from . import paper_table3 as t3
from . import statistics as st
from .data import Campaign, Cases
from .goals_file import QUANTITIES, GoalRow, Goals

FIVEFOLD = 5.0  # goal for every cell of Table 3: so many times narrower than the paper's range
BOXES = ("building", "truck", "long-truck")
KINDS = ("boxes", "cylinders", "parked cars")
MOMENTS = ("all answers", "first answers", "at the end")
GROUPS = {  # beginnings of the goals' groups, and their titles
    "gauss0.3": "Gaussian pixel noise, 0.3 px",
    "gauss1": "Gaussian pixel noise, 1 px",
    "rounding": "Whole pixels",
    "field": "All errors of a small aircraft's sensors",
    "table3": "The paper's Table 3",
    "early": "Early warning",
    "recorded": "Autopilots' recorded flights",
    "kitti": "KITTI's cars",
    "boxes": "Upright bounding boxes",
    "rivals": "Other methods",
}


AUTOPILOTS = {"px4": "PX4", "arduplane": "ArduPlane"}


def group_title(group: str) -> str:
    for start, title in GROUPS.items():
        if group == start:
            return title
        if group.startswith((f"{start} ", f"{start}:")):
            rest = group[len(start) :].strip(" :")
            return f"{title}, {AUTOPILOTS.get(rest, rest)}"
    return group


@dataclass(frozen=True)
class Trio:
    """A number of Table 3: the paper's range, the window method's and the filter method's (percent; height m)."""

    obstacle: str
    model: str  # the paper's row; "box": filter alone, configured for a box
    quantity: str
    paper: t3.PaperRange | None
    window: float
    refined: float
    runs: int  # of the filter method, with the quantity
    without: int  # ... and without it

    @property
    def factor(self) -> float:
        """How many times narrower than the paper's range; a lower limit if the paper's values lie beyond it."""
        return self.paper.value / self.refined if self.paper and self.refined > 0.0 else math.nan


def refined_runs(refined: Cases, obstacle: str, model: str) -> Cases:
    return refined.select(study="paper", obstacle=obstacle, model=model, fraction=t3.FRACTION)


def _trio(campaign: Campaign, obstacle: str, model: str, quantity: str) -> Trio | None:
    window = None if model == "box" else st.make_cell(campaign.cases, obstacle, model, quantity)
    if campaign.refined is None or (window is None and model != "box"):
        return None
    runs = refined_runs(campaign.refined, obstacle, "box" if model == "box" else "auto")
    errors = st.errors_of(runs, quantity)
    return Trio(
        obstacle, model, quantity, window.paper if window else None, window.bars if window else math.nan,
        t3.holding_range(errors.extent), len(errors.mean), errors.without_estimate,
    )  # fmt: skip


def table3(campaign: Campaign) -> list[tuple[str, str, list[Trio | None]]]:
    """Rows (obstacle, model, cells in the order of TABLE3_QUANTITIES): the paper's, then boxes configured as such."""
    if campaign.refined is None:
        return []
    configured = [(o, "box") for o in BOXES if len(refined_runs(campaign.refined, o, "box"))]
    rows = (*t3.PAPER_TABLE3, *configured)
    return [(o, m, [_trio(campaign, o, m, q) for q in t3.TABLE3_QUANTITIES]) for o, m in rows]


def papers(campaign: Campaign) -> list[Trio]:
    """The numbers that the paper gives."""
    return [cell for _, _, cells in table3(campaign) for cell in cells if cell is not None and cell.paper is not None]


@dataclass(frozen=True)
class StudyRow:
    """Root mean square errors, medians over the runs, by quantity: window, filter."""

    label: str
    errors: dict[str, tuple[float, float]]


def studies(campaign: Campaign) -> list[StudyRow]:
    """Straight flight first; boxes and cylinder together, the switching window method and the filter."""
    if campaign.refined is None:
        return []
    window, refined = (_of_auto(cases) for cases in (campaign.cases, campaign.refined))
    straight = [cases.select(study="paper", fraction=t3.FRACTION) for cases in (window, refined)]
    pairs = [("straight, as the paper", *straight)]
    others = {variant.label: variant.runs for variant in st.variants(refined)}
    pairs += [(v.label, v.runs, others[v.label]) for v in st.variants(window) if v.label in others]
    return [
        StudyRow(label, {q: (st.median_rmse(a, q), st.median_rmse(b, q)) for q in st.STUDY_QUANTITIES})
        for label, a, b in pairs
    ]


def _of_auto(cases: Cases) -> Cases:
    return cases.where((cases["model"] == "auto") | (cases["obstacle"] == "cylinder"))


# --------------------------------------------------------------------------------------------------------------- goals


def early_rows(goals: Goals) -> dict[str, dict[str, GoalRow]]:
    """By noise: seconds before abeam by obstacle, for each criterion ("filter, own 2 sigma", ...)."""
    found: dict[str, dict[str, GoalRow]] = {}
    for row in goals.rows:
        if row.group.startswith("early"):
            noise, _, way = row.name.partition(", ")
            found.setdefault(noise, {})[way] = row
    return found


def bound_rows(goals: Goals) -> dict[str, tuple[GoalRow, GoalRow]]:
    """By group: RMSE over the bound, median and 90th percentile of the cases."""
    found = {}
    for group in goals.groups:
        rows = (goals.find(group, "RMSE / bound, median"), goals.find(group, "RMSE / bound, 90th"))
        if rows[0] is not None and rows[1] is not None:
            found[group] = (rows[0], rows[1])
    return found


def coverage_rows(goals: Goals) -> dict[str, dict[tuple[str, str], GoalRow]]:
    """By group: how often the truth lies within two sigma, by kind of obstacle and moment."""
    found: dict[str, dict[tuple[str, str], GoalRow]] = {}
    for row in goals.rows:
        parts = row.name.split(", ")
        if parts[0] == "within 2 sigma" and len(parts) == 3:
            found.setdefault(row.group, {})[(parts[1], parts[2])] = row
    return found


def nees_rows(goals: Goals) -> list[GoalRow]:
    return [row for row in goals.rows if row.name.startswith("NEES")]


@dataclass(frozen=True)
class Flags:
    """Detection of moving cars: percent detected at each percent of false flags; the library's own flag."""

    false: tuple[float, ...]
    caught: tuple[float, ...]
    area: float
    default: tuple[float, float] | None  # false, caught
    goal: GoalRow


def flags(goals: Goals) -> Flags | None:
    curve = next((row for row in goals.rows if "caught, at a share of false flags" in row.name), None)
    if curve is None:
        return None
    points = sorted((float(name.rstrip("% ")), value) for name, value in curve.values.items())
    area = goals.find(curve.group, "NIS ratio as a flag")
    default = goals.find(curve.group, "flagged as suspect with the default threshold")
    return Flags(
        tuple(x for x, _ in points), tuple(y for _, y in points),
        next(iter(area.values.values())) if area else math.nan,
        (default.values["parked"], default.values["moving"]) if default else None, curve,
    )  # fmt: skip


@dataclass(frozen=True)
class Rival:
    """Median errors at the end of the flights with an estimate, and the percentage of those flights, by quantity."""

    name: str
    errors: dict[str, float]
    answers: dict[str, float]
    flights: int


def rivals(goals: Goals) -> dict[str, list[Rival]]:
    """By noise, filter and window first."""
    found: dict[str, list[Rival]] = {}
    for row in goals.rows:
        noise, _, rest = row.name.partition(", median error, ")
        if row.group != "rivals" or not rest:
            continue
        flights, _, name = rest.partition(" flights: ")
        answers = goals.find("rivals", f"{noise}, answers: {name}")
        errors = {quantity: row.values.get(quantity, math.nan) for quantity in QUANTITIES}
        found.setdefault(noise, []).append(Rival(name, errors, answers.values if answers else {}, int(flights)))
    return found
