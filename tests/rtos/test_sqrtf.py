"""The square root of port/sqrtf in integers rounds correctly. tests/targets runs it on a processor, too."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from kconfig_of import ROOT

HERE = Path(__file__).resolve().parent
SQRTF = ROOT / "port" / "sqrtf"
WARNINGS = ("-Wall", "-Wextra", "-Werror")


def compile_root(folder: Path, *flags: str) -> Path:
    made = folder / "goe_sqrtf.o"
    subprocess.run(["cc", "-c", *WARNINGS, *flags, SQRTF / "goe_sqrtf.c", "-o", made], check=True)
    return made


@pytest.mark.parametrize(
    "flags", [pytest.param(["-O2"], marks=pytest.mark.release), ["-O2", "-ffast-math"]], ids=["O2", "fast-math"]
)
def test_every_root_is_right(flags: list[str], tmp_path: Path) -> None:
    """The reference, the host's own sqrtf, is compiled and linked without the flags."""
    integers = "-DGOE_SQRTF_IN_INTEGERS"
    root, program = compile_root(tmp_path, *flags, integers), tmp_path / "sqrtf"
    other = ["-O2", "-fno-math-errno", integers, *WARNINGS, f"-I{SQRTF}", HERE / "sqrtf_main.c"]
    subprocess.run(["cc", *other, root, "-lm", "-o", program], check=True)
    text = subprocess.run([program], capture_output=True, text=True, timeout=1800).stdout
    tried, wrong = (int(word) for word in text.splitlines()[-1].split() if word.isdigit())
    assert wrong == 0, text
    assert tried > 50_000_000


@pytest.mark.parametrize(
    "flags",
    [["-fno-math-errno"], [], ["-fno-math-errno", "-DGOE_SQRTF_IN_INTEGERS"]],
    ids=["no-errno", "errno", "integers"],
)
@pytest.mark.parametrize("has_header", [True, False], ids=["header", "no-header"])
def test_no_root_calls_the_c_library(flags: list[str], has_header: bool, tmp_path: Path) -> None:
    """It replaces a slow one. Its own file accepts all flags of the library's files."""
    caller = tmp_path / "caller.c"
    caller.write_text("#include <math.h>\nfloat half(float x);\nfloat half(float x) { return 0.5f * sqrtf(x); }\n")
    common = ["-O2", *WARNINGS, *flags, "-Dsqrtf=goe_sqrtf", f"-I{SQRTF}"]
    if has_header:
        common += ["-include", "goe_sqrtf.h"]
    made = tmp_path / "caller.o"
    subprocess.run(["cc", "-c", *common, caller, "-o", made], check=True)
    root = compile_root(tmp_path, *common)
    symbols = subprocess.run(["nm", made, root], check=True, capture_output=True, text=True).stdout
    assert " T goe_sqrtf\n" in symbols
    assert " U sqrtf\n" not in symbols
