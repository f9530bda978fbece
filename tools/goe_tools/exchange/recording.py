"""The flight in an autopilot's log of any format: pose, rates, height, and the jumps of its filter.

Frames and units as in ``logs.obslog``; times in s of the autopilot's clock."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..flights.rotations import matrices, multiply
from ..logs.fields import LogError

LOG_BYTES_MAX = 2**31  # of a file of messages, whose content is kept in memory
LEAST_SAMPLES = 2
NORM_TOLERANCE = 0.01


def check_size(path: Path) -> None:
    """LogError for a log too large for memory, and for a device or pipe, which may have no end. The reader reports a
    missing file or a folder."""
    if path.is_file():
        if path.stat().st_size > LOG_BYTES_MAX:
            raise LogError(path, 0, "", f"longer than {LOG_BYTES_MAX} bytes")
    elif path.exists() and not path.is_dir():
        raise LogError(path, 0, "", "is not a file")


@dataclass
class Series:
    """One signal. ``name``: topic and field, for errors."""

    name: str
    time_s: np.ndarray  # (N,) strictly increasing
    value: np.ndarray  # (N, n)

    @property
    def rate_hz(self) -> float:
        return float((len(self.time_s) - 1) / (self.time_s[-1] - self.time_s[0]))


@dataclass(frozen=True)
class Jump:
    """A reset of the autopilot's filter; its time is that of the first sample after it."""

    time_s: float
    delta_m: tuple[float, float, float] | None  # new minus old position, NED; None: unknown, or the attitude jumped
    cause: str


@dataclass
class Recording:
    """``clearance``: (N, 1) height of the vehicle above the ground below it, m; None: the log has no such sensor."""

    path: Path
    position: Series  # (N, 3) NED, m
    attitude: Series  # (N, 4) w, x, y, z
    gyro: Series | None = None  # (N, 3) body rates, rad/s
    velocity: Series | None = None  # (N, 3) NED, m/s
    clearance: Series | None = None
    jumps: list[Jump] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def make_series(path: Path, name: str, time_s: np.ndarray, value: np.ndarray) -> Series:
    """Checks a signal; a LogError contains its name and the time. Drops repeated samples."""
    time_s, value = np.asarray(time_s, float), np.asarray(value, float)
    if len(time_s) < LEAST_SAMPLES:
        raise LogError(path, 0, name, f"{len(time_s)} samples, needs at least {LEAST_SAMPLES}")
    value = value.reshape(len(time_s), -1)
    step = np.diff(time_s)
    back = np.flatnonzero(step < 0.0)
    if len(back):
        before, after = time_s[back[0]], time_s[back[0] + 1]
        raise LogError(path, 0, name, f"time runs back from {before:.6f} s to {after:.6f} s")
    new = np.concatenate([[True], step > 0.0])
    time_s, value = time_s[new], value[new]
    bad = np.flatnonzero(~np.isfinite(value).all(1))
    if len(bad):
        raise LogError(path, 0, name, f"not finite at {time_s[bad[0]]:.6f} s")
    if len(time_s) < LEAST_SAMPLES:
        raise LogError(path, 0, name, "all samples have the same time")
    return Series(name, time_s, value)


def make_attitude(path: Path, name: str, time_s: np.ndarray, quaternion: np.ndarray) -> Series:
    """Checks quaternions, normalizes them and gives them continuous signs."""
    series = make_series(path, name, time_s, quaternion)
    norm = np.linalg.norm(series.value, axis=1)
    bad = np.flatnonzero(np.abs(norm - 1.0) > NORM_TOLERANCE)
    if len(bad):
        at = series.time_s[bad[0]]
        raise LogError(path, 0, name, f"is not a unit quaternion at {at:.6f} s: its norm is {norm[bad[0]]:.3f}")
    q = series.value / norm[:, None]
    turned = np.concatenate([[1.0], np.cumprod(np.where((q[1:] * q[:-1]).sum(1) < 0.0, -1.0, 1.0))])
    return Series(series.name, series.time_s, q * turned[:, None])


# ------------------------------------------------------------------------------------------------------- interpolation


def _bracket(series: Series, time_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Index of the sample before each time, and the fraction of the interval to the next."""
    i = np.clip(np.searchsorted(series.time_s, time_s, side="right") - 1, 0, len(series.time_s) - 2)
    span = series.time_s[i + 1] - series.time_s[i]
    return i, np.clip((time_s - series.time_s[i]) / span, 0.0, 1.0)


def linear(series: Series, time_s: np.ndarray) -> np.ndarray:
    """(K, n) at times (K,); constant beyond the ends."""
    i, share = _bracket(series, time_s)
    return series.value[i] + share[:, None] * (series.value[i + 1] - series.value[i])


def slerp(series: Series, time_s: np.ndarray) -> np.ndarray:
    """(K, 4): spherical interpolation at a constant rate."""
    i, share = _bracket(series, time_s)
    p, q = series.value[i], series.value[i + 1]
    cosine = np.clip((p * q).sum(1), -1.0, 1.0)
    angle = np.arccos(cosine)
    sine = np.maximum(np.sin(angle), 1e-12)
    straight = angle < 1e-6
    a = np.where(straight, 1.0 - share, np.sin((1.0 - share) * angle) / sine)
    b = np.where(straight, share, np.sin(share * angle) / sine)
    result = a[:, None] * p + b[:, None] * q
    return result / np.linalg.norm(result, axis=1, keepdims=True)


def within(series: Series, time_s: np.ndarray, gap_s: float) -> np.ndarray:
    """(K,) whether the samples around a time are no farther apart than the gap."""
    i, _ = _bracket(series, time_s)
    inside = (time_s >= series.time_s[0]) & (time_s <= series.time_s[-1])
    return inside & (series.time_s[i + 1] - series.time_s[i] <= gap_s)


def made_upright(distance: Series, attitude: Series) -> Series:
    """The vertical part of a distance along the body's down axis."""
    down = matrices(slerp(attitude, distance.time_s))[:, 2, 2]
    return Series(distance.name, distance.time_s, distance.value * np.maximum(down, 0.0)[:, None])


class Poses:
    """The vehicle's pose at any time. Positions are interpolated without the known jumps of the filter, which are then
    added again; there is no interpolation across an unknown jump."""

    def __init__(self, recording: Recording) -> None:
        self.recording = recording
        known = [jump for jump in recording.jumps if jump.delta_m is not None]
        self._known_s = np.array([jump.time_s for jump in known])
        self._sums = np.concatenate([np.zeros((1, 3)), np.cumsum([j.delta_m for j in known], 0).reshape(-1, 3)])
        self.cuts_s = np.array([jump.time_s for jump in recording.jumps if jump.delta_m is None])
        position = recording.position
        smooth = position.value - self.jumped_m(position.time_s)
        self._smooth = Series(position.name, position.time_s, smooth)

    def jumped_m(self, time_s: np.ndarray) -> np.ndarray:
        """(K, 3): sum of all known jumps up to a time."""
        return self._sums[np.searchsorted(self._known_s, time_s, side="right")]

    def count(self, time_s: np.ndarray) -> np.ndarray:
        """(K,): number of jumps of all kinds up to a time."""
        times = np.array([jump.time_s for jump in self.recording.jumps])
        return np.searchsorted(times, time_s, side="right")

    def position_m(self, time_s: np.ndarray) -> np.ndarray:
        """(K, 3) as the filter reported it at that time."""
        return linear(self._smooth, time_s) + self.jumped_m(time_s)

    def smooth_m(self, time_s: np.ndarray) -> np.ndarray:
        """(K, 3) without the known jumps."""
        return linear(self._smooth, time_s)

    def attitude(self, time_s: np.ndarray) -> np.ndarray:
        return slerp(self.recording.attitude, time_s)

    def good(self, time_s: np.ndarray, gap_s: float) -> np.ndarray:
        """(K,) whether the log gives the pose: not outside, in no gap, not between the samples of an unknown jump."""
        result = np.ones(len(time_s), bool)
        for series in (self.recording.position, self.recording.attitude):
            result &= within(series, time_s, gap_s)
            i, share = _bracket(series, time_s)
            for cut in self.cuts_s:
                result &= ~((series.time_s[i] < cut) & (cut <= series.time_s[i + 1]) & (share > 0.0) & (share < 1.0))
        return result

    def ground_d_m(self, time_s: np.ndarray) -> np.ndarray | None:
        """(K,) down coordinate of the ground below the vehicle, from the latest reading; None without any."""
        clearance = self.recording.clearance
        if clearance is None:
            return None
        ground = clearance.value[:, 0] + self.position_m(clearance.time_s)[:, 2] - self.jumped_m(clearance.time_s)[:, 2]
        return np.interp(time_s, clearance.time_s, ground) + self.jumped_m(time_s)[:, 2]


# --------------------------------------------------------------------------------------------------------------- rates


def turned_by(gyro: Series, start_s: float, end_s: float) -> np.ndarray:
    """(4,): rotation between two times, body -> body at the start, from the rates with the trapezoidal rule."""
    inner = gyro.time_s[(gyro.time_s > start_s) & (gyro.time_s < end_s)]
    times = np.concatenate([[start_s], inner, [end_s]])
    rates = linear(gyro, times)
    result = np.array([1.0, 0.0, 0.0, 0.0])
    for vector in 0.5 * (rates[1:] + rates[:-1]) * np.diff(times)[:, None]:
        angle = np.linalg.norm(vector)
        result = multiply(result, np.concatenate([[np.cos(angle / 2)], vector * 0.5 * np.sinc(angle / (2 * np.pi))]))
    return result


def conjugate(q: np.ndarray) -> np.ndarray:
    return q * np.array([1.0, -1.0, -1.0, -1.0])


def filled(attitude: Series, gyro: Series) -> Series:
    """The attitude, interpolated with the gyro: integrates the rates from each sample and distributes the difference at
    the next one over the time between them."""
    times, values = [attitude.time_s[0]], [attitude.value[0]]
    for k in range(len(attitude.time_s) - 1):
        start, end = attitude.time_s[k], attitude.time_s[k + 1]
        inner = gyro.time_s[(gyro.time_s > start) & (gyro.time_s < end)]
        stops = np.concatenate([inner, [end]])
        turn, path, at = np.array([1.0, 0.0, 0.0, 0.0]), [], start
        for stop in stops:
            turn = multiply(turn, turned_by(gyro, at, stop))
            path.append(turn)
            at = stop
        left = multiply(conjugate(path[-1]), multiply(conjugate(attitude.value[k]), attitude.value[k + 1]))
        left = left if left[0] >= 0.0 else -left
        for stop, turn in zip(stops, path):
            share = (stop - start) / (end - start)
            rest = np.concatenate([[1.0], share * left[1:]])
            q = multiply(multiply(attitude.value[k], turn), rest / np.linalg.norm(rest))
            times.append(stop)
            values.append(q if q @ values[-1] >= 0.0 else -q)
    return Series(attitude.name, np.array(times), np.array(values))
