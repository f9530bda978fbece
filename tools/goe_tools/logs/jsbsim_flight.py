"""Flies a scenario with JSBSim and writes it as an observation log: a cross-check against another flight model.

JSBSim's stock model glider (minisgs) gets ballast, a motor and an airbrake, and a small autopilot flies it straight
along the course, down the slope, at the given speed. Its true pose, recorded at 50 Hz, is the input of
`goe_sim --flight`, which observes the obstacle from it: geometry, camera and pixel noise come from the simulator, the
motion from JSBSim.

    python -m goe_tools jsbsim_flight --goe-sim build/sim_host/goe_sim --out log -- \
        --obstacle building --alpha -20 --noise rounding

Options after `--` go to goe_sim. Needs the Python package jsbsim.
"""

from __future__ import annotations

import argparse
import csv
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from .whole_file import replacing

FEET_PER_METRE = 1.0 / 0.3048
POUNDS_PER_NEWTON = 1.0 / 4.4482216152605
GRAVITY_MPS2 = 9.80665
STEP_S = 1.0 / 200.0
RECORD_EVERY = 4  # steps
RUN_IN_S = 20.0  # settles trim and turbulence before the recording starts
BALLAST_LBS = 40.0  # brings the glider's wing loading to that of a small UAV at 17 m/s
MOTOR_N, BRAKE_N = 80.0, -40.0  # limits of the force along body x: the glider is too clean for a steep slope
SURFACE_RAD = 0.3  # approximate surface angle of a full command
WIND_AT_20FT_KNOTS = {"none": 0.0, "dryden:light": 15.0, "dryden:moderate": 30.0}
TURBULENCE_MILSPEC = 3

MOTOR = """
    <external_reactions>
        <force name="motor" frame="BODY">
            <location unit="IN"> <x> 0 </x> <y> 0 </y> <z> 0 </z> </location>
            <direction> <x> 1 </x> <y> 0 </y> <z> 0 </z> </direction>
        </force>
    </external_reactions>
</fdm_config>
"""


class Plan(NamedTuple):
    """The flight to fly: meters, seconds, radians; altitude is above ground at reach time."""

    speed: float
    course: float
    glide: float
    altitude: float
    reach: float
    run: float
    wind: str
    seed: int


class State(NamedTuple):
    """Meters, m/s, radians; north and east since the start, height above ground."""

    north: float
    east: float
    height: float
    v_north: float
    v_east: float
    v_down: float
    airspeed: float
    roll: float
    pitch: float
    yaw: float
    roll_rate: float
    pitch_rate: float
    yaw_rate: float


def clamp(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))


def start_model(root: Path, plan: Plan, height: float):
    """The aircraft in flight; JSBSim's files are copied to root and extended by a motor."""
    import jsbsim

    stock = Path(jsbsim.get_default_root_dir()) / "aircraft" / "minisgs" / "minisgs.xml"
    model = root / "aircraft" / "minisgs" / "minisgs.xml"
    model.parent.mkdir(parents=True)
    model.write_text(stock.read_text().replace("</fdm_config>", MOTOR))
    for name in ("engine", "systems"):
        (root / name).mkdir()
    jsbsim.FGJSBBase().debug_lvl = 0
    fdm = jsbsim.FGFDMExec(str(root))
    fdm.set_debug_level(0)
    if not fdm.load_model("minisgs"):
        raise RuntimeError("JSBSim cannot load its model minisgs")
    fdm.set_dt(STEP_S)
    fdm["inertia/pointmass-weight-lbs"] = BALLAST_LBS
    fdm["ic/lat-geod-deg"] = 0.0
    fdm["ic/long-gc-deg"] = 0.0
    fdm["ic/h-sl-ft"] = height * FEET_PER_METRE
    fdm["ic/psi-true-rad"] = plan.course
    fdm["ic/theta-rad"] = -plan.glide
    fdm["ic/vt-fps"] = plan.speed / math.cos(plan.glide) * FEET_PER_METRE
    fdm["ic/gamma-rad"] = -plan.glide
    if not fdm.run_ic():
        raise RuntimeError("JSBSim refuses the initial conditions")
    knots = WIND_AT_20FT_KNOTS[plan.wind]
    if knots > 0.0:
        fdm["simulation/randomseed"] = plan.seed
        fdm["atmosphere/turb-type"] = TURBULENCE_MILSPEC
        fdm["atmosphere/turbulence/milspec/windspeed_at_20ft_AGL-fps"] = knots * 1852.0 / 3600.0 * FEET_PER_METRE
        fdm["atmosphere/turbulence/milspec/severity"] = 3 if plan.wind.endswith("light") else 4
    return fdm


def read_state(fdm) -> State:
    """At the equator north is the Earth's z axis and, from longitude 0, east is its y axis."""
    return State(
        north=fdm["position/ecef-z-ft"] / FEET_PER_METRE,
        east=fdm["position/ecef-y-ft"] / FEET_PER_METRE,
        height=fdm["position/h-sl-ft"] / FEET_PER_METRE,
        v_north=fdm["velocities/v-north-fps"] / FEET_PER_METRE,
        v_east=fdm["velocities/v-east-fps"] / FEET_PER_METRE,
        v_down=fdm["velocities/v-down-fps"] / FEET_PER_METRE,
        airspeed=fdm["velocities/vtrue-fps"] / FEET_PER_METRE,
        roll=fdm["attitude/phi-rad"],
        pitch=fdm["attitude/theta-rad"],
        yaw=fdm["attitude/psi-rad"],
        roll_rate=fdm["velocities/p-rad_sec"],
        pitch_rate=fdm["velocities/q-rad_sec"],
        yaw_rate=fdm["velocities/r-rad_sec"],
    )


class Autopilot:
    """Holds course line, slope and airspeed with aileron, elevator and motor."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.pitch_trim = 0.0
        self.thrust_trim = 12.0  # N

    def height_wanted(self, along: float) -> float:
        plan = self.plan
        return plan.altitude + (plan.speed * plan.reach - along) * math.tan(plan.glide)

    def along(self, state: State) -> float:
        """Distance along the course, 0 at the start of the run."""
        return (
            state.north * math.cos(self.plan.course)
            + state.east * math.sin(self.plan.course)
            - self.plan.speed * RUN_IN_S
        )

    def steer(self, fdm, state: State) -> None:
        plan = self.plan
        ground_speed = math.hypot(state.v_north, state.v_east)
        cross = state.east * math.cos(plan.course) - state.north * math.sin(plan.course)
        course_error = math.remainder(
            plan.course - math.atan(0.5 * cross / ground_speed) - math.atan2(state.v_east, state.v_north), 2 * math.pi
        )
        bank = clamp(math.atan(1.0 * course_error * ground_speed / GRAVITY_MPS2), math.radians(40.0))
        roll_rate = clamp(3.0 * (bank - state.roll), 1.5)
        aileron = 0.13 * roll_rate + 0.03 * (roll_rate - state.roll_rate)

        height_error = self.height_wanted(self.along(state)) - state.height
        climb = clamp(-plan.glide + 0.7 * height_error / ground_speed, math.radians(15.0))
        climb_error = climb - math.atan2(-state.v_down, ground_speed)
        self.pitch_trim = clamp(self.pitch_trim + 0.8 * climb_error * STEP_S, 0.3)
        pitch = climb + 0.7 * climb_error + self.pitch_trim
        elevator = -0.5 * (pitch - state.pitch) + 0.05 * state.pitch_rate

        speed_error = plan.speed / math.cos(plan.glide) - state.airspeed
        self.thrust_trim = min(max(self.thrust_trim + 4.0 * speed_error * STEP_S, BRAKE_N), MOTOR_N)
        thrust = min(max(self.thrust_trim + 15.0 * speed_error, BRAKE_N), MOTOR_N)

        fdm["fcs/aileron-cmd-norm"] = clamp(aileron / SURFACE_RAD, 1.0)
        fdm["fcs/elevator-cmd-norm"] = clamp(elevator / SURFACE_RAD, 1.0)
        fdm["fcs/rudder-cmd-norm"] = clamp(0.5 * state.yaw_rate / SURFACE_RAD, 1.0)
        fdm["external_reactions/motor/magnitude"] = thrust * POUNDS_PER_NEWTON


def quaternion(state: State) -> tuple[float, float, float, float]:
    """Body to NED, (w, x, y, z), from yaw, pitch, roll."""
    cr, sr = math.cos(state.roll / 2), math.sin(state.roll / 2)
    cp, sp = math.cos(state.pitch / 2), math.sin(state.pitch / 2)
    cy, sy = math.cos(state.yaw / 2), math.sin(state.yaw / 2)
    return (
        cy * cp * cr + sy * sp * sr,
        cy * cp * sr - sy * sp * cr,
        cy * sp * cr + sy * cp * sr,
        sy * cp * cr - cy * sp * sr,
    )


def fly(plan: Plan) -> list[list[float]]:
    """Rows t_s, n_m, e_m, d_m, qw, qx, qy, qz from the start of the run to its end; ground at d = 0."""
    autopilot = Autopilot(plan)
    with tempfile.TemporaryDirectory() as folder:
        fdm = start_model(Path(folder), plan, autopilot.height_wanted(-plan.speed * RUN_IN_S))
        rows: list[list[float]] = []
        started_step = 0
        for step in range(round((2 * RUN_IN_S + 2 * plan.run) / STEP_S)):
            state = read_state(fdm)
            if state.height <= 0.0:
                raise RuntimeError(f"the aircraft hit the ground {step * STEP_S:.1f} s after the start")
            if not rows and autopilot.along(state) >= 0.0:
                started_step = step
            if rows or autopilot.along(state) >= 0.0:
                t = (step - started_step) * STEP_S
                if (step - started_step) % RECORD_EVERY == 0:
                    rows.append([t, state.north, state.east, -state.height, *quaternion(state)])
                if t > plan.run:
                    return rows
            autopilot.steer(fdm, state)
            fdm.run()
    raise RuntimeError("the aircraft did not reach the end of the run")


def write_recording(path: Path, rows: list[list[float]]) -> None:
    """The estimate in a recording is the autopilot's belief; here it equals the truth."""
    names = ("n_m", "e_m", "d_m", "qw", "qx", "qy", "qz")
    with replacing(path) as place, place.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["t_s", *(f"true_{name}" for name in names), *(f"est_{name}" for name in names)])
        for row in rows:
            values = [f"{value:.17g}" for value in row]
            writer.writerow(values + values[1:])


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--goe-sim", default=shutil.which("goe_sim"), help="the program (default: from the PATH)")
    parser.add_argument("--out", type=Path, required=True, help="folder of the log")
    parser.add_argument("--recording", type=Path, help="keep the recorded flight in this file")
    parser.add_argument("--speed", type=float, default=17.0, help="m/s over ground in still air (default: 17)")
    parser.add_argument("--course", type=float, default=0.0, help="degrees from north (default: 0)")
    parser.add_argument("--glide", type=float, default=0.0, help="slope in degrees, positive down (default: 0)")
    parser.add_argument("--altitude", type=float, default=15.0, help="m above ground at reach time (default: 15)")
    parser.add_argument("--reach", type=float, default=20.0, help="s to the obstacle (default: 20)")
    parser.add_argument("--run", type=float, default=18.0, help="s of the run (default: 18)")
    parser.add_argument("--wind", choices=sorted(WIND_AT_20FT_KNOTS), default="none", help="JSBSim's own turbulence")
    parser.add_argument("--seed", type=int, default=1, help="of turbulence and pixel noise (default: 1)")
    parser.add_argument("rest", nargs="*", help="options of goe_sim, after --")


def run(args: argparse.Namespace) -> int:
    if args.goe_sim is None:
        raise ValueError("--goe-sim is needed: goe_sim is not in the PATH")
    plan = Plan(
        args.speed, math.radians(args.course), math.radians(args.glide), args.altitude, args.reach, args.run, args.wind,
        args.seed,
    )  # fmt: skip
    try:
        rows = fly(plan)
    except ImportError:
        raise ValueError("the Python package jsbsim is needed") from None
    except RuntimeError as error:
        print(f"jsbsim_flight: {error}", file=sys.stderr)
        return 1
    with tempfile.TemporaryDirectory() as folder:
        recording = args.recording or Path(folder) / "flight.csv"
        write_recording(recording, rows)
        command = [args.goe_sim, "--flight", recording, "--course", args.course, "--z0",
                   args.speed * args.reach, "--reach", args.reach, "--run", args.run, "--seed", args.seed,
                   "--out", args.out, *args.rest]  # fmt: skip
        return subprocess.run([str(word) for word in command], check=False).returncode
