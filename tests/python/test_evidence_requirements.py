"""Requirements: marks and names of the tree; missing ones are reported in a small tree."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import pytest
from ci.__main__ import main
from ci.evidence.parts import Amount
from ci.evidence.record import Row
from ci.evidence.requirements import breaks, marks, part

ROOT = Path(__file__).resolve().parents[2]

# ------------------------------------------------------------------------------------------------------------- the tree


def test_every_promise_has_tests_and_every_test_its_promise() -> None:
    found = marks.joined()
    stale = list(breaks.stale(breaks.read(), found))
    assert not [*found.orphans, *stale], "\n".join(["", *found.orphans, *stale])
    assert len(found.promises) > 500 and len(found.tests) > 2000
    assert sum(bool(promise.text) for promise in found.promises) > 40


@pytest.mark.release
def test_the_part_reports_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(part, "TABLE", tmp_path / "new" / "requirements.csv")
    result = part.run(Amount())
    assert [row.met for row in result.rows] == [None, None, None, True, True]
    with part.TABLE.open(encoding="utf-8", newline="") as file:
        rows = {row["mark"]: row for row in csv.DictReader(file)}
    assert "tests/c/test_safety.c:random_bits_do_no_harm" in rows["A16"]["tests"]
    assert rows["A16"]["promise"].endswith("Every output is finite.") and rows["(R10)"]["place"].startswith("lib/")


@pytest.mark.parametrize("how", ["--quick", "--long", "--show"])
def test_the_command(
    how: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without breaking lines of code, which takes minutes."""
    monkeypatch.setattr(part, "rows_of_breaks", lambda _: ([Row("lines broken", "1 of 1", "all", True)], ["one"]))
    record = tmp_path / "new" / "record.json"
    assert main(["evidence", how, "--only", "requirements", "--record", str(record)]) == 0
    assert record.exists() == (how == "--long")
    assert ("| requirements |" in capsys.readouterr().out) == (how != "--show")


def test_a_break_of_each_folder_is_tried() -> None:
    files = {broken.file for broken in breaks.read()}
    assert len(breaks.read()) >= 60
    for folder in ("image", "window", "refined", "hazard", "maths"):
        assert any(file.startswith(f"lib/{folder}/") for file in files), folder


# -------------------------------------------------------------------------------------------------------- a small tree

HEADER = """/* Counts.
 *
 * A count never falls. [A1] It begins at 0.
 */
enum { GOE_LIMIT = 3 };
typedef struct {
    int now;  /* the count */
    float x, y; /* where */
} goe_count_t;
typedef struct {
    int now; /* another one */
} goe_second_t;
int goe_count(goe_count_t *count);
"""
LIST = "#define GOE_SETTINGS(X) X(camera.k1, REAL, 0) X(model, CHOICE, 0)\n"
CODE = """int goe_count(goe_count_t *count) { return count->now++; } /* (R2) to (R3) */
"""
TEST = """/* Counting. */
/* tests: lib/goe_count.c */
static const int limits[] = {
    GOE_LIMIT,
};
static int looked(const goe_count_t *count) { return count->now == limits[0]; }

/* [A1, (R2),
 *  (R3)] GIVEN a count THEN it grows. */
static void it_grows(void) {
    TEST_ASSERT_TRUE(goe_count(&count) && count.now && count.x < 1 && looked(&count));
    settings.camera.k1 = set("model");
}

/* [goe_count_t.y] */
static void it_stays(void) { second->now = 1; }
int main(void) { RUN_TEST(it_grows); RUN_TEST(it_stays); }
"""
SMALL = {"lib/goe.h": HEADER, "lib/goe_settings_list.h": LIST, "lib/goe_count.c": CODE, "tests/c/test_count.c": TEST}


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name, text in SMALL.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def orphans(tree: Path) -> list[str]:
    for cached in (marks.read, marks.without_comments, marks.chunks):
        cached.cache_clear()
    return marks.joined(tree).orphans


def change(tree: Path, name: str, old: str, new: str) -> None:
    text = (tree / name).read_text()
    assert text.count(old) == 1
    (tree / name).write_text(text.replace(old, new))


def test_a_whole_tree_is_left_alone(tree: Path) -> None:
    assert orphans(tree) == []


@pytest.mark.parametrize(
    ("name", "old", "new", "found"),
    [
        ("lib/goe.h", "at 0.", "at 0. [A2]", "lib/goe.h:3: A2: no test has this mark or name"),
        ("lib/goe.h", "[A1]", "", "tests/c/test_count.c:10: [A1] is the mark of no promise, name, equation or source"),
        ("lib/goe.h", "at 0.", "at 0. [A1]", "lib/goe.h:3: [A1] is also at lib/goe.h:3"),
        ("lib/goe.h", "int goe_count", "int goe_new(void);\nint goe_count", "lib/goe.h:13: goe_new: no test"),
        ("lib/goe.h", " = 3 };", " = 3, GOE_LEAST };", "lib/goe.h:5: GOE_LEAST: no test"),
        ("lib/goe.h", "x, y;", "x, y, z;", "lib/goe.h:8: goe_count_t.z: no test"),
        (
            "lib/goe_settings_list.h",
            "X(model",
            "X(camera.k2, REAL) X(model",
            "goe_settings_list.h:1: camera.k2: no test",
        ),
        ("lib/goe_count.c", "(R3)", "(R4)", "lib/goe_count.c:1: (R4): no test"),
        ("tests/c/test_count.c", "/* tests: lib/goe_count.c */", "", "lib/goe_count.c:1: goe_count.c: no test"),
        (
            "tests/c/test_count.c",
            "goe_count.c */",
            "goe_none.c */",
            "count.c:10: [goe_none.c] is the mark of no promise",
        ),
        ("tests/c/test_count.c", "    GOE_LIMIT,", "    3,", "lib/goe.h:5: GOE_LIMIT: no test"),
        ("tests/c/test_count.c", "count.now", "count.new", "lib/goe.h:7: goe_count_t.now: no test"),
        ("tests/c/test_count.c", "second->now", "third->now", "lib/goe.h:11: goe_second_t.now: no test"),
        ("tests/c/test_count.c", '"model"', "0", "goe_settings_list.h:1: model: no test"),
        ("tests/c/test_count.c", "[A1,", "A1 [", "lib/goe.h:3: A1: no test"),
    ],
)
def test_an_orphan_is_reported(tree: Path, name: str, old: str, new: str, found: str) -> None:
    change(tree, name, old, new)
    assert any(found in line for line in orphans(tree)), orphans(tree)


def test_a_test_without_a_mark_is_reported(tree: Path) -> None:
    (tree / "tests/c/test_other.c").write_text("static void it_ends(void) {}\nint main(void) { RUN_TEST(it_ends); }\n")
    assert orphans(tree) == ["tests/c/test_other.c:1: it_ends has neither mark nor name of a promise"]


@pytest.mark.parametrize(
    ("name", "text", "test"),
    [
        (
            "python/test_x.py",
            'def test_one(\n    x: int\n) -> None:\n    """[A9] One."""\n',
            "python/test_x.py::test_one",
        ),
        ("x/CMakeLists.txt", "    # [A9, goe_count]\n    add_test(NAME x)\n", "x/CMakeLists.txt:1"),
        ("x.sh", "#!/bin/sh\n# [A9]\n", "x.sh:2"),
        ("x.cpp", "namespace {\n// no\n/* [A9] */\nvoid one() {\n}\n}\nRUN_TEST(one)\n", "x.cpp:one"),
    ],
)
def test_other_tests_have_marks(tree: Path, name: str, text: str, test: str) -> None:
    change(tree, "lib/goe.h", "at 0.", "at 0. [A9]")
    (tree / "tests" / name).parent.mkdir(exist_ok=True)
    (tree / "tests" / name).write_text(text)
    assert orphans(tree) == []
    assert [each.name for each in marks.joined(tree).by_key["A9"]] == [f"tests/{test}"]


def test_breaks_that_are_stale_are_reported(tree: Path) -> None:
    def stale(mark: str, old: str, test: str) -> list[str]:
        broken = breaks.Break(mark, "lib/goe_count.c", old, "", f"tests/c/test_count.c:{test}", 2)
        orphans(tree)
        return list(breaks.stale([broken], marks.joined(tree), tree))

    assert stale("A1", "count->now++", "it_grows") == []
    assert "does not have that mark" in stale("A1", "count->now++", "it_stays")[0]
    assert "does not have that mark" in stale("A2", "count->now++", "it_grows")[0]
    assert "must have these words once: count" in stale("A1", "count", "it_grows")[0]


# -------------------------------------------------------------------------------------------------------------- breaks

UNITY_H = """#include <stdio.h>
#define UNITY_BEGIN() 0
#define UNITY_END() 0
extern int bad;
#define TEST_ASSERT_TRUE(x) do { if (!(x)) bad = 1; } while (0)
#define RUN_TEST(t) do { bad = 0; t(); printf("x.c:1:" #t ":%s\\n", bad ? "FAIL: no" : "PASS"); } while (0)
"""
BROKEN_CODE = "int goe_add(int a, int b);\nint goe_add(int a, int b) { return a + b; }\n"
BROKEN_TEST = """#include <unity.h>
int goe_add(int a, int b);
static void two_and_two(void) { TEST_ASSERT_TRUE(goe_add(2, 2) == 4); }
int main(void) { RUN_TEST(two_and_two); return 0; }
"""


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler cc")
def test_a_broken_line_is_noticed_or_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, text in {"lib/add.c": BROKEN_CODE, "tests/c/test_add.c": BROKEN_TEST, "unity/unity.c": "int bad;\n",
                       "unity/unity.h": UNITY_H}.items():  # fmt: skip
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(breaks, "ROOT", tmp_path)
    monkeypatch.setenv("UNITY_DIR", str(tmp_path / "unity"))
    test = "tests/c/test_add.c:two_and_two"
    tried = [breaks.Break("", "lib/add.c", "a + b", new, test, 2) for new in ("a - b", "b + a", "a +", "*(int *)0")]
    outcomes, failing = breaks.try_all(tried, 2)
    assert failing == []
    assert [outcome.noticed for outcome in outcomes] == [True, False, False, True]
    assert "does not compile" in outcomes[2].message
    _, failing = breaks.try_all([breaks.Break("", "lib/add.c", "a + b", "a - b", f"{test}_twice", 2)], 1)
    assert failing == [f"{test}_twice"]
