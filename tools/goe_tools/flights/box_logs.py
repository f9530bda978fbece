"""Recorded upright boxes with truth: KITTI's cars as framed by several detectors and trackers, and ODMD.

The data are in the folder that the environment variable GOE_BOXES_DIR names, by default next to this checkout:

    kitti_boxes/FEED/SEQUENCE/    camera.ini, frames.csv, truth.csv: cars, with the middle of the base
    odmd/SET/                     the same files, but truth.csv has one depth for each track

frames.csv has one row for each obstacle and image: t_s, id, pose, and box_left_px, box_top_px, box_right_px,
box_bottom_px, empty if a side was not measured. ODMD's depth is along the camera's axis at the track's last
image (B. A. Griffin and J. J. Corso, "Depth from Camera Motion and Object Detection", CVPR 2021)."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..logs.obslog import POSE_COLUMNS, Camera, LogError, read_camera
from ..places import ROOT
from .flight import Flight, Obstacle
from .noise import Noise
from .rotations import level_axes, matrices

FOLDER_VARIABLE = "GOE_BOXES_DIR"
SIDE_COLUMNS = ("box_left_px", "box_top_px", "box_right_px", "box_bottom_px")
FRAME_COLUMNS = ("t_s", "id", "agl_m", *POSE_COLUMNS, *SIDE_COLUMNS)
CAR_COLUMNS = ("id", "static", "center_n_m", "center_e_m", "width_m", "length_m", "height_m")
DEPTH_COLUMNS = ("id", "depth_m")
ODMD_SETS = ("val_robot", "val_perturb_motion", "val_perturb_detection")


def boxes_folder() -> Path:
    """The folder of the recorded boxes, if it exists."""
    return Path(os.environ.get(FOLDER_VARIABLE) or ROOT.parent / "shared" / "data")


def kitti_feeds() -> list[Path]:
    """The folders of KITTI's feeds; none without the data."""
    return sorted({path.parents[1] for path in (boxes_folder() / "kitti_boxes").glob("*/*/frames.csv")})


def odmd_folder(name: str) -> Path | None:
    """The folder of one of ``ODMD_SETS``; None without the data."""
    folder = boxes_folder() / "odmd" / name
    return folder if (folder / "frames.csv").is_file() else None


def _table(path: Path, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Columns of a CSV file as numbers, NaN where a field is empty."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            reader = csv.DictReader(file)
            rows = list(reader)
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None
    for name in names:
        if name not in (reader.fieldnames or ()):
            raise LogError(path, 1, name, "column is missing")
    result = {name: np.full(len(rows), math.nan) for name in names}
    for k, row in enumerate(rows):
        for name in names:
            try:
                result[name][k] = float(row[name]) if row[name] else math.nan
            except ValueError:
                raise LogError(path, k + 2, name, f"'{row[name]}' is not a number") from None
    return result


def _tracks(folder: Path) -> Iterator[tuple[int, Flight]]:
    """Each id and its flight, without the truth; leaves out images with a bad pose and those before the first box,
    where the track starts."""
    camera = read_camera(folder / "camera.ini")
    table = _table(folder / "frames.csv", FRAME_COLUMNS)
    pose_known = np.isfinite([table[name] for name in ("t_s", "agl_m", *POSE_COLUMNS)]).all(0)
    for key in np.unique(table["id"][pose_known]):
        own = np.flatnonzero(pose_known & (table["id"] == key))
        shown = np.isfinite([table[name][own] for name in SIDE_COLUMNS]).any(0)
        rows = {name: values[own[np.argmax(shown) :]] for name, values in table.items()}
        yield int(key), _flight_of(camera, rows, f"{folder.name}/{key:.0f}")


def _flight_of(camera: Camera, rows: dict[str, np.ndarray], name: str) -> Flight:
    def columns(*names: str) -> np.ndarray:
        return np.stack([rows[column] for column in names], 1)

    attitude, images = columns("qw", "qx", "qy", "qz"), len(rows["t_s"])
    heading = camera.heading_deg
    if heading is None:
        forward = matrices(attitude[0])[:, 0]
        heading = math.degrees(math.atan2(forward[1], forward[0]))
    unknown = Obstacle("box", *[math.nan] * 6)
    return Flight(
        name, "", replace(camera, heading_deg=heading), rows["t_s"], np.zeros((images, 6, 2)),
        np.zeros((images, 6), bool), columns("n_m", "e_m", "d_m"), attitude, rows["agl_m"], unknown, Noise(),
        box_px=columns(*SIDE_COLUMNS), image_size_px=(camera.width, camera.height),
    )  # fmt: skip


def _eye_ned(flight: Flight) -> np.ndarray:
    """(K, 3): position of the camera."""
    camera = flight.camera
    offset = np.array([camera.offset_x_m, camera.offset_y_m, camera.offset_z_m])
    return flight.position_ned_m + matrices(flight.attitude) @ offset


def _ahead_m(flight: Flight) -> float:
    """Distance of the camera along Z between the first and the last image, m."""
    eye = _eye_ned(flight)
    return float(level_axes(flight.heading_rad)[2] @ (eye[-1] - eye[0]))


def kitti_box_flights(feed: Path) -> Iterator[Flight]:
    """Every car of a feed, also moving ones; the reference position of the truth is the middle of the base."""
    for folder in sorted(path.parent for path in feed.glob("*/frames.csv")):
        truth = _table(folder / "truth.csv", CAR_COLUMNS)
        row_of = {int(key): row for row, key in enumerate(truth["id"])}
        for key, flight in _tracks(folder):
            if key not in row_of:
                continue
            car = {name: float(values[row_of[key]]) for name, values in truth.items()}
            way = np.array([car["center_n_m"], car["center_e_m"]]) - _eye_ned(flight)[0, :2]
            x0, z0 = level_axes(flight.heading_rad)[[0, 2], :2] @ way
            yield replace(
                flight, group=feed.name, name=f"{feed.name}/{flight.name}",
                truth=Obstacle("box", float(x0), float(z0), math.nan, car["width_m"], car["length_m"],
                               car["height_m"], car["static"] == 1.0),
            )  # fmt: skip


def odmd_flights(folder: Path) -> Iterator[Flight]:
    """Every track of a set; of the truth only Z0 is known. ``final_depth`` returns the depth."""
    truth = _table(folder / "truth.csv", DEPTH_COLUMNS)
    depth = dict(zip(truth["id"].astype(int), truth["depth_m"]))
    for key, flight in _tracks(folder):
        if key in depth:
            z0 = float(depth[key]) + _ahead_m(flight)
            yield replace(flight, group=folder.name, truth=replace(flight.truth, z0_m=z0))


def final_depth(flight: Flight) -> float:
    """Distance of the obstacle ahead of the camera in the last image, m."""
    return flight.truth.z0_m - _ahead_m(flight)
