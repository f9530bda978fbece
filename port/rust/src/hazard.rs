//! What a planned flight will meet.

use crate::ffi;
use crate::Length;

/// To fly on at constant velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plan {
    /// Over the ground, north, east, down, m/s; each ±1e3.
    pub velocity_ned_m_s: [f32; 3],
    /// The outline of the obstacle must stay farther away than this, horizontally, m; 0 to 1e4.
    pub margin_m: f32,
    /// ... or its top must lie deeper than this below the aircraft, m; 0 to 1e4.
    pub clearance_m: f32,
    /// How long ago the latest image was taken, s; 0 to 1e3. Times count from now.
    pub since_image_s: f32,
}

/// What will become of it. Sigmas are to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hazard {
    /// Until the distance to the obstacle's outline is smallest, or the path enters it, s; 0: the distance grows already.
    pub time_s: f32,
    /// Its one sigma, s; 0 if the time is.
    pub time_sd_s: f32,
    /// That distance; 0 m if the path crosses the outline.
    pub miss: Length,
    /// Camera above the top at that time, negative: below it; `None`: the height is not known.
    pub clearance: Option<Length>,
    /// Probability, 0 to 1, that margin and clearance are both violated; without a height: that the margin is.
    pub violation: f32,
}

impl Plan {
    pub(crate) fn to_c(self) -> ffi::goe_plan_t {
        ffi::goe_plan_t {
            velocity_ned_m_s: self.velocity_ned_m_s,
            margin_m: self.margin_m,
            clearance_m: self.clearance_m,
            since_image_s: self.since_image_s,
        }
    }
}

impl Hazard {
    pub(crate) fn of(c: &ffi::goe_hazard_t) -> Self {
        Self {
            time_s: c.time_s,
            time_sd_s: c.time_sd_s,
            miss: Length {
                m: c.miss_m,
                sd_m: c.miss_sd_m,
            },
            clearance: c.has_clearance.then_some(Length {
                m: c.clearance_m,
                sd_m: c.clearance_sd_m,
            }),
            violation: c.violation,
        }
    }
}
