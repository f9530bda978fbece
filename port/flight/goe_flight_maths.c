/* Finite numbers, angles and rotations of the flight layer. SPDX-License-Identifier: MIT */
#include "goe_flight_maths.h"

#include <math.h>

bool goe_flight_all_finite(const float *numbers, int count) {
    bool finite = true;
    for (int i = 0; i < count; i++) {
        finite = goe_flight_finite(numbers[i]) && finite;
    }
    return finite;
}

bool goe_flight_all_within(const float *numbers, int count, float limit) {
    bool within = true;
    for (int i = 0; i < count; i++) {
        within = goe_flight_within(numbers[i], limit) && within;
    }
    return within;
}

#define DEG_MAX 1.0e6f /* for a larger angle the number of quarter turns may not fit an int */

/* Minimax polynomial, made by `python -m bench minimax`. Its own error: 5e-9 rad. */
#define TAN_PI_8 0.414213562f
#define ATAN_3 0.333327567f /* atan t = t - t z (A3 - A5 z + A7 z^2 - A9 z^3), |t| <= tan(pi/8), z = t^2 */
#define ATAN_5 0.199718793f
#define ATAN_7 0.138244538f
#define ATAN_9 0.0790259837f

static float atan_of_unit_deg(float t) {
    const bool folded = t > TAN_PI_8; /* atan t = 45 degrees + atan((t - 1)/(t + 1)) */
    const float u = folded ? (t - 1.0f) / (t + 1.0f) : t;
    const float z = u * u;
    const float angle = u - u * (z * (ATAN_3 - z * (ATAN_5 - z * (ATAN_7 - z * ATAN_9))));
    return (folded ? 45.0f : 0.0f) + angle * GOE_FLIGHT_DEG_PER_RAD;
}

float goe_flight_atan2_deg(float y, float x) {
    const float up = goe_flight_absolute(y);
    const float along = goe_flight_absolute(x);
    if (!(up > 0.0f) && !(along > 0.0f)) {
        return 0.0f;
    }
    float deg = up <= along ? atan_of_unit_deg(up / along) : 90.0f - atan_of_unit_deg(along / up);
    deg = x < 0.0f ? 180.0f - deg : deg;
    return y < 0.0f ? -deg : deg;
}

/* Taylor series up to t^7 and t^8. For |t| <= pi/4, the next term is below 3.2e-7. */
void goe_flight_sincos_deg(float angle_deg, float *sine, float *cosine) {
    const float deg = goe_flight_within(angle_deg, DEG_MAX) ? angle_deg : 0.0f;
    const int quarter = (int)(deg * (1.0f / 90.0f) + (deg < 0.0f ? -0.5f : 0.5f));
    const float t = (deg - (float)quarter * 90.0f) * GOE_FLIGHT_RAD_PER_DEG;
    const float z = t * t;
    const float s = t - t * (z * (1.0f / 6.0f - z * (1.0f / 120.0f - z * (1.0f / 5040.0f))));
    const float c = 1.0f - z * (0.5f - z * (1.0f / 24.0f - z * (1.0f / 720.0f - z * (1.0f / 40320.0f))));
    const bool swapped = ((unsigned)quarter & 1u) != 0u;
    const float first = swapped ? c : s;
    const float second = swapped ? s : c;
    *sine = ((unsigned)quarter & 2u) != 0u ? -first : first;
    *cosine = (((unsigned)quarter + 1u) & 2u) != 0u ? -second : second;
}

float goe_flight_positive_deg(float angle_deg) {
    const float deg = goe_flight_within(angle_deg, DEG_MAX) ? angle_deg : 0.0f;
    const float turned = deg - 360.0f * (float)(int)(deg * (1.0f / 360.0f));
    const float positive = turned < 0.0f ? turned + 360.0f : turned;
    return positive < 360.0f ? positive : 0.0f;
}

void goe_flight_rotation(const float q[4], float r[9]) {
    const float w = q[0];
    const float x = q[1];
    const float y = q[2];
    const float z = q[3];
    r[0] = 1.0f - 2.0f * (y * y + z * z);
    r[1] = 2.0f * (x * y - w * z);
    r[2] = 2.0f * (x * z + w * y);
    r[3] = 2.0f * (x * y + w * z);
    r[4] = 1.0f - 2.0f * (x * x + z * z);
    r[5] = 2.0f * (y * z - w * x);
    r[6] = 2.0f * (x * z - w * y);
    r[7] = 2.0f * (y * z + w * x);
    r[8] = 1.0f - 2.0f * (x * x + y * y);
}

void goe_flight_turn(const float r[9], const float v[3], float turned[3]) {
    for (int i = 0; i < 3; i++) {
        turned[i] = r[3 * i] * v[0] + r[3 * i + 1] * v[1] + r[3 * i + 2] * v[2];
    }
}

void goe_flight_turn_back(const float r[9], const float v[3], float turned[3]) {
    for (int i = 0; i < 3; i++) {
        turned[i] = r[i] * v[0] + r[3 + i] * v[1] + r[6 + i] * v[2];
    }
}
