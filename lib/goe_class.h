/* Size and shape of an obstacle by its detector's class. Included by goe.h. SPDX-License-Identifier: MIT */
#ifndef GOE_CLASS_H
#define GOE_CLASS_H

#ifndef GOE_H
#error "include goe.h, which includes this"
#endif

/* What the detector's class says of the obstacle, for the filter method. All 0: unknown. Each size is 0 (unknown) to 1e3 m; a size above
 * 0 needs a sigma of at least 1 % of it, at most 1e3 m.
 * While images do not show the range, the estimate follows from the size; such an estimate never leads to GOE_DECISION_CLEAR. A wrong
 * class therefore gives a wrong range at first, until images show it. If images contradict a size by four sigmas, or show the obstacle
 * where it cannot be by that size, goe reports GOE_REASON_SHAPE and ignores all classes to the end of the track.
 * The shape counts from the first image of the track on, and again after a restart of the filter. */
typedef struct {
    float width_m, width_sd_m;   /* width of the silhouette, whatever side is visible, and one sigma */
    float height_m, height_sd_m; /* height, and one sigma */
    uint8_t shape;               /* GOE_KIND_... */
} goe_kind_t;

#define GOE_KIND_UNKNOWN 0u
#define GOE_KIND_ROUND 1u /* an upright cylinder, as with the setting model disc */
#define GOE_KIND_OTHER 2u /* not an upright cylinder, also with the setting model disc */

#endif
