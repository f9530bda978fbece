"""The block of a page that a command writes, between <!-- NAME: begin --> and <!-- NAME: end -->."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from .fields import LogError
from .whole_file import write_whole


@dataclass(frozen=True)
class MarkedBlock:
    name: str

    @property
    def begin(self) -> str:
        return f"<!-- {self.name}: begin -->"

    @property
    def end(self) -> str:
        return f"<!-- {self.name}: end -->"

    def _parts(self, page: Path) -> tuple[str, str, str]:
        """The text before, between and after the marks."""
        text = page.read_text(encoding="utf-8")
        if text.count(self.begin) != 1 or text.count(self.end) != 1 or text.index(self.begin) > text.index(self.end):
            raise LogError(page, 0, "", f"needs the lines {self.begin} and {self.end} once")
        before, rest = text.split(self.begin)
        between, behind = rest.split(self.end)
        return before, between.strip(), behind

    def of(self, page: Path) -> str:
        """The text of the block."""
        return self._parts(page)[1]

    def around(self, page: Path) -> str:
        """The text outside the block, written by people."""
        before, _, behind = self._parts(page)
        return before + behind

    def write(self, page: Path, text: str) -> None:
        before, _, behind = self._parts(page)
        write_whole(page, f"{before}{self.begin}\n{text.strip()}\n{self.end}{behind}")
