"""MISRA C:2012 over lib/: lib/MISRA.md justifies each violation that cppcheck's addon reports.

tests/static/misra.csv contains their number by configuration, rule and file. An additional violation fails; a missing
one requires an update of the table: ``python -m ci.evidence.misra``, which also sets the counts in lib/MISRA.md.
"""

from __future__ import annotations

import csv
import re
import sys
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

from goe_tools.places import ROOT

from .cppcheck import CONFIGURATIONS, LIBRARY, counts, misra
from .parts import Amount
from .record import Result, Row

BASELINE = ROOT / "tests" / "static" / "misra.csv"
PAGE = LIBRARY / "MISRA.md"
# From MISRA C:2012 with its first amendment.
MANDATORY = frozenset(
    (
        *("9.1", "12.5", "13.6", "17.3", "17.4", "17.6", "19.1", "21.13", "21.17", "21.18", "21.19", "21.20"),
        *("22.2", "22.4", "22.5", "22.6"),
    )
)

Counts = dict[tuple[str, str, str], int]  # configuration, rule, file: how many


def read_baseline(path: Path) -> Counts:
    with path.open(encoding="utf-8", newline="") as file:
        return {(row["configuration"], row["rule"], row["file"]): int(row["count"]) for row in csv.DictReader(file)}


def rule_order(rule: str) -> tuple[int, ...]:
    return tuple(int(number) for number in rule.split("."))


def write_baseline(path: Path, found: Counts) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["configuration", "rule", "file", "count"])
        names = list(CONFIGURATIONS)
        for key in sorted(found, key=lambda key: (names.index(key[0]), rule_order(key[1]), key[2])):
            table.writerow([*key, found[key]])


def page_counts(page: str) -> dict[str, int]:
    """Counts by rule in the page's tables: the first column has the rule, the second the count."""
    return {rule: int(count) for rule, count in re.findall(r"^\| (\d+\.\d+) \| (\d+) \|", page, re.MULTILINE)}


def by_rule(found: Mapping[tuple[str, str, str], int]) -> Counter[str]:
    """Counts in the default configuration."""
    total: Counter[str] = Counter()
    for (configuration, rule, _), count in found.items():
        if configuration == "default":
            total[rule] += count
    return total


def differences(found: Counts, kept: Counts, configurations: set[str]) -> tuple[list[str], list[str]]:
    """Counts above the baseline, and counts below it."""
    more, less = [], []
    for key in sorted(set(found) | {key for key in kept if key[0] in configurations}):
        now, then = found.get(key, 0), kept.get(key, 0)
        if now != then:
            (more if now > then else less).append(f"{key[0]}: rule {key[1]}, {key[2]}: {now}, in the baseline {then}")
    return more, less


def measure(configurations: list[str], jobs: int) -> Counts:
    found: Counts = {}
    for name in configurations:
        for (rule, file), count in counts(misra(CONFIGURATIONS[name], jobs)).items():
            found[name, rule, file] = count
    return found


def set_page(page: str, total: Mapping[str, int]) -> str:
    """The page with these counts."""
    return re.sub(
        r"^\| (\d+\.\d+) \| \d+ \|", lambda row: f"| {row[1]} | {total.get(row[1], 0)} |", page, flags=re.MULTILINE
    )


def run(amount: Amount) -> Result:
    configurations = list(CONFIGURATIONS) if amount.long else ["default"]
    found = measure(configurations, amount.jobs)
    more, less = differences(found, read_baseline(BASELINE), set(configurations))
    total = by_rule(found)
    justified = page_counts(PAGE.read_text(encoding="utf-8"))
    unjustified = sorted(set(total) - set(justified), key=rule_order)
    stale = [
        f"{rule}: {count}, found {total.get(rule, 0)}"
        for rule, count in justified.items()
        if count != total.get(rule, 0)
    ]
    mandatory = sum(count for (_, rule, _), count in found.items() if rule in MANDATORY)
    shown = ", ".join(f"{rule} {total[rule]}" for rule in sorted(total, key=rule_order))
    rows = [
        Row("mandatory rules violated", str(mandatory), "0", mandatory == 0),
        Row("violations beyond the baseline", str(len(more)), "0", not more),
        Row("entries of the baseline that no longer appear", str(len(less)), "0: update it", not less),
        Row(
            "violated rules with a reason in lib/MISRA.md",
            f"{len(total) - len(unjustified)} of {len(total)}, {sum(total.values())} places",
            "all, with these counts",
            not unjustified and not stale,
        ),
        Row("configurations checked", f"{len(configurations)} of {len(CONFIGURATIONS)}", "", None),
    ]
    report = [f"default configuration: {shown}", "", *(f"new: {line}" for line in more)]
    report += [f"update: {line}" for line in less] + [f"no reason: {rule}" for rule in unjustified]
    report += [f"count in lib/MISRA.md: {line}" for line in stale]
    return Result(rows, "\n".join(report))


def renew() -> int:
    found = measure(list(CONFIGURATIONS), Amount().jobs)
    BASELINE.parent.mkdir(exist_ok=True)
    write_baseline(BASELINE, found)
    if PAGE.exists():
        PAGE.write_text(set_page(PAGE.read_text(encoding="utf-8"), by_rule(found)), encoding="utf-8")
    print(
        "\n".join(f"{rule}: {count}" for rule, count in sorted(by_rule(found).items(), key=lambda x: rule_order(x[0])))
    )
    return 0


if __name__ == "__main__":
    sys.exit(renew())
