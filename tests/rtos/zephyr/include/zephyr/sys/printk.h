/* A stand-in for Zephyr's printk.h: see kernel.h. SPDX-License-Identifier: MIT */
#ifndef STAND_IN_ZEPHYR_PRINTK_H
#define STAND_IN_ZEPHYR_PRINTK_H

__attribute__((format(printf, 1, 2))) void printk(const char *format, ...);

#endif
