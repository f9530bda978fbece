"""The comparison with other solvers: it runs, and every solver solves the problem."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from bench.peers import command, update, window
from bench.peers.build import Builder, build_plugin, missing_tool
from bench.peers.job import Group
from bench.peers.lower_bound import Operations, householder_update, triangle_inverse
from bench.peers.measure import Bench
from bench.peers.others import Others, find_others
from bench.peers.throughput import KINDS

# Relative error of W: single precision over a window whose normal equations have a condition number of 1e4.
WINDOW_ERROR_MOST = 1.0e-3
# Error of an update: rounding must be negligible compared with the noise. TinyEKF's covariance in single precision does
# not reach this accuracy; it is exempt.
CHANGE_SIGMAS_MOST = 1.0e-2
VARIANCE_ERROR_MOST = 1.0e-2  # relative: half of it in sigma
NIS_ERROR_MOST = 1.0e-2  # relative
pytestmark = pytest.mark.release  # Eigen's solvers take two minutes to compile

NOBODY = Others(eigen=None, lapack=False, cmsis_dsp=None, tinyekf=None)
COUNT, STACK, CODE = "M4F, instructions: mean (max)", "M4F stack, bytes", "M4F code, bytes"
BOUNDS = ["flop count", "flop count, with inverse"]

emulated = pytest.mark.skipif(missing_tool() is not None, reason=f"emulated part: no {missing_tool()}")
Row = dict[str, str]
Table = list[Row]


def tables(text: str) -> list[Table]:
    """The Markdown tables of a text. A second column of the same name gets the suffix " (2)"."""
    found: list[Table] = []
    head: list[str] | None = None
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if not cells:
            head = None
        elif head is None:
            head = [cell + (" (2)" if cell in cells[:i] else "") for i, cell in enumerate(cells)]
            found.append([])
        elif not set("".join(cells)) <= {"-"}:
            assert len(cells) == len(head), line
            found[-1].append(dict(zip(head, cells)))
    return found


def instructions(row: Row) -> tuple[float, int]:
    """Mean and maximum."""
    mean, most = row[COUNT].split()
    return float(mean), int(most.strip("()"))


@pytest.fixture(scope="module")
def others() -> Others:
    parser = argparse.ArgumentParser()
    command.add_arguments(parser)
    return find_others(parser.parse_args([]))


@pytest.fixture(scope="module")
def printed() -> str:
    done = subprocess.run([sys.executable, "-m", "bench", "peers", "--quick"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def windows(printed: str) -> Table:
    return tables(printed)[0]


@pytest.fixture(scope="module")
def updates(printed: str) -> list[Table]:
    """One update for each number of rows."""
    return tables(printed)[1:-1]


# ------------------------------------------------------------------------------------------------------- printed tables


def test_each_solver_is_printed(windows: Table, updates: list[Table], others: Others) -> None:
    assert [row["solver"] for row in windows] == [peer.name for peer in window.window_peers(others)]
    assert len(updates) == len(update.GROUPS)
    for table in updates:
        assert [row["solver"] for row in table] == [peer.name for peer in update.update_peers(others)] + BOUNDS


def test_who_is_not_there_is_named(printed: str, windows: Table) -> None:
    solvers = " ".join(row["solver"] for row in windows)
    for name in ("Eigen", "LAPACK", "CMSIS-DSP", "TinyEKF"):
        assert name in solvers or f"skipped: {name}" in printed


def test_ratios_are_of_ours(windows: Table, updates: list[Table]) -> None:
    for table in (windows, *updates):
        for row in (row for row in table if row["solver"] not in BOUNDS):
            assert float(row["host, ns"]) > 0.0 and float(row["over ours"]) > 0.0, row
            if row["solver"].startswith("goe"):
                assert float(row["over ours"]) == 1.0, row


@emulated
def test_each_solver_is_counted(windows: Table, updates: list[Table]) -> None:
    for table in (windows, *updates):
        for row in (row for row in table if row["solver"] != "LAPACK sgels"):
            mean, most = instructions(row)
            assert 0.0 < mean <= most, row
            assert float(row["over ours (2)"]) > 0.0, row
            if row["solver"] not in BOUNDS:
                assert int(row[STACK]) > 0 and int(row[CODE]) > 0, row


def test_each_solver_finds_the_width(windows: Table) -> None:
    for row in windows:
        worst, mean = float(row["error of W, relative: worst"]), float(row["root mean square"])
        assert 0.0 <= mean <= worst < WINDOW_ERROR_MOST, row


def test_each_solver_makes_the_update(updates: list[Table]) -> None:
    for table in updates:
        for row in (row for row in table if row["solver"] not in BOUNDS):
            assert float(row["error of the change, sigmas: worst"]) < CHANGE_SIGMAS_MOST, row
            assert float(row["of the variances, relative: worst"]) < VARIANCE_ERROR_MOST, row
            assert float(row["of the NIS, relative: worst"]) < NIS_ERROR_MOST, row


@emulated
def test_no_update_of_ours_is_below_the_bound(updates: list[Table]) -> None:
    for table in updates:
        rows = {row["solver"]: row for row in table}
        for bound, ours in zip(BOUNDS, (update.OURS, update.OURS_INVERSE)):
            assert instructions(rows[bound])[0] < instructions(rows[ours])[0]


def test_throughput_is_printed(printed: str) -> None:
    rows = tables(printed)[-1]
    assert [row["obstacles"] for row in rows] == ["1", "10"]
    for row in rows:
        window_hz, refined_hz, hazard_hz = (float(row[f"{kind}: updates per second"]) for kind in KINDS)
        assert_ratio(row["time of filter over window"], window_hz, refined_hz)
        assert_ratio(row["of filter and hazard over filter"], refined_hz, hazard_hz)


def assert_ratio(ratio: str, dividend: float, divisor: float) -> None:
    """Checks a ratio with two decimals, whose dividend and divisor are rounded to whole numbers."""
    assert dividend > 0.0 and divisor > 0.0
    least, most = (dividend - 0.5) / (divisor + 0.5) - 0.005, (dividend + 0.5) / (divisor - 0.5) + 0.005
    assert least <= float(ratio) + 1e-9 and float(ratio) - 1e-9 <= most


@emulated
def test_instructions_repeat_exactly(tmp_path: Path) -> None:
    builder = Builder(tmp_path)
    bench = Bench(builder, window.window_job(builder, NOBODY, quick=True), 0.01, build_plugin(tmp_path))
    image = bench.programs(bench.job.peers[0], "own").image
    assert image is not None
    builder.make()
    text, counts = bench.count(image)
    assert len(counts) == window.QUICK_CASES and min(counts) > 0
    assert bench.count(image) == (text, counts)


# --------------------------------------------------------------------------------------------------- wrong answers show


def test_a_wrong_width_shows() -> None:
    # X0 = 10 m, Z0 = 100 m, W = 4 m, flown straight ahead: no number is rounded
    case = np.concatenate([np.zeros(8), np.arange(8.0), np.full(8, 2.5), (100.0 - np.arange(8.0)) / 4.0])
    group = Group("one", case[None].astype(np.float32))
    ours = window.window_peers(NOBODY)[0]
    right, wrong = (np.array([[width, 10.0, 100.0]], dtype=np.float32) for width in (4.0, 4.5))
    job = window.WindowJob([ours], [group])
    assert job.errors(ours, group, right) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert job.errors(ours, group, wrong) == pytest.approx((0.125, 0.125), abs=1e-12)


def random_recorded() -> np.ndarray:
    """A random update in the format of record.c, without a zero."""
    random = np.random.default_rng(20190601)
    root = random.normal(size=(update.STATES, update.STATES)) + 4.0 * np.eye(update.STATES)
    columns = random.normal(size=(update.COLUMNS, update.ROWS))
    return np.concatenate([root[update.UPPER], [2.0], columns.ravel()]).astype(np.float32)


def test_a_wrong_update_shows() -> None:
    group = Group("one", update.case_of(random_recorded())[None])
    holder = update.UpdatePeer("of factors", Path(), "", form="factors")
    job = update.UpdateJob([holder], [group])
    truth = job.exact["one"][0]

    def errors(change: np.ndarray, nis: float, variance: np.ndarray) -> tuple[float | None, ...]:
        held = np.zeros(update.STATES**2)
        held[: update.TRIANGLE] = update.to_columns(np.diag(variance))
        answer = np.concatenate([change, [nis], held]).astype(np.float32)
        return job.errors(holder, group, answer[None])

    right = errors(truth.change, truth.nis, truth.variance)
    assert right == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    far = truth.change + 0.5 * np.sqrt(truth.variance) * (np.arange(update.STATES) == 7)
    assert errors(far, truth.nis, truth.variance)[0] == pytest.approx(0.5, rel=1e-5)
    assert errors(truth.change, truth.nis, 1.25 * truth.variance)[1] == pytest.approx(0.25, rel=1e-5)
    assert errors(truth.change, 3.0 * truth.nis, truth.variance)[2] == pytest.approx(
        2.0 * truth.nis / max(truth.nis, update.ROWS), rel=1e-5
    )


def test_each_form_of_a_covariance_gives_the_same() -> None:
    case = update.case_of(random_recorded()).astype(float)
    root, factors, covariance, _, _ = np.split(case, np.cumsum(update.CASE)[:-1])
    full = covariance.reshape(update.STATES, update.STATES)
    assert np.linalg.inv(full) == pytest.approx(update.from_rows(root).T @ update.from_rows(root), rel=1e-3, abs=1e-3)
    variance = update.variance_of_covariance(covariance)
    assert update.variance_of_root(root) == pytest.approx(variance, rel=1e-5)
    assert update.variance_of_factors(factors) == pytest.approx(variance, rel=1e-5)
    inverse = np.linalg.inv(update.from_rows(root))
    assert update.variance_of_inverse(update.to_columns(inverse)) == pytest.approx(variance, rel=1e-5)


# ---------------------------------------------------------------------------------------------------------- lower bound


def test_the_counted_update_is_right() -> None:
    one = update.Update.of_case(update.case_of(random_recorded()))
    solution = householder_update(one.root, one.nuisances_root, one.rows, Operations())
    truth = update.exact(one)
    assert solution.change == pytest.approx(truth.change, rel=1e-9, abs=1e-12)
    assert solution.nis == pytest.approx(truth.nis, rel=1e-9)
    inverse = triangle_inverse(solution.root, Operations())
    assert np.sum(inverse**2, axis=1) == pytest.approx(truth.variance, rel=1e-9)


def test_operations_of_one_state_and_one_row() -> None:
    operations = Operations()
    householder_update(np.array([[2.0]]), 1.0, np.array([[3.0, 1.0]]), operations)
    # s = h h; sqrt(s + r r); u = r - d; beta = 1/(d u); g = h z beta; (0, z) + g (u, h); /d; z z
    assert operations == Operations(products=6, sums=1, pairs=2, divisions=2, roots=1)
    assert (operations.fused, operations.separate) == (12, 14)


def test_operations_without_a_zero() -> None:
    """By the textbook's formulas: m rows, n states, t nuisances, whose rows of the triangle are 0 and not kept."""
    m, n, t = update.ROWS, update.STATES, update.NUISANCES
    dot = 2 * m - 1
    pivots = (n + t) * (dot + 2 + 4)  # h'h; + r r; root, u, beta's product and division
    nuisances = sum(n + t - j for j in range(t)) * (dot + 1 + 2 * m)  # g; h'c beta; c + g h
    states = sum(n - 1 - j for j in range(n)) * (dot + 2 + 1 + 2 * m + 2)  # the same with r
    residual = n * (dot + 1 + 2 * m + 1)  # the triangle adds nothing, because its right-hand side is 0
    solution = n * (n - 1) + n + dot  # back substitution; NIS
    one = update.Update.of_case(update.case_of(random_recorded()))
    operations = Operations()
    root = householder_update(one.root, one.nuisances_root, one.rows, operations).root
    assert operations.separate == pivots + nuisances + states + residual + solution
    before = operations.separate
    triangle_inverse(root, operations)
    # element (i, j): j - i products, one sum less, one product with the reciprocal; n of those for the solution, too
    assert operations.separate - before == n + sum(2 * (j - i) for j in range(n) for i in range(j))


def test_zeros_cost_nothing() -> None:
    one = update.Update.of_case(update.case_of(random_recorded()))
    few = one.rows.copy()
    few[3:] = 0.0
    operations, of_three = Operations(), Operations()
    padded = householder_update(one.root, one.nuisances_root, few, operations)
    short = householder_update(one.root, one.nuisances_root, few[:3], of_three)
    assert operations == of_three
    assert padded.change == pytest.approx(short.change, rel=1e-12)
