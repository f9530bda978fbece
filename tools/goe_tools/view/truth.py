"""The true value of each quantity: of the point that the estimate describes, with front and side named as in it.

Disc and prism: the obstacle's center; width: of a prism the extent across the line of sight of the first
image, of a disc that represents a box none. Front edge and box: the center of the front edge; front and side so that
the true orientation is nearer to the estimate's. NaN: unknown; also the position of a moving obstacle.
"""

from __future__ import annotations

import math

import numpy as np

from ..flights.rotations import fold
from ..logs.obslog import Truth
from .answers import Answers

MODELS_OF_EDGE = ("line", "box")  # their point is the center of the front edge
EXCHANGE_ANGLE = math.pi / 4.0
RIM = 48


def _filled(values: np.ndarray) -> np.ndarray:
    """(K,): a gap gets the next value, or else the previous one."""
    known = np.flatnonzero(np.isfinite(values))
    if not len(known):
        return values
    return values[known[np.minimum(np.searchsorted(known, np.arange(len(values))), len(known) - 1)]]


def footprint(truth: Truth) -> np.ndarray:
    """(P, 2) north, east of the outline on the ground; empty if unknown or moving."""
    middle = np.array([truth.center_n_m, truth.center_e_m])
    if truth.length_m is None or truth.heading_deg is None:
        turn = 2.0 * np.pi * np.arange(RIM) / RIM
        points = middle + 0.5 * truth.width_m * np.stack([np.cos(turn), np.sin(turn)], -1)
    else:
        along, across = _axes(truth)
        signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        steps = signs[:, :1] * 0.5 * truth.width_m * across + signs[:, 1:] * 0.5 * truth.length_m * along
        points = middle + steps
    return points if truth.static and np.isfinite(points).all() else np.empty((0, 2))


def _axes(truth: Truth) -> tuple[np.ndarray, np.ndarray]:
    """North and east of the unit vectors along length and width."""
    heading = math.radians(truth.heading_deg or 0.0)
    return np.array([math.cos(heading), math.sin(heading)]), np.array([-math.sin(heading), math.cos(heading)])


def _extent_across(truth: Truth, sight_ne: np.ndarray) -> float:
    """Extent of the footprint across a line of sight, m."""
    if truth.length_m is None or truth.heading_deg is None:
        return truth.width_m
    across = np.array([-sight_ne[1], sight_ne[0]]) / max(float(np.hypot(*sight_ne)), 1e-9)
    along, side = _axes(truth)
    return abs(truth.length_m * float(along @ across)) + abs(truth.width_m * float(side @ across))


def true_columns(truth: Truth, answers: Answers) -> dict[str, np.ndarray]:
    """(K,) by the names of ``Answers.column``."""
    count, nothing = len(answers), np.full(len(answers), np.nan)
    result = dict.fromkeys(("x_m", "z_m", "width_m", "length_m", "orientation_deg"), nothing)
    result["height_m"] = np.full(count, truth.height_m)
    middle = np.array([truth.center_n_m, truth.center_e_m])
    sight = middle - answers.camera_ne_m
    result["width_m"] = np.full(count, _extent_across(truth, sight[0]) if truth.static else math.nan)
    is_box = truth.length_m is not None and truth.heading_deg is not None
    if is_box:
        angle, width, length = _named_as(truth, answers)
        result |= {"length_m": length, "orientation_deg": np.degrees(angle)}
        as_box, as_disc = _is(answers.model, *MODELS_OF_EDGE), _is(answers.model, "disc")
        result["width_m"] = np.where(as_box, width, np.where(as_disc, np.nan, result["width_m"]))
        heading = angle + answers.heading_rad
        near = 0.5 * length[:, None] * np.stack([np.cos(heading), np.sin(heading)], -1)
        sight = sight - np.where(as_box[:, None], near, 0.0)
    if truth.static:
        c, s = np.cos(answers.heading_rad), np.sin(answers.heading_rad)
        result |= {"z_m": sight[:, 0] * c + sight[:, 1] * s, "x_m": sight[:, 1] * c - sight[:, 0] * s}
    return result


def _is(models: list[str], *wanted: str) -> np.ndarray:
    """(K,): whether the estimate's model is one of these; before an estimate as in the first one."""
    return np.nan_to_num(_filled(np.array([math.nan if m == "none" else float(m in wanted) for m in models]))) > 0.5


def _named_as(truth: Truth, answers: Answers) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(K,) each: orientation (rad), width, length, with front and side named as in the estimates."""
    assert truth.length_m is not None and truth.heading_deg is not None
    angle = fold(math.radians(truth.heading_deg) - answers.heading_rad)
    answered = _filled(np.radians(answers.column["orientation_deg"]))
    with np.errstate(invalid="ignore"):
        other = np.abs(fold(answered - angle)) > EXCHANGE_ANGLE
    return (
        np.where(other, fold(angle + 0.5 * math.pi), angle), np.where(other, truth.length_m, truth.width_m),
        np.where(other, truth.width_m, truth.length_m),
    )  # fmt: skip
