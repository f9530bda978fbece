"""JSBSim through the same scenario: another flight model, the same log."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from sim_support import Camera, Log, box_corners, poses, read_log

COMMAND = (sys.executable, "-m", "goe_tools", "jsbsim_flight")

pytest.importorskip("jsbsim")


def fly(goe_sim: Path, folder: Path, *options: object, sim: tuple[str, ...]) -> Log:
    command = [*COMMAND, "--goe-sim", goe_sim, "--out", folder, *options, "--", *sim]
    subprocess.run([str(word) for word in command], check=True)
    return read_log(folder)


@pytest.mark.parametrize(("glide", "wind"), [(0.0, "none"), (6.0, "none"), (6.0, "dryden:light")])
def test_scenario_is_flown(goe_sim: Path, tmp_path: Path, glide: float, wind: str) -> None:
    scenario = ("--glide", glide, "--wind", wind, "--altitude", 44.5, "--reach", 40, "--run", 30, "--course", 20)
    log = fly(goe_sim, tmp_path / "log", *scenario, sim=("--obstacle", "building", "--alpha", "-20", "--noise", "none"))
    position, attitude = poses(log.exact)
    still = wind == "none"
    assert len(position) == 241
    assert log.truth["x0_m"] == pytest.approx(-75.0, abs=1e-9) and log.truth["z0_m"] == pytest.approx(680.0, abs=1e-9)
    wanted = 44.5 + (680.0 - np.hypot(*(position - position[0])[:, :2].T)) * np.tan(np.radians(glide))
    assert -position[:, 2] == pytest.approx(wanted, abs=0.5 if still else 5.0)
    speed = np.linalg.norm(np.diff(position, axis=0), axis=1) / 0.125
    assert speed == pytest.approx(np.full(240, 17.0 / np.cos(np.radians(glide))), abs=0.2 if still else 5.0)
    rolls = attitude.as_euler("ZYX", degrees=True)[:, 2]
    assert np.ptp(rolls) < 0.1 if still else 1.0 < np.ptp(rolls) < 40.0
    camera, corners = Camera(log.camera), box_corners(log.truth)
    for k in range(0, 241, 20):
        pixels, _ = camera.project(position[k], attitude[k], corners)
        found = log.pixels("left")[k]
        assert np.isnan(found).all() or np.abs(pixels - found).max(axis=1).min() < 1e-9
    assert np.isfinite(log.pixels("base_left")).all(axis=1).sum() > 200


def test_ground_is_reported(goe_sim: Path, tmp_path: Path) -> None:
    command = [*COMMAND, "--goe-sim", goe_sim, "--out", tmp_path / "log", "--altitude", "0.05", "--wind",
               "dryden:moderate"]  # fmt: skip
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "hit the ground" in done.stderr
    assert not (tmp_path / "log").exists()
