"""Runs programs and returns what they print."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EMULATOR_SECONDS = 600


class LedgerError(RuntimeError):
    """A figure cannot be had, or is not what it must be."""


def output_of(command: Sequence[str | Path], cwd: Path | None = None) -> str:
    """Standard output of a command; LedgerError with what it printed if it fails."""
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True)
    if done.returncode != 0:
        raise LedgerError(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def emulated(command: Sequence[str]) -> str:
    """All that an emulator prints: the image's console is standard output or error, as the machine has it."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=EMULATOR_SECONDS)
    if done.returncode != 0:
        raise LedgerError(f"{' '.join(command)}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr
