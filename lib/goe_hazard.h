/* Closest approach, decision and covariance of the latest estimate. Included by goe.h. SPDX-License-Identifier: MIT */
#ifndef GOE_HAZARD_H
#define GOE_HAZARD_H

#ifndef GOE_H
#error "include goe.h, which includes this"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The quantities of goe_covariance(), in this order. */
enum { GOE_X0, GOE_Z0, GOE_ORIENTATION, GOE_WIDTH, GOE_LENGTH, GOE_HEIGHT, GOE_QUANTITIES };

/* Writes the covariance of x0_m, z0_m, orientation_deg, width_m, length_m, height_m of the latest estimate, in meters and
 * degrees. Rows and columns of a quantity that is not valid are 0. The diagonal contains the squared sigmas, up to rounding:
 * 0.2 % of the variance plus 4e-7 of the largest one. For a stale estimate of the filter the variances are larger: they include
 * the growth with age.
 * All elements off the diagonal are 0 for an estimate of the window method, and for one from before a restart or a change of
 * the model.
 *   covariance  always written, unless null; all zero after a failure
 * Returns GOE_OK, GOE_CONVERGING if there is no position, GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED, GOE_CORRUPTED.
 * Cost: at most 10700 instructions, 1040 bytes of stack. */
goe_status_t goe_covariance(const goe_estimator_t *estimator, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]);

/* The aircraft's intent: flight at constant velocity. A horizontal speed below 0.1 m/s counts as hovering, also in a climb or a
 * descent. The speed is relative to the ground, or to the obstacle if its velocity is valid.
 * During an evasion, pass the velocity at which the flight continues after it, such as level flight on the course: the velocity
 * of a climb makes the decision CLEAR, and the climb ends too early. */
typedef struct {
    float velocity_ned_m_s[3]; /* velocity relative to the ground, each +-1e3 */
    float margin_m;            /* wanted horizontal distance to the obstacle's outline; 0 to 1e4 */
    float clearance_m;         /* wanted height above its top; 0 to 1e4 */
    float since_image_s;       /* time since the exposure of the latest image that goe took, not refused; 0 to 1e3. goe
                                * assumes flight at this velocity since then, and predicts times from now on */
    float velocity_sd_m_s;     /* sigma of each axis of the velocity; 0 to 100; 0: navigation.velocity_bias_sd_m_s */
} goe_intent_t;

/* The predicted closest approach under this intent. The sigmas are of first order, from the covariance of the estimate and the
 * error of the velocity. Filter: a constant error of goe_pose_t.height_m moves camera and top by the same amount, and does not
 * change the clearance. The conflict probability uses the clearance at tcpa_s. Elsewhere within the margin, climb or descent
 * may reduce the clearance by up to vertical speed * margin_m / horizontal speed: add that to goe_intent_t.clearance_m. The
 * conflict probability is an upper bound if the errors of distance and clearance are negatively correlated. */
typedef struct {
    float tcpa_s;      /* time until the distance to the outline is smallest for the first time. If the path crosses the
                        * outline: time until it enters. 0 if the distance already grows, or inside the outline */
    float dcpa_m;      /* horizontal distance to the outline at that time; 0 if the path crosses the outline */
    float clearance_m; /* height of the camera above the top at that time, negative below the top. In a descent across
                        * the outline: where the path leaves the outline. 0 if has_clearance is false */
    float tcpa_sd_s;   /* 0 if tcpa_s is 0. If either end of a nearly parallel face may be closest, it spans the
                        * times of both ends */
    float dcpa_sd_m;   /* if the path crosses the outline: sigma of the penetration depth */
    float clearance_sd_m;
    float conflict_probability; /* probability that margin and clearance are both violated, 0 to 1. If has_clearance is
                                 * false: that the margin is violated */
    bool has_clearance;         /* the height of the obstacle is valid */
} goe_hazard_t;

#if GOE_WITH_HAZARD
/* Predicts the closest approach to the obstacle of the latest estimate, also if that is stale or suspect. The outline is the
 * disc, or the valid part of the box. If orientation or length is not valid, the outline is a circle about the reference point
 * with the box's width as diameter. Prism: a circle as wide as the obstacle across the present line of sight, and as near to the
 * camera: images show the near side well, and the center poorly. With a velocity of 0, dcpa_m is the distance to the near
 * side. In the window method without width, the outline is the reference point alone.
 * An image without a detection changes only the time. A restart of the filter keeps position and size until a new estimate replaces
 * them, or until a feature contradicts them: the obstacle lies behind the camera, the feature ahead. So without a new estimate
 * uncertainty only grows. [A34]
 *   hazard  always written, unless null; all zero after a failure: conflict_probability = 0 then does not mean "safe"
 * Returns GOE_OK, GOE_CONVERGING if there is no position, GOE_NOT_FINITE or GOE_OUT_OF_RANGE for the intent,
 * GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED, GOE_CORRUPTED.
 * Cost: at most 22100 instructions, 1280 bytes of stack. */
GOE_NODISCARD goe_status_t goe_hazard(const goe_estimator_t *estimator, const goe_intent_t *intent,
                                      goe_hazard_t *hazard);

/* When to act. Margin and clearance are in goe_intent_t. */
typedef struct {
    float conflict_probability_max; /* act at this probability or above it; 0 to 1; default 0.1 */
    float act_within_s;             /* ... and if the aircraft may reach the obstacle within this time, or is too near
                                     * already: the duration of the maneuver and some seconds to decide; 0 to 1e4;
                                     * default 12 */
    float suspect_factor;           /* multiplies margin and clearance of a suspect estimate; 1 to 100; default 1.5 */
    float stale_growth_m_s;         /* growth of margin and clearance without a new estimate; 0 to 100; default 1 */
} goe_rule_t;

typedef enum {
    GOE_DECISION_UNKNOWN = 0, /* too little is known. This does not mean "safe": keep the previous decision. Either
                               * no position is valid; or the probability is below conflict_probability_max, but one
                               * sigma could violate both distances; or the probability is reached, and only the
                               * linear bound tcpa_s - 2 tcpa_sd_s is within act_within_s; or for two seconds detections
                               * gave no new estimate; or the latest image is over two seconds old; or the obstacle moves
                               * (GOE_REASON_MOVES) without a valid velocity, so the position is wrong; or the range is
                               * that of a detector's class, which no image confirms yet. Filter, while the obstacle may
                               * be ahead: an image showed it larger than it can be at its range, and no images of two
                               * seconds have shown otherwise; or the border may cut its box on the side of the course */
    GOE_DECISION_CLEAR = 1,   /* no reason to act now */
    GOE_DECISION_ACT = 2,     /* go around, or avoid */
    GOE_DECISION_KEEP = 3     /* the call failed: keep the previous decision */
} goe_decision_t;

/* Sets *rule to its defaults. rule may be null.
 * Cost: at most 40 instructions, 16 bytes of stack. */
void goe_rule_default(goe_rule_t *rule);

/* The decision rule: widens margin and clearance by suspect_factor and age, calls goe_hazard() and applies the thresholds of
 * the rule. Only GOE_DECISION_CLEAR ends an action, and a failure never returns it. If goe refused images since the latest one
 * taken, the rule also judges the time of the newest of them, and the more severe decision counts.
 *   rule    may be null; the defaults then apply
 *   hazard  receives the hazard for the widened distances, all zero if there is none. May be null
 * Returns GOE_DECISION_KEEP for a bad argument, for an intent or a rule that is not finite or out of range, and for an
 * estimator that is corrupted or not initialized.
 * Call it 5 to 50 times a second, also while no image comes.
 * Without refused images, and if the aircraft flies more than the margin within act_within_s, it takes at most 22700 instructions.
 * Cost: at most 44000 instructions, 1500 bytes of stack. */
GOE_NODISCARD goe_decision_t goe_decide(const goe_estimator_t *estimator, const goe_intent_t *intent,
                                        const goe_rule_t *rule, goe_hazard_t *hazard);

/* Returns the earliest time of the closest approach at two sigma, s: tcpa_s^2 / (tcpa_s + 2 tcpa_sd_s). Returns 0 if hazard is
 * null or not finite.
 * Cost: at most 70 instructions, 16 bytes of stack. */
float goe_earliest_tcpa_s(const goe_hazard_t *hazard);
#endif

#ifdef __cplusplus
}
#endif

#endif
