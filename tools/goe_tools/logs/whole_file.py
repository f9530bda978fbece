"""Writes files completely or not at all, and never in place of an input."""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from .fields import LogError


def kept_as(suffix: str) -> Callable[[str], Path]:
    """Type of an argparse option: a file to write, whose name must not end like that of another kind of file."""

    def parse(text: str) -> Path:
        path = Path(text)
        if path.suffix.lower() not in ("", suffix):
            raise argparse.ArgumentTypeError(f"'{text}' must end in {suffix}")
        return path

    return parse


def refuse_inputs(out: Path, inputs: Iterable[Path | None]) -> None:
    """Raises LogError if an output would replace an input, also through links."""
    for path in inputs:
        if path is not None and out.is_file() and path.exists() and os.path.samefile(out, path):
            raise LogError(out, 0, "", f"the output would replace the input {path}")


def log_files(folder: Path) -> list[Path]:
    """The files that a log may have."""
    return [folder / name for name in ("camera.ini", "frames.csv", "truth.csv", "truth_frames.csv")]


def _mode(target: Path) -> int:
    """Mode of the existing file, or of a new one."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


@contextmanager
def _placed(path: Path) -> Iterator[Path]:
    if path.is_dir():
        raise LogError(path, 0, "", "is a folder")
    if path.is_symlink() and not path.exists():
        raise LogError(path, 0, "", "is a symbolic link that leads nowhere")
    if path.exists() and not path.is_file():  # a device or a pipe: write to it directly
        yield path
        return
    target = path.resolve()
    target.parent.mkdir(parents=True, exist_ok=True)
    descriptor, name = tempfile.mkstemp(prefix=f".{target.name}.", suffix=".part", dir=target.parent)
    part = Path(name)
    try:
        os.close(descriptor)
        yield part
        part.chmod(_mode(target))
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)


@contextmanager
def replacing(path: Path, inputs: Iterable[Path | None] = ()) -> Iterator[Path]:
    """Yields the path to write to; its content moves to ``path`` once all is written. The old file stays until then,
    and also if writing fails or is interrupted. A symbolic link stays one; a dangling link or an input is refused.
    Missing folders are made."""
    path = Path(path)
    refuse_inputs(path, inputs)
    try:
        with _placed(path) as place:
            yield place
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None


@contextmanager
def replacing_all(paths: Iterable[Path], inputs: Iterable[Path | None] = ()) -> Iterator[list[Path]]:
    """The same for files that belong together."""

    inputs = list(inputs)
    with ExitStack() as stack:
        yield [stack.enter_context(replacing(path, inputs)) for path in paths]


def write_whole(path: Path, content: str | bytes, inputs: Iterable[Path | None] = ()) -> None:
    with replacing(path, inputs) as place:
        place.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
