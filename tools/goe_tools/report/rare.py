"""The record of rare events on the page: number of flights, events, intervals of their probabilities."""

from __future__ import annotations

from .avoid import KIND_NAMES
from .avoid_file import COLLISION
from .rare_record import EVENTS, WARNED_S, Record, flights, interval, out_of

HEADS = ("flights", "events", "95 % interval")
COURSE_NAMES = {"collision": "collision course", "pass": "pass at twice the margin"}
EVENT_NAMES = {
    "unwarned": f"no order until {WARNED_S:g} s before a collision",
    "collided": "collision with obstacle or ground, orders followed",
    "false_order": "unnecessary order",
    "confident": "error above 5σ five times in a row, not suspect",
}


def share(value: float) -> str:
    """A small share as 1 in N."""
    if value >= 0.01:
        return f"{100.0 * value:.2g}\u00a0%"
    return f"1 in {1.0 / value:,.0f}" if value > 0.0 else "0"


def table(record: Record) -> list[dict[str, object]]:
    """A line for each event of each course and kind."""
    rows: list[dict[str, object]] = []
    for course, names in EVENTS.items():
        for name in names:
            for kind, of in record.counts[course].items():
                low, high = interval(of[name], out_of(of, name))
                rows.append({
                    "title": f"{KIND_NAMES[kind]}, {COURSE_NAMES[course]}", "event": EVENT_NAMES[name],
                    "cells": [f"{out_of(of, name):,}", f"{of[name]:,}", f"{share(low)} to {share(high)}"],
                    "css": "miss" if of[name] else "",
                })  # fmt: skip
    return rows


def sentence(record: Record) -> str:
    """One bound for each kind of obstacle: the same seeds draw the same wind and sensor errors for all kinds."""
    courses = record.counts[COLLISION]
    collided, unwarned = (sum(of[name] for of in courses.values()) for name in ("collided", "unwarned"))
    confident = sum(of["confident"] for kinds in record.counts.values() for of in kinds.values())
    most = max(interval(of["collided"], of["runs"])[1] for of in courses.values())
    return (
        f"In {flights(record.counts):,} simulated flights ({record.date}, version {record.version}) "
        f"{sum(of['doomed'] for of in courses.values()):,} collision courses would have ended in a collision without "
        f"goe. With goe's orders followed, {collided:,} did: the probability is below {share(most)} for each kind of "
        f"obstacle (97.5\u00a0% confidence). {unwarned:,} had no order until {WARNED_S:g}\u00a0s before the "
        f"collision. In {confident:,} flights an estimate was wrong by more than 5σ, five times in a row, "
        "without being marked suspect."
    )
