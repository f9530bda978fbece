"""Evidence by fuzzing: slices are added up and kept, the goals decide which target runs next, and failures are
reported."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from ci.__main__ import main
from ci.evidence import command, fuzz
from ci.evidence.fuzz import MEMORY, PLAIN, SANITIZED, BrokenError, Job
from ci.evidence.fuzz_state import Build, State, read_state, write_state
from ci.evidence.record import read

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def stand_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A target that prints the number of its arguments as its count, and fails on seed 13."""
    place = tmp_path / "target"
    place.write_text(
        '#!/bin/sh\n[ "$4" = 13 ] && { echo "fuzz: it broke" >&2; exit 134; }\necho "{\\"updates\\": $#}"\n'
    )
    place.chmod(0o755)
    monkeypatch.setattr(fuzz, "program", lambda of, target, kind="fuzz": place)
    return place


def finished(but: str = "", updates: int = 0) -> State:
    """Counts that meet all goals of the long run, with so many updates, except for one target."""
    state = State("hash")
    state.add("default/estimator", {"updates": updates})
    state.add("fuzz/estimator", {"updates": updates})
    for of in (SANITIZED, MEMORY):
        for target in fuzz.TARGETS:
            state.add(Job(of, target, 0.0).name, {"seconds": fuzz.OTHERS_S["long"]})
    for target in fuzz.TARGETS:
        state.add(Job(SANITIZED, target, 0.0, True).name, {"seconds": fuzz.FUZZER_S})
    state.counts.pop(but, None)
    return state


def test_counts_of_slices_are_added_and_edges_are_not() -> None:
    state = State("hash")
    state.add("fuzz/log/libfuzzer", {"runs": 5, "edges": 70})
    state.add("fuzz/log/libfuzzer", {"runs": 7, "edges": 60})
    state.add("fuzz/logger", {"runs": 100})
    assert state.counts["fuzz/log/libfuzzer"] == {"runs": 12, "edges": 70}
    assert state.sum_over("fuzz/log", "runs") == 12
    assert state.all_of("log")["runs"] == 12


def test_a_stopped_run_goes_on_with_other_seeds_unless_the_library_is_another(tmp_path: Path) -> None:
    place = tmp_path / "deep" / "state.json"
    state = State("hash")
    state.add("default/estimator", {"updates": 5})
    first = state.next_seed()
    write_state(place, state)
    again = read_state(place, "hash")
    assert again.counts == state.counts
    assert again.next_seed() > first
    assert read_state(place, "other").counts == {}
    place.write_text("{")
    assert read_state(place, "hash").counts == {}


def test_the_target_farthest_from_its_goal_runs_next() -> None:
    state = finished()
    assert fuzz.next_job(state, 1000, []) == Job(PLAIN, "estimator", fuzz.SLICE_S)
    state.add("default/estimator", {"updates": 890})
    assert fuzz.next_job(state, 1000, []) == Job(SANITIZED, "estimator", fuzz.SLICE_S)
    state.add("fuzz/estimator", {"updates": 100})
    assert fuzz.next_job(state, 1000, []) == Job(PLAIN, "estimator", fuzz.SLICE_S)
    state.add("default/estimator", {"updates": 10})
    assert fuzz.next_job(state, 1000, []) is None


@pytest.mark.parametrize("name", ["fuzz/log", "fuzz-msan/text", "fuzz-msan/estimator", "fuzz/companion/libfuzzer"])
def test_every_other_target_has_its_time(name: str) -> None:
    state = finished(name, 2000)
    job = fuzz.next_job(state, 1000, [])
    assert job is not None and job.name == name
    assert fuzz.next_job(state, 1000, [job]) is None  # one at a time


def test_the_rows_list_the_missing_counts() -> None:
    state = State("hash")
    state.add("default/estimator", {"runs": 3, "updates": 900, "status_ok": 1, "status_stale": 0, "movers_followed": 2})
    state.add("fuzz/estimator", {"runs": 1, "updates": 99, "latency_reported": 1})
    rows = {row.what: row for row in fuzz.rows_of(state, 1000)}
    assert rows["updates through goe_update, every answer checked"].met is False
    assert rows["... of them under ASan and UBSan"].figure == "99"
    assert rows["... of them under ASan and UBSan"].met is False
    assert rows["statuses of images reached"].figure == "1 of 2"
    assert rows["inputs that broke something"].met is True
    assert rows["inputs of estimator"].figure == "4"
    state.broken.append("log: it broke")
    rows = {row.what: row for row in fuzz.rows_of(state, 1000)}
    assert rows["inputs that broke something"].met is False
    assert "log: it broke" in fuzz.report_of(state)


def test_a_target_that_breaks_is_reported_and_ends_the_run(stand_in: Path, tmp_path: Path) -> None:
    assert fuzz.drive(PLAIN, "text", [], tmp_path) == {"updates": 2}
    with pytest.raises(BrokenError, match="it broke"):
        fuzz.drive(PLAIN, "text", ["--random", "13"], tmp_path)
    state = finished()
    state.seed = 10  # the third slice includes seed 13
    place = tmp_path / "state.json"
    fuzz.run_slices(state, 10**9, 1, tmp_path, place)
    assert len(state.broken) == 1 and "it broke" in state.broken[0]
    assert json.loads(place.read_text())["broken"] == state.broken
    assert state.count("default/estimator", "updates") + state.count("fuzz/estimator", "updates") > 0


def test_a_broken_input_counts_until_it_is_mended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ran = []

    def drive(of: Build, target: str, arguments: list[str], keep: Path) -> dict[str, float]:
        ran.append(target)
        if "crash" in arguments[0]:
            raise BrokenError("it breaks yet")
        return {}

    monkeypatch.setattr(fuzz, "drive", drive)
    mended = tmp_path / "broken-fuzz_estimator-7-123"
    broken = tmp_path / "broken-libfuzzer-log-crash-abc"
    mended.touch()
    broken.touch()
    assert fuzz.still_broken(tmp_path) == [f"{broken.name}: it breaks yet"]
    assert ran == ["estimator", "log"]
    assert broken.exists() and not mended.exists()


def test_libfuzzers_edges_are_read_from_its_last_line() -> None:
    log = "#2 INITED cov: 12 ft: 13 corp: 1/1b\n#9 NEW    cov: 345 ft: 400 corp: 2/9b\nDone 9 runs\n"
    assert fuzz.edges_of(log) == 345
    assert fuzz.edges_of("nothing") == 0


def test_a_long_run_is_recorded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    state = State("hash")
    state.add("default/estimator", {"updates": 1234})
    monkeypatch.setattr(fuzz, "run_long", lambda updates, jobs, keep: state)
    monkeypatch.setattr(command, "REPORTS", tmp_path)
    record = tmp_path / "new" / "record.json"
    arguments = ["evidence", "--long", "--only", "fuzz", "--updates", "1000", "--record", str(record)]
    assert main(arguments) == 1  # none of them under the sanitizers
    rows = read(record)["fuzz"].rows
    assert (rows[0].figure, rows[0].met) == ("1,234", True)


def test_every_target_has_a_harness_and_a_corpus_that_is_small() -> None:
    harnesses = {path.stem for path in (ROOT / "tests" / "fuzz").glob("fuzz_*.c")}
    assert harnesses >= {f"fuzz_{target}" for target in fuzz.TARGETS}
    assert {path.name for path in fuzz.CORPUS.iterdir()} == set(fuzz.TARGETS)
    for target in fuzz.TARGETS:
        assert any((fuzz.CORPUS / target).iterdir()), target
    assert sum(path.stat().st_size for path in fuzz.CORPUS.rglob("*")) < 300_000
