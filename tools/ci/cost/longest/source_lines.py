"""Source lines of an image's instructions, from its debugging information."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from bench.running import LedgerError
from goe_tools.places import ROOT


@dataclass(frozen=True)
class Place:
    """A line of a compiled function: its own, or of a function inlined in it."""

    function: str
    file: str
    line: int

    @property
    def text(self) -> str:
        lines = lines_of(self.file)
        return lines[self.line - 1] if self.line <= len(lines) else ""


Places = tuple[Place, ...]  # of an instruction, innermost function first


@cache
def lines_of(file: str) -> list[str]:
    """The lines of a source without indentation and trailing comments; the second and further loops with the same text
    get a number: " #2"."""
    try:
        source = ROOT / file.rsplit("/./", 1)[-1]  # builds name the library's sources relative to the project
        plain = [re.sub(r"\s*/\*.*$", "", line).strip() for line in source.read_text("utf-8").splitlines()]
    except OSError:
        return []
    counts: dict[str, int] = {}
    for i, text in enumerate(plain):
        if is_loop(text):
            counts[text] = counts.get(text, 0) + 1
            plain[i] = text if counts[text] == 1 else f"{text} #{counts[text]}"
    return plain


def is_loop(text: str) -> bool:
    return text.startswith(("for (", "while (", "} while (", "do {"))


def places_of(text: str) -> dict[int, Places]:
    """Parses the output of ``addr2line -a -f -i``."""
    found: dict[int, Places] = {}
    for block in re.split(r"^(?=0x[0-9a-f]+$)", text, flags=re.MULTILINE):
        lines = block.splitlines()
        if not lines:
            continue
        places = []
        for name, place in zip(lines[1::2], lines[2::2]):
            file, number = re.sub(r" \(discriminator \d+\)$", "", place).rsplit(":", 1)
            if number.isdigit() and int(number) > 0:
                places.append(Place(name, file, int(number)))
        found[int(lines[0], 16)] = tuple(places)
    return found


def read(tool: str, image: Path, addresses: Iterable[int]) -> dict[int, Places]:
    """The places of the instructions; empty for those compiled without debugging information."""
    given = "".join(f"{address:x}\n" for address in addresses)
    command = [tool, "-a", "-f", "-i", "-e", str(image)]
    done = subprocess.run(command, input=given, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise LedgerError(f"{' '.join(command)}: {done.stderr}")
    return places_of(done.stdout)
