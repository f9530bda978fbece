"""One thread for a whole fleet in simulated time: timed calls, sockets with input, processes that wait.

Time stands still until all work of one moment is done, however long the machine takes. No result depends on the speed
or the load of the machine.
"""

from __future__ import annotations

import heapq
import itertools
import selectors
from collections.abc import Callable
from typing import Any, Protocol

Action = Callable[[], None]
US_PER_S = 1_000_000
HANG_S = 300  # real time, guard against a hang
BEGIN_US = 5_000 * US_PER_S  # monotonic clock
UNIX_AHEAD_US = 1_790_000_000 * US_PER_S + 123_456  # UNIX time minus monotonic time


class Process(Protocol):
    """A process with the loop's clocks."""

    until_us: int  # the process waits until then at the longest

    def go_on(self, now_us: int) -> None:
        """Ends the process's wait."""

    def wait_until_idle(self) -> None:
        """Returns once the process waits again and has read and written all available data."""


class Loop:
    """Runs timed calls and readers of sockets until a time. `now_s` is the time of the monotonic clock."""

    def __init__(self) -> None:
        self.now_us = BEGIN_US
        self._due: list[tuple[int, int, Action]] = []
        self._number = itertools.count()
        self._selector = selectors.DefaultSelector()
        self._processes: list[Process] = []

    @property
    def now_s(self) -> float:
        return self.now_us / US_PER_S

    @property
    def unix_s(self) -> float:
        return (self.now_us + UNIX_AHEAD_US) / US_PER_S

    def at(self, due_s: float, action: Action) -> None:
        """Calls at that time. If the time is past, it calls as soon as the present work is done."""
        heapq.heappush(self._due, (max(round(due_s * US_PER_S), self.now_us), next(self._number), action))

    def after(self, delay_s: float, action: Action) -> None:
        self.at(self.now_s + delay_s, action)

    def every(self, period_s: float, action: Action, first_s: float = 0.0) -> None:
        begin_s = self.now_s + first_s

        def again(number: int) -> None:
            action()
            self.at(begin_s + (number + 1) * period_s, lambda: again(number + 1))

        self.at(begin_s, lambda: again(0))

    def watch(self, file: Any, action: Action) -> None:
        self._selector.register(file, selectors.EVENT_READ, action)

    def forget(self, file: Any) -> None:
        self._selector.unregister(file)

    def join(self, process: Process) -> None:
        """Adds a process that waits already."""
        self._processes.append(process)

    def leave(self, process: Process) -> None:
        if process in self._processes:
            self._processes.remove(process)

    def run(self, seconds: float) -> None:
        end_us = self.now_us + round(seconds * US_PER_S)
        while True:
            self._finish_this_moment()
            following = [self._due[0][0]] if self._due else []
            following += [process.until_us for process in self._processes]
            self.now_us = min([end_us, *following])
            if self.now_us == end_us and all(time_us > end_us for time_us in following):
                return

    def _finish_this_moment(self) -> None:
        """Returns when nothing is due, no input is left, and all processes wait for a later time."""
        while True:
            acted = self._call_due() + self._read()
            awake = [process for process in self._processes if acted or process.until_us <= self.now_us]
            if not awake and not acted:
                return
            for process in awake:
                process.go_on(self.now_us)
            for process in awake:
                process.wait_until_idle()

    def _call_due(self) -> int:
        called = 0
        while self._due and self._due[0][0] <= self.now_us:
            heapq.heappop(self._due)[2]()
            called += 1
        return called

    def _read(self) -> int:
        ready = self._selector.select(0)
        for key, _ in ready:
            key.data()
        return len(ready)

    def close(self) -> None:
        self._selector.close()
