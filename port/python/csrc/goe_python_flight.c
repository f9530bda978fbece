/* SPDX-License-Identifier: MIT */
#include "goe_python_flight.h"

#include <string.h>

#define GOE_FLIGHT_SETTING(field, least, most, usual)                                                                  \
    {#field, "", "", GOE_PYTHON_REAL, (double)(least), (double)(most), (double)(usual)},
static const goe_python_setting_t rows[] = {
#include "goe_flight_settings_list.h"
};
#undef GOE_FLIGHT_SETTING

#define ROWS ((int)(sizeof rows / sizeof rows[0]))

GOE_STATIC_ASSERT(sizeof(goe_flight_settings_t) == (sizeof rows / sizeof rows[0]) * sizeof(float), all_are_listed);

const goe_python_setting_t *goe_python_flight_setting(int row) { return row >= 0 && row < ROWS ? &rows[row] : NULL; }

goe_flight_status_t goe_python_flight_init(goe_flight_t *flight, const double *values, int cameras,
                                           const float *flight_values, const char **bad_field) {
    goe_settings_t estimator;
    goe_flight_settings_t settings;
    goe_python_settings(values, cameras, &estimator);
    memcpy(&settings, flight_values, sizeof settings);
    return goe_flight_init(flight, sizeof *flight, &estimator, &settings, bad_field);
}

goe_flight_status_t goe_python_flight_change(goe_flight_t *flight, const float *flight_values, const char **bad_field) {
    goe_flight_settings_t settings;
    memcpy(&settings, flight_values, sizeof settings);
    return goe_flight_change_settings(flight, &settings, bad_field);
}
