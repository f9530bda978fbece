"""Names that version 0.4.0 replaced: an old one is refused, and the error reports the new one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

SETTINGS = {
    "camera.border_share": "camera.border_rel",
    "camera.cut_share": "camera.truncation_rel",
    "navigation.attitude_bias_deg": "navigation.attitude_bias_sd_deg",
    "navigation.attitude_white_deg": "navigation.attitude_white_sd_deg",
    "navigation.attitude_drift_deg": "navigation.attitude_walk_sd_deg",
    "navigation.height_bias_m": "navigation.height_bias_sd_m",
    "navigation.velocity_bias_m_s": "navigation.velocity_bias_sd_m_s",
    "navigation.position_walk_m": "navigation.position_walk_sd_m",
    "navigation.position_white_m": "navigation.position_white_sd_m",
    "navigation.height_white_m": "navigation.height_white_sd_m",
    "navigation.slope": "navigation.terrain_slope_sd",
    "navigation.ground_m": "navigation.terrain_height_sd_m",
    "detector.point_px": "detector.point_noise_px",
    "detector.point_share": "detector.point_noise_rel",
    "detector.shape_share": "detector.shape_error_rel",
    "detector.box_px": "detector.box_noise_px",
    "detector.box_share": "detector.box_noise_rel",
    "detector.correlation_s": "detector.box_correlation_time_s",
    "detector.cut_noise": "detector.truncation_noise_rel",
    "refined.typical_size_m": "filter.prior_width_m",
    "refined.gate_sigma": "filter.gate_sigma",
    "refined.huber_sigma": "filter.huber_sigma",
    "refined.misfit_max": "filter.nis_ratio_max",
    "refined.range_share": "filter.range_sd_rel_max",
    "refined.top_is_highest": "filter.top_is_highest",
    "flight.alive_s": "flight.detector_timeout_s",
    "flight.forget_s": "flight.track_timeout_s",
    "flight.violation_max": "flight.conflict_probability_max",
    "flight.doubt": "flight.suspect_factor",
    "flight.drift_m_s": "flight.stale_growth_m_s",
}
"""As C names them; those of the flight layer begin with "flight."."""

GROUPS = {
    "Camera": "camera", "Navigation": "navigation", "Detector": "detector", "FilterSettings": "filter",
    "FlightSettings": "flight",
}  # fmt: skip

_RULE = {
    "violation_max": "conflict_probability_max", "act_s": "act_within_s", "doubt": "suspect_factor",
    "drift_m_s": "stale_growth_m_s",
}  # fmt: skip
FIELDS: dict[str, Mapping[str, str]] = {
    **{
        name: {
            before.partition(".")[2]: now.partition(".")[2]
            for before, now in SETTINGS.items()
            if now.partition(".")[0] == group and before.partition(".")[2] != now.partition(".")[2]
        }
        for name, group in GROUPS.items()
    },
    "Settings": {"refined": "filter"},
    "DecisionRule": _RULE,
    "Rule": _RULE,
    "Hazard": {
        "time_s": "tcpa_s", "time_sd_s": "tcpa_sd_s", "miss": "dcpa", "violation": "conflict_probability",
        "soonest_s": "earliest_tcpa_s",
    },
    "Estimate": {"images": "images_used", "misfit": "nis_ratio"},
    "Estimator": {"causes": "fault_counts"},
    "ImageNoise": {"attitude_deg": "attitude_sd_deg", "height_m": "height_sd_m", "pixel_px": "pixel_sd_px"},
    "Images": {"points_seen": "points_visible"},
    "Obstacle": {"passed": "receding"},
    "goe": {"Plan": "Intent", "RefinedSettings": "FilterSettings"},
}  # fmt: skip
"""Attributes and keywords by class; those of the package by "goe"."""


def unknown(owner: str, name: str) -> str:
    """What an error says of a name that is not there: an old one with the new one."""
    now = FIELDS.get(owner, {}).get(name)
    return f"unknown name {owner}.{name}: now {owner}.{now}" if now else f"{owner!r} has no attribute {name!r}"


def missing(self: object, name: str) -> object:
    """``__getattr__`` of a class with old names."""
    raise AttributeError(unknown(type(self).__name__, name))


class Renamed:
    """Base of such a class; its constructor refuses old keywords, too."""

    __slots__ = ()

    if not TYPE_CHECKING:  # a checker knows the names

        def __new__(cls, *args, **kwargs):
            for name in FIELDS.get(cls.__name__, {}):
                if name in kwargs:
                    raise TypeError(unknown(cls.__name__, name))
            return super().__new__(cls)

        __getattr__ = missing
