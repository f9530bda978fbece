"""Outcomes of mutants, and their counts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from .mutants import Mutant
from .record import Row

GOAL = 0.95
NO_CODE, SAME_CODE, EQUIVALENT, KILLED, KILLED_BY_PROGRAM, BY_HASH, SURVIVED = (
    "no code",
    "same code",
    "no output bit changed",
    "killed",
    "killed by the tests of the program",
    "killed by the hash alone",
    "survived",
)
COUNTED = (KILLED, BY_HASH, SURVIVED)
ALL_KILLED = (KILLED, KILLED_BY_PROGRAM, BY_HASH)
Reasons = dict[tuple[str, str, str, str], str]


@dataclass(frozen=True)
class Outcome:
    """The outcome of a mutant. ``test``: the one that killed it."""

    mutant: Mutant
    came_to: str
    test: str = ""
    why: str = ""


def percent(part: int, whole: int) -> str:
    return f"{100.0 * part / whole:.1f} % ({part} of {whole})" if whole else "none"


def rows(outcomes: Iterable[Outcome], reasons: Reasons) -> list[Row]:
    outcomes = list(outcomes)
    count = Counter(outcome.came_to for outcome in outcomes)
    changed = sum(count[name] for name in COUNTED)
    killed = count[KILLED] + count[BY_HASH]
    alive = [outcome for outcome in outcomes if outcome.came_to == SURVIVED]
    unexplained = sum(outcome.mutant.key not in reasons for outcome in alive)
    tried = len(outcomes) - count[NO_CODE]
    return [
        Row("mutants of lib/ that compile", str(tried), "", None),
        Row("... that change a unit test's result or an output bit of the probe", str(changed), "", None),
        Row(
            "... of these, killed by the unit tests",
            percent(killed, changed),
            f">= {100 * GOAL:.0f} %",
            killed >= GOAL * changed,
        ),
        Row("... ... without the hash over the filter method's bits", percent(count[KILLED], changed), "", None),
        Row("... ... by that hash alone", str(count[BY_HASH]), "", None),
        Row("mutants with the same object code", str(count[SAME_CODE]), "", None),
        Row("mutants that neither a unit test nor the probe detects", str(count[EQUIVALENT]), "", None),
        Row("killed, if those count as alive", percent(killed, changed + count[EQUIVALENT]), "", None),
        Row(
            "mutants that survive: with a written reason, and without",
            f"{len(alive) - unexplained} and {unexplained}",
            "none without",
            unexplained == 0,
        ),
    ]


def rows_of_layer(name: str, outcomes: Iterable[Outcome], reasons: Reasons) -> list[Row]:
    """Rows of a folder without a probe: every mutant with other object code counts, except those with a written
    reason."""
    outcomes = list(outcomes)
    count = Counter(outcome.came_to for outcome in outcomes)
    killed = sum(count[end] for end in ALL_KILLED)
    explained = sum(outcome.came_to == SURVIVED and outcome.mutant.key in reasons for outcome in outcomes)
    alive = count[SURVIVED] - explained
    made = f"{len(outcomes)}; {count[NO_CODE]}; {count[SAME_CODE]}"
    ends = f"{count[KILLED]}; {count[KILLED_BY_PROGRAM]}; {explained}; {alive}"
    return [
        Row(f"mutants of {name}: all; that do not compile; with the same object code", made, "", None),
        Row(
            "... killed by tests in C; by tests of the program; surviving with a written reason; without",
            ends,
            "",
            None,
        ),
        Row(
            "... of those that count, killed",
            percent(killed, killed + alive),
            f">= {100 * GOAL:.0f} %",
            killed >= GOAL * (killed + alive),
        ),
    ]


def by_family(outcomes: Iterable[Outcome], reasons: Reasons) -> list[str]:
    """A table: outcomes of the mutants of each family."""
    columns = ("all", "no code", "same code", "undetected", "killed in C", "by program", "reasoned", "survived")
    ends = {NO_CODE: 1, SAME_CODE: 2, EQUIVALENT: 3, KILLED: 4, BY_HASH: 4, KILLED_BY_PROGRAM: 5, SURVIVED: 7}
    counts: dict[str, list[int]] = {}
    for outcome in outcomes:
        is_reasoned = outcome.came_to == SURVIVED and outcome.mutant.key in reasons
        for name in (outcome.mutant.family, "together"):
            row = counts.setdefault(name, [0] * len(columns))
            row[0] += 1
            row[6 if is_reasoned else ends[outcome.came_to]] += 1
    names = sorted(counts, key=lambda name: (name == "together", name))
    lines = [f"{'family':34s}" + "".join(f"{column:>12s}" for column in columns)]
    return lines + [f"{name:34s}" + "".join(f"{number:12d}" for number in counts[name]) for name in names]


def report(outcomes: Iterable[Outcome], reasons: Reasons, seconds: float) -> str:
    """Survivors first, then mutants that only the hash detects, then all killed ones."""
    outcomes = sorted(outcomes, key=lambda o: (o.mutant.file, o.mutant.begin, o.mutant.text))
    lines = [f"{len(outcomes)} mutants in {seconds:.0f} s"]
    for title, name in (("Survivors", SURVIVED), ("Killed by the hash alone", BY_HASH), ("Equivalent", EQUIVALENT)):
        lines += ["", title, "-" * len(title)]
        for outcome in outcomes:
            if outcome.came_to == name:
                m = outcome.mutant
                lines += [f"{m.file} {m.function}: {m.kind} {outcome.why}", f"    {m.source}", f"    {m.mutation}"]
                if m.key in reasons:
                    lines.append(f"    reason: {reasons[m.key]}")
    killers = Counter(outcome.test for outcome in outcomes if outcome.came_to in (KILLED, KILLED_BY_PROGRAM))
    lines += ["", "Killed, by test"] + [f"{count:5d} {name}" for name, count in killers.most_common()]
    lines += ["", "By family", *by_family(outcomes, reasons)]
    return "\n".join(lines)
