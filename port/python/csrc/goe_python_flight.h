/* The flight layer's settings for Python. SPDX-License-Identifier: MIT */
#ifndef GOE_PYTHON_FLIGHT_H
#define GOE_PYTHON_FLIGHT_H

#include "goe_flight.h"
#include "goe_python.h"

/* Rows of goe_flight_settings_list.h from 0 on, in the order of goe_flight_settings_t; null after the last. */
const goe_python_setting_t *goe_python_flight_setting(int row);

/* goe_flight_init(): the estimator's settings as for goe_python_init(), those of the layer as one value for each row. */
goe_flight_status_t goe_python_flight_init(goe_flight_t *flight, const double *values, int cameras,
                                           const float *flight_values, const char **bad_field);

/* goe_flight_change_settings() likewise. */
goe_flight_status_t goe_python_flight_change(goe_flight_t *flight, const float *flight_values, const char **bad_field);

#endif /* GOE_PYTHON_FLIGHT_H */
