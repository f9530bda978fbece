/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "option_fault.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "input_error.h"
#include "nearest_name.h"

static bool is_end(const struct poptOption *option) {
    return option->longName == NULL && option->shortName == '\0' && option->arg == NULL;
}

/* Tables include others, which include none. */
static void try_table(nearest_name_t *nearest, const struct poptOption *table) {
    for (const struct poptOption *option = table; !is_end(option); option++) {
        if (option->longName != NULL) {
            nearest_name_try(nearest, option->longName);
        }
    }
}

const char *option_blamed(poptContext context, int argc, const char *const *argv) {
    const char *bad = poptBadOption(context, 0);
    for (int i = 2; i < argc; i++) {
        if (strcmp(argv[i], bad) == 0 && bad[0] != '-' && argv[i - 1][0] == '-') {
            return argv[i - 1];
        }
    }
    return bad;
}

static void tell(char *text, size_t capacity, const struct poptOption *table, const char *word, const char *value,
                 int error, const char *dashes) {
    const char *quote = value != NULL ? " '" : "";
    nearest_name_t nearest = nearest_name_of(word, strcspn(word, "="));
    try_table(&nearest, table);
    for (const struct poptOption *option = table; !is_end(option); option++) {
        if ((option->argInfo & POPT_ARG_MASK) == POPT_ARG_INCLUDE_TABLE) {
            try_table(&nearest, option->arg);
        }
    }
    const bool guess = error == POPT_ERROR_BADOPT && nearest.name != NULL;
    const excerpt_t shown = excerpt_of(value != NULL ? value : "", value != NULL ? strlen(value) : 0u);
    (void)snprintf(text, capacity, "%s%s%s%s%s%s%s%s", poptStrerror(error), quote, shown.text, value != NULL ? "'" : "",
                   guess ? "; did you mean " : "", guess ? dashes : "", guess ? nearest.name : "", guess ? "?" : "");
}

void option_fault_bare(char *text, size_t capacity, const struct poptOption *table, const char *name, const char *value,
                       int error) {
    tell(text, capacity, table, name, error != POPT_ERROR_BADOPT ? value : NULL, error, "");
}

void option_fault(char text[OPTION_FAULT_MAX], poptContext context, const struct poptOption *table, const char *bad,
                  int error) {
    const char *value = poptBadOption(context, 0);
    const bool apart = error == POPT_ERROR_BADNUMBER || error == POPT_ERROR_OVERFLOW;
    tell(text, OPTION_FAULT_MAX, table, bad + strspn(bad, "-"), apart && strcmp(value, bad) != 0 ? value : NULL, error,
         "--");
}
