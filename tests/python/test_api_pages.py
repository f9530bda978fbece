"""The pages of the C interface that tools/api_pages.sh builds by Doxygen, with warnings as errors."""

from __future__ import annotations

import importlib.util
import re
import shutil
import subprocess
from pathlib import Path
from types import ModuleType

import pytest
from goe_tools.places import PUBLIC_HEADERS

ROOT = Path(__file__).resolve().parents[2]
HEADERS = (*(ROOT / "lib" / name for name in PUBLIC_HEADERS), ROOT / "port" / "flight" / "goe_flight.h")
FUNCTIONS = {"goe.h": 4, "goe_hazard.h": 5, "goe_diagnostics.h": 3}
SECONDS = 600  # guard against a hang


def filter_module() -> ModuleType:
    spec = importlib.util.spec_from_file_location("as_doxygen", ROOT / "tools" / "api" / "as_doxygen.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def pages_of(script: Path, out: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(script), str(out)], capture_output=True, text=True, timeout=SECONDS, check=False)


@pytest.fixture
def doxygen() -> None:
    if shutil.which("doxygen") is None:
        pytest.skip("doxygen is not installed (tools/setup.sh installs it)")


def test_every_function_has_its_words(tmp_path: Path, doxygen: None) -> None:
    done = pages_of(ROOT / "tools" / "api_pages.sh", tmp_path / "new" / "api")
    assert done.returncode == 0, done.stderr
    html = tmp_path / "new" / "api" / "html"
    assert done.stdout == f"{html / 'index.html'}\n" and (html / "index.html").is_file()
    for header in HEADERS:
        page = (html / f"{header.stem.replace('_', '__')}_8h.html").read_text(encoding="utf-8")
        source = re.sub(r"/\*.*?\*/", "", header.read_text(encoding="utf-8"), flags=re.DOTALL)
        functions = re.findall(r"^(?:GOE_NODISCARD )?[\w ]+?[ *](goe_\w+)\([^;{]*\);", source, re.MULTILINE)
        assert len(functions) >= (FUNCTIONS.get(header.name, 0) if header.parent.name == "lib" else 6)
        for function in functions:
            assert re.search(rf">{function}<", page), f"{header.name}: no page has {function}"


@pytest.mark.release
def test_a_warning_is_an_error(tmp_path: Path, doxygen: None) -> None:
    """In a copy whose header documents a parameter that does not exist."""
    for name in (*(path.relative_to(ROOT) for path in HEADERS), "tools/api_pages.sh"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    shutil.copytree(ROOT / "tools" / "api", tmp_path / "tools" / "api")
    script, header = tmp_path / "tools" / "api_pages.sh", tmp_path / "lib" / "goe.h"
    assert pages_of(script, tmp_path / "good").returncode == 0
    wrong = "/** Adds.\n * @param nothing is there\n */\nint goe_add(int a);\n"
    filter_path = tmp_path / "tools" / "api" / "as_doxygen.py"
    filter_path.write_text(filter_path.read_text().replace("sys.stdout.write(", f"sys.stdout.write({wrong!r} + ", 1))
    done = pages_of(script, tmp_path / "bad")
    assert done.returncode != 0 and "nothing" in done.stderr
    header.unlink()
    assert pages_of(script, tmp_path / "none").returncode != 0


def test_plain_comments_become_descriptions() -> None:
    source = """/*
 * name - a purpose
 *    a drawing <o>
 */
#define A 1 /* of all [A7] */

/* ------------------------------ a ruler -- */

/* What it does, if x < 3 or
 * more. */
void f(float x);

typedef struct {
    float a_m, b_m[2]; /* shared
                        * by both */
    int c;
} t;
"""
    converted = filter_module().converted(source, "name.h")
    assert converted.startswith("/** @file name.h\n@verbatim\n name - a purpose\n    a drawing <o>\n")
    assert "#define A 1 /**< of all */" in converted
    assert "/* ------------------------------ a ruler -- */" in converted
    assert "/** What it does, if x \\< 3 or\nmore. */\nvoid f(float x);" in converted
    assert "    float a_m; /**< shared by both */ float b_m[2]; /**< shared\nby both */\n    int c;" in converted
