"""The Python package over the embedded logs, against the hashes of C on every target: image by image through the typed
classes, as whole tracks, and in threads."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from embedded_logs import Hash, LoggedImage, LoggedTrack, golden, read_tracks

goe = pytest.importorskip("goe", reason="the Python package is not installed (tools/setup.sh)")
NONE = goe.Length(0.0, 0.0)
PLAN = goe.Intent((15.0, 1.0, -0.5), 10.0, 5.0)
LATE = 2  # images
IMAGE_PX = 1280.0
MAX_CM = 20000


@pytest.fixture(scope="module")
def tracks() -> list[LoggedTrack]:
    return read_tracks()


def settings_of(track: LoggedTrack, method: goe.Method) -> goe.Settings:
    n = track.numbers
    camera = goe.Camera(*n[:12], offset_m=n[12:15], width_px=n[16], height_px=n[17])
    settings = goe.Settings(camera, method=method, shape=goe.Shape(track.model))
    settings.heading_deg = None if track.heading_auto else n[15]
    settings.window.points, settings.window.line_points = track.window, track.line_points
    settings.window.orientation_memory = track.orientation_memory
    settings.navigation.position_white_sd_m = track.position_white_sd_m
    return settings


def points_of(image: LoggedImage) -> dict[str, goe.Pixel | None]:
    n = image.numbers[11:]
    return {
        name: goe.Pixel(*n[2 * i : 2 * i + 2]) if image.seen >> i & 1 else None for i, name in enumerate(goe.POINTS)
    }


def box_of(image: LoggedImage) -> goe.BoundingBox | None:
    sides = (number if image.box >> i & 1 else None for i, number in enumerate(image.numbers[11:15]))
    return goe.BoundingBox(*sides) if image.box else None


def image_of(image: LoggedImage) -> goe.Image:
    n = image.numbers
    delta = n[8:11] if image.reset_delta_known else None
    pose = goe.Pose(image.time_us, n[:3], n[3], n[4:8], image.reset_count, delta)
    return goe.Image(pose, bounding_box=box_of(image), **points_of(image))


def images_of(track: LoggedTrack) -> goe.Images:
    n = np.array([image.numbers for image in track.images])
    bits = np.array([[image.seen, image.box] for image in track.images])
    visible = (bits[:, :1] >> np.arange(6) & 1).astype(bool)
    box = np.where(bits[:, 1:] >> np.arange(4) & 1, n[:, 11:15], np.nan)
    known = np.array([[image.reset_delta_known] for image in track.images])
    return goe.Images(
        [image.time_us for image in track.images], n[:, :3], n[:, 4:8], n[:, 3], box,
        n[:, 11:].reshape(-1, 6, 2), visible, [image.reset_count for image in track.images],
        np.where(known, n[:, 8:11], np.nan), velocity_ned_m_s=np.tile(PLAN.velocity_ned_m_s, (len(n), 1)),
    )  # fmt: skip


# ------------------------------------------------------------------------------------------------------------ estimates


def hash_estimate(h: Hash, e: goe.Estimate) -> None:
    """An unknown value is 0 in C."""
    p = e.position or goe.Position(NONE, NONE, NONE, NONE, 0.0, 0.0)
    o = e.orientation or goe.Orientation(0.0, 0.0, 0.0, 0.0, (0, 0), (0, 0), (0, 0), (0, 0))
    c = e.center or goe.Center(NONE, NONE, 0.0)
    v = e.velocity or goe.Velocity(0.0, 0.0, 0.0, 0.0)
    width, length, height = (size or NONE for size in (e.width, e.length, e.height))
    h.word(e.method or 0, e.model or 0)
    known = (e.position, e.length, e.height, e.orientation, e.center, e.width, e.velocity)
    h.flags(*(quantity is not None for quantity in known))
    h.word(e.fresh, e.suspect)
    h.text("none" if e.reason is None else str(e.reason))
    h.word(e.nis_rows, e.images_used)
    h.numbers(e.age_s, v.north_m_s, v.east_m_s, e.latency_s, p.x0.m, p.z0.m, p.x.m, p.z.m)
    h.numbers(width.m, length.m, height.m, o.side_deg, o.side_raw_deg, o.front_deg)
    h.numbers(*o.length_axis, *o.width_axis, *o.length_axis_ne, *o.width_axis_ne)
    h.numbers(
        e.trajectory_heading_deg, c.north.m, c.east.m, c.covariance_m2, p.residual, p.baseline_m, e.nis, e.nis_ratio
    )
    h.numbers(p.x0.sd_m, p.z0.sd_m, p.x.sd_m, p.z.sd_m, width.sd_m, length.sd_m, height.sd_m, o.side_sd_deg)
    h.numbers(c.north.sd_m, c.east.sd_m, v.north_sd_m_s, v.east_sd_m_s, e.latency_sd_s)


def hash_status(h: Hash, status: goe.Status) -> None:
    h.word(status)
    h.text(str(status))


def hash_after(h: Hash, covariance: np.ndarray | None, hazard: goe.Hazard | None) -> None:
    hash_status(h, goe.Status.OK if covariance is not None else goe.Status.CONVERGING)
    h.numbers(*(np.zeros(36) if covariance is None else covariance.ravel()))
    hash_status(h, goe.Status.OK if hazard is not None else goe.Status.CONVERGING)
    shown = hazard or goe.Hazard(0.0, 0.0, NONE, None, 0.0)
    clearance = shown.clearance or NONE
    h.numbers(
        shown.tcpa_s,
        shown.dcpa.m,
        clearance.m,
        shown.conflict_probability,
        shown.tcpa_sd_s,
        shown.dcpa.sd_m,
        clearance.sd_m,
    )
    h.word(shown.clearance is not None)


def runs_of(tracks: list[LoggedTrack]) -> Iterator[tuple[LoggedTrack, goe.Settings]]:
    for track in tracks:
        for method in goe.Method:
            yield track, settings_of(track, method)


def test_estimates_have_the_bits_of_c(tracks: list[LoggedTrack]) -> None:
    """[A13]"""
    h, images = Hash(), 0
    for track, settings in runs_of(tracks):
        try:
            estimator = goe.Estimator(settings)
        except goe.SettingError as refused:
            h.word(-32)
            h.text("bad_settings" + refused.field)
            continue
        hash_status(h, goe.Status.OK)
        for image in track.images:
            estimate = estimator.update(image_of(image))
            hash_status(h, estimate.status)
            hash_estimate(h, estimate)
            hash_after(h, estimator.covariance(), estimator.hazard(PLAN))
            images += 1
        h.word(*estimator.fault_counts)
        estimator.reset()
        hash_status(h, goe.Status.OK)
    assert images > 1000
    assert str(h) == golden("golden_hash.txt")


@pytest.mark.parametrize("threads", [1, 3])
def test_whole_tracks_have_the_bits_of_c(tracks: list[LoggedTrack], threads: int) -> None:
    """[A11] In one call for all logs, and in more threads than there are processors."""
    runs = list(runs_of(tracks))
    rules = [goe.Rule(PLAN.margin_m, PLAN.clearance_m, suspect_factor=1.0, stale_growth_m_s=0.0)]
    jobs = {"rules": rules, "covariance": True, "threads": threads}
    answers = goe.run_parallel([settings for _, settings in runs], [images_of(track) for track, _ in runs], **jobs)
    h = Hash()
    for (track, settings), answer in zip(runs, answers):
        hash_status(h, goe.Status.OK)
        estimator = goe.Estimator(settings)
        for k, estimate in enumerate(answer):
            hash_status(h, estimate.status)
            hash_estimate(h, estimate)
            hash_after(h, answer.covariance[k] if estimate.position else None, answer.hazard(k))
        estimator.run(images_of(track))
        h.word(*estimator.fault_counts)
        hash_status(h, goe.Status.OK)
    assert str(h) == golden("golden_hash.txt")


# -------------------------------------------------------------------------------------------------------- flight layer


def hash_hazard(h: Hash, hazard: goe.Hazard | None) -> None:
    shown = hazard or goe.Hazard(0.0, 0.0, NONE, None, 0.0)
    clearance = shown.clearance or NONE
    h.numbers(
        shown.tcpa_s,
        shown.dcpa.m,
        clearance.m,
        shown.tcpa_sd_s,
        shown.dcpa.sd_m,
        clearance.sd_m,
        shown.conflict_probability,
    )
    h.word(shown.clearance is not None)


def hash_assessment(h: Hash, a: goe.flight.Assessment | None) -> None:
    if a is None:
        h.word(0, 0, -1, -1, *7 * [0])
        hash_hazard(h, None)
        return
    h.word(a.action)
    h.flags(a.late, a.suspect, a.detector_alive, a.pose_alive)
    h.word(*(-1 if slot is None else slot for slot in (a.worst, a.avoided)), a.obstacles)
    h.numbers(a.needed_s, *(a.target_ned_m or (0, 0, 0)))
    h.word(*(a.target or (0, 0)))
    hash_hazard(h, a.hazard)


def hash_obstacle(h: Hash, o: goe.flight.Obstacle | None) -> None:
    if o is None:
        h.word(*33 * [0])
        return
    zero = (0.0, 0.0, 0.0)
    place, height = o.place or goe.flight.Place(zero, zero, 0.0, zero, zero, None), o.height or NONE
    h.word(o.id)
    known = (o.place, o.length_m, o.height, o.length_heading_deg, None, o.width_m)
    h.flags(*(quantity is not None for quantity in known), o.moves)
    h.word(o.model or 0)
    h.flags(o.suspect, o.receding, o.in_view, o.hazard is not None)
    h.numbers(o.age_s, *place.center_ned_m, *place.covariance_ne_m2, place.radius_m, *height)
    h.numbers(*(quantity or 0.0 for quantity in (o.width_m, o.length_m, o.length_heading_deg)))
    h.numbers(*place.nearest_ned_m, *place.nearest_body_m)
    h.word(*(place.center or (0, 0)))
    hash_hazard(h, o.hazard)


def time_of(track: LoggedTrack, k: int) -> int:
    """The time in 32 bits, which wrap on the way; the package accepts larger numbers."""
    return 0xFFF00000 + track.images[k].time_us - track.images[0].time_us


def velocity_of(track: LoggedTrack, k: int) -> np.ndarray:
    """The velocity that the logs lack: the change of the position since the image before, so that the two agree."""
    if k == 0:
        return np.array(PLAN.velocity_ned_m_s, np.float32)
    now, before = track.images[k], track.images[k - 1]
    between_us = (time_of(track, k) - time_of(track, k - 1) + 2**31) % 2**32 - 2**31
    s = np.float32(between_us) * np.float32(1e-6)
    return (np.array(now.numbers[:3], np.float32) - np.array(before.numbers[:3], np.float32)) / s


def give_samples(h: Hash, flight: goe.Flight, time_us: int, image: LoggedImage, velocity: np.ndarray) -> None:
    n = image.numbers
    h.word(flight.attitude(goe.flight.Attitude(time_us, n[4:8])))
    sample = goe.flight.PositionSample(
        time_us, n[:3], velocity, terrain_m=n[3], origin=goe.flight.LatLon(474000000, 85000000),
        reset_horizontal=image.reset_count, reset_vertical=image.reset_count,
        reset_delta_ned_m=n[8:11] if image.reset_delta_known else None,
    )  # fmt: skip
    h.word(flight.position(sample))


def read_layer(h: Hash, flight: goe.Flight, now_us: int, approach: bool) -> None:
    """Python returns None for a status other than OK. With a pose, that is the status of an empty slot."""
    assessment, obstacle, sectors = flight.assess(now_us, approach), flight.obstacle(0), flight.sectors(MAX_CM)
    status = goe.flight.FlightStatus.OK if assessment is not None else goe.flight.FlightStatus.NO_POSE
    h.word(status)
    hash_assessment(h, assessment)
    h.word(0 if obstacle is not None else goe.flight.FlightStatus.NOTHING if status == 0 else status)
    hash_obstacle(h, obstacle)
    h.word(status)
    h.word(*(goe.flight.SECTORS * [goe.flight.SECTOR_UNKNOWN] if sectors is None else sectors))


def test_the_flight_layer_has_the_bits_of_c(tracks: list[LoggedTrack]) -> None:
    h, frames = Hash(), 0
    for track in tracks:
        settings = settings_of(track, goe.Method.FILTER)
        if settings.camera.width_px <= 0.0:
            settings.camera.width_px = settings.camera.height_px = IMAGE_PX
        flight = goe.Flight(settings, goe.FlightSettings(confirm_images=1))
        h.word(0)
        for k, image in enumerate(track.images):
            give_samples(h, flight, time_of(track, k), image, velocity_of(track, k))
            if k >= LATE:
                visible = track.images[k - LATE]
                detection = goe.flight.Detection(1.0, 1, box_of(visible), **points_of(visible))
                frame = goe.flight.Frame(time_of(track, k), time_of(track, k - LATE), [detection], time_sd_us=3000)
                h.word(flight.frame(frame))
                frames += 1
            read_layer(h, flight, time_of(track, k), k % 16 < 8)
    assert frames > 600
    assert str(h) == golden("flight_hash.txt")
