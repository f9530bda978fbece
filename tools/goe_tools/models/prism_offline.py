"""Maximum likelihood fit of a prism to the upright bounding boxes of all images of a track at once, in float64: a
reference optimum for recursive estimators.

Levenberg-Marquardt steps estimate the states of ``prism`` and a constant error of the velocity over ground.
With r the residuals of all measured sides, N their covariance and p the prior sigmas,

    cost = r' N^-1 r + sum (state/p)^2

Every side is linearized at its touching point for the latest state; N, which depends on the derivatives, is recomputed
until the fit converges. It is the covariance of ``prism_bound`` plus the random walks in the data,

    + position_walk^2 min(t_i, t_j) J_p J_p' + attitude_drift^2 min(t_i, t_j) J_b J_b'      t: since the first image

so each side's errors are whitened over its whole series. Errors of attitude, height and velocity, the shear s and the
depth d have the library's priors; place and sizes have almost none, while the library has a weak first guess. The fit
estimates d if at the last image the line of sight has turned as far as the library requires (``DEPTH_TURNED``).
Otherwise d is a consider parameter fixed at 0: with z = d state / d d of the fit,

    covariance of the states = (J' N^-1 J + diag(p^-2))^-1 + z z' var(d)

Three margins of the library are left out: a white share of each side, a yaw error that represents the velocity error,
and the reduced weight of sides that do not fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..flights.flight import Flight
from .bound import inverse
from .model import COMPLEX_STEP, KNOWN_SIGMA, distorted, lens_slope
from .prism import (
    AXIS,
    LEVEL_MIN,
    OUTWARD,
    PX,
    STATES,
    UNKNOWNS,
    A,
    D,
    E,
    ErrorModel,
    G,
    Q,
    Row,
    S,
    Sight,
    W,
    quantities,
    quantity_slopes,
    rim_point,
    sights,
)
from .prism_bound import COUNT, ORDER, VX, VZ, noise_of_rows, prior_sigmas
from .prism_filter import PrismFilter, footprint_sds, knows_depth

ROUNDS = 4  # most rounds of computing the covariance and fitting
MAX_STEPS = 60  # in a round
FARTHER, FARTHER_ROUNDS = 0.8, 20  # for a first guess that the camera passes: factor on 1/Z0
AHEAD_MIN = 1e-3  # range of a touching point, units of Z0
TOUCHING_ROUNDS = 30
TOUCHING = 1e-10  # rad: convergence of the touching points
NEAREST = np.array([0.0, -1.0])  # direction of the rim point nearest to the camera
SETTLED = 1e-4  # size of a step, in sigmas of the states, that ends a round ...
STAYED = 1e-2  # ... and size of a round that ends the fit
DAMPING, DAMPING_MIN, DAMPING_MAX = 1e-3, 1e-12, 1e12  # of the steps, relative to the information's diagonal
EASED, HARDENED = 0.1, 10.0  # its factors after a step that lowers the cost, and after another one


@dataclass
class PrismFit:
    """Six quantities with sigmas, NaN except for X0, Z0, W, H, and details of the fit."""

    values: np.ndarray  # (6,)
    sigma: np.ndarray  # (6,)
    state: np.ndarray  # (12,) in the track's axes
    cost: float  # of the state, with the last covariance
    rows: int
    steps: int


class Track:
    """All measured sides of a flight as arrays of n rows, in axes that point at the obstacle from the first image that
    measures left and right. States: (12,) as in ``prism_bound``."""

    def __init__(self, flight: Flight, errors: ErrorModel) -> None:
        self.errors, prism = errors, PrismFilter(errors)
        images = sights(flight, errors)
        first = (prism.altimeter.read(sight, False, 0.0) for sight in images)
        if not any(prism.start(sight) for sight in first):  # stops at the first that starts
            raise ValueError(f"{flight.name}: no image measures left and right of a box ahead")
        self.turn, self.origin_m, self.start_s = prism.turn, prism.origin_m, prism.start_s
        self.first_guess = np.append(prism.state, [0.0, 0.0])
        self.footprint_sd = footprint_sds(errors, self.first_guess[W])  # of s, d
        self.estimates_depth = False
        self.camera = flight.camera
        used = [sight.turned(self.turn, self.origin_m) for sight in images if sight.time_s >= self.start_s]
        self.sight: list[Sight] = [s for s in used for _ in range(int(np.isfinite(s.side).sum()))]
        self.side = np.concatenate([np.flatnonzero(np.isfinite(s.side)) for s in used])
        self.measured = np.concatenate([s.side[np.isfinite(s.side)] for s in used])
        self.since_s = np.array([s.time_s for s in self.sight]) - self.start_s
        self.moved_m = np.array([s.moved_m for s in self.sight])
        self.height_m = np.array([s.height_m for s in self.sight])
        self.axes_from_camera = np.array([s.axes_from_camera for s in self.sight])
        self.axes_from_body = np.array([s.axes_from_body for s in self.sight])
        self.sign, self.axis = OUTWARD[self.side], AXIS[self.side]
        self.row = np.arange(len(self.side))
        self.at_measured = np.where(np.arange(2) == self.axis[:, None], self.measured[:, None], 0.0)

    def start(self) -> np.ndarray:
        """The first guess, moved farther away if it is not ahead of all images."""
        state = self.first_guess.copy()
        for _ in range(FARTHER_ROUNDS):
            if self.predicted(state) is not None:
                break
            state[Q] *= FARTHER
        return state

    def decide(self, state: np.ndarray) -> np.ndarray:
        """Decides at a state whether to estimate the depth. Returns the state, with d = 0 if not."""
        self.estimates_depth = knows_depth(self.sight[-1], state)
        result = state.copy()
        result[D] *= self.estimates_depth
        return result

    # --------------------------------------------------------------------------------------------------- measurements

    def unknowns(self, state: np.ndarray) -> np.ndarray:
        """(n, 13) of ``prism``: the reported path is too long by velocity times time."""
        result = np.zeros((len(self.side), UNKNOWNS))
        result[:, : len(STATES)] = state[: len(STATES)]
        result[:, [PX, PX + 2]] = -self.since_s[:, None] * state[[VX, VZ]]
        return result

    def _rim_point(self, unknowns: np.ndarray, u: np.ndarray, foot: np.ndarray) -> np.ndarray:
        """(..., n, 3): the rim's farthest point along u (..., n, 2), in the camera's axes; also for complex
        unknowns."""
        a, q, g, e = (unknowns[..., i] for i in (A, Q, G, E))
        rim, shift = rim_point(unknowns, u), unknowns[..., PX:]
        height = (self.height_m - shift[..., 1]) * q
        x = a - (self.moved_m[:, 0] + shift[..., 0]) * q + rim[..., 0]
        z = 1 - (self.moved_m[:, 2] + shift[..., 2]) * q + rim[..., 1]
        point = np.stack([x, np.where(foot, height + g, height - e), z], -1)
        turn = np.einsum("nij,...nj->...ni", self.axes_from_body, unknowns[..., :3])
        return np.einsum("...ni,nij->...nj", point + np.cross(turn, point), self.axes_from_camera)

    def _level_normal(self, unknowns: np.ndarray, point: np.ndarray) -> np.ndarray:
        """(..., n, 2): outward normal of the plane through the side's line at an image point (..., n, 2), without a
        lens."""
        slope = lens_slope(self.camera, point)[..., self.row, self.axis, :]
        normal = np.concatenate([slope, -(slope * point).sum(-1, keepdims=True)], -1) * self.sign[:, None]
        normal = np.einsum("nij,...nj->...ni", self.axes_from_camera, normal)
        normal = normal - np.cross(np.einsum("nij,nj->ni", self.axes_from_body, unknowns[:, :3]), normal)
        level = np.hypot(normal[..., 0], normal[..., 2])[..., None]
        return np.where(level > LEVEL_MIN, normal[..., [0, 2]] / np.maximum(level, LEVEL_MIN), NEAREST)

    def _coordinate(self, point: np.ndarray) -> np.ndarray:
        """(..., n) coordinate across each row's side, focal lengths."""
        return distorted(self.camera, point[..., :2] / point[..., 2:])[..., self.row, self.axis]

    def _touching(self, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
        """Direction u (n, 2) of each side's touching point, whether it is at the foot (n,), and its coordinate (n,):
        the outer one of the touching points with the rims of foot and roof. None if one of them is not ahead of the
        camera."""
        foot = np.repeat([[True], [False]], len(self.side), 1)
        u = np.broadcast_to(self._level_normal(unknowns, self.at_measured), (*foot.shape, 2))
        for _ in range(TOUCHING_ROUNDS):
            point = self._rim_point(unknowns, u, foot)
            if not (point[..., 2] > AHEAD_MIN).all():
                return None
            before, u = u, self._level_normal(unknowns, point[..., :2] / point[..., 2:])
            if np.abs(u - before).max() < TOUCHING:
                break
        at = self._coordinate(point)
        outer = np.argmax(self.sign * at, 0)
        return u[outer, self.row], foot[outer, self.row], at[outer, self.row]

    def predicted(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """All sides (n,), focal lengths, and their derivatives (n, 13) by the unknowns; None if the state is not an
        obstacle ahead of the camera."""
        if not (state[[Q, W]] > 0).all():
            return None
        unknowns = self.unknowns(state)
        found = self._touching(unknowns)
        if found is None:
            return None
        u, foot, at = found
        steps = unknowns + 1j * COMPLEX_STEP * np.eye(UNKNOWNS)[:, None]
        return at, self._coordinate(self._rim_point(steps, u, foot)).imag.T / COMPLEX_STEP

    # ------------------------------------------------------------------------------------------------------- the noise

    def covariance(self, state: np.ndarray, predicted: np.ndarray, slope: np.ndarray) -> np.ndarray:
        """(n, n) covariance of all rows."""
        rows = [(s, Row(int(i), float(p), d)) for s, i, p, d in zip(self.sight, self.side, predicted, slope)]
        result = noise_of_rows(rows, state[: len(STATES)], self.errors)
        passed = np.minimum(self.since_s[:, None], self.since_s)
        result += self.errors.position_walk_sd_m**2 * passed * (slope[:, PX:] @ slope[:, PX:].T)
        drift = np.radians(self.errors.attitude_walk_sd_deg)
        return result + drift**2 * passed * (slope[:, :3] @ slope[:, :3].T)

    def priors(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Residuals (12,) of the priors, and their derivatives (12, 12). The height's sigma is configured in meters,
        except that of the slope, and g is in units of Z0."""
        sigma = prior_sigmas(state[: len(STATES)], self.errors)
        sigma[S] = self.footprint_sd[0]
        if self.estimates_depth:
            sigma[D] = self.footprint_sd[1]
        slope = np.diag(1 / sigma)
        if sigma[G] > KNOWN_SIGMA:
            in_meters = 1 - (self.errors.terrain_slope_sd / sigma[G]) ** 2  # share of the variance
            slope[G, Q] = -in_meters * state[G] / (sigma[G] * state[Q])
        return state / sigma, slope

    def by_states(self, slope: np.ndarray) -> np.ndarray:
        """(n, 12) from derivatives (n, 13) by the unknowns; 0 by a depth that is not estimated."""
        result = np.zeros((len(slope), COUNT))
        result[:, : len(STATES)] = slope[:, : len(STATES)]
        result[:, D] *= self.estimates_depth
        result[:, [VX, VZ]] = -self.since_s[:, None] * slope[:, [PX, PX + 2]]
        return result

    def whitening(self, state: np.ndarray) -> np.ndarray:
        """(n, n): makes the rows' errors independent with variance 1, for the covariance at a state."""
        found = self.predicted(state)
        if found is None:
            raise ValueError("the state is not an obstacle ahead of the camera")
        return np.linalg.inv(np.linalg.cholesky(self.covariance(state, *found)))

    def residuals(self, state: np.ndarray, whitening: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """Residuals of all rows and priors (n + 12,), and their derivatives (n + 12, 12) by the states."""
        found = self.predicted(state)
        if found is None:
            return None
        predicted, slope = found
        prior, prior_slope = self.priors(state)
        white, white_slope = whitening @ (predicted - self.measured), whitening @ self.by_states(slope)
        return np.append(white, prior), np.concatenate([white_slope, prior_slope])

    def cost(self, state: np.ndarray, whitening: np.ndarray) -> float:
        """Infinite if the state is not an obstacle ahead of the camera."""
        found = self.residuals(state, whitening)
        return np.inf if found is None else float(found[0] @ found[0])


# -------------------------------------------------------------------------------------------------------------- the fit


def _settle(track: Track, state: np.ndarray, whitening: np.ndarray) -> tuple[np.ndarray, int]:
    """Levenberg-Marquardt steps with this covariance; also returns their number."""
    found = track.residuals(state, whitening)
    if found is None:
        raise ValueError("the start is not an obstacle ahead of the camera")
    damping = DAMPING
    for number in range(1, MAX_STEPS + 1):
        left, slope = found
        information = slope.T @ slope
        scale = 1 / np.sqrt(np.diag(information))
        scaled = information * scale[:, None] * scale
        while damping <= DAMPING_MAX:
            change = scale * np.linalg.solve(scaled + damping * np.eye(COUNT), -scale * (slope.T @ left))
            tried = track.residuals(state + change, whitening)
            if tried is not None and tried[0] @ tried[0] <= left @ left:
                break
            damping *= HARDENED
        else:
            return state, number  # no step lowers the cost
        damping = max(EASED * damping, DAMPING_MIN)
        moved = slope @ change
        state, found = state + change, tried
        if moved @ moved < SETTLED**2:
            return state, number
    return state, MAX_STEPS


def fit(flight: Flight, errors: ErrorModel, start: np.ndarray | None = None) -> PrismFit:
    """Fits a flight with boxes. ``start``: a state in the axes of ``Track``, by default the library's first guess."""
    track = Track(flight, errors)
    state = track.start() if start is None else np.array(start, float)
    steps = 0
    for _ in range(ROUNDS):
        state = track.decide(state)
        before, whitening = state, track.whitening(state)
        state, more = _settle(track, before, whitening)
        steps += more
        moved = track.residuals(state, whitening)[1] @ (state - before)
        if moved @ moved < STAYED**2:
            break
    return _fit_result(track, state, steps)


def _considering(
    track: Track, state: np.ndarray, whitening: np.ndarray, slope: np.ndarray, inner: np.ndarray
) -> np.ndarray:
    """(12, 12) covariance with the depth considered. ``inner``: the covariance for a known depth, of the fit with the
    derivatives ``slope``."""
    by_depth = whitening @ track.predicted(state)[1][:, D]
    change = -inner @ (slope[: len(by_depth)].T @ by_depth)
    change[D] = 1.0
    return inner + track.footprint_sd[1] ** 2 * np.outer(change, change)


def _fit_result(track: Track, state: np.ndarray, steps: int) -> PrismFit:
    whitening = track.whitening(state)
    left, slope = track.residuals(state, whitening)
    inner = inverse(slope.T @ slope)
    covariance = inner if track.estimates_depth else _considering(track, state, whitening, slope, inner)
    outer = np.zeros((len(ORDER), COUNT))
    outer[:, : len(STATES)] = quantity_slopes(state[: len(STATES)], track.turn)
    values, sigma = np.full(6, np.nan), np.full(6, np.nan)
    values[ORDER] = quantities(state[: len(STATES)], track.turn)
    values[ORDER[:2]] += track.origin_m[[0, 2]]
    sigma[ORDER] = np.sqrt(np.einsum("ij,jk,ik->i", outer, covariance, outer))
    return PrismFit(values, sigma, state, float(left @ left), len(track.side), steps)
