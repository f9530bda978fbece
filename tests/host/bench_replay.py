"""Prints how many rows goe_replay processes in a second of processor time: a long log from a pipe with all columns
filled.

python tests/host/bench_replay.py ROWS      tools/bench.sh runs it
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from test_replay import PROGRAM, stream

RUNS = 3


def most_rows_per_second(rows: int) -> float:
    with tempfile.TemporaryDirectory() as folder:
        return rows / min(stream(Path(folder), rows)[1] for _ in range(RUNS))


if __name__ == "__main__":
    if not Path(PROGRAM).exists():
        sys.exit(f"{PROGRAM} is not built")
    print(round(most_rows_per_second(int(sys.argv[1]))))
