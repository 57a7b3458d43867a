/* `--segments FILE` of `run`, and of `replay --field`: the run that was played, as C source that a firmware
 * test compiles and plays again.
 *
 * The file is C99 and C++11. Its names begin with the file's own name up to the first dot: motion.h has
 * motion_run (a wh_played_t, see sim/played.h), motion_player_t (the memory that it needs), motion_begin and
 * the constants MOTION_WAFERS, MOTION_GRIPPERS and MOTION_MOTIONS. A name has the ASCII letters and digits of
 * the file's name. Other characters between two of them become one underscore, and a name that does not begin
 * with a letter gets run_ before it. If two different files with equal names, in small letters or capitals,
 * are included together, the second is an #error. Numbers are decimal, with enough digits to lose nothing, so
 * that every compiler reads them.
 */
#ifndef WH_PRINT_SEGMENTS_H
#define WH_PRINT_SEGMENTS_H

#include <stdio.h>

#include "../mcs/mcs.h"

/* The origin of a row: the record's command that asked for it, or WH_NONE; of a log its line. And how many
 * values the row has. */
typedef struct {
    int32_t command;
    size_t values;
} wh_segments_origin_t;

/* A run as the file has it. `run` points into this, into the record and into the layout. */
typedef struct {
    wh_played_t run;
    wh_played_row_t *rows;
    wh_segments_origin_t *origins; /* by row */
    wh_pose_t *wafers;             /* where they lie first */
    size_t row_count, row_capacity, origin_capacity;
    const wh_record_t *record; /* null: of a log */
    const char *source;        /* the script's or the log's path */
    const wh_layout_t *layout;
    const char *path; /* of the file, which gives the names */
    /* For a log: where its axes are, and which valves are open, after so many slices. */
    wh_real_t q[WH_AXES];
    uint32_t open;
    int64_t slices;
} wh_segments_t;

/* Makes the run that motion control has played with keeps_segments, and plays it. Returns null if it came to
 * the record's hash; else what was expected, a constant text. Call wh_segments_free in any case. Cost: that
 * of its slices. */
const char *wh_segments_make(wh_segments_t *segments, const wh_mcs_t *mcs, const char *path);

/* Begins a run that somebody outside of the program drives: a log's, against this layout. */
void wh_segments_begin(wh_segments_t *segments, const wh_layout_t *layout, const char *source,
                       const char *path);

/* Takes a slice of it, by the log's line. */
void wh_segments_keep(wh_segments_t *segments, const wh_command_t *command, size_t line);

/* Ends it, and plays it. Returns null if it came to this hash; else as wh_segments_make does. */
const char *wh_segments_end(wh_segments_t *segments, uint64_t hash);

void wh_segments_free(wh_segments_t *segments);

/* Writes a wh_segments_t that was made: see wh_file_write. */
bool wh_segments_write(void *segments, FILE *out);

#endif
