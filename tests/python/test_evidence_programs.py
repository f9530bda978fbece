"""The parts programs, reproducible and sbom of the evidence: their counts on small inputs."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from ci.evidence import programs, reproducible, sbom
from ci.evidence.parts import Amount

TESTS = Path(__file__).resolve().parents[1]

RESULTS = """<testsuites><testsuite>
<testcase classname="host.test_a" name="test_one[x]" time="0.1"/>
<testcase classname="host.test_a" name="test_one[y]"><failure message="no">no</failure></testcase>
<testcase classname="python.test_b" name="test_two"><skipped message="no compiler"/></testcase>
<testcase classname="python.test_b" name="test_three"/>
</testsuite></testsuites>"""


def test_cases_are_counted() -> None:
    found = programs.read_outcomes(RESULTS)
    assert found == {
        "host/test_a.py::test_one": [True, False],
        "python/test_b.py::test_two": [False],
        "python/test_b.py::test_three": [True],
    }
    for tests, figure, met in (
        (("python/test_b.py::test_three",), "1 of 1", True),
        (("python/test_b.py::test_three", "host/test_a.py::test_one"), "2 of 3", False),
        (("python/test_b.py::test_two",), "0 of 1", False),
        (("python/test_b.py::test_that_is_gone",), "0 of 1", False),
    ):
        row = programs.row_of(programs.Finding("x", tests), found)
        assert (row.figure, row.met) == (f"fixed: {figure} cases pass", met)


def test_every_test_that_a_finding_names_is_there() -> None:
    for test in {test for finding in programs.FINDINGS for test in finding.tests}:
        file, name = test.split("::")
        assert re.search(rf"^def {name}\(", (TESTS / file).read_text(encoding="utf-8"), re.MULTILINE), test


def test_bits_that_differ_are_a_miss() -> None:
    assert reproducible.same("a", "12" * 32, "12" * 32).met is True
    row = reproducible.same("a", "12" * 32, "34" * 32)
    assert row.met is False and row.figure == "1212121212121212 and 3434343434343434"


def test_the_two_trees_lie_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both trees contain every source, links are files, and neither contains a build product."""
    monkeypatch.setattr(reproducible, "NEEDED", ("lib", "LICENSE"))
    trees = [reproducible.copied(around, tmp_path) for around in (reproducible.FIRST, reproducible.SECOND)]
    assert len({len(tree.parts) for tree in trees}) == 2
    for tree in trees:
        assert (tree / "lib" / "goe.h").is_file() and (tree / "LICENSE").is_file()
        assert not any(path.is_symlink() for path in tree.rglob("*"))
    first, second = reproducible.FIRST, reproducible.SECOND
    for what in ("folder", "build", "jobs", "umask", "environment"):
        assert getattr(first, what) != getattr(second, what)


def test_the_bill() -> None:
    rows = {row.what: row for row in sbom.run(Amount()).rows}
    assert [row.met for row in rows.values()].count(True) == 3 and False not in [row.met for row in rows.values()]
    assert rows["packages that the library contains or needs"].figure == "0"
