/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

enum perf_counter_type { PC_ELAPSED };
struct standin_perf {
    const char *name;
    unsigned long events;
};
using perf_counter_t = standin_perf *;

inline perf_counter_t perf_alloc(perf_counter_type, const char *name) { return new standin_perf{name, 0}; }
inline void perf_free(perf_counter_t counter) { delete counter; }
inline void perf_begin(perf_counter_t) {}
inline void perf_end(perf_counter_t counter) { counter->events++; }
inline void perf_print_counter(perf_counter_t counter) {
    standin::print("%s: %lu events\n", counter->name, counter->events);
}
