"""Triangulation of every point from all images at once, with GTSAM.

GTSAM is not among the pinned packages: its wheel requires a newer pytest than the tests use, although it runs without
it. ``tools/setup.sh --rivals`` installs it to .cache/rivals (tools/requirements-rivals.txt), outside the environment.
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
WORST = 0.25  # relative sigma of the distance above which a point is not located


@cache
def gtsam() -> ModuleType | None:
    """The module, None if it is not installed."""
    if PLACE.is_dir() and str(PLACE) not in sys.path:
        sys.path.append(str(PLACE))  # last: the pinned numpy takes precedence
    try:
        return importlib.import_module("gtsam")
    except ImportError:
        return None


def absent() -> str:
    """The reason why this rival cannot run; empty if it can."""
    return "" if gtsam() else "GTSAM is not installed (tools/setup.sh --rivals; Python 3.11 or newer)"


def triangulation(track: Track) -> Values:
    """Triangulates every corner (or the cylinder's axis) separately, from all images."""
    if gtsam() is None:
        raise RuntimeError(absent())
    return estimate(track, locate) if len(track) >= MIN_IMAGES else {}


def looking_along(rays: np.ndarray) -> np.ndarray:
    """(n,3,3) rotations camera -> T of cameras that look along the rays (n,2), x axis level.

    Each point is then in the middle of the image, where pixel noise equals angular noise; away from the
    axis the noise of aligned points grows with the square of the distance from it.
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
    center = np.zeros(2)
    noise = g.noiseModel.Robust.Create(
        g.noiseModel.mEstimator.Huber.Create(HUBER), g.noiseModel.Isotropic.Sigma(2, sigma)
    )
    key = g.symbol("p", 0)
    graph, start = g.NonlinearFactorGraph(), g.Values()
    try:
        start.insert(key, g.triangulatePoint3(poses, calibration, [center] * len(poses), 1e-9, False))
        for pose in poses:
            camera = g.PinholeCameraCal3_S2(pose, calibration)
            graph.add(g.TriangulationFactorCal3_S2(camera, center, noise, key))
        fit = g.LevenbergMarquardtOptimizer(graph, start).optimize()
        covariance = g.Marginals(graph, fit).marginalCovariance(key)
    except RuntimeError:  # behind a camera, or no parallax
        return None
    point = np.asarray(fit.atPoint3(key))
    ray = point - cameras[-1]
    distance = float(np.linalg.norm(ray))
    known = ray @ covariance @ ray < (WORST * distance**2) ** 2
    return (point, covariance) if known and ray[2] > 0 else None
