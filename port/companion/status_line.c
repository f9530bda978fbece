/* What an operator reads. SPDX-License-Identifier: MIT */
#include "status_line.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "events.h"

#define LINE_MAX_LENGTH 256
#define PLAIN_EVERY 10 /* seconds, where there is no terminal */
#define WIDTH_USUAL 120

typedef struct {
    char text[LINE_MAX_LENGTH];
    size_t length;
} text_line_t;

__attribute__((format(printf, 2, 3))) static void add(text_line_t *line, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int size = vsnprintf(line->text + line->length, sizeof line->text - line->length, format, arguments);
    va_end(arguments);
    line->length += size > 0 ? (size_t)size : 0u;
    line->length = line->length < sizeof line->text ? line->length : sizeof line->text - 1u;
}

static void add_autopilot(text_line_t *line, const companion_t *c) {
    const autopilot_t *a = &c->autopilot;
    if (a->heartbeat_us == 0) {
        add(line, "no autopilot");
        return;
    }
    add(line, "%s %u  pose %.0f Hz", autopilot_kind_text(a), a->system, c->rates.pose_hz);
    if (clock_sync_known(&a->clock)) {
        add(line, "  clock %.1f ms%s", autopilot_clock_sd_us(a) * 1e-3, a->clock.two_way ? "" : " one-way");
    } else {
        add(line, "  no clock");
    }
}

static void add_images(text_line_t *line, const companion_t *c) {
    const delay_count_t *delay = &c->rates.delay_shown;
    if (delay->images > 0) {
        add(line, " | images %.0f Hz %.0f ms", c->rates.image_hz, delay->sum_ms / delay->images);
    } else {
        add(line, " | no images");
    }
}

static bool is_sent(const companion_t *c) { return c->config.reaction_mode != REACTION_OFF && !c->orders.silenced; }

/* The one that the order is about, or the worst. */
static void add_obstacle(text_line_t *line, const companion_t *c) {
    const goe_flight_assessment_t *a = &c->assessment;
    const int slot = a->avoided >= 0 ? a->avoided : a->worst;
    goe_flight_obstacle_t o;
    add(line, " | obstacles %u", a->obstacles);
    if (a->unplaced > 0) {
        add(line, " located, %u detected but not located (boxes few, cut or unusable)", a->unplaced);
    }
    if (a->obstacles == 0 || slot < 0 || goe_flight_obstacle(&c->flight, slot, &o) != GOE_FLIGHT_OK) {
        return;
    }
    const float away[2] = {o.center_ned_m[0] - c->autopilot.position.x, o.center_ned_m[1] - c->autopilot.position.y};
    const double range_m = hypot((double)away[0], (double)away[1]);
    const double along = range_m > 0.0 ? 1.0 / range_m : 0.0;
    const double n = (double)away[0] * along, e = (double)away[1] * along;
    const double variance = n * n * (double)o.covariance_ne_m2[0] + 2.0 * n * e * (double)o.covariance_ne_m2[1] +
                            e * e * (double)o.covariance_ne_m2[2];
    add(line, "  id %u: %.0f +- %.0f m, %.1f s, %.0f %%%s", (unsigned)o.id, range_m, sqrt(fmax(variance, 0.0)),
        (double)o.hazard.tcpa_s, 100.0 * (double)o.hazard.conflict_probability, o.suspect ? ", suspect" : "");
    if (a->action != GOE_FLIGHT_NONE) {
        add(line, ", %s%s", goe_flight_action_text(a->action), is_sent(c) ? "" : " (not sent)");
    }
}

static unsigned long lost_of(const companion_t *c) {
    return c->wire.counts.lost + c->wire.counts.garbage + c->counts.late + c->counts.unread + c->queue.given_up;
}

static int width_of_terminal(void) {
    struct winsize size;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : WIDTH_USUAL;
}

void status_line_show(const companion_t *c) {
    static int second;
    text_line_t line = {"", 0};
    const int on_terminal = isatty(STDERR_FILENO);
    second++;
    if (!on_terminal && second % PLAIN_EVERY != 0) {
        return;
    }
    add_autopilot(&line, c);
    add_images(&line, c);
    add_obstacle(&line, c);
    if (c->health.doubts != 0) {
        add(&line, " | %s", health_text(c->health.doubts));
    }
    add(&line, " | lost %lu", lost_of(c));
    if (on_terminal && (size_t)width_of_terminal() <= line.length) {
        line.text[width_of_terminal() - 1] = '\0';
    }
    events_show_line(line.text, on_terminal);
}

static void row(const char *name, unsigned long count, const char *what) {
    (void)printf("%-22s %8lu  %s\n", name, count, what);
}

void status_line_summary(const companion_t *c) {
    const wire_counts_t *wire = &c->wire.counts;
    if (isatty(STDERR_FILENO)) {
        (void)fputs("\r\033[K", stderr);
    }
    row("messages", wire->messages, "of MAVLink that were understood");
    row("messages_unknown", wire->unknown, "of kinds that the companion has no use for");
    row("messages_lost", wire->lost, "of the autopilot's, by their running number");
    row("messages_garbage", wire->garbage, "frames with a wrong checksum");
    row("messages_unsigned", wire->without_signature, "that were refused on a signed link");
    row("messages_forged", wire->forged, "with another's signature, or an old one: refused");
    row("bytes_stray", wire->stray, "between frames");
    row("messages_unsent", wire->unsent, "that the link did not take");
    row("links_lost", c->links_lost, "TCP peers and devices that went away");
    row("attitudes", c->autopilot.attitudes, "samples taken");
    row("positions", c->autopilot.positions, "samples taken");
    row("samples_bad", c->autopilot.bad_samples, "out of order, not finite or out of range");
    row("jumps", c->autopilot.jumps, "of the autopilot's position or attitude");
    row("restarts", c->autopilot.restarts, "of the autopilot, or jumps of its clock by a second and more");
    row("clock_slips", c->autopilot.slips, "of the autopilot's clock against this computer's");
    row("images", c->counts.images, "taken");
    row("images_late", c->counts.late, "too late for the history of poses");
    row("images_unread", c->counts.unread, "lines or messages that could not be understood");
    row("images_without_clock", c->counts.clockless, "before the autopilot's clock was known");
    row("images_without_pose", c->queue.given_up, "that waited in vain");
    row("detections_refused", c->flight.counters.refused, "not finite or out of range, samples of the pose included");
    for (int fault = BOX_GOOD + 1; fault < BOX_FAULTS; fault++) {
        static const char *const names[BOX_FAULTS] = {"", "boxes_normalized", "boxes_exchanged", "boxes_outside"};
        row(names[fault], c->box_faults[fault].boxes, box_fault_text((box_fault_t)fault));
    }
    row("classes_unknown", c->counts.classless, "detections of a class whose size is not known");
    row("tracks_evicted", c->flight.counters.evicted, "for a worse obstacle");
    row("strangers", c->autopilot.strangers,
        "messages from another address that were read before the system refused them");
    row("orders", c->orders.orders, "begun or changed");
    row("orders_refused", c->orders.refused, "by the autopilot");
    row("log_rows", c->record.rows, c->record.failed ? "the log could not be written to its end" : "written");
}
