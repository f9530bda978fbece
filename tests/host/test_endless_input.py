"""Endless input: every reader of the programs and of the Python tools ends with an error message, in bounded memory.

GOE_REPLAY, GOE_SIM and GOE_COMPANION name the programs; by default they are looked for in build/.
"""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PLACES = {
    "goe_replay": ("GOE_REPLAY", "sim_host"),
    "goe_sim": ("GOE_SIM", "sim_host"),
    "goe_companion": ("GOE_COMPANION", "port/companion"),
}
MEMORY_KIB = {"goe_replay": 400_000, "goe_sim": 400_000, "goe_companion": 100_000}  # of address space in total
SECONDS = 600  # guard against a hang
FRAMES = "t_s,id,n_m,e_m,d_m,qw,qx,qy,qz"
RECORDING = "t_s," + ",".join(
    f"{kind}_{axis}" for kind in ("true", "est") for axis in ("n_m", "e_m", "d_m", "qw", "qx", "qy", "qz")
)
CAMERA = "".join(f"camera.{name} = 100\n" for name in ("width", "height", "fx", "fy", "cx", "cy"))


def program(name: str) -> str:
    variable, folder = PLACES[name]
    path = Path(os.environ.get(variable, ROOT / "build" / folder / name))
    if variable not in os.environ and not path.is_file():
        pytest.skip(f"{path} is not built ({variable} names it)")
    return str(path)


def error_of(name: str, feed: str, *words: str) -> str:
    """The error message of a program for an endless file: /dev/stdin, fed by a shell command, or a device."""
    path, limit = program(name), MEMORY_KIB[name]
    with_limit = ["sh", "-c", f'ulimit -v {limit}; exec "$@"', "sh", path]
    if subprocess.run([*with_limit, "--help"], capture_output=True, check=False).returncode != 0:
        with_limit = [path]  # the address sanitizer needs more address space than there is memory
    command = f"{feed} 2>/dev/null | {shlex.join([*with_limit, *words])}"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, timeout=SECONDS, check=False)
    assert done.returncode == 2, (done.returncode, done.stderr)
    assert done.stderr.count("\n") == 1 and len(done.stderr) < 500
    return done.stderr


def rows(header: str, row: str) -> str:
    """A command that prints endless rows. ``row`` is an awk expression of the row number i."""
    return f"awk 'BEGIN {{ print \"{header}\"; for (i = 1;; i++) print {row} }}'"


ENDLESS_LINE = "tr '\\0' '1' </dev/zero"
ENDLESS_COLUMNS = "yes , | tr -d '\\n'"
TABLES = [
    ("cat /dev/zero", ":1: the row is longer than 1048576 bytes"),
    (ENDLESS_LINE, ":1: the row is longer than 1048576 bytes"),
    (ENDLESS_COLUMNS, ":1: more than 4096 columns"),
]
QUOTE = "{{ echo {}; printf '1,\"'; yes; }}"


@pytest.mark.parametrize(
    ("feed", "reason"),
    [
        *TABLES,
        (QUOTE.format(FRAMES), ":2: id: the row is longer than 1048576 bytes: a quote not closed?"),
        (f"{{ echo {FRAMES}; {ENDLESS_LINE}; }}", ":2: t_s: the row is longer than 1048576 bytes"),
        (f"{{ echo {FRAMES}; {ENDLESS_COLUMNS}; }}", ":2: the row is longer than 1048576 bytes"),
        (rows(FRAMES, 'i "," i ",0,0,-9,1,0,0,0"'), ":16386: id: no room for another track: 16384 are the most"),
    ],
    ids=["zeros", "line", "columns", "quote", "line of a row", "fields of a row", "tracks"],
)
def test_frames(tmp_path: Path, feed: str, reason: str) -> None:
    (tmp_path / "camera.ini").write_text(CAMERA)
    words = ("--camera", str(tmp_path / "camera.ini"), "--frames", "/dev/stdin", "--out", str(tmp_path / "out.csv"))
    assert f"/dev/stdin{reason}" in error_of("goe_replay", feed, *words)
    assert [path.name for path in tmp_path.iterdir()] == ["camera.ini"]


@pytest.mark.parametrize(
    ("feed", "reason"),
    [
        *TABLES,
        (QUOTE.format(RECORDING), ":2: true_n_m: the row is longer than 1048576 bytes: a quote not closed?"),
        (rows(RECORDING, 'i ",0,0,-9,1,0,0,0,0,0,-9,1,0,0,0"'), ":1000002: more than 1000000 poses"),
    ],
    ids=["zeros", "line", "columns", "quote", "poses"],
)
def test_recorded_flights(tmp_path: Path, feed: str, reason: str) -> None:
    assert f"/dev/stdin{reason}" in error_of("goe_sim", feed, "--flight", "/dev/stdin", "--out", str(tmp_path / "log"))
    assert list(tmp_path.iterdir()) == []


LINES = [
    ("cat /dev/zero", ":1: the line holds a NUL byte"),
    (ENDLESS_LINE, ":1: the line is longer than 4096 bytes"),
    ("yes '# a comment'", ":100001: more than 100000 lines"),
]


@pytest.mark.parametrize(("feed", "reason"), LINES, ids=["zeros", "line", "lines"])
def test_settings(tmp_path: Path, feed: str, reason: str) -> None:
    """camera.ini, a scenario, the companion's configuration, and its camera's file."""
    (tmp_path / "companion.ini").write_text("[camera]\nfile = /dev/stdin\n")
    for name, *words in (
        ("goe_replay", "--camera", "/dev/stdin", "--frames", str(tmp_path / "none.csv")),
        ("goe_sim", "--scenario", "/dev/stdin", "--out", str(tmp_path / "log")),
        ("goe_companion", "--check", "/dev/stdin"),
        ("goe_companion", "--check", str(tmp_path / "companion.ini")),
    ):
        assert f"/dev/stdin{reason}" in error_of(name, feed, *words)


READ_IN_PYTHON = f"""
import resource, subprocess, sys
from pathlib import Path
from goe_tools.logs import fields
from goe_tools.logs.estimates import LABELS, NUMBERS, read_estimates
from goe_tools.logs.obslog import TRUTH_COLUMNS, LogError, read_cameras, read_frames, read_truth

resource.setrlimit(resource.RLIMIT_AS, (300 << 20, 300 << 20))
fields.ROWS_MAX, fields.TABLE_BYTES_MAX = 2000, 1 << 22  # as many as there are would take a while

def error_of(read, feed):
    with subprocess.Popen(["sh", "-c", feed], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as source:
        try:
            read(Path(f"/dev/fd/{{source.stdout.fileno()}}"))
        except LogError as error:
            print(error.line, error.reason)
        finally:
            source.stdout.close()

truth, estimates = ",".join(TRUTH_COLUMNS), ",".join((*LABELS, *NUMBERS))
for read, header, row in (
    (read_frames, {FRAMES!r}, "1,2,0,0,-9,1,0,0,0"),
    (read_truth, truth, None),
    (read_estimates, estimates, "1,1,ok,disc,8" + "," * len(NUMBERS)),
):
    error_of(read, "cat /dev/zero")
    error_of(read, {ENDLESS_LINE!r})
    error_of(read, "echo " + header + "; printf '1,\\"'; yes")
    error_of(read, "echo " + header + "; yes '" + 4000 * " " + "'")
    if row:
        error_of(read, "echo " + header + "; yes " + row)
error_of(read_cameras, "cat /dev/zero")
error_of(read_cameras, "yes '# a comment'")
"""


def test_python_readers() -> None:
    words = [sys.executable, "-c", READ_IN_PYTHON]
    done = subprocess.run(words, capture_output=True, text=True, timeout=SECONDS, check=False, cwd=ROOT / "tools")
    assert (done.returncode, done.stderr) == (0, "")
    long_row = "the row is longer than 1048576 bytes: a quote not closed?"
    table = [f"1 {long_row}", f"1 {long_row}", f"2 {long_row}", "the file is longer than 4194304 bytes"]
    said = done.stdout.splitlines()
    assert said.pop() == said.pop() == "0 longer than 1048576 bytes"
    for rows_too in (True, False, True):
        expected = [*table, "2002 more than 2000 rows"][: 5 if rows_too else 4]
        assert [line.endswith(end) for line, end in zip(said, expected)] == [True] * len(expected), said
        said = said[len(expected) :]
    assert said == []
