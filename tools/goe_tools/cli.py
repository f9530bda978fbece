"""The command line of the three packages: python -m goe_tools COMMAND ..., python -m bench ..., python -m ci ...

A package's ``COMMANDS`` map a name to a module with add_arguments and run, and its description."""

from __future__ import annotations

import argparse
import difflib
import importlib
import os
import re
import signal
import sys
import threading
from collections.abc import Mapping, Sequence
from typing import NoReturn

from .logs.obslog import LogError

PACKAGES = ("goe_tools", "bench", "ci")  # each has its COMMANDS in __main__.py
EXIT_BAD_INPUT = 2
EXIT_INTERRUPTED = 130  # as a shell reports Ctrl-C


def commands_of(package: str) -> Sequence[str]:
    """Names of a package's commands; empty if it is not installed."""
    try:
        return tuple(importlib.import_module(f"{package}.__main__").COMMANDS)
    except ModuleNotFoundError:
        return ()


class Parser(argparse.ArgumentParser):
    """Suggests the command or option that a mistyped one probably means, and the package that has it."""

    package = ""  # whose commands this parser has; empty for the parser of a single command

    def elsewhere(self) -> dict[str, str]:
        """Command lines of the other packages' commands, by name."""
        others = [package for package in PACKAGES if self.package and package != self.package]
        return {name: f"python -m {package} {name}" for package in others for name in commands_of(package)}

    def words(self) -> list[str]:
        """Its options, its commands, and their options: a command's parser returns words it does not know to this
        one."""
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
        others = self.elsewhere() if mistyped and mistyped[1] else {}
        names = [name for name in (*known, *others) if (name[0] == "-") == word.startswith("-")]
        near = difflib.get_close_matches(word, names, 1)
        super().error(f"{message}; did you mean {others.get(near[0], near[0])}?" if near else message)


def parser_for(
    package: str, what: str, known: Mapping[str, tuple[str, str]], words: Sequence[str]
) -> argparse.ArgumentParser:
    """The parser of a command line. It imports only the module of the named command: plots, tables and solvers load
    slowly."""
    parser = Parser(prog=package, description=what)
    parser.package = package
    commands = parser.add_subparsers(dest="command", required=True)
    chosen = next((word for word in words if not word.startswith("-")), None)
    for name, (module_name, text) in known.items():
        command = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        if name == chosen:
            module = importlib.import_module(module_name, package)
            module.add_arguments(command)
            command.set_defaults(entry=module.run)
    return parser


def fault_of(error: OSError) -> str:
    """Starts with the file. A system error without a file name is one of standard output: a full disk, a closed
    pipe."""
    if error.strerror is None:
        return str(error)
    return f"{error.filename or 'standard output'}: {error.strerror}"


def drop_output() -> None:
    """Discards what standard output did not take; otherwise Python would try again on exit."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _take_interrupts() -> None:
    """Ctrl-C raises KeyboardInterrupt from now on; a program that ignores it still does. Until now Ctrl-C ended the
    program at once (__main__.py)."""
    in_main = threading.current_thread() is threading.main_thread()
    if in_main and signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def main(package: str, what: str, known: Mapping[str, tuple[str, str]], argv: Sequence[str] | None = None) -> int:
    """``what``: the package in one sentence; ``known``: its ``COMMANDS``."""
    words = sys.argv[1:] if argv is None else argv
    name = package  # and its command, once it is known
    try:
        arguments = parser_for(package, what, known, words).parse_args(words)
        _take_interrupts()
        name = f"{package} {arguments.command}"
        status = int(arguments.entry(arguments))
        sys.stdout.flush()
        return status
    except OSError as error:
        print(f"{name}: {fault_of(error)}", file=sys.stderr)
        drop_output()
        return EXIT_BAD_INPUT
    except (LogError, ValueError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return EXIT_BAD_INPUT
    except MemoryError:
        print(f"{name}: out of memory", file=sys.stderr)
        return EXIT_BAD_INPUT
    except KeyboardInterrupt:
        print(f"{name}: interrupted", file=sys.stderr)
        return EXIT_INTERRUPTED
