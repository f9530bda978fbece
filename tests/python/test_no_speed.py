"""No test depends on the speed of the machine: none asserts the reading of a clock, and guards against hangs wait
long."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests"
CLOCKS = {"time", "monotonic", "perf_counter", "process_time", "thread_time", "clock_gettime", "times", "getrusage"}
CLOCKS |= {f"{name}_ns" for name in CLOCKS}
MODULES = {"time", "os", "resource"}
USED = {"ru_utime", "ru_stime"}
GUARD_S = 300  # at least


def reads_a_clock(node: ast.AST, names: set[str]) -> bool:
    """Whether an expression contains a clock call or a name that holds a clock's reading."""
    for part in ast.walk(node):
        if isinstance(part, ast.Attribute):
            of_module = isinstance(part.value, ast.Name) and part.value.id in MODULES
            if (of_module and part.attr in CLOCKS) or part.attr in USED:
                return True
        elif isinstance(part, ast.Name) and part.id in names:
            return True
    return False


def assigned(node: ast.AST) -> tuple[list[ast.AST], ast.AST | None]:
    if isinstance(node, ast.Assign):
        return list(node.targets), node.value
    if isinstance(node, (ast.AnnAssign, ast.AugAssign, ast.NamedExpr)):
        return [node.target], node.value
    return [], None


def names_of_times(function: ast.AST) -> set[str]:
    """Local names that hold the reading of a clock."""
    names: set[str] = set()
    before = -1
    while len(names) != before:
        before = len(names)
        for node in ast.walk(function):
            targets, value = assigned(node)
            if value is not None and reads_a_clock(value, names):
                names |= {target.id for target in targets if isinstance(target, ast.Name)}
    return names


def timed(text: str) -> Iterator[int]:
    """Lines of assertions on a clock, and of guards that are too short."""
    tree = ast.parse(text)
    lines = set()
    for function in ast.walk(tree):
        if isinstance(function, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Module)):
            names = names_of_times(function) if not isinstance(function, ast.Module) else set()
            asserts = (node for node in ast.walk(function) if isinstance(node, ast.Assert))
            lines |= {node.lineno for node in asserts if reads_a_clock(node.test, names)}
    for node in ast.walk(tree):
        if isinstance(node, ast.keyword) and node.arg == "timeout" and isinstance(node.value, ast.Constant):
            value = node.value.value
            lines |= {node.value.lineno} if isinstance(value, (int, float)) and value < GUARD_S else set()
    yield from sorted(lines)


def test_no_test_asserts_the_reading_of_a_clock() -> None:
    """Within a function only: a time that another function returns is not recognized."""
    paths = sorted(TESTS.rglob("*.py"))
    assert len(paths) > 90
    found = {str(path.relative_to(ROOT)): list(timed(path.read_text(encoding="utf-8"))) for path in paths}
    assert {path: lines for path, lines in found.items() if lines} == {}


def test_limits_of_ctest_are_the_common_ones() -> None:
    paths = [*TESTS.rglob("CMakeLists.txt"), *TESTS.rglob("*.cmake")]
    assert len(paths) > 10
    own = [path for path in paths if re.search(r"\bTIMEOUT +[^$ ]", path.read_text(encoding="utf-8"))]
    assert own == []
    common = (TESTS / "CMakeLists.txt").read_text(encoding="utf-8")
    limits = [int(seconds) for seconds in re.findall(r"^set\(goe_\w*hang_s (\d+)\)", common, re.MULTILINE)]
    assert len(limits) == 2 and min(limits) >= GUARD_S


SAMPLE = """
def test_speed():
    begin = time.monotonic()
    work()
    end = begin + 5.0
    seconds = time.monotonic() - begin
    assert seconds < 5.0
    assert 100 / seconds > 3
    assert time.perf_counter() < end, "late"
    assert (took := os.times().user) < 1
    assert os.wait4(pid, 0)[2].ru_utime < 1
    run(timeout=20)

def test_fine():
    until = time.monotonic() + 600
    while not done():
        if time.monotonic() > until:
            raise TimeoutError
        time.sleep(0.1)
    run(timeout=600)
    seconds = log.time_s
    assert seconds < 5.0 and log.time() == 3 and heard.time_s < times[1] and path.stat().st_mtime
"""


def test_timed_assertions_are_found() -> None:
    assert list(timed(SAMPLE)) == [7, 8, 9, 10, 11, 12]
