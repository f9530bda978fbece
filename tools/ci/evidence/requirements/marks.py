"""Joins promises and tests by marks; tests/README.md ("Marks") describes how to add one.

A promise in a header or page has a mark after its sentence, [A12]. A named item is its own mark: a function, an
enumerator, a constant, a field and a setting of a public header, an equation of a source, (R10), a source file. The
test that would fail starts its comment with that mark, /* [A12, GOE_ABEAM, (R7)] ... */, or names it in its code.
"""

from __future__ import annotations

import ast
import csv
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from goe_tools.places import PUBLIC_HEADERS, ROOT

HEADERS = {  # public headers, and the list of the settings that one has
    **{f"lib/{name}": "" for name in PUBLIC_HEADERS},
    "lib/goe.h": "lib/goe_settings_list.h",
    "port/flight/goe_flight.h": "port/flight/goe_flight_settings_list.h",
}
PAGES = ("README.md", "lib/DESIGN.md", "lib/window/README.md", "lib/refined/README.md")
GUARDS = {Path(name).name.upper().replace(".", "_") for name in HEADERS}
NOT_OF_THE_INTERFACE = {*GUARDS, "GOE_NODISCARD"}
STRUCTURE = re.compile(r"typedef struct \{(.*?)\} (goe_\w+);", re.DOTALL)
SETTINGS = re.compile(r"goe_(camera|navigation|detector|((window|filter|flight)_)?settings)_t")  # named by path
SUFFIXES = (".c", ".cpp", ".py", ".sh", ".cmake", "CMakeLists.txt")
MARK = re.compile(r"\[([A-Z]\d+)\]")
MARKS_OF_TEST = re.compile(r"(?:/\*|#)?\s*\[([^\]]*)\]")
HEAD = re.compile(r"^(?:/\*|#| \*)?\s*tests: (\w[\w/.]*(?:, \w[\w/.]*)*)", re.MULTILINE)
HEAD_LENGTH = 1500
EQUATION = re.compile(r"\((?:R[1-9]\d?|[1-8])\)")
SPAN = re.compile(r"\((R?)([1-9]\d?)\) to \(R?([1-9]\d?)\)")


@dataclass(frozen=True)
class Promise:
    key: str  # A12, goe_update, goe_pose_t.height_m, camera.k1, (R10), goe_status.c
    place: str  # file:line
    words: frozenset[str] = frozenset()  # any of them in a test's code refers to it
    text: str = ""


@dataclass(frozen=True)
class Test:
    name: str  # tests/c/x.c:function, tests/python/x.py::test_function; file:line in scripts
    place: str
    marks: tuple[str, ...]  # in its comment, and the sources in the file's head, which it tests from inside
    words: frozenset[str] = frozenset()  # in its code: words, a.b and .b


@dataclass
class Findings:
    promises: list[Promise]
    tests: list[Test]
    by_key: dict[str, list[Test]]
    orphans: list[str]


@cache
def read(path: Path) -> str:
    return path.read_text(encoding="utf-8")


@cache
def without_comments(path: Path) -> str:
    """Every line keeps its number."""
    return re.sub(r"/\*.*?\*/", lambda match: " " + "\n" * match[0].count("\n"), read(path), flags=re.DOTALL)


def line_of(text: str, at: int) -> int:
    return text.count("\n", 0, at) + 1


# -------------------------------------------------------------------------------------------------------- the promises


def marks_in(root: Path) -> Iterator[Promise]:
    for name in (*HEADERS, *PAGES):
        text = read(root / name) if (root / name).is_file() else ""
        for match in MARK.finditer(text):
            before = re.sub(r"^[/ *]+|<!--", "", text[max(0, match.start() - 400) : match.start()], flags=re.MULTILINE)
            sentence = re.split(r"(?<=[.\]]) (?=[A-Z])", " ".join(before.split()))[-1]
            yield Promise(match[1], f"{name}:{line_of(text, match.start())}", frozenset(), sentence)


def fields_of(body: str) -> Iterator[str]:
    for line in re.sub(r"^\s*#.*$", "", body, flags=re.MULTILINE).split(";"):
        yield from re.findall(r"(\w+)\s*(?:,|$)", re.sub(r"\[[^\]]*\]", "", line).strip())


def times_of_fields(name: str, root: Path) -> Counter[str]:
    """How many structures of a header, and of those next to it, have a field."""
    texts = [without_comments(root / each) for each in HEADERS if (root / each).is_file() and same_folder(each, name)]
    structures = [body for text in texts for body, _ in STRUCTURE.findall(text)]
    return Counter(each for body in structures for each in fields_of(body))


def same_folder(one: str, other: str) -> bool:
    return Path(one).parent == Path(other).parent


def fields_in(name: str, text: str, public: str, shared: Counter[str]) -> Iterator[Promise]:
    """Fields of public structures; if several structures have a field, the code must name its owner: pose.height_m."""
    for match in STRUCTURE.finditer(text):
        private = "{ /* goe_" in public.splitlines()[line_of(text, match.start()) - 1] or match[2] == "goe_flight_t"
        for each in () if SETTINGS.fullmatch(match[2]) or private else fields_of(match[1]):
            owner = match[2][: -len("_t")].rpartition("_")[2]
            words = {f"{owner}.{each}"} if shared[each] > 1 else {f".{each}"}
            at = re.search(rf"\b{each}\b", match[1])
            line = line_of(text, match.start(1) + (at.start() if at else 0))
            yield Promise(f"{match[2]}.{each}", f"{name}:{line}", frozenset(words))


def names_in(name: str, listed: str, root: Path) -> Iterator[Promise]:
    """Functions, enumerators, constants, fields and settings of a header."""
    text = without_comments(root / name)
    found = [(match[1], match.start(1)) for match in re.finditer(r"^\w[\w *]*?\b(goe_\w+)\(", text, re.MULTILINE)]
    for body in re.finditer(r"\benum\s*\{(.*?)\}", text, re.DOTALL):
        plain = re.sub(r"=[^,}]*", lambda match: " " * len(match[0]), body[1])
        found += [(match[0], body.start(1) + match.start()) for match in re.finditer(r"\bGOE_\w+", plain)]
    found += [(match[1], match.start(1)) for match in re.finditer(r"^# *define (GOE_\w+)", text, re.MULTILINE)]
    for key, at in dict(found).items():
        if key not in NOT_OF_THE_INTERFACE:
            yield Promise(key, f"{name}:{line_of(text, at)}", frozenset({key}))
    yield from fields_in(name, text, read(root / name), times_of_fields(name, root))
    table = without_comments(root / listed) if (root / listed).is_file() else ""
    for match in re.finditer(r"\b(?:X|GOE_FLIGHT_SETTING)\(([\w.]+)(\[0\])?, ", table):
        place, key = f"{listed}:{line_of(table, match.start())}", match[1]
        if "flight" in listed:
            yield Promise(f"flight.{key}", place, frozenset({f".{key}"}))
        else:
            yield Promise(key, place, frozenset({key} if "." in key else {f"settings.{key}", f'"{key}"'}))


def equations_in(text: str) -> set[str]:
    """(7), (R19); for (R33) to (R36) all four."""
    spans = [f"({kind}{number})" for kind, low, high in SPAN.findall(text) for number in range(int(low), int(high) + 1)]
    return {*EQUATION.findall(text), *spans}


def of_sources(root: Path) -> Iterator[Promise]:
    """Sources, and the equations that they and their theory name."""
    equations: dict[str, Promise] = {}
    files = [*(root / "lib").rglob("*.[ch]"), *(root / "lib").glob("*/README.md")]
    for path in sorted(files, key=lambda path: (path.suffix != ".c", path)):
        name = path.relative_to(root).as_posix()
        if path.suffix == ".c":
            yield Promise(path.name, f"{name}:1")
        for number, line in enumerate(read(path).splitlines(), 1):
            for key in equations_in(line) - set(equations):
                equations[key] = Promise(key, f"{name}:{number}")
    yield from equations.values()


def promises(root: Path = ROOT) -> list[Promise]:
    headers = [header for header in HEADERS if (root / header).is_file()]
    named = [each for header in headers for each in names_in(header, HEADERS[header], root)]
    return [*marks_in(root), *named, *of_sources(root)]


# ----------------------------------------------------------------------------------------------------------- the tests


def marks_of(comment: str) -> tuple[str, ...]:
    match = MARKS_OF_TEST.match(comment)
    return tuple(word.strip(" *\n") for word in match[1].split(",")) if match else ()


def words_of(code: str) -> frozenset[str]:
    """The words of a test's code: "words", and from a.b, a->b and a[i].b also "a.b" and ".b"."""
    code = re.sub(r"/\*.*?\*/|//[^\n]*", " ", code, flags=re.DOTALL).replace("->", ".")
    pairs = re.findall(r"(\w+)(?:\[[^\]]*\])?\.(?=(\w+))", code)
    single = re.findall(r'\w+|"\w+"|\.\w+', code) + re.findall(r"\w+", code)
    return frozenset((*single, *re.findall(r"\.\w+", code), *(f"{left}.{right}" for left, right in pairs)))


@dataclass(frozen=True)
class Chunk:
    """A definition at the left edge of a C file, with the comment directly above it."""

    line: int
    comment: str
    code: str
    is_function: bool


@cache
def chunks(path: Path) -> dict[str, Chunk]:
    """Chunks by name; a definition ends with the first closing line at the left edge."""
    found: dict[str, Chunk] = {}
    lines, at, comment = read(path).splitlines(), 0, ""
    while at < len(lines):
        begin = at
        if lines[at].startswith("/*"):
            while "*/" not in lines[at] and at + 1 < len(lines):
                at += 1
            comment = "\n".join(lines[begin : at + 1])
        elif lines[at].startswith("#"):
            while lines[at].endswith("\\"):
                at += 1
        elif re.match(r"\w", lines[at]) and not re.match(r'extern "C" \{$|namespace\b', lines[at]):
            whole = re.search(r"[;}]$|;\s*/[*/]", lines[at])
            while not whole and at + 1 < len(lines) and not lines[at].startswith("}"):
                at += 1
        code = "\n".join(lines[begin : at + 1])
        name = None if code.startswith("/*") else re.search(r"^# *define (\w+)|(\w+)\(|(\w+)(?:\[[^\]]*\])* =", code)
        if name:
            found[name[1] or name[2] or name[3]] = Chunk(begin + 1, comment, code, bool(name[2]))
        comment = comment if code.startswith("/*") else ""
        at += 1
    return found


def code_of(test: str, others: dict[str, Chunk]) -> str:
    """The code of a test, and of the tables and macros that it or its helpers name."""
    known, todo, code = {test}, [test], others[test].code
    while todo:
        new = set(re.findall(r"\w+", others[todo.pop()].code)) & set(others) - known
        known |= new
        todo += new
        code += "\n".join(["", *(others[name].code for name in sorted(new) if not others[name].is_function)])
    return code


def c_tests(path: Path, name: str, inside: tuple[str, ...]) -> Iterator[Test]:
    others = chunks(path)
    for test in dict.fromkeys(re.findall(r"\bRUN_TEST\((\w+)\)", without_comments(path))):
        if test in others:
            marks = (*marks_of(others[test].comment), *inside)
            yield Test(f"{name}:{test}", f"{name}:{others[test].line}", marks, words_of(code_of(test, others)))


def python_tests(path: Path, name: str, inside: tuple[str, ...]) -> Iterator[Test]:
    for node in ast.parse(read(path)).body:
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
            marks = (*marks_of(ast.get_docstring(node) or ""), *inside)
            yield Test(f"{name}::{node.name}", f"{name}:{node.lineno}", marks)


def script_tests(path: Path, name: str) -> Iterator[Test]:
    for number, line in enumerate(read(path).splitlines(), 1):
        if re.match(r"\s*# \[[A-Za-z(]", line):
            yield Test(f"{name}:{number}", f"{name}:{number}", marks_of(line.strip()))


def tests(root: Path = ROOT) -> list[Test]:
    found: list[Test] = []
    for path in sorted((root / "tests").rglob("*")):
        if not path.name.endswith(SUFFIXES) or "golden" in path.parts:
            continue
        name = path.relative_to(root).as_posix()
        head = HEAD.search(read(path)[:HEAD_LENGTH])
        inside = tuple(Path(source).name for source in head[1].split(", ") if source.startswith("lib/")) if head else ()
        if path.suffix in (".c", ".cpp"):
            found += c_tests(path, name, inside)
        elif path.suffix == ".py":
            found += python_tests(path, name, inside)
        else:
            found += script_tests(path, name)
    return found


# ---------------------------------------------------------------------------------------------------------- both sides


def joined(root: Path = ROOT) -> Findings:
    """The tests of each promise, and orphans on both sides."""
    found = Findings(promises(root), tests(root), {}, [])
    known: dict[str, Promise] = {}
    keys_of: dict[str, list[str]] = {}  # of a word
    for promise in found.promises:
        if promise.key in known:
            found.orphans.append(f"{promise.place}: [{promise.key}] is also at {known[promise.key].place}")
        known[promise.key] = promise
        for word in promise.words:
            keys_of.setdefault(word, []).append(promise.key)
    found.by_key = {key: [] for key in known}
    for test in found.tests:
        named = {key for word in test.words & keys_of.keys() for key in keys_of[word]}
        for mark in dict.fromkeys((*test.marks, *sorted(named))):
            if mark in known:
                found.by_key[mark].append(test)
            else:
                found.orphans.append(f"{test.place}: [{mark}] is the mark of no promise, name, equation or source")
        if test.name.startswith("tests/c/") and not test.marks and not named:
            found.orphans.append(f"{test.place}: {test.name.rpartition(':')[2]} has neither mark nor name of a promise")
    for key, promise in known.items():
        if not found.by_key[key]:
            found.orphans.append(f"{promise.place}: {key}: no test has this mark or name")
    return found


def write_table(found: Findings, path: Path) -> None:
    """For reviewers: each promise, its place, and its tests."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("mark", "place", "promise", "tests"))
        for each in found.promises:
            rows.writerow((each.key, each.place, each.text, "; ".join(test.name for test in found.by_key[each.key])))
