/* A box with only its silhouette visible. SPDX-License-Identifier: MIT
 *
 * Two faces of a box end in two outer corners: whatever its sides are, the silhouette shows the line between these, the
 * chord. The sides show only when a face turns away and the silhouette takes the corner between them. So: disc, then
 * chord, then box. */
#ifndef GOE_CHORD_H
#define GOE_CHORD_H

#include "refined/goe_gate.h"
#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* Both return whether there was a change; the image that brings it is not used for more.
 *
 * Of a disc: takes it for a chord if that is clear. */
bool goe_chord_start(goe_filter_t *filter, const goe_observation_t *obs);

/* Of a chord: when one of its ends has left the chord it learns that end again (a face came into view) or becomes a box (a
 * face turned away). */
bool goe_chord_change(goe_filter_t *filter, const goe_observation_t *obs);

/* Before the update: the roof's nearest corner may stand before the chord, and must not give the range. */
void goe_chord_free_top(goe_filter_t *filter, const goe_observation_t *obs);

/* Appends the rows of a chord. */
/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows) && rows->count == 0; */
void goe_chord_rows(const goe_observation_t *obs, goe_rows_t *rows);

/* After the gate: keeps in mind by how much the ends leave the chord. */
void goe_chord_follow(goe_filter_t *filter, const goe_verdict_t *verdict);

/* Whether an end is leaving the chord, so that its refusal says nothing against the state. */
bool goe_chord_is_leaving(const goe_filter_t *filter);

void goe_chord_shape(const goe_filter_t *filter, goe_shape_t *shape);

#endif
