"""Runs goe_sim, reads its logs, and projects points with independent code, none of it shared with the simulator.

Frames: NED in meters; attitude quaternions (w, x, y, z) body forward-right-down to NED; camera x right, y down, z
ahead.
"""

from __future__ import annotations

import configparser
import csv
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

HANG_S = 600  # guard against a hang
FEATURES = ("left", "right", "top", "base_left", "base_near", "base_right")


@dataclass
class Log:
    """One log: camera.ini, the single row of truth.csv, and both frame tables as float arrays (empty = NaN)."""

    camera: dict[str, float]
    truth: dict[str, float]
    frames: dict[str, np.ndarray]
    exact: dict[str, np.ndarray]

    def pixels(self, name: str, exact: bool = True) -> np.ndarray:
        """Pixels of a feature, shape (frames, 2), NaN where it is not visible."""
        table = self.exact if exact else self.frames
        return np.column_stack([table[f"{name}_u"], table[f"{name}_v"]])


def read_table(path: Path) -> dict[str, np.ndarray]:
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    names = list(rows[0]) if rows else []
    return {name: np.array([float(row[name]) if row[name] != "" else np.nan for row in rows]) for name in names}


def read_log(folder: Path) -> Log:
    parser = configparser.ConfigParser()
    parser.read_string("[log]\n" + (folder / "camera.ini").read_text())
    camera = {key: float(value) for key, value in parser["log"].items()}
    with (folder / "truth.csv").open(newline="") as file:
        (row,) = list(csv.DictReader(file))
    truth = {key: float(value) if value else np.nan for key, value in row.items() if key != "kind"}
    return Log(camera, truth, read_table(folder / "frames.csv"), read_table(folder / "truth_frames.csv"))


def run(program: Path, *arguments: object, expect: int = 0) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == expect, f"{arguments}: exit {done.returncode}, {done.stderr}"
    return done


def fly(program: Path, folder: Path, *arguments: object, expect: int = 0) -> Log:
    run(program, "--out", folder, *arguments, expect=expect)
    return read_log(folder)


def poses(table: dict[str, np.ndarray]) -> tuple[np.ndarray, Rotation]:
    """Positions (frames, 3) and attitudes."""
    position = np.column_stack([table["n_m"], table["e_m"], table["d_m"]])
    quaternion = np.column_stack([table["qx"], table["qy"], table["qz"], table["qw"]])
    return position, Rotation.from_quat(quaternion)


class Camera:
    """Pinhole with Brown-Conrady lens, from the values of a camera.ini; name: camera or camera2."""

    def __init__(self, ini: dict[str, float], name: str = "camera") -> None:
        self.ini = ini = {key.removeprefix(f"{name}."): value for key, value in ini.items()}
        turn = Rotation.from_euler(
            "ZYX",
            [ini["mount_yaw_deg"], ini["mount_pitch_deg"], ini["mount_roll_deg"]],
            degrees=True,
        )
        axes = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])  # camera x, y, z in body axes
        self.axes_in_body = turn.apply(axes)
        self.offset = np.array([ini[f"offset_{axis}_m"] for axis in "xyz"])

    def eye(self, position: np.ndarray, attitude: Rotation) -> np.ndarray:
        return position + attitude.apply(self.offset)

    def project(self, position: np.ndarray, attitude: Rotation, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pixels (n, 2) and depths (n,) of points (n, 3) in NED, for one pose."""
        in_body = attitude.inv().apply(points - position) - self.offset
        ray = in_body @ self.axes_in_body.T
        depth = ray[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            x, y = ray[:, 0] / depth, ray[:, 1] / depth
        r2 = x**2 + y**2
        k1, k2, p1, p2, k3 = (self.ini[f"{name}"] for name in ("k1", "k2", "p1", "p2", "k3"))
        radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
        xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x**2)
        yd = y * radial + p1 * (r2 + 2 * y**2) + 2 * p2 * x * y
        u = self.ini["fx"] * xd + self.ini["cx"]
        v = self.ini["fy"] * yd + self.ini["cy"]
        return np.column_stack([u, v]), depth

    def inside(self, pixels: np.ndarray, depth: np.ndarray, margin: float = 0.0) -> np.ndarray:
        """Whether pixels are inside the image by more than the margin (px); a negative margin allows pixels slightly
        outside."""
        u, v = pixels[:, 0], pixels[:, 1]
        width, height = self.ini["width"], self.ini["height"]
        return (
            (depth > 1e-3)
            & (u >= -0.5 + margin)
            & (u < width - 0.5 - margin)
            & (v >= -0.5 + margin)
            & (v < height - 0.5 - margin)
        )


def box_corners(truth: dict[str, float]) -> np.ndarray:
    """Corners (8, 3), the first four on the ground, in no particular order."""
    heading = np.radians(truth["heading_deg"])
    along = np.array([np.cos(heading), np.sin(heading), 0.0]) * truth["length_m"] / 2
    across = np.array([-np.sin(heading), np.cos(heading), 0.0]) * truth["width_m"] / 2
    center = np.array([truth["center_n_m"], truth["center_e_m"], truth["ground_d_m"]])
    up = np.array([0.0, 0.0, -truth["height_m"]])
    base = np.array([center + i * along + j * across for i in (-1, 1) for j in (-1, 1)])
    return np.vstack([base, base + up])


def passes_through_box(truth: dict[str, float], eye: np.ndarray, target: np.ndarray) -> bool:
    """Whether the line from the eye to the target crosses the inside of the box. Slab method, box shrunk by 1e-7."""
    heading = np.radians(truth["heading_deg"])
    axes = np.array(
        [[np.cos(heading), np.sin(heading), 0.0], [-np.sin(heading), np.cos(heading), 0.0], [0.0, 0.0, -1.0]]
    )
    size = np.array([truth["length_m"], truth["width_m"], truth["height_m"]])
    middle = np.array([truth["center_n_m"], truth["center_e_m"], truth["ground_d_m"] - truth["height_m"] / 2])
    start, way = axes @ (eye - middle), axes @ (target - eye)
    half = size / 2 * (1 - 1e-7)
    enter, leave = 0.0, 1.0
    for axis in range(3):
        if abs(way[axis]) < 1e-15:
            if abs(start[axis]) >= half[axis]:
                return False
            continue
        t = sorted([(-half[axis] - start[axis]) / way[axis], (half[axis] - start[axis]) / way[axis]])
        enter, leave = max(enter, t[0]), min(leave, t[1])
    return enter < leave
