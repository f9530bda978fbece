"""goe.h stays short, its loop compiles, and goe_settings.h is generated from the list."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from ci import settings_header
from ci.__main__ import main
from goe_tools.places import PUBLIC_HEADERS, ROOT, interface

LIB = ROOT / "lib"
LINES, WORDS = 300, 2200
STUBS = """#include "goe.h"
static bool tenth_of_a_second_passed(void) {
    return true;
}
static bool next_image(goe_pose_t *pose, goe_box_t *box) {
    return pose->time_us == 0 && box->sides == 0;
}
static double exposure_s(void) {
    return 0.0;
}
static double now_s(void) {
    return 0.0;
}
bool fly(bool go_around);
bool fly(bool go_around) {
"""


def comment_words(text: str) -> list[str]:
    comments = " ".join(re.findall(r"/\*.*?\*/", text, re.DOTALL))
    return re.sub(r"[/*]+", " ", comments).split()


def test_the_manual_is_short() -> None:
    text = (LIB / "goe.h").read_text(encoding="utf-8")
    assert text.count("\n") <= LINES
    assert 1000 < len(comment_words(text)) <= WORDS


def test_the_loop_in_the_manual_compiles(tmp_path: Path) -> None:
    text = (LIB / "goe.h").read_text(encoding="utf-8")
    lines = re.findall(r"^ \*     (.*)$", text.partition("Order of calls")[0], re.MULTILINE)
    assert len(lines) <= 22 and "goe_update" in "\n".join(lines)
    body = "\n".join(lines).replace("return;", "return go_around;")
    (tmp_path / "loop.c").write_text(f"{STUBS}{body}\nreturn go_around;\n}}\n", encoding="utf-8")
    flags = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-fsyntax-only")
    done = subprocess.run(["gcc", *flags, f"-I{LIB}", tmp_path / "loop.c"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_one_include_gives_everything() -> None:
    """Every public header belongs to goe.h, and refuses to be included without it."""
    included = re.findall(r'^#include "(.+)"$', (LIB / "goe.h").read_text(encoding="utf-8"), re.MULTILINE)
    assert {*included} == {*PUBLIC_HEADERS, "goe_state.h"} - {"goe.h"}
    for name in set(included) - {"goe_limits.h"}:
        done = subprocess.run(
            ["gcc", "-std=c99", f"-I{LIB}", "-fsyntax-only", "-x", "c", "-"],
            input=f'#include "{name}"\n', capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode != 0 and "include goe.h" in done.stderr, name


def test_the_settings_header_is_the_lists() -> None:
    """[A26]"""
    assert main(["settings_header", "--check"]) == 0


def test_the_header_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    other = tmp_path / "goe_settings.h"
    other.write_text("something else", encoding="utf-8")
    monkeypatch.setattr(settings_header, "HEADER", other)
    assert main(["settings_header", "--check"]) == 1
    assert "settings_header --write" in capsys.readouterr().out
    assert main(["settings_header", "--write"]) == 0
    assert other.read_bytes() == (LIB / "goe_settings.h").read_bytes()


def test_a_changed_list_changes_the_header(capsys: pytest.CaptureFixture[str]) -> None:
    text = settings_header.LIST.read_text(encoding="utf-8")
    made = settings_header.header(text)
    assert "float prior_width_m;" in made and "0.1 to 1e3 m; default 6 */" in made
    other = text.replace("0.1f, 1.0e3f, 6.0f", "0.1f, 1.0e3f, 7.5f")
    assert settings_header.header(other) == made.replace("0.1 to 1e3 m; default 6 */", "0.1 to 1e3 m; default 7.5 */")
    with pytest.raises(ValueError, match="cannot be read"):
        settings_header.header(text.replace('REAL, "px", 1.0f', "REAL, px, 1.0f"))
    assert main(["settings_header"]) == 0
    assert capsys.readouterr().out == made


def test_numbers_are_written_as_readers_do() -> None:
    assert [settings_header.plain(n) for n in ("1.0e5f", "-100.0f", "0.05f", "1.0e-3f", "GOE_WINDOW_MAX")] == [
        "1e5", "-100", "0.05", "1e-3", "GOE_WINDOW_MAX",
    ]  # fmt: skip


def test_the_interface_has_every_public_function() -> None:
    functions = re.findall(r"^(?:GOE_NODISCARD )?\w[\w *]*?\b(goe_\w+)\([^;{]*\);", interface(), re.MULTILINE)
    assert len(functions) == len(set(functions)) == 12
