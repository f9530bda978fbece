"""Python tests that a change affects: ``python -m ci affected`` prints their files for ``tools/test.sh --quick``.

A test file is affected if it changed, if it imports a changed module, directly or through one other module, or if
it names a changed file. A change of the library or the flight layer also affects the tests of the package goe, and a
change of a page the tests of all pages. Deeper dependencies are covered by the whole run only. The changed tests come
first.
"""

from __future__ import annotations

import argparse
import ast
import functools
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
IMPORTED_FROM = (ROOT / "tools", *sorted({path.parent for path in (ROOT / "tests").rglob("test_*.py")}))
DEPTH = 2  # longest chain of imports from a test to a changed module
LIBRARY = ("lib/", "port/flight/", "port/python/")
LIBRARY_TESTS = ("tests/python/test_port_python.py", "tests/python/test_port_python_golden.py")
PAGE_TESTS = ("tests/python/test_words.py", "tests/python/test_readme_commands.py")


def git(*arguments: str) -> list[str]:
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


def base() -> str:
    """GOE_SINCE, or the commit where this branch left main, or the commit before the newest."""
    if "GOE_SINCE" in os.environ:
        return os.environ["GOE_SINCE"]
    branch = git("rev-parse", "--abbrev-ref", "HEAD")[0]
    if branch != "main" and git("branch", "--list", "main"):
        return git("merge-base", "HEAD", "main")[0]
    return "HEAD~1"


def changed() -> set[str]:
    """Paths of all files that differ from the base: committed, in the work tree, or not yet added."""
    return {*git("diff", "--name-only", base()), *git("ls-files", "--others", "--exclude-standard")}


def imported_names(path: Path, package: list[str]) -> Iterator[str]:
    """Modules that a file may import, as dotted names."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            parts = [*above, *([node.module] if node.module else [])]
            yield ".".join(parts)
            yield from (".".join([*parts, alias.name]) for alias in node.names)


def modules() -> dict[str, Path]:
    found = {}
    for root in IMPORTED_FROM:
        for path in root.rglob("*.py"):
            parts = path.relative_to(root).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@functools.lru_cache(maxsize=1)
def imports() -> dict[Path, set[Path]]:
    """By module: the project's modules that it imports. Every file is parsed once a process."""
    by_name = modules()
    return {
        path: {by_name[name] for name in imported_names(path, module.split(".")[:-1]) if name in by_name}
        for module, path in by_name.items()
    }


def names_of(path: str) -> tuple[str, ...]:
    """What a test calls the file: its name, or that of a page with its folder."""
    parts = ("ROOT", *Path(path).parts)
    if parts[-1] == "CMakeLists.txt":
        return ()
    if parts[-1] == "README.md":
        return f"{parts[-2]}/README.md", f'{parts[-2]}" / "README.md"', f'{parts[-2]} / "README.md"'
    return (parts[-1],)


def affected(paths: set[str]) -> list[str]:
    """Test files that these changes affect."""
    by_name, uses = modules(), imports()
    tests = {path for path in by_name.values() if path.name.startswith("test_")}
    hit = {ROOT / path for path in paths}
    for _ in range(DEPTH):
        hit |= {path for path, used in uses.items() if used & hit}
    names = {name for path in paths for name in names_of(path)}
    found = (tests & hit) | {test for test in tests if any(name in test.read_text(encoding="utf-8") for name in names)}
    if any(path.startswith(LIBRARY) for path in paths):
        found |= {ROOT / path for path in LIBRARY_TESTS}
    if any(path.endswith(".md") for path in paths):
        found |= {ROOT / path for path in PAGE_TESTS}
    ordered = sorted(str(path.relative_to(ROOT)) for path in found)
    return sorted(ordered, key=lambda path: path not in paths)


def add_arguments(_: argparse.ArgumentParser) -> None:
    """No arguments."""


def run(_: argparse.Namespace) -> int:
    for path in affected(changed()):
        print(path)
    return 0
