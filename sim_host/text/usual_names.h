/* Names that other programs give to the columns of a log. SPDX-License-Identifier: MIT */
#ifndef USUAL_NAMES_H
#define USUAL_NAMES_H

/* The column that a name usually means; null: the name is not in the list. */
const char *usual_name(const char *name);

#endif
