/* The stand-in for Zephyr's kernel on the host. With STAND_IN_HURRY in the environment time waits for no thread, and readers of a
 * queue are slower than its writers, however fast the machine is: a reader takes a message only after one was
 * refused, or once no other thread runs. SPDX-License-Identifier: MIT */
#include <zephyr/kernel.h>
#include <zephyr/sys/printk.h>

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define NS_PER_S 1000000000L
#define STACK_UNUSED 96 /* the reported number of unused stack bytes of every thread */

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
static int busy = 1; /* threads that do not wait; main() is one */
static int refused;  /* messages since the last one was taken */
static struct k_msgq *queues;

static bool in_a_hurry(void) { return getenv("STAND_IN_HURRY") != NULL; }

/* Both are called with the lock held. */
static void begin_waiting(void) {
    busy--;
    (void)pthread_cond_broadcast(&changed);
}

static void end_waiting(void) {
    busy++;
    (void)pthread_cond_broadcast(&changed);
}

/* ------------------------------------------------------------------------------------------------------------- queue -- */

void stand_in_queue(struct k_msgq *queue) {
    queue->next = queues;
    queues = queue;
}

int k_msgq_put(struct k_msgq *queue, const void *message, k_timeout_t timeout) {
    (void)pthread_mutex_lock(&lock);
    while (queue->count == queue->most) {
        if (timeout.us == 0) {
            refused++;
            (void)pthread_cond_broadcast(&changed);
            (void)pthread_mutex_unlock(&lock);
            return -ENOMSG;
        }
        begin_waiting();
        (void)pthread_cond_wait(&changed, &lock);
        end_waiting();
    }
    memcpy(queue->buffer + (queue->begin + queue->count) % queue->most * queue->size, message, queue->size);
    queue->count++;
    (void)pthread_cond_broadcast(&changed);
    (void)pthread_mutex_unlock(&lock);
    return 0;
}

/* Called with the lock held. */
static bool is_too_early(const struct k_msgq *queue) {
    return queue->count == 0u || (in_a_hurry() && refused == 0 && busy != 0);
}

int k_msgq_get(struct k_msgq *queue, void *message, k_timeout_t timeout) {
    (void)pthread_mutex_lock(&lock);
    if (queue->count == 0u && timeout.us == 0) {
        (void)pthread_mutex_unlock(&lock);
        return -ENOMSG;
    }
    begin_waiting();
    while (is_too_early(queue)) {
        (void)pthread_cond_wait(&changed, &lock);
    }
    refused = 0;
    memcpy(message, queue->buffer + queue->begin * queue->size, queue->size);
    queue->begin = (queue->begin + 1u) % queue->most;
    queue->count--;
    end_waiting();
    (void)pthread_mutex_unlock(&lock);
    return 0;
}

static bool all_empty(void) {
    for (const struct k_msgq *queue = queues; queue != NULL; queue = queue->next) {
        if (queue->count != 0u) {
            return false;
        }
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------------- timer -- */

void k_timer_start(struct k_timer *timer, k_timeout_t duration, k_timeout_t period) {
    timer->running = duration.us >= 0 && period.us > 0;
}

uint32_t k_timer_status_sync(struct k_timer *timer) {
    if (!timer->running) {
        return 0;
    }
    (void)pthread_mutex_lock(&lock);
    begin_waiting();
    while (!in_a_hurry() && (busy != 0 || !all_empty())) {
        (void)pthread_cond_wait(&changed, &lock);
    }
    end_waiting();
    (void)pthread_mutex_unlock(&lock);
    return 1;
}

void k_timer_stop(struct k_timer *timer) { timer->running = false; }

uint32_t k_cycle_get_32(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint32_t)now.tv_sec * (uint32_t)NS_PER_S + (uint32_t)now.tv_nsec;
}

uint32_t k_cyc_to_us_floor32(uint32_t cycles) { return cycles / 1000u; }

uint32_t k_cyc_to_us_ceil32(uint32_t cycles) { return cycles / 1000u + (cycles % 1000u != 0u); }

/* ----------------------------------------------------------------------------------------------------------- threads -- */

static void *run(void *argument) {
    k_tid_t thread = argument;
    thread->entry(thread->argument[0], thread->argument[1], thread->argument[2]);
    (void)pthread_mutex_lock(&lock);
    begin_waiting();
    (void)pthread_mutex_unlock(&lock);
    return NULL;
}

/* Threads that share a floating-point unit have to declare it: all threads here compute. */
static bool may_compute(const struct stand_in_thread *thread) {
#if defined(CONFIG_FPU_SHARING)
    return (thread->options & K_FP_REGS) != 0u;
#else
    return thread->options == 0u;
#endif
}

void k_thread_start(k_tid_t thread) {
    (void)pthread_mutex_lock(&lock);
    end_waiting();
    (void)pthread_mutex_unlock(&lock);
    if (thread->stack_bytes <= STACK_UNUSED || !may_compute(thread) ||
        pthread_create(&thread->thread, NULL, run, thread) != 0) {
        abort();
    }
}

int k_thread_join(k_tid_t thread, k_timeout_t timeout) {
    (void)timeout;
    (void)pthread_mutex_lock(&lock);
    begin_waiting();
    (void)pthread_mutex_unlock(&lock);
    const int failed = pthread_join(thread->thread, NULL);
    (void)pthread_mutex_lock(&lock);
    end_waiting();
    (void)pthread_mutex_unlock(&lock);
    return -failed;
}

int k_thread_stack_space_get(k_tid_t thread, size_t *unused_bytes) {
    (void)thread;
    *unused_bytes = STACK_UNUSED;
    return 0;
}

void printk(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    (void)vprintf(format, arguments);
    va_end(arguments);
}

/* Linked with --wrap=goe_flight_init: refuses all settings. */
int __wrap_goe_flight_init(void);
int __wrap_goe_flight_init(void) { return -32; }
