"""What goe shows when a caller makes a mistake: the table of lib/DESIGN.md, each row flown toward a static mast."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

goe = pytest.importorskip("goe", reason="the Python package is not installed (tools/setup.sh)")

ROOT = Path(__file__).resolve().parents[2]
RATE_HZ, SPEED_M_S, CLIMB_M_S, IMAGES = 10.0, 15.0, 0.5, 150
MAST_NE_M, MAST_WIDTH_M, MAST_HEIGHT_M = np.array([250.0, 60.0]), 8.0, 40.0
FOCAL_PX, SIZE_PX = 914.0, 1280.0
MOUNT_PITCH_DEG = -10.0
BOX_NOISE_REL, BOX_CORRELATION_S, BOX_NOISE_PX, HEIGHT_NOISE_M = 0.07, 1.2, 1.0, 0.3
AXES = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # camera (right, down, ahead) -> mounted (FRD)
SEEDS = range(4)
Mistake = Callable[["Flown"], "Flown"]


@dataclass(frozen=True)
class Flown:
    settings: goe.Settings
    images: goe.Images


def boxes_px(place_m: np.ndarray, attitude: Rotation, rng: np.random.Generator) -> np.ndarray:
    """Boxes of the mast as a detector draws them: the size's error fades over a second."""
    angle = np.linspace(0.0, 2.0 * np.pi, 48)
    rim_m = MAST_NE_M + 0.5 * MAST_WIDTH_M * np.column_stack([np.cos(angle), np.sin(angle)])
    points_m = np.vstack([np.column_stack([rim_m, np.full(len(rim_m), down)]) for down in (0.0, -MAST_HEIGHT_M)])
    mount = Rotation.from_euler("y", MOUNT_PITCH_DEG, degrees=True)
    kept, slow, boxes = np.exp(-1.0 / (RATE_HZ * BOX_CORRELATION_S)), rng.normal(0.0, BOX_NOISE_REL, 4), []
    for k in range(IMAGES):
        seen = (attitude[k] * mount).inv().apply(points_m - place_m[k]) @ AXES
        pixel = 0.5 * SIZE_PX + FOCAL_PX * seen[:, :2] / seen[:, 2:]
        box = np.concatenate([pixel.min(axis=0), pixel.max(axis=0)])
        slow = kept * slow + np.sqrt(1.0 - kept**2) * rng.normal(0.0, BOX_NOISE_REL, 4)
        boxes.append(box + slow * np.tile(box[2:] - box[:2], 2) + rng.normal(0.0, BOX_NOISE_PX, 4))
    return np.clip(np.array(boxes), 0.0, SIZE_PX)


@cache
def right(seed: int) -> Flown:
    """A flight without a mistake, 3 m past the mast's middle, in a shallow climb, swaying."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(IMAGES) / RATE_HZ
    course = np.arctan2(MAST_NE_M[1] - 3.0, MAST_NE_M[0])
    velocity_m_s = np.array([SPEED_M_S * np.cos(course), SPEED_M_S * np.sin(course), -CLIMB_M_S])
    place_m = np.array([0.0, 0.0, -25.0]) + time_s[:, None] * velocity_m_s
    sway = [np.radians(of) * np.sin(2.0 * np.pi * time_s / period_s) for of, period_s in ((2, 9), (1, 5), (4, 7))]
    attitude = Rotation.from_euler("ZYX", np.column_stack([course + sway[0], np.radians(2.0) + sway[1], sway[2]]))
    settings = goe.Settings.for_camera(FOCAL_PX, FOCAL_PX, 640.0, 640.0, width_px=SIZE_PX, height_px=SIZE_PX)
    settings.camera.mount_pitch_deg = MOUNT_PITCH_DEG
    images = goe.Images(
        time_us=np.rint(1e6 * time_s).astype(np.int64),
        position_ned_m=place_m,
        attitude=attitude.as_quat()[:, [3, 0, 1, 2]],
        height_m=-place_m[:, 2] + rng.normal(0.0, HEIGHT_NOISE_M, IMAGES),
        box_px=boxes_px(place_m, attitude, rng),
        velocity_ned_m_s=np.tile(velocity_m_s, (IMAGES, 1)),
    )
    return Flown(settings, images)


def changed(**columns: Callable[[goe.Images], np.ndarray]) -> Mistake:
    """Columns of the images replaced."""

    def make(flown: Flown) -> Flown:
        return replace(flown, images=replace(flown.images, **{name: of(flown.images) for name, of in columns.items()}))

    return make


def mounted_wrong(flown: Flown) -> Flown:
    settings = goe.Settings.for_camera(FOCAL_PX, FOCAL_PX, 640.0, 640.0, width_px=SIZE_PX, height_px=SIZE_PX)
    settings.camera.mount_pitch_deg = -MOUNT_PITCH_DEG
    return replace(flown, settings=settings)


def held(column: str, k: int = 0) -> Callable[[goe.Images], np.ndarray]:
    return lambda images: np.repeat(getattr(images, column)[k : k + 1], IMAGES, axis=0)


ALIVE = np.arange(IMAGES) < 50  # while the camera works
MOTION = ("position_ned_m", "attitude", "height_m", "box_px")
MISTAKES: dict[str, Mistake] = {
    "quaternion as x, y, z, w": changed(attitude=lambda images: images.attitude[:, [1, 2, 3, 0]]),
    "quaternion inverted": changed(attitude=lambda images: images.attitude * [1.0, -1.0, -1.0, -1.0]),
    "position as east, north, up": changed(position_ned_m=lambda i: i.position_ned_m[:, [1, 0, 2]] * [1.0, 1.0, -1.0]),
    "down position with up as positive": changed(position_ned_m=lambda i: i.position_ned_m * [1.0, 1.0, -1.0]),
    "mounting pitch with the wrong sign": mounted_wrong,
    "time in milliseconds": changed(time_us=lambda images: images.time_us // 1000),
    "time in seconds": changed(time_us=lambda images: images.time_us // 1_000_000),
    "no height": changed(height_m=lambda images: 0.0 * images.height_m),
    "box as left, top, width, height": changed(
        box_px=lambda i: np.column_stack([i.box_px[:, :2], i.box_px[:, 2:] - i.box_px[:, :2]])
    ),
    "box in 0 to 1": changed(box_px=lambda images: images.box_px / SIZE_PX),
    "velocity of the intent never set": changed(velocity_ned_m_s=lambda images: 0.0 * images.velocity_ned_m_s),
    "pose and box frozen, time running": changed(**{column: held(column) for column in MOTION}),
    "box frozen, the pose moves": changed(box_px=held("box_px", 20)),
    "camera dead, empty images passed": changed(box_px=lambda i: np.where(ALIVE[:, None], i.box_px, np.nan)),
}


@dataclass(frozen=True)
class Shown:
    """What a track shows: statuses and decisions by name, and when a suspect estimate first came, s."""

    status: list[str]
    decision: list[str]
    reasons: set[str]
    suspect_s: float


def fly(flown: Flown) -> Shown:
    track = goe.run(flown.settings, flown.images, rules=[goe.Rule(margin_m=15, clearance_m=10)])
    suspect = np.asarray(track.estimates["suspect"], dtype=bool)
    reasons = {goe.Reason(int(reason)).name for reason in track.estimates["reason"] if reason}
    return Shown(
        [goe.Status(int(status)).name for status in track.status],
        [goe.Decision(int(decision)).name for decision in track.decision[:, 0]],
        reasons,
        float(np.argmax(suspect)) / RATE_HZ if suspect.any() else float("inf"),
    )


@cache
def shown(mistake: str, seed: int) -> Shown:
    return fly(MISTAKES[mistake](right(seed)))


def rows() -> list[str]:
    """Mistakes of the page's table."""
    text = (ROOT / "lib" / "DESIGN.md").read_text(encoding="utf-8").split("| mistake | what goe shows |")[1]
    return re.findall(r"^\| ([^|]+) \|", text.split("\n\n")[0], re.MULTILINE)


def test_the_page_has_these_mistakes() -> None:
    assert rows() == list(MISTAKES)


@pytest.mark.parametrize("seed", SEEDS)
def test_without_a_mistake_the_warning_comes_and_nothing_is_suspect(seed: int) -> None:
    flown = fly(right(seed))
    assert not flown.reasons and "CLEAR" not in flown.decision and flown.decision[60:] == ["ACT"] * (IMAGES - 60)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("mistake", "latest_s"),
    [
        ("quaternion as x, y, z, w", 6.0),
        ("quaternion inverted", 4.0),
        ("position as east, north, up", 10.0),
        ("mounting pitch with the wrong sign", 4.0),
        ("box frozen, the pose moves", 4.0),
    ],
)
def test_a_mistake_that_looks_like_motion(mistake: str, latest_s: float, seed: int) -> None:
    flown = shown(mistake, seed)
    assert "MOVES" in flown.reasons and flown.suspect_s < latest_s


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("mistake", ["mounting pitch with the wrong sign", "time in milliseconds", "time in seconds"])
def test_a_mistake_that_gives_no_estimate(mistake: str, seed: int) -> None:
    flown = shown(mistake, seed)
    assert set(flown.status) <= {"CONVERGING", "BAD_TIME"} and set(flown.decision) == {"UNKNOWN"}
    assert ("BAD_TIME" in flown.status) == (mistake == "time in seconds")


@pytest.mark.parametrize("seed", SEEDS)
def test_a_mistake_that_each_image_reports(seed: int) -> None:
    assert set(shown("no height", seed).status) <= {"NO_HEIGHT", "PARTIAL"}
    assert set(shown("box as left, top, width, height", seed).status) == {"SWAPPED"}
    assert set(shown("box in 0 to 1", seed).status) == {"BOX_INCOMPLETE"}


@pytest.mark.parametrize("seed", SEEDS)
def test_a_mistake_that_nothing_shows(seed: int) -> None:
    assert not shown("down position with up as positive", seed).reasons
    never = shown("velocity of the intent never set", seed)
    assert not never.reasons and never.decision[-1] == "CLEAR" and "ACT" not in never.decision
    frozen = shown("pose and box frozen, time running", seed)
    assert not frozen.reasons and set(frozen.status[10:]) == {"OK"} and "ACT" not in frozen.decision
    dead = shown("camera dead, empty images passed", seed)
    assert set(dead.status[50:]) == {"NO_DETECTION"} and set(dead.decision[50:]) == {"ACT"}
