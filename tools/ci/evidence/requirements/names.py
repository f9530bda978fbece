"""What the sources define: names of the interface, functions, tests."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from goe_tools.places import ROOT

HEADER = "lib/goe.h"
LIST = "lib/goe_settings_list.h"
NOT_OF_THE_INTERFACE = {"GOE_H", "GOE_NODISCARD"}
SETTINGS = {  # structures whose fields are settings, and are named by their path
    "goe_camera_t", "goe_navigation_t", "goe_detector_t", "goe_window_settings_t", "goe_refined_settings_t",
    "goe_settings_t",
}  # fmt: skip
CMAKE = ("CMakeLists.txt", "*.cmake")


@cache
def read(path: Path) -> str:
    return path.read_text(encoding="utf-8")


@cache
def without_comments(path: Path) -> str:
    return re.sub(r"/\*.*?\*/", " ", read(path), flags=re.DOTALL)


# ----------------------------------------------------------------------------------------------------- the interface


def fields(structure: str) -> list[str]:
    """Names of the fields in the body of a structure."""
    found = []
    for line in re.sub(r"^\s*#.*$", "", structure, flags=re.MULTILINE).split(";"):
        declaration = re.sub(r"\[[^\]]*\]", "", line).strip()
        found += re.findall(r"(\w+)\s*(?:,|$)", declaration) if declaration else []
    return found


def public_names(root: Path = ROOT) -> set[str]:
    """Functions, enumerators, constants and fields of goe.h, and the settings."""
    text = without_comments(root / HEADER)
    found = set(re.findall(r"^[\w *]*?\b(goe_\w+)\(", text, re.MULTILINE))
    for body in re.findall(r"\benum\s*\{(.*?)\}", text, re.DOTALL):
        found.update(re.findall(r"\b(GOE_\w+)", re.sub(r"=[^,}]*", "", body)))
    found.update(set(re.findall(r"^#\s*define\s+(GOE_\w+)", text, re.MULTILINE)) - NOT_OF_THE_INTERFACE)
    for body, name in re.findall(r"typedef struct \{(.*?)\} (goe_\w+);", text, re.DOTALL):
        if name not in SETTINGS:
            found.update(f"{name}.{field}" for field in fields(body))
    return found | settings(root)


def settings(root: Path = ROOT) -> set[str]:
    return set(re.findall(r"\bX\(([\w.\[\]]+), (?:REAL|COUNT|TRUTH|CHOICE),", without_comments(root / LIST)))


def equations_in(text: str) -> set[str]:
    """(7), (R21); of (R35) to (R38) all four."""
    found = set(re.findall(r"\((?:R[1-9]\d?|[1-8])\)", text))
    for kind, low, high in re.findall(r"\((R?)([1-9]\d?)\) to \(R?([1-9]\d?)\)", text):
        found.update(f"({kind}{number})" for number in range(int(low), int(high) + 1))
    return found


def equations(root: Path = ROOT) -> dict[str, str]:
    """Every equation that a source of the library or its theory names, and a file that does."""
    files = [*(root / "lib").rglob("*.[ch]"), *(root / "lib").glob("*/README.md")]
    return {name: str(path.relative_to(root)) for path in files for name in equations_in(read(path))}


# ---------------------------------------------------------------------------------------------------------- the code


def defines(path: Path, name: str) -> bool:
    """Whether a file has a function, a macro, a type, a table or, beside C, the words."""
    if path.suffix not in (".c", ".h"):
        return name in read(path)
    patterns = (
        rf"^\w[^\n;{{}}=]*\b{name}\([^;{{}}]*\)\s*\{{",  # a function
        rf"^[ \t]*#[ \t]*define {name}\b",
        rf"^static const [^;=]*\b{name}(\[\w*\])*\s*=",  # a table
        rf"^\}} {name};",  # a type
        rf"^    (?:[\w *]*\b)?{name}(?:\[\w+\])?(?:;|,| =|$)",  # a field or an enumerator
    )
    return any(re.search(pattern, without_comments(path), re.MULTILINE) for pattern in patterns)


# --------------------------------------------------------------------------------------------------------- the tests


@cache
def unity_tests(path: Path) -> tuple[str, ...]:
    return tuple(re.findall(r"\bRUN_TEST\((\w+)\)", without_comments(path)))


@cache
def python_tests(path: Path) -> tuple[str, ...]:
    return tuple(re.findall(r"^def (test_\w+)\(", read(path), re.MULTILINE))


@cache
def told_to_ctest(root: Path) -> str:
    folder = root / "tests"
    return "\n".join(read(path) for pattern in CMAKE for path in sorted(folder.rglob(pattern)))


def is_test(test: str, root: Path = ROOT) -> bool:
    """Whether the test is there: ctest:name, tests/x.sh, tests/x.c:function, tests/x.py::test_function, tests/x.c."""
    if test.startswith("ctest:"):
        return re.search(rf"(?<![\w-]){re.escape(test[len('ctest:') :])}(?![\w-])", told_to_ctest(root)) is not None
    name, _, function = test.replace("::", ":").partition(":")
    path = root / name
    if not path.is_file():
        return False
    if not function:
        return path.suffix in (".sh", ".c", ".cpp", ".py")
    return function in (python_tests(path) if path.suffix == ".py" else unity_tests(path))
