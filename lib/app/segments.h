/* `run --segments FILE`: the motion that was played, as C source that a firmware test compiles and plays
 * again.
 *
 * The file defines, all static const and named played_*: machine, slice_us, segments[], segment_count, config
 * (of the grasp table), wafers[] (base_from_wafer at the start), wafer_count, slices and hash (wh_grasp_hash
 * at the end). Numbers are hexadecimal, so that no digit is lost. tests/end_to_end/segments plays one.
 */
#ifndef WH_APP_SEGMENTS_H
#define WH_APP_SEGMENTS_H

#include "../mcs/mcs.h"

/* Writes `path` anew, by way of a file beside it that is renamed when it is complete. Needs a run with
 * keep_segments. 0, or -1 with errno set, the old file being as it was. */
int wh_segments_write(const wh_mcs_t *mcs, const char *path);

#endif
