"""The aircraft's motion over a log: one entry for each time with an image.

Frames: NED earth, meters. Known jumps of the autopilot's filter are removed, so the path continues as flown, relative
to the first image's origin. An unknown jump interrupts the path.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..flights.rotations import matrices, mounting
from ..logs.obslog import Camera, Frame, ObservationLog
from ..models.model import undistort

VELOCITY_OVER_S = 1.0  # averaging time of the velocity, or else the last two images
QUATERNION_OFF = 0.01  # limit of the library
POSITION_MAX_M = 1e6  # limit of the library
LEVEL_MIN = 0.2  # horizontal share of a line of sight; below, it has no direction on the map


@dataclass
class Motion:
    """Over M moments. ``of_frame``: (rows,) the moment of each row of the log."""

    time_s: np.ndarray  # (M,) rising
    camera_ne_m: np.ndarray  # (M, 2); interpolated if the log has none
    down_m: np.ndarray  # (M,)
    velocity_m_s: np.ndarray  # (M, 3) north, east, down; NaN: not known
    look_rad: np.ndarray  # (M, 2) azimuths, clockwise from north, of the image's left and right border; NaN: none
    broken: np.ndarray  # (M,) the path does not continue from the moment before
    reset: np.ndarray  # (M,) the filter's reset count changed
    of_frame: np.ndarray
    shift_m: np.ndarray  # (rows, 3) sum of the jumps, subtracted from the position of each row


def shown_times(frames: Sequence[Frame]) -> np.ndarray:
    """(rows,) the time of a row; that of its track's latest row before it if it has none, or an earlier one."""
    times = np.array([frame.t_s for frame in frames], float)
    first = float(times[np.isfinite(times)].min()) if np.isfinite(times).any() else 0.0
    latest: dict[int, float] = {}
    for i, frame in enumerate(frames):
        before = latest.get(frame.id, first)
        times[i] = max(times[i], before) if math.isfinite(times[i]) else before
        latest[frame.id] = float(times[i])
    return times


def _jumps(frames: Sequence[Frame], order: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(rows, 3) sum of the known jumps up to each row; (rows,) whether the count changed there, and whether by an
    unknown jump. Tracks share the filter: a jump counts once."""
    shift, reset, unknown = np.zeros((len(frames), 3)), np.zeros(len(frames), bool), np.zeros(len(frames), bool)
    total, count = np.zeros(3), None
    for i in order:
        frame = frames[i]
        if count is not None and frame.reset_count != count:
            known = frame.reset_delta_m is not None and np.isfinite(frame.reset_delta_m).all()
            reset[i], unknown[i] = True, not known
            total = total + (np.array(frame.reset_delta_m) if known else 0.0)
        count = frame.reset_count
        shift[i] = total
    return shift, reset, unknown


def _filled(time_s: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(M, n): rows with a NaN are interpolated in time; zero if all are NaN."""
    good = np.isfinite(values).all(1)
    if not good.any():
        return np.zeros_like(values)
    return np.stack([np.interp(time_s, time_s[good], column[good]) for column in values.T], -1)


def velocities(time_s: np.ndarray, position_m: np.ndarray, broken: np.ndarray) -> np.ndarray:
    """(M, 3): mean velocity over ``VELOCITY_OVER_S``, or since the previous image; NaN at the start of a path."""
    result = np.full((len(time_s), 3), np.nan)
    starts = np.flatnonzero(broken)
    since = np.searchsorted(time_s, time_s - VELOCITY_OVER_S - 1e-9)
    for k in range(1, len(time_s)):
        start = starts[np.searchsorted(starts, k, side="right") - 1] if len(starts) and starts[0] <= k else 0
        j = max(min(since[k], k - 1), start)
        if j < k and time_s[k] > time_s[j]:
            result[k] = (position_m[k] - position_m[j]) / (time_s[k] - time_s[j])
    return result


def border_rays(camera: Camera) -> np.ndarray:
    """(2, 3): body axes, through the centers of the image's left and right border."""
    pixels = np.array([[0.0, 0.5 * camera.height], [camera.width, 0.5 * camera.height]])
    try:
        points, _ = undistort(camera, pixels)
    except np.linalg.LinAlgError:  # outside the lens model's range
        points = (pixels - [camera.cx, camera.cy]) / [camera.fx, camera.fy]
    return np.column_stack([points, np.ones(2)]) @ mounting(camera).T


def _azimuths(rays: np.ndarray) -> np.ndarray:
    """(..., 2) of rays (..., 2, 3) in NED; both NaN if one has no direction on the map."""
    level = np.hypot(rays[..., 0], rays[..., 1])
    good = (level > LEVEL_MIN * np.linalg.norm(rays, axis=-1)).all(-1, keepdims=True)
    return np.where(good, np.arctan2(rays[..., 1], rays[..., 0]), np.nan)


def motion_of(log: ObservationLog) -> Motion:
    """Of a log with at least one row."""
    frames = log.frames
    cameras = [log.camera, log.camera2 or log.camera]
    shown = shown_times(frames)
    order = np.argsort(shown, kind="stable")
    shift, reset, unknown = _jumps(frames, order)
    time_s, of_frame = np.unique(shown, return_inverse=True)
    of_frame = of_frame.reshape(-1)
    count = len(time_s)
    position = np.array([frame.position_m for frame in frames], float) - shift
    quaternion = np.array([frame.attitude for frame in frames], float)
    with np.errstate(invalid="ignore", over="ignore"):
        turned = np.abs(np.linalg.norm(quaternion, axis=1) - 1.0) < QUATERNION_OFF
        good = turned & (np.abs(position) < POSITION_MAX_M).all(1)  # false for NaN
    position = np.where(good[:, None], position, np.nan)
    rotation = matrices(np.where(turned[:, None], quaternion, [1.0, 0.0, 0.0, 0.0]))
    number = np.array([frame.camera for frame in frames])
    offsets = np.array([[c.offset_x_m, c.offset_y_m, c.offset_z_m] for c in cameras])
    rays = np.array([border_rays(camera) for camera in cameras])
    eye = position + np.einsum("kij,kj->ki", rotation, offsets[number])
    look = _azimuths(np.einsum("kij,kbj->kbi", rotation, rays[number]))
    at, camera_at, look_at = (np.full((count, n), np.nan) for n in (3, 3, 2))
    for i in order[::-1]:  # of several rows at one time the first good one counts
        if good[i]:
            at[of_frame[i]], camera_at[of_frame[i]], look_at[of_frame[i]] = position[i], eye[i], look[i]
    broken, resets = np.zeros(count, bool), np.zeros(count, bool)
    np.logical_or.at(broken, of_frame, unknown)
    np.logical_or.at(resets, of_frame, reset)
    camera_m = _filled(time_s, camera_at)
    return Motion(
        time_s, camera_m[:, :2], camera_m[:, 2], velocities(time_s, _filled(time_s, at), broken), look_at, broken,
        resets, of_frame, shift,
    )  # fmt: skip
