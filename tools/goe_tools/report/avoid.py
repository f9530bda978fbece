"""The flight layer's orders: collisions and closest distances with and without them, false orders."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .avoid_file import COLLISION, KINDS, PASS, Avoid
from .prose.words import plural

KIND_NAMES = {"mast": "Mast", "building": "Building", "truck": "Truck, on approach"}


@dataclass(frozen=True)
class Courses:
    """The collision courses of one kind of obstacle. Closest distances, m, and orders' time ahead, s, ascending."""

    kind: str
    runs: int
    collided_without: int
    collided_with: int
    collided_late: int  # with the orders followed, and the order was late
    closest_without_m: np.ndarray
    closest_with_m: np.ndarray
    ahead_s: np.ndarray
    late: int
    no_order: int


@dataclass(frozen=True)
class Passes:
    kind: str
    runs: int
    false: int


def quantile(ascending: np.ndarray, share: float) -> float:
    """As in goe_avoid: the value of the run with that rank."""
    return float(ascending[int(share * (len(ascending) - 1) + 0.5)]) if len(ascending) else math.nan


def _courses(kind: str, runs: Avoid) -> Courses:
    collided = runs["collided_with"] == 1.0
    return Courses(
        kind, len(runs), int(np.sum(runs["collided_without"])), int(np.sum(collided)),
        int(np.sum(collided & (runs["late"] == 1.0))), np.sort(runs["closest_without_m"]),
        np.sort(runs["closest_with_m"]), np.sort(runs["ahead_s"][runs.ordered]), int(np.sum(runs["late"])),
        int(np.sum(~runs.ordered)),
    )  # fmt: skip


def courses(avoid: Avoid) -> list[Courses]:
    """For each kind that was flown."""
    found = [_courses(kind, avoid.flown(COLLISION, kind)) for kind in KINDS]
    return [row for row in found if row.runs]


def passes(avoid: Avoid) -> list[Passes]:
    flown = [(kind, avoid.flown(PASS, kind)) for kind in KINDS]
    return [Passes(kind, len(runs), int(np.sum(runs["false_order"]))) for kind, runs in flown if len(runs)]


def setup(avoid: Avoid) -> dict[str, str]:
    """The values that all runs share, as text; without passes ``pass_m`` is empty."""
    away = avoid.flown(PASS)["pass_m"]
    return {
        "delay_ms": f"{1e3 * avoid['delay_s'][0]:g}", "margin_m": f"{avoid['margin_m'][0]:g}",
        "collision_m": f"{avoid['collision_m'][0]:g}", "pass_m": f"{away[0]:g}" if len(away) else "",
    }  # fmt: skip


def one_decimal(value: float) -> str:
    return f"{value:.1f}" if math.isfinite(value) else "–"


def _text(ascending: np.ndarray, *shares: float) -> str:
    return " / ".join(one_decimal(quantile(ascending, share)) for share in shares)


def _percent(part: int, whole: int) -> str:
    return f"{100.0 * part / whole:.1f}\u00a0%"


COURSE_HEADS = (
    "runs", "collisions without", "collisions with", "closest [m]: least / 5 % / median",
    "order ahead [s]: least / median", "late orders", "no order",
)  # fmt: skip
PASS_HEADS = ("passes", "false orders")


def heads(avoid: Avoid) -> list[str]:
    return [*(COURSE_HEADS if courses(avoid) else ()), *(PASS_HEADS if passes(avoid) else ())]


def _cells(texts: tuple[str, ...], red: tuple[int, ...] = ()) -> list[dict[str, str]]:
    """red: the cells whose number should be 0, by index."""
    return [{"text": t, "css": "miss" if i in red and t not in ("", "0") else ""} for i, t in enumerate(texts)]


def _course_cells(row: Courses | None) -> list[dict[str, str]]:
    if row is None:
        return _cells(("",) * len(COURSE_HEADS))
    counts = [f"{n:,}" for n in (row.runs, row.collided_without, row.collided_with, row.late, row.no_order)]
    closest, ahead = _text(row.closest_with_m, 0.0, 0.05, 0.5), _text(row.ahead_s, 0.0, 0.5)
    return _cells((*counts[:3], closest, ahead, *counts[3:]), red=(2, 5, 6))


def _pass_cells(row: Passes | None) -> list[dict[str, str]]:
    if row is None:
        return _cells(("",) * len(PASS_HEADS))
    return _cells((f"{row.runs:,}", f"{row.false:,} ({_percent(row.false, row.runs)})"))


def table(avoid: Avoid) -> list[dict[str, object]]:
    """For the page: a line for each kind that was flown, cells by heads(); empty if there is no number."""
    of_kind, away = {row.kind: row for row in courses(avoid)}, {row.kind: row for row in passes(avoid)}
    lines: list[dict[str, object]] = []
    for kind in KINDS:
        if kind in of_kind or kind in away:
            cells = _course_cells(of_kind.get(kind)) if of_kind else []
            cells += _pass_cells(away.get(kind)) if away else []
            lines.append({"title": KIND_NAMES[kind], "cells": cells})
    return lines


def _collisions(found: list[Courses]) -> str:
    runs, without = sum(row.runs for row in found), sum(row.collided_without for row in found)
    collided, late = sum(row.collided_with for row in found), sum(row.collided_late for row in found)
    said = (
        f"without goe, {without:,} of {plural(runs, 'collision course')} {'ends' if without == 1 else 'end'} in a "
        "collision; with goe's orders followed, "
    )
    if collided == 0:
        least = min(float(row.closest_with_m[0]) for row in found)
        return said + f"none does, and the closest aircraft stays {one_decimal(least)}\u00a0m away"
    where = ", ".join(f"{row.kind} {row.collided_with:,}" for row in found if row.collided_with)
    after = f"; {late:,} after a late order" if late else ""
    return said + f"{collided:,} {'does' if collided == 1 else 'do'} ({where}{after})"


def _false_orders(found: list[Passes], pass_m: str) -> str:
    runs, false = sum(row.runs for row in found), sum(row.false for row in found)
    many = f"{plural(runs, 'pass', 'passes')} at {pass_m}\u00a0m"
    if false == 0:
        return f"none of {many} gets a false order"
    return f"{false:,} of {many} ({_percent(false, runs)}) {'gets' if false == 1 else 'get'} a false order"


def sentence(avoid: Avoid) -> str:
    """The result in words, from the numbers."""
    found, away = courses(avoid), passes(avoid)
    said = [_collisions(found)] if found else []
    said += [_false_orders(away, setup(avoid)["pass_m"])] if away else []
    text = "; ".join(said)
    return text[:1].upper() + text[1:] + "."
