/* A motion of a played run, read from its rows. */
#ifndef WH_SIM_PLAYED_INTERNAL_H
#define WH_SIM_PLAYED_INTERNAL_H

#include "played.h"

typedef struct {
    wh_segment_t segment;
    wh_via_point_t points[WH_VIA_POINTS]; /* what segment.points points to */
    wh_slowness_t slowness;
    bool is_slow;
} wh_played_plan_t;

/* Reads the motion, or the PLACE as one of axes, that begins with row *row, for a track that stands where it
 * begins. *row is then the one after its last. Returns WH_OK, or WH_STATUS_OUT_OF_RANGE for axes that the
 * machine does not have, or for values and points that are too few or too many. */
wh_status_t wh_played_read(const wh_played_t *run, const wh_track_t *track, size_t *row,
                           wh_played_plan_t *plan) WH_SYMBOL(wh_played_read);

/* Returns WH_OK if the rows are in order and within the run, and nothing goes on that did not begin;
 * otherwise WH_STATUS_OUT_OF_RANGE. Cost: linear. */
wh_status_t wh_played_check_rows(const wh_played_t *run) WH_SYMBOL(wh_played_check_rows);

#endif
