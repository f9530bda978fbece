/* Closest approach of a straight flight to an outline. SPDX-License-Identifier: MIT
 *
 * Seen from above, in T, the camera now at the origin, u the unit vector of the course, r its right. The outline K is
 * convex. Its reach into a direction m, h(m) = max over K of m k, is all that distances take: the ray along u keeps
 * max of -h(m), m u >= 0, from K, negative if it crosses, and by the envelope theorem the derivative at the best m is
 * that of h with m held. Two of these m are told apart from the start, -r and r: the obstacle is passed on one side or on
 * the other, which exclude each other, so that their probabilities add. */
#include "hazard/goe_approach.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_normal.h"
#include "maths/goe_scalar.h"

#define HOVER_M_S 0.1f        /* slower than this is taken as standing still */
#define PARALLEL 1.0e-5f      /* sine of an angle between two directions that counts as none */
#define CHORD_LEAST_M 1.0e-3f /* half chord that a derivative divides by */
#define DISTANCE_LEAST_M 1.0e-6f
#define SIGMA_LEAST 1.0e-6f
#define MOST 1.0e9f /* of any number told */

typedef struct {
    float x, z;
} vector_t;

typedef struct {
    vector_t reference, width_axis, length_axis;
    float half, length; /* half: of the width, or the radius */
    bool box;
} outline_t;

typedef struct {
    vector_t course, right; /* 0 if it stands still */
    float speed_m_s, climb_m_s;
} motion_t;

/* A quantity and its derivatives by those of goe_covariance. */
typedef struct {
    float value;
    float by[GOE_QUANTITIES];
} gauge_t;

/* Closest approach. */
typedef struct {
    gauge_t left, right, ahead; /* signed distances: passed with the obstacle on the left, right; along the course */
    gauge_t clearance;
    float time_s, time_sd_s;
    bool moves;
} approach_t;

static float dot(vector_t a, vector_t b) { return a.x * b.x + a.z * b.z; }

static vector_t turned(vector_t v) { /* a quarter to the right: also the derivative by the orientation */
    const vector_t t = {v.z, -v.x};
    return t;
}

static vector_t negative(vector_t v) {
    const vector_t n = {-v.x, -v.z};
    return n;
}

static float bounded(float x) { return goe_within(x, MOST) ? x : (x < 0.0f ? -MOST : MOST); }

static float product(const gauge_t *a, const gauge_t *b, goe_covariance_t covariance) {
    float sum = 0.0f;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        float row = 0.0f;
        for (int j = 0; j < GOE_QUANTITIES; j++) {
            row += covariance[i][j] * b->by[j];
        }
        sum += a->by[i] * row;
    }
    return sum;
}

static float sigma_of(const gauge_t *gauge, goe_covariance_t covariance) {
    const float variance = product(gauge, gauge, covariance);
    return variance > 0.0f ? bounded(sqrtf(variance)) : 0.0f;
}

/* Probability that the gauge lies below the limit. */
static float below(const gauge_t *gauge, float limit, goe_covariance_t covariance) {
    return goe_normal_below((limit - gauge->value) / goe_larger(sigma_of(gauge, covariance), SIGMA_LEAST));
}

/* ----------------------------------------------------------------------------------------------------------- outline -- */

static outline_t outline_of(const goe_estimate_t *estimate) {
    const unsigned needed = GOE_HAS_ORIENTATION | GOE_HAS_WIDTH | GOE_HAS_LENGTH;
    outline_t o;
    o.reference.x = estimate->x_m;
    o.reference.z = estimate->z_m;
    o.length_axis.x = estimate->length_axis[0];
    o.length_axis.z = estimate->length_axis[1];
    o.width_axis.x = estimate->width_axis[0];
    o.width_axis.z = estimate->width_axis[1];
    o.half = (estimate->valid & GOE_HAS_WIDTH) ? 0.5f * estimate->width_m : 0.0f;
    o.length = estimate->length_m;
    o.box = estimate->model != GOE_MODEL_DISC && (estimate->valid & needed) == needed;
    return o;
}

/* m k at a corner k of a box, m held in the derivatives: side -0.5 or 0.5 of the width, end 0 or 1 of the length. */
static gauge_t corner(const outline_t *o, vector_t m, float side, float end) {
    const float across = dot(m, o->width_axis);
    const float along = dot(m, o->length_axis);
    const float side_m = side * 2.0f * o->half;
    const float end_m = end * o->length;
    gauge_t g = {dot(m, o->reference) + side_m * across + end_m * along, {0}};
    g.by[GOE_X0] = m.x;
    g.by[GOE_Z0] = m.z;
    g.by[GOE_WIDTH] = side * across;
    g.by[GOE_LENGTH] = end * along;
    g.by[GOE_ORIENTATION] = (end_m * across - side_m * along) * GOE_RAD_PER_DEG;
    return g;
}

/* h(m), |m| = 1. */
static gauge_t reach(const outline_t *o, vector_t m) {
    if (o->box) {
        return corner(o, m, dot(m, o->width_axis) < 0.0f ? -0.5f : 0.5f, dot(m, o->length_axis) > 0.0f ? 1.0f : 0.0f);
    }
    gauge_t h = {dot(m, o->reference) + o->half, {0}};
    h.by[GOE_X0] = m.x;
    h.by[GOE_Z0] = m.z;
    h.by[GOE_WIDTH] = 0.5f;
    return h;
}

/* Signed distance to the half-plane beyond which the outline does not reach towards m. */
static gauge_t distance(const outline_t *o, vector_t m) {
    gauge_t d = reach(o, m);
    d.value = -d.value;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        d.by[i] = -d.by[i];
    }
    return d;
}

/* Along the course to where the outline reaches farthest towards m, a side of the course; of a whole edge that does, to
 * its first end. */
static gauge_t along_course(const outline_t *o, vector_t course, vector_t m) {
    if (o->box) {
        float across = dot(m, o->width_axis);
        float along = dot(m, o->length_axis);
        across = goe_absolute(across) > PARALLEL ? across : -dot(course, o->width_axis);
        along = goe_absolute(along) > PARALLEL ? along : -dot(course, o->length_axis);
        return corner(o, course, across < 0.0f ? -0.5f : 0.5f, along > 0.0f ? 1.0f : 0.0f);
    }
    gauge_t s = {dot(course, o->reference), {0}};
    s.by[GOE_X0] = course.x;
    s.by[GOE_Z0] = course.z;
    return s;
}

/* --------------------------------------------------------------------------------------------------------- crossing -- */

/* Along the course into (way -1) or out of (way 1) a disc that it crosses. sigma_m: of how deep. Near the rim the chord
 * grows with the root of the depth, and its derivative is taken a sigma inside. */
static gauge_t chord_end(const outline_t *o, const motion_t *motion, float way, float sigma_m) {
    const vector_t u = motion->course;
    const vector_t r = motion->right;
    const float off = dot(r, o->reference);
    const float chord2 = o->half * o->half - off * off;
    const float chord = sqrtf(chord2 > 0.0f ? chord2 : 0.0f);
    const float share = way / goe_larger(goe_larger(chord, sqrtf(o->half * sigma_m)), CHORD_LEAST_M);
    gauge_t s = {dot(u, o->reference) + way * chord, {0}};
    s.by[GOE_X0] = u.x - share * off * r.x;
    s.by[GOE_Z0] = u.z - share * off * r.z;
    s.by[GOE_WIDTH] = 0.5f * share * o->half;
    return s;
}

/* Along the course to the line of the face with the outward normal m; slope = m u, not 0. */
static gauge_t face_line(const outline_t *o, const motion_t *motion, vector_t m, float slope) {
    gauge_t s = reach(o, m);
    s.value /= slope;
    const vector_t to_reference = {o->reference.x - s.value * motion->course.x,
                                   o->reference.z - s.value * motion->course.z};
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        s.by[i] /= slope;
    }
    s.by[GOE_ORIENTATION] = dot(turned(m), to_reference) * GOE_RAD_PER_DEG / slope;
    return s;
}

/* The same for a box: the last of the faces that it enters by, the first of those that it leaves by. */
static gauge_t face_end(const outline_t *o, const motion_t *motion, float way) {
    const vector_t normal[4] = {o->width_axis, negative(o->width_axis), o->length_axis, negative(o->length_axis)};
    gauge_t s = {0.0f, {0}};
    bool any = false;
    for (int i = 0; i < 4; i++) {
        const float slope = dot(normal[i], motion->course);
        if (way * slope > PARALLEL) {
            const gauge_t end = face_line(o, motion, normal[i], slope);
            if (!any || way * (end.value - s.value) < 0.0f) {
                s = end;
                any = true;
            }
        }
    }
    return s;
}

static gauge_t outline_end(const outline_t *o, const motion_t *motion, float way, float sigma_m) {
    return o->box ? face_end(o, motion, way) : chord_end(o, motion, way, sigma_m);
}

/* -------------------------------------------------------------------------------------------------- where it stands -- */

/* The way out of a box that the camera is in, other than to the sides of the course. */
static vector_t way_out_of_box(const outline_t *o, const motion_t *motion) {
    const vector_t normal[4] = {o->width_axis, negative(o->width_axis), o->length_axis, negative(o->length_axis)};
    vector_t best = motion->course;
    float least = MOST;
    for (int i = 0; i < 4; i++) {
        const float depth = reach(o, normal[i]).value;
        if (depth < least && dot(normal[i], motion->course) >= 0.0f) {
            least = depth;
            best = normal[i];
        }
    }
    return best;
}

/* From the outline to the camera now, or out of it by the shortest way. */
static vector_t way_from_box(const outline_t *o, const motion_t *motion) {
    const float across = -dot(o->width_axis, o->reference);
    const float along = -dot(o->length_axis, o->reference);
    const float off_across = across - (across < -o->half ? -o->half : across > o->half ? o->half : across);
    const float off_along = along - (along < 0.0f ? 0.0f : along > o->length ? o->length : along);
    const float norm = sqrtf(off_across * off_across + off_along * off_along);
    if (norm < DISTANCE_LEAST_M) {
        return way_out_of_box(o, motion);
    }
    const vector_t m = {(off_across * o->width_axis.x + off_along * o->length_axis.x) / norm,
                        (off_across * o->width_axis.z + off_along * o->length_axis.z) / norm};
    return m;
}

static vector_t way_from_disc(const outline_t *o, const motion_t *motion) {
    const vector_t c = o->reference;
    const float norm = sqrtf(dot(c, c));
    if (norm < o->half && dot(c, motion->course) > 0.0f) {
        return motion->course; /* inside, and the sides are nearer than what lies behind */
    }
    vector_t m = {0.0f, 1.0f};
    if (norm > DISTANCE_LEAST_M) {
        m.x = -c.x / norm;
        m.z = -c.z / norm;
    }
    return m;
}

/* ---------------------------------------------------------------------------------------------------------- approach -- */

static motion_t motion_of(const goe_estimator_t *estimator, const goe_plan_t *plan) {
    const float c = estimator->heading_cos;
    const float s = estimator->heading_sin;
    const float north = plan->velocity_ned_m_s[0];
    const float east = plan->velocity_ned_m_s[1];
    const float speed = sqrtf(north * north + east * east);
    motion_t motion;
    memset(&motion, 0, sizeof motion);
    motion.climb_m_s = -plan->velocity_ned_m_s[2];
    if (speed > HOVER_M_S) {
        motion.speed_m_s = speed;
        motion.course.x = (c * east - s * north) / speed;
        motion.course.z = (c * north + s * east) / speed;
        motion.right = turned(motion.course);
    }
    return motion;
}

static void to_time(gauge_t *along, const motion_t *motion) {
    along->value /= motion->speed_m_s;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        along->by[i] /= motion->speed_m_s;
    }
}

/* Time to the closest approach, and the time at which the clearance counts: over the outline it is the lower end of the
 * flight. Value and derivatives are 0 for what is now. */
static void find_times(const outline_t *o, const motion_t *motion, goe_covariance_t covariance,
                       const approach_t *approach, gauge_t *first, gauge_t *lowest) {
    memset(lowest, 0, sizeof *lowest);
    if (approach->left.value > 0.0f || approach->right.value > 0.0f) {
        *first = along_course(o, motion->course, approach->left.value > 0.0f ? motion->right : negative(motion->right));
    } else {
        const float sigma_m = sigma_of(&approach->left, covariance);
        *first = outline_end(o, motion, -1.0f, sigma_m);
        if (motion->climb_m_s < 0.0f) {
            *lowest = outline_end(o, motion, 1.0f, sigma_m);
        }
    }
    if (!(first->value > 0.0f)) {
        memset(first, 0, sizeof *first);
    }
    if (!(lowest->value > 0.0f)) {
        *lowest = *first;
    }
    to_time(first, motion);
    to_time(lowest, motion);
}

/* What bounds the spread of the time whatever the derivatives say: the outline is met between its near and its far end.
 * They do at a grazed edge, where the entry moves at once from one end to the other. */
static float time_sd_most(const outline_t *o, const motion_t *motion, goe_covariance_t covariance) {
    const gauge_t far_end = reach(o, motion->course);
    const gauge_t near_end = reach(o, negative(motion->course));
    return (sigma_of(&near_end, covariance) + 0.5f * (far_end.value + near_end.value)) / motion->speed_m_s;
}

/* Variance of the time along an edge which, as far as the orientation is known, may lean either way from the course: then
 * the closest corner is its other end, if the outline is passed at all. */
static float edge_variance(const motion_t *motion, vector_t edge, float length_m, float sigma_rad, float passes) {
    const float lean = goe_absolute(dot(edge, motion->right));
    const float lead = goe_absolute(dot(edge, motion->course));
    const float other = passes * goe_normal_below(-lean / goe_larger(lead * sigma_rad, SIGMA_LEAST));
    const float between_s = lead * length_m / motion->speed_m_s;
    return other * (1.0f - other) * between_s * between_s;
}

static float time_sd(const outline_t *o, const motion_t *motion, const approach_t *a, const gauge_t *time,
                     goe_covariance_t covariance) {
    float sd = sigma_of(time, covariance);
    if (!(time->value > 0.0f)) {
        return 0.0f;
    }
    if (o->box) {
        const float sigma_rad = sqrtf(covariance[GOE_ORIENTATION][GOE_ORIENTATION]) * GOE_RAD_PER_DEG;
        const gauge_t *side = a->left.value > a->right.value ? &a->left : &a->right;
        const float passes = 1.0f - below(side, 0.0f, covariance);
        sd = sqrtf(sd * sd + edge_variance(motion, o->length_axis, o->length, sigma_rad, passes) +
                   edge_variance(motion, o->width_axis, 2.0f * o->half, sigma_rad, passes));
    }
    const float most = time_sd_most(o, motion, covariance);
    return bounded(sd < most ? sd : most);
}

/* The clearance at the time of `lowest`, sharing what the derivatives of a time do not tell of its sigma. */
static void find_clearance(const motion_t *motion, const gauge_t *lowest, float share, float height_m,
                           gauge_t *clearance) {
    clearance->value = height_m + motion->climb_m_s * lowest->value;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        clearance->by[i] = motion->climb_m_s * share * lowest->by[i];
    }
    clearance->by[GOE_HEIGHT] -= 1.0f;
}

static void find_approach(const outline_t *o, const motion_t *motion, goe_covariance_t covariance, float height_m,
                          approach_t *a) {
    gauge_t first;
    gauge_t lowest;
    float share = 0.0f;
    memset(a, 0, sizeof *a);
    memset(&lowest, 0, sizeof lowest);
    a->moves = motion->speed_m_s > 0.0f;
    if (a->moves) {
        a->left = distance(o, motion->right);
        a->right = distance(o, negative(motion->right));
        find_times(o, motion, covariance, a, &first, &lowest);
        a->time_s = first.value;
        a->time_sd_s = time_sd(o, motion, a, &first, covariance);
        share = time_sd(o, motion, a, &lowest, covariance) / goe_larger(sigma_of(&lowest, covariance), SIGMA_LEAST);
    }
    find_clearance(motion, &lowest, share, height_m, &a->clearance);
    a->ahead = distance(o, a->time_s > 0.0f ? motion->course
                           : o->box         ? way_from_box(o, motion)
                                            : way_from_disc(o, motion));
}

/* ------------------------------------------------------------------------------------------- sigmas and probability -- */

static const gauge_t *largest(const approach_t *a) {
    const gauge_t *side = a->left.value > a->right.value ? &a->left : &a->right;
    return a->moves && side->value > a->ahead.value ? side : &a->ahead;
}

/* Probability that the obstacle is not passed on the side that m points away from it. Each corner may spoil it, and the
 * one that is likeliest to is not always the nearest: the orientation moves some more than others. */
static float side_violation(const outline_t *o, vector_t m, const gauge_t *nearest, float margin_m,
                            goe_covariance_t covariance) {
    float most = below(nearest, margin_m, covariance);
    for (int i = 0; o->box && i < 4; i++) {
        const gauge_t d = corner(o, negative(m), (i & 1) ? 0.5f : -0.5f, (i & 2) ? 1.0f : 0.0f);
        const float p = below(&d, margin_m, covariance);
        most = p > most ? p : most;
    }
    return most;
}

/* Each is necessary for the margin to be violated: not passed on either side, and not out of the way along the course. */
static float margin_violation(const outline_t *o, const motion_t *motion, const approach_t *a, float margin_m,
                              goe_covariance_t covariance) {
    const float out = below(&a->ahead, margin_m, covariance);
    if (!a->moves) {
        return out;
    }
    const float sides = side_violation(o, motion->right, &a->left, margin_m, covariance) +
                        side_violation(o, negative(motion->right), &a->right, margin_m, covariance) - 1.0f;
    return sides < 0.0f ? 0.0f : sides < out ? sides : out;
}

/* Of two normal variables both below their limits. Independent: the product. Positively correlated: towards the smaller
 * of the two, in proportion; that is at most 0.014 below the truth and at most 0.053 above it. Negatively correlated:
 * the product is an upper bound. */
static float both(float p, float q, float correlation) {
    const float independent = p * q;
    const float share = correlation < 0.0f ? 0.0f : correlation > 1.0f ? 1.0f : correlation;
    return independent + share * ((p < q ? p : q) - independent);
}

static void tell(const outline_t *o, const motion_t *motion, const approach_t *a, const goe_plan_t *plan,
                 goe_covariance_t covariance, goe_hazard_t *hazard) {
    const gauge_t *miss = largest(a);
    hazard->time_s = bounded(a->time_s);
    hazard->time_sd_s = a->time_sd_s;
    hazard->miss_m = miss->value > 0.0f ? bounded(miss->value) : 0.0f;
    hazard->miss_sd_m = sigma_of(miss, covariance);
    hazard->violation = margin_violation(o, motion, a, plan->margin_m, covariance);
    if (hazard->has_clearance) {
        const float sd = sigma_of(&a->clearance, covariance);
        const float shared = product(miss, &a->clearance, covariance);
        const float correlation = shared / goe_larger(hazard->miss_sd_m, SIGMA_LEAST) / goe_larger(sd, SIGMA_LEAST);
        hazard->clearance_m = bounded(a->clearance.value);
        hazard->clearance_sd_m = sd;
        hazard->violation = both(hazard->violation, below(&a->clearance, plan->clearance_m, covariance), correlation);
    }
}

void goe_approach_foresee(const goe_estimator_t *estimator, const goe_plan_t *plan, float height_m,
                          goe_covariance_t covariance, goe_hazard_t *hazard) {
    approach_t approach;
    const goe_estimate_t *estimate = goe_told(estimator);
    const outline_t outline = outline_of(estimate);
    const motion_t motion = motion_of(estimator, plan);
    find_approach(&outline, &motion, covariance, height_m, &approach);
    hazard->has_clearance = (estimate->valid & GOE_HAS_HEIGHT) != 0u;
    tell(&outline, &motion, &approach, plan, covariance, hazard);
}
