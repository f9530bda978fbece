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
    """Calls what is due, and what has something to read, until a time. Times are time.monotonic()."""

    def __init__(self) -> None:
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
            late = time.monotonic() - due_s
            following = due_s + period_s * max(1, int(late / period_s))
            self.at(following, lambda: again(following))

        self.at(begin, lambda: again(begin))

    def watch(self, file: Any, action: Action) -> None:
        self._selector.register(file, selectors.EVENT_READ, action)

    def forget(self, file: Any) -> None:
        self._selector.unregister(file)

    def run(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (now := time.monotonic()) < end:
            due = min(self._due[0][0] if self._due else end, end)
            for key, _ in self._selector.select(max(due - now, 0.0)):
                key.data()
            while self._due and self._due[0][0] <= min(time.monotonic(), end):
                heapq.heappop(self._due)[2]()

    def close(self) -> None:
        self._selector.close()
