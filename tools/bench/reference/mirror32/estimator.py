"""One obstacle's estimator: the library's chain from an image to an estimate, step by step."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from goe_tools.logs.estimates import NUMBERS, Estimate
from goe_tools.logs.obslog import FEATURES, Camera, Frame

from ..settings import Settings
from .angle import NINETY, fold_deg, note_end, sincos_deg
from .camera import Point, align, camera_of
from .intake import Pose, intake_check
from .projection import WIDTH_MIN, Edge, heading_deg, projection_disc, projection_turn
from .rotation import Matrix, rotation_apply, rotation_from_quaternion, rotation_multiply
from .single import HALF, ONE, ZERO, Decisions, F, within
from .window import Mean, Window, window_solve

LEVEL_NOSE_MIN = F(1.0e-3)
ASIDE_MIN = F(1.7320508)  # tangent of 60 degrees
BEFORE = "before:"  # the decisions of a view that is thrown away when the track begins again
AMBIGUOUS_DEG = F(30.0)
QUARTER = F(0.25)

Pixels = dict[str, tuple[np.float32, np.float32]]


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
        self.taken: Decisions = {}
        self._forget_track()

    def _forget_track(self) -> None:
        window = self.settings.window
        self.sighted = False
        self.heading_cos = self.heading_sin = ZERO
        self.origin_ned_m = [ZERO] * 3
        self.dx_m = self.dz_m = ZERO
        self.time_us: int | None = None
        self.disc, self.line = Window.of(window), Window.of(window)
        self.length, self.height = Mean([ZERO] * window), Mean([ZERO] * window)
        self.filtered_deg = self.variance_deg2 = ZERO
        self.angles = 0
        self.told = Told()

    # -- ego motion

    def _follow(self, pose: Pose) -> Matrix:
        body_to_ned = rotation_from_quaternion(pose.attitude)
        arm = rotation_apply(body_to_ned, self.camera.offset_m)
        position = [pose.position_ned_m[i] + arm[i] for i in range(3)]
        if not self.sighted:
            self._fix_heading(body_to_ned)
            self.origin_ned_m = position
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

    # -- aligned points and rows

    def _align_view(self, turn: Matrix, pixels: Pixels, when: str = "") -> View:
        """``when``: before the names of its decisions."""
        view = View()
        for feature, (u_px, v_px) in pixels.items():
            fault, point = align(self.camera, turn, u_px, v_px)
            self.taken[f"{when}lens:{feature}"] = fault != "lens_failed"
            if fault != "lens_failed":
                self.taken[f"{when}behind:{feature}"] = fault == "behind_camera"
            if point is None:
                view.faults.append(fault)
            else:
                view.points[feature] = point
        return view

    def _may_begin_again(self, turn: Matrix) -> bool:
        if self.heading_setting is not None or "x0_m" in self.told.values:
            return False
        nose = self.camera.camera_to_body
        x = turn[0] * nose[0] + turn[1] * nose[1] + turn[2] * nose[2]
        z = turn[6] * nose[0] + turn[7] * nose[1] + turn[8] * nose[2]
        self.taken["turned"] = bool(np.abs(x) > z)
        return self.taken["turned"]

    def _lies_aside(self, view: View) -> bool:
        for feature, point in view.points.items():
            self.taken[f"aside:{feature}"] = not within(point.x, ASIDE_MIN)
        return all(self.taken[f"aside:{feature}"] for feature in view.points)

    def _open_view(self, pose: Pose, pixels: Pixels) -> View:
        turn = self._follow(pose)
        if self._may_begin_again(turn) and pixels and self._lies_aside(self._align_view(turn, pixels, BEFORE)):
            self._forget_track()
            turn = self._follow(pose)
        self.sighted = self.sighted or bool(pixels)
        return self._align_view(turn, pixels)

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

    # -- edges

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

    # -- orientation

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

    # -- length and height

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

    # -- solution and estimate

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

    def _take_image(self, pose: Pose, pixels: Pixels) -> str:
        view = self._open_view(pose, pixels)
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
