"""The packages in tools/ and their folders: imports go down, never in circles, and a long file has one idea.

``ci`` may use ``bench`` and ``goe_tools``, ``bench`` may use ``goe_tools``, and ``goe_tools`` neither."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
from bench.__main__ import COMMANDS as BENCH_COMMANDS
from ci.__main__ import COMMANDS as CI_COMMANDS
from goe_tools.__main__ import COMMANDS
from goe_tools.cli import PACKAGES

TOOLS = Path(__file__).resolve().parents[2] / "tools"
COMMANDS_OF = {"goe_tools": COMMANDS, "bench": BENCH_COMMANDS, "ci": CI_COMMANDS}

# From the ground up. A file or folder imports from lower floors only, not from others on its own floor.
FLOORS = {
    "goe_tools": (
        ("__init__", "places", "spread"),
        ("renamed",),
        ("logs",),
        ("flights", "double_precision"),
        ("library",),
        ("models",),
        ("view",),
        ("report", "live", "exchange", "montecarlo", "noise"),
        ("cli",),
        ("__main__",),
    ),
    "bench": (
        ("__init__", "running"),
        ("count_plugin",),
        ("attack", "lies"),
        ("reference", "optimum", "peers"),
        ("__main__",),
    ),
    "ci": (
        ("__init__",),
        ("settings_header",),
        ("affected", "cost", "embed_logs", "packages", "settings_table", "tidy_commands"),
        ("evidence",),
        ("__main__",),
    ),
}

MOST_LINES = 500
LONG: dict[str, str] = {}  # file and its one idea

Module = tuple[str, ...]  # ("logs", "obslog"); of a folder's __init__.py: ("logs", "__init__")
Graph = dict[str, set[str]]


def imported_names(tree: ast.AST) -> Iterator[str]:
    """Names of absolute imports, also of those inside functions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield node.module or ""


def against_the_direction(tools: Path) -> list[str]:
    """Files of a package that import a package above it."""
    found = []
    for number, package in enumerate(PACKAGES):
        above = set(PACKAGES[number + 1 :])
        for path in sorted((tools / package).rglob("*.py")):
            for name in imported_names(ast.parse(path.read_text(encoding="utf-8"))):
                if name.split(".")[0] in above:
                    found.append(f"{path.relative_to(tools).as_posix()} imports {name}")
    return found


def folders_of(modules: Iterable[Module]) -> set[Module]:
    """Every folder that contains one of the modules at any depth."""
    return {module[:depth] for module in modules for depth in range(len(module))}


def sources(package: Path) -> dict[Module, Path]:
    return {path.relative_to(package).with_suffix("").parts: path for path in sorted(package.rglob("*.py"))}


def imported(module: Module, path: Path, known: dict[Module, Path], package_name: str) -> Iterator[Module]:
    """The modules of the package that a module imports, also those inside functions."""
    folders = folders_of(known)

    def found(name: Module) -> Module:
        """The module of that name, the folder's __init__.py, or the module that defines the name."""
        if name in known:
            return name
        return (*name, "__init__") if name in folders else found(name[:-1])

    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                first, *rest = alias.name.split(".")
                if first == package_name:
                    yield found(tuple(rest))
        elif isinstance(node, ast.ImportFrom):
            start = tuple(node.module.split(".")) if node.module else ()
            if node.level:
                start = (*module[: len(module) - node.level], *start)
            elif start[:1] == (package_name,):
                start = start[1:]
            else:
                continue
            for alias in node.names:
                yield found((*start, alias.name))


def imports(package: Path) -> set[tuple[Module, Module]]:
    known = sources(package)
    return {(m, target) for m, path in known.items() for target in imported(m, path, known, package.name)}


def side_by_side(edges: set[tuple[Module, Module]], folder: Module) -> Graph:
    """The files and folders directly in a folder, and the imports between them."""
    graph: Graph = {}
    depth = len(folder)
    for source, target in edges:
        if source[:depth] == folder == target[:depth] and source[depth] != target[depth]:
            graph.setdefault(source[depth], set()).add(target[depth])
    return graph


def circles(package: Path) -> list[str]:
    edges, found = imports(package), []
    for folder in sorted(folders_of(sources(package))):
        try:
            TopologicalSorter(side_by_side(edges, folder)).prepare()
        except CycleError as error:
            found.append(f"{'/'.join((package.name, *folder))}: {' <- '.join(error.args[1])}")
    return found


def upwards(edges: set[tuple[Module, Module]], floors: tuple[tuple[str, ...], ...]) -> list[str]:
    """Imports that do not go to a lower floor, and files or folders without a floor."""
    floor = {place: number for number, places in enumerate(floors) for place in places}
    found = []
    for source, target in sorted(edges):
        places = [module[0] for module in (source, target)]
        for place in places:
            if place not in floor:
                found.append(f"{place}: say in FLOORS on which floor it is")
        if places[0] != places[1] and floor.get(places[0], 0) <= floor.get(places[1], 0):
            found.append(f"{'/'.join(source)} imports {'/'.join(target)}")
    return found


def test_packages_import_in_one_direction() -> None:
    assert set(PACKAGES) == set(FLOORS)
    assert against_the_direction(TOOLS) == []


@pytest.mark.parametrize("package", PACKAGES)
def test_imports_go_to_lower_floors(package: str) -> None:
    edges = imports(TOOLS / package)
    commands = {(("__main__",), tuple(name.strip(".").split("."))) for name, _ in COMMANDS_OF[package].values()}
    assert upwards(edges | commands, FLOORS[package]) == []


def test_imports_are_found() -> None:
    edges = imports(TOOLS / "goe_tools")
    assert (("report", "page"), ("report", "figures", "__init__")) in edges  # a folder's __init__.py
    assert (("models", "model"), ("logs", "obslog")) in edges  # ... and a module of another folder
    text = (TOOLS / "bench" / "optimum" / "goals" / "boxes.py").read_text(encoding="utf-8")
    assert "goe_tools.flights.boxes" in imported_names(ast.parse(text))  # ... and in another package


@pytest.mark.parametrize("package", PACKAGES)
def test_no_circles_at_any_level(package: str) -> None:
    assert circles(TOOLS / package) == []


@pytest.mark.parametrize("package", PACKAGES)
def test_every_command_is_a_module(package: str) -> None:
    known = sources(TOOLS / package)
    for module_name, _ in COMMANDS_OF[package].values():
        name = tuple(module_name.strip(".").split("."))
        assert name in known or (*name, "__init__") in known, module_name


@pytest.mark.parametrize("package", PACKAGES)
def test_each_module_has_a_floor_and_a_line_in_the_readme(package: str) -> None:
    text = (TOOLS / package / "README.md").read_text(encoding="utf-8")
    for place in {module[0] for module in sources(TOOLS / package)}:
        assert any(place in places for places in FLOORS[package]), place
        if (TOOLS / package / place).is_dir():
            assert f"`{place}/`" in text or f"`{place}.py`" in text, place


def test_a_long_file_has_one_idea() -> None:
    files = [path for package in PACKAGES for path in sources(TOOLS / package).values()]
    assert len(files) > 50
    long = [p for p in files if len(p.read_text(encoding="utf-8").splitlines()) > MOST_LINES and p.name not in LONG]
    assert long == [], "split it, or name its one idea in LONG"


# ------------------------------------------------------------------------------------------------ the checks themselves


def write(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = folder / "house" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder / "house"


@pytest.mark.parametrize(
    "back",
    ["from ..logs.b import y", "from ..logs import b", "from .. import logs", "from house.logs import b",
     "import house.logs.b", "def f():\n    from ..logs.b import y"],
)  # fmt: skip
def test_a_circle_between_folders_is_found(tmp_path: Path, back: str) -> None:
    files = {"logs/a.py": "", "logs/b.py": "from ..report import a", "report/a.py": "from logs import b"}
    house = write(tmp_path, files)
    assert circles(house) == []  # another package's logs
    write(tmp_path, {"report/a.py": back})
    (message,) = circles(house)
    assert message.startswith("house: ") and "logs" in message and "report" in message


@pytest.mark.parametrize(
    ("file", "text", "name"),
    [
        ("goe_tools/logs/a.py", "def f():\n    from bench.attack import rows", "bench.attack"),
        ("goe_tools/a.py", "import ci.affected as b", "ci.affected"),
        ("bench/attack/a.py", "from ci import cost", "ci"),
    ],
)
def test_an_import_against_the_direction_is_found(tmp_path: Path, file: str, text: str, name: str) -> None:
    files = {
        "goe_tools/places.py": "",
        "bench/b.py": "from goe_tools import places",
        "ci/c.py": "import bench.b\nfrom goe_tools import places",
        "bench/d.py": "from .ci import c",
        file: text,
    }
    for place, content in files.items():
        (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / place).write_text(content)
    assert against_the_direction(tmp_path) == [f"{file} imports {name}"]


def test_an_import_upwards_is_found(tmp_path: Path) -> None:
    files = {
        "logs/b.py": "from ..report.a import x",
        "report/a.py": "",
        "optimum/c.py": "from .. import logs",
        "reference/d.py": "from ..optimum import c",
        "cellar/e.py": "from ..logs.b import x",
    }
    floors = (("logs",), ("reference", "optimum"), ("report",))
    assert upwards(imports(write(tmp_path, files)), floors) == [
        "cellar: say in FLOORS on which floor it is",
        "cellar/e imports logs/b",
        "logs/b imports report/a",
        "reference/d imports optimum/c",
    ]


def test_a_circle_of_files_is_found(tmp_path: Path) -> None:
    files = {"logs/a.py": "from .b import x", "logs/b.py": "from . import c", "logs/c.py": "from .a import y"}
    (message,) = circles(write(tmp_path, files))
    assert message.startswith("house/logs: ")
