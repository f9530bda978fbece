"""The sentences of a header's comments, and of a page, as one line of text that anchors are looked for in."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from goe_tools.places import ROOT

PARAGRAPH = "\x00"  # between paragraphs while a text is made; a space in the end
RULE = re.compile(r"[-\s]*(\b[a-z-]+( [a-z-]+)*\b)?[-\s]*")  # a line that parts two sections, with its title
END_OF_SENTENCE = re.compile(rf"(?<=[.])\s+(?=[A-Z\"(0-9])|{PARAGRAPH}")
FEWEST_LETTERS = 3


@dataclass(frozen=True)
class Sentence:
    begin: int  # in the text
    end: int
    line: int  # in the file
    text: str


@dataclass(frozen=True)
class Text:
    plain: str  # without comment marks, every gap one space
    sentences: tuple[Sentence, ...]


def squeezed(text: str) -> str:
    return " ".join(text.split())


def comment_body(comment: str) -> str:
    """Without the stars that lines begin with; empty lines become the mark between paragraphs."""
    lines = [re.sub(r"^\s*\*?", "", line).strip() for line in comment.split("\n")]
    return " ".join(PARAGRAPH if not line or (RULE.fullmatch(line) and "--" in line) else line for line in lines)


def sentences_in(body: str, offset: int, line: int) -> list[Sentence]:
    found, begin = [], 0
    for end in [*(match.start() for match in END_OF_SENTENCE.finditer(body)), len(body)]:
        text = body[begin:end].strip(f" {PARAGRAPH}")
        if len(re.findall(r"[A-Za-z]", text)) >= FEWEST_LETTERS:
            at = body.index(text, begin)
            found.append(Sentence(offset + at, offset + at + len(text), line, text))
        begin = end
    return found


def text_of_code(source: str) -> Text:
    plain, sentences, at = "", [], 0
    for match in re.finditer(r"/\*(?!@)(.*?)\*/", source, re.DOTALL):
        plain += squeezed(source[at : match.start()]) + " "
        body = squeezed(comment_body(match[1]))
        if not ("--" in match[1] and RULE.fullmatch(match[1])):
            sentences += sentences_in(body, len(plain), source.count("\n", 0, match.start()) + 1)
        plain += body + " "
        at = match.end()
    return Text((plain + squeezed(source[at:])).replace(PARAGRAPH, " "), tuple(sentences))


@cache
def text_of(path: Path) -> Text:
    source = path.read_text(encoding="utf-8")
    if path.suffix in (".c", ".h"):
        return text_of_code(source)
    return Text(squeezed(source.replace("\\\n", " ")), ())


def found_at(anchor: str, source: str, root: Path = ROOT) -> list[tuple[int, int]]:
    """Where the words stand in the text of a source; gaps do not count."""
    plain, wanted = text_of(root / source).plain, squeezed(anchor)
    loose = re.compile(r"\s+".join(re.escape(word) for word in wanted.split()))
    return [match.span() for match in loose.finditer(plain)] if wanted else []
