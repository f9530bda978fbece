"""Error messages of the three tool packages for a mistyped command line."""

from __future__ import annotations

import subprocess
import sys

import pytest
from bench.__main__ import main as bench_main
from ci.__main__ import main as ci_main
from goe_tools.__main__ import main
from goe_tools.cli import commands_of

MAIN = {"goe_tools": main, "bench": bench_main, "ci": ci_main}


@pytest.mark.parametrize(
    ("package", "words", "guess"),
    [
        ("goe_tools", ["tabel"], "did you mean table?"),
        ("goe_tools", ["table", "estimates.csv", "--thruth", "truth.csv"], "did you mean --truth?"),
        ("goe_tools", ["table", "estimates.csv", "--colour"], ""),
        ("bench", ["goals", "--quik"], "did you mean --quick?"),
        ("bench", ["goals", "--half", "setle"], ""),
        ("goe_tools", ["golden"], "did you mean python -m bench golden?"),
        ("goe_tools", ["ledgr"], "did you mean python -m ci ledger?"),
        ("bench", ["tabel"], "did you mean python -m goe_tools table?"),
        ("bench", ["settings", "--check", "x"], "did you mean python -m ci settings?"),
        ("ci", ["view", "log"], "did you mean python -m goe_tools view?"),
        ("ci", ["goals"], "did you mean python -m bench goals?"),
        ("ci", ["xyzzy"], ""),
    ],
)
def test_a_mistyped_word(package: str, words: list[str], guess: str, capsys) -> None:
    with pytest.raises(SystemExit) as end:
        MAIN[package](words)
    assert end.value.code == 2
    text = capsys.readouterr().err.strip()
    assert text.endswith(guess) and ("did you mean" in text) == bool(guess)


def test_a_package_that_is_not_installed_has_no_commands() -> None:
    assert commands_of("goe_tools_of_nobody") == ()


INTERRUPTED_IMPORT = """
import os, runpy, signal, sys

package, module, *words = sys.argv[1:]

class Hook:
    def find_spec(self, name, path=None, target=None):
        if name == module:
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Hook())
sys.argv = [package, *words]
runpy.run_module(package, run_name="__main__", alter_sys=True)
"""


@pytest.mark.parametrize(
    ("package", "module", "words"),
    [
        ("goe_tools", "goe_tools.cli", ["view", "log"]),
        ("goe_tools", "goe_tools.view.command", ["view", "log"]),
        ("bench", "goe_tools.cli", ["goals"]),
        ("ci", "ci.packages.command", ["packages", "--check"]),
    ],
)
def test_ctrl_c_during_the_imports_ends_it_without_a_traceback(package: str, module: str, words: list[str]) -> None:
    command = [sys.executable, "-c", INTERRUPTED_IMPORT, package, module, *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")
