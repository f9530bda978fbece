/* Candidates. SPDX-License-Identifier: MIT */
#include "goe_candidate.h"

#include "goe_flight_maths.h"

#define APART_US 1000000
#define OVERLAP_MIN 0.3f /* the usual threshold of trackers by overlap */

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

static goe_flight_candidate_t *find(goe_flight_candidate_t *table, const goe_flight_candidate_t *seen) {
    for (int i = 0; i < GOE_FLIGHT_CANDIDATES; i++) {
        if (is_same(&table[i], seen)) {
            return &table[i];
        }
    }
    return NULL;
}

static goe_flight_candidate_t *take_place(goe_flight_candidate_t *table, uint32_t time_us) {
    goe_flight_candidate_t *oldest = &table[0];
    for (int i = 0; i < GOE_FLIGHT_CANDIDATES; i++) {
        goe_flight_candidate_t *other = &table[i];
        if (other->images == 0) {
            return other;
        }
        if (goe_flight_between_us(time_us, other->time_us) > goe_flight_between_us(time_us, oldest->time_us)) {
            oldest = other;
        }
    }
    return oldest;
}

bool goe_flight_candidate_confirm(goe_flight_candidate_t table[GOE_FLIGHT_CANDIDATES],
                                  const goe_flight_candidate_t *seen, int images) {
    goe_flight_candidate_t *candidate = find(table, seen);
    uint8_t before = 0;
    if (!candidate) {
        candidate = take_place(table, seen->time_us);
    } else if (goe_flight_between_us(seen->time_us, candidate->time_us) <= 0) {
        return false; /* twice in one image */
    } else {
        before = candidate->images;
    }
    *candidate = *seen;
    candidate->images = (uint8_t)(before + 1);
    if (candidate->images < images) {
        return false;
    }
    candidate->images = 0;
    return true;
}
