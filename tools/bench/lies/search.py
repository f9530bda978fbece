"""Random flights in batches, spread over processes, and their tally."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from goe_tools.spread import Workers, spread
from tqdm import tqdm

from . import answers, finds, genes, judge, world
from .answers import Answers
from .decode import decode
from .finds import Finds
from .genes import Flights, Params
from .judge import Judged
from .tally import Tally, tally_of
from .world import World

BATCH = 500


@dataclass(frozen=True)
class Task:
    seed: int
    batch: int
    count: int
    mixes: tuple[int, ...]


@dataclass
class Flown:
    world: World
    found: Answers
    judged: Judged
    lies: Finds


def fly(p: Params) -> Flown:
    flown = world.fly(p)
    return look_at(flown)


def look_at(flown: World, found: Answers | None = None) -> Flown:
    """``found``: answers to use in place of the library's."""
    found = answers.fly(flown) if found is None else found
    with np.errstate(invalid="ignore", divide="ignore"):
        judged = judge.judge(flown, found)
        return Flown(flown, found, judged, finds.find(flown, found, judged))


def flights_of(task: Task) -> Flights:
    """The flights of a task, independent of the total number."""
    rng = np.random.default_rng([task.seed, task.batch])
    return genes.draw(BATCH, task.mixes, rng).take(np.arange(task.count))


def perform(task: Task) -> Tally:
    flown = fly(decode(flights_of(task)))
    return tally_of(flown.world, flown.found, flown.judged, flown.lies, task.batch)


def tasks_for(seed: int, flights: int, mixes: Sequence[int], first: int = 0) -> list[Task]:
    batches = -(-flights // BATCH)
    return [Task(seed, first + i, min(BATCH, flights - BATCH * i), tuple(mixes)) for i in range(batches)]


def _rounds(seed: int, mixes: Sequence[int], most: int, until: float, jobs: int) -> Iterator[list[Task]]:
    """The requested number of flights, or as many as the time allows."""
    if until == np.inf:
        yield tasks_for(seed, most, mixes)
        return
    done, at_once = 0, 4 * jobs
    while time.monotonic() < until and done * BATCH < most:
        yield tasks_for(seed, min(at_once * BATCH, most - done * BATCH), mixes, done)
        done += at_once


def search(seed: int, mixes: Sequence[int], most: int, seconds: float | None, workers: Workers) -> Tally:
    until = np.inf if seconds is None else time.monotonic() + seconds
    result = Tally()
    total = most if seconds is None else None
    with tqdm(total=total, desc="flights", unit="flight", disable=None, leave=False) as bar:
        for tasks in _rounds(seed, mixes, most, until, workers.jobs):
            for task, tally in zip(tasks, spread(perform, tasks, workers)):
                result.add(tally)
                bar.update(task.count)
    return result
