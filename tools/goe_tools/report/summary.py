"""What a campaign and the files with it show, in a few lines of plain text."""

from __future__ import annotations

from . import avoid as av
from . import refined as rf
from .data import Campaign


def _paper(campaign: Campaign) -> list[str]:
    if campaign.refined is None:
        return []
    cells = rf.papers(campaign)
    better = sum(cell.factor >= 1.0 for cell in cells)
    return [f"The paper's Table 3: the default method is better in {better} of {len(cells)} numbers (simulation)."]


def _orders(campaign: Campaign) -> list[str]:
    if campaign.avoid is None:
        return []
    courses, passes = av.courses(campaign.avoid), av.passes(campaign.avoid)
    runs, without = sum(row.runs for row in courses), sum(row.collided_without for row in courses)
    said = [
        f"Orders: of {runs} collision courses {without} ended in a collision without them "
        f"and {sum(row.collided_with for row in courses)} with them (simulation)."
    ]
    if passes:
        false, passed = sum(row.false for row in passes), sum(row.runs for row in passes)
        said.append(f"False orders: {false} of {passed} passes at twice the margin (simulation).")
    return said


def _goals(campaign: Campaign) -> list[str]:
    goals = campaign.goals
    if goals is None or not goals.asked:
        return []
    met = sum(bool(row.met) for row in goals.asked)
    return [f"Goals, recorded on {goals.date}: {met} of {len(goals.asked)} met; the report lists the others."]


def summary(campaign: Campaign) -> list[str]:
    return [*_paper(campaign), *_orders(campaign), *_goals(campaign)]
