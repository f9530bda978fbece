/* The self-check at start: CONFIG_GOE_SELF_CHECK. SPDX-License-Identifier: MIT */
#include <zephyr/init.h>
#include <zephyr/kernel.h>
#include <zephyr/sys/printk.h>

#include "goe.h"

static int check_arithmetic(void) {
    const unsigned found = goe_self_check();
    if (found != 0u) {
        printk("goe: goe_self_check() returned 0x%02x: results are not bit-identical to those of other targets\n",
               found);
    }
    return 0;
}

SYS_INIT(check_arithmetic, APPLICATION, CONFIG_KERNEL_INIT_PRIORITY_DEFAULT);
