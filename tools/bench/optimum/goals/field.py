"""The errors of real sensors: comparison with the window method, the offline fit and the reported sigmas."""

from __future__ import annotations

from goe_tools.models import offline
from goe_tools.models.judge import LENGTH, ORIENTATION, WIDTH, Z0

from .goal import Goal
from .measures import consistency_goals, coverage_goals, offline_goals, suspect_goals, window_goals
from .work import Amount, drawn, perform_all, simulated_tasks


def field_group(group: str, amount: Amount) -> list[Goal]:
    """All errors of a small aircraft's usual sensors, and outliers."""
    tasks = simulated_tasks("field", amount.field_seeds, amount)
    for task in drawn(tasks[: len(tasks) // amount.field_seeds], amount.offline):
        task.offline = offline.available()
    outcomes = perform_all(tasks, amount, group)
    result = window_goals(group, outcomes, 0.4, (Z0, ORIENTATION, WIDTH, LENGTH))
    result += offline_goals(group, outcomes) + coverage_goals(group, outcomes)
    return result + consistency_goals(group, outcomes, False) + suspect_goals(group, outcomes)
