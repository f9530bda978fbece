/* A stand-in for Zephyr's init.h: see kernel.h. SPDX-License-Identifier: MIT */
#ifndef STAND_IN_ZEPHYR_INIT_H
#define STAND_IN_ZEPHYR_INIT_H

enum { STAND_IN_APPLICATION = 200 };

/* One level, one priority. */
#define SYS_INIT(function, level, priority)                                                                            \
    __attribute__((constructor(200))) static void function##_at_start(void) {                                          \
        _Static_assert((int)STAND_IN_##level == 200 && (priority) >= 0, "the stand-in knows APPLICATION alone");       \
        (void)function();                                                                                              \
    }                                                                                                                  \
    static int function(void)

#endif
