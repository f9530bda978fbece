"""goe - position, size and orientation of a ground obstacle, each with a 1-sigma uncertainty, from a detector's boxes
or points and the aircraft's own motion; and what a planned flight will meet. Over the C library of that name: the same
bits.

    >>> import goe
    >>> tower = goe.Estimator(goe.Settings.for_camera(914, 914, 640, 640, 1280, 1280))
    >>> for k in range(10):  # flying north, 15 m above the ground
    ...     ahead_m = 200 - 2 * k
    ...     left, top, right, bottom = (640 + 914 * m / ahead_m for m in (-33, -15, -27, 15))
    ...     pose = goe.Pose(125_000 * k, (2 * k, 0, 0), height_m=15)
    ...     estimate = tower.update(goe.Image(pose, bounding_box=goe.BoundingBox(left, top, right, bottom)))
    >>> print("{:.1f} +- {:.1f} m ahead".format(*estimate.position.z))
    183.2 +- 28.3 m ahead

Frames      earth: north, east, down (NED), m, local. Body: forward, right, down; attitude: Hamilton quaternion
            (w, x, y, z) that turns body into NED. Camera: pixel (u, v) = (right, down) from the top left corner.
            Trajectory: X right, Z ahead, level; its origin is where the camera was at the track's first image, which is
            the first one that shows a feature.
Units       stand in the names: _m, _deg, _px, _s, _us, _m_s.
Not known   is None, or NaN in an array. "No position" does not mean "safe".
Faults      of an image are in ``Estimate.status``; a bad setting raises ``SettingError`` with field and range.
Threads     calls release Python's lock; one estimator serves one thread at a time.

``Estimator.update`` takes one image, ``run`` a whole track of numpy arrays, ``run_parallel`` several tracks at a time.
``goe.flight`` is the flight layer: late frames, clocks, a table of obstacles, orders.
"""

from typing import TYPE_CHECKING

from . import flight
from ._goe import ffi as _ffi
from ._goe import lib as _lib
from ._layout import ESTIMATE, HAZARD, IMAGE
from ._renamed import unknown as _unknown
from .estimate import Center, Estimate, Length, Orientation, Position, Velocity
from .estimator import Estimator, run, run_parallel
from .flight import Flight
from .hazard import Decision, DecisionRule, Hazard, Intent, Rule
from .image import KINDS, POINTS, SIDES, TIME_UNKNOWN, BoundingBox, Image, ImageNoise, Kind, KindShape, Pixel, Pose
from .settings import (
    CAMERAS_MAX,
    Camera,
    Detector,
    FilterSettings,
    FlightSettings,
    Navigation,
    Settings,
    WindowSettings,
    setting_rows,
)
from .status import Method, Model, Reason, SettingError, Shape, Status, self_check
from .tracks import QUANTITIES, Images, Track

if not TYPE_CHECKING:  # a checker knows the names

    def __getattr__(name):
        raise AttributeError(_unknown("goe", name))


FINGERPRINT: str = _ffi.string(_lib.goe_python_fingerprint).decode()
"""Of the sources that this package was built from: 64 hexadecimal digits."""

__version__: str = "{}.{}.{}".format(*(getattr(_lib, f"GOE_VERSION_{part}") for part in ("MAJOR", "MINOR", "PATCH")))

__all__ = [
    "CAMERAS_MAX", "ESTIMATE", "FINGERPRINT", "HAZARD", "IMAGE", "KINDS", "POINTS", "QUANTITIES", "SIDES",
    "TIME_UNKNOWN", "BoundingBox", "Camera", "Center", "Decision", "DecisionRule", "Detector", "Estimate",
    "Estimator", "FilterSettings", "Flight", "FlightSettings", "Hazard", "Image", "ImageNoise", "Images", "Intent",
    "Kind", "KindShape", "Length", "Method", "Model", "Navigation", "Orientation", "Pixel", "Pose", "Position",
    "Reason", "Rule", "SettingError", "Settings", "Shape", "Status", "Track", "Velocity", "WindowSettings",
    "flight", "run", "run_parallel", "self_check", "setting_rows",
]  # fmt: skip
