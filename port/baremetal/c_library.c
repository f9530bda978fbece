/* System calls that the C library of the test programs needs. SPDX-License-Identifier: MIT
 *
 * The library goe needs none of them. Test programs need an environment; all other calls of the C library (files,
 * a heap) are refused. */
#include <stddef.h>
#include <string.h>

#include "semihosting.h"

void _exit(int status);
void *_sbrk(int bytes);

void _exit(int status) { port_exit(status); }

/* console.c has another one. */
__attribute__((weak)) void *_sbrk(int bytes) {
    (void)bytes;
    return (void *)-1;
}

#if defined(PORT_ENVIRONMENT)
/* The environment of a machine without one: "NAME=value", the value of one variable. */
char *getenv(const char *name);

char *getenv(const char *name) {
    static char environment[] = PORT_ENVIRONMENT;
    const size_t length = strlen(name);
    return strncmp(environment, name, length) == 0 && environment[length] == '=' ? &environment[length + 1] : NULL;
}
#endif
