"""The table of what the machine code does not tell: how often loops run, and what excludes what, each with its reason.

tests/targets/loop_bounds.csv, columns:

kind      loop, size, most or case
function  loop: of the source that holds the line; size: that is called; most, case: the public calls,
          separated by "; ", or all
line      loop: text of the line that the loop stands in (of the second that reads alike in its file with " #2"), or
          #1, #2 ... of a function without lines, in the order of their addresses; size: text of the line that calls;
          most, case: calls "caller > callee", or "3 caller > callee" of which each counts three times, separated by
          |; the caller may be "any", and "=caller" leaves out calls by functions that were put into its place
when      loop: texts of lines by which the function, or one that called it, was called, all of them, separated by " &
          "; of several lines of the table those with the most texts count, and they alone; empty: any
most      an expression of whole numbers, of the library's constants and, for what a size bounds, of ``size`` and
          ``over4``, ``over16``, ``over64``: what is left of it by whole times 4 ...
per       loop: turns per "entry" of the loop; "outer", "outer2": in all per entry of the loop around it, or around
          that one; "call": in all per call of the function; "all": in all per public call; "> f": in all per call of
          f, whoever calls it
why       the reason

A case changes nothing that the statements say: it lets the proof look at what excludes each other one after the
other, each of its calls alone and once, and none of them.

A loop whose line counts from one constant to another needs no line of the table: counted().
"""

from __future__ import annotations

import ast
import csv
import operator
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from bench.running import ROOT, LedgerError

TABLE = ROOT / "tests" / "targets" / "loop_bounds.csv"
HEAD = ["kind", "function", "line", "when", "most", "per", "why"]
KINDS = ("loop", "size", "most", "case")
PER = ("entry", "outer", "outer2", "call", "all")
OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.FloorDiv: operator.floordiv,
}


@dataclass(frozen=True)
class Row:
    number: int  # of the table's line
    kind: str
    function: str
    line: str
    when: str
    most: str
    per: str
    why: str

    @property
    def passes(self) -> tuple[str, ...]:
        return tuple(self.when.split(" & ")) if self.when else ()


def value_of(expression: str, names: Mapping[str, int]) -> int:
    """Whole numbers, names, + - * // and brackets."""

    def of(node: ast.expr) -> int:
        if isinstance(node, ast.Constant) and type(node.value) is int:
            return node.value
        if isinstance(node, ast.Name) and node.id in names:
            return names[node.id]
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return int(OPERATORS[type(node.op)](of(node.left), of(node.right)))
        raise LedgerError(f"{TABLE.name}: {expression}: neither a number nor a known constant")

    try:
        return of(ast.parse(expression, mode="eval").body)
    except SyntaxError:
        raise LedgerError(f"{TABLE.name}: {expression}: no expression") from None


def without_comments(text: str) -> str:
    return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def enumerated(text: str) -> Iterator[tuple[str, str]]:
    """Names and values of the enumerations of a source."""
    for body in re.findall(r"\benum(?: \w+)?\s*\{([^}]*)\}", without_comments(text)):
        value = ""
        for entry in filter(None, (part.strip() for part in body.split(","))):
            name, _, given = (word.strip() for word in entry.partition("="))
            value = given or (f"{value} + 1" if value else "0")
            yield name, value


def defined(text: str) -> Iterator[tuple[str, str]]:
    """Names and values of the macros that hold a number, and of the enumerations."""
    for name, value in re.findall(r"^#define (\w+) (.+)$", without_comments(text), re.MULTILINE):
        yield name, re.sub(r"\b(\d+)[uU]\b", r"\1", value.strip()).replace("/", "//")
    yield from enumerated(text)


def constants_of(headers: str, sources: Iterable[str]) -> dict[str, int]:
    """Whole numbers that the headers define, as the compiler's preprocessor leaves them (-E -dD), and the sources
    beside them. What two sources define differently is left out."""
    found = dict(defined(headers))
    other: dict[str, set[str]] = {}
    for text in sources:
        for name, value in defined(text):
            other.setdefault(name, set()).add(value)
    found |= {name: min(values) for name, values in other.items() if len(values) == 1 and name not in found}
    known: dict[str, int] = {}
    for _ in range(8):  # definitions by others, as deep
        for name, value in found.items():
            try:
                known.setdefault(name, value_of(value, known))
            except LedgerError:
                continue
    return known


COUNTS_UP = re.compile(r"for \([\w ]+? (\w+) = (.+?); \1 (<=?) (.+?); \1(?:\+\+| \+= (\d+))\) \{?$")
COUNTS_DOWN = re.compile(r"for \([\w ]+? (\w+) = (.+?); \1-- > (.+?);\) \{?$")


def counted(line: str, names: Mapping[str, int]) -> int | None:
    """The turns of a loop whose line counts from one constant to another; None if it is no such line."""
    line = re.sub(r" #\d+$", "", line).replace("/", "//")
    up, down = COUNTS_UP.match(line), COUNTS_DOWN.match(line)
    try:
        if up:
            _, first, compared, last, step = up.groups()
            span = value_of(last, names) - value_of(first, names) + (compared == "<=")
            return -(-span // int(step or 1))
        if down:
            return value_of(down.group(2), names) - value_of(down.group(3), names)
    except LedgerError:
        pass
    return None


def read(path: Path = TABLE) -> list[Row]:
    with path.open(encoding="utf-8", newline="") as file:
        lines = list(csv.reader(file))
    if not lines or lines[0] != HEAD:
        raise LedgerError(f"{path}: its first line is not {','.join(HEAD)}")
    rows = []
    for number, cells in enumerate(lines[1:], 2):
        if len(cells) != len(HEAD):
            raise LedgerError(f"{path}: line {number}: {len(cells)} cells, not {len(HEAD)}")
        row = Row(number, *cells)
        if row.kind not in KINDS or (row.kind == "loop" and row.per not in PER and row.per[:2] != "> ") or not row.why:
            raise LedgerError(f"{path}: line {number}: of no known kind, or without a reason")
        rows.append(row)
    return rows
