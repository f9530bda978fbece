"""Reads tests/targets/embedded_logs.c, and computes the hash of tests/targets/replay.c over all outputs."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

TARGETS = Path(__file__).resolve().parents[1] / "targets"
NUMBER = re.compile(r'INT64_MIN|"[^"]*"|-?(?:0x[0-9A-F]+|\d+)')
TIME_UNKNOWN = -(2**63)


@dataclass(frozen=True)
class LoggedImage:
    time_us: int
    seen: int  # bit i: point i
    box: int  # bit i: side i
    reset_count: int
    reset_delta_known: bool
    numbers: tuple[float, ...]  # the 23 numbers, in the order of embedded_logs.h


@dataclass(frozen=True)
class LoggedTrack:
    name: str
    images: list[LoggedImage]
    model: int
    window: int
    line_points: int
    orientation_memory: int
    heading_auto: bool
    position_white_sd_m: float
    numbers: tuple[float, ...]  # 18


def floats(words: Iterable[int]) -> tuple[float, ...]:
    return tuple(np.array(list(words), np.uint32).view(np.float32).tolist())


def rows(text: str, name: str) -> list[list[object]]:
    """Rows of an array of structs. The last member of each struct is an array."""

    def value(word: str) -> object:
        return word[1:-1] if word[0] == '"' else TIME_UNKNOWN if word == "INT64_MIN" else int(word, 0)

    body = text.split(f" {name}[", 1)[1].split("{", 1)[1].split("\n};", 1)[0]
    body = re.sub(r"/\*.*?\*/", "", body)
    return [[value(word) for word in NUMBER.findall(row)] for row in re.split(r"\}\s*\},?", body) if row.strip()]


def read_tracks() -> list[LoggedTrack]:
    text = (TARGETS / "embedded_logs.c").read_text(encoding="utf-8")
    images = [LoggedImage(*row[:4], bool(row[4]), floats(row[5:])) for row in rows(text, "logged_images")]  # type: ignore
    assert all(len(image.numbers) == 23 for image in images)
    tracks = []
    for name, first, count, model, window, line_points, memory, auto, white, *bits in rows(text, "logged_tracks"):
        own = images[first : first + count]  # type: ignore[operator]
        assert len(own) == count and len(bits) == 18
        tracks.append(
            LoggedTrack(name, own, model, window, line_points, memory, bool(auto), float(white), floats(bits))  # type: ignore
        )
    return tracks


def golden(name: str) -> str:
    return (TARGETS / name).read_text(encoding="utf-8").split()[0]


class Hash:
    """FNV-1a, 64 bit, over words, least significant byte first."""

    def __init__(self) -> None:
        self.bytes = bytearray()

    def word(self, *words: int) -> None:
        for word in words:
            self.bytes += (int(word) & 0xFFFFFFFF).to_bytes(4, "little")

    def numbers(self, *numbers: float) -> None:
        self.bytes += np.array(numbers, np.float64).astype("<f4").tobytes()

    def flags(self, *flags: bool) -> None:
        self.word(sum(1 << i for i, flag in enumerate(flags) if flag))

    def text(self, text: str) -> None:
        self.word(*text.encode())

    def __str__(self) -> str:
        state = 0xCBF29CE484222325
        for byte in self.bytes:
            state = ((state ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
        return f"{state:016x}"
