"""Bad links and bad senders: the companion keeps running, finds the mast, does not grow, and reports its losses."""

from __future__ import annotations

import itertools
import random
import re
import socket
import statistics
from collections.abc import Iterator
from typing import Any

import pytest
from autopilot import ARDUPILOT
from companion import PROGRAM, SANITIZED_KIB, is_missing, replay
from flights import Fleet, Flight, MakeFleet, Plan
from hostile import STRANGER_ID, bad_lines, crowd, escapes, frame_faults, in_turn, odd_lines, poison, stranger
from links import HOST, Faults

pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

FLIGHT_S = 12.8
BEGIN_S = 1.5  # the autopilot is known by then, because its messages came first
GROWTH_KIB = 512

LOSSY, SHUFFLED, DOUBLED, BAD = "lossy", "shuffled", "doubled", "lossy, shuffled and doubled"
LINKS = {
    LOSSY: {"lost": 0.2},
    SHUFFLED: {"delay_s": 0.03},
    DOUBLED: {"doubled": 0.3},
    BAD: {"lost": 0.2, "doubled": 0.2, "delay_s": 0.03},
}
FRAMES, SERIAL_FRAMES, STRANGER, POISON = "frames", "frames on a serial line", "stranger", "poison"
LINES, PIPED, CROWD, HUGE = "lines", "piped lines", "crowd", "line without end"
ESCAPES = "escapes"
UNDISTURBED = "undisturbed"
HOSTILE = [FRAMES, SERIAL_FRAMES, STRANGER, POISON, LINES, PIPED, HUGE, ESCAPES]
FOUND = [*LINKS, *HOSTILE]


def plans() -> list[Plan]:
    bad_links = [
        Plan(name, faults=Faults(**reported), detector_faults=Faults(**reported), recorded=True)
        for name, reported in LINKS.items()
    ]
    return [
        *bad_links,
        Plan(FRAMES),
        Plan(SERIAL_FRAMES, link="serial"),
        Plan(STRANGER, autopilot={"make": ARDUPILOT}),
        Plan(POISON),
        Plan(LINES),
        Plan(PIPED, source="stdin"),
        Plan(HUGE, source="stdin"),
        Plan(ESCAPES),
        Plan(CROWD, recorded=True, settings={"record": {"size_max_mb": 1}}),
        Plan(UNDISTURBED),
    ]


class Attack:
    """All data that are sent in addition to those of autopilot and detector."""

    def __init__(self, fleet: Fleet, dialect: Any) -> None:
        self.fleet, self.dialect, self.dice = fleet, dialect, random.Random(3)
        self.other = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)  # another sender to the same port

    def begin(self) -> None:
        every, dice = self.fleet.loop.every, self.dice
        for name in (FRAMES, SERIAL_FRAMES):
            faults = frame_faults(self.dialect, random.Random(4))
            every(0.02, lambda name=name, faults=faults: self.fleet[name].autopilot.wire.send(next(faults)))
        elsewhere = frame_faults(self.dialect, random.Random(6))
        every(0.02, lambda: self.from_elsewhere(FRAMES, next(elsewhere)))
        pilot, sender = (
            self.fleet[STRANGER].autopilot,
            self.dialect.MAVLink(None, srcSystem=STRANGER_ID, srcComponent=1),
        )
        sender.seq = 77
        every(0.01, in_turn(pilot, lambda ms: stranger(self.dialect, dice, ms), sender))
        every(0.05, lambda: self.from_elsewhere(STRANGER, dice.choice(stranger(self.dialect, dice, 5000)).pack(sender)))
        pilot = self.fleet[POISON].autopilot
        every(0.02, in_turn(pilot, lambda ms: poison(self.dialect, ms), pilot.mavlink))
        self.begin_lines()

    def begin_lines(self) -> None:
        loop, dice = self.fleet.loop, self.dice
        for name, end in ((LINES, b""), (PIPED, b"\n")):
            lines = itertools.cycle([*bad_lines(), *odd_lines(), crowd(dice, 500, 0.1)])
            loop.every(0.02, lambda name=name, end=end, lines=lines: self.fleet[name].put(next(lines) + end))
        loop.every(0.1, lambda: self.fleet[CROWD].put(crowd(dice, 300, 0.9)))
        steering = itertools.cycle(escapes())
        loop.every(1.1, lambda: self.fleet[ESCAPES].put(next(steering)))
        for at_s in (0.5, 4.0):
            loop.after(at_s, lambda: self.fleet[HUGE].put(b"[" + b"1, " * 3_300_000 + b"\n"))

    def from_elsewhere(self, name: str, data: bytes) -> None:
        self.other.sendto(data, (HOST, int(self.fleet[name].autopilot.wire.setting.rsplit(":", 1)[1])))

    def close(self) -> None:
        self.other.close()


@pytest.fixture(scope="module", name="sizes")
def resident_sizes() -> dict[str, tuple[int, int]]:
    """KiB of each companion, in the middle and at the end."""
    return {}


@pytest.fixture(scope="module", name="fleet")
def flown(make_fleet: MakeFleet, dialect: Any, sizes: dict[str, tuple[int, int]]) -> Iterator[Fleet]:
    fleet = make_fleet(plans())
    attack = Attack(fleet, dialect)
    fleet.start()
    fleet.run(BEGIN_S)
    attack.begin()
    fleet.run(0.5 * (FLIGHT_S - BEGIN_S))
    before = {name: flight.companion.rss_kib() for name, flight in fleet.flights.items()}
    fleet.run(0.5 * (FLIGHT_S - BEGIN_S))
    sizes.update({name: (before[name], flight.companion.rss_kib()) for name, flight in fleet.flights.items()})
    fleet.stop()
    attack.close()
    yield fleet


def counted(flight: Flight, name: str) -> int:
    assert flight.ended
    return flight.ended.count(name)


@pytest.mark.parametrize("name", FOUND)
def test_the_mast_is_found(fleet: Fleet, name: str) -> None:
    fleet[name].assert_found()


@pytest.mark.parametrize("name", [*FOUND, CROWD])
def test_it_goes_on_until_it_is_interrupted(fleet: Fleet, name: str) -> None:
    fleet[name].assert_ended_well()


@pytest.mark.parametrize("name", [*FOUND, CROWD])
def test_it_does_not_grow(fleet: Fleet, sizes: dict[str, tuple[int, int]], name: str) -> None:
    before, after = sizes[name]
    if before > SANITIZED_KIB:
        pytest.skip("a sanitizer keeps freed memory")
    assert before > 0, "it has ended"
    assert 0 < after <= before + GROWTH_KIB


@pytest.mark.parametrize("name", [*LINKS, *HOSTILE, CROWD])
def test_the_status_goes_on(fleet: Fleet, name: str) -> None:
    lost = 0.36 if "lossy" in name else 0.0
    times = [heard.time_s for heard in fleet[name].autopilot.heard_of("GOE_STATUS")]
    assert len(times) >= (FLIGHT_S - 2.5) * (1.0 - lost) - 1.0
    assert not fleet[name].statuses()[-1].alive & ~7
    assert fleet[name].statuses()[-1].alive == 7


# --------------------------------------------------------------------------------------------------- what it says of it


@pytest.mark.parametrize("name", [LOSSY, BAD])
def test_losses_are_reported(fleet: Fleet, name: str) -> None:
    """About as many as were lost, by the sequence numbers of the autopilot's messages."""
    wire = fleet[name].autopilot.wire
    assert wire.dropped > 100
    assert counted(fleet[name], "messages_lost") == pytest.approx(wire.dropped, rel=0.2, abs=30)


@pytest.mark.parametrize("name", [SHUFFLED, DOUBLED, UNDISTURBED])
def test_messages_out_of_order_are_no_losses(fleet: Fleet, name: str) -> None:
    """A late or doubled message does not count as a gap of 255."""
    flight = fleet[name]
    assert counted(flight, "messages_lost") <= 0.05 * flight.autopilot.wire.sent


@pytest.mark.parametrize("name", [STRANGER, FRAMES])
def test_strangers_are_not_counted_as_losses(fleet: Fleet, name: str) -> None:
    """They have their own sequence numbers."""
    assert counted(fleet[name], "messages_lost") <= 0.05 * fleet[name].autopilot.wire.sent


@pytest.mark.parametrize("name", [LINES, PIPED, HUGE])
def test_bad_lines_are_reported_with_their_number(fleet: Fleet, name: str) -> None:
    ended = fleet[name].ended
    assert ended and re.search(r"line \d+", ended.said), ended


def test_bad_lines_are_quoted_harmlessly(fleet: Fleet) -> None:
    """Text of a stranger does not control the operator's terminal."""
    ended = fleet[ESCAPES].ended
    assert ended and re.search(r"line \d+", ended.said)
    strange = {character for character in ended.said if not character.isprintable() and character != "\n"}
    assert strange == set()


@pytest.mark.parametrize("name", [LINES, PIPED])
def test_bad_lines_are_counted(fleet: Fleet, name: str) -> None:
    """At least those that are certainly malformed."""
    rounds = int((FLIGHT_S - BEGIN_S) / 0.02 / (len(bad_lines()) + len(odd_lines()) + 1))
    assert 0.8 * rounds * len(bad_lines()) <= counted(fleet[name], "images_unread") <= 800


def test_a_line_without_end_is_one_line(fleet: Fleet) -> None:
    """Two were sent, and no other malformed line."""
    assert counted(fleet[HUGE], "images_unread") == 2


def test_bad_frames_are_counted(fleet: Fleet) -> None:
    for name in (FRAMES, SERIAL_FRAMES):
        assert counted(fleet[name], "messages_garbage") > 50


@pytest.mark.parametrize("name", [LINES, PIPED, FRAMES, POISON, STRANGER])
def test_the_amount_of_output_is_limited(fleet: Fleet, name: str) -> None:
    """Hundreds of faults do not fill the disk: less than ten lines a second."""
    ended = fleet[name].ended
    assert ended and ended.said.count("\n") < 10 * FLIGHT_S + 60, ended.said[-2000:]


def test_poison_is_counted(fleet: Fleet) -> None:
    """The messages end no track and move none."""
    last = fleet[POISON].statuses()[-1]
    assert last.refused > 20
    assert (last.lost, last.resets) == (0, 0)
    assert counted(fleet[POISON], "samples_bad") > 50 and counted(fleet[POISON], "jumps") == 0


def test_a_stranger_changes_nothing(fleet: Fleet) -> None:
    """Pose, clock, origin, system and the address of answers stay as they are."""
    flight = fleet[STRANGER]
    last = flight.statuses()[-1]
    assert (last.lost, last.resets) == (0, 0)
    assert {heard.message.get_srcSystem() for heard in flight.autopilot.heard} == {1}
    reported = [status.delay_mean for status in flight.statuses()[3:]]
    assert statistics.median(reported) == pytest.approx(1e3 * statistics.median(flight.detector.delays), abs=15.0)


@pytest.mark.parametrize("name", [FRAMES, STRANGER])
def test_answers_go_to_the_autopilot(fleet: Fleet, name: str) -> None:
    """Also while another address sends to the same port."""
    assert len(fleet[name].of("HEARTBEAT")) >= FLIGHT_S - 2.5


def test_weak_detections_in_a_crowd_are_counted(fleet: Fleet) -> None:
    assert fleet[LINES].statuses()[-1].weak > 100


@pytest.mark.parametrize("name", [LOSSY, BAD])
def test_lost_images_lose_nothing_else(fleet: Fleet, name: str) -> None:
    assert fleet[name].statuses()[-1].lost == 0


@pytest.mark.parametrize("name", LINKS)
def test_the_log_of_a_bad_link_is_replayed(fleet: Fleet, name: str) -> None:
    """Doubled images and images out of order are valid input."""
    assert any(row["status"] == "ok" for row in replay(fleet[name].log))


def test_a_log_ends_at_its_largest_size(fleet: Fleet) -> None:
    """The end is reported, and the log is complete: its last line is whole."""
    flight = fleet[CROWD]
    text = (flight.log / "frames.csv").read_text(encoding="utf-8")
    assert 0.9e6 < len(text) < 1.1e6 and text.endswith("\n")
    assert flight.ended and re.search(r"\blog\b", flight.ended.err)
