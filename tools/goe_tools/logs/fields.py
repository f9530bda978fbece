"""Text written by people and programs: numbers, tables with a header line, and errors with file, line and column."""

from __future__ import annotations

import csv
import difflib
import os
import stat
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO

from ..renamed import names as renamed_names
from ..renamed import usual
from .progress import Progress

INTEGER_MIN, INTEGER_MAX = -(2**63), 2**63 - 1  # range of the programs' reader

# These limits bound the memory for any file, even an endless one; those of rows equal the limits of the programs.
ROW_BYTES_MAX, COLUMNS_MAX = 2**20, 4096
ROWS_MAX, TABLE_BYTES_MAX = 1_000_000, 2**29
TEXT_BYTES_MAX, JSON_BYTES_MAX = 2**20, 2**26  # a settings file; a file written by a tool

BLANKS = " \t\r\n"
csv.field_size_limit(ROW_BYTES_MAX)  # this file counts the row's bytes
Row = dict[str, str]


class LogError(ValueError):
    """Bad input. Its text is ``file:line: column: reason`` (without the parts that do not apply)."""

    def __init__(self, path: Path, line: int, column: str, reason: str) -> None:
        self.path, self.line, self.column, self.reason = Path(path), line, column, reason
        where = f"{path}:{line}: " if line else f"{path}: "
        super().__init__(where + (f"{column}: " if column else "") + reason)


def warn(path: Path, text: str, line: int = 0) -> None:
    """Reports a probable mistake in a readable file."""
    print(f"warning: {path}:{f'{line}:' if line else ''} {text}", file=sys.stderr)


def read_number(text: str, path: Path, line: int, column: str) -> float:
    """A decimal number; nan and inf are bad measurements, not bad input."""
    try:
        if "_" in text or not text.isascii() or text != text.strip():  # Python's extensions, which other readers refuse
            raise ValueError
        return float(text)
    except ValueError:
        raise LogError(path, line, column, f"'{text}' is not a number") from None


def read_integer(text: str, path: Path, line: int, column: str) -> int:
    """A 64-bit integer."""
    try:
        if "_" in text or not text.isascii() or text != text.strip():
            raise ValueError
        value = int(text)
    except ValueError:
        raise LogError(path, line, column, f"'{text}' is not an integer") from None
    if not INTEGER_MIN <= value <= INTEGER_MAX:
        raise LogError(path, line, column, f"'{text}' is not an integer of 64 bits")
    return value


def read_optional(row: Row, path: Path, line: int, column: str) -> float | None:
    """A number, or None for an empty field or an absent column."""
    text = row.get(column, "")
    return read_number(text, path, line, column) if text else None


def read_text(path: Path, most_bytes: int = TEXT_BYTES_MAX) -> str:
    """Reads a whole file of UTF-8 text, without a byte order mark; refuses a longer or endless one."""
    try:
        with open(path, "rb") as file:
            content = file.read(most_bytes + 1)
        if len(content) > most_bytes:
            raise LogError(path, 0, "", f"longer than {most_bytes} bytes")
        return content.decode("utf-8-sig")
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None
    except UnicodeDecodeError as error:
        raise LogError(path, 0, "", f"not UTF-8 text: {error.reason}") from None


DELIMITERS = {";": "semicolons", "\t": "tabs", "|": "bars"}
SIMILARITY_MIN = 0.75  # of difflib


def _nearest(name: str, names: Sequence[str]) -> str:
    """The most similar of some names; empty if none is similar."""
    return next(iter(difflib.get_close_matches(name, names, 1, SIMILARITY_MIN)), "")


def _missing(header: list[str], absent: list[str], known: Sequence[str]) -> str:
    """The message for missing columns, about the first one most."""
    for delimiter, plural in DELIMITERS.items():
        if len(header) == 1 and delimiter in header[0]:
            return f"column is missing: {plural} separate the columns; there must be commas, and points in the numbers"
    others = f"; also missing: {', '.join(absent[1:])}" if len(absent) > 1 else ""
    name = absent[0]
    old = [before for before in header if renamed_names().get(before) == name]
    if old:
        return f"unknown column {old[0]}: now {name}{others}"
    strange = [other for other in header if other not in known]
    instead = next((other for other in strange if usual().get(other) == name), "") or _nearest(name, strange)
    meant = f"; is '{instead}' meant to be it?" if instead else ""
    return f"column is missing{meant}{others}"


def _check_header(header: list[str], path: Path, line: int, required: Sequence[str], known: Sequence[str]) -> None:
    absent = [name for name in required if name not in header]
    if absent:
        raise LogError(path, line, absent[0], _missing(header, absent, known))
    for name in known:
        if header.count(name) > 1:
            raise LogError(path, line, name, "column is given twice")


class _Lines:
    """Lines of a table, one at a time; only LF ends a line. Call ``begin`` before each row."""

    def __init__(self, path: Path, file: IO[bytes]) -> None:
        self.path, self.file = path, file
        self.number = self.first = 0  # of the latest line, and of the line where its row begins
        self.row_bytes = self.bytes = 0
        self.ended = True  # whether a line break ends the latest line

    def begin(self) -> None:
        self.first, self.row_bytes = self.number + 1, 0

    def __iter__(self) -> _Lines:
        return self

    def __next__(self) -> str:
        raw = self.file.readline(ROW_BYTES_MAX + 1)
        if not raw:
            raise StopIteration
        self.number += 1
        self.row_bytes += len(raw)
        self.bytes += len(raw)
        self.ended = raw.endswith(b"\n")
        if self.row_bytes > ROW_BYTES_MAX:
            raise LogError(
                self.path, self.first, "", f"the row is longer than {ROW_BYTES_MAX} bytes: a quote not closed?"
            )
        if self.bytes > TABLE_BYTES_MAX:
            raise LogError(self.path, self.number, "", f"the file is longer than {TABLE_BYTES_MAX} bytes")
        try:
            text = raw.decode("utf-8-sig" if self.number == 1 else "utf-8")
        except UnicodeDecodeError as error:
            raise LogError(self.path, self.number, "", f"not UTF-8 text: {error.reason}") from None
        if "\0" in text:
            raise LogError(self.path, self.number, "", "the row holds a NUL byte")
        return text.replace("\r", " ")  # a blank, as in the programs


PROGRESS_ROWS = 4096  # between two readings of the clock


def _records_of(path: Path, file: IO[bytes]) -> Iterator[tuple[int, list[str]]]:
    status = os.fstat(file.fileno())
    progress = Progress(str(path), status.st_size if stat.S_ISREG(status.st_mode) else 0)
    try:
        yield from _rows_of(path, file, progress)
    finally:
        progress.end()


def _rows_of(path: Path, file: IO[bytes], progress: Progress) -> Iterator[tuple[int, list[str]]]:
    lines, rows = _Lines(path, file), 0
    reader = csv.reader(lines, strict=True, skipinitialspace=True)
    while True:
        lines.begin()
        try:
            fields = next(reader, None)
        except csv.Error as error:
            raise LogError(path, lines.first, "", f"not CSV: {error}") from None
        if fields is None:
            return
        fields = [text.strip(BLANKS) for text in fields]
        if len(fields) < 2 and not any(fields):
            continue
        if rows > ROWS_MAX:
            raise LogError(path, lines.first, "", f"more than {ROWS_MAX} rows")
        if rows == 0 and len(fields) > COLUMNS_MAX:
            raise LogError(path, lines.first, "", f"more than {COLUMNS_MAX} columns")
        rows += 1
        if rows % PROGRESS_ROWS == 0:
            progress.show(lines.bytes, f", {rows:,} rows")
        yield lines.first, fields
        if not lines.ended:
            raise LogError(path, lines.first, "", "the file ends without a line break: is it cut off here?")


def read_records(path: Path) -> Iterator[tuple[int, list[str]]]:
    """(line on which it begins, stripped fields) of each non-blank row of a table, in memory bounded by the constants
    above. Whether a row is complete is known only when the next one is requested."""
    try:
        with open(path, "rb") as file:
            yield from _records_of(path, file)
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None


def read_fields(
    path: Path,
    required: Sequence[str],
    known: Sequence[str],
    check: Callable[[list[str], Path, int], None] | None = None,
) -> Iterator[tuple[int, list[str], list[str]]]:
    """Yields (line number, header, fields) of each row of a CSV file with a header line. ``known``: columns that may
    not appear twice; ``check``: raises a LogError for a line that is no header."""
    header: list[str] | None = None
    for line, fields in read_records(path):
        if header is None:
            header = fields
            _check_header(header, path, line, required, known)
            if check is not None:
                check(header, path, line)
        elif len(fields) != len(header):
            column = header[min(len(fields), len(header) - 1)]
            raise LogError(path, line, column, f"{len(fields)} fields under {len(header)} columns")
        else:
            yield line, header, fields
    if header is None:
        raise LogError(path, 0, "", "empty: no header line")


def read_rows(
    path: Path,
    required: Sequence[str],
    known: Sequence[str],
    check: Callable[[list[str], Path, int], None] | None = None,
) -> Iterator[tuple[int, Row]]:
    """The same as (line number, column -> text)."""
    for line, header, fields in read_fields(path, required, known, check):
        yield line, dict(zip(header, fields))


def warn_of_misspelt(header: list[str], path: Path, line: int, known: Sequence[str]) -> None:
    """Warns about an ignored column whose name resembles a known column that is absent."""
    absent = [name for name in known if name not in header]
    for name in header:
        ours = usual().get(name, "")
        meant = ours if ours in absent else _nearest(name, absent)
        if meant and name not in known:
            warn(path, f"{name}: unknown column, ignored; did you mean {meant}?", line)
