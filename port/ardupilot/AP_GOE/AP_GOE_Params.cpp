/* Parameters of AP_GOE. Ranges and defaults are those of goe_settings_list.h and goe_flight_settings_list.h. Exceptions are
 * OA_SIGMA and the drift in AP_GOE_config.h. SPDX-License-Identifier: MIT */
#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include "AP_GOE.h"

const AP_Param::GroupInfo AP_GOE::var_info[] = {

    // @Param: ENABLE
    // @DisplayName: Obstacle estimation from a camera
    // @Description: Enables the estimation of obstacles' positions and sizes from the detections of a camera
    // @Values: 0:Disabled,1:Enabled
    // @User: Standard
    // @RebootRequired: True
    AP_GROUPINFO_FLAGS("ENABLE", 1, AP_GOE, _enable, 0, AP_PARAM_FLAG_ENABLE),

    // @Param: WIDTH
    // @DisplayName: Camera image width
    // @Description: Width of the raw image in pixels. Must be set
    // @Range: 0 32767
    // @User: Standard
    AP_GROUPINFO("WIDTH", 2, AP_GOE, _width, 0),

    // @Param: HEIGHT
    // @DisplayName: Camera image height
    // @Description: Height of the raw image in pixels. Must be set
    // @Range: 0 32767
    // @User: Standard
    AP_GROUPINFO("HEIGHT", 3, AP_GOE, _height, 0),

    // @Param: FX
    // @DisplayName: Focal length
    // @Description: Focal length along the image's width in pixels, from a calibration. Must be set. No image reveals a wrong value
    // @Range: 1 100000
    // @User: Standard
    AP_GROUPINFO("FX", 4, AP_GOE, _fx, 0.0f),

    // @Param: FY
    // @DisplayName: Focal length, vertical
    // @Description: Focal length along the image's height in pixels. 0: the value of GOE_FX
    // @Range: 0 100000
    // @User: Advanced
    AP_GROUPINFO("FY", 5, AP_GOE, _fy, 0.0f),

    // @Param: CX
    // @DisplayName: Principal point
    // @Description: Position of the principal point in pixels from the left side of the image. 0: the middle of the image
    // @Range: -100000 100000
    // @User: Advanced
    AP_GROUPINFO("CX", 6, AP_GOE, _cx, 0.0f),

    // @Param: CY
    // @DisplayName: Principal point, vertical
    // @Description: Position of the principal point in pixels from the top of the image. 0: the middle of the image
    // @Range: -100000 100000
    // @User: Advanced
    AP_GROUPINFO("CY", 7, AP_GOE, _cy, 0.0f),

    // @Param: K1
    // @DisplayName: Lens distortion, radial, first
    // @Description: First radial coefficient of the lens distortion, in OpenCV's order and meaning
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("K1", 8, AP_GOE, _k1, 0.0f),

    // @Param: K2
    // @DisplayName: Lens distortion, radial, second
    // @Description: Second radial coefficient of the lens distortion
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("K2", 9, AP_GOE, _k2, 0.0f),

    // @Param: P1
    // @DisplayName: Lens distortion, tangential, first
    // @Description: First tangential coefficient of the lens distortion
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("P1", 10, AP_GOE, _p1, 0.0f),

    // @Param: P2
    // @DisplayName: Lens distortion, tangential, second
    // @Description: Second tangential coefficient of the lens distortion
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("P2", 11, AP_GOE, _p2, 0.0f),

    // @Param: K3
    // @DisplayName: Lens distortion, radial, third
    // @Description: Third radial coefficient of the lens distortion
    // @Range: -100 100
    // @User: Advanced
    AP_GROUPINFO("K3", 12, AP_GOE, _k3, 0.0f),

    // @Param: YAW
    // @DisplayName: Camera yaw
    // @Description: Yaw angle of the camera's mounting. 0: the camera looks forward. Negative: it looks left
    // @Units: deg
    // @Range: -360 360
    // @User: Standard
    AP_GROUPINFO("YAW", 13, AP_GOE, _yaw, 0.0f),

    // @Param: PITCH
    // @DisplayName: Camera pitch
    // @Description: Pitch angle of the camera's mounting, applied after the yaw. Positive: the camera looks up
    // @Units: deg
    // @Range: -360 360
    // @User: Standard
    AP_GROUPINFO("PITCH", 14, AP_GOE, _pitch, 0.0f),

    // @Param: ROLL
    // @DisplayName: Camera roll
    // @Description: Roll angle of the camera's mounting about its optical axis, applied after yaw and pitch. Positive: the camera leans to the right
    // @Units: deg
    // @Range: -360 360
    // @User: Standard
    AP_GROUPINFO("ROLL", 15, AP_GOE, _roll, 0.0f),

    // @Param: POS_X
    // @DisplayName: Camera X position
    // @Description: X position of the camera in body frame. Positive X is forward of the origin. The origin is the same as for INS_POS1_X
    // @Units: m
    // @Range: -10000 10000
    // @User: Advanced
    AP_GROUPINFO("POS_X", 16, AP_GOE, _pos_x, 0.0f),

    // @Param: POS_Y
    // @DisplayName: Camera Y position
    // @Description: Y position of the camera in body frame. Positive Y is to the right of the origin. The origin is the same as for INS_POS1_Y
    // @Units: m
    // @Range: -10000 10000
    // @User: Advanced
    AP_GROUPINFO("POS_Y", 17, AP_GOE, _pos_y, 0.0f),

    // @Param: POS_Z
    // @DisplayName: Camera Z position
    // @Description: Z position of the camera in body frame. Positive Z is down from the origin. The origin is the same as for INS_POS1_Z
    // @Units: m
    // @Range: -10000 10000
    // @User: Advanced
    AP_GROUPINFO("POS_Z", 18, AP_GOE, _pos_z, 0.0f),

    // @Param: DELAY
    // @DisplayName: Least delay of the link
    // @Description: Least time from the sending of an image's message to its arrival. It applies to images whose time is not by the autopilot's clock
    // @Units: s
    // @Range: 0 0.5
    // @User: Standard
    AP_GROUPINFO("DELAY", 19, AP_GOE, _delay, 0.005f),

    // @Param: HOME_SD
    // @DisplayName: Error of the height above home
    // @Description: One sigma of the error of the height above home as a height above the ground
    // @Units: m
    // @Range: 0.001 1000
    // @User: Standard
    AP_GROUPINFO("HOME_SD", 29, AP_GOE, _home_sd, 5.0f),

    // @Param: MARGIN
    // @DisplayName: Margin
    // @Description: Wanted horizontal distance to an obstacle's outline. It affects hazards and actions, not the avoidance database
    // @Units: m
    // @Range: 0 1000
    // @User: Standard
    AP_GROUPINFO("MARGIN", 30, AP_GOE, _margin, 15.0f),

    // @Param: CLEAR
    // @DisplayName: Clearance
    // @Description: Wanted vertical distance over an obstacle's top. It affects hazards and actions, not the avoidance database
    // @Units: m
    // @Range: 0 1000
    // @User: Standard
    AP_GROUPINFO("CLEAR", 31, AP_GOE, _clear, 10.0f),

    // @Param: GND_SD
    // @DisplayName: Unevenness of the ground
    // @Description: One sigma of the difference in height between the ground at the obstacle and the ground below the vehicle
    // @Units: m
    // @Range: 0 1000
    // @User: Standard
    AP_GROUPINFO("GND_SD", 43, AP_GOE, _gnd_sd, 2.0f),

    // @Param: OA_SIGMA
    // @DisplayName: Sigmas in the database
    // @Description: Number of sigmas of the obstacle's position that are added to its radius in the avoidance database. While the estimate is suspect, twice as many are added. One sigma is 10 to 35 m after the first detection, and 1 m close to the obstacle. 0: the estimated radius without an addition, which is not safe
    // @Range: 0 5
    // @User: Standard
    AP_GROUPINFO("OA_SIGMA", 47, AP_GOE, _oa_sigma, 2.0f),

    // @Param: REPORT_HZ
    // @DisplayName: Rate of messages
    // @Description: Rate at which GOE_OBSTACLE and GOE_HAZARD are sent for each obstacle. 0: these messages and GOE_STATUS are not sent
    // @Units: Hz
    // @Range: 0 10
    // @User: Standard
    AP_GROUPINFO("REPORT_HZ", 48, AP_GOE, _report_hz, 1.0f),

    // @Param: OPTIONS
    // @DisplayName: Options
    // @Description: With bit 0, arming requires images and a pose. Images without obstacles do not prevent arming
    // @Bitmask: 0:Arming requires images and a pose
    // @User: Standard
    AP_GROUPINFO("OPTIONS", 49, AP_GOE, _options, 1),

    AP_GROUPEND};

#define GRAVITY_M_S2 9.80665f
#define CM_PER_M 100.0f

static float or_else(float value, float otherwise) { return is_zero(value) ? otherwise : value; }

bool AP_GOE::Foreign::find(const char *name, float its_scale)
{
    param = AP_Param::find(name, &type);
    scale = its_scale;
    return param != nullptr;
}

// Called once, because the search goes through all names of the vehicle. Newer names come first.
void AP_GOE::find_vehicle()
{
    if (!_roll_limit_deg.find("ROLL_LIMIT_DEG", 1.0f)) {
        (void)_roll_limit_deg.find("LIM_ROLL_CD", 1.0f / CM_PER_M);
    }
    (void)_climb_max_m_s.find("TECS_CLMB_MAX", 1.0f);
    (void)_loiter_m.find("WP_LOITER_RAD", 1.0f);
    if (!_cruise_m_s.find("AIRSPEED_CRUISE", 1.0f)) {
        (void)_cruise_m_s.find("TRIM_ARSPD_CM", 1.0f / CM_PER_M);
    }
}

/* Limits from the vehicle's own parameters. The vehicle cannot fly a circle smaller than its turn at cruise speed and this bank, so
 * the layer gets the larger of both radii. */
void AP_GOE::read_vehicle(goe_flight_settings_t &layer) const
{
    if (is_positive(_roll_limit_deg.get())) {
        layer.bank_deg = MIN(layer.bank_deg, _roll_limit_deg.get());
    }
    if (is_positive(_climb_max_m_s.get())) {
        layer.climb_m_s = MIN(layer.climb_m_s, _climb_max_m_s.get());
    }
    if (_loiter_m.param == nullptr) {
        return;
    }
    layer.loiter_m = fabsf(_loiter_m.get());
    if (is_positive(layer.loiter_m) && is_positive(_cruise_m_s.get())) {
        layer.loiter_m = MAX(layer.loiter_m, sq(_cruise_m_s.get()) / (GRAVITY_M_S2 * tanf(radians(layer.bank_deg))));
    }
}

/* Name of the parameter, as the ground station shows it. For a setting without a parameter: the setting's own name. */
const char *AP_GOE::parameter_of(const char *field)
{
    static const struct {
        const char *field, *parameter;
    } names[] = {
        {"camera.width_px", "GOE_WIDTH"},
        {"camera.height_px", "GOE_HEIGHT"},
        {"camera.fx_px", "GOE_FX"},
        {"camera.fy_px", "GOE_FY"},
        {"camera.cx_px", "GOE_CX"},
        {"camera.cy_px", "GOE_CY"},
        {"camera.k1", "GOE_K1"},
        {"camera.k2", "GOE_K2"},
        {"camera.p1", "GOE_P1"},
        {"camera.p2", "GOE_P2"},
        {"camera.k3", "GOE_K3"},
        {"camera.mount_yaw_deg", "GOE_YAW"},
        {"camera.mount_pitch_deg", "GOE_PITCH"},
        {"camera.mount_roll_deg", "GOE_ROLL"},
        {"camera.offset_m[0]", "GOE_POS_X"},
        {"camera.offset_m[1]", "GOE_POS_Y"},
        {"camera.offset_m[2]", "GOE_POS_Z"},
        {"navigation.terrain_height_sd_m", "GOE_GND_SD"},
        {"delay_s", "GOE_DELAY"},
        {"home_sd_m", "GOE_HOME_SD"},
        {"margin_m", "GOE_MARGIN"},
        {"clearance_m", "GOE_CLEAR"},
        {"bank_deg", "ROLL_LIMIT_DEG"},
        {"climb_m_s", "TECS_CLMB_MAX"},
        {"loiter_m", "WP_LOITER_RAD"},
    };
    for (const auto &name : names) {
        if (strcmp(name.field, field) == 0) {
            return name.parameter;
        }
    }
    return field;
}

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

    estimator.navigation.attitude_walk_sd_deg = AP_GOE_ATTITUDE_DRIFT;
    estimator.navigation.terrain_height_sd_m = _gnd_sd;

    layer.resets = GOE_FLIGHT_RESETS_TIME;
    layer.delay_s = _delay;
    layer.home_sd_m = _home_sd;
    layer.margin_m = _margin;
    layer.clearance_m = _clear;
    read_vehicle(layer);
}

#endif // AP_GOE_ENABLED
