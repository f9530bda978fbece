"""The files of port/flight: includes go one way, as its README draws them; of lib/ they include only the public
header."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LAYER = ROOT / "port" / "flight"

# From the ground up. A file includes its own header and headers of lower floors.
FLOORS = [
    {"goe_flight.h", "goe_flight_settings_list"},
    {"goe_flight_maths"},
    {"goe_marks", "goe_travel", "goe_clock", "goe_history", "goe_candidate", "goe_flight_seal"},
    {"goe_geometry"},
    {"goe_slot"},
    {"goe_parts"},
    {"goe_table", "goe_lookout"},
    {"goe_clear"},
    {"goe_reaction"},
    {"goe_flight.c"},
]


def floor(file: str) -> int:
    """The floor of a file. The public header is at the bottom, the chain of the same name at the top."""
    names = {file, file.rsplit(".", 1)[0]}
    return next(number for number, files in enumerate(FLOORS) if names & files)


def included(path: Path) -> set[str]:
    return set(re.findall(r'^ *# *include "([^"]+)"', path.read_text(encoding="utf-8"), flags=re.MULTILINE))


def upward(file: str, targets: set[str]) -> list[str]:
    own = file.rsplit(".", 1)[0] + ".h"
    return [f"{file} -> {target}" for target in sorted(targets - {own}) if floor(target) >= floor(file)]


def sources() -> list[Path]:
    return sorted(LAYER.glob("*.[ch]"))


def test_includes_go_down() -> None:
    for path in sources():
        assert upward(path.name, included(path) - {"goe.h"}) == []


def test_of_the_library_only_the_public_header_is_known() -> None:
    own = {path.name for path in sources()}
    for path in sources():
        of_library = included(path) - own
        assert of_library <= ({"goe.h"} if path.name == "goe_flight.h" else set()), path.name


def test_an_arrow_upwards_is_noticed() -> None:
    assert upward("goe_slot.c", {"goe_slot.h", "goe_table.h", "goe_flight.h"}) == ["goe_slot.c -> goe_table.h"]


def test_the_settings_list_has_every_setting_with_the_manual_s_range_and_default() -> None:
    manual = (LAYER / "goe_flight.h").read_text(encoding="utf-8")
    block = manual[: manual.index("} goe_flight_settings_t;")].rsplit("typedef struct {", 1)[1]
    drawn = {
        name: tuple(float(number) for number in numbers)
        for name, *numbers in re.findall(
            r"float (\w+);\s*/\*(?:(?!\*/).)*?([\d.e-]+) (?:to|or)\s+([\d.e-]+);\s*([\d.e-]+) \*/", block, re.DOTALL
        )
    }
    listed = {
        name: (float(least), float(most), float(usual))
        for name, least, most, usual in re.findall(
            r"^GOE_FLIGHT_SETTING\((\w+), ([\d.e]+)f, ([\d.e]+)f, ([\d.e]+)f\)",
            (LAYER / "goe_flight_settings_list.h").read_text(encoding="utf-8"),
            re.MULTILINE,
        )
    }
    assert list(listed) == re.findall(r"float (\w+);", block)
    assert drawn == listed
