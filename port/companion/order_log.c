/* Orders in the log. SPDX-License-Identifier: MIT */
#include "order_log.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "companion_config.h"

#define LINE_MAX_LENGTH 512
#define NUMBER_MAX 9.0e15 /* what a double holds to the unit */

/* Columns that a restarted companion reads. */
enum { UNIX_US, BOOT_US, ACTIVE, ACTION, MODE_BEFORE, COURSE_N, COURSE_E, OBSTACLE_N, OBSTACLE_E, RADIUS, NUMBERS };

static const char header[] =
    "unix_us,boot_us,active,action,mode_before,course_n,course_e,obstacle_n_m,obstacle_e_m,radius_m,event,action_name,"
    "mode,slot,id,tcpa_s,dcpa_m,target_lat_e7,target_lon_e7,target_alt_m,why\n";

bool order_log_open(order_log_t *log, const char *folder) {
    char path[(2 * CONFIG_TEXT_MAX + 16)];
    (void)snprintf(path, sizeof path, "%s/orders.csv", folder);
    log->stream = fopen(path, "wbx");
    if (log->stream == NULL || fputs(header, log->stream) < 0) {
        return false;
    }
    return fflush(log->stream) == 0;
}

void order_log_put(order_log_t *log, const order_row_t *row) {
    const order_left_t *left = &row->left;
    if (log == NULL || log->stream == NULL) {
        return;
    }
    (void)fprintf(log->stream, "%" PRId64 ",%" PRId64 ",%d,%u,%" PRIu32 ",%.6g,%.6g,%.9g,%.9g,%.4g", left->unix_us,
                  left->boot_us, left->active ? 1 : 0, left->action, left->mode_before, (double)left->course_ne[0],
                  (double)left->course_ne[1], (double)left->obstacle_ne_m[0], (double)left->obstacle_ne_m[1],
                  (double)left->radius_m);
    (void)fprintf(log->stream, ",%s,%s,%" PRIu32 ",%d,%u,%.2f,%.1f,%" PRId32 ",%" PRId32 ",%.1f,%s\n", row->event,
                  goe_flight_action_text((goe_flight_action_t)left->action), row->mode, row->slot, row->obstacle_id,
                  (double)row->tcpa_s, (double)row->dcpa_m, row->target_lat_e7, row->target_lon_e7,
                  (double)row->target_alt_m, row->why);
    (void)fflush(log->stream);
    if (log->active && !left->active) {
        (void)fdatasync(fileno(log->stream));
    }
    log->active = left->active;
}

void order_log_close(order_log_t *log) {
    if (log->stream != NULL) {
        (void)fclose(log->stream);
        log->stream = NULL;
    }
}

/* The first numbers of a row, with a comma behind each. False: these are not all. */
static bool read_numbers(const char *line, double number[NUMBERS]) {
    for (int i = 0; i < NUMBERS; i++) {
        char *end = NULL;
        number[i] = strtod(line, &end);
        if (end == line || *end != ',' || !(fabs(number[i]) < NUMBER_MAX)) {
            return false;
        }
        line = end + 1;
    }
    return true;
}

/* A row that was cut by a crash has no end, and does not count. */
static bool parse(const char *line, order_left_t *left) {
    double number[NUMBERS];
    (void)memset(left, 0, sizeof *left);
    if (strchr(line, '\n') == NULL || !read_numbers(line, number) || number[ACTION] < 0.0 ||
        number[ACTION] > (double)GOE_FLIGHT_HOLD || number[MODE_BEFORE] < 0.0 ||
        number[MODE_BEFORE] > (double)UINT32_MAX) {
        return false;
    }
    left->unix_us = (int64_t)number[UNIX_US];
    left->boot_us = (int64_t)number[BOOT_US];
    left->active = number[ACTIVE] > 0.5;
    left->action = (unsigned)number[ACTION];
    left->mode_before = (uint32_t)number[MODE_BEFORE];
    left->course_ne[0] = (float)number[COURSE_N];
    left->course_ne[1] = (float)number[COURSE_E];
    left->obstacle_ne_m[0] = (float)number[OBSTACLE_N];
    left->obstacle_ne_m[1] = (float)number[OBSTACLE_E];
    left->radius_m = (float)number[RADIUS];
    return true;
}

bool order_log_read(const char *folder, order_left_t *left) {
    char path[(2 * CONFIG_TEXT_MAX + 16)], line[LINE_MAX_LENGTH];
    order_left_t row;
    (void)memset(left, 0, sizeof *left);
    (void)snprintf(path, sizeof path, "%s/orders.csv", folder);
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return false;
    }
    while (fgets(line, sizeof line, file) != NULL) {
        *left = parse(line, &row) ? row : *left;
    }
    (void)fclose(file);
    return left->active;
}
