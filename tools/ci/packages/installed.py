"""Packages installed by the tests and tools, from the files that install them: the set-up script, lists of
requirements, the script that fetches Unity, and CMake's lists, which name the libraries of the programs."""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from pathlib import Path

from goe_tools.places import ROOT

from .licenses import DEBIAN, OTHERS, PYTHON

DEBIAN_PACKAGE, PYTHON_PACKAGE, NPM_PACKAGE, SOURCE = "deb", "pypi", "npm", "github"
NEEDED, TESTS_ONLY = "needed", "extra"  # lists of tools/setup.sh
MARKER = r"(?:; *(?P<marker>.+))?"
REQUIREMENT = re.compile(rf"^(?P<name>[A-Za-z0-9._-]+)(?P<version>[<>=!~][^;]*)?{MARKER}$")
PINNED = re.compile(r"^==([^,*]+)$")


@dataclass(frozen=True)
class Installed:
    """An installed package. ``version``: pinned, or empty if any available version is used."""

    kind: str
    name: str
    version: str
    by: str  # the file that installs it
    why: str
    license: str = ""  # an SPDX expression; empty: unknown
    sha256: str = ""  # of the download, if pinned
    files: tuple[tuple[str, str], ...] = ()  # name and SHA-256 of each, if files instead of an archive are pinned

    @property
    def ref(self) -> str:
        at = f"@{self.version}" if self.version else ""
        return f"pkg:{self.kind}/{self.namespace}{self.name}{at}"

    @property
    def namespace(self) -> str:
        return {DEBIAN_PACKAGE: "debian/", SOURCE: "throwtheswitch/"}.get(self.kind, "")


def canonical(name: str) -> str:
    """A Python package's name in the form of the index."""
    return re.sub(r"[-_.]+", "-", name).lower()


def requirement(line: str, by: str, why: str) -> Installed | None:
    """None for a comment or a blank line."""
    text = line.split("#")[0].strip()
    if not text:
        return None
    found = REQUIREMENT.match(text)
    if found is None:
        raise ValueError(f"{by}: '{text}' is not a requirement")
    name, pinned = canonical(found["name"]), PINNED.match((found["version"] or "").strip())
    reason = f"{why}, where {found['marker'].strip()}" if found["marker"] else why
    return Installed(
        PYTHON_PACKAGE, name, pinned[1].strip() if pinned else "", by, reason, PYTHON.get(name, "")
    )  # fmt: skip


def array_of(toml: str, table: str, key: str) -> tuple[str, ...]:
    """Strings of a list in a TOML file: the standard library has no TOML parser before Python 3.11."""
    section = re.search(rf"^\[{re.escape(table)}\]\n(.*?)(?=^\[|\Z)", toml, re.MULTILINE | re.DOTALL)
    found = re.search(rf"^{key} = \[(.*?)\]", section[1], re.MULTILINE | re.DOTALL) if section else None
    return tuple(re.findall(r'"([^"]+)"', found[1])) if found else ()


@dataclass(frozen=True)
class Sources:
    """The files that install packages."""

    root: Path = ROOT

    def text(self, name: str) -> str:
        return (self.root / name).read_text(encoding="utf-8")

    @cached_property
    def debian(self) -> tuple[Installed, ...]:
        by = "tools/setup.sh"
        wanted = re.findall(rf"^ *want ({NEEDED}|{TESTS_ONLY}) ([a-z0-9.+-]+) ", self.text(by), re.MULTILINE)
        why = {NEEDED: "builds the programs or sets up", TESTS_ONLY: "tests alone"}
        return tuple(
            Installed(DEBIAN_PACKAGE, name, "", by, why[place], DEBIAN.get(name, "")) for place, name in wanted
        )

    def _requirements(self, by: str, why: str) -> Iterator[Installed]:
        known: set[Installed] = set()
        for line in self.text(by).splitlines():
            one = requirement(line, by, why)
            if one is not None and one not in known:
                known.add(one)
                yield one

    @cached_property
    def python(self) -> tuple[Installed, ...]:
        """Pinned packages, and the build requirements of the tools, which pip chooses."""
        by = "tools/pyproject.toml"
        lines = array_of(self.text(by), "build-system", "requires")
        builders = [requirement(line, by, "builds goe-tools") for line in lines]
        return (
            *self._requirements("tools/requirements.txt", "tools and tests"),
            *self._requirements("tools/requirements-rivals.txt", "comparison with other estimators, on demand"),
            *(one for one in builders if one is not None),
        )

    @cached_property
    def unity(self) -> tuple[Installed, ...]:
        """One of two: from its repository, or otherwise from a Debian source package."""
        by = "tools/fetch_unity.sh"
        text = self.text(by)

        def value(name: str) -> str:
            found = re.search(rf"^{name}='?([^'\s]+)", text, re.MULTILINE)
            if found is None:
                raise ValueError(f"{by}: no {name}")
            return found[1]

        files = re.search(r"^debian_sha256='([^']*)'", text, re.MULTILINE)
        other = re.search(r"Unity ([0-9.]+) in its", text)
        if files is None or other is None:
            raise ValueError(f"{by}: no files of the Debian source package")
        pairs = (line.split() for line in files[1].splitlines())
        version, archive = f"v{value('version')}", value("archive_sha256")
        mine = Installed(SOURCE, "unity", version, by, "unit tests", OTHERS["unity"], archive)
        spare = f"unit tests, from the Debian source package {value('debian_source')} if the repository is unreachable"
        return mine, replace(
            mine, version=f"v{other[1]}", why=spare, sha256="", files=tuple((name, digest) for digest, name in pairs)
        )

    @cached_property
    def in_pages(self) -> tuple[Installed, ...]:
        """plotly.js, contained in the pinned package ``plotly``; without version if that is not installed."""
        found = importlib.util.find_spec("plotly")
        version, digest = "", ""
        if found is not None and found.origin is not None:
            folder = Path(found.origin).parent
            found = re.search(r'"([0-9.]+)"', (folder / "offline" / "_plotlyjs_version.py").read_text(encoding="utf-8"))
            version = found[1] if found else ""
            digest = sha256((folder / "package_data" / "plotly.min.js").read_bytes()).hexdigest()
        why = "contained in pages with charts; part of the Python package plotly"
        by = "tools/requirements.txt"
        return (Installed(NPM_PACKAGE, "plotly.js", version, by, why, OTHERS["plotly.js"], digest),)

    @cached_property
    def all(self) -> tuple[Installed, ...]:
        return (*self.debian, *self.python, *self.unity, *self.in_pages)

    @cached_property
    def linked(self) -> dict[str, tuple[str, ...]]:
        """The Debian packages with the libraries that each program for the host links."""
        host, companion = self.text("sim_host/CMakeLists.txt"), self.text("port/companion/CMakeLists.txt")
        own = tuple(re.findall(r"^goe_find\(\w+ \S+ \w+ ([a-z0-9.+-]+)\)", host, re.MULTILINE))
        programs = re.findall(r"^ *goe_program\((\w+)", host, re.MULTILINE)
        more = tuple(re.findall(r"needs (lib[a-z0-9-]+-dev)", companion))
        if not own or not programs or not more:
            raise ValueError("sim_host, port/companion: CMakeLists.txt has no program or no library")
        return {**dict.fromkeys(programs, own), "goe_companion": (*own, *more)}

    def packaged(self, key: str) -> tuple[str, ...]:
        """Python packages in a list of the Python package: "requires" to build it, "dependencies" to run it."""
        table = "build-system" if key == "requires" else "project"
        lines = array_of(self.text("port/python/pyproject.toml"), table, key)
        return tuple(one.name for line in lines if (one := requirement(line, "port/python/pyproject.toml", "")))
