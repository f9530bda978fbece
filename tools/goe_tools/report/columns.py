"""Reads a CSV file by columns."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from ..logs.fields import LogError, read_records


def read_columns(path: Path, text: Iterable[str]) -> dict[str, np.ndarray]:
    """Arrays of one length: text for the columns in ``text``, float64 otherwise, NaN for an empty field."""
    lines, rows = [], []
    for line, fields in read_records(path):
        if rows and len(fields) != len(rows[0]):
            raise LogError(path, line, "", f"{len(fields)} fields, the header has {len(rows[0])}")
        lines.append(line)
        rows.append(fields)
    if len(rows) < 2:
        raise LogError(path, 0, "", "no rows")
    header = rows[0]
    columns: dict[str, np.ndarray] = {}
    for name, fields in zip(header, zip(*rows[1:])):
        columns[name] = np.array(fields) if name in text else _numbers(path, name, lines[1:], fields)
    return columns


def _numbers(path: Path, name: str, lines: Sequence[int], fields: Sequence[str]) -> np.ndarray:
    try:
        return np.array([field or "nan" for field in fields], dtype=float)
    except ValueError:
        for line, field in zip(lines, fields):
            try:
                float(field or "nan")
            except ValueError:
                raise LogError(path, line, name, f"{field!r} is not a number") from None
        raise
