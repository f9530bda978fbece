"""The expected output of the samples; its only copy is in port/examples/scripted_flight/README.md."""

from __future__ import annotations

import re

from kconfig_of import ROOT

PAGE = ROOT / "port" / "examples" / "scripted_flight" / "README.md"


def version() -> str:
    header = (ROOT / "lib" / "goe.h").read_text()
    return ".".join(re.findall(r"^#define GOE_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)$", header, re.MULTILINE))


def assert_flown(text: str) -> None:
    """Checks the first line, and all lines on the flight, verbatim."""
    (shown,) = re.findall(r"^```text\n(.*?)^```$", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    wanted = shown.splitlines()
    lines = text.splitlines()
    begin = next(number for number, line in enumerate(lines) if line.startswith("goe "))
    assert wanted[0] == f"goe {version()}, self-check 0x00"
    assert len(wanted) > 15
    assert lines[begin : begin + len(wanted)] == wanted
    assert not any(" s: " in line for line in lines[begin + len(wanted) :])
