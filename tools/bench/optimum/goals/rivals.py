"""Other published methods on the same flights."""

from __future__ import annotations

import numpy as np

from .goal import UNITS, Goal, named
from .measures import ends, nan_quantile
from .work import Amount, drawn, perform_all, simulated_tasks


def rivals_group(group: str, amount: Amount) -> list[Goal]:
    """Other published methods on the same flights."""
    result = []
    for noise in ("gauss1", "field"):
        tasks = drawn(simulated_tasks(noise, 1, amount, rivals=True), amount.rivals)
        outcomes = perform_all(tasks, amount, f"{group} {noise}")
        names = list(dict.fromkeys(name for o in outcomes for name in o.rivals))
        errors = {name: np.array([o.rivals[name] for o in outcomes]) for name in names}
        errors = {"filter": ends(outcomes), "window": ends(outcomes, "window"), **errors} if names else {}
        for name, error in errors.items():
            median = nan_quantile(np.abs(error), 0.5) * UNITS
            result.append(Goal(group, f"{noise}, median error, {len(error)} flights: {name}", "m, deg", named(median)))
            there = 100.0 * np.isfinite(error).mean(0)
            result.append(Goal(group, f"{noise}, answers: {name}", "%", named(there)))
    return result
