"""Command line: python -m ci COMMAND ..."""

from __future__ import annotations

import os
import signal
import sys

if __name__ == "__main__" and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, lambda *_: os._exit(130))  # Ctrl-C during the slow imports; cli.main() takes over

from collections.abc import Sequence

from goe_tools import cli

COMMANDS = {  # name: module with add_arguments and run, and its description
    "affected": (".affected", "print the Python tests that a change affects"),
    "embed_logs": (".embed_logs", "write or check the synthetic logs in the target images"),
    "evidence": (".evidence.command", "run the evidence for the library's promises, and print its table"),
    "flight_cost": (".cost.flight", "measure the cost of the flight layer's calls"),
    "ledger": (".cost.ledger", "measure the cost of the library on each target"),
    "packages": (".packages.command", "stage packages for other package managers, or check their manifests"),
    "tidy_commands": (".tidy_commands", "write one compile command for each source, for clang-tidy"),
    "settings": (".settings_table", "print, write or check the manual's table of the library's settings"),
    "settings_header": (".settings_header", "print, write or check the structures of the settings, lib/goe_settings.h"),
}


def main(argv: Sequence[str] | None = None) -> int:
    return cli.main("ci", "Checks of the repository itself, for those who change it.", COMMANDS, argv)


if __name__ == "__main__":
    sys.exit(main())
