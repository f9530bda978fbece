"""Selection of the tests that a change affects (ci.affected)."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from ci import affected

ROOT = Path(__file__).resolve().parents[2]


def test_a_changed_test_affects_itself_alone() -> None:
    assert affected.affected({"tests/python/test_affected.py"}) == ["tests/python/test_affected.py"]


def test_a_module_affects_those_that_import_it_directly_or_through_one_other() -> None:
    found = affected.affected({"tools/ci/affected.py"})
    assert found == ["tests/python/test_affected.py"]
    direct = affected.affected({"tools/goe_tools/logs/table.py"})
    importers = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "tests/python").glob("test_*.py")
        if "from goe_tools.logs.table import" in path.read_text(encoding="utf-8")
    }
    assert importers and importers <= set(direct)


def test_a_named_file_and_the_library_affect_their_tests() -> None:
    assert "tests/python/test_affected.py" in affected.affected({"any/named_here.csv"})
    assert set(affected.LIBRARY_TESTS) <= set(affected.affected({"lib/refined/goe_refined.c"}))
    assert affected.affected({"nothing_names_this.xyz"[::-1]}) == []


def test_a_page_affects_its_own_tests_and_those_of_all_pages() -> None:
    found = affected.affected({"README.md", "tests/python/test_words.py"})
    assert found[0] == "tests/python/test_words.py"
    assert {*affected.PAGE_TESTS, "tests/python/test_view_command.py"} <= set(found)
    assert "tests/python/test_lies.py" not in found


def test_after_its_time_a_quick_run_begins_no_test() -> None:
    one = f"{Path(__file__)}::{test_a_changed_test_affects_itself_alone.__name__}"
    words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", one]
    for end_s, outcome in (("1", "1 skipped"), ("1e12", "1 passed")):
        done = subprocess.run(
            words, cwd=ROOT / "tests", capture_output=True, text=True, env={**os.environ, "GOE_TESTS_END": end_s}
        )
        assert outcome in done.stdout


def test_changes_are_those_of_commits_work_tree_and_new_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def git(*arguments: str) -> None:
        identity = ("-c", "user.name=a", "-c", "user.email=a@b")
        subprocess.run(["git", *identity, *arguments], cwd=tmp_path, check=True, capture_output=True)

    git("init", "-b", "main")
    for name in ("one", "two"):
        (tmp_path / name).write_text(name)
    git("add", ".")
    git("commit", "-m", "Begin")
    git("checkout", "-b", "work")
    (tmp_path / "one").write_text("changed")
    git("commit", "-am", "Change one")
    (tmp_path / "two").write_text("changed")
    (tmp_path / "three").write_text("new")
    monkeypatch.setattr(affected, "ROOT", tmp_path)
    monkeypatch.delenv("GOE_SINCE", raising=False)
    assert affected.changed() == {"one", "two", "three"}
    monkeypatch.setenv("GOE_SINCE", "HEAD")
    assert affected.changed() == {"two", "three"}
