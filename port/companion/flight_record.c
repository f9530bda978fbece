/* The log. SPDX-License-Identifier: MIT */
#include "flight_record.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "events.h"

#define PATH_MAX_LENGTH (2 * CONFIG_TEXT_MAX)
#define LOGS_MAX 10000
#define BYTES_PER_MB 1.0e6
#define US_PER_S 1000000
#define BUFFER_BYTES                                                                                                   \
    (1024u * 1024u) /* more than a second of rows: the file grows by whole ones, and may end at any time */

static const char header[] =
    "t_s,id,n_m,e_m,d_m,agl_m,qw,qx,qy,qz,left_u,left_v,right_u,right_v,top_u,top_v,base_left_u,base_left_v,base_near_"
    "u,"
    "base_near_v,base_right_u,base_right_v,box_left_px,box_top_px,box_right_px,box_bottom_px,camera,"
    "reset_count,reset_n_m,reset_e_m,reset_d_m,kind_width_m,kind_width_sd_m,kind_height_m,kind_height_sd_m,kind_"
    "shape\n";

static bool copy_bytes(FILE *in, FILE *out) {
    char bytes[4096];
    while (feof(in) == 0) {
        const size_t size = fread(bytes, 1, sizeof bytes, in);
        if (ferror(in) != 0 || fwrite(bytes, 1, size, out) != size) {
            return false;
        }
    }
    return true;
}

/* A new file; null: *why says why not. */
static FILE *make_file(const char *path, const char **why) {
    FILE *file = fopen(path, "wbx");
    if (file == NULL) {
        *why = errno == EEXIST ? "holds a log already" : strerror(errno);
    }
    return file;
}

static bool copy_camera(const char *from, const char *to, const char **why) {
    FILE *out = make_file(to, why);
    if (out == NULL) {
        return false;
    }
    FILE *in = fopen(from, "rb");
    const bool copied = in != NULL && copy_bytes(in, out);
    if (in != NULL) {
        (void)fclose(in);
    }
    *why = "the camera's file cannot be copied";
    return fclose(out) == 0 && copied;
}

/* folder, folder-2, folder-3, ... */
static void name_folder(char name[PATH_MAX_LENGTH], const char *folder, int number) {
    if (number == 1) {
        (void)snprintf(name, PATH_MAX_LENGTH, "%s", folder);
    } else {
        (void)snprintf(name, PATH_MAX_LENGTH, "%s-%d", folder, number);
    }
}

static bool has_log(const char *folder) {
    char path[PATH_MAX_LENGTH + 16];
    (void)snprintf(path, sizeof path, "%s/camera.ini", folder);
    return access(path, F_OK) == 0;
}

bool flight_record_open(flight_record_t *record, const companion_config_t *config, char *fault, size_t fault_size) {
    char folder[PATH_MAX_LENGTH], camera[PATH_MAX_LENGTH + 16], frames[PATH_MAX_LENGTH + 16];
    const char *why = "";
    (void)memset(record, 0, sizeof *record);
    record->size_max_mb = config->record_size_max_mb;
    if (*config->record_folder == '\0') {
        return true;
    }
    int number = 0;
    do {
        number++;
        name_folder(folder, config->record_folder, number);
    } while (number < LOGS_MAX && has_log(folder));
    if (number > 1) {
        char before[PATH_MAX_LENGTH];
        name_folder(before, config->record_folder, number - 1);
        (void)order_log_read(before, &record->left);
    }
    (void)snprintf(camera, sizeof camera, "%s/camera.ini", folder);
    (void)snprintf(frames, sizeof frames, "%s/frames.csv", folder);
    (void)mkdir(folder, 0777); /* what hinders it hinders the files, too */
    if (copy_camera(config->camera_file, camera, &why)) {
        record->stream = make_file(frames, &why);
    }
    if (record->stream != NULL) {
        (void)setvbuf(record->stream, NULL, _IOFBF, BUFFER_BYTES);
    }
    if (record->stream == NULL || fputs(header, record->stream) < 0) {
        (void)snprintf(fault, fault_size, "record.folder: %s: %s", folder, why);
        return false;
    }
    if (!order_log_open(&record->orders, folder)) {
        event("no log of orders: %s", strerror(errno));
    }
    return true;
}

/* -------------------------------------------------------------------------------------------------------------- rows -- */

static int put(FILE *stream, float value) { return fprintf(stream, ",%.9g", (double)value); }

static int put_point(FILE *stream, const goe_pixel_t *point) {
    return point->visible ? fprintf(stream, ",%.9g,%.9g", (double)point->u_px, (double)point->v_px)
                          : fprintf(stream, ",,");
}

static int put_side(FILE *stream, const goe_box_t *box, unsigned bit, float value) {
    return (box->sides & bit) != 0 ? put(stream, value) : fprintf(stream, ",");
}

static int put_pose(FILE *stream, const goe_pose_t *pose) {
    int size = 0;
    for (int i = 0; i < 3; i++) {
        size += put(stream, pose->position_ned_m[i]);
    }
    size += put(stream, pose->height_m);
    for (int i = 0; i < 4; i++) {
        size += put(stream, pose->attitude[i]);
    }
    return size;
}

static int put_features(FILE *stream, const goe_flight_detection_t *d) {
    const goe_pixel_t *const points[] = {&d->left, &d->right, &d->top, &d->base_left, &d->base_near, &d->base_right};
    int size = 0;
    for (size_t i = 0; i < sizeof points / sizeof points[0]; i++) {
        size += put_point(stream, points[i]);
    }
    return size + put_side(stream, &d->box, GOE_SIDE_LEFT, d->box.left_px) +
           put_side(stream, &d->box, GOE_SIDE_TOP, d->box.top_px) +
           put_side(stream, &d->box, GOE_SIDE_RIGHT, d->box.right_px) +
           put_side(stream, &d->box, GOE_SIDE_BOTTOM, d->box.bottom_px);
}

static void end(flight_record_t *record, const char *why) {
    event("the log ends after %lu rows: %s", record->rows, why);
    (void)fclose(record->stream);
    record->stream = NULL;
}

static int put_reset(FILE *stream, const autopilot_t *autopilot) {
    const float *delta = autopilot->reset_delta_ned_m;
    int size = fprintf(stream, ",%u", autopilot->resets);
    for (int i = 0; i < 3; i++) {
        size += autopilot->last_reset_known ? put(stream, delta[i]) : fprintf(stream, ",");
    }
    return size;
}

/* Empty: unknown. */
static int put_size(FILE *stream, float size_m, float sd_m) {
    return size_m > 0.0f ? put(stream, size_m) + put(stream, sd_m) : fprintf(stream, ",,");
}

static int put_kind(FILE *stream, const goe_kind_t *kind) {
    return put_size(stream, kind->width_m, kind->width_sd_m) + put_size(stream, kind->height_m, kind->height_sd_m) +
           fprintf(stream, ",%u", (unsigned)kind->shape);
}

/* Times of a log increase: those of an autopilot that restarted follow the latest by a second. */
static double time_s(flight_record_t *record, int64_t time_us) {
    if (record->rows > 0 && time_us + record->shift_us < record->latest_us - US_PER_S) {
        record->shift_us = record->latest_us + US_PER_S - time_us;
    }
    record->latest_us = time_us + record->shift_us;
    return (double)record->latest_us * 1e-6;
}

void flight_record_put(flight_record_t *record, const goe_flight_t *flight, const goe_flight_frame_t *frame,
                       const autopilot_t *autopilot) {
    goe_pose_t pose;
    if (record->stream == NULL || goe_flight_pose(flight, flight->capture_us, 0, &pose, NULL) != GOE_FLIGHT_OK) {
        return;
    }
    const double at_s = time_s(record, pose.time_us);
    for (unsigned i = 0; i < frame->count; i++) {
        const goe_flight_detection_t *detection = &frame->detection[i];
        int size = fprintf(record->stream, "%.6f,%u", at_s, (unsigned)detection->id);
        size += put_pose(record->stream, &pose);
        size += put_features(record->stream, detection);
        size += fprintf(record->stream, ",%u", (unsigned)frame->camera);
        size += put_reset(record->stream, autopilot) + put_kind(record->stream, &detection->kind);
        size += fprintf(record->stream, "\n");
        record->written_mb += (double)size / BYTES_PER_MB;
        record->rows++;
    }
    if (record->written_mb >= record->size_max_mb) {
        end(record, "size_max_mb is reached");
    }
}

void flight_record_flush(flight_record_t *record) {
    if (record->stream != NULL && (fflush(record->stream) != 0 || ferror(record->stream) != 0)) {
        record->failed = true;
        end(record, strerror(errno));
    }
}

void flight_record_close(flight_record_t *record) {
    if (record->stream != NULL && fclose(record->stream) != 0) {
        record->failed = true;
        event("the log could not be written to its end: %s", strerror(errno));
    }
    record->stream = NULL;
    order_log_close(&record->orders);
}
