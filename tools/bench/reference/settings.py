"""The settings of the window method, except the camera."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Settings:
    """Defaults are the paper's."""

    model: str = "auto"  # auto, disc, line
    window: int = 8
    line_points: int = 8
    edge_min_px: float = 10.0
    orientation_min_px: float = 2.0
    side_min_px: float = 10.0
    orientation_memory: int = 20
    min_baseline_m: float = 0.1
