/* A stand-in for Zephyr's kernel.h on the host: only the names that port/zephyr uses. Names, arguments and meanings were compared
 * with Zephyr 3.4.0 on 2026-11-22. SPDX-License-Identifier: MIT
 *
 * Threads are the host's. Time advances immediately when every thread waits and every queue is empty. */
#ifndef STAND_IN_ZEPHYR_KERNEL_H
#define STAND_IN_ZEPHYR_KERNEL_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ARG_UNUSED(argument) (void)(argument)
#define MAX(a, b) ((a) > (b) ? (a) : (b))

typedef struct {
    int64_t us; /* below 0: for ever */
} k_timeout_t;
#define K_NO_WAIT ((k_timeout_t){0})
#define K_FOREVER ((k_timeout_t){-1})
#define K_USEC(time_us) ((k_timeout_t){(int64_t)(time_us)})
#define SYS_FOREVER_MS (-1)

/* ------------------------------------------------------------------------------------------------------------- queue -- */

struct k_msgq {
    char *buffer;
    size_t size;
    uint32_t most, begin, count;
    struct k_msgq *next;
};
void stand_in_queue(struct k_msgq *queue);
#define K_MSGQ_DEFINE(name, message_size, message_count, alignment)                                                    \
    extern struct k_msgq name;                                                                                         \
    __attribute__((constructor)) static void name##_register(void) { stand_in_queue(&name); }                          \
    static char __attribute__((aligned(alignment))) name##_buffer[(message_size) * (message_count)];                   \
    struct k_msgq name = {name##_buffer, message_size, message_count, 0u, 0u, NULL}
int k_msgq_put(struct k_msgq *queue, const void *message, k_timeout_t timeout);
int k_msgq_get(struct k_msgq *queue, void *message, k_timeout_t timeout);

/* ------------------------------------------------------------------------------------------------------------- timer -- */

struct k_timer {
    bool running;
};
#define K_TIMER_DEFINE(name, expired, stopped) struct k_timer name = {(expired) != NULL || (stopped) != NULL}
void k_timer_start(struct k_timer *timer, k_timeout_t duration, k_timeout_t period);
uint32_t k_timer_status_sync(struct k_timer *timer);
void k_timer_stop(struct k_timer *timer);
uint32_t k_cycle_get_32(void);
uint32_t k_cyc_to_us_floor32(uint32_t cycles);
uint32_t k_cyc_to_us_ceil32(uint32_t cycles);

/* ----------------------------------------------------------------------------------------------------------- threads -- */

#define K_FP_REGS 2

typedef void (*k_thread_entry_t)(void *p1, void *p2, void *p3);
struct stand_in_thread {
    pthread_t thread;
    k_thread_entry_t entry;
    void *argument[3];
    size_t stack_bytes;
    unsigned options;
};
typedef struct stand_in_thread *k_tid_t;
void k_thread_start(k_tid_t thread);
/* 300: after all calls of SYS_INIT. A thread with a delay waits for k_thread_start(). */
#define K_THREAD_DEFINE(name, stack_bytes, entry, p1, p2, p3, priority, options, delay_ms)                             \
    static struct stand_in_thread name##_thread = {0, entry, {p1, p2, p3}, stack_bytes, options};                      \
    __attribute__((constructor(300))) static void name##_start(void) {                                                 \
        (void)(priority);                                                                                              \
        if ((delay_ms) != SYS_FOREVER_MS) {                                                                            \
            k_thread_start(&name##_thread);                                                                            \
        }                                                                                                              \
    }                                                                                                                  \
    struct stand_in_thread *const name = &name##_thread
int k_thread_join(k_tid_t thread, k_timeout_t timeout);
int k_thread_stack_space_get(k_tid_t thread, size_t *unused_bytes);

#endif
