"""What the tests and tools install, as a bill of materials; and that the library holds nothing but itself."""

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
    told = {component.get("purl") for component in bom["components"]}
    lacking = sorted({one.ref for one in sources.all} - told)
    wrong = faults(bom)
    library = [entry["dependsOn"] for entry in bom["dependencies"] if entry["ref"] == "goe:goe"]
    unknown = sorted({one.name for one in sources.all if not one.licence})
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
        Row("packages that the library holds or needs", str(sum(map(len, library))), "0", library == [[]]),
        Row("licences told", f"{count - sum(one.name in unknown for one in sources.all)} of {count}", "", None),
        Row("versions pinned; of the others Debian's present ones are installed", f"{pinned} of {count}", "", None),
    ]
    lines = [f"{one.ref}: {one.licence or 'licence not known'}; {one.why}; by {one.by}" for one in sources.all]
    report = ["The bill: python -m ci packages --sbom FILE", *wrong, *(f"lacking: {ref}" for ref in lacking)]
    return Result(rows, "\n".join([*report, *lines]))
