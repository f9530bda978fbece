"""What a page tells of the tests: how many there are, counted in the sources, and the figures on record.

A page has both between <!-- testing: begin --> and <!-- testing: end -->. Counts may differ by a little before the page
is to be renewed, so that not every new test asks for it; the record's table may not.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..logs.marked_block import MarkedBlock
from ..places import ROOT
from .parts import MODULES
from .record import Kept, cells, run_of
from .requirements import names, rows

FIGURES = MarkedBlock("testing")
TOLERANCE = 0.03
ASSERTION = re.compile(r"\b(?:TEST_ASSERT|CHECK)_\w+\(|\bTEST_ASSERT\(")
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
LAYERS = ("flight", "mavlink", "companion", "px4", "ardupilot", "rtos", "go_around")


def sources(folder: Path, *suffixes: str) -> list[Path]:
    return sorted(path for path in folder.rglob("*") if path.suffix in suffixes and "golden" not in path.parts)


def code_lines(files: Iterable[Path]) -> int:
    """Lines that are neither empty nor comment, of C and Python."""
    total = 0
    for path in files:
        text = path.read_text(encoding="utf-8")
        text = (
            re.sub(r"^\s*#.*$", "", text, flags=re.MULTILINE)
            if path.suffix in (".py", ".sh")
            else COMMENT.sub("", text)
        )
        total += sum(1 for line in text.splitlines() if line.strip())
    return total


def unity(folder: Path) -> tuple[int, int, int]:
    """Files, tests and assertions of the Unity tests in a folder."""
    files = [path for path in sources(folder, ".c", ".cpp") if names.unity_tests(path)]
    shared = [path for path in sources(folder, ".c", ".cpp") if path not in files]
    tests = sum(len(set(names.unity_tests(path))) for path in files)
    return len(files), tests, sum(len(ASSERTION.findall(names.without_comments(path))) for path in [*files, *shared])


def counts(root: Path = ROOT) -> list[tuple[str, str, tuple[int, ...]]]:
    """Rows: what, a text with {} for each number, the numbers."""
    tests = root / "tests"
    python = [path for path in sources(tests, ".py") if names.python_tests(path)]
    functions = sum(len(names.python_tests(path)) for path in python)
    asserts = sum(len(re.findall(r"^\s*assert\b|pytest\.raises\(", names.read(path), re.MULTILINE)) for path in python)
    files, of_library, assertions = unity(tests / "c")
    layers = [sum(numbers) for numbers in zip(*(unity(tests / name) for name in LAYERS))]
    sources_of_tests = sources(tests, ".sh", ".c", ".h", ".cpp", ".hpp", ".py")
    lines_of_tests = code_lines(path for path in sources_of_tests if path.name != "embedded_logs.c")
    required = len(rows.requirements(root / "tests" / "requirements"))
    each = "{} in {} files, with {} assertions"
    return [
        ("the library", "{} lines of C, without comments", (code_lines(sources(root / "lib", ".c", ".h")),)),
        ("its tests and those of what lies around it", "{} lines of C, C++, Python and shell", (lines_of_tests,)),
        ("unit tests of the library", each, (of_library, files, assertions)),
        ("unit tests of the layers around it", each, (layers[1], layers[0], layers[2])),
        ("tests in Python", each, (functions, len(python), asserts)),
        ("requirements", "{}, each with its code and its tests", (required,)),
    ]


def count_table(root: Path = ROOT) -> str:
    lines = ["| what | how many |", "|---|---|"]
    lines += [
        f"| {what} | {text.format(*(f'{number:,}' for number in numbers))} |" for what, text, numbers in counts(root)
    ]
    return "\n".join(lines)


def part_table(entry: Kept) -> list[str]:
    """A line that tells how a part stands, which opens its rows where pages can."""
    asked = [row for row in entry.rows if row.met is not None]
    missed = [row.what for row in asked if not row.met]
    goals = f"{len(asked) - len(missed)} of {len(asked)} goals met" if asked else "no goals"
    told = f"{goals} ({run_of(entry)})" + (f"; missed: {'; '.join(missed)}" if missed else "")
    lines = ["| what | figure | goal | |", "|---|---|---|---|", *(f"| {cells(row)} |" for row in entry.rows)]
    return [f"<details><summary><b>{entry.part}</b>: {told}</summary>", "", *lines, "", "</details>", ""]


def record_table(kept: dict[str, Kept]) -> str:
    """The record's figures, and which parts have none yet."""
    lines = [line for name in MODULES if name in kept for line in part_table(kept[name])]
    missing = [name for name in MODULES if name not in kept]
    if missing:
        lines += [f"Not on record yet: {', '.join(missing)}."]
    return "\n".join(lines).strip()


def block(kept: dict[str, Kept], root: Path = ROOT) -> str:
    return f"{count_table(root)}\n\n{record_table(kept)}".strip()


def write(path: Path, kept: dict[str, Kept]) -> None:
    FIGURES.write(path, block(kept))


def numbers_of(text: str) -> list[int]:
    return [int(number.replace(",", "")) for number in re.findall(r"\d[\d,]*", text)]


def stale(told: str, kept: dict[str, Kept], root: Path = ROOT) -> Iterator[str]:
    """What the block of a page tells otherwise than it is."""
    said, _, of_record = told.partition("\n\n")
    is_now = count_table(root)
    for old, new in zip(said.splitlines(), is_now.splitlines()):
        before, after = numbers_of(old), numbers_of(new)
        alike = len(before) == len(after) and re.sub(r"[\d,]", "", old) == re.sub(r"[\d,]", "", new)
        if not alike or any(abs(a - b) > TOLERANCE * b for a, b in zip(before, after)):
            yield f"it says {old.strip('| ')}; now it is {new.strip('| ')}"
    if len(said.splitlines()) != len(is_now.splitlines()):
        yield "its counts are other ones"
    if of_record.strip() != record_table(kept):
        yield "its figures are not those of the record"
