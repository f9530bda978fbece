"""Both directions: from each requirement to code and tests that exist, and from all that exists to a requirement."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from goe_tools.places import ROOT

from . import names, rows, sentences
from .rows import KINDS, OF_INSIDES, Break, NoPromise, Requirement

UNIT_TESTS = "tests/c"
BOUND = (names.HEADER,)  # sources of which every sentence is a promise or said to be none
HOW = "tests/requirements.md says how"


@dataclass
class Findings:
    """What is wrong, one line each, by the direction in which it was found."""

    rows: list[str] = field(default_factory=list)  # a row whose code, test, anchor or name is not there
    orphans: list[str] = field(default_factory=list)  # what is there and in no row
    sentences: int = 0  # of the bound sources
    tests: int = 0  # unit tests that had to be in a row

    @property
    def all(self) -> list[str]:
        return [*self.rows, *self.orphans]


# ------------------------------------------------------------------------------------------- from the rows to the tree


def bad_code(requirement: Requirement, root: Path) -> Iterator[str]:
    for code in requirement.code:
        file, _, function = code.partition(":")
        if not (root / file).is_file():
            yield f"{requirement.place}: code: there is no file {file}"
        elif function and not names.defines(root / file, function):
            yield f"{requirement.place}: code: {file} has no {function}"
        elif not function and (root / file).suffix in (".c", ".h") and requirement.table != OF_INSIDES:
            yield f"{requirement.place}: code: {file}: name the function"


def bad_tests(requirement: Requirement, root: Path) -> Iterator[str]:
    for test in requirement.tests:
        if not names.is_test(test, root):
            yield f"{requirement.place}: tests: there is no {test}"
        elif test.endswith((".c", ".py")) and requirement.table != OF_INSIDES:
            yield f"{requirement.place}: tests: {test}: name the test"


def bad_row(requirement: Requirement, known: set[str], root: Path) -> Iterator[str]:
    place = requirement.place
    if not re.fullmatch(rf"{KINDS[requirement.table]}-\d{{3}}", requirement.id):
        yield f"{place}: the number must be {KINDS[requirement.table]}- and three digits"
    if not requirement.text:
        yield f"{place}: no text"
    if not requirement.code:
        yield f"{place}: no code"
    if bool(requirement.tests) == bool(requirement.open):
        yield f"{place}: name the tests that would fail without it, or say under open why there is none"
    if not (root / requirement.source).is_file():
        yield f"{place}: there is no source {requirement.source}"
    elif not sentences.found_at(requirement.anchor, requirement.source, root):
        yield (
            f'{place}: {requirement.source} does not say "{requirement.anchor}" any more: has the promise changed? '
            "Then change the row, its code and its tests"
        )
    for name in requirement.names:
        if name not in known:
            yield f"{place}: names: the interface has no {name}"


def bad_ids(requirements: Iterable[Requirement]) -> Iterator[str]:
    seen: dict[str, Requirement] = {}
    for requirement in requirements:
        if requirement.id in seen:
            yield f"{requirement.place}: the number is that of {seen[requirement.id].place}"
        seen[requirement.id] = requirement


def bad_breaks(breaks: Iterable[Break], requirements: Iterable[Requirement], root: Path) -> Iterator[str]:
    by_id = {requirement.id: requirement for requirement in requirements}
    for broken in breaks:
        place = f"tests/requirements/{rows.BREAKS}:{broken.line} ({broken.id})"
        if broken.id not in by_id:
            yield f"{place}: there is no such requirement"
        elif broken.test not in by_id[broken.id].tests:
            yield f"{place}: {broken.test} is no test of that requirement"
        if not (root / broken.file).is_file() or names.read(root / broken.file).count(broken.old) != 1:
            yield f"{place}: {broken.file} must have these words once: {broken.old}"


def bad_exceptions(exceptions: Iterable[NoPromise], root: Path) -> Iterator[str]:
    for exception in exceptions:
        if not sentences.found_at(exception.anchor, exception.source, root):
            yield (
                f"tests/requirements/{rows.NO_PROMISE}:{exception.line}: "
                f'{exception.source} does not say "{exception.anchor}" any more'
            )


# ------------------------------------------------------------------------------------------- from the tree to the rows


def names_without_row(requirements: Iterable[Requirement], known: set[str]) -> Iterator[str]:
    named = {name for requirement in requirements for name in requirement.names}
    for name in sorted(known - named):
        yield f"{name}: no requirement names it: add a row, or its name to one ({HOW})"


def code_without_row(requirements: Iterable[Requirement], root: Path) -> Iterator[str]:
    named = {code.partition(":")[0] for requirement in requirements for code in requirement.code}
    for path in sorted((root / "lib").rglob("*.c")):
        name = str(path.relative_to(root))
        if name not in named:
            yield f"{name}: no requirement names it as its code: what is it for? ({HOW})"


def tests_without_row(requirements: Iterable[Requirement], root: Path, findings: Findings) -> Iterator[str]:
    named = {test for requirement in requirements for test in requirement.tests}
    for path in sorted((root / UNIT_TESTS).glob("test_*.c")):
        file = str(path.relative_to(root))
        tests = names.unity_tests(path)
        findings.tests += len(tests)
        for test in tests if file not in named else ():
            if f"{file}:{test}" not in named:
                yield (
                    f"{file}: {test} belongs to no requirement: name it as {file}:{test} in the row "
                    "of what it checks, or the whole file, if it checks the inside of a part, in "
                    f"tests/requirements/{OF_INSIDES}.csv ({HOW})"
                )


def sentences_without_row(
    requirements: Iterable[Requirement], exceptions: Iterable[NoPromise], root: Path, findings: Findings
) -> Iterator[str]:
    """Of the bound sources: a sentence in which no anchor lies."""
    for source in BOUND:
        anchors = [entry.anchor for entry in (*requirements, *exceptions) if entry.source == source]
        spans = [span for anchor in anchors for span in sentences.found_at(anchor, source, root)]
        for sentence in sentences.text_of(root / source).sentences:
            findings.sentences += 1
            if not any(begin < sentence.end and end > sentence.begin for begin, end in spans):
                yield (
                    f"{source}:{sentence.line}: no requirement has its anchor in this sentence: {sentence.text} "
                    f"(if it promises nothing: tests/requirements/{rows.NO_PROMISE})"
                )


# ----------------------------------------------------------------------------------------------------------- all of it


def findings(folder: Path = rows.FOLDER, root: Path = ROOT) -> Findings:
    requirements, exceptions = rows.requirements(folder), rows.without_promise(folder)
    known = names.public_names(root) | set(names.equations(root))
    found = Findings()
    found.rows += bad_ids(requirements)
    for requirement in requirements:
        found.rows += bad_row(requirement, known, root)
        found.rows += bad_code(requirement, root)
        found.rows += bad_tests(requirement, root)
    found.rows += bad_breaks(rows.breaks(folder), requirements, root)
    found.rows += bad_exceptions(exceptions, root)
    found.orphans += names_without_row(requirements, known)
    found.orphans += code_without_row(requirements, root)
    found.orphans += tests_without_row(requirements, root, found)
    found.orphans += sentences_without_row(requirements, exceptions, root, found)
    return found
