//! Sizes and offsets of what passes between Rust and C, bytes. Here Rust is held against them, in `build.rs` the C compiler, which reads
//! this file line by line: on every target for which the crate is built.

use core::mem::{offset_of, size_of};

use crate::ffi;

macro_rules! layout {
    ($($name:ident: $size:literal { $($field:ident: $offset:literal,)+ })+) => {
        $(
            const _: () = assert!(size_of::<ffi::$name>() == $size, stringify!($name));
            $(const _: () = assert!(offset_of!(ffi::$name, $field) == $offset, stringify!($name.$field));)+
        )+
    };
}
#[cfg(feature = "hazard")]
macro_rules! layout_hazard {
    ($($list:tt)+) => { layout! { $($list)+ } };
}
#[cfg(not(feature = "hazard"))]
macro_rules! layout_hazard {
    ($($list:tt)+) => {};
}
#[cfg(feature = "flight")]
macro_rules! layout_flight {
    ($($list:tt)+) => { layout! { $($list)+ } };
}
#[cfg(not(feature = "flight"))]
macro_rules! layout_flight {
    ($($list:tt)+) => {};
}
// With addresses in them.
#[cfg(target_pointer_width = "32")]
macro_rules! layout_flight_32 {
    ($($list:tt)+) => { layout_flight! { $($list)+ } };
}
#[cfg(not(target_pointer_width = "32"))]
macro_rules! layout_flight_32 {
    ($($list:tt)+) => {};
}
#[cfg(target_pointer_width = "64")]
macro_rules! layout_flight_64 {
    ($($list:tt)+) => { layout_flight! { $($list)+ } };
}
#[cfg(not(target_pointer_width = "64"))]
macro_rules! layout_flight_64 {
    ($($list:tt)+) => {};
}

layout! {
    goe_box_t: 20 {
        left_px: 0,
        top_px: 4,
        right_px: 8,
        bottom_px: 12,
        sides: 16,
    }
    goe_camera_t: 76 {
        fx_px: 0,
        fy_px: 4,
        cx_px: 8,
        cy_px: 12,
        k1: 16,
        k2: 20,
        p1: 24,
        p2: 28,
        k3: 32,
        mount_yaw_deg: 36,
        mount_pitch_deg: 40,
        mount_roll_deg: 44,
        offset_m: 48,
        width_px: 60,
        height_px: 64,
        border_rel: 68,
        truncation_rel: 72,
    }
    goe_detector_t: 32 {
        point_noise_px: 0,
        point_noise_rel: 4,
        point_correlation: 8,
        shape_error_rel: 12,
        box_noise_px: 16,
        box_noise_rel: 20,
        box_correlation_time_s: 24,
        truncation_noise_rel: 28,
    }
    goe_estimate_t: 200 {
        method: 0,
        model: 4,
        valid: 8,
        fresh: 12,
        suspect: 13,
        reason: 16,
        images_used: 20,
        age_s: 24,
        x0_m: 28,
        z0_m: 32,
        x_m: 36,
        z_m: 40,
        width_m: 44,
        length_m: 48,
        height_m: 52,
        orientation_deg: 56,
        orientation_raw_deg: 60,
        front_orientation_deg: 64,
        length_axis: 68,
        width_axis: 76,
        length_axis_ne: 84,
        width_axis_ne: 92,
        trajectory_heading_deg: 100,
        center_north_m: 104,
        center_east_m: 108,
        center_ne_m2: 112,
        velocity_north_m_s: 116,
        velocity_east_m_s: 120,
        latency_s: 124,
        residual: 128,
        baseline_m: 132,
        nis: 136,
        nis_rows: 140,
        nis_ratio: 144,
        sigma: 148,
    }
    goe_hazard_t: 32 {
        tcpa_s: 0,
        dcpa_m: 4,
        clearance_m: 8,
        tcpa_sd_s: 12,
        dcpa_sd_m: 16,
        clearance_sd_m: 20,
        conflict_probability: 24,
        has_clearance: 28,
    }
    goe_image_noise_t: 12 {
        attitude_sd_deg: 0,
        height_sd_m: 4,
        pixel_sd_px: 8,
    }
    goe_image_t: 184 {
        pose: 0,
        left: 56,
        right: 68,
        top: 80,
        base_left: 92,
        base_near: 104,
        base_right: 116,
        box_: 128,
        noise: 148,
        kind: 160,
        camera: 180,
    }
    goe_kind_t: 20 {
        width_m: 0,
        width_sd_m: 4,
        height_m: 8,
        height_sd_m: 12,
        shape: 16,
    }
    goe_navigation_t: 40 {
        attitude_bias_sd_deg: 0,
        attitude_white_sd_deg: 4,
        attitude_walk_sd_deg: 8,
        height_bias_sd_m: 12,
        position_walk_sd_m: 16,
        position_white_sd_m: 20,
        height_white_sd_m: 24,
        terrain_slope_sd: 28,
        terrain_height_sd_m: 32,
        velocity_bias_sd_m_s: 36,
    }
    goe_pixel_t: 12 {
        u_px: 0,
        v_px: 4,
        visible: 8,
    }
    goe_intent_t: 28 {
        velocity_ned_m_s: 0,
        margin_m: 12,
        clearance_m: 16,
        since_image_s: 20,
        velocity_sd_m_s: 24,
    }
    goe_pose_t: 56 {
        time_us: 0,
        position_ned_m: 8,
        height_m: 20,
        attitude: 24,
        reset_count: 40,
        reset_delta_known: 41,
        reset_delta_ned_m: 44,
    }
    goe_filter_settings_t: 24 {
        prior_width_m: 0,
        gate_sigma: 4,
        huber_sigma: 8,
        nis_ratio_max: 12,
        range_sd_rel_max: 16,
        top_is_highest: 20,
    }
    goe_settings_t: 216 {
        camera: 0,
        method: 76,
        model: 80,
        heading_auto: 84,
        heading_deg: 88,
        navigation: 92,
        detector: 132,
        window: 164,
        filter: 192,
    }
    goe_sigma_t: 52 {
        x0_m: 0,
        z0_m: 4,
        x_m: 8,
        z_m: 12,
        width_m: 16,
        length_m: 20,
        height_m: 24,
        orientation_deg: 28,
        center_north_m: 32,
        center_east_m: 36,
        velocity_north_m_s: 40,
        velocity_east_m_s: 44,
        latency_s: 48,
    }
    goe_window_settings_t: 28 {
        points: 0,
        line_points: 4,
        edge_min_px: 8,
        orientation_min_px: 12,
        side_min_px: 16,
        orientation_memory: 20,
        min_baseline_m: 24,
    }
}

layout_hazard! {
    goe_rule_t: 16 {
        conflict_probability_max: 0,
        act_within_s: 4,
        suspect_factor: 8,
        stale_growth_m_s: 12,
    }
}

layout_flight! {
    goe_flight_assessment_t: 80 {
        action: 0,
        late: 4,
        suspect: 5,
        detector_alive: 6,
        pose_agrees: 7,
        pose_alive: 8,
        worst: 9,
        avoided: 10,
        obstacles: 11,
        unplaced: 12,
        needed_s: 16,
        target_ned_m: 20,
        reason: 32,
        clear_m: 36,
        target_lat_e7: 40,
        target_lon_e7: 44,
        hazard: 48,
    }
    goe_flight_attitude_t: 24 {
        time_us: 0,
        q: 4,
        reset: 20,
    }
    goe_flight_counters_t: 20 {
        taken: 0,
        late: 2,
        early: 4,
        refused: 6,
        weak: 8,
        renumbered: 10,
        evicted: 12,
        full: 14,
        resets: 16,
        lost: 18,
    }
    goe_flight_detection_t: 124 {
        id: 0,
        score: 4,
        pixel_px: 8,
        box_: 12,
        left: 32,
        right: 44,
        top: 56,
        base_left: 68,
        base_near: 80,
        base_right: 92,
        kind: 104,
    }
    goe_flight_obstacle_t: 132 {
        id: 0,
        valid: 4,
        model: 8,
        suspect: 12,
        receding: 13,
        in_view: 14,
        has_hazard: 15,
        age_s: 16,
        center_ned_m: 20,
        covariance_ne_m2: 32,
        radius_m: 44,
        height_m: 48,
        height_sd_m: 52,
        width_m: 56,
        length_m: 60,
        length_heading_deg: 64,
        nearest_ned_m: 68,
        nearest_body_m: 80,
        lat_e7: 92,
        lon_e7: 96,
        hazard: 100,
    }
    goe_flight_position_t: 76 {
        time_us: 0,
        position_ned_m: 4,
        velocity_ned_m_s: 16,
        height_m: 28,
        height_valid: 40,
        origin_known: 41,
        origin_lat_e7: 44,
        origin_lon_e7: 48,
        reset_horizontal: 52,
        reset_vertical: 56,
        reset_delta_known: 60,
        reset_delta_ned_m: 64,
    }
    goe_flight_settings_t: 108 {
        score_min: 0,
        confirm_images: 4,
        detector_timeout_s: 8,
        track_timeout_s: 12,
        delay_s: 16,
        delay_sd_s: 20,
        delay_max_s: 24,
        resets: 28,
        range_finder_sd_m: 32,
        range_finder_max_m: 36,
        terrain_sd_m: 40,
        home_sd_m: 44,
        margin_m: 48,
        clearance_m: 52,
        conflict_probability_max: 56,
        suspect_factor: 60,
        stale_growth_m_s: 64,
        bank_deg: 68,
        roll_in_s: 72,
        climb_m_s: 76,
        climb_in_s: 80,
        loiter_m: 84,
        reserve_s: 88,
        confirm_s: 92,
        hold_s: 96,
        order_height_m: 100,
        order_speed_m_s: 104,
    }
}

layout_flight_32! {
    goe_flight_frame_t: 24 {
        arrival_us: 0,
        capture_us: 4,
        sent_us: 8,
        time_sd_us: 12,
        time_base: 16,
        camera: 17,
        number: 18,
        count: 19,
        detection: 20,
    }
}

layout_flight_64! {
    goe_flight_frame_t: 32 {
        arrival_us: 0,
        capture_us: 4,
        sent_us: 8,
        time_sd_us: 12,
        time_base: 16,
        camera: 17,
        number: 18,
        count: 19,
        detection: 24,
    }
}
