"""The edges of the base: (1) and the gates of the paper's Section 4; choice of the side edge; the low-pass."""

from __future__ import annotations

import math

from ..gates import UNIT_ROUNDOFF, Gates
from ..settings import Settings
from .geometry import Point, heading_deg
from .precision import Numbers, Real, Rounding
from .view import Edge, View

POINT_ROUNDOFF = UNIT_ROUNDOFF  # of an aligned coordinate in float32, relative to 1 + |coordinate|


def heading_roundoff_deg(a: Point, b: Point) -> Rounding:
    xa, ya, xb, yb = float(a.x), float(a.y), float(b.x), float(b.y)
    across, along = xa * yb - ya * xb, yb - ya
    size2 = max(across**2 + along**2, 1e-300)
    coordinates = abs(xa) + abs(ya) + abs(xb) + abs(yb)
    return math.degrees(POINT_ROUNDOFF * (abs(along) * coordinates + 2.0 * abs(across)) / size2)


def measure_edge(n: Numbers, settings: Settings, fx_px: Real, gates: Gates, name: str, a: Point, b: Point) -> Edge:
    """The gates of the paper's Section 4."""
    real = n.real
    least, du, dv = real(settings.edge_min_px), b.u_px - a.u_px, b.v_px - a.v_px
    length2 = du * du + dv * dv
    size = max(abs(a.u_px), abs(a.v_px), abs(b.u_px), abs(b.v_px))
    if not gates.decide(f"counts:{name}", length2 > least * least, math.sqrt(length2) - least, size):
        return Edge(a, b, False, None)
    rise, least = abs(b.y - a.y) * fx_px, real(settings.orientation_min_px)
    size = float(fx_px) * (4.0 + abs(float(a.y)) + abs(float(b.y)))
    if not gates.decide(f"rises:{name}", rise > least, rise - least, size):
        return Edge(a, b, True, None)
    return Edge(a, b, True, heading_deg(n, a, b), heading_roundoff_deg(a, b))


def find_edges(n: Numbers, settings: Settings, fx_px: Real, view: View) -> None:
    points = view.points
    for a, b in (("base_left", "base_near"), ("base_near", "base_right"), ("base_left", "base_right")):
        if a in points and b in points:
            left, right = points[a].x, points[b].x
            size = 4.0 + abs(float(left)) + abs(float(right))
            if not view.gates.decide(f"order:{a}:{b}", left <= right, right - left, size):
                view.faults.append("swapped")
                return
    pairs = [("base_left", "base_near"), ("base_near", "base_right")]
    if "base_near" not in points:
        pairs = [("base_left", "base_right")]
    for a, b in pairs:
        if a in points and b in points:
            view.edges.append(measure_edge(n, settings, fx_px, view.gates, f"{a}:{b}", points[a], points[b]))


class Orientation:
    """The orientation of one obstacle and its low-pass."""

    def __init__(self, n: Numbers, memory: int) -> None:
        self.n, self.memory, self.count = n, memory, 0
        self.deg = self.variance_deg2 = n.zero
        self.roundoff_deg = 0.0

    def turn(self) -> tuple[Real, Real]:
        """Sine and cosine."""
        return self.n.sincos_deg(self.deg)

    def _hypothesis(self, side: Edge | None, front: Edge | None) -> Real:
        """The orientation if ``side`` is the side edge."""
        if side is not None and side.heading_deg is not None:
            return side.heading_deg
        assert front is not None and front.heading_deg is not None
        return self.n.fold_deg(front.heading_deg - self.n.right_angle_deg)

    def update(self, view: View) -> None:
        """Distinguishes the side edge from the front edge and updates the orientation, if an edge has one."""
        n, gates, fold = self.n, view.gates, self.n.fold_deg
        if all(edge.heading_deg is None for edge in view.edges):
            return
        first, second = view.edges[0], view.edges[1] if len(view.edges) > 1 else None
        roundoff = max(edge.roundoff_deg for edge in view.edges)
        size = 180.0 + roundoff / UNIT_ROUNDOFF
        if_first, if_second = self._hypothesis(first, second), self._hypothesis(second, first)
        off_first, off_second = abs(if_first), abs(if_second)
        if self.count > 0:
            gap = abs(off_first - off_second)
            if gates.decide("ambiguous", gap < n.ambiguous_deg, n.ambiguous_deg - gap, size):
                off_first, off_second = abs(fold(if_first - self.deg)), abs(fold(if_second - self.deg))
        first_is_side = gates.decide("first_is_side", off_first <= off_second, off_second - off_first, size)
        view.measured = True
        view.side, view.front = (first, second) if first_is_side else (second, first)
        view.side_is_right = not first_is_side
        measured = self._choose_end(gates, "end:measured", if_first if first_is_side else if_second, size)
        self._low_pass(gates, measured, roundoff, size)

    def _low_pass(self, gates: Gates, measured: Real, roundoff: Rounding, size: Rounding) -> None:
        n, fold, before, step = self.n, self.n.fold_deg, measured, self.n.zero
        if self.count > 0:
            before, step = self.deg, self._choose_end(gates, "end:step", fold(measured - self.deg), size)
        self.count = min(self.count + 1, self.memory)
        gain = n.one / n.real(self.count)
        self.deg = self._choose_end(gates, "end:filter", fold(before + step * gain), size)
        self.variance_deg2 = self.variance_deg2 + (step * step - self.variance_deg2) * gain
        self.roundoff_deg += (roundoff - self.roundoff_deg) / self.count

    def _choose_end(self, gates: Gates, name: str, deg: Real, size: Rounding) -> Real:
        """An angle in (-90, 90]. The choice of the end near 90 is a decision. size: of the angle's operands."""
        if abs(deg) > 45.0:
            positive = gates.decide(name, deg > self.n.zero, 90.0 - abs(float(deg)), size)
            if positive != (deg > self.n.zero):
                return deg + (self.n.half_turn_deg if positive else -self.n.half_turn_deg)
        return deg
