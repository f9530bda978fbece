/* What the C library of the test programs asks of a system. SPDX-License-Identifier: MIT
 *
 * The library goe needs none of this. Test programs ask for an environment; what else the C library might want (files,
 * a heap) is refused. */
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
