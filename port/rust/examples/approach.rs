//! Flies towards a mast of 6 m by 30 m and prints the estimate, and when to go around it.

use goe::{BoundingBox, DecisionRule, Error, Estimator, Fault, Image, Intent, Pose, Settings};

const FOCAL_PX: f32 = 914.0;
const CENTER_PX: f32 = 640.0;
const SPEED_M_S: f32 = 16.0;
const HEIGHT_M: f32 = 15.0;

/// What a detector would see of the mast from here: raw pixels.
fn detect(ahead_m: f32) -> BoundingBox {
    let px = |across_m: f32| CENTER_PX + FOCAL_PX * across_m / ahead_m;
    BoundingBox::new(px(-3.0), px(-15.0), px(3.0), px(HEIGHT_M))
}

fn main() -> Result<(), Error> {
    let mut settings = Settings::for_camera(
        FOCAL_PX,
        FOCAL_PX,
        CENTER_PX,
        CENTER_PX,
        2.0 * CENTER_PX,
        2.0 * CENTER_PX,
    );
    settings.detector.box_noise_rel = 0.01; // this detector does not err; real ones: leave the default
    let mut mast = Estimator::new(&settings)?;
    let intent = Intent {
        velocity_ned_m_s: [SPEED_M_S, 0.0, 0.0],
        margin_m: 15.0,
        clearance_m: 10.0,
        ..Intent::default()
    };
    let rule = DecisionRule {
        act_within_s: 5.0, // what a climb takes here
        ..DecisionRule::default()
    };
    let mut go_around = false;
    for k in 0..80_i16 {
        let flown_m = 2.0 * f32::from(k);
        let image = Image {
            pose: Pose {
                time_us: 125_000 * i64::from(k),
                position_ned_m: [flown_m, 0.0, -HEIGHT_M],
                height_m: HEIGHT_M,
                ..Pose::default()
            },
            bounding_box: Some(detect(200.0 - flown_m)),
            ..Image::default()
        };
        let estimate = mast.update(&image).unwrap_or_else(|fault: Fault| fault.estimate);
        let (decision, hazard) = mast.decide(&intent, &rule);
        go_around = decision.acts(go_around);
        let (Some(position), Some(hazard)) = (estimate.position, hazard) else {
            println!("{:4.1} s  {}", f32::from(k) / 8.0, estimate.status);
            continue;
        };
        if k % 8 == 0 {
            println!(
                "{:4.1} s  {:5.1} +- {:4.1} m ahead, {:4.1} s to go, violation {:.2}",
                f32::from(k) / 8.0,
                position.z.m,
                position.z.sd_m,
                hazard.tcpa_s,
                hazard.conflict_probability
            );
        }
        if go_around {
            println!("{:4.1} s  go around: {:.1} s to go", f32::from(k) / 8.0, hazard.tcpa_s);
            break;
        }
    }
    Ok(())
}
