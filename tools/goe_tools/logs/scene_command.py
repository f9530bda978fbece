"""The command ``scene``: parses its options and writes the log."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from .numbers import between, finite, positive
from .obslog import Camera
from .own_log import write_own_log
from .scene import Scene, make_log

# name: shape, W, L, H in meters (of the cylinder: diameter, diameter, height)
PRESETS = {
    "cylinder": ("cylinder", 6.0, 6.0, 30.0),
    "building": ("box", 15.0, 40.0, 89.0),
    "truck": ("box", 2.5, 7.0, 2.5),
    "long-truck": ("box", 2.5, 18.0, 4.0),
}

RUN_MAX_S = 3600.0
FPS_MIN_HZ, FPS_MAX_HZ = 0.01, 1000.0
GLIDE_MAX_DEG = 80.0


def _numbers(text: str, count: int) -> tuple[float, ...]:
    parts = text.split(",")
    if len(parts) != count:
        raise argparse.ArgumentTypeError(f"'{text}': needs {count} numbers with commas between them")
    try:
        values = tuple(float(part) for part in parts)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}': not numbers") from None
    if not all(math.isfinite(value) for value in values):
        raise argparse.ArgumentTypeError(f"'{text}': not finite")
    return values


def _obstacle(text: str) -> tuple[str, float, float, float]:
    if text in PRESETS:
        return PRESETS[text]
    kind, _, sizes = text.partition(":")
    if kind == "box":
        shape = ("box", *_numbers(sizes, 3))
    elif kind == "disc":
        diameter, height = _numbers(sizes, 2)
        shape = ("cylinder", diameter, diameter, height)
    else:
        raise argparse.ArgumentTypeError(f"'{text}': must be {', '.join(PRESETS)}, box:W,L,H or disc:D,H")
    if min(shape[1:]) <= 0.0:  # type: ignore[type-var]
        raise argparse.ArgumentTypeError(f"'{text}': sizes must be positive")
    return shape  # type: ignore[return-value]


def _path(text: str) -> dict[str, object]:
    kind, _, rest = text.partition(":")
    if text == "straight":
        return {"path": "straight"}
    if kind == "arc":
        (radius,) = _numbers(rest, 1)
        if radius != 0.0:
            return {"path": "arc", "arc_radius_m": radius}
    if kind == "weave":
        amplitude, period = _numbers(rest, 2)
        if period > 0.0:
            return {"path": "weave", "weave_amplitude_m": amplitude, "weave_period_s": period}
    raise argparse.ArgumentTypeError(f"'{text}': straight, arc:R (m, positive right) or weave:A,T (m, s)")


def _speed_profile(text: str) -> float:
    kind, _, rest = text.partition(":")
    if text == "constant":
        return 0.0
    if kind == "ramp":
        return _numbers(rest, 1)[0]
    raise argparse.ArgumentTypeError(f"'{text}': constant or ramp:A (m/s^2)")


def _noise(text: str) -> dict[str, object]:
    kind, _, rest = text.partition(":")
    if text == "none":
        return {}
    if text == "rounding":
        return {"rounding": "pixel"}
    if kind == "pixel":
        return {"pixel_sigma_px": _numbers(rest, 1)[0]}
    raise argparse.ArgumentTypeError(f"'{text}': none, rounding or pixel:SIGMA (px)")


def _heading(text: str) -> float | None:
    return None if text == "auto" else _numbers(text, 1)[0]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add(
        "--obstacle",
        type=_obstacle,
        default=PRESETS["truck"],
        metavar="WHAT",
        help=f"{', '.join(PRESETS)}, box:W,L,H or disc:D,H (m); default truck",
    )
    add("--x0", type=finite, default=-12.0, metavar="M", help="reference point right of the start (default -12)")
    add("--z0", type=finite, metavar="M", help="reference point ahead of the start (default: speed times reach)")
    add("--reach", type=positive, default=12.0, metavar="S", help="time to come abeam at the first speed (default 12)")
    run = between(0.0, RUN_MAX_S)
    add("--run", type=run, default=10.0, metavar="S", help=f"duration of the log, at most {RUN_MAX_S:g} (default 10)")
    add("--alpha", type=finite, default=0.0, metavar="DEG", help="length axis from the flight direction (default 0)")
    add("--altitude", type=positive, default=20.0, metavar="M", help="above the ground at the start (default 20)")
    glide = between(-GLIDE_MAX_DEG, GLIDE_MAX_DEG)
    add("--glide", type=glide, default=0.0, metavar="DEG", help="descent angle (default 0)")
    add("--speed", type=positive, default=17.0, metavar="MPS", help="default 17")
    rate, span = between(FPS_MIN_HZ, FPS_MAX_HZ), f"{FPS_MIN_HZ:g} to {FPS_MAX_HZ:g}"
    add("--fps", type=rate, default=8.0, metavar="HZ", help=f"images per second, {span} (default 8)")
    add("--course", type=finite, default=0.0, metavar="DEG", help="direction of flight at the start (default 0: north)")
    add(
        "--path",
        type=_path,
        default={"path": "straight"},
        metavar="P",
        help="straight (default), arc:R (m, positive: right) or weave:A,T (m, s)",
    )
    add("--speed-profile", type=_speed_profile, default=0.0, metavar="P", help="constant (default) or ramp:A (m/s^2)")
    add(
        "--pitch", type=finite, default=0.0, metavar="DEG", help="constant pitch, added to the glide path's (default 0)"
    )
    add("--wobble", type=finite, default=0.0, metavar="DEG", help="amplitude of an attitude oscillation (default 0)")
    add(
        "--noise",
        type=_noise,
        default={},
        metavar="N",
        help="none (default), rounding (whole pixels) or pixel:SIGMA (px)",
    )
    add("--seed", type=int, default=1, metavar="N", help="of the pixel noise (default 1)")
    add("--clip", action="store_true", help="points outside the image are not measured")
    add(
        "--start",
        type=lambda text: _numbers(text, 3),
        default=(0.0, 0.0, 0.0),
        metavar="N,E,D",
        help="NED of the ground point below the start (m; default 0,0,0)",
    )
    add("--t0", type=finite, default=0.0, metavar="S", help="time stamp of the first image (default 0)")
    add("--id", type=int, default=1, metavar="N", help="track id (default 1)")
    add(
        "--image",
        type=lambda text: _numbers(text, 2),
        default=(1280.0, 1280.0),
        metavar="W,H",
        help="px (default 1280,1280)",
    )
    add("--focal", type=positive, default=914.0, metavar="PX", help="focal length (default 914)")
    add("--yaw-camera", type=finite, default=0.0, metavar="DEG", help="mounting, negative points left (default 0)")
    add("--pitch-camera", type=finite, default=0.0, metavar="DEG", help="mounting, positive points up (default 0)")
    add("--roll-camera", type=finite, default=0.0, metavar="DEG", help="mounting (default 0)")
    add(
        "--lens",
        type=lambda text: _numbers(text, 5),
        default=(0.0,) * 5,
        metavar="K1,K2,P1,P2,K3",
        help="distortion (default none)",
    )
    add(
        "--offset",
        type=lambda text: _numbers(text, 3),
        default=(0.0,) * 3,
        metavar="X,Y,Z",
        help="camera in body axes (m; default 0,0,0)",
    )
    add("--t-heading", type=_heading, default=None, metavar="DEG", help="T's Z axis; default auto: the first yaw")
    add("--out", type=Path, required=True, metavar="DIR", help="folder to write; an earlier result there is replaced")


def scene_of(arguments: argparse.Namespace) -> Scene:
    """The scene that the options describe."""
    shape, width, length, height = arguments.obstacle
    camera = Camera(
        arguments.image[0],
        arguments.image[1],
        arguments.focal,
        arguments.focal,
        0.5 * arguments.image[0],
        0.5 * arguments.image[1],
        *arguments.lens,
        mount_roll_deg=arguments.roll_camera,
        mount_pitch_deg=arguments.pitch_camera,
        mount_yaw_deg=arguments.yaw_camera,
        offset_x_m=arguments.offset[0],
        offset_y_m=arguments.offset[1],
        offset_z_m=arguments.offset[2],
        heading_deg=arguments.t_heading,
    )
    return Scene(
        shape=shape,
        width_m=width,
        length_m=length,
        height_m=height,
        x0_m=arguments.x0,
        z0_m=arguments.speed * arguments.reach if arguments.z0 is None else arguments.z0,
        alpha_deg=arguments.alpha,
        run_s=arguments.run,
        fps_hz=arguments.fps,
        speed_mps=arguments.speed,
        acceleration_mps2=arguments.speed_profile,
        course_deg=arguments.course,
        altitude_m=arguments.altitude,
        glide_deg=arguments.glide,
        pitch_deg=arguments.pitch,
        wobble_deg=arguments.wobble,
        start_ne_m=(arguments.start[0], arguments.start[1]),
        ground_d_m=arguments.start[2],
        seed=arguments.seed,
        clip=arguments.clip,
        id=arguments.id,
        t0_s=arguments.t0,
        camera=camera,
        **arguments.path,
        **arguments.noise,
    )


def run(arguments: argparse.Namespace) -> int:
    log = make_log(scene_of(arguments))
    write_own_log(arguments.out, log, "made by goe_tools scene")
    print(f"{arguments.out}: {len(log.frames)} rows")
    return 0
