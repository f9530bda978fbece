"""The folders of lib/: includes go one way, down the floors, and never in a circle."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from goe_tools.places import PUBLIC_HEADERS

LIBRARY = Path(__file__).resolve().parents[2] / "lib"

# Floors, from the ground up. A file may include files of its own folder and of lower floors only; folders on the same
# floor must not include each other. "" is lib/ itself, with the contract at the bottom and the chain at the top.
FLOORS = [
    {"contract"},
    {"maths"},
    {"image"},
    {"window", "refined"},
    {"covariance"},
    {"hazard"},
    {"chain"},
]
CONTRACT = {*PUBLIC_HEADERS, "goe_state.h", "goe_settings_list.h"}
COVARIANCE = {"goe_guard.h", "goe_guard.c", "goe_latest.h", "goe_covariance.h", "goe_covariance.c"}


def folder_of(file: str) -> str:
    """The folder of a file, given by its path in lib/."""
    folder, _, name = file.rpartition("/")
    if folder:
        return folder
    return "contract" if name in CONTRACT else "covariance" if name in COVARIANCE else "chain"


def floor(file: str) -> int:
    return next(number for number, folders in enumerate(FLOORS) if folder_of(file) in folders)


def sources(library: Path) -> dict[str, set[str]]:
    """The include graph: each file of the library with the files that it includes, as paths in lib/."""
    files = {path.relative_to(library).as_posix(): path for path in sorted(library.rglob("*.[ch]"))}
    graph: dict[str, set[str]] = {}
    for name, path in files.items():
        included = set(re.findall(r'^ *# *include "([^"]+)"', path.read_text(encoding="utf-8"), flags=re.MULTILINE))
        unknown = included - set(files)
        assert not unknown, f"{name} includes {unknown}: not by its path in lib/"
        graph[name] = included
    return graph


def upward(graph: dict[str, set[str]]) -> list[str]:
    """Includes that go to a higher floor, or to another folder of the same floor."""
    return [
        f"{name} -> {target}"
        for name, targets in graph.items()
        for target in sorted(targets)
        if folder_of(target) != folder_of(name) and floor(target) >= floor(name)
    ]


def circle(graph: dict[str, set[str]]) -> list[str]:
    """Files that include each other in a circle; empty if there is none."""
    done: set[str] = set()
    path: list[str] = []

    def visit(name: str) -> list[str]:
        if name in path:
            return [*path[path.index(name) :], name]
        if name in done:
            return []
        path.append(name)
        for target in sorted(graph[name]):
            if found := visit(target):
                return found
        path.pop()
        done.add(name)
        return []

    for name in graph:
        if found := visit(name):
            return found
    return []


@pytest.fixture(scope="module")
def graph() -> dict[str, set[str]]:
    return sources(LIBRARY)


def test_every_file_has_a_floor(graph: dict[str, set[str]]) -> None:
    folders = set().union(*FLOORS)
    assert {name for name in graph if folder_of(name) not in folders} == set()


def test_includes_go_down(graph: dict[str, set[str]]) -> None:
    assert upward(graph) == []


def test_there_is_no_circle(graph: dict[str, set[str]]) -> None:
    assert circle(graph) == []


def test_every_header_is_included(graph: dict[str, set[str]]) -> None:
    included = set().union(*graph.values())
    assert {name for name in graph if name.endswith(".h")} - included == set()


def test_an_arrow_upwards_and_a_circle_are_noticed() -> None:
    graph = {
        "maths/goe_angle.h": {"image/goe_align.h"},
        "image/goe_align.h": {"goe.h"},
        "window/goe_fit.h": {"refined/goe_srif.h"},
        "refined/goe_srif.h": set(),
        "goe.h": {"maths/goe_angle.h"},
    }
    assert upward(graph) == [
        "maths/goe_angle.h -> image/goe_align.h",
        "window/goe_fit.h -> refined/goe_srif.h",
        "goe.h -> maths/goe_angle.h",
    ]
    assert circle(graph) == ["maths/goe_angle.h", "image/goe_align.h", "goe.h", "maths/goe_angle.h"]
