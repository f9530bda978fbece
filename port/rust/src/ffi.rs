//! The C interface as it is: `lib/goe.h` and `port/flight/goe_flight.h` are its manuals.
//!
//! Enumerations of C are integers here, so no number that C may return is undefined behavior. They have C's `int`: the
//! library is compiled with `-fno-short-enums`, also where the processor's ABI would make them shorter. `layout.rs` lists sizes and
//! offsets; both compilers compare them whenever the crate is built, and that of C the constants below.

#![allow(non_camel_case_types)]

use core::ffi::{c_char, c_int, c_uint};
use core::mem::MaybeUninit;

pub use crate::estimate::Sigma as goe_sigma_t;
pub use crate::settings::{
    Camera as goe_camera_t, Detector as goe_detector_t, FilterSettings as goe_filter_settings_t,
    Navigation as goe_navigation_t, WindowSettings as goe_window_settings_t,
};

/// Status of a call; negative: no new solution.
pub type goe_status_t = c_int;
/// A projection model.
pub type goe_model_t = c_uint;
/// A method.
pub type goe_method_t = c_uint;
/// Why an estimate is suspect.
pub type goe_reason_t = c_uint;
/// What the decision rule says.
pub type goe_decision_t = c_uint;

macro_rules! constants {
    ($($type:ty: $($name:ident = $value:expr),+ $(,)?;)+) => {
        $($(#[doc = concat!("`", stringify!($name), "` of C.")] pub const $name: $type = $value;)+)+
    };
}

constants! {
    goe_status_t: GOE_OK = 0, GOE_PARTIAL = 1, GOE_CONVERGING = 2, GOE_STALE = 3, GOE_NO_DETECTION = 4,
        GOE_BEHIND_CAMERA = -1, GOE_LENS_FAILED = -2, GOE_SWAPPED = -3, GOE_EDGE_ON = -4, GOE_NO_EDGE = -5,
        GOE_BAD_HEIGHT = -6, GOE_NO_BASELINE = -7, GOE_NO_PARALLAX = -8, GOE_ABEAM = -9, GOE_NOT_FINITE = -10,
        GOE_OUT_OF_RANGE = -11, GOE_BAD_TIME = -12, GOE_BAD_ATTITUDE = -13, GOE_BOX_INCOMPLETE = -14,
        GOE_NO_HEIGHT = -15, GOE_BAD_SETTINGS = -32, GOE_BAD_ARGUMENT = -33, GOE_NOT_INITIALIZED = -34,
        GOE_CORRUPTED = -35;
    goe_model_t: GOE_MODEL_NONE = 0, GOE_MODEL_AUTO = 1, GOE_MODEL_DISC = 2, GOE_MODEL_LINE = 3, GOE_MODEL_BOX = 4,
        GOE_MODEL_PRISM = 5;
    goe_method_t: GOE_METHOD_WINDOW = 1, GOE_METHOD_FILTER = 2;
    goe_reason_t: GOE_REASON_NONE = 0, GOE_REASON_CONVENTION = 1, GOE_REASON_MOVES = 2, GOE_REASON_BASE = 3,
        GOE_REASON_SHAPE = 4, GOE_REASON_LATE = 5, GOE_REASON_NOISE = 6;
    goe_decision_t: GOE_DECISION_UNKNOWN = 0, GOE_DECISION_CLEAR = 1, GOE_DECISION_ACT = 2, GOE_DECISION_KEEP = 3;
    u8: GOE_SIDE_LEFT = 1, GOE_SIDE_TOP = 2, GOE_SIDE_RIGHT = 4, GOE_SIDE_BOTTOM = 8,
        GOE_KIND_UNKNOWN = 0, GOE_KIND_ROUND = 1, GOE_KIND_OTHER = 2;
    c_uint: GOE_HAS_POSITION = 0x01, GOE_HAS_LENGTH = 0x02, GOE_HAS_HEIGHT = 0x04, GOE_HAS_ORIENTATION = 0x08,
        GOE_HAS_CENTER = 0x10, GOE_HAS_WIDTH = 0x20, GOE_HAS_VELOCITY = 0x40;
    usize: GOE_FAULT_COUNTS = 16, GOE_QUANTITIES = 6;
}

macro_rules! c_struct {
    ($($name:ident { $($field:ident: $type:ty),+ $(,)? })+) => {
        $(
            #[doc = concat!("`", stringify!($name), "` of C.")]
            #[repr(C)]
            #[derive(Clone, Copy, Debug)]
            pub struct $name {
                $(#[doc = concat!("`", stringify!($field), "` of C.")] pub $field: $type,)+
            }
        )+
    };
}

c_struct! {
    goe_settings_t {
        camera: goe_camera_t,
        method: goe_method_t,
        model: goe_model_t,
        heading_auto: bool,
        heading_deg: f32,
        navigation: goe_navigation_t,
        detector: goe_detector_t,
        window: goe_window_settings_t,
        filter: goe_filter_settings_t,
    }
    goe_pose_t {
        time_us: i64,
        position_ned_m: [f32; 3],
        height_m: f32,
        attitude: [f32; 4],
        reset_count: u8,
        reset_delta_known: bool,
        reset_delta_ned_m: [f32; 3],
    }
    goe_pixel_t { u_px: f32, v_px: f32, visible: bool }
    goe_box_t { left_px: f32, top_px: f32, right_px: f32, bottom_px: f32, sides: u8 }
    goe_image_noise_t { attitude_sd_deg: f32, height_sd_m: f32, pixel_sd_px: f32 }
    goe_kind_t { width_m: f32, width_sd_m: f32, height_m: f32, height_sd_m: f32, shape: u8 }
    goe_image_t {
        pose: goe_pose_t,
        left: goe_pixel_t,
        right: goe_pixel_t,
        top: goe_pixel_t,
        base_left: goe_pixel_t,
        base_near: goe_pixel_t,
        base_right: goe_pixel_t,
        box_: goe_box_t,
        noise: goe_image_noise_t,
        kind: goe_kind_t,
        camera: u8,
    }
    goe_estimate_t {
        method: goe_method_t,
        model: goe_model_t,
        valid: c_uint,
        fresh: bool,
        suspect: bool,
        reason: goe_reason_t,
        images_used: c_int,
        age_s: f32,
        x0_m: f32,
        z0_m: f32,
        x_m: f32,
        z_m: f32,
        width_m: f32,
        length_m: f32,
        height_m: f32,
        orientation_deg: f32,
        orientation_raw_deg: f32,
        front_orientation_deg: f32,
        length_axis: [f32; 2],
        width_axis: [f32; 2],
        length_axis_ne: [f32; 2],
        width_axis_ne: [f32; 2],
        trajectory_heading_deg: f32,
        center_north_m: f32,
        center_east_m: f32,
        center_ne_m2: f32,
        velocity_north_m_s: f32,
        velocity_east_m_s: f32,
        latency_s: f32,
        residual: f32,
        baseline_m: f32,
        nis: f32,
        nis_rows: c_int,
        nis_ratio: f32,
        sigma: goe_sigma_t,
    }
    goe_intent_t {
        velocity_ned_m_s: [f32; 3],
        margin_m: f32,
        clearance_m: f32,
        since_image_s: f32,
        velocity_sd_m_s: f32,
    }
    goe_rule_t { conflict_probability_max: f32, act_within_s: f32, suspect_factor: f32, stale_growth_m_s: f32 }
    goe_hazard_t {
        tcpa_s: f32,
        dcpa_m: f32,
        clearance_m: f32,
        tcpa_sd_s: f32,
        dcpa_sd_m: f32,
        clearance_sd_m: f32,
        conflict_probability: f32,
        has_clearance: bool,
    }
}

include!(concat!(env!("OUT_DIR"), "/bytes.rs"));

/// The estimator: memory of the caller's, private to C. It holds no addresses, so it may be moved and copied.
#[repr(C, align(8))]
#[derive(Clone, Copy)]
pub struct goe_estimator_t {
    private: [MaybeUninit<u8>; ESTIMATOR_BYTES],
}

extern "C" {
    /// Sets every field to its default.
    pub fn goe_settings_default(settings: *mut goe_settings_t);
    /// Checks settings, copies them, starts with an empty track.
    pub fn goe_init(
        estimator: *mut goe_estimator_t,
        estimator_size: usize,
        settings: *const goe_settings_t,
        bad_field: *mut *const c_char,
    ) -> goe_status_t;
    /// Takes one image and reports the estimate after it.
    pub fn goe_update(
        estimator: *mut goe_estimator_t,
        image: *const goe_image_t,
        estimate: *mut goe_estimate_t,
    ) -> goe_status_t;
    /// Covariance of the latest estimate: meters and degrees.
    pub fn goe_covariance(
        estimator: *const goe_estimator_t,
        covariance: *mut [[f32; GOE_QUANTITIES]; GOE_QUANTITIES],
    ) -> goe_status_t;
    /// Closest approach of a planned flight.
    #[cfg(feature = "hazard")]
    pub fn goe_hazard(
        estimator: *const goe_estimator_t,
        intent: *const goe_intent_t,
        hazard: *mut goe_hazard_t,
    ) -> goe_status_t;
    /// Sets a rule to its defaults.
    #[cfg(feature = "hazard")]
    pub fn goe_rule_default(rule: *mut goe_rule_t);
    /// Whether to act now.
    #[cfg(feature = "hazard")]
    pub fn goe_decide(
        estimator: *const goe_estimator_t,
        intent: *const goe_intent_t,
        rule: *const goe_rule_t,
        hazard: *mut goe_hazard_t,
    ) -> goe_decision_t;
    /// The earliest time of the closest approach at two sigma.
    #[cfg(feature = "hazard")]
    pub fn goe_earliest_tcpa_s(hazard: *const goe_hazard_t) -> f32;
    /// Forgets the track.
    pub fn goe_reset(estimator: *mut goe_estimator_t) -> goe_status_t;
    /// A short name for a status.
    pub fn goe_status_text(status: goe_status_t) -> *const c_char;
    /// A short name for a reason.
    pub fn goe_reason_text(reason: goe_reason_t) -> *const c_char;
    /// Faults of the arithmetic of this machine; 0: none.
    pub fn goe_self_check() -> c_uint;
    /// The counters of an estimator: `fault_counts` of `goe_estimator_t`. Of `shim.c`.
    pub fn goe_rust_fault_counts(estimator: *const goe_estimator_t) -> *const [u32; GOE_FAULT_COUNTS];
}

#[cfg(feature = "flight")]
pub use flight::*;

#[cfg(feature = "flight")]
mod flight {
    use super::*;

    pub use crate::flight::{Attitude as goe_flight_attitude_t, FlightSettings as goe_flight_settings_t};

    /// Status of a call of the flight layer; negative: nothing was taken.
    pub type goe_flight_status_t = c_int;
    /// What to do.
    pub type goe_flight_action_t = c_uint;
    /// Why it is this action.
    pub type goe_flight_reason_t = c_uint;

    constants! {
        goe_flight_status_t: GOE_FLIGHT_OK = 0, GOE_FLIGHT_TOO_NEW = 1, GOE_FLIGHT_TOO_OLD = -1, GOE_FLIGHT_NO_POSE = -2,
            GOE_FLIGHT_BAD_TIME = -3, GOE_FLIGHT_NOT_FINITE = -4, GOE_FLIGHT_OUT_OF_RANGE = -5,
            GOE_FLIGHT_BAD_ATTITUDE = -6, GOE_FLIGHT_NOTHING = -7, GOE_FLIGHT_BAD_SETTINGS = -32,
            GOE_FLIGHT_BAD_ARGUMENT = -33, GOE_FLIGHT_NOT_INITIALIZED = -34,
            GOE_FLIGHT_CORRUPTED = -35;
        goe_flight_action_t: GOE_FLIGHT_NONE = 0, GOE_FLIGHT_LEFT = 1, GOE_FLIGHT_RIGHT = 2, GOE_FLIGHT_CLIMB = 3,
            GOE_FLIGHT_GO_AROUND = 4, GOE_FLIGHT_HOLD = 5;
        goe_flight_reason_t: GOE_FLIGHT_REASON_NONE = 0, GOE_FLIGHT_REASON_CLEAR = 1, GOE_FLIGHT_REASON_LEAST_BAD = 2,
            GOE_FLIGHT_REASON_LOW = 3, GOE_FLIGHT_REASON_SLOW = 4, GOE_FLIGHT_REASON_LANDING = 5;
        u8: GOE_FLIGHT_AUTOPILOT_CLOCK = 0, GOE_FLIGHT_SENDER_CLOCK = 1, GOE_FLIGHT_AGE = 2,
            GOE_FLIGHT_FLYING = 0, GOE_FLIGHT_APPROACH = 1, GOE_FLIGHT_FLARE = 2, GOE_FLIGHT_LANDED = 3;
        usize: GOE_FLIGHT_SLOTS = 4, GOE_FLIGHT_DETECTIONS = 32, GOE_FLIGHT_SECTORS = 72, GOE_FLIGHT_HEIGHTS = 3;
        u16: GOE_FLIGHT_SECTOR_UNKNOWN = 65535;
    }

    c_struct! {
        goe_flight_position_t {
            time_us: u32,
            position_ned_m: [f32; 3],
            velocity_ned_m_s: [f32; 3],
            height_m: [f32; GOE_FLIGHT_HEIGHTS],
            height_valid: u8,
            origin_known: bool,
            origin_lat_e7: i32,
            origin_lon_e7: i32,
            reset_horizontal: u32,
            reset_vertical: u32,
            reset_delta_known: bool,
            reset_delta_ned_m: [f32; 3],
        }
        goe_flight_detection_t {
            id: u32,
            score: f32,
            pixel_px: f32,
            box_: goe_box_t,
            left: goe_pixel_t,
            right: goe_pixel_t,
            top: goe_pixel_t,
            base_left: goe_pixel_t,
            base_near: goe_pixel_t,
            base_right: goe_pixel_t,
            kind: goe_kind_t,
        }
        goe_flight_frame_t {
            arrival_us: u32,
            capture_us: u32,
            sent_us: u32,
            time_sd_us: u32,
            time_base: u8,
            camera: u8,
            number: u8,
            count: u8,
            detection: *const goe_flight_detection_t,
        }
        goe_flight_assessment_t {
            action: goe_flight_action_t,
            late: bool,
            suspect: bool,
            detector_alive: bool,
            pose_agrees: bool,
            pose_alive: bool,
            worst: i8,
            avoided: i8,
            obstacles: u8,
            unplaced: u8,
            needed_s: f32,
            target_ned_m: [f32; 3],
            reason: goe_flight_reason_t,
            clear_m: f32,
            target_lat_e7: i32,
            target_lon_e7: i32,
            hazard: goe_hazard_t,
        }
        goe_flight_obstacle_t {
            id: u32,
            valid: c_uint,
            model: goe_model_t,
            suspect: bool,
            receding: bool,
            in_view: bool,
            has_hazard: bool,
            age_s: f32,
            center_ned_m: [f32; 3],
            covariance_ne_m2: [f32; 3],
            radius_m: f32,
            height_m: f32,
            height_sd_m: f32,
            width_m: f32,
            length_m: f32,
            length_heading_deg: f32,
            nearest_ned_m: [f32; 3],
            nearest_body_m: [f32; 3],
            lat_e7: i32,
            lon_e7: i32,
            hazard: goe_hazard_t,
        }
    }

    pub use crate::flight::Counters as goe_flight_counters_t;

    /// The flight layer: memory of the caller's, private to C. It holds no addresses.
    #[repr(C, align(8))]
    #[derive(Clone, Copy)]
    pub struct goe_flight_t {
        private: [MaybeUninit<u8>; FLIGHT_BYTES],
    }

    extern "C" {
        /// Sets every field to its default.
        pub fn goe_flight_settings_default(settings: *mut goe_flight_settings_t);
        /// Checks both settings, copies them, starts with nothing known.
        pub fn goe_flight_init(
            flight: *mut goe_flight_t,
            flight_size: usize,
            estimator: *const goe_settings_t,
            settings: *const goe_flight_settings_t,
            bad_field: *mut *const c_char,
        ) -> goe_flight_status_t;
        /// Takes a sample of the attitude.
        pub fn goe_flight_attitude(
            flight: *mut goe_flight_t,
            sample: *const goe_flight_attitude_t,
        ) -> goe_flight_status_t;
        /// Takes a sample of the position.
        pub fn goe_flight_position(
            flight: *mut goe_flight_t,
            sample: *const goe_flight_position_t,
        ) -> goe_flight_status_t;
        /// The pose at a time.
        pub fn goe_flight_pose(
            flight: *const goe_flight_t,
            time_us: u32,
            time_sd_us: u32,
            pose: *mut goe_pose_t,
            attitude_sd_deg: *mut f32,
        ) -> goe_flight_status_t;
        /// The sender's clock from a two-way exchange.
        pub fn goe_flight_timesync(flight: *mut goe_flight_t, offset_us: u32, sd_us: u32) -> goe_flight_status_t;
        /// Takes an image's detections.
        pub fn goe_flight_frame(flight: *mut goe_flight_t, frame: *const goe_flight_frame_t) -> goe_flight_status_t;
        /// The hazards ahead from now on, and the reaction.
        pub fn goe_flight_assess(
            flight: *mut goe_flight_t,
            now_us: u32,
            phase: u8,
            result: *mut goe_flight_assessment_t,
        ) -> goe_flight_status_t;
        /// One obstacle.
        pub fn goe_flight_obstacle(
            flight: *const goe_flight_t,
            slot: c_int,
            obstacle: *mut goe_flight_obstacle_t,
        ) -> goe_flight_status_t;
        /// Nearest obstacle by bearing.
        pub fn goe_flight_sectors(
            flight: *const goe_flight_t,
            max_cm: u32,
            sector_cm: *mut [u16; GOE_FLIGHT_SECTORS],
        ) -> goe_flight_status_t;
        /// Changes the layer's settings in flight.
        pub fn goe_flight_change_settings(
            flight: *mut goe_flight_t,
            settings: *const goe_flight_settings_t,
            bad_field: *mut *const c_char,
        ) -> goe_flight_status_t;
        /// Forgets poses, clocks, obstacles and the reaction.
        pub fn goe_flight_restart(flight: *mut goe_flight_t) -> goe_flight_status_t;
        /// A short name for an action.
        pub fn goe_flight_action_text(action: goe_flight_action_t) -> *const c_char;
        /// The counters: `counters` of `goe_flight_t`. Of `shim.c`.
        pub fn goe_rust_counters(flight: *const goe_flight_t) -> *const goe_flight_counters_t;
    }
}
