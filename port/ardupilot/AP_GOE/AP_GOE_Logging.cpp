/* Log messages of AP_GOE. SPDX-License-Identifier: MIT */
#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include "AP_GOE.h"

#include <AP_HAL/AP_HAL.h>
#include <AP_Logger/AP_Logger.h>

// @LoggerMessage: GOEO
// @Description: Tracked obstacles with a position, ten times a second
// @Field: TimeUS: Time since system startup
// @Field: I: slot of the obstacle in the table
// @Field: Id: the detector's id of the obstacle; 0: no id
// @Field: N: middle of the base, north of the EKF's origin
// @Field: E: middle of the base, east of the EKF's origin
// @Field: D: ground at the obstacle, down from the EKF's origin
// @Field: R: radius of the circle around the middle that contains the outline
// @Field: W: width; 0: not known
// @Field: H: height of the top above the ground; 0: not known
// @Field: HSD: one sigma of the height
// @Field: NN: variance of the middle, north
// @Field: NE: covariance of the middle, north and east
// @Field: EE: variance of the middle, east
// @Field: Age: time since the obstacle was last measured
// @Field: Mdl: assumed shape: 2 disc, 3 line, 4 box, 5 prism
// @Field: Fl: bits: 1 suspect, 2 receding, 4 in view
void AP_GOE::log_obstacle(int slot, const goe_flight_obstacle_t &obstacle) const
{
#if HAL_LOGGING_ENABLED
    const unsigned flags = (obstacle.suspect ? GOE_MAVLINK_SUSPECT : 0U) |
                           (obstacle.receding ? GOE_MAVLINK_RECEDING : 0U) |
                           (obstacle.in_view ? GOE_MAVLINK_IN_VIEW : 0U);
    AP::logger().WriteStreaming(
        "GOEO", "TimeUS,I,Id,N,E,D,R,W,H,HSD,NN,NE,EE,Age,Mdl,Fl", "s#-mmmmmmm---s--", "F--0000000---0--",
        "QBIfffffffffffBB", AP_HAL::micros64(), unsigned(slot), obstacle.id, double(obstacle.center_ned_m[0]),
        double(obstacle.center_ned_m[1]), double(obstacle.center_ned_m[2]), double(obstacle.radius_m),
        double(obstacle.width_m), double(obstacle.height_m), double(obstacle.height_sd_m),
        double(obstacle.covariance_ne_m2[0]), double(obstacle.covariance_ne_m2[1]),
        double(obstacle.covariance_ne_m2[2]), double(obstacle.age_s), unsigned(obstacle.model), flags);
#endif
}

// @LoggerMessage: GOEH
// @Description: Hazard of an obstacle on the present course, ten times a second
// @Field: TimeUS: Time since system startup
// @Field: I: slot of the obstacle in the table
// @Field: TCPA: time to the closest point of approach
// @Field: TSD: one sigma of TCPA
// @Field: DCPA: horizontal distance to the outline at the closest point of approach
// @Field: DSD: one sigma of DCPA
// @Field: Clr: vertical distance over the top at the closest point of approach; 0: the top is not known
// @Field: CSD: one sigma of Clr
// @Field: CPrb: probability that both margin and clearance are violated
void AP_GOE::log_hazard(int slot, const goe_flight_obstacle_t &obstacle) const
{
#if HAL_LOGGING_ENABLED
    if (!obstacle.has_hazard) {
        return;
    }
    const goe_hazard_t &hazard = obstacle.hazard;
    AP::logger().WriteStreaming("GOEH", "TimeUS,I,TCPA,TSD,DCPA,DSD,Clr,CSD,CPrb", "s#ssmmmm-", "F-000000-",
                                "QBfffffff", AP_HAL::micros64(), unsigned(slot), double(hazard.tcpa_s),
                                double(hazard.tcpa_sd_s), double(hazard.dcpa_m), double(hazard.dcpa_sd_m),
                                double(hazard.clearance_m), double(hazard.clearance_sd_m),
                                double(hazard.conflict_probability));
#endif
}

// @LoggerMessage: GOEA
// @Description: Assessment of all obstacles, ten times a second, also with nothing in view
// @Field: TimeUS: Time since system startup
// @Field: Act: action: 0 none, 1 left, 2 right, 3 climb, 4 go around, 5 hold
// @Field: Wst: slot of the worst obstacle; -1: no known hazard
// @Field: Avd: slot of the obstacle that the action avoids; -1: none
// @Field: Ob: obstacles with a position
// @Field: Unp: least number of detected obstacles without a position; no action avoids them
// @Field: Fl: bits: 1 the action needs more time than is left, 2 the worst obstacle is suspect, 4 images arrive, 8 the pose arrives
void AP_GOE::log_assessment() const
{
#if HAL_LOGGING_ENABLED
    const goe_flight_assessment_t &now = _state->shown.assessment;
    const unsigned flags =
        (now.late ? 1U : 0U) | (now.suspect ? 2U : 0U) | (now.detector_alive ? 4U : 0U) | (now.pose_alive ? 8U : 0U);
    AP::logger().WriteStreaming("GOEA", "TimeUS,Act,Wst,Avd,Ob,Unp,Fl", "s------", "F------", "QBbbBBB",
                                AP_HAL::micros64(), unsigned(now.action), int(now.worst), int(now.avoided),
                                unsigned(now.obstacles), unsigned(now.unplaced), flags);
#endif
}

// @LoggerMessage: GOES
// @Description: State of the obstacle estimation, once a second, also with nothing in view
// @Field: TimeUS: Time since system startup
// @Field: Tkn: accepted messages of images
// @Field: Late: messages of images that arrived too late
// @Field: Erl: attempts to use a message before its pose arrived
// @Field: Ref: samples, messages or detections that were refused
// @Field: Weak: detections with too low a score
// @Field: Ren: tracks that took over a new id
// @Field: Evi: tracks that ended because a new obstacle took their slot
// @Field: Ful: confirmed detections that found no slot
// @Field: Rst: known jumps of the position estimate
// @Field: Lst: unknown resets and restarts; each of them ended all tracks
// @Field: Dly: mean delay from exposure to arrival
// @Field: DM: longest delay from exposure to arrival
// @Field: Ob: obstacles with a position
// @Field: Al: bits: 1 images arrive, 2 the pose arrives
// @Field: SC: result of goe_self_check(); 0: the arithmetic is bit-identical to that of other targets
void AP_GOE::log_status(const goe_mavlink_status_t &status) const
{
#if HAL_LOGGING_ENABLED
    AP::logger().WriteStreaming("GOES", "TimeUS,Tkn,Late,Erl,Ref,Weak,Ren,Evi,Ful,Rst,Lst,Dly,DM,Ob,Al,SC",
                                "s----------ss---", "F----------CC---", "QHHHHHHHHHHHHBBB", AP_HAL::micros64(),
                                status.taken, status.late, status.early, status.refused, status.weak, status.renumbered,
                                status.evicted, status.full, status.resets, status.lost, status.delay_mean,
                                status.delay_max, unsigned(status.obstacles), unsigned(status.alive),
                                unsigned(status.self_check));
#endif
}

#endif // AP_GOE_ENABLED
