"""Runs programs and returns their output."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EMULATOR_SECONDS = 600


class LedgerError(RuntimeError):
    """A figure cannot be determined, or has a wrong value."""


def output_of(command: Sequence[str | Path], cwd: Path | None = None) -> str:
    """Standard output of a command; raises LedgerError with its output if it fails."""
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True)
    if done.returncode != 0:
        raise LedgerError(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def emulated(command: Sequence[str]) -> str:
    """All output of an emulator: the image's console is standard output or error, depending on the machine."""

    done = subprocess.run(command, capture_output=True, text=True, timeout=EMULATOR_SECONDS)
    if done.returncode != 0:
        raise LedgerError(f"{' '.join(command)}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr
