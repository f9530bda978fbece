"""Reads a CSV file by columns."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from ..logs.obslog import LogError


def read_columns(path: Path, text: Iterable[str]) -> dict[str, np.ndarray]:
    """Arrays of one length: text where named so, float64 otherwise, NaN where the field is empty."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or "cannot be read") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise LogError(path, 0, "", f"no CSV: {error}") from None
    if len(rows) < 2:
        raise LogError(path, 0, "", "no rows")
    header = rows[0]
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            raise LogError(path, number, "", f"{len(row)} fields, the header has {len(header)}")
    columns: dict[str, np.ndarray] = {}
    for name, fields in zip(header, zip(*rows[1:])):
        columns[name] = np.array(fields) if name in text else _numbers(path, name, fields)
    return columns


def _numbers(path: Path, name: str, fields: Sequence[str]) -> np.ndarray:
    try:
        return np.array([field or "nan" for field in fields], dtype=float)
    except ValueError:
        for number, field in enumerate(fields, start=2):
            try:
                float(field or "nan")
            except ValueError:
                raise LogError(path, number, name, f"{field!r} is not a number") from None
        raise
