/* Writes estimates as CSV. SPDX-License-Identifier: MIT */
#include "estimate_writer.h"

#include <inttypes.h>
#include <stddef.h>
#include <string.h>

#include "number_text.h"

typedef struct {
    const char *name, *sigma_name;
    size_t value, sigma; /* offsets of the floats in goe_estimate_t */
    unsigned valid;      /* GOE_HAS_... */
} quantity_t;

#define QUANTITY(name, sigma_name, field, valid)                                                                       \
    {name, sigma_name, offsetof(goe_estimate_t, field), offsetof(goe_estimate_t, sigma.field), valid}
static const quantity_t quantities[] = {
    QUANTITY("x0_m", "x0_sd_m", x0_m, GOE_HAS_POSITION),
    QUANTITY("z0_m", "z0_sd_m", z0_m, GOE_HAS_POSITION),
    QUANTITY("x_m", "x_sd_m", x_m, GOE_HAS_POSITION),
    QUANTITY("z_m", "z_sd_m", z_m, GOE_HAS_POSITION),
    QUANTITY("width_m", "width_sd_m", width_m, GOE_HAS_WIDTH),
    QUANTITY("length_m", "length_sd_m", length_m, GOE_HAS_LENGTH),
    QUANTITY("height_m", "height_sd_m", height_m, GOE_HAS_HEIGHT),
    QUANTITY("orientation_deg", "orientation_sd_deg", orientation_deg, GOE_HAS_ORIENTATION),
    QUANTITY("center_n_m", "center_n_sd_m", center_north_m, GOE_HAS_CENTER),
    QUANTITY("center_e_m", "center_e_sd_m", center_east_m, GOE_HAS_CENTER),
};
static const quantity_t velocities[] = {
    QUANTITY("velocity_n_m_s", "velocity_n_sd_m_s", velocity_north_m_s, GOE_HAS_VELOCITY),
    QUANTITY("velocity_e_m_s", "velocity_e_sd_m_s", velocity_east_m_s, GOE_HAS_VELOCITY),
};
#undef QUANTITY
#define QUANTITIES (sizeof quantities / sizeof quantities[0])
#define VELOCITIES (sizeof velocities / sizeof velocities[0])

#define LEADING_MAX 160 /* time text, id, status, model and number of points */
#define DOUBT_MAX 20    /* suspect and reason */
#define RESIDUALS_MAX ((3 + 2 * VELOCITIES + 2) * (NUMBER_TEXT_MAX + 1))
#define ROW_MAX (LEADING_MAX + 2 * QUANTITIES * (NUMBER_TEXT_MAX + 1) + DOUBT_MAX + RESIDUALS_MAX + 1)

bool estimate_write_header(FILE *stream, bool residuals) {
    bool written = fputs("t_s,id,status,model,images_used", stream) >= 0;
    for (size_t i = 0; i < QUANTITIES; i++) {
        written = fprintf(stream, ",%s,%s", quantities[i].name, quantities[i].sigma_name) >= 0 && written;
    }
    written = fputs(",suspect,reason", stream) >= 0 && written;
    if (residuals) {
        written = fputs(",nis,nis_rows,nis_ratio", stream) >= 0 && written;
        for (size_t i = 0; i < VELOCITIES; i++) {
            written = fprintf(stream, ",%s,%s", velocities[i].name, velocities[i].sigma_name) >= 0 && written;
        }
        written = fputs(",latency_s,latency_sd_s", stream) >= 0 && written;
    }
    return fputs("\n", stream) >= 0 && written;
}

static const char *model_text(goe_model_t model) {
    switch (model) {
        case GOE_MODEL_DISC:
            return "disc";
        case GOE_MODEL_LINE:
            return "line";
        case GOE_MODEL_BOX:
            return "box";
        case GOE_MODEL_PRISM:
            return "prism";
        case GOE_MODEL_NONE:
        case GOE_MODEL_AUTO:
        default:
            return "none";
    }
}

static char *append_number(char *out, const goe_estimate_t *estimate, size_t offset) {
    float value = 0.0f;
    (void)memcpy(&value, (const char *)estimate + offset, sizeof value);
    return out + number_format(out, value);
}

static char *append_quantity(char *out, const goe_estimate_t *estimate, const quantity_t *quantity) {
    const bool valid = (estimate->valid & quantity->valid) != 0;
    *out++ = ',';
    out = valid ? append_number(out, estimate, quantity->value) : out;
    *out++ = ',';
    return valid ? append_number(out, estimate, quantity->sigma) : out;
}

static char *append_doubt(char *out, const goe_estimate_t *estimate) {
    const int length = snprintf(out, DOUBT_MAX, ",%d,%s", estimate->suspect ? 1 : 0, goe_reason_text(estimate->reason));
    return out + (length < 0 ? 0 : length);
}

static char *append_residuals(char *out, const goe_estimate_t *estimate) {
    *out++ = ',';
    if (estimate->nis_rows > 0) {
        out += number_format(out, estimate->nis);
    }
    *out++ = ',';
    out += number_format(out, (float)estimate->nis_rows);
    *out++ = ',';
    if (estimate->nis_ratio > 0.0f) {
        out += number_format(out, estimate->nis_ratio);
    }
    for (size_t i = 0; i < VELOCITIES; i++) {
        out = append_quantity(out, estimate, &velocities[i]);
    }
    *out++ = ',';
    out += number_format(out, estimate->latency_s);
    *out++ = ',';
    return out + number_format(out, estimate->sigma.latency_s);
}

bool estimate_write_row(FILE *stream, const char *time_text, int64_t id, goe_status_t status,
                        const goe_estimate_t *estimate, bool residuals) {
    char row[ROW_MAX];
    const int leading = snprintf(row, LEADING_MAX, "%s,%" PRId64 ",%s,%s,%d", time_text, id, goe_status_text(status),
                                 model_text(estimate->model), estimate->images_used);
    if (leading < 0 || leading >= LEADING_MAX) {
        return false;
    }
    char *out = row + leading;
    for (size_t i = 0; i < QUANTITIES; i++) {
        out = append_quantity(out, estimate, &quantities[i]);
    }
    out = append_doubt(out, estimate);
    out = residuals ? append_residuals(out, estimate) : out;
    *out++ = '\n';
    const size_t length = (size_t)(out - row);
    return fwrite(row, 1u, length, stream) == length;
}
