/*
 * Work done by several threads at once.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef WORK_POOL_H
#define WORK_POOL_H

#include <stdbool.h>
#include <stddef.h>

#define WORK_POOL_JOBS_MAX 1024

/* Cores that this machine has online, at least 1. */
int work_pool_cores(void);

/* Calls work(context, i) once for each i below count, from 1 to WORK_POOL_JOBS_MAX threads, in any order and several at a
 * time; they may write only their own memory. Meanwhile calls watch(watcher, done) from the calling thread a few times
 * a second; null: not wanted. Returns when all is done. False if not a single thread could be started: nothing was done. */
bool work_pool_run(int jobs, size_t count, void (*work)(void *context, size_t i), void *context,
                   void (*watch)(void *watcher, size_t done), void *watcher);

#endif
