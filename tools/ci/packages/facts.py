"""The content of every manifest: read from the sources if they have it, otherwise given here."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from goe_tools.places import ROOT, interface

NEEDS = {"target_motion": ("filter",)}  # parts that require others

# Files that a package may contain from a folder; other files are build output or private.
SUFFIXES = (".c", ".cmake", ".h", ".in", ".ino", ".py", ".pyi", ".rs", ".txt", ".typed", ".xml", ".yml")
NO_SOURCES = ("build", "target", "__pycache__", "dist")  # folders written by tools


def is_no_source(folder: str) -> bool:
    return folder in NO_SOURCES or folder.startswith((".", "build-"))


@dataclass(frozen=True)
class Part:
    """A part of the library that may be left out: GOE_WITH_..."""

    name: str  # target_motion
    text: str  # one line, from goe_limits.h

    @property
    def define(self) -> str:
        return f"GOE_WITH_{self.name.upper()}"

    @property
    def needs(self) -> tuple[str, ...]:
        return NEEDS.get(self.name, ())


@dataclass(frozen=True)
class Limit:
    """A number that determines the memory, with its bounds and default."""

    define: str
    low: int
    high: int
    default: int
    text: str

    @property
    def option(self) -> str:
        return self.define.partition("_")[2].lower()  # window_max


@dataclass(frozen=True)
class Facts:
    root: Path = ROOT

    name = "goe"
    owner = "the goe authors"
    license = "MIT"
    sentence = "Position, size and orientation of a ground obstacle, from a detector's boxes and the aircraft's motion."
    paragraph = (
        "A small C99 library for flight controllers: one obstacle takes at most 2.1 KiB, there is no heap, and every "
        "output is finite and has a 1-sigma uncertainty. It also predicts the miss distance and the probability of a "
        "collision of a planned flight."
    )
    flight_sentence = "The layer between a detector, an autopilot and the ground obstacle estimator goe."
    flight_paragraph = (
        "Poses of late images, clocks, filter resets, a table of obstacles, future hazards, and an action against "
        "the worst one: left, right, climb, go around, hold."
    )
    keywords = ("uav", "obstacle", "avoidance", "estimation", "autopilot")

    @cached_property
    def header(self) -> str:
        """All public ones."""
        return interface(self.root / "lib")

    @cached_property
    def version(self) -> str:
        numbers = dict(re.findall(r"^#define GOE_VERSION_(MAJOR|MINOR|PATCH) (\d+)$", self.header, re.MULTILINE))
        if len(numbers) != 3:
            raise ValueError("lib/goe.h: no GOE_VERSION_MAJOR, _MINOR and _PATCH")
        return f"{numbers['MAJOR']}.{numbers['MINOR']}.{numbers['PATCH']}"

    @cached_property
    def url(self) -> str:
        """The home page, from the top CMakeLists.txt."""
        text = (self.root / "CMakeLists.txt").read_text(encoding="utf-8")
        found = re.search(r'^ +HOMEPAGE_URL "(https://[^"]+)"', text, re.MULTILINE)
        if not found:
            raise ValueError("CMakeLists.txt: project() has no HOMEPAGE_URL")
        return found[1]

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        found = re.findall(r"^#ifndef GOE_WITH_(\w+)\n#define GOE_WITH_\1 1 /\* (.*) \*/$", self.header, re.MULTILINE)
        if not found:
            raise ValueError("lib/goe_limits.h: no part, GOE_WITH_...")
        return tuple(Part(name.lower(), text) for name, text in found)

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        flight = (self.root / "port" / "flight" / "goe_flight.h").read_text(encoding="utf-8")
        texts = {
            "GOE_WINDOW_MAX": "Largest window, in image points",
            "GOE_CAMERAS_MAX": "Cameras of one aircraft",
            "GOE_FLIGHT_SLOTS": "Flight layer: obstacles tracked at a time",
        }
        limits = []
        for define, text in texts.items():
            both = self.header + flight
            default = re.search(rf"^#define {define} (\d+)", both, re.MULTILINE)
            bounds = re.search(rf"^#if {define} < (\d+) \|\| {define} > (\d+)$", both, re.MULTILINE)
            if not default or not bounds:
                raise ValueError(f"goe_limits.h, goe_flight.h: {define} has no default or no bounds")
            limits.append(Limit(define, int(bounds[1]), int(bounds[2]), int(default[1]), text))
        return tuple(limits)

    def limit(self, define: str) -> Limit:
        (limit,) = (limit for limit in self.limits if limit.define == define)
        return limit

    def files(self, folder: str, suffixes: tuple[str, ...] = SUFFIXES) -> tuple[str, ...]:
        """Sources below a folder of the project, relative to it."""
        base = self.root / folder
        below = (path.relative_to(base) for path in base.rglob("*") if path.suffix in suffixes)
        found = tuple(sorted(path.as_posix() for path in below if not any(map(is_no_source, path.parts[:-1]))))
        if not found:
            raise ValueError(f"{base}: there is no {' or '.join(suffixes)} file")
        return found

    @cached_property
    def sources(self) -> tuple[str, ...]:
        return self.files("lib", (".c",))

    @cached_property
    def headers(self) -> tuple[str, ...]:
        return self.files("lib", (".h",))

    @cached_property
    def flight_sources(self) -> tuple[str, ...]:
        return self.files("port/flight", (".c",))

    @cached_property
    def flight_headers(self) -> tuple[str, ...]:
        return self.files("port/flight", (".h",))
