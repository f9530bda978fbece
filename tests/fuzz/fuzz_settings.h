/* Settings by the fuzzer's bytes: the defaults, a camera, and changes of a few fields. SPDX-License-Identifier: MIT */
#ifndef FUZZ_SETTINGS_H
#define FUZZ_SETTINGS_H

#include "fuzz_input.h"
#include "goe.h"

/* Defaults, and a camera that shows the scene: goe_init() accepts them. */
void fuzz_usual_settings(fuzz_input_t *in, goe_settings_t *settings);

/* Changes some fields, within their ranges (`legal`) or not. */
void fuzz_change_settings(fuzz_input_t *in, bool legal, goe_settings_t *settings);

#endif
