"""Time at which the range is known."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from goe_tools.flights.noise import NOISES
from goe_tools.flights.simulated import paper_scenes
from goe_tools.models.judge import Z0

from .goal import Goal
from .measures import by_obstacle
from .outcome import Outcome, Task
from .work import Amount, perform_all

KNOWN_SHARE = 0.1  # the range is known if two sigma are less than this share of it


def _known_since(outcome: Outcome, good: np.ndarray) -> float:
    """Seconds before the obstacle is reached from which ``good`` (K,) is true until the end; 0: never."""
    bad = np.flatnonzero(~good)
    start = bad[-1] + 1 if len(bad) else 0
    return outcome.reach_s - float(outcome.time_s[start]) if start < len(good) else 0.0


def early_group(group: str, amount: Amount) -> list[Goal]:
    """Time at which the range is known, that is, the time left to fly around."""
    result = []
    for noise in ("rounding", "field"):
        tasks = [Task(scene, NOISES[noise], (1, number)) for number, scene in enumerate(paper_scenes())]
        outcomes = perform_all(tasks, amount, f"{group} {noise}")
        criteria: dict[str, Callable[[Outcome], np.ndarray]] = {
            "filter, own 2 sigma": lambda o: 2 * o.filter.sigma[:, Z0] < KNOWN_SHARE * o.truth.z0_m,
            "filter, true error": lambda o: np.abs(o.filter.error[:, Z0]) < KNOWN_SHARE * o.truth.z0_m,
            "window, true error": lambda o: np.abs(o.window.error[:, Z0]) < KNOWN_SHARE * o.truth.z0_m,
        }
        for label, criterion in criteria.items():
            with np.errstate(invalid="ignore"):
                values = {
                    obstacle: float(np.median([_known_since(o, criterion(o)) for o in chosen]))
                    for obstacle, chosen in by_obstacle(outcomes).items()
                }
            result.append(
                Goal(f"{group}: Z0 known to {KNOWN_SHARE:.0%}", f"{noise}, {label}", "s before abeam", values)
            )
    return result
