/* A sensor loop: poses at 50 Hz and images at 10 Hz come through a queue, a thread of its own estimates, assesses and tells.
 * SPDX-License-Identifier: MIT
 *
 * In an application of yours sensor_thread() is what there is already: drivers, a link to the autopilot, a detector. It may be
 * several threads. goe_thread() alone touches `flight`, so nothing needs a lock. */
#include <zephyr/kernel.h>
#include <zephyr/sys/printk.h>

#include "goe_flight.h"
#include "scripted_flight.h"

#define SENSOR_STACK_BYTES 1536
#define GOE_STACK_BYTES 4096
#define SENSOR_PRIORITY 5 /* before the estimator: samples are late otherwise */
#define GOE_PRIORITY 7
#define QUEUE_LENGTH 16 /* the estimator may sleep for 0.25 s */
#define LINE_TICKS 50u  /* a line a second, and one whenever the action changes */

enum sensor_kind { SENSOR_POSE, SENSOR_IMAGE, SENSOR_END };

struct sensor_message {
    enum sensor_kind kind;
    uint32_t tick;
    union {
        scripted_pose_t pose;
        scripted_image_t image;
    };
};

K_MSGQ_DEFINE(sensor_queue, sizeof(struct sensor_message), QUEUE_LENGTH, 4);
K_TIMER_DEFINE(tick_timer, NULL, NULL);

static goe_flight_t flight;
static uint32_t images, lost;
static uint32_t cycles_sum, cycles_most; /* of one image: goe_flight_frame() and goe_flight_assess() */

/* ----------------------------------------------------------------------------------------------------------- sensors -- */

static void send(const struct sensor_message *message) {
    if (k_msgq_put(&sensor_queue, message, K_NO_WAIT) != 0) {
        lost++; /* the estimator is behind: a lost pose is a gap, a lost image is one that was never taken */
    }
}

static void sensor_thread(void *p1, void *p2, void *p3) {
    struct sensor_message message;
    ARG_UNUSED(p1);
    ARG_UNUSED(p2);
    ARG_UNUSED(p3);
    k_timer_start(&tick_timer, K_USEC(SCRIPTED_TICK_US), K_USEC(SCRIPTED_TICK_US));
    for (uint32_t tick = 0; tick < SCRIPTED_TICKS; tick++) {
        k_timer_status_sync(&tick_timer);
        message.tick = tick;
        message.kind = SENSOR_POSE;
        scripted_pose(tick, &message.pose);
        send(&message);
        message.kind = SENSOR_IMAGE;
        if (scripted_image(tick, &message.image)) {
            send(&message);
        }
    }
    k_timer_stop(&tick_timer);
    message.kind = SENSOR_END;
    (void)k_msgq_put(&sensor_queue, &message, K_FOREVER);
}

/* --------------------------------------------------------------------------------------------------------- estimator -- */

static void take_pose(const scripted_pose_t *pose) {
    (void)goe_flight_attitude(&flight, &pose->attitude);
    (void)goe_flight_position(&flight, &pose->position);
}

static void take_image(scripted_image_t *image, uint32_t now_us, goe_flight_assessment_t *assessment) {
    const uint32_t begun = k_cycle_get_32();
    image->frame.detection = &image->detection;
    /* GOE_FLIGHT_TOO_NEW cannot be here: poses come first. Otherwise keep the frame, and ask again after the next pose. */
    (void)goe_flight_frame(&flight, &image->frame);
    (void)goe_flight_assess(&flight, now_us, false, assessment);
    const uint32_t cycles = k_cycle_get_32() - begun;
    images++;
    cycles_sum += cycles;
    cycles_most = MAX(cycles_most, cycles);
}

static void tell(uint32_t tick, const goe_flight_assessment_t *assessment) {
    static goe_flight_action_t told = GOE_FLIGHT_NONE;
    static char line[SCRIPTED_LINE];
    if (tick % LINE_TICKS == 0u || assessment->action != told) {
        told = assessment->action;
        scripted_line(&flight, tick * SCRIPTED_TICK_US, assessment, line);
        printk("%s\n", line);
    }
}

static bool start(void) {
    goe_settings_t settings;
    const char *bad_field = NULL;
    scripted_settings(&settings);
    const goe_flight_status_t status = goe_flight_init(&flight, sizeof(flight), &settings, NULL, &bad_field);
    if (status != GOE_FLIGHT_OK) {
        printk("goe: no start: %d, setting %s\n", (int)status, bad_field != NULL ? bad_field : "(none)");
    }
    return status == GOE_FLIGHT_OK;
}

static void goe_thread(void *p1, void *p2, void *p3) {
    struct sensor_message message;
    goe_flight_assessment_t assessment;
    ARG_UNUSED(p1);
    ARG_UNUSED(p2);
    ARG_UNUSED(p3);
    if (!start()) {
        return;
    }
    while (k_msgq_get(&sensor_queue, &message, K_FOREVER) == 0 && message.kind != SENSOR_END) {
        if (message.kind == SENSOR_POSE) {
            take_pose(&message.pose);
        } else {
            take_image(&message.image, message.tick * SCRIPTED_TICK_US, &assessment);
            tell(message.tick, &assessment);
        }
    }
}

#if defined(CONFIG_FPU_SHARING)
#define THREAD_OPTIONS K_FP_REGS /* both use the floating-point unit */
#else
#define THREAD_OPTIONS 0
#endif

K_THREAD_DEFINE(sensor_id, SENSOR_STACK_BYTES, sensor_thread, NULL, NULL, NULL, SENSOR_PRIORITY, THREAD_OPTIONS, 0);
K_THREAD_DEFINE(goe_id, GOE_STACK_BYTES, goe_thread, NULL, NULL, NULL, GOE_PRIORITY, THREAD_OPTIONS, 0);

int main(void) {
    size_t unused = 0;
    printk("goe %d.%d.%d on %s, self-check 0x%02x\n", GOE_VERSION_MAJOR, GOE_VERSION_MINOR, GOE_VERSION_PATCH,
           CONFIG_BOARD, goe_self_check());
    (void)k_thread_join(sensor_id, K_FOREVER);
    (void)k_thread_join(goe_id, K_FOREVER);
    (void)k_thread_stack_space_get(goe_id, &unused);
    printk("images %u, lost %u; an image takes %u us, at most %u us; stack %u of %u bytes; flight layer %u bytes\n",
           images, lost, k_cyc_to_us_floor32(images > 0u ? cycles_sum / images : 0u), k_cyc_to_us_ceil32(cycles_most),
           (unsigned int)(GOE_STACK_BYTES - unused), GOE_STACK_BYTES, (unsigned int)sizeof(flight));
    printk("done\n");
    return 0;
}
