"""The comparison with other solvers: it runs, and every solver solves the problem."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from goe_tools.peers.build import Builder, build_plugin, missing_tool
from goe_tools.peers.job import Group
from goe_tools.peers.measure import Bench
from goe_tools.peers.others import Others
from goe_tools.peers.throughput import KINDS
from goe_tools.peers.window import QUICK_CASES, WindowJob, window_job, window_peers

# Of W, relative: single precision over a window whose normal equations are conditioned like 1e4.
WINDOW_ERROR_MOST = 1.0e-3
NOBODY = Others(eigen=None, lapack=False, cmsis_dsp=None, tinyekf=None)

emulated = pytest.mark.skipif(missing_tool() is not None, reason=f"emulated part: no {missing_tool()}")


def tables(text: str) -> list[list[dict[str, str]]]:
    """The Markdown tables of a text; each a list of rows by column. Of columns with one name the first counts."""
    found: list[list[dict[str, str]]] = []
    head: list[str] | None = None
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if not cells:
            head = None
        elif head is None:
            head = cells
            found.append([])
        elif not set("".join(cells)) <= {"-"}:
            assert len(cells) == len(head), line
            found[-1].append(dict(zip(reversed(head), reversed(cells))))
    return found


@pytest.fixture(scope="module")
def printed() -> str:
    done = subprocess.run([sys.executable, "-m", "goe_tools", "peers", "--quick"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_each_solver_finds_the_width(printed: str) -> None:
    solvers = tables(printed)[0]
    assert solvers[0]["solver"] == "goe, closed form"
    assert float(solvers[0]["over ours"]) == 1.0
    for row in solvers:
        assert float(row["host, ns"]) > 0.0 and float(row["over ours"]) > 0.0, row
        assert 0.0 <= float(row["root mean square"]) <= float(row["error of W, relative: worst"]), row
        assert float(row["error of W, relative: worst"]) < WINDOW_ERROR_MOST, row


def test_who_is_not_there_is_named(printed: str) -> None:
    solvers = " ".join(row["solver"] for row in tables(printed)[0])
    for name in ("Eigen", "LAPACK", "CMSIS-DSP", "TinyEKF"):
        assert name in solvers or f"skipped: {name}" in printed


@emulated
def test_each_solver_is_counted(printed: str) -> None:
    for row in tables(printed)[0]:
        if not row["solver"].startswith("LAPACK"):
            mean, most = (float(word.strip("()")) for word in row["M4F, instructions: mean (max)"].split())
            assert 0.0 < mean <= most, row
            assert int(row["M4F stack, bytes"]) > 0 and int(row["M4F code, bytes"]) > 0, row


def test_throughput_is_printed(printed: str) -> None:
    rows = tables(printed)[1]
    assert [row["obstacles"] for row in rows] == ["1", "10"]
    for row in rows:
        speeds = [float(row[f"{kind}: updates per second"]) for kind in KINDS]
        assert min(speeds) > 0.0
        assert float(row["time of refined over window"]) == pytest.approx(speeds[0] / speeds[1], abs=0.006)
        assert float(row["of refined and hazard over refined"]) == pytest.approx(speeds[1] / speeds[2], abs=0.006)


@emulated
def test_instructions_repeat_exactly(tmp_path: Path) -> None:
    builder = Builder(tmp_path)
    bench = Bench(builder, window_job(builder, NOBODY, quick=True), 1, build_plugin(tmp_path))
    image = bench.programs(bench.job.peers[0], "own").image
    assert image is not None
    builder.make()
    text, counts = bench.count(image)
    assert len(counts) == QUICK_CASES and min(counts) > 0
    assert bench.count(image) == (text, counts)


def test_a_wrong_answer_shows() -> None:
    # X0 = 10 m, Z0 = 100 m, W = 4 m, flown straight ahead: no number is rounded
    case = np.concatenate([np.zeros(8), np.arange(8.0), np.full(8, 2.5), (100.0 - np.arange(8.0)) / 4.0])
    group = Group("one", case[None].astype(np.float32))
    ours = window_peers(NOBODY)[0]
    right, wrong = (np.array([[width, 10.0, 100.0]], dtype=np.float32) for width in (4.0, 4.5))
    job = WindowJob([ours], [group])
    assert job.errors(ours, group, right) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert job.errors(ours, group, wrong) == pytest.approx((0.125, 0.125), abs=1e-12)
