"""Model of the sides of an upright bounding box around an upright obstacle, in float64, independent of the library.

The obstacle is a prism over a horizontal ellipse. Its footprint about the middle M, (X, Z) in the axes, is the image of
the unit disc under a triangular matrix,

    {M + L v: |v| <= 1}         L = [[w, 0], [s, D]]         D = w e^d

w is the half width across the axes' Z. The shear s is how much deeper the right end (v = (1, 0)) lies than the middle.
D is the half depth along Z where s = 0. Every ellipse has one such L with w, D > 0, the Cholesky root of L L': for half
axes l1, l2 along the columns of a rotation R, L L' = R diag(l1^2, l2^2) R'. The footprint may therefore be turned.

A side of the box is an image line; the plane through it and the camera touches the prism at its foot or its roof. With
the plane's outward normal n, in level axes (X, Y down, Z) at the camera, and u = (nX, nZ)/|(nX, nZ)|, the touching
point is

    (X, Z) = M + L v          v = L' u/h(u)      h(u) = |L' u| = sqrt((w uX + s uZ)^2 + (D uZ)^2)
    Y      = ground if nY > 0, otherwise roof

h is the support function of the ellipse. v is where h(u) = u L v is largest, so that to first order the touching point
keeps its v. All lengths are in units of Z0, the range of the middle at the filter's start; the camera at that time is
the origin:

    M = (a - dX q, 1 - dZ q)        ground = height q + g        roof = height q - e

dX, dZ: motion of the camera since then, m; height: of the camera, from the first image's height and the changes of
down, m.

States (``STATES``):

    bx by bz  attitude: true = estimated, turned by the rotation vector b in body axes, rad; to first order
    g         true minus given height of the camera, over Z0
    a q       X0/Z0 and 1/Z0 (1/m) of the middle
    e         top above the altimeter's zero, over Z0
    s         shear, over Z0
    w         half width over Z0
    d         log of the depth D over the half width

The position error of the camera (``PX``, ``PY``, ``PZ``: m, same axes) is not a state, but derivatives by it are
given, too. All derivatives use complex steps, to detect errors in the library's formulas."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from ..flights.flight import Flight
from ..flights.rotations import level_axes, matrices, mounting
from ..library import MODEL_AUTO, MODEL_DISC
from ..logs.obslog import Camera
from .model import COMPLEX_STEP, distorted, lens_slope
from .path import off_path

STATES = ("bx", "by", "bz", "g", "a", "q", "e", "s", "w", "d")
BX, BY, BZ, G, A, Q, E, S, W, D, PX, PY, PZ = range(13)
UNKNOWNS = 13  # states and position
BOX_LEFT, BOX_TOP, BOX_RIGHT, BOX_BOTTOM = range(4)
AXIS = np.array([0, 1, 0, 1])  # of each side's image coordinate
OUTWARD = np.array([-1.0, -1.0, 1.0, 1.0])
AHEAD_MIN = 0.02  # of a touching point, units of Z0
LEVEL_MIN = 1e-6  # horizontal part of a normal
CUT_SIGMAS = 3.0  # of box_noise_rel: top and bottom this near to the border may be cut
LEANS = 0.2  # tangent of a lean beyond which two borders cut the same end
HIDDEN_VARIANCE = 16 / 3  # of half the edge squared: uniform, in 16 images that share it
EXACT_ROUNDS = 60
EXACT = 1e-15  # focal lengths
SECTION_OF = {  # section of each setting; default: navigation
    **dict.fromkeys(("box_noise_px", "box_noise_rel", "box_correlation_time_s", "truncation_noise_rel"), "detector"),
    **dict.fromkeys(("border_rel", "truncation_rel"), "camera"),
    **dict.fromkeys(("prior_width_m", "gate_sigma", "huber_sigma"), "filter"),
}


@dataclass(frozen=True)
class ErrorModel:
    """The configured errors of boxes and navigation; the defaults are the library's."""

    box_noise_px: float = 1.0  # of a side, white
    box_noise_rel: float = 0.07  # of a side, share of the box's width or height, correlated ...
    box_correlation_time_s: float = 1.2  # ... over this time
    truncation_noise_rel: float = 1.0  # of every side of a box cut by the border, same share
    border_rel: float = 0.012  # sides nearer to the border are not used, share of the image's width
    truncation_rel: float = 0.04  # a left or right side nearer to it marks the box as cut
    attitude_bias_sd_deg: float = 0.5
    attitude_white_sd_deg: float = 0.1
    attitude_walk_sd_deg: float = 0.0  # per sqrt(s)
    height_bias_sd_m: float = 0.5
    height_white_sd_m: float = 0.5  # of a reading of the altimeter
    terrain_height_sd_m: float = 2.0  # of the obstacle's terrain height
    terrain_slope_sd: float = 0.01  # of the ground between aircraft and obstacle at first sight
    velocity_bias_sd_m_s: float = 0.05
    position_walk_sd_m: float = 0.05  # per sqrt(s)
    position_white_sd_m: float = 0.0
    prior_width_m: float = 6.0
    gate_sigma: float = 5.0
    huber_sigma: float = 2.5
    disc: bool = False  # depth equals width

    def ground_sd(self, q: float) -> float:
        """One sigma of the first height above the obstacle's ground, units of Z0 = 1/q."""
        parts = [self.height_bias_sd_m, self.height_white_sd_m, self.terrain_height_sd_m, self.terrain_slope_sd / q]
        return float(np.linalg.norm(parts) * q)

    def settings(self) -> dict[str, float]:
        """The library's settings, by name."""
        result = {f"{SECTION_OF.get(f.name, 'navigation')}.{f.name}": getattr(self, f.name) for f in fields(self)}
        del result["navigation.disc"]
        return {**result, "model": float(MODEL_DISC if self.disc else MODEL_AUTO)}


# ------------------------------------------------------------------------------------------------------------ the view


@dataclass(frozen=True)
class Sight:
    """An image, in level axes: those of T or of a filter. Sides in the order left, top, right, bottom."""

    time_s: float
    camera: Camera
    side: np.ndarray  # (4,) raw coordinates, focal lengths; NaN where not measured
    doubtful: np.ndarray  # (4,) whether the border may have cut it: top and bottom
    cut: bool  # left or right is missing, or near the border
    axes_from_camera: np.ndarray  # (3, 3) estimated
    axes_from_body: np.ndarray
    moved_m: np.ndarray  # (3,) camera since the axes' origin
    off_path_m: np.ndarray  # (3,) place minus that on the smoothed path
    height_m: float  # of the camera above ground, from the first height and the changes of down
    given_height_m: float
    image_height_px: float  # 0: not known

    def turned(self, turn: np.ndarray, origin_m: np.ndarray) -> Sight:
        """The image in axes with another direction and origin."""
        return Sight(
            self.time_s, self.camera, self.side, self.doubtful, self.cut,
            turn @ self.axes_from_camera, turn @ self.axes_from_body,
            turn @ (self.moved_m - origin_m), turn @ self.off_path_m,
            self.height_m, self.given_height_m, self.image_height_px,
        )  # fmt: skip

    def on_path(self) -> Sight:
        """The image from the place on the smoothed path."""
        moved_m = self.moved_m - self.off_path_m
        return replace(self, moved_m=moved_m, height_m=self.height_m + self.off_path_m[1])


def focal_px(camera: Camera) -> np.ndarray:
    """(4,) by side."""
    return np.array([camera.fx, camera.fy, camera.fx, camera.fy])


def measured_sides(
    box_px: np.ndarray, image_size_px: tuple[float, float], errors: ErrorModel, rolled: np.ndarray | bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """Sides (K, 4), NaN if out of order or at the border, and whether the border cuts the box (K,).

    rolled: (K,) whether the image leans so much that the borders above and below cut the obstacle's ends, too.
    """
    sides = np.array(box_px, float)
    with np.errstate(invalid="ignore"):
        swapped = (sides[:, BOX_LEFT] >= sides[:, BOX_RIGHT]) | (sides[:, BOX_TOP] >= sides[:, BOX_BOTTOM])
        sides[swapped] = np.nan
        last = np.array(image_size_px)[AXIS] - 1

        def near(share: float) -> np.ndarray:
            distance = share * image_size_px[0]
            return (last > 0) & ((sides < distance) | (sides > last - distance))

        cut = near(max(errors.border_rel, errors.truncation_rel)) | ~np.isfinite(sides)
        sides[near(errors.border_rel)] = np.nan
    return sides, cut[:, [BOX_LEFT, BOX_RIGHT]].any(1) | (rolled & cut[:, [BOX_TOP, BOX_BOTTOM]].any(1))


def doubtful_sides(box_px: np.ndarray, image_height_px: float, errors: ErrorModel) -> np.ndarray:
    """(K, 4): top and bottom so near to the border that it may have cut them."""
    share = CUT_SIGMAS * errors.box_noise_rel
    last = image_height_px - 1
    top, bottom = box_px[:, BOX_TOP], box_px[:, BOX_BOTTOM]
    doubtful = np.zeros(box_px.shape, bool)
    doubtful[:, BOX_TOP] = (last > 0) & np.isfinite(bottom) & (top < share * bottom)
    doubtful[:, BOX_BOTTOM] = (last > 0) & np.isfinite(top) & (last - bottom < share * (last - top))
    return doubtful


def sights(flight: Flight, errors: ErrorModel) -> list[Sight]:
    """The images of a flight with boxes, in T: axes at the camera of the first image."""
    if flight.box_px is None:
        raise ValueError(f"{flight.name}: has no boxes")
    camera = flight.camera
    t_from_ned, ned_from_body = level_axes(flight.heading_rad), matrices(flight.attitude)
    eye = flight.position_ned_m + ned_from_body @ [camera.offset_x_m, camera.offset_y_m, camera.offset_z_m]
    moved = (eye - eye[0]) @ t_from_ned.T
    off = off_path(flight.time_s, flight.position_ned_m @ t_from_ned.T)
    t_from_body = t_from_ned @ ned_from_body
    t_from_camera = t_from_body @ mounting(camera)
    down = np.abs(t_from_camera[:, 1])
    px, cut = measured_sides(flight.box_px, flight.image_size_px, errors, down[:, 0] > LEANS * down[:, 1])
    doubtful = doubtful_sides(flight.box_px, flight.image_size_px[1], errors)
    side = (px - np.array([camera.cx, camera.cy])[AXIS]) / focal_px(camera)
    return [
        Sight(
            float(t), camera, side[k], doubtful[k], bool(cut[k]), t_from_camera[k], t_from_body[k], moved[k],
            off[k],
            float(flight.height_m[0] - moved[k, 1]), float(flight.height_m[k]), float(flight.image_size_px[1]),
        )
        for k, t in enumerate(flight.time_s)
    ]  # fmt: skip


# ---------------------------------------------------------------------------------------------------------- the prism


@dataclass(frozen=True)
class Touch:
    """The point where a plane touches."""

    v: np.ndarray  # (2,) on the unit circle
    foot: bool


def _reach(unknowns: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """L' u of the footprint, (...) each; ``unknowns``: (..., 13), ``u``: (..., 2)."""
    across = unknowns[..., W] * u[..., 0] + unknowns[..., S] * u[..., 1]
    return across, unknowns[..., W] * np.exp(unknowns[..., D]) * u[..., 1]


def support(unknowns: np.ndarray, u: np.ndarray) -> np.ndarray:
    """h(u) = |L' u| of the footprint; ``unknowns``: (..., 13), also complex."""
    across, along = _reach(unknowns, u)
    return np.sqrt(across**2 + along**2)


def rim_point(unknowns: np.ndarray, u: np.ndarray) -> np.ndarray:
    """(..., 2): the ellipse's farthest point along u, from its middle: L L' u/h, the gradient of the support
    function. Also for complex unknowns."""
    across, along = _reach(unknowns, u)
    deep = unknowns[..., W] * np.exp(unknowns[..., D])
    point = np.stack([unknowns[..., W] * across, unknowns[..., S] * across + deep * along], -1)
    return point / np.sqrt(across**2 + along**2)[..., None]


def in_camera(sight: Sight, unknowns: np.ndarray, touch: Touch) -> np.ndarray:
    """(..., 3): the touching point in the camera's axes at the estimated attitude; also for complex unknowns."""
    a, q, g, e = (unknowns[..., i] for i in (A, Q, G, E))
    dx, dy, dz = (sight.moved_m[i] + unknowns[..., PX + i] for i in range(3))
    w, s, d = (unknowns[..., i] for i in (W, S, D))
    height = (sight.height_m - (dy - sight.moved_m[1])) * q
    y = height + g if touch.foot else height - e
    x = a - dx * q + w * touch.v[0]
    z = 1 - dz * q + s * touch.v[0] + w * np.exp(d) * touch.v[1]
    point = np.stack([x, y, z], -1)
    return (point + np.cross(unknowns[..., :3] @ sight.axes_from_body.T, point)) @ sight.axes_from_camera


def _touch(sight: Sight, state: np.ndarray, normal: np.ndarray, foot: bool | None) -> Touch:
    """Touching point of the plane with this outward normal, in the estimated camera's axes. ``foot`` None: either."""
    n = sight.axes_from_camera @ normal
    n = n - np.cross(sight.axes_from_body @ state[:3], n)
    level = np.hypot(n[0], n[2])
    u = n[[0, 2]] / level if level > LEVEL_MIN else np.array([0.0, -1.0])
    return Touch(np.stack(_reach(state, u)) / support(state, u), bool(n[1] > 0) if foot is None else foot)


def has_lens(camera: Camera) -> bool:
    return any((camera.k1, camera.k2, camera.p1, camera.p2, camera.k3))


def _normal(side: int, at: float) -> np.ndarray:
    """Normal of the plane through the vertical or level line at a coordinate, without a lens."""
    normal = np.zeros(3)
    normal[AXIS[side]], normal[2] = 1.0, -at
    return OUTWARD[side] * normal


def _bent_touch(sight: Sight, state: np.ndarray, side: int, at: float, foot: bool) -> tuple[Touch, float]:
    """With a lens: uses the direction of the line at the straight line's touching point. Also returns the outward
    offset."""
    touch = _touch(sight, state, _normal(side, at), foot)
    point_m = in_camera(sight, state, touch)
    point = point_m[:2] / point_m[2]
    slope = lens_slope(sight.camera, point)[AXIS[side]]
    touch = _touch(sight, state, OUTWARD[side] * np.array([*slope, -slope @ point]), foot)
    return touch, OUTWARD[side] * float(coordinate(sight, state, side, touch))


def touching(sight: Sight, state: np.ndarray, side: int, at: float) -> Touch:
    """The point where the side at the raw coordinate ``at`` touches the obstacle of the state (13,)."""
    if not has_lens(sight.camera):
        return _touch(sight, state, _normal(side, at), None)
    return max((_bent_touch(sight, state, side, at, foot) for foot in (True, False)), key=lambda pair: pair[1])[0]


def coordinate(sight: Sight, unknowns: np.ndarray, side: int, touch: Touch) -> np.ndarray:
    """Raw coordinate (...) of the touching point across the side, focal lengths; also for complex unknowns."""
    point_m = in_camera(sight, unknowns, touch)
    return distorted(sight.camera, point_m[..., :2] / point_m[..., 2:])[..., AXIS[side]]


@dataclass(frozen=True)
class Row:
    side: int
    predicted: float  # focal lengths
    slope: np.ndarray  # (13,) derivative by the unknowns
    hidden: float = 0.0  # variance of an end that no level side shows, focal lengths squared


def row_of(sight: Sight, state: np.ndarray, side: int, at: float) -> Row | None:
    """Prediction and derivative of a measured side at the state (10,); None if it touches behind the camera."""
    unknowns = np.concatenate([state, np.zeros(UNKNOWNS - len(state))])
    touch = touching(sight, unknowns, side, at)
    if not in_camera(sight, unknowns, touch)[2] >= AHEAD_MIN:
        return None
    steps = unknowns + 1j * COMPLEX_STEP * np.eye(UNKNOWNS)
    slope = coordinate(sight, steps, side, touch).imag / COMPLEX_STEP
    return Row(side, float(coordinate(sight, unknowns, side, touch)), slope)


def is_beyond(sight: Sight, unknowns: np.ndarray, touch: Touch, border: int) -> bool:
    """Whether the touching point lies above the image (top) or below it (bottom), through the lens."""
    y_px = float(coordinate(sight, unknowns, BOX_TOP, touch)) * sight.camera.fy + sight.camera.cy
    return y_px < 0.0 if border == BOX_TOP else y_px > sight.image_height_px


def shown(sight: Sight, state: np.ndarray, is_placed: bool) -> Sight:
    """The image without the doubtful sides that the border cuts: until the position is known, or where the obstacle
    reaches beyond the border."""
    unknowns = np.concatenate([state, np.zeros(UNKNOWNS - len(state))])
    side = sight.side.copy()
    for i in np.flatnonzero(sight.doubtful & np.isfinite(side)):
        touch = touching(sight, unknowns, i, side[i])
        is_ahead = in_camera(sight, unknowns, touch)[2] >= AHEAD_MIN
        if not (is_placed and is_ahead) or is_beyond(sight, unknowns, touch, i):
            side[i] = np.nan
    return replace(sight, side=side)


def is_outside(sight: Sight, unknowns: np.ndarray, side: int, at: float) -> bool:
    """Whether the end of the upright edge that left or right touches lies outside the image, beyond the opposite level
    side, which is not measured. Then the side ends where the border crosses the roof or the base."""
    end = touching(sight, unknowns, side, at)
    border = BOX_TOP if end.foot else BOX_BOTTOM
    if np.isfinite(sight.side[border]) or not sight.image_height_px > 0:
        return False
    return is_beyond(sight, unknowns, end, border)


def visible_row_of(sight: Sight, state: np.ndarray, side: int, at: float) -> Row | None:
    """Like ``row_of``, unless no level side shows the end that a left or right side touches. Then the visible part may
    end anywhere between foot and roof: the row takes the middle and has no derivative by the heights, (R27a). None if
    the edge lies outside the image."""
    row = row_of(sight, state, side, at)
    if row is None or AXIS[side] == 1:
        return row
    unknowns = np.concatenate([state, np.zeros(UNKNOWNS - len(state))])
    if is_outside(sight, unknowns, side, at):
        return None
    foot = touching(sight, unknowns, side, at).foot
    if np.isfinite(sight.side[BOX_BOTTOM if foot else BOX_TOP]):
        return row
    slope = row.slope.copy()
    end = G if foot else E
    by_y = slope[end] * (1.0 if foot else -1.0)  # Y = height q + g, or height q - e
    slope[end] = 0.0
    slope[Q] -= by_y * sight.height_m
    slope[PY] += by_y * unknowns[Q]
    half_edge = 0.5 * (unknowns[G] + unknowns[E]) * (-1.0 if foot else 1.0)  # from the end down to the middle
    moved = by_y * half_edge
    return Row(side, row.predicted + moved, slope, HIDDEN_VARIANCE * moved**2)


def exact_side(sight: Sight, unknowns: np.ndarray, side: int, guess: float) -> float:
    """Raw coordinate of the side of the box around the obstacle: a line through its own touching point."""
    at = guess
    for _ in range(EXACT_ROUNDS):
        before, at = at, float(coordinate(sight, unknowns, side, touching(sight, unknowns, side, at)))
        if abs(at - before) < EXACT:
            break
    return at


def box_size(sight: Sight, state: np.ndarray, axis: int) -> float:
    """Width (axis 0) or height (1) of the box, focal lengths: measured if possible, otherwise predicted."""
    measured = sight.side[axis + 2] - sight.side[axis]
    if np.isfinite(measured):
        return float(measured)
    ahead = max(1 - sight.moved_m[2] * state[Q], AHEAD_MIN)
    return max(state[E] + state[G] if axis else 2 * state[W], 0.0) / ahead


def turned(sight: Sight, state: np.ndarray) -> float:
    """Sine of the angle by which the line of sight to the middle has turned since the axes' start; negative for
    a camera that passes to the right."""
    first = np.array([state[A], 1.0])
    now = first - sight.moved_m[[0, 2]] * state[Q]
    return float((now[0] * first[1] - now[1] * first[0]) / (np.linalg.norm(first) * np.linalg.norm(now)))


def quantities(state: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """(..., 4): X0, Z0 from the axes' origin, W, H, in m, of states (..., 10); turn: (3, 3) T -> the state's axes."""
    a, q, g, w, e = (state[..., i] for i in (A, Q, G, W, E))
    place = np.stack([a / q, 0 * q, 1 / q], -1) @ turn
    return np.stack([place[..., 0], place[..., 2], 2 * w / q, (e + g) / q], -1)


def quantity_slopes(state: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """(4, 10): derivative of ``quantities`` by the state."""
    return quantities(state + 1j * COMPLEX_STEP * np.eye(len(STATES)), turn).imag.T / COMPLEX_STEP
