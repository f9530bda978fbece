"""The theory of the filter: its table lists every constant of the sources, and the equations that the sources name
exist."""

from __future__ import annotations

import re
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2] / "lib" / "refined"
KINDS = set("dlsgbc")

DEFINITION = re.compile(r"^#define (\w+) +\(?(-?[0-9][0-9.]*(?:e-?[0-9]+)?)[fu]*\)?(?:\s|$)", re.MULTILINE)
TABLE_ROW = re.compile(r"^\| (goe_\w+\.[ch]) \| `(\w+)` \| ([^ |]+) \| (\w) \| (.+) \|$", re.MULTILINE)
LABEL = re.compile(r"\(R(\d+)\)$", re.MULTILINE)


def numbers_in(sources: dict[str, str]) -> dict[tuple[str, str], float]:
    """Every macro with a number, by file and name."""
    joined = {file: text.replace("\\\n", " ") for file, text in sources.items()}
    return {(file, name): float(value) for file, text in joined.items() for name, value in DEFINITION.findall(text)}


def folder_sources() -> dict[str, str]:
    return {path.name: path.read_text() for path in sorted(FOLDER.glob("*.[ch]"))}


def theory() -> str:
    return (FOLDER / "README.md").read_text()


def test_the_table_has_every_constant_of_the_sources_with_its_value() -> None:
    rows = TABLE_ROW.findall(theory())
    listed = {(file, name): float(value) for file, name, value, _, _ in rows}
    assert len(listed) == len(rows), "a constant is in the table twice"
    assert listed == numbers_in(folder_sources())
    assert {kind for _, _, _, kind, _ in rows} <= KINDS


def test_a_constant_is_found_however_it_is_written() -> None:
    text = "#define A 1.0e-3f /* x */\n#define B (-1.0f)\n#define C 4000000000u\n#define D GOE_STATES\n#define E_H\n"
    text += "#define F    \\\n    2.5f /* y */\n"
    assert numbers_in({"f": text}) == {("f", "A"): 1e-3, ("f", "B"): -1.0, ("f", "C"): 4e9, ("f", "F"): 2.5}


def test_equations_are_numbered_in_order() -> None:
    labels = [int(label) for label in LABEL.findall(theory())]
    assert labels == list(range(1, len(labels) + 1))


def test_equations_that_the_sources_name_exist() -> None:
    known = {int(label) for label in LABEL.findall(theory())}
    named = {int(number) for text in folder_sources().values() for number in re.findall(r"\(R(\d+)\)", text)}
    assert named and named <= known
