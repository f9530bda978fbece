"""Checks that the code is the same without the debugging information that identifies the loops."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from bench.running import ROOT, output_of

from ..building import Build
from ..modules import plain_command


def code_of(built: Build, file: Path) -> str:
    """The instructions of an object, with their relocations."""
    return built.tool("objdump", "-dr", file).split("\n", 3)[3]


def changed(built: Build, folder: Path, sources: Iterable[Path] | None = None, jobs: int = 2) -> list[str]:
    """Modules whose code differs when compiled without the extra outputs."""
    chosen = sorted((ROOT / "lib").rglob("*.c")) if sources is None else list(sources)
    objects = {path.name: path for path in built.library_files("obj")}

    def differs(source: Path) -> str | None:
        target = folder / f"{source.stem}.obj"
        output_of([*plain_command(built), "-o", target, "-c", source])
        return None if code_of(built, objects[f"{source.name}.obj"]) == code_of(built, target) else source.stem

    with ThreadPoolExecutor(jobs) as pool:
        return [name for name in pool.map(differs, chosen) if name]
