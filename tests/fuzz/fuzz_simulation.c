/* Fuzzes all input of goe_sim: recorded flights and scenarios. SPDX-License-Identifier: MIT
 *
 * The input is text. If it begins with '[' or '#' it is a scenario, otherwise a recorded flight. */
#include <math.h>
#include <string.h>

#include "fuzz.h"
#include "fuzz_file.h"
#include "recorded_flight.h"
#include "scenario_file.h"

#define TIMES 7
#define FAULT_SIZE 256u

enum { INPUTS, FLIGHTS, FLIGHTS_REFUSED, SCENARIOS, SCENARIOS_REFUSED, COUNTS };

fuzz_count_t fuzz_counts[COUNTS + 1] = {{"inputs", 0},    {"flights", 0},           {"flights_refused", 0},
                                        {"scenarios", 0}, {"scenarios_refused", 0}, {NULL, 0}};

static void check_fault(const char *fault, size_t size, const char *path) {
    FUZZ_CHECK(memchr(fault, '\0', size) != NULL && strncmp(fault, path, strlen(path)) == 0);
}

static void check_pose(const pose_t *pose) {
    const quat_t *q = &pose->attitude;
    FUZZ_CHECK(isfinite(pose->position_ned_m.x) && isfinite(pose->position_ned_m.y) &&
               isfinite(pose->position_ned_m.z));
    FUZZ_CHECK(fabs(q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z - 1.0) < 1e-6);
}

/* Between its rows, at them and beyond them. */
static void fly(const recorded_flight_t *flight) {
    const double duration_s = recorded_flight_duration(flight);
    FUZZ_CHECK(flight->count >= 2 && duration_s > 0.0);
    for (int i = -1; i <= TIMES; i++) {
        const recorded_pose_t at = recorded_flight_at(flight, duration_s * i / (TIMES - 1));
        check_pose(&at.truth);
        check_pose(&at.estimated);
    }
}

static void try_flight(const char *text, size_t size) {
    recorded_flight_t flight;
    input_error_t error;
    const char *path = fuzz_file(0, "flight.csv", text, size);
    if (recorded_flight_read(path, &flight, &error)) {
        fuzz_counts[FLIGHTS].times++;
        fly(&flight);
        recorded_flight_free(&flight);
    } else {
        fuzz_counts[FLIGHTS_REFUSED].times++;
        check_fault(error.text, sizeof error.text, path);
        FUZZ_CHECK(flight.poses == NULL && flight.count == 0);
    }
}

/* Accepts every option except those that begin with an x. */
static bool take_option(const char *name, const char *value, unsigned long line, char reason[SCENARIO_REASON_MAX]) {
    FUZZ_CHECK(name != NULL && value != NULL && *value != '\0' && line > 0);
    (void)strcpy(reason, "it begins with an x");
    return *name != 'x' || name[1] == '0';
}

static void try_scenario(const char *text, size_t size) {
    scenario_file_t scenario;
    char fault[FAULT_SIZE];
    const char *path = fuzz_file(0, "scenario.ini", text, size);
    if (scenario_file_read(path, take_option, &scenario, fault, sizeof fault)) {
        fuzz_counts[SCENARIOS].times++;
        FUZZ_CHECK(scenario.neighbors >= 0 && scenario.neighbors <= SCENARIO_NEIGHBORS_MAX);
    } else {
        fuzz_counts[SCENARIOS_REFUSED].times++;
        check_fault(fault, sizeof fault, path);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const char *text = size > 0 ? (const char *)data : "";
    fuzz_counts[INPUTS].times++;
    if (size > 0 && (*text == '[' || *text == '#')) {
        try_scenario(text, size);
    } else {
        try_flight(text, size);
    }
    return 0;
}
