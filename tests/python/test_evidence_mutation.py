"""Mutation of C sources: the changes, their selection and counting, and the lists of survivors."""

from __future__ import annotations

import json
import shutil
from dataclasses import asdict
from pathlib import Path

import pytest
from ci.evidence import mutants as made
from ci.evidence import mutation, mutation_counts, mutation_trees, survivors
from ci.evidence.mutants import Mutant
from ci.evidence.mutation import Kept
from ci.evidence.mutation_counts import (
    BY_HASH,
    EQUIVALENT,
    KILLED,
    KILLED_BY_PROGRAM,
    NO_CODE,
    SAME_CODE,
    SURVIVED,
    Outcome,
)
from goe_tools.logs.obslog import LogError

needs_clang = pytest.mark.skipif(shutil.which(made.CLANG) is None, reason=f"no {made.CLANG}")

SOURCE = """/* a < b is a comment */
#define LIMIT 3.0f
typedef char size_is_right[sizeof(int) == 4 ? 1 : -1];
static const float steps[] = {0.5f, 2.0e-3f};
static float larger(float a, float b) { return a > b ? a : b; }
float sum(const float *x, int n, float a, float b) {
    float all = 0.0f;
    for (int i = 0; i < n; i++) {
        if (x[i] < LIMIT && !(x[i] == b)) {
            all += larger(x[i], -b) * steps[1];
        }
    }
    all = all / 7.0f;
    return larger(a, b) - all;
}
enum side { LEFT, RIGHT, AHEAD };
typedef int flag;
static flag is_any(void) { return 1; }
static void empty(float *x) { *x = 0.0f; }
int side_of(float *x) {
    (void)larger(*x, 1.0f);
    while (is_any()) {
        if (*x > LIMIT) {
            continue;
        }
        if (is_any()) {
            break;
        }
        if (*x < 0.0f) {
            return LEFT;
        }
    }
    empty(x);
    return RIGHT;
}
"""


def mutations(tmp_path: Path, source: str) -> list[Mutant]:
    (tmp_path / "sum.c").write_text(source)
    return made.mutants("sum.c", tmp_path)


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> list[Mutant]:
    return mutations(tmp_path_factory.mktemp("c"), SOURCE)


@needs_clang
@pytest.mark.parametrize(
    ("function", "source", "mutation"),
    [
        ("larger", "return a > b", "return a < b"),
        ("larger", "return a > b", "return a >= b"),
        ("larger", "return a > b", "return !(a > b)"),
        ("sum", "i < n", "i <= n"),
        ("sum", "x[i] < LIMIT &&", "x[i] < LIMIT ||"),
        ("sum", "x[i] < LIMIT", "x[i] > LIMIT"),
        ("sum", "!(x[i] == b)", "(x[i] == b)"),
        ("sum", "x[i] == b", "x[i] != b"),
        ("sum", "all += larger(x[i], -b) * steps[1];", ";"),
        ("sum", "all +=", "all -="),
        ("sum", "larger(x[i], -b)", "larger(-b, x[i])"),
        ("sum", "larger(x[i], -b)", "larger(x[i], b)"),
        ("sum", "larger(x[i], -b)", "larger(x[i - 1], -b)"),
        ("sum", "-b) * steps", "-b) / steps"),
        ("sum", "steps[1]", "steps[0]"),
        ("sum", "all = all / 7.0f;", ";"),
        ("sum", "7.0f", "14.0f"),
        ("sum", "7.0f", "7.1f"),
        ("sum", "7.0f", "(-7.0f)"),
        ("sum", "all = 0.0f", "all = 1.0f"),
        ("sum", "larger(x[i], -b)", "(x[i])"),
        ("sum", "return larger(a, b)", "return (a)"),
        ("sum", "LIMIT", "(2 * LIMIT)"),
        ("sum", "LIMIT", "(LIMIT + 1)"),
        ("side_of", "(void)larger(*x, 1.0f);", ";"),
        ("side_of", "empty(x);", ";"),
        ("side_of", "is_any()", "0"),
        ("side_of", "continue;", ";"),
        ("side_of", "break;", ";"),
        ("side_of", "return LEFT;", ";"),
        ("side_of", "return LEFT;", "return RIGHT;"),
        ("side_of", "return RIGHT;", "return AHEAD;"),
        ("", "{0.5f, 2.0e-3f}", "{1.0f, 2.0e-3f}"),
        ("", "{0.5f, 2.0e-3f}", "{0.5f, 2.1e-3f}"),
    ],
)
def test_a_token_is_changed(found: list[Mutant], function: str, source: str, mutation: str) -> None:
    """Each kind of change is made, at its place, and is visible in the text of its line."""
    there = [m for m in found if m.function == function and source in m.source]
    assert any(m.source.replace(source, mutation, 1) == m.mutation for m in there)


@needs_clang
def test_no_function_loses_its_value(found: list[Mutant]) -> None:
    """The last return stays. A call without a value is removed, not replaced."""
    assert not any(m.source == "return RIGHT;" and m.mutation == ";" for m in found)
    assert {m.mutation for m in found if m.source == "empty(x);"} == {";"}
    assert "0" not in {m.text for m in found if m.kind == "dropped call" and "larger" in m.source}


@needs_clang
def test_each_change_has_its_family(found: list[Mutant]) -> None:
    families = {(m.source, m.mutation): m.family for m in found}
    assert families["return RIGHT;", "return AHEAD;"] == "enumerator or flag inverted"
    assert families["continue;", ";"] == "return, continue or break removed"
    assert families["all = all / 7.0f;", ";"] == "statement removed"
    assert families["all = all / 7.0f;", "all = all * 7.0f;"] == "arithmetic and logic"
    assert families["all = all / 7.0f;", "all = all / 14.0f;"] == "constant"


@needs_clang
def test_comments_macros_and_types_are_left_alone(found: list[Mutant]) -> None:
    """Comments, macros and types are not mutated, and every change leaves all other lines as they are."""
    for mutant in found:
        changed = made.apply(mutant, SOURCE).splitlines()
        assert changed[:3] == SOURCE.splitlines()[:3]
        assert len(set(changed) - set(SOURCE.splitlines())) <= 1


@needs_clang
def test_a_change_made_by_a_macro_is_in_no_line(tmp_path: Path) -> None:
    text = "#define TWICE(x) ((x) + (x))\nint f(int a) { return TWICE(a) * 2; }\n"
    assert {m.mutation for m in mutations(tmp_path, text) if m.kind.startswith("operator")} == {
        "int f(int a) { return TWICE(a) / 2; }"
    }


def test_every_file_gets_its_share() -> None:
    assert mutation.shares([10, 30, 60], 10) == [1, 3, 6]
    assert sum(mutation.shares([1, 1, 1, 5, 7], 9)) == 9
    assert mutation.shares([1, 1000], 5) == [0, 5]


def some_mutant(number: int, change: int = 0) -> Mutant:
    text = "-" * (1 + change)
    return Mutant("box.c", "f", number, number + 1, text, "operator +", f"a{number} + b;", f"a{number} {text} b;")


def test_the_chosen_are_spread_and_always_the_same() -> None:
    """The selection is spread over places, not over changes. Different places get different changes; if one does not
    compile, another replaces it."""
    every = [some_mutant(i, change) for i in range(100) for change in range(1 + i % 2)]
    groups = mutation.strided(every, 4)
    assert [(group[0].begin, group[0].text) for group in groups] == [(12, "-"), (37, "--"), (62, "-"), (87, "--")]
    assert all(len(group) == mutation.TRIES for group in groups)
    assert {mutant.text for mutant in groups[1] if mutant.begin == 37} == {"-", "--"}


def test_every_family_gets_as_many_as_it_has() -> None:
    """Each family gets up to its share; the same mutants for the same seed."""
    kinds = ["removed statement"] * 50 + ["operator <"] * 3 + ["operator +"] * 50
    every = [Mutant("box.c", "f", i, i + 1, "-", kind, f"a{i};", f"b{i};") for i, kind in enumerate(kinds)]
    chosen = mutation_trees.sampled(every, 23, seed=1)
    assert [sum(m.family == family for m in chosen) for family in ("statement removed", "comparison")] == [10, 3]
    assert len(chosen) == 23
    assert chosen == mutation_trees.sampled(every, 23, seed=1)
    assert chosen != mutation_trees.sampled(every, 23, seed=2)


def outcomes() -> list[Outcome]:
    ends = [KILLED] * 17 + [BY_HASH] * 2 + [SURVIVED] + [EQUIVALENT] * 3 + [NO_CODE]
    return [Outcome(some_mutant(i), end, "box" if end == KILLED else "") for i, end in enumerate(ends)]


def test_equivalent_mutants_are_not_counted() -> None:
    """19 of 20 mutants with an effect are killed, 17 without the hash. Equivalent mutants and those that do not compile
    are in neither count."""
    by_name = {row.what: row for row in mutation_counts.rows(outcomes(), {})}
    assert by_name["mutants of lib/ that compile"].figure == "23"
    assert by_name["... of these, killed by the unit tests"].figure == "95.0 % (19 of 20)"
    assert by_name["... of these, killed by the unit tests"].met is True
    assert by_name["... ... without the hash over the filter method's bits"].figure == "85.0 % (17 of 20)"
    assert by_name["mutants that survive: with a written reason, and without"].figure == "0 and 1"
    assert by_name["mutants that survive: with a written reason, and without"].met is False


def test_mutants_that_the_probe_misses_are_counted() -> None:
    by_name = {row.what: row for row in mutation_counts.rows(outcomes(), {})}
    assert by_name["mutants that neither a unit test nor the probe detects"].figure == "3"
    assert by_name["killed, if those count as alive"].figure == "82.6 % (19 of 23)"


def test_in_a_layer_every_change_of_the_object_code_counts() -> None:
    """18 of 20 are killed; one survivor of three has a reason."""
    ends = [KILLED] * 10 + [KILLED_BY_PROGRAM] * 8 + [SURVIVED] * 3 + [SAME_CODE] * 2 + [NO_CODE]
    found = [Outcome(some_mutant(i), end) for i, end in enumerate(ends)]
    reasons = {found[18].mutant.key: "twice the same"}
    made, ended, killed = mutation_counts.rows_of_layer("port/flight", found, reasons)
    assert made.figure == "24; 1; 2"
    assert ended.figure == "10; 8; 1; 2"
    assert killed.figure == "90.0 % (18 of 20)"
    assert killed.met is False
    table = mutation_counts.by_family(found, reasons)
    assert table[-1].split() == ["together", "24", "1", "2", "0", "10", "8", "1", "2"]


def test_a_survivor_with_a_reason_is_explained_but_not_killed() -> None:
    reasons = {outcomes()[19].mutant.key: "twice the same"}
    by_name = {row.what: row for row in mutation_counts.rows(outcomes(), reasons)}
    assert by_name["mutants that survive: with a written reason, and without"].figure == "1 and 0"
    assert by_name["... of these, killed by the unit tests"].figure == "95.0 % (19 of 20)"
    assert "reason: twice the same" in mutation_counts.report(outcomes(), reasons, 1.0)


def test_a_result_is_valid_as_long_as_its_test(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """For a killed mutant that is the test that killed it, for a surviving one all tests."""
    hashes = {"box": "1", "disc": "1"}
    monkeypatch.setattr(mutation, "unit_tests", lambda: sorted(hashes))
    monkeypatch.setattr(mutation, "test_hash", lambda name: hashes[name])
    killed, survived = Outcome(some_mutant(1), KILLED, "box"), Outcome(some_mutant(2), SURVIVED)
    kept = Kept(tmp_path)
    kept.keep(killed)
    kept.keep(survived)
    groups = [[killed.mutant], [survived.mutant], [some_mutant(3)]]
    assert [Kept(tmp_path).of_group(group) for group in groups] == [[killed], [survived], None]
    hashes["disc"] = "2"
    assert [Kept(tmp_path).of_group(group) for group in groups] == [[killed], None, None]
    hashes["box"] = "2"
    assert [Kept(tmp_path).of_group(group) for group in groups] == [None, None, None]
    assert json.loads((tmp_path / "outcomes.jsonl").read_text().splitlines()[0])["outcome"] == asdict(killed)


# -------------------------------------------------------------------------------------------------------- survivors.csv


@needs_clang
def test_every_listed_survivor_is_a_mutant_of_the_present_sources() -> None:
    """A reason does not apply to a line that has changed or is gone."""
    assert survivors.strangers(survivors.read()) == []


@pytest.mark.release
@needs_clang
def test_every_listed_survivor_of_the_flight_layer_is_a_mutant() -> None:
    """Mutants of the companion need its build: the evidence checks them."""
    layer = mutation_trees.FLIGHT
    assert survivors.strangers(survivors.read(layer.reasons), layer.folder, layer.flags) == []


@needs_clang
def test_an_entry_that_fits_nothing_is_reported(tmp_path: Path) -> None:
    (tmp_path / "sum.c").write_text(SOURCE)
    listed = tmp_path / "survivors.csv"
    listed.write_text(
        ",".join(survivors.COLUMNS) + "\n"
        "sum.c,sum,all = all / 7.0f;,all = all * 7.0f;,nobody reads it\n"
        "sum.c,sum,all = all / 8.0f;,all = all * 8.0f;,nobody reads it\n"
        "gone.c,sum,all = all / 7.0f;,all = all * 7.0f;,nobody reads it\n"
    )
    assert [entry.line for entry in survivors.strangers(survivors.read(listed), tmp_path)] == [3, 4]


def test_a_survivor_without_a_reason_is_refused(tmp_path: Path) -> None:
    listed = tmp_path / "survivors.csv"
    listed.write_text(",".join(survivors.COLUMNS) + "\nsum.c,sum,a + b;,a - b;,\n")
    with pytest.raises(LogError, match="reason"):
        survivors.read(listed)
