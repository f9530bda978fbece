"""The search for confident errors and vanished warnings, as users run it: ``python -m bench lies``."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

from goe_tools.places import ROOT

from .parts import Amount
from .record import Result, Row

QUICK_S = 60
LONG_FLIGHTS = 1_000_000
SEED = 2026
CONFIDENT_MOST = 0.003  # share of the flights of a mix


def rows_of(counts: dict[str, int], mixes: list[str]) -> list[Row]:
    """Rows of a search's counts."""
    flights = {mix: counts.get(f"flights|{mix}", 0) for mix in mixes}
    rows = [Row("flights", f"{sum(flights.values()):,}", "", None)]
    for mix, flown in flights.items():
        confident, vanished = (counts.get(f"{kind}|{mix}|any", 0) for kind in ("confident", "vanished"))
        share = confident / max(flown, 1)
        safe = counts.get(f"false safety|{mix}", 0) / max(flown, 1)
        rows += [
            Row(f"{mix}: flights with a confident error, > 6 sigma", f"{100 * share:.2f} %",
                f"{100 * CONFIDENT_MOST:g} %", share <= CONFIDENT_MOST),
            Row(f"... with a warning that vanished, of {flown:,}", str(vanished), "0", vanished == 0),
            Row("... with a violation reported below 1 % that happens", f"{100 * safe:.2f} %", "", None),
        ]  # fmt: skip
    return rows


def run(amount: Amount) -> Result:
    size = ["--flights", str(LONG_FLIGHTS)] if amount.long else ["--seconds", str(QUICK_S)]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "lies.json"
        words = [sys.executable, "-m", "bench", "lies", *size, "--seed", str(SEED), "--jobs", str(amount.jobs)]
        done = subprocess.run([*words, "--json", str(path)], cwd=ROOT, capture_output=True, text=True, check=False)
        if not path.exists():
            raise RuntimeError(f"python -m bench lies: {done.stderr.strip()[-500:]}")
        found = json.loads(path.read_text(encoding="utf-8"))
    return Result(rows_of(found["counts"], found["mixes"]), done.stdout)
