//! What the estimator is given with each image.

use crate::estimate::Length;
use crate::ffi;

/// Where the aircraft was at the time of exposure, not when the image arrived.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Any origin, microseconds; strictly increasing; `i64::MIN` is refused.
    pub time_us: i64,
    /// The vehicle's reference point in north, east, down, m; each ±1e6.
    pub position_ned_m: [f32; 3],
    /// Of the camera above the ground at the obstacle, m; ±1e5.
    pub height_m: f32,
    /// Quaternion w, x, y, z that turns body (forward, right, down) into north, east, down; refused if its norm is off 1 by over
    /// 1 %.
    pub attitude: [f32; 4],
    /// Counts the resets of the autopilot's filter; any start, wraps.
    pub reset_count: u8,
    /// By what the position jumped with them, new minus old, summed over all resets since the last image that was taken, m; each
    /// ±1e6. `None`: not known; then a change of `reset_count` starts a new track.
    pub reset_delta_ned_m: Option<[f32; 3]>,
}

impl Default for Pose {
    /// Level, at the origin, at time 0.
    fn default() -> Self {
        Self {
            time_us: 0,
            position_ned_m: [0.0; 3],
            height_m: 0.0,
            attitude: [1.0, 0.0, 0.0, 0.0],
            reset_count: 0,
            reset_delta_ned_m: None,
        }
    }
}

/// A point of the raw image; each ±1e5.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// From the left, px.
    pub u_px: f32,
    /// From the top, px.
    pub v_px: f32,
}

/// A detector's upright box in the raw image; each ±1e5. `None`: that side is cut, hidden or unreliable.
///
/// Feed raw detections: a tracker's smoothed boxes lag, which no sigma knows of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BoundingBox {
    /// Left side, px.
    pub left_px: Option<f32>,
    /// Top side, px.
    pub top_px: Option<f32>,
    /// Right side, px; right of the left one.
    pub right_px: Option<f32>,
    /// Bottom side, px; below the top one.
    pub bottom_px: Option<f32>,
}

impl BoundingBox {
    /// A box with all four sides visible, px.
    #[must_use]
    pub fn new(left_px: f32, top_px: f32, right_px: f32, bottom_px: f32) -> Self {
        Self {
            left_px: Some(left_px),
            top_px: Some(top_px),
            right_px: Some(right_px),
            bottom_px: Some(bottom_px),
        }
    }

    pub(crate) fn to_c(self) -> ffi::goe_box_t {
        let bit = |side: Option<f32>, bit: u8| if side.is_some() { bit } else { 0 };
        ffi::goe_box_t {
            left_px: self.left_px.unwrap_or(0.0),
            top_px: self.top_px.unwrap_or(0.0),
            right_px: self.right_px.unwrap_or(0.0),
            bottom_px: self.bottom_px.unwrap_or(0.0),
            sides: bit(self.left_px, ffi::GOE_SIDE_LEFT)
                | bit(self.top_px, ffi::GOE_SIDE_TOP)
                | bit(self.right_px, ffi::GOE_SIDE_RIGHT)
                | bit(self.bottom_px, ffi::GOE_SIDE_BOTTOM),
        }
    }
}

/// This image's own errors, one sigma each, instead of those of the settings; `None`: as in the settings. Filter method.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImageNoise {
    /// Instead of [`Navigation::attitude_white_sd_deg`](crate::Navigation::attitude_white_sd_deg), degrees; up to 30. A late pose belongs
    /// here: 20 ms at 24 degrees a second are 0.5 degrees.
    pub attitude_sd_deg: Option<f32>,
    /// Instead of [`Navigation::height_bias_sd_m`](crate::Navigation::height_bias_sd_m), m; up to 1e3.
    pub height_sd_m: Option<f32>,
    /// Instead of the detector's `point_noise_px` and `box_noise_px`, px; up to 100.
    pub pixel_sd_px: Option<f32>,
}

/// What the detector's class says of the obstacle's shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum KindShape {
    /// As the settings have it.
    #[default]
    Unknown,
    /// An upright cylinder: as with [`Shape::Disc`](crate::Shape::Disc) of the settings.
    Round,
    /// None, also with that setting.
    Other,
}

/// What the detector's class says of the obstacle; `None`: unknown. Filter method. A class that the images contradict is not used any
/// more, and the estimate's reason is [`Reason::Shape`](crate::Reason::Shape).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Kind {
    /// Width of the silhouette, from any side, up to 1e3 m; its sigma at least 1 % of it.
    pub width: Option<Length>,
    /// Height, up to 1e3 m; its sigma at least 1 % of it.
    pub height: Option<Length>,
    /// Whether it is round.
    pub shape: KindShape,
}

impl Kind {
    pub(crate) fn to_c(self) -> ffi::goe_kind_t {
        ffi::goe_kind_t {
            width_m: self.width.map_or(0.0, |width| width.m),
            width_sd_m: self.width.map_or(0.0, |width| width.sd_m),
            height_m: self.height.map_or(0.0, |height| height.m),
            height_sd_m: self.height.map_or(0.0, |height| height.sd_m),
            shape: match self.shape {
                KindShape::Unknown => ffi::GOE_KIND_UNKNOWN,
                KindShape::Round => ffi::GOE_KIND_ROUND,
                KindShape::Other => ffi::GOE_KIND_OTHER,
            },
        }
    }
}

/// One image of one obstacle: a box, or points, or both. Any subset may be visible; none: pass the image anyway.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Image {
    /// Where the aircraft was.
    pub pose: Pose,
    /// Leftmost point of the silhouette.
    pub left: Option<Pixel>,
    /// Rightmost point of the silhouette.
    pub right: Option<Pixel>,
    /// Point of the roof's edge over the nearest base corner; of a disc the nearest point of its upper rim.
    pub top: Option<Pixel>,
    /// Corner of the base on the ground, in image order.
    pub base_left: Option<Pixel>,
    /// The one between two visible faces; not visible with a single face.
    pub base_near: Option<Pixel>,
    /// The last in image order.
    pub base_right: Option<Pixel>,
    /// What detectors give. It replaces left, right and top, which are not read then.
    pub bounding_box: Option<BoundingBox>,
    /// This image's own errors.
    pub noise: ImageNoise,
    /// What the detector's class says of it.
    pub kind: Kind,
}

pub(crate) fn pixel_to_c(pixel: Option<Pixel>) -> ffi::goe_pixel_t {
    let at = pixel.unwrap_or_default();
    ffi::goe_pixel_t {
        u_px: at.u_px,
        v_px: at.v_px,
        visible: pixel.is_some(),
    }
}

impl Image {
    pub(crate) fn to_c(self) -> ffi::goe_image_t {
        ffi::goe_image_t {
            pose: ffi::goe_pose_t {
                time_us: self.pose.time_us,
                position_ned_m: self.pose.position_ned_m,
                height_m: self.pose.height_m,
                attitude: self.pose.attitude,
                reset_count: self.pose.reset_count,
                reset_delta_known: self.pose.reset_delta_ned_m.is_some(),
                reset_delta_ned_m: self.pose.reset_delta_ned_m.unwrap_or_default(),
            },
            left: pixel_to_c(self.left),
            right: pixel_to_c(self.right),
            top: pixel_to_c(self.top),
            base_left: pixel_to_c(self.base_left),
            base_near: pixel_to_c(self.base_near),
            base_right: pixel_to_c(self.base_right),
            box_: self.bounding_box.unwrap_or_default().to_c(),
            noise: ffi::goe_image_noise_t {
                attitude_sd_deg: self.noise.attitude_sd_deg.unwrap_or(0.0),
                height_sd_m: self.noise.height_sd_m.unwrap_or(0.0),
                pixel_sd_px: self.noise.pixel_sd_px.unwrap_or(0.0),
            },
            kind: self.kind.to_c(),
            camera: 0,
        }
    }
}
