"""The estimator of one obstacle."""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import numpy.typing as npt

from ._goe import ffi, lib
from ._renamed import Renamed
from .estimate import Estimate, estimate_of
from .hazard import Decision, DecisionRule, Hazard, Intent, Rule, hazard_of
from .image import Image, fill_image
from .settings import Settings
from .status import SettingError, Status
from .tracks import QUANTITIES, ImagesOrC, Track, empty_track, images_to_c, velocities


class Estimator(Renamed):
    """Follows one obstacle.

    Several obstacles take several estimators, which share nothing. Two threads may work on two of them at once: calls
    release Python's lock. One estimator that is given to several threads works for one after the other.
    """

    def __init__(self, settings: Settings) -> None:
        """Copies the settings and starts with an empty track. SettingError: one is outside its range."""
        values = settings.numbers()
        self._cameras = 1 + len(settings.more_cameras)
        self._lock = threading.Lock()
        self._c = ffi.new("goe_estimator_t *")
        self._image = ffi.new("goe_image_t *")
        self._estimate = ffi.new("goe_estimate_t *")
        bad = ffi.new("const char **")
        status = lib.goe_python_init(self._c, ffi.from_buffer("double[]", values), self._cameras, bad)
        if status != Status.OK:
            raise SettingError(ffi.string(bad[0]).decode(), ": does not fit the size of the image")

    def update(self, image: Image) -> Estimate:
        """Takes one image, also one without a detection, and returns the estimate after it.

        A fault of the image is no exception: ``Estimate.status`` reports it, and the rest is the last good estimate.
        ValueError: a vector of another length; OverflowError: a whole number that C cannot hold.
        """
        with self._lock:
            fill_image(self._image, image)
            status = lib.goe_update(self._c, self._image, self._estimate)
            return estimate_of(status, self._estimate)

    def run(
        self, images: ImagesOrC, *, rules: Sequence[Rule] = (), velocity_ned_m_s: Any = None, covariance: bool = False
    ) -> Track:
        """Takes K images in one call, as ``update`` would one by one, with the same bits; Python's lock is released.

        images            ``Images``, or (K,) of goe_image_t (``goe.IMAGE``)
        rules             R rules for ``decide`` after each image
        velocity_ned_m_s  (K, 3) planned, m/s; None: that of ``images``. Needed if there are rules
        covariance        whether it is wanted after each image

        ValueError names a column of another shape, or of numbers that are not whole, and a number of a rule outside its
        range.
        """
        c = images_to_c(images)
        velocity = velocities(images, velocity_ned_m_s, rules)
        for rule in rules:
            rule._check()
        track = empty_track(len(c), len(rules), covariance)
        table = ffi.new("goe_python_rule_t[]", [tuple(rule) for rule in rules])
        square = len(QUANTITIES)
        with self._lock:
            lib.goe_python_update(
                self._c, len(c), ffi.from_buffer("goe_image_t[]", c), ffi.from_buffer("int32_t[]", track.status),
                ffi.from_buffer("goe_estimate_t[]", track.estimates),
                ffi.NULL
                if track.covariance is None
                else ffi.from_buffer(f"float[][{square}][{square}]", track.covariance),
                len(rules), table, ffi.from_buffer("float[][3]", velocity),
                ffi.from_buffer("int32_t[]", track.decision), ffi.from_buffer("int32_t[]", track.hazard_status),
                ffi.from_buffer("goe_hazard_t[]", track.hazards),
            )  # fmt: skip
        return track

    def covariance(self) -> npt.NDArray[np.float32] | None:
        """(6, 6) of ``QUANTITIES`` of the latest estimate, m and degrees; rows and columns of invalid quantities are 0.
        None: there is no position."""
        result = np.zeros((len(QUANTITIES), len(QUANTITIES)), np.float32)
        with self._lock:
            status = lib.goe_covariance(self._c, ffi.from_buffer(f"float[][{len(QUANTITIES)}]", result))
        return result if status == Status.OK else None

    def hazard(self, intent: Intent) -> Hazard | None:
        """Closest approach to the obstacle of the latest estimate, stale or not, suspect or not. None: there is no
        position, which does not mean that it is safe. ValueError names a number of the intent outside its range."""
        c, result = intent._to_c(), ffi.new("goe_hazard_t *")
        with self._lock:
            status = lib.goe_hazard(self._c, c, result)
        return hazard_of(result) if status == Status.OK else None

    def decide(self, intent: Intent, rule: DecisionRule | None = None) -> tuple[Decision, Hazard | None]:
        """The decision rule: whether to act now, and the hazard with the intent's margin and clearance widened by doubt
        and age. Ask it after each image, also after one without a detection. None: there is no hazard, which does not
        mean that it is safe. ``rule``: None: the defaults. ValueError names a number of intent or rule outside its
        range."""
        c, result = intent._to_c(), ffi.new("goe_hazard_t *")
        by = ffi.NULL if rule is None else rule._to_c()
        with self._lock:
            decision = Decision(lib.goe_decide(self._c, c, by, result))
        known = result.dcpa_sd_m > 0.0  # all zero without one
        return decision, hazard_of(result) if known else None

    def reset(self) -> None:
        """Forgets the track; keeps settings and counters. For another obstacle, or a new view of the same one."""
        with self._lock:
            lib.goe_reset(self._c)

    @property
    def fault_counts(self) -> tuple[int, ...]:
        """Faults so far: [-status] of each Status from -1 to -15, [0] the tracks that a filter reset of unknown size
        ended. They saturate."""
        return tuple(self._c.fault_counts)

    def copy(self) -> Estimator:
        """Another one that knows the same: to try what an image would do."""
        other = Estimator.__new__(Estimator)
        other._cameras = self._cameras
        other._lock = threading.Lock()
        other._c, other._image, other._estimate = (
            ffi.new(f"{name} *") for name in ("goe_estimator_t", "goe_image_t", "goe_estimate_t")
        )
        with self._lock:
            other._c[0] = self._c[0]
        return other

    __copy__ = copy

    def __deepcopy__(self, memo: dict[int, Any]) -> Estimator:
        return self.copy()

    def __reduce__(self) -> Any:
        raise TypeError("an Estimator cannot be pickled: send its Settings and Images, which can")

    def __repr__(self) -> str:
        return f"<goe.Estimator, faults {sum(self.fault_counts[1:])}>"


def run(
    settings: Settings, images: ImagesOrC, *, rules: Sequence[Rule] = (), velocity_ned_m_s: Any = None,
    covariance: bool = False,
) -> Track:  # fmt: skip
    """A new estimator over one whole track: ``Estimator(settings).run(images, ...)``."""
    return Estimator(settings).run(images, rules=rules, velocity_ned_m_s=velocity_ned_m_s, covariance=covariance)


def run_parallel(
    settings: Settings | Sequence[Settings], tracks: Sequence[ImagesOrC], *, rules: Sequence[Rule] = (),
    covariance: bool = False, threads: int | None = None,
) -> list[Track]:  # fmt: skip
    """A new estimator over each of several tracks, several at a time; the same bits as one after the other.

    settings  one for all, or one for each track
    tracks    those with rules have ``Images.velocity_ned_m_s``
    threads   at most; None: as many as this process may use processors

    Raises what the first track that fails raises.
    """
    each = [settings] * len(tracks) if isinstance(settings, Settings) else list(settings)
    if len(each) != len(tracks):
        raise ValueError(f"{len(each)} settings for {len(tracks)} tracks")

    def one(job: tuple[Settings, ImagesOrC]) -> Track:
        return run(job[0], job[1], rules=rules, covariance=covariance)

    count = threads if threads is not None else _processors()
    if count < 1:
        raise ValueError(f"threads = {count}: must be at least 1")
    if count == 1 or len(each) < 2:
        return [one(job) for job in zip(each, tracks)]
    with ThreadPoolExecutor(min(count, len(each)), "goe") as pool:
        return list(pool.map(one, zip(each, tracks)))


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
