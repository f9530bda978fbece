"""For all tests: interrupts reach the programs started here, even where those who started pytest ignore them."""

from __future__ import annotations

import signal

# What is ignored stays ignored in child processes: a job in the background ignores SIGINT, one under nohup SIGHUP.
for number in (signal.SIGHUP, signal.SIGTERM):
    signal.signal(number, signal.SIG_DFL)
signal.signal(signal.SIGINT, signal.default_int_handler)
