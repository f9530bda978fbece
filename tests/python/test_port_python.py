"""The Python package: errors and their messages, names of C, whole tracks, threads, pages, the example."""

from __future__ import annotations

import copy
import dataclasses
import doctest
import importlib
import pickle
import re
import runpy
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from goe_tools import library
from goe_tools.places import interface

goe = pytest.importorskip("goe", reason="the Python package is not installed (tools/setup.sh)")
flight = goe.flight

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "port" / "python"
NAN = float("nan")
HEADER = interface()


def settings() -> goe.Settings:
    return goe.Settings.for_camera(914.0, 914.0, 640.0, 640.0, width_px=1280.0, height_px=1280.0)


def approach(images: int = 60, **change: object) -> goe.Images:
    """An approach to a plate of 6 m by 30 m, 30 m to the left, with exact boxes."""
    k = np.arange(images)
    box = 640.0 + 914.0 * np.array([-33.0, -15.0, -27.0, 15.0]) / (200.0 - 2.0 * k)[:, None]
    columns = {
        "time_us": 125_000 * k, "position_ned_m": np.column_stack([2.0 * k, 0.0 * k, 0.0 * k]),
        "attitude": np.tile([1.0, 0.0, 0.0, 0.0], (images, 1)), "height_m": np.full(images, 15.0), "box_px": box,
        "velocity_ned_m_s": np.tile([16.0, 0.0, 0.0], (images, 1)),
    }  # fmt: skip
    return goe.Images(**{**columns, **change})


def image(k: int, images: goe.Images) -> goe.Image:
    pose = goe.Pose(int(images.time_us[k]), images.position_ned_m[k], 15.0, images.attitude[k])
    sides = (None if np.isnan(side) else side for side in images.box_px[k])
    return goe.Image(pose, bounding_box=goe.BoundingBox(*sides))


# ------------------------------------------------------------------------------------------------------------- sources


def test_the_installed_package_is_made_of_these_sources() -> None:
    """A failure and not a skip, because tests of an outdated library prove nothing."""
    assert library.package() is goe


@pytest.mark.parametrize("name", ["lib/maths/goe_angle.c", "port/flight/goe_slot.h", "port/python/src/goe/image.py",
                                  "port/cmake/goe_compile.cmake", "port/python/CMakeLists.txt"])  # fmt: skip
def test_another_source_is_another_fingerprint(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    read = Path.read_bytes

    def changed(path: Path) -> bytes:
        return read(path) + b" " * path.resolve().as_posix().endswith(name)

    monkeypatch.setattr(Path, "read_bytes", changed)
    places = (ROOT / "lib", ROOT / "port" / "flight", ROOT / "port" / "cmake")
    assert library._bindings().fingerprint(*places) != goe.FINGERPRINT


def test_a_package_of_other_sources_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.import_module("goe"), "FINGERPRINT", "0" * 64)
    library.package.cache_clear()
    try:
        with pytest.raises(FileNotFoundError, match=r"not built from the sources in .*tools/setup\.sh"):
            library.ready()
    finally:
        library.package.cache_clear()


def test_version_and_arithmetic() -> None:
    numbers = re.findall(r"^#define GOE_VERSION_\w+ (\d+)$", HEADER, re.MULTILINE)
    assert goe.__version__ == ".".join(numbers)
    assert goe.self_check() == 0


# ------------------------------------------------------------------------------------------------------------ settings


def leaves(group: object, prefix: str = "") -> dict[str, object]:
    """Every number of a Settings by its name in C."""
    found: dict[str, object] = {}
    for field in dataclasses.fields(group):
        value, name = getattr(group, field.name), prefix + field.name
        if dataclasses.is_dataclass(value):
            found |= leaves(value, f"{name}.")
        elif name == "camera.offset_m":
            found |= {f"{name}[{i}]": number for i, number in enumerate(value)}
        else:
            found[name] = value
    return found


def test_settings_are_those_of_c() -> None:
    """The same settings exist in both, with the same defaults."""
    rows = {row.name: row for row in goe.setting_rows()}
    mine = leaves(goe.Settings())
    assert mine.pop("more_cameras") == ()
    assert mine.pop("heading_deg") is None and rows["heading_auto"].default == 1.0
    mine["model"] = mine.pop("shape")
    assert set(mine) == set(rows) - {"heading_auto", "heading_deg"} and len(rows) > 50
    assert all(mine[name] == rows[name].default for name in mine)
    layer = goe.FlightSettings()
    assert [f.name for f in dataclasses.fields(layer)] == [row.name for row in goe._table.FLIGHT_ROWS]


@pytest.mark.parametrize("name", [row.name for row in goe.setting_rows() if row.name != "heading_auto"])
def test_every_setting_reaches_c_and_its_range_is_c_s(name: str) -> None:
    """The ends of the range are accepted; beyond them the error names field, value and range."""
    row = next(row for row in goe.setting_rows() if row.name == name)
    lens = {"camera.fx_px": 5e4, "camera.fy_px": 5e4, "camera.cx_px": 0.0, "camera.cy_px": 0.0}
    base = lens | {"camera.width_px": 0.0, "camera.height_px": 0.0, "heading_auto": 0.0}
    for value in (row.low, row.high):
        given = goe.Settings.from_names({**base, row.name: value})
        numbers = dict(zip((r.name for r in goe.setting_rows()), given.numbers()))
        assert numbers[row.name] == np.float32(value)
        goe.Estimator(given)
    for value in (row.low - 1.0 - abs(row.low), row.high * 2.0 + 1.0, NAN):
        with pytest.raises(goe.SettingError, match=re.escape(row.name)) as refused:
            goe.Estimator(goe.Settings.from_names({**base, row.name: value}))
        assert refused.value.field == row.name
        if not row.whole:
            assert f"{row.low:g} to {row.high:g}" in str(refused.value)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda s: setattr(s.camera, "fx_px", 0.0), r"camera\.fx_px = 0: not within 1 to 100000 px; it must be set"),
        (lambda s: setattr(s.window, "points", 8.5), r"window\.points = 8\.5: not a whole number"),
        (lambda s: setattr(s.window, "points", 65), r"window\.points = 65: not within 3 to 64 images"),
        (lambda s: setattr(s.detector, "box_noise_px", "1"), r"detector\.box_noise_px = '1': not a number"),
        (lambda s: setattr(s.detector, "box_noise_px", None), r"detector\.box_noise_px = None: not a number"),
        (lambda s: setattr(s.camera, "offset_m", (1.0, 2.0)), r"camera\.offset_m: 2 numbers, not 3"),
        (lambda s: setattr(s, "heading_deg", 361.0), r"heading_deg = 361: not within -360 to 360 deg"),
        (lambda s: setattr(s, "more_cameras", (goe.Camera(1.0, 0.0),)), r"more_cameras\[0\]\.fy_px = 0"),
        (lambda s: setattr(s, "more_cameras", 8 * (s.camera,)), r"more_cameras: 8, not at most 7"),
    ],
)  # fmt: skip
def test_a_bad_setting_is_named(change: object, words: str) -> None:
    bad = settings()
    change(bad)
    with pytest.raises(goe.SettingError, match=f"^{words}"):
        bad.check()
    with pytest.raises(goe.SettingError, match=f"^{words}"):
        goe.Estimator(bad)
    with pytest.raises(goe.SettingError, match=f"^{words}"):
        goe.Flight(bad)


def test_a_name_that_is_not_there_is_refused_at_once() -> None:
    with pytest.raises(AttributeError, match=r"Detector has no setting point_pix; did you mean point_noise_px\?"):
        settings().detector.point_pix = 1.0
    with pytest.raises(
        goe.SettingError, match=r"detector\.pont_px: no such setting; did you mean detector\.point_noise_px\?"
    ):
        goe.Settings.from_names({"detector.pont_px": 1.0})
    for name in ("more_cameras[7].fx_px", "more_cameras[0].of_nothing", "camera[0].fx_px", "", "more_cameras[0]"):
        with pytest.raises(goe.SettingError, match="no such setting"):
            goe.Settings.from_names({name: 1.0})
    with pytest.raises(goe.SettingError, match=r"heading_auto = 2: not 0 or 1"):
        goe.Settings.from_names({"heading_auto": 2})
    with pytest.raises(goe.SettingError, match=r"method = 3: not one of 1 \(window\), 2 \(filter\)"):
        goe.Settings.from_names({"method": 3})


def test_the_layer_s_settings() -> None:
    with pytest.raises(goe.SettingError, match=r"^bank_deg = 80: not within 5 to 70"):
        goe.Flight(settings(), goe.FlightSettings(bank_deg=80.0))
    with pytest.raises(goe.SettingError, match=r"^camera\.width_px: refused by the flight layer"):
        goe.Flight(goe.Settings(camera=goe.Camera(914.0, 914.0, 640.0, 640.0, width_px=0.0, height_px=0.0)))


def test_the_size_of_the_image_is_part_of_the_call() -> None:
    camera = settings().camera
    assert goe.Settings.for_camera(914.0, 914.0, 640.0, 640.0, 1280.0, 1280.0).camera == camera
    with pytest.raises(TypeError, match=r"missing 2 required .*'width_px' and 'height_px'"):
        goe.Settings.for_camera(914.0, 914.0, 640.0, 640.0)
    for size, name in (((0.0, 1280.0), "width_px"), ((1280.0, NAN), "height_px")):
        with pytest.raises(goe.SettingError, match=rf"^camera\.{name} = .*: give the size of the image, px"):
            goe.Settings.for_camera(914.0, 914.0, 640.0, 640.0, *size)


# ------------------------------------------------------------------------------------------------------------- classes


def test_the_classes_are_those_of_the_companion() -> None:
    """Its page has every number; ``python -m ci packages --check`` compares the table with the C source."""
    page = (ROOT / "port" / "companion" / "README.md").read_text(encoding="utf-8")
    table = page.split("### Classes")[1].split("\n## ")[0]
    rows = re.findall(r"^\| (`[\w`, ]+`) \| (.*) \| (.*) \| (.*) \|$", table, re.MULTILINE)
    shapes = {"unknown": "UNKNOWN", "round": "ROUND", "not round": "OTHER"}

    named = {name: row[1:] for row in rows for name in re.findall(r"\w+", row[0])}
    assert len(named) >= 13 and set(named) == set(goe.KINDS)
    for name, (width, height, shape) in named.items():
        kind = goe.KINDS[name]
        assert kind.shape.name == shapes[shape]
        for size_m, sd_m, said in ((kind.width_m, kind.width_sd_m, width), (kind.height_m, kind.height_sd_m, height)):
            found = [float(number) for number in said.split(" +- ")] if said != "unknown" else [0.0, 0.0]
            assert [size_m or 0.0, sd_m] == pytest.approx(found, abs=0.006), name


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("car", r"kind = 'car': not a goe\.Kind; use goe\.KINDS\['car'\]"),
        ("Car", r"use goe\.KINDS\['car'\]"),
        ("tree", r"kind = 'tree': not a goe\.Kind; use goe\.Kind\(width_m=\.\.\., width_sd_m=\.\.\.\)"),
        (None, r"kind = None: not a goe\.Kind"),
    ],
)
def test_a_kind_that_is_none_is_refused(kind: object, words: str) -> None:
    layer = goe.Flight(settings())
    with pytest.raises(TypeError, match=words):
        goe.Estimator(settings()).update(goe.Image(kind=kind))
    with pytest.raises(TypeError, match=words):
        layer.frame(flight.Frame(0, 0, [flight.Detection(0.9, 1, goe.BoundingBox(1, 2, 3, 4), kind=kind)]))
    if kind:
        with pytest.raises(TypeError, match=words):
            goe.run(settings(), approach(2, kind=kind))


def test_a_class_of_a_whole_track_is_that_of_its_images() -> None:
    images, kind = approach(30), goe.KINDS["pole"]
    one = goe.Estimator(settings())
    single = [one.update(dataclasses.replace(image(k, images), kind=kind)) for k in range(30)]
    assert list(goe.run(settings(), approach(30, kind=kind))) == single != list(goe.run(settings(), images))


@pytest.mark.parametrize("shape", [-1.0, 1.5, 256.0, 257.0, NAN, float("inf")])
def test_a_shape_in_an_array_of_kinds_is_not_cast_to_another(shape: float) -> None:
    kinds = np.tile([3.3, 0.9, 1.6, 0.14, 2.0], (30, 1))
    assert (approach(30, kind=kinds).to_c()["kind"]["shape"] == 2).all()
    kinds[7, 4] = shape
    with pytest.raises(ValueError, match="kind: a shape that is not a whole number within 0 to 255"):
        approach(30, kind=kinds).to_c()


def test_objects_can_be_sent_to_other_processes() -> None:
    given = settings()
    given.more_cameras = (goe.Camera(900.0, 900.0, 640.0, 640.0, width_px=0.0, height_px=0.0),)
    assert pickle.loads(pickle.dumps(given)) == given
    with pytest.raises(goe.SettingError) as refused:
        goe.Estimator(goe.Settings())
    again = pickle.loads(pickle.dumps(refused.value))
    assert (str(again), again.field) == (str(refused.value), "camera.fx_px")
    with pytest.raises(TypeError, match="cannot be pickled"):
        pickle.dumps(goe.Estimator(given))
    track = goe.run(given, approach(3))
    assert np.array_equal(pickle.loads(pickle.dumps(track)).estimates, track.estimates)


# ------------------------------------------------------------------------------------------------------- names of C


@pytest.mark.parametrize(
    ("kind", "prefix", "left_out", "file"),
    [
        (goe.Status, "GOE_", {"BAD_SETTINGS", "BAD_ARGUMENT", "NOT_INITIALIZED"}, "lib/goe.h"),
        (goe.Method, "GOE_METHOD_", set(), "lib/goe_settings.h"),
        (goe.Model, "GOE_MODEL_", {"NONE", "AUTO"}, "lib/goe_settings.h"),
        (goe.Shape, "GOE_MODEL_", {"NONE", "BOX", "PRISM"}, "lib/goe_settings.h"),
        (goe.Reason, "GOE_REASON_", {"NONE"}, "lib/goe.h"),
        (flight.FlightStatus, "GOE_FLIGHT_", {"BAD_SETTINGS", "BAD_ARGUMENT", "NOT_INITIALIZED"},
         "port/flight/goe_flight.h"),
        (goe.Decision, "GOE_DECISION_", set(), "lib/goe_hazard.h"),
        (flight.Action, "GOE_FLIGHT_", set(), "port/flight/goe_flight.h"),
    ],
)  # fmt: skip
def test_enumerations_are_those_of_c(kind: type, prefix: str, left_out: set[str], file: str) -> None:
    name = {"Shape": "goe_model_t", "FlightStatus": "goe_flight_status_t", "Action": "goe_flight_action_t"}
    c_name = name.get(kind.__name__, f"goe_{kind.__name__.lower()}_t")
    text = re.sub(r"/\*.*?\*/", "", (ROOT / file).read_text(encoding="utf-8"), flags=re.DOTALL)
    (body,) = re.findall(rf"typedef enum \{{([^}}]*)\}} {c_name};", text)
    numbers, following = {}, 0
    for word in filter(None, (part.strip() for part in body.split(","))):
        own, _, number = word.partition("=")
        following = int(number) if number else following
        numbers[own.strip().removeprefix(prefix)] = following
        following += 1
    assert {member.name: int(member) for member in kind} == {n: v for n, v in numbers.items() if n not in left_out}
    names = {str(member) for member in kind}
    assert len(names) == len(kind) and ("unknown" not in names or kind is goe.Decision)


def test_arrays_have_the_fields_of_c() -> None:
    (body,) = re.findall(r"typedef struct \{([^{}]*)\} goe_estimate_t;", HEADER)
    words = re.findall(r"^\s+(?:\w+) ([^;]*);", re.sub(r"/\*.*?\*/", "", body, flags=re.DOTALL), re.MULTILINE)
    names = [re.sub(r"\[\d+\]", "", name).strip() for word in words for name in word.split(",")]
    assert list(goe.ESTIMATE.names) == names and len(names) > 30


# -------------------------------------------------------------------------------------------------------------- tracks


def test_a_track_in_pieces_is_the_same_track() -> None:
    images = approach()
    whole = goe.run(settings(), images, covariance=True)
    estimator, c = goe.Estimator(settings()), images.to_c()
    pieces = [estimator.run(part, covariance=True) for part in (c[:7], c[7:8], c[8:8], c[8:])]
    assert np.array_equal(np.concatenate([piece.estimates for piece in pieces]), whole.estimates)
    assert np.array_equal(np.concatenate([piece.covariance for piece in pieces]), whole.covariance)
    one = goe.Estimator(settings())
    assert [one.update(image(k, images)) for k in range(len(images))] == list(whole)
    assert np.array_equal(one.covariance(), whole.covariance[-1])
    assert goe.run(settings(), images).covariance is None


def test_quantities_and_their_sigmas() -> None:
    track = goe.run(settings(), approach(), covariance=True)
    last = track[-1]
    assert goe.QUANTITIES == ("x0_m", "z0_m", "orientation_deg", "width_m", "length_m", "height_m")
    assert (track.values[-1, 0], track.sigma[-1, 1]) == (last.position.x0.m, last.position.z0.sd_m)
    assert (track.values[-1, 3], track.sigma[-1, 5]) == (last.width.m, last.height.sd_m)
    assert last.orientation is None and np.isnan(track.values[-1, 2]) and not track.valid[-1, 2]
    assert np.allclose(np.sqrt(np.diag(track.covariance[-1]))[[0, 1, 3, 5]], track.sigma[-1][[0, 1, 3, 5]], rtol=1e-3)
    assert np.isnan(track.values[0]).all() and track[0].position is None
    assert last.position.x0.m == pytest.approx(-30.0, abs=4 * last.position.x0.sd_m)
    with pytest.raises(IndexError):
        track[len(track)]


def test_rules_are_plans_that_grow_with_doubt_and_age() -> None:
    """Against an intended velocity with the same margins. At the end no detection comes, and the estimate becomes
    old."""
    images = approach()
    images.box_px[-20:] = NAN
    rules = [
        goe.Rule(15.0, 10.0, suspect_factor=2.0, stale_growth_m_s=3.0, since_image_s=0.2),
        goe.Rule(5.0, 4.0, 1.0, 0.0),
    ]
    track = goe.run(settings(), images, rules=rules)
    estimator = goe.Estimator(settings())
    ages = set()
    for k in range(len(images)):
        estimate = estimator.update(image(k, images))
        for number, rule in enumerate(rules):
            doubt = rule.suspect_factor if estimate.suspect else 1.0
            old_s = np.float32(estimate.age_s) + np.float32(rule.since_image_s)
            margin, clearance = (
                float(np.float32(doubt * m) + np.float32(rule.stale_growth_m_s) * old_s)
                for m in (rule.margin_m, rule.clearance_m)
            )
            plan = goe.Intent((16.0, 0.0, 0.0), margin, clearance, rule.since_image_s)
            assert track.hazard(k, number) == estimator.hazard(plan)
        ages.add(estimate.age_s > 0.0)
    assert ages == {False, True}
    with pytest.raises(ValueError, match="velocity_ned_m_s: not given"):
        goe.run(settings(), approach(velocity_ned_m_s=None), rules=rules)


def collision() -> goe.Images:
    """Head-on towards a plate of 6 m by 30 m."""
    k = np.arange(60)
    box = 640.0 + 914.0 * np.array([-3.0, -15.0, 3.0, 15.0]) / (200.0 - 2.0 * k)[:, None]
    return approach(box_px=box)


def expected_decision(rule: goe.Rule, hazard: goe.Hazard, estimate: goe.Estimate) -> goe.Decision:
    """By the definition of goe_decide, from the hazard with the widened margins."""
    old_m = rule.stale_growth_m_s * estimate.age_s
    doubt = rule.suspect_factor if estimate.suspect else 1.0
    if hazard.conflict_probability >= rule.conflict_probability_max:
        if hazard.earliest_tcpa_s <= rule.act_within_s:
            return goe.Decision.ACT
        later = hazard.tcpa_s - 2.0 * hazard.tcpa_sd_s > rule.act_within_s
        return goe.Decision.CLEAR if later else goe.Decision.UNKNOWN
    aside = hazard.dcpa.m - hazard.dcpa.sd_m >= doubt * rule.margin_m + old_m
    over = hazard.clearance
    above = over is not None and over.m - over.sd_m >= doubt * rule.clearance_m + old_m
    return goe.Decision.CLEAR if aside or above else goe.Decision.UNKNOWN


def test_decisions_are_those_of_the_rule() -> None:
    """Probability, distances and times of the hazard with the widened margins."""
    images = collision()
    images.box_px[30:40] = NAN
    other = goe.Rule(
        15.0, 10.0, conflict_probability_max=0.9, act_within_s=6.0, suspect_factor=3.0, stale_growth_m_s=0.5
    )
    rules = [goe.Rule(15.0, 10.0), other]
    configured = settings()
    configured.navigation.terrain_height_sd_m = configured.navigation.terrain_slope_sd = 0.0  # it is level
    track = goe.run(configured, images, rules=rules)
    estimator = goe.Estimator(configured)
    for k in range(len(images)):
        estimate = estimator.update(image(k, images))
        for number, rule in enumerate(rules):
            own = goe.DecisionRule(
                rule.conflict_probability_max, rule.act_within_s, rule.suspect_factor, rule.stale_growth_m_s
            )
            decision, hazard = estimator.decide(goe.Intent((16.0, 0.0, 0.0), rule.margin_m, rule.clearance_m), own)
            assert (decision, hazard) == (track.decision[k, number], track.hazard(k, number))
            if hazard is None:
                assert decision == goe.Decision.UNKNOWN and track.hazard_status[k, number] == goe.Status.CONVERGING
                continue
            earliest_tcpa_s = hazard.tcpa_s**2 / (hazard.tcpa_s + 2.0 * hazard.tcpa_sd_s)
            assert hazard.earliest_tcpa_s == pytest.approx(earliest_tcpa_s, rel=1e-6)
            assert decision == expected_decision(rule, hazard, estimate)
    assert set(track.decision.flat) == {goe.Decision.UNKNOWN, goe.Decision.CLEAR, goe.Decision.ACT}
    assert str(goe.Decision.ACT) == "act"
    last = estimator.decide(goe.Intent((16.0, 0.0, 0.0), 15.0, 10.0))
    assert last == (track.decision[-1, 0], track.hazard(-1, 0))  # the defaults are those of C
    defaults = goe.DecisionRule()
    probability, act_within_s, factor = (
        defaults.conflict_probability_max,
        defaults.act_within_s,
        defaults.suspect_factor,
    )
    assert (probability, act_within_s, factor, defaults.stale_growth_m_s) == (0.1, 12.0, 1.5, 1.0)
    assert goe.Rule(1.0, 1.0)[2:4] == (1.5, 1.0) and goe.Rule(1.0, 1.0)[5:7] == (0.1, 12.0)


def test_a_velocity_that_is_no_number_keeps_the_decision() -> None:
    images = collision()
    images.velocity_ned_m_s[50:, 1] = NAN
    track = goe.run(settings(), images, rules=[goe.Rule(15.0, 10.0)])
    assert set(track.decision[50:, 0]) == {goe.Decision.KEEP}
    assert set(track.hazard_status[50:, 0]) == {goe.Status.NOT_FINITE} and track.hazard(55) is None
    assert track.decision[49, 0] == goe.Decision.ACT


def test_an_uncertain_velocity_makes_the_hazard_uncertain() -> None:
    estimator = goe.Estimator(settings())
    estimator.run(approach())
    sure, unsure = (estimator.hazard(goe.Intent((16.0, 0.0, 0.0), 15.0, 10.0, 0.0, sd)) for sd in (0.0, 3.0))
    assert unsure.dcpa.sd_m > 2.0 * sure.dcpa.sd_m
    track = goe.run(settings(), approach(), rules=[goe.Rule(15.0, 10.0, velocity_sd_m_s=3.0)])
    assert track.hazard(-1).dcpa.sd_m == unsure.dcpa.sd_m


def test_a_box_without_sides_and_one_without_a_height() -> None:
    images = approach()
    images.box_px[10, 1:] = NAN
    images.height_m[0] = 0.0
    estimator = goe.Estimator(settings())
    track = estimator.run(images)
    assert estimator.fault_counts[-int(goe.Status.BOX_INCOMPLETE)] == 1
    assert estimator.fault_counts[-int(goe.Status.NO_HEIGHT)] == 1 and len(estimator.fault_counts) == 16
    alone = goe.run(settings(), approach(1, box_px=np.array([[500.0, NAN, NAN, NAN]])))
    assert goe.Status(alone.status[0]) == goe.Status.BOX_INCOMPLETE and track.status[-1] == goe.Status.OK


def test_which_images_are_taken() -> None:
    refused = {goe.Status.NOT_FINITE, goe.Status.OUT_OF_RANGE, goe.Status.BAD_TIME, goe.Status.BAD_ATTITUDE,
               goe.Status.CORRUPTED}  # fmt: skip
    assert {status for status in goe.Status if not status.is_image_taken} == refused


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"attitude": np.zeros((60, 3))}, r"attitude: shape \(60, 3\), not \(60, 4\)"),
        ({"box_px": np.zeros((59, 4))}, r"box_px: shape \(59, 4\), not \(60, 4\)"),
        ({"points_px": np.zeros((60, 12))}, r"points_px: shape \(60, 12\), not \(60, 6, 2\)"),
        ({"time_us": np.arange(60) * 1.5}, "time_us: float64, not whole numbers"),
        ({"reset_count": np.arange(60) + 200}, "reset_count: not within 0 to 255"),
        ({"camera": np.full(60, -1)}, "camera: not within 0 to 255"),
        ({"height_m": "high"}, r"height_m: shape \(\), not \(60,\)"),
    ],
)
def test_a_column_of_another_shape_is_named(change: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        goe.run(settings(), approach(**change))


def test_bad_measurements_are_a_status() -> None:
    """Each is refused for its image, and the last good estimate remains."""
    images = approach()
    images.position_ned_m[20, 1] = NAN
    images.height_m[21] = 1e39  # too large for a float
    images.attitude[22] = 2.0
    images.time_us[23] = 0
    images.box_px[24] = NAN
    track = goe.run(settings(), images)
    reported = [goe.Status(number) for number in track.status[19:26]]
    assert reported == [goe.Status.OK, goe.Status.NOT_FINITE, goe.Status.NOT_FINITE, goe.Status.BAD_ATTITUDE,
                    goe.Status.BAD_TIME, goe.Status.NO_DETECTION, goe.Status.OK]  # fmt: skip
    assert track[22].position is not None and not track[22].fresh and track[22].age_s > 0.0
    assert goe.Status.BAD_TIME.is_fault and not goe.Status.BAD_TIME.is_image_taken
    points = np.full((60, 6, 2), NAN)
    seen = goe.run(settings(), approach(points_px=points, points_visible=np.ones((60, 6), bool), box_px=None))
    assert set(seen.status) == {goe.Status.NOT_FINITE}
    assert set(goe.run(settings(), approach(points_px=points, box_px=None)).status) == {goe.Status.NO_DETECTION}


def test_vectors_and_plans_that_c_would_misread() -> None:
    estimator = goe.Estimator(settings())
    with pytest.raises(ValueError, match="attitude: 3 numbers, not 4"):
        estimator.update(goe.Image(goe.Pose(attitude=(1.0, 0.0, 0.0))))
    with pytest.raises(ValueError, match="position_ned_m: 2 numbers, not 3"):
        estimator.update(goe.Image(goe.Pose(position_ned_m=(1.0, 0.0))))
    for plan, words in (((1e4, 0.0, 0.0), 1.0, 1.0), "velocity_ned_m_s"), (((0.0, 0.0, 0.0), -1.0, 1.0), "margin_m"), (
        ((0.0, 0.0, 0.0), 1.0, NAN), "clearance_m"
    ), (((0.0, 0.0, 0.0), 1.0, 1.0, 1e4), "since_image_s"), (
        ((0.0, 0.0, 0.0), 1.0, 1.0, 0.0, 101.0), "velocity_sd_m_s"
    ):  # fmt: skip
        for ask in (estimator.hazard, estimator.decide):
            with pytest.raises(ValueError, match=f"^{words} = .*: not within"):
                ask(goe.Intent(*plan))
    for change in (
        {"conflict_probability_max": 1.1}, {"act_within_s": NAN}, {"suspect_factor": 0.5}, {"stale_growth_m_s": 101.0}
    ):  # fmt: skip
        words = rf"^{next(iter(change))} = .*: not within"
        with pytest.raises(ValueError, match=words):
            estimator.decide(goe.Intent((1.0, 0.0, 0.0), 1.0, 1.0), goe.DecisionRule(**change))
        with pytest.raises(ValueError, match=words):
            goe.run(settings(), approach(), rules=[goe.Rule(1.0, 1.0, **change)])
    assert estimator.decide(goe.Intent((1.0, 0.0, 0.0), 1.0, 1.0)) == (goe.Decision.UNKNOWN, None)
    assert estimator.hazard(goe.Intent((1.0, 0.0, 0.0), 1.0, 1.0)) is None  # no estimate is known
    assert estimator.covariance() is None


def test_reset_and_copy() -> None:
    images = approach()
    estimator = goe.Estimator(settings())
    first = [estimator.update(image(k, images)) for k in range(30)]
    branch = copy.deepcopy(estimator)
    assert branch.update(image(30, images)) == estimator.update(image(30, images))
    branch.reset()
    assert [branch.update(image(k, images)) for k in range(30)] == first
    assert estimator.covariance() is not None


# ------------------------------------------------------------------------------------------------------------- threads


def test_calls_release_python_s_lock() -> None:
    """Python runs while C runs. If C kept the lock, this thread would stop until the call is over."""
    c = approach(98).to_c()
    c = np.tile(c, 200)
    c["pose"]["time_us"] = 125_000 * np.arange(len(c))
    estimator, reported = goe.Estimator(settings()), []

    def work() -> None:
        reported.append("begun")
        estimator.run(c)
        reported.append("ended")

    thread = threading.Thread(target=work)
    interval_s = sys.getswitchinterval()
    sys.setswitchinterval(1e3)  # no thread takes the lock from another one: it has to be released
    try:
        thread.start()
        seen = list(reported)
    finally:
        sys.setswitchinterval(interval_s)
    thread.join()
    assert (seen, reported) == (["begun"], ["begun", "ended"])


def test_threads_do_not_mix_tracks_up() -> None:
    tracks = [approach(40, height_m=np.full(40, 10.0 + i)) for i in range(24)]
    each = [settings() for _ in tracks]
    for i, own in enumerate(each):
        own.detector.box_noise_px = 1.0 + 0.1 * i
    rules = [goe.Rule(15.0, 10.0)]
    alone = [goe.run(own, images, rules=rules) for own, images in zip(each, tracks)]
    for threads in (1, 4, None):
        together = goe.run_parallel(each, tracks, rules=rules, threads=threads)
        assert all(np.array_equal(a.estimates, b.estimates) for a, b in zip(alone, together))
        assert all(np.array_equal(a.hazards, b.hazards) for a, b in zip(alone, together))
    assert not np.array_equal(alone[0].estimates, alone[1].estimates)


def test_one_estimator_given_to_threads_serves_them_in_turn() -> None:
    """Every bad image is counted, so no call interrupts another."""
    estimator = goe.Estimator(settings())
    bad = np.tile(approach(50, attitude=np.zeros((50, 4))).to_c(), 10)
    threads = [threading.Thread(target=lambda: [estimator.run(bad) for _ in range(10)]) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert estimator.fault_counts[-int(goe.Status.BAD_ATTITUDE)] == 6 * 10 * 500


def test_parallel_errors_are_those_of_the_track() -> None:
    with pytest.raises(ValueError, match="2 settings for 3 tracks"):
        goe.run_parallel([settings(), settings()], [approach(3)] * 3)
    with pytest.raises(ValueError, match="threads = 0"):
        goe.run_parallel(settings(), [approach(3)] * 3, threads=0)
    with pytest.raises(goe.SettingError, match=r"camera\.fx_px"):
        goe.run_parallel([settings(), goe.Settings()], [approach(3)] * 2)
    assert goe.run_parallel(settings(), []) == []


# -------------------------------------------------------------------------------------------------------- flight layer


def test_the_flight_layer_from_samples_to_an_order() -> None:
    """A mast dead ahead. Images arrive 100 ms late, and the 32-bit clock wraps on the way."""
    layer = goe.Flight(settings(), goe.FlightSettings(margin_m=15.0))
    start = 2**32 - 3_000_000
    assert layer.assess(start) is None and layer.sectors(20000) is None and layer.obstacles() == {}
    assert layer.frame(flight.Frame(start, start)) == flight.FlightStatus.NO_POSE
    orders, first = [], None
    assert layer.change_settings(goe.FlightSettings(margin_m=15.0, hold_s=1.5)) == flight.FlightStatus.OK
    for k in range(90):
        t = start + 125_000 * k
        north = 2.0 * k
        assert layer.attitude(flight.Attitude(t, (1.0, 0.0, 0.0, 0.0))) == 0
        position = flight.PositionSample(t, (north, 0.0, -15.0), (16.0, 0.0, 0.0), terrain_m=15.0)
        assert layer.position(position) == flight.FlightStatus.OK
        box = (640.0 + 914.0 * m / (200.0 - north + 1.6) for m in (-3.0, -15.0, 3.0, 15.0))
        frame = flight.Frame(t, t - 100_000, [flight.Detection(0.9, 7, goe.BoundingBox(*box))])
        assert layer.frame(frame) == (flight.FlightStatus.OK if k else flight.FlightStatus.NO_POSE) or k < 2
        reported = layer.assess(t)
        orders.append(reported.action)
        if first is None and reported.action:
            first = reported
    ((slot, mast),) = layer.obstacles().items()
    assert mast.id == 7 and layer.obstacle(slot) == mast and layer.obstacle(slot + 1) is None
    assert mast.place.center_ned_m[0] == pytest.approx(200.0, abs=10.0) and mast.hazard is not None
    assert orders[0] == flight.Action.NONE and orders[-1] != flight.Action.NONE
    assert (
        reported.worst == slot and reported.pose_alive and reported.detector_alive and reported.target_ned_m is not None
    )
    assert first.reason == flight.OrderReason.CLEAR and first.clear_m > 0.0 and str(first.reason)
    assert reported.reason == flight.OrderReason.LEAST_BAD and reported.clear_m < 0.0  # the aircraft did not turn
    landed = layer.assess(t, flight.Phase.LANDED)
    assert (landed.action, landed.reason) == (flight.Action.NONE, flight.OrderReason.LANDING)
    sectors = layer.sectors(20000)
    assert sectors.shape == (72,) and sectors[0] < 2500 and sectors[36] == flight.SECTOR_UNKNOWN
    pose, sd_deg = layer.pose(t - 50_000)
    assert pose.position_ned_m[0] == pytest.approx(north - 0.8, abs=1e-3) and sd_deg >= 0.0
    assert layer.counters.taken >= 85 and layer.capture_us == (t - 100_000) % 2**32
    assert layer.position(position) == flight.FlightStatus.BAD_TIME
    layer.timesync(0, 100)
    layer.timesync(0, None)
    layer.restart()
    assert layer.obstacles() == {} and layer.counters.lost == 1


def test_a_detection_s_kind_reaches_the_estimator() -> None:
    without_ground = settings()
    without_ground.navigation.terrain_height_sd_m = 1000.0

    def refused_and_first(kind: goe.Kind) -> tuple[int, int]:
        """How many kinds are refused, and the first frame after which there is a position."""
        layer, first = goe.Flight(without_ground), -1
        for k in range(90):
            t, north = 50_000 * k, 0.8 * k
            layer.attitude(flight.Attitude(t, (1.0, 0.0, 0.0, 0.0)))
            layer.position(flight.PositionSample(t, (north, 0.0, -15.0), (16.0, 0.0, 0.0), terrain_m=15.0))
            box = goe.BoundingBox(*(640.0 + 914.0 * m / (200.0 - north) for m in (-3.0, -15.0, 3.0, 15.0)))
            layer.frame(flight.Frame(t, t, [flight.Detection(0.9, 7, box, kind=kind)]))
            placed = any(found.place is not None for found in layer.obstacles().values())
            first = k if first < 0 and placed else first
        assert first >= 0
        return layer.counters.refused, first

    without = refused_and_first(goe.Kind())
    with_size = refused_and_first(goe.Kind(height_m=30.0, height_sd_m=0.5))
    bad = refused_and_first(goe.Kind(height_m=30.0, height_sd_m=NAN))
    assert without[0] == with_size[0] == 0 and with_size[1] < 0.5 * without[1]
    assert bad == (90, without[1])


def test_the_flight_layer_refuses() -> None:
    layer = goe.Flight(settings())
    with pytest.raises(goe.SettingError, match="bank_deg"):
        layer.change_settings(goe.FlightSettings(bank_deg=89.0))
    with pytest.raises(ValueError, match="q: 3 numbers, not 4"):
        layer.attitude(flight.Attitude(0, (1.0, 0.0, 0.0)))
    with pytest.raises(ValueError, match="max_cm = 0"):
        layer.sectors(0)
    assert layer.attitude(flight.Attitude(0, (1.0, NAN, 0.0, 0.0))) == flight.FlightStatus.NOT_FINITE
    too_many = flight.Frame(0, 0, (flight.DETECTIONS + 1) * [flight.Detection(1.0)])
    assert layer.frame(too_many) == flight.FlightStatus.OUT_OF_RANGE


# ------------------------------------------------------------------------------------------------- what pages promise


def test_the_package_s_own_words() -> None:
    assert doctest.testmod(goe).attempted >= 4 and doctest.testmod(goe).failed == 0
    assert doctest.testmod(goe.settings).failed == 0


def test_the_readme_s_examples_run(capsys: pytest.CaptureFixture[str]) -> None:
    page = (PACKAGE / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, "README.md", "exec"), names)
    printed = capsys.readouterr().out.split()
    assert len(blocks) >= 4 and f"`{' '.join(printed[:5])}`" in page
    assert names["assessment"].action != flight.Action.NONE and abs(names["north_m"] - 200.0) < 5.0


def test_the_example_goes_around(capsys: pytest.CaptureFixture[str]) -> None:
    path = PACKAGE / "examples" / "approach.py"
    cells = re.findall(r"^# %%.*$", path.read_text(encoding="utf-8"), re.MULTILINE)
    assert len(cells) >= 8  # an editor shows a notebook
    reported = runpy.run_path(str(path))
    text = capsys.readouterr().out
    assert re.search(r"go around at [\d.]+ s: [\d.]+ s to go", text) and reported["share"] > 0.9
    errors = [abs(reported["track"][k].position.z.m - reported["true_m"][k]) for k in (60, 80, 99)]
    sigmas = [reported["track"][k].position.z.sd_m for k in (60, 80, 99)]
    assert all(error < 3.0 * sd for error, sd in zip(errors, sigmas)) and sigmas[0] > sigmas[-1]
    assert reported["true_m"][reported["order"]] > 100.0  # in time
