"""Pixel noise and no other error: the filter method against the Cramer-Rao bound."""

from __future__ import annotations

from .goal import Goal
from .measures import consistency_goals, coverage_goals, efficiency_goals, suspect_goals
from .work import Amount, perform_all, simulated_tasks


def gauss_group(group: str, amount: Amount) -> list[Goal]:
    """Gaussian pixel noise, or rounding to whole pixels, and nothing else."""
    outcomes = perform_all(simulated_tasks(group, amount.seeds, amount, bound=True), amount, group)
    rounding = group == "rounding"
    result = efficiency_goals(group, outcomes, 2.0 if rounding else 1.25, None if rounding else 2.0)
    result += coverage_goals(group, outcomes)
    return result + consistency_goals(group, outcomes, not rounding) + suspect_goals(group, outcomes)
