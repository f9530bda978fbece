//! The figures of the project's example, faults and parts.

use goe::{BoundingBox, Error, Estimate, Estimator, Fault, Image, Pose, Settings, Status};

fn settings() -> Settings {
    Settings::for_camera(914.0, 914.0, 640.0, 640.0, 1280.0, 1280.0)
}

/// Image k of the approach in the project's README.
fn image(k: i16) -> Image {
    let ahead_m = 200.0 - 2.0 * f32::from(k);
    let px = |across_m: f32| 640.0 + 914.0 * across_m / ahead_m;
    Image {
        pose: Pose {
            time_us: 125_000 * i64::from(k),
            position_ned_m: [2.0 * f32::from(k), 0.0, 0.0],
            height_m: 15.0,
            ..Pose::default()
        },
        bounding_box: Some(BoundingBox::new(px(-33.0), px(-15.0), px(-27.0), px(15.0))),
        ..Image::default()
    }
}

fn fly(estimator: &mut Estimator, images: i16) -> Estimate {
    let mut last = None;
    for k in 0..images {
        last = Some(estimator.update(&image(k)).expect("a good image"));
    }
    last.expect("an image")
}

#[test]
fn nothing_is_wrong_with_the_arithmetic() {
    assert_eq!(goe::self_check(), 0);
}

#[cfg(feature = "filter")]
mod filter {
    use super::*;
    use goe::{Kind, KindShape, Length, Model};

    #[test]
    #[allow(clippy::result_large_err)] // of the closure
    fn a_class_gives_size_and_shape() {
        let with = |kind: Kind| {
            let mut estimator = Estimator::new(&settings()).expect("good settings");
            let image = |k| Image { kind, ..image(k) };
            (0..20).map(|k| estimator.update(&image(k))).last().expect("an image")
        };
        let plain = with(Kind::default()).expect("a good image");
        let sized = with(Kind {
            height: Some(Length { m: 30.0, sd_m: 1.0 }),
            ..Kind::default()
        });
        let sd_m = |estimate: Estimate| estimate.position.expect("a position").z.sd_m;
        let ratio = sd_m(sized.expect("a good image")) / sd_m(plain); // images know the range by now
        assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
        let round = Kind {
            shape: KindShape::Round,
            ..Kind::default()
        };
        assert_eq!(with(round).expect("a good image").model, Some(Model::Disc));
        let bad = with(Kind {
            width: Some(Length { m: 6.0, sd_m: 0.0 }),
            ..Kind::default()
        });
        assert_eq!(bad.expect_err("no sigma").estimate.status, Status::OutOfRange);
    }

    #[test]
    fn the_figures_of_the_readme() {
        let mut tower = Estimator::new(&settings()).expect("good settings");
        let first = tower.update(&image(0)).expect("a good image");
        assert_eq!((first.status, first.position), (Status::Converging, None));
        let estimate = fly(&mut Estimator::new(&settings()).expect("good settings"), 2);
        let position = estimate.position.expect("a position with the second image");
        let said = format!(
            "{:.1} +- {:.1} m ahead, {:.1} m to the left",
            position.z.m, position.z.sd_m, -position.x.m
        );
        if cfg!(feature = "window") && cfg!(feature = "target_motion") {
            let width = estimate.width.expect("a width");
            let height = estimate.height.expect("a height");
            assert_eq!(said, "201.0 +- 53.3 m ahead, 30.4 m to the left");
            assert_eq!(format!("{:.1} {:.1}", width.m, height.m), "6.0 30.0");
        }
        let tenth = fly(&mut Estimator::new(&settings()).expect("good settings"), 10);
        let z = tenth.position.expect("a position").z;
        assert_eq!(format!("{:.1} +- {:.1}", z.m, z.sd_m), "183.2 +- 28.3");
    }
}

#[test]
fn a_bad_setting_is_named() {
    let bad = Estimator::new(&Settings::default());
    assert_eq!(bad.err(), Some(Error::BadSetting("camera.fx_px")));
    let mut settings = settings();
    settings.heading_deg = Some(f32::NAN);
    assert_eq!(Estimator::new(&settings).err(), Some(Error::BadSetting("heading_deg")));
}

#[test]
fn a_method_that_is_left_out_is_refused() {
    for (method, there) in [
        (goe::Method::Window, cfg!(feature = "window")),
        (goe::Method::Filter, cfg!(feature = "filter")),
    ] {
        let chosen = Settings { method, ..settings() };
        assert_eq!(Estimator::new(&chosen).is_ok(), there, "{method:?}");
    }
}

#[test]
fn a_fault_carries_the_last_good_estimate_and_is_counted() {
    let mut estimator = Estimator::new(&settings()).expect("good settings");
    let good = fly(&mut estimator, 12);
    let mut bad = image(12);
    bad.pose.position_ned_m[1] = f32::NAN;
    let Err(Fault { estimate }) = estimator.update(&bad) else {
        panic!("a NaN was taken")
    };
    assert_eq!(estimate.status, Status::NotFinite);
    assert!(!estimate.fresh && estimate.status.is_fault() && !estimate.status.is_image_taken());
    assert_eq!(estimate.position, good.position);
    assert_eq!(estimator.fault_counts()[10], 1);
    let repeated = estimator.update(&image(11)).expect_err("the same time again");
    assert_eq!(
        (repeated.estimate.status, repeated.to_string()),
        (Status::BadTime, "bad_time".to_string())
    );
    assert_eq!(estimator.update(&image(13)).expect("a good image").status, Status::Ok);
}

#[test]
fn nothing_in_view_is_not_a_fault() {
    let mut estimator = Estimator::new(&settings()).expect("good settings");
    let empty = Image {
        bounding_box: None,
        ..image(0)
    };
    assert_eq!(estimator.update(&empty).expect("no fault").status, Status::NoDetection);
}

#[test]
fn an_estimator_may_be_moved_and_copied() {
    let mut one = Estimator::new(&settings()).expect("good settings");
    fly(&mut one, 5);
    let mut two = Box::new(one.clone());
    for k in 5..12 {
        assert_eq!(one.update(&image(k)), two.update(&image(k)));
    }
    assert!(format!("{two:?}").starts_with("Estimator"));
}

#[test]
fn a_reset_forgets_the_track() {
    let mut estimator = Estimator::new(&settings()).expect("good settings");
    assert!(estimator.covariance().is_none());
    let last = fly(&mut estimator, 12);
    let covariance = estimator.covariance().expect("a position");
    let z0_sd_m = last.position.expect("a position").z0.sd_m;
    assert!((covariance[1][1].sqrt() - z0_sd_m).abs() < 1e-3 * z0_sd_m);
    estimator.reset();
    assert!(estimator.covariance().is_none());
    assert_eq!(estimator.update(&image(0)).expect("a good image").position, None);
}

#[cfg(feature = "hazard")]
#[test]
fn hazards() {
    use goe::Intent;
    let intent = Intent {
        velocity_ned_m_s: [16.0, 0.0, 0.0],
        margin_m: 40.0,
        clearance_m: 10.0,
        ..Intent::default()
    };
    let mut estimator = Estimator::new(&settings()).expect("good settings");
    assert_eq!(estimator.hazard(&intent), Err(Error::NoPosition));
    let z_m = fly(&mut estimator, 12).position.expect("a position").z.m;
    let hazard = estimator.hazard(&intent).expect("a position");
    assert!((hazard.tcpa_s - z_m / 16.0).abs() < 1.0, "{hazard:?} {z_m}");
    assert!(hazard.clearance.is_some_and(|clearance| clearance.m < 0.0) && hazard.conflict_probability > 0.1);
    let away = Intent {
        velocity_ned_m_s: [-16.0, 0.0, 0.0],
        ..intent
    };
    assert_eq!(estimator.hazard(&away).expect("a position").tcpa_s, 0.0);
    assert_eq!(
        estimator.hazard(&Intent {
            margin_m: f32::NAN,
            ..intent
        }),
        Err(Error::NotFinite)
    );
    assert_eq!(
        estimator.hazard(&Intent {
            margin_m: -1.0,
            ..intent
        }),
        Err(Error::OutOfRange)
    );
    let unsure = Intent {
        velocity_sd_m_s: 3.0,
        ..intent
    };
    let unsure = estimator.hazard(&unsure).expect("a position");
    assert!(unsure.dcpa.sd_m > 2.0 * hazard.dcpa.sd_m, "{unsure:?} {hazard:?}");
    let most = hazard.tcpa_s + 2.0 * hazard.tcpa_sd_s;
    assert!((hazard.earliest_tcpa_s() - hazard.tcpa_s * hazard.tcpa_s / most).abs() < 1e-4);
}

#[cfg(feature = "hazard")]
#[test]
fn decisions() {
    use goe::{Decision, DecisionRule, Intent};
    let rule = DecisionRule::default();
    assert_eq!(
        (
            rule.conflict_probability_max,
            rule.act_within_s,
            rule.suspect_factor,
            rule.stale_growth_m_s
        ),
        (0.1, 12.0, 1.5, 1.0)
    );
    let intent = Intent {
        velocity_ned_m_s: [16.0, 0.0, 0.0],
        margin_m: 40.0,
        clearance_m: 10.0,
        ..Intent::default()
    };
    let mut estimator = Estimator::new(&settings()).expect("good settings");
    assert_eq!(estimator.decide(&intent, &rule), (Decision::Unknown, None));
    fly(&mut estimator, 12);
    let (decision, hazard) = estimator.decide(&intent, &rule);
    let hazard = hazard.expect("a position");
    assert_eq!(
        (decision, hazard),
        (Decision::Act, estimator.hazard(&intent).expect("a position"))
    );
    let late = DecisionRule {
        act_within_s: 0.5 * hazard.earliest_tcpa_s(),
        ..rule
    };
    assert_eq!(estimator.decide(&intent, &late), (Decision::Clear, Some(hazard)));
    let away = Intent {
        velocity_ned_m_s: [-16.0, 0.0, 0.0],
        margin_m: 5.0,
        ..intent
    };
    assert_eq!(estimator.decide(&away, &rule).0, Decision::Clear);
    let bad_intent = Intent {
        margin_m: f32::NAN,
        ..intent
    };
    let bad_rule = DecisionRule {
        suspect_factor: 0.5,
        ..rule
    };
    assert_eq!(estimator.decide(&bad_intent, &rule), (Decision::Keep, None));
    assert_eq!(estimator.decide(&intent, &bad_rule), (Decision::Keep, None));
    assert!(Decision::Act.acts(false) && Decision::Keep.acts(true) && Decision::Unknown.acts(true));
    assert!(!Decision::Clear.acts(true) && !Decision::Keep.acts(false));
    let mut invisible = image(12);
    invisible.bounding_box = None;
    invisible.pose.time_us += 1_000_000;
    estimator.update(&invisible).expect("no fault");
    assert_ne!(estimator.decide(&intent, &rule).1, estimator.hazard(&intent).ok());
}

#[cfg(feature = "filter")]
#[test]
fn a_box_without_sides_and_one_without_a_height() {
    let mut estimator = Estimator::new(&settings()).expect("good settings");
    let mut bare = image(0);
    bare.pose.height_m = 0.0;
    let _ = estimator.update(&bare);
    let mut narrow = image(1);
    narrow.bounding_box = Some(BoundingBox {
        left_px: Some(500.0),
        ..BoundingBox::default()
    });
    let Err(Fault { estimate }) = estimator.update(&narrow) else {
        panic!("a box of one side")
    };
    assert_eq!(estimate.status, Status::BoxIncomplete);
    assert_eq!((estimator.fault_counts()[14], estimator.fault_counts()[15]), (1, 1));
}
