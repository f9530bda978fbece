"""Thin and small obstacles of real drives and flights, with the default settings: bollards, cones, signs and cars of
Argoverse 2, whose boxes are projected with a detector's noise, and the poles of the ODA data set.

The folders av2 and oda are in the folder of ``box_logs``. A track counts once, with its last answer; a track without
one counts as infinitely wrong."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from goe_tools.flights.box_logs import boxes_folder
from goe_tools.flights.rotations import level_axes, matrices
from goe_tools.library import METHODS, Images, Track, run
from goe_tools.logs.obslog import Camera, Frame, ObservationLog, read_log

from .goal import OPEN, Goal, Range
from .work import Amount

SETS = ("av2", "oda")
Z0 = 1
WANTED: dict[str, Range] = {"BOLLARD": (0.0, 1.0), "CONSTRUCTION_CONE": (0.0, 4.0), "pole": (0.0, 8.0)}
SUSPECT_MOST: Range = (0.0, 5.0)
SIGMA_MOST: Range = (0.0, 20.0)  # % of the range, of the poles


@dataclass(frozen=True)
class Judged:
    """One track. Errors and sigmas in percent of the range at its first image, NaN without an answer."""

    kind: str
    error: np.ndarray
    sigma: np.ndarray
    suspect: bool


def logs() -> list[Path]:
    """The folders of the logs; none without the data."""
    return sorted(path.parent for name in SETS for path in (boxes_folder() / name).glob("*/frames.csv"))


def _settings_of(name: str, camera: Camera) -> dict[str, float]:
    result = {f"{name}.{key}_px": getattr(camera, key) for key in ("fx", "fy", "cx", "cy", "width", "height")}
    result |= {f"{name}.{key}": getattr(camera, key) for key in ("k1", "k2", "p1", "p2", "k3")}
    result |= {f"{name}.mount_{axis}_deg": getattr(camera, f"mount_{axis}_deg") for axis in ("yaw", "pitch", "roll")}
    return result | {f"{name}.offset_m[{i}]": getattr(camera, f"offset_{axis}_m") for i, axis in enumerate("xyz")}


def _cameras(log: ObservationLog) -> list[Camera]:
    return [log.camera] + ([log.camera2] if log.camera2 else [])


def _shown(frames: list[Frame]) -> list[Frame]:
    """From the first box on, which fixes T."""
    first = next((i for i, f in enumerate(frames) if f.box_px and any(side is not None for side in f.box_px)), None)
    return [] if first is None else frames[first:]


def _way(log: ObservationLog, first: Frame, center_ne_m: np.ndarray) -> np.ndarray:
    """(2,): north, east, from the camera at the first box to the obstacle."""
    camera = _cameras(log)[first.camera]
    arm = matrices(np.array(first.attitude)) @ [getattr(camera, f"offset_{axis}_m") for axis in "xyz"]
    return center_ne_m - (np.array(first.position_m) + arm)[:2]


def _estimate(log: ObservationLog, frames: list[Frame], heading_deg: float) -> Track:
    count = len(frames)
    boxes = [[math.nan if side is None else side for side in f.box_px or (None,) * 4] for f in frames]
    images = Images(
        np.array([f.t_s for f in frames]) - frames[0].t_s, np.array([f.position_m for f in frames]),
        np.array([f.attitude for f in frames]), np.array([f.height_m for f in frames]), np.zeros((count, 6, 2)),
        np.zeros((count, 6), bool), np.array(boxes), camera=np.array([f.camera for f in frames]),
    )  # fmt: skip
    settings = {"heading_auto": 0.0, "heading_deg": heading_deg}
    for name, camera in zip(("camera", "more_cameras[0]"), _cameras(log)):
        settings |= _settings_of(name, camera)
    return run(images, settings)


def tracks(folder: Path) -> Iterator[Judged]:
    """The tracks of static obstacles."""
    log = read_log(folder)
    with open(folder / "truth.csv", encoding="utf-8", newline="") as file:
        truth = {int(row["id"]): row for row in csv.DictReader(file)}
    for key, all_frames in log.tracks().items():
        frames, row = _shown(all_frames), truth.get(key)
        if row is None or row["static"] != "1" or not frames:
            continue
        way = _way(log, frames[0], np.array([float(row["center_n_m"]), float(row["center_e_m"])]))
        heading = math.atan2(way[1], way[0])
        z0 = float(level_axes(heading)[2, :2] @ way)
        track = _estimate(log, frames, math.degrees(heading))
        known = (track.method == METHODS["filter"]) & np.isfinite(track.values[:, Z0])
        error = np.where(known, np.abs(track.values[:, Z0] - z0), math.nan)
        sigma = np.where(known, track.sigma[:, Z0], math.nan)
        yield Judged(row.get("class") or "pole", 100 * error / z0, 100 * sigma / z0, bool(track.suspect.any()))


def _last(values: np.ndarray) -> float:
    known = values[np.isfinite(values)]
    return float(known[-1]) if len(known) else math.inf


def _inside(track: Judged) -> float:
    """Share of a track's answers within two sigmas; NaN without one."""
    known = np.isfinite(track.error)
    return float(np.mean((track.error < 2 * track.sigma)[known])) if known.any() else math.nan


def goals_of(group: str, kind: str, judged: list[Judged]) -> list[Goal]:
    name = f"{len(judged)} {kind.lower().replace('_', ' ')}s"
    error, sigma = (float(np.median([_last(getattr(t, of)) for t in judged])) for of in ("error", "sigma"))
    inside = 100.0 * float(np.nanmean([_inside(track) for track in judged]))
    suspect = 100.0 * float(np.mean([track.suspect for track in judged]))
    wanted = ("Z0",) if kind in WANTED else ()
    sure = ("tracks",) if kind in ("BOLLARD", "CONSTRUCTION_CONE") else ()
    goals = [
        Goal(group, f"{name}: Z0 error at the end, median", "%", {"Z0": error}, WANTED.get(kind, OPEN), wanted),
        Goal(group, f"{name}: within 2 sigma", "%", {"Z0": inside}),
        Goal(group, f"{name}: suspect", "%", {"tracks": suspect}, SUSPECT_MOST, sure),
    ]
    if kind == "pole":
        goals.append(Goal(group, f"{name}: sigma of Z0 at the end", "%", {"Z0": sigma}, SIGMA_MOST, ("Z0",)))
    return goals


def thin_group(group: str, amount: Amount) -> list[Goal]:
    of_kind: dict[str, list[Judged]] = {}
    for folder in logs():
        for judged in tracks(folder):
            of_kind.setdefault(judged.kind, []).append(judged)
    return [goal for kind in sorted(of_kind) for goal in goals_of(group, kind, of_kind[kind])]
