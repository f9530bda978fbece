"""One compile command for each source: ``python -m ci tidy_commands BUILD OUT``.

The library's sources are compiled by several targets, and clang-tidy repeats its work for each command that it finds.
The first one of a source is that of its own library; the others differ in definitions and include paths only.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

DATABASE = "compile_commands.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("build", type=Path, help=f"folder with {DATABASE}")
    parser.add_argument("out", type=Path, help="folder to write the reduced one to")


def first_of_each_source(commands: list[dict[str, Any]]) -> list[dict[str, Any]]:
    kept: dict[Path, dict[str, Any]] = {}
    for command in commands:
        kept.setdefault((Path(command["directory"]) / command["file"]).resolve(), command)
    return list(kept.values())


def run(arguments: argparse.Namespace) -> int:
    commands = json.loads((arguments.build / DATABASE).read_text(encoding="utf-8"))
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / DATABASE).write_text(json.dumps(first_of_each_source(commands), indent=1), encoding="utf-8")
    return 0
