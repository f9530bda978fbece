/* A sensor loop: poses at 50 Hz and images at 10 Hz come through a queue; the main thread estimates, assesses and tells.
 * SPDX-License-Identifier: MIT
 *
 *   goe_sensor_loop [-f]   -f: as fast as it can, not at 50 Hz
 *
 * In an application of yours sensor_thread() is what there is already: drivers, a link to the autopilot, a detector. It may be
 * several tasks. The main thread alone touches `flight`, so nothing needs a lock. */
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "goe_flight.h"
#include "scripted_flight.h"

#define QUEUE_LENGTH 16
#define LINE_TICKS 50u /* a line a second, and one whenever the action changes */
#define NS_PER_S 1000000000L

typedef enum { SENSOR_POSE, SENSOR_IMAGE, SENSOR_END } sensor_kind_t;

typedef struct {
    sensor_kind_t kind;
    uint32_t tick;
    union {
        scripted_pose_t pose;
        scripted_image_t image;
    } of;
} sensor_message_t;

/* NuttX's own message queues hold 32 bytes a message unless MQ_MAXMSGSIZE is raised. */
typedef struct {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    sensor_message_t message[QUEUE_LENGTH];
    unsigned begin, count;
} queue_t;

static goe_flight_t flight;
static queue_t queue;
static bool in_time; /* at 50 Hz */
static unsigned images;
static unsigned long us_sum, us_most; /* of one image: goe_flight_frame() and goe_flight_assess() */

/* ------------------------------------------------------------------------------------------------------------- queue -- */

/* Waits while the queue is full, so nothing is lost here; drivers that may not wait would drop the message, and count. */
static void put(const sensor_message_t *message) {
    (void)pthread_mutex_lock(&queue.lock);
    while (queue.count == QUEUE_LENGTH) {
        (void)pthread_cond_wait(&queue.changed, &queue.lock);
    }
    queue.message[(queue.begin + queue.count) % QUEUE_LENGTH] = *message;
    queue.count++;
    (void)pthread_cond_signal(&queue.changed);
    (void)pthread_mutex_unlock(&queue.lock);
}

static void get(sensor_message_t *message) {
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
    next->tv_nsec += (long)SCRIPTED_TICK_US * 1000L;
    if (next->tv_nsec >= NS_PER_S) {
        next->tv_nsec -= NS_PER_S;
        next->tv_sec++;
    }
    (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, next, NULL);
}

static void *sensor_thread(void *argument) {
    sensor_message_t message;
    struct timespec next;
    memset(&message, 0, sizeof message);
    (void)clock_gettime(CLOCK_MONOTONIC, &next);
    for (uint32_t tick = 0; tick < SCRIPTED_TICKS; tick++) {
        if (in_time) {
            wait_tick(&next);
        }
        message.tick = tick;
        message.kind = SENSOR_POSE;
        scripted_pose(tick, &message.of.pose);
        put(&message);
        message.kind = SENSOR_IMAGE;
        if (scripted_image(tick, &message.of.image)) {
            put(&message);
        }
    }
    message.kind = SENSOR_END;
    put(&message);
    return argument;
}

/* --------------------------------------------------------------------------------------------------------- estimator -- */

static unsigned long us_since(const struct timespec *begun) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (unsigned long)((now.tv_sec - begun->tv_sec) * 1000000L + (now.tv_nsec - begun->tv_nsec) / 1000L);
}

static void take_pose(const scripted_pose_t *pose) {
    (void)goe_flight_attitude(&flight, &pose->attitude);
    (void)goe_flight_position(&flight, &pose->position);
}

static void take_image(scripted_image_t *image, uint32_t now_us, goe_flight_assessment_t *assessment) {
    struct timespec begun;
    (void)clock_gettime(CLOCK_MONOTONIC, &begun);
    image->frame.detection = &image->detection;
    /* GOE_FLIGHT_TOO_NEW cannot be here: poses come first. Otherwise keep the frame, and ask again after the next pose. */
    (void)goe_flight_frame(&flight, &image->frame);
    (void)goe_flight_assess(&flight, now_us, false, assessment);
    const unsigned long us = us_since(&begun);
    images++;
    us_sum += us;
    us_most = us > us_most ? us : us_most;
}

static void tell(uint32_t tick, const goe_flight_assessment_t *assessment, goe_flight_action_t *told) {
    char line[SCRIPTED_LINE];
    if (tick % LINE_TICKS == 0u || assessment->action != *told) {
        *told = assessment->action;
        scripted_line(&flight, tick * SCRIPTED_TICK_US, assessment, line);
        printf("%s\n", line);
    }
}

static bool start(void) {
    goe_settings_t settings;
    const char *bad_field = NULL;
    scripted_settings(&settings);
    const goe_flight_status_t status = goe_flight_init(&flight, sizeof flight, &settings, NULL, &bad_field);
    if (status != GOE_FLIGHT_OK) {
        printf("goe: no start: %d, setting %s\n", (int)status, bad_field != NULL ? bad_field : "(none)");
    }
    return status == GOE_FLIGHT_OK;
}

static void estimate(void) {
    sensor_message_t message;
    goe_flight_assessment_t assessment;
    goe_flight_action_t told = GOE_FLIGHT_NONE;
    for (get(&message); message.kind != SENSOR_END; get(&message)) {
        if (message.kind == SENSOR_POSE) {
            take_pose(&message.of.pose);
        } else {
            take_image(&message.of.image, message.tick * SCRIPTED_TICK_US, &assessment);
            tell(message.tick, &assessment, &told);
        }
    }
}

/* Returns 0, or an error. */
static int fly(void) {
    pthread_t sensors;
    images = 0; /* where programs share one memory, another run has used these */
    us_sum = us_most = 0;
    queue.begin = queue.count = 0;
    (void)pthread_mutex_init(&queue.lock, NULL);
    (void)pthread_cond_init(&queue.changed, NULL);
    const int error = pthread_create(&sensors, NULL, sensor_thread, NULL);
    if (error == 0) {
        estimate();
        (void)pthread_join(sensors, NULL);
    }
    (void)pthread_cond_destroy(&queue.changed);
    (void)pthread_mutex_destroy(&queue.lock);
    return error;
}

int main(int argc, char *argv[]) {
    in_time = !(argc > 1 && strcmp(argv[1], "-f") == 0);
    printf("goe %d.%d.%d, self-check 0x%02x\n", GOE_VERSION_MAJOR, GOE_VERSION_MINOR, GOE_VERSION_PATCH,
           goe_self_check());
    if (!start()) {
        return 1;
    }
    const int error = fly();
    if (error != 0) {
        printf("goe: no thread: %s\n", strerror(error));
        return 1;
    }
    printf("images %u; an image takes %lu us, at most %lu us; flight layer %u bytes\n", images,
           images > 0u ? us_sum / images : 0ul, us_most, (unsigned)sizeof flight);
    return 0;
}
