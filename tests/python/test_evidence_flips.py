"""The part ``flips`` of the evidence: evaluation of the program's lines."""

from __future__ import annotations

import pytest
from ci.evidence import flips

HEADER = (
    "flips,flight,images,field,bits,crashed,hung,not_finite,undefined,corrupted,suspect,reported,wrong,was_wrong,masked"
)


def lines(*rows: str) -> str:
    return "\n".join([HEADER, *rows])


GOOD = lines(
    'flips,"window, disc",3,settings,8,0,0,0,0,8,0,0,0,0,0',
    'flips,"window, disc",3,motion.dx_m,10,0,0,0,0,2,1,1,3,1,2',
    'flips,"filter, disc",12,motion.dx_m,10,0,0,0,0,0,0,0,0,0,10',
)


def met(text: str) -> list[bool | None]:
    return [row.met for row in flips.rows(flips.counts(text))]


def test_lines_are_counted_by_their_outcome() -> None:
    found = flips.counts(GOOD)
    assert [count.flight for count in found] == ["window, disc", "window, disc", "filter, disc"]
    assert found[1].of(["corrupted", "suspect", "reported"]) == 4
    by_field = flips.summed(found, "field")
    assert by_field["motion.dx_m"]["bits"] == 20 and by_field["motion.dx_m"]["wrong"] == 3
    figures = [row.figure for row in flips.rows(found)]
    assert figures[0] == "0 of 28" and figures[3] == "4 of 20 (20.00 %)" and figures[6] == "3 of 20 (15.00 %)"
    assert met(GOOD) == [True, True, True, None, None, None, None]


@pytest.mark.parametrize(
    ("row", "missed"),
    [
        ('flips,"a",3,motion.dx_m,2,1,0,0,0,0,0,0,0,0,1', 0),
        ('flips,"a",3,motion.dx_m,2,0,1,0,0,0,0,0,0,0,1', 0),
        ('flips,"a",3,motion.dx_m,2,0,0,1,0,0,0,0,0,0,1', 1),
        ('flips,"a",3,motion.dx_m,2,0,0,0,1,0,0,0,0,0,1', 1),
        ('flips,"a",3,settings,2,0,0,0,0,1,0,0,0,0,1', 2),
    ],
)
def test_one_bad_bit_misses_its_goal(row: str, missed: int) -> None:
    assert [number for number, word in enumerate(met(GOOD + "\n" + row)) if word is False] == [missed]


def test_nothing_flown_meets_nothing() -> None:
    assert met(HEADER)[:3] == [False, False, False]


def test_a_line_of_other_columns_is_refused() -> None:
    with pytest.raises(ValueError, match="zip"):
        flips.counts(lines('flips,"a",3,motion.dx_m,2,1'))


def test_the_report_names_the_most_frequent_faults() -> None:
    text = flips.report(flips.counts(GOOD))
    assert "| motion.dx_m | 20 |" in text and "silently wrong" in text
    assert "| window, disc | 18 |" in text
