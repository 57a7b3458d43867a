/* Beams of light across the way of a wafer, and the instants at which moving bodies break and free them.
 *
 * A beam is a straight line from an emitter to a receiver. It is broken by flat bodies: a wafer, by its
 * true rim, and a blade, by its outline. A gripper carries both. Its motion within a slice is that of swept
 * checking (grasp/grasp.h): its position is linear, its rotation the normalised quaternion between the two
 * ends. So the instants do not depend on how a motion is cut into slices, if the motion itself does not.
 *
 * Coordinates are in base, in mm; parts of a slice run from 0, its begin, to 1, its end. Numbers are double
 * also in a library of floats. It uses no heap and no state, and has equal bits on every machine.
 */
#ifndef WH_ALIGN_BEAM_H
#define WH_ALIGN_BEAM_H

#include "../math/pose.h"
#include "centring.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(beam);

typedef struct {
    double x, y, z;    /* a point of it */
    double ex, ey, ez; /* its direction, a unit vector */
    double low, high;  /* its ends, along the direction from the point; -1e4 to 1e4 */
} wh_beam_t;

/* A beam at (x, y) of a station, upright in the station's frame, from `low` to `high` over the station's z
 * = 0. The pose must be valid; nothing is checked. */
wh_beam_t wh_beam_at(const wh_pose_t *base_from_station, double x, double y, double low, double high)
    WH_SYMBOL(wh_beam_at);

/* Returns WH_OK, WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_FINITE, or WH_STATUS_OUT_OF_RANGE: coordinates are
 * beyond 1e5, the direction is no unit vector to 1e-5, or `high` is not above `low`. */
wh_status_t wh_beam_validate(const wh_beam_t *beam) WH_SYMBOL(wh_beam_validate);

#define WH_OUTLINE_POINTS 24

/* A blade from above: a closed polygon in its gripper's plane z = 0, in either direction. */
typedef struct {
    int32_t count;                                     /* 3 to WH_OUTLINE_POINTS; 0: no blade */
    double x[WH_OUTLINE_POINTS], y[WH_OUTLINE_POINTS]; /* gripper's frame, -1e3 to 1e3 */
} wh_blade_outline_t;

/* Returns WH_OK, WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_FINITE or WH_STATUS_OUT_OF_RANGE. */
wh_status_t wh_blade_outline_validate(const wh_blade_outline_t *outline) WH_SYMBOL(wh_blade_outline_validate);

/* A gripper's motion within a slice. The poses are the caller's, and must exist while this is used. */
typedef struct {
    const wh_pose_t *begin, *end;
    double w, x, y, z; /* the turn from begin to end as a unit quaternion */
    double angle;      /* the largest angle of that motion per slice, rad; negative: not followed */
} wh_slice_motion_t;

/* A gripper that turns by more than 3 rad in a slice is not followed: it is at its end pose during the
 * whole slice. */
wh_slice_motion_t wh_slice_motion_between(const wh_pose_t *begin, const wh_pose_t *end)
    WH_SYMBOL(wh_slice_motion_between);

/* A body that breaks beams. */
typedef struct {
    wh_slice_motion_t motion;            /* the motion of its gripper */
    const wh_pose_t *gripper_from_wafer; /* with `rim`; null: the frames are equal */
    const wh_rim_t *rim;                 /* of a wafer, which wh_rim_validate accepts; or null and */
    const wh_blade_outline_t *outline;   /* of a blade, with a count above 0 */
} wh_shade_t;

/* The most bodies that are evaluated together. */
#define WH_SHADES 16

/* The next change of a beam from *part on. At the call *broken is the beam's state before *part; if the
 * state at *part differs, the change is exactly there. True: *part is the first instant of the other state,
 * exact to 1e-9 mm of the bodies' motion, and *broken is inverted. False: nothing changes up to the slice's
 * end; both are unchanged. A beam that several bodies break is free when all have left it.
 *
 * Two changes within 1e-6 mm of a motion may be missed. Two changes within 1/2000 of a slice may also be
 * missed next to an edge along which the beam runs, and for a body that turns by more than 0.1 rad in the
 * slice. A body whose plane is inclined to the beam's by more than 60 degrees at either end of the slice
 * breaks no beam. There may be at most WH_SHADES; arguments must be valid, 0 <= *part <= 1. Cost: 0.2 us
 * for each body that is not near, about 25 us for one that crosses, at most ten times that. */
bool wh_beam_next(const wh_beam_t *beam, const wh_shade_t *shades, size_t count, double *part, bool *broken)
    WH_SYMBOL(wh_beam_next);

/* A latch as a crossing for wh_centring_solve: the point of a gripper's plane z = 0 that is in the beam at
 * a part of the slice, and the speed of the beam over it. `beam` and `edge` of the crossing are left
 * unchanged. The beam and the gripper's pose are those that a controller assumes; the slice's length must
 * be above 0. False, with the crossing unchanged: the plane is inclined by more than 60 degrees. */
bool wh_beam_crossing(const wh_beam_t *beam, const wh_slice_motion_t *motion, double part, double slice_s,
                      wh_crossing_t *crossing) WH_SYMBOL(wh_beam_crossing);

WH_HEADER_END

#endif
