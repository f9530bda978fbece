"""For all tests: programs started here receive interrupts, even if the caller of pytest ignores them."""

from __future__ import annotations

import signal

# Ignored signals stay ignored in child processes: a background job ignores SIGINT, one under nohup SIGHUP.
for number in (signal.SIGHUP, signal.SIGTERM):
    signal.signal(number, signal.SIG_DFL)
signal.signal(signal.SIGINT, signal.default_int_handler)
