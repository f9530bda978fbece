/* The estimator's memory. Private to the library; in a header because the caller owns the memory. Included by goe.h alone.
 * SPDX-License-Identifier: MIT
 *
 * Each type names the file that maintains it; a new track, and the start of a phase or a model, reset it. */
#ifndef GOE_STATE_H
#define GOE_STATE_H

#ifndef GOE_H
#error "include goe.h, which includes this"
#endif

/* C99 has no _Static_assert: a negative array size does not compile. */
#define GOE_STATIC_ASSERT(condition, what) typedef char goe_assert_##what[(condition) ? 1 : -1]

/* Before a static function that must stay one: its locals must not be on the stack while its neighbors run, or it is called
 * in more than one place and a copy in each would cost more. */
#if defined(__GNUC__)
#define GOE_NOINLINE __attribute__((noinline))
#else
#define GOE_NOINLINE
#endif

/* Before a static function whose constant arguments must reach its branches, also where the compiler counts bytes. */
#if defined(__GNUC__)
#define GOE_INLINE __attribute__((always_inline)) inline
#else
#define GOE_INLINE inline
#endif

/* Whether something is so: 0 is not, anything else is. A bool with a flipped bit would be undefined. */
typedef uint8_t goe_flag_t;

/* Augmented states, which the filter takes as constant: the latency of the poses, s, and the obstacle's velocity, T
 * axes, m/s; 0 of them if that part is left out. */
#if GOE_WITH_FILTER && GOE_WITH_TARGET_MOTION
#define GOE_AUGMENTED 3
#else
#define GOE_AUGMENTED 0
#endif

/* In this order. */
typedef enum { GOE_AUGMENTED_LATENCY, GOE_AUGMENTED_VELOCITY_X, GOE_AUGMENTED_VELOCITY_Z } goe_augmented_t;

/* ----------------------------------------------------------------------------------------------------------- image -- */

/* image/goe_ego_motion.c: own motion over the track. */
typedef struct {
    int64_t time_us;                /* latest image of the track; GOE_TIME_UNKNOWN: none was taken, and nothing holds */
    int64_t start_time_us;          /* its first one */
    float heading_cos, heading_sin; /* of T's Z axis, from north */
    float origin_ne_m[2];           /* camera at the track's first image, moved along with compensated resets */
    float dx_m, dz_m;               /* camera since then, T axes */
    float height_m;                 /* camera above ground, latest image: as given, plus the next one */
    float height_jump_m;            /* sum of the jumps of down that the given height followed */
    float ground_m;                 /* down of the ground, by the latest image's height as given */
    goe_flag_t detected;            /* a feature was visible: T and its origin stay */
    uint8_t reset_count;
#if GOE_AUGMENTED
    uint8_t paced; /* not 0: the fields below hold; 1, and images in a row that lay where they led */
    uint8_t leaps; /* images in a row that lay far off */
    float rate_rad_s[3], velocity_m_s[2]; /* T axes; since the mark ... */
    float rate_before_rad_s[3];           /* ... and before it: free of the latest attitude's own error */
    float mark_attitude[4], mark_m[2];    /* attitude and place, T axes, at mark_us: where they count from */
    int64_t mark_us;
#endif
} goe_motion_t;

/* ---------------------------------------------------------------------------------------------------------- window -- */

/* window/goe_fit.h: what one image gives to one model, and the newest of these in a ring. */
typedef struct {
    float dx_m, dz_m; /* camera since the track's first image, T axes */
    float xi, zeta;   /* rows of (5), turned back into T */
} goe_fit_point_t;

typedef struct {
    goe_fit_point_t point[GOE_WINDOW_MAX];
    int16_t next, count; /* count: points that ever came, saturating */
} goe_fit_ring_t;

typedef struct { /* window/goe_mean.c: sliding mean */
    float value[GOE_WINDOW_MAX];
    int16_t next, count;
} goe_mean_t;

typedef struct { /* window/goe_orientation.c */
    float filtered_deg, raw_deg;
    float variance_deg2; /* of one image's orientation about the filtered one */
    int count;           /* saturates at orientation_memory */
} goe_orientation_t;

typedef struct { /* window/goe_window.c */
    goe_orientation_t orientation;
    goe_mean_t length, height;
    goe_fit_ring_t disc, line;
} goe_window_t;

/* --------------------------------------------------------------------------------------------------------- filter -- */

#define GOE_STATES 10
#define GOE_FEATURES 6

/* The state and the augmented states. */
#define GOE_UNKNOWNS (GOE_STATES + GOE_AUGMENTED)

typedef struct {
    float element[GOE_UNKNOWNS * (GOE_UNKNOWNS + 1) / 2]; /* upper triangular matrix, row by row */
#if GOE_AUGMENTED
    float right[GOE_AUGMENTED]; /* right-hand side of the last rows, those of the augmented states */
    uint8_t estimated;          /* of these, from the first on; the others are taken as known */
#endif
} goe_triangle_t;

/* Rows of a measurement: by the nuisances of the image (its own attitude noise about three axes), by the states, by the
 * augmented states, and the residual. */
#define GOE_NUISANCES 3
#define GOE_COLUMNS (GOE_NUISANCES + GOE_UNKNOWNS + 1)
#define GOE_ROWS_MAX 9 /* three corners, two each; left, right, top */

typedef struct {
    float row[GOE_ROWS_MAX][GOE_COLUMNS];
} goe_matrix_t;

/* refined/goe_filter.c: the axes of the state, with their origin at the camera at the filter's start. */
typedef struct {
    int64_t start_time_us;
    float turn_cos, turn_sin;     /* T turned by this about the vertical, clockwise as viewed from above */
    float start_dx_m, start_dz_m; /* that camera in T */
#if GOE_AUGMENTED
    float start_velocity_m_s[2]; /* ... and its velocity, if goe_filter_t.paced holds */
#endif
} goe_axes_t;

/* refined/goe_box_start.c: the box found in the previous images; goe_model.c: the last box. */
typedef struct {
    float extent[2];     /* two faces: lateral extents, focal lengths; one face: its orientation, rad, second unused */
    goe_flag_t both;     /* of two faces */
    uint8_t agreeing;    /* images in a row */
    uint8_t near_images; /* in which an undetected near corner still counts as missed */
} goe_candidate_t;

typedef struct {          /* refined/goe_box.c: what the report calls the edges of a box */
    goe_flag_t exchanged; /* it calls front what the state calls side */
    goe_flag_t decided;
} goe_naming_t;

/* refined/goe_ground.c: the camera's height by the changes of down since the track's first image, and what the readings of the altimeter
 * say of it. */
typedef struct {
    float ground_m;     /* down of the ground, by the heights before the filter's start */
    float height_m;     /* of the camera above it, latest image */
    float sd_m;         /* one sigma of the first height, as its image gave it; 0: as in the settings */
    float mean_m;       /* by how much the heights, freed of the changes of down, lie above that ground */
    float noise_m2;     /* variance of that mean by the noise of the readings and the drift of down */
    float scatter_m2;   /* mean square of the readings about it */
    float first_m2;     /* variance of the height that the filter began with */
    float taken_m2;     /* ... of the heights that are in the filter */
    float taken_mean_m; /* ... and mean_m then */
    uint8_t readings;   /* heights so far, saturating */
    goe_flag_t boxes;   /* the filter has used an upright box */
} goe_datum_t;

/* refined/goe_side_memory.c: the slowly varying (correlated) error of a box's side, as estimated from the residuals
 * so far. It depends on the state: value + by' (x - state), and the variance is its uncertainty beyond that. */
typedef struct {
    float by[GOE_UNKNOWNS];
    float value;    /* focal lengths */
    float variance; /* not positive: the side was not measured yet, and the magnitude is the configured variance */
} goe_side_memory_t;

/* refined/goe_scatter.c: residuals of one image with those of the image before. A series: a coordinate of a feature. */
#define GOE_SERIES (2 * GOE_FEATURES)
typedef struct {
    float before[GOE_SERIES]; /* sigmas */
    float products, squares;
    uint16_t seen; /* bit i: series i has a residual of the image before */
} goe_scatter_t;

#define GOE_NIS_NONE (-1.0f)

typedef struct {      /* refined/goe_health.c: how the images fit */
    float nis;        /* normalized innovation squared of the latest image */
    float mean_nis;   /* of nis over rows: running mean over the track */
    float excess;     /* of nis over rows, above 1: the mean over the whole track, begun with eight images of none */
    float recent_nis; /* ... over some ten images of the filter's present phase; GOE_NIS_NONE: not begun */
    int16_t nis_rows;
    int16_t images;                /* of the track that gave rows, saturating */
    uint8_t refused[GOE_FEATURES]; /* images in a row in which this feature was refused */
    uint8_t poor;                  /* images in a row in which half of the points were */
    uint8_t failed;                /* times that a box proved wrong */
    goe_flag_t base_refused;       /* base corners proved to be none: they are not used */
    goe_flag_t adrift;             /* the filter started again twice within few images */
    uint8_t steady;                /* images since it did, saturating */
} goe_health_t;

/* refined/goe_mover.c: what the images say of the latency and of the obstacle's velocity. */
typedef struct {
    float augmented[3];         /* taken off: latency, s; velocity, T axes, m/s: 0 unless it is followed */
    float nis, rows;            /* sums over the track: the part that no state explains, and its expectation */
    float observed_s;           /* time with informative images, over all starts of the filter */
    float unlike_s;             /* time for which it has contradicted a static obstacle */
    uint8_t images;             /* in a row that said so */
    goe_flag_t moves, followed; /* the obstacle moves; the filter moves with it */
    goe_flag_t late;            /* the poses are late */
} goe_mover_t;

typedef struct {
    float dx_m, dz_m;
} goe_place_t;

typedef struct {         /* refined/goe_answer.c: data of the latest estimate that stay valid when the state changes */
    float reach_m;       /* half of the extent about the reference point, m; prism: across the line of sight */
    goe_place_t nearer;  /* prism: from the middle of a circle of that reach to that of one as near as it is, T axes */
    float height_bias_m; /* constant error of the camera's height that the answer is freed of, m */
    goe_flag_t outdated; /* the state has changed since, other than by time */
    goe_flag_t by_kind;  /* the answer's range is that of the detector's class */
    goe_flag_t outgrown; /* the latest image shows the obstacle larger than it can be at the state's range */
} goe_answer_t;

#define GOE_KIND_SIZES 2 /* width, height */
typedef struct {         /* refined/goe_kind.c: what the filter uses of the detector's class */
    float size_m[GOE_KIND_SIZES], sd_m[GOE_KIND_SIZES];
    uint8_t known;        /* GOE_HAS_...: what the image before knew well enough with the sizes */
    uint8_t usable;       /* bit i: the size does not differ from what images know, which is not the range */
    uint8_t contradicted; /* images in a row that contradict it */
    goe_flag_t wrong;     /* they did: to the end of the track it is not used */
    goe_flag_t first;     /* the first guess of the range was the class's */
    uint8_t passed;       /* first guesses of the range, by the prior width, that proved too near; saturating */
    goe_flag_t is_round;  /* the obstacle is taken to be round */
} goe_kind_use_t;

/* Small members come first: instructions reach the beginning of an object by shorter forms. */
typedef struct {
    int64_t time_us;      /* of the latest image that the filter took */
    uint8_t phase;        /* goe_phase_t */
    uint8_t phase_images; /* images of the phase, saturating */
    uint8_t known;        /* GOE_HAS_...: what the latest image knew well enough */
#if GOE_AUGMENTED
    goe_flag_t paced; /* the velocity in axes holds */
#endif
    goe_naming_t naming;
    uint8_t camera;       /* that took the latest image */
    goe_flag_t has_datum; /* the datum is that of the track's first image */
    float ground_scale;   /* 1/Z0 for which the sigma of GOE_GROUND was set, over the present one */
    float flown_m;        /* along the path since the filter's start, over ground */
    goe_place_t last;     /* camera in the image before, T axes */
    goe_place_t measured; /* ... in the latest image that gave rows, the state's axes */
    float walk_s[2];      /* time since the walk of the own position was last added along X, and along Z */
    float due_s;          /* ... since process noise was, which waits for the next image that gives rows */
    goe_kind_use_t kind;
    goe_candidate_t candidate;
    goe_health_t health;
    goe_answer_t answer;
    goe_axes_t axes;
    goe_datum_t datum;
    goe_scatter_t scatter;
#if GOE_AUGMENTED
    goe_mover_t mover;
#endif
    goe_side_memory_t side[6]; /* by goe_box_side_t, and of the points left and right */
    float state[GOE_STATES];   /* by goe_state_index_t */
    goe_triangle_t root;       /* R: R'R is the information of the state, as of the latest image that gave rows */
} goe_filter_t;

/* ------------------------------------------------------------------------------------------------------- estimator -- */

/* goe_guard.c: sums over mounting and settings, as goe_init() left them. */
typedef struct {
    uint32_t sum, turned;
} goe_seal_t;

typedef struct {
    goe_motion_t motion;
    uint32_t fault_counts[GOE_FAULT_COUNTS];
    uint32_t ready; /* distinguishes an initialized estimator from any other memory */
    goe_seal_t seal;
    float camera_to_body[GOE_CAMERAS_MAX][9];
    goe_settings_t settings;
    goe_estimate_t estimate; /* after the latest image taken; its age_s: from that to the newest refused one, 0: none */
    int64_t estimate_time_us; /* image behind the estimate */
#if GOE_WITH_FILTER
    goe_filter_t filter;
#endif
#if GOE_WITH_WINDOW
    goe_window_t window;
#endif
} goe_estimator_t;

#endif
