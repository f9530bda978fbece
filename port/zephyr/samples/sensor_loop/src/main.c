/* A sensor loop: poses at 50 Hz, images at 10 Hz and a timer come through a queue to a thread that estimates, assesses and prints.
 * SPDX-License-Identifier: MIT
 *
 * In your application existing code replaces sensor_thread(): drivers, a link to the autopilot, a detector. It may be
 * several threads. goe_thread() alone uses `estimator`, so nothing needs a lock. */
#include <zephyr/kernel.h>
#include <zephyr/sys/printk.h>

#include <string.h>

#include "scripted_estimator.h"

#define SENSOR_STACK_BYTES 1536
#define GOE_STACK_BYTES 5120
#define SENSOR_PRIORITY 5 /* before the estimator: samples are late otherwise */
#define GOE_PRIORITY 7
#define QUEUE_LENGTH 16 /* the estimator may sleep for 0.25 s */

K_MSGQ_DEFINE(sensor_queue, sizeof(scripted_message_t), QUEUE_LENGTH, 4);
K_TIMER_DEFINE(tick_timer, NULL, NULL);

static scripted_estimator_t estimator;
static uint32_t lost;

/* ----------------------------------------------------------------------------------------------------------- threads -- */

static void send(const scripted_message_t *message) {
    if (k_msgq_put(&sensor_queue, message, K_NO_WAIT) != 0) {
        lost++; /* the estimator is behind: a lost pose is a gap, a lost image is one that was never taken */
    }
}

static void sensor_thread(void *p1, void *p2, void *p3) {
    scripted_message_t message;
    ARG_UNUSED(p1);
    ARG_UNUSED(p2);
    ARG_UNUSED(p3);
    memset(&message, 0, sizeof(message));
    k_timer_start(&tick_timer, K_USEC(SCRIPTED_TICK_US), K_USEC(SCRIPTED_TICK_US));
    for (uint32_t tick = 0; tick < SCRIPTED_TICKS; tick++) {
        k_timer_status_sync(&tick_timer);
        for (int kind = SCRIPTED_POSE; kind < SCRIPTED_END; kind++) {
            if (scripted_message(tick, (scripted_kind_t)kind, &message)) {
                send(&message);
            }
        }
    }
    k_timer_stop(&tick_timer);
    message.kind = SCRIPTED_END;
    (void)k_msgq_put(&sensor_queue, &message, K_FOREVER);
}

static void goe_thread(void *p1, void *p2, void *p3) {
    static char line[SCRIPTED_LINE];
    scripted_message_t message;
    ARG_UNUSED(p1);
    ARG_UNUSED(p2);
    ARG_UNUSED(p3);
    while (k_msgq_get(&sensor_queue, &message, K_FOREVER) == 0 && message.kind != SCRIPTED_END) {
        if (scripted_take(&estimator, &message, line)) {
            printk("%s\n", line);
        }
    }
}

#if defined(CONFIG_FPU_SHARING)
#define THREAD_OPTIONS K_FP_REGS /* both use the floating-point unit */
#else
#define THREAD_OPTIONS 0
#endif

/* main() starts them. */
K_THREAD_DEFINE(sensor_id, SENSOR_STACK_BYTES, sensor_thread, NULL, NULL, NULL, SENSOR_PRIORITY, THREAD_OPTIONS,
                SYS_FOREVER_MS);
K_THREAD_DEFINE(goe_id, GOE_STACK_BYTES, goe_thread, NULL, NULL, NULL, GOE_PRIORITY, THREAD_OPTIONS, SYS_FOREVER_MS);

/* -------------------------------------------------------------------------------------------------------------- main -- */

static uint32_t cycles(void) { return k_cycle_get_32(); }

static void print_cost(const char *what, const scripted_cost_t *cost) {
    printk("%s: %u us, at most %u us\n", what, k_cyc_to_us_floor32(scripted_mean(cost)),
           k_cyc_to_us_ceil32(cost->most));
}

static void fly(void) {
    size_t unused = 0;
    k_thread_start(goe_id);
    k_thread_start(sensor_id);
    (void)k_thread_join(sensor_id, K_FOREVER);
    (void)k_thread_join(goe_id, K_FOREVER);
    (void)k_thread_stack_space_get(goe_id, &unused);
    printk("images %u, dropped %u; messages lost %u\n", estimator.frame.calls, estimator.dropped, lost);
    print_cost("an image", &estimator.frame);
    print_cost("an assessment", &estimator.assess);
    printk("on %s; stack %u of %u bytes; flight layer %u bytes\n", CONFIG_BOARD,
           (unsigned int)(GOE_STACK_BYTES - unused), GOE_STACK_BYTES, (unsigned int)sizeof(estimator.flight));
}

int main(void) {
    static char line[SCRIPTED_LINE];
    scripted_first_line(line);
    printk("%s\n", line);
    if (scripted_start(&estimator, cycles, line)) {
        fly();
    } else {
        printk("%s\n", line);
    }
    printk("done\n");
    return 0;
}
