"""Writes an observation log and its estimates as MCAP, for Foxglove and PlotJuggler.

python -m goe_tools mcap LOG --out FILE"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np
from tqdm import tqdm

from ..flights.rotations import matrices
from ..logs.estimates import NUMBERS, Estimate, read_estimates
from ..logs.fields import LogError
from ..logs.obslog import Frame, ObservationLog, read_log
from ..logs.whole_file import log_files, refuse_inputs, replacing
from ..places import ROOT
from .messages import (
    SCHEMAS,
    Json,
    estimate_message,
    nanoseconds,
    observation_message,
    observation_numbers,
    obstacle_message,
    plain_schema,
    pose_messages,
    truth_message,
)

SCENE, POSE, TRANSFORM = "foxglove.SceneUpdate", "foxglove.PoseInFrame", "foxglove.FrameTransform"
Estimates = dict[tuple[int, int], Estimate]  # by time stamp in ns and id
Message = tuple[str, str, int, Json]  # topic, schema, time in ns, content


class Topics:
    """An MCAP file that adds schemas and channels with their first message."""

    def __init__(self, stream: IO[bytes]) -> None:
        from mcap.writer import Writer  # imported here: the other commands do not need it

        self._writer = Writer(stream)
        self._writer.start(profile="", library="goe_tools")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}

    def _channel(self, topic: str, schema: str, columns: list[str]) -> int:
        if schema not in self._schemas:
            text = json.dumps(SCHEMAS[schema] if schema in SCHEMAS else plain_schema(columns)).encode()
            self._schemas[schema] = self._writer.register_schema(schema, "jsonschema", text)
        if topic not in self._channels:
            self._channels[topic] = self._writer.register_channel(topic, "json", self._schemas[schema])
        return self._channels[topic]

    def write(self, message: Message, columns: list[str]) -> None:
        topic, schema, time_ns, content = message
        data = json.dumps(content, allow_nan=False).encode()
        channel = self._channel(topic, schema, columns)
        self._writer.add_message(channel, log_time=time_ns, publish_time=time_ns, data=data)

    def close(self) -> None:
        self._writer.finish()


def run_replay(folder: Path, out: Path) -> None:
    """goe_replay's estimates of a log, from $GOE_REPLAY or the program in this checkout's build."""
    program = Path(os.environ.get("GOE_REPLAY") or ROOT / "build" / "sim_host" / "goe_replay")
    if not program.is_file():
        raise FileNotFoundError(f"{program}: not found; build it, set $GOE_REPLAY, or use --estimates")
    words = [str(program), "--out", str(out), str(folder)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):  # 1: no row gave an estimate
        raise ValueError(done.stderr.strip() or f"{program}: exit status {done.returncode}")


def _estimates(folder: Path, file: Path | None) -> Estimates:
    if file is not None:
        rows = read_estimates(file)
    else:
        with tempfile.TemporaryDirectory() as scratch:
            run_replay(folder, Path(scratch) / "estimates.csv")
            rows = read_estimates(Path(scratch) / "estimates.csv")
    return {(nanoseconds(t_s), key): estimate for t_s, key, estimate in rows if math.isfinite(t_s)}


def _heading_deg(log: ObservationLog, first: Frame) -> float:
    """Heading of the Z axis of a track's trajectory frame."""
    if log.camera.heading_deg is not None:
        return log.camera.heading_deg
    forward = matrices(np.array(first.attitude))[:, 0]
    return math.degrees(math.atan2(forward[1], forward[0]))


def _usable(frame: Frame) -> bool:
    """Whether the row has a time and a pose; others cannot be placed or drawn."""
    return bool(np.isfinite([*frame.position_m, *frame.attitude]).all())


def messages(log: ObservationLog, estimates: Estimates) -> Iterator[Message]:
    """In the order of time; the truth comes with the first row. Rows without a time are left out."""
    frames = sorted((f for f in log.frames if f.time_us is not None and f.time_us >= 0), key=lambda f: f.t_s)
    first: dict[int, tuple[float, int]] = {}
    posed = -1
    for truth in log.truth.values() if frames else ():
        if np.isfinite([truth.center_n_m, truth.center_e_m, truth.ground_d_m, truth.width_m, truth.height_m]).all():
            yield "/truth", SCENE, nanoseconds(frames[0].t_s), truth_message(frames[0].t_s, truth)
    for frame in frames:
        time_ns = nanoseconds(frame.t_s)
        yield f"/observation/{frame.id}", "goe.Observation", time_ns, observation_message(frame)
        if _usable(frame):
            if time_ns != posed:
                pose, transform = pose_messages(frame)
                yield "/pose", POSE, time_ns, pose
                yield "/tf", TRANSFORM, time_ns, transform
                posed = time_ns
            cut = frame.reset_count if frame.reset_delta_m is None else None
            if frame.id not in first or (cut is not None and cut != first[frame.id][1]):
                first[frame.id] = (_heading_deg(log, frame), frame.reset_count)
            if cut is None:
                first[frame.id] = (first[frame.id][0], frame.reset_count)
        estimate = estimates.get((time_ns, frame.id))
        if estimate is None:
            continue
        yield f"/estimate/{frame.id}", "goe.Estimate", time_ns, estimate_message(frame.t_s, estimate)
        if _usable(frame):
            ground = frame.position_m[2] + frame.height_m
            scene = obstacle_message(frame, estimate, first[frame.id][0], ground)
            if scene is not None:
                yield "/obstacles", SCENE, time_ns, scene


def write_mcap(path: Path, log: ObservationLog, estimates: Estimates) -> dict[str, int]:
    """Writes the file and returns the number of messages by topic."""
    columns: dict[str, list[str]] = {"goe.Estimate": ["images_used", *NUMBERS, "suspect"]}
    if log.frames:
        columns["goe.Observation"] = list(observation_numbers(log.frames[0]))
    count: dict[str, int] = {}
    with replacing(path) as place, place.open("wb") as stream:
        topics = Topics(stream)
        for message in tqdm(messages(log, estimates), desc=str(path), disable=None, leave=False):
            topics.write(message, columns.get(message[1], []))
            count[message[0]] = count.get(message[0], 0) + 1
        topics.close()
    return count


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add: Any = parser.add_argument
    add("log", type=Path, metavar="LOG", help="log folder")
    add("--estimates", type=Path, metavar="CSV", help="goe_replay's output (default: runs goe_replay)")
    add("--out", type=Path, required=True, metavar="FILE", help="file to write (.mcap)")


def run(arguments: argparse.Namespace) -> int:
    refuse_inputs(arguments.out, [*log_files(arguments.log), arguments.estimates])
    log = read_log(arguments.log)
    count = write_mcap(arguments.out, log, _estimates(arguments.log, arguments.estimates))
    if not count:
        raise LogError(arguments.log / "frames.csv", 0, "t_s", "no row has a time of 0 or more")
    for topic, number in sorted(count.items()):
        print(f"{topic}: {number}")
    return 0
