"""The Kconfig files of port/zephyr and port/nuttx: defaults, ranges and dependencies are those of the headers."""

from __future__ import annotations

import re
from itertools import product
from pathlib import Path

import kconfiglib
import pytest
from kconfig_of import NUTTX, ROOT, ZEPHYR, apply, parse

HEADERS = (ROOT / "lib" / "goe_limits.h").read_text() + (ROOT / "port" / "flight" / "goe_flight.h").read_text()
NUMBERS = ("GOE_WINDOW_MAX", "GOE_CAMERAS_MAX", "GOE_FLIGHT_SLOTS")
PARTS = ("GOE_WITH_WINDOW", "GOE_WITH_FILTER", "GOE_WITH_HAZARD", "GOE_WITH_TARGET_MOTION")

ports = pytest.mark.parametrize("port", [ZEPHYR, NUTTX], ids=["zephyr", "nuttx"])


def value(parsed: kconfiglib.Kconfig, name: str) -> str:
    return parsed.syms[name].str_value


@ports
def test_nothing_is_built_unless_enabled(port: Path, tmp_path: Path) -> None:
    parsed = parse(port, tmp_path)
    assert value(parsed, "GOE") == "n"
    assert all(value(parsed, part) == "n" for part in (*PARTS, "GOE_FLIGHT", "GOE_MAVLINK"))


@ports
def test_defaults_are_those_of_the_headers(port: Path, tmp_path: Path) -> None:
    parsed = parse(port, tmp_path)
    apply(parsed, ["CONFIG_GOE=y"])
    for name in NUMBERS:
        assert re.search(rf"#define {name} {value(parsed, name)}\b", HEADERS), name
    for name in PARTS:
        assert (value(parsed, name) == "y") == (f"#define {name} 1 " in HEADERS), name
    assert value(parsed, "GOE_FLIGHT") == "y"
    assert value(parsed, "GOE_MAVLINK") == "n"


@ports
@pytest.mark.parametrize("name", NUMBERS)
def test_ranges_are_those_of_the_headers(port: Path, tmp_path: Path, name: str) -> None:
    (limits,) = re.findall(rf"#if {name} < (\d+) \|\| {name} > (\d+)", HEADERS)
    parsed = parse(port, tmp_path)
    apply(parsed, ["CONFIG_GOE=y"])
    symbol = parsed.syms[name]
    ((low, high, _),) = symbol.ranges
    assert (low.str_value, high.str_value) == limits
    for inside in limits:
        assert symbol.set_value(inside) and symbol.str_value == inside
    for outside in (int(limits[0]) - 1, int(limits[1]) + 1):
        symbol.set_value(str(outside))
        assert symbol.str_value != str(outside), "a value out of range is taken"


@ports
def test_every_choice_of_parts_compiles(port: Path, tmp_path: Path) -> None:
    """goe_limits.h needs a method, the flight layer the hazard, late poses the filter method."""
    parsed = parse(port, tmp_path)
    found = set()
    for chosen in product("yn", repeat=6):
        apply(parsed, ["CONFIG_GOE=y"])
        for name, wanted in zip((*PARTS, "GOE_FLIGHT", "GOE_MAVLINK"), chosen):
            parsed.syms[name].set_value(wanted)
        window, filtered, hazard, target_motion = (value(parsed, name) == "y" for name in PARTS)
        flight, mavlink = (value(parsed, name) == "y" for name in ("GOE_FLIGHT", "GOE_MAVLINK"))
        assert window or filtered
        assert filtered or not target_motion
        assert hazard or not flight
        assert flight or not mavlink
        found.add((window, filtered, hazard, target_motion, flight, mavlink))
    assert len(found) == 5 * 4, "a combination that would compile cannot be chosen"


@pytest.mark.parametrize(
    "port, poor", [(ZEPHYR, "MINIMAL_LIBC"), (NUTTX, "LIBM"), (NUTTX, "LIBM_NONE")], ids=["zephyr", "nuttx", "none"]
)
def test_own_square_root_where_the_tree_has_a_poor_one_or_none(port: Path, poor: str, tmp_path: Path) -> None:
    parsed = parse(port, tmp_path)
    apply(parsed, ["CONFIG_GOE=y"])
    assert value(parsed, "GOE_OWN_SQRTF") == "n"
    apply(parsed, [f"CONFIG_{poor}=y"])
    assert value(parsed, "GOE_OWN_SQRTF") == "y"
    apply(parsed, ["CONFIG_GOE_OWN_SQRTF=n"])


def test_programs_of_nuttx_are_built_only_if_enabled(tmp_path: Path) -> None:
    parsed = parse(NUTTX, tmp_path)
    apply(parsed, ["CONFIG_GOE=y"])
    assert value(parsed, "GOE_SENSOR_LOOP") == value(parsed, "GOE_GOLDEN_BITS") == "n"
    apply(parsed, ["CONFIG_GOE_SENSOR_LOOP=y", "CONFIG_GOE_GOLDEN_BITS=y"])


@pytest.mark.parametrize(
    "other",
    ["GOE_WITH_WINDOW=n", "GOE_WITH_FILTER=n", "GOE_WITH_TARGET_MOTION=n", "GOE_WITH_HAZARD=n", "GOE_WINDOW_MAX=9",
     "GOE_CAMERAS_MAX=2", "GOE_FLIGHT_SLOTS=3"],
)  # fmt: skip
def test_golden_bits_are_those_of_the_whole_with_its_defaults(other: str, tmp_path: Path) -> None:
    """Another build has other hashes, and the program would report a false failure."""
    parsed = parse(NUTTX, tmp_path)
    apply(parsed, ["CONFIG_GOE=y", "CONFIG_GOE_GOLDEN_BITS=y"])
    apply(parsed, [f"CONFIG_{other}"])
    assert value(parsed, "GOE_GOLDEN_BITS") == "n"


def test_priorities_of_nuttx_leave_one_above(tmp_path: Path) -> None:
    parsed = parse(NUTTX, tmp_path)
    apply(parsed, ["CONFIG_GOE=y"])
    ((_, high, _),) = parsed.syms["GOE_PRIORITY"].ranges
    assert high.str_value == "254"
