//! What the estimator answers.

use core::fmt;

use crate::ffi;
use crate::{Method, Status};

/// One sigma of each quantity of C's estimate, for [`crate::ffi`]; 0 of an invalid one.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sigma {
    /// Of the reference point across the trajectory, at the first image, m.
    pub x0_m: f32,
    /// ... along it, m.
    pub z0_m: f32,
    /// ... across it, relative to the camera, m.
    pub x_m: f32,
    /// ... along it, m.
    pub z_m: f32,
    /// Of the width, m.
    pub width_m: f32,
    /// Of the length, m.
    pub length_m: f32,
    /// Of the height, m.
    pub height_m: f32,
    /// Of the orientation, degrees.
    pub orientation_deg: f32,
    /// Of the center, m.
    pub center_north_m: f32,
    /// Of the center, m.
    pub center_east_m: f32,
    /// Of the velocity, m/s.
    pub velocity_north_m_s: f32,
    /// Of the velocity, m/s.
    pub velocity_east_m_s: f32,
    /// Of the latency, s.
    pub latency_s: f32,
}

/// The shape behind an estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Model {
    /// An upright cylinder. Filter: only if the settings require it; window: also the circle that replaces anything else.
    Disc,
    /// The front edge of a box. Window method.
    Line,
    /// A box with an upright, level outline. Filter method.
    Box,
    /// Something upright by its silhouette, whose depth along the line of sight is not reported. Filter method.
    Prism,
}

impl Model {
    pub(crate) fn of(model: ffi::goe_model_t) -> Option<Self> {
        match model {
            ffi::GOE_MODEL_DISC => Some(Self::Disc),
            ffi::GOE_MODEL_LINE => Some(Self::Line),
            ffi::GOE_MODEL_BOX => Some(Self::Box),
            ffi::GOE_MODEL_PRISM => Some(Self::Prism),
            _ => None,
        }
    }
}

/// Why an estimate is suspect, the most significant one. Filter method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Reason {
    /// The inputs contradict each other: axes, signs or order of the attitude, the mounting, very late poses.
    Convention,
    /// The obstacle moves. Without [`Estimate::velocity`] it is not followed, and the position is wrong.
    Moves,
    /// The given base corners proved to be wrong.
    Base,
    /// A disc was configured, and the silhouette is not that of one.
    Shape,
    /// Poses are late or early: [`Estimate::latency_s`]. Also of an estimate that is not suspect.
    Late,
    /// The errors are larger than given, or the obstacle is of another shape.
    Noise,
}

impl Reason {
    fn of(reason: ffi::goe_reason_t) -> Option<Self> {
        match reason {
            ffi::GOE_REASON_CONVENTION => Some(Self::Convention),
            ffi::GOE_REASON_MOVES => Some(Self::Moves),
            ffi::GOE_REASON_BASE => Some(Self::Base),
            ffi::GOE_REASON_SHAPE => Some(Self::Shape),
            ffi::GOE_REASON_LATE => Some(Self::Late),
            ffi::GOE_REASON_NOISE => Some(Self::Noise),
            _ => None,
        }
    }
}

impl fmt::Display for Reason {
    /// The library's short name: `moves`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Convention => "convention",
            Self::Moves => "moves",
            Self::Base => "base",
            Self::Shape => "shape",
            Self::Late => "late",
            Self::Noise => "noise",
        })
    }
}

/// A length and its one sigma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length {
    /// The length, m.
    pub m: f32,
    /// Its one sigma, m.
    pub sd_m: f32,
}

/// Position of the reference point: of a disc the center, of a line or box the middle of the front edge. X points right, Z ahead,
/// level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// From where the camera was at the track's first image, across, m.
    pub x0: Length,
    /// ... and along, m.
    pub z0: Length,
    /// From where the camera is at the latest image, across, m: negative is left.
    pub x: Length,
    /// ... and ahead, m.
    pub z: Length,
    /// Window: root mean square residual of the fit, in its rows' own unit; filter: 0.
    pub residual: f32,
    /// Window: spread of the flown baseline; filter: distance from where the track began; m.
    pub baseline_m: f32,
}

/// Orientation of a box or a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    /// The side edge (length) from Z, clockwise as viewed from above, degrees; over -90, up to 90.
    pub side_deg: f32,
    /// Its one sigma, degrees.
    pub side_sd_deg: f32,
    /// Window: the same of the latest image alone, degrees; filter: `side_deg`.
    pub side_raw_deg: f32,
    /// The front edge (width) from Z, degrees.
    pub front_deg: f32,
    /// Unit vector along the side edge, (X, Z).
    pub length_axis: [f32; 2],
    /// Unit vector along the front edge, (X, Z).
    pub width_axis: [f32; 2],
    /// Unit vector along the side edge, (north, east).
    pub length_axis_ne: [f32; 2],
    /// Unit vector along the front edge, (north, east).
    pub width_axis_ne: [f32; 2],
}

/// The middle of the base in the pose's north and east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Center {
    /// North, m.
    pub north: Length,
    /// East, m.
    pub east: Length,
    /// Covariance of the two, m².
    pub covariance_m2: f32,
}

/// Of an obstacle that moves and is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Velocity {
    /// North, m/s.
    pub north_m_s: f32,
    /// East, m/s.
    pub east_m_s: f32,
    /// One sigma, m/s.
    pub north_sd_m_s: f32,
    /// One sigma, m/s.
    pub east_sd_m_s: f32,
}

/// The estimate after an image. A quantity that is not valid is `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// What became of the image.
    pub status: Status,
    /// Behind this estimate; `None`: nothing is solved.
    pub method: Option<Method>,
    /// The shape behind position and sizes; `None`: nothing is solved.
    pub model: Option<Model>,
    /// Solved from the latest image; otherwise stale: the last good answer.
    pub fresh: bool,
    /// Its sigmas may be too small: widen the margins, never drop a warning.
    pub suspect: bool,
    /// Why; [`Reason::Late`] also if it is not suspect.
    pub reason: Option<Reason>,
    /// Images behind the answer.
    pub images_used: u16,
    /// Since the image of the last solution, s; 0 if fresh or none; at most 4000.
    pub age_s: f32,
    /// Where the obstacle is.
    pub position: Option<Position>,
    /// Disc: diameter; line, box: the front edge.
    pub width: Option<Length>,
    /// The side edge.
    pub length: Option<Length>,
    /// Top above ground.
    pub height: Option<Length>,
    /// Orientation.
    pub orientation: Option<Orientation>,
    /// The middle of its base.
    pub center: Option<Center>,
    /// If it moves and is followed.
    pub velocity: Option<Velocity>,
    /// Of Z, clockwise from north, degrees, ±180; from the track's first image on.
    pub trajectory_heading_deg: f32,
    /// What the poses are late by against the images, s; negative: early. It is taken off. 0: nothing is known.
    pub latency_s: f32,
    /// Its one sigma, s.
    pub latency_sd_s: f32,
    /// Normalized innovation squared of the latest image. Filter method.
    pub nis: f32,
    /// Its expectation: the rows that made it; 0: none.
    pub nis_rows: u16,
    /// Running mean of `nis / nis_rows`: 1 is what the settings predict. Filter method.
    pub nis_ratio: f32,
}

fn length(m: f32, sd_m: f32) -> Length {
    Length { m, sd_m }
}

fn count(number: core::ffi::c_int) -> u16 {
    u16::try_from(number).unwrap_or(0)
}

impl Estimate {
    pub(crate) fn of(status: ffi::goe_status_t, c: &ffi::goe_estimate_t) -> Self {
        let has = |bit: core::ffi::c_uint| c.valid & bit != 0;
        let sd = &c.sigma;
        Self {
            status: Status::of(status),
            method: Method::of(c.method),
            model: Model::of(c.model),
            fresh: c.fresh,
            suspect: c.suspect,
            reason: Reason::of(c.reason),
            images_used: count(c.images_used),
            age_s: c.age_s,
            position: has(ffi::GOE_HAS_POSITION).then(|| Position {
                x0: length(c.x0_m, sd.x0_m),
                z0: length(c.z0_m, sd.z0_m),
                x: length(c.x_m, sd.x_m),
                z: length(c.z_m, sd.z_m),
                residual: c.residual,
                baseline_m: c.baseline_m,
            }),
            width: has(ffi::GOE_HAS_WIDTH).then(|| length(c.width_m, sd.width_m)),
            length: has(ffi::GOE_HAS_LENGTH).then(|| length(c.length_m, sd.length_m)),
            height: has(ffi::GOE_HAS_HEIGHT).then(|| length(c.height_m, sd.height_m)),
            orientation: has(ffi::GOE_HAS_ORIENTATION).then_some(Orientation {
                side_deg: c.orientation_deg,
                side_sd_deg: sd.orientation_deg,
                side_raw_deg: c.orientation_raw_deg,
                front_deg: c.front_orientation_deg,
                length_axis: c.length_axis,
                width_axis: c.width_axis,
                length_axis_ne: c.length_axis_ne,
                width_axis_ne: c.width_axis_ne,
            }),
            center: has(ffi::GOE_HAS_CENTER).then(|| Center {
                north: length(c.center_north_m, sd.center_north_m),
                east: length(c.center_east_m, sd.center_east_m),
                covariance_m2: c.center_ne_m2,
            }),
            velocity: has(ffi::GOE_HAS_VELOCITY).then_some(Velocity {
                north_m_s: c.velocity_north_m_s,
                east_m_s: c.velocity_east_m_s,
                north_sd_m_s: sd.velocity_north_m_s,
                east_sd_m_s: sd.velocity_east_m_s,
            }),
            trajectory_heading_deg: c.trajectory_heading_deg,
            latency_s: c.latency_s,
            latency_sd_s: sd.latency_s,
            nis: c.nis,
            nis_rows: count(c.nis_rows),
            nis_ratio: c.nis_ratio,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_called_as_in_c() {
        for code in 1..=6 {
            let reason = Reason::of(code).expect("a reason of C");
            // SAFETY: a string constant of the library.
            let name = unsafe { core::ffi::CStr::from_ptr(ffi::goe_reason_text(code)) };
            assert_eq!(format!("{reason}"), name.to_str().expect("plain text"));
        }
        assert!(Reason::of(0).is_none() && Reason::of(7).is_none());
    }
}
