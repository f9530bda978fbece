/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "aviation.h"

#include <math.h>
#include <string.h>

#include "ranks.h"

#define NORMAL_975 1.959963984540054 /* of a standard normal variable, 2.5 % are above it */
#define LOW_SHARE 0.05
#define SECONDS_PER_HOUR 3600.0

/* ------------------------------------------------------------------------------------------------------- risk ratio -- */

/* Wilson's interval of a share. */
static void wilson(double times, double of, double z, double *low, double *high) {
    const double middle = 2.0 * times + z * z, whole = 2.0 * (of + z * z);
    const double half = z * sqrt(z * z + 4.0 * times * (1.0 - times / of));
    *low = fmax((middle - half) / whole, 0.0);
    *high = (middle + half) / whole;
}

aviation_ratio_t aviation_ratio(int both, int nominal_alone, int ordered_alone) {
    const double ordered = both + ordered_alone, nominal = both + nominal_alone, either = ordered + nominal_alone;
    aviation_ratio_t risk = {(double)NAN, (double)NAN, (double)NAN};
    if (nominal > 0.0) {
        /* As wide as the two intervals have to be for their quotient to have 95 %. */
        const double joint = sqrt((nominal_alone + ordered_alone + 2.0) / ((ordered + 1.0) * (nominal + 1.0)));
        const double apart = sqrt((1.0 - (ordered + 1.0) / (either + 2.0)) / (ordered + 1.0)) +
                             sqrt((1.0 - (nominal + 1.0) / (either + 2.0)) / (nominal + 1.0));
        double ordered_low, ordered_high, nominal_low, nominal_high;
        wilson(ordered, either, NORMAL_975 * joint / apart, &ordered_low, &ordered_high);
        wilson(nominal, either, NORMAL_975 * joint / apart, &nominal_low, &nominal_high);
        risk.ratio = ordered / nominal;
        risk.low = ordered_low / nominal_high;
        risk.high = ordered_high / nominal_low;
    }
    return risk;
}

/* ------------------------------------------------------------------------------------------------------------ counts -- */

static void count_alerts(aviation_figures_t *figures, const aviation_flight_t *flight) {
    if (!flight->due) {
        figures->quiet++;
        figures->alerted += flight->alerts > 0 ? 1 : 0;
        figures->alerts += flight->alerts;
        figures->quiet_h += flight->flown_s / SECONDS_PER_HOUR;
    }
}

/* The means are sums until all flights are counted. */
static void count_latency(aviation_figures_t *figures, const aviation_flight_t *flight) {
    double sum_s = 0.0;
    if (!flight->obeyed) {
        return;
    }
    figures->obeyed++;
    for (int part = 0; part < AVIATION_LATENCIES; part++) {
        const double part_s = part == AVIATION_SUM ? sum_s : flight->latency_s[part];
        figures->latency_mean_s[part] += part_s;
        figures->latency_most_s[part] = fmax(figures->latency_most_s[part], part_s);
        sum_s += part_s;
    }
}

static void count(aviation_figures_t *figures, const aviation_flight_t *flight) {
    figures->flights++;
    figures->nominal += flight->collided_nominal ? 1 : 0;
    figures->collided += flight->collided ? 1 : 0;
    figures->induced += flight->collided && !flight->collided_nominal ? 1 : 0;
    count_alerts(figures, flight);
    count_latency(figures, flight);
}

static bool is_among(const aviation_flight_t *flight, int least, int most) {
    return flight->obstacles >= least && flight->obstacles <= most;
}

static void rank_alerted(aviation_figures_t *figures, const aviation_flight_t *flight, int flights, int least, int most,
                         double *scratch) {
    int alerted = 0;
    for (int k = 0; k < flights; k++) {
        if (is_among(&flight[k], least, most) && !flight[k].due && flight[k].alerts > 0) {
            scratch[alerted++] = flight[k].nominal_m;
        }
    }
    ranks_sort(scratch, alerted);
    figures->alerted_m = ranks_quantile(scratch, alerted, 0.5);
}

static void rank_leads(aviation_figures_t *figures, const aviation_flight_t *flight, int flights, int least, int most,
                       double *scratch) {
    int leads = 0;
    for (int k = 0; k < flights; k++) {
        if (is_among(&flight[k], least, most) && !isnan(flight[k].lead_s)) {
            scratch[leads++] = flight[k].lead_s;
        }
    }
    ranks_sort(scratch, leads);
    figures->unordered = figures->nominal - leads;
    figures->lead_least_s = ranks_quantile(scratch, leads, 0.0);
    figures->lead_low_s = ranks_quantile(scratch, leads, LOW_SHARE);
    figures->lead_median_s = ranks_quantile(scratch, leads, 0.5);
}

static void divide(aviation_figures_t *figures) {
    const int both = figures->collided - figures->induced;
    figures->risk = aviation_ratio(both, figures->nominal - both, figures->induced);
    figures->alerts_per_h = figures->quiet > 0 ? figures->alerts / figures->quiet_h : (double)NAN;
    for (int part = 0; part < AVIATION_LATENCIES; part++) {
        figures->latency_mean_s[part] /= fmax(figures->obeyed, 1.0);
    }
}

aviation_figures_t aviation_figures(const aviation_flight_t *flight, int flights, int least, int most,
                                    double *scratch) {
    aviation_figures_t figures;
    memset(&figures, 0, sizeof figures);
    for (int k = 0; k < flights; k++) {
        if (is_among(&flight[k], least, most)) {
            count(&figures, &flight[k]);
        }
    }
    divide(&figures);
    rank_alerted(&figures, flight, flights, least, most, scratch);
    rank_leads(&figures, flight, flights, least, most, scratch);
    return figures;
}
