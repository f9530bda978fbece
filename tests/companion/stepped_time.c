/* Preloaded into goe_companion, so that its clocks show the time of a test and not of the machine. Where the program would wait
 * in poll() for input, it reports that to the test, and continues when the test sends the time. SPDX-License-Identifier: MIT
 *
 * GOE_STEPPED_TIME in the environment contains three numbers: the descriptor of a socket of packets to the test, the time of
 * CLOCK_MONOTONIC in
 * microseconds, and the lead of CLOCK_REALTIME over it. Without the variable nothing is changed. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define US_PER_S 1000000
#define US_PER_MS 1000
#define NS_PER_US 1000
#define AT_ONCE_MAX 10000 /* more calls of poll() at one time are a busy loop */
#define ABANDONED 4       /* exit status: the test has ended */

/* Read by the test: see companion.py. */
typedef struct {
    int64_t until_us; /* the program waits until then at the longest */
    int64_t waits;    /* so far */
    int64_t written;  /* bytes written to terminals so far; they arrive after the end of the write */
} idle_t;

typedef int poll_t(struct pollfd *, nfds_t, int);
typedef int clock_gettime_t(clockid_t, struct timespec *);
typedef ssize_t write_t(int, const void *, size_t);

static int control = -1;
static int64_t now_us, unix_ahead_us;
static idle_t idle;
static int at_once;

__attribute__((constructor)) static void begin(void) {
    const char *setting = getenv("GOE_STEPPED_TIME");
    if (setting != NULL && sscanf(setting, "%d %" SCNd64 " %" SCNd64, &control, &now_us, &unix_ahead_us) != 3) {
        abort();
    }
}

int clock_gettime(clockid_t clock, struct timespec *time) {
    if (control < 0 || (clock != CLOCK_MONOTONIC && clock != CLOCK_REALTIME)) {
        clock_gettime_t *const real = (clock_gettime_t *)dlsym(RTLD_NEXT, "clock_gettime");
        return real(clock, time);
    }
    const int64_t us = now_us + (clock == CLOCK_REALTIME ? unix_ahead_us : 0);
    time->tv_sec = us / US_PER_S;
    time->tv_nsec = us % US_PER_S * NS_PER_US;
    return 0;
}

/* -1: a signal came first */
static int wait_for_time(int64_t until_us) {
    idle.until_us = until_us;
    idle.waits++;
    at_once = 0;
    if (send(control, &idle, sizeof idle, MSG_NOSIGNAL) != (ssize_t)sizeof idle) {
        _exit(ABANDONED);
    }
    const ssize_t size = recv(control, &now_us, sizeof now_us, 0);
    if (size < 0 && errno == EINTR) {
        return -1;
    }
    if (size != (ssize_t)sizeof now_us) {
        _exit(ABANDONED);
    }
    return 0;
}

int poll(struct pollfd *files, nfds_t number, int timeout_ms) {
    poll_t *const real = (poll_t *)dlsym(RTLD_NEXT, "poll");
    if (control < 0) {
        return real(files, number, timeout_ms);
    }
    const int ready = real(files, number, 0);
    const int is_busy = ++at_once > AT_ONCE_MAX;
    if (!is_busy && (ready != 0 || timeout_ms == 0)) {
        return ready;
    }
    if (wait_for_time(is_busy ? now_us : now_us + (int64_t)timeout_ms * US_PER_MS) != 0) {
        return -1;
    }
    return real(files, number, 0);
}

/* The name that hardened compilers use for poll(). */
int __poll_chk(struct pollfd *files, nfds_t number, int timeout_ms, size_t size);
int __poll_chk(struct pollfd *files, nfds_t number, int timeout_ms, size_t size) {
    (void)size;
    return poll(files, number, timeout_ms);
}

ssize_t write(int file, const void *bytes, size_t size) {
    write_t *const real = (write_t *)dlsym(RTLD_NEXT, "write");
    const ssize_t written = real(file, bytes, size);
    const int why = errno;
    idle.written += written > 0 && isatty(file) ? written : 0;
    errno = why;
    return written;
}
