"""The library's arithmetic in float32, operation by operation, in the order of the C sources.

Every number is a numpy.float32 and every operation rounds to float32, so that the results carry the same bits as the
C library's, built with its own flags. One section per C file; the names are the C names without their prefix.
Decisions at thresholds are noted by name (Gates), so that the float64 reference can be compared decision by decision.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..logs.estimates import NUMBERS, Estimate
from ..logs.obslog import FEATURES, Camera, Frame
from .settings import Settings

F = np.float32
Decisions = dict[str, bool]

ZERO, HALF, ONE, TWO = F(0.0), F(0.5), F(1.0), F(2.0)


def magnitude(x: np.float32) -> int:
    """Bits of |x|, which order as the magnitudes do."""
    return int(F(x).view(np.uint32)) & 0x7FFFFFFF


def within(x: np.float32, limit: np.float32) -> bool:
    return magnitude(x) <= magnitude(limit)


def larger(a: np.float32, b: np.float32) -> np.float32:
    return a if a > b else b


# ---------------------------------------------------------------------------------------------------------- goe_angle.c

TAN_PI_8 = F(0.414213562)
ATAN = (F(0.333327567), F(0.199718793), F(0.138244538), F(0.0790259837))
SIN = (F(0.166666507), F(0.00833197866), F(0.000194956362))
COS = (F(0.0416666469), F(0.00138873675), F(2.44384516e-05))
QUARTER_PI_RAD, HALF_PI_RAD = F(0.785398163), F(1.57079633)
DEG_PER_RAD, RAD_PER_DEG = F(57.2957795), F(0.0174532925)
NINETY, HALF_TURN = F(90.0), F(180.0)
PER_NINETY = ONE / NINETY


def arctan_of_fraction(t: np.float32) -> np.float32:
    z = t * t
    return t - t * (z * (ATAN[0] - z * (ATAN[1] - z * (ATAN[2] - z * ATAN[3]))))


def arctan_of_unit(t: np.float32) -> np.float32:
    if t <= TAN_PI_8:
        return arctan_of_fraction(t)
    return QUARTER_PI_RAD + arctan_of_fraction((t - ONE) / (t + ONE))


def arctan_rad(y: np.float32, x: np.float32) -> np.float32:
    size = np.abs(y)
    angle = arctan_of_unit(size / x) if size <= x else HALF_PI_RAD - arctan_of_unit(x / size)
    return -angle if y < ZERO else angle


def sincos_deg(deg: np.float32) -> tuple[np.float32, np.float32]:
    quarter = int(deg * PER_NINETY + (-HALF if deg < ZERO else HALF))
    t = (deg - F(quarter) * NINETY) * RAD_PER_DEG
    z = t * t
    s = t - t * (z * (SIN[0] - z * (SIN[1] - z * SIN[2])))
    c = ONE - HALF * z + z * z * (COS[0] - z * (COS[1] - z * COS[2]))
    return ((s, c), (c, -s), (-s, -c), (-c, s))[quarter & 3]


def fold_deg(deg: np.float32) -> np.float32:
    if deg > NINETY:
        return deg - HALF_TURN
    return deg + HALF_TURN if deg <= -NINETY else deg


def note_end(taken: Decisions, name: str, deg: np.float32) -> np.float32:
    """Notes near which end of (-90, 90] an angle lies, if near any."""
    if abs(deg) > 45.0:
        taken[name] = bool(deg > ZERO)
    return deg


# ------------------------------------------------------------------------------------------------------- goe_rotation.c

Matrix = list[np.float32]  # 3 x 3, row by row


def rotation_from_quaternion(q: Sequence[np.float32]) -> Matrix:
    w, x, y, z = q
    s = TWO / (w * w + x * x + y * y + z * z)
    return [
        ONE - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
        s * (x * y + w * z), ONE - s * (x * x + z * z), s * (y * z - w * x),
        s * (x * z - w * y), s * (y * z + w * x), ONE - s * (x * x + y * y),
    ]  # fmt: skip


def rotation_from_euler(yaw_deg: np.float32, pitch_deg: np.float32, roll_deg: np.float32) -> Matrix:
    sy, cy = sincos_deg(yaw_deg)
    sp, cp = sincos_deg(pitch_deg)
    sr, cr = sincos_deg(roll_deg)
    return [
        cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,
        -sp, cp * sr, cp * cr,
    ]  # fmt: skip


def rotation_multiply(a: Matrix, b: Matrix) -> Matrix:
    return [
        a[3 * row] * b[column] + a[3 * row + 1] * b[3 + column] + a[3 * row + 2] * b[6 + column]
        for row in range(3)
        for column in range(3)
    ]


def rotation_apply(r: Matrix, v: Sequence[np.float32]) -> list[np.float32]:
    return [r[3 * row] * v[0] + r[3 * row + 1] * v[1] + r[3 * row + 2] * v[2] for row in range(3)]


# --------------------------------------------------------------------------------------------------------- goe_camera.c

UNDISTORT_ROUNDS = 20
UNDISTORT_DONE, UNDISTORT_FAILED = F(1.0e-7), F(1.0e-4)
RAY_LIMIT, RADIAL_MIN, RADIAL_MAX = F(20.0), F(0.05), F(1.0e6)


@dataclass
class Camera32:
    """The camera settings as floats."""

    fx: np.float32
    fy: np.float32
    cx: np.float32
    cy: np.float32
    k1: np.float32
    k2: np.float32
    p1: np.float32
    p2: np.float32
    k3: np.float32
    offset_m: list[np.float32]
    camera_to_body: Matrix


def camera_of(camera: Camera) -> Camera32:
    turn = rotation_from_euler(F(camera.mount_yaw_deg), F(camera.mount_pitch_deg), F(camera.mount_roll_deg))
    mounting = [turn[3 * row + column] for row in range(3) for column in (1, 2, 0)]
    numbers = [F(getattr(camera, name)) for name in ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")]
    return Camera32(*numbers, [F(camera.offset_x_m), F(camera.offset_y_m), F(camera.offset_z_m)], mounting)


def undistort(lens: Camera32, distorted_x: np.float32, distorted_y: np.float32) -> tuple[np.float32, np.float32] | None:
    x, y, step = distorted_x, distorted_y, ZERO
    for _ in range(UNDISTORT_ROUNDS):
        r2 = x * x + y * y
        radial = ONE + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))
        if not within(radial, RADIAL_MAX) or radial < RADIAL_MIN:
            return None
        tangential_x = TWO * lens.p1 * x * y + lens.p2 * (r2 + TWO * x * x)
        tangential_y = lens.p1 * (r2 + TWO * y * y) + TWO * lens.p2 * x * y
        next_x = (distorted_x - tangential_x) / radial
        next_y = (distorted_y - tangential_y) / radial
        if not within(next_x, RAY_LIMIT) or not within(next_y, RAY_LIMIT):
            return None
        step = larger(np.abs(next_x - x), np.abs(next_y - y))
        x, y = next_x, next_y
        if step <= UNDISTORT_DONE:
            break
    return (x, y) if step <= UNDISTORT_FAILED else None


def camera_ray(camera: Camera32, u_px: np.float32, v_px: np.float32) -> tuple[np.float32, np.float32] | None:
    x, y = (u_px - camera.cx) / camera.fx, (v_px - camera.cy) / camera.fy
    if any(magnitude(k) != 0 for k in (camera.k1, camera.k2, camera.p1, camera.p2, camera.k3)):
        return undistort(camera, x, y)
    return x, y


# ---------------------------------------------------------------------------------------------------------- goe_align.c

FORWARD_MIN = F(0.05)


@dataclass
class Point:
    x: np.float32
    y: np.float32
    u_px: np.float32
    v_px: np.float32


def align(
    camera: Camera32, camera_to_trajectory: Matrix, u_px: np.float32, v_px: np.float32
) -> tuple[str, Point | None]:
    ray = camera_ray(camera, u_px, v_px)
    if ray is None:
        return "lens_failed", None
    x, y = ray
    norm = np.sqrt(x * x + y * y + ONE)
    turned = rotation_apply(camera_to_trajectory, (x, y, ONE))
    if turned[2] <= FORWARD_MIN * norm:
        return "behind_camera", None
    return "ok", Point(turned[0] / turned[2], turned[1] / turned[2], u_px, v_px)


# ----------------------------------------------------------------------------------------------------- goe_projection.c

WIDTH_MIN = F(1.0e-4)
SIXTEENTH = ONE / F(16.0)


def projection_disc(left: Point, right: Point) -> tuple[np.float32, np.float32] | None:
    """(2): (xi, zeta), or None."""
    raw_size = right.x - left.x
    if not raw_size > WIDTH_MIN:
        return None
    cos_left = ONE / np.sqrt(ONE + left.x * left.x)
    cos_right = ONE / np.sqrt(ONE + right.x * right.x)
    size = raw_size * (cos_left + cos_right)
    x = HALF * (left.x + right.x) * (ONE - size * size * SIXTEENTH)
    zeta = TWO / size
    return x * zeta, zeta


def projection_turn(point: Point, s: np.float32, c: np.float32) -> np.float32 | None:
    """(4)"""
    forward = c + point.x * s
    if not forward > FORWARD_MIN * np.sqrt(ONE + point.x * point.x):
        return None
    return (point.x * c - s) / forward


# ----------------------------------------------------------------------------------------------------------- goe_edge.c


@dataclass
class Edge:
    left: Point
    right: Point
    counts: bool
    has_heading: bool
    heading_deg: np.float32


def heading_deg(a: Point, b: Point) -> np.float32:
    """(1)"""
    x = a.x * b.y - a.y * b.x
    z = b.y - a.y
    rad = arctan_rad(-x, -z) if z < ZERO else arctan_rad(x, z)
    return fold_deg(rad * DEG_PER_RAD)


# --------------------------------------------------------------------------------------------------------- goe_window.c

PARALLAX_MIN, LIMIT_M, SIGMA_LIMIT_M = F(1.0e-6), F(1.0e6), F(1.0e9)
COUNT_MAX = 32767


@dataclass
class Window:
    """A ring, as in C: the order of summation is the order in memory."""

    dx_m: list[np.float32]
    dz_m: list[np.float32]
    xi: list[np.float32]
    zeta: list[np.float32]
    next: int = 0
    count: int = 0

    @classmethod
    def of(cls, length: int) -> Window:
        return cls([ZERO] * length, [ZERO] * length, [ZERO] * length, [ZERO] * length)

    def add(self, dx_m: np.float32, dz_m: np.float32, row: tuple[np.float32, np.float32]) -> None:
        at, length = self.next, len(self.xi)
        self.dx_m[at], self.dz_m[at] = dx_m, dz_m
        self.xi[at], self.zeta[at] = row
        self.next = at + 1 if at + 1 < length else 0
        self.count = min(self.count + 1, COUNT_MAX)


@dataclass
class Fit:
    x0_m: np.float32
    z0_m: np.float32
    width_m: np.float32
    sigma_x0_m: np.float32
    sigma_z0_m: np.float32
    sigma_width_m: np.float32
    residual: np.float32
    baseline_m: np.float32


def bounded(sigma_m: np.float32) -> np.float32:
    return sigma_m if sigma_m < SIGMA_LIMIT_M else SIGMA_LIMIT_M


def window_solve(window: Window, min_baseline_m: np.float32, taken: Decisions) -> tuple[str, Fit | None]:
    """(5) in closed form."""
    length = len(window.xi)
    mean_dx = mean_dz = mean_xi = mean_zeta = ZERO
    largest_dz = window.dz_m[0]
    share = ONE / F(length)
    for k in range(length):
        mean_dx = mean_dx + window.dx_m[k]
        mean_dz = mean_dz + window.dz_m[k]
        mean_xi = mean_xi + window.xi[k]
        mean_zeta = mean_zeta + window.zeta[k]
        largest_dz = larger(largest_dz, window.dz_m[k])
    mean_dx, mean_dz, mean_xi, mean_zeta = mean_dx * share, mean_dz * share, mean_xi * share, mean_zeta * share
    spread_m2 = mixed_m = ZERO
    for k in range(length):
        x = window.dx_m[k] - mean_dx
        z = window.dz_m[k] - mean_dz
        spread_m2 = spread_m2 + (x * x + z * z)
        mixed_m = mixed_m + (x * (window.xi[k] - mean_xi) + z * (window.zeta[k] - mean_zeta))

    baseline_m = np.sqrt(spread_m2)
    taken["baseline"] = bool(baseline_m < min_baseline_m)
    if taken["baseline"]:
        return "no_baseline", None
    inverse_width = -mixed_m / spread_m2
    taken["parallax"] = bool(inverse_width * baseline_m <= PARALLAX_MIN * (ONE + np.abs(mean_xi) + np.abs(mean_zeta)))
    if taken["parallax"]:
        return "no_parallax", None
    width_m = ONE / inverse_width
    x0_m = width_m * mean_xi + mean_dx
    z0_m = width_m * mean_zeta + mean_dz
    taken["limit"] = not (within(width_m, LIMIT_M) and within(x0_m, LIMIT_M) and within(z0_m, LIMIT_M))
    if taken["limit"]:
        return "no_parallax", None
    taken["passed"] = bool(z0_m <= largest_dz)
    if taken["passed"]:
        return "passed", None

    squares = ZERO
    for k in range(length):
        x = (window.xi[k] - mean_xi) + inverse_width * (window.dx_m[k] - mean_dx)
        z = (window.zeta[k] - mean_zeta) + inverse_width * (window.dz_m[k] - mean_dz)
        squares = squares + (x * x + z * z)
    s2 = squares / F(2 * length - 3)
    mean = s2 / F(length)
    slope = width_m * width_m * (s2 / spread_m2)
    return "ok", Fit(
        x0_m,
        z0_m,
        width_m,
        bounded(width_m * np.sqrt(mean + mean_xi * mean_xi * slope)),
        bounded(width_m * np.sqrt(mean + mean_zeta * mean_zeta * slope)),
        bounded(width_m * np.sqrt(slope)),
        np.sqrt(squares / F(2 * length)),
        baseline_m,
    )


# ----------------------------------------------------------------------------------------------------------- goe_mean.c


@dataclass
class Mean:
    value: list[np.float32]
    next: int = 0
    count: int = 0

    def add(self, value: np.float32) -> tuple[np.float32, np.float32]:
        """Mean and its variance."""
        length = len(self.value)
        self.value[self.next] = value
        self.next = self.next + 1 if self.next + 1 < length else 0
        self.count = self.count + 1 if self.count < length else length
        n = self.count
        mean = squares = ZERO
        for k in range(n):
            mean = mean + self.value[k]
        mean = mean / F(n)
        for k in range(n):
            off = self.value[k] - mean
            squares = squares + off * off
        return mean, squares / F((n - 1) * n) if n > 1 else ZERO


# --------------------------------------------------------------------------------------------------------- goe_intake.c

POSITION_LIMIT_M, HEIGHT_LIMIT_M, PIXEL_LIMIT_PX, ATTITUDE_LIMIT = F(1.0e6), F(1.0e5), F(1.0e5), F(2.0)
NORM2_MIN, NORM2_MAX = F(0.99) * F(0.99), F(1.01) * F(1.01)
INFINITY_BITS = 0x7F800000


@dataclass
class Pose:
    time_us: int | None
    position_ned_m: list[np.float32]
    height_m: np.float32
    attitude: list[np.float32]


def intake_check(
    pose: Pose, pixels: dict[str, tuple[np.float32, np.float32]], last_time_us: int | None, taken: Decisions
) -> str:
    limits = [(pose.height_m, HEIGHT_LIMIT_M)]
    limits += [(value, POSITION_LIMIT_M) for value in pose.position_ned_m]
    limits += [(value, PIXEL_LIMIT_PX) for pixel in pixels.values() for value in pixel]
    q = pose.attitude
    if any(magnitude(value) >= INFINITY_BITS for value in [*q, *(value for value, _ in limits)]):
        return "not_finite"
    if any(magnitude(value) > magnitude(limit) for value, limit in limits):
        return "out_of_range"
    if pose.time_us is None or (last_time_us is not None and pose.time_us <= last_time_us):
        return "bad_time"
    if any(magnitude(value) > magnitude(ATTITUDE_LIMIT) for value in q):
        return "bad_attitude"
    norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]
    taken["attitude"] = bool(norm2 < NORM2_MIN or norm2 > NORM2_MAX)
    return "bad_attitude" if taken["attitude"] else "ok"


# ------------------------------------------------------------------------------------------------------ goe_estimator.c

LEVEL_NOSE_MIN = F(1.0e-3)
AMBIGUOUS_DEG = F(30.0)
QUARTER = F(0.25)


@dataclass
class View:
    """What one image contributes, on its way through the chain."""

    points: dict[str, Point] = field(default_factory=dict)
    edges: list[Edge] = field(default_factory=list)
    measured: bool = False
    front: Edge | None = None
    side: Edge | None = None
    side_is_right: bool = False
    turn_s: np.float32 = ZERO
    turn_c: np.float32 = ZERO
    faults: list[str] = field(default_factory=list)
    disc_row: bool = False
    line_row: bool = False


@dataclass
class Told:
    """The estimate that outlives an image; ``values`` by the output's column names."""

    model: str = "none"
    points: int = 0
    fresh: bool = False
    values: dict[str, np.float32] = field(default_factory=dict)
    residual: np.float32 = ZERO
    baseline_m: np.float32 = ZERO


class Mirror32:
    """One obstacle's estimator in float32."""

    def __init__(self, camera: Camera, settings: Settings | None = None) -> None:
        self.settings = settings or Settings()
        self.camera = camera_of(camera)
        self.heading_setting = None if camera.heading_deg is None else F(camera.heading_deg)
        window = self.settings.window
        self.started = False
        self.heading_cos = self.heading_sin = ZERO
        self.origin_ned_m = [ZERO] * 3
        self.dx_m = self.dz_m = ZERO
        self.time_us: int | None = None
        self.disc, self.line = Window.of(window), Window.of(window)
        self.length, self.height = Mean([ZERO] * window), Mean([ZERO] * window)
        self.filtered_deg = self.variance_deg2 = ZERO
        self.angles = 0
        self.told = Told()
        self.taken: Decisions = {}

    # goe_ego_motion.c

    def _follow(self, pose: Pose) -> Matrix:
        body_to_ned = rotation_from_quaternion(pose.attitude)
        arm = rotation_apply(body_to_ned, self.camera.offset_m)
        position = [pose.position_ned_m[i] + arm[i] for i in range(3)]
        if not self.started:
            self._fix_heading(body_to_ned)
            self.origin_ned_m = position
            self.started = True
        self.time_us = pose.time_us
        north = position[0] - self.origin_ned_m[0]
        east = position[1] - self.origin_ned_m[1]
        c, s = self.heading_cos, self.heading_sin
        self.dx_m = c * east - s * north
        self.dz_m = c * north + s * east
        camera_to_ned = rotation_multiply(body_to_ned, self.camera.camera_to_body)
        turned = [ZERO] * 9
        for i in range(3):
            north, east = camera_to_ned[i], camera_to_ned[3 + i]
            turned[i] = c * east - s * north
            turned[3 + i] = camera_to_ned[6 + i]
            turned[6 + i] = c * north + s * east
        return turned

    def _fix_heading(self, body_to_ned: Matrix) -> None:
        north, east = body_to_ned[0], body_to_ned[3]
        level = np.sqrt(north * north + east * east)
        if self.heading_setting is not None:
            self.heading_sin, self.heading_cos = sincos_deg(self.heading_setting)
            return
        self.taken["nose"] = bool(level < LEVEL_NOSE_MIN)
        if self.taken["nose"]:
            self.heading_cos, self.heading_sin = ONE, ZERO
        else:
            self.heading_cos, self.heading_sin = north / level, east / level

    # goe_align.c, goe_projection.c: rows

    def _align_view(self, turn: Matrix, pixels: dict[str, tuple[np.float32, np.float32]], view: View) -> None:
        for feature, (u_px, v_px) in pixels.items():
            fault, point = align(self.camera, turn, u_px, v_px)
            self.taken[f"lens:{feature}"] = fault != "lens_failed"
            if fault != "lens_failed":
                self.taken[f"behind:{feature}"] = fault == "behind_camera"
            if point is None:
                view.faults.append(fault)
            else:
                view.points[feature] = point

    def _add_disc_row(self, view: View) -> None:
        if self.settings.model == "line" or "left" not in view.points or "right" not in view.points:
            return
        row = projection_disc(view.points["left"], view.points["right"])
        self.taken["disc_width"] = row is not None
        if row is None:
            view.faults.append("swapped")
            return
        self.disc.add(self.dx_m, self.dz_m, row)
        view.disc_row = True

    def _turn_point(self, point: Point, view: View, name: str) -> np.float32 | None:
        x = projection_turn(point, view.turn_s, view.turn_c)
        self.taken[name] = x is not None
        return x

    def _line_row(self, front: Edge, view: View) -> tuple[np.float32, np.float32] | None:
        x_left = self._turn_point(front.left, view, "turn:front:left")
        if x_left is None:
            return None
        x_right = self._turn_point(front.right, view, "turn:front:right")
        if x_right is None:
            return None
        size = x_right - x_left
        self.taken["line_width"] = bool(size > WIDTH_MIN)
        if not self.taken["line_width"]:
            return None
        forward = ONE / size
        aside = HALF * (x_left + x_right) * forward
        c, s = view.turn_c, view.turn_s
        return c * aside + s * forward, c * forward - s * aside

    def _add_line_row(self, view: View) -> None:
        if not view.measured or view.front is None or not view.front.counts:
            return
        row = self._line_row(view.front, view)
        if row is None:
            view.faults.append("edge_on")
            return
        self.line.add(self.dx_m, self.dz_m, row)
        view.line_row = True

    # goe_edge.c

    def _find_edges(self, view: View) -> None:
        points = view.points
        for a, b in (("base_left", "base_near"), ("base_near", "base_right"), ("base_left", "base_right")):
            if a in points and b in points:
                name = f"order:{a}:{b}"
                self.taken[name] = bool(points[a].x <= points[b].x)
                if not self.taken[name]:
                    view.faults.append("swapped")
                    return
        pairs = [("base_left", "base_near"), ("base_near", "base_right")]
        if "base_near" not in points:
            pairs = [("base_left", "base_right")]
        for a, b in pairs:
            if a in points and b in points:
                view.edges.append(self._edge(points[a], points[b], f"{a}:{b}"))

    def _edge(self, left: Point, right: Point, name: str) -> Edge:
        du, dv = right.u_px - left.u_px, right.v_px - left.v_px
        rise_px = np.abs(right.y - left.y) * self.camera.fx
        edge_min, orientation_min = F(self.settings.edge_min_px), F(self.settings.orientation_min_px)
        counts = bool(du * du + dv * dv > edge_min * edge_min)
        self.taken[f"counts:{name}"] = counts
        has_heading = counts and bool(rise_px > orientation_min)
        if counts:
            self.taken[f"rises:{name}"] = has_heading
        heading = heading_deg(left, right) if has_heading else ZERO
        return Edge(left, right, counts, has_heading, heading)

    # goe_orientation.c

    def _hypothesis_deg(self, side: Edge | None, front: Edge | None) -> np.float32:
        if side is not None and side.has_heading:
            return side.heading_deg
        assert front is not None
        return fold_deg(front.heading_deg - NINETY)

    def _prefers_first(self, first_deg: np.float32, second_deg: np.float32) -> bool:
        first, second = np.abs(first_deg), np.abs(second_deg)
        if self.angles > 0:
            self.taken["ambiguous"] = bool(np.abs(first - second) < AMBIGUOUS_DEG)
            if self.taken["ambiguous"]:
                first = np.abs(fold_deg(first_deg - self.filtered_deg))
                second = np.abs(fold_deg(second_deg - self.filtered_deg))
        return bool(first <= second)

    def _orient(self, view: View) -> None:
        first = view.edges[0] if view.edges else None
        second = view.edges[1] if len(view.edges) > 1 else None
        if any(edge is not None and edge.has_heading for edge in (first, second)):
            if_first = self._hypothesis_deg(first, second)
            if_second = self._hypothesis_deg(second, first)
            first_is_side = self._prefers_first(if_first, if_second)
            self.taken["first_is_side"] = first_is_side
            view.measured = True
            view.side, view.front = (first, second) if first_is_side else (second, first)
            view.side_is_right = not first_is_side
            self._low_pass(note_end(self.taken, "end:measured", if_first if first_is_side else if_second))
        view.turn_s, view.turn_c = sincos_deg(self.filtered_deg)

    def _low_pass(self, measured_deg: np.float32) -> None:
        if self.angles > 0:
            step = note_end(self.taken, "end:step", fold_deg(measured_deg - self.filtered_deg))
            before = self.filtered_deg
        else:
            step, before = ZERO, measured_deg
        self.angles += 1 if self.angles < self.settings.orientation_memory else 0
        gain = ONE / F(self.angles)
        self.filtered_deg = note_end(self.taken, "end:filter", fold_deg(before + step * gain))
        self.variance_deg2 = self.variance_deg2 + (step * step - self.variance_deg2) * gain

    # goe_extent.c

    def _measure_length(self, view: View) -> None:
        values, c, s = self.told.values, view.turn_c, view.turn_s
        assert view.side is not None
        near = view.side.left if view.side_is_right else view.side.right
        far = view.side.right if view.side_is_right else view.side.left
        x_near = self._turn_point(near, view, "turn:side:near")
        x_far = self._turn_point(far, view, "turn:side:far") if x_near is not None else None
        if x_near is None or x_far is None:
            view.faults.append("edge_on")
            return
        min_x = F(self.settings.side_min_px) / self.camera.fx
        self.taken["aside:near"] = bool(np.abs(x_near) < min_x)
        self.taken["aside:far"] = bool(np.abs(x_far) < min_x)
        if self.taken["aside:near"] or self.taken["aside:far"] or bool(x_near < ZERO) != bool(x_far < ZERO):
            view.faults.append("edge_on")
            return
        inverse = ONE / x_far - ONE / x_near
        width = values["width_m"]
        half_m = HALF * width if view.side_is_right else -HALF * width
        side_m = values["x_m"] * c - values["z_m"] * s + half_m
        sigma_x, sigma_z, sigma_w = values["x_sd_m"], values["z_sd_m"], values["width_sd_m"]
        across_m2 = c * c * sigma_x * sigma_x + s * s * sigma_z * sigma_z + QUARTER * sigma_w * sigma_w
        self._take_extent(self.length, inverse * side_m, inverse * inverse * across_m2, "length")

    def _measure_height(self, view: View, height_m: np.float32) -> None:
        values, top = self.told.values, view.points["top"]
        if height_m <= ZERO:
            view.faults.append("bad_height")
            return
        sigma_m = top.y * values["z_sd_m"]
        self._take_extent(self.height, height_m - top.y * values["z_m"], sigma_m * sigma_m, "height")

    def _take_extent(self, mean: Mean, value_m: np.float32, variance_m2: np.float32, name: str) -> None:
        average, variance = mean.add(value_m)
        answers = bool(average > ZERO)
        self.taken[f"positive:{name}_m"] = answers
        if answers:
            self.told.values[f"{name}_m"] = average
            self.told.values[f"{name}_sd_m"] = np.sqrt(variance + variance_m2)
        else:
            self.told.values.pop(f"{name}_m", None)
            self.told.values.pop(f"{name}_sd_m", None)

    # goe_estimator.c

    def _solve(self, view: View) -> str:
        model = self.settings.model
        if model == "auto":
            needed = max(self.settings.line_points, self.settings.window)
            model = "line" if self.line.count >= needed else "disc"
        window = self.line if model == "line" else self.disc
        if window.count < self.settings.window:
            return "collecting"
        if not (view.line_row if model == "line" else view.disc_row):
            return "held"
        status, fit = window_solve(window, F(self.settings.min_baseline_m), self.taken)
        if fit is not None:
            told = self.told
            told.model, told.fresh, told.points = model, True, self.settings.window
            told.residual, told.baseline_m = fit.residual, fit.baseline_m
            told.values.update(
                x0_m=fit.x0_m,
                z0_m=fit.z0_m,
                width_m=fit.width_m,
                x0_sd_m=fit.sigma_x0_m,
                z0_sd_m=fit.sigma_z0_m,
                x_sd_m=fit.sigma_x0_m,
                z_sd_m=fit.sigma_z0_m,
                width_sd_m=fit.sigma_width_m,
            )
        return status

    def _follow_motion(self) -> None:
        values = self.told.values
        if "x0_m" in values:
            values["x_m"] = values["x0_m"] - self.dx_m
            values["z_m"] = values["z0_m"] - self.dz_m

    def _tell_orientation(self) -> None:
        if self.angles > 0:
            self.told.values["orientation_deg"] = self.filtered_deg
            self.told.values["orientation_sd_deg"] = np.sqrt(self.variance_deg2 / F(self.angles))

    def _tell_center(self, view: View) -> None:
        values, c, s = self.told.values, self.heading_cos, self.heading_sin
        if "x0_m" not in values or not (self.told.model == "disc" or "length_m" in values):
            for name in ("center_n_m", "center_n_sd_m", "center_e_m", "center_e_sd_m"):
                values.pop(name, None)
            return
        x_m, z_m = values["x0_m"], values["z0_m"]
        variance_x = values["x0_sd_m"] * values["x0_sd_m"]
        variance_z = values["z0_sd_m"] * values["z0_sd_m"]
        if self.told.model == "line":
            half_x, half_z = HALF * view.turn_s, HALF * view.turn_c
            length, sigma = values["length_m"], values["length_sd_m"]
            x_m = x_m + half_x * length
            z_m = z_m + half_z * length
            variance_x = variance_x + half_x * half_x * sigma * sigma
            variance_z = variance_z + half_z * half_z * sigma * sigma
        values["center_n_m"] = self.origin_ned_m[0] + (c * z_m - s * x_m)
        values["center_e_m"] = self.origin_ned_m[1] + (s * z_m + c * x_m)
        values["center_n_sd_m"] = np.sqrt(c * c * variance_z + s * s * variance_x)
        values["center_e_sd_m"] = np.sqrt(s * s * variance_z + c * c * variance_x)

    def _judge(self, view: View, seen: bool, solving: str) -> str:
        if solving == "ok":
            return "partial" if view.faults else "ok"
        if solving not in ("collecting", "held"):
            return solving
        if view.faults:
            return view.faults[0]
        if not seen:
            return "nothing_seen"
        if self.settings.model == "line" and view.edges and not view.line_row:
            return "no_edge"
        return solving

    def _take_image(self, pose: Pose, pixels: dict[str, tuple[np.float32, np.float32]]) -> str:
        view = View()
        self._align_view(self._follow(pose), pixels, view)
        self._add_disc_row(view)
        if self.settings.model != "disc":
            self._find_edges(view)
            self._orient(view)
            self._add_line_row(view)
        self.told.fresh = False
        solving = self._solve(view)
        self._follow_motion()
        self._tell_orientation()
        if solving == "ok":
            if self.told.model == "line" and view.front is not None and view.side is not None:
                self._measure_length(view)
            if "top" in view.points:
                self._measure_height(view, pose.height_m)
        self._tell_center(view)
        return self._judge(view, bool(pixels), solving)

    def update(self, frame: Frame) -> Estimate:
        """Takes one image. The decisions that were met are in ``taken`` afterwards."""
        self.taken = {}
        with np.errstate(all="ignore"):
            down = F(frame.position_m[2])
            pose = Pose(
                frame.time_us,
                [F(value) for value in frame.position_m],
                -down if frame.agl_m is None else F(frame.agl_m),
                [F(value) for value in frame.attitude],
            )
            seen = {feature: getattr(frame, feature) for feature in FEATURES}
            pixels = {feature: (F(pixel[0]), F(pixel[1])) for feature, pixel in seen.items() if pixel is not None}
            status = intake_check(pose, pixels, self.time_us, self.taken)
            if status == "ok":
                status = self._take_image(pose, pixels)
            else:
                self.told.fresh = False
        values = {name: self.told.values[name] for name in NUMBERS if name in self.told.values}
        return Estimate(status, self.told.model, self.told.points, values)
