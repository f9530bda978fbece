"""Logs that a command may write again: those that it wrote itself, as long as nobody has changed them.

The last line of camera.ini names the program and a sum over the folder's files.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

from .fields import LogError
from .obslog import ObservationLog, write_log
from .whole_file import log_files, refuse_inputs, write_whole

MARK = "# written by goe_tools, which replaces the log only as long as this sum fits: "


def _sum(files: list[Path], camera: bytes) -> str:
    digest = hashlib.blake2b(camera, digest_size=8)
    for file in files[1:]:
        if file.is_file():
            digest.update(file.read_bytes())
    return digest.hexdigest()


def is_own(folder: Path) -> bool:
    """Whether the folder's log is as :func:`write_own_log` left it."""
    files = log_files(folder)
    if not files[0].is_file():
        return False
    camera, mark, found = files[0].read_bytes().rpartition(MARK.encode())
    return bool(mark) and found.decode("ascii", "replace").strip() == _sum(files, camera)


def write_own_log(folder: Path, log: ObservationLog, comment: str = "", inputs: Sequence[Path] = ()) -> None:
    """As ``write_log``. LogError: the folder contains a log that this function did not write, or that was changed
    since."""
    folder = Path(folder)
    files = log_files(folder)
    for file in files:
        refuse_inputs(file, inputs)
    found = [file.name for file in files if file.exists()]
    if found and not is_own(folder):
        reason = f"contains {', '.join(found)}, which this command did not write; choose another folder"
        raise LogError(folder, 0, "", reason)
    write_log(folder, log, comment, inputs)
    if not log.truth:
        (folder / "truth.csv").unlink(missing_ok=True)  # of the log before
    camera = files[0].read_bytes()
    write_whole(files[0], camera + f"{MARK}{_sum(files, camera)}\n".encode())
