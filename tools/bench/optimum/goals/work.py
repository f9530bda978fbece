"""Number of flights and processes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from goe_tools.flights.noise import NOISES
from goe_tools.flights.simulated import paper_scenes, random_scenes
from goe_tools.spread import ALONE, Workers, each

from ...attack.approach import RUNS
from ...attack.rows import TRACKS_EACH
from .outcome import Outcome, Task, perform
from .output import print_worst


@dataclass
class Amount:
    """Amount of computation."""

    seeds: int
    field_seeds: int
    random: int
    offline: int  # flights of the first seed with field noise, drawn at random
    rivals: int  # likewise
    recorded: int  # passes of each recorded flight and seed
    recorded_seeds: int
    precision_seeds: int
    boxes: int  # flights of each case of upright boxes
    attack: int  # tracks of each attack
    hazard: int  # runs of each row of warnings
    half: str = "judge"  # of the attacks' tracks: one half tunes thresholds, the other judges
    workers: Workers = ALONE
    worst: int = 0  # flights to print, those with the largest NEES


QUICK = Amount(
    seeds=6, field_seeds=4, random=100, offline=90, rivals=40, recorded=40, recorded_seeds=2,
    precision_seeds=1, boxes=8, attack=40, hazard=200,
)  # fmt: skip
FULL = Amount(
    seeds=24, field_seeds=16, random=400, offline=10**6, rivals=300, recorded=60, recorded_seeds=3,
    precision_seeds=3, boxes=40, attack=TRACKS_EACH, hazard=RUNS,
)  # fmt: skip


def perform_all(tasks: Sequence[Task], amount: Amount, title: str) -> list[Outcome]:
    outcomes = each(perform, tasks, amount.workers, title)
    print_worst(title, outcomes, amount.worst)
    return outcomes


def simulated_tasks(noise: str, seeds: int, amount: Amount, **options: object) -> list[Task]:
    scenes = paper_scenes() + random_scenes(amount.random)
    return [
        Task(scene, NOISES[noise], (seed, number), **options)  # type: ignore[arg-type]
        for seed in range(1, seeds + 1)
        for number, scene in enumerate(scenes)
    ]


def drawn(tasks: list[Task], count: int) -> list[Task]:
    """A random choice of the tasks, the same in every run."""
    order = np.random.default_rng(3).permutation(len(tasks))[:count]
    return [tasks[i] for i in sorted(order)]
