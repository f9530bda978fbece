/* Types of the estimator's memory. Private to the library; in a header because the caller owns the memory. Only goe.h includes it.
 * SPDX-License-Identifier: MIT
 *
 * Each type names the file that maintains it. A new track, and the start of a phase or a model, reset it. */
#ifndef GOE_STATE_H
#define GOE_STATE_H

#ifndef GOE_H
#error "include goe.h, which includes this"
#endif

/* C99 has no _Static_assert. An array of negative size does not compile. */
#define GOE_STATIC_ASSERT(condition, what) typedef char goe_assert_##what[(condition) ? 1 : -1]

/* Marks a static function that must not be inlined: its locals must not be on the stack while its neighbors run, or it has several callers
 * and a copy in each would cost more. */
#if defined(__GNUC__)
#define GOE_NOINLINE __attribute__((noinline))
#else
#define GOE_NOINLINE
#endif

/* Marks a static function that must be inlined, also if the compiler saves bytes: its constant arguments must reach its branches. */
#if defined(__GNUC__)
#define GOE_INLINE __attribute__((always_inline)) inline
#else
#define GOE_INLINE inline
#endif

/* A truth value: 0 is false, any other value is true. A bool with a flipped bit would be undefined. */
typedef uint8_t goe_flag_t;

/* Number of augmented states, which the filter models as constant: the latency of the poses, s, and the obstacle's velocity, T axes, m/s; 0
 * if that part is left out. */
#if GOE_WITH_FILTER && GOE_WITH_TARGET_MOTION
#define GOE_AUGMENTED 3
#else
#define GOE_AUGMENTED 0
#endif

/* The augmented states, in this order. */
typedef enum { GOE_AUGMENTED_LATENCY, GOE_AUGMENTED_VELOCITY_X, GOE_AUGMENTED_VELOCITY_Z } goe_augmented_t;

/* ----------------------------------------------------------------------------------------------------------- image -- */

/* image/goe_ego_motion.c: motion of the camera over the track. */
typedef struct {
    int64_t time_us;                /* latest image; GOE_TIME_UNKNOWN: none was taken, the other fields are invalid */
    int64_t start_time_us;          /* first image of the track */
    float heading_cos, heading_sin; /* direction of T's Z axis, from north */
    float origin_ne_m[2];           /* camera at the track's first image, moved along with compensated jumps */
    float dx_m, dz_m;               /* displacement of the camera since then, T axes */
    float height_m;                 /* camera above ground at the latest image: as given, plus height_jump_m */
    float height_jump_m;            /* sum of those jumps of down that the given height also made */
    float ground_m;                 /* down of the ground, from the latest image's given height */
    uint8_t detected; /* 0: no feature was visible so far. Otherwise T and its origin are fixed, and the value less 1 is
                       * the time, 1/8 s, for which a detection without a new estimate still counts */
    uint8_t reset_count;
#if GOE_CAMERAS_MAX > 1
    uint8_t camera; /* of the latest image */
#endif
#if GOE_AUGMENTED
    uint8_t stray;       /* largest recent distance of an image from the predicted place, 1/16 m; 255: not known */
    uint8_t marks;       /* marks of the smoothed path, saturating */
    float rate_rad_s[3]; /* mean since the mark, T axes */
    float rate_before_rad_s[3];        /* the rate before the mark, free of the latest attitude's error */
    float velocity_m_s[3];             /* of the smoothed path: X and Z in T, down */
    float mark_attitude[4], mark_m[3]; /* attitude, and place on the smoothed path, at mark_us: the mark */
    uint32_t mark_us;                  /* low half of the time */
    int16_t undone[2];                 /* sum of the removed jumps, X and Z in T, 1/256 m; it fades */
#endif
} goe_motion_t;

/* ---------------------------------------------------------------------------------------------------------- window -- */

/* window/goe_fit.h: the measurement of one image for one model, and a ring of the newest of these. */
typedef struct {
    float dx_m, dz_m; /* camera since the track's first image, T axes */
    float xi, zeta;   /* rows of (5), rotated back into T */
} goe_fit_point_t;

typedef struct {
    goe_fit_point_t point[GOE_WINDOW_MAX];
    int16_t next, count; /* count: points added so far, saturating */
} goe_fit_ring_t;

typedef struct { /* window/goe_mean.c: sliding mean */
    float value[GOE_WINDOW_MAX];
    int16_t next, count;
} goe_mean_t;

typedef struct { /* window/goe_orientation.c: low-pass */
    float filtered_deg, raw_deg;
    float variance_deg2; /* variance of one image's orientation about the filtered one */
    int count;           /* images; saturates at orientation_memory */
} goe_orientation_t;

typedef struct { /* window/goe_window.c: memory of the method */
    goe_orientation_t orientation;
    goe_mean_t length, height;
    goe_fit_ring_t disc, line;
} goe_window_t;

/* --------------------------------------------------------------------------------------------------------- filter -- */

#define GOE_STATES 10
#define GOE_FEATURES 6

/* Number of states and augmented states. */
#define GOE_UNKNOWNS (GOE_STATES + GOE_AUGMENTED)

typedef struct {
    float element[GOE_UNKNOWNS * (GOE_UNKNOWNS + 1) / 2]; /* upper triangular matrix, row by row */
#if GOE_AUGMENTED
    float right[GOE_AUGMENTED]; /* right-hand side of the last rows, those of the augmented states */
    uint8_t estimated;          /* number of estimated augmented states, the first ones; the others count as known */
#endif
} goe_triangle_t;

/* Rows of a measurement. Columns: the nuisances of the image (its own attitude noise about three axes), the states, the augmented states,
 * the residual. */
#define GOE_NUISANCES 3
#define GOE_COLUMNS (GOE_NUISANCES + GOE_UNKNOWNS + 1)
#define GOE_ROWS_MAX 9 /* two for each of three corners; left, right, top */

typedef struct {
    float row[GOE_ROWS_MAX][GOE_COLUMNS];
} goe_matrix_t;

/* refined/goe_filter.c: the axes of the state. Their origin is the camera at the filter's start. */
typedef struct {
    int64_t start_time_us;
    float turn_cos, turn_sin;     /* rotation from T about the vertical, clockwise as viewed from above */
    float start_dx_m, start_dz_m; /* that camera, in T */
#if GOE_AUGMENTED
    float start_velocity_m_s[2]; /* its velocity, if goe_filter_t.paced is set */
#endif
} goe_axes_t;

/* refined/goe_box_start.c: the box found in the previous images; goe_model.c: the last box. */
typedef struct {
    float extent[2];     /* two faces: lateral extents, focal lengths; one face: its orientation, rad, second unused */
    goe_flag_t both;     /* two faces are visible */
    uint8_t agreeing;    /* images in a row that agree */
    uint8_t near_images; /* next images in which an undetected near corner counts as missed */
} goe_candidate_t;

typedef struct {          /* refined/goe_box.c: names of the edges in the report */
    goe_flag_t exchanged; /* the report's front is the state's side */
    goe_flag_t decided;
} goe_naming_t;

/* refined/goe_ground.c: the camera's height by the changes of down since the track's first image, and the mean and the scatter of the
 * altimeter's readings. */
typedef struct {
    float ground_m;     /* down of the ground, from the heights before the filter's start */
    float height_m;     /* of the camera above that ground, latest image */
    float sd_m;         /* one sigma of the first height, from its image; 0: from the settings */
    float mean_m;       /* mean of the height readings minus height_m */
    float noise_m2;     /* variance of that mean, by the noise of the readings and the random walk of down */
    float scatter_m2;   /* mean square of the readings about that mean */
    float first_m2;     /* variance of the height at the filter's start */
    float taken_m2;     /* variance of the height that the filter has used */
    float taken_mean_m; /* mean_m at that use */
    float start_m;      /* height_m at the filter's start */
} goe_datum_t;

/* refined/goe_side_memory.c: the slowly varying (correlated) error of a box's side, estimated from the residuals so far. The estimate
 * depends on the state: value + by' (x - state). Its remaining uncertainty is the variance. */
typedef struct {
    float by[GOE_UNKNOWNS];
    float value;    /* focal lengths */
    float variance; /* not positive: the side was not measured yet, and the magnitude is the configured variance */
} goe_side_memory_t;

/* Four sides of the boxes of each camera, which err independently, and two of a shape that is no ellipse. */
#define GOE_SIDE_MEMORIES (4 * GOE_CAMERAS_MAX + 2)

/* refined/goe_scatter.c: products of each residual with that of the previous image. A series: a coordinate of a feature. */
#define GOE_SERIES (2 * GOE_FEATURES)
typedef struct {
    float before[GOE_SERIES]; /* residuals of the previous image, sigmas */
    float products, squares;
    uint16_t seen; /* bit i: series i has a residual of the previous image */
} goe_scatter_t;

#define GOE_NIS_NONE (-1.0f)

typedef struct {      /* refined/goe_health.c: how well the images fit */
    float nis;        /* normalized innovation squared (NIS) of the latest image */
    float mean_nis;   /* running mean of nis / nis_rows over the track */
    float excess;     /* mean of nis / nis_rows - 1 over the whole track, begun with eight images of 0 */
    float recent_nis; /* mean of nis / nis_rows over some ten images of the present phase; GOE_NIS_NONE: none */
    int16_t nis_rows;
    int16_t images;                /* images of the track that gave rows, saturating */
    uint8_t refused[GOE_FEATURES]; /* images in a row in which this feature was refused */
    uint8_t poor;                  /* images in a row in which half of the points were refused */
    uint8_t failed;                /* times that a box proved wrong */
    goe_flag_t base_refused;       /* the points given as base corners are other points: not used */
    goe_flag_t adrift;             /* the filter restarted twice within few images */
    uint8_t steady;                /* images since the latest restart, saturating */
    uint8_t heights;               /* height readings of the track, saturating */
} goe_health_t;

/* refined/goe_mover.c: estimates of the latency and of the obstacle's velocity. */
typedef struct {
    float augmented[3];         /* corrected for: latency, s; velocity, T axes, m/s, 0 unless it is followed */
    float nis, rows;            /* sums over the track: NIS that no state explains, and its expectation */
    float observed_s;           /* time with informative images, over all starts of the filter */
    float unlike_s;             /* time for which the images have contradicted a static obstacle */
    uint8_t images;             /* images in a row that did so */
    goe_flag_t moves, followed; /* the obstacle moves; the filter follows its motion */
    goe_flag_t late;            /* the poses are late */
} goe_mover_t;

typedef struct {
    float dx_m, dz_m;
} goe_place_t;

typedef struct {         /* refined/goe_answer.c: data of the latest estimate that stay valid when the state changes */
    float reach_m;       /* half of the extent about the reference point, m; prism: across the line of sight */
    goe_place_t nearer;  /* prism: from its center to that of a circle of that reach that is as near, T axes */
    float height_bias_m; /* constant error of the camera's height, removed from the estimate, m */
    float outgrown_s;    /* time for which a growth beyond that at the state's range still counts; 0: none */
    goe_flag_t outdated; /* the state has changed since the estimate, other than by time */
    goe_flag_t by_kind;  /* the estimate's range is that of the detector's class */
    uint8_t cut;         /* mask: the obstacle's left and right end, if no image shows them: the border may cut them */
} goe_answer_t;

#define GOE_KIND_SIZES 2 /* width, height */
typedef struct {         /* refined/goe_kind.c: use of the detector's class */
    float size_m[GOE_KIND_SIZES], sd_m[GOE_KIND_SIZES];
    uint8_t known;        /* GOE_HAS_...: what the previous image knew well enough, with the sizes */
    uint8_t usable;       /* bit i: size i agrees with the images, and they do not know the range */
    uint8_t contradicted; /* images in a row that contradict the class */
    goe_flag_t wrong;     /* the class is wrong: not used to the end of the track */
    goe_flag_t first;     /* the prior range is that of the class */
    uint8_t passed;       /* number of prior ranges, by the prior width, that proved too near; saturating */
    goe_flag_t is_round;  /* the obstacle counts as round */
} goe_kind_use_t;

/* Small members come first, because instructions reach the beginning of an object by shorter encodings. */
typedef struct {
    int64_t time_us;      /* latest image that the filter took */
    uint8_t phase;        /* goe_phase_t */
    uint8_t phase_images; /* images of the present phase, saturating */
    uint8_t known;        /* GOE_HAS_...: what the latest image knew well enough */
#if GOE_AUGMENTED
    goe_flag_t paced; /* the velocity in axes is valid */
#endif
    goe_naming_t naming;
    goe_flag_t has_datum; /* the datum is set, by the track's first image */
    goe_flag_t boxes;     /* the filter has used an upright box */
    float ground_scale;   /* 1/Z0 at which the sigma of GOE_GROUND was set, over the present 1/Z0 */
    goe_place_t measured; /* camera at the latest image that gave rows, the state's axes */
    float walk_s[2];      /* time since the random walk of the own position was last added along X, and along Z */
    float due_s;          /* time since process noise was last added; the next image that gives rows adds it */
#if GOE_CAMERAS_MAX > 1
    float faded_s[GOE_CAMERAS_MAX]; /* by camera: time since the errors of its boxes were last faded */
    float used_s[GOE_CAMERAS_MAX];  /* by camera: time since its latest image that gave rows */
    uint8_t ends[GOE_CAMERAS_MAX];  /* by camera: the ends that the border may cut in that image */
#endif
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
    goe_side_memory_t side[GOE_SIDE_MEMORIES]; /* of each camera by goe_box_side_t; then points left and right */
    float state[GOE_STATES];                   /* by goe_state_index_t */
    goe_triangle_t root; /* R: R'R is the information of the state, as of the latest image that gave rows */
} goe_filter_t;

/* ------------------------------------------------------------------------------------------------------- estimator -- */

/* goe_guard.c: checksums over mounting and settings, set by goe_init(). */
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
    goe_estimate_t estimate;  /* after the latest image taken; age_s: from that image to the newest refused, 0: none */
    int64_t estimate_time_us; /* image that gave the estimate */
#if GOE_WITH_FILTER
    goe_filter_t filter;
#endif
#if GOE_WITH_WINDOW
    goe_window_t window;
#endif
} goe_estimator_t;

#endif
