"""The offset of the camera's clock that the command uses: the given one, or the found one if it can be trusted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..logs.fields import LogError, warn
from ..logs.obslog import Camera, Frame
from ..logs.progress import Progress
from .clock import LEAST_IMAGES, Offset, find_offset, is_whole
from .recording import Poses, Recording

WORST_SIGMA_S = 0.02  # of an estimated offset: 0.5 degrees at 24 degrees a second
POOR, WRONG = 2.5, 5.0  # residual in units of the boxes' usual noise: a warning, and no offset
LEAST_SHARE = 0.5  # of the rows; of fewer a warning
SLOW_STEP_S, UNIX_S = 5.0, 1e8
MISTAKES = "tools/goe_tools/exchange/README.md, 'Symptoms'"


@dataclass(frozen=True)
class Searched:
    """The search interval, and the longest gap between poses."""

    about_s: float
    reach_s: float
    gap_s: float

    def __str__(self) -> str:
        return f"within {self.about_s - self.reach_s:g} to {self.about_s + self.reach_s:g} s"


def _log_span(recording: Recording) -> tuple[float, float]:
    spans = [(series.time_s[0], series.time_s[-1]) for series in (recording.position, recording.attitude)]
    return max(float(start) for start, _ in spans), min(float(end) for _, end in spans)


def spans(frames: Sequence[Frame], recording: Recording, offset_s: float) -> str:
    """The times of the table and of the log, and a hint at another unit or epoch."""
    time_s = np.unique([frame.t_s for frame in frames])
    start, end = _log_span(recording)
    text = f"t_s runs from {time_s[0]:.3f} to {time_s[-1]:.3f} s, and the poses from {start:.3f} to {end:.3f} s"
    if offset_s:
        text += f", {offset_s:+g} s to be added to t_s"
    if time_s[0] + offset_s < end and time_s[-1] + offset_s > start:
        return text
    step_s = float(np.median(np.diff(time_s))) if len(time_s) > 1 else 0.0
    if step_s > SLOW_STEP_S:
        unit = "milliseconds" if step_s < 1e3 * SLOW_STEP_S else "microseconds"
        return f"{text}: {unit}? t_s is in seconds"
    epoch = "Unix time? " if time_s[0] > UNIX_S else ""
    return f"{text}: {epoch}the clocks have different epochs; give --about, the autopilot's time minus t_s"


def _found_or_refused(table: Path, frames: Sequence[Frame], cameras: Sequence[Camera], poses: Poses,
                      searched: Searched) -> Offset:  # fmt: skip
    progress = Progress("searching the offset of the camera's clock", 1.0)
    found = find_offset(
        frames, cameras, poses, searched.about_s, searched.reach_s, searched.gap_s, lambda share: progress.show(share)
    )
    progress.end()
    if found is not None:
        return found
    whole = sum(is_whole(frame, cameras[frame.camera]) for frame in frames)
    raise LogError(
        table, 0, "t_s",
        f"no track has known poses {searched} of offset: {spans(frames, poses.recording, searched.about_s)}; "
        f"{whole} of {len(frames)} rows show a whole obstacle, and a track needs {LEAST_IMAGES} of them with a pose; "
        "use --offset, or give the search interval with --about and --within",
    )  # fmt: skip


def _refusal(found: Offset, searched: Searched) -> str:
    """Why an offset cannot be trusted. Empty: it can."""
    best = f"the best is {found.offset_s:+.4f} s"
    if math.isfinite(found.sigma_s):
        best = f"the best is {found.offset_s:+.4f} +- {found.sigma_s:.4f} s"
    if found.misfit > WRONG:
        return (
            f"turns and boxes fit at no offset {searched}: {best} and leaves {found.misfit:.2g} times the usual noise "
            "of boxes: the true offset is outside, or the poses, camera.ini or the boxes have another convention "
            f"(order or inverse of the quaternion, axes, exchanged columns; see {MISTAKES})"
        )
    if found.at_the_end or not found.sigma_s <= WORST_SIGMA_S:
        return (
            f"turns and boxes determine no offset {searched}: {best}: too few turns, an offset outside, or another "
            f"convention in the poses, camera.ini or the boxes (see {MISTAKES})"
        )
    return ""


def found_offset(
    table: Path, frames: Sequence[Frame], cameras: Sequence[Camera], poses: Poses, searched: Searched
) -> float:
    """Prints the offset with its fit. LogError: none can be trusted."""
    found = _found_or_refused(table, frames, cameras, poses, searched)
    refusal = _refusal(found, searched)
    if refusal:
        way_out = "use --offset, or give the search interval with --about and --within"
        raise LogError(table, 0, "t_s", f"{refusal}; {way_out}")
    print(
        f"time offset, from {found.images} of {len(frames)} rows: {found.offset_s:+.4f} +- {found.sigma_s:.4f} s to be "
        f"added to t_s; residual {found.misfit:.2g} times the usual noise of boxes"
    )
    if found.misfit > POOR:
        warn(table, f"the offset leaves {found.misfit:.2g} times the usual noise of boxes: see {MISTAKES}")
    if found.images < LEAST_SHARE * len(frames):
        reason = "the others show no whole obstacle, or have no pose at some offset of the interval"
        warn(table, f"only {found.images} of {len(frames)} rows determine the offset: {reason}")
    return found.offset_s


def warn_of_few(table: Path, kept: int, frames: Sequence[Frame], recording: Recording, offset_s: float) -> None:
    """Warns if most rows have no pose."""
    if 0 < kept < LEAST_SHARE * len(frames):
        warn(table, f"only {kept} of {len(frames)} rows have a pose: {spans(frames, recording, offset_s)}")
