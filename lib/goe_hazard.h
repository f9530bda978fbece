/* Closest approach, decision and covariance of the latest estimate. Included by goe.h. SPDX-License-Identifier: MIT */
#ifndef GOE_HAZARD_H
#define GOE_HAZARD_H

#ifndef GOE_H
#error "include goe.h, which includes this"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The quantities of goe_covariance, in this order. */
enum { GOE_X0, GOE_Z0, GOE_ORIENTATION, GOE_WIDTH, GOE_LENGTH, GOE_HEIGHT, GOE_QUANTITIES };

/* Covariance of x0_m, z0_m, orientation_deg, width_m, length_m, height_m of the latest estimate: meters and degrees. Rows
 * and columns of a quantity that is not valid are 0. The diagonal holds the sigmas squared. For a stale answer x0 and z0
 * include the growth of x_m and z_m with its age, and no variance is below its sigma squared. The window's answer, and one
 * from before a restart or a change of the model, has nothing off the diagonal.
 *   covariance  always written unless null; all zero on failure
 * Returns GOE_OK, GOE_CONVERGING if there is no position, GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED, GOE_CORRUPTED.
 * Cost: at most 10600 instructions, 880 bytes of stack. */
goe_status_t goe_covariance(const goe_estimator_t *estimator, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]);

/* The aircraft's intent: it continues at constant velocity. Slower than 0.1 m/s over the ground, or relative to an obstacle
 * that is followed, counts as standing still, also in a climb or a descent. */
typedef struct {
    float velocity_ned_m_s[3]; /* relative to the ground, each +-1e3 */
    float margin_m;            /* least horizontal distance to the obstacle's outline; 0 to 1e4 */
    float clearance_m;         /* ... or least height above its top; 0 to 1e4 */
    float since_image_s;       /* time since the latest image: the detector's latency or silence; 0 to 1e3. The aircraft
                                * has flown at that velocity since, and times count from now. 0: from that image */
    float velocity_sd_m_s;     /* sigma of velocity_ned_m_s, each axis; 0 to 100; 0: navigation.velocity_bias_sd_m_s */
} goe_intent_t;

/* The closest approach under this intent. Sigmas are to first order, from the estimate's covariance and the velocity's error.
 * Filter: a constant error of goe_pose_t.height_m moves camera and top by the same amount, and is not in the clearance.
 * The conflict probability takes the clearance at tcpa_s: elsewhere within the margin a climb or descent costs up to
 * climb * margin_m / speed, which goe_intent_t.clearance_m has to cover. It is too high, never too low, if the errors of
 * distance and clearance are negatively correlated. */
typedef struct {
    float tcpa_s;      /* time until the horizontal distance to the outline is smallest for the first time; if the path
                        * crosses the outline: until it enters. 0: the distance already grows, or the aircraft is inside */
    float dcpa_m;      /* that distance; 0 if the path crosses the outline */
    float clearance_m; /* camera above the top at that time; negative: below it. In a descent across the outline: where
                        * the path leaves it. 0 if the height is not known */
    float tcpa_sd_s;   /* 0 if tcpa_s is. If either end of a nearly parallel face may be closest, it spans the face */
    float dcpa_sd_m;   /* if the path crosses the outline: of the penetration depth */
    float clearance_sd_m;
    float conflict_probability; /* that margin and clearance are both violated, 0 to 1; height unknown: the margin */
    bool has_clearance;         /* the obstacle's height is known */
} goe_hazard_t;

#if GOE_WITH_HAZARD
/* Closest approach to the obstacle of the latest estimate, also if stale or suspect. The outline is the disc, or the known part
 * of the box: without orientation or length the circle of its width about the reference point; window, without width: that
 * point alone. An image without a detection changes nothing but the time, and a restart of the filter keeps position and size
 * until a new answer replaces them: uncertainty only grows. [A34]
 *   hazard  always written unless null; all zero on failure: conflict_probability = 0 is not "safe" then
 * Returns GOE_OK, GOE_CONVERGING if there is no position, GOE_NOT_FINITE or GOE_OUT_OF_RANGE for the intent,
 * GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED, GOE_CORRUPTED.
 * Cost: at most 21300 instructions, 1110 bytes of stack. */
GOE_NODISCARD goe_status_t goe_hazard(const goe_estimator_t *estimator, const goe_intent_t *intent,
                                      goe_hazard_t *hazard);

/* When to act. goe_intent_t has margin and clearance. */
typedef struct {
    float conflict_probability_max; /* act from this probability on; 0 to 1; default 0.1 */
    float act_within_s;             /* ... if the aircraft may reach the obstacle within this time: the maneuver's,
                                     * and some seconds to decide; 0 to 1e4; default 12 */
    float suspect_factor;           /* on margin and clearance while the estimate is suspect; 1 to 100; default 1.5 */
    float stale_growth_m_s;         /* of margin and clearance without a new answer; 0 to 100; default 1 */
} goe_rule_t;

typedef enum {
    GOE_DECISION_UNKNOWN = 0, /* no position; or a small probability although one sigma breaks both distances, or
                               * although the obstacle may be reached within act_within_s at two sigma of the time; or
                               * no new answer in two seconds of detections. Not "safe": keep the previous decision */
    GOE_DECISION_CLEAR = 1,   /* no reason to act now */
    GOE_DECISION_ACT = 2,     /* go around, or avoid */
    GOE_DECISION_KEEP = 3     /* the call failed: keep the previous decision */
} goe_decision_t;

/* Sets *rule to its defaults. Null is ignored.
 * Cost: at most 40 instructions, 16 bytes of stack. */
void goe_rule_default(goe_rule_t *rule);

/* The decision rule: goe_hazard() with margin and clearance widened by suspect_factor and age, and the rule's thresholds. Only
 * GOE_DECISION_CLEAR ends an action; no failure returns it.
 *   rule    null: the defaults
 *   hazard  the hazard with the widened distances, all zero without one; null: not wanted
 * Returns GOE_DECISION_KEEP for a bad argument, an intent or a rule that is not finite or out of range, and an estimator that
 * is not initialized or corrupted.
 * Cost: at most 21800 instructions, 1200 bytes of stack. */
GOE_NODISCARD goe_decision_t goe_decide(const goe_estimator_t *estimator, const goe_intent_t *intent,
                                        const goe_rule_t *rule, goe_hazard_t *hazard);

/* The earliest closest approach at two sigma, s: time^2 / (time + 2 sigma). 0 if *hazard is null or not finite.
 * Cost: at most 30 instructions, 16 bytes of stack. */
float goe_earliest_tcpa_s(const goe_hazard_t *hazard);
#endif

#ifdef __cplusplus
}
#endif

#endif
