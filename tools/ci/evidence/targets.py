"""Part ``targets``: the same bits on every processor and compiler, under QEMU; the safety tests at full length.

The long run also compiles every combination of parts, and with the flags of every firmware at each level."""

from __future__ import annotations

import os
import re
import subprocess

from goe_tools.places import ROOT

from .parts import Amount, NotHereError
from .record import Result, Row

BUILD = ROOT / "build"
LONG = ("-L", "targets|flags")
QUICK = ("-R", r"^(replay|flight_replay)$")  # on this machine only


def run(amount: Amount) -> Result:
    if not (BUILD / "tests" / "targets").exists():
        raise NotHereError("nothing is built in build/ (cmake --preset default)")
    which = LONG if amount.long else QUICK
    done = subprocess.run(
        ["ctest", "--test-dir", str(BUILD), "--output-on-failure", "-j", str(amount.jobs), *which],
        env={**os.environ, "GOE_LONG": "1"}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    passed = len(re.findall(r"^ *\d+/\d+ Test .*Passed", done.stdout, re.MULTILINE))
    left_out = len(re.findall(r"^ *\d+/\d+ Test .*\*\*\*(?:Skipped|Not Run)", done.stdout, re.MULTILINE))
    total = int(match[1]) if (match := re.search(r"tests failed out of (\d+)", done.stdout)) else 0
    what = "every target, compiler, level and part" if amount.long else "this machine's replays"
    figure = f"{passed} of {total - left_out} with the golden bits" + (f", {left_out} left out" if left_out else "")
    return Result([Row(what, figure, "all", done.returncode == 0 and passed > 0)], done.stdout)
