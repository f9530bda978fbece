"""The manual's table of settings, from the library's list.

    python -m ci settings [--check FILE | --write FILE]

Without options the command prints the table. FILE contains it between <!-- settings: begin --> and <!-- settings: end
-->.
"""

from __future__ import annotations

import argparse
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

from goe_tools.logs.marked_block import MarkedBlock
from goe_tools.places import ROOT

from .settings_header import MUST_BE_SET, must_be_set

TABLE = MarkedBlock("settings")
MANUAL = ROOT / "lib" / "README.md"


@dataclass
class Setting:
    name: str
    unit: str
    low: str
    high: str
    value: str  # by default
    text: str

    @property
    def default(self) -> str:
        return MUST_BE_SET if must_be_set(self.name, *map(float, (self.value, self.low, self.high))) else self.value

    @property
    def limit(self) -> str:
        """The programs are built with the largest possible window; a firmware has its own limit."""
        return "`GOE_WINDOW_MAX`" if self.name == "window.points" else self.high


def program() -> Path:
    return Path(os.environ.get("GOE_REPLAY", ROOT / "build" / "sim_host" / "goe_replay"))


def settings(replay: Path | None = None) -> list[Setting]:
    """Every setting of the library."""
    lines = subprocess.run([replay or program(), "--settings"], capture_output=True, text=True, check=True).stdout
    return [Setting(*line.split("\t")) for line in lines.splitlines()]


def table(rows: list[Setting]) -> str:
    head = ["| setting | unit | range | default | meaning |", "|---|---|---|---|---|"]
    body = [f"| `{s.name}` | {s.unit or '-'} | {s.low} to {s.limit} | {s.default} | {s.text} |" for s in rows]
    return "\n".join([*head, *body])


def add_arguments(parser: argparse.ArgumentParser) -> None:
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--check", type=Path, metavar="FILE", help="fail if FILE has another table")
    what.add_argument("--write", type=Path, metavar="FILE", help="put the table into FILE")


def run(arguments: argparse.Namespace) -> int:
    text = table(settings())
    file = arguments.check or arguments.write
    if file is None:
        print(text)
        return 0
    if arguments.write:
        TABLE.write(file, text)
    elif TABLE.of(file) != text:
        print(f"{file}: its table of settings differs from the library's; run python -m ci settings --write {file}")
        return 1
    return 0
