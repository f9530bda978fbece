"""The test run itself: tools/test.sh with stand-ins for all programs that only record their calls."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 120  # guard against a hang
OWN = [
    "bash",
    "sh",
    "env",
    "git",
    "nproc",
    "sed",
    "tr",
    "mkdir",
    "rm",
    "grep",
    "tail",
    "sort",
    "head",
    "dirname",
    "find",
    "wc",
    "xargs",
    "ps",
    "seq",
    "cat",
    "cut",
]
STEPS = {"build", "ruff", "unit tests", "golden hashes", *(f"affected Python tests, part {part}" for part in (0, 1))}


class Checkout:
    """A repository with the script alone. Set-up, CMake, CTest and Python succeed unless named in `failing`."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.programs = folder / "checkout", folder / "programs"
        (self.folder / "tools").mkdir(parents=True)
        self.programs.mkdir()
        shutil.copy(ROOT / "tools" / "test.sh", self.folder / "tools")
        self._program(self.folder / "tools" / "setup.sh", "")
        self._program(self.folder / ".venv" / "bin" / "python", 'echo "$*"; echo "3 passed in 0.1 s"')
        for name in ("cmake", "ctest"):
            self._program(self.programs / name, 'echo "$*"; echo "100% tests passed"')
        self._git("init", "--quiet")
        self.commit("Add the script")

    def _program(self, file: Path, lines: str) -> None:
        file.parent.mkdir(parents=True, exist_ok=True)
        ends = 'case "$*" in *"${FAILING:-no such word}"*) exit 1 ;; esac'
        file.write_text(f'#!/bin/sh\n{lines}\necho "$PRINTED"\n{ends}\n')
        file.chmod(0o755)

    def _git(self, *words: str) -> None:
        subprocess.run(
            ["git", "-c", "user.name=goe", "-c", "user.email=goe@localhost", *words], cwd=self.folder, check=True
        )

    def commit(self, subject: str) -> None:
        self._git("commit", "--quiet", "--allow-empty", "-m", subject)

    def run(self, *words: str, failing: str | None = None, **environment: str) -> subprocess.CompletedProcess[str]:
        path = f"{self.programs}:{os.environ['PATH']}"
        settings = {key: value for key, value in os.environ.items() if key not in ("CI", "UNITY_DIR")}
        settings |= {"PATH": path, **environment, **({"FAILING": failing} if failing else {})}
        return subprocess.run(words, cwd=self.folder, env=settings, capture_output=True, text=True, timeout=SECONDS)


@pytest.fixture(name="checkout")
def made(tmp_path: Path) -> Checkout:
    return Checkout(tmp_path)


def test_a_quick_run_names_its_steps_and_its_time(checkout: Checkout) -> None:
    done = checkout.run("tools/test.sh", "--quick")
    assert done.returncode == 0, done.stdout + done.stderr
    named = {line[8:54].strip() for line in done.stdout.splitlines() if line.startswith("ok ")}
    assert named == STEPS
    assert "slowest steps" in done.stdout
    assert done.stdout.splitlines()[-1].startswith("all tests passed in ")
    assert done.stdout.splitlines()[-1].endswith("0 skipped")


@pytest.mark.parametrize(
    ("failing", "step"), [("-L unit", "unit tests"), ("ruff", "ruff"), ("replay", "golden hashes")]
)
def test_a_step_that_fails_fails_the_run(checkout: Checkout, failing: str, step: str) -> None:
    done = checkout.run("tools/test.sh", "--quick", failing=failing)
    assert done.returncode == 1
    assert f"FAILED: {step}\n" in done.stdout
    assert done.stdout.splitlines()[-1].startswith("failed in ")


@pytest.mark.parametrize(
    ("failing", "printed", "named"),
    [
        ("pytest", "FAILED tests/python/test_a.py::test_b - ValueError", "tests/python/test_a.py::test_b - ValueError"),
        ("-L unit", "      7 - c_box (Failed)                  unit", "7 - c_box (Failed)"),
        ("-L unit", "     12 - c_row (Timeout)", "12 - c_row (Timeout)"),
    ],
)
def test_the_last_lines_name_the_failed_tests(checkout: Checkout, failing: str, printed: str, named: str) -> None:
    done = checkout.run("tools/test.sh", "--quick", failing=failing, PRINTED=printed)
    lines = [line.strip() for line in done.stdout.splitlines()]
    assert named in lines[lines.index("slowest steps, and their share of the processors:") :]


def test_nothing_runs_after_a_build_that_fails(checkout: Checkout) -> None:
    done = checkout.run("tools/test.sh", "--quick", failing="--build")
    assert done.returncode == 1
    assert "FAILED: build\n" in done.stdout and "skipped: everything else" in done.stdout
    assert "unit tests" not in done.stdout


@pytest.mark.parametrize(
    "subject", ["The step is new", "Add a step.", "add a step", "Adding a step", "Add a step " + 62 * "x"]
)  # fmt: skip
def test_a_subject_against_the_rule_ends_the_run_at_once(checkout: Checkout, subject: str) -> None:
    checkout.commit(subject)
    done = checkout.run("tools/test.sh", "--quick")
    assert done.returncode == 1
    assert subject in done.stderr and "build" not in done.stdout


def test_a_subject_of_72_characters_is_taken(checkout: Checkout) -> None:
    checkout.commit("Add " + 68 * "x")
    assert checkout.run("tools/test.sh", "--quick").returncode == 0


@pytest.mark.parametrize("ci", [{}, {"CI": "true"}])
def test_a_missing_tool_is_counted_and_fails_ci(checkout: Checkout, ci: dict[str, str]) -> None:
    """A PATH with the shell's own programs alone lacks compilers, formatters and the emulators."""
    for name in OWN:
        program = shutil.which(name)
        assert program
        (checkout.programs / name).symlink_to(program)
    (checkout.folder / "tests").mkdir()
    done = checkout.run("tools/test.sh", PATH=str(checkout.programs), **ci)
    lines = done.stdout.splitlines()
    assert "skipped: clang-format (not installed)" in lines, done.stdout + done.stderr
    assert ("FAILED, as CI must skip nothing: clang-format (not installed)" in lines) == bool(ci)
    failed = [line for line in lines if line.startswith("FAILED: ")]
    assert done.returncode == (1 if failed or ci else 0)
    assert int(lines[-1].split()[-2]) == sum(line.startswith("skipped: ") for line in lines) > 5


def test_an_option_that_is_none_shows_the_usage(checkout: Checkout) -> None:
    done = checkout.run("tools/test.sh", "--fast")
    assert done.returncode == 2
    assert "tools/test.sh --quick" in done.stderr
