//! The same logs as samples, late frames and assessments: `tests/targets/flight_main.c`.

use core::mem::MaybeUninit;
use core::num::NonZeroU32;

use goe::flight::{
    Action, Assessment, Attitude, Capture, Detection, Flight, FlightError, FlightPhase, FlightSettings, Frame, Heights,
    LatLon, Obstacle, Point, PositionSample, Sector, SECTORS,
};
use goe::{Hazard, Image, Length, Method, Model};

use crate::hash::Hash;
use crate::logs::{tracks, LoggedTrack};

const IMAGE_PX: f32 = 1280.0;
const LATE: usize = 2; // images
const MAX_CM: u16 = 20_000;
const NONE: Length = Length { m: 0.0, sd_m: 0.0 };

fn code(result: Result<(), FlightError>) -> u32 {
    result.map_or_else(|error| error.code() as u32, |()| 0)
}

fn hash_hazard(hash: &mut Hash, hazard: Option<Hazard>) {
    let Some(h) = hazard else {
        return (0..8).for_each(|_| hash.word(0));
    };
    let clearance = h.clearance.unwrap_or(NONE);
    hash.numbers(&[
        h.tcpa_s,
        h.dcpa.m,
        clearance.m,
        h.tcpa_sd_s,
        h.dcpa.sd_m,
        clearance.sd_m,
        h.conflict_probability,
    ]);
    hash.word(h.clearance.is_some().into());
}

fn hash_assessment(hash: &mut Hash, result: Result<Assessment, FlightError>) {
    let Ok(a) = result else {
        hash.word(0);
        hash.word(0);
        hash.word(u32::MAX); // worst and avoided: -1
        hash.word(u32::MAX);
        (0..7).for_each(|_| hash.word(0));
        return hash_hazard(hash, None);
    };
    hash.word(match a.action {
        Action::None => 0,
        Action::Left => 1,
        Action::Right => 2,
        Action::Climb => 3,
        Action::GoAround => 4,
        _ => 5,
    });
    hash.flags(&[a.late, a.suspect, a.detector_alive, a.pose_alive]);
    for slot in [a.worst, a.avoided] {
        hash.word(slot.map_or(u32::MAX, |slot| slot as u32));
    }
    hash.word(a.obstacles.into());
    hash.number(a.needed_s);
    hash.numbers(&a.target_ned_m.unwrap_or_default());
    hash_place(hash, a.target);
    hash_hazard(hash, a.hazard);
}

fn hash_place(hash: &mut Hash, place: Option<LatLon>) {
    let at = place.unwrap_or(LatLon { lat_e7: 0, lon_e7: 0 });
    hash.word(at.lat_e7 as u32);
    hash.word(at.lon_e7 as u32);
}

fn hash_obstacle(hash: &mut Hash, obstacle: Result<Obstacle, FlightError>) {
    let Ok(o) = obstacle else {
        return (0..33).for_each(|_| hash.word(0));
    };
    let height = o.height.unwrap_or(NONE);
    hash.word(o.id);
    hash.flags(&[
        o.place.is_some(),
        o.length_m.is_some(),
        o.height.is_some(),
        o.length_heading_deg.is_some(),
        false,
        o.width_m.is_some(),
        o.moves,
    ]);
    hash.word(match o.model {
        None => 0,
        Some(Model::Disc) => 2,
        Some(Model::Line) => 3,
        Some(Model::Box) => 4,
        Some(_) => 5,
    });
    hash.flags(&[o.suspect, o.receding, o.in_view, o.hazard.is_some()]);
    hash.number(o.age_s);
    hash.numbers(&o.place.map_or([0.0; 3], |p| p.center_ned_m));
    hash.numbers(&o.place.map_or([0.0; 3], |p| p.covariance_ne_m2));
    hash.numbers(&[o.place.map_or(0.0, |p| p.radius_m), height.m, height.sd_m]);
    hash.numbers(&[o.width_m, o.length_m, o.length_heading_deg].map(Option::unwrap_or_default));
    hash.numbers(&o.place.map_or([0.0; 3], |p| p.nearest_ned_m));
    hash.numbers(&o.place.map_or([0.0; 3], |p| p.nearest_body_m));
    hash_place(hash, o.place.and_then(|p| p.center));
    hash_hazard(hash, o.hazard);
}

fn time_of(track: &LoggedTrack, k: usize) -> u32 {
    let images = track.images();
    0xFFF0_0000_u32.wrapping_add((images[k].time_us - images[0].time_us) as u32)
}

/// The velocity that the logs lack: the change of the position since the image before, so that the two agree.
fn velocity_of(track: &LoggedTrack, k: usize) -> [f32; 3] {
    if k == 0 {
        return [15.0, 1.0, -0.5];
    }
    let (now, before) = (track.images()[k].image().pose, track.images()[k - 1].image().pose);
    let s = time_of(track, k).wrapping_sub(time_of(track, k - 1)) as i32 as f32 * 1.0e-6;
    std::array::from_fn(|i| (now.position_ned_m[i] - before.position_ned_m[i]) / s)
}

fn give_samples(hash: &mut Hash, flight: &mut Flight, time_us: u32, image: &Image, velocity_ned_m_s: [f32; 3]) {
    let pose = &image.pose;
    let reset = u32::from(pose.reset_count);
    hash.word(code(flight.attitude(&Attitude {
        time_us,
        q: pose.attitude,
        reset: 0,
    })));
    hash.word(code(flight.position(&PositionSample {
        time_us,
        position_ned_m: pose.position_ned_m,
        velocity_ned_m_s,
        heights: Heights {
            terrain_m: Some(pose.height_m),
            ..Heights::default()
        },
        origin: Some(LatLon {
            lat_e7: 474_000_000,
            lon_e7: 85_000_000,
        }),
        reset_horizontal: reset,
        reset_vertical: reset,
        reset_delta_ned_m: pose.reset_delta_ned_m,
    })));
}

fn detection(image: &Image) -> Detection {
    let points = [
        (Point::Left, image.left),
        (Point::Right, image.right),
        (Point::Top, image.top),
        (Point::BaseLeft, image.base_left),
        (Point::BaseNear, image.base_near),
        (Point::BaseRight, image.base_right),
    ];
    let mut detection = Detection::new(1.0)
        .with_id(1)
        .with_box(image.bounding_box.unwrap_or_default());
    for (point, at) in points {
        if let Some(at) = at {
            detection = detection.with_point(point, at);
        }
    }
    detection
}

fn read_layer(hash: &mut Hash, flight: &mut Flight, now_us: u32, approach: bool) {
    let assessed = flight.assess(
        now_us,
        if approach {
            FlightPhase::Approach
        } else {
            FlightPhase::Flying
        },
    );
    hash.word(code(assessed.map(|_| ())));
    hash_assessment(hash, assessed);
    let obstacle = flight.obstacle(0);
    hash.word(code(obstacle.map(|_| ())));
    hash_obstacle(hash, obstacle);
    let sectors = flight.sectors(MAX_CM);
    hash.word(code(sectors.map(|_| ())));
    for sector in sectors.unwrap_or([Sector::Unknown; SECTORS]) {
        hash.word(match sector {
            Sector::Unknown => 65_535,
            Sector::Clear => u32::from(MAX_CM) + 1,
            Sector::Nearest { cm } => cm.into(),
        });
    }
}

fn fly(hash: &mut Hash, track: &LoggedTrack) -> u32 {
    let mut estimator = track.settings(Method::Filter);
    if estimator.camera.width_px <= 0.0 {
        estimator.camera.width_px = IMAGE_PX;
        estimator.camera.height_px = IMAGE_PX;
    }
    let settings = FlightSettings {
        confirm_images: 1.0,
        ..FlightSettings::default()
    };
    let mut place = MaybeUninit::uninit();
    let Ok(flight) = Flight::new_in(&mut place, &estimator, &settings) else {
        hash.word(goe::ffi::GOE_FLIGHT_BAD_SETTINGS as u32);
        return 0;
    };
    hash.word(0);
    let mut frames = 0;
    for (k, logged) in track.images().iter().enumerate() {
        give_samples(hash, flight, time_of(track, k), &logged.image(), velocity_of(track, k));
        if k >= LATE {
            let detections = [detection(&track.images()[k - LATE].image())];
            let capture = Capture::Autopilot {
                capture_us: time_of(track, k - LATE),
            };
            let mut frame = Frame::new(time_of(track, k), capture, &detections);
            frame.time_sd_us = NonZeroU32::new(3000);
            hash.word(code(flight.frame(&frame)));
            frames += 1;
        }
        read_layer(hash, flight, time_of(track, k), k % 16 < 8);
    }
    frames
}

pub fn replay() -> crate::Replayed {
    let mut hash = Hash::new();
    let frames = tracks().map(|track| fly(&mut hash, track)).sum();
    (hash.0, frames)
}
