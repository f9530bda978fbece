"""Command line: python -m goe_tools COMMAND ..."""

from __future__ import annotations

import argparse
import difflib
import importlib
import os
import re
import sys
from collections.abc import Sequence
from typing import NoReturn

from .logs.obslog import LogError

COMMANDS = {  # name: module with add_arguments and run, and what it does
    "attack_tables": (".report.attack_command", "print or write the tables of hostile flights from a file of goals"),
    "bound": (".optimum.bound", "print the Cramer-Rao bound of a log with truth"),
    "scene": (".logs.scene_command", "write a synthetic observation log of a box or a cylinder"),
    "embed_logs": (".logs.embed_logs", "write or check the synthetic logs that the target images carry"),
    "campaign": (".report.campaign_command", "fly goe_campaign in parts, over processes or a cluster"),
    "compare": (".reference.compare", "run goe_replay over logs and compare it with both references"),
    "convert": (".exchange.convert", "make an observation log of an autopilot's log and a detector's table"),
    "evidence": (".evidence.command", "run what shows that the library is as it says, and print its table"),
    "golden": (".reference.golden", "write or check the C headers with the unit tests' reference data"),
    "jsbsim_flight": (".logs.jsbsim_flight", "fly a scenario with JSBSim and write it as an observation log"),
    "flight_cost": (".cost.flight", "measure what the calls of the flight layer take"),
    "ledger": (".cost.ledger", "measure what the library costs on each target"),
    "lies": (".lies.command", "search for confident errors and warnings that vanish, in random legal flights"),
    "live": (".live.command", "write a page in which the library runs, compiled to WebAssembly"),
    "goals": (".optimum.goals.command", "print what the project promises beside what is reached"),
    "mcap": (".exchange.mcap_command", "write a log and its estimates as MCAP, for Foxglove and PlotJuggler"),
    "minimax": (".reference.minimax", "print the constants of the library's polynomials and their error bounds"),
    "noise": (".noise.command", "find the settings of the noise that logs ask for"),
    "offline": (".optimum.offline", "fit all images of a log with truth at once"),
    "packages": (".packages.command", "stage packages for other package managers, or check their manifests"),
    "peers": (".cost.peers.command", "hold the window fit and the filter update against other solvers"),
    "rare": (".report.rare_command", "fly the flight layer's orders many times and keep what rarely happens"),
    "report": (".report.command", "write the campaign's report and print Table 3"),
    "settings": (".reference.settings_table", "print, write or check the manual's table of the library's settings"),
    "view": (".view.command", "show a log: a page with a map and a slider over time, or a picture"),
    "table": (".logs.table", "print estimates as a table that a pilot can read"),
}
EXIT_BAD_INPUT = 2
EXIT_INTERRUPTED = 130  # as a shell reports Ctrl-C


class Parser(argparse.ArgumentParser):
    """Tells the name that a mistyped command or option was probably meant to be."""

    def words(self) -> list[str]:
        """Its options, its commands, and their options: a command hands back what it does not know."""
        found = [word for action in self._actions for word in action.option_strings]
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction):
                for name, parser in action.choices.items():
                    found += [name, *parser.words()]
        return found

    def error(self, message: str) -> NoReturn:
        known = self.words()
        mistyped = re.search(r"argument command: invalid choice: '([^']*)'|unrecognized arguments: (\S+)", message)
        word = (mistyped[1] or mistyped[2]).split("=")[0] if mistyped else ""
        near = difflib.get_close_matches(word, [name for name in known if (name[0] == "-") == word.startswith("-")], 1)
        super().error(f"{message}; did you mean {near[0]}?" if near else message)


def parser_for(words: Sequence[str]) -> argparse.ArgumentParser:
    """The parser of a command line. Only the module of the command that is asked for is imported: plots, tables and
    solvers take their time to start."""
    parser = Parser(prog="goe_tools", description="Tools of the ground obstacle estimator.")
    commands = parser.add_subparsers(dest="command", required=True)
    asked = next((word for word in words if not word.startswith("-")), None)
    for name, (module_name, text) in COMMANDS.items():
        command = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        if name == asked:
            module = importlib.import_module(module_name, __package__)
            module.add_arguments(command)
            command.set_defaults(entry=module.run)
    return parser


def fault_of(error: OSError) -> str:
    """The file first; an error of the system that names none is of standard output: a full disk, a closed pipe."""
    if error.strerror is None:
        return str(error)
    return f"{error.filename or 'standard output'}: {error.strerror}"


def drop_output() -> None:
    """What standard output did not take: Python would try again on leaving."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main(argv: Sequence[str] | None = None) -> int:
    words = sys.argv[1:] if argv is None else argv
    arguments = parser_for(words).parse_args(words)
    try:
        status = int(arguments.entry(arguments))
        sys.stdout.flush()
        return status
    except OSError as error:
        print(f"goe_tools {arguments.command}: {fault_of(error)}", file=sys.stderr)
        drop_output()
        return EXIT_BAD_INPUT
    except (LogError, ValueError) as error:
        print(f"goe_tools {arguments.command}: {error}", file=sys.stderr)
        return EXIT_BAD_INPUT
    except MemoryError:
        print(f"goe_tools {arguments.command}: out of memory", file=sys.stderr)
        return EXIT_BAD_INPUT
    except KeyboardInterrupt:
        print(f"goe_tools {arguments.command}: interrupted", file=sys.stderr)
        return EXIT_INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
