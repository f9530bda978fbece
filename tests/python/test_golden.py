"""The reference data of the C tests: the committed files are those of the generator, and a change is detected."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from bench.__main__ import main
from bench.reference import golden

ROOT = Path(__file__).resolve().parents[2]

COMMITTED = ROOT / "tests" / "c" / "golden"


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("golden")
    assert main(["golden", "--out", str(folder)]) == 0
    return folder


@pytest.fixture
def copy(made: Path, tmp_path: Path) -> Path:
    for path in made.iterdir():
        (tmp_path / path.name).write_text(path.read_text())
    return tmp_path


def test_committed_data_are_up_to_date(capsys) -> None:
    assert main(["golden", "--check", str(COMMITTED)]) == 0, capsys.readouterr().out


def test_size_and_form(made: Path) -> None:
    assert sum(path.stat().st_size for path in made.iterdir()) < 300_000
    for path in made.iterdir():
        assert max(len(line) for line in path.read_text().splitlines()) <= 140
        assert "nan" not in path.read_text()


def test_a_changed_last_bit_of_a_double_passes(copy: Path) -> None:
    path = copy / "golden_window.h"
    number = re.search(r"\d\.\d{17}e\+00", path.read_text()).group()
    path.write_text(path.read_text().replace(number, number[:16] + "999e+00", 1))
    assert golden.check(copy) == []


@pytest.mark.parametrize(
    ("name", "pattern", "replacement"),
    [
        ("golden_window.h", r"\d\.\d{17}e\+00", "1.23400000000000000e+00"),
        ("golden_lens.h", r"0x1\.\w+p\+9f", "0x1.5p+9f"),
        ("golden_corner.h", r"0x4\w{7}u", "0x40000000u"),
        ("golden_corner.h", "GOE_MODEL_LINE", "GOE_MODEL_DISC"),
    ],
)
def test_any_other_change_is_found(name: str, pattern: str, replacement: str, copy: Path, capsys) -> None:
    path = copy / name
    path.write_text(re.sub(pattern, replacement, path.read_text(), count=1))
    assert main(["golden", "--check", str(copy)]) == 1
    assert re.search(rf"{name}: line \d+: ", capsys.readouterr().out)


def test_missing_short_and_foreign_files_are_found(copy: Path) -> None:
    (copy / "golden_lens.h").unlink()
    (copy / "golden_more.h").write_text("")
    text = (copy / "golden_angle.h").read_text()
    (copy / "golden_angle.h").write_text(text[: len(text) // 2].rpartition("\n")[0] + "\n")
    found = golden.check(copy)
    assert len(found) == 3
    assert "lines should be" in found[0]
    assert found[1].endswith("golden_lens.h: missing")
    assert found[2].endswith("golden_more.h: not made by this program")


def test_hexadecimal_floats_are_exact() -> None:
    for value in (0.1, -1.0, 0.0, 1e-45, 3.4e38, 1200.0):
        literal = golden.hex_float(value)
        assert literal.endswith("f")
        assert float.fromhex(literal[:-1]) == golden.f32(value)
