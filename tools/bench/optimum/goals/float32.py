"""Effect of float32 rounding on the answers."""

from __future__ import annotations

import numpy as np
from goe_tools.flights.measured import measure
from goe_tools.library import ready
from goe_tools.spread import each

from ..precision import Rounding, rounding_of
from .goal import NAMES, Goal, named
from .measures import nan_quantile
from .outcome import Task
from .work import Amount, simulated_tasks

ROUNDING_MOST = 0.05  # of one sigma
ROUNDING_TITLE = "float32 against float64"


def _rounding(task: Task) -> Rounding:
    return rounding_of(measure(task.scene, task.noise, task.seed))


def float32_group(group: str, amount: Amount) -> list[Goal]:
    """The library in float32 against itself in float64: the largest difference over a flight's images, in sigmas."""
    result = []
    try:
        ready(double=True)
    except FileNotFoundError as reason:
        print(f"left out: {reason}")
        return []
    for noise in ("gauss0.3", "gauss1", "field"):
        tasks = simulated_tasks(noise, amount.precision_seeds, amount)
        flights = each(_rounding, tasks, amount.workers, f"{group} {noise}")
        largest = np.array([r.worst for r in flights])
        for label, share in (("99th percentile", 0.99), ("worst", 1.0)):
            values = named(nan_quantile(largest, share))
            name = f"{noise}, largest of a flight, {label} of {len(flights)}"
            result.append(Goal(ROUNDING_TITLE, name, "sigma", values, (0.0, ROUNDING_MOST), NAMES))
        images = {
            "compared": float(sum(r.answered - r.apart for r in flights)),
            "decided otherwise": float(sum(r.apart for r in flights)),
        }
        result.append(Goal(ROUNDING_TITLE, f"{noise}, images with an answer", "1", images))
    return result
