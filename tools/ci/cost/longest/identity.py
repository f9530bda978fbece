"""Whether the code is the same without the debugging information that the loops are told apart by."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from bench.running import ROOT, output_of

from ..building import Build
from ..modules import plain_command


def code_of(built: Build, file: Path) -> str:
    """The instructions of an object with what the linker is to put into them."""
    return built.tool("objdump", "-dr", file).split("\n", 3)[3]


def changed(built: Build, folder: Path, sources: Iterable[Path] | None = None, jobs: int = 2) -> list[str]:
    """Modules whose code differs when they are compiled without what is written beside it."""
    chosen = sorted((ROOT / "lib").rglob("*.c")) if sources is None else list(sources)
    objects = {path.name: path for path in built.library_files("obj")}

    def differs(source: Path) -> str | None:
        target = folder / f"{source.stem}.obj"
        output_of([*plain_command(built), "-o", target, "-c", source])
        return None if code_of(built, objects[f"{source.name}.obj"]) == code_of(built, target) else source.stem

    with ThreadPoolExecutor(jobs) as pool:
        return [name for name in pool.map(differs, chosen) if name]
