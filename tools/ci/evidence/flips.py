"""Part ``flips``: the effect of one flipped bit anywhere in the estimator's memory (tests/flips)."""

from __future__ import annotations

import csv
import shutil
import subprocess
from collections import defaultdict
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from goe_tools.places import ROOT

from .parts import Amount, NotHereError
from .record import Result, Row

PROGRAM = ROOT / "build-asan" / "tests" / "flips" / "goe_flips"
FLIGHTS = 7
LONG = ("--stride", "1", "--images", "60")
FATAL = ("crashed", "hung")
BAD = ("not_finite", "undefined")
FOUND = ("corrupted", "suspect", "reported")
SEALED = ("ready", "seal", "camera_to_body", "settings")
CHUNK = 25  # number of fields in the report, those most often wrong


@dataclass(frozen=True)
class Count:
    """Outcomes of the bits of one field, flipped after a number of images of one flight."""

    flight: str
    images: int
    field: str
    bits: int
    outcomes: dict[str, int]

    def of(self, names: Iterable[str]) -> int:
        return sum(self.outcomes[name] for name in names)


def counts(text: str) -> list[Count]:
    """Parses the program's lines, including headers."""
    found: list[Count] = []
    names: list[str] = []
    for line in csv.reader(text.splitlines()):
        if line[:5] == ["flips", "flight", "images", "field", "bits"]:
            names = line[5:]
        elif line:
            outcomes = dict(zip(names, (int(number) for number in line[5:]), strict=True))
            found.append(Count(line[1], int(line[2]), line[3], int(line[4]), outcomes))
    return found


def summed(found: Iterable[Count], key: str) -> dict[str, dict[str, int]]:
    """Bits and outcomes by ``flight`` or ``field``."""
    sums: dict[str, dict[str, int]] = defaultdict(lambda: defaultdict(int))
    for count in found:
        into = sums[getattr(count, key)]
        into["bits"] += count.bits
        for name, number in count.outcomes.items():
            into[name] += number
    return {name: dict(into) for name, into in sums.items()}


def share(part: int, whole: int) -> str:
    return f"{part:,} of {whole:,}" + (f" ({100.0 * part / whole:.2f} %)" if part else "")


def rows(found: list[Count]) -> list[Row]:
    bits = sum(count.bits for count in found)
    sealed = [count for count in found if count.field in SEALED]
    sealed_bits = sum(count.bits for count in sealed)
    open_bits = bits - sealed_bits
    track = [count for count in found if count.field not in SEALED]

    def number(names: Iterable[str], of: list[Count]) -> int:
        return sum(count.of(names) for count in of)

    fatal, bad, missed = number(FATAL, found), number(BAD, found), sealed_bits - number(["corrupted"], sealed)
    return [
        Row("one flipped bit: a trap, a sanitizer's finding, a hang", share(fatal, bits), "0", bits > 0 and fatal == 0),
        Row("... an output not finite, or not of its enumeration", share(bad, bits), "0", bits > 0 and bad == 0),
        Row("... in settings and mounting, missed", share(missed, sealed_bits), "0", sealed_bits > 0 and missed == 0),
        Row("... elsewhere: reported (corrupted, suspect, stale)", share(number(FOUND, track), open_bits), "", None),
        Row("... never off by 5 sigma", share(number(["masked"], track), open_bits), "", None),
        Row("... off by 5 sigma for some images, then right", share(number(["was_wrong"], track), open_bits), "", None),
        Row("... silently off by 5 sigma to the end", share(number(["wrong"], track), open_bits), "measured", None),
    ]


def table(sums: dict[str, dict[str, int]], first: str) -> str:
    names = list(next(iter(sums.values())))
    lines = [f"| {first} | " + " | ".join(names) + " |", "|---" * (len(names) + 1) + "|"]
    lines += [f"| {key} | " + " | ".join(str(into[name]) for name in names) + " |" for key, into in sums.items()]
    return "\n".join(lines)


def report(found: list[Count]) -> str:
    by_field = summed(found, "field")
    worst = sorted(by_field, key=lambda name: -by_field[name]["wrong"] / by_field[name]["bits"])[:CHUNK]
    wrong = {name: by_field[name] for name in worst if by_field[name]["wrong"]}
    parts = ["Flipped between two images of a flight; each bit has the first applicable outcome, from the left."]
    parts += ["By flight:", table(summed(found, "flight"), "flight"), "By field:", table(by_field, "field")]
    if wrong:
        parts += ["Fields by the share of bits that make the answer silently wrong:", table(wrong, "field")]
    return "\n\n".join(parts)


def build() -> None:
    if not shutil.which("cmake") or not shutil.which("ninja"):
        raise NotHereError("cmake and ninja build the program with the sanitizers")
    for command in (
        ["--preset", "asan", "-DGOE_BUILD_TESTS=ON"],
        ["--build", "--preset", "asan", "--target", "goe_flips"],
    ):
        made = subprocess.run(["cmake", *command], cwd=ROOT, capture_output=True, text=True, check=False)
        if made.returncode != 0:
            raise RuntimeError(f"cmake {' '.join(command)}: {made.stdout[-2000:]}{made.stderr[-2000:]}")


def fly(program: Path, flight: int, options: Iterable[str]) -> str:
    """The lines of one flight. Exit status 1 means that a bit was fatal or bad; its lines count that."""
    done = subprocess.run(
        [str(program), "--flight", str(flight), *options], capture_output=True, text=True, check=False
    )
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{program.name}: {done.stderr[-2000:]}")
    return done.stdout


def run(amount: Amount) -> Result:
    build()
    options = LONG if amount.long else ()
    with ThreadPoolExecutor(amount.jobs) as pool:
        lines = list(pool.map(lambda flight: fly(PROGRAM, flight, options), range(FLIGHTS)))
    found = counts("\n".join(lines))
    return Result(rows(found), report(found))
