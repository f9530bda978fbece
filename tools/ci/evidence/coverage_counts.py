"""Coverage items of a source and whether they were reached: lines, outcomes of conditions, independent conditions.

llvm-cov counts a function of a header once for every file that includes it; here each place of a source counts once,
reached if any copy of it was.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

OUTCOMES = ("line", "true", "false", "independent")
KINDS = {"line": "lines", "true": "branches", "false": "branches", "independent": "MC/DC"}

_CONDITION_OF_DECISION = 6  # kind of a region in llvm-cov's numbering
_NO_CODE = re.compile(r"[\s{}();]*(/\*.*|\*.*|//.*|#.*|else)?[\s{}]*")  # nothing to execute; inside of a comment

_Span = tuple[int, int, int, int]  # line and column of the start, of the end


class CountError(ValueError):
    """llvm-cov's output does not have the format of version 19."""


@dataclass(frozen=True)
class Item:
    """One item that a test should reach."""

    file: str  # path in the project
    function: str
    text: str  # the line; the condition, in [ ] within its decision if that has several
    outcome: str  # one of OUTCOMES
    line: int
    reached: bool


class _Source:
    """Text of a file by lines and columns, which start at 1."""

    def __init__(self, text: str) -> None:
        self.lines = text.splitlines()

    def at(self, line: int, column: int, end_line: int, end_column: int) -> str:
        if line == end_line:
            return self.lines[line - 1][column - 1 : end_column - 1]
        first, last = self.lines[line - 1][column - 1 :], self.lines[end_line - 1][: end_column - 1]
        return "\n".join([first, *self.lines[line : end_line - 1], last])


def plain(text: str) -> str:
    """On one line, with single spaces."""
    return " ".join(text.split())


def _line_counts(segments: Sequence[Sequence[Any]]) -> dict[int, int]:
    """Executions of each line, as llvm-cov lists them: the maximum over the segments that start in it or continue."""
    by_line: dict[int, list[Sequence[Any]]] = defaultdict(list)
    for segment in segments:
        by_line[segment[0]].append(segment)
    counts: dict[int, int] = {}
    before: Sequence[Any] | None = None
    for line in range(min(by_line, default=1), max(by_line, default=0) + 1):
        here = by_line.get(line, [])
        begins = [s for s in here if s[3] and s[4] and not s[5]]  # counted, an entry, no gap
        skipped = bool(here) and not here[0][3] and here[0][4]
        going_on = before is not None and before[3]
        if any(s[3] for s in here) or (not skipped and going_on):
            counts[line] = max([before[2] if before is not None else 0, *(s[2] for s in begins)])
        if here:
            before = here[-1]
    return counts


def _span(region: Sequence[Any]) -> _Span:
    return region[0], region[1], region[2], region[3]


def _inside(inner: _Span, outer: _Span) -> bool:
    return outer[:2] <= inner[:2] and inner[2:] <= outer[2:]


def _functions(functions: Iterable[dict[str, Any]], file: str) -> Callable[[int], str]:
    """The name of the function that contains a line of the file."""
    begun: dict[int, str] = {}
    for function in functions:
        if function["filenames"][0] == file:
            begun[function["regions"][0][0]] = re.split("[:;]", function["name"])[-1]
    starts = sorted(begun)

    def name(line: int) -> str:
        place = bisect_right(starts, line)
        return begun[starts[place - 1]] if place else ""

    return name


def _lines(source: _Source, segments: Sequence[Sequence[Any]]) -> Iterable[tuple[int, str, str, bool]]:
    for line, count in _line_counts(segments).items():
        text = source.lines[line - 1] if line <= len(source.lines) else ""  # an included file ends after its last line
        if not _NO_CODE.fullmatch(text):
            yield line, plain(text), "line", count > 0


def _marked(source: _Source, decision: _Span, condition: _Span) -> str:
    before = source.at(*decision[:2], *condition[:2])
    after = source.at(*condition[2:], *decision[2:])
    return plain(f"{before}[{source.at(*condition)}]{after}")


def _conditions(decision: _Span, decisions: Iterable[_Span], branches: Iterable[tuple[_Span, int]]) -> list[_Span]:
    """Conditions of the decision itself, not of one nested in it."""
    inner = [other for other in decisions if other != decision and _inside(other, decision)]
    return sorted(
        {
            span
            for span, kind in branches
            if kind == _CONDITION_OF_DECISION
            and _inside(span, decision)
            and not any(_inside(span, other) for other in inner)
        }
    )


def _independent(records: Iterable[Sequence[Any]], file: str) -> dict[_Span, list[bool]]:
    """By decision: whether each of its conditions was shown to decide alone, in any copy of it."""
    shown: dict[_Span, list[bool]] = {}
    for record in records:
        span = _span(record)
        conditions = list(record[-1])
        known = shown.setdefault(span, [False] * len(conditions))
        if len(known) != len(conditions):
            raise CountError(f"{file}:{span[0]}: a decision with {len(known)} and with {len(conditions)} conditions")
        shown[span] = [a or b for a, b in zip(known, conditions)]
    return shown


def _branches(source: _Source, export: dict[str, Any], file: str, strict: bool) -> Iterable[tuple[int, str, str, bool]]:
    counts: dict[_Span, list[int]] = {}
    kinds: dict[_Span, int] = {}
    for branch in export["branches"]:
        span = _span(branch)
        known = counts.setdefault(span, [0, 0])
        counts[span] = [known[0] + branch[4], known[1] + branch[5]]
        kinds[span] = branch[8]
    decisions = _independent(export["mcdc_records"], file)
    text: dict[_Span, str] = {span: plain(source.at(*span)) for span in counts}
    for decision, shown in decisions.items():
        conditions = _conditions(decision, decisions, kinds.items())
        if len(conditions) != len(shown):
            if strict:
                raise CountError(f"{file}:{decision[0]}: {len(shown)} conditions, but {len(conditions)} found")
            for number, alone in enumerate(shown, start=1):
                yield decision[0], f"{plain(source.at(*decision))}, condition {number}", "independent", alone
            continue
        for condition, alone in zip(conditions, shown):
            text[condition] = _marked(source, decision, condition)
            yield condition[0], text[condition], "independent", alone
    for span, (true, false) in counts.items():
        yield span[0], text[span], "true", true > 0
        yield span[0], text[span], "false", false > 0


def items(export: dict[str, Any], root: Path, strict: bool = True) -> list[Item]:
    """All coverage items in the files of an llvm-cov export, by file and line.

    strict: a macro with a condition is refused; otherwise outcomes in macros, which belong to the system, do not count.
    """
    found: list[Item] = []
    for part in export["files"]:
        path = Path(part["filename"])
        file = path.relative_to(root).as_posix()
        if strict and any(expansion["branches"] for expansion in part.get("expansions", [])):
            raise CountError(f"{file}: a macro with a condition: its places are those of the macro's text")
        source = _Source(path.read_text(encoding="utf-8"))
        function = _functions(export["functions"], part["filename"])
        for line, text, outcome, reached in [
            *_lines(source, part["segments"]),
            *_branches(source, part, file, strict),
        ]:
            found.append(Item(file, function(line), text, outcome, line, reached))
    return sorted(found, key=lambda item: (item.file, item.line, OUTCOMES.index(item.outcome), item.text))
