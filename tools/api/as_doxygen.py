"""Converts a header for Doxygen, to standard output: python as_doxygen.py HEADER.

The headers are the manual and keep plain C comments. Here the first comment of a file becomes its description, with
unchanged layout; a comment before or after a declaration becomes its description. Separator lines remain comments.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

COMMENT = re.compile(r"/\*(.*?)\*/", re.DOTALL)
RULER = re.compile(r"-{20,}")
MARKS = re.compile(r" ?\[[A-Z]\d+(?:, ?[A-Z]\d+)*\]")  # marks that join promises and tests
NAME = r"\w+(?:\[\w+\])*"
SHARED = re.compile(rf"^( +)(\w+) ({NAME}(?:, {NAME})+); +/\*(.*?)\*/", re.MULTILINE | re.DOTALL)
SPECIAL = re.compile(r"([\\@<>#%&$\"])")


def plain(text: str) -> str:
    """Escapes Doxygen's special characters."""
    return SPECIAL.sub(r"\\\1", text)


def described(text: str) -> str:
    lines = [re.sub(r"^\s*\* ?", "", line) for line in text.split("\n")]
    return plain("\n".join(lines).strip())


def one_by_one(match: re.Match[str]) -> str:
    """Gives each member of a declaration a copy of the common comment."""
    indent, kind, names, text = match.groups()
    *others, last = names.split(", ")
    short = " ".join(re.sub(r"\n\s*\* ?", " ", text).split())
    return indent + "".join(f"{kind} {name}; /* {short} */ " for name in others) + f"{kind} {last}; /*{text}*/"


def converted(source: str, name: str) -> str:
    """The output has two more lines than the source, at its head: a warning for line N is about line N - 2."""
    first = True
    source = SHARED.sub(one_by_one, source)

    def replaced(match: re.Match[str]) -> str:
        nonlocal first
        text = MARKS.sub("", match[1])
        before = source[source.rfind("\n", 0, match.start()) + 1 : match.start()]
        if first:
            first = False
            body = "\n".join(re.sub(r"^ \*", "", line) for line in text.strip("\n").split("\n"))
            return f"/** @file {name}\n@verbatim\n{body}\n@endverbatim */"
        if RULER.search(text):
            return match[0]
        return f"/**< {described(text)} */" if before.strip() else f"/** {described(text)} */"

    return COMMENT.sub(replaced, source)


if __name__ == "__main__":
    path = Path(sys.argv[1])
    sys.stdout.write(converted(path.read_text(encoding="utf-8"), path.name))
