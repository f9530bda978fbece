"""The examples compile with the commands of their page, and print the output that it shows."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "port" / "examples" / "README.md").read_text(encoding="utf-8")
LINES = re.findall(r"^cc (.*) -o (\w+)$", PAGE, re.MULTILINE)


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler cc")
@pytest.mark.parametrize(("line", "name"), LINES, ids=[name for _, name in LINES])
def test_a_line_of_the_page(line: str, name: str, tmp_path: Path) -> None:
    program = tmp_path / name
    subprocess.run(f"cc {line} -o {program}", shell=True, check=True, cwd=ROOT)
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    (text,) = re.findall(rf"^## {name}\n.*?```text\n(.*?)```", PAGE, re.MULTILINE | re.DOTALL)
    assert printed == text
