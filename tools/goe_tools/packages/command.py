"""Stage packages, or check and write the manifests that lie in the tree.

    python -m goe_tools packages --out DIR [--target NAME]... [--maintainer "NAME <ADDRESS>"] [--url URL]
    python -m goe_tools packages --check
    python -m goe_tools packages --write
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from .facts import Facts
from .staging import Words
from .targets import COMMITTED, TARGETS, committed_text


def add_arguments(parser: argparse.ArgumentParser) -> None:
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--out", type=Path, metavar="DIR", help="where to stage: DIR/<target>/goe; must not be there yet")
    what.add_argument("--check", action="store_true", help="fail if a manifest in the tree says something else")
    what.add_argument("--write", action="store_true", help="write the manifests in the tree")
    parser.add_argument("--target", action="append", choices=sorted(TARGETS), help="only this one; may be repeated")
    parser.add_argument("--maintainer", default=Words.maintainer, help="who answers for the packages")
    parser.add_argument("--url", default=Words.url, help="home page of the project; Arduino's index asks for one")


def differences(facts: Facts) -> list[str]:
    """What manifests in the tree say that the library does not."""
    found = []
    for name in COMMITTED:
        if (facts.root / name).read_text(encoding="utf-8") != committed_text(facts, name):
            found.append(f"{name}: not what its template gives; python -m goe_tools packages --write")
    manifest = "tools/pyproject.toml"
    text = (facts.root / manifest).read_text(encoding="utf-8")
    if re.findall(r'^version = "(.*)"$', text, re.MULTILINE) != [facts.version]:
        found.append(f"{manifest}: the version is not lib/goe.h's, {facts.version}")
    return found


def run(arguments: argparse.Namespace) -> int:
    facts = Facts()
    if arguments.check:
        found = differences(facts)
        print("\n".join(found) or f"manifests are those of version {facts.version}")
        return 1 if found else 0
    if arguments.write:
        for name in COMMITTED:
            (facts.root / name).write_text(committed_text(facts, name), encoding="utf-8")
        return 0
    words = Words(arguments.maintainer, arguments.url)
    for name in arguments.target or sorted(TARGETS):
        folder = arguments.out / name
        if folder.exists():
            raise ValueError(f"{folder} is there already")
        for staged in TARGETS[name](facts, words, folder):
            print(staged)
    return 0
