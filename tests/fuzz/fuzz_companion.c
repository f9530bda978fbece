/* Fuzzes all input of goe_companion: configuration, order log, detections as JSON, MAVLink. SPDX-License-Identifier: MIT
 *
 * The first letter of the input selects the kind: c a configuration, o an order log, d lines of a detector, w bytes of a link. With any
 * other letter the rest is messages of an autopilot: number, time to wait, length and bytes of each. Messages pass through all stages:
 * samples, clock, health, assessment, orders and reports. The link is a stand-in of this file that discards all output. */
#include <math.h>
#include <string.h>

#include "autopilot.h"
#include "companion_config.h"
#include "detection_text.h"
#include "fuzz.h"
#include "fuzz_file.h"
#include "fuzz_input.h"
#include "health.h"
#include "image_queue.h"
#include "line_reader.h"
#include "margins.h"
#include "orders.h"
#include "reports.h"

#define UNIX_US INT64_C(1790000000000000)
#define MESSAGES_MAX 2000

enum { INPUTS, CONFIGS, CONFIGS_REFUSED, LINES, LINES_REFUSED, DETECTIONS, MESSAGES, SAMPLES, FRAMES, SENT, COUNTS };

fuzz_count_t fuzz_counts[COUNTS + 1] = {{"inputs", 0},
                                        {"configurations", 0},
                                        {"configurations_refused", 0},
                                        {"lines", 0},
                                        {"lines_refused", 0},
                                        {"detections", 0},
                                        {"messages", 0},
                                        {"samples", 0},
                                        {"frames", 0},
                                        {"sent_bytes", 0},
                                        {NULL, 0}};

/* ---------------------------------------------------------------------------------------------------- a link that is none -- */

struct link {
    const uint8_t *bytes;
    size_t left;
};

static struct link in_hand;

bool link_check(const char *where, char *fault, size_t fault_size) {
    FUZZ_CHECK(where != NULL && fault_size > 8u);
    (void)memcpy(fault, "no link", 8);
    return *where == 'u' || *where == 's';
}

bool link_is_wide(const char *where) { return where == NULL; }
bool link_is_local(const char *where) { return where == NULL; }

link_t *link_open(const char *where, char *fault, size_t fault_size) {
    (void)where;
    (void)fault;
    (void)fault_size;
    return &in_hand;
}

int link_descriptor(const link_t *link) { return link != NULL ? -1 : 0; }
bool link_has_messages(const link_t *link) { return link->left % 2u == 0; }
unsigned link_losses(const link_t *link) { return link->left == SIZE_MAX ? 1u : 0u; }
bool link_ended(const link_t *link) { return link->left == 0; }

size_t link_read(link_t *link, uint8_t *bytes, size_t size) {
    const size_t piece = link->left < 37u ? link->left : 37u;
    const size_t taken = piece < size ? piece : size;
    if (taken > 0) {
        (void)memcpy(bytes, link->bytes, taken);
        link->bytes += taken;
        link->left -= taken;
    }
    return taken;
}

void link_answer(link_t *link) { (void)link; }
void link_greet(link_t *link) { (void)link; }
void link_release(link_t *link) { (void)link; }
bool link_is_answered(const link_t *link) { return link != NULL; }

bool link_write(link_t *link, const uint8_t *bytes, size_t size) {
    FUZZ_CHECK(link == &in_hand && size > 0 && size <= MAVLINK_MAX_PACKET_LEN);
    FUZZ_CHECK(bytes[0] == MAVLINK_STX || bytes[0] == MAVLINK_STX_MAVLINK1);
    fuzz_counts[SENT].times += size;
    return true;
}

void link_mend(link_t *link, int64_t now_us) {
    (void)link;
    (void)now_us;
}

void link_close(link_t *link) { (void)link; }

/* -------------------------------------------------------------------------------------------------------------- the rest -- */

static companion_config_t config;
static goe_flight_t flight;
static autopilot_t autopilot;
static orders_t orders;
static health_t health;
static screen_t screen;
static wire_t wire;
static camera_image_t image;
static image_queue_t queue;
static line_reader_t reader;
static int64_t now_us;

static void start(void) {
    (void)memset(&config, 0, sizeof config);
    (void)memset(&wire, 0, sizeof wire);
    goe_settings_default(&config.estimator);
    goe_flight_settings_default(&config.flight);
    config.estimator.camera.fx_px = config.estimator.camera.fy_px = 914.0f;
    config.estimator.camera.cx_px = config.estimator.camera.cy_px = 640.0f;
    config.estimator.camera.width_px = config.estimator.camera.height_px = 1280.0f;
    config.detections_delay_s = 0.08;
    config.detections_delay_sd_s = 0.01;
    config.link_attitude_hz = config.link_position_hz = 50.0;
    config.link_request_rates = 1;
    config.reaction_mode = REACTION_PX4;
    config.reaction_modes = 0xFFu;
    config.reaction_resume = 1;
    config.reaction_icao = 0xF0E000u;
    config.reports_standard = 0xFu;
    config.reports_distance_increment_deg = 5;
    config.reports_distance_max_m = 300.0;
    FUZZ_CHECK(goe_flight_init(&flight, sizeof flight, &config.estimator, &config.flight, NULL) == GOE_FLIGHT_OK);
    wire.link = &in_hand;
    wire.system = 1;
    wire.component = 196;
    in_hand.left = 0;
    now_us = INT64_C(5000000000);
    autopilot_init(&autopilot, &config, &flight, &wire);
    orders_init(&orders, &wire, &config, &autopilot, &flight);
    (void)memset(&health, 0, sizeof health);
    (void)memset(&screen, 0, sizeof screen);
    screen.on = true;
    orders.screen = &screen;
    image_queue_clear(&queue);
}

/* ------------------------------------------------------------------------------------------------------- configuration -- */

static const char camera[] =
    "camera.width = 1280\ncamera.height = 960\ncamera.fx = 914\ncamera.fy = 914\ncamera.cx = 640\ncamera.cy = 480\n";

static void try_config(const uint8_t *data, size_t size) {
    static FILE *sink;
    input_error_t error;
    error.text[0] = '\0';
    if (sink == NULL) {
        sink = fopen("/dev/null", "w");
        FUZZ_CHECK(sink != NULL);
        (void)fuzz_file(1, "camera.ini", camera, sizeof camera - 1u);
    }
    const char *path = fuzz_file(0, "companion.ini", data, size);
    if (companion_config_read(path, NULL, &config, &error)) {
        fuzz_counts[CONFIGS].times++;
        companion_config_print(sink, &config);
        FUZZ_CHECK(goe_flight_init(&flight, sizeof flight, &config.estimator, &config.flight, NULL) == GOE_FLIGHT_OK);
    } else {
        fuzz_counts[CONFIGS_REFUSED].times++;
        FUZZ_CHECK(memchr(error.text, '\0', sizeof error.text) != NULL);
        FUZZ_CHECK(error.text[0] != '\0' && strchr(error.text, '\n') == NULL);
    }
}

/* ------------------------------------------------------------------------------------------------------ log of orders -- */

static void try_orders(const uint8_t *data, size_t size) {
    char folder[FUZZ_PATH_MAX];
    order_left_t left;
    (void)snprintf(folder, sizeof folder, "%s", fuzz_file(2, "orders.csv", data, size));
    *strrchr(folder, '/') = '\0';
    FUZZ_CHECK(order_log_read(folder, &left) == left.active);
    FUZZ_CHECK(isfinite(left.obstacle_ne_m[0]) && isfinite(left.obstacle_ne_m[1]) && isfinite(left.radius_m));
    orders_take_over(&orders, &left);
}

/* ---------------------------------------------------------------------------------------------------------- detections -- */

static void on_frame(void *user, const goe_flight_frame_t *frame, goe_flight_status_t status) {
    (void)user;
    FUZZ_CHECK(frame->count <= GOE_FLIGHT_DETECTIONS && status != GOE_FLIGHT_TOO_NEW);
    fuzz_counts[FRAMES].times++;
}

static void on_line(void *user, const char *line, size_t length) {
    detection_fault_t fault;
    const detection_now_t now = {UNIX_US, now_us, 60000000, 300.0};
    (void)user;
    fault.text[0] = '\0';
    if (!detection_text_read(line, length, &config, &now, &image, &fault)) {
        FUZZ_CHECK(fault.text[0] != '\0' && memchr(fault.text, '\0', sizeof fault.text) != NULL);
        fuzz_counts[LINES_REFUSED].times++;
        return;
    }
    fuzz_counts[LINES].times++;
    fuzz_counts[DETECTIONS].times += image.detections;
    FUZZ_CHECK(image.detections <= CAMERA_IMAGE_DETECTIONS && image.frame.number >= image.detections % 256u);
    for (unsigned i = 0; i < image.detections; i++) {
        const goe_flight_detection_t *d = &image.detection[i];
        FUZZ_CHECK(d->score >= 0.0f && d->score <= 1.0f && d->pixel_px >= 0.0f);
        FUZZ_CHECK((d->box.sides & ~GOE_SIDES_ALL) == 0u);
    }
    image_queue_add(&queue, &image);
    image_queue_run(&queue, &flight, 60000000u, on_frame, NULL);
}

/* Poses up to now, so that each image has one. */
static void fly(void) {
    for (uint32_t time_us = 59000000u; time_us <= 60000000u; time_us += 20000u) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        (void)memset(&attitude, 0, sizeof attitude);
        (void)memset(&position, 0, sizeof position);
        attitude.time_us = position.time_us = time_us;
        attitude.q[0] = 1.0f;
        position.position_ned_m[0] = 20.0e-6f * (float)(time_us - 59000000u);
        position.position_ned_m[2] = -20.0f;
        position.velocity_ned_m_s[0] = 20.0f;
        FUZZ_CHECK(goe_flight_attitude(&flight, &attitude) == GOE_FLIGHT_OK);
        FUZZ_CHECK(goe_flight_position(&flight, &position) == GOE_FLIGHT_OK);
    }
}

static void try_detections(const uint8_t *data, size_t size) {
    (void)memset(&reader, 0, sizeof reader);
    fly();
    line_reader_take(&reader, (const char *)data, size, on_line, NULL);
    line_reader_end(&reader, on_line, NULL);
}

/* ------------------------------------------------------------------------------------------------------------- MAVLink -- */

static void follow(void) {
    goe_flight_assessment_t assessment;
    const uint32_t clock_us = (uint32_t)autopilot_clock_us(&autopilot, now_us);
    autopilot_ask(&autopilot, now_us);
    if (health_judge(&health, now_us)) {
        FUZZ_CHECK(*health_text(health.doubts) != '\0');
        FUZZ_CHECK(margins_set(&flight, &config, health.doubts != 0));
    }
    screen_go_on(&screen, &wire, now_us);
    if (goe_flight_assess(&flight, clock_us, autopilot.landing, &assessment) == GOE_FLIGHT_OK) {
        const goe_mavlink_own_t own = reports_own(&autopilot, now_us, UNIX_US + now_us);
        const delay_count_t delay = {0.0, 0.0, 0, 0};
        orders_follow(&orders, &assessment, &own, now_us);
        reports_send_obstacles(&wire, &config, &flight, &assessment, &own);
        reports_send_status(&wire, &flight, &assessment, &own, &delay, 0);
    }
    FUZZ_CHECK(isfinite(autopilot_heading_deg(&autopilot)) && isfinite(autopilot_clock_sd_us(&autopilot)));
    FUZZ_CHECK(*autopilot_kind_text(&autopilot) != '\0');
}

static void on_message(void *user, const mavlink_message_t *message) {
    (void)user;
    if (autopilot_is_stranger(&autopilot, now_us)) {
        return;
    }
    autopilot_take(&autopilot, message, now_us);
    health_take(&health, message, now_us);
    orders_take(&orders, message);
    fuzz_counts[MESSAGES].times++;
}

static void try_bytes(const uint8_t *data, size_t size) {
    in_hand.bytes = data;
    in_hand.left = size;
    while (wire_receive(&wire, on_message, NULL)) {
        now_us += 5000;
    }
    follow();
}

static const uint32_t kinds[] = {MAVLINK_MSG_ID_ATTITUDE_QUATERNION,
                                 MAVLINK_MSG_ID_LOCAL_POSITION_NED,
                                 MAVLINK_MSG_ID_HEARTBEAT,
                                 MAVLINK_MSG_ID_TIMESYNC,
                                 MAVLINK_MSG_ID_ODOMETRY,
                                 MAVLINK_MSG_ID_DISTANCE_SENSOR,
                                 MAVLINK_MSG_ID_TERRAIN_REPORT,
                                 MAVLINK_MSG_ID_ALTITUDE,
                                 MAVLINK_MSG_ID_HOME_POSITION,
                                 MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN,
                                 MAVLINK_MSG_ID_EXTENDED_SYS_STATE,
                                 MAVLINK_MSG_ID_COMMAND_ACK,
                                 MAVLINK_MSG_ID_STATUSTEXT,
                                 MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT,
                                 MAVLINK_MSG_ID_GPS_RAW_INT,
                                 MAVLINK_MSG_ID_ESTIMATOR_STATUS,
                                 MAVLINK_MSG_ID_EKF_STATUS_REPORT};

static void try_messages(const uint8_t *data, size_t size) {
    fuzz_input_t in = {data, size};
    for (int k = 0; k < MESSAGES_MAX && in.left > 0; k++) {
        mavlink_message_t message;
        const uint32_t kind = fuzz_byte(&in);
        const uint32_t wait = fuzz_byte(&in);
        const size_t length = fuzz_below(&in, 64);
        (void)memset(&message, 0, sizeof message);
        message.msgid = kinds[kind % (sizeof kinds / sizeof kinds[0])] & 0xFFFFFFu; /* 24 bits on the wire */
        message.sysid = kind >= 240u ? 9 : 1;
        message.compid = MAV_COMP_ID_AUTOPILOT1;
        message.seq = (uint8_t)k;
        message.len = (uint8_t)(length < in.left ? length : in.left);
        (void)memcpy(_MAV_PAYLOAD_NON_CONST(&message), in.next, message.len);
        in.next += message.len;
        in.left -= message.len;
        now_us += (int64_t)wait * wait * 50;
        on_message(NULL, &message);
        if (k % 4 == 0) {
            follow();
        }
    }
    fuzz_counts[SAMPLES].times += autopilot.attitudes + autopilot.positions;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_counts[INPUTS].times++;
    if (size == 0) {
        return 0;
    }
    start();
    switch (data[0]) {
        case 'c':
            try_config(data + 1, size - 1u);
            break;
        case 'o':
            try_orders(data + 1, size - 1u);
            break;
        case 'd':
            try_detections(data + 1, size - 1u);
            break;
        case 'w':
            try_bytes(data + 1, size - 1u);
            break;
        default:
            try_messages(data + 1, size - 1u);
            break;
    }
    return 0;
}
