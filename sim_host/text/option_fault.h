/* The fault of a command line, from popt's result. SPDX-License-Identifier: MIT */
#ifndef OPTION_FAULT_H
#define OPTION_FAULT_H

#include <popt.h>
#include <stddef.h>

#define OPTION_FAULT_MAX 160

/* The option to blame, where popt names only the value that it cannot read. */
const char *option_blamed(poptContext context, int argc, const char *const *argv);

/* popt's text for an error, and for an unknown option the one that was probably meant. Tables that the given one includes are
 * searched, too. */
void option_fault_bare(char *text, size_t capacity, const struct poptOption *table, const char *name, const char *value,
                       int error);

/* The same of a name with its dashes, as option_blamed() has it, and of the guess; with the value that cannot be read, unless the
 * name already has it behind a '='. */
void option_fault(char text[OPTION_FAULT_MAX], poptContext context, const struct poptOption *table, const char *bad,
                  int error);

#endif
