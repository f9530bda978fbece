"""Recorded flights of autopilots, with the errors of their filters."""

from __future__ import annotations

from goe_tools.flights.recorded import recorded_scenes
from goe_tools.models.judge import HEIGHT, WIDTH, Z0

from .goal import Goal
from .measures import consistency_goals, coverage_goals, suspect_goals, window_goals
from .outcome import Task
from .work import Amount, perform_all


def recorded_group(group: str, amount: Amount) -> list[Goal]:
    """Recorded flights of real autopilots past added obstacles."""
    result: list[Goal] = []
    scenes = [s for seed in range(amount.recorded_seeds) for s in recorded_scenes(amount.recorded, seed=seed + 1)]
    for autopilot in sorted({scene.group for scene in scenes}):
        tasks = [
            Task(scene, scene.noise, (1, number), shape_known=False)
            for number, scene in enumerate(scenes)
            if scene.group == autopilot
        ]
        outcomes = perform_all(tasks, amount, autopilot)
        name = f"{group} {autopilot}"
        result += window_goals(name, outcomes, 0.5, (Z0, WIDTH, HEIGHT), worse_asked=False)
        result += [g for g in coverage_goals(name, outcomes, (88.0, 100.0)) if "first" not in g.name]
        result += consistency_goals(name, outcomes, False) + suspect_goals(name, outcomes)
    return result
