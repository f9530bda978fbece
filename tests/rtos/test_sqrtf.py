"""The square root of port/sqrtf rounds correctly, in integers and by the instruction."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from kconfig_of import ROOT

HERE = Path(__file__).resolve().parent


@pytest.mark.parametrize("flags", [["-DGOE_SQRTF_IN_INTEGERS"], []], ids=["integers", "hardware"])
def test_every_root_is_right(flags: list[str], tmp_path: Path) -> None:
    program = tmp_path / "sqrtf"
    subprocess.run(
        ["cc", "-O2", "-fno-math-errno", "-Wall", "-Wextra", "-Werror", *flags, f"-I{ROOT / 'port' / 'sqrtf'}",
         HERE / "sqrtf_main.c", ROOT / "port" / "sqrtf" / "goe_sqrtf.c", "-lm", "-o", program],
        check=True,
    )  # fmt: skip
    text = subprocess.run([program], capture_output=True, text=True, timeout=300).stdout
    tried, wrong = (int(word) for word in text.splitlines()[-1].split() if word.isdigit())
    assert wrong == 0, text
    assert tried > 50_000_000
