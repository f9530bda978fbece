"""Words: every page, comment, message and help text of the repository is plain English, in American spelling.

The standard terms are in lib/GLOSSARY.md. A word that names something in code is not text: an identifier, a string
without a space, a word in backquotes.
"""

from __future__ import annotations

import ast
import fnmatch
import io
import re
import subprocess
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

# Pattern and the plain words to use.
BANNED = (
    (r"(un)?told|tells?", "report, state, show, give, provide"),
    (r"anew", "again"),
    (r"beside", "next to, in addition to; augmented state"),
    (r"stands? (for|in for)", "represent, replace"),
    (r"stands(?! (still|up\b))", "is"),
    (r"seen", "visible, detected, observed"),
    (r"rooms|room(?! (for|to|left|in)\b)", "folder; space"),
    (r"(is|are|was|were|be|been|being) asked|asks", "request, query"),
    (r"so that it", "so, therefore"),
    (r"none of an?", "not"),
    (r"what (is|was|are|were|has|had|goes|comes|lies|no|it is|they are)", "the noun for the thing"),
    (r"alike", "equal, similar, the same way"),
    (r"holds? (for|of|only|where|if|as long|too)", "is valid, applies"),
    (r"hears?|heard", "receive"),
)
ENDING_IN_IZE = "initial|normal|optim|minim|maxim|linear|recogn|organ|serial|synchron|quant|general|summar|real"
BRITISH = (
    (r"(kilo|centi|milli)?metres?", "meter"),
    (r"centre[ds]?|centring", "center"),
    (rf"({ENDING_IN_IZE})is(e[ds]?|ing|ations?)", "-ize"),
    (r"(colour|behaviour|neighbour|favour|honour)\w*", "-or"),
    (r"grey", "gray"),
    (r"licence[ds]?", "license"),
    (r"(analys|catalogu)(e[ds]?|ing)", "analyze, catalog"),
    (r"learnt", "learned"),
)
ANY = re.compile(rf"\b(?:{'|'.join(pattern for pattern, _ in (*BANNED, *BRITISH))})\b", re.IGNORECASE)
RULES = tuple((re.compile(rf"\b(?:{pattern})\b", re.IGNORECASE), instead) for pattern, instead in (*BANNED, *BRITISH))

# File (a pattern), phrase and reason of each justified use.
EXCEPTIONS: tuple[tuple[str, str, str], ...] = (
    ("tests/python/test_words.py", "*", "The rules themselves and their samples."),
    ("lib/GLOSSARY.md", "*", "Names the words that it replaces."),
    ("tools/bench/lies/__init__.py", "seen       the output of an ideal detector", "The name of a module."),
    ("tools/bench/optimum/rivals/track.py", "seen (K,6)", "The name of a field."),
)

# Folders and files whose text is not rewritten yet.
PENDING: tuple[str, ...] = ()

C_LIKE = {".c", ".h", ".cpp", ".hpp", ".ino", ".mjs", ".js", ".rs", ".css"}
HASH = {".sh", ".cmake", ".yml", ".yaml", ".toml", ".ini", ".conf", ".msg", ".defs", ".gitignore", ".txt"}
WHOLE = {".md", ".html", ".xml", ".cff", ".csv", ".properties"}
DATA = ("tests/data/", "tests/finds/", "tests/fuzz/corpus/", "tests/evidence/", "tests/c/golden/")

C_TEXT = re.compile(r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`", re.DOTALL)
LUA_TEXT = re.compile(r"--[^\n]*|\"(?:\\.|[^\"\\\n])*\"")
HASH_TEXT = re.compile(r"#[^\n]*|\"(?:\\.|[^\"\\\n])*\"")
FENCE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
# Words in backquotes, addresses, identifiers, options, marks, names in XML, expressions of Jinja.
CODE = re.compile(
    r"`[^`\n]*`|\]\([^)\s]*\)|https?://\S+|\w+(?:(?:\.|->|::)\w+)+|\b\w*_\w*\b|\b\w+\(\)|--[a-z][a-z-]*"
    r"|\[\w[\w., ]*\]|name=\"\w+\"|\{\{.*?\}\}|\{%.*?%\}"
)


def _lines(text: str, first: int) -> Iterator[tuple[int, str]]:
    yield from enumerate(text.split("\n"), first)


def _matches(pattern: re.Pattern[str], text: str) -> Iterator[tuple[int, str]]:
    """The comments and the strings with a space in them."""
    for match in pattern.finditer(text):
        found = match.group(0)
        if found[0] not in "\"'`" or " " in found:
            yield from _lines(found, text.count("\n", 0, match.start()) + 1)


def _of_python(text: str) -> Iterator[tuple[int, str]]:
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        is_text = token.type == tokenize.STRING and " " in token.string
        if token.type == tokenize.COMMENT or is_text or tokenize.tok_name[token.type] == "FSTRING_MIDDLE":
            yield from _lines(token.string, token.start[0])


def texts(path: str, text: str) -> Iterator[tuple[int, str]]:
    """Line numbers and lines of the text that a person reads in a file."""
    name = path.removesuffix(".j2").removesuffix(".in")
    kind = Path(name).suffix
    if kind == ".md":
        yield from _lines(FENCE.sub(lambda m: "\n" * m.group(0).count("\n"), text), 1)
    elif kind in (".py", ".pyi") and not path.endswith(".j2"):
        ast.parse(text)
        yield from _of_python(text)
    elif kind in C_LIKE:
        yield from _matches(C_TEXT, text)
    elif kind == ".lua":
        yield from _matches(LUA_TEXT, text)
    elif kind in HASH or Path(name).name in ("Makefile", "Doxyfile", ".clang-format"):
        yield from _matches(HASH_TEXT, text)
    elif kind in WHOLE or Path(name).name == "Kconfig":
        yield from _lines(text, 1)


def findings(path: str, text: str) -> list[str]:
    """Each banned word of a file: file:line, the word, its plain words, the line."""
    found = []
    for number, line in texts(path, text):
        plain = CODE.sub(" ", line)
        if not ANY.search(plain):
            continue
        for rule, instead in RULES:
            for match in rule.finditer(plain):
                phrase = match.group(0)
                if not _is_exception(path, line):
                    found.append(f"{path}:{number}: '{phrase}' (plain: {instead}): {line.strip()[:160]}")
    return found


def _is_exception(path: str, line: str) -> bool:
    return any(fnmatch.fnmatch(path, file) and (phrase == "*" or phrase in line) for file, phrase, _ in EXCEPTIONS)


def _paths() -> list[str]:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [path for path in listed.splitlines() if not path.startswith(DATA) and (ROOT / path).is_file()]


def _read(path: str) -> str | None:
    try:
        return (ROOT / path).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return None


def test_every_text_is_plain() -> None:
    found = []
    for path in _paths():
        text = None if path.startswith(PENDING) else _read(path)
        if text is not None:
            found += findings(path, text)
    assert not found, f"{len(found)} words of the private dialect:\n" + "\n".join(found)


def test_every_exception_is_used() -> None:
    paths = _paths()
    unused = [
        (file, phrase)
        for file, phrase, reason in EXCEPTIONS
        if not reason
        or not any(fnmatch.fnmatch(path, file) and (phrase == "*" or phrase in (_read(path) or "")) for path in paths)
    ]
    assert not unused


SAMPLES = (
    ("a.c", "/* The answer is told. */\nint told;\n", [1]),
    ("a.c", 'int seen;\nconst char *text = "a wall is seen";\n', [2]),
    ("a.c", 'const char *name = "seen"; /* box.seen, `seen`, is_seen() */\n', []),
    ("a.c", "/* A house that stands still,\n * from its centre. */\n", [2]),
    ("a.md", "A page.\n```c\nint beside; /* told */\n```\nThe room of the filter.\n", [5]),
    ("a.md", "See [the list](what/is/told.md). There is room for two.\n", []),
    ("a.py", '"""It tells\n\nwhat is wrong."""\ntold = 1  # alike\n', [1, 3, 4]),
    ("a.rs", "/// So that it is heard.\nlet anew = 1;\n", [1, 1]),
    ("a.lua", 'local told = "is asked for" -- anew\n', [1, 1]),
    ("a.cmake", "# what goes on\nset(told 1)\n", [1]),
    ("Kconfig", "config GOE\n    help\n      None of a detector's boxes.\n", [3]),
    ("a.xml", "<description>Behaviour in metres</description>\n", [1, 1]),
    ("a.h.j2", "/* Initialised with {{ told }} */\n", [1]),
)


@pytest.mark.parametrize(("path", "text", "lines"), SAMPLES)
def test_a_sample_is_found(path: str, text: str, lines: list[int]) -> None:
    found = [int(finding.split(":")[1]) for finding in findings(path, text)]
    assert sorted(found) == lines
