"""Packages installed by the tests and tools, as a bill of materials; and the check that the library contains none."""

from __future__ import annotations

from ..packages.facts import Facts
from ..packages.installed import Sources
from ..packages.sbom import make
from ..packages.sbom_rules import faults
from .parts import Amount
from .record import Result, Row


def run(_: Amount) -> Result:
    sources = Sources()
    bom = make(Facts(), sources)
    listed = {component.get("purl") for component in bom["components"]}
    lacking = sorted({one.ref for one in sources.all} - listed)
    wrong = faults(bom)
    library = [entry["dependsOn"] for entry in bom["dependencies"] if entry["ref"] == "goe:goe"]
    unknown = sorted({one.name for one in sources.all if not one.license})
    pinned = sum(bool(one.version) for one in sources.all)
    count = len(sources.all)
    rows = [
        Row(
            "packages that the tests and tools install, in the bill",
            f"{count - len(lacking)} of {count}",
            "all",
            not lacking,
        ),
        Row("faults of the bill against CycloneDX 1.5", str(len(wrong)), "0", not wrong),
        Row("packages that the library contains or needs", str(sum(map(len, library))), "0", library == [[]]),
        Row("licenses known", f"{count - sum(one.name in unknown for one in sources.all)} of {count}", "", None),
        Row("versions pinned; the others are Debian's current ones", f"{pinned} of {count}", "", None),
    ]
    lines = [f"{one.ref}: {one.license or 'license unknown'}; {one.why}; by {one.by}" for one in sources.all]
    report = ["The bill: python -m ci packages --sbom FILE", *wrong, *(f"missing: {ref}" for ref in lacking)]
    return Result(rows, "\n".join([*report, *lines]))
