/* What a run's time goes into, and who is busy when: counted slice by slice as the motion control software
 * plays.
 *
 * Every slice belongs to one share, so the shares of a run add up to its slices. Besides, a log keeps, for
 * each robot, for each gripper's chuck, wafer and valve and for each door, from when to when it was busy and
 * with what. Who is busy with the same thing over several segments or commands has one interval.
 */
#ifndef WH_RECORD_ACTIVITY_H
#define WH_RECORD_ACTIVITY_H

#include "../motion/track.h"
#include "../sim/slice.h"

typedef enum {
    WH_SHARE_LOADED,   /* motion with a wafer on what moves */
    WH_SHARE_EMPTY,    /* motion without */
    WH_SHARE_VACUUM,   /* standing still for vacuum: a station's vacuum_delay, then until the sensor is on */
    WH_SHARE_HANDOVER, /* standing still while valves switch; one that stays as it is does not */
    WH_SHARE_WAITING   /* standing still for anything else, such as WAIT */
} wh_share_t;

#define WH_SHARES 5

/* Whose time an interval is of. */
typedef enum {
    WH_BUSY_ROBOT, /* `what` is 1 + the share that its time goes into; only a chuck turns: not busy */
    WH_BUSY_CHUCK, /* turns, and `what` is 1 + WH_SHARE_LOADED or WH_SHARE_EMPTY */
    WH_BUSY_WAFER, /* a gripper holds wafer `what` - 1 */
    WH_BUSY_VALVE, /* a gripper's valve is open, vacuum on; `what` is 1 */
    WH_BUSY_DOOR   /* moves, and `what` is 1 + WH_SHARE_EMPTY */
} wh_busy_t;

/* The robots, then a chuck, a wafer and a valve for each gripper, then the doors. */
#define WH_BUSY_ROBOTS (WH_AXES / WH_ROBOT_AXES)
#define WH_RESOURCES (WH_BUSY_ROBOTS + 3 * WH_GRIPPERS + WH_DOORS)

typedef struct {
    wh_busy_t who;
    int32_t gripper; /* index from 0, of a door the door's, of a robot the robot's */
    int32_t what;    /* never 0 */
    /* Slices: busy from the end of `begin` to the end of `end`, which is later. A wafer is held, and a valve
     * open, from the end of the first slice that says so: at the time of its event. */
    int64_t begin, end;
} wh_busy_span_t;

/* What a segment asks of the machine, for all of its slices. */
typedef struct {
    wh_share_t share;  /* when nothing moves */
    bool moves, robot; /* a robot goes or, when nothing does, stands for `share` */
    uint32_t carried;  /* bit g: what gripper g holds goes along */
    uint32_t doors;    /* bit d: door d goes */
    /* Of several robots, for each: 1 + WH_SHARE_EMPTY if it goes, 1 + what it stands for; 0: neither. If all
     * are 0 but `robot` is not, those stand that went last. */
    uint8_t robots[WH_BUSY_ROBOTS];
} wh_task_t;

/* To be zeroed before a run. Read `shares` and, once it was ended, `intervals`. */
typedef struct {
    int64_t shares[WH_SHARES]; /* slices */
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
        uint32_t went; /* bit r: of several robots those that went last */
    } last; /* the slice that was counted last: while nothing changes, nothing is looked at again */
} wh_activity_t;

/* The task of a segment that will begin where the track stands. `for_vacuum` tells a dwell for vacuum from
 * others. */
wh_task_t wh_activity_task(const wh_track_t *track, const wh_segment_t *segment, bool for_vacuum);

/* The task while these axes move; `share` when none does. */
wh_task_t wh_activity_motion(const wh_machine_t *machine, const bool moving[WH_AXES], wh_share_t share);

/* Of several robots those that have one of these axes, bit a for axis a, stand for the task's share, unless
 * the task is to go somewhere; with none of them no robot is busy with the task. */
void wh_activity_narrow(wh_task_t *task, const wh_machine_t *machine, uint32_t axes);

/* Counts slice command->seq, which `state` answers, and returns its share. Of the command it reads `seq` and
 * the valves. Cost: 4 ns for two grippers. */
wh_share_t wh_activity_count(wh_activity_t *activity, const wh_machine_t *machine, const wh_task_t *task,
                             const wh_command_t *command, const wh_state_t *state);

/* What a slice of this task that `state` answers goes into. */
wh_share_t wh_activity_share(const wh_task_t *task, const wh_state_t *state);

/* Ends all that is going on with slice `slice`. */
void wh_activity_end(wh_activity_t *activity, int64_t slice);

/* Which of the WH_RESOURCES an interval is of: 0 is the robot, or the first. */
size_t wh_activity_resource(const wh_busy_span_t *interval);

/* Frees the intervals. */
void wh_activity_free(wh_activity_t *activity);

#endif
