/* All of <string.h> that lib/ may use. SPDX-License-Identifier: MIT */
#ifndef POOR_STRING_H
#define POOR_STRING_H

#include <stddef.h>

void *memcpy(void *to, const void *from, size_t count);
void *memset(void *to, int byte, size_t count);

#endif
