"""The distributed Python package: the sdist of the tree and of the staged folder, and the wheel made of the sdist
alone."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from ci.packages.facts import Facts
from ci.packages.staging import Words
from ci.packages.targets import TARGETS
from goe_tools import library

pytestmark = pytest.mark.release  # packaging

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "port" / "python"
FACTS = Facts()
MOST_BYTES = 300_000
SECONDS = 1800  # guard against a hang
SDIST = "import sys; from scikit_build_core.build import build_sdist; print(build_sdist(sys.argv[1]))"
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror")


def run(*words: str | Path, folder: Path, **environment: str) -> str:
    done = subprocess.run(
        [str(word) for word in words], cwd=folder, env={**os.environ, **environment}, capture_output=True, text=True,
        timeout=SECONDS,
    )  # fmt: skip
    assert done.returncode == 0, f"{words}: {done.stdout}{done.stderr}"
    return done.stdout


def sdist_of(folder: Path, out: Path) -> Path:
    return out / run(sys.executable, "-c", SDIST, out, folder=folder).split()[-1]


@pytest.fixture(scope="module")
def sdist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Made in the tree, where csrc/lib and others are links."""
    if importlib.util.find_spec("scikit_build_core") is None:
        pytest.skip("no scikit-build-core: the Python package is not built (tools/setup.sh)")
    return sdist_of(PACKAGE, tmp_path_factory.mktemp("sdist"))


@pytest.fixture(scope="module")
def wheel(sdist: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Made from the sdist alone, in a folder without the rest of the project."""
    for program in ("cc", "cmake", "ninja"):
        if not shutil.which(program):
            pytest.skip(f"no {program}: the Python package is not built")
    folder = tmp_path_factory.mktemp("wheel")
    alone = folder / sdist.name
    shutil.copyfile(sdist, alone)
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check", "wheel", "--quiet", "--no-deps")
    run(*pip, "--no-build-isolation", "--no-cache-dir", "--wheel-dir", folder, alone, folder=folder)
    (made,) = folder.glob("*.whl")
    return made


def test_the_sdist_has_every_source_and_no_link(sdist: Path, tmp_path: Path) -> None:
    with tarfile.open(sdist) as archive:
        members = {member.name.partition("/")[2]: member for member in archive.getmembers()}
        assert all(member.isreg() for member in members.values())
        for prefix, folder in (("csrc/lib", "lib"), ("csrc/flight", "port/flight")):
            names = FACTS.files(folder, (".c",)) + FACTS.files(folder, (".h",))
            for name in names:
                packed = archive.extractfile(members[f"{prefix}/{name}"])
                assert packed is not None and packed.read() == (ROOT / folder / name).read_bytes()
    TARGETS["python"](FACTS, Words(), tmp_path / "staged")
    with tarfile.open(sdist_of(tmp_path / "staged" / "goe", tmp_path)) as archive:
        assert {name.partition("/")[2] for name in archive.getnames()} == set(members)


def test_the_wheel(wheel: Path) -> None:
    assert wheel.name.startswith(f"goe-{FACTS.version}-cp39-abi3-")  # for every Python from 3.9 on
    assert wheel.stat().st_size < MOST_BYTES
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        (metadata,) = (archive.read(name).decode() for name in names if name.endswith("/METADATA"))
        (licence,) = (archive.read(name) for name in names if name.endswith("/LICENSE"))
    modules = {f"goe/{path.name}" for path in (PACKAGE / "src" / "goe").glob("*.py*") if path.suffix != ".pyc"}
    assert {name for name in names if name.startswith("goe/")} == {*modules, "goe/py.typed", "goe/_goe.abi3.so"}
    assert licence == (ROOT / "LICENSE").read_bytes()
    assert f"\nVersion: {FACTS.version}\n" in metadata and "\nLicense: MIT\n" in metadata
    assert re.findall(r"^Requires-Dist: (\w+)", metadata, re.MULTILINE) == ["cffi", "numpy"]


def test_the_wheel_alone_has_the_bits_of_c(wheel: Path, tmp_path: Path) -> None:
    """The package's own tests and the golden hashes, with this package found before the installed one."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    words = "import goe, doctest; print(goe.__file__, goe.FINGERPRINT, doctest.testmod(goe).failed)"
    environment = {"PYTHONPATH": str(tmp_path)}
    place, fingerprint, failed = run(sys.executable, "-c", words, folder=tmp_path, **environment).split()
    assert Path(place).is_relative_to(tmp_path) and failed == "0"
    assert fingerprint == library._bindings().fingerprint(ROOT / "lib", ROOT / "port/flight", ROOT / "port/cmake")
    golden = ROOT / "tests" / "python" / "test_port_python_golden.py"
    pytest_words = (sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-c", ROOT / "tools/pyproject.toml")
    text = run(*pytest_words, golden, "-k", "estimates or layer", folder=tmp_path, **environment)
    assert "2 passed" in text


def test_the_licence_is_the_project_s() -> None:
    assert (PACKAGE / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()


def test_the_glue_compiles_without_a_warning(tmp_path: Path) -> None:
    if not shutil.which("cc"):
        pytest.skip("no cc")
    sources = sorted((PACKAGE / "csrc").glob("*.c"))
    assert len(sources) == 2
    run("cc", "-std=c99", *WARNINGS, "-fsyntax-only", "-Ilib", "-Iport/flight", *sources, folder=ROOT)
