"""Prints the processor time of goe_companion for each second of a simulated flight with 200 Hz of poses and eight
obstacles at 30 Hz. tools/bench.sh runs it."""

from __future__ import annotations

import contextlib
import io
import sys
import tempfile
from pathlib import Path
from types import ModuleType

from companion import PROGRAM, is_missing
from conftest import load_dialect
from flights import Fleet
from test_companion_load import LOAD_S, PLAN, WARM_S

RUNS = 3


def share_of_a_core(dialect: ModuleType, folder: Path) -> float:
    fleet = Fleet(dialect, folder, [PLAN])
    companion = fleet[PLAN.name].companion
    try:
        fleet.start()
        fleet.run(WARM_S)
        before_s = companion.processor_s()
        fleet.run(LOAD_S)
        return (companion.processor_s() - before_s) / LOAD_S
    finally:
        fleet.close()


def least_share() -> float:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with contextlib.redirect_stdout(io.StringIO()):  # generator's process
            dialect = load_dialect(folder)
        return min(share_of_a_core(dialect, folder / str(number)) for number in range(RUNS))


if __name__ == "__main__":
    if is_missing():
        sys.exit(f"{PROGRAM} is not built")
    print(f"{least_share():.4f}")
