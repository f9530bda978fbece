"""The cost of the flight layer's calls: evaluation of the tools' output."""

from __future__ import annotations

from ci.cost.flight import HEADER, PUBLIC, calls_of, exceeded, ranges_of, stated, table
from ci.cost.instructions import Spread


def test_the_callers_are_left_out_and_thumb_addresses_are_even() -> None:
    symbols = (
        "00000101 00000010 T goe_flight_init\n00000200 00000004 t fly\n00000080 00000008 W memcpy\n00000300 D data\n"
    )
    assert ranges_of(symbols) == [(0x80, 0x88, "memcpy"), (0x100, 0x110, "goe_flight_init")]


def test_calls_are_gathered_by_their_function() -> None:
    spreads = calls_of("1 10 0:4 1:6\n0 5 0:5\n1 20 1:20\n", ["memcpy", "goe_flight_init"])
    assert spreads == {"goe_flight_init": Spread(10, 15.0, 20), "memcpy": Spread(5, 5.0, 5)}


def test_a_row_for_each_call() -> None:
    text = table({"m4f-gcc-os": {name: Spread(1, 2.0, 3) for name in PUBLIC}})
    assert text.splitlines()[0].endswith("| Cortex-M4F gcc -Os |")
    assert text.splitlines()[2] == "| `goe_flight_init` | 2 / 3 |"
    assert len(text.splitlines()) == 2 + len(PUBLIC)


def test_more_than_the_manual_states_is_reported() -> None:
    limits = stated(HEADER.read_text(encoding="utf-8"))
    assert list(limits) == list(PUBLIC)
    within = {name: Spread(1, 2.0, limit) for name, limit in limits.items()}
    assert exceeded({"m4f-gcc-os": within}, limits) == []
    more = {**within, "goe_flight_frame": Spread(1, 2.0, limits["goe_flight_frame"] + 1)}
    assert len(exceeded({"m4f-gcc-os": more, "m0plus-gcc-os": more}, limits)) == 1
