"""The command line: every command exists, and starting one does not import the others."""

from __future__ import annotations

import subprocess
import sys

import pytest
from bench import __main__ as bench
from ci import __main__ as ci
from goe_tools import __main__ as goe_tools
from goe_tools.cli import PACKAGES

MODULES = {"goe_tools": goe_tools, "bench": bench, "ci": ci}
HEAVY = ("matplotlib", "numpy", "rich", "scipy", "jinja2")


@pytest.mark.parametrize(("package", "name"), [(p, name) for p, module in MODULES.items() for name in module.COMMANDS])
def test_every_command_shows_its_arguments(package: str, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        MODULES[package].main([name, "--help"])
    assert stop.value.code == 0
    output = capsys.readouterr().out
    assert output.startswith(f"usage: {package} {name} ")
    assert MODULES[package].COMMANDS[name][1][1:] in " ".join(output.split())


def test_a_command_is_in_one_package() -> None:
    assert tuple(MODULES) == PACKAGES
    names = [name for module in MODULES.values() for name in module.COMMANDS]
    assert len(names) == len(set(names))


@pytest.mark.parametrize("package", MODULES)
@pytest.mark.parametrize("words", [["--help"], ["nothing"], []], ids=["help", "unknown", "none"])
def test_without_a_command_nothing_heavy_is_imported(package: str, words: list[str]) -> None:
    program = (
        f"import sys\nfrom {package}.__main__ import main\n"
        f"try:\n    main({words!r})\nexcept SystemExit as stop:\n    print(stop.code)\n"
        f"print([name for name in {HEAVY!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    code, imported = done.stdout.splitlines()[-2:]
    assert code == ("0" if words == ["--help"] else "2")
    assert imported == "[]"
    output = done.stdout + done.stderr  # the help or the error lists all commands
    assert all(name in output for name in MODULES[package].COMMANDS)
