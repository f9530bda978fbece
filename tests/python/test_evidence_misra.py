"""MISRA's baseline: how the check reacts to more and fewer findings, and whether lib/MISRA.md covers every rule."""

from __future__ import annotations

import re
from pathlib import Path

from ci.evidence import analyzers, cppcheck, misra
from goe_tools.places import ROOT


def test_findings_are_read_with_their_rule_from_the_project_s_root() -> None:
    output = f"{ROOT}/lib/goe_status.c|20|15|misra-c2012-12.1|use --rule-texts\nChecking a.c ...\nnofile|0|0|info|x\n"
    assert cppcheck.findings_of(output) == {
        cppcheck.Finding("12.1", "lib/goe_status.c", 20, 15, "use --rule-texts"),
    }


def test_one_more_is_new_and_one_less_requires_a_renewal_of_the_baseline() -> None:
    kept = {("default", "12.1", "a.c"): 2, ("default", "15.5", "a.c"): 1, ("without HAZARD", "15.5", "a.c"): 1}
    found = {("default", "12.1", "a.c"): 3}
    more, less = misra.differences(found, kept, {"default"})
    assert more == ["default: rule 12.1, a.c: 3, in the baseline 2"]
    assert less == ["default: rule 15.5, a.c: 0, in the baseline 1"]
    assert misra.differences(kept, kept, {"default", "without HAZARD"}) == ([], [])


def test_the_baseline_is_written_as_it_is_read(tmp_path: Path) -> None:
    kept = {("default", "12.1", "a.c"): 2, ("default", "2.5", "a.c"): 1}
    misra.write_baseline(tmp_path / "baseline.csv", kept)
    assert misra.read_baseline(tmp_path / "baseline.csv") == kept


def test_the_page_answers_for_every_rule_of_the_baseline_with_its_count() -> None:
    total = misra.by_rule(misra.read_baseline(misra.BASELINE))
    output = misra.page_counts(misra.PAGE.read_text(encoding="utf-8"))
    assert output == dict(total)
    assert not misra.MANDATORY & set(total)


def test_counts_are_set_on_the_page() -> None:
    page = "| 12.1 | 3 | required | reason |\n| 15.5 | 1 | advisory | reason |\n"
    assert misra.page_counts(misra.set_page(page, {"12.1": 7})) == {"12.1": 7, "15.5": 0}


def test_warnings_of_headers_count_once() -> None:
    line = f"{ROOT}/lib/goe.h:1:2: warning: something [-Wthing]"
    assert analyzers.warnings_of(f"{line}\n{line}\nother text\n") == ["lib/goe.h:1:2: warning: something [-Wthing]"]


def test_a_false_alarm_is_left_out_and_missed_when_it_no_longer_comes() -> None:
    (name, file, text), _ = next(iter(analyzers.FALSE_ALARMS.items()))
    line = f"{file}:1:2: warning: {text} [-Wx]"
    assert analyzers.split_false(name, [line, "lib/goe.h:1:1: warning: new"]) == (["lib/goe.h:1:1: warning: new"], [])
    assert analyzers.split_false(name, []) == ([], [f"{file}: {text}"])


def test_every_check_that_clang_tidy_leaves_out_has_a_reason() -> None:
    file = (ROOT / ".clang-tidy").read_text()
    left_out = re.findall(r"^\s+-((?:bugprone|cert|clang-analyzer)-[\w.-]+)", file, re.MULTILINE)
    assert left_out
    reasons = file[: file.index("Checks:")]
    for check in left_out:
        assert re.search(rf"^# +{re.escape(check)}: \S", reasons, re.MULTILINE), check
