/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "campaign_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "turbulence.h"

const char *const STUDY_NAMES[STUDY_COUNT] = {"paper",    "arc",      "weave", "ramp",         "wind",
                                              "attitude", "position", "field", "conditioning", "boxes"};

/* --------------------------------------------------------------------------------------------------------- studies -- */

/* One way to fly Table 2. */
typedef struct {
    study_t study;
    const char *path, *speed_profile, *wind, *noise;
} variant_t;

static const variant_t VARIANTS[] = {
    {STUDY_PAPER, "straight", "constant", "none", "rounding"},
    {STUDY_ARC, "arc:2000", "constant", "none", "rounding"},
    {STUDY_ARC, "arc:-6000", "constant", "none", "rounding"},
    {STUDY_WEAVE, "weave:5,8", "constant", "none", "rounding"},
    {STUDY_RAMP, "straight", "ramp:0.5", "none", "rounding"},
    {STUDY_RAMP, "straight", "ramp:-0.2", "none", "rounding"},
    {STUDY_WIND, "straight", "constant", "dryden:light", "rounding"},
    {STUDY_WIND, "straight", "constant", "dryden:moderate", "rounding"},
    {STUDY_ATTITUDE, "straight", "constant", "none", "attitude"},
    {STUDY_POSITION, "straight", "constant", "none", "position"},
    {STUDY_FIELD, "straight", "constant", "none", "field"},
};
#define VARIANTS_COUNT (sizeof VARIANTS / sizeof VARIANTS[0])

typedef struct {
    const char *name;
    unsigned studies;
} group_t;

#define BIT(study) (1u << (unsigned)(study))
static const group_t GROUPS[] = {
    {"paper", BIT(STUDY_PAPER)},
    {"paths", BIT(STUDY_ARC) | BIT(STUDY_WEAVE) | BIT(STUDY_RAMP)},
    {"wind", BIT(STUDY_WIND)},
    {"noise", BIT(STUDY_ATTITUDE) | BIT(STUDY_POSITION) | BIT(STUDY_FIELD)},
    {"conditioning", BIT(STUDY_CONDITIONING)},
    {"boxes", BIT(STUDY_BOXES)},
    {"all", BIT(STUDY_COUNT) - 1u},
};
#define GROUPS_COUNT (sizeof GROUPS / sizeof GROUPS[0])

static unsigned find_group(const char *name, size_t length) {
    for (size_t i = 0; i < GROUPS_COUNT; i++) {
        if (strlen(GROUPS[i].name) == length && memcmp(GROUPS[i].name, name, length) == 0) {
            return GROUPS[i].studies;
        }
    }
    return 0;
}

bool campaign_plan_studies(const char *text, unsigned *studies, char *bad, size_t bad_size) {
    const char *name = text;
    *studies = 0;
    for (;;) {
        const size_t length = strcspn(name, ",");
        const unsigned group = find_group(name, length);
        if (group == 0) {
            (void)snprintf(bad, bad_size, "%.*s", (int)length, name);
            return false;
        }
        *studies |= group;
        if (name[length] == '\0') {
            return true;
        }
        name += length + 1;
    }
}

/* ---------------------------------------------------------------------------------------------------------- flights -- */

/* How far into an image interval the run starts, 0 to 1: multiples of the golden ratio, which fill the interval evenly
 * whatever the number of seeds. */
static double phase_of_seed(int seed) {
    const double golden = 0.61803398874989485 * (double)(seed - 1);
    return golden - floor(golden);
}

/* "attitude" and "position" are the parts of "field" that disturb the own pose, in addition to the paper's pixels. */
static bool parse_noise(const char *text, sensor_noise_t *noise) {
    sensor_noise_t field;
    if (!sensor_noise_parse("field", &field)) {
        return false;
    }
    if (strcmp(text, "attitude") == 0) {
        (void)sensor_noise_parse("rounding", noise);
        noise->attitude_bias_deg = field.attitude_bias_deg;
        noise->attitude_noise_deg = field.attitude_noise_deg;
        return true;
    }
    if (strcmp(text, "position") == 0) {
        (void)sensor_noise_parse("rounding", noise);
        noise->position_walk_m = field.position_walk_m;
        noise->velocity_bias_mps = field.velocity_bias_mps;
        noise->altimeter_m = field.altimeter_m;
        return true;
    }
    return sensor_noise_parse(text, noise);
}

static void add_run(planned_flight_t *flight, goe_model_t model, int window) {
    const case_setting_t setting = {GOE_METHOD_WINDOW, model, window};
    flight->run[flight->runs++] = setting;
}

/* After the window's runs. */
static void add_refined_run(planned_flight_t *flight) {
    const case_setting_t setting = {GOE_METHOD_FILTER, GOE_MODEL_AUTO, PLAN_WINDOW};
    flight->run[flight->runs++] = setting;
}

/* The boxes' own model first; for the cylinder the window has only the disc. */
static goe_model_t usual_model(const planned_flight_t *flight) {
    return flight->setup.obstacle.kind == OBSTACLE_BOX ? GOE_MODEL_AUTO : GOE_MODEL_DISC;
}

/* The next flight of the plan, without runs. The forms are the plan's own and known to be good. */
static planned_flight_t *add_flight(campaign_plan_t *plan, const variant_t *variant, const scenario_t *scenario,
                                    int number, int seed) {
    planned_flight_t *flight = &plan->flights[plan->count++];
    (void)memset(flight, 0, sizeof *flight);
    flight->study = variant->study;
    flight->number = number;
    flight->seed = seed;
    flight->obstacle = scenario->obstacle;
    flight->path = variant->path;
    flight->speed_profile = variant->speed_profile;
    flight->wind = variant->wind;
    flight->noise = variant->noise;
    flight_case_paper(&flight->setup, scenario);
    (void)path_parse(variant->path, &flight->setup.path);
    (void)path_parse_speed(variant->speed_profile, &flight->setup.path);
    (void)turbulence_parse(variant->wind, &flight->setup.w20_mps);
    (void)parse_noise(variant->noise, &flight->setup.noise);
    flight->setup.seed = (uint64_t)seed;
    flight->setup.reach_s += phase_of_seed(seed) / SCENARIO_FPS_HZ;
    return flight;
}

/* Beyond the paper three of the five orientations are enough. */
static bool is_flown(const variant_t *variant, const scenario_t *scenario) {
    static const double flown_deg[] = {-20.0, 0.0, 45.0};
    bool flown = variant->study == STUDY_PAPER;
    for (size_t i = 0; i < sizeof flown_deg / sizeof flown_deg[0]; i++) {
        flown = flown || fabs(scenario->alpha_deg - flown_deg[i]) < 1.0;
    }
    return flown;
}

static void add_table2(campaign_plan_t *plan, const variant_t *variant, int seed) {
    for (int number = 0; number < scenario_count(); number++) {
        const scenario_t scenario = scenario_get(number);
        if (!is_flown(variant, &scenario)) {
            continue;
        }
        planned_flight_t *flight = add_flight(plan, variant, &scenario, number, seed);
        add_run(flight, usual_model(flight), PLAN_WINDOW);
        if (variant->study == STUDY_PAPER && usual_model(flight) != GOE_MODEL_DISC) {
            add_run(flight, GOE_MODEL_DISC, PLAN_WINDOW);
        }
        add_refined_run(flight);
    }
}

/* ----------------------------------------------------------------------------------------------------- conditioning -- */

static const char *const OBSTACLES[] = {"cylinder", "building", "truck", "long-truck"};
#define OBSTACLES_COUNT (sizeof OBSTACLES / sizeof OBSTACLES[0])
static const int WINDOWS[] = {4, 6, 8, 12, 16, 24, 32, 48, 64};
#define WINDOWS_COUNT (sizeof WINDOWS / sizeof WINDOWS[0])
static const double RATES_HZ[] = {2.0, 4.0, 16.0, 32.0, 64.0};
#define RATES_COUNT (sizeof RATES_HZ / sizeof RATES_HZ[0])
#define USUAL_ALPHA_DEG 20.0
#define ALPHA_STEPS 9 /* of ALPHA_STEP_DEG to either side */
#define ALPHA_STEP_DEG 5.0
#define SIDE_STEPS 8 /* from 0 to twice the middle side distance, which is the largest */
#define MOST_CONDITIONING (OBSTACLES_COUNT * (1u + SIDE_STEPS + (2u * ALPHA_STEPS + 1u) + RATES_COUNT))

typedef struct {
    campaign_plan_t *plan;
    int number, seed;
} conditioning_t;

static planned_flight_t *add_condition(conditioning_t *study, const scenario_t *scenario) {
    static const variant_t variant = {STUDY_CONDITIONING, "straight", "constant", "none", "rounding"};
    return add_flight(study->plan, &variant, scenario, study->number++, study->seed);
}

static void vary_side(conditioning_t *study, const scenario_t *usual) {
    for (int i = 0; i <= SIDE_STEPS; i++) {
        if (2 * i != SIDE_STEPS) {
            scenario_t scenario = *usual;
            scenario.x0_m = 2.0 * usual->x0_m * (double)i / SIDE_STEPS;
            planned_flight_t *flight = add_condition(study, &scenario);
            add_run(flight, usual_model(flight), PLAN_WINDOW);
            add_refined_run(flight);
        }
    }
}

static void vary_orientation(conditioning_t *study, const scenario_t *usual) {
    for (int i = -ALPHA_STEPS; i <= ALPHA_STEPS; i++) {
        scenario_t scenario = *usual;
        scenario.alpha_deg = ALPHA_STEP_DEG * (double)i;
        if (fabs(scenario.alpha_deg - usual->alpha_deg) > 0.5 * ALPHA_STEP_DEG) {
            planned_flight_t *flight = add_condition(study, &scenario);
            add_run(flight, usual_model(flight), PLAN_WINDOW);
            add_refined_run(flight);
        }
    }
}

static void vary_rate(conditioning_t *study, const scenario_t *usual) {
    for (size_t i = 0; i < RATES_COUNT; i++) {
        planned_flight_t *flight = add_condition(study, usual);
        flight->setup.fps_hz = RATES_HZ[i];
        add_run(flight, usual_model(flight), PLAN_WINDOW);
        add_refined_run(flight);
    }
}

static void add_conditioning(campaign_plan_t *plan, int seed) {
    conditioning_t study = {plan, PLAN_FIRST_CONDITIONING_CASE, seed};
    for (size_t i = 0; i < OBSTACLES_COUNT; i++) {
        scenario_t usual;
        if (!scenario_find(OBSTACLES[i], &usual)) {
            continue;
        }
        const planned_flight_t *first = &plan->flights[plan->count];
        planned_flight_t *flight = add_condition(&study, &usual);
        if (usual_model(first) == GOE_MODEL_AUTO) {
            usual.alpha_deg = USUAL_ALPHA_DEG;
            flight->setup.alpha_deg = USUAL_ALPHA_DEG;
        }
        for (size_t k = 0; k < WINDOWS_COUNT; k++) {
            add_run(flight, usual_model(flight), WINDOWS[k]);
        }
        add_refined_run(flight);
        vary_side(&study, &usual);
        if (usual_model(first) == GOE_MODEL_AUTO) {
            vary_orientation(&study, &usual);
        }
        vary_rate(&study, &usual);
    }
}

/* ------------------------------------------------------------------------------------------------------------ boxes -- */

static const double ROLLS_DEG[] = {0.0, 5.0, 10.0, 25.0};
#define ROLLS_COUNT (sizeof ROLLS_DEG / sizeof ROLLS_DEG[0])
#define SEED_STEP 1000u /* more than there are cases in Table 2 */

static bool boxes_are_flown(const variant_t *variant, const scenario_t *scenario) {
    scenario_t first;
    return is_flown(variant, scenario) && !(fabs(scenario->glide_deg) > 0.0) &&
           scenario_find(scenario->obstacle, &first) && !(scenario->altitude_m > first.altitude_m);
}

/* The same flights, with the same errors of the sensors, at each roll. Every flight has random numbers of its own: the share
 * of errors within their sigmas is counted over flights, not over images of one flight. */
static void add_boxes(campaign_plan_t *plan, int seed) {
    static const variant_t variant = {STUDY_BOXES, "straight", "constant", "none", "field"};
    static const case_setting_t settings[] = {{GOE_METHOD_WINDOW, GOE_MODEL_AUTO, PLAN_WINDOW},
                                              {GOE_METHOD_FILTER, GOE_MODEL_AUTO, PLAN_WINDOW}};
    for (size_t i = 0; i < ROLLS_COUNT * (size_t)scenario_count(); i++) {
        const int number = (int)(i % (size_t)scenario_count());
        const scenario_t scenario = scenario_get(number);
        if (boxes_are_flown(&variant, &scenario)) {
            planned_flight_t *flight = add_flight(plan, &variant, &scenario, number, seed);
            flight->setup.features = LOG_BOXES;
            flight->setup.roll_amplitude_deg = ROLLS_DEG[i / (size_t)scenario_count()];
            flight->setup.seed = SEED_STEP * (uint64_t)seed + (uint64_t)number;
            flight->run[flight->runs++] = settings[0];
            flight->run[flight->runs++] = settings[1];
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------- plan -- */

bool campaign_plan_make(unsigned studies, int seeds, campaign_plan_t *plan) {
    const size_t most = (size_t)seeds * ((VARIANTS_COUNT + ROLLS_COUNT) * (size_t)scenario_count() + MOST_CONDITIONING);
    plan->count = 0;
    plan->flights = malloc(most * sizeof *plan->flights);
    if (plan->flights == NULL) {
        return false;
    }
    for (size_t i = 0; i < VARIANTS_COUNT; i++) {
        for (int seed = 1; seed <= seeds && (studies & BIT(VARIANTS[i].study)) != 0; seed++) {
            add_table2(plan, &VARIANTS[i], seed);
        }
    }
    for (int seed = 1; seed <= seeds && (studies & BIT(STUDY_CONDITIONING)) != 0; seed++) {
        add_conditioning(plan, seed);
    }
    for (int seed = 1; seed <= seeds && (studies & BIT(STUDY_BOXES)) != 0; seed++) {
        add_boxes(plan, seed);
    }
    return true;
}

void campaign_plan_keep_part(campaign_plan_t *plan, int part, int parts) {
    const size_t first = plan->count * (size_t)(part - 1) / (size_t)parts;
    const size_t end = plan->count * (size_t)part / (size_t)parts;
    memmove(plan->flights, plan->flights + first, (end - first) * sizeof *plan->flights);
    plan->count = end - first;
}

void campaign_plan_free(campaign_plan_t *plan) {
    free(plan->flights);
    plan->flights = NULL;
    plan->count = 0;
}
