/* One measurement update of a filter of ten states. SPDX-License-Identifier: MIT */
#ifndef GOE_PEER_JOB_H
#define GOE_PEER_JOB_H

#define PEER_STATES 10
#define PEER_NUISANCES 3 /* white noise of the image, common to all its rows */
#define PEER_COLUMNS (PEER_NUISANCES + PEER_STATES + 1)
#define PEER_RESIDUAL (PEER_COLUMNS - 1)
#define PEER_ROWS 9
#define PEER_TRIANGLE (PEER_STATES * (PEER_STATES + 1) / 2)
#define PEER_REPEATS 1 /* of a prepared case while timed: solving overwrites it */

typedef struct {
    /* the prior, in the form of each solver */
    float root[PEER_TRIANGLE];                   /* R, row by row: R'R is the information */
    float factors[PEER_TRIANGLE];                /* U D U' is the covariance: column by column, D where U has ones */
    float covariance[PEER_STATES * PEER_STATES]; /* row by row */
    float nuisance_root;                         /* 1/sigma of the nuisances */
    /* the measurement: rows divided by their sigma, row by row: nuisances, states, residual; unused rows are 0 */
    float measured[PEER_ROWS][PEER_COLUMNS];
} peer_case_t;

typedef struct {
    float change[PEER_STATES];
    float nis;                             /* normalized innovation squared; 0 if the solver does not report it */
    float held[PEER_STATES * PEER_STATES]; /* the posterior in the solver's form; the rest is 0 */
} peer_answer_t;

#endif
