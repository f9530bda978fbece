"""Whether a bill of materials keeps the rules of CycloneDX 1.5: the parts of its JSON schema that it uses, and that
every reference leads somewhere."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from .sbom import SPEC

Json = dict[str, Any]
TYPES = ("application", "framework", "library", "container", "platform", "device", "firmware", "file")
SCOPES = ("required", "optional", "excluded")
AGGREGATES = ("complete", "incomplete", "unknown", "not_specified")
KEYS = {  # what an object may hold; the schema allows nothing else
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
LICENCE_WORD = re.compile(r"^[A-Za-z0-9][A-Za-z0-9.+-]*$")
OPERATORS = ("AND", "OR", "WITH")


def _strangers(what: str, told: Json, kind: str) -> Iterator[str]:
    for key in sorted(set(told) - KEYS[kind]):
        yield f"{what}: no key {key} is allowed here"


def _licence_faults(what: str, licences: Any) -> Iterator[str]:
    if not isinstance(licences, list) or not licences:
        yield f"{what}: licenses is no list of any"
        return
    for one in licences:
        if set(one) == {"license"} and set(one["license"]) == {"id"}:
            words = [one["license"]["id"]]
        elif set(one) == {"expression"} and len(licences) == 1:
            words = [word for word in one["expression"].split() if word not in OPERATORS]
        else:
            yield f"{what}: a licence is one id, or one expression for all"
            continue
        if not words or not all(LICENCE_WORD.match(word) for word in words):
            yield f"{what}: {words} is no licence of SPDX"


def _component_faults(component: Json) -> Iterator[str]:
    what = str(component.get("bom-ref") or component.get("name"))
    yield from _strangers(what, component, "component")
    if component.get("type") not in TYPES:
        yield f"{what}: {component.get('type')} is no type"
    for key in ("name", "bom-ref"):
        if not isinstance(component.get(key), str) or not component[key]:
            yield f"{what}: no {key}"
    for key in ("version", "description"):
        if not isinstance(component.get(key, ""), str):
            yield f"{what}: {key} is no text"
    if component.get("scope", SCOPES[0]) not in SCOPES:
        yield f"{what}: {component['scope']} is no scope"
    if "purl" in component and not PURL.match(component["purl"]):
        yield f"{what}: {component['purl']} is no package URL"
    for one in component.get("hashes", ()):
        if set(one) != {"alg", "content"} or one["alg"] != "SHA-256" or not DIGEST.match(one["content"]):
            yield f"{what}: a hash is none of SHA-256"
    if "licenses" in component:
        yield from _licence_faults(what, component["licenses"])
    for inner in component.get("components", ()):
        yield from _component_faults(inner)


def _refs(components: list[Json]) -> Iterator[str]:
    for component in components:
        yield str(component.get("bom-ref"))
        yield from _refs(component.get("components", []))


def faults(bom: Json) -> list[str]:
    """What is wrong; empty: nothing."""
    found = list(_strangers("bill", bom, "bom"))
    if bom.get("bomFormat") != "CycloneDX" or bom.get("specVersion") != SPEC:
        found.append("bill: not of CycloneDX " + SPEC)
    if not isinstance(bom.get("version"), int) or bom["version"] < 1:
        found.append("bill: version is no number from 1 on")
    components = [bom.get("metadata", {}).get("component", {}), *bom.get("components", [])]
    for component in components:
        found += _component_faults(component)
    refs = list(_refs(components))
    found += [f"{ref}: there twice" for ref in sorted({ref for ref in refs if refs.count(ref) > 1})]
    for dependency in bom.get("dependencies", ()):
        named = [dependency.get("ref"), *dependency.get("dependsOn", ())]
        found += [f"dependencies: {ref} leads nowhere" for ref in named if ref not in refs]
        if len(set(named)) != len(named):
            found.append(f"dependencies: {dependency.get('ref')} names one twice")
    for composition in bom.get("compositions", ()):
        if composition.get("aggregate") not in AGGREGATES:
            found.append("compositions: no aggregate")
        named = composition.get("dependencies", ())
        found += [f"compositions: {ref} leads nowhere" for ref in named if ref not in refs]
    return found
