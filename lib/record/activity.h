/* Counts, slice by slice while motion control plays, how a run's time is spent and what is busy when.
 *
 * Every slice belongs to one share, so the shares of a run add up to its slices. A log also keeps
 * intervals: when each robot, each gripper's chuck, wafer and valve, and each door was busy, and with what.
 * If something is busy with one thing over several segments or commands, it has one interval.
 */
#ifndef WH_RECORD_ACTIVITY_H
#define WH_RECORD_ACTIVITY_H

#include "../motion/track.h"
#include "../sim/slice.h"

typedef enum {
    WH_SHARE_LOADED,   /* motion while the moving parts carry a wafer */
    WH_SHARE_EMPTY,    /* motion without a wafer */
    WH_SHARE_VACUUM,   /* standing still for vacuum: a station's vacuum_delay, then until the sensor is on */
    WH_SHARE_HANDOVER, /* standing still while valves switch, not while they keep their positions */
    WH_SHARE_WAITING   /* standing still for anything else, such as WAIT */
} wh_share_t;

#define WH_SHARES 5

/* The kinds of things that are busy. */
typedef enum {
    WH_BUSY_ROBOT, /* `what` is 1 + the share of its time; only a chuck turns: not busy */
    WH_BUSY_CHUCK, /* turns, and `what` is 1 + WH_SHARE_LOADED or WH_SHARE_EMPTY */
    WH_BUSY_WAFER, /* a gripper holds wafer `what` - 1 */
    WH_BUSY_VALVE, /* a gripper's valve is open, vacuum on; `what` is 1 */
    WH_BUSY_DOOR   /* moves, and `what` is 1 + WH_SHARE_EMPTY */
} wh_busy_t;

/* The order: the robots, then a chuck, a wafer and a valve for each gripper, then the doors. */
#define WH_BUSY_ROBOTS (WH_AXES / WH_ROBOT_AXES)
#define WH_RESOURCES (WH_BUSY_ROBOTS + 3 * WH_GRIPPERS + WH_DOORS)

typedef struct {
    wh_busy_t who;
    int32_t gripper; /* index from 0; a door's or a robot's index for those kinds */
    int32_t what;    /* never 0 */
    /* Slices: busy from the end of `begin` to the end of `end`, which is later. A wafer is held, and a
     * valve open, from the end of the first slice with that state: the time of its event. */
    int64_t begin, end;
} wh_busy_span_t;

/* The demands of a segment on the machine, for all of its slices. */
typedef struct {
    wh_share_t share;  /* when nothing moves */
    bool moves, robot; /* a robot moves or, when nothing does, stands still for `share` */
    uint32_t carried;  /* bit g: the wafer of gripper g moves along */
    uint32_t doors;    /* bit d: door d moves */
    /* With several robots, for each: 1 + WH_SHARE_EMPTY if it moves, 1 + its share if it stands still for
     * one; 0: neither. If all are 0 but `robot` is not, the robots that moved last stand still. */
    uint8_t robots[WH_BUSY_ROBOTS];
} wh_task_t;

/* Zero it before a run. Read `shares`, and `intervals` once it has ended. */
typedef struct {
    int64_t shares[WH_SHARES]; /* slices */
    bool drops_intervals;
    wh_busy_span_t *intervals; /* in the order in which they ended */
    size_t interval_count, interval_capacity;
    struct {
        int32_t what; /* 0: not busy */
        int64_t begin;
    } open[WH_RESOURCES];
    struct {
        bool is_known;
        wh_task_t task;
        wh_share_t share;
        int32_t held[WH_GRIPPERS], valves[WH_GRIPPERS];
        uint32_t went; /* bit r: robot r is one of several that moved last */
    } last;            /* the last counted slice: nothing is evaluated again while nothing changes */
} wh_activity_t;

/* The task of a segment that will begin at the track's present state. `for_vacuum` tells a dwell for vacuum
 * from others. */
wh_task_t wh_activity_task(const wh_track_t *track, const wh_segment_t *segment, bool for_vacuum);

/* The task while these axes move; `share` if none moves. */
wh_task_t wh_activity_motion(const wh_machine_t *machine, const bool moving[WH_AXES], wh_share_t share);

/* Narrows a task of several robots to those that have one of these axes, bit a for axis a: they stand still
 * for the task's share. It changes nothing if the task is a motion. Without such axes no robot is busy with
 * the task. */
void wh_activity_narrow(wh_task_t *task, const wh_machine_t *machine, uint32_t axes);

/* Counts slice command->seq, which `state` answers, and returns its share. It reads the command's `seq` and
 * valves only. Cost: 4 ns for two grippers. */
wh_share_t wh_activity_count(wh_activity_t *activity, const wh_machine_t *machine, const wh_task_t *task,
                             const wh_command_t *command, const wh_state_t *state);

/* Counts so many slices more that are like the last counted one. */
void wh_activity_repeat(wh_activity_t *activity, int64_t slices);

/* The share of a slice of this task that `state` answers. */
wh_share_t wh_activity_share(const wh_task_t *task, const wh_state_t *state);

/* Ends all open intervals with slice `slice`. */
void wh_activity_end(wh_activity_t *activity, int64_t slice);

/* The resource of an interval, below WH_RESOURCES: 0 is the robot, or the first one. */
size_t wh_activity_resource(const wh_busy_span_t *interval);

/* Frees the intervals. */
void wh_activity_free(wh_activity_t *activity);

#endif
