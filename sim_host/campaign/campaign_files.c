/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "campaign_files.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "parent_folders.h"

#define PATH_SIZE 4096
#define STAGING_PATTERN ".goe_campaign-XXXXXX"
#define FOLDER_MODE 0777u

/* False: the path is too long, errno says so. */
static bool join(char path[PATH_SIZE], const char *folder, const char *name) {
    const int length = snprintf(path, PATH_SIZE, "%s/%s", folder, name);
    if (length < 0 || length >= PATH_SIZE) {
        errno = ENAMETOOLONG;
        return false;
    }
    return true;
}

/* ----------------------------------------------------------------------------------------------------------- check -- */

static const char *check_parent(const char *folder) {
    char parent[PATH_SIZE];
    size_t length = strlen(folder);
    while (length > 0 && folder[length - 1] == '/') {
        length--;
    }
    while (length > 0 && folder[length - 1] != '/') {
        length--;
    }
    if (length >= sizeof parent) {
        return strerror(ENAMETOOLONG);
    }
    (void)snprintf(parent, sizeof parent, "%.*s", (int)length, folder);
    return access(length > 0 ? parent : ".", W_OK | X_OK) == 0 ? NULL : strerror(errno);
}

/* The existing file or folder in place of a file or the folder of the series. */
static const char *check_places(const char *folder) {
    static const struct {
        const char *name;
        bool is_folder;
    } places[] = {{"cases.csv", false}, {"campaign.json", false}, {CAMPAIGN_SERIES_FOLDER, true}};
    char path[PATH_SIZE];
    struct stat status;
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        if (!join(path, folder, places[i].name)) {
            return strerror(ENAMETOOLONG);
        }
        if (lstat(path, &status) == 0 && places[i].is_folder != S_ISDIR(status.st_mode)) {
            return places[i].is_folder ? "holds something in the place of the folder " CAMPAIGN_SERIES_FOLDER
                                       : "holds a folder in the place of cases.csv or campaign.json";
        }
    }
    return NULL;
}

const char *campaign_files_check(const char *folder) {
    struct stat status;
    if (*folder == '\0') {
        return "no name of a folder";
    }
    if (stat(folder, &status) != 0) {
        const int cause = errno;
        if (lstat(folder, &status) == 0) {
            return "is a symbolic link that leads nowhere";
        }
        errno = cause;
        if (cause != ENOENT || !parent_folders_make(folder)) {
            return strerror(errno);
        }
        return check_parent(folder);
    }
    if (!S_ISDIR(status.st_mode)) {
        return "is there and is not a folder";
    }
    return access(folder, R_OK | W_OK | X_OK) == 0 ? check_places(folder) : strerror(errno);
}

/* ---------------------------------------------------------------------------------------------------------- staging -- */

static bool write_file(const char *folder, const campaign_file_t *file) {
    char path[PATH_SIZE];
    FILE *stream = join(path, folder, file->name) ? fopen(path, "wb") : NULL;
    if (stream == NULL) {
        return false;
    }
    for (size_t i = 0; i < file->count; i++) {
        if (file->pieces[i] != NULL) {
            (void)fputs(file->pieces[i], stream);
        }
    }
    const bool written = fflush(stream) == 0 && ferror(stream) == 0;
    const int cause = errno;
    const bool closed = fclose(stream) == 0;
    if (!written) {
        errno = cause;
    }
    return written && closed;
}

static bool write_files(const char *folder, const campaign_file_t *files, size_t count) {
    char series[PATH_SIZE];
    bool done = join(series, folder, CAMPAIGN_SERIES_FOLDER) && mkdir(series, FOLDER_MODE) == 0;
    for (size_t i = 0; i < count && done; i++) {
        done = write_file(folder, &files[i]);
    }
    return done;
}

/* The rest of it. */
static void remove_staging(const char *folder, const campaign_file_t *files, size_t count) {
    const int cause = errno;
    char path[PATH_SIZE];
    for (size_t i = 0; i < count; i++) {
        if (join(path, folder, files[i].name)) {
            (void)unlink(path);
        }
    }
    if (join(path, folder, CAMPAIGN_SERIES_FOLDER)) {
        (void)rmdir(path);
    }
    (void)rmdir(folder);
    errno = cause;
}

/* ---------------------------------------------------------------------------------------------------------- exchange -- */

/* <case>_<run>.csv */
static bool is_series(const char *name) {
    static const char *const endings[] = {"_auto.csv", "_disc.csv", "_filter.csv"};
    const char *run = name;
    bool known = false;
    while (isdigit((unsigned char)*run)) {
        run++;
    }
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        known = known || strcmp(run, endings[i]) == 0;
    }
    return run != name && known;
}

static bool remove_old_series(const char *folder) {
    char series[PATH_SIZE], path[PATH_SIZE];
    DIR *entries = join(series, folder, CAMPAIGN_SERIES_FOLDER) ? opendir(series) : NULL;
    if (entries == NULL) {
        return errno == ENOENT && mkdir(series, FOLDER_MODE) == 0;
    }
    bool done = true;
    for (const struct dirent *entry = readdir(entries); entry != NULL && done; entry = readdir(entries)) {
        done = !is_series(entry->d_name) || (join(path, series, entry->d_name) && unlink(path) == 0);
    }
    (void)closedir(entries);
    return done;
}

/* What could fail has been tried on the same file system: from here on only names change. */
static bool exchange(const char *folder, const char *staging, const campaign_file_t *files, size_t count) {
    char from[PATH_SIZE], to[PATH_SIZE];
    bool done = remove_old_series(folder);
    for (size_t i = 0; i < count && done; i++) {
        done = join(from, staging, files[i].name) && join(to, folder, files[i].name) && rename(from, to) == 0;
    }
    return done;
}

static bool stage_and_exchange(const char *folder, const campaign_file_t *files, size_t count) {
    char staging[PATH_SIZE];
    if (!join(staging, folder, STAGING_PATTERN) || mkdtemp(staging) == NULL) {
        return false;
    }
    const bool done = write_files(staging, files, count) && exchange(folder, staging, files, count);
    remove_staging(staging, files, count);
    return done;
}

const char *campaign_files_write(const char *folder, const campaign_file_t *files, size_t count) {
    sigset_t interrupts, before;
    (void)sigemptyset(&interrupts);
    (void)sigaddset(&interrupts, SIGINT);
    (void)sigaddset(&interrupts, SIGTERM);
    (void)sigaddset(&interrupts, SIGHUP);
    (void)sigprocmask(SIG_BLOCK, &interrupts, &before);
    (void)signal(SIGXFSZ, SIG_IGN); /* a write that cannot succeed shall fail where it is made */
    const bool made = mkdir(folder, FOLDER_MODE) == 0;
    const char *fault = NULL;
    if ((!made && errno != EEXIST) || !stage_and_exchange(folder, files, count)) {
        fault = strerror(errno);
        if (made) {
            (void)rmdir(folder);
        }
    }
    (void)sigprocmask(SIG_SETMASK, &before, NULL);
    return fault;
}
