"""Noise that is new in each pose, and configured: the range stays as good as lib/DESIGN.md says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("goe", reason="the Python package is not installed (tools/setup.sh)")

from test_caller_mistakes import FOCAL_PX, IMAGES, MAST_NE_M, SIZE_PX, goe, right

FLIGHTS, FROM = 40, 30  # images before have little range


def errors_in_sigmas(white_m: float) -> np.ndarray:
    """Of the range, the mean of each flight; positive: too far."""
    result = []
    for seed in range(FLIGHTS):
        flown, rng = right(seed), np.random.default_rng(1000 + seed)
        settings = goe.Settings.for_camera(FOCAL_PX, FOCAL_PX, 640.0, 640.0, width_px=SIZE_PX, height_px=SIZE_PX)
        settings.camera.mount_pitch_deg = flown.settings.camera.mount_pitch_deg
        settings.navigation.position_white_sd_m = white_m
        place_m = flown.images.position_ned_m + white_m * rng.normal(size=(IMAGES, 3))
        track = goe.run(settings, replace(flown.images, position_ned_m=place_m))
        heading = np.radians(track.estimates["trajectory_heading_deg"])
        away_m = MAST_NE_M - flown.images.position_ned_m[:, :2]
        true_m = np.cos(heading) * away_m[:, 0] + np.sin(heading) * away_m[:, 1]
        fresh = np.asarray(track.estimates["fresh"], bool) & (np.arange(IMAGES) >= FROM)
        off_m, sigma_m = track.estimates["z_m"] - true_m, track.estimates["sigma"]["z_m"]
        result.append(np.mean(off_m[fresh] / sigma_m[fresh]))
    return np.array(result)


def test_position_noise_that_is_new_in_each_image_hardly_biases_the_range() -> None:
    """With the noise in the derivatives as well, the mean is +1.3 sigma."""
    for white_m, most in ((0.0, 0.5), (0.3, 0.9), (1.0, 2.0)):
        off = errors_in_sigmas(white_m)
        assert abs(off.mean()) < most
        assert np.sqrt(np.mean(off**2)) < 1.2 * most
