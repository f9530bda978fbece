"""For all tests: programs started here receive interrupts, even if the caller of pytest ignores them; those marked
``release`` run with GOE_LONG=1 alone. After the time GOE_TESTS_END (seconds since 1970) no further test begins."""

from __future__ import annotations

import os
import signal
import time

import pytest

# Ignored signals stay ignored in child processes: a background job ignores SIGINT, one under nohup SIGHUP.
for number in (signal.SIGHUP, signal.SIGTERM):
    signal.signal(number, signal.SIG_DFL)
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if not os.environ.get("GOE_LONG"):
        later = [item for item in items if item.get_closest_marker("release")]
        config.hook.pytest_deselected(items=later)
        items[:] = [item for item in items if item not in set(later)]


def pytest_runtest_setup() -> None:
    end = os.environ.get("GOE_TESTS_END")
    if end and time.time() > float(end):
        pytest.skip("no time left in a quick run")
