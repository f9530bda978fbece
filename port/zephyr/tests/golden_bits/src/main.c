/* Replays the embedded logs through the estimator and through the flight layer, and prints a hash of every output bit:
 * the same as on every other target, or goe_self_check() gives the reason. SPDX-License-Identifier: MIT */
#include <zephyr/kernel.h>
#include <zephyr/sys/printk.h>

int replay_main(void);
int flight_main(void);

int main(void) {
    (void)replay_main();
    (void)flight_main();
    printk("done\n");
    return 0;
}
