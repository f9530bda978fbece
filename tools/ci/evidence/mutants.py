"""Small changes of C sources, found in clang's syntax tree.

Macro expansions, declarations, static asserts and comments are left alone: a change is in a function's
body or in a table of numbers, in text written there. A named constant is changed at its use.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from goe_tools.places import ROOT

from .parts import NotHereError

CLANG = "clang-19"
FLAGS = ("-std=c99", "-Ilib", "-DGOE_WINDOW_MAX=8")
LIBRARY = ROOT / "lib"

Node = dict[str, Any]

OPERATORS: dict[str, tuple[str, ...]] = {
    "<": ("<=", ">"),
    "<=": ("<", ">"),
    ">": (">=", "<"),
    ">=": (">", "<"),
    "==": ("!=",),
    "!=": ("==",),
    "+": ("-",),
    "-": ("+",),
    "*": ("/",),
    "/": ("*",),
    "&&": ("||",),
    "||": ("&&",),
    "&": ("|",),
    "|": ("&",),
    "<<": (">>",),
    ">>": ("<<",),
    "+=": ("-=",),
    "-=": ("+=",),
    "*=": ("/=",),
    "/=": ("*=",),
    "|=": ("&=",),
    "&=": ("|=",),
}
LARGER = ("goe_larger", "goe_larger_bits")
ORDER_IS_FREE = (*LARGER, "goe_xz_dot", "goe_flight_larger", "goe_flight_smaller", "dot")
UNREAD = ("StaticAssertDecl", "UnaryExprOrTypeTraitExpr", "OffsetOfExpr", "TypedefDecl", "RecordDecl", "EnumDecl")
REMOVED = ("BinaryOperator", "CompoundAssignOperator", "CallExpr", "UnaryOperator", "CStyleCastExpr")
JUMPS = ("ReturnStmt", "ContinueStmt", "BreakStmt")
NUMBERS = re.compile(r"_Bool|float|double|(unsigned |signed )?(char|short|int|long|long long)|unsigned")
TOP_BEGIN, TOP_END = "    {\n", ("    },\n", "    }\n")  # of a top-level declaration in clang's JSON
FAMILIES = {  # by kind; operators other than comparisons: "arithmetic and logic"
    "removed statement": "statement removed",
    "removed jump": "return, continue or break removed",
    "swapped arguments": "arguments swapped",
    "dropped call": "call dropped",
    "negated condition": "condition negated",
    "other enumerator": "enumerator or flag inverted",
    "inverted flag": "enumerator or flag inverted",
    **{f"operator {sign}": "comparison" for sign in ("<", "<=", ">", ">=", "==", "!=")},
}


@dataclass(frozen=True)
class Mutant:
    """A change of the bytes from ``begin`` to before ``end`` of a file."""

    file: str  # "refined/goe_box.c", in lib/
    function: str  # "" for a table
    begin: int
    end: int
    text: str  # the replacement
    kind: str
    source: str  # the changed lines, with white space reduced to single blanks
    mutation: str  # the same lines after the change

    @property
    def key(self) -> tuple[str, str, str, str]:
        """Its identity as long as its lines do not change."""
        return self.file, self.function, self.source, self.mutation

    @property
    def family(self) -> str:
        return "constant" if self.kind.startswith("constant") else FAMILIES.get(self.kind, "arithmetic and logic")


def sources(folder: Path = LIBRARY) -> list[str]:
    """Files with functions, in a fixed order."""
    headers = [path for path in folder.rglob("*.h") if "static inline" in path.read_text(encoding="utf-8")]
    return sorted(str(path.relative_to(folder)) for path in [*folder.rglob("*.c"), *headers])


def declarations(file: str, folder: Path = LIBRARY, flags: Sequence[str] = ()) -> tuple[list[Node], dict[str, str]]:
    """clang's syntax tree of one source or header: its own declarations; and for each enumerator another one of its
    enumeration. Headers of others, whose tree is 200 MB in some files, are not decoded."""
    if shutil.which(CLANG) is None:
        raise NotHereError(CLANG)
    command = [CLANG, *FLAGS[:1], f"-I{folder}", *(flags or FLAGS[2:]), "-w", "-fsyntax-only"]
    command += ["-Xclang", "-ast-dump=json", "-x", "c", str(folder / file)]
    found: list[Node] = []
    others: dict[str, str] = {}
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as clang:
        assert clang.stdout
        for text in top_level(clang.stdout):
            if "EnumConstantDecl" in text or not is_of_another_file(text):
                node: Node = json.loads(text)
                others.update(next_names(node))
                found.append(node)
    if clang.returncode:
        raise RuntimeError(f"{CLANG} refuses {folder / file}")
    return found, others


def top_level(lines: Iterable[str]) -> Iterator[str]:
    """The text of each declaration of a translation unit."""
    text: list[str] = []
    for line in lines:
        if line == TOP_BEGIN:
            text = [line]
        elif line in TOP_END and text:
            yield "".join([*text, "    }"])
            text = []
        elif text:
            text.append(line)


def is_of_another_file(text: str) -> bool:
    """By the range, which precedes the parts of a declaration; a declaration that starts with a macro is decoded."""
    place = text.partition('"kind"')[2].partition('"inner"')[0]
    return "includedFrom" in place and "expansionLoc" not in place


def next_names(node: Node) -> dict[str, str]:
    """For an enumeration: each name with the next one."""
    if node.get("kind") != "EnumDecl":
        return {}
    names = [part["name"] for part in node.get("inner", []) if part.get("kind") == "EnumConstantDecl"]
    return dict(zip(names, [*names[1:], names[0]])) if len(names) > 1 else {}


def mutants(file: str, folder: Path = LIBRARY, flags: Sequence[str] = ()) -> list[Mutant]:
    """All mutants of a file, by place, then by kind."""
    text = (folder / file).read_text(encoding="ascii")
    nodes, others = declarations(file, folder, flags)
    found = Finder(file, text, others)
    for node in nodes:
        found.top(node)
    unique = {(m.begin, m.end, m.text): m for m in found.mutants}
    return sorted(unique.values(), key=lambda m: (m.begin, m.end, m.kind, m.text))


def apply(mutant: Mutant, text: str) -> str:
    return text[: mutant.begin] + mutant.text + text[mutant.end :]


class Finder:
    """Walks the tree of one file."""

    def __init__(self, file: str, text: str, other_enumerators: dict[str, str]) -> None:
        self.file = file
        self.text = text
        self.other_enumerators = other_enumerators
        self.function = ""
        self.mutants: list[Mutant] = []

    def top(self, node: Node) -> None:
        if not self.is_here(node):
            return
        if node.get("kind") == "FunctionDecl":
            self.function = node["name"]
            for part in node.get("inner", []):
                if part.get("kind") == "CompoundStmt":
                    self.walk(part, node)
        elif node.get("kind") == "VarDecl":
            self.function = ""
            self.walk(node)

    # ---------------------------------------------------------------------------------------------------------- places

    @staticmethod
    def is_here(node: Node) -> bool:
        """Whether the node is in the file itself, not in an included one."""
        begin = node.get("range", {}).get("begin", {})
        return "offset" in at(begin) and "includedFrom" not in at(begin)

    @staticmethod
    def is_written(node: Node) -> bool:
        """Whether both ends are in the text itself, not in a macro."""
        ends = node.get("range", {})
        return all("offset" in ends.get(end, {}) and "includedFrom" not in ends[end] for end in ("begin", "end"))

    def span(self, node: Node) -> tuple[int, int]:
        """Range of a node that may be a macro's name: from its first to after its last character."""
        begin, end = (at(node["range"][name]) for name in ("begin", "end"))
        stop = end["offset"] + end["tokLen"]
        if "expansionLoc" in node["range"]["end"] and self.text[stop : stop + 1] == "(":
            stop = self.closing(stop) + 1  # a macro with arguments
        return begin["offset"], stop

    def closing(self, opening: int) -> int:
        depth = 0
        for place in range(opening, len(self.text)):
            depth += {"(": 1, ")": -1}.get(self.text[place], 0)
            if depth == 0:
                return place
        raise ValueError(f"{self.file}: an open bracket at {opening}")

    def add(self, kind: str, begin: int, end: int, text: str) -> None:
        first = self.text.rfind("\n", 0, begin) + 1
        last = self.text.find("\n", end)
        before = self.text[first:last]
        after = self.text[first:begin] + text + self.text[end:last]
        if before != after:
            self.mutants.append(
                Mutant(self.file, self.function, begin, end, text, kind, one_line(before), one_line(after))
            )

    # ----------------------------------------------------------------------------------------------------------- nodes

    def walk(self, node: Node, parent: Node | None = None) -> None:
        kind = node.get("kind")
        if kind in UNREAD or not self.is_here(node):
            return
        made = getattr(self, f"of_{kind}", None)
        if made:
            made(node, parent)
        if kind == "CompoundStmt":
            self.removals(node)
            self.jumps(node, ends_function=(parent or {}).get("kind") == "FunctionDecl")
        elif kind == "CaseStmt":
            self.jumps(node, ends_function=False)
        for condition in conditions(node):
            if self.is_written(condition):
                self.negate(condition)
        for part in node.get("inner", []):
            self.walk(part, node)

    def negate(self, condition: Node) -> None:
        begin, end = self.span(condition)
        self.add("negated condition", begin, end, f"!({self.text[begin:end]})")

    def removals(self, block: Node) -> None:
        for statement in block.get("inner", []):
            if statement.get("kind") not in REMOVED or not self.is_written(statement):
                continue
            begin, end = self.span(statement)
            if self.text[end : end + 1] == ";":
                self.add("removed statement", begin, end, "")

    def jumps(self, block: Node, ends_function: bool) -> None:
        """Removes jumps, except one that ends a function, which would then lack a return value."""
        statements = block.get("inner", [])
        for statement in statements[:-1] if ends_function else statements:
            if statement.get("kind") in JUMPS and self.is_written(statement):
                begin, end = self.span(statement)
                self.add("removed jump", begin, end, "")

    def of_BinaryOperator(self, node: Node, _parent: Node | None) -> None:
        left, right = node["inner"]
        if not (self.is_here(left) and self.is_here(right)):
            return
        begin, end = self.span(left)[1], self.span(right)[0]
        between = self.text[begin:end]
        place = between.find(node["opcode"])
        if place < 0 or "/*" in between:
            return
        place += begin
        for other in OPERATORS.get(node["opcode"], ()):
            self.add(f"operator {node['opcode']}", place, place + len(node["opcode"]), other)

    of_CompoundAssignOperator = of_BinaryOperator

    def of_UnaryOperator(self, node: Node, _parent: Node | None) -> None:
        if not self.is_written(node):
            return
        begin, end = self.span(node)
        opcode = node["opcode"]
        place = begin if not node.get("isPostfix") else end - len(opcode)
        if self.text[place : place + len(opcode)] != opcode:
            return
        if opcode in ("-", "!"):
            self.add(f"removed {opcode}", place, place + 1, "")
        elif opcode in ("++", "--"):
            self.add(f"operator {opcode}", place, place + 2, {"++": "--", "--": "++"}[opcode])

    def of_FloatingLiteral(self, node: Node, _parent: Node | None) -> None:
        self.constants(node)

    def of_IntegerLiteral(self, node: Node, _parent: Node | None) -> None:
        self.constants(node)

    def constants(self, node: Node) -> None:
        begin, end = self.span(node)
        text = self.text[begin:end]
        if self.is_written(node):
            for kind, other in other_numbers(text):
                self.add(kind, begin, end, other)
        elif text in ("true", "false"):
            self.add("inverted flag", begin, end, "false" if text == "true" else "true")
        elif re.fullmatch(r"[A-Z][A-Z0-9_]*", text):
            self.add("constant x 2", begin, end, f"(2 * {text})")
            self.add("constant + 1", begin, end, f"({text} + 1)")

    def of_DeclRefExpr(self, node: Node, _parent: Node | None) -> None:
        name = node.get("referencedDecl", {}).get("name", "")
        if name in self.other_enumerators and self.is_written(node):
            begin, end = self.span(node)
            self.add("other enumerator", begin, end, self.other_enumerators[name])

    def of_ArraySubscriptExpr(self, node: Node, _parent: Node | None) -> None:
        index = node["inner"][1]
        if index.get("kind") == "IntegerLiteral" or not self.is_here(index):
            return
        begin, end = self.span(index)
        written = self.text[begin:end]
        self.add("index + 1", begin, end, f"{written} + 1")
        self.add("index - 1", begin, end, f"{written} - 1")

    def of_CallExpr(self, node: Node, parent: Node | None) -> None:
        callee, *arguments = node["inner"]
        if not self.is_written(node) or not all(self.is_here(argument) for argument in arguments):
            return
        name = callee_name(callee)
        spans = [self.span(argument) for argument in arguments]
        texts = [self.text[begin:end] for begin, end in spans]
        if name in LARGER:
            begin, end = self.span(node)
            self.add("smaller for larger", begin, end, "({0} < {1} ? {0} : {1})".format(*texts))
        if is_value_used(parent):
            self.drop_call(node, arguments, texts)
        if name in ORDER_IS_FREE:
            return
        for i in range(len(arguments) - 1):
            if type_of(arguments[i]) == type_of(arguments[i + 1]):
                (begin, middle), (after, end) = spans[i], spans[i + 1]
                swapped = texts[i + 1] + self.text[middle:after] + texts[i]
                self.add("swapped arguments", begin, end, swapped)

    def drop_call(self, node: Node, arguments: list[Node], texts: list[str]) -> None:
        """Replaces a call by its first argument, or 0."""
        begin, end = self.span(node)
        if arguments and type_of(arguments[0]) == type_of(node):
            self.add("dropped call", begin, end, f"({texts[0]})")
        elif NUMBERS.fullmatch(type_of(node)):
            self.add("dropped call", begin, end, "false" if type_of(node) == "_Bool" else "0")


def at(end: Node) -> Node:
    """Place of an end of a range in the file."""
    place: Node = end.get("expansionLoc", end)
    return place


def one_line(text: str) -> str:
    return re.sub(r"\s+", " ", text).strip()


def type_of(node: Node) -> str:
    found = node.get("type", {})
    return str(found.get("desugaredQualType", found.get("qualType", id(node))))


def is_value_used(parent: Node | None) -> bool:
    """Whether the parent uses the value of a call."""
    kind = (parent or {}).get("kind")
    return kind != "CompoundStmt" and not (kind == "CStyleCastExpr" and type_of(parent or {}) == "void")


def callee_name(node: Node) -> str:
    while node.get("kind") != "DeclRefExpr" and node.get("inner"):
        node = node["inner"][0]
    return str(node.get("referencedDecl", {}).get("name", ""))


def conditions(node: Node) -> Iterator[Node]:
    """The conditions of a statement or an expression."""
    parts = node.get("inner", [])
    kind = node.get("kind")
    if kind in ("IfStmt", "WhileStmt", "ConditionalOperator"):
        yield parts[0]
    elif kind == "ForStmt" and len(parts) == 5 and parts[2]:
        yield parts[2]


def other_numbers(text: str) -> Iterator[tuple[str, str]]:
    """Other values for a literal, with its suffix: 0 for 1, twice as much, the other sign, another last digit."""
    whole = re.fullmatch(r"(\d+)([uUlL]*)", text)
    real = re.fullmatch(r"(\d+\.\d+)((?:e[-+]?\d+)?)(f?)", text)
    if whole:
        value, suffix = int(whole[1]), whole[2]
        yield "constant 0 and 1", f"{1 - value if value in (0, 1) else 0}{suffix}"
        if value > 1:
            yield "constant x 2", f"{2 * value}{suffix}"
        yield "constant + 1", f"{value + 1}{suffix}"
    elif real:
        digits, power, suffix = real.groups()
        value = float(digits)
        if value == 0.0:
            yield "constant 0 and 1", f"1.0{suffix}"
            return
        yield "constant x 2", f"{2.0 * value!r}{power}{suffix}"
        yield "constant's sign", f"(-{text})"
        last = digits[:-1] + str((int(digits[-1]) + 1) % 10)
        yield "constant's last digit", f"{last}{power}{suffix}"
        if value == 1.0 and not power:
            yield "constant 0 and 1", f"0.0{suffix}"
