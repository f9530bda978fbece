"""The errors of a flight's measurements."""

from __future__ import annotations

import math
from dataclasses import dataclass

ROUNDING_PX = 0.29  # 1 / sqrt(12)
MIN_PIXEL_PX = 0.05


@dataclass(frozen=True)
class Noise:
    """Errors of a run, which are also the estimator's configuration."""

    pixel_px: float = 0.5
    rounding: bool = False  # to whole pixels
    size_share: float = 0.0  # of the obstacle's width in the image
    correlation: float = 0.0  # from image to image
    shape_error_rel: float = 0.0  # shape error of the disc model, share of the width
    attitude_bias_sd_deg: float = 0.0  # each body axis
    attitude_white_sd_deg: float = 0.0
    attitude_walk_sd_deg: float = 0.0  # per sqrt(s)
    height_m: float = 0.0
    velocity_bias_sd_m_s: float = 0.0  # north and east
    position_walk_sd_m: float = 0.0  # per sqrt(s), each axis
    outliers: float = 0.0  # share of the points
    outlier_px: float = 15.0
    prior_width_m: float = 6.0

    @property
    def sigma_px(self) -> float:
        """Sigma of a coordinate of an image point, including rounding, px."""
        return max(math.hypot(self.pixel_px, ROUNDING_PX if self.rounding else 0.0), MIN_PIXEL_PX)


FIELD = Noise(
    attitude_bias_sd_deg=0.5, attitude_white_sd_deg=0.1, height_m=0.5, velocity_bias_sd_m_s=0.05,
    position_walk_sd_m=0.05,
    outliers=0.02,
)  # fmt: skip
NOISES = {
    "gauss0.3": Noise(pixel_px=0.3),
    "gauss1": Noise(pixel_px=1.0),
    "rounding": Noise(pixel_px=0.0, rounding=True),
    "field": FIELD,
}
