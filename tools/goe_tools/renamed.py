"""Names that version 0.4.0 replaced (settings, values of options, columns), and names of columns in the files of other
programs. The programs and the tools read the same lists."""

from __future__ import annotations

import re
from functools import cache

from .places import ROOT

LISTS = ROOT / "sim_host" / "text"


def _pairs(word: str, name: str) -> dict[str, str]:
    text = (LISTS / name).read_text(encoding="utf-8")
    return dict(re.findall(rf'^{word}\("([^"]+)", "([^"]+)"\)$', text, re.MULTILINE))


@cache
def names() -> dict[str, str]:
    """The new name of each old one; a value of an option with the option before it."""
    return _pairs("RENAMED", "renamed_names_list.h")


@cache
def usual() -> dict[str, str]:
    """The column that a name in another program's file usually means."""
    return _pairs("USUAL", "usual_names_list.h")
