//! What a planned flight will meet, and whether to act.

use core::mem::MaybeUninit;

use crate::ffi;
use crate::Length;

/// To fly on at constant velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Intent {
    /// Over the ground, north, east, down, m/s; each ±1e3.
    pub velocity_ned_m_s: [f32; 3],
    /// The outline of the obstacle must stay farther away than this, horizontally, m; 0 to 1e4.
    pub margin_m: f32,
    /// ... or its top must lie deeper than this below the aircraft, m; 0 to 1e4.
    pub clearance_m: f32,
    /// How long ago the latest image was taken, s; 0 to 1e3. Times count from now.
    pub since_image_s: f32,
    /// One sigma of the velocity, each axis, m/s; 0 to 100; 0: that of [`Navigation`](crate::Navigation).
    pub velocity_sd_m_s: f32,
}

/// When to act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DecisionRule {
    /// Act from this probability on that margin and clearance are both violated; 0 to 1; default 0.1.
    pub conflict_probability_max: f32,
    /// ... if the obstacle may be reached within this time, s; 0 to 1e4; default 12.
    pub act_within_s: f32,
    /// Times margin and clearance while the estimate is suspect; 1 to 100; default 1.5.
    pub suspect_factor: f32,
    /// Margin and clearance grow by this for each second without a new answer, m/s; 0 to 100; default 1.
    pub stale_growth_m_s: f32,
}

impl Default for DecisionRule {
    /// Those of the library.
    fn default() -> Self {
        let mut c = MaybeUninit::<ffi::goe_rule_t>::zeroed();
        // SAFETY: zeros are a goe_rule_t, which the call writes whole.
        let c = unsafe {
            ffi::goe_rule_default(c.as_mut_ptr());
            c.assume_init()
        };
        Self {
            conflict_probability_max: c.conflict_probability_max,
            act_within_s: c.act_within_s,
            suspect_factor: c.suspect_factor,
            stale_growth_m_s: c.stale_growth_m_s,
        }
    }
}

impl DecisionRule {
    pub(crate) fn to_c(self) -> ffi::goe_rule_t {
        ffi::goe_rule_t {
            conflict_probability_max: self.conflict_probability_max,
            act_within_s: self.act_within_s,
            suspect_factor: self.suspect_factor,
            stale_growth_m_s: self.stale_growth_m_s,
        }
    }
}

/// What the decision rule says. Only [`Decision::Clear`] ends an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[must_use]
pub enum Decision {
    /// There is no position, or too little is known to say, which does not make it safe: keep the previous decision.
    Unknown,
    /// No reason to act now.
    Clear,
    /// Go around, or avoid.
    Act,
    /// The intent or the rule was refused, or the memory is corrupted: keep the previous decision.
    Keep,
}

impl Decision {
    pub(crate) fn of(c: ffi::goe_decision_t) -> Self {
        match c {
            ffi::GOE_DECISION_UNKNOWN => Self::Unknown,
            ffi::GOE_DECISION_CLEAR => Self::Clear,
            ffi::GOE_DECISION_ACT => Self::Act,
            _ => Self::Keep,
        }
    }

    /// Whether to act after this decision, if `before` says whether that was so before it.
    #[must_use]
    pub fn acts(self, before: bool) -> bool {
        self == Self::Act || (before && self != Self::Clear)
    }
}

/// What will become of it. Sigmas are to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hazard {
    /// Until the distance to the obstacle's outline is smallest, or the path enters it, s; 0: the distance grows already.
    pub tcpa_s: f32,
    /// Its one sigma, s; 0 if the time is.
    pub tcpa_sd_s: f32,
    /// That distance; 0 m if the path crosses the outline.
    pub dcpa: Length,
    /// Camera above the top at that time, negative: below it; `None`: the height is not known.
    pub clearance: Option<Length>,
    /// Probability, 0 to 1, that margin and clearance are both violated; without a height: that the margin is.
    pub conflict_probability: f32,
}

impl Intent {
    pub(crate) fn to_c(self) -> ffi::goe_intent_t {
        ffi::goe_intent_t {
            velocity_ned_m_s: self.velocity_ned_m_s,
            margin_m: self.margin_m,
            clearance_m: self.clearance_m,
            since_image_s: self.since_image_s,
            velocity_sd_m_s: self.velocity_sd_m_s,
        }
    }
}

impl Hazard {
    /// The earliest time of the closest approach at two sigma, s.
    #[must_use]
    pub fn earliest_tcpa_s(&self) -> f32 {
        let c = ffi::goe_hazard_t {
            tcpa_s: self.tcpa_s,
            dcpa_m: 0.0,
            clearance_m: 0.0,
            tcpa_sd_s: self.tcpa_sd_s,
            dcpa_sd_m: 0.0,
            clearance_sd_m: 0.0,
            conflict_probability: 0.0,
            has_clearance: false,
        };
        // SAFETY: the call reads a hazard.
        unsafe { ffi::goe_earliest_tcpa_s(&c) }
    }

    pub(crate) fn of(c: &ffi::goe_hazard_t) -> Self {
        Self {
            tcpa_s: c.tcpa_s,
            tcpa_sd_s: c.tcpa_sd_s,
            dcpa: Length {
                m: c.dcpa_m,
                sd_m: c.dcpa_sd_m,
            },
            clearance: c.has_clearance.then_some(Length {
                m: c.clearance_m,
                sd_m: c.clearance_sd_m,
            }),
            conflict_probability: c.conflict_probability,
        }
    }
}
