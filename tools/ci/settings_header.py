"""The structures of the settings, lib/goe_settings.h, from the library's list.

    python -m ci settings_header [--check | --write]

Without options the command prints the header.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import jinja2
from goe_tools.places import ROOT

LIST = ROOT / "lib" / "goe_settings_list.h"
HEADER = ROOT / "lib" / "goe_settings.h"
TEMPLATE = Path(__file__).with_name("goe_settings.h.j2")
GROUPS = ("camera", "navigation", "detector", "window", "filter", "")  # in the order of the header; "": no group
ENTRY = re.compile(r'^    X\(([\w.]+)(?:\[(\d)\])?, (\w+), "([^"]*)", (\S+), (\S+), (\S+), "([^"]*)"\)', re.MULTILINE)
NAMED = {  # defaults that are no numbers
    "GOE_METHOD_MAX": "filter (if compiled in)",
    "GOE_MODEL_AUTO": "auto",
    "GOE_WINDOW_DEFAULT": "8 (at most GOE_WINDOW_MAX)",
}
CENTER = ("camera.cx_px", "camera.cy_px")  # 0 is in their range, and wrong
MUST_BE_SET = "must be set"


def must_be_set(path: str, value: float, low: float, high: float) -> bool:
    """A default outside the range, or one that is in it and wrong, means that the user must set it."""
    return not low <= value <= high or path in CENTER


@dataclass(frozen=True)
class Field:
    path: str
    index: str  # of an element of an array of three, "" if there is none
    kind: str
    unit: str
    low: str
    high: str
    value: str
    text: str

    @property
    def group(self) -> str:
        return self.path.rpartition(".")[0]

    @property
    def declared(self) -> str:
        kind = {"REAL": "float", "COUNT": "int", "TRUTH": "bool"}.get(self.kind, f"goe_{self.path}_t")
        return f"{kind} {self.path.rpartition('.')[2]}{'[3]' if self.index else ''};"

    @property
    def default(self) -> str:
        if self.value in NAMED:
            return f"default {NAMED[self.value]}"
        if self.kind == "TRUTH":
            return f"default {'true' if self.value == '1' else 'false'}"
        required = must_be_set(self.path, *(float(plain(number)) for number in (self.value, self.low, self.high)))
        return f"no default: {MUST_BE_SET}" if required else f"default {plain(self.value)}"

    @property
    def comment(self) -> str:
        text = "camera relative to pose.position_ned_m, body FRD" if self.index else self.text
        has_range = self.kind in ("REAL", "COUNT")
        span = f"{plain(self.low)} to {plain(self.high)} {self.unit}".removesuffix(" images").rstrip()
        return "; ".join([text, *([span] if has_range else []), self.default])


def plain(number: str) -> str:
    """A number of C as a reader writes it: -1.0e5f as -1e5."""
    return re.sub(r"\.0(?=e|$)", "", number.removesuffix("f")) if number[-1:] == "f" else number


def fields(text: str) -> Iterator[Field]:
    """One of each array."""
    found = [Field(*match.groups(default="")) for match in ENTRY.finditer(text)]
    if len(found) != len(re.findall(r"^    X\(", text, re.MULTILINE)):
        raise ValueError(f"{LIST}: an entry cannot be read")
    return (field for field in found if field.index in ("", "0"))


def header(text: str) -> str:
    groups: dict[str, list[Field]] = {group: [] for group in GROUPS}
    for field in fields(text):
        groups[field.group].append(field)
    lines = {}
    for group, members in groups.items():
        width = max(len(field.declared) for field in members)
        lines[group or "general"] = [f"    {field.declared:{width}} /* {field.comment} */" for field in members]
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, keep_trailing_newline=True, autoescape=False)
    return environment.from_string(TEMPLATE.read_text(encoding="utf-8")).render(lines=lines)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--check", action="store_true", help="fail if lib/goe_settings.h differs")
    what.add_argument("--write", action="store_true", help="write lib/goe_settings.h")


def run(arguments: argparse.Namespace) -> int:
    text = header(LIST.read_text(encoding="utf-8"))
    if arguments.write:
        HEADER.write_text(text, encoding="utf-8")
    elif not arguments.check:
        print(text, end="")
    elif HEADER.read_text(encoding="utf-8") != text:
        print(f"{HEADER}: differs from {LIST.name}; run python -m ci settings_header --write")
        return 1
    return 0
