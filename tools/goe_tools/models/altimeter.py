"""The height above the obstacle's ground from the readings of the altimeter, as in the library."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .prism import ErrorModel, Sight

UNKNOWN_SD_M = 1e3  # of a first height that is not set
SCATTER_SEEDS, SCATTER_MEMORY = 8, 64  # readings as configured, and how many their mean square remembers
VARIANCE_MIN_M2 = 1e-12
SCATTER_CHANCE = 1.4  # of the configured scatter: no excess
EXCESS_WEIGHT = 4.0  # of the readings' scatter beyond the configured one


class Altimeter:
    """A first-order Kalman filter of the height's offset: down drifts, and the readings scatter."""

    def __init__(self, errors: ErrorModel) -> None:
        self.errors = errors
        self.lifted_m = 0.0  # by the mean before the start
        self.mean_m = self.noise_m2 = 0.0
        self.bias_m: float | None = None
        self.scatter_m2 = errors.height_white_sd_m**2
        self.readings = 0

    def read(self, sight: Sight, started: bool, span_s: float) -> Sight:
        """Returns the image with the height as known."""
        lacks = sight.given_height_m == 0
        if self.bias_m is None:
            self.bias_m = UNKNOWN_SD_M if lacks else self.errors.height_bias_sd_m
        if not lacks:
            self._average(sight.given_height_m - sight.height_m - self.lifted_m, span_s)
            if not started:
                self.lifted_m += self.mean_m
                self.mean_m = 0.0
        return replace(sight, height_m=sight.height_m + self.lifted_m)

    def _average(self, off_m: float, span_s: float) -> None:
        innovation2 = (off_m - self.mean_m) ** 2 if self.readings else 0.0
        self.scatter_m2 += (innovation2 - self.scatter_m2) / min(self.readings + SCATTER_SEEDS, SCATTER_MEMORY)
        white2 = max(self.errors.height_white_sd_m**2, self.scatter_m2)
        predicted = self.noise_m2 + self.errors.position_walk_sd_m**2 * span_s
        gain = predicted / max(predicted + white2, VARIANCE_MIN_M2) if self.readings else 1.0
        self.readings = min(self.readings + 1, 255)
        self.noise_m2 = gain * white2
        self.mean_m += gain * (off_m - self.mean_m)

    @property
    def sd_m(self) -> float:
        """Above the obstacle's ground, without its slope."""
        excess = max(self.scatter_m2 - SCATTER_CHANCE * self.errors.height_white_sd_m**2, 0.0)
        constant = self.bias_m**2 + self.errors.terrain_height_sd_m**2
        return float(np.sqrt(constant + self.noise_m2 + EXCESS_WEIGHT * excess))
