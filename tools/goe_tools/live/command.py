"""The command ``live``."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console

from ..logs.whole_file import write_whole
from ..places import ROOT
from .modules import build
from .page import page


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", type=Path, required=True, metavar="FILE.html", help="page to write")
    parser.add_argument(
        "--build", type=Path, default=ROOT / "build-wasm", metavar="DIR", help="build folder (default: build-wasm)"
    )


def run(arguments: argparse.Namespace) -> int:
    if arguments.out.is_dir():
        raise ValueError(f"{arguments.out} is a folder: name a file")
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    with Console(stderr=True).status("building the modules"):
        modules = build(arguments.build.resolve())
    text = page(modules)
    write_whole(arguments.out, text)
    print(
        f"{arguments.out}: {len(text.encode('utf-8')):,} bytes; bytes of WebAssembly: library {len(modules.goe):,}, "
        f"flight {len(modules.flight):,}, test logs and their replay {len(modules.golden):,}"
    )
    return 0
