/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "work_pool.h"

#include <pthread.h>
#include <time.h>
#include <unistd.h>

#define WATCH_INTERVAL_NS 200000000L
#define NS_PER_S 1000000000L

typedef struct {
    pthread_mutex_t lock; /* guards next and done */
    pthread_cond_t finished;
    size_t next, done, count;
    void (*work)(void *context, size_t i);
    void *context;
} pool_t;

int work_pool_cores(void) {
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores < 1 ? 1 : cores > WORK_POOL_JOBS_MAX ? WORK_POOL_JOBS_MAX : (int)cores;
}

static void *labour(void *argument) {
    pool_t *pool = argument;
    (void)pthread_mutex_lock(&pool->lock);
    while (pool->next < pool->count) {
        const size_t i = pool->next++;
        (void)pthread_mutex_unlock(&pool->lock);
        pool->work(pool->context, i);
        (void)pthread_mutex_lock(&pool->lock);
        pool->done++;
    }
    (void)pthread_cond_signal(&pool->finished);
    (void)pthread_mutex_unlock(&pool->lock);
    return NULL;
}

static void wait_a_little(pool_t *pool) {
    struct timespec until;
    (void)clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += WATCH_INTERVAL_NS;
    until.tv_sec += until.tv_nsec / NS_PER_S;
    until.tv_nsec %= NS_PER_S;
    (void)pthread_cond_timedwait(&pool->finished, &pool->lock, &until);
}

static void watch_over(pool_t *pool, void (*watch)(void *watcher, size_t done), void *watcher) {
    (void)pthread_mutex_lock(&pool->lock);
    while (pool->done < pool->count) {
        wait_a_little(pool);
        const size_t done = pool->done;
        (void)pthread_mutex_unlock(&pool->lock);
        watch(watcher, done);
        (void)pthread_mutex_lock(&pool->lock);
    }
    (void)pthread_mutex_unlock(&pool->lock);
}

bool work_pool_run(int jobs, size_t count, void (*work)(void *context, size_t i), void *context,
                   void (*watch)(void *watcher, size_t done), void *watcher) {
    pthread_t threads[WORK_POOL_JOBS_MAX];
    pool_t pool = {PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, 0, 0, count, work, context};
    int started = 0;
    /* more threads than work, or than the system gives, are no loss */
    while (started < jobs && (size_t)started < count && pthread_create(&threads[started], NULL, labour, &pool) == 0) {
        started++;
    }
    if (started > 0 && watch != NULL) {
        watch_over(&pool, watch, watcher);
    }
    for (int i = 0; i < started; i++) {
        (void)pthread_join(threads[i], NULL);
    }
    (void)pthread_cond_destroy(&pool.finished);
    (void)pthread_mutex_destroy(&pool.lock);
    return started > 0 || count == 0;
}
