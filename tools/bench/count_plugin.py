"""Builds the QEMU plugin that counts instructions."""

from __future__ import annotations

from pathlib import Path

from .running import ROOT, output_of


def build_plugin(folder: Path, name: str = "count_calls") -> Path:
    plugin = folder / f"{name}.so"
    source = ROOT / "tools" / "count_plugin" / f"{name}.c"
    flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-shared", "-fPIC", "-fvisibility=hidden"]
    output_of(["cc", *flags, source, "-o", plugin])
    return plugin
