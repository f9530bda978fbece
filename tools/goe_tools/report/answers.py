"""The first page: how early, how certain, how many collisions; each answer from the recorded goals if there are any,
otherwise from the campaign's flights and those of goe_avoid."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..logs.obslog import read_log
from ..view import words
from ..view.answers import Options
from ..view.story import Story, Track, story_of
from . import attacks, avoid, boxes
from . import refined as rf
from .data import COVERED, Campaign
from .goals_file import Goals
from .prose import refined as rp
from .prose.words import listed
from .style import NAMES, SYMBOLS, number

COLLISION_COUNTS = ("runs", "collided_without", "collided_with")  # of avoid.Courses
REAL = "field"  # noise of the goals: errors of real sensors
KNOWN = 0.1  # of the distance: a range is called known if 2 sigma are below this share
OWN = "filter, own 2 sigma"  # line of the goals: seconds before abeam from which the range is known
GOALS_COMMAND = "python -m bench goals --json FILE"


@dataclass(frozen=True)
class Card:
    """One question and its short answer; ``section`` has the long one."""

    question: str
    value: str
    text: str
    section: str


# ------------------------------------------------------------------------------------------------------------ how early


def known_row(track: Track) -> int | None:
    """The row from which on 2 sigma of Z0 stay below ``KNOWN`` of it; None: never."""
    column = track.answers.column
    with np.errstate(invalid="ignore", divide="ignore"):
        known = 2.0 * column["z0_sd_m"] / np.abs(column["z0_m"]) < KNOWN
    answered = np.flatnonzero(track.answers.answered)
    late = [k for k in answered if not known[k]]
    after = answered if not late else answered[answered > late[-1]]
    return int(after[0]) if len(after) else None


def story(campaign: Campaign) -> Story | None:
    """The approach that the first page shows, replayed."""
    if campaign.approach is None:
        return None
    return story_of(campaign.approach.resolve().name, read_log(campaign.approach), Options())


def of_approach(shown: Story | None) -> list[str]:
    """When the range of the shown approach is known."""
    if shown is None:
        return []
    track = shown.chosen(None)
    row = known_row(track)
    if row is None:
        return []
    column = track.answers.column
    distance = words.measured(float(column["z_m"][row]), float(column["z_sd_m"][row]), figures=1)
    to_go_s = float(column["tcpa_s"][row])
    when = f", {to_go_s:.0f}\u00a0s before the closest approach" if math.isfinite(to_go_s) and to_go_s > 0.0 else ""
    return [
        f"In the replayed approach, 2σ fall below {100.0 * KNOWN:.0f}\u00a0% of the initial distance at "
        f"{track.time_s[row]:.1f}\u00a0s{when}; the obstacle is {distance} ahead."
    ]


def _orders(campaign: Campaign) -> list[str]:
    if campaign.avoid is None:
        return []
    parts = [
        f"{avoid.KIND_NAMES[row.kind].lower()} {avoid.one_decimal(avoid.quantile(row.ahead_s, 0.5))}\u00a0s (least "
        f"{avoid.one_decimal(float(row.ahead_s[0]))}\u00a0s)"
        for row in avoid.courses(campaign.avoid)
        if len(row.ahead_s)
    ]
    if not parts:
        return []
    return [
        "On collision courses, time from the flight layer's first order until the obstacle would be reached, median: "
        f"{listed(parts)}. The flight layer waits until an order is necessary; the range is known earlier."
    ]


def early(campaign: Campaign, shown: Story | None) -> list[str]:
    said = of_approach(shown)
    if campaign.goals is not None:
        said += rp.early(campaign.goals, REAL)  # the figure has the others
    return said + _orders(campaign)


def _early_card(campaign: Campaign, shown: Story | None) -> Card | None:
    rows = rf.early_rows(campaign.goals) if campaign.goals else {}
    for ways in [rows[REAL]] if REAL in rows else []:
        values = [v for v in ways[OWN].values.values() if math.isfinite(v)] if OWN in ways else []
        if values:
            named = [f"{NAMES.get(o, o).lower()} {number(v, 2)}\u00a0s" for o, v in ways[OWN].values.items()]
            text = f"before it is abeam, the range of an obstacle is known to 10 % by goe's own 2σ: {listed(named)}"
            return Card("How early?", f"{number(min(values))} to {number(max(values))}\u00a0s", text, "early-answer")
    if shown is not None and (row := known_row(track := shown.chosen(None))) is not None:
        left_s = float(track.answers.column["tcpa_s"][row])
        if math.isfinite(left_s):
            text = (
                "before the closest approach of the flight below, goe's own 2σ fall below 10 % of the initial distance"
            )
            return Card("How early?", f"{left_s:.0f}\u00a0s", text, "early-answer")
    runs = avoid.courses(campaign.avoid) if campaign.avoid else []
    ahead = np.sort(np.concatenate([row.ahead_s for row in runs])) if runs else np.empty(0)
    if not len(ahead):
        return None
    text = f"from the first order until the obstacle would be reached; median of {len(ahead):,} collision courses"
    return Card("How early?", f"{avoid.one_decimal(avoid.quantile(ahead, 0.5))}\u00a0s", text, "early-answer")


# ---------------------------------------------------------------------------------------------------------- how certain


def certain(campaign: Campaign) -> list[str]:
    return rp.coverage(campaign.goals) if campaign.goals else []


def _certain_card(campaign: Campaign) -> Card | None:
    rows = boxes.by_roll(campaign)
    if rows:
        shares = [row.refined.covered[q] for row in rows for q in COVERED]
        value, flown = (
            f"{boxes.span(shares)}\u00a0%",
            f"{sum(row.flights for row in rows):,} flights with upright boxes",
        )
        text = f"of the estimates lie within 2 of their own σ of the truth (ideal: 95 %); {flown}"
        return Card("How certain?", value, text, "certain")
    shares = rp.covered_shares(campaign.goals) if campaign.goals else []
    if not shares:
        return None
    text = "of the estimates lie within 2 of their own σ of the truth (ideal: 95 %), median over quantities and flights"
    return Card("How certain?", f"{number(float(np.median(shares)), 3)}\u00a0%", text, "certain")


def upright_boxes(campaign: Campaign) -> dict[str, object] | None:
    """The part on upright boxes; None if they were not flown."""
    rows = boxes.by_roll(campaign)
    if not rows:
        return None
    lines = []
    for row in rows:
        cells = [
            {"ours": number(of[0][q]), "window": number(of[1][q]), "head": f"{SYMBOLS[q]} {head}"}
            for head, of in (
                ("[m]", (row.refined.error_m, row.window.error_m)),
                ("in 2σ [%]", (row.refined.covered, row.window.covered)),
            )
            for q in COVERED
        ]  # fmt: skip
        lines.append({"roll": f"{row.roll_deg:g}°", "flights": row.flights, "cells": cells})
    heads = [f"{SYMBOLS[q]} {unit}" for unit in ("[m]", "in 2σ [%]") for q in COVERED]
    return {"rows": lines, "heads": heads, "sentences": boxes.sentences(rows)}


# ----------------------------------------------------------------------------------------------------------- collisions


def orders(campaign: Campaign) -> dict[str, object] | None:
    """The section on the flight layer's orders; None without goe_avoid's runs."""
    if campaign.avoid is None:
        return None
    return {
        "sentence": avoid.sentence(campaign.avoid), "heads": avoid.heads(campaign.avoid),
        "rows": avoid.table(campaign.avoid), **avoid.setup(campaign.avoid),
    }  # fmt: skip


def _collisions_card(campaign: Campaign) -> Card | None:
    found = avoid.courses(campaign.avoid) if campaign.avoid else []
    if not found:
        return None
    runs, without, collided = (sum(getattr(row, name) for row in found) for name in COLLISION_COUNTS)
    text = f"collisions on {runs:,} collision courses: without goe, and with its orders followed"
    return Card("How many collisions?", f"{without:,} → {collided:,}", text, "avoid")


def cards(campaign: Campaign, shown: Story | None) -> list[Card]:
    found = (_early_card(campaign, shown), _certain_card(campaign), _collisions_card(campaign))
    return [card for card in found if card is not None]


# ---------------------------------------------------------------------------------------------------------- the record


def record(goals: Goals | None) -> list[str]:
    """What the goals say, with their date; or how to measure them."""
    if goals is None:
        return [
            f"The goals of this version are not on this page: no record of them was given. {GOALS_COMMAND} measures "
            "them, which takes hours; report --goals FILE then adds a page with all of them."
        ]
    return rp.verdict(attacks.without(goals)) if attacks.without(goals).rows else []
