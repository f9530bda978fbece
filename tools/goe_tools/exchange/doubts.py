"""Compares signals of an autopilot's log with each other: position and velocity, attitude and rates, height and
distance sensor. It also checks the detector's boxes.

Nothing is refused or corrected: a doubt names the numbers and likely mistakes."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from ..flights.rotations import multiply
from ..logs.hints import hints_of
from ..logs.obslog import Camera, Frame
from .recording import Jump, Poses, Recording, Series, conjugate, slerp, turned_by, within
from .resets import LONGEST_S, unexplained_m

SPAN_S = 1.0  # of one comparison of position and velocity; the limits are those of the flight layer (port/flight)
OFF_M, OFF_DOWN_M, OFF_SHARE = 4.0, 3.0, 0.3  # level, down, and as a share of the way
FITS = 0.15  # a mistake explains the motion if it leaves this share of it
FOOT_M = 0.3048
UNITS = {
    "feet": FOOT_M, "centimeters": 0.01, "millimeters": 0.001, "knots": 0.514444, "kilometers per hour": 1.0 / 3.6,
}  # fmt: skip
TURN_SPAN_S, TURN_SPANS = 0.5, 400  # of one comparison of attitude and rates, and about how many
TURN_LEAST_DEG, TURN_OFF_DEG, TURN_LEAST = 3.0, 1.5, 5  # turns to compare, their difference, and least number
TURN_RATE_HZ = 20.0  # of the rates; slower ones do not give the turn
REAL_LAST = [3, 0, 1, 2]  # columns of a quaternion in the order x, y, z, w
HEIGHT_OFF_M, HEIGHT_OFF_SHARE = 10.0, 0.5  # more than both: no hill, but another unit or origin
HEIGHT_LEAST_M = 2.0  # on the ground nothing is compared
HEIGHT_SAMPLES = 10
MOST = 0.8  # of the samples
HINT_RATE_HZ = 5.0
BOXES_LEAST, ODD_BOXES = 5, 0.2  # boxes, and share of them from which they are remarked on
SHARES_MAX, BEYOND = 1.5, 0.05  # largest side of a box in shares of the image; beyond the image, share of its size
FOOT_TOLERANCE = 0.1


def _ways(position: Series, velocity: Series, jumps: Sequence[Jump]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """For each second without a gap or a jump: its start (K,), and the ways (K, 3) by positions and by velocity,
    m."""
    time_s = position.time_s
    off = unexplained_m(position, velocity)
    moved = np.diff(position.value, axis=0)
    place = position.value - position.value[0]
    flown = np.concatenate([np.zeros((1, 3)), np.cumsum(moved - off, 0)])
    end = np.searchsorted(time_s, time_s + SPAN_S - 1e-6)
    start = np.flatnonzero(end < len(time_s))
    end = end[start]
    broken = np.diff(time_s) > LONGEST_S
    at = np.searchsorted(time_s, [jump.time_s for jump in jumps])
    broken[np.clip(at - 1, 0, len(broken) - 1)] = True
    breaks = np.concatenate([[0], np.cumsum(broken)])
    whole = breaks[end] == breaks[start]
    start, end = start[whole], end[whole]
    return time_s[start], place[end] - place[start], flown[end] - flown[start]


def _contradicted(moved: np.ndarray, flown: np.ndarray) -> np.ndarray:
    """(K,) whether the ways differ by more than the errors of a filter."""
    level = [np.linalg.norm(way[:, :2], axis=1) for way in (moved, flown)]
    apart = np.linalg.norm((moved - flown)[:, :2], axis=1) > OFF_M + OFF_SHARE * np.maximum(*level)
    down = [np.abs(way[:, 2]) for way in (moved, flown)]
    return apart | (np.abs(moved - flown)[:, 2] > OFF_DOWN_M + OFF_SHARE * np.maximum(*down))


def _mistakes() -> dict[str, np.ndarray]:
    """Matrices (3, 3) that make a wrong velocity the right one, simple ones first."""
    one, swap = np.eye(3), np.eye(3)[[1, 0, 2]]
    result = {}
    for name, unit in UNITS.items():
        result[f"is the velocity in {name}?"] = unit * one
        result[f"is the level velocity in {name}?"] = np.diag([unit, unit, 1.0])
        if "kilo" not in name and name != "knots":
            result[f"is the position in {name}?"] = one / unit
            result[f"is z in {name}?"] = np.diag([1.0, 1.0, 1.0 / unit])
    result["are north and east exchanged in one of them?"] = swap
    result["are they on different axes: east, north, up in one of them?"] = swap * [1.0, 1.0, -1.0]
    for signs in itertools.product((1.0, -1.0), repeat=3):
        wrong = [word for word, sign in zip(("north", "east", "down"), signs) if sign < 0.0]
        if wrong:
            result[f"is the sign of {' and '.join(wrong)} wrong in one of them?"] = np.diag(signs)
    return result


def _cause(moved: np.ndarray, flown: np.ndarray) -> str:
    """The simplest mistake that explains the contradiction about as well as any."""
    size = float(np.sqrt(np.mean(moved**2)))
    if float(np.sqrt(np.mean(flown**2))) < FITS * size:
        return "is the velocity 0, or in another unit?"
    left = {words: float(np.sqrt(np.mean((moved - flown @ by.T) ** 2))) for words, by in _mistakes().items()}
    enough = max(2.0 * min(left.values()), 0.02 * size)
    if enough > FITS * size:
        return "are unit, axes or sign of one of them wrong?"
    return next(words for words, rest in left.items() if rest <= enough)


def doubt_of_velocity(recording: Recording) -> str:
    """The first contradiction between position and velocity, and a likely mistake. Empty: none."""
    position, velocity = recording.position, recording.velocity
    if velocity is None:
        return ""
    start_s, moved, flown = _ways(position, velocity, recording.jumps)
    wrong = _contradicted(moved, flown)
    if not wrong.any():
        return ""
    first = int(np.argmax(wrong))
    ways = [", ".join(f"{x:+.1f}" for x in way[first]) for way in (moved, flown)]
    cause = _cause(moved[wrong], flown[wrong]) if wrong.mean() > 0.5 else "a jump or a slip of the position?"
    return (
        f"from {start_s[first]:.3f} s the position moves by {ways[0]} m (north, east, down) in {SPAN_S:g} s, and "
        f"{velocity.name} gives {ways[1]} m; such differences in {100.0 * wrong.mean():.3g} % of the time: {cause}"
    )


def _apart_deg(turns: np.ndarray, others: np.ndarray) -> np.ndarray:
    """(K,) angles between rotations (K, 4)."""
    left = multiply(conjugate(turns), others)
    return np.degrees(2.0 * np.arctan2(np.linalg.norm(left[:, 1:], axis=1), np.abs(left[:, 0])))


def _turns(recording: Recording, gyro: Series) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """For spans without a gap or a jump: start (K,), attitudes at both ends and turn by the rates, each (K, 4)."""
    attitude = recording.attitude
    start = max(attitude.time_s[0], gyro.time_s[0])
    starts = np.arange(start, min(attitude.time_s[-1], gyro.time_s[-1]) - TURN_SPAN_S, TURN_SPAN_S)
    starts = starts[:: max(len(starts) // TURN_SPANS, 1)]
    good = np.ones(len(starts), bool)
    for series in (attitude, gyro):
        for share in (0.0, 0.5, 1.0):
            good &= within(series, starts + share * TURN_SPAN_S, LONGEST_S)
    for jump in recording.jumps:
        good &= ~((starts < jump.time_s) & (jump.time_s <= starts + TURN_SPAN_S))
    starts = starts[good]
    by_rates = [turned_by(gyro, one, one + TURN_SPAN_S) for one in starts]
    first, last = slerp(attitude, starts), slerp(attitude, starts + TURN_SPAN_S)
    return starts, first, last, np.array(by_rates).reshape(-1, 4)


def doubt_of_attitude(recording: Recording) -> str:
    """A contradiction between most turns of the attitude and the rates, and a likely mistake. Empty: none."""
    gyro = recording.gyro
    if gyro is None or gyro.rate_hz < TURN_RATE_HZ:
        return ""
    start_s, first, last, by_rates = _turns(recording, gyro)
    if len(start_s) == 0:
        return ""
    turn = multiply(conjugate(first), last)
    none = np.tile([1.0, 0.0, 0.0, 0.0], (len(turn), 1))
    angles = [_apart_deg(turns, none) for turns in (turn, by_rates)]
    apart = _apart_deg(turn, by_rates)
    moves = np.maximum(*angles) > TURN_LEAST_DEG
    wrong = moves & (apart > TURN_OFF_DEG + OFF_SHARE * np.maximum(*angles))
    if moves.sum() < TURN_LEAST or wrong.sum() <= 0.5 * moves.sum():
        return ""
    swapped = multiply(conjugate(first[:, REAL_LAST]), last[:, REAL_LAST])
    inverse = multiply(first, conjugate(last))
    if np.median(angles[0][wrong]) < FITS * np.median(angles[1][wrong]):
        cause = "is the attitude frozen, or are the rates in degrees?"
    elif np.median(_apart_deg(inverse, by_rates)[wrong]) < 0.5 * np.median(apart[wrong]):
        cause = "is it the inverse quaternion?"
    elif np.median(_apart_deg(swapped, by_rates)[wrong]) < 0.5 * np.median(apart[wrong]):
        cause = "is the quaternion in the order x, y, z, w?"
    else:
        cause = "another order or inverse of the quaternion, other axes, or rates in degrees?"
    k = int(np.argmax(wrong))
    return (
        f"from {start_s[k]:.3f} s {recording.attitude.name} turns by {angles[0][k]:.1f} degrees in {TURN_SPAN_S:g} s, "
        f"and {gyro.name} gives {angles[1][k]:.1f} degrees, {apart[k]:.1f} degrees apart; such differences in "
        f"{100.0 * wrong.sum() / moves.sum():.3g} % of the turns: {cause}"
    )


def _below(position: Series, ground_d_m: float) -> str:
    """Whether most of the flight is below the ground."""
    height = ground_d_m - position.value[:, 2]
    if np.mean(height < -HEIGHT_LEAST_M) <= MOST:
        return ""
    lowest = int(np.argmin(height))
    return (
        f"the aircraft is below the ground at d = {ground_d_m:g} m, by {-height[lowest]:.1f} m at "
        f"{position.time_s[lowest]:.3f} s: is the position's z up, or the ground at another --ground?"
    )


def doubt_of_height(poses: Poses, ground_d_m: float) -> str:
    """A height below the ground, or a gross contradiction between the height above a ground and the distance sensor.
    Empty: none."""
    return _against_sensor(poses, ground_d_m) or _below(poses.recording.position, ground_d_m)


def _against_sensor(poses: Poses, ground_d_m: float) -> str:
    clearance = poses.recording.clearance
    if clearance is None:
        return ""
    measured, time_s = clearance.value[:, 0], clearance.time_s
    height = ground_d_m - poses.position_m(time_s)[:, 2]
    flies = np.maximum(measured, np.abs(height)) > HEIGHT_LEAST_M
    flies &= (time_s >= poses.recording.position.time_s[0]) & (time_s <= poses.recording.position.time_s[-1])
    if flies.sum() < HEIGHT_SAMPLES:
        return ""
    measured, height = measured[flies], height[flies]
    gap = np.abs(height - measured)
    gross = (gap > HEIGHT_OFF_M) & (gap > HEIGHT_OFF_SHARE * np.maximum(measured, np.abs(height)))
    if gross.mean() <= 0.5:
        return ""
    middle = int(np.argmin(np.abs(gap - np.median(gap)).round(1)))  # the first of the typical ones, on any processor
    ratio = float(np.median(height / np.maximum(measured, 1e-6)))
    if ratio < 0.0:
        cause = "is the position's z up?"
    elif abs(ratio * FOOT_M - 1.0) < FOOT_TOLERANCE or abs(ratio / FOOT_M - 1.0) < FOOT_TOLERANCE:
        cause = "is one of them in feet?"
    else:
        ground = ground_d_m - float(np.median(height - measured))
        cause = f"is the origin not on the ground, for example at sea level? then give --ground {ground:.1f}"
    return (
        f"at {time_s[flies][middle]:.3f} s {clearance.name} measures {measured[middle]:.1f} m, and the height above "
        f"the ground at d = {ground_d_m:g} m is {height[middle]:.1f} m: {cause}"
    )


def doubts_of_boxes(frames: Sequence[Frame], cameras: Sequence[Camera]) -> list[str]:
    """Boxes in shares of the image, with exchanged sides, or outside the image."""
    whole = [frame for frame in frames if frame.box_px is not None and None not in frame.box_px]
    if len(whole) < BOXES_LEAST:
        return []
    box = np.array([frame.box_px for frame in whole], float)
    size = np.array([(cameras[frame.camera].width, cameras[frame.camera].height) for frame in whole], float)
    if np.nanmax(np.abs(box)) <= SHARES_MAX:
        return ["box_left_px: all sides are between 0 and 1: shares of the image? boxes are in pixels"]
    result = []
    exchanged = int(((box[:, 2] <= box[:, 0]) | (box[:, 3] <= box[:, 1])).sum())
    if exchanged > ODD_BOXES * len(box):
        result.append(
            f"box_right_px: right is not right of left, or bottom not below top, in {exchanged} of {len(box)} boxes: "
            "are these width and height, or exchanged columns?"
        )
    beyond = np.maximum(-box[:, :2], box[:, 2:] - size) > BEYOND * size
    if beyond.any(1).mean() > ODD_BOXES:
        result.append(
            f"box_left_px: {int(beyond.any(1).sum())} of {len(box)} boxes leave the image of {size[0, 0]:g} x "
            f"{size[0, 1]:g} px: is camera.ini that of another image size, or are columns exchanged?"
        )
    return result


def hints_on_conventions(poses: Poses) -> list[str]:
    """Hints at other units, orders and axes, by the rules for frames.csv and with its names."""
    position, attitude = poses.recording.position, poses.recording.attitude
    start, end = max(position.time_s[0], attitude.time_s[0]), min(position.time_s[-1], attitude.time_s[-1])
    if not start < end:
        return []
    time_s = np.linspace(start, end, max(int((end - start) * HINT_RATE_HZ), 2))
    pose = np.column_stack([time_s, poses.smooth_m(time_s), poses.attitude(time_s)])
    return hints_of(pose, np.full(len(time_s), np.nan), np.ones(len(time_s), bool))
