/* Fields. SPDX-License-Identifier: MIT */
#include "fields.h"

#include "goe.h"

#define OF(field, decides) {#field, offsetof(goe_estimator_t, field), sizeof(((goe_estimator_t *)0)->field), decides}
#define NUMBER(field) OF(field, false),
#define DECIDES(field) OF(field, true),

/* clang-format off */
const field_t fields[] = {
    NUMBER(motion.time_us) NUMBER(motion.start_time_us) NUMBER(motion.heading_cos) NUMBER(motion.heading_sin)
    NUMBER(motion.origin_ne_m) NUMBER(motion.dx_m) NUMBER(motion.dz_m)
    NUMBER(motion.height_m) NUMBER(motion.height_jump_m) NUMBER(motion.ground_m) DECIDES(motion.detected) DECIDES(motion.reset_count)
    DECIDES(motion.stray) DECIDES(motion.marks) NUMBER(motion.undone) NUMBER(motion.rate_rad_s) NUMBER(motion.velocity_m_s) NUMBER(motion.rate_before_rad_s)
    NUMBER(motion.mark_attitude) NUMBER(motion.mark_m) NUMBER(motion.mark_us)
    NUMBER(fault_counts) DECIDES(ready) DECIDES(seal) DECIDES(camera_to_body) DECIDES(settings)
    DECIDES(estimate.method) DECIDES(estimate.model) DECIDES(estimate.valid) DECIDES(estimate.fresh)
    DECIDES(estimate.suspect) DECIDES(estimate.reason) DECIDES(estimate.images_used) NUMBER(estimate.age_s)
    NUMBER(estimate.x0_m) NUMBER(estimate.z0_m) NUMBER(estimate.x_m) NUMBER(estimate.z_m) NUMBER(estimate.width_m)
    NUMBER(estimate.length_m) NUMBER(estimate.height_m) NUMBER(estimate.orientation_deg)
    NUMBER(estimate.orientation_raw_deg) NUMBER(estimate.front_orientation_deg) NUMBER(estimate.length_axis)
    NUMBER(estimate.width_axis) NUMBER(estimate.length_axis_ne) NUMBER(estimate.width_axis_ne)
    NUMBER(estimate.trajectory_heading_deg) NUMBER(estimate.center_north_m) NUMBER(estimate.center_east_m)
    NUMBER(estimate.center_ne_m2) NUMBER(estimate.velocity_north_m_s) NUMBER(estimate.velocity_east_m_s)
    NUMBER(estimate.latency_s) NUMBER(estimate.residual) NUMBER(estimate.baseline_m) NUMBER(estimate.nis)
    DECIDES(estimate.nis_rows) NUMBER(estimate.nis_ratio) NUMBER(estimate.sigma) NUMBER(estimate_time_us)
    NUMBER(filter.time_us) DECIDES(filter.phase) DECIDES(filter.phase_images) DECIDES(filter.known)
    DECIDES(filter.paced) DECIDES(filter.naming) DECIDES(motion.camera) DECIDES(filter.has_datum)
    NUMBER(filter.faded_s) NUMBER(filter.used_s)
    NUMBER(filter.ground_scale)
    NUMBER(filter.walk_s) NUMBER(filter.due_s) NUMBER(filter.candidate.extent)
    DECIDES(filter.candidate.both) DECIDES(filter.candidate.agreeing)
    NUMBER(filter.health.nis) NUMBER(filter.health.mean_nis) NUMBER(filter.health.excess)
    NUMBER(filter.health.recent_nis) DECIDES(filter.health.nis_rows) DECIDES(filter.health.images)
    DECIDES(filter.health.refused) DECIDES(filter.health.poor) DECIDES(filter.health.failed)
    DECIDES(filter.health.base_refused) DECIDES(filter.health.adrift) DECIDES(filter.health.steady)
    NUMBER(filter.axes.start_time_us) NUMBER(filter.axes.turn_cos) NUMBER(filter.axes.turn_sin)
    NUMBER(filter.datum.start_m) NUMBER(filter.axes.start_dx_m) NUMBER(filter.axes.start_dz_m) NUMBER(filter.axes.start_velocity_m_s)
    NUMBER(filter.datum.ground_m) NUMBER(filter.datum.height_m) NUMBER(filter.datum.sd_m)
    NUMBER(filter.datum.mean_m) NUMBER(filter.datum.noise_m2) NUMBER(filter.datum.scatter_m2) NUMBER(filter.datum.first_m2) NUMBER(filter.datum.taken_m2)
    NUMBER(filter.datum.taken_mean_m) DECIDES(filter.health.heights) DECIDES(filter.boxes) NUMBER(filter.scatter.before)
    NUMBER(filter.scatter.products) NUMBER(filter.scatter.squares) DECIDES(filter.scatter.seen)
    NUMBER(filter.mover.augmented) NUMBER(filter.mover.nis) NUMBER(filter.mover.rows) NUMBER(filter.mover.observed_s)
    NUMBER(filter.mover.unlike_s) DECIDES(filter.mover.images) DECIDES(filter.mover.moves)
    DECIDES(filter.mover.followed) DECIDES(filter.mover.late) NUMBER(filter.side) NUMBER(filter.state)
    NUMBER(filter.root.element) NUMBER(filter.root.right) DECIDES(filter.root.estimated)
    NUMBER(window.orientation.filtered_deg) NUMBER(window.orientation.raw_deg)
    NUMBER(window.orientation.variance_deg2) DECIDES(window.orientation.count)
    NUMBER(window.length.value) DECIDES(window.length.next) DECIDES(window.length.count)
    NUMBER(window.height.value) DECIDES(window.height.next) DECIDES(window.height.count)
    NUMBER(window.disc.point) DECIDES(window.disc.next) DECIDES(window.disc.count)
    NUMBER(window.line.point) DECIDES(window.line.next) DECIDES(window.line.count)
    {"(between the fields)", 0, 0, false},
};
/* clang-format on */

const size_t field_count = sizeof fields / sizeof fields[0];

size_t field_at(size_t byte) {
    size_t found = field_count - 1u;
    for (size_t i = 0; i < field_count; i++) {
        if (byte >= fields[i].offset && byte - fields[i].offset < fields[i].bytes) {
            found = i;
        }
    }
    return found;
}
