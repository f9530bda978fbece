"""Compares the limits that the public headers state for each function with the proved figures."""

from __future__ import annotations

import re

from . import book
from .book import Figures, key, number
from .instructions import PUBLIC, UPDATES, WITH_LENS

TARGET = "m4f-gcc-o2"  # the target that goe.h names
COST = re.compile(
    r"Cost: at most (?P<instructions>\d+) instructions, (?P<stack>\d+) bytes of stack"
    r"(?:; (?P<lens>\d+) with lens distortion)?(?:; window: (?P<window>\d+))?\."
    r".*?\*/.*?\b(?P<name>goe_\w+)\(",
    re.DOTALL,
)


def stated(headers: str) -> dict[str, int]:
    """The stated figures, by the ledger's names."""
    found: dict[str, int] = {}
    for cost in COST.finditer(headers):
        name = cost["name"]
        places = {
            "instructions": key(book.PROVED, name),
            "stack": key(book.STACK, name),
            "lens": key(book.PROVED, f"{name} {WITH_LENS}"),
            "window": key(book.PROVED, UPDATES["window"]),
        }
        found |= {places[group]: int(cost[group]) for group in places if cost[group]}
    missing = [name for name in PUBLIC if key(book.STACK, name) not in found]
    if missing:
        raise ValueError(f"the public headers state no cost of {', '.join(missing)}")
    return found


def understated(headers: str, figures: Figures) -> list[str]:
    """Costs above the stated limits."""
    return [
        f"public headers: {name}: at most {limit}, but {TARGET} has {number(figures, name):g}"
        for name, limit in stated(headers).items()
        if number(figures, name) > limit
    ]
