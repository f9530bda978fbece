/* Table of new obstacles that wait for confirmation or for a slot. SPDX-License-Identifier: MIT */
#include "goe_candidate.h"

#include "goe_flight_maths.h"

#define APART_US 1000000
#define BURIED_US 10000000 /* longer than the delay of any image */
#define WAITING 1          /* value of `images` while no image counts */
#define OVERLAP_MIN 0.3f   /* usual threshold of trackers that match by overlap */

static float length(int from, int to) { return to > from ? (float)(to - from) : 0.0f; }

float goe_flight_candidate_overlap(const int16_t a[4], const int16_t b[4]) {
    const float across = length(a[0] > b[0] ? a[0] : b[0], a[2] < b[2] ? a[2] : b[2]);
    const float down = length(a[1] > b[1] ? a[1] : b[1], a[3] < b[3] ? a[3] : b[3]);
    const float both = across * down;
    const float all = length(a[0], a[2]) * length(a[1], a[3]) + length(b[0], b[2]) * length(b[1], b[3]) - both;
    return all > 0.0f ? both / all : 0.0f;
}

static bool is_same(const goe_flight_candidate_t *candidate, const goe_flight_candidate_t *seen) {
    if (candidate->images == 0 || goe_flight_between_us(seen->time_us, candidate->time_us) > APART_US ||
        candidate->id != seen->id || candidate->camera != seen->camera) {
        return false;
    }
    return seen->id != 0u || goe_flight_candidate_overlap(candidate->box_px, seen->box_px) >= OVERLAP_MIN;
}

/* Index of this detection's candidate; GOE_FLIGHT_CANDIDATES: there is none. */
static int find(const goe_flight_candidate_t *table, const goe_flight_candidate_t *seen) {
    int i = 0;
    while (i < GOE_FLIGHT_CANDIDATES && !is_same(&table[i], seen)) {
        i++;
    }
    return i;
}

/* A free place, or that of the candidate undetected for the longest. */
static goe_flight_candidate_t *place_for(goe_flight_waiting_t *waiting, uint32_t time_us) {
    goe_flight_candidate_t *oldest = &waiting->place[0];
    for (int i = 0; i < GOE_FLIGHT_CANDIDATES; i++) {
        goe_flight_candidate_t *other = &waiting->place[i];
        if (other->images == 0) {
            return other;
        }
        if (goe_flight_between_us(time_us, other->time_us) > goe_flight_between_us(time_us, oldest->time_us)) {
            oldest = other;
        }
    }
    goe_flight_candidate_crowd(waiting, time_us);
    return oldest;
}

void goe_flight_candidate_crowd(goe_flight_waiting_t *waiting, uint32_t time_us) {
    if (!waiting->crowded || goe_flight_between_us(time_us, waiting->crowded_us) > 0) {
        waiting->crowded_us = time_us; /* an older image shortens no mark */
    }
    waiting->crowded = true;
}

void goe_flight_candidate_return(goe_flight_waiting_t *waiting, const goe_flight_candidate_t *seen, uint32_t now_us) {
    if (goe_flight_between_us(now_us, seen->time_us) > APART_US) {
        return;
    }
    goe_flight_candidate_t *candidate = place_for(waiting, seen->time_us);
    *candidate = *seen;
    candidate->images = WAITING;
}

bool goe_flight_candidate_confirm(goe_flight_waiting_t *waiting, const goe_flight_candidate_t *seen, int images) {
    const int found = find(waiting->place, seen);
    const bool known = found < GOE_FLIGHT_CANDIDATES;
    goe_flight_candidate_t *candidate = known ? &waiting->place[found] : place_for(waiting, seen->time_us);
    if (known && goe_flight_between_us(seen->time_us, candidate->time_us) <= 0) {
        goe_flight_candidate_crowd(waiting, seen->time_us); /* twice in one image */
        return false;
    }
    const uint8_t before = known ? candidate->images : WAITING;
    *candidate = *seen;
    candidate->images = (uint8_t)(before + 1);
    if (candidate->images < images + WAITING) {
        return false;
    }
    candidate->images = 0;
    return true;
}

static void forget(goe_flight_waiting_t *waiting, unsigned cameras, uint32_t time_us, int32_t after_us) {
    for (int i = 0; i < GOE_FLIGHT_CANDIDATES; i++) {
        goe_flight_candidate_t *candidate = &waiting->place[i];
        const bool meant = candidate->camera >= GOE_CAMERAS_MAX || ((cameras >> candidate->camera) & 1u) != 0u;
        if (meant && goe_flight_between_us(time_us, candidate->time_us) > after_us) {
            candidate->images = 0;
        }
    }
    waiting->crowded = waiting->crowded && goe_flight_between_us(time_us, waiting->crowded_us) <= after_us;
}

void goe_flight_candidate_expire(goe_flight_waiting_t *waiting, uint8_t camera, uint32_t time_us) {
    forget(waiting, 1u << camera, time_us, APART_US);
}

void goe_flight_candidate_bury(goe_flight_waiting_t *waiting, uint32_t now_us) {
    forget(waiting, (1u << GOE_CAMERAS_MAX) - 1u, now_us, BURIED_US);
}

int goe_flight_candidate_count(const goe_flight_waiting_t *waiting) {
    int count = waiting->crowded ? 1 : 0;
    for (int i = 0; i < GOE_FLIGHT_CANDIDATES; i++) {
        count += waiting->place[i].images != 0 ? 1 : 0;
    }
    return count;
}
