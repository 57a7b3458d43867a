/* Tracks: segments played slice by slice, on a host or on a microcontroller.
 *
 * The caller (a Lua pattern, a recorded list) hands over one segment at a time. The track plans a segment
 * when it begins, and then yields axes and valves for each slice until it is over. A segment ends on the
 * first slice at or after its duration (to rounding). There its axes have exactly the target's bits, so the
 * next segment starts from a clean state. A segment without length (below WH_PROFILE_TINY on every axis)
 * takes no slice and moves no axis. Before each slice the caller reports which grippers' sensors are on.
 *
 *     wh_track_begin(&track, &segment);
 *     while ((state = wh_track_next(&track, sensors)) == WH_TRACK_MOVING) { use track.axes, track.valves }
 *
 * It uses no heap; a track is a plain struct that its owner may copy.
 */
#ifndef WH_MOTION_TRACK_H
#define WH_MOTION_TRACK_H

#include "line.h"
#include "machine.h"
#include "polar.h"
#include "via.h"
#include "way.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(track);

typedef enum WH_FOUR_BYTES {
    WH_SEGMENT_AXES,   /* axes go to target[], synchronised, each at rest at both ends */
    WH_SEGMENT_LINE,   /* an end-effector moves by `travel` along a straight line at constant heading */
    WH_SEGMENT_VALVES, /* valves change; lasts one slice */
    WH_SEGMENT_DWELL,  /* everything stands still for `seconds`, rounded up to whole slices */
    WH_SEGMENT_SENSOR, /* stand still until the sensor of `gripper` is on, at most `seconds` */
    WH_SEGMENT_WAY,    /* a robot's axes move to target[]; R comes in to `reach` while it turns */
    WH_SEGMENT_VIA     /* a robot's axes move to target[] via `points` */
} wh_segment_kind_t;

typedef struct {
    wh_segment_kind_t kind;
    wh_real_t target[WH_AXES];   /* AXES, WAY: every axis of the machine, rad or mm */
    wh_vec3_t travel;            /* LINE: base, mm */
    wh_real_t speed;             /* LINE: at most this, mm/s; 0: the axes' own limits */
    wh_real_t acceleration;      /* LINE: at most this, mm/s^2; 0: the axes' own limits */
    wh_real_t seconds;           /* DWELL, SENSOR: 0 to 1e6 */
    int32_t valves[WH_GRIPPERS]; /* VALVES: WH_VALVE_OPEN, WH_VALVE_CLOSED; WH_NONE: unchanged */
    /* SENSOR; with several robots or arms, LINE and WAY: any gripper on the one that moves, WH_NONE: the
     * first */
    int32_t gripper;
    wh_real_t reach; /* WAY: mm, see motion/way.h */
    /* VIA: the caller's, read by wh_track_begin alone; see motion/via.h */
    const wh_via_point_t *points;
    size_t point_count;
    wh_real_t reach2; /* WAY: a second arm's */
} wh_segment_t;

typedef enum WH_FOUR_BYTES {
    WH_TRACK_MOVING,   /* axes and valves are those of one more slice */
    WH_TRACK_DONE,     /* the segment is over; no slice was used by this call */
    WH_TRACK_TIMED_OUT /* SENSOR: it did not turn on; no slice was used by this call */
} wh_track_state_t;

/* The data that a track needs for ways; see wh_track_take_ways. */
typedef struct {
    wh_status_t (*plan)(wh_way_t *way, const wh_polar_t *robot, const wh_real_t from[], const wh_real_t to[],
                        const wh_real_t reach[WH_POLAR_ARMS]);
    void (*at)(const wh_way_t *way, wh_real_t t, wh_real_t q[]);
} wh_ways_t;

/* The data that a track needs for via points; see wh_track_take_vias. */
typedef struct {
    wh_status_t (*plan)(wh_via_t *via, const wh_polar_t *robot, const wh_real_t from[],
                        const wh_via_point_t points[], size_t count, const wh_real_t to[]);
    void (*at)(const wh_via_t *via, wh_real_t t, wh_real_t q[]);
} wh_vias_t;

/* Callers read axes, valves and slice; the rest is internal. */
typedef struct {
    const wh_machine_t *machine; /* the caller's, which must outlive the track */
    int64_t slice_us;
    int64_t slice; /* slices yielded since wh_track_init: utime = slice * slice_us */
    wh_real_t axes[WH_AXES];
    int32_t valves[WH_GRIPPERS];
    wh_segment_t segment;
    int64_t segment_slices; /* the number of slices of the running segment */
    int64_t segment_slice;  /* the number of those yielded so far */
    union {
        wh_move_t move;
        wh_line_t line;
        wh_chain_line_t chain_line; /* LINE of a robot with a carrier */
        wh_way_t way;
        wh_via_t via;
    } plan;
    const wh_ways_t *ways; /* NULL: segments of kind WAY are refused */
    const wh_vias_t *vias; /* NULL: those of kind VIA are */
    uint32_t mark;         /* WH_TRACK_MARK once wh_track_init has set it up */
} wh_track_t;

/* A track without this mark was never initialised: it takes no segment, and has no slice. See WH_GRASP_MARK
 * for what that shows and what it does not. */
#define WH_TRACK_MARK UINT32_C(0x3c91d0a7)

/* Starts at rest at home (wh_machine_home), all valves closed. `slice_us` is 1 to 1e6. Refuses
 * null pointers, an invalid machine and a slice out of range; the track is then unchanged. */
wh_status_t wh_track_init(wh_track_t *track, const wh_machine_t *machine, int64_t slice_us)
    WH_SYMBOL(wh_track_init);

/* After this call the track accepts segments of kind WAY. Without it a firmware does not link the code for
 * them. `track` must not be null, and initialised. */
void wh_track_take_ways(wh_track_t *track) WH_SYMBOL(wh_track_take_ways);

/* After this call the track accepts segments of kind VIA. */
void wh_track_take_vias(wh_track_t *track) WH_SYMBOL(wh_track_take_vias);

/* A segment that changes nothing, for the caller to fill in: DWELL of 0 s, all valves WH_NONE, target at the
 * track's axes. */
wh_segment_t wh_track_blank(const wh_track_t *track) WH_SYMBOL(wh_track_blank);

/* Plans a segment from the track's present position. A segment that is still running ends there, at rest
 * from one slice to the next. Errors, which leave the track unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_INITIALISED the track
 *   WH_STATUS_NOT_FINITE      a target, travel, speed or time is NaN or infinite
 *   WH_STATUS_BAD_SEGMENT     a WAY or VIA of a track that takes none, a WAY of a SCARA, or one that moves
 *                             other axes than the robot's own; a VIA's points, as wh_via_plan says; a
 *                             robot's gripper that is on a chuck; kind, gripper, valve, speed, acceleration
 *                             or seconds out of range; a motion of over 1e6 s
 *   WH_STATUS_LIMIT_EXCEEDED  an axis other than R or the elbow outside its travel, at a VIA's point, too
 *   WH_STATUS_OUT_OF_REACH    R or the elbow outside its travel, at the target or anywhere on a line or at a
 *                             VIA's point; or a WAY's reach
 *   WH_STATUS_NOT_ALONG_ARM   a LINE not along an arm without a wrist
 *   WH_STATUS_BAD_LIMITS      limits too extreme to plan with: see wh_profile_plan
 * Cost: about 1 us for a move, 2 us for a line, 40 us for a way and for a SCARA's line, 300 us with via
 * points.
 */
wh_status_t wh_track_begin(wh_track_t *track, const wh_segment_t *segment) WH_SYMBOL(wh_track_begin);

/* One slice of the running segment. Bit g of `sensors` is set if gripper g's vacuum sensor is on. If the
 * awaited sensor is on already, no slice is used. After the segment's end each call returns the end again.
 * A track that was never initialised is at its end, DONE. Null is not checked. Cost: all axes of a
 * profile, or a square root and an arc tangent on a line. */
wh_track_state_t wh_track_next(wh_track_t *track, uint32_t sensors) WH_SYMBOL(wh_track_next);

/* Jumps to the running segment's end, as if all its slices had been played: a way to check a pattern's reach
 * without playing it. `slice` stays. One that was never initialised stays as it is. */
void wh_track_skip(wh_track_t *track) WH_SYMBOL(wh_track_skip);

/* How long the running segment moves, s, without the rounding up to slices; 0: it moves no axis. The track
 * must have begun a segment, or none. */
wh_real_t wh_track_seconds(const wh_track_t *track) WH_SYMBOL(wh_track_seconds);

/* Writes the axes that the running segment moves as they are `seconds` after its begin: a way to go along it
 * at another pace, such as to slow down. Before its begin they are as they were, behind its end as there. The
 * track stays, and of the others in `axes` none is written. Cost: as of wh_track_next. */
void wh_track_place(const wh_track_t *track, wh_real_t seconds, wh_real_t axes[WH_AXES])
    WH_SYMBOL(wh_track_place);

WH_HEADER_END

#endif
