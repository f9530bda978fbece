"""The bill of materials: complete by the files that install things, in CycloneDX's form, with licenses as installed."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import json
import re
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from ci.__main__ import main
from ci.packages.facts import Facts
from ci.packages.installed import PINNED, Sources, array_of, canonical, requirement
from ci.packages.licenses import PYTHON
from ci.packages.sbom import make
from ci.packages.sbom_rules import faults

ROOT = Path(__file__).resolve().parents[2]
Json = dict[str, Any]


@pytest.fixture(scope="module")
def bom() -> Json:
    return make(Facts(), Sources())


def named(bom: Json, prefix: str) -> dict[str, list[Json]]:
    found: dict[str, list[Json]] = {}
    for component in bom["components"]:
        if component.get("purl", "").startswith(prefix):
            found.setdefault(component["name"], []).append(component)
    return found


def test_every_package_of_the_set_up_is_there(bom: Json) -> None:
    """Package names of tools/setup.sh, extracted by a method independent of the bill's writer."""
    text = (ROOT / "tools" / "setup.sh").read_text(encoding="utf-8")
    lines = [line.split() for line in text.splitlines() if line.strip().startswith("want ")]
    wanted = [words[2] for words in lines]
    assert len(wanted) > 25 and set(named(bom, "pkg:deb/")) == set(wanted)


def test_every_pinned_package_is_there(bom: Json) -> None:
    pinned = set()
    for name in ("requirements.txt", "requirements-rivals.txt"):
        for line in (ROOT / "tools" / name).read_text(encoding="utf-8").splitlines():
            if "==" in line and not line.startswith("#"):
                package, version = line.split(";")[0].strip().split("==")
                pinned.add((canonical(package), version))
    stated = {
        (name, one["version"]) for name, all_ in named(bom, "pkg:pypi/").items() for one in all_ if "version" in one
    }
    assert len(pinned) > 70 and stated == pinned
    assert [one for one in named(bom, "pkg:pypi/")["setuptools"] if "version" in one] == []  # pip chooses


def test_unity_and_plotly_js_with_their_hashes(bom: Json) -> None:
    script = (ROOT / "tools" / "fetch_unity.sh").read_text(encoding="utf-8")
    digests = set(re.findall(r"\b[0-9a-f]{64}\b", script))
    unity = named(bom, "pkg:github/")["unity"]
    stated = [
        one["hashes"][0]["content"]
        for whole in unity
        for one in (whole, *whole.get("components", ()))
        if "hashes" in one
    ]
    assert len(digests) == 4 and sorted(stated) == sorted(digests)
    assert {whole["version"] for whole in unity} == {"2.6.1", "2.5.1"}
    (plotly,) = named(bom, "pkg:npm/")["plotly.js"]
    if importlib.util.find_spec("plotly") is not None:
        from plotly.offline import get_plotlyjs_version

        assert plotly["version"] == get_plotlyjs_version() and len(plotly["hashes"]) == 1


def test_the_library_contains_no_other_package(bom: Json) -> None:
    needs = {entry["ref"]: entry["dependsOn"] for entry in bom["dependencies"]}
    assert bom["metadata"]["component"]["bom-ref"] == "goe:goe"
    assert needs["goe:goe"] == [] and needs["goe:goe-flight"] == ["goe:goe"]
    (composition,) = bom["compositions"]
    assert composition == {"aggregate": "complete", "dependencies": ["goe:goe", "goe:goe-flight"]}
    required = [one["name"] for one in bom["components"] if one["scope"] == "required"]
    assert required == ["goe-flight"]


def test_libraries_that_the_programs_link(bom: Json) -> None:
    needs = {entry["ref"]: set(entry["dependsOn"]) for entry in bom["dependencies"]}
    usual = {f"pkg:deb/debian/{name}" for name in ("libpopt-dev", "libcsv-dev", "libinih-dev")}
    for program in ("replay", "sim", "campaign", "avoid"):
        assert needs[f"goe:goe_{program}"] == usual | {"goe:goe"}
    assert needs["goe:goe_companion"] == usual | {"goe:goe", "pkg:deb/debian/libjansson-dev"}
    wheel = needs["goe:goe (Python package)"]
    assert {ref.split("/")[-1].split("@")[0] for ref in wheel if ref.startswith("pkg:")} == {
        "cffi", "numpy", "scikit-build-core",
    }  # fmt: skip


def test_the_form(bom: Json) -> None:
    """By the rules here, and by the schema itself where its library is available."""
    assert faults(bom) == []
    if importlib.util.find_spec("cyclonedx") is not None:
        from cyclonedx.schema import SchemaVersion
        from cyclonedx.validation.json import JsonStrictValidator

        assert JsonStrictValidator(SchemaVersion.V1_5).validate_str(json.dumps(bom)) is None


def broken(bom: Json, how: str) -> Json:
    bad = deepcopy(bom)
    component = bad["components"][-1]
    changes = {
        "a key": lambda: component.update(license="MIT"),
        "a type": lambda: component.update(type="thing"),
        "no name": lambda: component.pop("name"),
        "a scope": lambda: component.update(scope="never"),
        "a hash": lambda: component.update(hashes=[{"alg": "SHA-256", "content": "12"}]),
        "a package URL": lambda: component.update(purl="npm/plotly"),
        "licenses": lambda: component.update(licenses=[{"license": {"id": "MIT"}}, {"expression": "MIT OR ISC"}]),
        "a license": lambda: component.update(licenses=[{"license": {"id": "do what you like"}}]),
        "twice": lambda: bad["components"].append(component),
        "nowhere": lambda: bad["dependencies"][0]["dependsOn"].append("pkg:deb/debian/none"),
        "a version": lambda: bad.update(version="1"),
        "another form": lambda: bad.update(specVersion="9.9"),
    }
    changes[how]()
    return bad


@pytest.mark.parametrize(
    "how",
    [
        "a key", "a type", "no name", "a scope", "a hash", "a package URL", "licenses", "a license", "twice", "nowhere",
        "a version", "another form",
    ],
)  # fmt: skip
def test_conflicts_of_the_rules_are_found(bom: Json, how: str) -> None:
    assert len(faults(broken(bom, how))) >= 1


def test_licences_are_those_that_the_installed_packages_state() -> None:
    checked = 0
    for name, licence in PYTHON.items():
        try:
            stated = importlib.metadata.metadata(name).get("License-Expression")
        except importlib.metadata.PackageNotFoundError:
            continue
        if stated:
            checked += 1
            assert set(re.split(r" OR | AND ", stated)) & set(re.split(r" OR | AND ", licence)), (name, stated)
    assert checked > 5 or importlib.util.find_spec("urllib3") is None


def test_the_command(tmp_path: Path) -> None:
    assert main(["packages", "--sbom", str(tmp_path / "bom.json")]) == 0
    assert main(["packages", "--sbom", str(tmp_path / "again.json")]) == 0
    text = (tmp_path / "bom.json").read_text(encoding="utf-8")
    assert text == (tmp_path / "again.json").read_text(encoding="utf-8")
    assert json.loads(text)["metadata"]["component"]["version"] == Facts().version
    assert str(ROOT) not in text


def test_lines_of_requirements() -> None:
    assert requirement("  # nothing", "r.txt", "") is None
    one = requirement('NumPy==2.0.2; python_version < "3.13"', "r.txt", "tests")
    assert one is not None and (one.name, one.version, one.ref) == ("numpy", "2.0.2", "pkg:pypi/numpy@2.0.2")
    assert one.why == 'tests, where python_version < "3.13"'
    assert PINNED.match(">=1.15") is None
    with pytest.raises(ValueError, match="is not a requirement"):
        requirement("-e ./tools", "r.txt", "")
    assert array_of('[a]\nb = ["x>=1", "y"]\n[c]\nb = []\n', "a", "b") == ("x>=1", "y")
