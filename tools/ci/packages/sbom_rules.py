"""Checks a bill of materials against the rules of CycloneDX 1.5: the used parts of its JSON schema, and that
every reference has a target."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from .sbom import SPEC

Json = dict[str, Any]
TYPES = ("application", "framework", "library", "container", "platform", "device", "firmware", "file")
SCOPES = ("required", "optional", "excluded")
AGGREGATES = ("complete", "incomplete", "unknown", "not_specified")
KEYS = {  # keys of an object; the schema allows no others
    "bom": {
        "bomFormat", "specVersion", "serialNumber", "version", "metadata", "components", "dependencies", "compositions",
    },
    "component": {
        "type", "bom-ref", "name", "version", "description", "scope", "hashes", "licenses", "purl", "properties",
        "components",
    },
}  # fmt: skip
PURL = re.compile(r"^pkg:[a-z][a-z0-9.+-]*/([^@/]+/)*[^@/]+(@[^@/?#]+)?$")
DIGEST = re.compile(r"^[0-9a-f]{64}$")
LICENSE_WORD = re.compile(r"^[A-Za-z0-9][A-Za-z0-9.+-]*$")
OPERATORS = ("AND", "OR", "WITH")


def _strangers(what: str, given: Json, kind: str) -> Iterator[str]:
    for key in sorted(set(given) - KEYS[kind]):
        yield f"{what}: no key {key} is allowed here"


def _license_faults(what: str, licenses: Any) -> Iterator[str]:
    if not isinstance(licenses, list) or not licenses:
        yield f"{what}: licenses is not a list, or is empty"
        return
    for one in licenses:
        if set(one) == {"license"} and set(one["license"]) == {"id"}:
            words = [one["license"]["id"]]
        elif set(one) == {"expression"} and len(licenses) == 1:
            words = [word for word in one["expression"].split() if word not in OPERATORS]
        else:
            yield f"{what}: a license must be one id, or one expression for all"
            continue
        if not words or not all(LICENSE_WORD.match(word) for word in words):
            yield f"{what}: {words} is not an SPDX license"


def _component_faults(component: Json) -> Iterator[str]:
    what = str(component.get("bom-ref") or component.get("name"))
    yield from _strangers(what, component, "component")
    if component.get("type") not in TYPES:
        yield f"{what}: {component.get('type')} is not a type"
    for key in ("name", "bom-ref"):
        if not isinstance(component.get(key), str) or not component[key]:
            yield f"{what}: no {key}"
    for key in ("version", "description"):
        if not isinstance(component.get(key, ""), str):
            yield f"{what}: {key} is not text"
    if component.get("scope", SCOPES[0]) not in SCOPES:
        yield f"{what}: {component['scope']} is not a scope"
    if "purl" in component and not PURL.match(component["purl"]):
        yield f"{what}: {component['purl']} is not a package URL"
    for one in component.get("hashes", ()):
        if set(one) != {"alg", "content"} or one["alg"] != "SHA-256" or not DIGEST.match(one["content"]):
            yield f"{what}: a hash is not SHA-256"
    if "licenses" in component:
        yield from _license_faults(what, component["licenses"])
    for inner in component.get("components", ()):
        yield from _component_faults(inner)


def _refs(components: list[Json]) -> Iterator[str]:
    for component in components:
        yield str(component.get("bom-ref"))
        yield from _refs(component.get("components", []))


def faults(bom: Json) -> list[str]:
    """The violations; empty: none."""
    found = list(_strangers("bill", bom, "bom"))
    if bom.get("bomFormat") != "CycloneDX" or bom.get("specVersion") != SPEC:
        found.append("bill: not in the format CycloneDX " + SPEC)
    if not isinstance(bom.get("version"), int) or bom["version"] < 1:
        found.append("bill: version is not a number of 1 or more")
    components = [bom.get("metadata", {}).get("component", {}), *bom.get("components", [])]
    for component in components:
        found += _component_faults(component)
    refs = list(_refs(components))
    found += [f"{ref}: appears twice" for ref in sorted({ref for ref in refs if refs.count(ref) > 1})]
    for dependency in bom.get("dependencies", ()):
        named = [dependency.get("ref"), *dependency.get("dependsOn", ())]
        found += [f"dependencies: {ref} has no target" for ref in named if ref not in refs]
        if len(set(named)) != len(named):
            found.append(f"dependencies: {dependency.get('ref')} lists one twice")
    for composition in bom.get("compositions", ()):
        if composition.get("aggregate") not in AGGREGATES:
            found.append("compositions: no aggregate")
        named = composition.get("dependencies", ())
        found += [f"compositions: {ref} has no target" for ref in named if ref not in refs]
    return found
