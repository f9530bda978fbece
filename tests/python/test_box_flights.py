"""Upright boxes, simulated and recorded, against geometry computed here and logs written here."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from goe_tools.flights.box_logs import (
    FOLDER_VARIABLE,
    final_depth,
    kitti_box_flights,
    kitti_feeds,
    odmd_flights,
    odmd_folder,
)
from goe_tools.flights.boxes import BUILDING, EXACT, MAST, WALL, BoxOptions, box_flight, clipped, correlated
from goe_tools.flights.flight import Flight
from goe_tools.logs.obslog import LogError

IMAGE = (1280.0, 1280.0)
ROLLING = replace(EXACT, roll_deg=25.0)


def in_camera(flight: Flight, points_ned: np.ndarray) -> np.ndarray:
    """Points (N, 3) as ahead, right and down of an unmounted camera, (K, N, 3), with quaternions by vector algebra."""
    w, axis = flight.attitude[:, None, :1], -flight.attitude[:, None, 1:]  # conjugate: NED to body
    way = points_ned - flight.position_ned_m[:, None]
    twice = 2.0 * np.cross(axis, way)
    return way + w * twice + np.cross(axis, twice)


def corners_ned(flight: Flight) -> np.ndarray:
    """Corners of the box, (8, 3), from its middle at the first image; T looks north."""
    truth = flight.truth
    middle = flight.position_ned_m[0, :2] + [truth.z0_m, truth.x0_m]
    c, s = math.cos(truth.orientation_rad), math.sin(truth.orientation_rad)
    side, front = np.array([c, s]) * truth.length_m / 2, np.array([-s, c]) * truth.width_m / 2
    base = [middle + i * side + j * front for i in (-1, 1) for j in (-1, 1)]
    return np.array([[*point, down] for point in base for down in (0.0, -truth.height_m)])


# ----------------------------------------------------------------------------------------------------------- simulated


@pytest.mark.parametrize("solid", [BUILDING, WALL], ids=lambda solid: solid.name)
def test_an_exact_box_frames_the_projected_corners(solid: object) -> None:
    uncut = 0
    for seed in range(1, 6):
        flight = box_flight(solid, ROLLING, seed)
        ahead, right, down = np.moveaxis(in_camera(flight, corners_ned(flight)), -1, 0)
        u, v = 640.0 + 914.0 * right / ahead, 640.0 + 914.0 * down / ahead
        frame = np.stack([u.min(1), v.min(1), u.max(1), v.max(1)], 1)
        seen = np.isfinite(flight.box_px[:, 0])
        assert np.allclose(flight.box_px[seen], np.clip(frame[seen], 0.0, 1279.0), atol=1e-6)
        inside = ((frame > 0.0) & (frame < 1279.0)).all(1)
        assert seen[inside].all()
        uncut += inside.sum()
    assert uncut > 200


def test_the_sides_of_a_masts_box_touch_its_rims() -> None:
    """Each side is a plane through the camera. The farthest point of a circle along the plane's normal is known in
    closed form."""
    flight = box_flight(MAST, ROLLING, 3)
    truth = flight.truth
    middle = np.array([flight.position_ned_m[0, 0] + truth.z0_m, flight.position_ned_m[0, 1] + truth.x0_m, 0.0])
    axes = np.moveaxis(in_camera(flight, flight.position_ned_m[0] + np.eye(3)), 0, 0) - in_camera(
        flight, flight.position_ned_m[:1]
    )  # (K, 3, 3): north, east, down as (ahead, right, down)
    touched = 0
    for k, box in enumerate(flight.box_px):
        for side, edge in enumerate(box):
            if not 1.0 < edge < 1278.0:
                continue
            normal = np.zeros(3)  # outward normal in (ahead, right, down): zero on the plane of the side
            normal[0], normal[1 + side % 2] = 640.0 - edge, 914.0
            normal *= 1.0 if side > 1 else -1.0
            ned = axes[k] @ normal
            middle_out = ned @ (middle - flight.position_ned_m[k])
            out = middle_out + truth.width_m / 2 * math.hypot(ned[0], ned[1]) + max(0.0, -truth.height_m * ned[2])
            depth = truth.z0_m - (flight.position_ned_m[k, 0] - flight.position_ned_m[0, 0])
            assert abs(out) / depth < 0.05, (k, side)  # px: ``out`` is pixels times depth
            touched += 1
    assert touched > 200


def test_boxes_are_cut_at_the_border() -> None:
    nan = [math.nan] * 4
    box = np.array([
        [100.0, 200.0, 300.0, 400.0], [-50.0, -5.0, 300.0, 1500.0], [1200.0, 10.0, 1400.0, 20.0],
        [-300.0, 10.0, 15.0, 90.0], [1265.0, 10.0, 1500.0, 90.0], [10.0, -90.0, 90.0, -1.0], nan,
    ])  # fmt: skip
    cut = clipped(box, IMAGE)
    assert cut[:3].tolist() == [[100.0, 200.0, 300.0, 400.0], [0.0, 0.0, 300.0, 1279.0], [1200.0, 10.0, 1279.0, 20.0]]
    assert np.isnan(cut[3:]).all()


def test_a_flight_starts_and_ends_with_a_box() -> None:
    flight = box_flight(BUILDING, BoxOptions(roll_deg=10.0), 4)
    assert np.isfinite(flight.box_px[[0, -1]]).all() and flight.time_s[0] == 0.0
    assert flight.image_size_px == IMAGE and not flight.seen.any()
    again, other = (box_flight(BUILDING, BoxOptions(roll_deg=10.0), seed) for seed in (4, 5))
    assert np.array_equal(flight.box_px, again.box_px, equal_nan=True) and flight.truth == again.truth
    assert flight.truth != other.truth


def test_the_detectors_error_has_its_size_and_its_memory() -> None:
    noisy = replace(EXACT, box_noise_rel=0.04, box_correlation_time_s=1.0)
    errors, after, white = [], [], []
    for seed in range(60):
        exact, flight = (box_flight(MAST, options, seed).box_px[:80] for options in (EXACT, noisy))
        size = np.tile(exact[:, 2:] - exact[:, :2], 2)
        inside = ((exact > 30.0) & (exact < 1250.0)).all(1) & (size > 0).all(1)
        count = int(np.argmin(inside)) if not inside.all() else len(inside)
        share = ((flight - exact) / size)[:count]
        errors.append(share)
        after.append(share[8:] * share[:-8])  # one second later
        white.append((box_flight(MAST, replace(EXACT, box_noise_px=0.5), seed).box_px[:80] - exact)[:count])
    variance = float(np.mean(np.concatenate(errors) ** 2))
    assert math.sqrt(variance) == pytest.approx(0.04, rel=0.05)
    assert np.mean(np.concatenate(after)) / variance == pytest.approx(math.exp(-1.0), abs=0.07)
    assert np.std(np.concatenate(white)) == pytest.approx(0.5, rel=0.03)


def test_a_process_that_forgets_at_uneven_times() -> None:
    t = np.array([0.0, 0.5, 2.0])
    drawn = np.stack([correlated(t, 1.0, 400, np.random.default_rng(seed)) for seed in range(50)])
    first, second, third = np.moveaxis(drawn, 1, 0)
    assert np.std(drawn, (0, 2)) == pytest.approx(1.0, abs=0.03)
    assert np.mean(first * second) == pytest.approx(math.exp(-0.5), abs=0.03)
    assert np.mean(first * third) == pytest.approx(math.exp(-2.0), abs=0.03)


def test_reported_heights() -> None:
    def reported(**change: object) -> np.ndarray:
        return np.array([box_flight(MAST, replace(EXACT, **change), seed).height_m[:60] for seed in range(30)])

    assert np.all(reported() == 20.0)
    assert set(np.unique(reported(ground_off_m=3.0))) == {17.0, 23.0}
    assert np.std(reported(height_white_sd_m=3.0) - 20.0) == pytest.approx(3.0, rel=0.1)
    anything = reported(altimeter=False)
    assert np.ptp(anything, 1).max() == 0.0 and np.std(anything[:, 0]) > 20.0


def test_pose_errors_are_as_configured() -> None:
    exact = [box_flight(MAST, EXACT, seed) for seed in range(40)]
    biased = [box_flight(MAST, replace(EXACT, attitude_bias_sd_deg=0.5), seed) for seed in range(40)]
    cosines = [np.abs((a.attitude * b.attitude).sum(1)) for a, b in zip(exact, biased)]
    turned = np.array([np.degrees(2 * np.arccos(np.minimum(c, 1.0))) for c in (cosine[[0, -1]] for cosine in cosines)])
    assert np.allclose(turned[:, 0], turned[:, 1], atol=1e-4)  # the same in every image
    assert math.sqrt(np.mean(turned**2)) == pytest.approx(0.5 * math.sqrt(3.0), rel=0.2)
    drifting = [box_flight(MAST, replace(EXACT, velocity_bias_sd_m_s=0.05), seed) for seed in range(40)]
    speeds = [(b.position_ned_m - a.position_ned_m)[-1] / a.time_s[-1] for a, b in zip(exact, drifting)]
    assert np.std(np.array(speeds)[:, :2]) == pytest.approx(0.05, rel=0.25)
    assert np.all(np.array(speeds)[:, 2] == 0.0)


# ------------------------------------------------------------------------------------------------------------ recorded

CAMERA = (
    "camera.width = 1242\ncamera.height = 375\ncamera.fx = 700\ncamera.fy = 700\ncamera.cx = 600\ncamera.cy = 170\n"
)
FRAMES = "t_s,id,n_m,e_m,d_m,agl_m,qw,qx,qy,qz,box_left_px,box_top_px,box_right_px,box_bottom_px,score\n"
EAST = "0.70710678,0,0,0.70710678"  # the nose points east


def write_set(folder: Path, heading: str, frames: str, truth: str) -> None:
    folder.mkdir(parents=True)
    (folder / "camera.ini").write_text(f"{CAMERA}trajectory.heading_deg = {heading}\n")
    (folder / "frames.csv").write_text(FRAMES + frames)
    (folder / "truth.csv").write_text(truth)


@pytest.fixture
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two cars, one of them without truth, in one sequence of one feed, and one track of ODMD."""
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    cars = (
        f"0.0,3,1,2,0,1.65,{EAST},500,150,560,200,1\n0.0,4,1,2,0,1.65,{EAST},1,2,3,4,1\n"
        f"0.1,3,1,4,0,1.65,{EAST},,151,570,,1\n0.2,3,1,,0,1.65,{EAST},480,152,580,210,1\n"
        f"0.3,3,1,8,0,1.65,{EAST},490,152,580,210,1\n"
    )
    truth = (
        "id,static,frames,center_n_m,center_e_m,ground_d_m,width_m,length_m,height_m,heading_deg\n"
        "3,1,4,-4,32,1.65,1.6,3.5,1.5,0\n"
    )
    write_set(tmp_path / "kitti_boxes" / "FEED" / "seq0001", "auto", cars, truth)
    tracks = "".join(f"{0.1 * k:.1f},7,{10 - 5 * k},1,0,200,1,0,0,0,300,150,{310 - k},170,\n" for k in range(3))
    write_set(tmp_path / "odmd" / "val_robot", "0", tracks, "id,static,depth_m\n7,1,90\n")
    return tmp_path


def test_kittis_boxes_are_read(data: Path) -> None:
    (feed,) = kitti_feeds()
    (flight,) = kitti_box_flights(feed)
    assert (flight.group, flight.name) == ("FEED", "FEED/seq0001/3")
    assert flight.time_s.tolist() == [0.0, 0.1, 0.3]  # one image has no position
    assert np.isfinite(flight.box_px).tolist() == [[True] * 4, [False, True, True, False], [True] * 4]
    assert flight.box_px[2].tolist() == [490.0, 152.0, 580.0, 210.0] and flight.image_size_px == (1242.0, 375.0)
    assert flight.camera.heading_deg == pytest.approx(90.0)
    truth = flight.truth
    assert (truth.x0_m, truth.z0_m, truth.height_m) == pytest.approx((5.0, 30.0, 1.5))  # the camera flies east
    assert truth.static and flight.path_m() == pytest.approx(6.0)


def test_odmds_depth_is_that_of_the_last_image(data: Path) -> None:
    folder = odmd_folder("val_robot")
    assert folder is not None
    (flight,) = odmd_flights(folder)
    assert flight.truth.z0_m == pytest.approx(80.0)  # the camera flew backwards by 10 m
    assert final_depth(flight) == pytest.approx(90.0) and math.isnan(flight.truth.height_m)
    assert flight.box_px[:, 2].tolist() == [310.0, 309.0, 308.0]


def test_a_lever_arm_moves_the_camera(data: Path) -> None:
    with open(data / "kitti_boxes/FEED/seq0001/camera.ini", "a") as file:
        file.write("camera.offset_x_m = 2\n")
    (flight,) = kitti_box_flights(data / "kitti_boxes/FEED")
    assert (flight.truth.x0_m, flight.truth.z0_m) == pytest.approx((5.0, 28.0))


def test_absent_boxes_are_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "nothing"))
    assert kitti_feeds() == [] and odmd_folder("val_robot") is None


def test_a_bad_log_is_reported_by_line_and_column(data: Path) -> None:
    frames = data / "odmd/val_robot/frames.csv"
    frames.write_text(frames.read_text().replace(",309,", ",wide,"))
    with pytest.raises(LogError, match=r"frames\.csv:3: box_right_px: 'wide'"):
        list(odmd_flights(frames.parent))
    frames.write_text(frames.read_text().replace("box_top_px", "top"))
    with pytest.raises(LogError, match=r"box_top_px: column is missing"):
        list(odmd_flights(frames.parent))
    (frames.parent / "truth.csv").unlink()
    with pytest.raises(LogError, match=r"truth\.csv"):
        list(odmd_flights(frames.parent))
