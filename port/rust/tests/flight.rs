//! The flight layer: from detections to an order.
#![cfg(feature = "flight")]

use goe::flight::{
    Action, Attitude, Capture, Detection, Flight, FlightError, FlightPhase, FlightSettings, Frame, Heights, LatLon,
    PositionSample, Sector, SLOTS,
};
use goe::{BoundingBox, Error, Kind, Length, Settings};

const SPEED_M_S: f32 = 16.0;

fn settings() -> Settings {
    Settings::for_camera(914.0, 914.0, 640.0, 640.0, 1280.0, 1280.0)
}

fn samples(flight: &mut Flight, time_us: u32, north_m: f32) -> Result<(), FlightError> {
    flight.attitude(&Attitude {
        time_us,
        q: [1.0, 0.0, 0.0, 0.0],
        reset: 0,
    })?;
    flight.position(&PositionSample {
        time_us,
        position_ned_m: [north_m, 0.0, -15.0],
        velocity_ned_m_s: [SPEED_M_S, 0.0, 0.0],
        heights: Heights {
            home_m: Some(15.0),
            ..Heights::default()
        },
        origin: Some(LatLon {
            lat_e7: 474_000_000,
            lon_e7: 85_000_000,
        }),
        ..PositionSample::default()
    })
}

fn mast(ahead_m: f32) -> Detection {
    let px = |across_m: f32| 640.0 + 914.0 * across_m / ahead_m;
    Detection::new(0.9)
        .with_id(7)
        .with_box(BoundingBox::new(px(-3.0), px(-15.0), px(3.0), px(15.0)))
}

#[test]
fn an_order_comes_in_time() {
    let mut flight = Flight::new(&settings(), &FlightSettings::default()).expect("good settings");
    assert_eq!(flight.assess(0, FlightPhase::Flying), Err(FlightError::NoPose));
    let start_us = u32::MAX - 2_000_000; // the clock wraps on the way
    let mut ordered_m = None;
    for k in 0..400_u16 {
        let time_us = start_us.wrapping_add(50_000 * u32::from(k));
        let north_m = SPEED_M_S * 0.05 * f32::from(k);
        samples(&mut flight, time_us, north_m).expect("good samples");
        let detections = [mast(300.0 - north_m)];
        let frame = Frame::new(time_us, Capture::Autopilot { capture_us: time_us }, &detections);
        if k > 0 && k % 2 == 0 {
            flight.frame(&frame).expect("a good frame");
        }
        let seen = flight.assess(time_us, FlightPhase::default()).expect("a pose");
        assert_eq!(seen.target_ned_m.is_some(), seen.action != Action::None);
        if seen.action != Action::None {
            assert!(seen.detector_alive && seen.pose_alive && seen.target.is_some());
            assert!(
                matches!(seen.action, Action::Left | Action::Right | Action::Climb),
                "{}",
                seen.action
            );
            let obstacle = flight
                .obstacle(seen.avoided.expect("an order has an obstacle"))
                .expect("an obstacle");
            assert_eq!(obstacle.id, 7);
            let place = obstacle.place.expect("a place");
            assert!((place.center_ned_m[0] - 300.0).abs() < 60.0 && place.center.is_some());
            assert!(matches!(
                flight.sectors(60_000).expect("a pose")[0],
                Sector::Nearest { .. }
            ));
            ordered_m = Some(300.0 - north_m);
            break;
        }
    }
    let ordered_m = ordered_m.expect("an order");
    assert!((60.0..250.0).contains(&ordered_m), "{ordered_m}");
    assert!(flight.counters().taken > 10);
}

#[test]
fn refused_input_is_reported_and_counted() {
    let mut flight = Flight::new(&settings(), &FlightSettings::default()).expect("good settings");
    let empty = |capture_us| Frame::new(1_000_000, Capture::Autopilot { capture_us }, &[]);
    assert_eq!(flight.frame(&empty(1_000_000)), Err(FlightError::NoPose));
    for k in 1..=50 {
        samples(&mut flight, 20_000 * k, 0.0).expect("good samples");
    }
    assert_eq!(flight.frame(&empty(1_100_000)), Err(FlightError::TooNew));
    assert_eq!(flight.frame(&empty(1_000)), Err(FlightError::TooOld));
    assert_eq!(flight.frame(&empty(990_000)), Ok(()));
    assert_eq!(samples(&mut flight, 900_000, 0.0), Err(FlightError::BadTime));
    assert_eq!(samples(&mut flight, 1_020_000, f32::NAN), Err(FlightError::NotFinite));
    assert_eq!(samples(&mut flight, 1_040_000, 1e7), Err(FlightError::OutOfRange));
    let counters = flight.counters();
    assert_eq!((counters.taken, counters.late, counters.early), (1, 2, 1)); // without a pose counts as late
    let many = [mast(100.0); 33];
    let frame = Frame::new(1_000_000, Capture::Autopilot { capture_us: 1_000_000 }, &many);
    assert_eq!(flight.frame(&frame), Err(FlightError::OutOfRange));
    for slot in [0, SLOTS, usize::MAX] {
        assert_eq!(flight.obstacle(slot), Err(FlightError::Nothing));
    }
    let at = flight.pose(980_000, 0).expect("a pose");
    assert_eq!((at.pose.position_ned_m, at.pose.height_m), ([0.0, 0.0, -15.0], 15.0));
    flight.timesync(Some((5, 1000)));
    flight.restart();
    assert_eq!(flight.pose(980_000, 0), Err(FlightError::NoPose));
    assert!(format!("{flight:?}").contains("lost: 1"));
}

#[test]
fn a_bad_kind_is_counted_and_loses_no_box() {
    let mut flight = Flight::new(&settings(), &FlightSettings::default()).expect("good settings");
    let bad = Kind {
        height: Some(Length {
            m: 30.0,
            sd_m: f32::NAN,
        }),
        ..Kind::default()
    };
    let mut taken = 0;
    for k in 1..=50_u16 {
        let time_us = 20_000 * u32::from(k);
        samples(&mut flight, time_us, 0.02 * SPEED_M_S * f32::from(k)).expect("good samples");
        let detections = [mast(200.0 - 0.02 * SPEED_M_S * f32::from(k)).with_kind(bad)];
        let frame = Frame::new(time_us, Capture::Autopilot { capture_us: time_us }, &detections);
        taken += u16::from(flight.frame(&frame).is_ok());
    }
    assert!(taken > 40);
    assert_eq!(flight.counters().refused, taken);
    assert!(flight.obstacle(0).is_ok());
}

#[test]
fn settings_change_in_flight() {
    let mut flight = Flight::new(&settings(), &FlightSettings::default()).expect("good settings");
    for k in 1..=50 {
        samples(&mut flight, 20_000 * k, 0.0).expect("good samples");
    }
    let wide = FlightSettings {
        margin_m: 40.0,
        ..FlightSettings::default()
    };
    assert_eq!(flight.change_settings(&wide), Ok(()));
    assert!(flight.pose(980_000, 0).is_ok());
    let bad = FlightSettings { bank_deg: 89.0, ..wide };
    assert_eq!(flight.change_settings(&bad), Err(Error::BadSetting("bank_deg")));
}

#[test]
fn bad_settings_are_named() {
    let mut unsized_image = settings();
    unsized_image.camera.width_px = 0.0;
    let error = Flight::new(&unsized_image, &FlightSettings::default()).err();
    assert_eq!(error, Some(Error::BadSetting("camera.width_px")));
    let settings_of_layer = FlightSettings {
        bank_deg: 89.0,
        ..FlightSettings::default()
    };
    assert_eq!(
        Flight::new(&settings(), &settings_of_layer).err(),
        Some(Error::BadSetting("bank_deg"))
    );
}
