"""One thread for a whole fleet: what is due at a time, and what a socket brings, in real time."""

from __future__ import annotations

import heapq
import itertools
import selectors
import time
from collections.abc import Callable
from typing import Any

Action = Callable[[], None]


class Loop:
    """Calls what is due, and what has something to read, until a time. Times are time.monotonic().

    `late_s` is by how much it was behind at most: a machine that is too busy for real time.
    """

    def __init__(self) -> None:
        self.late_s = 0.0
        self._due: list[tuple[float, int, Action]] = []
        self._number = itertools.count()
        self._selector = selectors.DefaultSelector()

    def at(self, due_s: float, action: Action) -> None:
        heapq.heappush(self._due, (due_s, next(self._number), action))

    def after(self, delay_s: float, action: Action) -> None:
        self.at(time.monotonic() + delay_s, action)

    def every(self, period_s: float, action: Action, first_s: float = 0.0) -> None:
        """What a busy machine misses is left out, not made up for: no two samples of one moment."""
        begin = time.monotonic() + first_s

        def again(due_s: float) -> None:
            action()
            now = time.monotonic()
            following = due_s + period_s * (int((now - due_s) / period_s) + 1)
            following += period_s if following - now < 0.3 * period_s else 0.0
            self.at(following, lambda: again(following))

        self.at(begin, lambda: again(begin))

    def watch(self, file: Any, action: Action) -> None:
        self._selector.register(file, selectors.EVENT_READ, action)

    def forget(self, file: Any) -> None:
        self._selector.unregister(file)

    def run(self, seconds: float) -> None:
        begin = time.monotonic()
        end = begin + seconds
        while (now := time.monotonic()) < end:
            due = min(self._due[0][0] if self._due else end, end)
            for key, _ in self._selector.select(max(due - now, 0.0)):
                key.data()
            self._call_what_is_due(begin, end)

    def _call_what_is_due(self, begin_s: float, end_s: float) -> None:
        while self._due and self._due[0][0] <= min(now := time.monotonic(), end_s):
            due, _, action = heapq.heappop(self._due)
            self.late_s = max(self.late_s, now - max(due, begin_s))
            action()

    def close(self) -> None:
        self._selector.close()
