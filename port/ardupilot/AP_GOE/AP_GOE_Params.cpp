/* Parameters of AP_GOE. Ranges and defaults are those of goe_settings_list.h and goe_flight_settings_list.h, but for
 * ATT_DRIFT. SPDX-License-Identifier: MIT */
#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include "AP_GOE.h"

const AP_Param::GroupInfo AP_GOE::var_info[] = {

    // @Param: ENABLE
    // @DisplayName: Obstacles from a camera
    // @Description: Takes the detections of a camera and finds where obstacles are and how big they are
    // @Values: 0:Disabled,1:Enabled
    // @User: Standard
    // @RebootRequired: True
    AP_GROUPINFO_FLAGS("ENABLE", 1, AP_GOE, _enable, 0, AP_PARAM_FLAG_ENABLE),

    // @Param: WIDTH
    // @DisplayName: Width of the camera's image
    // @Description: Width of the raw image in pixels. Must be set
    // @Range: 0 32767
    // @User: Standard
    AP_GROUPINFO("WIDTH", 2, AP_GOE, _width, 0),

    // @Param: HEIGHT
    // @DisplayName: Height of the camera's image
    // @Description: Height of the raw image in pixels. Must be set
    // @Range: 0 32767
    // @User: Standard
    AP_GROUPINFO("HEIGHT", 3, AP_GOE, _height, 0),

    // @Param: FX
    // @DisplayName: Focal length
    // @Description: Focal length along the image's width in pixels, from a calibration. Must be set. No image shows that it is wrong
    // @Range: 1 100000
    // @User: Standard
    AP_GROUPINFO("FX", 4, AP_GOE, _fx, 0.0f),

    // @Param: FY
    // @DisplayName: Focal length, vertical
    // @Description: Focal length along the image's height in pixels. 0: as FX
    // @Range: 0 100000
    // @User: Advanced
    AP_GROUPINFO("FY", 5, AP_GOE, _fy, 0.0f),

    // @Param: CX
    // @DisplayName: Principal point
    // @Description: Where the optical axis meets the image, pixels from its left side. 0: the middle
    // @Range: -100000 100000
    // @User: Advanced
    AP_GROUPINFO("CX", 6, AP_GOE, _cx, 0.0f),

    // @Param: CY
    // @DisplayName: Principal point, vertical
    // @Description: Where the optical axis meets the image, pixels from its top. 0: the middle
    // @Range: -100000 100000
    // @User: Advanced
    AP_GROUPINFO("CY", 7, AP_GOE, _cy, 0.0f),

    // @Param: K1
    // @DisplayName: Lens distortion, radial, first
    // @Description: First radial coefficient of the lens, order and meaning as in OpenCV
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("K1", 8, AP_GOE, _k1, 0.0f),

    // @Param: K2
    // @DisplayName: Lens distortion, radial, second
    // @Description: Second radial coefficient of the lens
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("K2", 9, AP_GOE, _k2, 0.0f),

    // @Param: P1
    // @DisplayName: Lens distortion, tangential, first
    // @Description: First tangential coefficient of the lens
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("P1", 10, AP_GOE, _p1, 0.0f),

    // @Param: P2
    // @DisplayName: Lens distortion, tangential, second
    // @Description: Second tangential coefficient of the lens
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("P2", 11, AP_GOE, _p2, 0.0f),

    // @Param: K3
    // @DisplayName: Lens distortion, radial, third
    // @Description: Third radial coefficient of the lens
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("K3", 12, AP_GOE, _k3, 0.0f),

    // @Param: YAW
    // @DisplayName: Camera's yaw
    // @Description: Mounting of the camera about body down, from forward; one that looks left has a negative yaw
    // @Units: deg
    // @Range: -360 360
    // @User: Standard
    AP_GROUPINFO("YAW", 13, AP_GOE, _yaw, 0.0f),

    // @Param: PITCH
    // @DisplayName: Camera's pitch
    // @Description: Mounting of the camera after its yaw, positive up
    // @Units: deg
    // @Range: -360 360
    // @User: Standard
    AP_GROUPINFO("PITCH", 14, AP_GOE, _pitch, 0.0f),

    // @Param: ROLL
    // @DisplayName: Camera's roll
    // @Description: Mounting of the camera about its own axis, after yaw and pitch
    // @Units: deg
    // @Range: -360 360
    // @User: Standard
    AP_GROUPINFO("ROLL", 15, AP_GOE, _roll, 0.0f),

    // @Param: POS_X
    // @DisplayName: Camera's place, forward
    // @Description: Camera relative to the point that INS_POS1_X and the like count from, body forward
    // @Units: m
    // @Range: -10000 10000
    // @User: Advanced
    AP_GROUPINFO("POS_X", 16, AP_GOE, _pos_x, 0.0f),

    // @Param: POS_Y
    // @DisplayName: Camera's place, right
    // @Description: Camera relative to the point that INS_POS1_X and the like count from, body right
    // @Units: m
    // @Range: -10000 10000
    // @User: Advanced
    AP_GROUPINFO("POS_Y", 17, AP_GOE, _pos_y, 0.0f),

    // @Param: POS_Z
    // @DisplayName: Camera's place, down
    // @Description: Camera relative to the point that INS_POS1_X and the like count from, body down
    // @Units: m
    // @Range: -10000 10000
    // @User: Advanced
    AP_GROUPINFO("POS_Z", 18, AP_GOE, _pos_z, 0.0f),

    // @Param: DELAY
    // @DisplayName: Least delay of the link
    // @Description: Least time from sending to arrival, for images whose time is not of this clock
    // @Units: s
    // @Range: 0 0.5
    // @User: Standard
    AP_GROUPINFO("DELAY", 19, AP_GOE, _delay, 0.005f),

    // @Param: DELAY_SD
    // @DisplayName: Uncertainty of the capture time
    // @Description: One sigma of the capture time of images whose sender tells none
    // @Units: s
    // @Range: 0 0.5
    // @User: Advanced
    AP_GROUPINFO("DELAY_SD", 20, AP_GOE, _delay_sd, 0.005f),

    // @Param: DELAY_MAX
    // @DisplayName: Longest delay of an image
    // @Description: An image that arrives later after its exposure is refused
    // @Units: s
    // @Range: 0.02 0.5
    // @User: Advanced
    AP_GROUPINFO("DELAY_MAX", 21, AP_GOE, _delay_max, 0.4f),

    // @Param: SCORE_MIN
    // @DisplayName: Least score
    // @Description: A detection of a lesser score is not looked at
    // @Range: 0 1
    // @User: Standard
    AP_GROUPINFO("SCORE_MIN", 22, AP_GOE, _score_min, 0.3f),

    // @Param: CONFIRM
    // @DisplayName: Images that confirm
    // @Description: Images that a new obstacle must be seen in before it is followed
    // @Range: 1 20
    // @User: Advanced
    AP_GROUPINFO("CONFIRM", 23, AP_GOE, _confirm, 3),

    // @Param: ALIVE
    // @DisplayName: Detector's timeout
    // @Description: Without an image for this long the detector counts as dead
    // @Units: s
    // @Range: 0.05 60
    // @User: Standard
    AP_GROUPINFO("ALIVE", 24, AP_GOE, _alive, 1.0f),

    // @Param: FORGET
    // @DisplayName: Time to forget
    // @Description: An obstacle that was not seen for this long is given up. The database then keeps it no longer than OA_DB_EXPIRE after it was last measured
    // @Units: s
    // @Range: 1 600
    // @User: Standard
    AP_GROUPINFO("FORGET", 25, AP_GOE, _forget, 10.0f),

    // @Param: RNG_SD
    // @DisplayName: Range finder's uncertainty
    // @Description: One sigma of the height above ground by a range finder that looks down
    // @Units: m
    // @Range: 0.001 100
    // @User: Advanced
    AP_GROUPINFO("RNG_SD", 26, AP_GOE, _rng_sd, 0.3f),

    // @Param: RNG_MAX
    // @DisplayName: Range finder's reach
    // @Description: Height up to which the range finder is believed
    // @Units: m
    // @Range: 0 1000
    // @User: Advanced
    AP_GROUPINFO("RNG_MAX", 27, AP_GOE, _rng_max, 40.0f),

    // @Param: TER_SD
    // @DisplayName: Terrain's uncertainty
    // @Description: One sigma of the height above ground by the terrain database
    // @Units: m
    // @Range: 0.001 1000
    // @User: Advanced
    AP_GROUPINFO("TER_SD", 28, AP_GOE, _ter_sd, 3.0f),

    // @Param: HOME_SD
    // @DisplayName: Home's uncertainty as ground
    // @Description: One sigma of the height above home as a height above the obstacle's ground
    // @Units: m
    // @Range: 0.001 1000
    // @User: Standard
    AP_GROUPINFO("HOME_SD", 29, AP_GOE, _home_sd, 5.0f),

    // @Param: MARGIN
    // @DisplayName: Margin
    // @Description: Horizontal distance to an obstacle's outline that is wanted; for warnings, not for the database
    // @Units: m
    // @Range: 0 1000
    // @User: Standard
    AP_GROUPINFO("MARGIN", 30, AP_GOE, _margin, 15.0f),

    // @Param: CLEAR
    // @DisplayName: Clearance
    // @Description: Height over an obstacle's top that is wanted; for warnings, not for the database
    // @Units: m
    // @Range: 0 1000
    // @User: Standard
    AP_GROUPINFO("CLEAR", 31, AP_GOE, _clear, 10.0f),

    // @Param: VIOL_MAX
    // @DisplayName: Probability that warns
    // @Description: Probability of violating margin and clearance both from which on there is a warning
    // @Range: 0.001 1
    // @User: Advanced
    AP_GROUPINFO("VIOL_MAX", 32, AP_GOE, _viol_max, 0.1f),

    // @Param: BANK
    // @DisplayName: Bank of an avoiding turn
    // @Description: What the vehicle can bank in a turn that avoids; with its speed it tells when a warning comes
    // @Units: deg
    // @Range: 5 70
    // @User: Standard
    AP_GROUPINFO("BANK", 33, AP_GOE, _bank, 30.0f),

    // @Param: ROLL_IN
    // @DisplayName: Time to turn
    // @Description: From the warning to that turn, the pilot's or the script's reaction included
    // @Units: s
    // @Range: 0 20
    // @User: Standard
    AP_GROUPINFO("ROLL_IN", 34, AP_GOE, _roll_in, 1.5f),

    // @Param: CLIMB
    // @DisplayName: Avoiding climb
    // @Description: What the vehicle can climb by
    // @Units: m/s
    // @Range: 0.1 50
    // @User: Standard
    AP_GROUPINFO("CLIMB", 35, AP_GOE, _climb, 2.5f),

    // @Param: CLIMB_IN
    // @DisplayName: Time to climb
    // @Description: From the warning to that climb
    // @Units: s
    // @Range: 0 20
    // @User: Advanced
    AP_GROUPINFO("CLIMB_IN", 36, AP_GOE, _climb_in, 2.0f),

    // @Param: LOITER
    // @DisplayName: Loiter radius
    // @Description: Radius of the circle that is flown about the target of a warning. 0: it is flown through
    // @Units: m
    // @Range: 0 10000
    // @User: Advanced
    AP_GROUPINFO("LOITER", 37, AP_GOE, _loiter, 0.0f),

    // @Param: RESERVE
    // @DisplayName: Reserve
    // @Description: A warning comes this much before its last moment
    // @Units: s
    // @Range: 0 60
    // @User: Standard
    AP_GROUPINFO("RESERVE", 38, AP_GOE, _reserve, 3.0f),

    // @Param: ATT_BIAS
    // @DisplayName: Constant error of the attitude
    // @Description: One sigma, the camera's mounting included
    // @Units: deg
    // @Range: 0.001 30
    // @User: Advanced
    AP_GROUPINFO("ATT_BIAS", 39, AP_GOE, _att_bias, 0.5f),

    // @Param: ATT_WHITE
    // @DisplayName: Error of the attitude that is new in each image
    // @Description: One sigma
    // @Units: deg
    // @Range: 0.0001 30
    // @User: Advanced
    AP_GROUPINFO("ATT_WHITE", 40, AP_GOE, _att_white, 0.1f),

    // @Param: ATT_DRIFT
    // @DisplayName: Drift of the attitude
    // @Description: Random walk of the attitude's error, degrees per square root of a second. The heading of EKF3 wanders by a degree or two after take-off; taken for constant, that makes obstacles narrow
    // @Range: 0 30
    // @User: Advanced
    AP_GROUPINFO("ATT_DRIFT", 41, AP_GOE, _att_drift, 0.3f),

    // @Param: VEL_BIAS
    // @DisplayName: Constant error of the velocity
    // @Description: One sigma of the own horizontal velocity, each axis
    // @Units: m/s
    // @Range: 0 100
    // @User: Advanced
    AP_GROUPINFO("VEL_BIAS", 42, AP_GOE, _vel_bias, 0.05f),

    // @Param: GND_SD
    // @DisplayName: Unevenness of the ground
    // @Description: How far the obstacle's ground may lie off that below the vehicle, one sigma
    // @Units: m
    // @Range: 0 1000
    // @User: Standard
    AP_GROUPINFO("GND_SD", 43, AP_GOE, _gnd_sd, 2.0f),

    // @Param: BOX_PX
    // @DisplayName: Error of a box that is new in each image
    // @Description: One sigma of each side in pixels
    // @Range: 0.05 100
    // @User: Advanced
    AP_GROUPINFO("BOX_PX", 44, AP_GOE, _box_px, 1.0f),

    // @Param: BOX_SHARE
    // @DisplayName: Error of a box that stays alike
    // @Description: One sigma of each side as a fraction of the box
    // @Range: 0 1
    // @User: Advanced
    AP_GROUPINFO("BOX_SHARE", 45, AP_GOE, _box_share, 0.07f),

    // @Param: BOX_TIME
    // @DisplayName: How long a box's error stays alike
    // @Description: Time constant
    // @Units: s
    // @Range: 0 100
    // @User: Advanced
    AP_GROUPINFO("BOX_TIME", 46, AP_GOE, _box_time, 1.2f),

    // @Param: OA_SIGMA
    // @DisplayName: Sigmas in the database
    // @Description: So many sigmas of the obstacle's place are added to its radius in the avoidance database, twice as many while the estimate is suspect. 0: the measured radius
    // @Range: 0 5
    // @User: Standard
    AP_GROUPINFO("OA_SIGMA", 47, AP_GOE, _oa_sigma, 0.0f),

    // @Param: REPORT_HZ
    // @DisplayName: Rate of messages
    // @Description: How often GOE_OBSTACLE and GOE_HAZARD are sent for each obstacle; with 0 neither these nor GOE_STATUS
    // @Units: Hz
    // @Range: 0 10
    // @User: Standard
    AP_GROUPINFO("REPORT_HZ", 48, AP_GOE, _report_hz, 1.0f),

    // @Param: OPTIONS
    // @DisplayName: Options
    // @Description: With bit 0 arming waits for images and pose. That no obstacle is in view never keeps from arming
    // @Bitmask: 0:Arm only with a camera that is alive
    // @User: Standard
    AP_GROUPINFO("OPTIONS", 49, AP_GOE, _options, 1),

    AP_GROUPEND};

static float or_else(float value, float otherwise) { return is_zero(value) ? otherwise : value; }

void AP_GOE::read_params(goe_settings_t &estimator, goe_flight_settings_t &layer) const
{
    memset(&estimator, 0, sizeof(estimator)); // settings are compared as bytes
    memset(&layer, 0, sizeof(layer));
    goe_settings_default(&estimator);
    goe_flight_settings_default(&layer);

    goe_camera_t &camera = estimator.camera;
    camera.width_px = _width.get();
    camera.height_px = _height.get();
    camera.fx_px = _fx;
    camera.fy_px = or_else(_fy, _fx);
    camera.cx_px = or_else(_cx, 0.5f * camera.width_px);
    camera.cy_px = or_else(_cy, 0.5f * camera.height_px);
    camera.k1 = _k1;
    camera.k2 = _k2;
    camera.p1 = _p1;
    camera.p2 = _p2;
    camera.k3 = _k3;
    camera.mount_yaw_deg = _yaw;
    camera.mount_pitch_deg = _pitch;
    camera.mount_roll_deg = _roll;
    camera.offset_m[0] = _pos_x;
    camera.offset_m[1] = _pos_y;
    camera.offset_m[2] = _pos_z;

    estimator.navigation.attitude_bias_deg = _att_bias;
    estimator.navigation.attitude_white_deg = _att_white;
    estimator.navigation.attitude_drift_deg = _att_drift;
    estimator.navigation.velocity_bias_m_s = _vel_bias;
    estimator.navigation.ground_m = _gnd_sd;
    estimator.detector.box_px = _box_px;
    estimator.detector.box_share = _box_share;
    estimator.detector.correlation_s = _box_time;

    layer.resets = GOE_FLIGHT_RESETS_TIME;
    layer.score_min = _score_min;
    layer.confirm_images = _confirm.get();
    layer.alive_s = _alive;
    layer.forget_s = _forget;
    layer.delay_s = _delay;
    layer.delay_sd_s = _delay_sd;
    layer.delay_max_s = _delay_max;
    layer.range_finder_sd_m = _rng_sd;
    layer.range_finder_max_m = _rng_max;
    layer.terrain_sd_m = _ter_sd;
    layer.home_sd_m = _home_sd;
    layer.margin_m = _margin;
    layer.clearance_m = _clear;
    layer.violation_max = _viol_max;
    layer.bank_deg = _bank;
    layer.roll_in_s = _roll_in;
    layer.climb_m_s = _climb;
    layer.climb_in_s = _climb_in;
    layer.loiter_m = _loiter;
    layer.reserve_s = _reserve;
}

#endif // AP_GOE_ENABLED
