/* Text of `goe status`. SPDX-License-Identifier: MIT */
#include "GoeText.hpp"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "GoeParameters.hpp"

namespace {

constexpr float DEG_PER_RAD = 57.29577951f;
constexpr float PER_CENT = 100.f;
constexpr unsigned LINES_OF_STATE = 6;
constexpr unsigned LINES_OF_OBSTACLE = 2;

const char *yes(bool is) { return is ? "alive" : "DEAD"; }

double number(float value) { return static_cast<double>(value); }

bool is_known(float value) { return !__builtin_isnan(value); }

float own_distance_m(const GoeOverview &o, const goe_obstacle_s &obstacle) {
    const float north_m = obstacle.nearest[0] - o.north_m;
    const float east_m = obstacle.nearest[1] - o.east_m;
    return sqrtf(north_m * north_m + east_m * east_m);
}

float bearing_deg(const GoeOverview &o, const goe_obstacle_s &obstacle) {
    const float deg = DEG_PER_RAD * atan2f(obstacle.east - o.east_m, obstacle.north - o.north_m);
    return deg < 0.f ? deg + 360.f : deg;
}

/* One sigma of the middle, as a circle. */
float place_sd_m(const goe_obstacle_s &obstacle) {
    return sqrtf(0.5f * (obstacle.covariance[0] + obstacle.covariance[2]));
}

void report_settings(const GoeOverview &o, char *line) {
    const goe_status_s &s = o.status;
    if (!s.settings_in_use) {
        snprintf(line, GOE_TEXT_LINE, "settings   NOT IN USE, the module does nothing: %s is out of range or not set",
                 o.bad_field != nullptr ? goe_text_parameter(o.bad_field) : "a parameter");
    } else if (o.bad_field != nullptr) {
        snprintf(line, GOE_TEXT_LINE, "settings   previous ones in use: %s is out of range",
                 goe_text_parameter(o.bad_field));
    } else {
        snprintf(line, GOE_TEXT_LINE, "settings   in use%s",
                 s.settings_waiting
                     ? "; changes wait until no obstacle is tracked and no order is active, or until disarming"
                     : "");
    }
}

void report_detector(const goe_status_s &s, char *line) {
    if (is_known(s.delay_mean)) {
        snprintf(line, GOE_TEXT_LINE,
                 "detector   %s, %.1f images/s, %.0f ms from exposure to processing (at most %.0f)",
                 yes(s.detector_alive), number(s.image_rate), number(s.delay_mean), number(s.delay_max));
    } else {
        snprintf(line, GOE_TEXT_LINE, "detector   %s, no image in the last second", yes(s.detector_alive));
    }
}

void report_images(const goe_status_s &s, char *line) {
    snprintf(line, GOE_TEXT_LINE,
             "images     %u accepted, %u too late, %u dropped (no pose or queue full), %u refused, %u with a low score",
             s.taken, s.late_images, s.overdue, s.refused, s.weak);
}

void report_tracks(const goe_status_s &s, char *line) {
    const bool nothing = s.obstacles == 0;
    snprintf(line, GOE_TEXT_LINE,
             "obstacles  %s%u of %d, %u without a position; resets that ended tracks: %u, detections without slot: %u",
             nothing && !(s.detector_alive && s.pose_alive && s.unplaced == 0) ? "NOT KNOWN, " : "", s.obstacles,
             GOE_FLIGHT_SLOTS, s.unplaced, s.lost, s.full);
}

const char *phase_text(uint8_t phase) {
    switch (phase) {
        case GOE_FLIGHT_APPROACH:
            return "; on approach";
        case GOE_FLIGHT_FLARE:
            return "; in the flare";
        case GOE_FLIGHT_LANDED:
            return "; on the ground";
        default:
            return "";
    }
}

void report_order(const GoeOverview &o, char *line) {
    const goe_status_s &s = o.status;
    const char *const who = s.overruled ? ", overruled" : s.flown ? ", sent to PX4" : ", reported only";
    if (s.action == goe_status_s::ACTION_NONE) {
        snprintf(line, GOE_TEXT_LINE, "order      none%s%s", o.react == 0 ? "; GOE_REACT is 0: PX4 flies no order" : "",
                 phase_text(o.phase));
    } else {
        snprintf(line, GOE_TEXT_LINE, "order      %s%s%s, needs %.1f s",
                 goe_flight_action_text(static_cast<goe_flight_action_t>(s.action)), who, s.late ? ", LATE" : "",
                 number(s.needed));
    }
}

void report_place(const GoeOverview &o, const goe_obstacle_s &obstacle, char *line) {
    char size[40] = "";
    int used = 0;
    if (is_known(obstacle.width)) {
        used = snprintf(size, sizeof size, ", %.1f m wide", number(obstacle.width));
    }
    if (is_known(obstacle.height)) {
        snprintf(size + used, sizeof size - static_cast<size_t>(used), ", %.1f m high", number(obstacle.height));
    }
    snprintf(line, GOE_TEXT_LINE, " %u id %-5lu %.0f m at %03.0f deg, +- %.1f m%s%s%s", obstacle.slot,
             static_cast<unsigned long>(obstacle.id), number(own_distance_m(o, obstacle)),
             number(bearing_deg(o, obstacle)), number(place_sd_m(obstacle)), size,
             obstacle.in_view ? ", in view" : ", not in view", obstacle.suspect ? ", SUSPECT" : "");
}

void report_hazard(const goe_obstacle_s &obstacle, char *line) {
    char over[32] = "";
    if (is_known(obstacle.clearance)) {
        snprintf(over, sizeof over, ", %.0f m %s its top", number(fabsf(obstacle.clearance)),
                 obstacle.clearance < 0.f ? "below" : "over");
    }
    if (!is_known(obstacle.dcpa)) {
        snprintf(line, GOE_TEXT_LINE, "     hazard not known");
    } else if (obstacle.receding) {
        snprintf(line, GOE_TEXT_LINE, "     passed: its distance grows");
    } else {
        snprintf(line, GOE_TEXT_LINE,
                 "     closest approach in %.1f +- %.1f s: distance %.0f m%s; conflict probability %.0f %%%s",
                 number(obstacle.tcpa), number(obstacle.tcpa_sd), number(obstacle.dcpa), over,
                 number(PER_CENT * obstacle.conflict_probability), obstacle.worst ? ", worst" : "");
    }
}

void report_arithmetic(const goe_status_s &s, char *line) {
    snprintf(line, GOE_TEXT_LINE, "arithmetic %s (self-check 0x%02x)",
             s.self_check == 0 ? "correct, bit-identical to other targets" : "NOT bit-identical to other targets",
             s.self_check);
}

void report_state(const GoeOverview &o, unsigned number_of_line, char *line) {
    switch (number_of_line) {
        case 0:
            report_arithmetic(o.status, line);
            break;
        case 1:
            report_settings(o, line);
            break;
        case 2:
            snprintf(line, GOE_TEXT_LINE, "pose       %s%s%s, corrected jumps of PX4's filter: %u",
                     yes(o.status.pose_alive), o.status.pose_agrees ? "" : ", velocity contradicts position",
                     o.status.dead_reckoning ? ", by dead reckoning" : "", o.status.resets);
            break;
        case 3:
            report_detector(o.status, line);
            break;
        case 4:
            report_images(o.status, line);
            break;
        default:
            report_order(o, line);
            break;
    }
}

} // namespace

const char *goe_text_parameter(const char *setting) {
    static const char *const names[][2] = {
        {"camera.width_px", "GOE_CAM_W"},
        {"camera.height_px", "GOE_CAM_H"},
        {"camera.fx_px", "GOE_CAM_FX"},
        {"camera.fy_px", "GOE_CAM_FY"},
        {"camera.cx_px", "GOE_CAM_CX"},
        {"camera.cy_px", "GOE_CAM_CY"},
        {"camera.k1", "GOE_CAM_K1"},
        {"camera.k2", "GOE_CAM_K2"},
        {"camera.k3", "GOE_CAM_K3"},
        {"camera.p1", "GOE_CAM_P1"},
        {"camera.p2", "GOE_CAM_P2"},
        {"camera.mount_yaw_deg", "GOE_CAM_YAW"},
        {"camera.mount_pitch_deg", "GOE_CAM_PITCH"},
        {"camera.mount_roll_deg", "GOE_CAM_ROLL"},
        {"camera.offset_m[0]", "GOE_CAM_X"},
        {"camera.offset_m[1]", "GOE_CAM_Y"},
        {"camera.offset_m[2]", "GOE_CAM_Z"},
        {"navigation.terrain_height_sd_m", "GOE_GROUND_SD"},
        {"delay_s", "GOE_DELAY"},
        {"home_sd_m", "GOE_HOME_SD"},
        {"margin_m", "GOE_MARGIN"},
        {"clearance_m", "GOE_CLEAR"},
        {"bank_deg", "FW_R_LIM"},
        {"climb_m_s", "FW_T_CLMB_MAX"},
        {"loiter_m", "NAV_LOITER_RAD"},
    };
    for (const auto &name : names) {
        if (strcmp(name[0], setting) == 0) {
            return name[1];
        }
    }
    return setting;
}

bool goe_text_status(const GoeOverview &overview, unsigned number_of_line, char line[GOE_TEXT_LINE]) {
    line[0] = '\0';
    if (number_of_line < LINES_OF_STATE) {
        report_state(overview, number_of_line, line);
        return true;
    }
    const unsigned rest = number_of_line - LINES_OF_STATE;
    if (rest == 0) {
        report_tracks(overview.status, line);
        return true;
    }
    const unsigned index = (rest - 1u) / LINES_OF_OBSTACLE;
    if (index >= overview.obstacles || index >= GOE_FLIGHT_SLOTS) {
        return false;
    }
    if ((rest - 1u) % LINES_OF_OBSTACLE == 0u) {
        report_place(overview, overview.obstacle[index], line);
    } else {
        report_hazard(overview.obstacle[index], line);
    }
    return true;
}
