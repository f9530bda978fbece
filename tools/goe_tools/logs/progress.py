"""Progress of a long task: one line on a terminal's standard error, from two seconds on."""

from __future__ import annotations

import sys
import time

AFTER_S, EVERY_S = 2.0, 0.2


class Progress:
    """``total`` 0: unknown. Writes nothing if standard error is not a terminal."""

    def __init__(self, what: str, total: float) -> None:
        self.what, self.total = what, total
        self.next_s = time.monotonic() + AFTER_S if sys.stderr.isatty() else float("inf")
        self.shown = False

    def show(self, done: float, more: str = "") -> None:
        now_s = time.monotonic() if self.next_s < float("inf") else 0.0
        if now_s < self.next_s:
            return
        self.next_s, self.shown = now_s + EVERY_S, True
        share = f" {min(done / self.total, 1.0):.0%}" if self.total else ""
        print(f"\r\x1b[K{self.what}:{share}{more}", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        """Leaves no trace."""
        if self.shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
            self.shown = False
