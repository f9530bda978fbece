/* Clear fraction of an order's path. SPDX-License-Identifier: MIT
 *
 * The exact response of an autopilot is unknown: it obeys half a second late or two, and flies straight to the target or first parallel to
 * the line. The test therefore covers a region and not one path:
 *
 *   late     straight on for late_m, an arc of the turn's radius, straight to the target
 *   fan      the triangle from the earliest start of the turn to both sides of the circle around the target; or, if the aircraft
 *            flies through, to the target and to the start of a line parallel to the course
 *   end      the disc around the target, or the line flown beyond it
 *
 * A turn away has no fan: it is the turns from the earliest to the latest start.
 *
 * If the aircraft turns away before an obstacle, the obstacle's sigma along the least distance counts. On the way past it, the sigma across
 * the line of sight counts if it is smaller: the range becomes more certain as it shrinks, and the target moves with the obstacle. */
#include "goe_clear.h"

#include <math.h>

#include "goe_flight_maths.h"
#include "goe_lookout.h"
#include "goe_slot.h"

#define SURE_SIGMA 2.0f
#define DISTANCE_MAX_M 1.0e6f
#define LENGTH_MIN_M2 1.0e-6f
#define NOBODY (-1)

/* A part of a path. Straight: from, to. Arc: around a center, from one point to the other, to the right or to the left. */
typedef struct {
    float from_m[2], to_m[2], center_m[2];
    float radius_m;           /* 0: a straight leg */
    bool right, whole, minor; /* minor: less than half a circle */
} leg_t;

enum { LEGS = 8 };

typedef struct {
    leg_t leg[LEGS];
    int legs;
    float fan_m[3][2]; /* its corners */
    bool has_fan;
} region_t;

/* ------------------------------------------------------------------------------------------------------------- frame -- */

void goe_flight_clear_direct(const goe_flight_clear_own_t *own, const float direction_ne[2], float turned[2]) {
    turned[0] = own->course_ne[0] * direction_ne[0] + own->course_ne[1] * direction_ne[1];
    turned[1] = own->course_ne[0] * direction_ne[1] - own->course_ne[1] * direction_ne[0];
}

void goe_flight_clear_relate(const goe_flight_clear_own_t *own, const float place_ne_m[2], float at_m[2]) {
    const float away_m[2] = {place_ne_m[0] - own->ned_m[0], place_ne_m[1] - own->ned_m[1]};
    goe_flight_clear_direct(own, away_m, at_m);
}

static void turn_variance(const float course_ne[2], const float ne_m2[3], float turned_m2[3]) {
    const float c = course_ne[0];
    const float s = course_ne[1];
    turned_m2[0] = c * c * ne_m2[0] + 2.0f * c * s * ne_m2[1] + s * s * ne_m2[2];
    turned_m2[1] = c * s * (ne_m2[2] - ne_m2[0]) + (c * c - s * s) * ne_m2[1];
    turned_m2[2] = s * s * ne_m2[0] - 2.0f * c * s * ne_m2[1] + c * c * ne_m2[2];
}

/* One sigma of the position along the vector off_m of this length. */
static float sd_along_m(const float variance_m2[3], const float off_m[2], float length_m) {
    const float n = off_m[0] / length_m;
    const float e = off_m[1] / length_m;
    const float variance = n * n * variance_m2[0] + 2.0f * n * e * variance_m2[1] + e * e * variance_m2[2];
    return sqrtf(goe_flight_larger(variance, 0.0f));
}

bool goe_flight_clear_counts(const goe_flight_t *flight, int slot, float down_m) {
    const goe_flight_slot_t *one = &flight->slot[slot];
    const float clearance_m = goe_flight_lookout_doubt(flight, one) * flight->settings.clearance_m;
    const float top_down_m = one->ground_down_m - one->top_m - SURE_SIGMA * one->top_sd_m;
    const bool is_below = (one->valid & GOE_HAS_HEIGHT) != 0u && down_m < top_down_m - clearance_m;
    return one->used && (one->valid & GOE_HAS_POSITION) != 0u && !is_below;
}

void goe_flight_clear_slots(const goe_flight_t *flight, const goe_flight_clear_own_t *own,
                            goe_flight_clear_slot_t slots[GOE_FLIGHT_SLOTS]) {
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_slot_t *slot = &flight->slot[i];
        goe_flight_clear_slot_t *one = &slots[i];
        memset(one, 0, sizeof *one);
        if (!slot->used || (slot->valid & GOE_HAS_POSITION) == 0u) {
            continue;
        }
        const float doubt = goe_flight_lookout_doubt(flight, slot);
        goe_flight_clear_relate(own, slot->center_ne_m, one->at_m);
        turn_variance(own->course_ne, slot->covariance_ne_m2, one->variance_m2);
        const float sight_m2 = one->at_m[0] * one->at_m[0] + one->at_m[1] * one->at_m[1];
        const float across[2] = {-one->at_m[1], one->at_m[0]};
        one->across_sd_m = sd_along_m(one->variance_m2, across, sqrtf(goe_flight_larger(sight_m2, LENGTH_MIN_M2)));
        one->radius_m = goe_flight_slot_radius_m(slot) + goe_flight_lookout_drift_m(flight, slot, own->time_us);
        one->margin_m = goe_flight_larger(doubt * flight->settings.margin_m, GOE_FLIGHT_CLEAR_MARGIN_MIN_M);
        one->counts = goe_flight_clear_counts(flight, i, own->ned_m[2]);
    }
}

/* ---------------------------------------------------------------------------------------------------------- distance -- */

static float cross(const float a[2], const float b[2]) { return a[0] * b[1] - a[1] * b[0]; }
static float dot(const float a[2], const float b[2]) { return a[0] * b[0] + a[1] * b[1]; }

static void minus(const float a[2], const float b[2], float difference[2]) {
    difference[0] = a[0] - b[0];
    difference[1] = a[1] - b[1];
}

/* Computes off_m, from the nearest point of the leg to the place. Returns the square of its length. */
static float off_straight_m2(const float from_m[2], const float to_m[2], const float at_m[2], float off_m[2]) {
    float along[2];
    minus(to_m, from_m, along);
    minus(at_m, from_m, off_m);
    const float square = dot(along, along);
    const float share = square > LENGTH_MIN_M2 ? goe_flight_clamped(dot(off_m, along) / square, 0.0f, 1.0f) : 0.0f;
    off_m[0] -= share * along[0];
    off_m[1] -= share * along[1];
    return dot(off_m, off_m);
}

/* Whether the arc passes abeam of the place. Its ends belong to the legs before and after it. */
static bool is_abeam(const leg_t *leg, const float out_m[2]) {
    float from[2];
    float to[2];
    if (leg->whole) {
        return true;
    }
    const float hand = leg->right ? 1.0f : -1.0f;
    minus(leg->from_m, leg->center_m, from);
    minus(leg->to_m, leg->center_m, to);
    if (leg->minor && !(dot(from, out_m) + dot(to, out_m) > 0.0f)) {
        return false; /* on the other half of the circle */
    }
    if (leg->minor || hand * cross(from, to) >= 0.0f) {
        return hand * cross(from, out_m) >= 0.0f && hand * cross(out_m, to) >= 0.0f;
    }
    return !(hand * cross(to, out_m) > 0.0f && hand * cross(out_m, from) > 0.0f);
}

static float off_arc_m2(const leg_t *leg, const float at_m[2], float off_m[2]) {
    float out_m[2];
    minus(at_m, leg->center_m, out_m);
    const float square = dot(out_m, out_m);
    if (!is_abeam(leg, out_m) || !(square > LENGTH_MIN_M2)) {
        return DISTANCE_MAX_M * DISTANCE_MAX_M;
    }
    const float share = 1.0f - leg->radius_m / sqrtf(square);
    off_m[0] = share * out_m[0];
    off_m[1] = share * out_m[1];
    return share * share * square;
}

static bool is_in_fan(const region_t *region, const float at_m[2]) {
    int right = 0;
    int left = 0;
    for (int i = 0; i < 3; i++) {
        float side[2];
        float off[2];
        minus(region->fan_m[(i + 1) % 3], region->fan_m[i], side);
        minus(at_m, region->fan_m[i], off);
        const float turn = cross(side, off);
        right += turn > 0.0f ? 1 : 0;
        left += turn < 0.0f ? 1 : 0;
    }
    return right == 3 || left == 3;
}

static float sure_m(const goe_flight_clear_slot_t *slot, const goe_flight_clear_way_t *way, const float off_m[2],
                    float square, float within_m) {
    const float length_m = sqrtf(goe_flight_larger(square, LENGTH_MIN_M2));
    const float sd_m = sd_along_m(slot->variance_m2, off_m, length_m);
    const float passed_m = way->turns_away ? sd_m : goe_flight_smaller(sd_m, slot->across_sd_m);
    return length_m - within_m - slot->radius_m - way->sigmas * passed_m;
}

/* Sets the arc of a turn from the course toward the place. A place inside the turn's circle is not reached: the path is then the whole
 * circle. */
static void set_arc(leg_t *arc, float begin_m, float turn_m, const float place_m[2]) {
    const float begin[2] = {begin_m, 0.0f};
    float d[2];
    memset(arc, 0, sizeof *arc);
    arc->right = place_m[1] > 0.0f;
    arc->minor = place_m[0] > begin_m; /* decides for a very short arc, whatever the rounding */
    arc->radius_m = turn_m;
    arc->center_m[0] = begin_m;
    arc->center_m[1] = arc->right ? turn_m : -turn_m;
    minus(place_m, arc->center_m, d);
    const float square = dot(d, d);
    const float tangent_m2 = square - turn_m * turn_m;
    memcpy(arc->from_m, begin, sizeof begin);
    arc->whole = !(tangent_m2 > LENGTH_MIN_M2);
    if (arc->whole) {
        memcpy(arc->to_m, begin, sizeof begin);
        return;
    }
    const float along = turn_m * turn_m / square;
    const float across = (arc->right ? -turn_m : turn_m) * sqrtf(tangent_m2) / square;
    arc->to_m[0] = arc->center_m[0] + along * d[0] - across * d[1];
    arc->to_m[1] = arc->center_m[1] + along * d[1] + across * d[0];
}

/* Whether a turn away that begins between the earliest and the latest start leads over the place. Two circles of the turn's radius touch the
 * course and contain the place: their starts are half a chord before and behind it. */
static bool is_between(const goe_flight_clear_own_t *own, const goe_flight_clear_way_t *way, const float at_m[2]) {
    const float aside_m = way->target_m[1] > 0.0f ? at_m[1] : -at_m[1];
    const float square = aside_m * (2.0f * own->turn_m - aside_m);
    if (!way->turns_away || !(square > 0.0f)) {
        return false;
    }
    const float half_m = sqrtf(square);
    for (int side = -1; side <= 1; side += 2) {
        const float begin_m = at_m[0] + (float)side * half_m;
        leg_t arc;
        float out_m[2];
        if (begin_m > own->early_m && begin_m < own->late_m) {
            set_arc(&arc, begin_m, own->turn_m, way->target_m);
            minus(at_m, arc.center_m, out_m);
            if (is_abeam(&arc, out_m)) {
                return true;
            }
        }
    }
    return false;
}

/* Distance of the path to one obstacle's circle, minus the sigmas. */
static float spare_m(const region_t *region, const goe_flight_clear_own_t *own, const goe_flight_clear_way_t *way,
                     const goe_flight_clear_slot_t *slot) {
    float nearest[2] = {0.0f, 0.0f};
    float least = DISTANCE_MAX_M * DISTANCE_MAX_M;
    for (int i = 0; i < region->legs; i++) {
        const leg_t *leg = &region->leg[i];
        float off_m[2] = {0.0f, 0.0f};
        const float square = leg->radius_m > 0.0f ? off_arc_m2(leg, slot->at_m, off_m)
                                                  : off_straight_m2(leg->from_m, leg->to_m, slot->at_m, off_m);
        if (square < least) {
            least = square;
            memcpy(nearest, off_m, sizeof nearest);
        }
    }
    float spare = sure_m(slot, way, nearest, least, 0.0f);
    if ((region->has_fan && is_in_fan(region, slot->at_m)) || is_between(own, way, slot->at_m)) {
        spare = goe_flight_smaller(spare, -slot->radius_m);
    }
    if (way->circle_m > 0.0f) {
        float off_m[2];
        minus(slot->at_m, way->target_m, off_m);
        spare = goe_flight_smaller(spare, sure_m(slot, way, off_m, dot(off_m, off_m), way->circle_m));
    }
    return spare;
}

/* ------------------------------------------------------------------------------------------------------------ region -- */

static leg_t *add(region_t *region) {
    leg_t *leg = &region->leg[region->legs];
    region->legs += region->legs < LEGS - 1 ? 1 : 0;
    memset(leg, 0, sizeof *leg);
    return leg;
}

static void add_straight(region_t *region, const float from_m[2], const float to_m[2]) {
    leg_t *leg = add(region);
    memcpy(leg->from_m, from_m, sizeof leg->from_m);
    memcpy(leg->to_m, to_m, sizeof leg->to_m);
}

/* From the start of the turn on the course by an arc toward the place, then straight. */
static void add_turn(region_t *region, float begin_m, float turn_m, const float place_m[2]) {
    leg_t *arc = add(region);
    set_arc(arc, begin_m, turn_m, place_m);
    if (!arc->whole) {
        const float leaves[2] = {arc->to_m[0], arc->to_m[1]};
        add_straight(region, leaves, place_m);
    }
}

/* Between the straight legs of both turns away is a triangle. If the late turn is a whole circle, its start replaces the end of its arc. If
 * the early turn is one, all turns are, and there are no straight legs. */
static void fill_between(region_t *region, const float target_m[2]) {
    const leg_t *early = &region->leg[1];
    const leg_t *late = &region->leg[3];
    if (early->whole) {
        return;
    }
    region->has_fan = true;
    memcpy(region->fan_m[0], early->to_m, sizeof early->to_m);
    memcpy(region->fan_m[1], late->to_m, sizeof late->to_m);
    memcpy(region->fan_m[2], target_m, sizeof region->fan_m[2]);
}

/* A turn that begins later may be a whole circle, because the target is inside it. The first such circle is the outer end of all others. */
static void add_first_circle(region_t *region, const goe_flight_clear_own_t *own, const float target_m[2]) {
    const float aside_m = goe_flight_absolute(target_m[1]);
    const float square = aside_m * (2.0f * own->turn_m - aside_m);
    const float begin_m = target_m[0] - sqrtf(goe_flight_larger(square, 0.0f));
    if (square > 0.0f && begin_m > own->early_m && begin_m < own->late_m) {
        leg_t *circle = add(region);
        set_arc(circle, begin_m, own->turn_m, target_m);
        circle->whole = true; /* whatever the rounding */
    }
}

/* Both ends of the circle around the target, viewed from the start of the turn. inner_m: the one nearer to the course. */
static bool ends_of_circle(const float begin_m[2], const goe_flight_clear_way_t *way, float inner_m[2],
                           float outer_m[2]) {
    float to[2];
    minus(way->target_m, begin_m, to);
    const float square = dot(to, to);
    if (!(square > way->circle_m * way->circle_m)) {
        return false;
    }
    const float share = (way->target_m[1] > 0.0f ? way->circle_m : -way->circle_m) / sqrtf(square);
    inner_m[0] = way->target_m[0] + share * to[1];
    inner_m[1] = way->target_m[1] - share * to[0];
    outer_m[0] = way->target_m[0] - share * to[1];
    outer_m[1] = way->target_m[1] + share * to[0];
    return true;
}

/* The point at which an autopilot that leaves its line by 45 degrees at once begins to fly parallel to it. */
static void shift_aside(const float begin_m[2], const goe_flight_clear_way_t *way, float sideways_m[2]) {
    const float *line = way->line_m;
    float to[2];
    minus(way->target_m, begin_m, to);
    const float aside_m = cross(line, to);
    const float ahead_m = goe_flight_clamped(dot(line, to), 0.0f, goe_flight_absolute(aside_m));
    sideways_m[0] = begin_m[0] + ahead_m * line[0] - aside_m * line[1];
    sideways_m[1] = begin_m[1] + ahead_m * line[1] + aside_m * line[0];
}

static void add_fan(region_t *region, const float a_m[2], const float b_m[2], const float c_m[2]) {
    memcpy(region->fan_m[0], a_m, sizeof region->fan_m[0]);
    memcpy(region->fan_m[1], b_m, sizeof region->fan_m[1]);
    memcpy(region->fan_m[2], c_m, sizeof region->fan_m[2]);
    region->has_fan = true;
    add_straight(region, a_m, b_m);
    add_straight(region, a_m, c_m);
    add_straight(region, b_m, c_m);
}

static void begin_region(const goe_flight_clear_own_t *own, const goe_flight_clear_way_t *way, region_t *region) {
    const float here_m[2] = {0.0f, 0.0f};
    const float early_m[2] = {own->early_m, 0.0f};
    const float late_m[2] = {own->late_m, 0.0f};
    float inner_m[2] = {way->target_m[0], way->target_m[1]};
    float outer_m[2] = {way->target_m[0], way->target_m[1]};
    region->legs = 0;
    region->has_fan = false;
    add_straight(region, here_m, late_m);
    if (way->turns_away) {
        add_turn(region, own->early_m, own->turn_m, way->target_m);
        add_turn(region, own->late_m, own->turn_m, way->target_m);
        fill_between(region, way->target_m);
        add_first_circle(region, own, way->target_m);
        return;
    }
    if (way->circle_m > 0.0f && !ends_of_circle(early_m, way, inner_m, outer_m)) {
        return; /* already on the circle */
    }
    if (!(way->circle_m > 0.0f) && way->shifts) { /* leaves the course by 45 degrees, at once */
        shift_aside(early_m, way, outer_m);
    }
    add_turn(region, own->late_m, own->turn_m, inner_m);
    add_fan(region, early_m, inner_m, outer_m);
    if (!(way->circle_m > 0.0f)) {
        const float on_m[2] = {way->target_m[0] + own->through_m * way->line_m[0],
                               way->target_m[1] + own->through_m * way->line_m[1]};
        add_straight(region, way->target_m, on_m);
    }
}

float goe_flight_clear_share(const goe_flight_clear_own_t *own, const goe_flight_clear_slot_t slots[GOE_FLIGHT_SLOTS],
                             const goe_flight_clear_way_t *way, float enough, int *nearest) {
    region_t region;
    float least = GOE_FLIGHT_CLEAR_MAX;
    *nearest = NOBODY;
    begin_region(own, way, &region);
    for (int i = 0; i < GOE_FLIGHT_SLOTS && least >= enough; i++) {
        if (slots[i].counts) {
            const float share = spare_m(&region, own, way, &slots[i]) / slots[i].margin_m;
            if (!(share >= least)) { /* also NaN */
                least = share;
                *nearest = i;
            }
        }
    }
    return goe_flight_larger(least, -GOE_FLIGHT_CLEAR_MAX);
}
