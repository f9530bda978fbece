"""The settings have one source: the manual, the header and the programs agree with the library's list."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest
from ci.__main__ import main
from ci.settings_table import MANUAL, TABLE, Setting, settings, table

HEADER = MANUAL.with_name("goe_settings.h")
REPLAY = os.environ.get("GOE_REPLAY")
pytestmark = pytest.mark.skipif(REPLAY is None, reason="GOE_REPLAY names no goe_replay")

STRUCTS = {  # group of settings: its structure in goe_settings.h
    "camera": "goe_camera_t",
    "navigation": "goe_navigation_t",
    "detector": "goe_detector_t",
    "window": "goe_window_settings_t",
    "filter": "goe_filter_settings_t",
    "": "goe_settings_t",
}
NUMBER = r"(-?\d+(?:\.\d+)?(?:e-?\d+)?|GOE_WINDOW_MAX)"


@pytest.fixture(scope="module")
def rows() -> list[Setting]:
    return settings()


def documented() -> dict[str, str]:
    """The comment of each field of the settings in goe_settings.h, by the field's name in the list."""
    text = HEADER.read_text(encoding="utf-8")
    comments = {}
    for group, struct in STRUCTS.items():
        body = re.search(rf"typedef struct {{((?:(?!typedef struct).)*?)}} {struct};", text, re.DOTALL)
        assert body, struct
        for kind, name, size, comment in re.findall(
            r"^ +(\w+) (\w+)(\[3\])?; +/\* (.*?)\*/", body.group(1), re.DOTALL | re.MULTILINE
        ):
            if kind in STRUCTS.values():
                continue  # a group: its fields are the settings
            full = f"{group}.{name}" if group else name
            for suffix in ("[0]", "[1]", "[2]") if size else ("",):
                comments[full + suffix] = f"{kind}: {' '.join(comment.split())}"
    return comments


def test_the_manual_has_the_table(rows: list[Setting]) -> None:
    """[A26]"""
    assert TABLE.of(MANUAL) == table(rows)


def test_the_header_documents_every_setting(rows: list[Setting]) -> None:
    assert set(documented()) == {row.name for row in rows}


def test_the_header_documents_range_and_default(rows: list[Setting]) -> None:
    """[A26]"""
    comments = documented()
    checked = 0
    for row in rows:
        comment = comments[row.name]
        kind, text = comment.split(": ", 1)
        if kind not in ("float", "int"):
            continue
        found = re.search(rf"; {NUMBER} to {NUMBER}(?: [^;]+)?; (?:no default: must be set|default {NUMBER})", text)
        assert found, f"{row.name}: {comment}"
        low, high, value = found.groups()
        assert float(low) == pytest.approx(float(row.low), rel=1e-6), row.name
        if high != "GOE_WINDOW_MAX":  # the programs are built with a larger one
            assert float(high) == pytest.approx(float(row.high), rel=1e-6), row.name
        assert (value is None) == (row.default == "must be set"), row.name
        assert value is None or float(value) == pytest.approx(float(row.value), rel=1e-6), row.name
        checked += 1
    assert checked == len(rows) - 4  # method, model and two flags have no range


def test_help_shows_the_defaults(rows: list[Setting]) -> None:
    assert REPLAY
    shown = subprocess.run([REPLAY, "--help"], capture_output=True, text=True, check=True).stdout
    tuned = [row for row in rows if row.name.split(".")[0] in ("navigation", "detector", "filter", "window")]
    for row in tuned:
        assert f"{row.name}={row.value}" in shown.split(), row.name


def test_the_command_mends_a_page(rows: list[Setting], tmp_path: Path) -> None:
    page = tmp_path / "README.md"
    page.write_text(MANUAL.read_text(encoding="utf-8").replace("focal length", "focus"), encoding="utf-8")
    assert main(["settings", "--check", str(page)]) == 1
    assert main(["settings", "--write", str(page)]) == 0
    assert main(["settings", "--check", str(page)]) == 0
    assert page.read_text(encoding="utf-8") == MANUAL.read_text(encoding="utf-8")


def test_other_settings_than_the_lists_are_noticed(rows: list[Setting]) -> None:
    other = [Setting(**{**vars(row), "high": "7"}) for row in rows]
    assert table(other) != table(rows)
    assert Path(MANUAL).exists()
