"""Embedded logs: synthetic tracks as C arrays for the replay images that run on every target.

Writes ``embedded_logs.c``. Numbers are stored as the bits of IEEE 754 singles, so every compiler reads the same values,
also NaN. All tracks come from ``scene``: no recordings, and no random numbers except seeded noise.

    corner       a box with its corner ahead, whole pixels, oscillating attitude, all six features: for each model
    kitti_like   a parked car passed at 9 m/s, boxes from a detector (0.7 px and 2.5 % of the width, one-sigma)
    lens         the corner through a distorting lens and a mounted camera off the vehicle's reference point
    boxes        upright boxes in banked flight, cut by the border; with position noise; through the lens
    degenerate   every fault, reset and refusal in the header, and inputs at the limits of their ranges
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import random
import re
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from goe_tools.logs.obslog import FEATURES, Camera, Frame
from goe_tools.logs.scene import Scene, make_log
from goe_tools.logs.whole_file import write_whole

TIME_UNKNOWN_US = -(2**63)
DETECTOR_SIGMA_PX = 0.7
DETECTOR_SIGMA_OF_WIDTH = 0.025
MODELS = {"auto": 1, "disc": 2, "line": 3}
SIDES = ("left", "top", "right", "bottom")
INFINITY = math.inf
NAN = math.nan


@dataclass
class Image:
    """One goe_image_t. Pixels by feature name; ``reset_delta_m`` None: unknown."""

    time_us: int
    position_m: tuple[float, ...]
    height_m: float
    attitude: tuple[float, ...]
    pixels: dict[str, tuple[float, float]]
    reset_count: int = 0
    reset_delta_m: tuple[float, float, float] | None = None
    box_px: dict[str, float] = field(default_factory=dict)  # by side, visible ones only


@dataclass
class Track:
    """Images replayed by one estimator. ``own_images`` False: those of the previous track."""

    name: str
    camera: Camera
    images: list[Image]
    model: str = "auto"
    window: int = 8
    line_points: int = 8
    orientation_memory: int = 20
    heading_deg: float | None = None
    position_white_sd_m: int = 0
    own_images: bool = True


@dataclass
class Book:
    """All tracks, in the order of replay."""

    tracks: list[Track] = field(default_factory=list)

    def add(self, track: Track) -> None:
        self.tracks.append(track)

    def again(self, name: str, **changes: object) -> None:
        """The images of the last track again, with other settings."""
        self.tracks.append(dataclasses.replace(self.tracks[-1], name=name, own_images=False, **changes))  # type: ignore[arg-type]


# ------------------------------------------------------------------------------------------------------------- tracks


def image_of(frame: Frame) -> Image:
    pixels = {name: getattr(frame, name) for name in FEATURES if getattr(frame, name) is not None}
    time_us = frame.time_us
    assert time_us is not None
    return Image(time_us, frame.position_m, frame.height_m, frame.attitude, pixels)


def images_of(scene: Scene) -> list[Image]:
    return [image_of(frame) for frame in make_log(scene).frames]


CORNER = Scene(
    shape="box", width_m=6.0, length_m=14.0, height_m=8.0, x0_m=-18.0, z0_m=130.0, alpha_deg=25.0,
    run_s=6.0, fps_hz=8.0, speed_mps=15.0, altitude_m=25.0, glide_deg=3.0, wobble_deg=2.0, course_deg=40.0,
    start_ne_m=(120.0, -75.0), rounding="pixel",
)  # fmt: skip

LENS_CAMERA = Camera(
    1920.0, 1080.0, 1100.0, 1102.0, 955.0, 545.0, k1=-0.28, k2=0.09, p1=0.0004, p2=-0.0006, k3=-0.012,
    mount_roll_deg=1.5, mount_pitch_deg=-4.0, mount_yaw_deg=-8.0, offset_x_m=0.6, offset_y_m=-0.1, offset_z_m=0.2,
)  # fmt: skip

KITTI_LIKE = Scene(
    shape="box", width_m=1.8, length_m=4.2, height_m=1.5, x0_m=-4.6, z0_m=38.0, alpha_deg=4.0,
    run_s=3.2, fps_hz=10.0, speed_mps=9.0, altitude_m=1.65, wobble_deg=0.3, course_deg=-65.0, start_ne_m=(15.0, 240.0),
    camera=Camera(1242.0, 375.0, 721.5, 721.5, 609.6, 172.9),
)  # fmt: skip


def detector_boxes(scene: Scene, seed: int) -> list[Image]:
    """A detector's bounding boxes: left and right side at half height, top side in the middle, noisy and correlated."""
    generator = random.Random(seed)
    error = dict.fromkeys(("left", "right", "top", "bottom"), 0.0)
    result = []
    for image in images_of(scene):
        width = image.pixels["right"][0] - image.pixels["left"][0]
        sigma = math.hypot(DETECTOR_SIGMA_PX, DETECTOR_SIGMA_OF_WIDTH * width)
        for side in error:  # lag-1 correlation 0.5
            error[side] = 0.5 * error[side] + math.sqrt(0.75) * generator.gauss(0.0, sigma)
        left = image.pixels["left"][0] + error["left"]
        right = image.pixels["right"][0] + error["right"]
        top = image.pixels["top"][1] + error["top"]
        middle = image.pixels["left"][1] + error["bottom"]
        image.pixels = {"left": (left, middle), "right": (right, middle), "top": (0.5 * (left + right), top)}
        result.append(image)
    return result


def upright_boxes(scene: Scene, seed: int) -> list[Image]:
    """The points' bounding boxes, noisy; sometimes a side is missing, a box is swapped or absent."""
    generator = random.Random(seed)
    result = []
    for k, image in enumerate(images_of(scene)):
        u = [pixel[0] for pixel in image.pixels.values()]
        v = [pixel[1] for pixel in image.pixels.values()]
        if u:
            sides = (min(u), min(v), max(u), max(v))
            image.box_px = {side: at + generator.gauss(0.0, 2.0) for side, at in zip(SIDES, sides)}
        if k % 7 == 5 and image.box_px:
            del image.box_px[SIDES[k // 7 % 4]]
        if k == 20 and image.box_px:
            image.box_px["left"], image.box_px["right"] = image.box_px["right"], image.box_px["left"]
        image.pixels = {}
        result.append(image)
    return result


def moving(scene: Scene, north_m_s: float, east_m_s: float) -> list[Image]:
    """A moving obstacle: the images of a static one, with poses of a camera that moves along."""
    result = images_of(scene)
    for image in result:
        s = 1.0e-6 * (image.time_us - result[0].time_us)
        north, east, down = image.position_m
        image.position_m = (north + north_m_s * s, east + east_m_s * s, down)
    return result


def late(scene: Scene) -> list[Image]:
    """Each image with the pose of the previous one."""
    images = images_of(scene)
    poses = [(image.position_m, image.height_m, image.attitude) for image in images]
    for image, (position, height, attitude) in zip(images[1:], poses):
        image.position_m, image.height_m, image.attitude = position, height, attitude
    return images


Change = Callable[[Image], None]


def changes_of_one_image() -> Iterator[tuple[str, Change]]:
    """Every way to spoil a single good image."""

    def position(index: int, value: float) -> Change:
        def change(image: Image) -> None:
            numbers = list(image.position_m)
            numbers[index] = value
            image.position_m = tuple(numbers)

        return change

    def pixel(name: str, u: float, v: float) -> Change:
        return lambda image: image.pixels.__setitem__(name, (u, v))

    def attribute(name: str, value: object) -> Change:
        return lambda image: setattr(image, name, value)

    def swap(a: str, b: str) -> Change:
        def change(image: Image) -> None:
            image.pixels[a], image.pixels[b] = image.pixels[b], image.pixels[a]

        return change

    def only(*names: str) -> Change:
        def change(image: Image) -> None:
            image.pixels = {name: image.pixels[name] for name in names if name in image.pixels}

        return change

    yield "position not a number", position(0, NAN)
    yield "position infinite", position(2, -INFINITY)
    yield "position at the end of its range", position(1, 1.0e6)
    yield "position out of range", position(1, -1.0000001e6)
    yield "position subnormal", position(0, 1.0e-40)
    yield "position minus zero", position(1, -0.0)
    yield "height not a number", attribute("height_m", NAN)
    yield "height zero", attribute("height_m", 0.0)
    yield "height negative", attribute("height_m", -3.0)
    yield "height subnormal", attribute("height_m", 1.0e-42)
    yield "pixel not a number", pixel("left", NAN, 600.0)
    yield "pixel infinite", pixel("top", 600.0, INFINITY)
    yield "pixel out of range", pixel("right", 1.0e9, 0.0)
    yield "pixel at the end of its range", pixel("top", 1.0e5, -1.0e5)
    yield "left far outside", pixel("left", -1.0e5, 0.0)
    yield "base far below", pixel("base_near", 640.0, 1.0e5)
    yield "time unknown", attribute("time_us", TIME_UNKNOWN_US)
    yield "time backwards", attribute("time_us", 0)
    yield "attitude zero", attribute("attitude", (0.0, 0.0, 0.0, 0.0))
    yield "attitude too long", attribute("attitude", (1.02, 0.0, 0.0, 0.0))
    yield "attitude not a number", attribute("attitude", (1.0, NAN, 0.0, 0.0))
    yield "attitude out of range", attribute("attitude", (1.0e20, 0.0, 0.0, 0.0))
    yield "attitude of norm 1.009", attribute("attitude", (1.009, 0.0, 0.0, 0.0))
    yield "looks back", attribute("attitude", (0.0, 0.0, 0.0, 1.0))
    yield "nose up", attribute("attitude", (0.70710678, 0.0, 0.70710678, 0.0))
    yield "sides swapped", swap("left", "right")
    yield "base swapped", swap("base_left", "base_right")
    yield "near outside", swap("base_near", "base_right")
    yield "no width", lambda image: image.pixels.__setitem__("right", image.pixels["left"])
    yield "disc only", only("left", "right", "top")
    yield "left only", only("left")
    yield "front alone", only("base_left", "base_near")
    yield "side alone", only("base_near", "base_right")
    yield "no near corner", only("base_left", "base_right", "top")
    yield "top alone", only("top")
    yield "nothing", only()


def spoiled() -> list[Image]:
    """The corner, every third image spoiled in another way, then resets, then good images again."""
    good = images_of(dataclasses.replace(CORNER, run_s=13.4, fps_hz=16.0, speed_mps=5.0))
    result = []
    changes = list(changes_of_one_image())
    for k, image in enumerate(good):
        if k >= 12 and k % 4 == 0 and changes:
            changes.pop(0)[1](image)
        result.append(image)
    assert not changes, "the track is too short for all changes"
    for k, image in enumerate(result):
        image.reset_count = (250 + (k >= 60) + (k >= 110) + (k >= 120)) % 256
        image.reset_delta_m = (3.0, -2.0, 0.5) if k >= 60 else None
        if k >= 60 and k < 110:
            image.position_m = (image.position_m[0] + 3.0, image.position_m[1] - 2.0, image.position_m[2] + 0.5)
        if 110 <= k < 120:
            image.reset_delta_m = None
        if k >= 120:
            image.reset_delta_m = (1.0e30, 0.0, 0.0) if k == 120 else (0.0, 0.0, 0.0)
    return result


def still() -> list[Image]:
    """The camera hovers: no baseline."""
    return images_of(dataclasses.replace(CORNER, run_s=1.5, speed_mps=0.0))


def receding() -> list[Image]:
    """The images shrink over time: not a static obstacle ahead."""
    images = images_of(dataclasses.replace(CORNER, run_s=2.0))
    poses = [(image.time_us, image.position_m, image.attitude) for image in images]
    images.reverse()
    for image, (time_us, position, attitude) in zip(images, poses):
        image.time_us, image.position_m, image.attitude = time_us, position, attitude
    return images


def passing() -> list[Image]:
    """Flies past at a small distance until the obstacle is abeam and behind."""
    return images_of(dataclasses.replace(CORNER, run_s=4.0, x0_m=-8.0, z0_m=35.0, glide_deg=0.0))


def head_on() -> list[Image]:
    """One face alone, perpendicular to the flight path."""
    return images_of(dataclasses.replace(CORNER, run_s=3.0, x0_m=0.0, alpha_deg=0.0, wobble_deg=0.0))


def ambiguous() -> list[Image]:
    """Both faces near 45 degrees, noisy: the low-pass decides which is the side."""
    return images_of(dataclasses.replace(CORNER, run_s=3.0, x0_m=0.0, alpha_deg=44.0, rounding="pixel"))


def numbers_at_random(count: int, seed: int) -> list[Image]:
    """Random bits in every number, within limits that the intake sometimes accepts."""
    generator = random.Random(seed)

    def number(limit: float) -> float:
        choice = generator.random()
        if choice < 0.06:
            return generator.choice((NAN, INFINITY, -INFINITY, -0.0, 1.0e-45, -1.0e-38, 3.0e38))
        if choice < 0.3:
            return generator.choice((-1.0, 1.0)) * limit * 10.0 ** generator.uniform(-12.0, 0.0)
        return generator.uniform(-1.0, 1.0) * limit

    images = []
    for k in range(count):
        q = [generator.gauss(0.0, 1.0) for _ in range(4)]
        norm = math.sqrt(sum(value * value for value in q)) / generator.uniform(0.995, 1.005)
        clean = generator.random() < 0.8
        limit_px = generator.choice((700.0, 2000.0, 1.0e5))
        pixels = {
            name: tuple(number(limit_px) if not clean else generator.uniform(-limit_px, limit_px) for _ in range(2))
            for name in FEATURES
            if generator.random() < 0.9
        }
        scale = generator.choice((1.0, 100.0, 1.0e6))
        images.append(
            Image(
                time_us=1000 * k - 50000,
                position_m=tuple(generator.uniform(-scale, scale) if clean else number(scale) for _ in range(3)),
                height_m=generator.uniform(-10.0, 1000.0) if clean else number(1.0e5),
                attitude=tuple(value / norm for value in q) if generator.random() < 0.7 else (1.0, 0.0, 0.0, 0.0),
                pixels=pixels,  # type: ignore[arg-type]
                reset_count=k // 40,
                reset_delta_m=(0.5, 0.25, 0.0) if k // 40 % 2 else None,
            )
        )
    return images


def make_book() -> Book:
    book = Book()
    book.add(Track("corner_auto", CORNER.camera, images_of(CORNER)))
    book.again("corner_disc", model="disc")
    book.again("corner_line", model="line", window=3, orientation_memory=1, heading_deg=-317.25)
    book.add(Track("kitti_like", KITTI_LIKE.camera, detector_boxes(KITTI_LIKE, seed=5)))
    lens = dataclasses.replace(CORNER, run_s=3.5, camera=LENS_CAMERA, rounding="none", pixel_sigma_px=0.5)
    book.add(Track("lens", LENS_CAMERA, images_of(lens), line_points=5))
    book.again("lens_folded", camera=dataclasses.replace(LENS_CAMERA, k1=-9.0, k2=4.0, p1=3.0))
    banked = dataclasses.replace(CORNER, wobble_deg=9.0, fps_hz=10.0, z0_m=110.0)
    book.add(Track("boxes", CORNER.camera, upright_boxes(banked, seed=3)))
    book.again("boxes_disc", model="disc", position_white_sd_m=1)
    lens_boxes = dataclasses.replace(lens, run_s=2.5)
    book.add(Track("lens_boxes", LENS_CAMERA, upright_boxes(lens_boxes, seed=4)))
    book.add(Track("moving", CORNER.camera, moving(CORNER, -4.0, 6.0)))
    swaying = dataclasses.replace(CORNER, fps_hz=12.0, wobble_deg=5.0, run_s=4.0)
    book.add(Track("late", CORNER.camera, late(swaying)))
    book.add(Track("degenerate_spoiled", CORNER.camera, spoiled()))
    book.again("degenerate_spoiled_line", model="line", window=4)
    book.add(Track("degenerate_still", CORNER.camera, still()))
    book.add(Track("degenerate_receding", CORNER.camera, receding()))
    book.add(Track("degenerate_passing", CORNER.camera, passing()))
    book.add(Track("degenerate_head_on", CORNER.camera, head_on()))
    book.again("degenerate_head_on_line", model="line")
    book.add(Track("degenerate_ambiguous", CORNER.camera, ambiguous(), window=4, line_points=1))
    book.add(Track("degenerate_random", CORNER.camera, numbers_at_random(120, seed=11), window=3, line_points=1))
    return book


# ------------------------------------------------------------------------------------------------------------ writing


def bits(number: float) -> str:
    """The bits of the nearest IEEE 754 single, as a C constant. Ties to even; too large becomes infinite."""
    try:
        packed = struct.pack("<f", number)
    except OverflowError:
        packed = struct.pack("<f", math.copysign(math.inf, number))
    return f"0x{struct.unpack('<I', packed)[0]:08X}u"


def _row(numbers: list[float]) -> str:
    return ", ".join(bits(number) for number in numbers)


def _image_lines(image: Image) -> Iterator[str]:
    visible = sum(1 << i for i, name in enumerate(FEATURES) if name in image.pixels)
    time = "INT64_MIN" if image.time_us == TIME_UNKNOWN_US else str(image.time_us)
    known = int(image.reset_delta_m is not None)
    delta = image.reset_delta_m or (0.0, 0.0, 0.0)
    pixels = [value for name in FEATURES for value in image.pixels.get(name, (0.0, 0.0))]
    box = sum(1 << i for i, side in enumerate(SIDES) if side in image.box_px)
    if box:
        pixels[:4] = [image.box_px.get(side, 0.0) for side in SIDES]
    numbers = [*image.position_m, image.height_m, *image.attitude, *delta]
    yield f"    {{{time}, 0x{visible:02X}u, 0x{box:02X}u, {image.reset_count}u, {known}u,"
    yield f"     {{{_row(numbers[:8])},"
    yield f"      {_row([*numbers[8:], *pixels[:5]])},"
    yield f"      {_row(pixels[5:])}}}}},"


def _track_lines(track: Track, first: int) -> Iterator[str]:
    c = track.camera
    numbers = [c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3, c.mount_yaw_deg, c.mount_pitch_deg,
               c.mount_roll_deg, c.offset_x_m, c.offset_y_m, c.offset_z_m, track.heading_deg or 0.0,
               c.width, c.height]  # fmt: skip
    yield f'    {{"{track.name}", {first}, {len(track.images)}, {MODELS[track.model]}, {track.window},'
    yield f"     {track.line_points}, {track.orientation_memory}, {int(track.heading_deg is None)},"
    yield f"     {track.position_white_sd_m},"
    yield f"     {{{_row(numbers[:8])},"
    yield f"      {_row(numbers[8:])}}}}},"


def c_text(book: Book) -> str:
    """The C file."""
    image_lines: list[str] = []
    track_lines: list[str] = []
    first, images = 0, 0
    for track in book.tracks:
        if track.own_images:
            first = images
            images += len(track.images)
            image_lines.append(f"    /* {track.name} */")
            for image in track.images:
                image_lines += _image_lines(image)
        track_lines += _track_lines(track, first)
    return "\n".join(
        [
            "/* Made by `python -m ci embed_logs`; do not edit. SPDX-License-Identifier: MIT */",
            '#include "embedded_logs.h"',
            "",
            f"const logged_image_t logged_images[{images}] = {{",
            *image_lines,
            "};",
            "",
            f"const logged_track_t logged_tracks[{len(book.tracks)}] = {{",
            *(line.rstrip() for line in track_lines),
            "};",
            "",
            f"const int logged_track_count = {len(book.tracks)};",
            "",
        ]
    )


def agrees(text: str, other: str) -> bool:
    """Whether two files agree except for last bits, which depend on the versions of the generator's libraries."""
    word = re.compile(r"0x([0-9A-F]{8})u")
    if word.sub("", text) != word.sub("", other):
        return False
    return all(abs(int(a, 16) - int(b, 16)) <= 1 for a, b in zip(word.findall(text), word.findall(other)))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="C file to write")
    parser.add_argument("--check", action="store_true", help="write nothing; fail if FILE differs")


def run(arguments: argparse.Namespace) -> int:
    text = c_text(make_book())
    if not arguments.check:
        write_whole(arguments.out, text)
        print(f"{arguments.out}: {len(text)} characters")
        return 0
    if agrees(arguments.out.read_text(encoding="utf-8"), text):
        return 0
    print(f"{arguments.out}: differs from this generator's output")
    return 1
