"""Reference data of the C unit tests, as committed headers.

    python -m bench golden --out tests/c/golden     writes them
    python -m bench golden --check tests/c/golden   compares them with this program's output

Inputs are hexadecimal floats, computed with additions, multiplications and Python's generator only, so they are
equal on every machine. Expected results in double come from numpy (trigonometry, Newton's method, lstsq), whose
last bits depend on its version; --check allows a relative difference of 1e-9 for them and none elsewhere.
"""

from __future__ import annotations

import argparse
import math
import random
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from goe_tools.logs.estimates import NUMBERS
from goe_tools.logs.obslog import FEATURES, Camera, Frame, read_log
from goe_tools.logs.projection import distort
from goe_tools.logs.whole_file import write_whole
from goe_tools.places import ROOT

from . import dense
from .gates import Gates
from .settings import Settings
from .window import WindowMethod
from .window.fit import Row, solve
from .window.precision import numbers

SEED = 20190917
ARCTAN_CASES, SINCOS_CASES, LENS_CASES, WINDOW_CASES = 240, 200, 24, 48
DOUBLE_TOLERANCE = 1e-9
EXIT_DIFFERENT = 1
CORNER = ROOT / "tests" / "data" / "corner"
# This data is for the window method, which uses neither boxes nor the errors of an image.
NO_BOX = "{.sides = 0}, {.pixel_sd_px = 0}, {.shape = 0}, 0"  # of no class, and from the first camera
VALID = {
    "GOE_HAS_POSITION": "x0_m",
    "GOE_HAS_LENGTH": "length_m",
    "GOE_HAS_HEIGHT": "height_m",
    "GOE_HAS_ORIENTATION": "orientation_deg",
    "GOE_HAS_CENTER": "center_n_m",
    "GOE_HAS_WIDTH": "width_m",
}


def f32(value: float) -> float:
    """The nearest float32, as a Python float."""
    return float(np.float32(value))


def hex_float(value: float) -> str:
    """A C literal of a float32, exact: 0x1.8p+1f."""
    mantissa, exponent = f32(value).hex().split("p")
    if "." in mantissa:
        mantissa = mantissa.rstrip("0").rstrip(".")
    return f"{mantissa}p{exponent}f"


def double(value: float) -> str:
    """A C literal of a double."""
    return f"{value:.17e}"


def header(name: str, title: str, body: Sequence[str], include: str = "") -> str:
    guard = f"GOLDEN_{name.upper()}_H"
    lines = [
        f"/* {title}",
        " * Made by `python -m bench golden --out tests/c/golden`; do not edit. SPDX-License-Identifier: MIT */",
        f"#ifndef {guard}",
        f"#define {guard}",
        "",
        *([include, ""] if include else []),
        *body,
        "",
        "#endif",
    ]
    return "\n".join(lines) + "\n"


def wrapped(items: Sequence[str], count: int, indent: str) -> str:
    """Items with commas, `count` to a line."""
    lines = [", ".join(items[i : i + count]) for i in range(0, len(items), count)]
    return f",\n{indent}".join(lines)


def array(type_name: str, name: str, rows: Sequence[str]) -> list[str]:
    return [f"static const {type_name} {name}[{len(rows)}] = {{", *(f"    {row}," for row in rows), "};"]


# --------------------------------------------------------------------------------------------------------------- angles


def angle_header() -> str:
    generator = random.Random(SEED)
    points = [(0.0, 1.0), (1.0, 0.0), (-1.0, 0.0), (1.0, 1.0), (-1.0, 1.0), (0.0, 1e-30), (1e-30, 1.0), (1e-30, 1e-30)]
    points += [(f32(0.414213562), 1.0), (1.0, f32(0.414213562)), (1e5, 1e-5), (-1e-5, 1e5)]
    while len(points) < ARCTAN_CASES:
        size = 10.0 ** generator.randint(-6, 6)
        points.append((f32((2.0 * generator.random() - 1.0) * size), f32(generator.random() * 10.0)))
    degrees = [45.0 * k for k in range(-16, 17)]
    while len(degrees) < SINCOS_CASES:
        degrees.append(f32((2.0 * generator.random() - 1.0) * generator.choice((1.0, 90.0, 720.0))))
    body = [
        "/* arctangent of y/x in radians, in double */",
        "typedef struct {",
        "    float y, x;",
        "    double rad;",
        "} golden_arctan_t;",
        "",
    ]
    body += array(
        "golden_arctan_t",
        "golden_arctan",
        [f"{{{hex_float(y)}, {hex_float(x)}, {double(math.atan2(f32(y), f32(x)))}}}" for y, x in points],
    )
    body += [
        "",
        "/* sine and cosine of an angle in degrees, in double */",
        "typedef struct {",
        "    float deg;",
        "    double sine, cosine;",
        "} golden_sincos_t;",
        "",
    ]
    rows = []
    for deg in degrees:
        rest, quarter = math.remainder(deg, 90.0), round((deg - math.remainder(deg, 90.0)) / 90.0) % 4
        s, c = math.sin(math.radians(rest)), math.cos(math.radians(rest))
        sine, cosine = ((s, c), (c, -s), (-s, -c), (-c, s))[quarter]
        rows.append(f"{{{hex_float(deg)}, {double(sine + 0.0)}, {double(cosine + 0.0)}}}")
    body += array("golden_sincos_t", "golden_sincos", rows)
    return header("angle", "Angles: arctangent, sine and cosine against double.", body)


# ----------------------------------------------------------------------------------------------------------------- lens


def undistort_exactly(camera: Camera, x_distorted: float, y_distorted: float) -> tuple[float, float]:
    """Inverts the lens by Newton's method with a numerical derivative, to the last digits of a double."""
    point = np.array([x_distorted, y_distorted])
    target, step = point.copy(), 1e-6
    for _ in range(60):
        error = np.array(distort(camera, *point)) - target
        columns = []
        for axis in np.eye(2) * step:
            ahead, behind = distort(camera, *(point + axis)), distort(camera, *(point - axis))
            columns.append((np.array(ahead) - np.array(behind)) / (2.0 * step))
        point = point - np.linalg.solve(np.column_stack(columns), error)
        if float(np.max(np.abs(error))) < 1e-15:
            break
    return float(point[0]), float(point[1])


def lens_header() -> str:
    generator = random.Random(SEED + 1)
    names = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")
    rows = []
    for _ in range(LENS_CASES):

        def between(low: float, high: float) -> float:
            return f32(low + (high - low) * generator.random())

        fx = between(400.0, 1200.0)
        camera = Camera(
            1280.0,
            960.0,
            fx,
            f32(fx * 1.01),
            between(600.0, 680.0),
            between(440.0, 520.0),
            between(-0.25, 0.1),
            between(-0.02, 0.05),
            between(-0.002, 0.002),
            between(-0.002, 0.002),
            between(-0.005, 0.005),
        )
        u, v = f32(camera.cx + 0.6 * camera.fx * between(-1.0, 1.0)), f32(camera.cy + 0.6 * fx * between(-1.0, 1.0))
        x, y = undistort_exactly(camera, (u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy)
        numbers = [getattr(camera, name) for name in names]
        inputs = wrapped([hex_float(number) for number in (*numbers, u, v)], 6, "     ")
        rows.append(f"{{{inputs},\n     {double(x)}, {double(y)}}}")
    body = [
        "/* pixel (u, v) and the undistorted ray (x, y, 1) in double */",
        "typedef struct {",
        "    float fx_px, fy_px, cx_px, cy_px, k1, k2, p1, p2, k3;",
        "    float u_px, v_px;",
        "    double x, y;",
        "} golden_lens_t;",
        "",
    ]
    body += array("golden_lens_t", "golden_lens", rows)
    return header("lens", "Lens: Brown-Conrady distortion inverted in double.", body)


# --------------------------------------------------------------------------------------------------------------- window


def window_header() -> str:
    generator = random.Random(SEED + 2)
    rows = []
    while len(rows) < WINDOW_CASES:
        n = generator.randint(3, 8)
        width = 2.0 + 18.0 * generator.random()
        x0, z0 = 100.0 * generator.random() - 50.0, 50.0 + 400.0 * generator.random()
        step, side = 1.0 + 5.0 * generator.random(), generator.random() - 0.5
        noise = generator.choice((0.0, 0.01, 0.05))
        points = []
        for k in range(n):
            dz = f32(k * step + 0.5 * generator.random())
            dx = f32(k * step * side)
            xi = f32((x0 - dx) / width + noise * (2.0 * generator.random() - 1.0))
            zeta = f32((z0 - dz) / width + noise * (2.0 * generator.random() - 1.0))
            points.append((dx, dz, xi, zeta))
        fitted = [Row(*(np.float64(value) for value in (xi, zeta, dx, dz))) for dx, dz, xi, zeta in points]
        fit = solve(numbers(np.float64), fitted, np.float64(0.1), Gates())[1]
        if fit is None or fit.ratio < 0.5:  # the library would refuse it, or rounding dominates
            continue
        # b = 0: the rows of (5) are zeta and xi themselves
        answer = dense.solve([dense.DenseRow(zeta, xi, 1.0, 0.0, dx, dz) for dx, dz, xi, zeta in points])
        columns = [wrapped([hex_float(point[i]) for point in points], 4, "      ") for i in range(4)]
        expected = (
            answer.x0_m,
            answer.z0_m,
            answer.width_m,
            answer.sigma["x0_m"],
            answer.sigma["z0_m"],
            answer.sigma["width_m"],
            answer.residual,
            answer.baseline_m,
        )
        text = f"{{{n},\n" + "".join(f"     {{{column}}},\n" for column in columns)
        results = [double(value) for value in expected]
        rows.append(text + f"     {', '.join(results[:4])},\n     {', '.join(results[4:])}}}")
    body = [
        "/* A window of `length` points and the solution of the 2N x 3 system (5) by dense least squares in double.",
        " * Where the rows carry no noise, sigmas and residual are those of the rows' rounding to float. */",
        "typedef struct {",
        "    int length;",
        "    float dx_m[8], dz_m[8], xi[8], zeta[8];",
        "    double x0_m, z0_m, width_m, sigma_x0_m;",
        "    double sigma_z0_m, sigma_width_m, residual, baseline_m;",
        "} golden_window_t;",
        "",
    ]
    body += array("golden_window_t", "golden_window", rows)
    return header("window", "Window least squares against a dense solution of (5) in double.", body)


# --------------------------------------------------------------------------------------------------------------- corner


def _pixel(frame: Frame, feature: str) -> str:
    pixel = getattr(frame, feature)
    return "{0.0f, 0.0f, false}" if pixel is None else f"{{{hex_float(pixel[0])}, {hex_float(pixel[1])}, true}}"


def _image(frame: Frame) -> list[str]:
    position = ", ".join(hex_float(value) for value in frame.position_m)
    attitude = ", ".join(hex_float(value) for value in frame.attitude)
    pixels = [_pixel(frame, feature) for feature in FEATURES]
    return [
        f"{{{{.time_us = {frame.time_us}, .position_ned_m = {{{position}}},",
        f"   .height_m = {hex_float(frame.height_m)}, .attitude = {{{attitude}}}}},",
        f"  {', '.join(pixels[:3])},",
        f"  {', '.join(pixels[3:])},",
        f"  {NO_BOX}}},",
    ]


def _bits(value: np.float32) -> str:
    return f"0x{int(np.float32(value).view(np.uint32)):08X}u"


def corner_header() -> str:
    log = read_log(CORNER)
    camera = log.camera
    method = WindowMethod(camera, Settings(), np.float32)
    rows = []
    for frame in log.frames:
        report = method.update(frame)
        estimate = report.estimate
        valid = [flag for flag, name in VALID.items() if name in estimate.values]
        numbers = [estimate.values.get(name, np.float32(0.0)) for name in NUMBERS]
        numbers += [report.residual, report.baseline_m]
        bits = [_bits(number) for number in numbers]
        image = _image(frame)
        fresh = "true" if report.fresh else "false"
        labels = f"GOE_{estimate.status.upper()}, GOE_MODEL_{estimate.model.upper()}, {estimate.images_used}, {fresh},"
        lines = ["{" + image[0], *image[1:], f" {labels}", f" {' | '.join(valid) or '0u'},"]
        lines.append(f" {{{wrapped(bits, 8, '      ')}}}}}")
        rows.append("\n    ".join(lines))
    fields = (
        ("fx_px", camera.fx),
        ("fy_px", camera.fy),
        ("cx_px", camera.cx),
        ("cy_px", camera.cy),
        ("k1", camera.k1),
        ("k2", camera.k2),
        ("p1", camera.p1),
        ("p2", camera.p2),
        ("k3", camera.k3),
        ("mount_yaw_deg", camera.mount_yaw_deg),
        ("mount_pitch_deg", camera.mount_pitch_deg),
        ("mount_roll_deg", camera.mount_roll_deg),
    )
    if camera.heading_deg is not None:
        raise ValueError(f"{CORNER}: the unit test uses an automatic heading")
    offset = ", ".join(hex_float(v) for v in (camera.offset_x_m, camera.offset_y_m, camera.offset_z_m))
    body = ["static const goe_camera_t golden_corner_camera = {"]
    body += [f"    .{name} = {hex_float(value)}," for name, value in fields]
    body += [f"    .offset_m = {{{offset}}},", "};", ""]
    body += ["/* What `bits` holds, in this order; 0 where the quantity is not valid. */"]
    order = [*NUMBERS, "residual", "baseline_m"]
    body += [f"#define GOLDEN_CORNER_NUMBERS {len(order)}", ""]
    body += ["static const char *const golden_corner_names[GOLDEN_CORNER_NUMBERS] = {"]
    names = wrapped([f'"{name}"' for name in order], 6, "    ")
    body += [
        f"    {names},",
        "};",
        "",
        "typedef struct {",
        "    goe_image_t image;",
        "    goe_status_t status;",
        "    goe_model_t model;",
        "    int points;",
        "    bool fresh;",
        "    unsigned valid;",
        "    uint32_t bits[GOLDEN_CORNER_NUMBERS];",
        "} golden_corner_t;",
        "",
    ]
    body += array("golden_corner_t", "golden_corner", rows)
    title = "One flight, tests/data/corner with the window method: every image and the estimate after it, in bits."
    return header("corner", title, body, '#include "goe.h"')


# ---------------------------------------------------------------------------------------------------------------- shell

MAKERS = {
    "golden_angle.h": angle_header,
    "golden_lens.h": lens_header,
    "golden_window.h": window_header,
    "golden_corner.h": corner_header,
}
DOUBLE_LITERAL = re.compile(r"(?<![\w.])-?\d\.\d{17}e[+-]\d+")


def difference(found: str, made: str) -> str:
    """Place where two headers differ beyond the last bits of doubles: "line N: ..."; empty if nowhere."""
    lines, wanted = found.splitlines(), made.splitlines()
    for number, (line, want) in enumerate(zip(lines, wanted), start=1):
        if line == want:
            continue
        if DOUBLE_LITERAL.sub("#", line) != DOUBLE_LITERAL.sub("#", want):
            return f"line {number}: '{line.strip()[:60]}' should be '{want.strip()[:60]}'"
        for a, b in zip(DOUBLE_LITERAL.findall(line), DOUBLE_LITERAL.findall(want)):
            if not math.isclose(float(a), float(b), rel_tol=DOUBLE_TOLERANCE, abs_tol=DOUBLE_TOLERANCE):
                return f"line {number}: {a} should be {b}"
    return "" if len(lines) == len(wanted) else f"{len(lines)} lines should be {len(wanted)}"


def check(folder: Path) -> list[str]:
    """Errors of the headers in a folder, a line for each."""
    found = []
    for name, make in MAKERS.items():
        path = folder / name
        if not path.is_file():
            found.append(f"{path}: missing")
            continue
        where = difference(path.read_text(encoding="utf-8"), make())
        if where:
            found.append(f"{path}: {where}")
    found += [f"{path}: not made by this program" for path in sorted(folder.glob("*.h")) if path.name not in MAKERS]
    return found


def add_arguments(parser: argparse.ArgumentParser) -> None:
    group = parser.add_mutually_exclusive_group(required=True)
    group.add_argument("--out", type=Path, metavar="DIR", help="write the headers into this folder")
    group.add_argument("--check", type=Path, metavar="DIR", help="compare the headers in this folder with new ones")


def run(arguments: argparse.Namespace) -> int:
    if arguments.check is not None:
        found = check(arguments.check)
        for line in found:
            print(line)
        return EXIT_DIFFERENT if found else 0
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name, make in MAKERS.items():
        write_whole(arguments.out / name, make())
    return 0
