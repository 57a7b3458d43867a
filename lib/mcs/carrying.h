/* Wafers on the way: how fast a segment may carry them, and whether friction alone holds them.
 *
 * A layout's `loaded` limits speed, acceleration and jerk of a carried wafer's centre in base. Each is
 * measured as differences of places one slice apart, or one millisecond apart if slices are shorter, from
 * rest to rest. A segment that goes beyond a limit is planned again with all limits of all axes for a
 * slower pace: speeds by the pace, accelerations by its square, jerks by its cube. So the path stays the
 * same.
 *
 * The wafer is assumed to lie in the middle of its gripper.
 */
#ifndef WH_MCS_CARRYING_H
#define WH_MCS_CARRYING_H

#include "../layout/layout.h"
#include "../motion/slow.h"

/* True if the motion of this cell depends on what the grippers carry: it has `loaded` or passive pads.
 * Otherwise the functions below only call wh_track_begin. */
bool wh_carrying_matters(const wh_layout_t *layout);

/* Call it after a track is initialised. Passive pads have no valve; the entry in its place is always
 * open. */
void wh_carrying_start(wh_track_t *track, const wh_layout_t *layout);

/* True for a motion with the axes' own limits. */
bool wh_carrying_is_full(const wh_slowness_t *slowness);

/* wh_track_begin for the segment with these parts of the limits, slowed as needed while the grippers of
 * `loaded` (bits) carry wafers: the slowness, whose pace is 1 at first, gets the pace. `slices` counts the
 * slices that were looked at. */
wh_status_t wh_carrying_begin(wh_track_t *track, const wh_layout_t *layout, const wh_segment_t *segment,
                              wh_slowness_t *slowness, uint32_t loaded, int64_t *slices);

/* An acceleration that passive pads do not hold. */
typedef struct {
    int32_t gripper;
    size_t axis;      /* of the machine: the axis that needs most of it */
    wh_real_t asked;  /* along the pads, mm/s^2 */
    wh_real_t held;   /* held by friction at that moment, mm/s^2 */
    wh_real_t enough; /* an acceleration in any direction that these pads would hold; 0 or less: none */
} wh_carrying_slip_t;

/* Checks a segment that the track has just begun, as the simulator will (grasp/hold.h), for the passive
 * grippers of `loaded`. True if a wafer would slip; `slip` then tells the moment at which most friction is
 * missing. */
bool wh_carrying_slips(const wh_track_t *begun, const wh_layout_t *layout, uint32_t loaded,
                       wh_carrying_slip_t *slip);

#endif
