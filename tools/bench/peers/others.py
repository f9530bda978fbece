"""Finds the solvers that are installed here."""

from __future__ import annotations

import argparse
import subprocess
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Others:
    """Options to include them; None: not installed. cmsis_dsp: the folder of their sources."""

    eigen: tuple[str, ...] | None
    lapack: bool
    cmsis_dsp: Path | None
    tinyekf: tuple[str, ...] | None


def has_header(name: str) -> bool:
    found = subprocess.run(["cc", "-E", "-x", "c", "-"], input=f"#include <{name}>\n", text=True, capture_output=True)
    return found.returncode == 0


def tinyekf_folder(named: Path) -> Path:
    found = next((path.parent for path in sorted(named.rglob("tinyekf.h"))), None)
    if found is None:
        raise ValueError(f"--tinyekf {named}: contains no tinyekf.h")
    return found


def find_others(arguments: argparse.Namespace) -> Others:
    """Reports the missing ones."""
    eigen = (arguments.eigen / "Eigen" / "Dense").exists()
    lapack = has_header("lapacke.h")
    if not eigen:
        print(f"skipped: Eigen: no {arguments.eigen}/Eigen/Dense (libeigen3-dev)")
    if not lapack:
        print("skipped: LAPACK: no lapacke.h (liblapacke-dev)")
    if not arguments.cmsis_dsp:
        print("skipped: CMSIS-DSP: give its sources with --cmsis-dsp")
    if not arguments.tinyekf:
        print("skipped: TinyEKF: give its sources with --tinyekf")
    return Others(
        # without a heap: the Cortex-M4F's images have none, and would fail
        (f"-isystem{arguments.eigen}", "-DNDEBUG", "-DEIGEN_NO_MALLOC") if eigen else None,
        lapack,
        arguments.cmsis_dsp,
        (f"-isystem{tinyekf_folder(arguments.tinyekf)}",) if arguments.tinyekf else None,
    )
