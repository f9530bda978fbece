"""Counts over many flights: judged answers, finds, and their circumstances."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from . import finds
from .answers import Answers
from .finds import CAUSES, COLUMNS, JUDGED, KINDS, PROMISED, Finds
from .genes import MIXES
from .judge import FILTER, MODELS, POSITION, Judged
from .world import World

COVER_SIGMA = 2.0
Key = tuple[str, ...]


@dataclass
class Example:
    """A flight of a class, and the place of the find. The one with the fewest circumstances is kept."""

    flags: int
    batch: int
    row: int


@dataclass
class Tally:
    counts: Counter[Key] = field(default_factory=Counter)
    examples: dict[Key, Example] = field(default_factory=dict)  # by class

    def add(self, other: Tally) -> None:
        self.counts.update(other.counts)
        for key, example in other.examples.items():
            self._keep(key, example)

    def _keep(self, key: Key, example: Example) -> None:
        known = self.examples.get(key)
        if known is None or example.flags < known.flags:
            self.examples[key] = example


def per_flight(world: World, images: np.ndarray) -> np.ndarray:
    """(F,): number of images of each flight."""
    return np.bincount(world.flight, images, len(world.start) - 1)


def _basics(tally: Tally, world: World, found: Answers, found_lies: Finds, judged: Judged, mix: int) -> None:
    name, here = MIXES[mix], world.p["mix"] == mix
    of_mix = here[world.flight]
    e, count = found.estimates, tally.counts
    count["flights", name] += int(here.sum())
    count["images", name] += int(of_mix.sum())
    answered = ((e["valid"] & POSITION) != 0) & (e["method"] == FILTER)
    count["answered", name] += int((per_flight(world, answered)[here] > 0).sum())
    count["suspect", name] += int((per_flight(world, e["suspect"])[here] > 0).sum())
    for column, title in enumerate(COLUMNS):
        ratio = found_lies.ratio[of_mix, column]
        ratio = ratio[np.isfinite(ratio)]
        count["judged", name, title] += len(ratio)
        count["within", name, title] += int((ratio <= COVER_SIGMA).sum())
        count["confident", name, title] += int((per_flight(world, found_lies.confident[:, column])[here] > 0).sum())
    any_confident = found_lies.confident[:, : len(JUDGED)].any(1)
    count["confident", name, "any"] += int((per_flight(world, any_confident)[here] > 0).sum())
    trusted = ~e["suspect"] & (e["age_s"] <= finds.FRESH_MOST_S)
    low = of_mix[:, None] & trusted[:, None] & (judged.violation < finds.SAFE_MOST)
    count["safety allowed", name] += int(np.round(1e6 * judged.violation[low].sum()))  # millionths
    count["safety found", name] += int(1e6 * (low & judged.violated).sum())
    for title, images in (("false safety", found_lies.false_safety), ("doubted", found_lies.doubted)):
        count[title, name] += int((per_flight(world, images.any(1))[here] > 0).sum())
    gone, cause = found_lies.vanished, found_lies.cause
    counted = (gone & (cause >= PROMISED)).any(1)
    count["vanished", name, "any"] += int((per_flight(world, counted)[here] > 0).sum())
    for number, title in enumerate(CAUSES):
        images = (gone & (cause == number)).any(1)
        count["vanished", name, title] += int((per_flight(world, images)[here] > 0).sum())


def worst_images(world: World, score: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Flights with a positive score, and the first image with the largest score of each."""
    best = np.zeros(len(world.start) - 1)
    np.maximum.at(best, world.flight, score)
    flights = np.flatnonzero(best > 0.0)
    top = (score == best[world.flight]) & (score > 0.0)
    images = np.flatnonzero(top)
    first = np.searchsorted(world.flight[images], flights)
    return flights, images[first]


def scores(found_lies: Finds) -> dict[str, np.ndarray]:
    """(N,) for each kind: 0 without a find."""
    judged = np.where(found_lies.confident, found_lies.ratio, 0.0)[:, : len(JUDGED)]
    return {
        KINDS[0]: judged.max(1), KINDS[1]: found_lies.false_safety.any(1) * 1.0,
        KINDS[2]: (found_lies.vanished & (found_lies.cause >= PROMISED)).any(1) * 1.0,
    }  # fmt: skip


def what(kind: str, found_lies: Finds, image: int) -> str:
    if kind == KINDS[0]:
        return COLUMNS[int(np.argmax(np.where(found_lies.confident, found_lies.ratio, 0.0)[image, : len(JUDGED)]))]
    causes = np.where(found_lies.vanished[image], found_lies.cause[image], -1)
    return CAUSES[causes.max()] if kind == KINDS[2] else "violation"


def _classes(tally: Tally, world: World, found: Answers, found_lies: Finds, batch: int) -> None:
    flags = finds.flags(world)
    names, table = list(flags), np.stack(list(flags.values()), 1)
    for mix in np.unique(world.p["mix"]):
        here = world.p["mix"] == mix
        for flag, share in zip(names, table[here].sum(0)):
            tally.counts["flag", MIXES[mix], flag] += int(share)
    for kind, score in scores(found_lies).items():
        for flight, image in zip(*worst_images(world, score)):
            mix = MIXES[world.p["mix"][flight]]
            solid = "cylinder" if world.solid.round[flight] else "cuboid"
            model = MODELS[int(found.estimates["model"][image])]
            key = (kind, mix, what(kind, found_lies, image), model, solid, str(int(found.status[image])))
            tally.counts[("class", *key)] += 1
            present = table[flight]
            for flag in np.flatnonzero(present):
                tally.counts[("with", *key, names[flag])] += 1
            tally._keep(key, Example(int(present.sum()), batch, int(flight)))


def tally_of(world: World, found: Answers, judged: Judged, found_lies: Finds, batch: int) -> Tally:
    result = Tally()
    for mix in np.unique(world.p["mix"]):
        _basics(result, world, found, found_lies, judged, int(mix))
    _classes(result, world, found, found_lies, batch)
    return result
