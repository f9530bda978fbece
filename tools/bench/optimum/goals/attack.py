"""The library over the hostile flights of ``attack``: a line of goals for each figure of a row.

Reasons of suspicion and the obstacle's velocity are used if ``Track.more`` has the columns ``reason`` (named by
``reason_names``) and ``VELOCITY``; settings that the library does not have are left out with a message."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from goe_tools.flights.measured import measure
from goe_tools.flights.recorded import recorded_scenes
from goe_tools.library import (
    METHODS,
    Images,
    Plan,
    Track,
    camera_settings,
    estimate,
    has_setting,
    reason_names,
    run,
    settings_of,
)
from goe_tools.models.coverage import coverage
from goe_tools.report import attack_lines
from goe_tools.spread import each

from ...attack import approach, harder, judging, rows, scenario
from ...attack.judging import Answers, Outcome
from ...attack.rows import MOVES, Ask, Row
from ...attack.scenario import Inputs
from .goal import OPEN, Figures, Goal, Range, named
from .work import Amount

VELOCITY = ("velocity_north_m_s", "velocity_east_m_s", "velocity_north_sd_m_s", "velocity_east_sd_m_s")
PLACE, LATENCY = ("x_m", "z_m", "x_sd_m", "z_sd_m"), ("latency_s", "latency_sd_s")
PLANS = (
    Plan(approach.MARGIN_M, approach.CLEARANCE_M),
    Plan(approach.MARGIN_M, approach.CLEARANCE_M, grows=True),
)
TIME_LEAST_S = 2.0  # smallest remaining time at which the reported time to go is judged
TIMED_S = 60.0  # part of a moving obstacle's path that is searched for the closest approach
RECORDED_MOST = {"px4": 3.0}  # percent flagged as moving, with the settings for that autopilot


def images_of(inputs: Inputs, plans: tuple[Plan, ...] = ()) -> Images:
    return Images(
        inputs.time_s, inputs.position_ned_m, inputs.attitude, inputs.height_m, inputs.pixel_px, inputs.seen,
        inputs.box_px, inputs.reset_count, inputs.reset_m, inputs.velocity_ned_m_s if plans else None, plans,
    )  # fmt: skip


def known(settings: dict[str, float]) -> dict[str, float]:
    """The settings that the library has."""
    return {name: value for name, value in settings.items() if has_setting(name)}


def reasons_of(track: Track) -> np.ndarray | None:
    """(K,) reason of suspicion, as text; None if the library does not report reasons."""
    names = reason_names()
    if "reason" not in track.more or not names:
        return None
    return np.array([names[number] if 0 <= number < len(names) else "" for number in track.more["reason"]])


def _columns(track: Track, names: tuple[str, ...], refined: np.ndarray) -> tuple[np.ndarray, ...] | tuple[None, None]:
    """The first and the second half of these columns, NaN where a sigma is 0; None if the library lacks them."""
    if not all(name in track.more for name in names):
        return None, None
    values, sigma = np.split(np.stack([track.more[name] for name in names], 1), 2, axis=1)
    there = refined[:, None] & (sigma > 0.0)
    return np.where(there, values, np.nan), np.where(there, sigma, np.nan)


def answers_of(track: Track, time_s: np.ndarray) -> Answers:
    """The filter method's answers: the window's sigmas do not describe the true error."""
    refined = track.method == METHODS["filter"]
    values, sigma = (np.where(refined[:, None], a, np.nan) for a in (track.values, track.sigma))
    points = track.images_used if track.images_used is not None else np.zeros(len(time_s), int)
    restarted = np.append(False, np.diff(points) < 0)  # images used: the number grows until a restart
    answers = Answers(time_s, values, sigma, track.model, track.status, track.suspect, restarted, reasons_of(track))
    if all(name in track.more for name in VELOCITY):
        velocity = np.stack([track.more[name] for name in VELOCITY], 1)
        there = (velocity[:, 2:] > 0.0).all(1)[:, None]
        parts = [np.where(there, velocity[:, i : i + 2], np.nan) for i in (0, 2)]
        answers.velocity_m_s, answers.velocity_sigma_m_s = parts
    answers.place_m, answers.place_sigma_m = _columns(track, PLACE, refined)
    latency, sigma_s = _columns(track, LATENCY, refined)
    if latency is not None and sigma_s is not None:
        answers.latency_s, answers.latency_sigma_s = latency[:, 0], sigma_s[:, 0]
    if track.hazard:
        answers.time_to_go_s = np.where(track.hazard["status"][:, 0] == 0, track.hazard["tcpa_s"][:, 0], np.nan)
    return answers


def perform(row: Row, number: int) -> tuple[Outcome, Figures]:
    """A track of a row; for moving obstacles also the velocity, and the true time to go up to the limit for judging."""
    inputs = scenario.fly(row.scenario, number)
    timed = any(ask.line == attack_lines.TIME for ask in row.asked)
    settings = {**inputs.settings, **row.settings, **known(row.if_known)}
    track = run(images_of(inputs, PLANS[:1] if timed else ()), settings)
    return judging.judge(answers_of(track, inputs.time_s), inputs.truth), _motion(inputs, timed)


def _motion(inputs: Inputs, timed: bool) -> Figures:
    velocity = inputs.truth.velocity_ned_m_s
    result = {"north": float(velocity[0]), "east": float(velocity[1])}
    if timed:
        path = inputs.truth.path_velocity_ned_m_s[0]
        first = approach.closest(inputs.truth, 0, path - np.append(velocity, 0.0), TIMED_S)
        result["closest_s"] = first.time_s
    return result


def _harder_lines(row: Row, results: Sequence[tuple[Outcome, Figures]]) -> dict[str, tuple[str, Figures]]:
    """Line -> unit and figures, for the section "harder world"."""
    outcomes = [outcome for outcome, _ in results]
    suspected, covered = judging.suspected(outcomes), named(coverage(outcomes))
    velocity = [np.array([motion["north"], motion["east"]]) for _, motion in results]
    lines: dict[str, tuple[str, Figures]] = {
        attack_lines.VELOCITY: ("%", {attack_lines.IMAGES: judging.velocity_covered(outcomes, velocity)}),
        attack_lines.FOLLOWED: ("%", {attack_lines.IMAGES: judging.followed_covered(outcomes)}),
        attack_lines.SUSPECT: ("%", {**suspected, attack_lines.OR_COVERED: judging.suspect_or_covered(outcomes)}),
        attack_lines.ANSWERS: ("%", {attack_lines.TRACKS: judging.answered(outcomes)}),
    }
    if row.scenario.moves:
        within = {attack_lines.IN_4_S: 4.0, attack_lines.IN_8_S: 8.0, attack_lines.EVER: math.inf}
        reasons = {name: judging.flagged_within(outcomes, MOVES, limit) for name, limit in within.items()}
        return lines | {attack_lines.REASON: ("%", reasons)}
    lines[attack_lines.COVER] = "%", covered
    lines[attack_lines.WRONG] = "%", judging.confident(outcomes)
    lines[attack_lines.TYPICAL] = "1", {"Z0": judging.typical_error(outcomes)}
    latency = judging.latency_covered(outcomes, row.scenario.wrong.late_s)
    lines[attack_lines.LATENCY] = "%", {attack_lines.IMAGES: latency}
    if row.either is not None:
        worst = [covered[name] for name in ("X0", "Z0", "W", "H")]
        short = judging.shortfall(worst, suspected[attack_lines.TRACKS], row.either)
        lines[attack_lines.SHORT] = "%", {attack_lines.TRACKS: short}
    return lines


def _lines(row: Row, results: Sequence[tuple[Outcome, Figures]]) -> dict[str, tuple[str, Figures]]:
    """Line -> unit and figures."""
    if row.section == harder.SECTION:
        return _harder_lines(row, results)
    outcomes = [outcome for outcome, _ in results]
    suspected = judging.suspected(outcomes)
    lines: dict[str, tuple[str, Figures]] = {}
    if row.section == "moving obstacles":
        within = partial(judging.flagged_within, outcomes, MOVES)
        lines[attack_lines.REASON] = (
            "%",
            {attack_lines.IN_4_S: within(4.0), attack_lines.IN_8_S: within(8.0), attack_lines.EVER: within(math.inf)},
        )
        velocity = [np.array([motion["north"], motion["east"]]) for _, motion in results]
        lines[attack_lines.VELOCITY] = "%", {attack_lines.IMAGES: judging.velocity_covered(outcomes, velocity)}
        if any("closest_s" in motion for _, motion in results):
            left = [motion["closest_s"] - outcome.answers.time_s for outcome, motion in results]
            lines[attack_lines.TIME] = (
                "%",
                {attack_lines.MEDIAN: judging.time_error(outcomes, left, MOVES, TIME_LEAST_S)},
            )
    elif row.section == "conventions":
        lines[attack_lines.ODD] = "%", {attack_lines.FLAGGED: judging.odd_within(outcomes, attack_lines.FLAG_S)}
    else:
        lines[attack_lines.COVER] = "%", named(coverage(outcomes))
        lines[attack_lines.WRONG] = "%", judging.confident(outcomes)
        lines[attack_lines.SUSPECT] = "%", {**suspected, attack_lines.OR_COVERED: judging.suspect_or_covered(outcomes)}
        lines[attack_lines.ANSWERS] = "%", {attack_lines.TRACKS: judging.answered(outcomes)}
        if any(ask.line == attack_lines.LATENESS for ask in row.asked):
            lines[attack_lines.LATENESS] = (
                "%",
                {attack_lines.FLAGGED: judging.flagged_within(outcomes, rows.LATE, attack_lines.FLAG_S)},
            )
        if any(ask.line == attack_lines.ODD for ask in row.asked):
            lines[attack_lines.ODD] = "%", {attack_lines.FLAGGED: judging.odd_within(outcomes, attack_lines.FLAG_S)}
        if any(ask.line == attack_lines.REASON for ask in row.asked):
            lines[attack_lines.REASON] = "%", {attack_lines.EVER: judging.flagged_within(outcomes, MOVES, math.inf)}
    lines.setdefault(attack_lines.SUSPECT, ("%", suspected))
    return lines


def _judged_names(ask: Ask, figures: Figures) -> tuple[str, ...]:
    """Without names: all reported quantities, and always the position."""
    if ask.names or "X0" not in figures:
        return ask.names or tuple(figures)
    return tuple(n for n, v in figures.items() if math.isfinite(v) or n in ("X0", "Z0"))


def goals_of(group: str, row: Row, results: Sequence[tuple[Outcome, Figures]]) -> list[Goal]:
    goals = []
    for line, (unit, figures) in _lines(row, results).items():
        reported = any(math.isfinite(value) for value in figures.values())
        asks = [ask for ask in row.asked if ask.line == line and (reported or not ask.if_reported)]
        name = f"{row.title}: {line}"
        for i, ask in enumerate(asks):
            names = _judged_names(ask, figures)
            if i == 0:
                goals.append(Goal(group, name, unit, figures, ask.wanted, names))
            else:  # another range, for other quantities
                shown = {n: figures[n] for n in names}
                goals.append(Goal(group, f"{name}, {', '.join(names)}", unit, shown, ask.wanted, names))
        if not asks:
            goals.append(Goal(group, name, unit, figures))
    return goals


def tracks_of(row: Row, amount: Amount) -> range:
    return rows.numbers(amount.half, max(1, round(amount.attack * row.tracks_share)))


def _recorded(group: str, amount: Amount) -> list[Goal]:
    """Static obstacles in recorded flights, with the settings for each autopilot: share flagged as moving."""
    by_autopilot: dict[str, list[Outcome]] = {}
    for part in range(1, amount.recorded_seeds + 1):
        for number, scene in enumerate(recorded_scenes(amount.recorded, seed=part)):
            flight = measure(scene, scene.noise, (part, number))
            answers = answers_of(estimate(flight, {**settings_of(flight), **camera_settings(flight)}), flight.time_s)
            nothing = np.full_like(answers.values, np.nan)
            by_autopilot.setdefault(scene.group, []).append(Outcome(answers, nothing, nothing))
    goals = []
    for autopilot, outcomes in by_autopilot.items():
        wanted: Range = (0.0, RECORDED_MOST[autopilot]) if autopilot in RECORDED_MOST else OPEN
        flagged = {attack_lines.EVER: judging.flagged_within(outcomes, MOVES, math.inf)}
        name = f"{autopilot}, {len(outcomes)} static obstacles: {attack_lines.REASON}"
        judged = (attack_lines.EVER,) if autopilot in RECORDED_MOST else ()
        goals.append(Goal(group, name, "%", flagged, wanted, judged))
    if not goals:
        print("left out: no recorded flights")
    return goals


def attack_group(group: str, amount: Amount) -> list[Goal]:
    """The goals of all rows."""
    goals, left_out = [], set()
    for row in rows.ROWS:
        results = each(partial(perform, row), tracks_of(row, amount), amount.workers, row.title)
        goals += goals_of(f"{group}: {row.section}", row, results)
        unknown = {name: value for name, value in row.if_known.items() if name not in known(row.if_known)}
        if unknown:
            left_out |= set(unknown)
            goals.append(Goal(f"{group}: {row.section}", f"{row.title}: settings left out", "1", unknown))
    if left_out:
        print(f"left out: settings that the library does not have: {', '.join(sorted(left_out))}")
    return goals + _recorded(f"{group}: recorded flights", amount)
