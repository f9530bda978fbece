"""Senders that the companion accepts: one address, and on a signed link only senders with the key. Simultaneous
flights."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from autopilot import Autopilot
from camera import Camera
from companion import PROGRAM, call, is_missing
from flights import Fleet, MakeFleet, Plan
from links import HOST, UdpServerWire

pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

FLIGHT_S, ATTACK_S = 9.0, 4.0
KEY, OTHER_KEY = bytes(range(32)), bytes(32)
DAY_S = 86400
BOUND, CONNECTED, BOXES = "udpin", "udpout", "boxes of a stranger"
SIGNED, UNSIGNED, FORGED, MIXED, AGAIN = "signed", "unsigned", "another key", "signed and attacked", "clock set back"
LATE = "autopilot without time"
STRANGERS = {BOUND: "udpin", CONNECTED: "udpout"}


def signed(name: str, key: bytes | None, **more: Any) -> Plan:
    """Times of images are ages, because this computer's clock may be wrong."""
    return Plan(name, clock="age", settings={"link": {"key_file": "link.key"}}, autopilot={"key": key, **more})


PLANS = [
    Plan(BOUND),
    Plan(CONNECTED, link="udpout"),
    Plan(BOXES, source=0),
    signed(SIGNED, KEY),
    signed(UNSIGNED, None),
    signed(FORGED, OTHER_KEY),
    signed(MIXED, KEY),
    signed(AGAIN, KEY),
    signed(LATE, KEY, late_s=2.0 * 3600.0),
]


class Attack:
    """From its own address, or over the autopilot's wire without the key."""

    def __init__(self, fleet: Fleet, dialect: Any) -> None:
        self.fleet, self.dialect = fleet, dialect
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.recorded: list[bytes] = []
        pilot = fleet[MIXED].autopilot
        send = pilot.wire.send

        def record(data: bytes) -> None:
            self.recorded.append(data)
            send(data)

        pilot.wire.send = record  # type: ignore[method-assign]
        self.replay = send

    def begin(self) -> None:
        self.fleet.loop.every(0.1, self.strike)

    def forged(self, pilot: Autopilot) -> list[bytes]:
        """Another mode, and a jump."""
        mavlink = self.dialect.MAVLink(None, srcSystem=1, srcComponent=1)
        ms = int(pilot.boot_s() * 1e3)
        return [
            self.dialect.MAVLink_heartbeat_message(1, 12, 0x51, 0, 4, 3).pack(mavlink),
            self.dialect.MAVLink_local_position_ned_message(ms, 900.0, 0.0, 0.0, 0.0, 0.0, 0.0).pack(mavlink),
        ]

    def strike_at_once(self) -> None:
        """After the autopilot's first messages, before the companion has read any."""
        for data in self.forged(self.fleet[BOUND].autopilot):
            self.socket.sendto(data, self.address(BOUND))

    def strike(self) -> None:
        for name in (BOUND, CONNECTED):
            for data in self.forged(self.fleet[name].autopilot):
                self.socket.sendto(data, self.address(name))
        boxes = self.dialect.MAVLink_goe_features_message(
            0, 100000, 9, [-100, -100, 100, 100], 0, 1280, 720, 15, 0, 2, 1, 0, 90
        )
        self.socket.sendto(boxes.pack(self.dialect.MAVLink(None, srcSystem=1, srcComponent=77)), self.address(BOUND))
        for data in [*self.forged(self.fleet[MIXED].autopilot), *self.recorded[20:24]]:
            self.replay(data)

    def address(self, name: str) -> tuple[str, int]:
        """The address on which the companion listens."""
        wire = self.fleet[name].autopilot.wire
        if isinstance(wire, UdpServerWire):
            assert wire.peer
            return wire.peer
        return HOST, int(wire.setting.rsplit(":", 1)[1])

    def close(self) -> None:
        self.socket.close()


def restart_in_the_past(fleet: Fleet) -> None:
    companion = fleet[AGAIN].companion
    companion.stop()
    companion.unix_ahead_us -= DAY_S * 1_000_000
    companion.start()


@pytest.fixture(scope="module", name="fleet")
def flown(make_fleet: MakeFleet, dialect: Any) -> Iterator[Fleet]:
    fleet = make_fleet(PLANS)
    for flight in fleet.flights.values():
        key = flight.companion.folder / "link.key"
        key.write_text(KEY.hex() + "\n", encoding="ascii")
        key.chmod(0o600)
    attack = Attack(fleet, dialect)
    fleet.start()
    fleet.loop.after(0.0, attack.strike_at_once)
    fleet.run(ATTACK_S)
    attack.begin()
    restart_in_the_past(fleet)
    fleet.run(FLIGHT_S - ATTACK_S)
    fleet.stop()
    attack.close()
    yield fleet


@pytest.mark.parametrize("name", [BOUND, CONNECTED, MIXED])
def test_messages_of_strangers_are_ignored(fleet: Fleet, name: str) -> None:
    flight = fleet[name]
    flight.assert_ended_well()
    assert flight.ended and flight.ended.count("jumps") == 0
    assert len(flight.found(since_s=flight.loop.now_s - 3.0)) > 5


def test_messages_before_the_system_refused_strangers_are_counted(fleet: Fleet) -> None:
    assert fleet[BOUND].ended and fleet[BOUND].ended.count("strangers") == 2


def test_boxes_of_strangers_are_none(fleet: Fleet) -> None:
    """The number of images is that of the real detector."""
    assert fleet[BOUND].ended and fleet[BOXES].ended
    assert abs(fleet[BOUND].ended.count("images") - fleet[BOXES].ended.count("images")) <= 2
    assert fleet[BOUND].ended.count("images_unread") == 0


@pytest.mark.parametrize("name", [SIGNED, MIXED, AGAIN, LATE])
def test_a_signed_link_works_in_both_directions(fleet: Fleet, name: str) -> None:
    """The stand-in refuses unsigned messages and messages whose time goes back."""
    flight = fleet[name]
    flight.assert_ended_well()
    since = [heard for heard in flight.autopilot.heard if heard.time_s > flight.loop.now_s - 3.0]
    assert {"HEARTBEAT", "GOE_STATUS", "GOE_OBSTACLE", "TIMESYNC"} <= {heard.message.get_type() for heard in since}
    assert flight.autopilot.refused_signatures == 0


def test_signed_messages_are_counted_as_good(fleet: Fleet) -> None:
    ended = fleet[SIGNED].ended
    assert ended and ended.count("messages_unsigned") == 0 and ended.count("messages_forged") == 0


@pytest.mark.parametrize("name, row", [(UNSIGNED, "messages_unsigned"), (FORGED, "messages_forged")])
def test_who_has_no_key_is_not_heard(fleet: Fleet, name: str, row: str) -> None:
    flight = fleet[name]
    flight.assert_ended_well()
    assert flight.ended and flight.ended.count(row) > 500 and flight.ended.count("messages") == 0
    assert flight.ended.count("attitudes") == 0 and flight.autopilot.heard == []


def test_refused_messages_are_counted_and_reported(fleet: Fleet) -> None:
    ended = fleet[MIXED].ended
    assert ended and ended.count("messages_unsigned") >= 80
    assert ended.count("messages_forged") >= 80  # replayed, with times in the past
    assert "without a signature" in ended.err


# ------------------------------------------------------------------------------------------------------- configuration


@pytest.fixture(name="folder")
def configured_folder(tmp_path: Path) -> Path:
    (tmp_path / "camera.ini").write_text(Camera().ini(), encoding="utf-8")
    (tmp_path / "companion.ini").write_text("[link]\nkey_file = link.key\n", encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("text", [None, "", "00" * 31, "00" * 33, "zz" * 32, "00" * 32 + " 00"])
def test_a_key_that_is_none_is_an_error(folder: Path, text: str | None) -> None:
    if text is not None:
        (folder / "link.key").write_text(text, encoding="ascii")
    done = call("--check", folder / "companion.ini")
    assert done.returncode == 2 and done.stdout == "" and "link.key" in done.stderr


def test_the_key_is_not_printed(folder: Path) -> None:
    (folder / "link.key").write_text(KEY.hex().upper(), encoding="ascii")
    os.chmod(folder / "link.key", 0o600)
    done = call("--check", folder / "companion.ini")
    assert done.returncode == 0 and KEY.hex() not in done.stdout.lower() and "link.key" in done.stdout


def test_it_listens_to_this_computer_alone(folder: Path) -> None:
    """Unless the file or the call configures another address."""
    (folder / "companion.ini").write_text("", encoding="utf-8")
    assert "link.autopilot = udpin:127.0.0.1:" in call("--check", folder / "companion.ini").stdout
    wide = call("--check", "--link", "udpin:0.0.0.0:14540", folder / "companion.ini")
    assert wide.returncode == 0 and "link.autopilot = udpin:0.0.0.0:14540" in wide.stdout
    assert "0.0.0.0" in call("--help").stdout
    assert call("--check", "--link", "pigeon:1", folder / "companion.ini").returncode == 2
