/* `run --segments FILE`: the run that was played, as C source that a firmware test compiles and plays again.
 *
 * The file is C99 and C++11. Its names begin with the file's own name up to the first dot: motion.h has
 * motion_run (a wh_played_t, see sim/played.h) and the constants MOTION_WAFERS and MOTION_GRIPPERS. A name
 * has the ASCII letters and digits of the file's name. Other characters between two of them become one
 * underscore, and a name that does not begin with a letter gets run_ before it. If two different files with
 * equal names, in small letters or capitals, are included together, the second is an #error. Numbers are
 * decimal, with enough digits to lose nothing, so that every compiler reads them.
 */
#ifndef WH_APP_SEGMENTS_H
#define WH_APP_SEGMENTS_H

#include <stdio.h>

#include "../mcs/mcs.h"

/* The run, played with keep_segments, and the path of the file, which gives the names. */
typedef struct {
    const wh_mcs_t *mcs;
    const char *path;
} wh_segments_t;

/* Writes a wh_segments_t: see wh_file_write. Without a cell nothing is written. */
bool wh_segments_write(void *segments, FILE *out);

#endif
