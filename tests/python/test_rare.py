"""Rare events: counts, intervals, a record that runs continue, and the repository's record, partly flown again."""

from __future__ import annotations

from pathlib import Path

import pytest
from goe_tools.__main__ import main
from goe_tools.report.avoid_file import KINDS, read_avoid
from goe_tools.report.rare import sentence, table
from goe_tools.report.rare_command import CHUNK_RUNS, HASH, PROGRAM, fly, version_of
from goe_tools.report.rare_record import FIRST_SEED, added, events_of, flights, interval, read_record
from scipy.stats import binom
from synthetic_campaign import avoid_rows, write_avoid

ROOT = Path(__file__).resolve().parents[2]
RECORD = ROOT / "tests" / "data" / "rare_events.json"
goe_avoid = pytest.mark.skipif(not PROGRAM.exists(), reason=f"{PROGRAM} is not built")


def test_events_are_counted(tmp_path: Path) -> None:
    """Synthetic runs with a late order that ends in a collision, a false order, and the events set here."""
    rows = avoid_rows(20)
    for row in rows:
        if row["course"] == "collision" and row["kind"] == "mast" and row["seed"] in (3, 4):
            row["confident"] = 1
        if row["course"] == "collision" and row["kind"] == "building" and row["seed"] in (1, 5):
            row |= {"action": "none", "ahead_s": None}  # 1 would not have collided
    counts = events_of(read_avoid(write_avoid(tmp_path / "avoid.csv", rows)))
    assert counts["collision"] == {
        "mast": {"runs": 20, "doomed": 19, "unwarned": 0, "collided": 0, "confident": 2},
        "building": {"runs": 20, "doomed": 19, "unwarned": 1, "collided": 0, "confident": 0},
        "truck": {"runs": 20, "doomed": 19, "unwarned": 1, "collided": 1, "confident": 0},
    }
    assert counts["pass"]["building"] == {"runs": 20, "doomed": 0, "false_order": 1, "confident": 0}
    assert flights(counts) == 20 * 3 * 3
    twice = added(counts, counts)
    assert twice["collision"]["mast"]["confident"] == 4 and twice["pass"]["truck"]["runs"] == 40


@pytest.mark.parametrize(("times", "runs"), [(0, 1000), (3, 1000), (50, 1000), (1000, 1000)])
def test_the_interval_has_its_probability(times: int, runs: int) -> None:
    """At each end of the interval, the observed count or a more extreme one has a probability of 2.5 %."""
    low, high = interval(times, runs)
    assert 0.0 <= low <= times / runs <= high <= 1.0
    if times > 0:
        assert binom.sf(times - 1, runs, low) == pytest.approx(0.025, rel=1e-6)
    if times < runs:
        assert binom.cdf(times, runs, high) == pytest.approx(0.025, rel=1e-6)


@pytest.mark.release
@goe_avoid
def test_a_record_is_continued(tmp_path: Path, capsys) -> None:
    file = tmp_path / "record.json"
    command = ["rare", "--out", str(file), "--jobs", "1", "--flights"]
    assert main([*command, "1"]) == 0
    first = read_record(file)
    assert first.runs == CHUNK_RUNS and first.counts == first.first
    assert first.flight_hash == HASH.read_text().split()[0]
    assert main([*command, str(flights(first.counts) + 1)]) == 0
    both = read_record(file)
    assert both.runs == 2 * CHUNK_RUNS and both.first == first.first
    assert both.counts == added(first.counts, fly(PROGRAM, FIRST_SEED + CHUNK_RUNS))
    before = file.read_bytes()
    assert main([*command, "1"]) == 0 and file.read_bytes() == before
    output = capsys.readouterr().out
    assert f"{flights(both.counts)} simulated flights" in output


@goe_avoid
@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "not a record of rare events"),
        ('{"version": "0", "flight_hash": "0"}', "not a record of rare events"),
        ("hash", "name another file"),
        ("first", "its first flights now give another result"),
    ],
)
def test_a_bad_record(tmp_path: Path, text: str, reason: str, capsys) -> None:
    file = tmp_path / "record.json"
    if text in ("hash", "first"):
        record = read_record(RECORD)
        if text == "hash":
            record.flight_hash = "0123456789abcdef"
        else:
            record.version = version_of(PROGRAM)  # the record may be of an earlier one
            record.first["pass"]["mast"]["false_order"] += 1
        record.write(file)
    else:
        file.write_text(text)
    before = file.read_bytes()
    assert main(["rare", "--flights", "1", "--out", str(file)]) == 2
    assert reason in capsys.readouterr().err and file.read_bytes() == before


@goe_avoid
def test_the_record_s_first_flights_are_these() -> None:
    record = read_record(RECORD)
    assert record.flight_hash == HASH.read_text().split()[0], "the layer's bits have changed: make a new record"
    assert record.first == fly(PROGRAM, FIRST_SEED)


def test_the_record_is_reported() -> None:
    record = read_record(RECORD)
    assert f"In {flights(record.counts):,} simulated flights" in sentence(record)
    rows = table(record)
    assert len(rows) == 5 * len(KINDS)
    assert all(row["css"] == ("miss" if row["cells"][1] != "0" else "") for row in rows)
