/* Wafers on the way: how fast a segment may carry them, and if friction alone holds them in it.
 *
 * A layout's `loaded` limits speed, acceleration and jerk of a carried wafer's centre in base. Each is
 * measured as differences of places one slice apart, or one millisecond where slices are shorter, from
 * standing to standing. A segment that goes beyond a limit is planned again with all limits of all axes for
 * a slower pace: speeds by the pace, accelerations by its square, jerks by its cube. So it goes the same
 * way.
 *
 * The wafer is taken to lie in the middle of its gripper.
 */
#ifndef WH_MCS_CARRYING_H
#define WH_MCS_CARRYING_H

#include "../layout/layout.h"
#include "../motion/track.h"

/* True if motion of this cell depends on what grippers carry: it has `loaded` or passive pads. Else the
 * functions below do nothing more than wh_track_begin. */
bool wh_carrying_matters(const wh_layout_t *layout);

/* To be called once a track is initialised: passive pads have no valve, and what stands for it is open for
 * ever. */
void wh_carrying_start(wh_track_t *track, const wh_layout_t *layout);

/* wh_track_begin of the segment as it may be played while the grippers of `loaded` (bits) carry wafers.
 * `slices` is how many were looked at for that. */
wh_status_t wh_carrying_begin(wh_track_t *track, const wh_layout_t *layout, const wh_segment_t *segment,
                              uint32_t loaded, int64_t *slices);

/* What passive pads do not hold. */
typedef struct {
    int32_t gripper;
    size_t axis;      /* of the machine: the one that asks for most of it */
    wh_real_t asked;  /* along the pads, mm/s^2 */
    wh_real_t held;   /* by friction in that moment, mm/s^2 */
    wh_real_t enough; /* an acceleration in any direction that these pads would hold; 0 or less: none */
} wh_carrying_slip_t;

/* Looks at a segment that the track has just begun, as the simulator will (grasp/hold.h), where a gripper of
 * `loaded` is passive. True if a wafer would slip; `slip` is then the moment at which most is missing. */
bool wh_carrying_slips(const wh_track_t *begun, const wh_layout_t *layout, uint32_t loaded,
                       wh_carrying_slip_t *slip);

#endif
