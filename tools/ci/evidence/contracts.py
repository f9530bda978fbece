"""ACSL contracts that only require valid pointers: generated from the signatures, in a copy for Frama-C.

A contract at a function replaces the generated one, for pointers that may be null, for lengths and for ranges.
Lines keep their numbers. tests/proof/README.md has the rules.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

from goe_tools.places import PUBLIC_HEADERS

FUNCTION = re.compile(  # static in a .c file or inline in a header; a prototype in a header
    r"^(?P<head>(?:\w+ +)*?\w[\w ]*[ *]+\**)(?P<name>\w+)\((?P<parameters>[^;{}()]*)\)[ \n]*[;{]", re.MULTILINE
)
NO_FUNCTION = ("return", "typedef", "else")
PARAMETER = re.compile(
    r"(?P<const>const )?(?P<type>(?:unsigned )?\w+) (?P<stars>\**)(?:const )?(?P<name>\w+)(?P<runs>\[.*)?"
)
ARRAYS = {"goe_covariance_t": "[GOE_QUANTITIES]"}  # types that are arrays
OPEN = {  # further conditions of every such structure, once it is filled in
    "goe_faults_t": "goe_faults_are_open",
    "goe_observation_t": "goe_observation_is_open",
    "goe_rows_t": "goe_rows_hold",
    "goe_solid_t": "goe_solid_is_closed",
    "goe_view_t": "goe_view_is_open",
}
WRITTEN = ("goe_observation_t", "goe_view_t")  # for these also the structure itself, if it is not const


def blank(match: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", match[0])


def without_comments(text: str) -> str:
    """Without comments and directives; everything else keeps its place."""
    text = re.sub(r"/\*.*?\*/", blank, text, flags=re.DOTALL)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*$", blank, text, flags=re.MULTILINE)


def is_static(function: re.Match[str]) -> bool:
    return "static" in function["head"].split()


def functions(text: str, is_source: bool) -> Iterator[re.Match[str]]:
    """Functions with their contract in this file: external ones have it in the header."""
    for match in FUNCTION.finditer(without_comments(text)):
        if not match["head"].startswith(NO_FUNCTION) and (is_static(match) or not is_source):
            yield match


def clause(parameter: str, public: bool) -> str:
    """The clause that a pointer is valid; "" for another parameter."""
    match = PARAMETER.fullmatch(" ".join(parameter.split()))
    runs = match and (match["runs"] or ("" if match["stars"] else ARRAYS.get(match["type"], "")))
    if not match or not (match["stars"] or runs):
        return ""
    name, valid = match["name"], r"\valid_read" if match["const"] and match["stars"] != "**" else r"\valid"
    if runs:
        length = re.sub(r"\b(restrict|static) ", "", runs[1 : runs.index("]")])
        last = str(int(length) - 1) if length.isdigit() else f"{length} - 1"
        text = f"{valid}({name} + (0 .. {last}))"
    elif match["type"] in OPEN:
        written = match["type"] in WRITTEN and not match["const"]
        text = (rf"\valid({name}) && " if written else "") + f"{OPEN[match['type']]}({name})"
    else:
        text = f"{valid}({name})"
    return rf"{name} == \null || {text}" if public else text


def contract(parameters: str, public: bool) -> str:
    clauses = [text for parameter in parameters.split(",") if (text := clause(parameter, public))]
    return f"/*@ {' '.join(f'requires {text};' for text in clauses)} */ " if clauses else ""


def has_contract(before: str) -> bool:
    """Whether the text before a function ends with one."""
    comment = before.rstrip().rpartition("/*")[2]
    return comment.endswith("*/") and comment.startswith("@") and "requires" in comment


def with_contracts(text: str, name: str) -> str:
    found, at = "", 0
    for match in functions(text, name.endswith(".c")):
        if not has_contract(text[: match.start()]):
            found += text[at : match.start()] + contract(match["parameters"], name in PUBLIC_HEADERS)
            at = match.start()
    return found + text[at:]


def copy(library: Path, to: Path) -> None:
    """Copies the library and adds a contract to each function with a pointer parameter."""
    shutil.rmtree(to, ignore_errors=True)
    for path in library.rglob("*.[ch]"):
        target = to / path.relative_to(library)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(with_contracts(path.read_text(encoding="utf-8"), path.name), encoding="utf-8")
