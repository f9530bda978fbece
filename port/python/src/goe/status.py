"""What became of an image, of a setting, and of a call; names as the C library has them."""

from __future__ import annotations

from enum import IntEnum

from ._goe import ffi, lib


class Status(IntEnum):
    """What became of one image. 0: solved; positive: good, but less than a new solution; negative: a fault."""

    OK = 0
    """Solved from this image and those before it."""
    PARTIAL = 1
    """Solved, but a part of the image was refused or could not be used."""
    CONVERGING = 2
    """Image taken; no solution yet."""
    STALE = 3
    """Image taken; it adds no point to the reported model, whose older solution stays."""
    NO_DETECTION = 4
    """Image taken for its pose; no feature was visible."""
    BEHIND_CAMERA = -1
    """Image taken; a ray points backwards or sideways."""
    LENS_FAILED = -2
    """Image taken; the lens model cannot be inverted at a pixel."""
    SWAPPED = -3
    """Image taken; left is not left of right."""
    EDGE_ON = -4
    """Image taken; the camera views the front edge from its end or from behind."""
    NO_EDGE = -5
    """Image taken; no edge has a measurable orientation."""
    BAD_HEIGHT = -6
    """Image taken; the camera's height above ground is not positive."""
    NO_BASELINE = -7
    """Image taken; the camera moved too little."""
    NO_PARALLAX = -8
    """Image taken; the picture does not grow as it must."""
    ABEAM = -9
    """Image taken; the solution lies abeam or behind."""
    NOT_FINITE = -10
    """Image refused: a NaN or an infinity."""
    OUT_OF_RANGE = -11
    """Image refused: a number outside its range."""
    BAD_TIME = -12
    """Image refused: its time is unknown, repeated or runs backwards."""
    BAD_ATTITUDE = -13
    """Image refused: the quaternion's norm is off 1 by more than 1 %."""
    BOX_INCOMPLETE = -14
    """Image taken; fewer than two sides of the box can be used."""
    NO_HEIGHT = -15
    """Image taken; the height is exactly 0 with a box, as if it was not set."""
    CORRUPTED = -35
    """The estimator's memory is not what the library left there: nothing is known, which does not make it safe."""

    @property
    def is_fault(self) -> bool:
        """No new solution came of this image, by a fault."""
        return self < 0

    @property
    def is_image_taken(self) -> bool:
        """The next images build on this one, whether or not it gave a solution."""
        return bool(lib.goe_python_image_taken(int(self)))

    def __str__(self) -> str:
        return ffi.string(lib.goe_status_text(int(self))).decode()


class Method(IntEnum):
    """How it is estimated."""

    WINDOW = 1
    """The paper's method: least squares over the last images."""
    FILTER = 2
    """A square-root information filter over the whole track."""

    def __str__(self) -> str:
        return self.name.lower()


class Shape(IntEnum):
    """Which shapes the estimator may take the obstacle for; the setting ``model`` of C."""

    AUTO = 1
    """Filter: a prism until base corners show a box. Window: a disc until the images show enough of the base."""
    DISC = 2
    """An upright cylinder alone: its depth along the line of sight is known."""
    LINE = 3
    """Window: the front edge of a box. Filter: a box, and no prism before it."""

    def __str__(self) -> str:
        return self.name.lower()


class Model(IntEnum):
    """The shape behind an estimate."""

    DISC = 2
    """An upright cylinder. Filter: only if the settings require it. Window: also the circle that replaces anything
    else."""
    LINE = 3
    """The front edge of a box. Window method."""
    BOX = 4
    """A box with an upright, level outline. Filter method."""
    PRISM = 5
    """Something upright by its silhouette, whose depth along the line of sight is not reported. Filter method."""

    def __str__(self) -> str:
        return self.name.lower()


class Reason(IntEnum):
    """Why an estimate is suspect, the most significant one. Filter method."""

    CONVENTION = 1
    """The inputs contradict each other: axes, signs or order of the attitude, the mounting, very late poses."""
    MOVES = 2
    """The obstacle moves. Without ``Estimate.velocity`` it is not followed, and the position is wrong."""
    BASE = 3
    """The given base corners proved to be wrong."""
    SHAPE = 4
    """A disc was configured, and the silhouette is not that of one."""
    LATE = 5
    """Poses are late or early: ``Estimate.latency_s``. Also of an estimate that is not suspect."""
    NOISE = 6
    """The errors are larger than given, or the obstacle is of another shape."""

    def __str__(self) -> str:
        return ffi.string(lib.goe_reason_text(int(self))).decode()


class SettingError(ValueError):
    """A setting that is unknown, of the wrong kind or outside its range; the message names field, value and range."""

    def __init__(self, field: str, problem: str) -> None:
        super().__init__(f"{field}{problem}")
        self.field = field
        """As C has it: "detector.point_noise_px"."""

    def __reduce__(self) -> tuple[type, tuple[str, str]]:
        return type(self), (self.field, str(self)[len(self.field) :])


def self_check() -> int:
    """0 if this machine's arithmetic gives the library's bits, otherwise a sum of GOE_SELF_... of goe.h."""
    return int(lib.goe_self_check())
