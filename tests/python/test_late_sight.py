"""Buildings first detected nearby, the base below the image: a larger `filter.range_sd_rel_max` warns sooner."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest

goe = pytest.importorskip("goe", reason="the Python package is not installed (tools/setup.sh)")

ROOT = Path(__file__).resolve().parents[2]
RATE_HZ, FOCAL_PX, WIDE_PX, HIGH_PX = 10.0, 914.0, 1280.0, 720.0
MARGIN_M, CLEARANCE_M, PASS_M, LATE_S = 15.0, 10.0, 30.0, 3.0
BOX_NOISE_REL, BOX_CORRELATION_S, BOX_NOISE_PX, HEIGHT_NOISE_M = 0.07, 1.2, 1.0, 0.5  # the library's defaults
EDGE_POINTS = 40
FLIGHTS = 120
SHARES = (0.25, 0.5, 2.0)  # filter.range_sd_rel_max: the default, and the values of the page


@dataclass(frozen=True)
class Flown:
    images: goe.Images
    violated: np.ndarray  # (K,) margin and clearance, both


def edges_m(width_m: float, depth_m: float, height_m: float, yaw: float) -> np.ndarray:
    """(N, 3) points on the edges of a box about the origin: right, down, ahead."""
    corners = 0.5 * np.array([[-width_m, -depth_m], [width_m, -depth_m], [width_m, depth_m], [-width_m, depth_m]])
    corners = corners @ np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    share = np.linspace(0.0, 1.0, EDGE_POINTS)[:, None]
    lines = []
    for i in range(4):
        along = corners[i] + share * (corners[(i + 1) % 4] - corners[i])
        lines += [np.insert(along, 1, down, axis=1) for down in (0.0, -height_m)]
        lines.append(np.insert(np.repeat(corners[i : i + 1], EDGE_POINTS, axis=0), 1, -height_m * share[:, 0], axis=1))
    return np.vstack(lines)


def distance_m(corners_m: np.ndarray, place_m: np.ndarray) -> float:
    """From a place to the outline of the corners; 0 inside."""
    ahead = np.roll(corners_m, -1, axis=0) - corners_m
    to = place_m - corners_m
    if (ahead[:, 0] * to[:, 1] - ahead[:, 1] * to[:, 0] >= 0.0).all():
        return 0.0
    share = np.clip((to * ahead).sum(axis=1) / (ahead**2).sum(axis=1), 0.0, 1.0)
    return float(np.linalg.norm(to - share[:, None] * ahead, axis=1).min())


def visible_box_px(points_m: np.ndarray) -> np.ndarray | None:
    """Of the part that the image shows; right, down, ahead of the camera."""
    near = points_m[points_m[:, 2] > 1.0]
    pixel = np.array([WIDE_PX, HIGH_PX]) / 2 + FOCAL_PX * near[:, :2] / near[:, 2:]
    inside = pixel[((pixel >= 0.0) & (pixel <= [WIDE_PX, HIGH_PX])).all(axis=1)]
    if len(inside) < 2:
        return None
    box = np.concatenate([inside.min(axis=0), inside.max(axis=0)])
    return box if (box[2:] - box[:2] > 4.0).all() else None


@cache
def flown(seed: int, aside: bool) -> Flown:
    """Level flight north, into the building or past it."""
    rng = np.random.default_rng(seed)
    width_m, depth_m = rng.uniform(12.0, 40.0, 2)
    height_m, yaw = rng.uniform(25.0, 80.0), rng.uniform(0.0, np.pi)
    altitude_m = max(height_m - rng.uniform(3.0, 60.0), 4.0)
    speed_m_s, first_m = rng.uniform(12.0, 20.0), rng.uniform(50.0, 120.0)
    points_m = edges_m(width_m, depth_m, height_m, yaw)
    right_m = PASS_M - points_m[:, 0].min() if aside else rng.uniform(-8.0, 8.0)
    points_m = points_m + np.array([right_m, 0.0, 0.0])
    base_m = points_m[[0, 3 * EDGE_POINTS, 6 * EDGE_POINTS, 9 * EDGE_POINTS]][:, [0, 2]]
    count = int((first_m + 20.0) / speed_m_s * RATE_HZ)
    north_m = -first_m + speed_m_s * np.arange(count) / RATE_HZ
    kept = np.exp(-1.0 / (RATE_HZ * BOX_CORRELATION_S))
    slow, boxes, far_m = rng.standard_normal(4), np.full((count, 4), np.nan), np.zeros(count)
    for k in range(count):
        far_m[k] = distance_m(base_m, np.array([0.0, north_m[k]]))
        box = visible_box_px(points_m + np.array([0.0, altitude_m, -north_m[k]]))
        slow = kept * slow + np.sqrt(1.0 - kept**2) * rng.standard_normal(4)
        if box is not None:
            box = box + BOX_NOISE_REL * slow * np.tile(box[2:] - box[:2], 2) + rng.normal(0.0, BOX_NOISE_PX, 4)
            boxes[k] = np.clip(box, 0.0, [WIDE_PX, HIGH_PX] * 2)
    end = int(np.argmax(far_m <= 0.0)) if (far_m <= 0.0).any() else count
    still = np.zeros(end)
    images = goe.Images(
        time_us=np.arange(1, end + 1) * 100_000,
        position_ned_m=np.column_stack([north_m[:end], still, still - altitude_m]),
        attitude=np.tile([1.0, 0.0, 0.0, 0.0], (end, 1)),
        height_m=altitude_m + rng.normal(0.0, HEIGHT_NOISE_M, end),
        box_px=boxes[:end],
        velocity_ned_m_s=np.tile([speed_m_s, 0.0, 0.0], (end, 1)),
    )
    return Flown(images, (far_m[:end] < MARGIN_M) & (altitude_m - height_m < CLEARANCE_M))


@dataclass(frozen=True)
class Counts:
    unwarned: int  # flights into a building without "act" before margin and clearance are violated
    late: int  # ... with "act" less than LATE_S before
    clear: int  # decisions "clear" while they are
    alerts: int  # passes with "act"


@cache
def counts(range_sd_rel_max: float) -> Counts:
    settings = goe.Settings.for_camera(
        FOCAL_PX, FOCAL_PX, WIDE_PX / 2, HIGH_PX / 2, width_px=WIDE_PX, height_px=HIGH_PX
    )
    settings.filter.range_sd_rel_max = range_sd_rel_max
    rule = goe.Rule(margin_m=MARGIN_M, clearance_m=CLEARANCE_M)
    unwarned = late = clear = alerts = 0
    for seed in range(FLIGHTS):
        into, past = flown(seed, False), flown(seed, True)
        decision = goe.run(settings, into.images, rules=[rule]).decision[:, 0]
        first = int(np.argmax(into.violated))
        acted = np.flatnonzero(decision[:first] == goe.Decision.ACT)
        unwarned += len(acted) == 0
        late += bool(len(acted) > 0 and (first - acted[0]) / RATE_HZ < LATE_S)
        clear += int((decision[into.violated] == goe.Decision.CLEAR).sum())
        alerts += bool((goe.run(settings, past.images, rules=[rule]).decision[:, 0] == goe.Decision.ACT).any())
    return Counts(unwarned, late, clear, alerts)


@pytest.mark.parametrize("share", SHARES)
def test_nothing_that_is_violated_is_clear(share: float) -> None:
    assert all(flown(seed, False).violated.any() for seed in range(FLIGHTS))
    assert counts(share).clear == 0


def test_a_larger_share_warns_sooner_and_more_often() -> None:
    all_counts = [counts(share) for share in SHARES]
    for smaller, larger in zip(all_counts, all_counts[1:]):
        assert larger.unwarned < smaller.unwarned and larger.late < smaller.late and larger.alerts > smaller.alerts


def test_the_page_states_these_counts() -> None:
    text = (ROOT / "lib" / "DESIGN.md").read_text(encoding="utf-8")
    found = re.findall(r"^  \| (0\.25, the default|0\.5|2) \| (\d+) \| (\d+) \| (\d+) \|$", text, re.MULTILINE)
    assert len(found) == len(SHARES)
    for share, (_, *stated) in zip(SHARES, found):
        of = counts(share)
        assert [int(number) for number in stated] == [of.unwarned, of.late, of.alerts]
