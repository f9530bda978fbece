"""Hints at probable mistakes in a readable log: other units, signs or axes, another order of the quaternion.

A hint refuses nothing: it describes the observation and a remedy. goe_replay has the same rules
(sim_host/log/log_hints.c).
"""

from __future__ import annotations

import math

import numpy as np

IMAGES_MIN = 10
STEP_MAX_S, SPEED_MIN_M_S, WAY_MIN_M = 5.0, 0.5, 5.0  # fewer images of a hardly moving aircraft: milliseconds
SPEED_MAX_M_S = 150.0
MOVE_M = 1.0
TILT_MAX, AGAINST, MOST = 0.5, -0.5, 0.8  # cosines of a tilt, of the nose to the motion; share of the moves
APART, ALONG = 0.87, 0.97  # cosines of the nose to a motion at more than 30 degrees to it, and within 14
FOOT_M, FOOT_TOLERANCE = 0.3048, 0.03
HEIGHT_VARIANCE_M2, CORRELATED = 4.0 * FOOT_M, 0.99


def _moves(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Images at which the aircraft has moved by a meter or more since the last such image, and the directions of
    motion."""
    rows, ways, anchor = [], [], place[0]
    for i in range(1, len(place)):
        way = (place[i, 0] - anchor[0], place[i, 1] - anchor[1])
        length = math.hypot(*way)
        if length >= MOVE_M:
            rows.append(i)
            ways.append((way[0] / length, way[1] / length))
            anchor = place[i]
    return np.array(rows, int), np.array(ways, float).reshape(-1, 2)


def _nose_along(attitude: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Cosines between the nose and the motion, of level attitudes."""
    w, x, y, z = attitude.T
    return (w * w + x * x - y * y - z * z) * motion[:, 0] + 2.0 * (x * y + w * z) * motion[:, 1]


def _odd(attitude: np.ndarray, motion: np.ndarray) -> float:
    """Share of the attitudes that are tilted by more than 60 degrees or point against the motion."""
    w, x, y, z = attitude.T
    down = w * w - x * x - y * y + z * z
    return float(np.mean((down < TILT_MAX) | (_nose_along(attitude, motion) < AGAINST)))


def _of_times(time_s: np.ndarray, place: np.ndarray) -> str:
    span_s = time_s[-1] - time_s[0]
    way_m = float(np.hypot(*np.diff(place, axis=0).T).sum())
    step_s, speed = span_s / (len(time_s) - 1), way_m / span_s
    if way_m > WAY_MIN_M and step_s > STEP_MAX_S and speed < SPEED_MIN_M_S:
        observed = f"an image every {step_s:.3g} s of an aircraft that flies {speed:.2g} m/s"
        return f"t_s: {observed}: milliseconds? t_s is in seconds"
    if speed > SPEED_MAX_M_S:
        return f"n_m, e_m: the aircraft flies {speed:.3g} m/s: feet? positions are in meters, t_s in seconds"
    return ""


def _of_attitude(attitude: np.ndarray, place: np.ndarray) -> str:
    rows, motion = _moves(place)
    if len(rows) < IMAGES_MIN:
        return ""
    attitude = attitude[rows]
    if _odd(attitude, motion) > MOST and _odd(attitude[:, [3, 0, 1, 2]], motion) < 1.0 - MOST:
        return (
            "qw: the attitude does not fit the motion, and does if the quaternion is in the order x, y, z, w: "
            "qw is its real part"
        )
    if np.mean(_nose_along(attitude, motion) < APART) <= MOST:
        return ""
    if np.mean(_nose_along(attitude, motion[:, ::-1]) > ALONG) > MOST:
        return (
            "n_m, e_m: the motion does not fit the heading, and does if the two are exchanged: is east the first? "
            "n_m is north"
        )
    if np.mean(_nose_along(attitude * [1.0, -1.0, -1.0, -1.0], motion) > ALONG) > MOST:
        return (
            "qw: the attitude does not fit the motion, and its inverse does: the quaternion turns the body's axes into "
            "north, east, down"
        )
    return ""


def _strange_ratio(up: np.ndarray, agl: np.ndarray) -> float:
    """3.28, 0.305 or -1 if this is the ratio of the heights, or of their changes (agl_m over -d_m); 0: none of them."""
    u, a = up - up.mean(), agl - agl.mean()
    both, of_up = float(np.mean(u * a)), float(np.mean(u * u))
    varied = of_up > HEIGHT_VARIANCE_M2 and both * both > CORRELATED * of_up * float(np.mean(a * a))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = agl / up
    for strange in (1.0 / FOOT_M, FOOT_M, -1.0):
        if varied and abs(both / of_up / strange - 1.0) < FOOT_TOLERANCE:
            return strange
        if bool(np.all(np.abs(ratio / strange - 1.0) < FOOT_TOLERANCE)):
            return strange
    return 0.0


def _of_heights(up: np.ndarray, agl: np.ndarray, given: np.ndarray) -> str:
    """``agl``: NaN where it is not a number; ``given``: whether the field has one."""
    known = np.isfinite(agl)
    ratio = _strange_ratio(up[known], agl[known]) if known.sum() >= IMAGES_MIN else 0.0
    end = "is it up? d_m is down, negative above the origin"
    if ratio < 0.0:
        return f"d_m: it grows as agl_m does: {end}"
    if np.mean(np.where(given, agl < 0.0, up < 0.0)) > MOST:
        by = " by agl_m" if known.any() else ", and agl_m is empty"
        return f"d_m: the camera is below the ground{by}: {end}"
    if ratio:
        name, other = ("agl_m", "-d_m") if ratio > 1.0 else ("d_m", "-agl_m")
        return f"{name}: {1.0 / FOOT_M:.3g} times {other}: feet? both are in meters"
    return ""


def hints_of(pose: np.ndarray, agl: np.ndarray, given: np.ndarray) -> list[str]:
    """Hints for rows of frames.csv: (N, 8) time, position and attitude, (N,) height above ground, NaN where it is not
    a number, and whether its field has one."""
    taken = np.flatnonzero(np.isfinite(pose).all(1))
    latest = np.maximum.accumulate(pose[taken, 0]) if len(taken) else pose[:0, 0]
    taken = taken[np.flatnonzero(np.diff(latest, prepend=-np.inf) > 0.0)]  # an image has a row of each obstacle
    if len(taken) < IMAGES_MIN:
        return []
    pose = pose[taken]
    found = [
        _of_times(pose[:, 0], pose[:, 1:3]),
        _of_attitude(pose[:, 4:], pose[:, 1:3]),
        _of_heights(-pose[:, 3], agl[taken], given[taken]),
    ]
    return [hint for hint in found if hint]
