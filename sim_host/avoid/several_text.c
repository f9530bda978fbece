/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "several_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "aviation_text.h"
#include "flown.h"

#define FALSE_SHARE_MAX 0.02
#define CHANGES_MAX 1

static const double obey_s[] = {0.5, 1.0, 1.5, 2.0};
static const double frame_s[] = {0.1, 0.3};
enum { OBEYS = sizeof obey_s / sizeof obey_s[0], FRAMES = sizeof frame_s / sizeof frame_s[0] };

typedef struct {
    int flights, ordered, late, possible, missed, collided, excused, changed, least_bad, by_action[GOE_FLIGHT_HOLD + 1];
    double closest_m; /* where it was possible */
} tally_t;

several_case_t several_case(int k, uint64_t seed, bool new_ids) {
    several_case_t setup;
    memset(&setup, 0, sizeof setup);
    setup.kind = (several_kind_t)(k % SEVERAL_KINDS);
    setup.seed = seed;
    setup.new_ids = new_ids;
    setup.obey_s = obey_s[k / SEVERAL_KINDS % OBEYS];
    setup.circles = k / (SEVERAL_KINDS * OBEYS) % 2 != 0;
    setup.frame_s = frame_s[k / (SEVERAL_KINDS * OBEYS * 2) % FRAMES];
    return setup;
}

static void count(tally_t *tally, const several_outcome_t *outcome) {
    tally->closest_m = tally->flights == 0 ? HUGE_VAL : tally->closest_m;
    tally->flights++;
    tally->ordered += outcome->ordered ? 1 : 0;
    tally->late += outcome->late ? 1 : 0;
    tally->possible += outcome->possible ? 1 : 0;
    tally->missed += several_misses(outcome) ? 1 : 0;
    tally->collided += outcome->collided && outcome->possible ? 1 : 0;
    tally->excused += outcome->collided && !outcome->possible ? 1 : 0;
    tally->changed += outcome->changes > CHANGES_MAX ? 1 : 0;
    tally->least_bad += outcome->reason == GOE_FLIGHT_REASON_LEAST_BAD ? 1 : 0;
    tally->by_action[outcome->action]++;
    if (outcome->possible) {
        tally->closest_m = fmin(tally->closest_m, outcome->closest_m);
    }
}

static void print_row(const char *what, const char *name, const tally_t *tally) {
    if (tally->flights == 0) {
        return;
    }
    printf("| %s%s | %d | %d | %d | %d (%d) | %d | %.1f | %d | ", what, name, tally->flights, tally->ordered,
           tally->possible, tally->collided, tally->excused, tally->missed, tally->closest_m, tally->changed);
    for (int action = GOE_FLIGHT_LEFT; action <= GOE_FLIGHT_HOLD; action++) {
        if (tally->by_action[action] > 0) {
            printf("%s %d ", goe_flight_action_text((goe_flight_action_t)action), tally->by_action[action]);
        }
    }
    printf("| %d | %d |\n", tally->least_bad, tally->late);
}

static void print_miss(int k, const several_case_t *setup, const several_outcome_t *outcome) {
    printf("%d %s seed %" PRIu64 ": %d obstacles, offset %.0f m, obeyed after %.1f s, %s, boxes after %.1f s: %s %s%s "
           "%.1f s ahead, closest %.1f m%s, %d changes, %s\n",
           k, SEVERAL_NAMES[setup->kind], setup->seed, outcome->obstacles, outcome->offset_m, setup->obey_s,
           setup->circles ? "circles" : "line", setup->frame_s, goe_flight_action_text(outcome->action),
           goe_flight_reason_text(outcome->reason), outcome->late ? " (late)" : "", outcome->ahead_s,
           outcome->closest_m, outcome->collided ? " (hit)" : "", outcome->changes,
           outcome->known ? "all known" : "not all known");
}

static bool print_goal(const char *what, int missed, int of, double most_share) {
    const bool met = missed <= (int)(most_share * of);
    printf("| %s | %d of %d | %s |\n", what, missed, of, met ? "met" : "missed");
    return met;
}

/* ---------------------------------------------------------------------------------------------------------- campaign -- */

typedef struct {
    bool lists, new_ids;
    tally_t all, by_kind[SEVERAL_KINDS], by_number[FLOWN_MAX + 1], by_obey[OBEYS], by_autopilot[2];
    aviation_flight_t *flown;
    double *scratch;
} campaign_t;

static void tally_up(campaign_t *campaign, int k, const several_case_t *setup, const several_outcome_t *outcome) {
    count(&campaign->all, outcome);
    count(&campaign->by_kind[setup->kind], outcome);
    count(&campaign->by_number[outcome->obstacles], outcome);
    count(&campaign->by_obey[k / SEVERAL_KINDS % OBEYS], outcome);
    count(&campaign->by_autopilot[setup->circles ? 1 : 0], outcome);
}

/* Flight k, with orders and without. */
static bool fly(campaign_t *campaign, int k, uint64_t seed) {
    several_outcome_t outcome, nominal;
    const several_case_t setup = several_case(k, seed, campaign->new_ids);
    const char *fault = several_fly(&setup, &outcome);
    fault = fault != NULL ? fault : several_fly_nominal(&setup, &nominal);
    if (fault != NULL) {
        (void)fprintf(stderr, "goe_avoid: %s, seed %" PRIu64 ": %s\n", SEVERAL_NAMES[setup.kind], setup.seed, fault);
        return false;
    }
    if (campaign->lists && (several_misses(&outcome) || outcome.changes > CHANGES_MAX ||
                            (setup.kind == SEVERAL_BETWEEN && outcome.ordered))) {
        print_miss(k, &setup, &outcome);
    }
    tally_up(campaign, k, &setup, &outcome);
    campaign->flown[k] = several_counted(&outcome, &nominal);
    return true;
}

static void print_flights(const campaign_t *campaign) {
    puts("| flights | number | with an order | passable | collisions (not passable) | below 5 m | closest, m | changes "
         "of side above 1 | first orders | least bad | late |");
    puts("|---|---|---|---|---|---|---|---|---|---|---|");
    for (int kind = 0; kind < SEVERAL_KINDS; kind++) {
        print_row("", SEVERAL_NAMES[kind], &campaign->by_kind[kind]);
    }
    for (int number = 1; number <= FLOWN_MAX; number++) {
        char name[24];
        (void)snprintf(name, sizeof name, "%d", number);
        print_row("obstacles: ", name, &campaign->by_number[number]);
    }
    for (int i = 0; i < OBEYS; i++) {
        char name[24];
        (void)snprintf(name, sizeof name, "%.1f s", obey_s[i]);
        print_row("obeyed after ", name, &campaign->by_obey[i]);
    }
    print_row("flying straight on", "", &campaign->by_autopilot[0]);
    print_row("about the target", "", &campaign->by_autopilot[1]);
}

static bool print_goals(const campaign_t *campaign) {
    const tally_t *all = &campaign->all, *between = &campaign->by_kind[SEVERAL_BETWEEN];
    puts("");
    puts("| goal | missed by | |");
    puts("|---|---|---|");
    bool met = print_goal("no collision where a search finds a path", all->collided, all->possible, 0.0);
    met = print_goal("5 m to every wall where a search finds a path", all->missed, all->possible, 0.0) && met;
    met = print_goal("at most one change of side", all->changed, all->flights, 0.0) && met;
    return print_goal("at most 2 % orders between two at twice the margin", between->ordered, between->flights,
                      FALSE_SHARE_MAX) &&
           met;
}

static bool fly_all(campaign_t *campaign, int flights, uint64_t first, uint64_t step) {
    for (int k = 0; k < flights; k++) {
        if (!fly(campaign, k, first + (uint64_t)k * step)) {
            return false;
        }
    }
    return true;
}

bool several_campaign(int flights, uint64_t first, uint64_t step, bool lists, bool new_ids, bool *met) {
    campaign_t campaign;
    memset(&campaign, 0, sizeof campaign);
    campaign.lists = lists;
    campaign.new_ids = new_ids;
    campaign.flown = calloc((size_t)flights, sizeof *campaign.flown);
    campaign.scratch = calloc((size_t)flights, sizeof *campaign.scratch);
    bool done = campaign.flown != NULL && campaign.scratch != NULL;
    if (!done) {
        (void)fputs("goe_avoid: --several: out of memory\n", stderr);
    }
    done = done && fly_all(&campaign, flights, first, step);
    if (done) {
        print_flights(&campaign);
        *met = print_goals(&campaign);
        aviation_text_tables(campaign.flown, flights, campaign.scratch);
    }
    free(campaign.flown);
    free(campaign.scratch);
    return done;
}
