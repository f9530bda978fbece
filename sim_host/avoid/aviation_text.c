/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "aviation_text.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>

typedef struct {
    const char *name;
    int least, most; /* obstacles */
} group_t;

static const group_t GROUPS[] = {
    {"all", 0, INT_MAX}, {"one obstacle", 1, 1}, {"two obstacles", 2, 2}, {"three or more obstacles", 3, INT_MAX}};
enum { GROUP_COUNT = sizeof GROUPS / sizeof GROUPS[0] };

static void print_risk(const aviation_figures_t *figures) {
    printf("%d | %d | %d | %d | ", figures->flights, figures->nominal, figures->collided, figures->induced);
    if (isnan(figures->risk.ratio)) {
        puts("- | - |");
    } else {
        printf("%.4f | %.4f to %.4f |\n", figures->risk.ratio, figures->risk.low, figures->risk.high);
    }
}

static void print_or_dash(double number, const char *then) {
    if (isnan(number)) {
        printf("-%s", then);
    } else {
        printf("%.1f%s", number, then);
    }
}

static void print_nuisance(const aviation_figures_t *figures) {
    printf("%d | %.2f | %d | ", figures->quiet, figures->quiet_h, figures->alerted);
    print_or_dash(figures->alerted_m, " | ");
    printf("%d | ", figures->alerts);
    print_or_dash(figures->alerts_per_h, " |\n");
}

static void print_lead(const aviation_figures_t *figures) {
    printf("%d | %d | ", figures->nominal, figures->unordered);
    if (isnan(figures->lead_least_s)) {
        puts("- |");
    } else {
        printf("%.1f / %.1f / %.1f |\n", figures->lead_least_s, figures->lead_low_s, figures->lead_median_s);
    }
}

static void print_latency(const aviation_figures_t *figures) {
    printf("%d |", figures->obeyed);
    for (int part = 0; part < AVIATION_LATENCIES; part++) {
        if (figures->obeyed > 0) {
            printf(" %.2f / %.2f |", figures->latency_mean_s[part], figures->latency_most_s[part]);
        } else {
            printf(" - |");
        }
    }
    puts("");
}

static void print_table(const char *head, const aviation_figures_t figures[GROUP_COUNT],
                        void (*print)(const aviation_figures_t *figures)) {
    printf("\n%s\n|", head);
    for (const char *at = head + 1; *at != '\0'; at++) {
        printf("%s", *at == '|' ? "---|" : "");
    }
    puts("");
    for (int i = 0; i < GROUP_COUNT; i++) {
        printf("| %s | ", GROUPS[i].name);
        print(&figures[i]);
    }
}

void aviation_text_tables(const aviation_flight_t *flight, int flights, double *scratch) {
    aviation_figures_t figures[GROUP_COUNT];
    for (int i = 0; i < GROUP_COUNT; i++) {
        figures[i] = aviation_figures(flight, flights, GROUPS[i].least, GROUPS[i].most, scratch);
    }
    print_table(
        "| risk ratio | flights | collisions without orders | collisions with orders | collisions with orders only "
        "| risk ratio | 95 % interval |",
        figures, print_risk);
    print_table(
        "| nuisance alerts | flights that keep the margin without orders | hours | flights with an alert | their "
        "distance from the nearest wall without orders, m: median | alerts | alerts per hour |",
        figures, print_nuisance);
    print_table("| lead time | flights that collide without orders | without an order | from the first order to that "
                "collision, s: least / 5 % / median |",
                figures, print_lead);
    print_table(
        "| latency, s: mean / most | flights with an obeyed order | exposure to arrival | arrival to assessment | "
        "assessment to obeyed order | sum |",
        figures, print_latency);
}
