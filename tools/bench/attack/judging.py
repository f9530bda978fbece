"""Answers of an estimator against the truth of a track, and statistics of many tracks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from goe_tools.models.coverage import COVERED_SIGMA, Judged

from .scenario import Truth

X0, Z0, ORIENTATION, WIDTH, LENGTH, HEIGHT = range(6)
POSITION = (X0, Z0)
CONFIDENT_SIGMA = 5.0  # an error beyond this ...
CONFIDENT_IMAGES = 5  # ... in this many consecutive images, none of them suspect
COVERED_SHARE = 0.9  # least share of a covered track's answers within two sigma
RESTARTS = 2  # of the filter: a consistent track has fewer in three seconds
DISC, LINE, BOX, PRISM = 2, 3, 4, 5  # the library's models


@dataclass
class Answers:
    """Answers for one track, K images. Quantities in the order X0, Z0, orientation (rad), width, length, height; NaN
    without an answer of the filter method."""

    time_s: np.ndarray
    values: np.ndarray  # (K, 6)
    sigma: np.ndarray  # (K, 6)
    model: np.ndarray  # (K,)
    status: np.ndarray  # (K,)
    suspect: np.ndarray  # (K,)
    restarted: np.ndarray  # (K,) the filter restarted
    reason: np.ndarray | None = None  # (K,) of suspicion, as text; None: not reported by the library
    velocity_m_s: np.ndarray | None = (
        None  # (K, 2) of the obstacle, north and east, NaN if not reported; None: never reported
    )
    velocity_sigma_m_s: np.ndarray | None = None
    place_m: np.ndarray | None = None  # (K, 2) X, Z relative to the camera now; None: never reported
    place_sigma_m: np.ndarray | None = None
    latency_s: np.ndarray | None = None  # (K,) of the poses, NaN if not reported; None: never reported
    latency_sigma_s: np.ndarray | None = None
    time_to_go_s: np.ndarray | None = None  # (K,) until the closest approach, NaN if not reported; None: not requested


@dataclass
class Outcome:
    """One judged track: errors and sigmas (K, 6), NaN without an answer that can be judged."""

    answers: Answers
    error: np.ndarray
    sigma: np.ndarray
    followed: np.ndarray | None = None  # (K, 2) errors in sigmas of X and Z relative to the camera now

    @property
    def suspect(self) -> np.ndarray:
        return self.answers.suspect


def folded(angle: np.ndarray) -> np.ndarray:
    """Folds to +-90 degrees: an edge has no direction."""
    return (angle + math.pi / 2) % math.pi - math.pi / 2


# ---------------------------------------------------------------------------------------------------------- one track


def namings(truth: Truth) -> np.ndarray:
    """(2, 6): correct answers for a box: either of the initially visible faces may be the front. The first one has the
    side edge nearer to that of the truth."""
    solid, result = truth.solid, []
    for turn in (0, 1):
        angle = solid.orientation_rad - turn * math.pi / 2
        width, length = (solid.width_m, solid.length_m) if turn == 0 else (solid.length_m, solid.width_m)
        out = np.array([math.sin(angle), math.cos(angle)])  # along the side edge
        faces = [truth.middle_m - sign * 0.5 * length * out for sign in (1.0, -1.0)]
        front = min(faces, key=lambda face: float(np.hypot(*face)))  # the face towards the camera
        result.append([*front, folded(np.array(angle)), width, length, solid.height_m])
    return np.array(result)


def _known(angle: np.ndarray) -> np.ndarray:
    """(K,): fills gaps from the next answer, otherwise from the last; all NaN without any."""
    known = np.flatnonzero(np.isfinite(angle))
    if not len(known):
        return angle
    return angle[known[np.minimum(np.searchsorted(known, np.arange(len(angle))), len(known) - 1)]]


def width_across(truth: Truth) -> float:
    """Width of the footprint, perpendicular to the first line of sight."""
    solid = truth.solid
    if solid.kind == "cylinder":
        return solid.width_m
    sight = truth.middle_m
    sight = sight / np.linalg.norm(sight)
    return float(np.ptp(np.concatenate(solid.bases()) @ np.array([sight[1], -sight[0]])))


def _correct(answers: Answers, truth: Truth) -> np.ndarray:
    """(K, 6) correct answers for a box, in the naming nearer to each answer."""
    as_box = (answers.model == BOX) | (answers.model == LINE)
    angle = _known(np.where(as_box, answers.values[:, ORIENTATION], np.nan))
    one, other = namings(truth)
    with np.errstate(invalid="ignore"):
        turned = np.abs(folded(angle - one[ORIENTATION])) > math.pi / 4
    return np.where(turned[:, None], other, one)


def followed(answers: Answers, truth: Truth) -> np.ndarray | None:
    """Errors in sigmas (K, 2) of X and Z relative to the camera now, NaN without an answer, and for a mover without a
    velocity; None: never reported."""
    if answers.place_m is None or answers.place_sigma_m is None:
        return None
    way = truth.velocity_ned_m_s * answers.time_s[:, None] - truth.eye_ned_m[:, :2]
    a = truth.axis_rad
    place = way @ np.array([[-math.sin(a), math.cos(a)], [math.cos(a), math.sin(a)]])
    if truth.solid.kind != "cylinder":
        by_face = np.isin(answers.model, (BOX, LINE))[:, None]
        place = place + by_face * (_correct(answers, truth)[:, :2] - truth.middle_m)
    there = answers.place_sigma_m > 0.0
    if truth.velocity_ned_m_s.any() and answers.velocity_m_s is not None:
        there &= np.isfinite(answers.velocity_m_s).all(1)[:, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(there, np.abs(answers.place_m - place) / answers.place_sigma_m, np.nan)


def judge(answers: Answers, truth: Truth) -> Outcome:
    """For a box, either naming of front and side is right; the one nearer in angle counts. A prism gives the place of
    its middle, the height, and the width across the first line of sight; a disc that represents another shape only the
    place of its middle."""
    values, solid = answers.values, truth.solid
    error = np.full_like(values, np.nan)
    if solid.kind == "cylinder":
        names = [X0, Z0, WIDTH, HEIGHT]
        error[:, names] = values[:, names] - [*truth.middle_m, solid.width_m, solid.height_m]
    else:
        as_box = (answers.model == BOX) | (answers.model == LINE)
        error[as_box] = (values - _correct(answers, truth))[as_box]
        error[~as_box, :2] = values[~as_box, :2] - truth.middle_m
        prism = answers.model == PRISM
        error[prism, WIDTH] = values[prism, WIDTH] - width_across(truth)
        error[prism, HEIGHT] = values[prism, HEIGHT] - solid.height_m
    error[:, ORIENTATION] = folded(error[:, ORIENTATION])
    there = np.isfinite(error) & np.isfinite(answers.sigma)
    sigma = np.where(there, answers.sigma, np.nan)
    return Outcome(answers, np.where(there, error, np.nan), sigma, followed(answers, truth))


def longest_run(flags: np.ndarray) -> int:
    """Largest number of consecutive flagged images."""
    ends = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return int((ends[1::2] - ends[::2]).max(initial=0))


def is_confidently_wrong(outcome: Judged, quantities: Sequence[int] = range(6)) -> bool:
    """Whether one of the quantities is far outside its sigma in several consecutive images without any warning."""
    with np.errstate(invalid="ignore"):
        far = np.abs(outcome.error) > CONFIDENT_SIGMA * outcome.sigma
    return longest_run(far[:, list(quantities)].any(1) & ~outcome.suspect) >= CONFIDENT_IMAGES


def first_flag_s(answers: Answers, flags: np.ndarray) -> float:
    """Time of the first flagged image; infinite without one."""
    flagged = np.flatnonzero(flags)
    return float(answers.time_s[flagged[0]] - answers.time_s[0]) if len(flagged) else math.inf


def flagged(answers: Answers, word: str) -> np.ndarray:
    """(K,): whether an image's reason contains the word; for a library without reasons: whether it is suspect."""
    if answers.reason is None:
        return answers.suspect
    return np.array([word in reason for reason in answers.reason], bool)


def is_odd_within(answers: Answers, limit_s: float) -> bool:
    """Whether an inconsistency of the whole track is reported by a time: suspect, repeated restarts of the filter, or
    faults in most images."""
    early = answers.time_s - answers.time_s[0] <= limit_s
    faults = float(np.mean(answers.status[early] < 0))
    return bool(answers.suspect[early].any()) or int(answers.restarted[early].sum()) >= RESTARTS or faults > 0.5


# --------------------------------------------------------------------------------------------------------- many tracks


def share(flags: Sequence[bool]) -> float:
    """Percentage of true flags."""
    return 100.0 * float(np.mean(flags)) if len(flags) else math.nan


def confident(outcomes: Sequence[Outcome]) -> dict[str, float]:
    """Percent of the tracks with a confident error in any quantity, and in the position."""
    return {
        "any": share([is_confidently_wrong(o) for o in outcomes]),
        "position": share([is_confidently_wrong(o, POSITION) for o in outcomes]),
    }


def suspected(outcomes: Sequence[Outcome]) -> dict[str, float]:
    """Percent of the tracks that are ever suspect, and of all images."""
    images = np.concatenate([o.answers.suspect for o in outcomes])
    return {"tracks": share([bool(o.answers.suspect.any()) for o in outcomes]), "images": share(images.tolist())}


def answered(outcomes: Sequence[Outcome]) -> float:
    """Percent of the tracks with a position in any image."""
    return share([bool(np.isfinite(o.error[:, Z0]).any()) for o in outcomes])


def flagged_within(outcomes: Sequence[Outcome], word: str, limit_s: float) -> float:
    """Percent of the tracks with this reason by a time; an infinite limit: ever."""
    times = [first_flag_s(o.answers, flagged(o.answers, word)) for o in outcomes]
    return share([math.isfinite(time) and time <= limit_s for time in times])


def suspect_or_covered(outcomes: Sequence[Outcome]) -> float:
    """Percent of the tracks that are suspect in some image or covered by their sigmas."""
    good = []
    for o in outcomes:
        there = np.isfinite(o.error)
        with np.errstate(invalid="ignore"):
            inside = (np.abs(o.error) < COVERED_SIGMA * o.sigma)[there]
        good.append(bool(o.answers.suspect.any()) or (inside.size > 0 and inside.mean() >= COVERED_SHARE))
    return share(good)


def velocity_covered(outcomes: Sequence[Outcome], velocity_m_s: Sequence[np.ndarray]) -> float:
    """Percent of the reported velocities, north and east, within two sigma of the true ones (2,), one for each track;
    NaN if none is reported."""
    inside = []
    for o, true in zip(outcomes, velocity_m_s):
        if o.answers.velocity_m_s is None or o.answers.velocity_sigma_m_s is None:
            continue
        ratio = np.abs(o.answers.velocity_m_s - true) / o.answers.velocity_sigma_m_s
        inside += (ratio[np.isfinite(ratio)] < COVERED_SIGMA).tolist()
    return share(inside)


def time_error(outcomes: Sequence[Outcome], true_s: Sequence[np.ndarray], word: str, least_s: float) -> float:
    """Median over the tracks of the error of the reported time to go, percent of the true one (K,), from the flag on
    while at least ``least_s`` are left; NaN if no track is flagged early enough."""
    medians = []
    for o, true in zip(outcomes, true_s):
        flags = flagged(o.answers, word)
        if o.answers.time_to_go_s is None or not flags.any():
            continue
        after = np.arange(len(flags)) >= np.argmax(flags)
        chosen = after & (true > least_s) & np.isfinite(o.answers.time_to_go_s)
        if chosen.any():
            medians.append(100.0 * np.median(np.abs(o.answers.time_to_go_s - true)[chosen] / true[chosen]))
    return float(np.median(medians)) if medians else math.nan


def followed_covered(outcomes: Sequence[Outcome]) -> float:
    """Percent of the places now, X and Z, within two sigma; NaN if none is reported."""
    ratios = [o.followed[np.isfinite(o.followed)] for o in outcomes if o.followed is not None]
    return share([bool(ratio < COVERED_SIGMA) for of_track in ratios for ratio in of_track])


def latency_covered(outcomes: Sequence[Outcome], late_s: float) -> float:
    """Percent of a track's latencies within two sigma, mean over the tracks with one; NaN without any."""
    shares = []
    for o in outcomes:
        if o.answers.latency_s is None or o.answers.latency_sigma_s is None:
            continue
        ratio = np.abs(o.answers.latency_s - late_s) / o.answers.latency_sigma_s
        if np.isfinite(ratio).any():
            shares.append(100.0 * float((ratio[np.isfinite(ratio)] < COVERED_SIGMA).mean()))
    return float(np.mean(shares)) if shares else math.nan


def typical_error(outcomes: Sequence[Outcome], quantity: int = Z0) -> float:
    """Error in sigmas: the median over the tracks of a track's median. 0.67 if errors are Gaussian."""
    medians = []
    for o in outcomes:
        ratio = np.abs(o.error[:, quantity]) / o.sigma[:, quantity]
        if np.isfinite(ratio).any():
            medians.append(float(np.nanmedian(ratio)))
    return float(np.median(medians)) if medians else math.nan


def shortfall(covered: Sequence[float], flagged: float, wanted: tuple[float, float]) -> float:
    """Percent lacking until the worst coverage or the share of flagged tracks is as wanted; 0: one of them is."""
    there = [value for value in covered if math.isfinite(value)]
    return max(0.0, min(wanted[0] - min(there, default=0.0), wanted[1] - flagged))


def odd_within(outcomes: Sequence[Outcome], limit_s: float) -> float:
    """Percent of the tracks that are ``is_odd_within``."""
    return share([is_odd_within(o.answers, limit_s) for o in outcomes])
