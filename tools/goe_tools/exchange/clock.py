"""Offset between the camera's clock and the autopilot's, estimated from the agreement of turns and images.

Compensated for attitude, a static obstacle is at the same place on the earth in every image. With a wrong time the
attitude belongs to another moment: the direction to the obstacle then moves with the turning rate, by rate times
offset. For an offset s, the middle of a box at time t, in direction r in the camera's axes, constrains a point P and a
constant attitude error b:

    e1, e2 . (P - c) / |P - c| = e1, e2 . (d + R [b x] M r)       R, c: attitude and place of the camera at t + s
                                                                 d = R M r, e1, e2: two directions perpendicular to d

Each track has one P and one b, b with a prior. The rows of a track are whitened with the library's error model of
boxes: white noise, plus an error proportional to the box that is correlated over about a second. The offset minimizes
J(s), the sum of all squares, found on a grid and filter by parabolas. With the variance v of a row

    sigma = sqrt(2 v / J''(s))

The attitude is the autopilot's; if it was logged slowly, the gyro's rates interpolate between its samples."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..flights.rotations import matrices, mounting
from ..logs.obslog import Camera, Frame
from ..models.model import undistort
from .detections import by_id
from .recording import Poses, Series, filled, slerp, within

SLOW_HZ = 40.0  # of the attitude: below this rate a faster gyro interpolates it
LEAST_IMAGES = 8  # of a track
GRID_S = 0.05
FINE_S = np.array([0.03, 0.008, 0.008])  # distance of the parabola's points, one parabola after the other
PARABOLA = np.arange(-2, 3)
BIAS_SD = math.radians(1.5)  # sigma of the constant attitude error
WHITE_PX = 1.0  # white error of a box's middle in px, including that of the attitude ...
SHARE, FADES_S = 0.035, 1.2  # ... correlated error as a share of the box's size, and its time; the fit scales them
ROUNDS = 5  # iterations of the ranges that weight the equations
HUBER = 2.5  # sigmas: rows farther off get a smaller weight
CORRELATED_IMAGES = 12  # up to this distance errors may be correlated
FAR_M = 1e5
NEAREST_M = 1.0
PREPARED = 0.5  # share of the time until the search begins


@dataclass(frozen=True)
class Offset:
    """Seconds to add to the camera's times, and their sigma."""

    offset_s: float
    sigma_s: float
    images: int  # rows of the table that took part
    misfit: float  # residual, in units of the usual noise of boxes
    at_the_end: bool  # the best offset is at an end of the search interval


@dataclass
class Marks:
    """The middles of an obstacle in K images of one track."""

    time_s: np.ndarray  # (K,) the camera's clock
    ray: np.ndarray  # (K, 3) unit vectors in body axes
    offset_m: np.ndarray  # (K, 3) of the camera, body
    whitening: np.ndarray  # (2, K, K) of the horizontal and the vertical errors, 1/rad
    weight: np.ndarray  # (K, 2)


def _middle(frame: Frame) -> tuple[float, float, float, float] | None:
    """u, v, width and height of the visible obstacle, px; with points, of left and right."""
    if frame.box_px is not None and all(side is not None for side in frame.box_px):
        left, top, right, bottom = frame.box_px
        return 0.5 * (left + right), 0.5 * (top + bottom), right - left, bottom - top  # type: ignore[operator]
    if frame.left is not None and frame.right is not None:
        u, v = (0.5 * (a + b) for a, b in zip(frame.left, frame.right))
        width = math.dist(frame.left, frame.right)
        return u, v, width, width
    return None


def _at_border(frame: Frame, camera: Camera) -> bool:
    """Whether the border cuts the box; then its middle is not the obstacle's."""
    if frame.box_px is None:
        return False
    margin = 0.012 * camera.width
    left, top, right, bottom = (math.nan if side is None else side for side in frame.box_px)
    return not (left > margin and top > margin and right < camera.width - margin and bottom < camera.height - margin)


def is_whole(frame: Frame, camera: Camera) -> bool:
    """Whether the row shows the whole obstacle."""
    return _middle(frame) is not None and not _at_border(frame, camera)


def _whitening(time_s: np.ndarray, size_rad: np.ndarray, white_rad: np.ndarray) -> np.ndarray:
    """(K, K): makes errors of that model independent, with variance 1."""
    correlation = np.exp(-np.abs(time_s[:, None] - time_s) / FADES_S)
    share = SHARE * size_rad
    return np.linalg.inv(np.linalg.cholesky(np.diag(white_rad**2) + share[:, None] * share * correlation))


def marks_of(frames: Sequence[Frame], cameras: Sequence[Camera]) -> Marks | None:
    """None: too few images show the whole obstacle."""
    time_s, ray, offset, size, white = [], [], [], [], []
    mounts = [mounting(camera) for camera in cameras]
    for frame in frames:
        camera = cameras[frame.camera]
        middle = _middle(frame)
        if middle is None or not is_whole(frame, camera):
            continue
        point, _ = undistort(camera, np.array(middle[:2]))
        direction = mounts[frame.camera] @ np.array([*point, 1.0])
        time_s.append(frame.t_s)
        ray.append(direction / np.linalg.norm(direction))
        offset.append([camera.offset_x_m, camera.offset_y_m, camera.offset_z_m])
        size.append([middle[2] / camera.fx, middle[3] / camera.fy])
        white.append(WHITE_PX / camera.fx)
    if len(time_s) < LEAST_IMAGES:
        return None
    times, sizes = np.array(time_s), np.array(size)
    whitening = np.array([_whitening(times, sizes[:, axis], np.array(white)) for axis in (0, 1)])
    return Marks(times, np.array(ray), np.array(offset), whitening, np.ones((len(times), 2)))


def _square_to(direction: np.ndarray) -> np.ndarray:
    """(K, 2, 3): horizontal and upward unit vectors perpendicular to directions (K, 3)."""
    right = np.cross(np.array([0.0, 0.0, 1.0]), direction)
    right /= np.maximum(np.linalg.norm(right, axis=1, keepdims=True), 1e-9)
    return np.stack([right, np.cross(direction, right)], 1)


def _crosses(vector: np.ndarray) -> np.ndarray:
    """(K, 3, 3): matrices m of minus the cross product: m b = b x vector."""
    x, y, z = vector.T
    zero = np.zeros(len(vector))
    return np.stack([np.stack(row, -1) for row in ([zero, z, -y], [-z, zero, x], [y, -x, zero])], 1)


def _whitened(marks: Marks, values: np.ndarray) -> np.ndarray:
    """Whitened rows (K, 2, n)."""
    return (marks.whitening @ values.transpose(1, 0, 2)).transpose(1, 0, 2) * marks.weight[..., None]


class Search:
    """The sum of squares over all tracks, for any offset."""

    def __init__(self, tracks: Sequence[Marks], poses: Poses, attitude: Series) -> None:
        self.tracks, self.poses, self.attitude = tracks, poses, attitude

    def _solve(self, marks: Marks, offset_s: float) -> np.ndarray:
        """(K, 2): residuals of the best point and attitude error, whitened and weighted."""
        time_s = marks.time_s + offset_s
        turn = matrices(slerp(self.attitude, time_s))
        eye = self.poses.smooth_m(time_s) + np.einsum("kij,kj->ki", turn, marks.offset_m)
        direction = np.einsum("kij,kj->ki", turn, marks.ray)
        across = _square_to(direction)
        by_bias = -np.einsum("kni,kij,kjl->knl", across, turn, _crosses(marks.ray))
        middle = eye.mean(0)
        distance = np.full(len(time_s), FAR_M)
        for _ in range(ROUNDS):
            slope = np.concatenate([across / distance[:, None, None], by_bias], -1)
            wanted = np.einsum("kni,ki->kn", across, eye - middle) / distance[:, None]
            rows = _whitened(marks, slope).reshape(-1, 6)
            white = _whitened(marks, wanted[..., None]).reshape(-1)
            prior = np.zeros((3, 6))
            prior[:, 3:] = np.eye(3) / BIAS_SD
            norm = np.maximum(np.linalg.norm(rows, axis=0), 1e-12)
            full = np.concatenate([rows / norm, prior / norm])
            best = np.linalg.lstsq(full, np.concatenate([white, np.zeros(3)]), rcond=1e-10)[0] / norm
            distance = np.maximum(np.einsum("ki,ki->k", direction, best[:3] + middle - eye), NEAREST_M)
        return (white - rows @ best).reshape(-1, 2)

    def residuals(self, offset_s: float) -> list[np.ndarray]:
        """(K, 2) of each track, whitened and weighted."""
        return [self._solve(marks, offset_s) for marks in self.tracks]

    def cost(self, offset_s: float) -> float:
        return float(sum((left**2).sum() for left in self.residuals(offset_s)))

    def spread(self, offset_s: float) -> float:
        """Variance of half the slope of the sum of squares, with any correlation between neighboring errors."""
        step = float(FINE_S[-1])
        result = 0.0
        for left, after, before in zip(*(self.residuals(offset_s + k * step) for k in (0, 1, -1))):
            score = (left * (after - before) / (2.0 * step)).sum(1)
            for lag in range(min(CORRELATED_IMAGES, len(score) - 1)):
                common = float(score[lag:] @ score[: len(score) - lag])
                result += common * (1.0 if lag == 0 else 2.0) * (1.0 - lag / CORRELATED_IMAGES)
        return max(result, 0.0)

    def weigh(self, offset_s: float) -> None:
        """Reduces the weight of rows that are far off at an offset."""
        left = self.residuals(offset_s)
        scale = 1.4826 * float(np.median(np.abs(np.concatenate([x.reshape(-1) for x in left]))))
        for marks, rows in zip(self.tracks, left):
            marks.weight[:] = np.sqrt(np.minimum(1.0, HUBER * scale / np.maximum(np.abs(rows), 1e-12)))


def _tracks(frames: Sequence[Frame], cameras: Sequence[Camera], poses: Poses, times: tuple[float, float],
            gap_s: float, report: Callable[[float], None]) -> list[Marks]:  # fmt: skip
    """The marks of every obstacle, split at filter jumps of unknown size; only images whose pose the log contains at
    each offset between the two."""
    result, obstacles = [], by_id(frames)
    for number, rows in enumerate(obstacles.values()):
        report(number / len(obstacles))
        at = np.array([frame.t_s for frame in rows])
        good = np.ones(len(rows), bool)
        for offset in np.linspace(*times, 5):
            good &= poses.good(at + offset, gap_s)
        for cut in poses.cuts_s:
            good &= (at + times[1] < cut) | (at + times[0] >= cut)
        part = np.searchsorted(poses.cuts_s, at + times[0], side="right")
        for piece in np.unique(part):
            chosen = [frame for frame, ok, number in zip(rows, good, part) if ok and number == piece]
            marks = marks_of(chosen, cameras)
            if marks is not None:
                result.append(marks)
    return result


def attitude_for(poses: Poses, start_s: float, end_s: float) -> Series:
    """The recorded attitude between two times, interpolated with the gyro if that improves it."""
    attitude, gyro = poses.recording.attitude, poses.recording.gyro
    if gyro is None or attitude.rate_hz >= SLOW_HZ or gyro.rate_hz < 2.0 * attitude.rate_hz:
        return attitude
    kept = (attitude.time_s >= start_s - 1.0) & (attitude.time_s <= end_s + 1.0)
    inside = within(gyro, attitude.time_s, 1.0)
    if (kept & inside).sum() < 2:
        return attitude
    return filled(Series(attitude.name, attitude.time_s[kept], attitude.value[kept]), gyro)


def find_offset(
    frames: Sequence[Frame], cameras: Sequence[Camera], poses: Poses, about_s: float, reach_s: float, gap_s: float,
    report: Callable[[float], None] = lambda share: None,
) -> Offset | None:  # fmt: skip
    """The offset within ``about_s`` +- ``reach_s``; None if no track is long enough. ``report`` gets the share of the
    work that is done."""
    times = (about_s - reach_s, about_s + reach_s)
    tracks = _tracks(frames, cameras, poses, times, gap_s, lambda share: report(PREPARED * share))
    if not tracks:
        return None
    start = min(float(marks.time_s[0]) for marks in tracks) + times[0]
    end = max(float(marks.time_s[-1]) for marks in tracks) + times[1]
    search = Search(tracks, poses, attitude_for(poses, start, end))
    grid = np.linspace(*times, 2 * max(round(reach_s / GRID_S), 1) + 1)
    parts = len(grid) + len(FINE_S) * len(PARABOLA) + 1
    done = itertools.count(1)

    def cost(offset: float) -> float:
        result = search.cost(offset)
        report(PREPARED + (1.0 - PREPARED) * next(done) / parts)
        return result

    best = float(grid[int(np.argmin([cost(offset) for offset in grid]))])
    search.weigh(best)
    square, least = 0.0, 0.0
    for step in FINE_S:
        square, slope, least = np.polyfit(step * PARABOLA, [cost(best + step * k) for k in PARABOLA], 2)
        if square > 0.0:
            move = min(max(-slope / (2.0 * square), -GRID_S), GRID_S)
            least += slope * move + square * move**2
            best += move
    rows = sum(2 * len(marks.time_s) for marks in tracks)
    outside = not times[0] + GRID_S / 2 < best < times[1] - GRID_S / 2
    freedom = max(rows - 6 * len(tracks) - 1, 1)
    misfit = math.sqrt(max(least, 0.0) / freedom)
    if not square > 0.0:
        return Offset(best, math.inf, rows // 2, misfit, outside)
    variance = misfit**2 / square
    return Offset(best, math.sqrt(max(variance, search.spread(best) / square**2)), rows // 2, misfit, outside)
