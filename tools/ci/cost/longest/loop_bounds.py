"""The table of facts that are not in the machine code: bounds of loops and exclusions, each with its reason.

tests/targets/loop_bounds.csv, columns:

kind      loop, size, most or case
function  loop: the source function with the line; size: the called function; most, case: the public calls,
          separated by "; ", or all
line      loop: text of the loop's line (of the second with the same text in its file with " #2"), or
          #1, #2 ... for a function without lines, in the order of their addresses; size: text of the calling line;
          most, case: calls "caller > callee", or "3 caller > callee" with each counted three times, separated by
          |; the caller may be "any", and "=caller" leaves out calls by functions inlined in it
when      loop: texts of lines by which the function, or one of its callers, was called, all of them, separated by " &
          "; among several lines of the table only those with the most texts apply; empty: any
most      an expression of integers, of the library's constants and, for a size, of ``size`` and
          ``over4``, ``over16``, ``over64``: its remainders by multiples of 4 ...
per       loop: turns per "entry" of the loop; "outer", "outer2": in total per entry of the loop around it, or around
          that one; "call": in total per call of the function; "all": in total per public call; "> f": in total per
          call of f by any caller
why       the reason

A case adds nothing to the statements: it lets the proof examine mutually exclusive calls one after the
other, each alone and once, and none of them.

A loop whose line counts from one constant to another needs no line in the table: counted().
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
    """Integers, names, + - * // and parentheses."""

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
        raise LedgerError(f"{TABLE.name}: {expression}: not an expression") from None


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
    """Names and values of the macros with a number, and of the enumerations."""
    for name, value in re.findall(r"^#define (\w+) (.+)$", without_comments(text), re.MULTILINE):
        yield name, re.sub(r"\b(\d+)[uU]\b", r"\1", value.strip()).replace("/", "//")
    yield from enumerated(text)


def constants_of(headers: str, sources: Iterable[str]) -> dict[str, int]:
    """Integers that the headers, as preprocessed by the compiler (-E -dD), and the sources define. Constants with
    different values in two sources are left out."""
    found = dict(defined(headers))
    other: dict[str, set[str]] = {}
    for text in sources:
        for name, value in defined(text):
            other.setdefault(name, set()).add(value)
    found |= {name: min(values) for name, values in other.items() if len(values) == 1 and name not in found}
    known: dict[str, int] = {}
    for _ in range(8):  # depth of definitions by other definitions
        for name, value in found.items():
            try:
                known.setdefault(name, value_of(value, known))
            except LedgerError:
                continue
    return known


COUNTS_UP = re.compile(r"for \([\w ]+? (\w+) = (.+?); \1 (<=?) (.+?); \1(?:\+\+| \+= (\d+))\) \{?$")
COUNTS_DOWN = re.compile(r"for \([\w ]+? (\w+) = (.+?); \1-- > (.+?);\) \{?$")


def counted(line: str, names: Mapping[str, int]) -> int | None:
    """The turns of a loop whose line counts from one constant to another; None for another line."""
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
            raise LedgerError(f"{path}: line {number}: unknown kind, or no reason")
        rows.append(row)
    return rows
