/* The companion. SPDX-License-Identifier: MIT */
#include "companion.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "events.h"
#include "goe_mavlink_map.h"
#include "margins.h"

#define US_PER_S 1000000
#define WAIT_MS 10            /* longest wait: everything that is due every so often is looked at in between */
#define READS_MAX 64          /* of the detector's in one turn */
#define SAME_IMAGE_US 5000u   /* images are farther apart */
#define DEAF_US 10000000      /* without a heartbeat, after which that is reported */
#define BOX_FAULT_US 10000000 /* between two reports of boxes with the same fault ... */
#define BOX_FAULTS_US 2000000 /* ... and with different faults */
#define GRAVITY_M_S2 9.80665
#define DEG_PER_RAD 57.29577951308232
#define WIDER 1.1            /* times the circle: a smaller excess may be a gust */
#define CLOCK_STEP_US 100000 /* by which the computer's own clock may be set without a word */

static int64_t clock_us(clockid_t clock) {
    struct timespec now;
    (void)clock_gettime(clock, &now);
    return (int64_t)now.tv_sec * US_PER_S + now.tv_nsec / 1000;
}

/* ------------------------------------------------------------------------------------------------------------ images -- */

/* An image of several messages is one. Of ages each message makes a time of its own, a little apart. */
static bool is_new_image(companion_rates_t *rates, const goe_flight_frame_t *frame, uint32_t capture_us) {
    const uint32_t since_us = capture_us - rates->capture_us[frame->camera];
    const bool is_same = frame->number > 1 && (since_us < SAME_IMAGE_US || since_us > UINT32_MAX - SAME_IMAGE_US);
    rates->capture_us[frame->camera] = capture_us;
    return !is_same;
}

static void on_image_taken(void *user, const goe_flight_frame_t *frame, goe_flight_status_t status) {
    companion_t *c = user;
    delay_count_t *delay = &c->rates.delay;
    if (status != GOE_FLIGHT_OK) {
        c->counts.late += status == GOE_FLIGHT_TOO_OLD || status == GOE_FLIGHT_NO_POSE ? 1u : 0u;
        c->counts.unread += status == GOE_FLIGHT_OUT_OF_RANGE ? 1u : 0u;
        return;
    }
    const double delay_ms = (double)(int32_t)(frame->arrival_us - c->flight.capture_us) * 1e-3;
    if (is_new_image(&c->rates, frame, c->flight.capture_us)) {
        c->counts.images++;
        delay->images++;
        delay->sum_ms += delay_ms;
        delay->most_ms = delay_ms > delay->most_ms ? delay_ms : delay->most_ms;
    }
    flight_record_put(&c->record, &c->flight, frame, &c->autopilot);
}

static void run_queue(companion_t *c) {
    const int64_t autopilot_us = autopilot_clock_us(&c->autopilot, clock_us(CLOCK_MONOTONIC));
    image_queue_run(&c->queue, &c->flight, (uint32_t)autopilot_us, on_image_taken, c);
}

static void report_box(companion_t *c, box_fault_t fault, const goe_flight_detection_t *detection) {
    box_faults_t *faults = &c->box_faults[fault];
    const goe_box_t *box = &detection->box;
    const int64_t now_us = clock_us(CLOCK_MONOTONIC);
    faults->boxes++;
    for (int other = 0; other < BOX_FAULTS; other++) {
        const int64_t reported_us = c->box_faults[other].reported_us;
        if (reported_us != 0 && now_us - reported_us < (other == (int)fault ? BOX_FAULT_US : BOX_FAULTS_US)) {
            return;
        }
    }
    faults->reported_us = now_us;
    event("detector, id %u, box %g %g %g %g: %s; such boxes so far: %lu", (unsigned)detection->id, (double)box->left_px,
          (double)box->top_px, (double)box->right_px, (double)box->bottom_px, box_fault_text(fault), faults->boxes);
    screen_show(&c->screen, SCREEN_BOXES, MAV_SEVERITY_WARNING, "GOE: %s", box_fault_text(fault));
}

/* The flight layer takes or refuses these boxes without a word: no obstacle comes of them. */
static void check_boxes(companion_t *c) {
    const unsigned number = c->image.frame.camera;
    const goe_settings_t *estimator = &c->config.estimator;
    const goe_camera_t *camera = number == 0 ? &estimator->camera : &estimator->more_cameras[0];
    if (number > 1u || !(camera->width_px > 0.0f)) {
        return; /* no such camera: the flight layer refuses the image */
    }
    for (unsigned i = 0; i < c->image.detections; i++) {
        const box_fault_t fault = box_check(&c->image.detection[i].box, camera);
        if (fault != BOX_GOOD) {
            report_box(c, fault, &c->image.detection[i]);
        }
    }
}

/* The flight layer's history begins with a pose: earlier detections have none. */
static void take_image(companion_t *c) {
    check_boxes(c);
    if (!clock_sync_known(&c->autopilot.clock)) {
        c->counts.clockless++;
        return;
    }
    image_queue_add(&c->queue, &c->image);
    run_queue(c);
}

/* -------------------------------------------------------------------------------------------------------------- lines -- */

static void on_line(void *user, const char *line, size_t length) {
    companion_t *c = user;
    detection_fault_t fault;
    const int64_t now_us = clock_us(CLOCK_MONOTONIC);
    if (!clock_sync_known(&c->autopilot.clock)) {
        c->counts.clockless++;
        return;
    }
    const detection_now_t now = {clock_us(CLOCK_REALTIME), now_us, autopilot_clock_us(&c->autopilot, now_us),
                                 autopilot_clock_sd_us(&c->autopilot)};
    if (detection_text_read(line, length, &c->config, &now, &c->image, &fault)) {
        c->counts.classless += c->image.unknown_classes;
        take_image(c);
    } else {
        c->counts.unread++;
        event("detections, line %lu: %s", c->lines.line, fault.text);
    }
}

static void read_lines(companion_t *c) {
    uint8_t bytes[DETECTION_LINE_MAX];
    for (int i = 0; i < READS_MAX; i++) {
        const bool had_ended = link_ended(c->detections_link);
        const unsigned long cut = c->lines.cut;
        const size_t size = link_read(c->detections_link, bytes, sizeof bytes);
        if (size > 0) {
            line_reader_take(&c->lines, (const char *)bytes, size, on_line, c);
        }
        if (link_ended(c->detections_link) && !had_ended) {
            event("the detector's input has ended");
        }
        if (size > 0 && link_has_messages(c->detections_link)) {
            line_reader_end(&c->lines, on_line, c);
        }
        if (c->lines.cut > cut) {
            c->counts.unread++;
            event("detections, line %lu: longer than %d bytes", c->lines.line, DETECTION_LINE_MAX);
        }
        if (size == 0) {
            return;
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ MAVLink -- */

static goe_mavlink_camera_t camera_of(const companion_config_t *config) {
    const goe_camera_t *camera = &config->estimator.camera;
    const goe_mavlink_camera_t of = {
        .width_px = camera->width_px,
        .height_px = camera->height_px,
        .fx_px = camera->fx_px,
        .fy_px = camera->fy_px,
        .cx_px = camera->cx_px,
        .cy_px = camera->cy_px,
        .number = 0,
        .delay_us = (uint32_t)(config->detections_delay_s * US_PER_S),
        .delay_sd_us = (uint32_t)(config->detections_delay_sd_s * US_PER_S),
        .shares_clock = config->detections_shares_clock != 0,
    };
    return of;
}

static void take_sighting(companion_t *c, bool has_detection, const goe_mavlink_sighting_t *sighting) {
    c->image.frame = sighting->frame;
    c->image.detections = has_detection ? 1u : 0u;
    c->image.detection[0] = sighting->detection;
    take_image(c);
}

/* Boxes of a smaller copy of the image would be silently wrong. */
static bool is_of_this_size(const companion_config_t *config, const goe_mavlink_features_t *features) {
    const goe_camera_t *camera =
        features->camera_id == 1 ? &config->estimator.more_cameras[0] : &config->estimator.camera;
    return features->number == 0 || (fabsf((float)features->image_width - camera->width_px) < 1.0f &&
                                     fabsf((float)features->image_height - camera->height_px) < 1.0f);
}

static void take_features(companion_t *c, const mavlink_message_t *message, uint32_t arrival_us) {
    goe_mavlink_features_t features;
    goe_mavlink_sighting_t sighting;
    goe_mavlink_read_features((const uint8_t *)_MAV_PAYLOAD(message), message->len, &features);
    if (!is_of_this_size(&c->config, &features)) {
        c->counts.unread++;
        event("GOE_FEATURES of an image of %u x %u px: camera.ini has another size", features.image_width,
              features.image_height);
        return;
    }
    const bool has = goe_mavlink_from_features(&features, arrival_us, &sighting);
    take_sighting(c, has, &sighting);
}

static void take_landing_target(companion_t *c, const mavlink_message_t *message, uint32_t arrival_us) {
    goe_mavlink_landing_target_t target;
    goe_mavlink_sighting_t sighting;
    const goe_mavlink_camera_t camera = camera_of(&c->config);
    goe_mavlink_read_landing_target((const uint8_t *)_MAV_PAYLOAD(message), message->len, &target);
    const bool has = goe_mavlink_from_landing_target(&target, &camera, arrival_us, &sighting);
    take_sighting(c, has, &sighting);
}

static void take_tracking(companion_t *c, const mavlink_message_t *message, uint32_t arrival_us) {
    goe_mavlink_tracking_t tracking;
    goe_mavlink_sighting_t sighting;
    const goe_mavlink_camera_t camera = camera_of(&c->config);
    goe_mavlink_read_tracking((const uint8_t *)_MAV_PAYLOAD(message), message->len, &tracking);
    const bool has = goe_mavlink_from_tracking(&tracking, &camera, arrival_us, &sighting);
    take_sighting(c, has, &sighting);
}

/* Detections come from any component of the autopilot's system, and from no other; a gimbal that follows a person is one of them:
 * so the configuration names the messages. */
static void take_detections(companion_t *c, const mavlink_message_t *message, uint32_t arrival_us) {
    const unsigned taken = c->config.detections_mavlink;
    if (message->msgid == MAVLINK_MSG_ID_GOE_FEATURES && (taken & DETECTIONS_GOE_FEATURES) != 0) {
        take_features(c, message, arrival_us);
    } else if (message->msgid == MAVLINK_MSG_ID_LANDING_TARGET && (taken & DETECTIONS_LANDING_TARGET) != 0) {
        take_landing_target(c, message, arrival_us);
    } else if (message->msgid == MAVLINK_MSG_ID_CAMERA_TRACKING_IMAGE_STATUS && (taken & DETECTIONS_TRACKING) != 0) {
        take_tracking(c, message, arrival_us);
    }
}

static void on_message(void *user, const mavlink_message_t *message) {
    companion_t *c = user;
    const int64_t now_us = clock_us(CLOCK_MONOTONIC);
    const uint32_t arrival_us = (uint32_t)autopilot_clock_us(&c->autopilot, now_us);
    if (autopilot_is_stranger(&c->autopilot, now_us)) {
        return;
    }
    if (c->autopilot.heartbeat_us != 0 && message->sysid == c->autopilot.system) {
        take_detections(c, message, arrival_us);
    }
    orders_take(&c->orders, message);
    autopilot_take(&c->autopilot, message, now_us);
    if (autopilot_is_from(&c->autopilot, message)) {
        health_take(&c->health, message, now_us);
    }
    if (c->autopilot.restarts != c->restarts) {
        c->restarts = c->autopilot.restarts;
        health_restart(&c->health);
        image_queue_clear(&c->queue);
    }
}

/* ---------------------------------------------------------------------------------------------------------- due work ----- */

static bool is_due(int64_t *last_us, int64_t now_us, double hz) {
    const int64_t period_us = (int64_t)(US_PER_S / hz);
    if (now_us - *last_us < period_us) {
        return false;
    }
    *last_us += period_us;
    if (now_us - *last_us >= period_us) {
        *last_us = now_us; /* missed turns are skipped */
    }
    return true;
}

static void send_alive(companion_t *c) {
    const goe_flight_assessment_t *a = &c->assessment;
    if (a->detector_alive != c->detector_alive) {
        event(a->detector_alive ? "the detector is alive"
                                : "the detector is silent: nothing ahead is known to be clear");
        screen_show(&c->screen, SCREEN_DETECTOR, a->detector_alive ? MAV_SEVERITY_INFO : MAV_SEVERITY_WARNING,
                    a->detector_alive ? "GOE: detector is alive" : "GOE: detector is silent");
    }
    if (a->pose_alive != c->pose_alive) {
        const char *none = a->pose_agrees ? "no poses come" : "velocity contradicts position";
        event("%s%s", a->pose_alive ? "poses come" : none,
              a->pose_agrees ? "" : ": nothing is clear, and hazards may be missing");
        screen_show(&c->screen, SCREEN_POSE, a->pose_alive ? MAV_SEVERITY_INFO : MAV_SEVERITY_WARNING, "GOE: %s",
                    a->pose_alive ? "poses come" : none);
    }
    c->detector_alive = a->detector_alive;
    c->pose_alive = a->pose_alive;
}

/* Doubt about the own place widens the margins, and is reported. */
static void watch_health(companion_t *c, int64_t now_us) {
    const bool was_in_doubt = c->health.doubts != 0;
    if (!health_judge(&c->health, now_us)) {
        return;
    }
    const bool in_doubt = c->health.doubts != 0;
    const char *what = health_text(c->health.doubts);
    event("navigation: %s%s", what, in_doubt ? ": margins are wider" : " again");
    screen_show(&c->screen, SCREEN_NAVIGATION, in_doubt ? MAV_SEVERITY_WARNING : MAV_SEVERITY_INFO,
                "GOE: navigation: %s", what);
    if (in_doubt != was_in_doubt && !margins_set(&c->flight, &c->config, in_doubt)) {
        event("the margins cannot be changed");
    }
}

/* The layer assumes the circle of its turn if flight.loiter_m is smaller, and an autopilot that cannot fly a circle leaves it. */
static void watch_circle(companion_t *c) {
    const goe_flight_settings_t *layer = &c->config.flight;
    const double speed_m_s = hypot((double)c->autopilot.position.vx, (double)c->autopilot.position.vy);
    const double turn_m = speed_m_s * speed_m_s / (GRAVITY_M_S2 * tan((double)layer->bank_deg / DEG_PER_RAD));
    if (layer->loiter_m > 0.0f && turn_m > WIDER * fmax((double)layer->loiter_m, c->turn_m)) {
        c->turn_m = turn_m;
        event("flight.loiter_m %.0f is smaller than the turn at %.0f m/s and %.0f degrees of bank: %.0f m is assumed; "
              "increase it and the autopilot's radius",
              (double)layer->loiter_m, speed_m_s, (double)layer->bank_deg, turn_m);
    }
}

/* Without reactions the order is advice. */
static void show_advice(companion_t *c) {
    const goe_flight_assessment_t *a = &c->assessment;
    if (c->config.reaction_mode == REACTION_OFF && a->action != c->advised && a->action != GOE_FLIGHT_NONE) {
        screen_show(&c->screen, SCREEN_ORDER, MAV_SEVERITY_WARNING, "GOE advises %s: obstacle in %.0f s",
                    goe_flight_action_text(a->action), (double)a->hazard.tcpa_s);
    }
    c->advised = a->action;
}

static bool begin_flight(companion_t *c, const char **bad) {
    return goe_flight_init(&c->flight, sizeof c->flight, &c->config.estimator, &c->config.flight, bad) == GOE_FLIGHT_OK;
}

/* A layer that cannot assess, as without a pose, has not ended its order: the assessment before stays, and nothing is clear. */
static void keep_assessment(companion_t *c, const goe_flight_assessment_t *assessment, goe_flight_status_t status) {
    if (status == GOE_FLIGHT_OK) {
        c->assessment = *assessment;
    } else {
        c->assessment.pose_alive = false;
    }
    send_alive(c);
}

static void assess(companion_t *c, int64_t now_us) {
    goe_flight_assessment_t assessment;
    const uint32_t autopilot_us = (uint32_t)autopilot_clock_us(&c->autopilot, now_us);
    const goe_mavlink_own_t own = reports_own(&c->autopilot, now_us, clock_us(CLOCK_REALTIME));
    const uint8_t phase = autopilot_phase(&c->autopilot);
    const goe_flight_status_t status = goe_flight_assess(&c->flight, autopilot_us, phase, &assessment);
    keep_assessment(c, &assessment, status);
    if (status == GOE_FLIGHT_CORRUPTED) {
        event("its memory was corrupted: the search for obstacles starts again");
        (void)begin_flight(c, NULL);
        (void)margins_set(&c->flight, &c->config, c->health.doubts != 0);
    }
    if (status == GOE_FLIGHT_OK) {
        orders_follow(&c->orders, &c->assessment, &own, now_us);
        show_advice(c);
    }
    watch_circle(c);
}

/* The UNIX clock gives the time of lines: a step of it makes those under way wrong, and is reported. */
static void watch_own_clock(companion_t *c, int64_t now_us) {
    const int64_t difference_us = clock_us(CLOCK_REALTIME) - now_us;
    const int64_t step_us = difference_us - c->clock_difference_us;
    if (step_us > CLOCK_STEP_US || step_us < -CLOCK_STEP_US) {
        event("this computer's clock was set by %+.1f s", (double)step_us / US_PER_S);
    }
    c->clock_difference_us = difference_us;
}

static void mend_links(companion_t *c, int64_t now_us) {
    unsigned lost = link_losses(c->autopilot_link);
    link_mend(c->autopilot_link, now_us);
    if (c->detections_link != NULL) {
        lost += link_losses(c->detections_link);
        link_mend(c->detections_link, now_us);
    }
    if (lost > c->links_lost) {
        event("a link was lost: it is tried again every second");
    }
    c->links_lost = lost;
}

/* A socket on this computer alone receives no autopilot of another. */
static void watch_deafness(companion_t *c, int64_t now_us) {
    const bool is_deaf = c->autopilot.heartbeat_us == 0 && now_us - c->begun_us > DEAF_US;
    if (is_deaf && !c->deafness_reported) {
        event("no message from an autopilot on %s%s", c->config.link_autopilot,
              link_is_local(c->config.link_autopilot) ? ": udpin:0.0.0.0:PORT listens to other computers, too" : "");
        c->deafness_reported = true;
    }
}

static void end_second(companion_t *c, int64_t now_us) {
    companion_rates_t *rates = &c->rates;
    const goe_mavlink_own_t own = reports_own(&c->autopilot, now_us, clock_us(CLOCK_REALTIME));
    rates->pose_hz =
        fmin((double)(c->autopilot.attitudes - rates->attitudes), (double)(c->autopilot.positions - rates->positions));
    rates->image_hz = (double)(c->counts.images - rates->images);
    rates->attitudes = c->autopilot.attitudes;
    rates->positions = c->autopilot.positions;
    rates->images = c->counts.images;
    rates->delay.all_images = c->counts.images;
    rates->delay_shown = rates->delay;
    reports_send_status(&c->wire, &c->flight, &c->assessment, &own, &rates->delay, c->self_check);
    (void)memset(&rates->delay, 0, sizeof rates->delay);
    flight_record_flush(&c->record);
    signing_go_on(&c->signing, &c->wire, clock_us(CLOCK_REALTIME));
    watch_own_clock(c, now_us);
    watch_deafness(c, now_us);
    mend_links(c, now_us);
}

static bool do_due_work(companion_t *c) {
    const int64_t now_us = clock_us(CLOCK_MONOTONIC);
    autopilot_ask(&c->autopilot, now_us);
    watch_health(c, now_us);
    screen_go_on(&c->screen, &c->wire, now_us);
    if (is_due(&c->assessed_us, now_us, c->config.reports_assess_hz)) {
        assess(c, now_us);
    }
    if (is_due(&c->reported_us, now_us, c->config.reports_obstacle_hz)) {
        const goe_mavlink_own_t own = reports_own(&c->autopilot, now_us, clock_us(CLOCK_REALTIME));
        reports_send_obstacles(&c->wire, &c->config, &c->flight, &c->assessment, &own);
    }
    if (is_due(&c->second_us, now_us, 1.0)) {
        end_second(c, now_us);
        return true;
    }
    return false;
}

/* --------------------------------------------------------------------------------------------------------- interface -- */

bool companion_turn(companion_t *c) {
    struct pollfd waited[2] = {{link_descriptor(c->autopilot_link), POLLIN, 0}, {-1, POLLIN, 0}};
    if (c->detections_link != NULL) {
        waited[1].fd = link_descriptor(c->detections_link);
    }
    (void)poll(waited, 2, WAIT_MS);
    if (wire_receive(&c->wire, on_message, c)) {
        run_queue(c);
    }
    if (c->detections_link != NULL) {
        read_lines(c);
    }
    return do_due_work(c);
}

static bool open_all(companion_t *c, char *fault, size_t fault_size) {
    const char *bad = NULL;
    c->autopilot_link = link_open(c->config.link_autopilot, fault, fault_size);
    if (c->autopilot_link == NULL) {
        return false;
    }
    if (strcmp(c->config.detections_from, "none") != 0) {
        c->detections_link = link_open(c->config.detections_from, fault, fault_size);
        if (c->detections_link == NULL) {
            return false;
        }
    }
    if (!begin_flight(c, &bad)) {
        (void)snprintf(fault, fault_size, "the library refuses the setting %s", bad != NULL ? bad : "(none)");
        return false;
    }
    if (!flight_record_open(&c->record, &c->config, fault, fault_size)) {
        event("no log: %s", fault); /* the aircraft is worth more than its log */
    }
    return true;
}

companion_t *companion_new(const companion_config_t *config, char *fault, size_t fault_size) {
    companion_t *c = calloc(1, sizeof *c);
    if (c == NULL) {
        (void)snprintf(fault, fault_size, "out of memory");
        return NULL;
    }
    c->config = *config;
    if (!open_all(c, fault, fault_size)) {
        companion_free(c);
        return NULL;
    }
    const int64_t now_us = clock_us(CLOCK_MONOTONIC);
    c->wire.link = c->autopilot_link;
    c->wire.system = 1;
    c->wire.component = (uint8_t)config->link_component;
    if (*config->link_key_file != '\0') {
        signing_begin(&c->signing, &c->wire, config->link_key_file, config->link_key, clock_us(CLOCK_REALTIME));
    } else if (link_is_wide(config->link_autopilot)) {
        event("%s is open to every network, and not signed: who reaches it can steer", config->link_autopilot);
    }
    if (link_is_wide(config->detections_from)) {
        event("%s is open to every network: who reaches it can send obstacles", config->detections_from);
    }
    c->self_check = goe_self_check();
    c->assessment.worst = c->assessment.avoided = -1;
    c->assessment.pose_agrees = true; /* a pose that has not come contradicts nothing */
    c->assessed_us = c->reported_us = c->second_us = c->begun_us = now_us;
    c->clock_difference_us = clock_us(CLOCK_REALTIME) - now_us;
    autopilot_init(&c->autopilot, &c->config, &c->flight, &c->wire);
    orders_init(&c->orders, &c->wire, &c->config, &c->autopilot, &c->flight);
    c->screen.on = config->reports_screen != 0;
    c->orders.log = &c->record.orders;
    c->orders.screen = &c->screen;
    orders_take_over(&c->orders, &c->record.left);
    if (c->self_check != 0) {
        event("the arithmetic of this computer is not right (self-check 0x%02x): no orders are sent", c->self_check);
        c->config.reaction_mode = REACTION_OFF;
    }
    return c;
}

void companion_free(companion_t *c) {
    if (c != NULL) {
        flight_record_close(&c->record);
        link_close(c->autopilot_link);
        link_close(c->detections_link);
    }
    free(c);
}
