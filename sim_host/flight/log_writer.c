/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "log_writer.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "output_file.h"
#include "parent_folders.h"

#define PATH_SIZE 4096
#define NUMBER_SIZE 32 /* of any double in text */

typedef void (*content_t)(FILE *file, const flight_case_t *setup, const flight_logs_t *logs);

typedef struct {
    const char *name;
    content_t content;
} log_file_t;

static const char *number(char text[NUMBER_SIZE], double value) {
    for (int digits = 15; digits <= 17; digits++) {
        (void)snprintf(text, NUMBER_SIZE, "%.*g", digits, value);
        const double back = strtod(text, NULL);
        if (!(back < value) && !(back > value)) {
            break;
        }
    }
    return text;
}

static void put(FILE *file, double value) {
    char text[NUMBER_SIZE];
    (void)fprintf(file, ",%s", number(text, value));
}

/* An empty field where the quantity does not exist. */
static void put_if(FILE *file, bool exists, double value) {
    if (exists) {
        put(file, value);
    } else {
        (void)fputc(',', file);
    }
}

static void put_vector(FILE *file, vec3_t v) {
    put(file, v.x);
    put(file, v.y);
    put(file, v.z);
}

static void put_attitude(FILE *file, quat_t q) {
    put(file, q.w);
    put(file, q.x);
    put(file, q.y);
    put(file, q.z);
}

static void put_features(FILE *file, log_features_t logged, const features_t *features) {
    for (int i = 0; i < features_logged(logged); i++) {
        const feature_t *feature = &features->feature[i];
        if (feature->seen) {
            put(file, feature->u_px);
            put(file, feature->v_px);
        } else {
            (void)fputs(",,", file);
        }
    }
}

static void put_box(FILE *file, log_features_t logged, const image_box_t *box) {
    for (int side = 0; side < SIDE_COUNT && logged == LOG_BOXES; side++) {
        if (box->seen) {
            put(file, box->side_px[side]);
        } else {
            (void)fputc(',', file);
        }
    }
}

/* A log of one camera has no such column. */
static void put_camera_number(FILE *file, const flight_case_t *setup, const flight_frame_t *frame) {
    if (setup->cameras > 1) {
        (void)fprintf(file, ",%d", frame->camera);
    }
}

static void put_image_names(FILE *file, const flight_case_t *setup) {
    const log_features_t logged = setup->features;
    (void)fputs(setup->cameras > 1 ? ",camera" : "", file);
    for (int i = 0; i < features_logged(logged); i++) {
        (void)fprintf(file, ",%s_u,%s_v", FEATURE_NAMES[i], FEATURE_NAMES[i]);
    }
    for (int side = 0; side < SIDE_COUNT && logged == LOG_BOXES; side++) {
        (void)fprintf(file, ",%s", SIDE_NAMES[side]);
    }
    (void)fputc('\n', file);
}

static void put_time(FILE *file, int64_t time_us) {
    (void)fprintf(file, "%" PRId64 ".%06" PRId64, time_us / 1000000, time_us % 1000000);
}

static void put_key(FILE *file, const char *owner, const char *key, double value) {
    char text[NUMBER_SIZE];
    (void)fprintf(file, "%s.%s = %s\n", owner, key, number(text, value));
}

static void put_camera(FILE *file, const char *name, const camera_t *camera) {
    put_key(file, name, "width", camera->width_px);
    put_key(file, name, "height", camera->height_px);
    put_key(file, name, "fx", camera->fx_px);
    put_key(file, name, "fy", camera->fy_px);
    put_key(file, name, "cx", camera->cx_px);
    put_key(file, name, "cy", camera->cy_px);
    put_key(file, name, "k1", camera->k1);
    put_key(file, name, "k2", camera->k2);
    put_key(file, name, "p1", camera->p1);
    put_key(file, name, "p2", camera->p2);
    put_key(file, name, "k3", camera->k3);
    put_key(file, name, "mount_roll_deg", camera->mount_roll_deg);
    put_key(file, name, "mount_pitch_deg", camera->mount_pitch_deg);
    put_key(file, name, "mount_yaw_deg", camera->mount_yaw_deg);
    put_key(file, name, "offset_x_m", camera->offset_m.x);
    put_key(file, name, "offset_y_m", camera->offset_m.y);
    put_key(file, name, "offset_z_m", camera->offset_m.z);
}

static void write_camera(FILE *file, const flight_case_t *setup, const flight_logs_t *logs) {
    put_camera(file, "camera", &setup->camera[0]);
    if (setup->cameras > 1) {
        put_camera(file, "camera2", &setup->camera[1]);
    }
    put_key(file, "trajectory", "heading_deg", degrees(logs->log[0].course_rad));
}

static void write_frames(FILE *file, const flight_case_t *setup, const flight_logs_t *logs) {
    (void)fputs("t_s,id,n_m,e_m,d_m,agl_m,qw,qx,qy,qz", file);
    put_image_names(file, setup);
    for (size_t i = 0; i < logs->log[0].count * logs->count; i++) {
        const size_t track = i % logs->count;
        const flight_frame_t *frame = &logs->log[track].frames[i / logs->count];
        put_time(file, frame->time_us);
        (void)fprintf(file, ",%d", LOG_TRACK_ID + (int)track);
        put_vector(file, frame->logged.position_ned_m);
        put(file, frame->agl_m);
        put_attitude(file, frame->logged.attitude);
        put_camera_number(file, setup, frame);
        put_features(file, setup->features, &frame->measured);
        put_box(file, setup->features, &frame->measured_box);
        (void)fputc('\n', file);
    }
}

static void write_truth_frames(FILE *file, const flight_case_t *setup, const flight_logs_t *logs) {
    (void)fputs("t_s,id,n_m,e_m,d_m,agl_m,qw,qx,qy,qz,airspeed_mps", file);
    put_image_names(file, setup);
    for (size_t i = 0; i < logs->log[0].count * logs->count; i++) {
        const size_t track = i % logs->count;
        const flight_frame_t *frame = &logs->log[track].frames[i / logs->count];
        put_time(file, frame->time_us);
        (void)fprintf(file, ",%d", LOG_TRACK_ID + (int)track);
        put_vector(file, frame->truth.position_ned_m);
        put(file, frame->true_agl_m);
        put_attitude(file, frame->truth.attitude);
        put(file, frame->airspeed_mps);
        put_camera_number(file, setup, frame);
        put_features(file, setup->features, &frame->exact);
        put_box(file, setup->features, &frame->exact_box);
        (void)fputc('\n', file);
    }
}

static void write_truth(FILE *file, const flight_case_t *setup, const flight_logs_t *logs) {
    (void)fputs("id,static,center_n_m,center_e_m,ground_d_m,width_m,length_m,height_m,heading_deg,"
                "x0_m,z0_m,front_x0_m,front_z0_m,orientation_deg,kind,seed\n",
                file);
    for (size_t track = 0; track < logs->count; track++) {
        const flight_log_t *log = &logs->log[track];
        const obstacle_t *o = &log->obstacle;
        const bool is_box = o->kind == OBSTACLE_BOX; /* a round obstacle has neither sides nor an orientation */
        (void)fprintf(file, "%d,1", LOG_TRACK_ID + (int)track);
        put(file, o->center_n_m);
        put(file, o->center_e_m);
        put(file, o->ground_d_m);
        put(file, o->width_m);
        put_if(file, is_box, o->length_m);
        put(file, o->height_m);
        put_if(file, is_box, degrees(o->heading_rad));
        put(file, log->x0_m);
        put(file, log->z0_m);
        put_if(file, is_box, log->front_x0_m);
        put_if(file, is_box, log->front_z0_m);
        put_if(file, is_box, log->orientation_deg);
        (void)fprintf(file, ",%s,%" PRIu64 "\n", is_box ? "box" : "cylinder", setup->seed);
    }
}

static const log_file_t LOG_FILES[] = {{"camera.ini", write_camera},
                                       {"frames.csv", write_frames},
                                       {"truth.csv", write_truth},
                                       {"truth_frames.csv", write_truth_frames}};
#define LOG_FILE_COUNT (sizeof LOG_FILES / sizeof LOG_FILES[0])

static bool join(char path[PATH_SIZE], const char *folder, const char *name) {
    const int length = snprintf(path, PATH_SIZE, "%s/%s", folder, name);
    return length > 0 && length < PATH_SIZE;
}

static bool write_file(const char *folder, const log_file_t *entry, const flight_case_t *setup,
                       const flight_logs_t *logs) {
    char path[PATH_SIZE];
    if (!join(path, folder, entry->name)) {
        errno = ENAMETOOLONG;
        return false;
    }
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        return false;
    }
    entry->content(file, setup, logs);
    const bool written = !ferror(file);
    return fclose(file) == 0 && written;
}

bool log_write_replaces(const char *folder, const char *path) {
    char file[PATH_SIZE];
    bool found = false;
    for (size_t i = 0; i < LOG_FILE_COUNT && !found; i++) {
        found = join(file, folder, LOG_FILES[i].name) && output_file_is(file, path);
    }
    return found;
}

/* Removes a folder that holds files of a log only. */
static void remove_log(const char *folder) {
    char path[PATH_SIZE];
    for (size_t i = 0; i < LOG_FILE_COUNT; i++) {
        if (join(path, folder, LOG_FILES[i].name)) {
            (void)unlink(path);
        }
    }
    (void)rmdir(folder);
}

static bool is_log_file(const char *name) {
    for (size_t i = 0; i < LOG_FILE_COUNT; i++) {
        if (strcmp(name, LOG_FILES[i].name) == 0) {
            return true;
        }
    }
    return strcmp(name, ".") == 0 || strcmp(name, "..") == 0;
}

/* ------------------------------------------------------------------------------------------------------- own logs -- */

/* The last line of camera.ini says who wrote the log, and a sum over all that the folder held then: a log of another program, or
 * one that was edited since, is not goe_sim's to replace. */
#define MARK "# written by goe_sim; it replaces the log only as long as this sum fits: "
#define MARK_SIZE (sizeof MARK + 17u) /* 16 digits, a line break and a NUL */
#define SUM_BEGIN 0xcbf29ce484222325u /* FNV-1a, 64 bits */
#define SUM_FACTOR 0x100000001b3u
#define CAMERA_FILE 0 /* of LOG_FILES */

static uint64_t sum_of(uint64_t sum, const unsigned char *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        sum = (sum ^ bytes[i]) * SUM_FACTOR;
    }
    return sum;
}

/* Of a file without its last `left_out` bytes, which go to `end`. False: it cannot be read, or is shorter. */
static bool sum_of_file(const char *path, size_t left_out, char *end, uint64_t *sum) {
    unsigned char buffer[16384];
    struct stat status;
    FILE *file = stat(path, &status) == 0 && S_ISREG(status.st_mode) ? fopen(path, "rb") : NULL;
    if (file == NULL) {
        return false;
    }
    bool done = status.st_size >= (off_t)left_out;
    off_t rest = done ? status.st_size - (off_t)left_out : 0;
    while (done && rest > 0) {
        const size_t wanted = rest < (off_t)sizeof buffer ? (size_t)rest : sizeof buffer;
        done = fread(buffer, 1, wanted, file) == wanted;
        *sum = done ? sum_of(*sum, buffer, wanted) : *sum;
        rest -= (off_t)wanted;
    }
    done = done && fread(end, 1, left_out, file) == left_out;
    (void)fclose(file);
    return done;
}

/* The mark that belongs to a folder's files; camera.ini already ends in one if `marked`, which goes to `found`. */
static bool mark_of(const char *folder, bool marked, char mark[MARK_SIZE], char found[MARK_SIZE]) {
    char path[PATH_SIZE];
    uint64_t sum = SUM_BEGIN;
    bool done = true;
    for (size_t i = 0; i < LOG_FILE_COUNT && done; i++) {
        const size_t left_out = marked && i == CAMERA_FILE ? MARK_SIZE - 1u : 0u;
        done = join(path, folder, LOG_FILES[i].name) && sum_of_file(path, left_out, found, &sum);
    }
    (void)snprintf(mark, MARK_SIZE, "%s%016" PRIx64 "\n", MARK, sum);
    return done;
}

static bool is_own_log(const char *folder) {
    char mark[MARK_SIZE] = "", found[MARK_SIZE] = "";
    return mark_of(folder, true, mark, found) && strcmp(mark, found) == 0;
}

static bool put_mark(const char *folder) {
    char mark[MARK_SIZE], nothing[MARK_SIZE], path[PATH_SIZE];
    FILE *file = mark_of(folder, false, mark, nothing) && join(path, folder, LOG_FILES[CAMERA_FILE].name)
                     ? fopen(path, "ab")
                     : NULL;
    if (file == NULL) {
        return false;
    }
    const bool written = fputs(mark, file) >= 0;
    return fclose(file) == 0 && written;
}

/* ---------------------------------------------------------------------------------------------------------- replace -- */

/* Null if a log may be put in this place, otherwise why not. */
static const char *occupied(const char *folder, bool *exists) {
    struct stat status;
    *exists = lstat(folder, &status) == 0;
    if (!*exists) {
        return errno == ENOENT ? NULL : strerror(errno);
    }
    DIR *entries = S_ISDIR(status.st_mode) ? opendir(folder) : NULL;
    if (entries == NULL) {
        return "is there and is not a folder";
    }
    bool only_log = true, empty = true;
    for (const struct dirent *entry = readdir(entries); entry != NULL; entry = readdir(entries)) {
        only_log = only_log && is_log_file(entry->d_name);
        empty = empty && entry->d_name[0] == '.';
    }
    (void)closedir(entries);
    if (!only_log) {
        return "is there and holds files that are no log";
    }
    return empty || is_own_log(folder) ? NULL
                                       : "is there and holds a log that goe_sim did not write, or that was changed "
                                         "since; remove it or name another folder";
}

static bool exchange(const char *folder, const char *fresh, bool exists) {
    char old[PATH_SIZE];
    if (exists) {
        const int length = snprintf(old, sizeof old, "%s.old", fresh);
        if (length <= 0 || (size_t)length >= sizeof old || rename(folder, old) != 0) {
            return false;
        }
    }
    if (rename(fresh, folder) != 0) {
        const int reason = errno;
        if (exists) {
            (void)rename(old, folder);
        }
        errno = reason;
        return false;
    }
    if (exists) {
        remove_log(old);
    }
    return true;
}

static bool write_and_exchange(const char *folder, const char *fresh, bool exists, const flight_case_t *setup,
                               const flight_logs_t *logs) {
    bool done = chmod(fresh, S_IRWXU | S_IRGRP | S_IXGRP | S_IROTH | S_IXOTH) == 0;
    for (size_t i = 0; i < LOG_FILE_COUNT && done; i++) {
        done = write_file(fresh, &LOG_FILES[i], setup, logs);
    }
    done = done && put_mark(fresh) && exchange(folder, fresh, exists);
    if (!done) {
        const int reason = errno;
        remove_log(fresh);
        errno = reason;
    }
    return done;
}

bool log_write(const char *folder, const flight_case_t *setup, const flight_logs_t *logs, char *fault,
               size_t fault_size) {
    char fresh[PATH_SIZE - 16], place[PATH_SIZE - 64];
    bool exists;
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/') {
        length--;
    }
    if (length == 0 || length >= sizeof place) {
        (void)snprintf(fault, fault_size, "%s: no usable name of a folder", folder);
        return false;
    }
    memcpy(place, folder, length);
    place[length] = '\0';
    const char *reason = occupied(place, &exists);
    if (reason != NULL) {
        (void)snprintf(fault, fault_size, "%s: %s", place, reason);
        return false;
    }
    /* An interrupt waits until the log is complete or gone: it must not leave a half of it behind. */
    sigset_t interrupts, before;
    (void)sigemptyset(&interrupts);
    (void)sigaddset(&interrupts, SIGINT);
    (void)sigaddset(&interrupts, SIGTERM);
    (void)sigaddset(&interrupts, SIGHUP);
    (void)sigprocmask(SIG_BLOCK, &interrupts, &before);
    (void)signal(SIGXFSZ, SIG_IGN); /* a write that cannot succeed shall fail where it is made */
    (void)snprintf(fresh, sizeof fresh, "%s.part-XXXXXX", place);
    const bool done =
        parent_folders_make(place) && mkdtemp(fresh) != NULL && write_and_exchange(place, fresh, exists, setup, logs);
    if (!done) {
        (void)snprintf(fault, fault_size, "%s: %s", place, strerror(errno));
    }
    (void)sigprocmask(SIG_SETMASK, &before, NULL);
    return done;
}
