"""Names that version 0.4.0 replaced: settings, values of options, columns. The programs and the tools have one list."""

from __future__ import annotations

import re
from functools import cache

from .places import ROOT

LIST = ROOT / "sim_host" / "text" / "renamed_names_list.h"


@cache
def names() -> dict[str, str]:
    """The new name of each old one; a value of an option with the option before it."""
    return dict(re.findall(r'^RENAMED\("([^"]+)", "([^"]+)"\)$', LIST.read_text(encoding="utf-8"), re.MULTILINE))
