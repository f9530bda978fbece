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
x25crc = pytest.importorskip("pymavlink.mavutil", reason="pymavlink is not installed").x25crc
minimal = pytest.importorskip("pymavlink.dialects.v20.minimal", reason="pymavlink is not installed")

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "port" / "ardupilot" / "goe_plane.lua"
AUTO, CRUISE, LOITER, GUIDED = 10, 7, 12, 15
LEFT, CLIMB, GO_AROUND, HOLD = 1, 3, 4, 5
ORDER = 0x20
DO_GO_AROUND = 191
NOWHERE = 2**31 - 1

ORIGIN = (473977420, 85455940, 48800)  # degrees times 1e7, cm over the sea
METRE = 89.8315  # of latitude, degrees times 1e7
KEY = bytes(range(32))

STAND_INS = """
local py = ...
function uint32_t(x) return x end
function millis() return py.now_ms end
local own = { GOEP_ENABLE = true }
param = { add_table = function(_, _, prefix, count) assert(prefix == "GOEP_"); return true end,
          add_param = function(_, _, index, name, value) py.add_parameter("GOEP_" .. name, value); return true end,
          get = function(_, name) return py.parameter(name) end }
function Parameter(name) return { get = function() return py.parameter(name) end } end
gcs = { send_text = function(_, severity, text) assert(#text <= 50, text); py.say(text) end,
        run_command_int = function(_, command, what) py.command(command, what.p1); return 0 end }
arming = { is_armed = function() return py.armed end }
local listens = {}
mavlink = { init = function(_, queue, kinds) assert(queue >= kinds and kinds == py.kinds and queue <= 25) end,
            register_rx_msgid = function(_, id) listens[id] = true; py.register(id); return true end,
            receive_chan = function()
                while true do
                    local m, link = py.receive()
                    if not m then return end
                    if listens[string.unpack("<I3", m, 10)] then return m, link, py.now_ms end
                end
            end }
io = { open = function(name, how)
    local text = py.file(name)
    if not text then return nil end
    return { read = function(_, count) return text:sub(1, count) end, close = function() end }
end }
local function place(values)
    local one = {}
    for _, name in ipairs({ "lat", "lng", "alt" }) do
        one[name] = function(self, new)
            if new then
                assert(math.type(new) == "integer" and new < 2^31 and new >= -2^31, name)
                values[name] = new
            else
                return values[name]
            end
        end
    end
    one.get_distance = function(_, other)
        return py.distance(values.lat, values.lng, other.values.lat, other.values.lng)
    end
    one.values = values
    return one
end
local function somewhere(lat, lng, alt) return place({ lat = lat, lng = lng, alt = alt }) end
ahrs = { get_origin = function() return somewhere(473977420, 85455940, 48800) end,
         home_is_set = function() return py.home_set end,
         get_home = function() return somewhere(473977420, 85455940, 48800) end,
         get_location = function() if py.has_position then return somewhere(473977420, 85455940, py.own_alt) end end }
vehicle = { get_mode = function() return py.mode end,
            set_mode = function(_, mode) py.mode = mode; py.led(mode); return true end,
            is_landing = function() return py.landing end, is_taking_off = function() return py.taking_off end,
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
    taking_off: bool = False
    now_ms: int = 1000
    kinds: int = 3
    home_set: bool = True
    has_position: bool = True
    own_alt: int = ORIGIN[2] + 3500
    link_accepts_unsigned: bool = True  # what the autopilot's parser does
    beats: bool = True  # the companion's HEARTBEAT, once a second
    key: bytes | None = None  # the companion signs
    files: dict[str, bytes] = field(default_factory=dict)
    parameters: dict[str, float] = field(default_factory=lambda: {"MAV_SYSID": 1})
    texts: list[str] = field(default_factory=list)
    commands: list[int] = field(default_factory=list)
    heights: list[float | None] = field(default_factory=list)  # that commands carry
    modes: list[int] = field(default_factory=list)
    places: list[tuple[int, int, int]] = field(default_factory=list)
    registered: list[int] = field(default_factory=list)
    waiting: list[tuple[bytes, int]] = field(default_factory=list)
    stamp: int = 1000000000000
    link_id: int = 0

    def __post_init__(self) -> None:
        self.lua = lua53.LuaRuntime(encoding=None, unpack_returned_tuples=True)
        self.lua.execute(STAND_INS.encode(), self)
        result: Any = self.lua.execute(SCRIPT.read_bytes())
        self.update: Any = result[0]
        self.beat()

    def beat(self) -> None:
        """The companion runs since some time."""
        if self.beats:
            self.send(self.heartbeat())
            self.update()

    # called from Lua, where every string is bytes
    def say(self, text: bytes) -> None:
        self.texts.append(text.decode())

    def command(self, command: int, height_m: float | None) -> None:
        self.commands.append(command)
        self.heights.append(height_m)

    def register(self, message: int) -> None:
        self.registered.append(message)

    def led(self, mode: int) -> None:
        self.modes.append(mode)

    def fly_to(self, lat: int, lon: int, alt: int) -> None:
        self.places.append((lat, lon, alt))

    def add_parameter(self, name: bytes, value: float) -> None:
        self.parameters.setdefault(name.decode(), value)

    def parameter(self, name: bytes) -> float | None:
        return self.parameters.get(name.decode())

    def file(self, name: bytes) -> bytes | None:
        return self.files.get(name.decode())

    def distance(self, *places: int) -> float:
        lat, lon, to_lat, to_lon = places
        north, east = (to_lat - lat) / METRE, (to_lon - lon) / METRE * math.cos(math.radians(lat * 1e-7))
        return math.hypot(north, east)

    def receive(self) -> tuple[bytes, int] | None:
        return self.waiting.pop(0) if self.waiting else None

    # the companion
    def frame(self, message: Any, system: int, component: int) -> bytes:
        mav = self.goe.MAVLink(None, srcSystem=system, srcComponent=component)
        if self.key is not None:
            mav.signing.secret_key, mav.signing.sign_outgoing = self.key, True
            mav.signing.link_id, mav.signing.timestamp = self.link_id, self.stamp
            self.stamp += 1
        return bytes(message.pack(mav))

    def send(
        self, message: Any, system: int = 1, harm: int | None = None, component: int = 196, link: int = 1
    ) -> bytes:
        """As ArduPilot's parser hands it over: what it knows if the link takes it, what it does not know always."""
        frame = self.frame(message, system, component)
        length = frame[1]
        end = 10 + length
        whole = bytearray(struct.pack("<H", self.checksum_field(frame, end)) + frame[:end])
        whole += bytes([0xAA] * (276 - len(whole)))  # what an earlier message left behind
        whole += frame[end : end + 2] + (frame[end + 2 :] or bytes([0xAA] * 13))
        assert len(whole) == 291
        if harm is not None:
            whole[harm] ^= 1
        self.hand_over(bytes(whole), link)
        return bytes(whole)

    @staticmethod
    def checksum_field(frame: bytes, end: int) -> int:
        """The received one where the parser takes it for wrong. An unknown message that is signed is handed over once
        its signature is found right, with the parser's own sum, which lacks the seed that it does not know."""
        if frame[2] & 1:
            return int(x25crc(frame[1:end]).crc)
        return frame[end + 1] << 8 | frame[end]

    def hand_over(self, whole: bytes, link: int = 1) -> None:
        known = whole[9:12] == b"\0\0\0"
        if not known or whole[4] & 1 or self.link_accepts_unsigned:
            self.waiting.append((whole, link))

    def heartbeat(self) -> Any:
        return minimal.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3)

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
        """As the scheduler: the script says when it wants to be called again."""
        end = self.now_ms + round(1000 * seconds)
        next_second = self.now_ms
        next_call = self.now_ms
        while self.now_ms < end:
            if self.now_ms >= next_second:
                next_second += 1000
                if self.beats:
                    self.send(self.heartbeat())
                if status is not None:
                    self.send(self.status(status))
            if self.now_ms >= next_call:
                next_call = self.now_ms + self.update()[1]
            self.now_ms += 10


@pytest.fixture
def plane(goe: ModuleType) -> Plane:
    return Plane(goe)


def test_it_listens_to_the_companion(plane: Plane) -> None:
    assert plane.registered == [42702, 42703, 0]
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
        plane.parameters["GOEP_ENABLE"] = 0
    elif change == "armed":
        plane.armed = False
    plane.send(hazards.get(change, plane.hazard()))
    plane.run(2.0, status=LEFT)
    assert plane.modes == [] and plane.places == []


@pytest.mark.parametrize("harm", [276, 3, 20, 70])
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


@pytest.mark.parametrize(
    ("down", "parameters", "height_m"),
    [
        (-60.0, {}, 60.0),
        (math.nan, {}, None),
        (math.inf, {}, None),
        (-35.0, {}, None),  # the aircraft's own height: nothing is known of the top
        (-190.0, {}, None),  # too far above
        (-60.0, {"FENCE_ENABLE": 1, "FENCE_TYPE": 1, "FENCE_ALT_MAX": 50}, None),
    ],
)
def test_going_around_climbs_over_the_top(
    plane: Plane, down: float, parameters: dict[str, float], height_m: float | None
) -> None:
    plane.landing = True
    plane.parameters |= parameters
    plane.send(plane.hazard(action=GO_AROUND, lat=NOWHERE, down=down))
    plane.run(1.0, status=GO_AROUND)
    assert plane.commands == [DO_GO_AROUND]
    assert plane.heights == [height_m]


def test_a_side_breaks_a_landing_off(plane: Plane) -> None:
    """The top cannot be cleared in time: it is flown around, and no landing goes on from beside the runway."""
    plane.landing = True
    plane.send(plane.hazard())
    plane.run(0.2, status=LEFT)
    assert plane.mode == GUIDED and len(plane.places) == 1 and plane.commands == []
    plane.landing = False
    plane.pass_by()
    assert plane.mode == GUIDED
    assert any("broke off landing" in text for text in plane.texts)


def test_a_landing_is_broken_off_where_no_side_may_be_flown(plane: Plane) -> None:
    plane.landing = True
    plane.own_alt = ORIGIN[2] + 1500  # below GOEP_ALT_MIN
    for _ in range(3):
        plane.send(plane.hazard(down=-15.0))
        plane.run(0.5, status=LEFT)
    assert plane.modes == [] and plane.commands == [DO_GO_AROUND] and plane.heights == [None]


def test_a_take_off_is_left_alone(plane: Plane) -> None:
    plane.taking_off = True
    plane.send(plane.hazard())
    plane.run(0.5, status=LEFT)
    assert plane.modes == [] and plane.commands == []


def test_holding_is_flown_like_the_others(plane: Plane) -> None:
    plane.send(plane.hazard(action=HOLD))
    plane.run(0.2, status=HOLD)
    assert plane.mode == GUIDED and len(plane.places) == 1
    plane.pass_by()
    assert plane.mode == GUIDED  # it turned away: the obstacle may lie on the way back
    assert any("circling" in text for text in plane.texts)


# ---------------------------------------------------------------------------------------------------- who may order


def test_an_unsigned_order_counts_for_nothing_on_a_signed_link(plane: Plane) -> None:
    plane.link_accepts_unsigned = False
    plane.run(10.0)  # what the link took before it was signed counts no more
    for _ in range(5):
        plane.send(plane.hazard())
        plane.run(1.0, status=LEFT)
    assert plane.modes == [] and plane.places == []
    assert sum("unsigned" in text for text in plane.texts) == 1


def test_an_order_on_another_link_or_of_another_component_counts_for_nothing(plane: Plane) -> None:
    plane.send(plane.hazard(), link=2)
    plane.send(plane.hazard(), component=197)
    plane.run(1.0)
    assert plane.modes == []


def test_a_harmed_heartbeat_opens_no_link(goe: ModuleType) -> None:
    plane = Plane(goe, beats=False)
    for harm in (276, 12, 14):
        plane.send(plane.heartbeat(), harm=harm)
        plane.send(plane.hazard())
        plane.run(0.2)
    assert plane.modes == []


def test_a_signed_order_without_a_key_counts_for_nothing(goe: ModuleType) -> None:
    plane = Plane(goe, key=KEY)
    plane.send(plane.hazard())
    plane.run(2.0, status=LEFT)
    assert plane.modes == []
    assert sum("goe.key" in text for text in plane.texts) == 1


@pytest.mark.parametrize("text", [KEY, KEY.hex().encode(), KEY.hex().upper().encode() + b"\r\n"])
@pytest.mark.parametrize("name", ["APM/goe.key", "goe.key"])
def test_a_signed_order_is_flown(goe: ModuleType, name: str, text: bytes) -> None:
    plane = Plane(goe, key=KEY, files={name: text}, link_accepts_unsigned=False)
    plane.send(plane.hazard())
    plane.run(0.5, status=LEFT)
    assert plane.modes == [GUIDED] and plane.places[0] == (474000000, 85460000, 48800 + 3550)
    plane.pass_by()
    plane.run(1.0)
    assert plane.modes == [GUIDED, AUTO]


def test_with_a_key_nothing_unsigned_and_nothing_of_another_key_counts(goe: ModuleType) -> None:
    plane = Plane(goe, key=KEY, files={"APM/goe.key": KEY})
    for key in (None, bytes(32), KEY[:-1] + b"x"):
        plane.key = key
        plane.send(plane.hazard())
        plane.run(1.0, status=LEFT)
    assert plane.modes == []


@pytest.mark.parametrize("harm", [15, 60, 278, 279, 284, 285, 290])
def test_a_harmed_signature_is_none(goe: ModuleType, harm: int) -> None:
    plane = Plane(goe, key=KEY, files={"APM/goe.key": KEY})
    plane.send(plane.hazard(), harm=harm)
    plane.run(1.0)
    assert plane.modes == []


def test_a_message_that_the_parser_hands_over_twice_is_no_fault(goe: ModuleType) -> None:
    """ArduPilot's parser takes the checksum of an unknown signed message for wrong before it has read its signature:
    the script then gets what its buffer holds, the message before."""
    plane = Plane(goe, key=KEY, files={"goe.key": KEY})
    whole = plane.send(plane.hazard())
    plane.hand_over(whole)
    plane.run(0.5, status=LEFT)
    assert plane.mode == GUIDED
    assert not any("ignored" in text for text in plane.texts)


def test_a_signed_order_that_is_played_once_more_counts_for_nothing(goe: ModuleType) -> None:
    plane = Plane(goe, key=KEY, files={"APM/goe.key": KEY})
    heard = plane.send(plane.hazard())
    plane.run(1.0, status=LEFT)
    plane.pass_by()
    plane.run(1.0)
    assert plane.modes == [GUIDED, AUTO]
    for _ in range(3):
        plane.hand_over(heard)
        plane.run(1.0, status=0)
    assert plane.modes == [GUIDED, AUTO]


@pytest.mark.parametrize("signed", [False, True])
def test_another_vehicle_that_is_heard_as_well_gives_no_orders(goe: ModuleType, signed: bool) -> None:
    plane = Plane(goe, key=KEY, files={"APM/goe.key": KEY}) if signed else Plane(goe)
    plane.send(plane.heartbeat(), system=2)
    plane.run(0.2)
    plane.send(plane.hazard(), system=2)
    plane.run(1.0)
    assert plane.modes == []


def test_a_signed_heartbeat_opens_no_link_to_unsigned_orders(goe: ModuleType) -> None:
    plane = Plane(goe, key=KEY)
    plane.run(2.0)
    plane.beats, plane.key = False, None
    plane.send(plane.hazard())
    plane.run(1.0)
    assert plane.modes == []


def test_a_link_on_which_somebody_signs_is_signed(goe: ModuleType) -> None:
    """ArduPilot's first link takes unsigned messages even if it signs."""
    plane = Plane(goe)
    for _ in range(4):
        plane.key = KEY
        plane.send(plane.heartbeat(), system=255, component=190)
        plane.key = None
        plane.send(plane.heartbeat())
        plane.send(plane.hazard())
        plane.run(1.0)
    assert plane.modes == [] and sum("unsigned" in text for text in plane.texts) == 1
    plane.run(6.0)  # nobody signs any more
    plane.send(plane.hazard())
    plane.run(1.0)
    assert plane.modes == [GUIDED]


def test_a_harmed_signed_heartbeat_shuts_no_link(plane: Plane) -> None:
    plane.key = KEY
    plane.send(plane.heartbeat(), system=255, harm=13)
    plane.key = None
    plane.run(1.1)
    plane.send(plane.hazard())
    plane.run(1.0)
    assert plane.modes == [GUIDED]


def test_the_time_of_a_signature_has_48_bits(goe: ModuleType) -> None:
    plane = Plane(goe, key=KEY, files={"APM/goe.key": KEY}, stamp=(5 << 24) - 3)
    plane.send(plane.hazard())
    plane.run(4.0, status=LEFT)
    plane.pass_by()
    plane.run(1.0)
    assert plane.modes == [GUIDED, AUTO] and plane.stamp > 5 << 24


def test_each_link_of_a_sender_has_its_own_time(goe: ModuleType) -> None:
    plane = Plane(goe, key=KEY, files={"APM/goe.key": KEY})
    plane.run(1.0, status=0)
    plane.link_id, plane.stamp = 1, 1000
    plane.send(plane.hazard())
    plane.run(0.5)
    assert plane.modes == [GUIDED]


def test_many_signed_messages_are_judged_soon(goe: ModuleType) -> None:
    plane = Plane(goe, key=KEY, files={"APM/goe.key": KEY})
    for _ in range(20):
        plane.send(plane.status(0))
    plane.send(plane.hazard())
    plane.run(1.0)
    assert plane.modes == [GUIDED]


@pytest.mark.parametrize("text", [b"", b"short", KEY + b"x", b"g" * 64, KEY.hex()[:-2].encode()])
def test_a_key_file_that_holds_none_shuts_the_script(goe: ModuleType, text: bytes) -> None:
    plane = Plane(goe, files={"APM/goe.key": text})
    for key in (None, bytes(32), KEY):
        plane.key = key
        plane.send(plane.hazard())
        plane.run(1.0, status=LEFT)
    assert plane.modes == [] and any("no key" in text for text in plane.texts)


STEPS = b"""
    local update = ...
    return function()
        local steps = 0
        debug.sethook(function() steps = steps + 100 end, "", 100)
        update()
        debug.sethook()
        return steps
    end"""


@pytest.mark.parametrize("signed", [False, True])
def test_a_call_is_short(goe: ModuleType, signed: bool) -> None:
    """SCR_VM_I_COUNT is 10000 by default: a call that needs more ends the script."""
    plane = Plane(goe, key=KEY, files={"APM/goe.key": KEY}) if signed else Plane(goe)
    for _ in range(20):
        plane.send(plane.hazard())
    count = plane.lua.execute(STEPS, plane.update)
    assert max(count() for _ in range(80)) < 9000
    assert plane.modes == [GUIDED] and not plane.waiting


# -------------------------------------------------------------------------------------------------- where it may lead


def north(metres: float) -> int:
    return ORIGIN[0] + round(metres * METRE)


@pytest.mark.parametrize(
    ("place", "parameters", "why"),
    [
        ({"lat": north(2000), "lon": ORIGIN[1], "down": -35.0}, {}, "too far"),
        ({"lat": north(501), "lon": ORIGIN[1], "down": -35.0}, {}, "too far"),
        ({"lat": -(2**31), "lon": 2**31 - 2, "down": -35.0}, {}, "too far"),
        ({"lat": north(200), "lon": ORIGIN[1], "down": -3.0}, {}, "too low"),
        ({"lat": north(200), "lon": ORIGIN[1], "down": -24.0}, {}, "too far below"),
        ({"lat": north(200), "lon": ORIGIN[1], "down": -190.0}, {}, "too far above"),
        ({"lat": north(200), "lon": ORIGIN[1], "down": 1e30}, {}, None),
        ({"lat": north(200), "lon": ORIGIN[1], "down": -math.inf}, {}, None),
        ({}, {"GOEP_DIST": 200}, "too far"),
        ({}, {"GOEP_DIST": math.nan}, "too far"),
        ({}, {"GOEP_ALT_MIN": 40}, "too low"),
        ({}, {"FENCE_ENABLE": 1, "FENCE_TYPE": 1, "FENCE_ALT_MAX": 36, "FENCE_MARGIN": 2}, "above the fence"),
        ({}, {"FENCE_AUTOENABLE": 3, "FENCE_TYPE": 8, "FENCE_ALT_MIN": 34, "FENCE_MARGIN": 2}, "below the fence"),
        ({}, {"FENCE_ENABLE": 1, "FENCE_TYPE": 2, "FENCE_RADIUS": 300, "WP_LOITER_RAD": -60}, "outside the fence"),
        ({}, {"FENCE_ENABLE": 1, "FENCE_TYPE": 4, "FENCE_TOTAL": 5}, "polygon"),
    ],
)
def test_a_target_out_of_bounds_is_not_flown(
    plane: Plane, place: dict[str, Any], parameters: dict[str, float], why: str | None
) -> None:
    plane.parameters |= parameters
    for _ in range(4):
        plane.send(plane.hazard(**place))
        plane.run(1.0, status=LEFT)
    assert plane.modes == [] and plane.places == []
    assert sum("not flown" in text and why in text for text in plane.texts if why) == (1 if why else 0)


@pytest.mark.parametrize(
    "parameters",
    [
        {"FENCE_ENABLE": 1, "FENCE_TYPE": 15, "FENCE_ALT_MAX": 40, "FENCE_ALT_MIN": 20, "FENCE_RADIUS": 400,
         "FENCE_MARGIN": 2, "WP_LOITER_RAD": 60, "FENCE_TOTAL": 0},
        {"FENCE_ENABLE": 1, "FENCE_TYPE": 4, "FENCE_TOTAL": 5, "GOEP_POLYGON": 1},
        {"FENCE_ENABLE": 0, "FENCE_TYPE": 2, "FENCE_RADIUS": 10},
    ],
)  # fmt: skip
def test_a_target_within_bounds_is_flown(plane: Plane, parameters: dict[str, float]) -> None:
    plane.parameters |= parameters
    plane.send(plane.hazard())
    plane.run(0.2, status=LEFT)
    assert plane.modes == [GUIDED]


@pytest.mark.parametrize("change", ["home_set", "has_position"])
def test_without_a_home_or_a_position_nothing_is_flown(plane: Plane, change: str) -> None:
    setattr(plane, change, False)
    plane.send(plane.hazard())
    plane.run(1.0, status=LEFT)
    assert plane.modes == []


def test_no_order_is_flown_near_the_ground(plane: Plane) -> None:
    plane.own_alt = ORIGIN[2] + 200
    plane.send(plane.hazard(down=-30.0))
    plane.run(1.0, status=LEFT)
    assert plane.modes == []


def test_a_target_that_leaves_the_bounds_leaves_the_aircraft_at_the_one_before(plane: Plane) -> None:
    plane.send(plane.hazard())
    plane.run(0.5, status=LEFT)
    plane.send(plane.hazard(lat=north(3000)))
    plane.run(5.0, status=LEFT)
    assert {place[0] for place in plane.places} == {474000000}
    assert sum("not flown" in text for text in plane.texts) == 1


def test_each_order_that_is_not_flown_is_told(plane: Plane) -> None:
    for _ in range(2):
        plane.send(plane.hazard(lat=north(3000)))
        plane.run(2.0, status=LEFT)
        plane.pass_by()
        plane.run(1.0, status=0)
    assert sum("not flown" in text for text in plane.texts) == 2


def test_an_order_that_nobody_knows_is_none(plane: Plane) -> None:
    plane.send(plane.hazard(action=6))
    plane.run(1.0, status=6)
    assert plane.modes == []
