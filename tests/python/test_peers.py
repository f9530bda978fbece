"""The comparison with other solvers: it runs, and every solver solves the problem."""

from __future__ import annotations

import shutil
import subprocess
import sys

import pytest

# Of W, relative: single precision over a window whose normal equations are conditioned like 1e4.
WINDOW_ERROR_MOST = 1.0e-3

emulated = pytest.mark.skipif(
    shutil.which("arm-none-eabi-g++") is None or shutil.which("qemu-system-arm") is None,
    reason="emulated part: no arm-none-eabi-g++ or no qemu-system-arm",
)


def tables(text: str) -> list[list[dict[str, str]]]:
    """The Markdown tables of a text; each a list of rows by column."""
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
            found[-1].append(dict(zip(head, cells)))
    return found


@pytest.fixture(scope="module")
def printed() -> str:
    done = subprocess.run([sys.executable, "-m", "goe_tools", "peers", "--quick"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_each_solver_finds_the_width(printed: str) -> None:
    solvers = tables(printed)[0]
    assert solvers[0]["solver"] == "goe, closed form"
    for row in solvers:
        assert float(row["host, ns"]) > 0.0, row
        assert 0.0 <= float(row["root mean square"]) <= float(row["error of W: worst"]) < WINDOW_ERROR_MOST, row


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
    assert [row["obstacles"] for row in rows] == ["1"]
    assert all(float(row["updates per second, one core"]) > 0.0 for row in rows)
