/* Names that version 0.4.0 replaced. The programs refuse an old name and report the new one. SPDX-License-Identifier: MIT */
#ifndef RENAMED_NAMES_H
#define RENAMED_NAMES_H

#include <stddef.h>

/* The new name of an old one, which need not end with a zero; null: the name was not replaced. */
const char *renamed_name(const char *name, size_t length);

#endif
