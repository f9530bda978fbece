"""The command line: every command is there, and starting one does not import the others."""

from __future__ import annotations

import subprocess
import sys

import pytest
from goe_tools.__main__ import COMMANDS, main

HEAVY = ("matplotlib", "numpy", "rich", "scipy", "jinja2")


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_tells_its_arguments(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main([name, "--help"])
    assert stop.value.code == 0
    told = capsys.readouterr().out
    assert told.startswith(f"usage: goe_tools {name} ") and COMMANDS[name][1][1:] in " ".join(told.split())


@pytest.mark.parametrize("words", [["--help"], ["nothing"], []], ids=["help", "unknown", "none"])
def test_without_a_command_nothing_heavy_is_imported(words: list[str]) -> None:
    program = (
        "import sys\nfrom goe_tools.__main__ import main\n"
        f"try:\n    main({words!r})\nexcept SystemExit as stop:\n    print(stop.code)\n"
        f"print([name for name in {HEAVY!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    code, imported = done.stdout.splitlines()[-2:]
    assert code == ("0" if words == ["--help"] else "2")
    assert imported == "[]"
    assert all(name in done.stdout + done.stderr for name in COMMANDS)  # the help, or the error, names them
