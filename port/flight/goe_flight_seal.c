/* Seal (checksum) over the layer's settings and cameras. SPDX-License-Identifier: MIT */
#include "goe_flight_seal.h"

#include "goe_flight_maths.h"

#define SEED 0x5EA1u

/* All floats, without padding between them. */
#define FROM offsetof(goe_flight_t, settings)
#define TO (offsetof(goe_flight_t, attitude_white_sd_deg) + sizeof(float))
#define NUMBERS ((TO - FROM) / sizeof(float))

GOE_STATIC_ASSERT(TO - FROM ==
                      sizeof(goe_flight_settings_t) + GOE_CAMERAS_MAX * sizeof(goe_flight_camera_t) + sizeof(float),
                  sealed_memory_is_whole);

/* As the estimator's seal, it detects every change of one number, and of two bits, except the same bit of two numbers 32 apart. */
static goe_seal_t seal_of(const goe_flight_t *flight) {
    const unsigned char *from = (const unsigned char *)flight + FROM;
    goe_seal_t seal = {SEED, SEED};
    for (size_t i = 0; i < NUMBERS; i++) {
        uint32_t word;
        memcpy(&word, from + i * sizeof word, sizeof word);
        seal.sum += word;
        seal.turned = word ^ (seal.turned << 1 | seal.turned >> 31);
    }
    return seal;
}

void goe_flight_seal(goe_flight_t *flight) { flight->seal = seal_of(flight); }

bool goe_flight_is_sealed(const goe_flight_t *flight) {
    const goe_seal_t seal = seal_of(flight);
    return seal.sum == flight->seal.sum && seal.turned == flight->seal.turned;
}

void goe_flight_unseal(goe_flight_t *flight) { flight->seal.sum = ~seal_of(flight).sum; }
