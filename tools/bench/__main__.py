"""Command line: python -m bench COMMAND ..."""

from __future__ import annotations

import os
import signal
import sys

if __name__ == "__main__" and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, lambda *_: os._exit(130))  # Ctrl-C during the slow imports; cli.main() takes over

from collections.abc import Sequence

from goe_tools import cli

COMMANDS = {  # name: module with add_arguments and run, and its description
    "attack_tables": (".attack.command", "print or write the tables of hostile flights from a file of goals"),
    "compare": (
        ".reference.compare",
        "run goe_replay over logs and compare it with the method in Python, both precisions",
    ),
    "golden": (".reference.golden", "write or check the C headers with the unit tests' reference data"),
    "lies": (".lies.command", "search for confident errors and warnings that vanish, in random legal flights"),
    "goals": (".optimum.goals.command", "print the project's goals and the figures reached"),
    "minimax": (".reference.minimax", "print the constants of the library's polynomials and their error bounds"),
    "peers": (".peers.command", "compare the window fit and the filter update with other solvers"),
}


def main(argv: Sequence[str] | None = None) -> int:
    return cli.main("bench", "Comparisons of the ground obstacle estimator with references and goals.", COMMANDS, argv)


if __name__ == "__main__":
    sys.exit(main())
