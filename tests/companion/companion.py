"""The program under test: its configuration, its process, what it said and what it used."""

from __future__ import annotations

import csv
import os
import re
import signal
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("GOE_COMPANION", str(ROOT / "build" / "port" / "companion" / "goe_companion"))
REPLAY = os.environ.get("GOE_REPLAY", str(ROOT / "build" / "sim_host" / "goe_replay"))
TICKS_S = os.sysconf("SC_CLK_TCK")
SANITIZED_KIB = 12000  # resident; without a sanitizer it is a third of this
Settings = Mapping[str, Mapping[str, Any]]


def is_missing() -> bool:
    """A path that the caller named must exist: without the program the tests fail then."""
    return "GOE_COMPANION" not in os.environ and not Path(PROGRAM).exists()


def ini(settings: Settings) -> str:
    sections = (
        f"[{section}]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())
        for section, keys in settings.items()
    )
    return "\n".join(sections)


def call(*arguments: str | Path, stdin: int = subprocess.DEVNULL) -> subprocess.CompletedProcess[str]:
    """A call that ends by itself."""
    return subprocess.run(
        [PROGRAM, *map(str, arguments)], stdin=stdin, capture_output=True, text=True, timeout=20, check=False
    )


def replay(log: Path) -> list[dict[str, str]]:
    """A log as goe_replay reads it; skipped where that is not built."""
    if "GOE_REPLAY" not in os.environ and not Path(REPLAY).exists():
        pytest.skip(f"{REPLAY} is not built")
    done = subprocess.run([REPLAY, str(log)], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return list(csv.DictReader(done.stdout.splitlines()))


@dataclass(frozen=True)
class Ended:
    """What is left of a run."""

    status: int
    out: str
    err: str

    @property
    def said(self) -> str:
        return self.out + self.err

    def count(self, name: str) -> int:
        """Of the summary: rows of a name, a number and what it counts."""
        rows = re.findall(r"^(\w+) +(\d+)\b", self.out, re.MULTILINE)
        assert name in dict(rows), self.out
        return int(dict(rows)[name])


class Companion:
    """One process at a time; start() again after an end is a restart."""

    def __init__(self, folder: Path, settings: Settings, camera: str) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder, self.configuration = folder, folder / "companion.ini"
        self.configuration.write_text(ini(settings), encoding="utf-8")
        (folder / "camera.ini").write_text(camera, encoding="utf-8")
        self.process: subprocess.Popen[bytes] | None = None
        self.ends: list[Ended] = []

    def start(self, stdin: int = subprocess.DEVNULL, arguments: Sequence[str] = ()) -> None:
        with self._output("out", "wb") as out, self._output("err", "wb") as err:
            command = [PROGRAM, *arguments, str(self.configuration)]
            self.process = subprocess.Popen(command, stdin=stdin, stdout=out, stderr=err)

    def _output(self, name: str, mode: str) -> Any:
        return open(self.folder / f"{name}.{len(self.ends)}", mode)

    @property
    def pid(self) -> int:
        assert self.process
        return self.process.pid

    def alive(self) -> bool:
        return self.process is not None and self.process.poll() is None

    def stop(self, number: int = signal.SIGINT) -> Ended:
        """Interrupts it, and waits for what it has to say."""
        assert self.process
        if self.alive():
            self.process.send_signal(number)
        try:
            status = self.process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            status = -999  # it did not end
        texts = []
        for name in ("out", "err"):
            with self._output(name, "rb") as file:
                texts.append(file.read().decode(errors="replace"))
        self.process = None
        self.ends.append(Ended(status, *texts))
        return self.ends[-1]

    def rss_kib(self) -> int:
        """Resident memory; 0: it has ended."""
        try:
            lines = Path(f"/proc/{self.pid}/status").read_text(encoding="ascii").splitlines()
        except OSError:
            return 0
        return next((int(line.split()[1]) for line in lines if line.startswith("VmRSS:")), 0)

    def processor_s(self) -> float:
        """Processor time so far, user's and system's."""
        fields = Path(f"/proc/{self.pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / TICKS_S

    def files(self) -> int:
        return len(os.listdir(f"/proc/{self.pid}/fd"))


def wait_until_ready(companions: Sequence[Companion], seconds: float = 0.5) -> None:
    """Lets the processes get to their loops."""
    time.sleep(seconds)
    for companion in companions:
        assert companion.alive(), companion.stop()
