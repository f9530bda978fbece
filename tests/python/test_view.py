"""goe_tools view without a browser: it draws the answers of goe_replay at the right place, and every log works."""

from __future__ import annotations

import csv
import dataclasses
import math
import re
import subprocess
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
import view_logs
from goe_tools import library
from goe_tools.logs.obslog import Camera, ObservationLog, read_log
from goe_tools.view import outline, words
from goe_tools.view.answers import Answers, Options
from goe_tools.view.motion import motion_of
from goe_tools.view.story import MOST_ROWS, Story, kept_moments, map_bounds, story_of

COLUMNS = {  # goe_replay's columns that the page has
    **{name: name for name in ("x_m", "z_m", "width_m", "length_m", "height_m", "orientation_deg", "nis_ratio")},
    **{name: name for name in ("x_sd_m", "z_sd_m", "width_sd_m", "length_sd_m", "height_sd_m", "orientation_sd_deg")},
}


@pytest.fixture(autouse=True)
def built() -> None:
    try:
        library.ready()
    except FileNotFoundError as error:
        pytest.skip(str(error))


def story(log: ObservationLog, **options: object) -> Story:
    return story_of("log", log, Options(**options), most_rows=10**9)  # type: ignore[arg-type]


def replayed(replay: Path, folder: Path, *words: str) -> dict[int, list[dict[str, str]]]:
    """goe_replay's own rows, by id."""
    out = folder / "estimates.csv"
    done = subprocess.run([replay, "--residuals", *words, "--out", out, folder], capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    rows: dict[int, list[dict[str, str]]] = {}
    with open(out, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            rows.setdefault(int(row["id"]), []).append(row)
    return rows


# --------------------------------------------------------------------------------------- the answers are goe_replay's

CASES: dict[str, tuple[Callable[[], ObservationLog], tuple[str, ...], dict[str, object]]] = {
    "corner": (lambda: read_log(view_logs.CORNER), (), {}),
    "window": (lambda: read_log(view_logs.CORNER), ("--method", "window", "--window", "5"),
               {"method": "window", "window": 5}),
    "set": (view_logs.several, ("--model", "disc", "--set", "detector.point_noise_px=2", "--set",
                                "filter.nis_ratio_max=0.3"),
            {"model": "disc", "settings": {"detector.point_noise_px": 2.0, "filter.nis_ratio_max": 0.3}}),
    "boxes": (view_logs.boxes, (), {}),
    "several": (view_logs.several, (), {}),
    "spoiled": (view_logs.spoiled, (), {}),
    "moving": (view_logs.moving, (), {}),
    "nothing": (view_logs.nothing_answered, (), {}),
    "one": (view_logs.one_frame, (), {}),
}  # fmt: skip


def assert_same(track_rows: dict[int, list[dict[str, str]]], shown: Story) -> None:
    assert [track.id for track in shown.tracks] == list(track_rows)
    for track in shown.tracks:
        rows, answers = track_rows[track.id], track.answers
        assert len(answers) == len(rows)
        assert answers.status == [row["status"] for row in rows]
        assert answers.model == [row["model"] for row in rows]
        assert [str(int(s)) for s in answers.suspect] == [row["suspect"] for row in rows]
        assert answers.reason == [row["reason"] for row in rows]
        for name, column in COLUMNS.items():
            theirs = np.array([float(row[name] or "nan") for row in rows], np.float32)
            where = f"obstacle {track.id}: {name}"
            np.testing.assert_allclose(answers.column[column], theirs, rtol=3e-7, err_msg=where)


@pytest.mark.parametrize("name", CASES)
def test_answers_are_those_of_goe_replay(name: str, replay: Path, tmp_path: Path) -> None:
    make, words_, options = CASES[name]
    folder = view_logs.written(make(), tmp_path / name)
    assert_same(replayed(replay, folder, *words_), story(read_log(folder), **options))


def test_when_to_act_is_the_decision_rules() -> None:
    """By definition: from a probability of 10 % on, if the aircraft may reach it within 12 s."""
    seen = set()
    for make in (view_logs.boxes, view_logs.several, view_logs.spoiled):
        for track in story(make()).tracks:
            column = track.answers.column
            with np.errstate(invalid="ignore"):
                earliest_tcpa_s = column["tcpa_s"] * np.divide(
                    column["tcpa_s"], column["tcpa_s"] + 2.0 * column["tcpa_sd_s"],
                    out=np.zeros(len(track.answers)), where=column["tcpa_s"] > 0.0,
                )  # fmt: skip
                sure = (np.abs(earliest_tcpa_s - 12.0) > 1e-3) & (np.abs(column["conflict_probability"] - 0.1) > 1e-6)
                acts = (column["conflict_probability"] >= 0.1) & (earliest_tcpa_s <= 12.0)
            assert np.array_equal(track.answers.act[sure], acts[sure])
            seen |= set(track.answers.act[sure].tolist())
    assert seen == {False, True}


def test_every_status_has_words() -> None:
    shown = {str(status) for status in library.package().Status}
    assert shown - set(words.STATUS) == {"ok", "partial", "corrupted"}


def test_two_cameras_with_lenses(replay: Path, tmp_path: Path, real_camera: Camera) -> None:
    folder = view_logs.written(view_logs.two_cameras(real_camera), tmp_path / "two")
    shown = story(read_log(folder))
    assert_same(replayed(replay, folder), shown)
    assert len(np.unique(shown.look_rad[:, 0].round(1))) > 1  # the view wedge changes to the other camera


def test_each_log_contains_its_case() -> None:
    spoiled, moving = story(view_logs.spoiled()), story(view_logs.moving())
    statuses = set(spoiled.tracks[0].answers.status)
    assert {"ok", "not_finite", "bad_time", "bad_attitude", "no_detection"} <= statuses
    assert spoiled.reset.sum() == 2 and spoiled.broken.sum() == 1
    assert "moves" in moving.tracks[0].answers.reason
    assert set(story(view_logs.boxes()).tracks[0].answers.model) == {"none", "prism"}


# ---------------------------------------------------------------------------------------------------------------- map


def to_earth(shown: Story, log: ObservationLog, points: np.ndarray) -> np.ndarray:
    """North and east of points of the map."""
    origin = motion_of(log).camera_ne_m[0]
    up, right = -shown.north_rad, 0.5 * math.pi - shown.north_rad
    axes = np.array([[math.cos(right), math.sin(right)], [math.cos(up), math.sin(up)]])
    return points @ axes + origin


@pytest.mark.parametrize("make", [lambda: read_log(view_logs.CORNER), view_logs.boxes, view_logs.several])
def test_outlines_are_at_the_center_of_goe_replay(
    make: Callable[[], ObservationLog], replay: Path, tmp_path: Path
) -> None:
    log = make()
    shown = story(log)
    rows = replayed(replay, view_logs.written(log, tmp_path / "log"))
    compared = 0
    for track in shown.tracks:
        for k, row in enumerate(rows[track.id]):
            if not row["center_n_m"]:
                continue
            middle = track.circle[k, :2] if math.isfinite(track.circle[k, 0]) else track.corner[k].mean(0)
            center = np.array([float(row["center_n_m"]), float(row["center_e_m"])])
            assert to_earth(shown, log, middle) == pytest.approx(center, abs=0.02), (track.id, row["t_s"])
            compared += 1
    assert compared > 40


def test_truth_is_drawn_where_the_log_has_it() -> None:
    log = read_log(view_logs.CORNER)
    shown = story(log)
    truth, outline_ne = log.truth[1], to_earth(shown, log, shown.tracks[0].truth_outline)
    assert outline_ne.mean(0) == pytest.approx([truth.center_n_m, truth.center_e_m])
    sides = np.linalg.norm(np.roll(outline_ne, -1, 0) - outline_ne, axis=1)
    assert sides == pytest.approx([truth.width_m, truth.length_m] * 2)
    along = outline_ne[2] - outline_ne[1]
    assert math.degrees(math.atan2(along[1], along[0])) % 180.0 == pytest.approx(truth.heading_deg)


@pytest.mark.parametrize("make", [lambda: read_log(view_logs.CORNER), view_logs.several, view_logs.boxes])
def test_good_answers_converge_to_the_true_values(make: Callable[[], ObservationLog]) -> None:
    shown = story(make(), settings=library.LEVEL)
    for track in shown.tracks:
        answers, last = track.answers, len(track.answers) - 1
        from_above = track.id == 7  # its highest point in the image is not the one that goe.h defines
        for name in ("z_m", "x_m", "width_m", *(() if from_above else ("height_m",))):
            stem, unit = name.split("_")
            error = answers.column[name][last] - track.truth[name][last]
            assert abs(error) < 4.0 * answers.column[f"{stem}_sd_{unit}"][last], (track.id, name)


def test_the_miss_is_that_of_goe_hazard() -> None:
    """The distance on the map between the predicted position and the outline, against the library's own."""
    compared = 0
    for make in (view_logs.several, view_logs.boxes, view_logs.moving, lambda: read_log(view_logs.CORNER)):
        for track in story(make()).tracks:
            drawn = np.linalg.norm(track.closest - track.nearest, axis=1)
            said = track.answers.column["dcpa_m"]
            good = np.isfinite(said) & (said > 0.0)
            turned_m = 0.3 * track.answers.column["width_m"] if "prism" in track.answers.model else 0.0 * drawn
            off_m = np.abs(drawn - said)[good]  # of a prism the circle is that across the present line of sight
            assert (off_m <= 0.05 + 2e-3 * said[good] + np.nan_to_num(turned_m)[good]).all()
            compared += good.sum()
    assert compared > 150


def test_a_reported_jump_does_not_show() -> None:
    """Up to the unreported jump, the path of the spoiled log equals that of the good one."""
    good, spoiled = motion_of(view_logs.boxes()), motion_of(view_logs.spoiled())
    times = spoiled.time_s < 5.4
    there = np.isin(good.time_s.round(6), spoiled.time_s[times].round(6))
    np.testing.assert_allclose(spoiled.camera_ne_m[times], good.camera_ne_m[there], atol=1e-6)
    speed = np.linalg.norm(spoiled.velocity_m_s[times][2:], axis=1)
    assert speed == pytest.approx(20.0)


# ------------------------------------------------------------------------------------------------------------- outline


def test_region_of_one_point_is_its_ellipse() -> None:
    spread = np.array([[900.0, 25.0], [25.0, 1.0]])  # 30 m by 0.5 m
    ring = outline.hull(np.zeros((1, 1, 2)), spread[None, None], np.zeros(1))[0]
    assert np.einsum("pi,ij,pj->p", ring, np.linalg.inv(spread), ring) == pytest.approx(4.0)
    area = 0.5 * abs(np.sum(ring[:, 0] * np.roll(ring[:, 1], -1) - ring[:, 1] * np.roll(ring[:, 0], -1)))
    assert area > 0.99 * 4.0 * math.pi * math.sqrt(np.linalg.det(spread))


def test_region_contains_the_outline_by_two_sigma() -> None:
    """For boxes drawn from the covariance: in any direction each corner is inside in at least 97.7 %, and two corners
    together in at least 95.4 %, less a little for the nonlinearity of rotation."""
    random = np.random.default_rng(5)
    root = random.normal(size=(5, 5)) * np.array([1.0, 3.0, 0.02, 0.5, 0.8])[:, None]
    mean = np.array([-20.0, 120.0, 0.4, 12.0, 25.0])
    one = dict(zip(("x_m", "z_m", "orientation_deg", "width_m", "length_m"), mean[:, None]))
    one["orientation_deg"] = np.degrees(one["orientation_deg"])
    ring = outline.outlines(one, ["box"], (root @ root.T)[None]).region[0]
    drawn = outline.corners(*(mean[:, None] + root @ random.normal(size=(5, 20_000))))
    for turn in np.linspace(0.0, 2.0 * math.pi, 16, endpoint=False):
        normal = np.array([math.cos(turn), math.sin(turn)])
        within = (drawn @ normal).max(1) <= (ring @ normal).max() + 1e-9
        assert 0.945 < within.mean() < 0.9999, turn


def test_corner_slopes_are_derivatives() -> None:
    values, step = [np.array([v]) for v in (-3.0, 50.0, -0.7, 6.0, 14.0)], 1e-6
    slopes = outline._corner_slopes(*values[2:])
    for i in range(5):
        moved = [v + (step if i == j else 0.0) for j, v in enumerate(values)]
        numeric = (outline.corners(*moved) - outline.corners(*values)) / step
        assert slopes[..., i] == pytest.approx(numeric, abs=1e-4)


def test_nearest_point() -> None:
    square = np.array([[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]] * 4)
    circle = np.full((4, 3), np.nan)
    points = np.array([[3.0, 1.0], [-1.0, -1.0], [0.5, 1.0], [1.0, 9.0]])
    expected = [[2.0, 1.0], [0.0, 0.0], [0.5, 1.0], [1.0, 2.0]]
    assert outline.nearest_on_outline(points, circle, square).tolist() == expected
    around = np.array([[1.0, 1.0, 2.0]])
    none = np.full((1, 4, 2), np.nan)
    assert outline.nearest_on_outline(np.array([[5.0, 1.0]]), around, none).tolist() == [[3.0, 1.0]]
    assert outline.nearest_on_outline(np.array([[1.5, 1.0]]), around, none).tolist() == [[1.5, 1.0]]


# --------------------------------------------------------------------------------------------------------------- words


def test_words() -> None:
    track = story(read_log(view_logs.CORNER)).tracks[0]
    said = words.place(track.answers, len(track.answers) - 1).replace("\u00a0", " ")
    number = r"[\d.]+ ± [\d.]+ m"
    assert re.fullmatch(f"{number} ahead, {number} left, {number} wide, {number} long, {number} high", said)
    assert words.place(track.answers, 0) == "No estimate yet: collecting images"
    assert "to the side" in words.approach(track.answers, len(track.answers) - 1)
    for clear_m, wanted in ((5.0, "over the obstacle in 3.0 "), (-69.0, "into the obstacle in 3.0 ")):
        column = {name: [value] for name, value in (("tcpa_s", 3.0), ("dcpa_m", 0.0), ("clearance_m", clear_m))}
        column |= {name: [0.5] for name in ("tcpa_sd_s", "dcpa_sd_m", "clearance_sd_m")}
        said = words.approach(cast(Answers, SimpleNamespace(column=column)), 0).replace("\u00a0", " ")
        assert wanted in said and said.endswith("above the top" if clear_m > 0.0 else "below the top")
    moving = story(view_logs.moving()).tracks[0].answers
    told = {words.doubt(moving, k) for k in range(len(moving))}
    assert any(
        text.startswith("Suspect: the obstacle moves at ") and text.endswith("m/s; the estimate follows it")
        for text in told
    )


@pytest.mark.parametrize(
    ("value", "sigma", "figures", "text"),
    [
        (473.2, 12.0, 1, "473 ± 12 m"), (41.26, 1.32, 1, "41 ± 1 m"), (41.26, 0.4, 1, "41.3 ± 0.4 m"),
        (5.1, 0.02, 1, "5.10 ± 0.02 m"), (-3.0, 0.2, 2, "−3.00 ± 0.20 m"), (60.0, 0.0, 1, "60.0 ± 0.0 m"),
        (math.nan, 1.0, 1, "–"), (12.34, math.nan, 1, "12.3 m"),
    ],
)  # fmt: skip
def test_digits_follow_the_sigma(value: float, sigma: float, figures: int, text: str) -> None:
    assert words.measured(value, sigma, "m", figures).replace("\u00a0", " ") == text


# ------------------------------------------------------------------------------------------------------------ long logs


def test_a_long_log_is_thinned() -> None:
    log = view_logs.long()
    shown = story_of("long", log, Options())
    (track,) = shown.tracks
    assert shown.rows == len(log.frames) >= 10_000
    assert 0.9 * MOST_ROWS < len(track.answers) <= MOST_ROWS
    assert shown.time_s[0] == 0.0 and shown.time_s[-1] == pytest.approx(log.frames[-1].t_s)
    assert np.diff(shown.time_s).max() < 3.0 * 100.0 / MOST_ROWS


def test_thinning_keeps_the_changes() -> None:
    log = view_logs.spoiled()
    motion = motion_of(log)
    everything = story(log).tracks[0].answers
    changed = everything.moment[1:][[a != b for a, b in zip(everything.model, everything.model[1:])]]
    assert len(changed) >= 2
    kept = kept_moments(motion, [everything], 40)
    assert len(kept) <= 40 and {0, len(motion.time_s) - 1} <= set(kept)
    assert set(changed) | set(np.flatnonzero(motion.reset)) <= set(kept)


def test_the_obstacle_that_is_shown_first() -> None:
    """The obstacle with the most answers, once it has a width; for one that is visible briefly, its own part of the
    map."""
    shown = story(view_logs.several(), settings=library.LEVEL)
    assert [shown.brief(track) for track in shown.tracks] == [False, False, False] and shown.chosen(None).id == 3
    for track in shown.tracks:
        row = track.row_at[shown.first_look(track)]
        assert math.isfinite(track.answers.column["width_m"][row])
    log = view_logs.several()
    frames = [f for f in log.frames if f.id != 11 or f.t_s > 6.0]
    late = story(dataclasses.replace(log, frames=frames), settings=library.LEVEL)
    chimney = late.chosen(11)
    assert late.brief(chimney)
    left, right, bottom, top = map_bounds(late, chimney)
    assert bottom > 100.0 and (left, right, top) != tuple(map_bounds(late)[i] for i in (0, 1, 3))


def test_an_obstacle_between_the_kept_moments_is_not_lost() -> None:
    log = view_logs.several()
    once = [f for f in log.frames if f.id == 7][1:2]
    frames = sorted([f for f in log.frames if f.id != 7] + once, key=lambda frame: frame.t_s)
    shown = story_of("log", dataclasses.replace(log, frames=frames), Options(), most_rows=20)
    assert [len(track.answers) for track in shown.tracks if track.id == 7] == [1]
