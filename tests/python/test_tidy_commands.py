"""One compile command for each source (ci.tidy_commands)."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from ci.__main__ import main


def command(file: str, output: str) -> dict[str, str]:
    return {"directory": "/build", "file": file, "command": f"cc -c {file}", "output": output}


def test_the_first_command_of_a_source_is_kept(tmp_path: Path) -> None:
    commands = [command("/lib/a.c", "goe"), command("/lib/b.c", "goe"), command("/build/../lib/a.c", "goe_double")]
    (tmp_path / "compile_commands.json").write_text(json.dumps(commands))
    assert main(["tidy_commands", str(tmp_path), str(tmp_path / "out")]) == 0
    kept = json.loads((tmp_path / "out" / "compile_commands.json").read_text())
    assert [(entry["file"], entry["output"]) for entry in kept] == [("/lib/a.c", "goe"), ("/lib/b.c", "goe")]


def test_a_folder_without_commands_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tidy_commands", str(tmp_path), str(tmp_path / "out")]) == 2
    assert "compile_commands.json: No such file" in capsys.readouterr().err
