/* Slow motions: a track's segment, planned with a part of all axes' limits.
 *
 * A segment keeps its path, and takes longer: with a pace of 0.5 every axis has half of its speed, a quarter
 * of its acceleration and an eighth of its jerk. Shares of speed and acceleration come on top of the pace. A
 * firmware that calls no function of this header does not link its code.
 */
#ifndef WH_MOTION_SLOW_H
#define WH_MOTION_SLOW_H

#include "track.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(slow);

/* The parts of all axes' limits that a motion may use, above 0 to 1; the jerk's is the acceleration's. */
typedef struct {
    wh_real_t speed, acceleration;
} wh_motion_share_t;

/* Each limit is that of the axis, times its share, times the pace (above 0 to 1): once for a speed, twice for
 * an acceleration, three times for a jerk. Doors keep their limits. */
typedef struct {
    wh_motion_share_t share;
    wh_real_t pace;
} wh_slowness_t;

/* Room for a machine with such limits: working memory, from the caller. Its content does not matter. */
typedef struct {
    wh_machine_t machine;
    wh_carrier_t carriers[2 * WH_AXES / WH_ROBOT_AXES];
} wh_slow_t;

/* wh_track_begin with these limits. A LINE's own speed and acceleration count as they are given. The track
 * keeps its machine, and needs neither `slowness` nor `room` afterwards. It refuses what wh_track_begin
 * refuses; WH_STATUS_OUT_OF_RANGE for a share or a pace that is not above 0 and at most 1;
 * WH_STATUS_NULL_ARGUMENT for a null pointer; WH_STATUS_NOT_INITIALISED. The track is then unchanged. Cost:
 * wh_track_begin, and a copy of the machine. */
wh_status_t wh_track_begin_slowly(wh_track_t *track, const wh_segment_t *segment,
                                  const wh_slowness_t *slowness, wh_slow_t *room)
    WH_SYMBOL(wh_track_begin_slowly);

WH_HEADER_END

#endif
