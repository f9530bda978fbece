"""Command line: python -m goe_tools COMMAND ..."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence

from .obslog import LogError

COMMANDS = {
    "bound": "print the Cramer-Rao bound of a log with truth",
    "scene": "write a synthetic observation log of a box or a cylinder",
    "embed_logs": "write or check the synthetic logs that the target images carry",
    "compare": "run goe_replay over logs and compare it with both references",
    "golden": "write or check the C headers with the unit tests' reference data",
    "ledger": "measure what the library costs on each target",
    "goals": "print what the project promises beside what is reached",
    "offline": "fit all images of a log with truth at once",
    "peers": "hold the window solve against other solvers",
    "report": "write the campaign's report and print Table 3",
    "table": "print estimates as a table that a pilot can read",
}
MODULES = {name: f".optimum.{name}" for name in ("bound", "goals", "offline")}
MODULES["ledger"] = ".cost.ledger"
EXIT_BAD_INPUT = 2
EXIT_INTERRUPTED = 130  # as a shell reports Ctrl-C


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="goe_tools", description="Tools of the ground obstacle estimator.")
    commands = parser.add_subparsers(dest="command", required=True)
    for name, text in COMMANDS.items():
        module = importlib.import_module(MODULES.get(name, f".{name}"), __package__)
        command = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        module.add_arguments(command)
        command.set_defaults(entry=module.run)
    arguments = parser.parse_args(argv)
    try:
        return int(arguments.entry(arguments))
    except (LogError, ValueError, FileNotFoundError) as error:
        print(f"goe_tools {arguments.command}: {error}", file=sys.stderr)
        return EXIT_BAD_INPUT
    except KeyboardInterrupt:
        print(f"goe_tools {arguments.command}: interrupted", file=sys.stderr)
        return EXIT_INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
