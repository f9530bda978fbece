/* Arctangent, sine and cosine by polynomials. SPDX-License-Identifier: MIT */
#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

/* Minimax polynomials in z = t^2, made by `python -m bench minimax`. The bounds are those of the polynomials alone. */
#define TAN_PI_8 0.414213562f
#define ATAN_1 0.333327567f /* atan t = t - t z (A1 - A2 z + A3 z^2 - A4 z^3), |t| <= tan(pi/8): 5e-9 rad */
#define ATAN_2 0.199718793f
#define ATAN_3 0.138244538f
#define ATAN_4 0.0790259837f
#define SIN_1 0.166666507f /* sin t = t - t z (S1 - S2 z + S3 z^2), |t| <= pi/4: 2e-9 */
#define SIN_2 0.00833197866f
#define SIN_3 0.000194956362f
#define COS_1 0.0416666469f /* cos t = 1 - z/2 + z^2 (C1 - C2 z + C3 z^2), |t| <= pi/4: 1e-10 */
#define COS_2 0.00138873675f
#define COS_3 2.44384516e-05f

#define DEG_MAX 1.0e6f /* for a larger angle the number of quarter turns may not fit an int */
#define QUARTER_PI_RAD 0.785398163f
#define HALF_PI_RAD 1.57079633f

static float arctan_of_fraction(float t) {
    const float z = t * t;
    return t - t * (z * (ATAN_1 - z * (ATAN_2 - z * (ATAN_3 - z * ATAN_4))));
}

/* For 0 <= t <= 1. Above tan(pi/8), atan t = pi/4 + atan((t - 1)/(t + 1)) keeps the polynomial short. */
static float arctan_of_unit(float t) {
    if (t <= TAN_PI_8) {
        return arctan_of_fraction(t);
    }
    return QUARTER_PI_RAD + arctan_of_fraction((t - 1.0f) / (t + 1.0f));
}

float goe_arctan_rad(float y, float x) {
    const float magnitude = goe_absolute(y);
    const float angle = magnitude <= x ? arctan_of_unit(magnitude / x) : HALF_PI_RAD - arctan_of_unit(x / magnitude);
    return y < 0.0f ? -angle : angle;
}

void goe_sincos_deg(float angle_deg, float *sine, float *cosine) {
    const float deg = goe_within(angle_deg, DEG_MAX) ? angle_deg : 0.0f;
    const int quarter = (int)(deg * (1.0f / 90.0f) + (deg < 0.0f ? -0.5f : 0.5f));
    const float t = (deg - (float)quarter * 90.0f) * GOE_RAD_PER_DEG; /* the difference is exact up to 720 degrees */
    const float z = t * t;
    const float s = t - t * (z * (SIN_1 - z * (SIN_2 - z * SIN_3)));
    const float c = 1.0f - 0.5f * z + z * z * (COS_1 - z * (COS_2 - z * COS_3));
    switch ((unsigned)quarter & 3u) {
        case 0u:
            *sine = s;
            *cosine = c;
            break;
        case 1u:
            *sine = c;
            *cosine = -s;
            break;
        case 2u:
            *sine = -s;
            *cosine = -c;
            break;
        default:
            *sine = -c;
            *cosine = s;
            break;
    }
}
