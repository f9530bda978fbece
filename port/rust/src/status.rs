//! What became of an image or a call.

use core::fmt;

use crate::ffi;
use crate::Estimate;

macro_rules! statuses {
    ($($(#[$doc:meta])+ $name:ident = $code:ident,)+) => {
        /// What became of one image.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Status {
            $($(#[$doc])+ $name,)+
        }

        impl Status {
            /// All of them.
            #[cfg(test)]
            pub(crate) const ALL: &'static [Self] = &[$(Self::$name),+];

            pub(crate) fn of(code: ffi::goe_status_t) -> Self {
                match code {
                    $(ffi::$code => Self::$name,)+
                    // The crate compiles its own C: no other number comes. A later one would be an image that was refused.
                    _ => Self::OutOfRange,
                }
            }

            /// The number that C has for it; negative: a fault.
            #[must_use]
            pub fn code(self) -> i32 {
                match self {
                    $(Self::$name => ffi::$code,)+
                }
            }
        }
    };
}

statuses! {
    /// Solved from this image and those before it.
    Ok = GOE_OK,
    /// Solved, but a part of the image was refused or could not be used.
    Partial = GOE_PARTIAL,
    /// Image taken; no solution yet.
    Converging = GOE_CONVERGING,
    /// Image taken; it adds no point to the reported model, whose older solution stays.
    Stale = GOE_STALE,
    /// Image taken for its pose; no feature was visible.
    NoDetection = GOE_NO_DETECTION,
    /// Image taken; a ray points backwards or sideways.
    BehindCamera = GOE_BEHIND_CAMERA,
    /// Image taken; the lens model cannot be inverted at a pixel.
    LensFailed = GOE_LENS_FAILED,
    /// Image taken; left is not left of right.
    Swapped = GOE_SWAPPED,
    /// Image taken; the camera views the front edge from its end or from behind.
    EdgeOn = GOE_EDGE_ON,
    /// Image taken; no edge has a measurable orientation.
    NoEdge = GOE_NO_EDGE,
    /// Image taken; the camera's height above ground is not positive.
    BadHeight = GOE_BAD_HEIGHT,
    /// Image taken; the camera moved too little.
    NoBaseline = GOE_NO_BASELINE,
    /// Image taken; the picture does not grow as it must.
    NoParallax = GOE_NO_PARALLAX,
    /// Image taken; the solution lies abeam or behind.
    Abeam = GOE_ABEAM,
    /// Image refused: a NaN or an infinity.
    NotFinite = GOE_NOT_FINITE,
    /// Image refused: a number outside its range.
    OutOfRange = GOE_OUT_OF_RANGE,
    /// Image refused: its time is unknown, repeated or runs backwards.
    BadTime = GOE_BAD_TIME,
    /// Image refused: the quaternion's norm is off 1 by more than 1 %.
    BadAttitude = GOE_BAD_ATTITUDE,
    /// Image taken; fewer than two sides of the box can be used.
    BoxIncomplete = GOE_BOX_INCOMPLETE,
    /// Image taken; the height is exactly 0 with a box, as if it was not set.
    NoHeight = GOE_NO_HEIGHT,
    /// The estimator's memory is not what the library left there: nothing is known any more, which does not make it safe.
    Corrupted = GOE_CORRUPTED,
}

impl Status {
    /// No new solution came of this image, by a fault.
    #[must_use]
    pub fn is_fault(self) -> bool {
        self.code() < 0
    }

    /// The image was taken: the next ones build on it, whether or not it gave a solution.
    #[must_use]
    pub fn is_image_taken(self) -> bool {
        self.code() > ffi::GOE_NOT_FINITE
            || (self.code() < ffi::GOE_BAD_ATTITUDE && self.code() > ffi::GOE_BAD_SETTINGS)
    }
}

impl fmt::Display for Status {
    /// The library's short name: `no_baseline`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // SAFETY: the library returns a string constant of its own, never null.
        let name = unsafe { core::ffi::CStr::from_ptr(ffi::goe_status_text(self.code())) };
        f.write_str(name.to_str().unwrap_or("unknown"))
    }
}

/// An image that gave no new solution, by a fault. The estimate is the last good one, marked stale, or has nothing valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// The estimate after the image; its status is the fault.
    pub estimate: Estimate,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.estimate.status.fmt(f)
    }
}

impl core::error::Error for Fault {}

/// Why a call gave nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Error {
    /// A setting is outside its range; its name as C has it: `"camera.fx_px"`.
    BadSetting(&'static str),
    /// There is no position yet. Nothing is known of the obstacle, which does not make it safe.
    NoPosition,
    /// The estimator's memory is not what the library left there. Nothing is known any more, which does not make it safe.
    Corrupted,
    /// A number of the intent is a NaN or an infinity.
    NotFinite,
    /// A number of the intent is outside its range.
    OutOfRange,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BadSetting(field) => write!(f, "bad setting: {field}"),
            Self::NoPosition => f.write_str("no position yet"),
            Self::Corrupted => f.write_str("corrupted memory"),
            Self::NotFinite => f.write_str("a number is not finite"),
            Self::OutOfRange => f.write_str("a number is out of range"),
        }
    }
}

impl core::error::Error for Error {}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::String;

    #[test]
    fn every_status_has_its_own_code_and_name() {
        let names = Status::ALL.iter().map(|status| format!("{status}"));
        let names: std::collections::BTreeSet<String> = names.collect();
        assert_eq!(names.len(), Status::ALL.len());
        assert!(!names.contains("unknown"));
        for &status in Status::ALL {
            assert_eq!(Status::of(status.code()), status);
        }
    }

    #[test]
    fn faults_and_refusals() {
        assert!(!Status::NoDetection.is_fault());
        assert!(Status::NoBaseline.is_fault() && Status::NoBaseline.is_image_taken());
        assert!(Status::BadTime.is_fault() && !Status::BadTime.is_image_taken());
        assert!(Status::BoxIncomplete.is_fault() && Status::BoxIncomplete.is_image_taken());
        assert!(Status::NoHeight.is_image_taken() && !Status::BadAttitude.is_image_taken());
        assert!(!Status::NotFinite.is_image_taken() && !Status::Corrupted.is_image_taken());
        assert!(Status::Ok.is_image_taken());
    }
}
