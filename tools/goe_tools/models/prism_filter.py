"""A recursive estimator of a prism from upright bounding boxes, image by image: covariance form, float64.

It follows the library's definitions, but shares no code with it: the library uses a square root of the information
instead of a covariance. One linearized update per image, at the predicted state x:

    r = measured - predicted(x)          J = d predicted / d state              (``prism.visible_row_of``)

A side's error has a white part and a correlated part: a first-order Gauss-Markov process with the sigma
s = box_noise_rel * size of the box, which decays by f = exp(-t/tau) from image to image. Given the state, the past
residuals determine it: m - F (x' - x) if the state becomes x', with the remaining variance V.

    predict     m <- f m    F <- f F    V <- min(f^2 V + (1 - f^2) s^2, s^2)    in the first image V = s^2
    whiten      r <- r - m  J <- J - F  N = V + white
    update      m <- m + k r    F <- F + k J    V <- V - k V    k: of the side and the opposite one (``_learn``)

The image's own position error, p per axis, looks like an attitude error of p/Z, Z the distance of the middle along the
axes: it adds to the white attitude error, which the image's rows share. Its part along Z, which opposite sides share,
adds 2 (p dr/dZ)^2 to each side's own variance.

The depth d comes last. P is the covariance of the other states if d were known, and z d' the effect of an error d' on
them, so
    covariance of all states = [[P + z z' var(d), z var(d)], [z' var(d), var(d)]]
While the line of sight has turned by an angle whose sine is at most ``DEPTH_TURNED`` since the filter's start, d has
its prior and is not estimated (a consider parameter, Schmidt): the gain K uses P alone.

    P <- (I - K J) P (I - K J)' + K N K'        z <- z - K (J z + J_d)        d, var(d): unchanged

Later images estimate it: K, for all states, uses the covariance of all states, and P, z, var(d) follow from the
updated one.

A constant error of the own velocity is a consider parameter, too. The obstacle seems to move with it: v, m/s, along the
axes' X and Z. No image estimates v. U v is the error of the state that v causes. With the derivatives J_v of the rows
by a velocity of the obstacle, which the sides' memories whiten as well,

    start       U = 0
    update      U <- U + K (J_v - J U)
    report      variance of w'x += velocity_bias^2 |U'w|^2

The process noise leaves U as it is.

If the residuals of a track are larger than configured, or correlated from image to image, the filter widens its sigmas:
it multiplies the variance by ``Scatter.factor``.
Not modeled: the library's reaction to sides that repeatedly do not fit, which is to restart."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..flights.flight import Flight
from .altimeter import Altimeter
from .model import undistort
from .prism import (
    BX,
    PX,
    PZ,
    A,
    D,
    E,
    ErrorModel,
    G,
    Q,
    S,
    Sight,
    W,
    box_size,
    focal_px,
    quantities,
    quantity_slopes,
    shown,
    sights,
    turned,
    visible_row_of,
)
from .scatter import RATIO_MOST, Scatter
from .side_memory import COLUMNS, COUNT, Memory, Rows, learn, slopes_with_velocity

SURE_SIGMAS = 3.0  # of the places, within which a way counts as noise
SCATTER_SHARE = 0.01  # white part of a side's error, of the box's size
EARLY_SHARE = 0.08  # of tau: images at a shorter distance from the last one are not used
GAP_MAX_S = 1000.0  # longer gaps count as this
DEPTH_LIMIT = 2.0  # of |d|
AHEAD_MIN = 0.02  # of the middle, units of Z0
RAY_AHEAD_MIN = 0.02
GROUND_SIGMAS = 3.0  # least distance of the foot below the horizon for a range from flat ground
FOOT_SHARE = 0.6  # of box_noise_rel of the width, part of that sigma
NEAR_SIDE = 0.5  # of the width: the foot is nearer than the middle
RANGE_MIN_M, RANGE_MAX_M = 1.0, 1e6
CUT_MAX = 0.3  # width of a box that starts although one side is missing
NO_ALTIMETER_M = 50.0  # from this sigma of the height on the first box determines it
HEADING_ARM = 0.08  # rad/(m/s): a yaw bias looks like a velocity bias
GROUND_MIN = 1e-6  # units of Z0
NARROW, WIDE, SCALE_MIN = 0.95, 1.05, 0.05  # of 1/Z0 when the sigma of G was set, over the present one
GROWN = 1e-3  # of the height's information: less waits for more
RANGE_SHARE = 10.0  # largest relative sigma of a range at which the readings count: as large as the setting can be
SHEAR_SHARE = 0.6  # sigma of s, of the first half width
DEPTH_SD = 1.0  # of d
ROUND_SHEAR_SHARE, ROUND_DEPTH_SD = 0.02, 1e-3  # the same if the model is a disc
DEPTH_TURNED = float(np.float32(0.3))  # sine of the turn of the line of sight above which an image estimates d


def sure_way(way_m: np.ndarray, white_m: float) -> np.ndarray:
    """Ways as far as noise does not explain them."""
    noise2, way2 = (SURE_SIGMAS * white_m) ** 2, way_m**2
    return np.where(way2 > noise2, way_m * (1 - noise2 / np.maximum(way2, 1e-30)), 0.0)


def footprint_sds(errors: ErrorModel, half: float) -> tuple[float, float]:
    """Sigmas of s and of d before the first image, for the first half width."""
    return (ROUND_SHEAR_SHARE * half, ROUND_DEPTH_SD) if errors.disc else (SHEAR_SHARE * half, DEPTH_SD)


def knows_depth(sight: Sight, state: np.ndarray) -> bool:
    """Whether an image estimates d."""
    return abs(turned(sight, state)) > DEPTH_TURNED


@dataclass
class PrismTrack:
    """(K, 6) in the order x0, z0, orientation (NaN), width, length (NaN), height; NaN before the start."""

    values: np.ndarray
    sigma: np.ndarray
    fresh: np.ndarray  # (K,) the image was used
    doubted: np.ndarray  # (K,) rows with a reduced weight
    refused: np.ndarray  # (K,) rejected rows


class PrismFilter:
    """Takes the images of one obstacle in T."""

    def __init__(self, errors: ErrorModel) -> None:
        self.errors = errors
        self.state: np.ndarray | None = None  # (10,)
        self.doubted = self.refused = 0  # in the latest image
        self.scatter = Scatter(np.zeros(4))
        self.first_s: float | None = None  # the track's first image
        self.altimeter = Altimeter(errors)

    # --------------------------------------------------------------------------------------------------------- start

    def _ray(self, sight: Sight, x: float, y: float) -> np.ndarray | None:
        """X/Z and Y/Z of the raw image point, focal lengths; None if it does not point ahead."""
        camera = sight.camera
        pixel = np.array([x, y]) * [camera.fx, camera.fy] + [camera.cx, camera.cy]
        ray = sight.axes_from_camera @ [*undistort(camera, pixel)[0], 1.0]
        return ray[:2] / ray[2] if ray[2] > RAY_AHEAD_MIN else None

    def _first_range_m(self, sight: Sight, size: float, foot: np.ndarray | None) -> float:
        """From flat ground, if the foot is clearly below the horizon, otherwise from the prior width."""
        errors = self.errors
        attitude = np.radians([errors.attitude_bias_sd_deg, errors.attitude_white_sd_deg])
        own = [errors.box_noise_px / sight.camera.fy, FOOT_SHARE * errors.box_noise_rel * size]
        clear = GROUND_SIGMAS * float(np.linalg.norm([*attitude, *own]))
        high = sight.height_m > GROUND_SIGMAS * self.altimeter.sd_m
        if foot is not None and foot[1] > clear and high:
            return sight.height_m / foot[1] * (1 + NEAR_SIDE * size)
        return errors.prior_width_m / size

    def start(self, in_t: Sight) -> bool:
        """Starts with the first image that measures left or right; Z then points at the middle between them. The border
        ends the visible part."""
        left, top, right, bottom = in_t.side
        cut = not np.isfinite(left + right)
        if not np.isfinite([left, right]).any():
            return False
        fx, cx = in_t.camera.fx, in_t.camera.cx
        left = left if np.isfinite(left) else -cx / fx
        right = right if np.isfinite(right) else max(in_t.camera.width - cx, cx) / fx
        x, y = 0.5 * (left + right), 0.5 * (top + bottom)
        ray = self._ray(in_t, x, y if np.isfinite(y) else 0.0)
        if ray is None:
            return False
        cosine, sine = np.array([1.0, ray[0]]) / np.hypot(1.0, ray[0])
        turn = np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])
        sight = in_t.turned(turn, in_t.moved_m)
        head = self._ray(sight, x, top) if np.isfinite(top) else None
        foot = self._ray(sight, x, bottom) if np.isfinite(bottom) else None
        size = (right - left) / (1 + x * x)
        if size <= 0 or (cut and size > CUT_MAX):
            return False
        range_m = self._first_range_m(sight, size, foot)
        if not RANGE_MIN_M <= range_m <= RANGE_MAX_M:
            return False
        self.turn, self.origin_m, (self.start_s, self.time_s, self.rows_s) = turn, in_t.moved_m, [in_t.time_s] * 3
        state = np.zeros(COUNT)
        state[[Q, W]] = 1 / range_m, 0.5 * size
        state[E] = sight.height_m / range_m - (0.0 if head is None else head[1])
        if self.altimeter.sd_m > NO_ALTIMETER_M and foot is not None:
            state[G] = foot[1] - sight.height_m / range_m
        self.state = state
        sd = self._prior_sd(size)
        if cut:
            sd[W] = max(0.5 * size, self.errors.prior_width_m / range_m)
        self._divide(np.diag(sd**2))
        self.memory = [Memory(0.0, np.zeros(COLUMNS), 0.0) for _ in range(4)]
        self.by_velocity = np.zeros((COUNT, 2))  # U
        self.settled, self.gained = self.full_covariance(), np.zeros(COUNT)  # after the latest image, and since
        self.due_s, self.walked_s = 0.0, np.zeros(2)  # since the walk was added along X, and along Z
        self.known = False  # the position
        self.scale = 1.0  # 1/Z0 when the sigma of G was set, over the present one
        self.first_m2 = self.taken_m2 = self.altimeter.sd_m**2  # of the first height, and of those in the state
        self.taken_mean_m = 0.0  # the mean of the latter
        return True

    def _ground_variance(self, height_m2: float, scale: float = 1.0) -> float:
        """Of G: the error of a height counts by 1/Z0, a slope as it is. ``scale``: factor on 1/Z0."""
        return height_m2 * (scale * self.state[Q]) ** 2 + self.errors.terrain_slope_sd**2

    def _prior_sd(self, width: float) -> np.ndarray:
        """(10,) sigmas of the first guess."""
        errors, q = self.errors, self.state[Q]
        sd = np.empty(COUNT)
        sd[:3] = np.radians(errors.attitude_bias_sd_deg)
        sd[2] = np.hypot(sd[2], HEADING_ARM * errors.velocity_bias_sd_m_s)
        sd[G] = max(np.sqrt(self._ground_variance(self.altimeter.sd_m**2)), GROUND_MIN)
        sd[[A, Q, W]] = 1.0, 4.0 * q, 2.5 * width
        sd[E] = 10 * max(abs(self.state[E]), width)
        sd[[S, D]] = footprint_sds(errors, self.state[W])
        return sd

    # ------------------------------------------------------------------------------------------------------- an image

    def _divide(self, covariance: np.ndarray) -> None:
        """Keeps the covariance (10, 10) of all states as P, z, var(d)."""
        self.depth_variance = float(covariance[D, D])
        self.by_depth = covariance[:D, D] / self.depth_variance
        self.covariance = covariance[:D, :D] - self.depth_variance * np.outer(self.by_depth, self.by_depth)

    def full_covariance(self, bend: float = 1.0) -> np.ndarray:
        """(10, 10), of all states. ``bend``: factor on the part of the depth, as a sigma."""
        by_depth = np.append(self.by_depth, 1.0)
        result = bend**2 * self.depth_variance * np.outer(by_depth, by_depth)
        result[:D, :D] += self.covariance
        return result

    def _wait(self, span_s: float) -> None:
        """Process noise waits for the next image that gives rows."""
        drift, walk = np.radians(self.errors.attitude_walk_sd_deg), self.errors.position_walk_sd_m * self.state[Q]
        self.gained[BX : BX + 3] += drift**2 * span_s
        self.gained[A] += walk**2 * span_s
        self.walked_s += span_s
        self.due_s += span_s

    def _age(self, span_s: float) -> None:
        """The position walks along X and Z in turn, or along both after images without rows: a step along Z rescales
        the lengths, which are in units of Z0. The depth d is a ratio of lengths."""
        drift, walk = np.radians(self.errors.attitude_walk_sd_deg), self.errors.position_walk_sd_m * self.state[Q]
        self.covariance[:G, :G] += np.diag(np.full(G, drift**2 * self.due_s))
        first = int(self.walked_s[1] > self.walked_s[0])
        for axis in (first, 1 - first)[: 2 if self.due_s > span_s else 1]:
            direction = np.zeros(D)
            if axis == 0:
                direction[A] = 1.0
            else:
                direction[G:D] = self.state[G:D]
            self.covariance += walk**2 * self.walked_s[axis] * np.outer(direction, direction)
            self.walked_s[axis] = 0.0
        self.due_s = 0.0

    def _doubt_height(self) -> None:
        """Removes information that a better known range made too strong; the height moves by the changes of down,
        which drift, and readings that scatter say less of it. The top counts from the altimeter's zero."""
        errors, q = self.errors, self.state[Q]
        if self.scale <= NARROW:
            begun = self._ground_variance(self.first_m2, max(self.scale, SCALE_MIN))
            excess = 1 / begun - 1 / self._ground_variance(self.first_m2)
            variance = self.full_covariance()[G, G]
            taken = min(variance, begun) * excess
            self.covariance[G, G] += variance * taken / (1 - taken)
            self.scale = 1.0
        before = self.taken_m2
        now = max(self.altimeter.sd_m**2, before + errors.position_walk_sd_m**2 * self.due_s)
        if now > before:
            direction = np.zeros(D)
            direction[[G, E]] = 1.0, -1.0
            self.covariance += (self.scale * q) ** 2 * (now - before) * np.outer(direction, direction)
            self.taken_m2, self.first_m2 = now, max(self.first_m2, now)

    def _height_rows(self, rows: Rows) -> Rows:
        """With the rows of the height: what a farther range made too weak, and what the readings added."""
        residual, slope = [], []
        if self.known and self.scale >= WIDE:
            gained = 1 / self._ground_variance(self.first_m2) - 1 / self._ground_variance(self.first_m2, self.scale)
            weight = np.sqrt(gained)
            residual.append(-weight * self.state[G])
            slope.append(weight * np.eye(COLUMNS)[G])
            self.scale = 1.0
        information, before = (1 / self._ground_variance(v) for v in (self.altimeter.sd_m**2, self.taken_m2))
        grown = information - before
        if self.known and grown > GROWN * information:
            weight, mean_m = np.sqrt(grown), self.altimeter.mean_m
            read_m = (information * mean_m - before * self.taken_mean_m) / grown
            residual.append(weight * (read_m * self.state[Q] - self.state[G]))
            slope.append(weight * (np.eye(COLUMNS)[G] - self.state[G] / self.state[Q] * np.eye(COLUMNS)[Q]))
            self.taken_m2, self.taken_mean_m = self.altimeter.sd_m**2, mean_m
        if not residual:
            return rows
        more = len(residual)
        return Rows(
            np.append(rows.side, np.full(more, -1)), np.append(rows.residual, residual), np.vstack([rows.slope, slope]),
            np.append(rows.own, np.ones(more)), np.vstack([rows.about, np.zeros((more, 3))]),
        )  # fmt: skip

    def _rows(self, sight: Sight, q_variance: float) -> Rows | None:
        """Residuals and derivatives as measured, and white variances that include the linearization error."""
        errors = self.errors
        seen = shown(sight, self.state, self.known)
        found = [visible_row_of(seen, self.state, i, seen.side[i]) for i in range(4) if np.isfinite(seen.side[i])]
        if not (rows := [row for row in found if row is not None]):
            return None
        side = np.array([row.side for row in rows])
        slope = np.array([row.slope for row in rows])
        by_place = slope[:, PX : PX + 3]
        slope[:, Q] += by_place @ (sure_way(sight.moved_m, errors.position_white_sd_m) - sight.moved_m) / self.state[Q]
        size = np.array([box_size(sight, self.state, row.side % 2) for row in rows])
        own = (errors.box_noise_px / focal_px(sight.camera)[side]) ** 2 + (SCATTER_SHARE * size) ** 2
        own += (errors.truncation_noise_rel * size) ** 2 if sight.cut else 0.0
        own += np.array([row.hidden for row in rows])
        ahead = max(1 - sight.moved_m[2] * self.state[Q], AHEAD_MIN)
        own += (slope[:, Q] * sight.moved_m[2] * q_variance / ahead) ** 2
        position_sd = errors.position_white_sd_m * np.sqrt(1 + q_variance / self.state[Q] ** 2)
        own += 2 * (position_sd * slope[:, PZ]) ** 2
        white = np.hypot(np.radians(errors.attitude_white_sd_deg), position_sd * self.state[Q] / ahead)
        residual = np.array([sight.side[row.side] - row.predicted for row in rows])
        nearer = max(ahead - sight.off_path_m[2] * self.state[Q], AHEAD_MIN)  # at the given place
        residual -= by_place @ sight.off_path_m * ahead / nearer
        by = slopes_with_velocity(slope, sight.time_s - self.start_s)
        return Rows(side, residual, by, own, white * slope[:, :3] @ sight.axes_from_body.T)

    def _whiten(self, sight: Sight, span_s: float, rows: Rows | None) -> None:
        errors = self.errors
        share = np.exp(-span_s / errors.box_correlation_time_s) if errors.box_correlation_time_s > 0 else 0.0
        for side, memory in enumerate(self.memory):
            memory.predict(share, (errors.box_noise_rel * box_size(sight, self.state, side % 2)) ** 2)
        for i, side in enumerate(() if rows is None else rows.side):
            memory = self.memory[side]
            rows.residual[i] -= memory.value
            rows.slope[i] -= memory.by
            rows.own[i] += memory.variance

    def _innovation2(self, rows: Rows, weight: np.ndarray) -> float:
        """Normalized square of a weighted sum of residuals, without the contribution of a walk along Z."""
        slope = weight @ rows.slope[:, :COUNT]
        variance = slope @ (self.settled + np.diag(self.gained)) @ slope + weight**2 @ rows.own
        variance += np.sum((weight @ rows.about) ** 2)
        return float((weight @ rows.residual) ** 2 / variance)

    def _judge(self, rows: Rows) -> np.ndarray:
        """(n,) normalized squares: of the middle residual of each image axis alone, of the others by their difference
        from it, since the attitude moves both; also alone if the middle one is itself an outlier."""
        result = np.zeros(len(rows.side))
        along_x = np.abs(rows.about[:, 1]) > np.abs(rows.about[:, 0])
        unit = np.eye(len(rows.side))
        for group in (np.flatnonzero(along_x), np.flatnonzero(~along_x)):
            if not len(group):
                continue
            order = group[np.argsort(rows.residual[group], kind="stable")]
            middle = order[len(order) // 2]
            other = order[len(order) // 2 - 1]
            if len(order) % 2 == 0 and abs(rows.residual[other]) < abs(rows.residual[middle]):
                middle = other
            result[middle] = self._innovation2(rows, unit[middle])
            common = result[middle] <= self.errors.gate_sigma**2
            for row in group[group != middle]:
                result[row] = self._innovation2(rows, unit[row] - unit[middle] if common else unit[row])
        return result

    def _update(self, rows: Rows, estimate_depth: bool) -> float:
        """Returns the normalized square of the residuals (nis) as expected with the depth as it is, or estimated."""
        count = COUNT if estimate_depth else D
        slope, noise = rows.slope[:, :count], rows.about @ rows.about.T + np.diag(rows.own)
        covariance = self.full_covariance() if estimate_depth else self.covariance
        expected = slope @ covariance @ slope.T + noise
        gain = np.linalg.solve(expected, slope @ covariance).T
        rest = np.eye(count) - gain @ slope
        self.by_velocity[:count] += gain @ (rows.slope[:, COUNT:] - rows.slope[:, :COUNT] @ self.by_velocity)
        covariance = rest @ covariance @ rest.T + gain @ noise @ gain.T
        if estimate_depth:
            self._divide(covariance)
        else:
            self.covariance = covariance
            self.by_depth = rest @ self.by_depth - gain @ rows.slope[:, D]
        self._move(gain @ rows.residual)
        return float(rows.residual @ np.linalg.solve(expected, rows.residual))

    def _move(self, change: np.ndarray) -> None:
        """Changes the first states, and what the sides' errors are at them."""
        before = self.state[Q]
        self.state = self.state + np.append(change, np.zeros(COUNT - len(change)))
        self.scale *= before / self.state[Q]
        self.state[D] = np.clip(self.state[D], -DEPTH_LIMIT, DEPTH_LIMIT)
        for memory in self.memory:
            memory.follow(change)

    def take(self, in_t: Sight) -> bool:
        """Takes an image; returns whether it was used."""
        self.doubted = self.refused = 0
        self.first_s = in_t.time_s if self.first_s is None else self.first_s
        started = self.state is not None
        since_s = min(in_t.time_s - self.time_s, GAP_MAX_S) if started else 0.0
        too_soon = started and in_t.time_s - self.rows_s < EARLY_SHARE * self.errors.box_correlation_time_s
        in_t = self.altimeter.read(in_t, started, 0.0 if too_soon else since_s)
        if too_soon or (not started and not self.start(in_t)):
            return False
        sight = in_t.turned(self.turn, self.origin_m)
        most_m = SURE_SIGMAS * self.errors.position_white_sd_m if started else 0.0
        sight = replace(sight, off_path_m=np.clip(sight.off_path_m, -most_m, most_m)).on_path()
        self.time_s = in_t.time_s
        q_variance = self.full_covariance()[Q, Q]
        self._wait(since_s)
        rows = self._rows(sight, q_variance)
        self._whiten(sight, since_s, rows)
        if rows is None:
            return False
        ratio = self._judge(rows)
        kept = ratio <= self.errors.gate_sigma**2
        self.refused = int((~kept).sum())
        self.doubted = int((kept & (ratio > self.errors.huber_sigma**2)).sum())
        factor = np.minimum(self.errors.huber_sigma / np.sqrt(np.maximum(ratio, 1e-30)), 1.0)
        names = ("side", "residual", "slope", "own", "about")
        rows.own = rows.own / factor
        poor = 2 * self.refused >= len(kept)
        self.scatter.take(rows.side, np.where(kept, rows.residual / np.sqrt(rows.own), 0.0))
        rows = Rows(*(getattr(rows, name)[kept] for name in names))
        if not kept.any():
            self.scatter.take_fit(RATIO_MOST)
            return False
        self.rows_s = in_t.time_s
        learn(self.memory, rows)
        self._doubt_height()
        self._age(since_s)
        rows = self._height_rows(rows)
        nis = self._update(rows, knows_depth(sight, self.state))
        self.scatter.take_fit(RATIO_MOST if poor else nis / len(rows.side))
        self.settled, self.gained = self.full_covariance(), np.zeros(COUNT)
        self.known = bool(np.sqrt(self.settled[Q, Q]) <= RANGE_SHARE * self.state[Q])
        return True

    # ----------------------------------------------------------------------------------------------------- quantities

    def report(self, in_t: Sight) -> tuple[np.ndarray, np.ndarray]:
        """(4,) X0, Z0, W, H and their sigmas, m. X0 and Z0 count from the track's first image."""
        errors = self.errors
        values = quantities(self.state, self.turn)
        slopes = quantity_slopes(self.state, self.turn)
        depth_sd = float(np.sqrt(self.depth_variance))
        reported = self.full_covariance(np.expm1(depth_sd) / depth_sd)  # the depth is exponential in its state
        variance = np.einsum("ij,jk,ik->i", slopes, reported, slopes) * self.scatter.factor()
        variance += errors.velocity_bias_sd_m_s**2 * ((slopes @ self.by_velocity) ** 2).sum(1)
        variance[3] += min(self.state[G] / self.state[Q], 0.0) ** 2  # hidden below it, or higher ground
        span_s, before_s = in_t.time_s - self.start_s, self.start_s - self.first_s
        variance[:2] += errors.position_walk_sd_m**2 * (span_s + before_s) + errors.position_white_sd_m**2
        variance[:2] += (errors.velocity_bias_sd_m_s * before_s) ** 2
        values[:2] += self.origin_m[[0, 2]]
        return values, np.sqrt(variance)


def follow(flight: Flight, errors: ErrorModel) -> PrismTrack:
    """The filter over all images of a flight with boxes."""
    prism = PrismFilter(errors)
    images = len(flight.time_s)
    values, sigma = np.full((images, 6), np.nan), np.full((images, 6), np.nan)
    fresh, doubted, refused = np.zeros(images, bool), np.zeros(images, int), np.zeros(images, int)
    for k, sight in enumerate(sights(flight, errors)):
        fresh[k] = prism.take(sight)
        doubted[k], refused[k] = prism.doubted, prism.refused
        if prism.state is not None:
            values[k, [0, 1, 3, 5]], sigma[k, [0, 1, 3, 5]] = prism.report(sight)
    return PrismTrack(values, sigma, fresh, doubted, refused)
