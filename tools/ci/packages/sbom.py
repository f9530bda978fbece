"""The bill of materials, CycloneDX 1.5 as JSON: packages installed by the tests and tools, and the (empty) list of
the library's own dependencies."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Iterable
from typing import Any

from .facts import Facts
from .installed import DEBIAN_PACKAGE, PYTHON_PACKAGE, Installed, Sources

Json = dict[str, Any]
SPEC = "1.5"
SINGLE = re.compile(r"^[A-Za-z0-9.+-]+$")  # a license name, not an expression
PYTHON_GOE = "goe (Python package)"


def _licenses(expression: str) -> list[Json]:
    return [{"license": {"id": expression}} if SINGLE.match(expression) else {"expression": expression}]


def _hashes(digest: str) -> Json:
    return {"hashes": [{"alg": "SHA-256", "content": digest}]} if digest else {}


def present_versions(packages: Iterable[str]) -> dict[str, str]:
    """Versions of the Debian packages on this machine; tools/setup.sh installs Debian's current ones."""
    try:
        words = ["dpkg-query", "-W", "-f", "${Package} ${Version} ${Status}\n", *packages]
        output = subprocess.run(words, capture_output=True, text=True, check=False).stdout
    except OSError:
        return {}
    rows = [line.split() for line in output.splitlines()]
    return {row[0]: row[1] for row in rows if len(row) > 2 and row[-1] == "installed"}


def component_of(one: Installed, present: dict[str, str]) -> Json:
    """An installed package is not part of a firmware: the standard's scope for that is "excluded"."""
    version = one.version or (present.get(one.name, "") if one.kind == DEBIAN_PACKAGE else "")
    component: Json = {"type": "library", "bom-ref": one.ref, "name": one.name}
    if version:
        component["version"] = version.lstrip("v")
    component["description"] = f"{one.why}; by {one.by}"
    component["scope"] = "excluded"
    component.update(_hashes(one.sha256))
    if one.license:
        component["licenses"] = _licenses(one.license)
    component["purl"] = one.ref
    component["properties"] = [{"name": "goe:installed-by", "value": one.by}]
    if one.files:
        component["components"] = [
            {"type": "file", "bom-ref": f"{one.ref}#{name}", "name": name, **_hashes(digest)}
            for name, digest in one.files
        ]
    return component


def _own(facts: Facts, kind: str, name: str, text: str) -> Json:
    return {
        "type": kind, "bom-ref": f"goe:{name}", "name": name, "version": facts.version, "description": text,
        "scope": "required" if kind == "library" else "optional", "licenses": _licenses(facts.license),
    }  # fmt: skip


def make(facts: Facts, sources: Sources) -> Json:
    """The whole bill. ``dependencies``: contents and needs of the library, the programs and the Python package."""
    installed = sources.all
    refs: dict[tuple[str, str], list[str]] = {}
    for one in installed:
        refs.setdefault((one.kind, one.name), []).append(one.ref)
    linked = sources.linked
    needs = [*sources.packaged("requires"), *sources.packaged("dependencies")]
    python = sorted({ref for name in needs for ref in refs[PYTHON_PACKAGE, name]})
    programs = [_own(facts, "application", name, "program for the host") for name in linked]
    library = {**_own(facts, "library", "goe", facts.sentence), "purl": f"pkg:generic/goe@{facts.version}"}
    flight = _own(facts, "library", "goe-flight", facts.flight_sentence)
    wheel = _own(facts, "application", PYTHON_GOE, "port/python: the library, and a wrapper")
    contents: dict[str, list[str]] = {
        library["bom-ref"]: [],
        flight["bom-ref"]: [library["bom-ref"]],
        wheel["bom-ref"]: [library["bom-ref"], flight["bom-ref"], *python],
    }
    for name, packages in linked.items():
        libraries = [refs[DEBIAN_PACKAGE, package][0] for package in packages]
        contents[f"goe:{name}"] = [library["bom-ref"], *libraries]
    present = present_versions(one.name for one in installed if one.kind == DEBIAN_PACKAGE)
    return {
        "bomFormat": "CycloneDX",
        "specVersion": SPEC,
        "version": 1,
        "metadata": {"component": library},
        "components": [flight, wheel, *programs, *(component_of(one, present) for one in installed)],
        "dependencies": [{"ref": ref, "dependsOn": on} for ref, on in contents.items()],
        "compositions": [  # everything in a firmware is listed
            {"aggregate": "complete", "dependencies": [library["bom-ref"], flight["bom-ref"]]}
        ],
    }


def as_text(bom: Json) -> str:
    return json.dumps(bom, indent=1, ensure_ascii=False) + "\n"
