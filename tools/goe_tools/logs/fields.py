"""Text that people and programs write by hand: numbers, tables with a header line, and errors that say where."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

INTEGER_MIN, INTEGER_MAX = -(2**63), 2**63 - 1  # what the programs' reader takes
Row = dict[str, str]


class LogError(ValueError):
    """Bad input; its text is ``file:line: column: reason`` (without the parts that do not apply)."""

    def __init__(self, path: Path, line: int, column: str, reason: str) -> None:
        self.path, self.line, self.column, self.reason = Path(path), line, column, reason
        where = f"{path}:{line}: " if line else f"{path}: "
        super().__init__(where + (f"{column}: " if column else "") + reason)


def read_number(text: str, path: Path, line: int, column: str) -> float:
    """A decimal number; also nan and inf, which are bad measurements, no bad input."""
    try:
        if "_" in text or not text.isascii():  # Python's digit grouping, unknown to every other reader
            raise ValueError
        return float(text)
    except ValueError:
        raise LogError(path, line, column, f"'{text}' is not a number") from None


def read_integer(text: str, path: Path, line: int, column: str) -> int:
    """A whole number of 64 bits."""
    try:
        if "_" in text or not text.isascii():
            raise ValueError
        value = int(text)
    except ValueError:
        raise LogError(path, line, column, f"'{text}' is not an integer") from None
    if not INTEGER_MIN <= value <= INTEGER_MAX:
        raise LogError(path, line, column, f"'{text}' is not an integer of 64 bits")
    return value


def read_optional(row: Row, path: Path, line: int, column: str) -> float | None:
    """A number, or None of an empty field or an absent column."""
    text = row.get(column, "")
    return read_number(text, path, line, column) if text else None


def read_text(path: Path) -> str:
    """A whole file of UTF-8 text, without a byte order mark."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None
    except UnicodeDecodeError as error:
        raise LogError(path, 0, "", f"not UTF-8 text: {error.reason}") from None


def _check_header(header: list[str], path: Path, line: int, required: Sequence[str], known: Sequence[str]) -> None:
    for name in required:
        if name not in header:
            raise LogError(path, line, name, "column is missing")
    for name in known:
        if header.count(name) > 1:
            raise LogError(path, line, name, "column is given twice")


def _records(path: Path) -> Iterator[tuple[int, list[str]]]:
    """(line number, fields) of the lines that are not blank."""
    reader = csv.reader(read_text(path).splitlines(keepends=True), strict=True)
    while True:
        try:
            fields = next(reader, None)
        except csv.Error as error:
            raise LogError(path, reader.line_num, "", f"not CSV: {error}") from None
        if fields is None:
            return
        if len(fields) > 1 or any(text.strip() for text in fields):
            yield reader.line_num, [text.strip() for text in fields]


def read_rows(
    path: Path,
    required: Sequence[str],
    known: Sequence[str],
    check: Callable[[list[str], Path, int], None] | None = None,
) -> Iterator[tuple[int, Row]]:
    """Yields (line number, column -> text) of a CSV file with a header line. ``known``: columns that may not appear
    twice; ``check``: raises a LogError if the header line is none."""
    header: list[str] | None = None
    for line, fields in _records(path):
        if header is None:
            header = fields
            _check_header(header, path, line, required, known)
            if check is not None:
                check(header, path, line)
        elif len(fields) != len(header):
            column = header[min(len(fields), len(header) - 1)]
            raise LogError(path, line, column, f"{len(fields)} fields under {len(header)} columns")
        else:
            yield line, dict(zip(header, fields))
    if header is None:
        raise LogError(path, 0, "", "empty: no header line")
