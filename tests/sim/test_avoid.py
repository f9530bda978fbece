"""The flight layer flown by goe_avoid: its orders avoid collisions, and a pass at twice the margin is left alone."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

RUNS = 60
FALSE_SHARE_MAX = 0.02


def avoid(goe_avoid: Path, *arguments: str) -> str:
    done = subprocess.run([str(goe_avoid), *arguments], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_orders_avoid_every_collision_and_passes_are_left_alone(goe_avoid: Path) -> None:
    text = avoid(goe_avoid, "--runs", str(RUNS))
    courses = re.findall(r"^\| (\w+) \| (\d+) \| (\d+) \| (\d+) \((\d+) late\)", text, re.MULTILINE)
    passes = re.findall(r"^\| (\w+) \| (\d+) \| (\d+) \([\d.]+ %\)", text, re.MULTILINE)
    assert [row[0] for row in courses] == [row[0] for row in passes] == ["mast", "building", "truck"]
    for _, runs, without, collisions, late in courses:
        assert int(runs) == RUNS
        assert int(without) >= 0.95 * RUNS  # otherwise there was nothing to avoid
        assert int(collisions) == int(late) == 0
    assert sum(int(row[2]) for row in passes) <= FALSE_SHARE_MAX * RUNS * len(passes)


def test_the_same_seed_flies_the_same_runs(goe_avoid: Path) -> None:
    assert avoid(goe_avoid, "-n", "3", "-s", "7") == avoid(goe_avoid, "-n", "3", "-s", "7")
    assert avoid(goe_avoid, "-n", "3", "-s", "7") != avoid(goe_avoid, "-n", "3", "-s", "70")


def test_bad_usage_is_told(goe_avoid: Path) -> None:
    for wrong in (["--runs", "0"], ["--delay", "-1"], ["--nonsense"], ["word"]):
        done = subprocess.run([str(goe_avoid), *wrong], capture_output=True, text=True)
        assert done.returncode == 2
        assert done.stderr.startswith("goe_avoid: ")
