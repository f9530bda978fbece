"""Command line: python -m ci COMMAND ..."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from goe_tools import cli

COMMANDS = {  # name: module with add_arguments and run, and what it does
    "affected": (".affected", "print the Python tests that a change affects"),
    "embed_logs": (".embed_logs", "write or check the synthetic logs that the target images carry"),
    "evidence": (".evidence.command", "run what shows that the library is as it says, and print its table"),
    "flight_cost": (".cost.flight", "measure what the calls of the flight layer take"),
    "ledger": (".cost.ledger", "measure what the library costs on each target"),
    "packages": (".packages.command", "stage packages for other package managers, or check their manifests"),
    "tidy_commands": (".tidy_commands", "write one compile command for each source, for clang-tidy"),
    "settings": (".settings_table", "print, write or check the manual's table of the library's settings"),
}


def main(argv: Sequence[str] | None = None) -> int:
    return cli.main("ci", "Checks of the repository itself, for those who change it.", COMMANDS, argv)


if __name__ == "__main__":
    sys.exit(main())
