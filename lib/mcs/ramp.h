/* A STOP that slows down: a motion that is stopped goes on along its way, ever slower, until it stands.
 *
 * Along the planned way time passes at a rate that falls smoothly from 1 to 0. Speed, acceleration and jerk
 * of each axis stay within its limits, but for a thousandth, or within the part of them that the planned
 * motion uses of any axis. So shares hold, too. A motion whose own end comes first goes to its end. Where a
 * ramp at once would jerk too much, the motion goes on as planned for some slices before it.
 *
 * It uses no heap; a ramp is a plain struct that its owner may copy.
 */
#ifndef WH_MCS_RAMP_H
#define WH_MCS_RAMP_H

#include "../motion/track.h"

typedef struct {
    bool is_on;
    wh_real_t begin; /* s into the segment: where the ramp begins */
    int64_t delay;   /* slices before it, at full pace */
    int64_t slices;  /* of the ramp; 0: the segment goes to its end */
    int64_t played;  /* slices so far, those before the ramp, too */
} wh_ramp_t;

/* Plans the stop of a segment that the track plays. False: nothing moves, and it may stand at once.
 * `as_planned`: no axis has more than the planned motion has of it somewhere, for a wafer that must not slip.
 * Cost: as of playing the segment a few times. */
bool wh_ramp_begin(wh_ramp_t *ramp, const wh_track_t *track, bool as_planned);

/* Takes the track to the next slice. False: it stands, and no slice was used. */
bool wh_ramp_next(wh_ramp_t *ramp, wh_track_t *track);

#endif
