"""The programs against hostile files, full disks, closed pipes and careless command lines: each earlier finding,
and the tests that detect its return."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from goe_tools.places import ROOT

from .parts import Amount, NotHereError
from .record import Result, Row

PROGRAMS = ("sim_host/goe_replay", "sim_host/goe_sim", "sim_host/goe_campaign", "sim_host/goe_avoid")
COMPANION = "port/companion/goe_companion"
SETTINGS = ROOT / "tools" / "pyproject.toml"


@dataclass(frozen=True)
class Finding:
    what: str
    tests: tuple[str, ...]  # file::test, below tests/


SIM, REPLAY, ENDLESS = "sim/test_sim_log.py", "host/test_replay.py", "host/test_endless_input.py"
AVOID, CAMPAIGN, COMPANION_TESTS = "sim/test_avoid.py", "sim/test_campaign.py", "companion/test_companion_usage.py"
SCHEMA, WHOLE = "python/test_log_schema.py", "python/test_whole_file.py"
BAD_RECORDINGS = f"{SIM}::test_bad_recordings_are_refused_with_their_place"

FINDINGS = (
    Finding("recordings: surplus fields, NUL, hexadecimal, 1e308, cut numbers, lines counted", (BAD_RECORDINGS,)),
    Finding("recordings: byte order mark, long numbers", (f"{SIM}::test_recordings_written_otherwise",)),
    Finding(
        "a last row that may be cut off",
        (f"{REPLAY}::test_bad_frames", f"{SCHEMA}::test_a_last_row_that_may_be_cut_off", BAD_RECORDINGS),
    ),
    Finding(
        "--out onto an input, through any link",
        (
            f"{REPLAY}::test_out_never_replaces_the_log",
            f"{SIM}::test_out_never_replaces_an_input",
            f"{WHOLE}::test_commands_refuse_their_inputs",
            "python/test_convert.py::test_an_input_is_not_replaced",
        ),
    ),
    Finding(
        "--out through a dangling link",
        (
            f"{REPLAY}::test_out_through_a_link_that_leads_nowhere",
            f"{AVOID}::test_a_table_goes_through_no_link_that_leads_nowhere",
            f"{WHOLE}::test_places_that_are_none",
        ),
    ),
    Finding(
        "goe_campaign checks --out before it flies",
        (
            f"{CAMPAIGN}::test_where_nothing_can_be_written",
            f"{CAMPAIGN}::test_places_that_are_taken_are_reported_before_the_flights",
        ),
    ),
    Finding(
        "memory bounded for any input",
        (
            f"{ENDLESS}::test_frames",
            f"{ENDLESS}::test_recorded_flights",
            f"{ENDLESS}::test_settings",
            f"{ENDLESS}::test_python_readers",
            "python/test_convert.py::test_files_that_are_none",
        ),
    ),
    Finding(
        "a full disk, a closed pipe",
        (
            f"{REPLAY}::test_full_disk",
            f"{REPLAY}::test_closed_pipe",
            f"{REPLAY}::test_file_size_limit_leaves_nothing",
            f"{SIM}::test_a_full_disk_leaves_nothing",
            f"{CAMPAIGN}::test_a_full_disk_leaves_nothing",
            f"{AVOID}::test_output_that_cannot_be_printed_is_reported",
            f"{COMPANION_TESTS}::test_output_that_cannot_be_printed_is_reported",
            f"{WHOLE}::test_output_that_nobody_takes",
        ),
    ),
    Finding(
        "Ctrl-C while writing",
        (
            f"{REPLAY}::test_interrupt_leaves_nothing",
            f"{SIM}::test_interrupted_runs_leave_no_part_of_a_log",
            f"{WHOLE}::test_an_unfinished_file_leaves_nothing",
            f"{WHOLE}::test_a_log_is_written_whole",
        ),
    ),
    Finding(
        "bad values name their option, mistyped words get a suggestion",
        (
            f"{REPLAY}::test_bad_usage",
            f"{AVOID}::test_bad_values_name_their_option",
            f"{COMPANION_TESTS}::test_a_mistyped_option_is_guessed",
        ),
    ),
)


def outcomes(tests: list[str]) -> dict[str, list[bool]]:
    """Whether each case of each test passed, by file::test. A skipped case did not."""
    with tempfile.TemporaryDirectory() as scratch:
        report = Path(scratch) / "report.xml"
        words = [
            sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-c", str(SETTINGS),
            f"--rootdir={ROOT / 'tests'}", f"--junitxml={report}", *(str(ROOT / "tests" / test) for test in tests),
        ]  # fmt: skip
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
        if not report.is_file() or done.returncode not in (0, 1):
            raise ValueError(f"pytest: {(done.stdout + done.stderr).strip()[-1000:]}")
        return read_outcomes(report.read_text(encoding="utf-8"))


def read_outcomes(text: str) -> dict[str, list[bool]]:
    """Parses pytest's JUnit XML."""
    found: dict[str, list[bool]] = {}
    for case in ElementTree.fromstring(text).iter("testcase"):
        name = f"{case.get('classname', '').replace('.', '/')}.py::{case.get('name', '').split('[')[0]}"
        bad = any(child.tag in ("failure", "error", "skipped") for child in case)
        found.setdefault(name, []).append(not bad)
    return found


def row_of(finding: Finding, found: dict[str, list[bool]]) -> Row:
    cases = [passed for test in finding.tests for passed in found.get(test, [False])]
    good = sum(cases)
    return Row(finding.what, f"fixed: {good} of {len(cases)} cases pass", "all", good == len(cases))


def run(_: Amount) -> Result:
    missing = [name for name in (*PROGRAMS, COMPANION) if not (ROOT / "build" / name).is_file()]
    if missing:
        raise NotHereError(f"build/{missing[0]}, which cmake --build --preset default makes")
    found = outcomes(sorted({test for finding in FINDINGS for test in finding.tests}))
    rows = [row_of(finding, found) for finding in FINDINGS]
    fixed = sum(row.met is True for row in rows)
    whole = Row("findings fixed, with tests", f"{fixed} of {len(rows)}", "all", fixed == len(rows))
    lines = [f"{finding.what}\n" + "\n".join(f"  tests/{test}" for test in finding.tests) for finding in FINDINGS]
    return Result([whole, *rows], "\n".join(lines))
