/* A way with via points: the axes move from point to point, and cut the corners as far as each point's
 * blend and the axes' limits allow.
 *
 * From one point to the next all axes go at once, each leg as a synchronised move (motion/move.h). A leg
 * begins before the one before it is over. While both run their positions add up, so that the arm does not
 * need to stop at the point between them. When the second leg begins and when the first one ends, the arm's
 * end is at most `blend` mm from the point, so the arm passes the point that close. The sum of both keeps
 * each axis's limits of speed, acceleration and jerk; this is checked phase by phase, not sampled. It takes
 * the longest of 64 overlaps, up to half of either leg, that keeps all this; if none does, the arm stops at
 * the point.
 *
 * All axes of the robot take part. The arm's end is that of R, or a SCARA's wrist. With two arms both ends
 * pass a point within the blend, each where that arm's R is at the point. A way is a plain struct without
 * pointers: copy it freely. All functions are reentrant.
 */
#ifndef WH_MOTION_VIA_H
#define WH_MOTION_VIA_H

#include "polar.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(via);

/* The most points between the ends. */
#define WH_VIA_POINTS 4
#define WH_VIA_LEGS (WH_VIA_POINTS + 1)

typedef struct {
    wh_real_t q[WH_CARRIER_AXES]; /* rad, mm */
    wh_real_t blend;              /* mm; 0: the arm stops there */
    /* For each arm: its R is at most this while one leg changes into the next, mm; 0: no limit. It is
     * unused for a SCARA. */
    wh_real_t reach[WH_POLAR_ARMS];
} wh_via_point_t;

/* A planned way. Only wh_via_plan and wh_via_plan_polar write it; callers may read its fields. Times are s
 * after the start. */
typedef struct {
    size_t axis_count, legs;
    wh_real_t begin[WH_VIA_LEGS], end[WH_VIA_LEGS];
    wh_real_t at[WH_VIA_LEGS + 1][WH_CARRIER_AXES];   /* begins and ends of legs */
    wh_real_t times[WH_VIA_LEGS][WH_CARRIER_AXES][3]; /* of each profile alone: jerk, rise and duration */
} wh_via_t;

/* Plans the way from axes `from` by these points to axes `to`, at rest at both ends. The robot must pass
 * wh_robot_validate, all points wh_robot_check_travel. Errors, which leave *via unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_OUT_OF_RANGE  no point, more than WH_VIA_POINTS, or a blend or a reach below 0
 *   WH_STATUS_NOT_FINITE
 *   WH_STATUS_BAD_LIMITS    see wh_profile_plan
 * Cost: up to 100 us for each point. */
wh_status_t wh_via_plan(wh_via_t *via, const wh_robot_t *robot, const wh_real_t from[WH_ROBOT_AXES],
                        const wh_via_point_t points[], size_t count, const wh_real_t to[WH_ROBOT_AXES])
    WH_SYMBOL(wh_via_plan);

/* Plans a way for a robot with other axes. A robot that wh_polar_is_sound does not pass gives
 * WH_STATUS_OUT_OF_RANGE, too. Cost: linear in the axes. */
wh_status_t wh_via_plan_polar(wh_via_t *via, const wh_polar_t *robot, const wh_real_t from[],
                              const wh_via_point_t points[], size_t count, const wh_real_t to[])
    WH_SYMBOL(wh_via_plan_polar);

/* s, never negative. */
static inline wh_real_t wh_via_duration(const wh_via_t *via) {
    return via->end[via->legs - 1];
}

/* Writes the planned axes at `t` seconds after the start: exactly `from` for t <= 0 (and NaN), exactly `to`
 * from the duration on. No pointer may be null. Cost: about 200 ns. */
void wh_via_at(const wh_via_t *via, wh_real_t t, wh_real_t q[]) WH_SYMBOL(wh_via_at);

WH_HEADER_END

#endif
