"""Boxes that no pixels of the image can be: the companion reports the fault and its remedy."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator

import pytest
from camera import Box, Camera, Image, Line, Obstacle, plain_line
from companion import PROGRAM, is_missing
from flights import Fleet, Flight, MakeFleet, Plan

pytestmark = pytest.mark.skipif(is_missing(), reason=f"{PROGRAM} is not built")

FLIGHT_S = 13.0
FAR = (Obstacle(350.0),)
CAMERA = Camera()
NORMALIZED, EXCHANGED, OUTSIDE, GOOD = "normalized", "left, top, width, height", "outside", "good"
REPORTS = {
    NORMALIZED: ("boxes_normalized", "box in 0..1: send pixels"),
    EXCHANGED: ("boxes_exchanged", "right<left or bottom<top: box is x1 y1 x2 y2"),
    OUTSIDE: ("boxes_outside", "box outside image: check camera.ini"),
}


def with_boxes(change: Callable[[Box], list[float]]) -> Line:
    def line(image: Image, clock: str | None) -> str:
        made = json.loads(plain_line(image, clock))
        for entry, box in zip(made["detections"], image.boxes):
            entry["box"] = change(box)
        return json.dumps(made) + "\n"

    return line


def normalized(box: Box) -> list[float]:
    return [
        box.left / CAMERA.width, box.top / CAMERA.height, box.right / CAMERA.width, box.bottom / CAMERA.height,
    ]  # fmt: skip


PLANS = [
    Plan(NORMALIZED, line=with_boxes(normalized), obstacles=FAR),
    Plan(EXCHANGED, line=with_boxes(lambda b: [b.left, b.top, b.right - b.left, b.bottom - b.top]), obstacles=FAR),
    Plan(
        OUTSIDE,
        line=with_boxes(lambda b: [b.left + CAMERA.width, b.top, b.right + CAMERA.width, b.bottom]),
        obstacles=FAR,
    ),
    Plan(GOOD, obstacles=FAR),
]


@pytest.fixture(scope="module", name="fleet")
def flown(make_fleet: MakeFleet) -> Iterator[Fleet]:
    fleet = make_fleet(PLANS)
    fleet.start()
    fleet.run(FLIGHT_S)
    fleet.stop()
    yield fleet


def texts(flight: Flight) -> list[str]:
    return [message.text for message in flight.of("STATUSTEXT")]


@pytest.mark.parametrize("name", REPORTS)
def test_the_fault_is_reported(fleet: Fleet, name: str) -> None:
    """At once, on the screen and as an event, and again after ten seconds; the summary has the number."""
    flight, (counter, text) = fleet[name], REPORTS[name]
    assert flight.ended and texts(flight).count(f"GOE: {text}") == 2
    events = re.findall(rf"detector, id 1, box (.*): {re.escape(text)}; such boxes so far: (\d+)", flight.ended.err)
    assert len(events) == 2 and events[0][1] == "1" and 95 <= int(events[1][1]) <= 105
    assert flight.ended.count(counter) > 100
    assert sum(flight.ended.count(other) for other, _ in REPORTS.values()) == flight.ended.count(counter)


def test_no_obstacle_comes_of_it(fleet: Fleet) -> None:
    """The status line then explains its count."""
    flight = fleet[NORMALIZED]
    assert not flight.found()
    assert flight.ended and "obstacles 0 located, 1 detected but not located (boxes" in flight.ended.err


def test_good_boxes_have_no_fault(fleet: Fleet) -> None:
    flight = fleet[GOOD]
    assert flight.found() and flight.ended
    assert not any("box" in text for text in texts(flight))
    assert not any(flight.ended.count(counter) for counter, _ in REPORTS.values())
