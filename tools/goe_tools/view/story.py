"""A replayed log in the axes of the map, for page and picture.

Map: from above, meters from the camera's first position, the course of the path upwards. If there are too many images,
the story contains an even selection over time, and images with a change of estimate, model, suspicion or filter reset.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..logs.obslog import ObservationLog, Truth
from .answers import Answers, Options, answers_of
from .motion import Motion, motion_of
from .outline import nearest_on_outline, outlines
from .truth import footprint, true_columns

MOST_ROWS = 3000  # of all obstacles, on one page
EARLY_REGIONS = 0.1  # share of the two-sigma regions that may reach beyond the map, at each side
BRIEF = 0.4  # share of the flight
COURSE_MIN_M = 1.0  # a shorter path has no course
FIRST_LOOK, SIZED_FOR = 0.4, 0.05  # of the time with estimates: the initial moment; least time after the first width


@dataclass
class Track:
    """One obstacle, in K images. Positions on the map; NaN: none."""

    answers: Answers
    time_s: np.ndarray  # (K,)
    row_at: np.ndarray  # (M,) its latest image at each moment, -1 before the first
    truth: dict[str, np.ndarray]  # by the names of ``Answers.column``; empty: unknown
    truth_outline: np.ndarray  # (P, 2)
    circle: np.ndarray  # (K, 3) middle and radius
    corner: np.ndarray  # (K, 4, 2)
    region: np.ndarray  # (K, points, 2)
    closest: np.ndarray  # (K, 2) the aircraft at the predicted closest approach ...
    nearest: np.ndarray  # (K, 2) ... and the outline's nearest point to it then
    moved: np.ndarray  # (K, 2) the outline's middle then, if the obstacle moves and is followed
    anchor: np.ndarray | None  # (2,) its true or last position; None: it moves, or there is no estimate

    @property
    def id(self) -> int:
        return self.answers.id


@dataclass
class Story:
    """Over M moments."""

    name: str
    time_s: np.ndarray
    path: np.ndarray  # (M, 2)
    velocity: np.ndarray  # (M, 2) map axes, m/s
    look_rad: np.ndarray  # (M, 2) from the map's up, clockwise: left and right border of the image
    broken: np.ndarray
    reset: np.ndarray
    north_rad: float  # direction of north, from the map's up, clockwise
    tracks: list[Track]
    rows: int  # of the log
    moments: int  # of the log
    options: Options

    def at(self, time_s: float) -> int:
        """The last moment at or before a time; the first if there is none."""
        return max(int(np.searchsorted(self.time_s, time_s + 1e-9, side="right")) - 1, 0)

    def first_look(self, track: Track) -> int:
        """The initial moment: midway through the images with estimates, where there is a width; or the last one."""
        answered, sized = (
            np.flatnonzero(f) for f in (track.answers.answered, np.isfinite(track.answers.column["width_m"]))
        )
        if not len(answered):
            return len(self.time_s) - 1
        first, last = track.time_s[answered[0]], track.time_s[answered[-1]]
        from_s = track.time_s[sized[0]] if len(sized) else first
        at_s = max(first + FIRST_LOOK * (last - first), from_s + SIZED_FOR * (last - first))
        sized_s = track.time_s[sized]
        return self.at(min(sized_s[sized_s >= at_s], default=at_s))

    def chosen(self, key: int | None) -> Track:
        """The obstacle with this id, or the one with most estimates."""
        if key is not None:
            for track in self.tracks:
                if track.id == key:
                    return track
            raise ValueError(f"--id: no obstacle {key}; there are {', '.join(str(t.id) for t in self.tracks[:20])}")
        return max(self.tracks, key=lambda track: int(track.answers.answered.sum()))

    def brief(self, track: Track) -> bool:
        """Whether the obstacle was detected only in a small part of the flight."""
        return bool(track.time_s[-1] - track.time_s[0] < BRIEF * (self.time_s[-1] - self.time_s[0]))


def turned(points: np.ndarray, angle_rad: np.ndarray | float) -> np.ndarray:
    """Points (..., 2) (right, ahead) of axes that are turned clockwise by an angle against those asked for."""
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    x, y = points[..., 0], points[..., 1]
    return np.stack([x * c + y * s, y * c - x * s], -1)


def _course(motion: Motion, answers: list[Answers]) -> float:
    """Heading of the map's upward direction, rad: from the path's start to its end, or that of T."""
    way = motion.camera_ne_m[-1] - motion.camera_ne_m[0]
    if np.hypot(*way) > COURSE_MIN_M:
        return math.atan2(way[1], way[0])
    return float(answers[0].heading_rad[-1])


def _changes(answers: Answers) -> np.ndarray:
    """(K,): whether estimate, model, suspicion or its cause begins or ends."""
    labels = list(zip(answers.answered, answers.model, answers.suspect, answers.reason))
    return np.array([k > 0 and labels[k] != labels[k - 1] for k in range(len(labels))], bool)


def _spread(candidates: np.ndarray, count: int) -> np.ndarray:
    """Up to ``count`` of them, evenly distributed, including the first and the last."""
    if len(candidates) <= count:
        return candidates
    return candidates[np.unique(np.linspace(0, len(candidates) - 1, max(count, 2)).round().astype(int))]


def kept_moments(motion: Motion, answers: list[Answers], most_rows: int) -> np.ndarray:
    """Indices of the shown moments: all, or so many that at most ``most_rows`` rows remain, plus one of each obstacle
    that would have none."""
    count, rows = len(motion.time_s), len(motion.of_frame)
    if rows <= most_rows:
        return np.arange(count)
    most = max(int(most_rows * count / rows), 2)
    changes = motion.reset | motion.broken
    for own in answers:
        changes[own.moment[_changes(own)]] = True
    events = _spread(np.flatnonzero(changes), most // 2)
    kept = np.union1d(_spread(np.arange(count), most - len(events)), events)
    left_out = [own.moment[-1] for own in answers if not np.isin(own.moment, kept).any()]
    return np.union1d(kept, left_out).astype(int)


def _spare_radius(own: Answers, closest: np.ndarray, on_map: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """(K,): radius of goe_hazard's circle while width or length is unknown, from its distance; 0: unknown."""
    reference = on_map(np.stack([own.column["x_m"], own.column["z_m"]], -1))
    radius = np.linalg.norm(closest - reference, axis=1) - own.column["dcpa_m"]
    return np.where(own.column["dcpa_m"] > 0.0, np.maximum(radius, 0.0), 0.0)


def _anchor(own: Answers, middle: np.ndarray, moves: np.ndarray, truth_outline: np.ndarray) -> np.ndarray | None:
    answered = np.flatnonzero(own.answered)
    if len(truth_outline):
        return truth_outline.mean(0)
    return middle[answered[-1]] if len(answered) and not moves.any() else None


def _track(
    own: Answers, motion: Motion, kept: np.ndarray, truth: Truth | None, course: float, origin: np.ndarray
) -> Track:
    rows = np.flatnonzero(np.isin(own.moment, kept))
    own = own.taken(rows)
    turn = own.heading_rad - course
    eye = turned((own.camera_ne_m - origin)[:, ::-1], -course)
    closest = eye + turned(motion.velocity_m_s[own.moment][:, 1::-1], -course) * own.column["tcpa_s"][:, None]
    drift = np.stack([own.column["velocity_east_m_s"], own.column["velocity_north_m_s"]], -1)
    moves = drift.any(1)
    by = np.where(moves[:, None], turned(drift, -course) * own.column["tcpa_s"][:, None], 0.0)

    def on_map(points: np.ndarray) -> np.ndarray:
        extra = (1,) * (points.ndim - 2)
        return turned(points, turn.reshape(-1, *extra)) + eye.reshape(-1, *extra, 2)

    shape = outlines(own.column, own.model, own.covariance, _spare_radius(own, closest - by, on_map))
    circle = np.column_stack([on_map(shape.circle[:, :2]), shape.circle[:, 2]])
    corner, region = on_map(shape.corner), on_map(shape.region)
    middle = np.where(np.isfinite(circle[:, :1]), circle[:, :2], corner.mean(1))
    outline = footprint(truth) if truth else np.empty((0, 2))
    outline_on_map = turned((outline - origin)[:, ::-1], -course)
    return Track(
        own, motion.time_s[own.moment], np.searchsorted(own.moment, kept, side="right") - 1,
        true_columns(truth, own) if truth else {}, outline_on_map, circle, corner, region, closest,
        nearest_on_outline(closest - by, circle, corner) + by, np.where(moves[:, None], middle + by, np.nan),
        _anchor(own, middle, moves, outline_on_map),
    )  # fmt: skip


def story_of(name: str, log: ObservationLog, options: Options, most_rows: int = MOST_ROWS) -> Story:
    """Replays a log with at least one row."""
    motion = motion_of(log)
    answers = answers_of(log, motion, options)
    course, origin = _course(motion, answers), motion.camera_ne_m[0]
    kept = kept_moments(motion, answers, most_rows)
    tracks = [_track(own, motion, kept, log.truth.get(own.id), course, origin) for own in answers]
    broken, reset = (np.logical_or.reduceat(flags, kept) for flags in (motion.broken, motion.reset))
    return Story(
        name, motion.time_s[kept], turned((motion.camera_ne_m[kept] - origin)[:, ::-1], -course),
        turned(motion.velocity_m_s[kept][:, 1::-1], -course), motion.look_rad[kept] - course, broken, reset, -course,
        tracks, len(log.frames), len(motion.time_s), options,
    )  # fmt: skip


def map_bounds(story: Story, alone: Track | None = None) -> list[float]:
    """left, right, bottom, top of the whole flight on the map: path, truth, outlines, and most of the regions.
    ``alone``: of one obstacle, and the path while it was detected."""
    points = [story.path]
    if alone is not None:
        points = [story.path[(story.time_s >= alone.time_s[0]) & (story.time_s <= alone.time_s[-1])]]
    for track in story.tracks if alone is None else [alone]:
        points.append(track.truth_outline)
        answered = np.flatnonzero(track.answers.answered)
        if len(answered):
            last = answered[-1]
            points += [track.region[last], track.corner[last], track.circle[last, None, :2]]
            reach = track.region[answered]
            low = np.quantile(reach.min(1), EARLY_REGIONS, axis=0)
            high = np.quantile(reach.max(1), 1.0 - EARLY_REGIONS, axis=0)
            points += [low[None], high[None]]
    every = np.concatenate(points)
    every = every[np.isfinite(every).all(1)]
    low, high = every.min(0), every.max(0)
    return [float(low[0]), float(high[0]), float(low[1]), float(high[1])]
