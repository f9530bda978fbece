"""Stage packages, or check and write the manifests and tables in the tree.

python -m ci packages --out DIR [--target NAME]... [--maintainer "NAME <ADDRESS>"] [--url URL]
python -m ci packages --check
python -m ci packages --write
python -m ci packages --sbom FILE
"""

from __future__ import annotations

import argparse
from pathlib import Path

from goe_tools.logs.whole_file import write_whole

from .facts import Facts
from .installed import Sources
from .sbom import as_text, make
from .staging import Words
from .targets import COMMITTED, TABLES, TARGETS


def add_arguments(parser: argparse.ArgumentParser) -> None:
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--out", type=Path, metavar="DIR", help="stage to DIR/<target>/goe, which must not exist")
    what.add_argument("--check", action="store_true", help="fail if a manifest in the tree differs")
    what.add_argument("--write", action="store_true", help="write the manifests in the tree")
    what.add_argument("--sbom", type=Path, metavar="FILE", help="write the bill of materials, CycloneDX as JSON")
    parser.add_argument("--target", action="append", choices=sorted(TARGETS), help="only this one; may be repeated")
    parser.add_argument("--maintainer", help="maintainer of the packages (default: the goe authors)")
    parser.add_argument("--url", help="home page (default: that in CMakeLists.txt)")


def differences(facts: Facts) -> list[str]:
    """Manifests and tables in the tree that differ from the library."""
    return [
        f"{name}: differs from the sources of version {facts.version}; run python -m ci packages --write"
        for name, text in (COMMITTED | TABLES).items()
        if (facts.root / name).read_text(encoding="utf-8") != text(facts)
    ]


def stage(facts: Facts, words: Words, out: Path, names: list[str]) -> None:
    folders = {name: out / name for name in names}
    for folder in folders.values():
        if folder.exists():
            raise ValueError(f"{folder} exists already")
    for name, folder in folders.items():
        for staged in TARGETS[name](facts, words, folder):
            print(staged)


def run(arguments: argparse.Namespace) -> int:
    facts = Facts()
    if not arguments.out and (arguments.target or arguments.maintainer or arguments.url):
        raise ValueError("--target, --maintainer and --url require --out")
    if arguments.check:
        found = differences(facts)
        print("\n".join(found) or f"manifests are those of version {facts.version}")
        return 1 if found else 0
    if arguments.sbom:
        write_whole(arguments.sbom, as_text(make(facts, Sources())))
        return 0
    if arguments.write:
        for name, text in (COMMITTED | TABLES).items():
            (facts.root / name).write_text(text(facts), encoding="utf-8")
        return 0
    words = Words(arguments.maintainer or Words.maintainer, arguments.url or facts.url)
    stage(facts, words, arguments.out, sorted(set(arguments.target or TARGETS)))
    return 0
