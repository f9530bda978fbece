/* What the name of a class says of an obstacle's size and shape. SPDX-License-Identifier: MIT */
#ifndef OBSTACLE_CLASS_H
#define OBSTACLE_CLASS_H

#include <stdbool.h>

#include "goe.h"

#define OBSTACLE_CLASS_NAME_MAX 64

/* The kind of a class, for any case of its letters. False, and an unknown kind, if the table does not have the name. */
bool obstacle_class_kind(const char *name, goe_kind_t *kind);

#endif
