"""port/ardupilot/goe_plane.lua, run by Lua 5.3 with stand-ins for ArduPilot's bindings, compared by name with 4.7-dev,
commit 90700977c5, on 22 Nov 2026."""

from __future__ import annotations

import importlib.util
import math
import struct
import sys
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

lua53 = pytest.importorskip("lupa.lua53", reason="lupa is not installed")
mavgen = pytest.importorskip("pymavlink.generator.mavgen", reason="pymavlink is not installed")

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "port" / "ardupilot" / "goe_plane.lua"
AUTO, CRUISE, LOITER, GUIDED = 10, 7, 12, 15
LEFT, CLIMB, GO_AROUND, HOLD = 1, 3, 4, 5
ORDER = 0x20
DO_GO_AROUND = 191
NOWHERE = 2**31 - 1

STAND_INS = """
local py = ...
function uint32_t(x) return x end
function millis() return py.now_ms end
function Parameter(name) return { get = function() return py.enable end } end
param = { add_table = function() return true end, add_param = function() return true end,
          get = function(_, name) return name == "MAV_SYSID" and 1 or nil end }
gcs = { send_text = function(_, severity, text) py.say(text) end,
        run_command_int = function(_, command, what) py.command(command); return 0 end }
arming = { is_armed = function() return py.armed end }
mavlink = { init = function(_, queue, kinds) assert(queue >= kinds and kinds == 2) end,
            register_rx_msgid = function(_, id) py.register(id); return true end,
            receive_chan = function() local m = py.receive(); if m then return m, 0, py.now_ms end end }
local function place(values)
    local one = {}
    for _, name in ipairs({ "lat", "lng", "alt" }) do
        one[name] = function(self, new)
            if new then
                assert(math.type(new) == "integer", name)
                values[name] = new
            else
                return values[name]
            end
        end
    end
    one.values = values
    return one
end
ahrs = { get_origin = function() return place({ lat = 473977420, lng = 85455940, alt = 48800 }) end }
vehicle = { get_mode = function() return py.mode end,
            set_mode = function(_, mode) py.mode = mode; py.led(mode); return true end,
            is_landing = function() return py.landing end, is_taking_off = function() return false end,
            set_target_location = function(_, place)
                if py.mode ~= 15 then return false end
                py.fly_to(place.values.lat, place.values.lng, place.values.alt)
                return true
            end }
"""


@pytest.fixture(scope="module")
def goe(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    """The dialect in Python, by mavgen."""
    out = tmp_path_factory.mktemp("dialect") / "goe_of_script.py"
    options = mavgen.Opts(str(out), wire_protocol="2.0", language="Python3", validate=False)
    assert mavgen.mavgen(options, [str(ROOT / "port" / "mavlink" / "goe.xml")])
    spec = importlib.util.spec_from_file_location("goe_of_script", out)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules["goe_of_script"] = module
    spec.loader.exec_module(module)
    return module


@dataclass
class Plane:
    """What the script sees of the aircraft, and what it did."""

    goe: ModuleType
    mode: int = AUTO
    armed: bool = True
    landing: bool = False
    enable: int = 1
    now_ms: int = 1000
    texts: list[str] = field(default_factory=list)
    commands: list[int] = field(default_factory=list)
    modes: list[int] = field(default_factory=list)
    places: list[tuple[int, int, int]] = field(default_factory=list)
    registered: list[int] = field(default_factory=list)
    waiting: list[bytes] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.lua = lua53.LuaRuntime(encoding=None)
        self.lua.execute(STAND_INS.encode(), self)
        self.update: Any = self.lua.execute(SCRIPT.read_bytes())
        self.update = self.update[0]

    # called from Lua, where every string is bytes
    def say(self, text: bytes) -> None:
        self.texts.append(text.decode())

    def command(self, command: int) -> None:
        self.commands.append(command)

    def register(self, message: int) -> None:
        self.registered.append(message)

    def led(self, mode: int) -> None:
        self.modes.append(mode)

    def fly_to(self, lat: int, lon: int, alt: int) -> None:
        self.places.append((lat, lon, alt))

    def receive(self) -> bytes | None:
        return self.waiting.pop(0) if self.waiting else None

    # the companion
    def send(self, message: Any, system: int = 1, harm: int | None = None) -> None:
        frame = bytearray(message.pack(self.goe.MAVLink(None, srcSystem=system, srcComponent=196)))
        length = frame[1]
        whole = bytearray(struct.pack("<H", frame[-2] | frame[-1] << 8) + frame[: 10 + length])
        whole += bytes([0xAA] * (291 - len(whole)))  # what an earlier message left behind
        if harm is not None:
            whole[harm] ^= 1
        self.waiting.append(bytes(whole))

    def hazard(self, action: int = LEFT, flags: int = ORDER, down: float = -35.5, **rest: Any) -> Any:
        values: dict[str, Any] = {"id": 7, "lat": 474000000, "lon": 85460000} | rest
        return self.goe.MAVLink_goe_hazard_message(
            5000000, values["id"], values["lat"], values["lon"], [1.0, 2.0, down], 8.0, 1.0, 2.0, 1.0,
            math.nan, math.nan, 0.6, 5.0, 0, action, flags,
        )  # fmt: skip

    def status(self, action: int) -> Any:
        return self.goe.MAVLink_goe_status_message(5000, *[0] * 10, 65535, 65535, 1, action, 3, 0)

    def pass_by(self) -> None:
        """The order ends: the obstacle is reported without one, a moment after the status says so."""
        self.run(0.5, status=0)
        self.send(self.hazard(action=0, flags=0))
        self.run(0.1)

    def run(self, seconds: float, status: int | None = None) -> None:
        for step in range(round(10 * seconds)):
            self.now_ms += 100
            if status is not None and step % 10 == 0:
                self.send(self.status(status))
            self.update()


@pytest.fixture
def plane(goe: ModuleType) -> Plane:
    return Plane(goe)


def test_it_listens_to_the_companion(plane: Plane) -> None:
    assert plane.registered == [42702, 42703]
    plane.run(5.0, status=0)
    assert plane.modes == [] and plane.texts == ["GOE: script runs"]


@pytest.mark.parametrize("mode", [AUTO, CRUISE])
def test_it_flies_to_the_target_and_back_into_the_mode_before(plane: Plane, mode: int) -> None:
    plane.mode = mode
    plane.send(plane.hazard())
    plane.run(0.1, status=LEFT)
    assert plane.modes == [GUIDED]
    assert plane.places == [(474000000, 85460000, 48800 + 3550)]
    plane.run(3.0, status=LEFT)
    assert 2 <= len(plane.places) <= 4
    plane.send(plane.hazard(lat=474000500))
    plane.run(1.5, status=LEFT)
    assert plane.places[-1][0] == 474000500
    plane.pass_by()
    assert plane.modes == [GUIDED, mode]
    plane.run(5.0, status=0)
    assert plane.modes == [GUIDED, mode]


@pytest.mark.parametrize("change", ["mode", "enable", "armed", "no order", "no action", "no place", "no height"])
def test_it_leaves_alone_what_is_not_its_own(plane: Plane, change: str) -> None:
    hazards = {
        "no order": plane.hazard(flags=0x08),
        "no action": plane.hazard(action=0),
        "no place": plane.hazard(lat=NOWHERE),
        "no height": plane.hazard(down=math.nan),
    }
    if change == "mode":
        plane.mode = LOITER
    elif change == "enable":
        plane.enable = 0
    elif change == "armed":
        plane.armed = False
    plane.send(hazards.get(change, plane.hazard()))
    plane.run(2.0, status=LEFT)
    assert plane.modes == [] and plane.places == []


@pytest.mark.parametrize("harm", [0, 3, 20, 70])
def test_a_harmed_message_is_none(plane: Plane, harm: int) -> None:
    plane.send(plane.hazard(), harm=harm)
    plane.run(1.0)
    assert plane.modes == []


def test_other_vehicles_companions_are_none_of_ours(plane: Plane) -> None:
    plane.send(plane.hazard(), system=2)
    plane.run(1.0)
    assert plane.modes == []


def test_a_pilot_who_chooses_a_mode_is_not_fought(plane: Plane) -> None:
    plane.send(plane.hazard())
    plane.run(1.0, status=LEFT)
    plane.mode = LOITER
    plane.send(plane.hazard())
    plane.run(5.0, status=LEFT)
    assert plane.modes == [GUIDED] and plane.mode == LOITER
    assert any("whoever" in text for text in plane.texts)
    plane.pass_by()
    assert plane.mode == LOITER
    plane.mode = AUTO
    plane.send(plane.hazard())
    plane.run(0.2, status=LEFT)
    assert plane.mode == GUIDED  # a new order counts again


def test_silence_does_not_send_it_back_towards_the_obstacle(plane: Plane) -> None:
    plane.send(plane.hazard())
    plane.run(1.0, status=LEFT)
    plane.run(20.0)
    assert plane.mode == GUIDED
    assert sum("silent" in text for text in plane.texts) == 1
    plane.pass_by()
    assert plane.mode == AUTO


@pytest.mark.parametrize("action", [LEFT, CLIMB])
def test_an_obstacle_that_was_given_up_is_not_flown_back_to(plane: Plane, action: int) -> None:
    plane.send(plane.hazard(action=action))
    plane.run(2.0, status=action)
    plane.send(plane.hazard(id=8, action=0, flags=0))  # of another one
    plane.run(2.0, status=0)
    assert plane.mode == GUIDED and not any("circling" in text for text in plane.texts)
    plane.run(5.0, status=0)
    assert plane.modes == [GUIDED]
    assert sum("circling" in text for text in plane.texts) == 1


def test_an_order_that_comes_back_goes_on(plane: Plane) -> None:
    plane.send(plane.hazard())
    plane.run(1.0, status=LEFT)
    plane.run(1.0, status=0)
    plane.send(plane.hazard())
    plane.run(6.0, status=LEFT)
    assert plane.modes == [GUIDED] and len(plane.places) >= 5


def test_going_around_is_for_landings_and_commanded_once(plane: Plane) -> None:
    plane.send(plane.hazard(action=GO_AROUND, lat=NOWHERE))
    plane.run(2.0, status=GO_AROUND)
    assert plane.commands == []
    plane.run(1.0, status=0)
    plane.landing = True
    for _ in range(5):
        plane.send(plane.hazard(action=GO_AROUND, lat=NOWHERE))
        plane.run(0.5, status=GO_AROUND)
    assert plane.commands == [DO_GO_AROUND]
    assert plane.modes == []


def test_holding_is_flown_like_the_others(plane: Plane) -> None:
    plane.send(plane.hazard(action=HOLD))
    plane.run(0.2, status=HOLD)
    assert plane.mode == GUIDED and len(plane.places) == 1
    plane.pass_by()
    assert plane.mode == GUIDED  # it turned away: the obstacle may lie on the way back
    assert any("circling" in text for text in plane.texts)
