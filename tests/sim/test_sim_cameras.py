"""Two cameras: the camera of each logged image, its correct projection, and a track that continues from one camera
to the other."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from sim_support import Camera, Log, box_corners, fly, poses, run
from test_sim_boxes import boxes, cut
from test_sim_projection import LENS

TOLERANCE_PX = 1e-3
BORDER_PX = 0.01  # nearer to the border it depends on rounding whether the whole obstacle is visible
SOLVED = {"ok", "partial"}
EXACT = ("--features", "boxes", "--noise", "none")
PASSING = ("--x0", "-40", "--reach", "12", "--yaw-camera", "-25", "--second-camera", "-75,0", "--run", "11.5")


def cameras(log: Log) -> tuple[Camera, Camera]:
    return Camera(log.camera), Camera(log.camera, "camera2")


def projected(log: Log, camera: Camera) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Boxes (frames, 4) of an obstacle with corners, uncut; whether all of it is ahead of the camera; the angle
    between its middle and the axis, rad."""
    corners = box_corners(log.truth)
    position, attitude = poses(log.exact)
    framed, ahead, angle = [], [], []
    for k in range(len(position)):
        pixels, depth = camera.project(position[k], attitude[k], corners)
        framed.append([*pixels.min(axis=0), *pixels.max(axis=0)])
        ahead.append((depth > 0.5).all())
        ray = attitude[k].inv().apply(corners.mean(axis=0) - position[k]) - camera.offset
        angle.append(math.acos(camera.axes_in_body[2] @ ray / np.linalg.norm(ray)))
    return np.array(framed), np.array(ahead), np.array(angle)


# ---------------------------------------------------------------------------------------------------- whose image it is

SCENES = {
    "side by side": ("--second-camera", "-75,0", "--yaw-camera", "-25"),
    "rolling, offset": ("--second-camera", "-70,-5", "--yaw-camera", "-20", "--offset-x", "1.5", "--offset-y", "-0.5",
                        "--roll-camera", "6", "--roll-amplitude-deg", "15"),
    "one above the other": ("--second-camera", "-5,0", "--pitch-camera", "14", "--yaw-camera", "-30",
                            "--image-height", "500"),
}  # fmt: skip


@pytest.mark.parametrize("scene", SCENES)
def test_the_row_is_of_the_camera_that_sees_it_whole_or_nearer_to_its_axis(
    goe_sim: Path, tmp_path: Path, scene: str
) -> None:
    shape = ("--obstacle", "box:8,12,14", "--alpha", "20", "--x0", "-40", "--reach", "14", "--run", "13", "--fps", "20")
    log = fly(goe_sim, tmp_path / "log", *EXACT, *shape, *SCENES[scene])
    number = log.frames["camera"].astype(int)
    assert np.array_equal(number, log.exact["camera"]) and set(number) == {0, 1}
    framed, ahead, angle = (np.stack(of_both) for of_both in zip(*(projected(log, camera) for camera in cameras(log))))
    border = np.array([log.camera["camera.width"] - 1.0, log.camera["camera.height"] - 1.0])
    margin = np.minimum(framed[..., :2], border - framed[..., 2:]).min(axis=-1)
    whole = ahead & (margin > 0.0)
    expected = np.where(whole[0] != whole[1], whole[1], angle[1] < angle[0])
    clear = (np.abs(margin) > BORDER_PX).all(axis=0)
    assert np.array_equal(number[clear], expected[clear]) and clear.mean() > 0.95
    against_the_axis = expected != (angle[1] < angle[0])
    assert against_the_axis.any() == (scene == "one above the other")
    rows = np.arange(len(number))
    logged = ahead[number, rows]
    assert np.allclose(
        boxes(log)[logged], cut(log, framed[number, rows])[logged], atol=TOLERANCE_PX, rtol=0, equal_nan=True
    )


def test_the_height_is_that_of_the_camera_at_hand(goe_sim: Path, tmp_path: Path) -> None:
    arm = ("--offset-x", "3", "--offset-z", "0.5")
    log = fly(goe_sim, tmp_path / "log", *EXACT, *PASSING, *arm, "--roll-amplitude-deg", "10")
    position, attitude = poses(log.exact)
    eye = [Camera(log.camera).eye(position[k], attitude[k]) for k in range(len(position))]
    assert log.frames["agl_m"] == pytest.approx(log.truth["ground_d_m"] - np.array(eye)[:, 2], abs=1e-9)


def test_a_camera_that_sees_nothing_changes_nothing_but_the_column(goe_sim: Path, tmp_path: Path) -> None:
    options = ("--noise", "field", "--features", "boxes", *LENS)
    one = fly(goe_sim, tmp_path / "one", *options)
    two = fly(goe_sim, tmp_path / "two", *options, "--second-camera", "150,0")
    assert "camera" not in one.frames and (two.frames.pop("camera") == 0.0).all()
    for name, column in one.frames.items():
        assert np.array_equal(column, two.frames[name], equal_nan=True)
    assert one.truth == two.truth
    others = {key: value for key, value in two.camera.items() if key.startswith("camera2.")}
    assert {key: value for key, value in two.camera.items() if key not in others} == one.camera
    changed = {key[8:] for key, value in others.items() if value != one.camera[f"camera.{key[8:]}"]}
    assert len(others) == len(one.camera) - 1 and changed == {"mount_yaw_deg"}


@pytest.mark.parametrize("angles", ["", "30", "30,", "30,x", "nan,0", "30,0,0", "400,0"])
def test_bad_angles_are_named(goe_sim: Path, tmp_path: Path, angles: str) -> None:
    done = run(goe_sim, "--out", tmp_path / "log", "--second-camera", angles, expect=2)
    assert (
        "mounting angles" if angles == "400,0" else f"--second-camera: '{angles}' cannot be taken: YAW,PITCH"
    ) in done.stderr
    assert not list(tmp_path.iterdir())


# ----------------------------------------------------------------------------------------------------------- goe_replay

PASSAGES = {
    "cylinder, boxes": ("--obstacle", "cylinder", "--features", "boxes"),
    "building, boxes": ("--obstacle", "box:12,16,15", "--alpha", "30", "--features", "boxes"),
    "cylinder, points": ("--obstacle", "cylinder", "--features", "points"),
    "building, corners": ("--obstacle", "box:12,16,15", "--alpha", "30", "--features", "corners"),
}
SEEDS = range(1, 7)


def center_error(row: dict[str, str], truth: dict[str, float], drift_m: np.ndarray) -> float:
    """The larger error of the two coordinates, in its sigmas. The center counts from the logged pose, which drifts."""
    place = (float(row[f"center_{a}_m"]) - drift_m[i] - truth[f"center_{a}_m"] for i, a in enumerate("ne"))
    return max(abs(off_m) / float(row[f"center_{a}_sd_m"]) for off_m, a in zip(place, "ne"))


@pytest.mark.parametrize("passage", PASSAGES)
def test_a_track_goes_on_from_one_camera_to_the_other(
    programs: dict[str, Path], goe_sim: Path, tmp_path: Path, passage: str
) -> None:
    """From the camera that looks ahead to the one that looks aside, with the library's default settings."""
    for seed in SEEDS:
        log = fly(goe_sim, tmp_path / "log", *PASSAGES[passage], *PASSING, "--noise", "field", "--seed", seed)
        rows = list(csv.DictReader(run(programs["goe_replay"], tmp_path / "log").stdout.splitlines()))
        number = log.frames["camera"].astype(int)
        change = int(np.argmax(number))
        assert change > 40 and (number[change:] == 1).all() and len(rows) - change > 8
        solved = [row["status"] in SOLVED for row in rows]
        assert all(solved[change - 3 : change + 3]) and all(solved[change:])
        used = [int(row["images_used"]) for row in rows[change - 1 :]]
        assert (np.diff(used) == 1).all()  # no track restarts
        assert len({row["model"] for row in rows[change - 1 : change + 1]}) == 1
        drift_m = poses(log.frames)[0] - poses(log.exact)[0]
        assert max(center_error(rows[k], log.truth, drift_m[k]) for k in range(change, len(rows))) < 3.0
        before, last = (float(rows[k]["center_n_sd_m"]) for k in (change - 1, -1))
        assert last < before * (
            0.75 if "boxes" in passage else 1.01
        )  # by points: as small as the drift of the position allows; by boxes the depth remains
