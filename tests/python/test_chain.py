"""The commands of the tools' README from a flight to its estimates, one after the other, as a user types them."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from autopilot_logs import Flown, ulog_topics, write_detections, write_ulog

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ROOT / "build" / "sim_host"

CHAIN, EXAMPLE = ("convert", "goe_replay", "table", "view"), ("goe_sim",)

pytest.importorskip("pyulog", reason="pyulog is not installed (tools/setup.sh)")


def blocks() -> list[list[str]]:
    """The commands of each block: the chain, and goe_sim in place of its first command."""
    page = (ROOT / "tools" / "goe_tools" / "README.md").read_text(encoding="utf-8")
    section = page.split("## From a flight to its estimates")[1].split("\n## ")[0]
    return [text.splitlines() for text in re.findall(r"^```sh\n(.*?)^```$", section, re.MULTILINE | re.DOTALL)]


@pytest.mark.parametrize("simulated", [False, True])
def test_the_chain_of_the_readme(tmp_path: Path, simulated: bool) -> None:
    if not (PROGRAMS / "goe_sim").is_file():
        pytest.skip("nothing is built in build/ (tools/test.sh builds)")
    chain, example = blocks()
    for commands, names in ((chain, CHAIN), (example, EXAMPLE)):
        assert len(commands) == len(names) and all(name in line for name, line in zip(names, commands))
    if not simulated:
        write_ulog(tmp_path / "flight.ulg", ulog_topics(Flown()))
        write_detections(tmp_path, Flown(), 0.0)
    path = os.pathsep.join([str(PROGRAMS), str(Path(sys.executable).parent), os.environ["PATH"]])
    for command in [*example, *chain[1:]] if simulated else chain:
        done = subprocess.run(
            command.split(), cwd=tmp_path, env={**os.environ, "PATH": path}, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"
        assert "warning" not in done.stderr
    assert (tmp_path / "log.html").read_text(encoding="utf-8").rstrip().endswith("</html>")
