/* A sensor loop: poses at 50 Hz, images at 10 Hz and a timer come through a queue; the main thread estimates, assesses and prints.
 * SPDX-License-Identifier: MIT
 *
 *   goe_sensor_loop [-f]   -f: as fast as it can, not at 50 Hz
 *
 * In your application existing code replaces sensor_thread(): drivers, a link to the autopilot, a detector. It may be
 * several tasks. The main thread alone uses `estimator`, so nothing needs a lock. */
#include <nuttx/config.h>

#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "scripted_estimator.h"

#define QUEUE_LENGTH 16
#define NS_PER_S 1000000000L
#define NS_PER_US 1000L
#define US_PER_S 1000000u

/* NuttX's own message queues hold 32 bytes a message unless MQ_MAXMSGSIZE is raised. */
typedef struct {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    scripted_message_t message[QUEUE_LENGTH];
    unsigned begin, count;
} queue_t;

static scripted_estimator_t estimator;
static queue_t queue;
static bool in_time; /* at 50 Hz */

/* ------------------------------------------------------------------------------------------------------------- queue -- */

/* Waits while the queue is full, so nothing is lost here; drivers that may not wait would drop the message, and count. */
static void put(const scripted_message_t *message) {
    (void)pthread_mutex_lock(&queue.lock);
    while (queue.count == QUEUE_LENGTH) {
        (void)pthread_cond_wait(&queue.changed, &queue.lock);
    }
    queue.message[(queue.begin + queue.count) % QUEUE_LENGTH] = *message;
    queue.count++;
    (void)pthread_cond_signal(&queue.changed);
    (void)pthread_mutex_unlock(&queue.lock);
}

static void get(scripted_message_t *message) {
    (void)pthread_mutex_lock(&queue.lock);
    while (queue.count == 0u) {
        (void)pthread_cond_wait(&queue.changed, &queue.lock);
    }
    *message = queue.message[queue.begin];
    queue.begin = (queue.begin + 1u) % QUEUE_LENGTH;
    queue.count--;
    (void)pthread_cond_signal(&queue.changed);
    (void)pthread_mutex_unlock(&queue.lock);
}

/* ----------------------------------------------------------------------------------------------------------- sensors -- */

static void wait_tick(struct timespec *next) {
    next->tv_nsec += (long)SCRIPTED_TICK_US * NS_PER_US;
    if (next->tv_nsec >= NS_PER_S) {
        next->tv_nsec -= NS_PER_S;
        next->tv_sec++;
    }
    (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, next, NULL);
}

static void *sensor_thread(void *argument) {
    scripted_message_t message;
    struct timespec next;
    memset(&message, 0, sizeof message);
    (void)clock_gettime(CLOCK_MONOTONIC, &next);
    for (uint32_t tick = 0; tick < SCRIPTED_TICKS; tick++) {
        if (in_time) {
            wait_tick(&next);
        }
        for (int kind = SCRIPTED_POSE; kind < SCRIPTED_END; kind++) {
            if (scripted_message(tick, (scripted_kind_t)kind, &message)) {
                put(&message);
            }
        }
    }
    message.kind = SCRIPTED_END;
    put(&message);
    return argument;
}

/* Before the estimator, or samples are late. Returns 0, or an error. */
static int start_sensors(pthread_t *thread) {
    pthread_attr_t attributes;
    struct sched_param scheduling;
    int policy = 0;
    (void)pthread_getschedparam(pthread_self(), &policy, &scheduling);
    scheduling.sched_priority++;
    (void)pthread_attr_init(&attributes);
    (void)pthread_attr_setstacksize(&attributes, CONFIG_GOE_STACKSIZE);
    (void)pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    (void)pthread_attr_setschedpolicy(&attributes, policy);
    (void)pthread_attr_setschedparam(&attributes, &scheduling);
    const int error = pthread_create(thread, &attributes, sensor_thread, NULL);
    (void)pthread_attr_destroy(&attributes);
    return error;
}

/* --------------------------------------------------------------------------------------------------------- estimator -- */

/* Microseconds. */
static uint32_t now_us(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint32_t)now.tv_sec * US_PER_S + (uint32_t)(now.tv_nsec / NS_PER_US);
}

static void estimate(void) {
    scripted_message_t message;
    char line[SCRIPTED_LINE];
    for (get(&message); message.kind != SCRIPTED_END; get(&message)) {
        if (scripted_take(&estimator, &message, line)) {
            (void)puts(line);
        }
    }
}

/* Returns 0, or an error. */
static int fly(void) {
    pthread_t sensors;
    queue.begin = queue.count = 0; /* where programs share one memory, another run has used it */
    (void)pthread_mutex_init(&queue.lock, NULL);
    (void)pthread_cond_init(&queue.changed, NULL);
    const int error = start_sensors(&sensors);
    if (error == 0) {
        estimate();
        (void)pthread_join(sensors, NULL);
    }
    (void)pthread_cond_destroy(&queue.changed);
    (void)pthread_mutex_destroy(&queue.lock);
    return error;
}

static void print_cost(const char *what, const scripted_cost_t *cost) {
    (void)printf("%s: %lu us, at most %lu us\n", what, (unsigned long)scripted_mean(cost), (unsigned long)cost->most);
}

int main(int argc, char *argv[]) {
    char line[SCRIPTED_LINE];
    in_time = !(argc > 1 && strcmp(argv[1], "-f") == 0);
    scripted_first_line(line);
    (void)puts(line);
    if (!scripted_start(&estimator, now_us, line)) {
        (void)puts(line);
        return 1;
    }
    const int error = fly();
    if (error != 0) {
        (void)printf("goe: no thread: %s\n", strerror(error));
        return 1;
    }
    (void)printf("images %lu, dropped %lu\n", (unsigned long)estimator.frame.calls, (unsigned long)estimator.dropped);
    print_cost("an image", &estimator.frame);
    print_cost("an assessment", &estimator.assess);
    (void)printf("flight layer %u bytes\n", (unsigned)sizeof estimator.flight);
    return 0;
}
