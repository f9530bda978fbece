"""Coverage: counting llvm-cov's export, and matching reasons with uncovered items."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from ci.evidence.coverage import REASONS, count, faults, per_file
from ci.evidence.coverage_counts import CountError, Item, items
from ci.evidence.coverage_reasons import COLUMNS, Reason, read, settle
from goe_tools.logs.obslog import LogError

SOURCE = """\
/* a header of two copies */
static inline int pick(int a, int b) {
    if (a > 0 && b > 0) {
        return 1;
    }
    return 2;
}
"""
FILE = "lib/pick.h"

A = [3, 9, 3, 14]  # a > 0
B = [3, 18, 3, 23]  # b > 0
BOTH = [3, 9, 3, 23]
CONDITION, DECISION = 6, 5


def exported(root: Path, a: tuple[int, int], b: tuple[int, int], alone: list[bool], inner: int = 0) -> dict[str, Any]:
    """llvm-cov's export for the source: how often each condition was true and false; line 4 was reached."""
    path = root / FILE
    path.parent.mkdir(exist_ok=True)
    path.write_text(SOURCE)
    segments = [
        [2, 38, 5, True, True, False],
        [3, 25, inner, True, True, False],
        [5, 6, 5, True, False, False],
        [7, 2, 0, False, False, False],
    ]
    branches = [[*A, *a, 0, 0, CONDITION], [*B, *b, 0, 0, CONDITION]]
    records = [[*BOTH, 0, DECISION, alone]]
    file = {"filename": str(path), "segments": segments, "branches": branches, "mcdc_records": records}
    function = {"name": "user.c:pick", "filenames": [str(path)], "regions": [[2, 38, 7, 2, 5, 0, 0, 0]]}
    return {"files": [file], "functions": [function]}


def unreached(found: list[Item]) -> set[tuple[str, str]]:
    return {(item.text, item.outcome) for item in found if not item.reached}


def reason(text: str, outcome: str, function: str = "pick") -> Reason:
    return Reason(FILE, function, text, outcome, "because", 2)


def test_lines_outcomes_and_conditions_are_counted_with_their_text(tmp_path: Path) -> None:
    found = items(exported(tmp_path, (5, 0), (0, 5), [False, False]), tmp_path)
    assert [item.line for item in found if item.outcome == "line"] == [2, 3, 4, 6]  # no brace, no comment
    assert {item.function for item in found} == {"pick"}
    assert unreached(found) == {
        ("return 1;", "line"),
        ("[a > 0] && b > 0", "false"),
        ("a > 0 && [b > 0]", "true"),
        ("[a > 0] && b > 0", "independent"),
        ("a > 0 && [b > 0]", "independent"),
    }


def test_copies_of_a_function_in_a_header_count_as_one(tmp_path: Path) -> None:
    export = exported(tmp_path, (5, 0), (5, 0), [False, True], inner=5)
    other = exported(tmp_path, (0, 2), (0, 0), [True, False])["files"][0]
    export["files"][0]["branches"] += other["branches"]
    export["files"][0]["mcdc_records"] += other["mcdc_records"]
    found = items(export, tmp_path)
    assert unreached(found) == {("a > 0 && [b > 0]", "false")}
    assert sum(item.outcome == "independent" for item in found) == 2


def test_an_answer_of_another_shape_is_refused(tmp_path: Path) -> None:
    export = exported(tmp_path, (5, 5), (5, 5), [True, True, True])
    with pytest.raises(CountError, match="3 conditions, but 2 found"):
        items(export, tmp_path)


def test_a_reason_covers_its_outcome_and_the_independence_that_needs_it(tmp_path: Path) -> None:
    found = items(exported(tmp_path, (5, 5), (5, 0), [True, False], inner=5), tmp_path)
    assert len(settle(found, []).missing) == 2
    verdict = settle(found, [reason("a > 0 && [b > 0]", "false")])
    assert verdict.missing == [] and verdict.stale == []
    assert [item.outcome for item, _ in verdict.reasoned] == ["false", "independent"]
    branches = count(found, verdict, "branches")
    assert (branches.of, branches.covered, branches.reasoned, branches.missing) == (4, 3, 1, 0)
    assert branches.figure() == "75.00 % (3 of 4, 1 reasoned)"
    last = " ".join(per_file(found, verdict).splitlines()[-1].split())
    assert last == "all 4 4 0 0 3 4 1 0 1 2 1 0"  # of each kind: reached, total, with a reason, missing


@pytest.mark.parametrize(
    ("given", "fault"),
    [
        (reason("a > 0 && [b > 0]", "true"), "is covered now"),
        (reason("a > 0 && [b > 1]", "false"), "no longer fits anything"),
        (reason("a > 0 && [b > 0]", "false", "choose"), "no longer fits anything"),
    ],
)
def test_a_reason_that_is_none_is_a_fault(tmp_path: Path, given: Reason, fault: str) -> None:
    found = items(exported(tmp_path, (5, 5), (5, 5), [True, True], inner=5), tmp_path)
    verdict = settle(found, [given])
    assert [text for _, text in verdict.stale] == [fault]
    assert len(faults(verdict)) == 1 and fault in faults(verdict)[0]


@pytest.mark.parametrize(
    ("row", "fault"),
    [
        ("lib/a.c,f,x > 0,maybe,because", "outcome"),
        ("lib/a.c,f,x > 0,true,", "all with text"),
        ("lib/a.c,f,x > 0,true", "5 cells"),
    ],
)
def test_a_bad_row_of_reasons_is_refused(tmp_path: Path, row: str, fault: str) -> None:
    path = tmp_path / "reasons.csv"
    path.write_text(",".join(COLUMNS) + "\n" + row + "\n")
    with pytest.raises(LogError, match=fault):
        read(path)


def test_the_reasons_of_the_library_are_unique() -> None:
    reasons = read(REASONS)
    places = [(r.file, r.function, r.text, r.outcome) for r in reasons]
    assert len(set(places)) == len(places)
