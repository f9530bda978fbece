"""Fuzzing done so far: counts added up over slices, and the file that keeps them between runs."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

NOT_SUMMED = {"edges"}  # the largest counts


@dataclass(frozen=True)
class Build:
    preset: str  # of CMake
    folder: str  # where it builds


@dataclass
class State:
    """``counts``: by "preset/target[/how]", the target's counts. For one library, identified by its golden hash."""

    golden_hash: str
    seed: int = 0
    counts: dict[str, dict[str, float]] = field(default_factory=dict)
    broken: list[str] = field(default_factory=list)

    def next_seed(self) -> int:
        """Never the same twice, so no slice repeats the inputs of another."""
        self.seed += 1
        return self.seed

    def add(self, name: str, counted: dict[str, float]) -> None:
        sums = self.counts.setdefault(name, {})
        for what, count in counted.items():
            before = sums.get(what, 0.0)
            sums[what] = max(before, count) if what in NOT_SUMMED else before + count

    def count(self, name: str, what: str) -> float:
        return self.counts.get(name, {}).get(what, 0.0)

    def sum_over(self, prefix: str, what: str) -> float:
        """Sum over all runs of a build's target."""
        return sum(counts.get(what, 0.0) for name, counts in self.counts.items() if f"{name}/".startswith(f"{prefix}/"))

    def all_of(self, target: str) -> dict[str, float]:
        """A target's counts over all builds."""
        sums: dict[str, float] = {}
        for name, counts in self.counts.items():
            if name.split("/")[1] == target:
                for what, count in counts.items():
                    sums[what] = sums.get(what, 0.0) + count
        return sums


def read_state(place: Path, golden_hash: str) -> State:
    """The state for the same library; empty for another one, or if the file is unreadable."""
    try:
        state = State(**json.loads(place.read_text(encoding="utf-8")))
    except (OSError, TypeError, ValueError):
        return State(golden_hash)
    return state if state.golden_hash == golden_hash else State(golden_hash)


def write_state(place: Path, state: State) -> None:
    place.parent.mkdir(parents=True, exist_ok=True)
    part = place.with_name(place.name + ".part")
    part.write_text(json.dumps(asdict(state), indent=1) + "\n", encoding="utf-8")
    part.replace(place)
