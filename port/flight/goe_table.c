/* Assigns detections to slots, and ends tracks. SPDX-License-Identifier: MIT */
#include "goe_table.h"

#include "goe_candidate.h"
#include "goe_flight_maths.h"
#include "goe_flight_seal.h"
#include "goe_parts.h"

#define COORDINATE_MAX_PX 1.0e5f
#define PIXEL_SD_MAX_PX 100.0f
#define UNDETECTED_S 2.0f /* after this time a track without a position, or a passed one, may be evicted */
#define WORTH_KEPT 0.5f   /* a slot of a higher worth is never evicted */
#define ABEAM_DEG 90.0f
#define AVOIDED_S                                                                                                      \
    600.0f /* the track of an order's obstacle ends no sooner: HOLD circles before it, perhaps out of view */
#define ORDERED_S 120.0f /* that of another one, while an order is active: the way back may lead past it */
#define MOVING_S 30.0f   /* that of one that moves: its place, and with it the order's target, drifts away */
#define NOBODY (-1)

/* ------------------------------------------------------------------------------------------------------- detections -- */

static bool is_good_pixel(const goe_pixel_t *p) {
    return !goe_flight_is_set(&p->visible) ||
           (goe_flight_within(p->u_px, COORDINATE_MAX_PX) && goe_flight_within(p->v_px, COORDINATE_MAX_PX));
}

static bool is_good_box(const goe_box_t *b) {
    const float side[4] = {b->left_px, b->top_px, b->right_px, b->bottom_px};
    const uint8_t mask[4] = {GOE_SIDE_LEFT, GOE_SIDE_TOP, GOE_SIDE_RIGHT, GOE_SIDE_BOTTOM};
    for (int i = 0; i < 4; i++) {
        if ((b->sides & mask[i]) != 0u && !goe_flight_within(side[i], COORDINATE_MAX_PX)) {
            return false;
        }
    }
    const bool across = (b->sides & GOE_SIDE_LEFT) != 0u && (b->sides & GOE_SIDE_RIGHT) != 0u;
    const bool down = (b->sides & GOE_SIDE_TOP) != 0u && (b->sides & GOE_SIDE_BOTTOM) != 0u;
    return b->sides <= GOE_SIDES_ALL && (!across || b->left_px < b->right_px) && (!down || b->top_px < b->bottom_px);
}

static bool is_good(const goe_flight_detection_t *d) {
    return goe_flight_within(d->score, 1.0f) && d->score >= 0.0f && goe_flight_within(d->pixel_px, PIXEL_SD_MAX_PX) &&
           d->pixel_px >= 0.0f && is_good_box(&d->box) && is_good_pixel(&d->left) && is_good_pixel(&d->right) &&
           is_good_pixel(&d->top) && is_good_pixel(&d->base_left) && is_good_pixel(&d->base_near) &&
           is_good_pixel(&d->base_right);
}

/* A score of exactly 0 means no score: a field that nobody set must not hide an obstacle. */
static bool is_weak(float score, float least) { return score > 0.0f && score < least; }

/* The detections to use, as bits. The others are counted, and so are bad kinds of used ones. *readable: there is a readable detection, or
 * the image has none. */
static uint32_t usable(goe_flight_t *flight, const goe_flight_slot_view_t *view, const goe_flight_frame_t *frame,
                       bool *readable) {
    uint32_t bits = 0u;
    *readable = frame->number == 0u && frame->count == 0u;
    for (int k = 0; k < frame->count; k++) {
        if (!is_good(&frame->detection[k])) {
            goe_flight_count(&flight->counters.refused);
            goe_flight_candidate_crowd(&flight->waiting, view->time_us);
        } else if (is_weak(frame->detection[k].score, flight->settings.score_min)) {
            goe_flight_count(&flight->counters.weak);
            *readable = true;
        } else {
            if (!goe_flight_slot_is_good_kind(&frame->detection[k].kind)) {
                goe_flight_count(&flight->counters.refused);
            }
            bits |= 1u << k;
            *readable = true;
        }
    }
    return bits;
}

/* ------------------------------------------------------------------------------------------------------------- slots -- */

static int slot_of(const goe_flight_t *flight, uint8_t camera, uint32_t id) {
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_slot_t *slot = &flight->slot[i];
        if (id != 0u && slot->used && slot->id == id && slot->camera == camera) {
            return i;
        }
    }
    return NOBODY;
}

/* The slot whose obstacle this box shows best. lost: the slots that may be taken over, as bits. */
static int claimant(const goe_flight_t *flight, const goe_flight_slot_view_t *view, uint32_t lost,
                    const int16_t box_px[4], float *claim) {
    int best = NOBODY;
    *claim = 0.0f;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const float other =
            ((lost >> i) & 1u) != 0u ? goe_flight_slot_claims(&flight->slot[i], flight->camera, view, box_px) : 0.0f;
        if (other > *claim) {
            *claim = other;
            best = i;
        }
    }
    return best;
}

/* Slots without a detection in this image. While the image is incomplete, slots with a detection in the previous image are left out: theirs
 * may still come. */
static uint32_t lost_slots(const goe_flight_t *flight, const goe_flight_slot_view_t *view, uint32_t taken,
                           bool complete) {
    uint32_t bits = 0u;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_slot_t *slot = &flight->slot[i];
        const bool may_come = !complete && slot->id != 0u && slot->camera == view->camera && slot->in_view;
        if (slot->used && !may_come) {
            bits |= 1u << i;
        }
    }
    return bits & ~taken;
}

/* The slot of the lowest worth is evicted first. */
static float worth(const goe_flight_t *flight, int i, uint32_t now_us) {
    const goe_flight_slot_t *slot = &flight->slot[i];
    const bool undetected = goe_flight_between_s(now_us, slot->detected_us) > UNDETECTED_S;
    const bool has_position = (slot->valid & GOE_HAS_POSITION) != 0u;
    if (!slot->used) {
        return -3.0f;
    }
    if (i == flight->reaction.slot || i == flight->reaction.edge) {
        return 2.0f; /* the target moves with both */
    }
    if (undetected && !has_position) {
        return -2.0f;
    }
    if (undetected && slot->assessed && !(slot->hazard.tcpa_s > 0.0f)) {
        return -1.0f;
    }
    if (!slot->assessed) {
        return WORTH_KEPT;
    }
    const float tcpa_s = slot->hazard.tcpa_s; /* 0 of a passed obstacle, which is not near in time */
    return slot->hazard.conflict_probability + (tcpa_s > 0.0f ? 1.0f / (1.0f + tcpa_s) : 0.0f);
}

/* Whether a new obstacle may be ahead on the course. */
static bool may_be_ahead(const goe_flight_t *flight, const goe_flight_bearings_t *bearings) {
    const float *v = flight->velocity_ned_m_s;
    const float course_deg = goe_flight_atan2_deg(v[1], v[0]);
    const float off_deg = goe_flight_positive_deg((float)bearings->middle_deg - course_deg + 180.0f) - 180.0f;
    const bool moves = goe_flight_square(v[0]) + goe_flight_square(v[1]) > goe_flight_square(GOE_FLIGHT_COURSE_MIN_M_S);
    return moves && goe_flight_within(off_deg, ABEAM_DEG + (float)bearings->half_deg);
}

/* The slot for a new obstacle. One that is not ahead evicts no obstacle in view: passed obstacles would evict each other again and again. */
static int free_place(goe_flight_t *flight, const goe_flight_bearings_t *bearings, uint32_t now_us) {
    int least = NOBODY;
    float least_worth = may_be_ahead(flight, bearings) ? WORTH_KEPT : 0.0f;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const float value = worth(flight, i, now_us);
        if (value < least_worth) {
            least_worth = value;
            least = i;
        }
    }
    if (least == NOBODY) {
        goe_flight_count(&flight->counters.full);
    } else if (flight->slot[least].used) {
        goe_flight_count(&flight->counters.evicted);
    }
    return least;
}

/* The next obstacle in this slot is neither that of the order, nor the one whose outline determines its target. */
static void release(goe_flight_reaction_t *reaction, int i) {
    if (i == reaction->slot) {
        reaction->slot = NOBODY;
    }
    if (i == reaction->edge) {
        reaction->edge = NOBODY;
        reaction->gap = false;
    }
}

/* ------------------------------------------------------------------------------------------------------------- frame -- */

/* An estimator that lost its own settings takes those of another slot. */
static void mend(goe_flight_t *flight, int i) {
    goe_estimator_t *lost = &flight->slot[i].estimator;
    for (int k = 0; k < GOE_FLIGHT_SLOTS; k++) {
        if (k != i) {
            memcpy(lost, &flight->slot[k].estimator, sizeof *lost);
        }
        if (k != i && goe_reset(lost) == GOE_OK) {
            memset(lost->fault_counts, 0, sizeof lost->fault_counts);
            return;
        }
    }
    goe_flight_unseal(flight);
}

static void give(goe_flight_t *flight, int i, const goe_flight_slot_view_t *view, const goe_flight_detection_t *seen,
                 uint32_t *taken) {
    if (flight->slot[i].fresh_track && goe_reset(&flight->slot[i].estimator) != GOE_OK) {
        mend(flight, i);
    }
    goe_flight_slot_take(&flight->slot[i], flight->camera, view, flight->marks.jumps_ned_m, seen);
    *taken |= 1u << i;
}

static void give_known(goe_flight_t *flight, const goe_flight_slot_view_t *view, const goe_flight_frame_t *frame,
                       uint32_t *waiting, uint32_t *taken) {
    for (int k = 0; k < frame->count; k++) {
        const int i = ((*waiting >> k) & 1u) != 0u ? slot_of(flight, view->camera, frame->detection[k].id) : NOBODY;
        if (i != NOBODY) {
            *waiting &= ~(1u << k);
            if (((*taken >> i) & 1u) == 0u) {
                give(flight, i, view, &frame->detection[k], taken);
            } else { /* a second detection of this id */
                goe_flight_candidate_crowd(&flight->waiting, view->time_us);
            }
        }
    }
}

/* Whether another waiting detection shows the obstacle of a slot better. */
static bool is_outdone(const goe_flight_t *flight, const goe_flight_slot_view_t *view, const goe_flight_frame_t *frame,
                       uint32_t waiting, int slot, float claim) {
    for (int k = 0; k < frame->count; k++) {
        int16_t box_px[4];
        if (((waiting >> k) & 1u) != 0u && goe_flight_slot_box_of(&frame->detection[k], box_px) &&
            goe_flight_slot_claims(&flight->slot[slot], flight->camera, view, box_px) > claim) {
            return true;
        }
    }
    return false;
}

/* The slot takes the id of its latest detection. A late image of another camera shows the obstacle, but is not the latest. */
static void renumber(goe_flight_t *flight, goe_flight_slot_t *slot, const goe_flight_slot_view_t *view, uint32_t id) {
    if (slot->detected_us != view->time_us || slot->camera != view->camera) {
        return;
    }
    if (id != slot->id) {
        goe_flight_count(&flight->counters.renumbered);
    }
    slot->id = id;
}

static void give_renumbered(goe_flight_t *flight, const goe_flight_slot_view_t *view, const goe_flight_frame_t *frame,
                            bool complete, uint32_t *waiting, uint32_t *taken) {
    for (int k = 0; k < frame->count; k++) {
        const goe_flight_detection_t *detection = &frame->detection[k];
        int16_t box_px[4];
        float claim;
        if (((*waiting >> k) & 1u) == 0u || !goe_flight_slot_box_of(detection, box_px)) {
            continue;
        }
        const int i = claimant(flight, view, lost_slots(flight, view, *taken, complete), box_px, &claim);
        if (i != NOBODY && !is_outdone(flight, view, frame, *waiting, i, claim)) {
            *waiting &= ~(1u << k);
            give(flight, i, view, detection, taken);
            renumber(flight, &flight->slot[i], view, detection->id);
        }
    }
}

/* The obstacle of an evicted slot waits for another slot. */
static void wait_again(goe_flight_t *flight, const goe_flight_slot_t *slot, uint32_t now_us) {
    goe_flight_candidate_t candidate = {slot->id, slot->detected_us, {0, 0, 0, 0}, slot->camera, 0, slot->bearings};
    memcpy(candidate.box_px, slot->box_px, sizeof candidate.box_px);
    if (slot->used) {
        goe_flight_candidate_return(&flight->waiting, &candidate, now_us);
    }
}

static void give_new(goe_flight_t *flight, const goe_flight_slot_view_t *view, const goe_flight_frame_t *frame,
                     uint32_t waiting, uint32_t *taken) {
    for (int k = 0; k < frame->count; k++) {
        const goe_flight_detection_t *detection = &frame->detection[k];
        goe_flight_candidate_t candidate = {detection->id, view->time_us, {0, 0, 0, 0}, view->camera, 0, {0, 0}};
        if (((waiting >> k) & 1u) == 0u) {
            continue;
        }
        goe_flight_slot_bearings_of(detection, &flight->camera[view->camera], view->pose.q, &candidate.bearings);
        if (!goe_flight_slot_box_of(detection, candidate.box_px) && detection->id == 0u) {
            goe_flight_candidate_crowd(&flight->waiting, view->time_us); /* no other image can be matched to it */
            continue;
        }
        if (!goe_flight_candidate_confirm(&flight->waiting, &candidate, (int)flight->settings.confirm_images)) {
            continue;
        }
        const int i = free_place(flight, &candidate.bearings, view->time_us);
        if (i != NOBODY) {
            wait_again(flight, &flight->slot[i], view->time_us);
            release(&flight->reaction, i);
            goe_flight_slot_begin(&flight->slot[i], detection->id, view->time_us);
            give(flight, i, view, detection, taken);
        } else {
            goe_flight_candidate_return(&flight->waiting, &candidate, view->time_us);
        }
    }
}

/* Images of two cameras need not come in the order of their exposures: an image without the obstacle must not block one of the other
 * camera. */
static void give_nothing(goe_flight_t *flight, const goe_flight_slot_view_t *view, uint32_t taken) {
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        goe_flight_slot_t *slot = &flight->slot[i];
        if (slot->used && slot->camera == view->camera && ((taken >> i) & 1u) == 0u) {
            slot->in_view = slot->in_view && goe_flight_between_us(view->time_us, slot->detected_us) <= 0;
            give(flight, i, view, NULL, &taken);
        }
    }
}

bool goe_flight_table_take(goe_flight_t *flight, const goe_flight_slot_view_t *view, const goe_flight_frame_t *frame) {
    goe_flight_parts_t *parts = &flight->parts[view->camera];
    bool readable;
    goe_flight_candidate_expire(&flight->waiting, view->camera, view->time_us);
    const bool complete = goe_flight_parts_add(parts, view, frame);
    uint32_t waiting = usable(flight, view, frame, &readable);
    give_known(flight, view, frame, &waiting, &parts->taken);
    give_renumbered(flight, view, frame, complete, &waiting, &parts->taken);
    give_new(flight, view, frame, waiting, &parts->taken);
    if (complete) {
        give_nothing(flight, view, parts->taken);
        goe_flight_parts_keep(parts, view, (uint32_t)flight->base_us);
    }
    return readable;
}

/* An obstacle ahead on the course is kept, however long it was undetected. */
static bool is_ahead(const goe_flight_t *flight, const goe_flight_slot_t *slot) {
    return slot->assessed && slot->hazard.tcpa_s > 0.0f &&
           slot->hazard.conflict_probability >= flight->settings.conflict_probability_max;
}

/* Whether an order is active, or ended shortly before: its obstacle must still be reported, then without an order. */
static bool is_ordered(const goe_flight_reaction_t *reaction) {
    return reaction->action != GOE_FLIGHT_NONE || reaction->falling;
}

/* Time for which a slot's track may be undetected. */
static float most_s(const goe_flight_t *flight, int i) {
    const float timeout_s = flight->settings.track_timeout_s;
    if (!is_ordered(&flight->reaction)) {
        return timeout_s;
    }
    const bool moves = (flight->slot[i].valid & GOE_HAS_VELOCITY) != 0u;
    /* an order that has ended no longer names its obstacle */
    const bool avoided = i == flight->reaction.slot || flight->reaction.action == GOE_FLIGHT_NONE;
    const float standing_s = avoided ? AVOIDED_S : ORDERED_S;
    return goe_flight_larger(moves ? MOVING_S : standing_s, timeout_s);
}

void goe_flight_table_age(goe_flight_t *flight, uint32_t now_us) {
    goe_flight_candidate_bury(&flight->waiting, now_us);
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        goe_flight_slot_t *slot = &flight->slot[i];
        const float undetected_s = goe_flight_between_s(now_us, slot->detected_us);
        slot->used = slot->used && (undetected_s <= most_s(flight, i) || is_ahead(flight, slot));
        if (!slot->used) {
            release(&flight->reaction, i);
        }
    }
}

void goe_flight_table_follow(goe_flight_t *flight, const goe_flight_slot_view_t *view) {
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        goe_flight_slot_t *slot = &flight->slot[i];
        if (slot->used && !slot->fresh_track && goe_flight_between_us(view->time_us, slot->taken_us) > 0) {
            goe_flight_slot_take(slot, flight->camera, view, flight->marks.jumps_ned_m, NULL);
        }
    }
}
