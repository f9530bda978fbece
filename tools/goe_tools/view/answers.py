"""The library's estimate of each obstacle of a log, image by image, and the decision of ``goe_decide``.

The library runs through the Python package, bit for bit as in goe_replay. NaN: not valid, not known.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from .. import library
from ..logs.obslog import FEATURES, NO_KIND, TIME_LIMIT_US, Camera, Frame, ObservationLog
from ..logs.progress import Progress
from .motion import Motion

MODEL_NAMES = {0: "none", 2: "disc", 3: "line", 4: "box", 5: "prism"}
MODEL_SETTINGS = {"auto": 1, "disc": 2, "line": 3}
SETTING_GROUPS = ("navigation", "detector", "filter", "window")  # --set may change these, as in goe_replay
TIME_UNKNOWN_S = -(2.0**63) * 1e-6  # in the library's microseconds: GOE_TIME_UNKNOWN
NIS_RATIO_MAX = 1.9  # default of filter.nis_ratio_max
QUANTITIES = ("x0_m", "z0_m", "orientation_deg", "width_m", "length_m", "height_m")
OF_POSITION = ("x_m", "z_m", "x_sd_m", "z_sd_m")
HAZARD = ("tcpa_s", "dcpa_m", "clearance_m", "tcpa_sd_s", "dcpa_sd_m", "clearance_sd_m", "conflict_probability")


@dataclass(frozen=True)
class Options:
    """Options of the replay. ``settings``: by name, as for goe_replay's --set."""

    method: str = "filter"
    model: str = "auto"
    window: int | None = None
    settings: dict[str, float] = field(default_factory=dict)
    margin_m: float = 15.0
    clearance_m: float = 10.0


@dataclass
class Answers:
    """Of one obstacle over K images. ``column``: by goe_replay's names and those of goe_hazard_t, (K,) each, meters,
    degrees, seconds. ``covariance``: (K, 5, 5) of x, z, orientation, width, length in meters and rad, 0: not valid."""

    id: int
    moment: np.ndarray  # (K,) index into Motion
    status: list[str]
    model: list[str]
    reason: list[str]
    suspect: np.ndarray
    fresh: np.ndarray
    age_s: np.ndarray
    heading_rad: np.ndarray  # of T's Z axis, clockwise from north
    camera_ne_m: np.ndarray  # (K, 2) camera position at the latest image that was not rejected
    column: dict[str, np.ndarray]
    covariance: np.ndarray
    act: np.ndarray  # (K,) the decision is: act now

    def __len__(self) -> int:
        return len(self.moment)

    @property
    def answered(self) -> np.ndarray:
        """(K,): whether there is a position, fresh or stale."""
        return np.isfinite(self.column["z_m"])

    def taken(self, keep: np.ndarray) -> Answers:
        """Only the images in ``keep``."""
        changes: dict[str, object] = {}
        for f in dataclasses.fields(self):
            value = getattr(self, f.name)
            if isinstance(value, np.ndarray):
                changes[f.name] = value[keep]
            elif isinstance(value, list):
                changes[f.name] = [value[k] for k in keep]
        column = {name: values[keep] for name, values in self.column.items()}
        return dataclasses.replace(self, column=column, **changes)  # type: ignore[arg-type]


def _of_camera(camera: Camera, owner: str) -> dict[str, float]:
    sizes = {f"{name}_px": getattr(camera, name) for name in ("fx", "fy", "cx", "cy", "width", "height")}
    lens = {name: getattr(camera, name) for name in ("k1", "k2", "p1", "p2", "k3")}
    mount = {f"mount_{axis}_deg": getattr(camera, f"mount_{axis}_deg") for axis in ("yaw", "pitch", "roll")}
    offset = {f"offset_m[{i}]": getattr(camera, f"offset_{axis}_m") for i, axis in enumerate("xyz")}
    return {f"{owner}.{name}": value for name, value in (sizes | lens | mount | offset).items()}


def settings_of(log: ObservationLog, options: Options) -> dict[str, float]:
    """The library's settings by name, as goe_replay sets them for the log and the options."""
    values = _of_camera(log.camera, "camera")
    if log.camera2 is not None:
        values |= _of_camera(log.camera2, "more_cameras[0]")
    if log.camera.heading_deg is not None:
        values |= {"heading_auto": 0.0, "heading_deg": log.camera.heading_deg}
    values |= {"method": float(library.METHODS[options.method]), "model": float(MODEL_SETTINGS[options.model])}
    if options.window is not None:
        values["window.points"] = float(options.window)
    return values | options.settings


def _unusable(frame: Frame) -> bool:
    """A side of the box is given but not a number: the library rejects the image; the package would ignore the side."""
    return frame.box_px is not None and any(side is not None and not math.isfinite(side) for side in frame.box_px)


def _images(frames: Sequence[Frame], velocity_m_s: np.ndarray, options: Options) -> library.Images:
    nothing, unknown = (0.0, 0.0), (math.nan,) * 3
    given = [[getattr(frame, feature) for feature in FEATURES] for frame in frames]
    position = np.array([unknown if _unusable(frame) else frame.position_m for frame in frames], float)
    times = np.array([frame.t_s for frame in frames], float)
    with np.errstate(invalid="ignore", over="ignore"):
        times = np.where(np.abs(times * 1e6) < TIME_LIMIT_US, times, TIME_UNKNOWN_S)
    none = (math.nan,) * 4
    boxes = [[math.nan if side is None else side for side in frame.box_px or none] for frame in frames]
    return library.Images(
        times, position, np.array([frame.attitude for frame in frames], float),
        np.array([frame.height_m for frame in frames], float),
        np.array([[pixel or nothing for pixel in row] for row in given], float),
        np.array([[pixel is not None for pixel in row] for row in given]),
        np.array(boxes, float),
        np.array([frame.reset_count & 0xFF for frame in frames]),
        np.array([frame.reset_delta_m or unknown for frame in frames], float),
        velocity_m_s, (library.Plan(options.margin_m, options.clearance_m, grows=True),),
        np.array([frame.kind or NO_KIND for frame in frames], float),
        np.array([frame.camera for frame in frames]),
    )  # fmt: skip


def _columns(track: library.Track) -> dict[str, np.ndarray]:
    """By goe_replay's names, degrees."""
    column: dict[str, np.ndarray] = {}
    for i, name in enumerate(QUANTITIES):
        scale = math.degrees(1.0) if name.endswith("_deg") else 1.0
        stem, unit = name.rsplit("_", 1)
        column[name], column[f"{stem}_sd_{unit}"] = scale * track.values[:, i], scale * track.sigma[:, i]
    located = np.isfinite(column["z0_m"])
    column |= {name: np.where(located, track.more[name], np.nan) for name in OF_POSITION}
    column["nis_ratio"] = np.where(track.nis_ratio > 0.0, track.nis_ratio, np.nan)
    column["latency_s"] = track.more["latency_s"]
    for axis in ("north", "east"):
        column[f"velocity_{axis}_m_s"] = track.more[f"velocity_{axis}_m_s"]
    hazard = {name: values[:, 0] for name, values in track.hazard.items()}
    known = hazard["status"] == 0
    column |= {name: np.where(known, hazard[name], np.nan) for name in HAZARD}
    over = known & (hazard["has_clearance"] != 0)
    for name in ("clearance_m", "clearance_sd_m"):
        column[name] = np.where(over, hazard[name], np.nan)
    return column


def _covariance(track: library.Track, column: dict[str, np.ndarray]) -> np.ndarray:
    """(K, 5, 5) of x, z (now), orientation, width, length: goe_covariance, with the sigmas of x and z instead of those
    of x0 and z0, which do not contain the drift of the aircraft's position since then."""
    result = track.covariance[:, :5, :5].copy()
    with np.errstate(invalid="ignore", divide="ignore"):
        for i, name in enumerate(("x", "z")):
            scale = column[f"{name}_sd_m"] / column[f"{name}0_sd_m"]
            scale = np.where(np.isfinite(scale), scale, 1.0)
            result[:, i, :] *= scale[:, None]
            result[:, :, i] *= scale[:, None]
    return result


def _taken_cameras(motion: Motion, moment: np.ndarray, status: np.ndarray) -> np.ndarray:
    """(K, 2): the camera position at the latest image that was not rejected."""
    refused = [int(number) for number in library.package().Status if not number.is_image_taken]
    taken = ~np.isin(status, refused)
    latest = np.maximum.accumulate(np.where(taken, np.arange(len(moment)), 0))
    return motion.camera_ne_m[moment[latest]]


def answers_of(log: ObservationLog, motion: Motion, options: Options) -> list[Answers]:
    """One for each id, in the log's order."""
    settings, reasons = settings_of(log, options), library.reason_names()
    statuses = {int(status): str(status) for status in library.package().Status}
    rows: dict[int, list[int]] = {}
    for i, frame in enumerate(log.frames):
        rows.setdefault(frame.id, []).append(i)
    result = []
    progress, done = Progress("replay", len(log.frames)), 0
    for key, indices in rows.items():
        progress.show(done)
        done += len(indices)
        frames, moment = [log.frames[i] for i in indices], motion.of_frame[indices]
        with np.errstate(
            over="ignore", invalid="ignore"
        ):  # a number beyond float32 becomes infinite, and the library rejects it
            track = library.run(_images(frames, motion.velocity_m_s[moment], options), settings)
        column = _columns(track)
        result.append(Answers(
            key, moment, [statuses[int(s)] for s in track.status],
            [MODEL_NAMES.get(int(m), "none") for m in track.model], [reasons[r] for r in track.more["reason"]],
            track.suspect, track.fresh, track.more["age_s"], np.radians(track.more["trajectory_heading_deg"]),
            _taken_cameras(motion, moment, track.status), column, _covariance(track, column),
            track.hazard["act"][:, 0],
        ))  # fmt: skip
    progress.end()
    return result
