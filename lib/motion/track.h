/* Tracks: segments played slice by slice, on a host or on a microcontroller.
 *
 * The caller (a Lua pattern, a recorded list) hands over one segment at a time. The track plans a segment
 * when it begins, and then yields axes and valves for each slice until it is over. A segment ends on the
 * first slice at or after its duration (to rounding). There its axes have exactly the target's bits, so the
 * next segment starts from a clean state. A segment without length (below WH_PROFILE_TINY on every axis)
 * takes no slice and moves nothing. Before each slice the caller reports which grippers' sensors are on.
 *
 *     wh_track_begin(&track, &segment);
 *     while ((state = wh_track_next(&track, sensors)) == WH_TRACK_MOVING) { use track.axes, track.valves }
 *
 * No heap; a track is a plain struct that its owner may copy.
 */
#ifndef WH_MOTION_TRACK_H
#define WH_MOTION_TRACK_H

#include "line.h"
#include "machine.h"
#include "way.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(track);

typedef enum WH_FOUR_BYTES {
    WH_SEGMENT_AXES,   /* axes go to target[], synchronised, each at rest at both ends */
    WH_SEGMENT_LINE,   /* the end-effector goes by `travel` along a straight line at constant heading */
    WH_SEGMENT_VALVES, /* valves change; lasts one slice */
    WH_SEGMENT_DWELL,  /* everything stands still for `seconds`, rounded up to whole slices */
    WH_SEGMENT_SENSOR, /* stand still until the sensor of `gripper` is on, at most `seconds` */
    WH_SEGMENT_WAY     /* the robot's axes go to target[], R coming in to `reach` while theta and yaw turn */
} wh_segment_kind_t;

typedef struct {
    wh_segment_kind_t kind;
    wh_real_t target[WH_AXES];   /* AXES, WAY: every axis of the machine, rad or mm */
    wh_vec3_t travel;            /* LINE: base, mm */
    wh_real_t speed;             /* LINE: at most this, mm/s; 0: the axes' own limits */
    wh_real_t acceleration;      /* LINE: at most this, mm/s^2; 0: the axes' own limits */
    wh_real_t seconds;           /* DWELL, SENSOR: 0 to 1e6 */
    int32_t valves[WH_GRIPPERS]; /* VALVES: WH_VALVE_OPEN, WH_VALVE_CLOSED; WH_NONE: unchanged */
    int32_t gripper;             /* SENSOR */
    wh_real_t reach;             /* WAY: mm, see motion/way.h */
} wh_segment_t;

typedef enum WH_FOUR_BYTES {
    WH_TRACK_MOVING,   /* axes and valves are those of one more slice */
    WH_TRACK_DONE,     /* the segment is over; no slice was used by this call */
    WH_TRACK_TIMED_OUT /* SENSOR: it did not come on; no slice was used by this call */
} wh_track_state_t;

/* What a track needs for ways; see wh_track_take_ways. */
typedef struct {
    wh_status_t (*plan)(wh_way_t *way, const wh_robot_t *robot, const wh_real_t from[WH_ROBOT_AXES],
                        const wh_real_t to[WH_ROBOT_AXES], wh_real_t reach);
    void (*at)(const wh_way_t *way, wh_real_t t, wh_real_t q[WH_ROBOT_AXES]);
} wh_ways_t;

/* Callers read axes, valves and slice; the rest is the track's own. */
typedef struct {
    const wh_machine_t *machine; /* the caller's, which must outlive the track */
    int64_t slice_us;
    int64_t slice; /* slices yielded since wh_track_init: utime = slice * slice_us */
    wh_real_t axes[WH_AXES];
    int32_t valves[WH_GRIPPERS];
    wh_segment_t segment;
    int64_t segment_slices; /* how many slices the running segment takes */
    int64_t segment_slice;  /* how many of them were yielded */
    union {
        wh_move_t move;
        wh_line_t line;
        wh_way_t way;
    } plan;
    const wh_ways_t *ways; /* NULL: segments of kind WAY are refused */
} wh_track_t;

/* Starts at rest at home (wh_robot_t.home, chucks at 0), all valves closed. `slice_us` is 1 to 1e6. Refuses
 * null pointers, an invalid machine and a slice out of range; the track is then unchanged. */
wh_status_t wh_track_init(wh_track_t *track, const wh_machine_t *machine, int64_t slice_us)
    WH_SYMBOL(wh_track_init);

/* From now on the track takes segments of kind WAY. Without it a firmware does not link what they need.
 * `track` must not be null, and initialised. */
void wh_track_take_ways(wh_track_t *track) WH_SYMBOL(wh_track_take_ways);

/* A segment that changes nothing, for the caller to fill in: DWELL of 0 s, all valves WH_NONE, target at the
 * track's axes. */
wh_segment_t wh_track_blank(const wh_track_t *track) WH_SYMBOL(wh_track_blank);

/* Plans a segment from where the track stands; one that is still running is given up there, at rest from one
 * slice to the next. Refused, the track unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_FINITE      a target, travel, speed or time is NaN or infinite
 *   WH_STATUS_BAD_SEGMENT     a WAY of a track that takes none, or one that turns a chuck; kind, gripper,
 *                             valve, speed, acceleration or seconds out of range; a motion of over 1e6 s
 *   WH_STATUS_LIMIT_EXCEEDED  an axis other than R outside its travel
 *   WH_STATUS_OUT_OF_REACH    R outside its travel, at the target or anywhere on a line; or a WAY's reach
 *   WH_STATUS_BAD_LIMITS      limits too extreme to plan with: see wh_profile_plan
 * Cost: about 1 us for a move, 2 us for a line, 40 us for a way.
 */
wh_status_t wh_track_begin(wh_track_t *track, const wh_segment_t *segment) WH_SYMBOL(wh_track_begin);

/* One slice of the running segment. Bit g of `sensors` says that gripper g's vacuum sensor is on. If the
 * awaited sensor is on already, no slice is used. After the segment's end each call returns the end again.
 * `track` is not checked. Cost: all axes of a profile, or a square root and an arc tangent on a line. */
wh_track_state_t wh_track_next(wh_track_t *track, uint32_t sensors) WH_SYMBOL(wh_track_next);

/* Jumps to the running segment's end, as if all its slices had been played: a way to check a pattern's reach
 * without playing it. `slice` stays. */
void wh_track_skip(wh_track_t *track) WH_SYMBOL(wh_track_skip);

WH_HEADER_END

#endif
