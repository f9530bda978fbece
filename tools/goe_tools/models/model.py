"""Image points of a box or a disc, in float64, as a function of twelve states.

The model shares only the definition of the features with the library. The library uses analytic derivatives, this model
complex steps; a comparison detects errors of either one.

States (``STATES``), with T's origin at the camera of the track's first image and all obstacle lengths divided by
the range Z0, because early images are almost linear in these states:

    bx by bz  attitude: true = estimated, turned by the rotation vector b in body axes, rad
    dh        true minus measured height of the camera, m
    a q       X0/Z0 and 1/Z0 (1/m) of the reference position
    sx sz     lateral and depth extent of the box's side edge over Z0; a disc has none
    fx        lateral extent of its front edge over Z0; for a disc, diameter over Z0
    e         top above the altimeter's zero over Z0: (H - dh)/Z0
    vx vz     estimated minus true velocity over ground in T, m/s

Rows of one image (``ROW_FEATURE``): left and right give the distance of the measured point from the image of a vertical
edge, top that from a level edge, each base corner both coordinates; all in units of the focal length.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..flights.flight import BASE_LEFT, BASE_NEAR, BASE_RIGHT, LEFT, RIGHT, TOP, Flight
from ..flights.logged import from_log
from ..flights.noise import Noise
from ..flights.rotations import level_axes, matrices, mounting
from ..flights.scene import MIN_DEPTH_SHARE
from ..logs.obslog import Camera

STATES = ("bx", "by", "bz", "dh", "a", "q", "sx", "fx", "sz", "e", "vx", "vz")
BX, BY, BZ, DH, A, Q, SX, FX, SZ, E, VX, VZ = range(12)
NUISANCES = np.array([BX, BY, BZ, DH, VX, VZ])
ROW_FEATURE = np.array([LEFT, RIGHT, TOP, BASE_LEFT, BASE_LEFT, BASE_NEAR, BASE_NEAR, BASE_RIGHT, BASE_RIGHT])
BASES = (BASE_LEFT, BASE_NEAR, BASE_RIGHT)
ROWS = len(ROW_FEATURE)
COMPLEX_STEP = 1e-30
WEAK_SIGMA = 1e3  # of a state without a prior
KNOWN_SIGMA = 1e-7  # of an exact quantity: far below the information of any image, rad, m or m/s
LENS_ROUNDS = 20
CORNER_ALPHA = np.array([-0.5, -0.5, 0.5, 0.5])  # front left, back left, back right, front right:
CORNER_GAMMA = np.array([0.0, 1.0, 1.0, 0.0])  # place = reference + alpha * front edge + gamma * side edge
MAX_SINE = 0.98  # sine of a disc's half angle


# ------------------------------------------------------------------------------------------------------------ the view


def distorted(camera: Camera, point: np.ndarray) -> np.ndarray:
    x, y = point[..., 0], point[..., 1]
    r2 = x * x + y * y
    radial = 1 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3))
    u = x * radial + 2 * camera.p1 * x * y + camera.p2 * (r2 + 2 * x * x)
    v = y * radial + camera.p1 * (r2 + 2 * y * y) + 2 * camera.p2 * x * y
    return np.stack([u, v], -1)


def lens_slope(camera: Camera, point: np.ndarray) -> np.ndarray:
    """(..., 2, 2): derivative of the distorted point by the undistorted one."""
    columns = []
    for axis in range(2):
        step = np.zeros(2, complex)
        step[axis] = 1j * COMPLEX_STEP
        columns.append(distorted(camera, point + step).imag / COMPLEX_STEP)
    return np.stack(columns, -1)


def undistort(camera: Camera, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Undistorted, normalized points (..., 2) of pixels, and their derivative (..., 2, 2) by the pixel, 1/px."""
    focal = np.array([camera.fx, camera.fy])
    wanted = (pixel - [camera.cx, camera.cy]) / focal
    point = wanted.copy()
    if any((camera.k1, camera.k2, camera.p1, camera.p2, camera.k3)):
        for _ in range(LENS_ROUNDS):  # Newton's method
            error = distorted(camera, point) - wanted
            point = point - np.linalg.solve(lens_slope(camera, point), error[..., None])[..., 0]
    return point, np.linalg.inv(lens_slope(camera, point)) / focal


@dataclass
class View:
    """A flight's K images as rays, with the estimated motion."""

    box: bool
    time_s: np.ndarray  # (K,) since the first image
    point: np.ndarray  # (K, 6, 2) undistorted, in units of the focal length, camera axes
    spread: np.ndarray  # (K, 6, 2, 2) covariance of a point for a pixel noise of 1 px
    seen: np.ndarray  # (K, 6)
    t_from_body: np.ndarray  # (K, 3, 3) estimated
    body_from_camera: np.ndarray  # (3, 3)
    dx_m: np.ndarray  # (K,) camera since the first image, estimated, T axes
    dz_m: np.ndarray
    height_m: np.ndarray  # (K,)
    width: np.ndarray  # (K,) of the obstacle in the image, units of the focal length; 0: unknown
    image: np.ndarray  # (2, 2) corners of the image, pixels over focal length
    top_is_highest: bool


def view_of(flight: Flight) -> View:
    camera = flight.camera
    t_from_ned = level_axes(flight.heading_rad)
    ned_from_body = matrices(flight.attitude)
    offset = np.array([camera.offset_x_m, camera.offset_y_m, camera.offset_z_m])
    eye = flight.position_ned_m + ned_from_body @ offset
    moved = (eye - eye[0]) @ t_from_ned.T
    point, slope = undistort(camera, flight.pixel_px)
    t_from_body, body_from_camera = t_from_ned @ ned_from_body, mounting(camera)
    ray = np.concatenate([point, np.ones((*point.shape[:2], 1))], -1)
    ahead = np.einsum("kj,knj->kn", (t_from_body @ body_from_camera)[:, 2], ray)
    seen = flight.seen & (ahead > MIN_DEPTH_SHARE * np.linalg.norm(ray, axis=-1))
    both = seen[:, LEFT] & seen[:, RIGHT]
    width = np.where(both, np.linalg.norm(point[:, RIGHT] - point[:, LEFT], axis=-1), 0.0)
    focal = np.array([camera.fx, camera.fy])
    margins = np.array([[0.0, 0.0], [camera.width, camera.height]])
    image = (margins - [camera.cx, camera.cy]) / focal
    return View(
        flight.truth.kind == "box", flight.time_s - flight.time_s[0], point, slope @ np.swapaxes(slope, -1, -2), seen,
        t_from_body, body_from_camera, moved[:, 0], moved[:, 2], flight.height_m, width, image, flight.top_is_highest,
    )  # fmt: skip


# --------------------------------------------------------------------------------------------------- state and outputs


def true_state(flight: Flight) -> np.ndarray:
    """(12,): the true obstacle, with zero nuisance states."""
    truth = flight.truth
    return state_of(truth.values, truth.kind == "box")


def state_of(values: np.ndarray, box: bool) -> np.ndarray:
    """(12,) state of x0, z0, orientation (rad), width, length, height."""
    x0, z0, angle, width, length, height = values
    state = np.zeros(len(STATES))
    state[[A, Q, FX, E]] = x0 / z0, 1 / z0, width / z0, height / z0
    state[SZ] = width / z0
    if box:
        state[[SX, FX, SZ]] = np.array([length * np.sin(angle), width * np.cos(angle), length * np.cos(angle)]) / z0
    return state


def quantities(state: np.ndarray, box: bool) -> np.ndarray:
    """x0, z0, orientation (rad), width, length, height of states (..., 12); works for complex states."""
    a, q, sx, fx, sz, e, dh = (state[..., i] for i in (A, Q, SX, FX, SZ, E, DH))
    if not box:
        return np.stack([a / q, 1 / q, 0 * q, fx / q, fx / q, e / q + dh], -1)
    length = np.sqrt(sx * sx + sz * sz)
    return np.stack([a / q, 1 / q, np.arctan(sx / sz), fx * length / sz / q, length / q, e / q + dh], -1)


def quantity_slopes(state: np.ndarray, box: bool) -> np.ndarray:
    """(6, 12): derivative of ``quantities`` by the state."""
    return quantities(state + 1j * COMPLEX_STEP * np.eye(len(STATES)), box).imag.T / COMPLEX_STEP


# ---------------------------------------------------------------------------------------------------- correspondences


@dataclass
class Corners:
    """The point of the obstacle behind each feature."""

    index: np.ndarray  # (K, 6) corner of the box, index of ``CORNER_ALPHA``
    usable: np.ndarray  # (K, 6)
    top_near: np.ndarray  # (K,) whether a disc's top is its rim's nearest point, not its farthest


def _camera_in_box(view: View, state: np.ndarray) -> tuple[np.ndarray, ...]:
    """Camera relative to the reference position along width and length axis (K,), and width and length, all over Z0."""
    sx, fx, sz = state[[SX, FX, SZ]]
    length = np.hypot(sx, sz)
    px, pz = state[A] - view.dx_m * state[Q], 1 - view.dz_m * state[Q]
    across = -(sz * px - sx * pz) / length
    along = -(sx * px + sz * pz) / length
    return across, along, fx * length / sz, length


FACE_CORNERS = np.array(  # left, near, right in the image; -1: none. Faces front, right, back, left, then two at once
    [[0, -1, 3], [3, -1, 2], [2, -1, 1], [1, -1, 0], [0, 3, 2], [3, 2, 1], [2, 1, 0], [1, 0, 3]]
)


def _rays(view: View, state: np.ndarray, corner: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Rays in camera axes (K, 3), with the estimated attitude, to a corner of the box ``height`` (K,) below the
    camera."""
    alpha, gamma = CORNER_ALPHA[corner], CORNER_GAMMA[corner]
    x = state[A] - view.dx_m * state[Q] + alpha * state[FX] + gamma * state[SX]
    z = 1 - view.dz_m * state[Q] - alpha * state[FX] * state[SX] / state[SZ] + gamma * state[SZ]
    return np.einsum("kji,kj->ki", view.t_from_body @ view.body_from_camera, np.stack([x, height, z], -1))


def _face_codes(view: View, state: np.ndarray) -> np.ndarray:
    """(K,): row of ``FACE_CORNERS``, from the geometry and from the visibility of a near corner."""
    across, along, width, length = _camera_in_box(view, state)
    front, right = -along > along - length, across > 0
    depth, side = np.where(front, -along, along - length), np.abs(across) - 0.5 * width
    two = np.where(front, np.where(right, 4, 7), np.where(right, 5, 6))
    one = np.where(depth > side, np.where(front, 0, 2), np.where(right, 1, 3))
    both = (depth > 0) & (side > 0)
    codes = np.where(view.seen[:, BASE_NEAR] | both, two, one)
    near = FACE_CORNERS[two, 1]
    ray = _rays(view, state, near, (view.height_m + state[DH]) * state[Q])
    with np.errstate(divide="ignore", invalid="ignore"):
        image = ray[:, :2] / ray[:, 2:]
    inside = ((image > view.image[0]) & (image < view.image[1])).all(1) & (ray[:, 2] > 0)
    shown = both & inside & ~view.seen[:, BASE_NEAR] & view.seen[:, BASE_LEFT] & view.seen[:, BASE_RIGHT]
    return np.where(shown, one, codes)  # without a near corner only one face is visible


def _highest_corners(view: View, state: np.ndarray) -> np.ndarray:
    """(K,): corner of the roof that is highest in the image."""
    rays = [_rays(view, state, np.full(len(view.time_s), i), view.height_m * state[Q] - state[E]) for i in range(4)]
    slopes = [np.where(ray[:, 2] > 0, ray[:, 1] / ray[:, 2], np.inf) for ray in rays]
    return np.argmin(slopes, 0)


def _below_roof(view: View, state: np.ndarray) -> np.ndarray:
    """(K,): whether the camera is lower than the top; then near points are high in the image."""
    return view.height_m * state[Q].real < state[E].real


def correspond(view: View, state: np.ndarray) -> Corners:
    """The corners behind the features, for a state."""
    index = np.zeros(view.seen.shape, int)
    usable = view.seen.copy()
    top_near = _below_roof(view, state) if view.top_is_highest else np.full(len(usable), True)
    if not view.box:
        usable[:, BASE_LEFT:] = False
        return Corners(index, usable, top_near)
    shown = FACE_CORNERS[_face_codes(view, state)]
    index[:, [BASE_LEFT, BASE_NEAR, BASE_RIGHT]] = np.maximum(shown, 0)
    usable[:, BASE_NEAR] &= shown[:, 1] >= 0
    index[:, LEFT], index[:, RIGHT] = shown[:, 0], shown[:, 2]
    across, along, _, length = _camera_in_box(view, state)
    index[:, TOP] = np.where(along < 0.5 * length, np.where(across > 0, 3, 0), np.where(across > 0, 2, 1))
    if view.top_is_highest:
        index[:, TOP] = _highest_corners(view, state)
    return Corners(index, usable, top_near)


# --------------------------------------------------------------------------------------------------------------- rows


def turn(b: np.ndarray) -> np.ndarray:
    """Rotation matrices (..., 3, 3) of small rotation vectors (..., 3), also complex: exact rotations, with an angle
    error of the third power / 12."""
    w, (x, y, z) = 1.0, np.moveaxis(b / 2, -1, 0)
    n = w + x * x + y * y + z * z
    rows = [
        [w + x * x - y * y - z * z, 2 * (x * y - z), 2 * (x * z + y)],
        [2 * (x * y + z), w - x * x + y * y - z * z, 2 * (y * z - x)],
        [2 * (x * z - y), 2 * (y * z + x), w - x * x - y * y + z * z],
    ]
    return np.stack([np.stack(row, -1) for row in rows], -2) / n[..., None, None]


def _distance_from_line(point: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Signed distance (..., K) of image points (K, 2) from the images of lines; ``normal``: (..., K, 3), of the plane
    through the line and the camera, in camera axes."""
    dot = point[..., 0] * normal[..., 0] + point[..., 1] * normal[..., 1] + normal[..., 2]
    return dot / np.sqrt(normal[..., 0] ** 2 + normal[..., 1] ** 2)


def _disc_places(px: np.ndarray, pz: np.ndarray, fx: np.ndarray, near: np.ndarray) -> tuple[np.ndarray, ...]:
    """Directions (x, z) of the left and the right tangent, and depth of the rim's nearest or farthest point."""
    distance = np.sqrt(px * px + pz * pz)
    sine = 0.5 * fx / distance
    sine = np.where(sine.real > MAX_SINE, MAX_SINE, sine)
    cosine = np.sqrt(1 - sine * sine)
    lx, lz = px * cosine - pz * sine, pz * cosine + px * sine
    rx, rz = px * cosine + pz * sine, pz * cosine - px * sine
    return lx, lz, rx, rz, pz * np.where(near, 1 - sine, 1 + sine)


def residuals(view: View, corners: Corners, state: np.ndarray) -> np.ndarray:
    """Measured minus predicted (..., K, ROWS) for states (..., 12), real or complex; meaningless for unusable
    features."""
    s = [state[..., i, None] for i in range(len(STATES))]
    px = s[A] - (view.dx_m - s[VX] * view.time_s) * s[Q]
    pz = 1 - (view.dz_m - s[VZ] * view.time_s) * s[Q]
    ground, top = (view.height_m + s[DH]) * s[Q], view.height_m * s[Q] - s[E]
    true_from_camera = turn(state[..., :3]) @ view.body_from_camera
    camera_from_t = np.swapaxes(view.t_from_body @ true_from_camera[..., None, :, :], -1, -2)
    zero = np.zeros_like(px)

    def in_camera_axes(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
        return np.einsum("...ij,...j->...i", camera_from_t, np.stack(np.broadcast_arrays(x, y, z), -1))

    def corner(feature: int) -> tuple[np.ndarray, np.ndarray]:
        alpha, gamma = CORNER_ALPHA[corners.index[:, feature]], CORNER_GAMMA[corners.index[:, feature]]
        return px + alpha * s[FX] + gamma * s[SX], pz - alpha * s[FX] * s[SX] / s[SZ] + gamma * s[SZ]

    result = np.empty((*px.shape, ROWS), px.dtype)
    if view.box:
        (lx, lz), (rx, rz), (_, tz) = corner(LEFT), corner(RIGHT), corner(TOP)
    else:
        lx, lz, rx, rz, tz = _disc_places(px, pz, s[FX], corners.top_near)
    result[..., 0] = _distance_from_line(view.point[:, LEFT], in_camera_axes(lz, zero, -lx))
    result[..., 1] = _distance_from_line(view.point[:, RIGHT], in_camera_axes(rz, zero, -rx))
    result[..., 2] = _distance_from_line(view.point[:, TOP], in_camera_axes(zero, tz, -top))
    result[..., 3:] = 0
    if view.box:
        for number, feature in enumerate(BASES):
            x, z = corner(feature)
            ray = in_camera_axes(x, ground, z)
            result[..., 3 + 2 * number : 5 + 2 * number] = view.point[:, feature] - ray[..., :2] / ray[..., 2:]
    return result


def jacobian(view: View, corners: Corners, state: np.ndarray) -> np.ndarray:
    """(K, ROWS, 12): derivative of the prediction, that is, of minus the residuals, by complex steps."""
    steps = state + 1j * COMPLEX_STEP * np.eye(len(STATES))
    return np.moveaxis(-residuals(view, corners, steps).imag / COMPLEX_STEP, 0, -1)


def _line_directions(view: View, state: np.ndarray) -> np.ndarray:
    """(K, 3, 2): unit vectors perpendicular to the images of left, right and top edge, camera axes. The edge's place is
    only a second-order effect, so the measured point replaces it."""
    camera_from_t = np.swapaxes(view.t_from_body @ turn(state[:3]) @ view.body_from_camera, -1, -2)
    rays = np.concatenate([view.point[:, :3], np.ones((len(view.time_s), 3, 1))], -1)
    in_t = np.einsum("kji,knj->kni", camera_from_t, rays)
    zero = np.zeros(len(view.time_s))
    normals = [np.stack([in_t[:, i, 2], zero, -in_t[:, i, 0]], -1) for i in (0, 1)]
    normals.append(np.stack([zero, in_t[:, 2, 2], -in_t[:, 2, 1]], -1))
    across = np.einsum("kij,knj->kni", camera_from_t, np.stack(normals, 1))[..., :2]
    return across / np.linalg.norm(across, axis=-1, keepdims=True)


def covariances(view: View, slopes: np.ndarray, state: np.ndarray, noise: Noise) -> np.ndarray:
    """(K, ROWS, ROWS): covariance of one image's rows from pixel noise, noise proportional to the obstacle's image, and
    the attitude's white noise, which moves all points of an image together. ``slopes``: from ``jacobian``."""
    images = len(view.time_s)
    spread = noise.sigma_px**2 * view.spread
    result = np.zeros((images, ROWS, ROWS))
    across = _line_directions(view, state)
    own = np.einsum("kni,knij,knj->kn", across, spread[:, :3], across)
    share = np.hypot(noise.size_share, 0.0 if view.box else noise.shape_error_rel)
    own += (share * view.width[:, None]) ** 2
    result[:, range(3), range(3)] = own
    for number, feature in enumerate(BASES):
        rows = slice(3 + 2 * number, 5 + 2 * number)
        result[:, rows, rows] = spread[:, feature]
    result *= (1 + noise.correlation) / (1 - noise.correlation)
    shaken = slopes[..., :3]
    return result + np.radians(noise.attitude_white_sd_deg) ** 2 * shaken @ np.swapaxes(shaken, -1, -2)


def prior_sigmas(noise: Noise, box: bool) -> np.ndarray:
    """(12,): sigma of each state before the first image."""
    sigma = np.full(len(STATES), WEAK_SIGMA)
    sigma[:3] = max(np.radians(noise.attitude_bias_sd_deg), KNOWN_SIGMA)
    sigma[DH] = max(noise.height_m, KNOWN_SIGMA)
    sigma[[VX, VZ]] = max(noise.velocity_bias_sd_m_s, KNOWN_SIGMA)
    if not box:
        sigma[[SX, SZ]] = KNOWN_SIGMA
    return sigma


def row_mask(use: np.ndarray) -> np.ndarray:
    """(K, ROWS): rows of the used features (K, 6)."""
    return use[:, ROW_FEATURE]


def masked(matrix: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Covariances (K, ROWS, ROWS) with unused rows replaced by unit rows."""
    both = rows[:, :, None] & rows[:, None, :]
    return np.where(both, matrix, np.eye(ROWS))


def whitened(matrix: np.ndarray, rows: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Rows (K, ROWS) or (K, ROWS, n) times the inverse Cholesky factor of the covariances, flattened; 0 if unused."""
    columns = values[..., None] if values.ndim == 2 else values
    columns = np.where(rows[..., None], columns, 0.0)
    white = np.linalg.solve(np.linalg.cholesky(masked(matrix, rows)), columns)
    return white.reshape(-1, columns.shape[-1]) if values.ndim == 3 else white.reshape(-1)


def logged_flights(folder: Path, kind: str | None = None) -> list[Flight]:
    """``from_log``, after deciding the meaning of the log's ``top``: the one that agrees better with the truth."""
    result = []
    for flight in from_log(folder, kind):
        errors = {}
        for highest in (False, True):
            view, state = view_of(replace(flight, top_is_highest=highest)), true_state(flight)
            rows = residuals(view, correspond(view, state), state)[view.seen[:, TOP], 2]
            errors[highest] = float(np.abs(rows).sum())
        result.append(replace(flight, top_is_highest=errors[True] < errors[False]))
    return result
