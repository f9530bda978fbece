"""Requirements: the tables of the tree, and that what is missing in a small one is told."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from ci.__main__ import main
from ci.evidence.parts import Amount
from ci.evidence.record import Row
from ci.evidence.requirements import breaks, check, names, part, rows, sentences
from goe_tools.logs.obslog import LogError

ROOT = Path(__file__).resolve().parents[2]

# ------------------------------------------------------------------------------------------------------------- the tree


def test_every_promise_has_code_and_tests_and_every_test_its_promise() -> None:
    found = check.findings()
    assert not found.all, "\n".join(["", *found.all])
    assert found.sentences > 300 and found.tests > 300


def test_the_part_tells_it() -> None:
    result = part.run(Amount())
    assert [row.met for row in result.rows] == [None, True, True, True, True]


@pytest.mark.parametrize("how", ["--quick", "--long", "--show"])
def test_the_command(
    how: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without breaking anything: that takes minutes."""
    monkeypatch.setattr(part, "rows_of_breaks", lambda _: ([Row("lines broken", "1 of 1", "all", True)], ["one"]))
    record = tmp_path / "new" / "record.json"
    assert main(["evidence", how, "--only", "requirements", "--record", str(record)]) == 0
    assert record.exists() == (how == "--long")
    assert ("| requirements |" in capsys.readouterr().out) == (how != "--show")


def test_the_script(tmp_path: Path) -> None:
    if not (ROOT / ".venv" / "installed").exists():
        pytest.skip("tools/setup.sh has not run")
    command = [ROOT / "tools" / "evidence.sh", "--show", "--record", tmp_path / "none.json"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("| part | what |")


def test_a_break_of_each_room_is_tried() -> None:
    files = {broken.file for broken in rows.breaks()}
    assert len(rows.breaks()) >= 60
    for room in ("image", "window", "refined", "hazard", "maths"):
        assert any(file.startswith(f"lib/{room}/") for file in files), room


# -------------------------------------------------------------------------------------------------------- a small tree

HEADER = """/* Counts.
 *
 * A count never falls. It begins at 0.
 */
enum { GOE_LIMIT = 3 };
typedef struct {
    int now;  /* the count */
    float x, y; /* where */
} goe_count_t;
int goe_count(goe_count_t *count);
"""
CODE = """int goe_count(goe_count_t *count) { return count->now++; } /* (R2) */
"""
TEST = """static void it_grows(void) {}
int main(void) { RUN_TEST(it_grows); }
"""
NAMES = "goe_count; GOE_LIMIT; goe_count_t.now; goe_count_t.x; goe_count_t.y; (R2)"
CODE_ANCHOR, TEST_NAME = "lib/goe_count.c:goe_count", "tests/c/test_count.c:it_grows"


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name, text in {"lib/goe.h": HEADER, "lib/goe_settings_list.h": "", "lib/goe_count.c": CODE,
                       "tests/c/test_count.c": TEST}.items():  # fmt: skip
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    folder = tmp_path / "tests" / "requirements"
    folder.mkdir()
    for name in rows.KINDS:
        (folder / f"{name}.csv").write_text(",".join(rows.COLUMNS) + "\n")
    (folder / rows.NO_PROMISE).write_text("source,anchor,why\nlib/goe.h,Counts,a heading\nlib/goe.h,where,explains\n")
    (folder / rows.BREAKS).write_text(",".join(rows.BREAK_COLUMNS) + "\n")
    write(tmp_path)
    return tmp_path


def write(tree: Path, **changed: str) -> None:
    row = dict(zip(rows.COLUMNS, ("GOE-API-001", "lib/goe.h", "A count never falls", NAMES, "Counts grow", CODE_ANCHOR,
                                  TEST_NAME, "")))  # fmt: skip
    second = {**row, "id": "GOE-API-002", "anchor": "It begins at 0", "names": ""}
    third = {**row, "id": "GOE-API-003", "anchor": "int now; the\ncount", "names": ""}
    lines = [",".join(f'"{cell}"' for cell in each.values()) for each in ({**row, **changed}, second, third)]
    (tree / "tests" / "requirements" / "api.csv").write_text("\n".join([",".join(rows.COLUMNS), *lines, ""]))


def told(tree: Path) -> list[str]:
    for cached in (names.read, names.without_comments, names.unity_tests, names.python_tests, names.told_to_ctest,
                   sentences.text_of):  # fmt: skip
        cached.cache_clear()
    return check.findings(tree / "tests" / "requirements", tree).all


def test_a_whole_tree_is_left_alone(tree: Path) -> None:
    assert told(tree) == []


@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("id", "GOE-STA-001", "must be GOE-API- and three digits"),
        ("id", "GOE-API-002", "the number is that of"),
        ("anchor", "A count never rises", "does not say"),
        ("source", "lib/none.h", "there is no source"),
        ("names", f"{NAMES}; GOE_NONE", "the interface has no GOE_NONE"),
        ("names", NAMES.replace("; GOE_LIMIT", ""), "GOE_LIMIT: no requirement names it"),
        ("names", NAMES.replace("; goe_count_t.y", ""), "goe_count_t.y: no requirement names it"),
        ("names", NAMES.replace("; (R2)", ""), "(R2): no requirement names it"),
        ("text", "", "no text"),
        ("code", "", "no code"),
        ("code", "lib/goe_count.c:goe_other", "has no goe_other"),
        ("code", "lib/goe_other.c:goe_count", "there is no file"),
        ("code", "lib/goe_count.c", "name the function"),
        ("tests", "", "name the tests"),
        ("tests", "tests/c/test_count.c:it_falls", "there is no tests/c/test_count.c:it_falls"),
        ("tests", "tests/c/test_count.c", "name the test"),
        ("tests", "ctest:count", "there is no ctest:count"),
        ("open", "nobody knows", "name the tests"),
    ],
)
def test_a_bad_row_is_told(tree: Path, column: str, value: str, words: str) -> None:
    write(tree, **{column: value})
    assert any(words in line for line in told(tree)), told(tree)


def test_what_is_new_and_in_no_row_is_told(tree: Path) -> None:
    (tree / "lib" / "goe_new.c").write_text("/* (R7) */\n")
    (tree / "lib" / "goe.h").write_text(HEADER.replace("It begins at 0.", "It begins at 0. It ends at 3."))
    (tree / "tests" / "c" / "test_count.c").write_text(TEST + "RUN_TEST(it_ends);\n")
    lines = "\n".join(told(tree))
    assert "lib/goe_new.c: no requirement names it" in lines and "(R7): no requirement names it" in lines
    assert "in this sentence: It ends at 3." in lines
    assert "it_ends belongs to no requirement: name it as tests/c/test_count.c:it_ends" in lines


def test_columns_are_checked(tree: Path) -> None:
    (tree / "tests" / "requirements" / "api.csv").write_text("id,text\n")
    with pytest.raises(LogError, match="columns"):
        told(tree)


def test_sentences_of_comments() -> None:
    text = sentences.text_of_code("/* One. Two goes\n * on. */ int a; /* -------- title -- */ /* three, 3.5 m */")
    assert [sentence.text for sentence in text.sentences] == ["One.", "Two goes on.", "three, 3.5 m"]
    assert all(text.plain[s.begin : s.end] == s.text for s in text.sentences)


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
def test_a_broken_line_is_noticed_or_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, text in {"lib/add.c": BROKEN_CODE, "tests/c/test_add.c": BROKEN_TEST, "unity/unity.c": "int bad;\n",
                       "unity/unity.h": UNITY_H}.items():  # fmt: skip
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(breaks, "ROOT", tmp_path)
    monkeypatch.setenv("UNITY_DIR", str(tmp_path / "unity"))
    test = "tests/c/test_add.c:two_and_two"
    tried = [rows.Break("", "lib/add.c", "a + b", new, test, 2) for new in ("a - b", "b + a", "a +", "*(int *)0")]
    outcomes, failing = breaks.try_all(tried, 2)
    assert failing == []
    assert [outcome.noticed for outcome in outcomes] == [True, False, False, True]
    assert "does not compile" in outcomes[2].told
    _, failing = breaks.try_all([rows.Break("", "lib/add.c", "a + b", "a - b", f"{test}_twice", 2)], 1)
    assert failing == [f"{test}_twice"]
