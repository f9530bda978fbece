"""The aircraft: trim, step responses of its autopilot, limits; and its commanded paths."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from sim_support import fly, poses, run

COLUMNS = (
    "t",
    "height_error",
    "cross_track",
    "course",
    "airspeed",
    "climb",
    "roll",
    "pitch",
    "bank_command",
    "pitch_command",
    "elevator",
    "aileron",
    "rudder",
    "throttle",
)
STEP_AT_S = 2.0


def respond(
    probe: Path, airspeed: float, climb: float, seconds: float, what: str, size: float
) -> dict[str, np.ndarray]:
    text = run(probe, "respond", airspeed, climb, seconds, what, size).stdout
    table = np.fromstring(text, sep=" ").reshape(-1, len(COLUMNS))
    return dict(zip(COLUMNS, table.T))


def step_figures(t: np.ndarray, error: np.ndarray) -> tuple[float, float, float]:
    """Rise time 10 to 90 % (s), overshoot and final error (fractions of the step) of an error that starts at 1."""
    after = t >= STEP_AT_S
    t, error = t[after] - STEP_AT_S, error[after]
    rise = t[np.argmax(error < 0.1)] - t[np.argmax(error < 0.9)]
    return float(rise), float(max(0.0, -error.min())), float(abs(error[-1]))


@pytest.mark.parametrize(("airspeed", "climb"), [(17.0, 0.0), (17.0, -6.0), (17.0, 4.0), (13.0, 0.0), (26.0, -3.0)])
def test_trim_is_an_equilibrium(sim_probe: Path, airspeed: float, climb: float) -> None:
    """Lift, drag and moment of the trim balance: 20 s of flight change nothing, and so does the balance by hand."""
    flown = respond(sim_probe, airspeed, climb, 20.0, "none", 0.0)
    assert np.ptp(flown["airspeed"]) < 1e-9 and np.abs(flown["height_error"]).max() < 1e-9
    assert np.ptp(flown["pitch"]) < 1e-9 and np.abs(flown["roll"]).max() < 1e-12
    ok, alpha, elevator, throttle = np.fromstring(run(sim_probe, "trim", airspeed, climb).stdout, sep=" ")
    assert ok == 1
    pressure_area, weight = 0.5 * 1.225 * airspeed**2 * 0.47, 3.2 * 9.80665
    lift = 0.25 + 4.8 * alpha + 0.35 * elevator
    drag = 0.045 + 0.049 * lift**2
    thrust = 20.0 * throttle - 0.003 * airspeed**2
    slope = np.radians(climb)
    assert pressure_area * lift + thrust * np.sin(alpha) == pytest.approx(weight * np.cos(slope), rel=1e-12)
    assert thrust * np.cos(alpha) - pressure_area * drag == pytest.approx(weight * np.sin(slope), abs=1e-11)
    assert 0.02 - 0.7 * alpha - 1.1 * elevator == pytest.approx(0.0, abs=1e-14)
    assert flown["pitch"][0] == pytest.approx(np.degrees(alpha) + climb, abs=1e-9)


@pytest.mark.parametrize(("airspeed", "climb"), [(17.0, -20.0), (28.0, 30.0), (8.0, 0.0)])
def test_impossible_flight_has_no_trim(sim_probe: Path, airspeed: float, climb: float) -> None:
    assert run(sim_probe, "trim", airspeed, climb).stdout.startswith("0 ")


@pytest.mark.parametrize(
    ("airspeed", "climb", "size"), [(17.0, 0.0, 5.0), (17.0, -6.0, 5.0), (13.0, 0.0, -5.0), (25.0, 0.0, 5.0)]
)
def test_height_step(sim_probe: Path, airspeed: float, climb: float, size: float) -> None:
    flown = respond(sim_probe, airspeed, climb, 62.0, "height", size)
    rise, overshoot, rest = step_figures(flown["t"], flown["height_error"] / size)
    assert 1.0 < rise < 4.0 and overshoot < 0.10 and rest < 1e-3
    assert np.abs(flown["airspeed"] - airspeed).max() < 1.5


@pytest.mark.parametrize(("airspeed", "climb", "size"), [(17.0, 0.0, 10.0), (17.0, -6.0, -10.0), (25.0, 0.0, 10.0)])
def test_cross_track_step(sim_probe: Path, airspeed: float, climb: float, size: float) -> None:
    flown = respond(sim_probe, airspeed, climb, 42.0, "cross", size)
    rise, overshoot, rest = step_figures(flown["t"], -flown["cross_track"] / size)
    assert 1.0 < rise < 4.0 and overshoot < 0.10 and rest < 1e-3
    assert np.abs(flown["height_error"]).max() < 0.5


@pytest.mark.parametrize(("airspeed", "size"), [(17.0, 30.0), (17.0, -60.0), (25.0, 30.0)])
def test_course_step(sim_probe: Path, airspeed: float, size: float) -> None:
    """The path turns at the aircraft's position: the aircraft overshoots, comes back, and settles on the new course."""
    flown = respond(sim_probe, airspeed, 0.0, 62.0, "course", size)
    rise, overshoot, rest = step_figures(flown["t"], 1 - flown["course"] / size)
    assert 0.5 < rise < 5.0 and overshoot < 0.55 and rest < 1e-3
    assert abs(flown["cross_track"][-1]) < 0.01 and np.abs(flown["height_error"]).max() < 1.0


@pytest.mark.parametrize(("airspeed", "size"), [(17.0, 3.0), (17.0, -3.0), (20.0, 5.0)])
def test_speed_step(sim_probe: Path, airspeed: float, size: float) -> None:
    flown = respond(sim_probe, airspeed, 0.0, 62.0, "speed", size)
    rise, overshoot, rest = step_figures(flown["t"], 1 - (flown["airspeed"] - airspeed) / size)
    assert 0.5 < rise < 4.0 and overshoot < 0.15 and rest < 1e-3
    assert np.abs(flown["height_error"]).max() < 0.5


@pytest.mark.parametrize("what", ["height", "cross", "course", "speed"])
@pytest.mark.parametrize("size", [-120.0, 120.0])
def test_limits_are_kept_for_any_command(sim_probe: Path, what: str, size: float) -> None:
    flown = respond(sim_probe, 17.0, 0.0, 40.0, what, size if what != "speed" else size / 12)
    assert np.abs(flown["bank_command"]).max() <= 40.0 + 1e-9 and np.abs(flown["roll"]).max() < 45.0
    assert np.abs(flown["pitch_command"]).max() <= 25.0 + 1e-9 and np.abs(flown["pitch"]).max() < 30.0
    for surface in ("elevator", "aileron", "rudder"):
        assert np.abs(flown[surface]).max() <= 25.0 + 1e-9
    assert flown["throttle"].min() >= 0.0 and flown["throttle"].max() <= 1.0
    assert flown["airspeed"].min() > 9.0 and flown["airspeed"].max() < 32.0
    if what in ("cross", "course"):
        assert np.abs(flown["bank_command"]).max() > 35.0  # the limit was reached


@pytest.mark.parametrize(("glide", "altitude"), [(0.0, 15.0), (6.0, 15.0), (-3.0, 30.0)])
def test_slope_arrives_at_reach_time(goe_sim: Path, tmp_path: Path, glide: float, altitude: float) -> None:
    log = fly(
        goe_sim,
        tmp_path / "log",
        "--obstacle",
        "truck",
        "--glide",
        glide,
        "--altitude",
        altitude,
        "--run",
        "20",
        "--course",
        "33",
    )
    position, _ = poses(log.exact)
    assert log.exact["t_s"][-1] == 20.0
    assert -position[-1, 2] == pytest.approx(altitude, abs=1e-6)
    assert np.hypot(*position[-1, :2]) == pytest.approx(340.0, abs=1e-6)
    slope = np.degrees(np.arctan2(np.diff(position[:, 2]), np.hypot(*np.diff(position[:, :2], axis=0).T)))
    assert slope == pytest.approx(np.full(160, glide), abs=1e-6)


def test_arc_weave_and_ramp_are_flown(goe_sim: Path, tmp_path: Path) -> None:
    """At most 0.5 m (arc) and 1.5 m (weave) from the path, coordinated banks, the obstacle at the end of the reach
    time."""
    arc = fly(goe_sim, tmp_path / "arc", "--obstacle", "truck", "--altitude", "20", "--path", "arc:-300")
    position, attitude = poses(arc.exact)
    assert np.abs(np.hypot(position[:, 0], position[:, 1] + 300.0) - 300.0).max() < 0.5
    roll = attitude.as_euler("ZYX", degrees=True)[:, 2]
    assert np.median(roll[40:]) == pytest.approx(-np.degrees(np.arctan(17.0**2 / 9.80665 / 300.0)), abs=0.5)
    assert arc.truth["z0_m"] == pytest.approx(300.0 * np.sin(340.0 / 300.0), abs=1e-6)

    weave = fly(goe_sim, tmp_path / "weave", "--obstacle", "truck", "--altitude", "20", "--path", "weave:8,10")
    position, _ = poses(weave.exact)
    assert np.abs(position[:, 1] - 8.0 * np.sin(2 * np.pi * position[:, 0] / 170.0)).max() < 1.5
    assert 320.0 < weave.truth["z0_m"] < 340.0 and weave.truth["z0_m"] / 20.0 == pytest.approx(
        position[-1, 0] / 18.0, rel=0.02
    )

    for rate, end in (
        (0.3, 17.0 * 20 + 0.15 * 400),
        (-0.2, 17.0 * 20 - 0.1 * 400),
        (2.0, 17.0 * 5.5 + 5.5**2 + 28.0 * 14.5),
    ):
        ramp = fly(
            goe_sim,
            tmp_path / f"ramp{rate}",
            "--obstacle",
            "truck",
            "--altitude",
            "20",
            "--speed-profile",
            f"ramp:{rate}",
            "--run",
            "20",
        )
        assert ramp.truth["z0_m"] == pytest.approx(end, abs=1e-6)
        assert ramp.exact["n_m"][-1] == pytest.approx(end, abs=3.0)
        speed = np.diff(ramp.exact["n_m"]) / 0.125
        assert speed[20] == pytest.approx(min(17.0 + rate * 20.5 * 0.125, 28.0), abs=0.5)


def test_wind_drifts_the_nose_not_the_path(goe_sim: Path, tmp_path: Path) -> None:
    """5 m/s from the left: the nose points asin(5/17) to the left, the path stays straight; the run starts settled."""
    log = fly(
        goe_sim, tmp_path / "log", "--obstacle", "truck", "--altitude", "20", "--wind-speed", "5", "--wind-from", "-90"
    )
    position, attitude = poses(log.exact)
    yaw = attitude.as_euler("ZYX", degrees=True)[:, 0]
    assert yaw == pytest.approx(np.full(len(yaw), -np.degrees(np.arcsin(5 / 17))), abs=0.2)
    assert np.abs(position[:, 1]).max() < 0.05
    assert log.exact["airspeed_mps"] == pytest.approx(np.full(len(yaw), 17.0), abs=0.05)


@pytest.mark.parametrize(("wind", "height", "airspeed"), [("dryden:light", 1.5, 1.0), ("dryden:moderate", 3.0, 2.2)])
def test_turbulence_is_ridden_out(goe_sim: Path, tmp_path: Path, wind: str, height: float, airspeed: float) -> None:
    """RMS over ten flights of 30 s: height error, airspeed error; the attitude moves as in rough air."""
    errors, speeds, rolls = [], [], []
    for seed in range(10):
        log = fly(
            goe_sim, tmp_path / str(seed), "--obstacle", "building", "--x0", "-150", "--wind", wind, "--seed", seed
        )
        errors.append(-log.exact["d_m"] - 44.5)
        speeds.append(log.exact["airspeed_mps"] - 17.0)
        rolls.append(poses(log.exact)[1].as_euler("ZYX", degrees=True)[:, 2])
    assert 0.2 < np.sqrt(np.mean(np.square(errors))) < height
    assert 0.1 < np.sqrt(np.mean(np.square(speeds))) < airspeed
    assert 1.0 < np.sqrt(np.mean(np.square(rolls))) < 12.0


def test_roll_is_a_sine_on_top_of_the_flight(goe_sim: Path, tmp_path: Path) -> None:
    options = ("--obstacle", "cylinder", "--wind", "dryden:light", "--seed", "3", "--altitude", "40")
    level = fly(goe_sim, tmp_path / "level", *options)
    rolling = fly(goe_sim, tmp_path / "rolling", *options, "--roll-amplitude-deg", "10", "--roll-rate-hz", "0.3")
    (there, flown), (same, turned) = poses(level.exact), poses(rolling.exact)
    assert np.array_equal(there, same)
    angle = np.radians(10.0) * np.sin(2 * np.pi * 0.3 * level.exact["t_s"])
    expected = flown * Rotation.from_rotvec(np.column_stack([angle, 0 * angle, 0 * angle]))
    assert (expected.inv() * turned).magnitude() == pytest.approx(np.zeros(len(angle)), abs=1e-7)


def test_roll_has_its_amplitude_and_its_usual_rate(goe_sim: Path, tmp_path: Path) -> None:
    log = fly(goe_sim, tmp_path / "log", "--obstacle", "cylinder", "--roll-amplitude-deg", "25", "--fps", "40")
    roll_deg = poses(log.exact)[1].as_euler("ZYX", degrees=True)[:, 2]
    assert roll_deg.max() == pytest.approx(25.0, abs=0.05) and roll_deg.min() == pytest.approx(-25.0, abs=0.05)
    upward = log.exact["t_s"][np.flatnonzero(np.diff(np.sign(roll_deg)) > 0)]
    assert len(upward) > 5 and np.diff(upward) == pytest.approx(np.full(len(upward) - 1, 1 / 0.4), abs=0.051)


@pytest.mark.parametrize(
    "options",
    [("--roll-amplitude-deg", "-1"), ("--roll-amplitude-deg", "nan"), ("--roll-rate-hz", "11")],
)
def test_a_roll_that_cannot_be_is_refused(goe_sim: Path, tmp_path: Path, options: tuple[str, ...]) -> None:
    done = run(goe_sim, "--out", tmp_path / "log", *options, expect=2)
    assert "roll" in done.stderr and not list(tmp_path.iterdir())
