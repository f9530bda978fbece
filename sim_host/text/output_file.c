/* A file that appears whole or not at all. SPDX-License-Identifier: MIT */

#include "output_file.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "parent_folders.h"

#define BUFFER_BYTES (1024u * 1024u)
#define TEMPORARY_SUFFIX ".XXXXXX"
#define PERMISSIONS 0777u
#define NEW_FILE_PERMISSIONS 0666u

/* ------------------------------------------------------------------------------------------------------- interrupt -- */

static const int interrupts[] = {SIGHUP, SIGINT, SIGTERM};
#define INTERRUPTS (sizeof interrupts / sizeof interrupts[0])

static const char *volatile to_remove; /* null: nothing */

static void on_interrupt(int number) {
    const char *path = to_remove;
    if (path != NULL) {
        (void)unlink(path);
    }
    (void)raise(number); /* SA_RESETHAND: the default action ends the program, as soon as this returns */
}

/* A signal that the caller's shell made the program ignore stays ignored. */
static void catch_interrupts(void) {
    struct sigaction action;
    (void)memset(&action, 0, sizeof action);
    action.sa_handler = on_interrupt;
    action.sa_flags = (int)SA_RESETHAND;
    (void)sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < INTERRUPTS; i++) {
        struct sigaction before;
        if (sigaction(interrupts[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN) {
            (void)sigaction(interrupts[i], &action, NULL);
        }
    }
}

static void block_interrupts(sigset_t *before) {
    sigset_t set;
    (void)sigemptyset(&set);
    for (size_t i = 0; i < INTERRUPTS; i++) {
        (void)sigaddset(&set, interrupts[i]);
    }
    (void)sigprocmask(SIG_BLOCK, &set, before);
}

/* ------------------------------------------------------------------------------------------------------------ open -- */

static void release(output_file_t *output) {
    to_remove = NULL;
    free(output->target);
    free(output->temporary);
    output->target = NULL;
    output->temporary = NULL;
    output->stream = NULL;
}

/* dir/name -> dir/.name.XXXXXX; null if memory is short. */
static char *temporary_pattern(const char *target) {
    const char *slash = strrchr(target, '/');
    const size_t directory = slash != NULL ? (size_t)(slash - target) + 1u : 0u;
    const size_t capacity = strlen(target) + sizeof "." TEMPORARY_SUFFIX;
    char *pattern = malloc(capacity);
    if (pattern != NULL) {
        (void)snprintf(pattern, capacity, "%.*s.%s" TEMPORARY_SUFFIX, (int)directory, target, target + directory);
    }
    return pattern;
}

static mode_t new_file_mode(void) {
    const mode_t mask = umask(0);
    (void)umask(mask);
    return NEW_FILE_PERMISSIONS & ~mask;
}

/* An interrupt between the making of the file and the note of its name would leave the file behind: it has to wait. */
static FILE *make_temporary(output_file_t *output, mode_t mode) {
    sigset_t before;
    block_interrupts(&before);
    const int descriptor = mkstemp(output->temporary);
    if (descriptor >= 0) {
        to_remove = output->temporary;
    }
    const int cause = errno;
    (void)sigprocmask(SIG_SETMASK, &before, NULL);
    errno = cause;
    if (descriptor < 0) {
        return NULL;
    }
    FILE *stream = fchmod(descriptor, mode) == 0 ? fdopen(descriptor, "w") : NULL;
    if (stream == NULL) {
        (void)unlink(output->temporary);
        (void)close(descriptor);
    }
    return stream;
}

static bool open_temporary(output_file_t *output, const char *path, const struct stat *existing) {
    output->target = existing != NULL ? realpath(path, NULL) : strdup(path); /* a symbolic link stays one */
    output->temporary = output->target != NULL ? temporary_pattern(output->target) : NULL;
    if (output->temporary == NULL) {
        return false;
    }
    catch_interrupts();
    output->stream = make_temporary(output, existing != NULL ? existing->st_mode & PERMISSIONS : new_file_mode());
    return output->stream != NULL;
}

/* Leaves errno alone. */
static bool is_link(const char *path) {
    struct stat status;
    const int cause = errno;
    const bool link = lstat(path, &status) == 0 && S_ISLNK(status.st_mode);
    errno = cause;
    return link;
}

bool output_file_is(const char *path, const char *input) {
    struct stat a, b;
    return stat(path, &a) == 0 && stat(input, &b) == 0 && S_ISREG(a.st_mode) && a.st_dev == b.st_dev &&
           a.st_ino == b.st_ino;
}

bool output_file_open(output_file_t *output, const char *path) {
    struct stat status;
    (void)memset(output, 0, sizeof *output);
    /* A write that cannot succeed shall fail where it is made, not end the program. */
    (void)signal(SIGPIPE, SIG_IGN);
    (void)signal(SIGXFSZ, SIG_IGN);
    if (path == NULL) {
        output->stream = stdout;
    } else if (stat(path, &status) != 0) {
        (void)(errno == ENOENT && !is_link(path) && parent_folders_make(path) && open_temporary(output, path, NULL));
    } else if (S_ISREG(status.st_mode)) {
        (void)open_temporary(output, path, &status);
    } else {
        output->stream = fopen(path, "w");
    }
    if (output->stream == NULL || setvbuf(output->stream, NULL, _IOFBF, BUFFER_BYTES) != 0) {
        const int cause = errno;
        output_file_discard(output);
        errno = cause;
        return false;
    }
    return true;
}

/* ----------------------------------------------------------------------------------------------------------- close -- */

bool output_file_commit(output_file_t *output) {
    bool done = fflush(output->stream) == 0 && ferror(output->stream) == 0;
    int cause = errno;
    if (fclose(output->stream) != 0 && done) {
        done = false;
        cause = errno;
    }
    output->stream = NULL;
    if (done && output->target != NULL && rename(output->temporary, output->target) != 0) {
        done = false;
        cause = errno;
    }
    if (done) {
        release(output);
    } else {
        output_file_discard(output);
        errno = cause;
    }
    return done;
}

void output_file_discard(output_file_t *output) {
    if (output->stream != NULL) {
        (void)fclose(output->stream);
    }
    if (to_remove != NULL && output->temporary != NULL) {
        (void)unlink(output->temporary);
    }
    release(output);
}
