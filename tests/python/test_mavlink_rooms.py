"""The files of port/mavlink: the codec includes no other part, the mappings only the flight layer's public header and
maths."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LAYER = ROOT / "port" / "mavlink"

ALLOWED = {
    "goe_mavlink.h": set(),
    "goe_mavlink_messages.h": set(),
    "goe_mavlink.c": {"goe_mavlink.h", "goe_mavlink_messages.h"},
    "goe_mavlink_map.h": {"goe_flight.h", "goe_mavlink.h"},
    "goe_mavlink_map_in.c": {"goe_flight_maths.h", "goe_mavlink_map.h"},
    "goe_mavlink_map_out.c": {"goe_flight_maths.h", "goe_mavlink_map.h"},
}


def test_includes_are_these_and_no_others() -> None:
    found = {
        path.name: set(re.findall(r'^ *# *include "([^"]+)"', path.read_text(encoding="utf-8"), flags=re.MULTILINE))
        for path in LAYER.glob("*.[ch]")
    }
    assert found == ALLOWED


def test_the_layers_below_do_not_know_messages() -> None:
    for folder in ("lib", "port/flight"):
        for path in (ROOT / folder).rglob("*.[ch]"):
            assert "goe_mavlink" not in path.read_text(encoding="utf-8"), path.name
