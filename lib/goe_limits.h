/* Parts of the library and compile-time limits. Included by goe.h. SPDX-License-Identifier: MIT
 *
 * A header of the firmware may define them: -DGOE_CONFIG_HEADER='"my_goe_config.h"'. [A24] All translation units of a program
 * must use the same values; goe_init() refuses an estimator of another size. */
#ifndef GOE_LIMITS_H
#define GOE_LIMITS_H

#ifdef GOE_CONFIG_HEADER
#include GOE_CONFIG_HEADER
#endif

/* Parts. 1 compiles the part's code and state, 0 leaves both out. At least one method is needed. */
#ifndef GOE_WITH_WINDOW
#define GOE_WITH_WINDOW 1 /* the window method */
#endif
#ifndef GOE_WITH_FILTER
#define GOE_WITH_FILTER 1 /* the filter method */
#endif
#ifndef GOE_WITH_HAZARD
#define GOE_WITH_HAZARD 1 /* goe_hazard, goe_decide, goe_rule_default, goe_earliest_tcpa_s */
#endif
#ifndef GOE_WITH_TARGET_MOTION
#define GOE_WITH_TARGET_MOTION 1 /* filter: corrects pose latency and jumps without a reset; estimates velocities */
#endif
#if !GOE_WITH_WINDOW && !GOE_WITH_FILTER
#error "GOE_WITH_WINDOW or GOE_WITH_FILTER must be 1"
#endif

/* Largest value of goe_settings_t.window.points, 3 to 64. Each image of the window costs 40 bytes. */
#ifndef GOE_WINDOW_MAX
#define GOE_WINDOW_MAX 8
#endif
#if GOE_WINDOW_MAX < 3 || GOE_WINDOW_MAX > 64
#error "GOE_WINDOW_MAX must be 3 to 64"
#endif

/* Largest number of cameras of one aircraft, 1 to 8. Each additional camera costs 360 to 384 bytes. */
#ifndef GOE_CAMERAS_MAX
#define GOE_CAMERAS_MAX 1
#endif
#if GOE_CAMERAS_MAX < 1 || GOE_CAMERAS_MAX > 8
#error "GOE_CAMERAS_MAX must be 1 to 8"
#endif

/* Marks a result that the caller must not ignore. */
#if defined(__GNUC__) || defined(__clang__)
#define GOE_NODISCARD __attribute__((warn_unused_result))
#else
#define GOE_NODISCARD
#endif

#endif
