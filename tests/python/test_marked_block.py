"""Blocks of pages that commands write: the text around them stays."""

from __future__ import annotations

from pathlib import Path

import pytest
from goe_tools.logs.fields import LogError
from goe_tools.logs.marked_block import MarkedBlock

BLOCK = MarkedBlock("figures")


def test_only_the_text_between_the_marks_changes(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(f"before\n{BLOCK.begin}\nold\n{BLOCK.end}\nbehind\n", encoding="utf-8")
    BLOCK.write(page, "new\n")
    assert page.read_text(encoding="utf-8") == f"before\n{BLOCK.begin}\nnew\n{BLOCK.end}\nbehind\n"
    assert BLOCK.of(page) == "new"
    assert BLOCK.around(page) == "before\n\nbehind\n"


@pytest.mark.parametrize(
    "text",
    [
        "no marks\n",
        f"{BLOCK.begin}\nno end\n",
        f"{BLOCK.end}\n{BLOCK.begin}\n",
        f"{BLOCK.begin}\n{BLOCK.end}\n{BLOCK.begin}\n{BLOCK.end}\n",
    ],
)
def test_a_page_without_the_marks_is_left_as_it_is(tmp_path: Path, text: str) -> None:
    page = tmp_path / "page.md"
    page.write_text(text, encoding="utf-8")
    with pytest.raises(LogError, match=r"page\.md: needs the lines <!-- figures: begin --> and"):
        BLOCK.write(page, "new")
    assert page.read_text(encoding="utf-8") == text
