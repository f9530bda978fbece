"""The C library over a whole flight: the Python package ``goe`` (port/python).

Pixels and poses go in unchanged, in float32; the answers are those that firmware would get, image by image. The
float64 build of the library (``double_precision``) gets the same inputs and settings, also rounded to float32."""

from __future__ import annotations

import importlib
import importlib.util
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from . import double_precision
from .flights.flight import Flight
from .flights.noise import Noise
from .places import ROOT

PACKAGE = ROOT / "port" / "python"
METHODS = {"window": 1, "filter": 2}
MODEL_AUTO, MODEL_DISC, MODEL_LINE, MODEL_BOX, MODEL_PRISM = 1, 2, 3, 4, 5
QUANTITIES = ("x0_m", "z0_m", "orientation_deg", "width_m", "length_m", "height_m")
NUMBERS = ("x_m", "z_m", "velocity_north_m_s", "velocity_east_m_s", "latency_s")  # of Track.more, with sigmas
HAZARD = (
    "tcpa_s", "dcpa_m", "clearance_m", "tcpa_sd_s", "dcpa_sd_m", "clearance_sd_m", "conflict_probability",
    "has_clearance",
)  # fmt: skip
TO_RADIANS = np.where(np.arange(6) == 2, np.pi / 180.0, 1.0)
SETTING_OF = {  # noise figure: setting of the library
    "sigma_px": "detector.point_noise_px",
    "size_share": "detector.point_noise_rel",
    "correlation": "detector.point_correlation",
    "shape_error_rel": "detector.shape_error_rel",
    "attitude_bias_sd_deg": "navigation.attitude_bias_sd_deg",
    "attitude_white_sd_deg": "navigation.attitude_white_sd_deg",
    "attitude_walk_sd_deg": "navigation.attitude_walk_sd_deg",
    "height_m": "navigation.height_bias_sd_m",
    "velocity_bias_sd_m_s": "navigation.velocity_bias_sd_m_s",
    "position_walk_sd_m": "navigation.position_walk_sd_m",
    "prior_width_m": "filter.prior_width_m",
}
LEVEL = {  # the simulated ground, and an altimeter with a constant error only
    "navigation.height_white_sd_m": 0.0, "navigation.terrain_slope_sd": 0.0, "navigation.terrain_height_sd_m": 0.0,
}  # fmt: skip
SMALLEST = {  # values that the library accepts
    "detector.point_noise_px": 0.05, "navigation.attitude_bias_sd_deg": 1e-3, "navigation.attitude_white_sd_deg": 1e-4,
    "navigation.height_bias_sd_m": 1e-3,
}  # fmt: skip


@dataclass(frozen=True)
class Plan:
    """Distances for goe_decide after each image. ``grows``: margins grow with suspicion and age, by the library's own
    rule; otherwise they are constant, and the hazard is that of goe_hazard."""

    margin_m: float
    clearance_m: float
    grows: bool = False


@dataclass
class Images:
    """The library's inputs over a track of K images."""

    time_s: np.ndarray  # (K,)
    position_ned_m: np.ndarray  # (K, 3)
    attitude: np.ndarray  # (K, 4) w, x, y, z
    height_m: np.ndarray  # (K,) of the camera above the ground
    pixel_px: np.ndarray  # (K, 6, 2) left, right, top, base left, near, right; any number where not visible
    seen: np.ndarray  # (K, 6)
    box_px: np.ndarray | None = None  # (K, 4) left, top, right, bottom; NaN where not visible
    reset_count: np.ndarray | None = None  # (K,) of the autopilot's filter
    reset_m: np.ndarray | None = None  # (K, 3) size of its jump; NaN: unknown
    velocity_m_s: np.ndarray | None = None  # (K, 3) intended, for goe_hazard
    plans: tuple[Plan, ...] = ()
    kind: np.ndarray | None = None  # (K, 5) of goe_kind_t: width, sigma, height, sigma, shape
    camera: np.ndarray | None = None  # (K,) camera number; the settings more_cameras[0] describe number 1


@dataclass
class Track:
    """The answers of an estimator over K images. Quantities in the order x0, z0, orientation (rad), width, length,
    height; NaN where they are not valid."""

    status: np.ndarray  # (K,) goe_status_t
    method: np.ndarray  # (K,) 1 window, 2 filter, 0 none
    model: np.ndarray  # (K,) goe_model_t
    fresh: np.ndarray  # (K,) solved from this image
    suspect: np.ndarray  # (K,) the track does not fit a static obstacle
    values: np.ndarray  # (K, 6)
    sigma: np.ndarray  # (K, 6)
    covariance: np.ndarray  # (K, 6, 6), 0 where not valid
    nis: np.ndarray  # (K,)
    nis_rows: np.ndarray  # (K,)
    nis_ratio: np.ndarray  # (K,)
    images_used: np.ndarray | None = None  # (K,) images used by the answer
    hazard: dict[str, np.ndarray] = field(default_factory=dict)  # "status", "act", columns of ``HAZARD``: (K, plans)
    more: dict[str, np.ndarray] = field(default_factory=dict)  # columns that some versions lack, (K,)

    @property
    def valid(self) -> np.ndarray:
        """Whether each quantity is valid: (K, 6)."""
        return np.isfinite(self.values)


@lru_cache(maxsize=1)
def _bindings() -> Any:
    """port/python/bindings.py, which knows the sources of the package."""
    spec = importlib.util.spec_from_file_location("goe_bindings", PACKAGE / "bindings.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@lru_cache(maxsize=1)
def package() -> Any:
    """The package goe. FileNotFoundError: it is not installed, or was built from other sources than this checkout's."""
    try:
        goe = importlib.import_module("goe")
    except ImportError as error:
        raise FileNotFoundError(
            f"the Python package goe is not installed ({error}); tools/setup.sh installs it"
        ) from None
    if PACKAGE.is_dir():
        here = _bindings().fingerprint(ROOT / "lib", ROOT / "port" / "flight", ROOT / "port" / "cmake")
        if here != goe.FINGERPRINT:
            place = Path(goe.__file__).parent
            raise FileNotFoundError(f"{place}: not built from the sources in {ROOT}; tools/setup.sh rebuilds it")
    return goe


def ready(double: bool = False) -> None:
    """Raises FileNotFoundError, with a remedy, if the library (``double``: its float64 build) cannot be called."""
    package()
    if double:
        double_precision.library_path()


def has_setting(name: str) -> bool:
    """Whether the library has a setting of that name."""
    return any(row.name == name for row in package().setting_rows())


def reason_names() -> tuple[str, ...]:
    """Names for the numbers in the column ``reason`` of ``Track.more``."""
    return ("none", *(str(reason) for reason in package().Reason))


def camera_settings(flight: Flight) -> dict[str, float]:
    """Settings by name for a flight's camera and for the axes of T."""
    camera = flight.camera
    result = {f"camera.{name}_px": getattr(camera, name) for name in ("fx", "fy", "cx", "cy")}
    result |= {f"camera.{name}": getattr(camera, name) for name in ("k1", "k2", "p1", "p2", "k3")}
    result |= {f"camera.mount_{axis}_deg": getattr(camera, f"mount_{axis}_deg") for axis in ("yaw", "pitch", "roll")}
    result |= {f"camera.{name}_px": size for name, size in zip(("width", "height"), flight.image_size_px)}
    result |= {f"camera.offset_m[{i}]": getattr(camera, f"offset_{axis}_m") for i, axis in enumerate("xyz")}
    return result | {"heading_auto": 0.0, "heading_deg": camera.heading_deg or 0.0}


def settings_of(flight: Flight, noise: Noise | None = None, method: str = "filter") -> dict[str, float]:
    """Settings by name for a flight's camera and noise, as a user would configure them."""
    noise = flight.noise if noise is None else noise
    result = camera_settings(flight) | LEVEL
    result |= {"filter.top_is_highest": float(flight.top_is_highest), "method": float(METHODS[method])}
    result |= {setting: getattr(noise, name) for name, setting in SETTING_OF.items()}
    return {name: max(value, SMALLEST.get(name, value)) for name, value in result.items()}


def known_shape(flight: Flight) -> dict[str, float]:
    """The setting of a user who knows what the camera looks at, as the paper does: a cylinder is configured as a disc,
    and is round. By default the filter does not know how deep an obstacle is before the line of sight has turned."""
    return {"model": float(MODEL_DISC)} if flight.truth.kind == "disc" else {}


def estimate(
    flight: Flight, settings: dict[str, float] | None = None, *, double: bool = False,
    cameras: np.ndarray | None = None, **change: float,
) -> Track:  # fmt: skip
    """Runs the library over a flight. ``settings``: by default ``settings_of(flight)``; ``change``: single settings on
    top, with "__" for the dot (``noise__pixel_px=0.5``). ``double``: in float64.
    ``cameras``: (K,) camera number of each image; the settings ``more_cameras[0]`` describe number 1."""
    values = dict(settings_of(flight) if settings is None else settings)
    values.update({name.replace("__", "."): value for name, value in change.items()})
    return run(replace(images_of(flight), camera=cameras), values, double=double)


def images_of(flight: Flight) -> Images:
    return Images(
        flight.time_s, flight.position_ned_m, flight.attitude, flight.height_m, flight.pixel_px, flight.seen,
        flight.box_px,
    )  # fmt: skip


def to_package(images: Images) -> Any:
    """Converts to goe.Images."""
    return package().Images(
        np.rint(images.time_s * 1e6).astype(np.int64), images.position_ned_m, images.attitude, images.height_m,
        images.box_px, images.pixel_px, images.seen, images.reset_count, images.reset_m, kind=images.kind,
        camera=images.camera, velocity_ned_m_s=images.velocity_m_s,
    )  # fmt: skip


@lru_cache(maxsize=64)
def named_settings(named: tuple[tuple[str, float], ...]) -> Any:
    """Converts to goe.Settings; cached, since the tracks of a case share their settings."""
    return package().Settings.from_names(dict(named))


def run(images: Images, settings: dict[str, float], *, double: bool = False) -> Track:
    """Runs the library over a track."""
    goe = package()
    plans = images.plans if images.velocity_m_s is not None else ()
    fixed = {"suspect_factor": 1.0, "stale_growth_m_s": 0.0}
    rules = [goe.Rule(p.margin_m, p.clearance_m, **({} if p.grows else fixed)) for p in plans]
    run_track = double_precision.run if double else goe.run
    output = run_track(named_settings(tuple(settings.items())), to_package(images), rules=rules, covariance=True)
    return _track(output)


def _hazard(output: Any) -> dict[str, np.ndarray]:
    """The hazard columns of a goe.Track; empty without rules."""
    if not output.hazards.shape[1]:
        return {}
    columns = {name: output.hazards[name].astype(float) for name in HAZARD}
    return {"status": output.hazard_status.astype(float), "act": output.decision == package().Decision.ACT, **columns}


def _track(output: Any) -> Track:
    """Converts a goe.Track."""
    column, sigma = output.estimates, output.estimates["sigma"]
    values, sigmas = (np.stack([of[name] for name in QUANTITIES], 1) * TO_RADIANS for of in (column, sigma))
    valid = output.valid
    more = {name: column[name] for name in ("reason", "age_s", "trajectory_heading_deg")}
    for name in NUMBERS:
        unit = "_m_s" if name.endswith("_m_s") else name[-2:]
        sd_name = f"{name[: -len(unit)]}_sd{unit}"
        more |= {name: column[name].astype(float), sd_name: sigma[name].astype(float)}
    return Track(
        output.status, column["method"], column["model"], column["fresh"], column["suspect"],
        np.where(valid, values, np.nan), np.where(valid, sigmas, np.nan),
        output.covariance * TO_RADIANS[:, None] * TO_RADIANS,
        column["nis"].astype(float), column["nis_rows"], column["nis_ratio"].astype(float), column["images_used"],
        _hazard(output), more,
    )  # fmt: skip
