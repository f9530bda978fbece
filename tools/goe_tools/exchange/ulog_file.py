"""The messages of a ULog file, without its damaged parts.

A message has a header of three bytes (length, type) and its content. After damage the next readable message is that
after the logger's next synchronization message."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

FILE_HEADER = 16  # bytes
HEADER = 3  # of a message
US = 1e-6
TYPES = frozenset(b"BFIMPQARDLCSO")
FLAGS, ADD, DATA = b"BAD"
APPENDED = slice(16, 40)  # of the flags: where parts appended after a crash begin
SYNC = bytes([8, 0]) + b"S" + bytes([0x2F, 0x73, 0x13, 0x20, 0x25, 0x0C, 0xBB, 0x12])


@dataclass(frozen=True)
class Damage:
    """A part of the file that is not readable, and the times of the data around it; None: no data follows."""

    start: int  # byte
    end: int
    before_s: float
    after_s: float | None


@dataclass
class Sound:
    """The readable content, and the missing parts."""

    content: bytes
    damages: list[Damage] = field(default_factory=list)
    cut_s: float | None = None  # the time of the latest data in a file that ends within a message

    def notes(self) -> list[str]:
        result = []
        for one in self.damages:
            until = "no data follows" if one.after_s is None else f"until {one.after_s:.3f} s"
            result.append(
                f"the file is damaged at byte {one.start}: {one.end - one.start} bytes are left out, the data from "
                f"{one.before_s:.3f} s on, {until}"
            )
        if self.cut_s is not None:
            where = f"after the data of {self.cut_s:.3f} s" if self.cut_s else "before any data"
            result.append(f"the file is cut: it ends within a message, {where}")
        return result


class _Walk:
    """The messages one after the other."""

    def __init__(self, data: bytes) -> None:
        self.data, self.view = data, memoryview(data)
        self.length: dict[bytes, int] = {}  # of the data of each topic, as in its first message; 0: none so far
        self.time_us = 0  # of the latest data, of the data before it, and of the first data of a part
        self.sure_us = 0
        self.first_us: int | None = None

    def _is_sound(self, at: int, end: int) -> bool:
        """Whether a message is one of a topic that the file describes, of that topic's length."""
        kind, size = self.data[at + 2], end - at - HEADER
        if kind == ADD and size > 3:
            self.length.setdefault(self.data[at + HEADER + 1 : at + HEADER + 3], 0)
        if kind != DATA:
            return kind in TYPES
        number = self.data[at + HEADER : at + HEADER + 2]
        usual = self.length.get(number)
        if usual is None or size < 10:
            return False
        follows = end + 2 >= len(self.data) or self.data[end + 2] in TYPES
        if usual and size != usual and not follows:
            return False
        self.length[number] = usual or size
        self.time_us = int.from_bytes(self.data[at + HEADER + 2 : at + HEADER + 10], "little")
        return True

    def part(self, begin: int) -> tuple[int, int, bool]:
        """Ends of the sound messages from ``begin`` on, without the latest data and with it; and whether the end of
        the file cuts the message after them."""
        at = sure = begin
        self.first_us = None
        while at < len(self.data):
            end = at + HEADER + int.from_bytes(self.data[at : at + 2], "little")
            if end > len(self.data) or at + HEADER > len(self.data):
                cut = len(self.data) - at < HEADER or self.data[at + 2] in TYPES
                return sure, at, cut
            before_us = self.time_us
            if not self._is_sound(at, end):
                return sure, at, False
            if self.data[at + 2] == DATA:
                sure, self.sure_us = at, before_us
                self.first_us = self.time_us if self.first_us is None else self.first_us
            else:
                sure, self.sure_us = end, self.time_us
            at = end
        return at, at, False


def _is_appended(data: bytes) -> bool:
    content = FILE_HEADER + HEADER
    return data[content - 1] == FLAGS and any(data[content + APPENDED.start : content + APPENDED.stop])


def sound(path: Path) -> Sound:
    """Leaves out damaged parts, with the data message before each: damage may begin in its content. A file with
    appended parts is left as it is."""
    data = path.read_bytes()
    if len(data) < FILE_HEADER + HEADER or _is_appended(data):
        return Sound(data)
    walk, begin = _Walk(data), 0
    kept: list[memoryview] = []
    damages: list[Damage] = []
    sure, at, cut = walk.part(FILE_HEADER)
    while at < len(data) and not cut:
        following = data.find(SYNC, at)
        kept.append(walk.view[begin:sure])
        begin = following if following >= 0 else len(data)
        start, before_us = sure, walk.sure_us
        sure, at, cut = walk.part(begin)
        after_us = walk.first_us
        damages.append(Damage(start, begin, before_us * US, None if after_us is None else after_us * US))
    content = b"".join([*kept, walk.view[begin:at]]) if damages or cut else data
    return Sound(content, damages, walk.time_us * US if cut else None)
