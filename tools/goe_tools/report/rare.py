"""The record of rare events on the page: how many flights, what happened, and how often it may."""

from __future__ import annotations

from .avoid import KIND_NAMES
from .avoid_file import COLLISION
from .rare_record import EVENTS, WARNED_S, Record, flights, interval, out_of

HEADS = ("of", "times", "95 % interval")
COURSE_NAMES = {"collision": "collision course", "pass": "pass at twice the margin"}
EVENT_NAMES = {
    "unwarned": f"no order {WARNED_S:g} s ahead of a collision",
    "collided": "the obstacle or the ground met, the orders carried out",
    "false_order": "an order that nothing asked for",
    "confident": "five sigmas off, five times in a row, not suspect",
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
                low, high = interval(of[name], out_of(of, name))
                rows.append({
                    "title": f"{KIND_NAMES[kind]}, {COURSE_NAMES[course]}", "event": EVENT_NAMES[name],
                    "cells": [f"{out_of(of, name):,}", f"{of[name]:,}", f"{share(low)} to {share(high)}"],
                    "css": "miss" if of[name] else "",
                })  # fmt: skip
    return rows


def sentence(record: Record) -> str:
    """Bounds are given for each kind by itself: the same seeds draw the same air and sensors for all kinds."""
    courses = record.counts[COLLISION]
    collided, unwarned = (sum(of[name] for of in courses.values()) for name in ("collided", "unwarned"))
    confident = sum(of["confident"] for kinds in record.counts.values() for of in kinds.values())
    most = max(interval(of["collided"], of["runs"])[1] for of in courses.values())
    return (
        f"In {flights(record.counts):,} simulated flights ({record.date}, version {record.version}) "
        f"{sum(of['doomed'] for of in courses.values()):,} collision courses would have ended in a collision; with the "
        f"orders carried out {collided:,} did, which leaves each kind of obstacle less than {share(most)} (97.5\u00a0% "
        f"confidence); {unwarned:,} had no order {WARNED_S:g}\u00a0s ahead. In {confident:,} runs an estimate was "
        "confidently wrong."
    )
