//! Position, size and orientation of a ground obstacle, each with a 1-sigma uncertainty, from a detector's boxes or points and the
//! aircraft's own motion; and what a planned flight will meet. Over the C library goe, which this crate compiles.
//!
//! No heap, no `std`, nothing outside an [`Estimator`]. All lengths are meters, angles degrees, times as their names say; axes are
//! north, east, down; forward, right, down; and of the trajectory X right, Z ahead, level.
//!
//! ```
//! use goe::{BoundingBox, Estimator, Image, Pose, Settings};
//!
//! let mut tower = Estimator::new(&Settings::for_camera(914.0, 914.0, 640.0, 640.0, 1280.0, 1280.0))?;
//! for k in 0..10_i16 {
//!     let ahead_m = 200.0 - 2.0 * f32::from(k); // flying north, 15 m above the ground
//!     let box_px = |across_m: f32| 640.0 + 914.0 * across_m / ahead_m;
//!     let image = Image {
//!         pose: Pose {
//!             time_us: 125_000 * i64::from(k),
//!             position_ned_m: [2.0 * f32::from(k), 0.0, 0.0],
//!             height_m: 15.0,
//!             ..Pose::default()
//!         },
//!         bounding_box: Some(BoundingBox::new(box_px(-33.0), box_px(-15.0), box_px(-27.0), box_px(15.0))),
//!         ..Image::default()
//!     };
//!     let estimate = tower.update(&image).unwrap_or_else(|fault| fault.estimate);
//!     if let Some(position) = estimate.position {
//!         println!("{:.1} +- {:.1} m ahead", position.z.m, position.z.sd_m);
//!     }
//! }
//! # Ok::<(), goe::Error>(())
//! ```
//!
//! A fault of one image is an `Err`, and still carries the last good estimate: use an estimate by what of it is `Some`, by
//! [`fresh`](Estimate::fresh) and [`age_s`](Estimate::age_s), whatever the [`Status`]. "No position" does not mean "safe".
//!
//! The features `window`, `filter`, `hazard`, `target_motion` and `flight` are the parts of the library, all on by default; at least one of
//! `window` and `filter` is needed.
#![no_std]
#![deny(missing_docs)]
#![warn(clippy::undocumented_unsafe_blocks)]
// A fault carries the last good estimate, on purpose.
#![allow(clippy::result_large_err)]

#[cfg(test)]
#[macro_use]
extern crate std;

mod estimate;
mod estimator;
pub mod ffi;
#[cfg(feature = "flight")]
pub mod flight;
#[cfg(feature = "hazard")]
mod hazard;
mod image;
mod layout;
mod settings;
mod status;

pub use estimate::{Center, Estimate, Length, Model, Orientation, Position, Reason, Velocity};
pub use estimator::{Estimator, QUANTITIES};
#[cfg(feature = "hazard")]
pub use hazard::{Decision, DecisionRule, Hazard, Intent};
pub use image::{BoundingBox, Image, ImageNoise, Kind, KindShape, Pixel, Pose};
pub use settings::{Camera, Detector, FilterSettings, Method, Navigation, Settings, Shape, WindowSettings};
pub use status::{Error, Fault, Status};

/// What the arithmetic of this machine does with the library's code: 0 if it is the IEEE 754 single precision arithmetic that gives
/// the same bits everywhere, otherwise a sum of `GOE_SELF_...` of `goe.h`. Call it once at the start.
#[must_use]
pub fn self_check() -> u32 {
    // SAFETY: the call takes and touches nothing.
    unsafe { ffi::goe_self_check() }
}
