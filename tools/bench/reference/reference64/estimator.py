"""One obstacle's estimator: the paper's chain from an image to an estimate, step by step."""

from __future__ import annotations

import math

import numpy as np
from goe_tools.logs.estimates import QUANTITIES, Estimate, sigma_name
from goe_tools.logs.obslog import FEATURES, Camera, Frame, Pixel

from ..gates import UNIT_ROUNDOFF, Gates
from ..settings import Settings
from .geometry import FORWARD_MIN, chosen_end, fold, mounting_rotation, quaternion_rotation, turned, undistort
from .track import Edge, Mean, Report, Track, View
from .window import Fit, Row, solve

POSITION_LIMIT_M = 1e6
HEIGHT_LIMIT_M = 1e5
PIXEL_LIMIT_PX = 1e5
NORM_TOLERANCE = 0.01
NOSE_MIN = 1e-3
WIDTH_MIN = 1e-4
ASIDE_DEG = 60.0  # from Z
BEFORE = "before:"  # the decisions of a view that is thrown away when the track begins again
AMBIGUOUS_DEG = 30.0
POINT_ROUNDOFF = UNIT_ROUNDOFF  # of an aligned coordinate in float32, relative to 1 + |coordinate|


class Reference64:
    """One obstacle's estimator. Feed it one frame after the other."""

    def __init__(self, camera: Camera, settings: Settings | None = None) -> None:
        self.camera = camera
        self.settings = settings or Settings()
        self.mount = mounting_rotation(camera)
        self.track = Track(self.settings)

    # -- intake

    def _refusal(self, frame: Frame, gates: Gates) -> str | None:
        limits = [(frame.height_m, HEIGHT_LIMIT_M)]
        limits += [(value, POSITION_LIMIT_M) for value in frame.position_m]
        for feature in FEATURES:
            limits += [(value, PIXEL_LIMIT_PX) for value in getattr(frame, feature) or ()]
        with np.errstate(over="ignore"):  # beyond float32's range is an infinity to the library
            finite = all(math.isfinite(np.float32(value)) for value in [*frame.attitude, *(v for v, _ in limits)])
        if not finite:
            return "not_finite"
        if any(abs(value) > limit for value, limit in limits):
            return "out_of_range"
        if frame.time_us is None or (self.track.time_us is not None and frame.time_us <= self.track.time_us):
            return "bad_time"
        excess = abs(float(np.linalg.norm(frame.attitude)) - 1.0) - NORM_TOLERANCE
        return "bad_attitude" if gates.decide("attitude", excess > 0.0, excess, 1.0) else None

    # -- ego motion

    def _follow(self, frame: Frame, gates: Gates) -> np.ndarray:
        """Takes the pose; returns camera -> T."""
        track, camera = self.track, self.camera
        ned_from_body = quaternion_rotation(frame.attitude)
        lever = np.array([camera.offset_x_m, camera.offset_y_m, camera.offset_z_m])
        position = np.asarray(frame.position_m) + ned_from_body @ lever
        if not track.sighted:
            track.origin_m = position
            nose = ned_from_body[:2, 0]
            level = float(np.hypot(*nose))
            if camera.heading_deg is not None:
                heading = math.radians(camera.heading_deg)
            elif gates.decide("nose", level < NOSE_MIN, level - NOSE_MIN, 1.0):
                heading = 0.0
            else:
                heading = math.atan2(nose[1], nose[0])
            track.heading = (math.cos(heading), math.sin(heading))
        c, s = track.heading
        t_from_ned = np.array([[-s, c, 0.0], [0.0, 0.0, 1.0], [c, s, 0.0]])
        moved = t_from_ned @ (position - track.origin_m)
        track.dx_m, track.dz_m = float(moved[0]), float(moved[2])
        track.roundoff_m = UNIT_ROUNDOFF * float(np.max(np.abs(position)))
        track.time_us = frame.time_us
        return t_from_ned @ ned_from_body @ self.mount

    # -- aligned points

    def _align(self, t_from_camera: np.ndarray, frame: Frame, gates: Gates, faults: list[str], when: str = "") -> View:
        """``when``: before the names of its decisions."""
        camera, view = self.camera, View()
        for feature in FEATURES:
            pixel: Pixel | None = getattr(frame, feature)
            if pixel is None:
                continue
            x, y = (pixel[0] - camera.cx) / camera.fx, (pixel[1] - camera.cy) / camera.fy
            x, y, converged, near = undistort(camera, x, y)
            if not gates.decide(f"{when}lens:{feature}", converged, near, 1.0 + abs(x) + abs(y)):
                faults.append("lens_failed")
                continue
            ray = np.array([x, y, 1.0])
            ray /= np.linalg.norm(ray)
            ray = t_from_camera @ ray
            away = ray[2] - FORWARD_MIN
            if gates.decide(f"{when}behind:{feature}", away <= 0.0, away, 2.0):
                faults.append("behind_camera")
                continue
            view.points[feature] = float(ray[0] / ray[2]), float(ray[1] / ray[2])
        return view

    def _may_begin_again(self, t_from_camera: np.ndarray, gates: Gates) -> bool:
        """Z is where the nose pointed, nothing is known, and the nose has turned by more than 45 degrees."""
        if self.camera.heading_deg is not None or self.track.fit is not None:
            return False
        nose = t_from_camera @ self.mount[0]
        beyond = float(abs(nose[0]) - nose[2])
        return gates.decide("turned", beyond > 0.0, beyond, 2.0)

    def _lies_aside(self, view: View, gates: Gates) -> bool:
        """All that can be used."""
        least = math.tan(math.radians(ASIDE_DEG))
        aside = [
            gates.decide(f"aside:{feature}", abs(x) > least, abs(x) - least, 2.0 * (1.0 + x * x))
            for feature, (x, _) in view.points.items()
        ]
        return all(aside)

    def _open_view(self, frame: Frame, gates: Gates, faults: list[str]) -> View:
        t_from_camera = self._follow(frame, gates)
        seen = any(getattr(frame, feature) is not None for feature in FEATURES)
        turned = self._may_begin_again(t_from_camera, gates) and seen
        if turned and self._lies_aside(self._align(t_from_camera, frame, gates, [], BEFORE), gates):
            self.track = Track(self.settings)
            t_from_camera = self._follow(frame, gates)
        self.track.sighted = self.track.sighted or seen
        return self._align(t_from_camera, frame, gates, faults)

    # -- rows

    def _add_disc_row(self, view: View, gates: Gates, faults: list[str]) -> bool:
        """(2)"""
        if self.settings.model == "line" or "left" not in view.points or "right" not in view.points:
            return False
        left, right = view.points["left"][0], view.points["right"][0]
        raw = right - left
        size_of_x = 4.0 + abs(left) + abs(right)
        if not gates.decide("disc_width", raw > WIDTH_MIN, raw - WIDTH_MIN, size_of_x):
            faults.append("swapped")
            return False
        size = raw * (math.cos(math.atan(left)) + math.cos(math.atan(right)))
        x = 0.5 * (left + right) * (1.0 - size**2 / 16.0)
        roundoff = POINT_ROUNDOFF * (1.0 + abs(left) + abs(right)) / raw * 2.0 / size * (1.0 + abs(x))
        track = self.track
        track.rows["disc"].append(
            Row(2.0 / size, 2.0 * x / size, 1.0, 0.0, track.dx_m, track.dz_m, roundoff, track.roundoff_m)
        )
        return True

    def _heading(self, a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
        """(1): heading of the edge through a and b, and its float32 rounding, degrees."""
        heading = 90.0 if a[1] == b[1] else math.degrees(math.atan(a[0] - a[1] * (b[0] - a[0]) / (b[1] - a[1])))
        across, along = a[0] * b[1] - a[1] * b[0], b[1] - a[1]
        size = max(math.hypot(across, along), 1e-300)
        coordinates = abs(a[0]) + abs(a[1]) + abs(b[0]) + abs(b[1])
        roundoff = math.degrees(POINT_ROUNDOFF * (abs(along) * coordinates + 2.0 * abs(across)) / size**2)
        return heading, roundoff

    def _find_edges(self, frame: Frame, view: View, gates: Gates, faults: list[str]) -> None:
        points = view.points
        for a, b in (("base_left", "base_near"), ("base_near", "base_right"), ("base_left", "base_right")):
            if a in points and b in points:
                gap = points[b][0] - points[a][0]
                size = 4.0 + abs(points[a][0]) + abs(points[b][0])
                if not gates.decide(f"order:{a}:{b}", gap >= 0.0, gap, size):
                    faults.append("swapped")
                    return
        pairs = [("base_left", "base_near"), ("base_near", "base_right")]
        if "base_near" not in points:
            pairs = [("base_left", "base_right")]
        for a, b in pairs:
            if a not in points or b not in points:
                continue
            pixel_a, pixel_b = np.array(getattr(frame, a)), np.array(getattr(frame, b))
            long_px = float(np.linalg.norm(pixel_b - pixel_a))
            pixel_size = float(np.max(np.abs([pixel_a, pixel_b])))
            least = self.settings.edge_min_px
            counts = gates.decide(f"counts:{a}:{b}", long_px > least, long_px - least, pixel_size)
            heading, roundoff = None, 0.0
            if counts:
                (_, ya), (_, yb) = points[a], points[b]
                rise = abs(yb - ya) * self.camera.fx
                size = self.camera.fx * (4.0 + abs(ya) + abs(yb))
                least = self.settings.orientation_min_px
                if gates.decide(f"rises:{a}:{b}", rise > least, rise - least, size):
                    heading, roundoff = self._heading(points[a], points[b])
            view.edges.append(Edge(points[a], points[b], counts, heading, roundoff))

    def _orient(self, view: View, gates: Gates) -> None:
        """Which edge is the side edge, and the low-pass of the orientation."""
        track = self.track
        if all(edge.heading_deg is None for edge in view.edges):
            return
        view.measured = True
        first = view.edges[0]
        second = view.edges[1] if len(view.edges) > 1 else None
        roundoff = max(edge.roundoff_deg for edge in view.edges)
        size = 180.0 + roundoff / UNIT_ROUNDOFF

        def hypothesis(side: Edge | None, front: Edge | None) -> float:
            if side is not None and side.heading_deg is not None:
                return side.heading_deg
            assert front is not None and front.heading_deg is not None
            return fold(front.heading_deg - 90.0)

        b_first, b_second = hypothesis(first, second), hypothesis(second, first)
        difference = abs(b_second) - abs(b_first)
        if track.angles > 0:
            gap = AMBIGUOUS_DEG - abs(difference)
            if gates.decide("ambiguous", gap > 0.0, gap, size):
                away = [abs(math.remainder(b - track.angle_deg, 180.0)) for b in (b_first, b_second)]
                difference = away[1] - away[0]
        first_is_side = gates.decide("first_is_side", difference >= 0.0, difference, size)
        view.side, view.front = (first, second) if first_is_side else (second, first)
        view.side_is_right = not first_is_side
        measured = chosen_end(gates, "end:measured", b_first if first_is_side else b_second, size)
        if track.angles == 0:
            track.angle_roundoff_deg = roundoff
            track.angles, track.angle_deg, track.angle_variance = 1, measured, 0.0
            return
        step = chosen_end(gates, "end:step", fold(measured - track.angle_deg), size)
        track.angles = min(track.angles + 1, self.settings.orientation_memory)
        track.angle_deg = chosen_end(gates, "end:filter", fold(track.angle_deg + step / track.angles), size)
        track.angle_variance += (step**2 - track.angle_variance) / track.angles
        track.angle_roundoff_deg += (roundoff - track.angle_roundoff_deg) / track.angles

    def _add_line_row(self, view: View, gates: Gates, faults: list[str]) -> bool:
        """(3), (4) of the front edge."""
        track, front = self.track, view.front
        if not view.measured or front is None or not front.counts:
            return False
        c, s = self._turn()
        ends = []
        for name, end in (("left", front.left), ("right", front.right)):
            x = turned(gates, f"turn:front:{name}", end[0], c, s)
            if x is None:
                faults.append("edge_on")
                return False
            ends.append(x)
        size = ends[1] - ends[0]
        size_of_x = 4.0 + abs(ends[0]) + abs(ends[1]) + sum((1.0 + x * x) for x in ends)
        if not gates.decide("line_width", size > WIDTH_MIN, size - WIDTH_MIN, size_of_x):
            faults.append("edge_on")
            return False
        x = 0.5 * (ends[0] + ends[1])
        angle = math.radians(track.angle_roundoff_deg)
        point = POINT_ROUNDOFF * (1.0 + abs(ends[0]) + abs(ends[1]))
        # an error of b turns the edge and is turned back with the row, which leaves x (1 + x) of it
        roundoff = (point / size + angle * abs(x)) / size * (1.0 + abs(x))
        track.rows["line"].append(Row(1.0 / size, x / size, c, s, track.dx_m, track.dz_m, roundoff, track.roundoff_m))
        track.line_points += 1
        return True

    def _turn(self) -> tuple[float, float]:
        angle = math.radians(self.track.angle_deg)
        return math.cos(angle), math.sin(angle)

    # -- solution

    def _reported_model(self) -> str:
        if self.settings.model != "auto":
            return self.settings.model
        enough = max(self.settings.line_points, self.settings.window)
        return "line" if self.track.line_points >= enough else "disc"

    def _solve(self, added: dict[str, bool], gates: Gates) -> str:
        track, model = self.track, self._reported_model()
        rows = track.rows[model]
        if len(rows) < self.settings.window:
            return "collecting"
        if not added[model]:
            return "held"
        status, fit = solve(rows, self.settings.min_baseline_m, gates)
        if fit is not None:
            track.fit, track.model = fit, model
        return status

    def _take_extent(
        self, gates: Gates, name: str, mean: Mean, value: float, variance: float, roundoff: float, size: float
    ) -> None:
        assert self.track.fit is not None
        average, spread = mean.add(value, self.track.fit.ratio)
        if gates.decide(f"positive:{name}", average > 0.0, average, size):
            self.track.extents[name] = average, math.sqrt(spread + variance), roundoff / math.sqrt(len(mean.values))
        else:
            self.track.extents.pop(name, None)

    def _measure_length(self, view: View, gates: Gates, faults: list[str]) -> None:
        """(6), (7)"""
        track, fit = self.track, self.track.fit
        assert fit is not None and view.side is not None
        c, s = self._turn()
        near, far = view.side.right, view.side.left
        if view.side_is_right:
            near, far = far, near
        x2, x3 = (turned(gates, f"turn:side:{name}", end[0], c, s) for name, end in (("near", near), ("far", far)))
        if x2 is None or x3 is None:
            faults.append("edge_on")
            return
        angle = math.radians(track.angle_roundoff_deg) / UNIT_ROUNDOFF
        for name, x in (("near", x2), ("far", x3)):
            away = abs(x) * self.camera.fx - self.settings.side_min_px
            if gates.decide(f"aside:{name}", away < 0.0, away, self.camera.fx * (1.0 + x * x) * (4.0 + angle)):
                faults.append("edge_on")
                return
        if (x2 < 0.0) != (x3 < 0.0):
            faults.append("edge_on")
            return
        x, z = fit.x0_m - track.dx_m, fit.z0_m - track.dz_m
        inverse = 1.0 / x3 - 1.0 / x2
        side = x * c - z * s + (0.5 if view.side_is_right else -0.5) * fit.width_m

        def propagated(sigma: dict[str, float]) -> float:
            return inverse**2 * ((c * sigma["x0_m"]) ** 2 + (s * sigma["z0_m"]) ** 2 + sigma["width_m"] ** 2 / 4.0)

        turning = POINT_ROUNDOFF + math.radians(track.angle_roundoff_deg)
        ends = turning * ((1.0 + x2**2) / x2**2 + (1.0 + x3**2) / x3**2) * abs(side)
        across = abs(inverse) * turning * (abs(x) + abs(z) + fit.width_m)
        roundoff = math.sqrt(propagated(fit.roundoff)) + ends + across
        self._take_extent(
            gates, "length_m", track.length, inverse * side, propagated(fit.sigma), roundoff, roundoff / UNIT_ROUNDOFF
        )

    def _measure_height(self, frame: Frame, view: View, gates: Gates, faults: list[str]) -> None:
        """(8)"""
        track, fit = self.track, self.track.fit
        assert fit is not None
        if frame.height_m <= 0.0:
            faults.append("bad_height")
            return
        y, z = view.points["top"][1], fit.z0_m - track.dz_m
        size = abs(frame.height_m) + (1.0 + abs(y)) * abs(z)
        roundoff = abs(y) * fit.roundoff["z0_m"] + UNIT_ROUNDOFF * size
        self._take_extent(
            gates,
            "height_m",
            track.height,
            frame.height_m - y * z,
            (y * fit.sigma["z0_m"]) ** 2,
            roundoff,
            roundoff / UNIT_ROUNDOFF,
        )

    # -- estimate

    def _estimate(self, status: str) -> tuple[Estimate, dict[str, float]]:
        track, fit = self.track, self.track.fit
        values: dict[str, float] = {}
        roundoff: dict[str, float] = {}

        def tell(quantity: str, value: float, sigma: float, rounding: float) -> None:
            values[quantity], values[sigma_name(quantity)], roundoff[quantity] = value, sigma, rounding

        if fit is not None:
            tell("x0_m", fit.x0_m, fit.sigma["x0_m"], fit.roundoff["x0_m"])
            tell("z0_m", fit.z0_m, fit.sigma["z0_m"], fit.roundoff["z0_m"])
            tell("x_m", fit.x0_m - track.dx_m, fit.sigma["x0_m"], fit.roundoff["x0_m"])
            tell("z_m", fit.z0_m - track.dz_m, fit.sigma["z0_m"], fit.roundoff["z0_m"])
            tell("width_m", fit.width_m, fit.sigma["width_m"], fit.roundoff["width_m"])
        for name, (value, sigma, rounding) in track.extents.items():
            tell(name, value, sigma, rounding)
        if track.angles > 0:
            sigma = math.sqrt(track.angle_variance / track.angles)
            tell("orientation_deg", track.angle_deg, sigma, track.angle_roundoff_deg / math.sqrt(track.angles))
        if fit is not None and (track.model == "disc" or "length_m" in track.extents):
            self._tell_center(fit, tell)
        ordered = {
            name: values[name] for quantity in QUANTITIES for name in (quantity, sigma_name(quantity)) if name in values
        }
        n_used = self.settings.window if fit is not None else 0
        return Estimate(status, track.model, n_used, ordered), roundoff

    def _tell_center(self, fit: Fit, tell) -> None:
        track = self.track
        c, s = track.heading
        assert track.origin_m is not None
        point = np.array([fit.x0_m, fit.z0_m])
        sigma = np.array([fit.sigma["x0_m"], fit.sigma["z0_m"]])
        rounding = np.array([fit.roundoff["x0_m"], fit.roundoff["z0_m"]])
        if track.model == "line":
            length, length_sigma, length_rounding = track.extents["length_m"]
            cos_b, sin_b = self._turn()
            axis = np.array([sin_b, cos_b])
            point = point + 0.5 * length * axis
            sigma = np.hypot(sigma, 0.5 * axis * length_sigma)
            rounding = np.hypot(rounding, 0.5 * axis * length_rounding)
        ned_from_t = np.array([[-s, c], [c, s]])
        center = track.origin_m[:2] + ned_from_t @ point
        sigma, rounding = (np.sqrt(ned_from_t**2 @ value**2) for value in (sigma, rounding))
        rounding = rounding + UNIT_ROUNDOFF * np.abs(center)
        for i, name in enumerate(("center_n_m", "center_e_m")):
            tell(name, float(center[i]), float(sigma[i]), float(rounding[i]))

    def update(self, frame: Frame, guide: dict[str, bool] | None = None) -> Report:
        """Takes one image. guide: decisions to follow where the own ones lie within float32 rounding of a threshold."""
        gates = Gates(guide)
        status = self._refusal(frame, gates)
        if status is None:
            status = self._take(frame, gates)
        estimate, roundoff = self._estimate(status)
        fit = self.track.fit
        return Report(estimate, gates, roundoff, self._conditioning(), fit.residual if fit else 0.0, frame.height_m)

    def _conditioning(self) -> dict[str, float]:
        track = self.track
        ratio = track.fit.ratio if track.fit else 0.0
        result = dict.fromkeys(QUANTITIES, ratio)
        result["length_m"] = min(track.length.ratios, default=0.0)
        result["height_m"] = min(track.height.ratios, default=0.0)
        if track.model == "line":
            result["center_n_m"] = result["center_e_m"] = min(ratio, result["length_m"])
        return result

    def _take(self, frame: Frame, gates: Gates) -> str:
        faults: list[str] = []
        view = self._open_view(frame, gates, faults)
        added = {"disc": self._add_disc_row(view, gates, faults), "line": False}
        if self.settings.model != "disc":
            self._find_edges(frame, view, gates, faults)
            self._orient(view, gates)
            added["line"] = self._add_line_row(view, gates, faults)
        solving = self._solve(added, gates)
        if solving == "ok":
            if self.track.model == "line" and view.front is not None and view.side is not None:
                self._measure_length(view, gates, faults)
            if "top" in view.points:
                self._measure_height(frame, view, gates, faults)
            return "partial" if faults else "ok"
        if solving not in ("collecting", "held"):
            return solving
        if faults:
            return faults[0]
        if all(getattr(frame, feature) is None for feature in FEATURES):
            return "nothing_seen"
        if self.settings.model == "line" and view.edges and not added["line"]:
            return "no_edge"
        return solving
