/*
 * The campaign's folder: cases.csv, campaign.json and series/. All of it changes at once: the files are written to a folder
 * of their own inside it and then renamed, and an interrupt waits for that. Series of an earlier campaign go; anything else
 * in the folder stays.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef CAMPAIGN_FILES_H
#define CAMPAIGN_FILES_H

#include <stdbool.h>
#include <stddef.h>

/* A file's name within the folder, at most 63 characters, and its content. */
typedef struct {
    char name[64];
    const char *const *pieces; /* one after the other; null ones are left out */
    size_t count;
} campaign_file_t;

#define CAMPAIGN_SERIES_FOLDER "series"

/* Null if a campaign can be written to folder (which need not exist, its parent must), otherwise why not. */
const char *campaign_files_check(const char *folder);

/* files: those in series/ first have that in their name. Null if all are written, otherwise the reason; then the folder's files are
 * as they were. */
const char *campaign_files_write(const char *folder, const campaign_file_t *files, size_t count);

#endif
