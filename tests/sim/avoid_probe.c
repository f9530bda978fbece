/*
 * avoid_probe ratio BOTH NOMINAL ORDERED   prints the risk ratio of so many flights that collide both ways, on the nominal course alone,
 *                                          with orders alone, and the ends of its interval
 * avoid_probe flights N SEED STEP          flies as goe_avoid --several does, and prints a row of CSV for every flight
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "several_text.h"

static int fail(const char *why) {
    (void)fprintf(stderr, "avoid_probe: %s\n", why);
    return EXIT_FAILURE;
}

static int number(const char *text) { return (int)strtol(text, NULL, 10); }

static int print_ratio(char **argument) {
    const int both = number(argument[0]), nominal = number(argument[1]), ordered = number(argument[2]);
    const aviation_ratio_t risk = aviation_ratio(both, nominal, ordered);
    printf("%.12g %.12g %.12g\n", risk.ratio, risk.low, risk.high);
    return EXIT_SUCCESS;
}

static void print_row(const several_case_t *setup, const several_outcome_t *flown, const several_outcome_t *nominal) {
    const aviation_flight_t counted = several_counted(flown, nominal);
    printf("%d,%d,%.17g,%.17g,%d,%d,%d,%d,", flown->obstacles, flown->ordered, flown->closest_m, nominal->closest_m,
           flown->collided, nominal->collided, counted.due, counted.alerts);
    printf("%.17g,%.17g,%.17g,%.17g,%.17g,%d,", flown->flown_s, nominal->flown_s, flown->ordered_s, setup->frame_s,
           setup->obey_s, flown->obeyed);
    printf("%.17g,%.17g,%.17g\n", flown->arrival_s, flown->assessment_s, flown->delay_s);
}

static int print_flights(char **argument) {
    const int flights = number(argument[0]), first = number(argument[1]), step = number(argument[2]);
    puts("obstacles,ordered,closest_m,nominal_closest_m,collided,nominal_collided,due,alerts,flown_s,nominal_flown_s,"
         "ordered_s,frame_s,obey_s,obeyed,arrival_s,assessment_s,delay_s");
    for (int k = 0; k < flights; k++) {
        const several_case_t setup = several_case(k, (uint64_t)first + (uint64_t)k * (uint64_t)step, false);
        several_outcome_t flown, nominal;
        const char *fault = several_fly(&setup, &flown);
        fault = fault != NULL ? fault : several_fly_nominal(&setup, &nominal);
        if (fault != NULL) {
            return fail(fault);
        }
        print_row(&setup, &flown, &nominal);
    }
    return EXIT_SUCCESS;
}

int main(int argc, char **argv) {
    if (argc == 5 && strcmp(argv[1], "ratio") == 0) {
        return print_ratio(argv + 2);
    }
    if (argc == 5 && strcmp(argv[1], "flights") == 0) {
        return print_flights(argv + 2);
    }
    return fail("ratio BOTH NOMINAL ORDERED, or flights N SEED STEP");
}
