"""The paper's Table 3: the factor of improvement, and the lower bound of any estimator."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from goe_tools.flights.measured import measure
from goe_tools.flights.noise import NOISES
from goe_tools.flights.simulated import paper_scenes
from goe_tools.models.bound import bound
from goe_tools.models.judge import HEIGHT, LENGTH, ORIENTATION, WIDTH, X0, Z0
from goe_tools.report.paper_table3 import FRACTION, MOST, PAPER_TABLE3, TABLE3_QUANTITIES, holding_range
from goe_tools.spread import each

from .goal import NAMES, Goal, named
from .measures import by_obstacle
from .outcome import Outcome, Task
from .work import Amount, perform_all

TABLE3_NUMBERS = dict(zip(TABLE3_QUANTITIES, (Z0, X0, WIDTH, LENGTH, HEIGHT)))


def _extent(outcome: Outcome, quantity: int) -> float:
    """|mean| + 2 sigma of the last answers' errors in Table 3's unit: percent, or meters for the height."""
    errors = outcome.filter.error[:, quantity]
    known = errors[np.isfinite(errors)]
    if not len(known):
        return math.nan
    known = known[int((1 - FRACTION) * len(known)) :]
    size = outcome.truth.values
    if outcome.filter.renamed[-1]:
        size = size[[X0, Z0, ORIENTATION, LENGTH, WIDTH, HEIGHT]]
    scale = 1.0 if quantity == HEIGHT else 100.0 / abs(size[quantity]) if size[quantity] else math.nan
    return float((abs(known.mean()) + 2 * known.std()) * scale)


def _bound_when_judged(task: Task) -> np.ndarray:
    """(6,) two sigma of the Cramer-Rao bound at the start of Table 3's statistics, in its units."""
    flight = measure(task.scene, task.noise, task.seed)
    seen = flight.seen.copy()
    seen[int((1 - FRACTION) * len(seen)) :] = False
    sigma = bound(replace(flight, seen=seen)).sigma
    size = np.abs(flight.truth.values)
    with np.errstate(divide="ignore"):
        scale = np.where(size > 0, 100.0 / size, math.nan)
    scale[HEIGHT] = 1.0
    return 2.0 * sigma * scale


def table3_bounds(group: str, tasks: Sequence[Task], outcomes: Sequence[Outcome], amount: Amount) -> list[Goal]:
    """Lower bound of any unbiased estimator, from the images up to the first one in Table 3's statistics."""
    bounds = dict(zip([id(o) for o in outcomes], each(_bound_when_judged, tasks, amount.workers, f"{group} bounds")))
    result = []
    for obstacle, chosen in by_obstacle(outcomes).items():
        asked = (X0, Z0, WIDTH, LENGTH, HEIGHT) if chosen[0].box else (X0, Z0, WIDTH, HEIGHT)
        values = np.nanmedian(np.array([bounds[id(o)] for o in chosen])[:, asked], axis=0)
        label = f"{obstacle}: bound (2 sigma) at {1 - FRACTION:.0%} of the run"
        result.append(Goal(group, label, "%, m", named(values, asked)))
    return result


def table3_group(group: str, amount: Amount) -> list[Goal]:
    """Table 3 of the paper on its 156 cases: whole pixels, no other error."""
    tasks = [Task(scene, NOISES["rounding"], (1, number)) for number, scene in enumerate(paper_scenes())]
    outcomes = perform_all(tasks, amount, group)
    result = []
    for obstacle, chosen in by_obstacle(outcomes).items():
        paper = PAPER_TABLE3[(obstacle, "line" if chosen[0].box else "disc")]
        cells = [(name, TABLE3_NUMBERS[name], cell) for name, cell in paper.items() if cell is not None]
        extents = {NAMES[i]: np.array([_extent(o, i) for o in chosen]) for _, i, _ in cells}
        paper_range = {NAMES[i]: cell.value for _, i, cell in cells}
        for share, asked in ((MOST, True), (0.9, False)):
            ours = {name: holding_range(values, share) for name, values in extents.items()}
            label = f"{obstacle}, {share:.0%} of the runs"
            result.append(Goal(group, f"{label}: errors within", "%, m", ours))
            factors = {name: paper_range[name] / max(value, 1e-12) for name, value in ours.items()}
            wanted = tuple(factors) if asked else ()
            result.append(Goal(group, f"{label}: times better than the paper", "1", factors, (5.0, math.inf), wanted))
    return result + table3_bounds(group, tasks, outcomes, amount)
