"""The program under test: its configuration, its process in simulated time, its output and its resources."""

from __future__ import annotations

import contextlib
import csv
import functools
import os
import re
import signal
import socket
import struct
import subprocess
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from loop import HANG_S, UNIX_AHEAD_US, Loop

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("GOE_COMPANION", str(ROOT / "build" / "port" / "companion" / "goe_companion"))
REPLAY = os.environ.get("GOE_REPLAY", str(ROOT / "build" / "sim_host" / "goe_replay"))
IDLE = struct.Struct("=qqq")  # idle_t of stepped_time.c
SANITIZED_KIB = 12000  # resident memory; without a sanitizer it is a third of this
Settings = Mapping[str, Mapping[str, Any]]


def is_missing() -> bool:
    """A path that the caller named must exist: without the program the tests fail."""
    return "GOE_COMPANION" not in os.environ and not Path(PROGRAM).exists()


def ini(settings: Settings) -> str:
    sections = (
        f"[{section}]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())
        for section, keys in settings.items()
    )
    return "\n".join(sections)


def call(*arguments: str | Path, stdin: int = subprocess.DEVNULL) -> subprocess.CompletedProcess[str]:
    """Runs a call that ends by itself."""
    return subprocess.run(
        [PROGRAM, *map(str, arguments)], stdin=stdin, capture_output=True, text=True, timeout=HANG_S, check=False
    )


def replay(log: Path) -> list[dict[str, str]]:
    """Replays a log with goe_replay; skips the test without the program."""
    if "GOE_REPLAY" not in os.environ and not Path(REPLAY).exists():
        pytest.skip(f"{REPLAY} is not built")
    done = subprocess.run([REPLAY, str(log)], capture_output=True, text=True, timeout=HANG_S, check=False)
    assert done.returncode == 0, done.stderr
    return list(csv.DictReader(done.stdout.splitlines()))


@functools.lru_cache(maxsize=1)
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="goe_companion")


@functools.lru_cache(maxsize=1)
def stepped_time() -> Path:
    """The preloaded library that gives a program the time of a loop, compiled once."""
    made = Path(_folder().name) / "stepped_time.so"
    source = Path(__file__).with_name("stepped_time.c")
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-Wall", "-Wextra", source, "-o", made, "-ldl"], check=True)
    return made


@dataclass(frozen=True)
class Ended:
    """Output, files and status of an ended run."""

    status: int
    out: str
    err: str

    @property
    def said(self) -> str:
        return self.out + self.err

    def count(self, name: str) -> int:
        """A counter of the summary, whose rows consist of a name, a number and a description."""
        rows = re.findall(r"^(\w+) +(\d+)\b", self.out, re.MULTILINE)
        assert name in dict(rows), self.out
        return int(dict(rows)[name])


class Companion:
    """One process at a time, in the loop's time; start() after an end is a restart.

    `waits` counts how often the process waited for input.
    """

    def __init__(self, loop: Loop, folder: Path, settings: Settings, camera: str) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.loop, self.folder, self.configuration = loop, folder, folder / "companion.ini"
        self.until_us = self.waits = 0
        self.unix_ahead_us = UNIX_AHEAD_US
        self.control: socket.socket | None = None
        self.on_written: Callable[[int], None] | None = None  # called with the number of bytes written to terminals
        self.configuration.write_text(ini(settings), encoding="utf-8")
        (folder / "camera.ini").write_text(camera, encoding="utf-8")
        self.process: subprocess.Popen[bytes] | None = None
        self.ends: list[Ended] = []

    def start(self, stdin: int = subprocess.DEVNULL, arguments: Sequence[str] = ()) -> None:
        """Returns once the process waits for input, or has ended."""
        self.control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.control.settimeout(HANG_S)
        environment = {
            **os.environ,
            "LD_PRELOAD": str(stepped_time()),
            "ASAN_OPTIONS": f"{os.environ.get('ASAN_OPTIONS', '')}:verify_asan_link_order=0",
            "GOE_STEPPED_TIME": f"{theirs.fileno()} {self.loop.now_us} {self.unix_ahead_us}",
        }
        command = [PROGRAM, *arguments, str(self.configuration)]
        with theirs, self._output("out", "wb") as out, self._output("err", "wb") as err:
            self.process = subprocess.Popen(
                command, stdin=stdin, stdout=out, stderr=err, env=environment, pass_fds=[theirs.fileno()]
            )
        self.wait_until_idle()
        if self.control:
            self.loop.join(self)

    def go_on(self, now_us: int) -> None:
        if self.control:
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                self.control.send(struct.pack("=q", now_us))

    def wait_until_idle(self) -> None:
        try:
            received = self.control.recv(IDLE.size) if self.control else b""
        except ConnectionResetError:
            received = b""
        if not received:  # the process ends
            self._let_go()
            if self.process:
                self.process.wait(timeout=HANG_S)
            return
        self.until_us, self.waits, written = IDLE.unpack(received)
        assert self.until_us > self.loop.now_us, "it does not wait: a busy loop"
        if self.on_written:
            self.on_written(written)

    def _let_go(self) -> None:
        """For a process that has ended or is about to end."""
        self.loop.leave(self)
        if self.control:
            self.control.close()
            self.control = None

    def _output(self, name: str, mode: str) -> Any:
        return open(self.folder / f"{name}.{len(self.ends)}", mode)

    @property
    def pid(self) -> int:
        assert self.process
        return self.process.pid

    def alive(self) -> bool:
        return self.process is not None and self.process.poll() is None

    def interrupt(self, number: int) -> int:
        """Sends this signal and waits for the end. Returns the exit status."""
        assert self.process
        if self.alive():
            self.process.send_signal(number)
            self.go_on(self.loop.now_us)  # the signal may have come just before it began to wait
        status = self.process.wait(timeout=HANG_S)
        self._let_go()
        return status

    def stop(self, number: int = signal.SIGINT) -> Ended:
        """Interrupts the process and collects its output."""
        assert self.process
        try:
            status = self.interrupt(number)
        except subprocess.TimeoutExpired:
            self._let_go()
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
        """Resident memory; 0 after its end."""
        try:
            lines = Path(f"/proc/{self.pid}/status").read_text(encoding="ascii").splitlines()
        except OSError:
            return 0
        return next((int(line.split()[1]) for line in lines if line.startswith("VmRSS:")), 0)

    def processor_s(self) -> float:
        """User and system time so far."""
        fields = Path(f"/proc/{self.pid}/schedstat").read_text(encoding="ascii").split()
        return int(fields[0]) * 1e-9

    def files(self) -> int:
        return len(os.listdir(f"/proc/{self.pid}/fd"))
