"""From directions in NED to raw pixels: mounting, pinhole, lens (Brown-Conrady, as in OpenCV).

Flat arrays, one entry for each image.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .genes import Array, Params
from .motion import rotation

DEPTH_LEAST_M = 0.3
BEYOND_CORNER = 1.25  # the lens model is valid up to this multiple of the corner's radius


@dataclass
class View:
    """Camera axes and optics of N images."""

    axes: Array  # (N, 3, 3) NED to camera: rows are right, down, along the optical axis
    focal: Array  # (N, 2)
    center: Array  # (N, 2)
    size: Array  # (N, 2)
    lens: Array  # (N, 4) k1, k2, p1, p2
    reach: Array  # (N,) largest valid radius on the plane at depth 1

    def take(self, chosen: np.ndarray) -> View:
        return View(*(getattr(self, name)[chosen] for name in ("axes", "focal", "center", "size", "lens", "reach")))


def mounted(yaw_deg: Array, pitch_deg: Array, roll_deg: Array) -> Array:
    """(..., 3, 3): rows are the camera's right, down and axis, in body axes."""
    turned = rotation(np.radians(yaw_deg), np.radians(pitch_deg), np.radians(roll_deg))
    return np.stack([turned[..., 1], turned[..., 2], turned[..., 0]], -2)


def corner_radius(p: Params) -> Array:
    """Radius of the image's corner, at depth 1, without the lens."""
    return np.hypot(0.53 * p["width_px"] / p["fx_px"], 0.53 * p["image_height_px"] / p["fy_px"])


def view(p: Params, body: Array, mount: Array, flight: np.ndarray) -> View:
    def pair(one: str, other: str) -> Array:
        return np.stack([p[one][flight], p[other][flight]], 1)

    return View(
        mount @ np.swapaxes(body, -1, -2), pair("fx_px", "fy_px"), pair("cx_px", "cy_px"),
        pair("width_px", "image_height_px"),
        np.stack([p[name][flight] for name in ("k1", "k2", "p1", "p2")], 1), BEYOND_CORNER * corner_radius(p)[flight],
    )  # fmt: skip


def bent(x: Array, y: Array, lens: Array) -> tuple[Array, Array]:
    """Applies the lens; ``lens`` (..., 4) has the shape of x and y."""
    k1, k2, p1, p2 = (lens[..., i] for i in range(4))
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * k2)
    u = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)
    v = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y
    return u, v


def project(seen_by: View, relative: Array) -> tuple[Array, np.ndarray]:
    """Pixels (N, P, 2) of points relative to the camera (N, P, 3), and whether they are ahead, within the valid
    field."""
    inside = relative @ np.swapaxes(seen_by.axes, 1, 2)
    depth = inside[..., 2]
    ahead = depth > DEPTH_LEAST_M
    safe = np.where(ahead, depth, 1.0)
    x, y = inside[..., 0] / safe, inside[..., 1] / safe
    if np.any(seen_by.lens):
        good = np.hypot(x, y) < seen_by.reach[:, None]
        bends = np.any(seen_by.lens != 0.0, 1)[:, None]
        ahead = ahead & (good | ~bends)
        x, y = bent(x, y, seen_by.lens[:, None, :])
    return np.stack([x, y], -1) * seen_by.focal[:, None] + seen_by.center[:, None], ahead


def in_image(seen_by: View, pixels: Array) -> np.ndarray:
    """(N, P) from (N, P, 2)."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.all((pixels >= 0.0) & (pixels <= seen_by.size[:, None]), -1))
