"""Triangulation of every point from all images at once, with GTSAM.

GTSAM is not among the pinned packages: its wheel asks for a newer pytest than the tests' own, though it needs none to
run. ``tools/setup.sh --rivals`` puts it into .cache/rivals (tools/requirements-rivals.txt), beside the environment.
"""

from __future__ import annotations

import importlib
import sys
from functools import cache
from types import ModuleType

import numpy as np
from goe_tools.places import ROOT

from .points import Located, Values, estimate
from .track import HUBER, MIN_IMAGES, Track

PLACE = ROOT / ".cache" / "rivals"
WORST = 0.25  # a point whose distance is less sure than this, relative, has not been located


@cache
def gtsam() -> ModuleType | None:
    """The module, None if it is not there."""
    if PLACE.is_dir() and str(PLACE) not in sys.path:
        sys.path.append(str(PLACE))  # last: the pinned numpy goes first
    try:
        return importlib.import_module("gtsam")
    except ImportError:
        return None


def absent() -> str:
    """Why this rival cannot run; empty if it can."""
    return "" if gtsam() else "GTSAM is not installed (tools/setup.sh --rivals; Python 3.11 or newer)"


def triangulation(track: Track) -> Values:
    """Every corner (or the cylinder's axis) triangulated alone, from all images."""
    if gtsam() is None:
        raise RuntimeError(absent())
    return estimate(track, locate) if len(track) >= MIN_IMAGES else {}


def looking_along(rays: np.ndarray) -> np.ndarray:
    """(n,3,3) rotations camera -> T of cameras that look along the rays (n,2), x axis level.

    Seen like this every point lies in the image's middle, where noise in pixels is noise of the angle: far off the
    axis the aligned points' noise grows with the square of the distance from it.
    """
    ahead = np.concatenate([rays, np.ones((len(rays), 1))], 1)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    right = np.stack([ahead[:, 2], np.zeros(len(rays)), -ahead[:, 0]], 1)
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    return np.stack([right, np.cross(ahead, right), ahead], 2)


def locate(rays: np.ndarray, cameras: np.ndarray, sigma: float) -> Located:
    """Linear triangulation as the start, then the robust non-linear fit and its marginal covariance."""
    g = gtsam()
    calibration = g.Cal3_S2(1.0, 1.0, 0.0, 0.0, 0.0)
    poses = [g.Pose3(g.Rot3(r), g.Point3(*c)) for r, c in zip(looking_along(rays), cameras)]
    centre = np.zeros(2)
    noise = g.noiseModel.Robust.Create(
        g.noiseModel.mEstimator.Huber.Create(HUBER), g.noiseModel.Isotropic.Sigma(2, sigma)
    )
    key = g.symbol("p", 0)
    graph, start = g.NonlinearFactorGraph(), g.Values()
    try:
        start.insert(key, g.triangulatePoint3(poses, calibration, [centre] * len(poses), 1e-9, False))
        for pose in poses:
            camera = g.PinholeCameraCal3_S2(pose, calibration)
            graph.add(g.TriangulationFactorCal3_S2(camera, centre, noise, key))
        fit = g.LevenbergMarquardtOptimizer(graph, start).optimize()
        covariance = g.Marginals(graph, fit).marginalCovariance(key)
    except RuntimeError:  # behind a camera, or no parallax
        return None
    point = np.asarray(fit.atPoint3(key))
    ray = point - cameras[-1]
    distance = float(np.linalg.norm(ray))
    known = ray @ covariance @ ray < (WORST * distance**2) ** 2
    return (point, covariance) if known and ray[2] > 0 else None
