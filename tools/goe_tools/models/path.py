"""The smoothed path of the vehicle: the places that the images before predict for each image.

A line through the places at the marks so far, by least squares; from ``MARKS`` on its gains stay constant.
"""

from __future__ import annotations

import numpy as np

MARKS = 6
SPAN_S = 0.09  # least time from mark to mark
SPAN_MAX_S = 0.6  # after a longer gap the path begins again


def off_path(time_s: np.ndarray, place_m: np.ndarray) -> np.ndarray:
    """(K, 3): each place minus the predicted one; 0 where no line predicts it. time_s (K,), place_m (K, 3)."""
    off = np.zeros_like(place_m)
    mark, velocity, marked_s, marks = place_m[0], np.zeros(3), float(time_s[0]), 1
    for k in range(1, len(time_s)):
        since_s = float(time_s[k]) - marked_s
        if since_s >= SPAN_MAX_S:
            mark, velocity, marked_s, marks = place_m[k], np.zeros(3), float(time_s[k]), 1
            continue
        stray = place_m[k] - (mark + velocity * since_s)
        if marks >= 2:
            off[k] = stray
        if since_s >= SPAN_S:
            marks = min(marks + 1, MARKS)
            mark = place_m[k] - stray * (marks - 1) * (marks - 2) / (marks * (marks + 1))
            velocity = velocity + 6 / (marks * (marks + 1)) * stray / since_s
            marked_s = float(time_s[k])
    return off
