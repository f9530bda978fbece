"""The results of a campaign and of the files given with it, in a few sentences for the terminal."""

from __future__ import annotations

import textwrap

from . import answers, boxes
from . import avoid as av
from . import refined as rf
from .data import COVERED, Campaign

LETTERS = 100  # of a line


def _early(campaign: Campaign) -> list[str]:
    said = answers.of_approach(answers.story(campaign))
    if campaign.avoid is not None:
        found = av.courses(campaign.avoid)
        least = min((float(row.ahead_s[0]) for row in found if len(row.ahead_s)), default=None)
        if least is not None:
            said.append(f"Orders came at least {av.one_decimal(least)} s before the obstacle would have been reached.")
    text = " ".join(said)
    return [f"How early: {text[:1].lower()}{text[1:]}"] if said else []


def _certain(campaign: Campaign) -> list[str]:
    rows = boxes.by_roll(campaign)
    if not rows:
        return []
    shares = [row.refined.covered[q] for row in rows for q in COVERED]
    return [
        f"How certain: {boxes.span(shares)} % of the estimates from upright boxes lie within 2 of their own sigma of "
        "the truth (ideal: 95 %)."
    ]


def _collisions(campaign: Campaign) -> list[str]:
    if campaign.avoid is None:
        return []
    courses, passes = av.courses(campaign.avoid), av.passes(campaign.avoid)
    runs, without, collided = (sum(getattr(row, name) for row in courses) for name in answers.COLLISION_COUNTS)
    said = [f"of {runs} collision courses, {without} end in a collision without goe and {collided} with its orders."]
    if passes:
        false, passed = sum(row.false for row in passes), sum(row.runs for row in passes)
        said.append(f"Of {passed} passes at twice the margin, {false} get an unnecessary order.")
    return [f"Collisions: {' '.join(said)}"]


def _paper(campaign: Campaign) -> list[str]:
    if campaign.refined is None:
        return []
    cells = rf.papers(campaign)
    better = sum(cell.factor >= 1.0 for cell in cells)
    return [f"The paper: the default method is better than the paper in {better} of {len(cells)} numbers of Table 3."]


def _goals(campaign: Campaign) -> list[str]:
    goals = campaign.goals
    if goals is None or not goals.asked:
        return []
    return [f"Goals: measured on {goals.date}; the report lists those that are met and those that are missed."]


def summary(campaign: Campaign) -> list[str]:
    return [line for part in (_early, _certain, _collisions, _paper, _goals) for line in part(campaign)]


def print_summary(campaign: Campaign) -> None:
    lines = summary(campaign)
    print("\nWhat this showed, in simulation:" if lines else "\nThere is nothing to summarize.")
    for line in lines:
        print(textwrap.fill(line, LETTERS, initial_indent="* ", subsequent_indent="  "))
