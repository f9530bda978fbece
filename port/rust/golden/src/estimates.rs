//! Each track by each method: `tests/targets/replay.c`, `replay_all`.

use goe::ffi;
use goe::{Error, Estimate, Estimator, Intent, Length, Method, Model};

use crate::hash::Hash;
use crate::logs::{tracks, LoggedTrack};

const NONE: Length = Length { m: 0.0, sd_m: 0.0 };

fn hash_estimate(hash: &mut Hash, e: &Estimate) {
    let valid = [
        e.position.is_some(),
        e.length.is_some(),
        e.height.is_some(),
        e.orientation.is_some(),
        e.center.is_some(),
        e.width.is_some(),
        e.velocity.is_some(),
    ];
    let p = e.position.map_or([NONE; 4], |p| [p.x0, p.z0, p.x, p.z]);
    let (residual, baseline_m) = e.position.map_or((0.0, 0.0), |p| (p.residual, p.baseline_m));
    let (width, length, height) = (
        e.width.unwrap_or(NONE),
        e.length.unwrap_or(NONE),
        e.height.unwrap_or(NONE),
    );
    let (north, east) = e.center.map_or((NONE, NONE), |c| (c.north, c.east));
    let velocity = e
        .velocity
        .map_or([0.0; 4], |v| [v.north_m_s, v.east_m_s, v.north_sd_m_s, v.east_sd_m_s]);
    hash.word(e.method.map_or(0, |m| if m == Method::Window { 1 } else { 2 }));
    hash.word(match e.model {
        None => 0,
        Some(Model::Disc) => 2,
        Some(Model::Line) => 3,
        Some(Model::Box) => 4,
        Some(_) => 5,
    });
    hash.flags(&valid);
    hash.word(e.fresh.into());
    hash.word(e.suspect.into());
    match e.reason {
        None => hash.text("none"),
        Some(reason) => {
            use core::fmt::Write;
            struct Text<'a>(&'a mut Hash);
            impl Write for Text<'_> {
                fn write_str(&mut self, text: &str) -> core::fmt::Result {
                    self.0.text(text);
                    Ok(())
                }
            }
            let _ = write!(Text(hash), "{reason}");
        }
    }
    hash.word(e.nis_rows.into());
    hash.word(e.images_used.into());
    hash.numbers(&[e.age_s, velocity[0], velocity[1], e.latency_s]);
    hash.numbers(&p.map(|quantity| quantity.m));
    hash.numbers(&[width.m, length.m, height.m]);
    match e.orientation {
        None => hash.numbers(&[0.0; 11]),
        Some(o) => {
            hash.numbers(&[o.side_deg, o.side_raw_deg, o.front_deg]);
            [o.length_axis, o.width_axis, o.length_axis_ne, o.width_axis_ne]
                .iter()
                .for_each(|axis| hash.numbers(axis));
        }
    }
    let covariance_m2 = e.center.map_or(0.0, |c| c.covariance_m2);
    hash.numbers(&[e.trajectory_heading_deg, north.m, east.m, covariance_m2]);
    hash.numbers(&[residual, baseline_m, e.nis, e.nis_ratio]);
    hash.numbers(&p.map(|quantity| quantity.sd_m));
    hash.numbers(&[
        width.sd_m,
        length.sd_m,
        height.sd_m,
        e.orientation.map_or(0.0, |o| o.side_sd_deg),
    ]);
    hash.numbers(&[north.sd_m, east.sd_m, velocity[2], velocity[3], e.latency_sd_s]);
}

fn hash_after(hash: &mut Hash, estimator: &Estimator) {
    let covariance = estimator.covariance();
    hash.status(if covariance.is_some() {
        ffi::GOE_OK
    } else {
        ffi::GOE_CONVERGING
    });
    covariance.unwrap_or_default().iter().for_each(|row| hash.numbers(row));
    let intent = Intent {
        velocity_ned_m_s: [15.0, 1.0, -0.5],
        margin_m: 10.0,
        clearance_m: 5.0,
        ..Intent::default()
    };
    match estimator.hazard(&intent) {
        Ok(hazard) => {
            hash.status(ffi::GOE_OK);
            let clearance = hazard.clearance.unwrap_or(NONE);
            hash.numbers(&[hazard.tcpa_s, hazard.dcpa.m, clearance.m, hazard.conflict_probability]);
            hash.numbers(&[hazard.tcpa_sd_s, hazard.dcpa.sd_m, clearance.sd_m]);
            hash.word(hazard.clearance.is_some().into());
        }
        Err(error) => {
            assert!(error == Error::NoPosition);
            hash.status(ffi::GOE_CONVERGING);
            hash.numbers(&[0.0; 7]);
            hash.word(0);
        }
    }
}

fn fly(hash: &mut Hash, track: &LoggedTrack, method: Method) -> u32 {
    let mut estimator = match Estimator::new(&track.settings(method)) {
        Ok(estimator) => estimator,
        Err(Error::BadSetting(name)) => {
            hash.status(ffi::GOE_BAD_SETTINGS);
            hash.text(name);
            return 0;
        }
        Err(_) => unreachable!(),
    };
    hash.status(ffi::GOE_OK);
    for logged in track.images() {
        let estimate = estimator.update(&logged.image()).unwrap_or_else(|fault| fault.estimate);
        hash.status(estimate.status.code());
        hash_estimate(hash, &estimate);
        hash_after(hash, &estimator);
    }
    estimator.fault_counts().iter().for_each(|&cause| hash.word(cause));
    estimator.reset();
    hash.status(ffi::GOE_OK);
    track.images().len() as u32
}

pub fn replay() -> crate::Replayed {
    let mut hash = Hash::new();
    let mut images = 0;
    for track in tracks() {
        for method in [Method::Window, Method::Filter] {
            images += fly(&mut hash, track, method);
        }
    }
    (hash.0, images)
}
