"""The record of rare events on the page: how many flights, what happened, and how often it may."""

from __future__ import annotations

from .avoid import KIND_NAMES
from .avoid_file import COLLISION
from .rare_record import EVENTS, WARNED_S, Record, flights, interval

HEADS = ("runs", "times", "95 % interval")
COURSE_NAMES = {"collision": "collision course", "pass": "pass at twice the margin"}
EVENT_NAMES = {
    "unwarned": f"no order {WARNED_S:g} s ahead of a collision",
    "collided": "a collision, the orders carried out",
    "false_order": "an order that nothing asked for",
    "confident": "five sigmas off, five times on end, not suspect",
}


def share(value: float) -> str:
    """As one in so many where it is small."""
    if value >= 0.01:
        return f"{100.0 * value:.2g}\u00a0%"
    return f"1 in {1.0 / value:,.0f}" if value > 0.0 else "0"


def table(record: Record) -> list[dict[str, object]]:
    """A line for each event of each course and kind."""
    rows: list[dict[str, object]] = []
    for course, names in EVENTS.items():
        for name in names:
            for kind, of in record.counts[course].items():
                low, high = interval(of[name], of["runs"])
                rows.append({
                    "title": f"{KIND_NAMES[kind]}, {COURSE_NAMES[course]}", "event": EVENT_NAMES[name],
                    "cells": [f"{of['runs']:,}", f"{of[name]:,}", f"{share(low)} to {share(high)}"],
                    "css": "miss" if of[name] else "",
                })  # fmt: skip
    return rows


def sentence(record: Record) -> str:
    courses = record.counts[COLLISION].values()
    runs = sum(of["runs"] for of in courses)
    collided, unwarned = (sum(of[name] for of in courses) for name in ("collided", "unwarned"))
    confident = sum(of["confident"] for kinds in record.counts.values() for of in kinds.values())
    most = interval(collided, runs)[1]
    return (
        f"In {flights(record.counts):,} simulated flights ({record.date}, version {record.version}) the orders were "
        f"carried out on {runs:,} collision courses: {collided:,} ended in a collision all the same, which is less "
        f"than {share(most)} with 97.5\u00a0% confidence; {unwarned:,} had no order {WARNED_S:g}\u00a0s ahead. In "
        f"{confident:,} flights an estimate was confidently wrong."
    )
