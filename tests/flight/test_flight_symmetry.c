/* Neither the compass, nor a place, nor a hand is preferred. SPDX-License-Identifier: MIT
 *
 * Random encounters with one to four obstacles, whose orders are obeyed, are decided twice: as they are, and in a world that is turned,
 * moved or mirrored. Both decisions are the same. */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_reaction.h"

#define PI 3.14159265358979
#define STEP_S 0.1
#define STEPS 250
#define ENCOUNTERS 250
#define SPEED_M_S 20.0

typedef struct {
    double cosine, sine; /* of the turn */
    double mirror;       /* -1: east is west, before the turn */
    double moved_ned_m[3];
} world_t;

typedef struct {
    double ned_m[3], heading;
    double speed_m_s;
    int obstacles;
    double at_ne_m[4][2], variance_m2[4][3];
    double width_m[4], top_m[4];
    bool has_top[4], suspect[4];
    bool approach;
} encounter_t;

static const world_t as_it_is = {1.0, 0.0, 1.0, {0.0, 0.0, 0.0}};
static check_random_t any;
static goe_flight_t plain;
static goe_flight_t flight[2];
static encounter_t now;
static int orders[GOE_FLIGHT_HOLD + 1];

void setUp(void) {
    static flown_t flown;
    any = check_random_start("flight symmetry");
    flown_start(&flown, NULL);
    plain = flown.flight;
    memset(orders, 0, sizeof orders);
}
void tearDown(void) {}

static double between(double low, double high) { return check_random_between(&any, low, high); }

static void any_encounter(void) {
    memset(&now, 0, sizeof now);
    now.heading = between(-PI, PI);
    now.speed_m_s = SPEED_M_S;
    now.ned_m[2] = -between(15.0, 60.0);
    now.approach = between(0.0, 1.0) < 0.2;
    now.obstacles = 1 + (int)between(0.0, 3.99);
    for (int i = 0; i < now.obstacles; i++) {
        const double ahead = between(60.0, 260.0);
        const double right = i == 0 ? between(-12.0, 12.0) : between(-90.0, 90.0);
        const double sigma[2] = {between(0.1, 12.0), between(0.1, 3.0)};
        now.at_ne_m[i][0] = ahead * cos(now.heading) - right * sin(now.heading);
        now.at_ne_m[i][1] = ahead * sin(now.heading) + right * cos(now.heading);
        const double c = cos(now.heading + 0.2);
        const double s = sin(now.heading + 0.2);
        now.variance_m2[i][0] = c * c * sigma[0] * sigma[0] + s * s * sigma[1] * sigma[1];
        now.variance_m2[i][1] = c * s * (sigma[0] * sigma[0] - sigma[1] * sigma[1]);
        now.variance_m2[i][2] = s * s * sigma[0] * sigma[0] + c * c * sigma[1] * sigma[1];
        now.width_m[i] = between(1.0, 25.0);
        now.top_m[i] = between(10.0, 80.0);
        now.has_top[i] = between(0.0, 1.0) < 0.7;
        now.suspect[i] = between(0.0, 1.0) < 0.15;
    }
}

static void place(const world_t *world, const double ne_m[2], float placed_ne_m[2], bool is_direction) {
    const double east = world->mirror * ne_m[1];
    const double off = is_direction ? 0.0 : 1.0;
    placed_ne_m[0] = (float)(world->cosine * ne_m[0] - world->sine * east + off * world->moved_ned_m[0]);
    placed_ne_m[1] = (float)(world->sine * ne_m[0] + world->cosine * east + off * world->moved_ned_m[1]);
}

static void put(const world_t *world, goe_flight_t *to, int i, uint32_t time_us) {
    goe_flight_slot_t *slot = &to->slot[i];
    const double c = world->cosine;
    const double s = world->sine;
    const double *v = now.variance_m2[i];
    const double cross = world->mirror * v[1];
    const double north = now.at_ne_m[i][0] - now.ned_m[0];
    const double east = now.at_ne_m[i][1] - now.ned_m[1];
    const double ahead = cos(now.heading) * north + sin(now.heading) * east;
    const double right = cos(now.heading) * east - sin(now.heading) * north;
    slot->used = slot->assessed = true;
    slot->valid = (uint8_t)(GOE_HAS_POSITION | GOE_HAS_WIDTH | (now.has_top[i] ? GOE_HAS_HEIGHT : 0));
    slot->suspect = now.suspect[i];
    slot->taken_us = slot->detected_us = time_us;
    place(world, now.at_ne_m[i], slot->center_ne_m, false);
    slot->ground_down_m = (float)world->moved_ned_m[2];
    slot->covariance_ne_m2[0] = (float)(c * c * v[0] - 2.0 * c * s * cross + s * s * v[2]);
    slot->covariance_ne_m2[1] = (float)(c * s * (v[0] - v[2]) + (c * c - s * s) * cross);
    slot->covariance_ne_m2[2] = (float)(s * s * v[0] + 2.0 * c * s * cross + c * c * v[2]);
    slot->width_m = slot->length_m = (float)now.width_m[i];
    slot->top_m = now.has_top[i] ? (float)now.top_m[i] : 0.0f;
    slot->hazard.conflict_probability = fabs(right) < now.width_m[i] + 6.0 ? (ahead > 0.0 ? 0.9f : 0.0f) : 0.0f;
    slot->hazard.tcpa_s = (float)(ahead / now.speed_m_s);
    slot->hazard.tcpa_sd_s = 0.3f;
}

/* Returns the time that the best action needs. */
static float decide(const world_t *world, goe_flight_t *to, uint32_t time_us) {
    goe_flight_reaction_own_t own;
    const double course[2] = {now.speed_m_s * cos(now.heading), now.speed_m_s * sin(now.heading)};
    memset(&own, 0, sizeof own);
    own.time_us = time_us;
    own.approach = now.approach;
    place(world, now.ned_m, own.ned_m, false);
    own.ned_m[2] = (float)(now.ned_m[2] + world->moved_ned_m[2]);
    place(world, course, to->velocity_ned_m_s, true);
    to->ground_down_m = (float)world->moved_ned_m[2];
    int worst = -1;
    for (int i = 0; i < now.obstacles; i++) {
        put(world, to, i, time_us);
        const bool is_hazard = to->slot[i].hazard.conflict_probability > 0.0f;
        worst = is_hazard && (worst < 0 || to->slot[i].hazard.tcpa_s < to->slot[worst].hazard.tcpa_s) ? i : worst;
    }
    return goe_flight_reaction_decide(to, worst, &own);
}

static unsigned mirrored(unsigned action) {
    return action == GOE_FLIGHT_LEFT ? GOE_FLIGHT_RIGHT : action == GOE_FLIGHT_RIGHT ? GOE_FLIGHT_LEFT : action;
}

/* False: rounding has decided between two ways that are as good. */
static bool is_similar(const world_t *world, float needed_s, float other_needed_s) {
    const goe_flight_reaction_t *a = &flight[0].reaction;
    const goe_flight_reaction_t *b = &flight[1].reaction;
    const double target_m[2] = {(double)a->target_ned_m[0], (double)a->target_ned_m[1]};
    float there_m[2];
    place(world, target_m, there_m, false);
    bool equal = (world->mirror < 0.0 ? mirrored(a->action) : a->action) == b->action && a->slot == b->slot &&
                 a->late == b->late && a->reason == b->reason && a->changes == b->changes &&
                 fabs((double)(needed_s - other_needed_s)) < 0.02 && fabs((double)(a->clear_m - b->clear_m)) < 0.1;
    if (a->action != GOE_FLIGHT_NONE) {
        const double down_m = (double)a->target_ned_m[2] + world->moved_ned_m[2];
        equal = equal && fabs((double)(there_m[0] - b->target_ned_m[0])) < 0.1 &&
                fabs((double)(there_m[1] - b->target_ned_m[1])) < 0.1 &&
                fabs(down_m - (double)b->target_ned_m[2]) < 0.05;
    }
    return equal;
}

/* Turns towards the target of a side or a circle, and back to the heading of before; climbs. */
static void obey(double line) {
    const goe_flight_reaction_t *r = &flight[0].reaction;
    const double to_north = (double)r->target_ned_m[0] - now.ned_m[0];
    const double to_east = (double)r->target_ned_m[1] - now.ned_m[1];
    const bool aside = r->action == GOE_FLIGHT_LEFT || r->action == GOE_FLIGHT_RIGHT || r->action == GOE_FLIGHT_HOLD;
    const double wanted = aside && hypot(to_north, to_east) > 20.0 ? atan2(to_east, to_north) : line;
    const double off = remainder(wanted - now.heading, 2.0 * PI);
    const double most = 0.28 * STEP_S; /* 30 degrees of bank */
    now.heading += off > most ? most : off < -most ? -most : off;
    now.ned_m[0] += now.speed_m_s * STEP_S * cos(now.heading);
    now.ned_m[1] += now.speed_m_s * STEP_S * sin(now.heading);
    if (r->action == GOE_FLIGHT_CLIMB || r->action == GOE_FLIGHT_GO_AROUND) {
        now.ned_m[2] -= 2.5 * STEP_S;
    }
}

/* The target of a side is on that side of the order's obstacle, looking along the course on which it was chosen. */
static bool is_on_its_side(void) {
    const goe_flight_reaction_t *r = &flight[0].reaction;
    if ((r->action != GOE_FLIGHT_LEFT && r->action != GOE_FLIGHT_RIGHT) || r->slot < 0) {
        return true;
    }
    const double north = (double)r->target_ned_m[0] - now.at_ne_m[r->slot][0];
    const double east = (double)r->target_ned_m[1] - now.at_ne_m[r->slot][1];
    const double right = (double)r->along_ne[0] * east - (double)r->along_ne[1] * north;
    return r->action == GOE_FLIGHT_RIGHT ? right > 0.0 : right < 0.0;
}

static void jump(world_t *world) {
    float jump_ned_m[3];
    for (int i = 0; i < 3; i++) {
        jump_ned_m[i] = (float)between(-200.0, 200.0);
        world->moved_ned_m[i] += (double)jump_ned_m[i];
    }
    goe_flight_reaction_shift(&flight[1].reaction, jump_ned_m);
}

static bool is_encounter_symmetric(world_t *world, double loiter_m, bool jumps) {
    const double line = now.heading;
    unsigned before = GOE_FLIGHT_NONE;
    for (int i = 0; i < 2; i++) {
        flight[i] = plain;
        flight[i].settings.loiter_m = (float)loiter_m;
    }
    for (int k = 0; k < STEPS; k++) {
        const uint32_t time_us = 1000000u + (uint32_t)(k * 100000);
        if (k % 50 == 10) { /* estimates move a little */
            now.at_ne_m[0][0] += between(-3.0, 3.0);
            now.at_ne_m[0][1] += between(-3.0, 3.0);
        }
        if (jumps && k % 40 == 39) {
            jump(world);
        }
        const float needed_s = decide(&as_it_is, &flight[0], time_us);
        const float other_needed_s = decide(world, &flight[1], time_us);
        if (!is_similar(world, needed_s, other_needed_s)) {
            return false;
        }
        TEST_ASSERT_TRUE(is_on_its_side());
        orders[flight[0].reaction.action] += flight[0].reaction.action != before ? 1 : 0;
        before = flight[0].reaction.action;
        obey(line);
    }
    return true;
}

/* Rounding may decide one encounter in a hundred, and of two sides that are exactly as good the right one is taken. */
static void check_world(bool is_turned, bool is_moved, bool is_mirrored, bool jumps) {
    const int least = is_mirrored ? 95 : 99; /* percent */
    int equal = 0;
    for (int n = 0; n < ENCOUNTERS; n++) {
        world_t world = as_it_is;
        const double angle = is_turned ? between(-PI, PI) : 0.0;
        world.cosine = cos(angle);
        world.sine = sin(angle);
        world.mirror = is_mirrored ? -1.0 : 1.0;
        for (int i = 0; i < 3 && is_moved; i++) {
            world.moved_ned_m[i] = between(-400.0, 400.0);
        }
        any_encounter();
        equal += is_encounter_symmetric(&world, n % 2 == 0 ? 0.0 : between(60.0, 90.0), jumps) ? 1 : 0;
    }
    TEST_ASSERT_TRUE_MESSAGE(100 * equal >= least * ENCOUNTERS, "encounters decided equally");
    for (int action = GOE_FLIGHT_LEFT; action <= GOE_FLIGHT_HOLD; action++) {
        TEST_ASSERT_TRUE_MESSAGE(orders[action] > 0, "each order is given");
    }
}

static void the_compass_decides_nothing(void) { check_world(true, false, false, false); }
static void the_place_decides_nothing(void) { check_world(false, true, false, false); }
static void a_known_jump_decides_nothing(void) { check_world(false, false, false, true); }
static void no_hand_is_preferred(void) { check_world(false, false, true, false); }

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_compass_decides_nothing);
    RUN_TEST(the_place_decides_nothing);
    RUN_TEST(a_known_jump_decides_nothing);
    RUN_TEST(no_hand_is_preferred);
    return UNITY_END();
}
