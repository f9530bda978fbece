/*
 * The figures by which aviation judges a system that avoids collisions. Every flight is flown twice, in the same wind: with the orders
 * obeyed, and without orders. The flight without orders is the nominal course.
 *
 *   risk ratio       collisions with orders divided by collisions of the nominal courses. The counts are of the same flights, so the
 *                    95 % interval is one for paired counts: Bonett and Price, "Confidence intervals for a ratio of binomial
 *                    proportions based on paired data", Statistics in Medicine 25 (2006). It needs no special case for a count of 0.
 *   nuisance alerts  orders that begin in a flight whose nominal course keeps the margin (goe_flight_settings_t.margin_m) to all walls
 *                    and does not collide. An order that follows another without a break is no new alert. All orders of such
 *                    a flight count, also those that are due only because the aircraft obeyed an earlier one. Their number is divided
 *                    by the hours flown in these flights, from the start to the end or to a collision.
 *   lead time        from the first order to the moment when the nominal course collides. A flight that would collide and has no
 *                    order has no lead time; such flights are counted apart.
 *   latency          of the first order of a flight, if the aircraft obeys it: from the exposure of the newest frame that the layer has
 *                    at that time to the frame's arrival, from there to the assessment that gives the order, from there to
 *                    the moment when the aircraft begins to obey. A frame without a detection counts too.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_AVIATION_H
#define SIM_AVIATION_H

#include <stdbool.h>

typedef enum {
    AVIATION_ARRIVAL,
    AVIATION_ASSESSMENT,
    AVIATION_DELAY,
    AVIATION_SUM,
    AVIATION_LATENCIES
} aviation_part_t;

typedef struct {
    int obstacles;
    double nominal_m;                /* from the nearest wall, on the nominal course */
    bool due;                        /* the nominal course does not keep the margin, or collides */
    bool collided_nominal, collided; /* on the nominal course, with orders */
    int alerts;                      /* orders that began */
    double flown_s;
    double lead_s;                        /* NaN: no order, or the nominal course does not collide */
    bool obeyed;                          /* the first order */
    double latency_s[AVIATION_DELAY + 1]; /* of this order */
} aviation_flight_t;

typedef struct {
    double ratio, low, high; /* NaN: without a collision on the nominal courses */
} aviation_ratio_t;

typedef struct {
    int flights;
    int nominal, collided, induced; /* collisions on the nominal courses, with orders, with orders alone */
    aviation_ratio_t risk;
    int quiet;           /* flights whose nominal course keeps the margin */
    int alerted, alerts; /* of these: flights with an alert, alerts */
    double alerted_m;    /* median of nominal_m of the flights with an alert; NaN: there is none */
    double quiet_h, alerts_per_h;
    int unordered;                                  /* flights that would collide, without an order */
    double lead_least_s, lead_low_s, lead_median_s; /* low: 5 % quantile. NaN: there is no lead time */
    int obeyed;
    double latency_mean_s[AVIATION_LATENCIES], latency_most_s[AVIATION_LATENCIES];
} aviation_figures_t;

/* Of flights that collide both ways, on the nominal course alone, with orders alone. */
aviation_ratio_t aviation_ratio(int both, int nominal_alone, int ordered_alone);

/* Of the flights among least to most obstacles. scratch has a place for every flight. */
aviation_figures_t aviation_figures(const aviation_flight_t *flight, int flights, int least, int most, double *scratch);

#endif
