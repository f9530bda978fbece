"""One obstacle's estimator: the paper's chain from an image to an estimate, step by step."""

from __future__ import annotations

import math

import numpy as np
from goe_tools.logs.estimates import NUMBERS, QUANTITIES, Estimate, sigma_name
from goe_tools.logs.obslog import FEATURES, Camera, Frame

from ..gates import UNIT_ROUNDOFF, Gates
from ..settings import Settings
from .fit import Mean, Ring, Row, solve
from .geometry import (
    Lens,
    Matrix,
    Point,
    apply,
    disc_row,
    mounting_rotation,
    multiply,
    quaternion_rotation,
    undistort,
)
from .orientation import POINT_ROUNDOFF, Orientation, find_edges
from .precision import DType, Real, Rounding, numbers
from .view import Edge, Report, View

POSITION_LIMIT_M, HEIGHT_LIMIT_M, PIXEL_LIMIT_PX, ATTITUDE_LIMIT = 1e6, 1e5, 1e5, 2.0
BEFORE = "before:"  # prefix for decisions of a view that is discarded when the track restarts
SIGMA_NAMES = {quantity: sigma_name(quantity) for quantity in QUANTITIES}


class WindowMethod:
    """One obstacle's estimator, in float64 or float32. Call it with one frame after the other."""

    def __init__(self, camera: Camera, settings: Settings | None = None, dtype: DType = np.float64) -> None:
        self.n = n = numbers(dtype)
        self.settings = settings or Settings()
        self.lens = Lens.of(n, camera)
        self.mount = mounting_rotation(n, camera)
        self.arm_m = [n.real(value) for value in (camera.offset_x_m, camera.offset_y_m, camera.offset_z_m)]
        self.heading_deg = None if camera.heading_deg is None else n.real(camera.heading_deg)
        self._begin()

    def _begin(self) -> None:
        n, window = self.n, self.settings.window
        self.sighted = False
        self.heading = (n.zero, n.one)  # sine and cosine of the heading of T's Z axis
        self.origin_m = [n.zero] * 3  # like the heading, from the latest image until one has a feature
        self.dx_m = self.dz_m = n.zero
        self.roundoff_m = 0.0  # of dX, dZ in float32, from the NED positions
        self.time_us: int | None = None
        self.rows = {"disc": Ring(window), "line": Ring(window)}
        self.means = {"length_m": Mean(Ring(window)), "height_m": Mean(Ring(window))}
        self.orientation = Orientation(n, self.settings.orientation_memory)
        self.model, self.fit = "none", None
        self.values: dict[str, Real] = {}
        self.roundoff: dict[str, Rounding] = {}

    # -- intake

    def _refusal(self, frame: Frame, gates: Gates) -> str | None:
        real = self.n.real
        limits = [(frame.height_m, HEIGHT_LIMIT_M)]
        limits += [(value, POSITION_LIMIT_M) for value in frame.position_m]
        limits += [(value, PIXEL_LIMIT_PX) for name in FEATURES for value in getattr(frame, name) or ()]
        # beyond float32's range: infinite in the library
        if not all(math.isfinite(np.float32(value)) for value in [*frame.attitude, *(value for value, _ in limits)]):
            return "not_finite"
        if any(abs(real(value)) > limit for value, limit in limits):
            return "out_of_range"
        if frame.time_us is None or (self.time_us is not None and frame.time_us <= self.time_us):
            return "bad_time"
        q = [real(value) for value in frame.attitude]
        if any(abs(value) > ATTITUDE_LIMIT for value in q):
            return "bad_attitude"
        norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]
        least, most = self.n.norm_min, self.n.norm_max
        excess = abs(math.sqrt(norm2) - 1.0) - 0.01
        wrong = norm2 < least * least or norm2 > most * most
        return "bad_attitude" if gates.decide("attitude", wrong, excess, 1.0) else None

    # -- ego motion

    def _follow(self, frame: Frame, gates: Gates) -> Matrix:
        """Takes the pose; returns camera -> T."""
        real = self.n.real
        ned_from_body = quaternion_rotation(self.n, [real(value) for value in frame.attitude])
        position = [real(value) + arm for value, arm in zip(frame.position_m, apply(ned_from_body, self.arm_m))]
        if not self.sighted:
            self.heading = self._track_heading(ned_from_body, gates)
            self.origin_m = position
        self.time_us = frame.time_us
        s, c = self.heading
        north, east = position[0] - self.origin_m[0], position[1] - self.origin_m[1]
        self.dx_m, self.dz_m = c * east - s * north, c * north + s * east
        self.roundoff_m = UNIT_ROUNDOFF * max(abs(float(value)) for value in position)
        m = multiply(ned_from_body, self.mount)
        aside = [c * east - s * north for north, east in zip(m[:3], m[3:6])]
        ahead = [c * north + s * east for north, east in zip(m[:3], m[3:6])]
        return [*aside, *m[6:], *ahead]

    def _track_heading(self, ned_from_body: Matrix, gates: Gates) -> tuple[Real, Real]:
        """Sine and cosine of the configured heading, or of the direction of the nose."""
        n, north, east = self.n, ned_from_body[0], ned_from_body[3]
        if self.heading_deg is not None:
            return n.sincos_deg(self.heading_deg)
        level = np.sqrt(north * north + east * east)
        if gates.decide("nose", level < n.level_nose_min, level - n.level_nose_min, 1.0):
            return n.zero, n.one
        return east / level, north / level

    # -- aligned points

    def _align(self, t_from_camera: Matrix, frame: Frame, gates: Gates, when: str = "") -> View:
        """``when``: prefix for the names of its decisions."""
        n, lens, view = self.n, self.lens, View(gates)
        for feature in FEATURES:
            pixel = getattr(frame, feature)
            if pixel is None:
                continue
            u, v = n.real(pixel[0]), n.real(pixel[1])
            x, y, converged, near = undistort(n, lens, (u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy)
            if not gates.decide(f"{when}lens:{feature}", converged, near, 1.0 + abs(float(x)) + abs(float(y))):
                view.faults.append("lens_failed")
                continue
            ray = apply(t_from_camera, (x, y, n.one))
            norm = np.sqrt(x * x + y * y + n.one)
            away = ray[2] - n.forward_min * norm
            behind = not ray[2] > n.forward_min * norm
            if gates.decide(f"{when}behind:{feature}", behind, away, 2.0 * float(norm)):
                view.faults.append("behind_camera")
                continue
            view.points[feature] = Point(ray[0] / ray[2], ray[1] / ray[2], u, v)
        return view

    def _may_begin_again(self, t_from_camera: Matrix, gates: Gates) -> bool:
        """Whether Z is from the nose, nothing is known, and the nose has turned by more than 45 degrees."""
        if self.heading_deg is not None or self.fit is not None:
            return False
        x, _, z = apply(t_from_camera, self.mount[:3])
        return gates.decide("turned", abs(x) > z, abs(x) - z, 2.0)

    def _lies_aside(self, view: View) -> bool:
        """Whether all usable features are too far from the axis."""
        least = self.n.aside_min
        return all(
            [
                view.gates.decide(f"aside:{feature}", abs(p.x) > least, abs(p.x) - least, 2.0 * (1.0 + float(p.x) ** 2))
                for feature, p in view.points.items()
            ]
        )

    def _open_view(self, frame: Frame, gates: Gates) -> View:
        t_from_camera = self._follow(frame, gates)
        visible = any(getattr(frame, feature) is not None for feature in FEATURES)
        turned = self._may_begin_again(t_from_camera, gates) and visible
        if turned and self._lies_aside(self._align(t_from_camera, frame, gates, BEFORE)):
            self._begin()
            t_from_camera = self._follow(frame, gates)
        self.sighted = self.sighted or visible
        return self._align(t_from_camera, frame, gates)

    # -- rows

    def _add_row(self, view: View, model: str, row: tuple[Real, Real], roundoff: Rounding) -> None:
        self.rows[model].add(Row(*row, self.dx_m, self.dz_m, roundoff, self.roundoff_m))
        view.added.add(model)

    def _add_disc_row(self, view: View) -> None:
        """Equation (2)."""
        if self.settings.model == "line" or "left" not in view.points or "right" not in view.points:
            return
        left, right = view.points["left"].x, view.points["right"].x
        least, raw, ends = self.n.width_min, right - left, abs(float(left)) + abs(float(right))
        if not view.gates.decide("disc_width", raw > least, raw - least, 4.0 + ends):
            view.faults.append("swapped")
            return
        row = disc_row(self.n, left, right)
        forward, aside = float(row[1]), abs(float(row[0]))
        self._add_row(view, "disc", row, POINT_ROUNDOFF * (1.0 + ends) / float(raw) * (forward + aside))

    def _turned(self, view: View, name: str, point: Point) -> Real | None:
        """(4): x of the point for a camera turned by b. None: not ahead of it."""
        n, x, s, c = self.n, point.x, view.sin_b, view.cos_b
        forward, norm = c + x * s, np.sqrt(n.one + x * x)
        least = n.forward_min * norm
        if not view.gates.decide(f"turn:{name}", forward > least, forward - least, 2.0 * float(norm)):
            return None
        return (x * c - s) / forward

    def _line_row(self, view: View, front: Edge) -> tuple[tuple[Real, Real], Rounding] | None:
        """(3), (4) of the front edge: m x/S and m/S, turned back by b, and their rounding."""
        n, s, c = self.n, view.sin_b, view.cos_b
        left = self._turned(view, "front:left", front.left)
        right = self._turned(view, "front:right", front.right) if left is not None else None
        if left is None or right is None:
            return None
        size, ends = right - left, (abs(float(left)), abs(float(right)))
        size_of_x = 4.0 + sum(end + 1.0 + end * end for end in ends)
        if not view.gates.decide("line_width", size > n.width_min, size - n.width_min, size_of_x):
            return None
        forward = n.one / size
        aside = n.half * (left + right) * forward
        # an error of b turns the edge and is turned back with the row; x (1 + x) of it remains
        x, angle = abs(float(left) + float(right)) / 2.0, math.radians(self.orientation.roundoff_deg)
        roundoff = (POINT_ROUNDOFF * (1.0 + sum(ends)) / float(size) + angle * x) / float(size) * (1.0 + x)
        return (c * aside + s * forward, c * forward - s * aside), roundoff

    def _add_line_row(self, view: View) -> None:
        if not view.measured or view.front is None or not view.front.counts:
            return
        row = self._line_row(view, view.front)
        if row is None:
            view.faults.append("edge_on")
        else:
            self._add_row(view, "line", *row)

    # -- solution

    def _solve(self, view: View) -> str:
        settings, model = self.settings, self.settings.model
        if model == "auto":
            model = "line" if self.rows["line"].count >= max(settings.line_points, settings.window) else "disc"
        rows = self.rows[model]
        if rows.count < settings.window:
            return "converging"
        if model not in view.added:
            return "stale"
        status, fit = solve(self.n, rows.items, self.n.real(settings.min_baseline_m), view.gates)
        if fit is not None:
            self.fit, self.model = fit, model
        return status

    # -- length and height

    def _measure_length(self, view: View, side: Edge) -> bool:
        """(6), (7). False: the side is viewed edge-on."""
        n, fit, values, s, c = self.n, self.fit, self.values, view.sin_b, view.cos_b
        assert fit is not None
        near, far = (side.left, side.right) if view.side_is_right else (side.right, side.left)
        x_near = self._turned(view, "side:near", near)
        x_far = self._turned(view, "side:far", far) if x_near is not None else None
        if x_near is None or x_far is None:
            return False
        least = n.real(self.settings.side_min_px) / self.lens.fx
        turning = math.radians(self.orientation.roundoff_deg) / UNIT_ROUNDOFF
        for name, x in (("near", x_near), ("far", x_far)):
            size = (1.0 + float(x) ** 2) * (4.0 + turning)
            if view.gates.decide(f"aside:{name}", abs(x) < least, abs(x) - least, size):
                return False
        if bool(x_near < n.zero) != bool(x_far < n.zero):
            return False
        inverse = n.one / x_far - n.one / x_near
        half_m = n.half * fit.width_m if view.side_is_right else -n.half * fit.width_m
        side_m = values["x_m"] * c - values["z_m"] * s + half_m
        sigma_x, sigma_z, sigma_w = fit.sigma["x0_m"], fit.sigma["z0_m"], fit.sigma["width_m"]
        variance = c * c * sigma_x * sigma_x + s * s * sigma_z * sigma_z + n.quarter * sigma_w * sigma_w

        r, turning = fit.roundoff, POINT_ROUNDOFF + math.radians(self.orientation.roundoff_deg)
        near2, far2, scale = float(x_near) ** 2, float(x_far) ** 2, abs(float(inverse))
        ends = turning * ((1.0 + near2) / near2 + (1.0 + far2) / far2) * abs(float(side_m))
        across = turning * (abs(float(values["x_m"])) + abs(float(values["z_m"])) + float(fit.width_m))
        solution = math.sqrt((c * r["x0_m"]) ** 2 + (s * r["z0_m"]) ** 2 + r["width_m"] ** 2 / 4.0)
        roundoff = scale * (solution + across) + ends
        size = roundoff / UNIT_ROUNDOFF
        self._take_extent(view.gates, "length_m", inverse * side_m, inverse * inverse * variance, roundoff, size)
        return True

    def _measure_height(self, view: View, frame: Frame) -> bool:
        """(8). False: no height above the ground."""
        n, fit, y, z = self.n, self.fit, view.points["top"].y, self.values["z_m"]
        assert fit is not None
        height_m = n.real(frame.height_m)
        if height_m <= n.zero:
            return False
        sigma_m = y * fit.sigma["z0_m"]
        size = abs(float(height_m)) + (1.0 + abs(float(y))) * abs(float(z))
        roundoff = abs(float(y)) * fit.roundoff["z0_m"] + UNIT_ROUNDOFF * size
        size = roundoff / UNIT_ROUNDOFF
        self._take_extent(view.gates, "height_m", height_m - y * z, sigma_m * sigma_m, roundoff, size)
        return True

    def _take_extent(
        self, gates: Gates, name: str, value: Real, variance: Real, roundoff: Rounding, size: Rounding
    ) -> None:
        """Adds a value to the sliding mean. A mean that is not positive is no answer."""
        assert self.fit is not None
        mean = self.means[name]
        average, spread = mean.add(self.n, value, self.fit.ratio)
        if gates.decide(f"positive:{name}", average > self.n.zero, average, size):
            self._report(name, average, np.sqrt(spread + variance), roundoff / math.sqrt(len(mean.ring.items)))
        else:
            self._forget(name)

    # -- estimate

    def _report(self, quantity: str, value: Real, sigma: Real, roundoff: Rounding) -> None:
        self.values[quantity], self.values[SIGMA_NAMES[quantity]] = value, sigma
        self.roundoff[quantity] = roundoff

    def _forget(self, quantity: str) -> None:
        for store, name in ((self.values, quantity), (self.values, SIGMA_NAMES[quantity]), (self.roundoff, quantity)):
            store.pop(name, None)

    def _report_solution(self) -> None:
        """Position and width; the position changes with the camera's path."""
        fit = self.fit
        if fit is None:
            return
        sigma, roundoff = fit.sigma, fit.roundoff
        for axis, zero_m, moved_m in (("x", fit.x0_m, self.dx_m), ("z", fit.z0_m, self.dz_m)):
            self._report(f"{axis}0_m", zero_m, sigma[f"{axis}0_m"], roundoff[f"{axis}0_m"])
            self._report(f"{axis}_m", zero_m - moved_m, sigma[f"{axis}0_m"], roundoff[f"{axis}0_m"])
        self._report("width_m", fit.width_m, sigma["width_m"], roundoff["width_m"])

    def _report_orientation(self) -> None:
        turned = self.orientation
        if turned.count > 0:
            sigma = np.sqrt(turned.variance_deg2 / self.n.real(turned.count))
            self._report("orientation_deg", turned.deg, sigma, turned.roundoff_deg / math.sqrt(turned.count))

    def _report_center(self, view: View) -> None:
        """Middle of the base: a disc's reference point; half a length behind a box's front edge."""
        fit, values, (s, c) = self.fit, self.values, self.heading
        if fit is None or (self.model == "line" and "length_m" not in values):
            self._forget("center_n_m")
            self._forget("center_e_m")
            return
        point, sigmas = [fit.x0_m, fit.z0_m], [fit.sigma["x0_m"], fit.sigma["z0_m"]]
        variances = [sigma * sigma for sigma in sigmas]
        roundings = [fit.roundoff["x0_m"] ** 2, fit.roundoff["z0_m"] ** 2]
        if self.model == "line":
            length, sigma = values["length_m"], values[SIGMA_NAMES["length_m"]]
            for i, axis in enumerate((view.sin_b, view.cos_b)):
                half = self.n.half * axis
                point[i] = point[i] + half * length
                variances[i] = variances[i] + half * half * sigma * sigma
                roundings[i] += (float(half) * self.roundoff["length_m"]) ** 2
        (x, z), (variance_x, variance_z), (rounding_x, rounding_z) = point, variances, roundings
        c2, s2 = float(c) ** 2, float(s) ** 2
        north, east = self.origin_m[0] + (c * z - s * x), self.origin_m[1] + (s * z + c * x)
        sigma_n = np.sqrt(c * c * variance_z + s * s * variance_x)
        sigma_e = np.sqrt(s * s * variance_z + c * c * variance_x)
        rounding_n = math.sqrt(c2 * rounding_z + s2 * rounding_x) + UNIT_ROUNDOFF * abs(float(north))
        rounding_e = math.sqrt(s2 * rounding_z + c2 * rounding_x) + UNIT_ROUNDOFF * abs(float(east))
        self._report("center_n_m", north, sigma_n, rounding_n)
        self._report("center_e_m", east, sigma_e, rounding_e)

    # -- the chain

    def _judge(self, view: View, solving: str, visible: bool) -> str:
        """Status of an accepted image."""
        if solving == "ok":
            return "partial" if view.faults else "ok"
        if solving not in ("converging", "stale"):
            return solving
        if view.faults:
            return view.faults[0]
        if not visible:
            return "no_detection"
        if self.settings.model == "line" and view.edges and "line" not in view.added:
            return "no_edge"
        return solving

    def _take(self, frame: Frame, gates: Gates) -> tuple[str, bool]:
        view = self._open_view(frame, gates)
        self._add_disc_row(view)
        if self.settings.model != "disc":
            find_edges(self.n, self.settings, self.lens.fx, view)
            self.orientation.update(view)
            view.sin_b, view.cos_b = self.orientation.turn()
            self._add_line_row(view)
        solving = self._solve(view)
        self._report_solution()
        self._report_orientation()
        if solving == "ok":
            two_sides = self.model == "line" and view.front is not None and view.side is not None
            if two_sides and not self._measure_length(view, view.side):
                view.faults.append("edge_on")
            if "top" in view.points and not self._measure_height(view, frame):
                view.faults.append("bad_height")
        self._report_center(view)
        visible = any(getattr(frame, feature) is not None for feature in FEATURES)
        return self._judge(view, solving, visible), solving == "ok"

    def _conditioning(self) -> dict[str, Rounding]:
        ratio = self.fit.ratio if self.fit else 0.0
        result = dict.fromkeys(QUANTITIES, ratio)
        result.update({name: mean.ratio for name, mean in self.means.items()})
        if self.model == "line":
            result["center_n_m"] = result["center_e_m"] = min(ratio, result["length_m"])
        return result

    def update(self, frame: Frame, guide: dict[str, bool] | None = None) -> Report:
        """Takes one image. guide: decisions to follow if the method's own are within float32 rounding of a
        threshold."""
        gates, fresh = Gates(guide), False
        with np.errstate(all="ignore"):
            status = self._refusal(frame, gates)
            if status is None:
                status, fresh = self._take(frame, gates)
        fit = self.fit
        values = {name: self.values[name] for name in NUMBERS if name in self.values}
        return Report(
            Estimate(status, self.model, self.settings.window if fit else 0, values),
            gates,
            dict(self.roundoff),
            self._conditioning(),
            fit.residual if fit else self.n.zero,
            fit.baseline_m if fit else self.n.zero,
            fresh,
            frame.height_m,
        )
