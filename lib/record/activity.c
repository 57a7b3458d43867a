#include "activity.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* -------------------------------------------------------------------------------------------------- tasks */

static bool has_several(const wh_machine_t *machine) {
    return machine->carrier && machine->carrier->next;
}

static uint32_t doors_of(const wh_machine_t *machine, const bool moving[WH_AXES]) {
    uint32_t doors = 0;
    for (size_t d = 0; d < machine->door_count; ++d) {
        doors |= moving[wh_machine_door_axis(machine, d)] ? 1U << d : 0;
    }
    return doors;
}

/* True if an axis of its own moves the gripper. */
static bool moves_by_itself(const wh_mount_t *mount, const bool moving[WH_AXES]) {
    bool moves = false;
    for (size_t i = 0; i < wh_mount_axes(mount); ++i) {
        moves = moves || moving[(size_t)mount->axis + i];
    }
    return moves;
}

/* Bit r: robot r moves. */
static uint32_t find_going(const wh_machine_t *machine, const bool moving[WH_AXES]) {
    uint32_t going = 0;
    for (size_t axis = 0; axis < wh_machine_robot_axes(machine); ++axis) {
        size_t own = 0;
        going |= moving[axis] ? 1U << wh_machine_robot_of(machine, axis, &own) : 0;
    }
    return going;
}

wh_task_t wh_activity_motion(const wh_machine_t *machine, const bool moving[WH_AXES], wh_share_t share) {
    const uint32_t moved = find_going(machine, moving);
    const bool robot = moved != 0;
    wh_task_t task = {share, robot, robot, 0, doors_of(machine, moving), {0}};
    for (size_t r = 0; has_several(machine) && r < WH_BUSY_ROBOTS; ++r) {
        task.robots[r] = (moved >> r & 1U) != 0 ? 1 + WH_SHARE_EMPTY : 0;
    }
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_mount_t *mount = &machine->mounts[g];
        const bool carried =
            mount->axis == WH_NONE ? (moved >> mount->robot & 1U) != 0 : moves_by_itself(mount, moving);
        task.moves = task.moves || carried;
        task.carried |= carried ? 1U << g : 0;
    }
    task.moves = task.moves || task.doors != 0;
    task.robot = robot || !task.moves;
    return task;
}

/* False also if each valve keeps its position, as when RECOVER closes a closed valve. */
static bool switches(const wh_track_t *track, const wh_segment_t *segment) {
    bool any = false;
    for (size_t g = 0; segment->kind == WH_SEGMENT_VALVES && g < track->machine->gripper_count; ++g) {
        any = any || (segment->valves[g] != WH_NONE && segment->valves[g] != track->valves[g]);
    }
    return any;
}

static wh_share_t share_standing(const wh_track_t *track, const wh_segment_t *segment, bool for_vacuum) {
    if (switches(track, segment)) {
        return WH_SHARE_HANDOVER;
    }
    return segment->kind == WH_SEGMENT_SENSOR || for_vacuum ? WH_SHARE_VACUUM : WH_SHARE_WAITING;
}

/* True if a LINE moves this axis; it moves the first robot or the one of its gripper. */
static bool goes_straight(const wh_machine_t *machine, const wh_segment_t *segment, size_t axis) {
    size_t own = 0;
    const int32_t robot = wh_machine_robot_of(machine, axis, &own);
    const bool is_said = has_several(machine) && segment->gripper != WH_NONE;
    return robot == (is_said ? machine->mounts[segment->gripper].robot : 0);
}

wh_task_t wh_activity_task(const wh_track_t *track, const wh_segment_t *segment, bool for_vacuum) {
    const bool is_line = segment->kind == WH_SEGMENT_LINE;
    const bool is_motion = is_line || segment->kind == WH_SEGMENT_AXES || segment->kind == WH_SEGMENT_WAY ||
                           segment->kind == WH_SEGMENT_VIA;
    bool moving[WH_AXES] = {false};
    for (size_t axis = 0; is_motion && axis < WH_AXES; ++axis) {
        moving[axis] = is_line ? goes_straight(track->machine, segment, axis)
                               : wh_real_abs(segment->target[axis] - track->axes[axis]) > 0;
    }
    wh_task_t task = wh_activity_motion(track->machine, moving, share_standing(track, segment, for_vacuum));
    /* A motion of length zero is a motion, but it keeps no robot busy. */
    task.robot = task.robot && (task.moves || !is_motion);
    task.moves = is_motion;
    return task;
}

void wh_activity_narrow(wh_task_t *task, const wh_machine_t *machine, uint32_t axes) {
    if (!task->robot || task->moves) {
        return;
    }
    uint32_t own = axes; /* bit 0: the robot's first axis */
    uint8_t *robot = task->robots;
    for (const wh_carrier_t *carrier = has_several(machine) ? machine->carrier : NULL; carrier;
         carrier = carrier->next) {
        const bool is_its = (own & ((1U << carrier->axis_count) - 1)) != 0;
        *robot = is_its ? (uint8_t)(1 + task->share) : *robot;
        own >>= carrier->axis_count;
        ++robot;
    }
    task->robot = (axes & wh_machine_robot_bits(machine)) != 0;
}

/* ----------------------------------------------------------------------------------------------- counting */

/* Indices of resources. */
enum { FIRST_GRIPPER = WH_BUSY_ROBOTS, FIRST_DOOR = FIRST_GRIPPER + 3 * WH_GRIPPERS };

/* True for a held wafer and for a valve: a slice tells the state of both at its end. A robot and a chuck
 * are busy during the slice. */
static bool is_state(size_t resource) {
    return resource >= FIRST_GRIPPER && resource < FIRST_DOOR && (resource - FIRST_GRIPPER) % 3 != 0;
}

/* The kind and index of a resource, as an interval has them. */
static wh_busy_span_t span_of(size_t resource) {
    if (resource >= FIRST_DOOR) {
        return (wh_busy_span_t){.who = WH_BUSY_DOOR, .gripper = (int32_t)(resource - FIRST_DOOR)};
    }
    if (resource < FIRST_GRIPPER) {
        return (wh_busy_span_t){.who = WH_BUSY_ROBOT, .gripper = (int32_t)resource};
    }
    return (wh_busy_span_t){.who = (wh_busy_t)(WH_BUSY_CHUCK + (resource - FIRST_GRIPPER) % 3),
                            .gripper = (int32_t)((resource - FIRST_GRIPPER) / 3)};
}

static void add_interval(wh_activity_t *activity, size_t resource, int64_t end) {
    wh_busy_span_t span = span_of(resource);
    if (end == activity->open[resource].begin || activity->drops_intervals) {
        return;
    }
    activity->intervals = wh_array_grow(activity->intervals, activity->interval_count,
                                        &activity->interval_capacity, sizeof *activity->intervals);
    span.what = activity->open[resource].what;
    span.begin = activity->open[resource].begin;
    span.end = end;
    activity->intervals[activity->interval_count++] = span;
}

size_t wh_activity_resource(const wh_busy_span_t *interval) {
    if (interval->who == WH_BUSY_DOOR) {
        return FIRST_DOOR + (size_t)interval->gripper;
    }
    return interval->who == WH_BUSY_ROBOT
               ? (size_t)interval->gripper
               : FIRST_GRIPPER + 3 * (size_t)interval->gripper + (size_t)(interval->who - WH_BUSY_CHUCK);
}

static void note(wh_activity_t *activity, size_t resource, int32_t what, int64_t slice) {
    const int64_t border = is_state(resource) ? slice : slice - 1;
    const int32_t before = activity->open[resource].what;
    if (before != 0 && before != what) {
        add_interval(activity, resource, border);
    }
    if (before != what) {
        activity->open[resource].what = what;
        activity->open[resource].begin = border;
    }
}

/* `turns`: it is a chuck, and it turns. */
static void note_gripper(wh_activity_t *activity, size_t g, bool turns, const wh_command_t *command,
                         int32_t held) {
    const size_t first = FIRST_GRIPPER + 3 * g;
    const wh_share_t share = held != WH_NONE ? WH_SHARE_LOADED : WH_SHARE_EMPTY;
    note(activity, first, turns ? 1 + (int32_t)share : 0, command->seq);
    note(activity, first + 1, held + 1, command->seq);
    note(activity, first + 2, command->grippers[g].valve == WH_VALVE_OPEN ? 1 : 0, command->seq);
}

/* True if the slice is like the last counted one. */
static bool goes_on(const wh_activity_t *activity, const wh_task_t *task, const wh_command_t *command,
                    const wh_state_t *state) {
    const wh_task_t *last = &activity->last.task;
    bool same = activity->last.is_known && task->share == last->share && task->moves == last->moves &&
                task->robot == last->robot && task->carried == last->carried && task->doors == last->doors &&
                memcmp(task->robots, last->robots, sizeof task->robots) == 0;
    for (size_t g = 0; same && g < state->gripper_count; ++g) {
        same = state->grippers[g].wafer == activity->last.held[g] &&
               command->grippers[g].valve == activity->last.valves[g];
    }
    return same;
}

/* True if a gripper on the robot holds a wafer. */
static bool is_loaded(const wh_machine_t *machine, size_t robot, const wh_state_t *state) {
    bool is_any = false;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        is_any = is_any || (machine->mounts[g].axis == WH_NONE && machine->mounts[g].robot == robot &&
                            state->grippers[g].wafer != WH_NONE);
    }
    return is_any;
}

/* Counts each of several robots by itself. */
static void note_robots(wh_activity_t *activity, const wh_machine_t *machine, const wh_task_t *task,
                        const wh_state_t *state, int64_t slice) {
    static const uint8_t nobody[WH_BUSY_ROBOTS] = {0};
    const bool stands = task->robot && memcmp(task->robots, nobody, sizeof nobody) == 0;
    uint32_t went = 0;
    for (size_t r = 0; r < WH_BUSY_ROBOTS; ++r) {
        int32_t what = task->robots[r];
        if (what == 1 + (int32_t)WH_SHARE_EMPTY) {
            went |= 1U << r;
            what = is_loaded(machine, r, state) ? 1 + (int32_t)WH_SHARE_LOADED : what;
        } else if (stands && (activity->last.went >> r & 1U) != 0) {
            what = 1 + (int32_t)task->share;
        }
        note(activity, r, what, slice);
    }
    activity->last.went = went != 0 ? went : activity->last.went;
}

static void note_all(wh_activity_t *activity, const wh_machine_t *machine, const wh_task_t *task,
                     const wh_command_t *command, const wh_state_t *state) {
    wh_share_t share = task->moves ? WH_SHARE_EMPTY : task->share;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const int32_t held = state->grippers[g].wafer;
        const bool carried = (task->carried >> g & 1U) != 0;
        note_gripper(activity, g, carried && machine->mounts[g].axis != WH_NONE, command, held);
        if (held != WH_NONE && carried) {
            share = WH_SHARE_LOADED;
        }
        activity->last.held[g] = held;
        activity->last.valves[g] = command->grippers[g].valve;
    }
    for (size_t d = 0; d < machine->door_count; ++d) {
        note(activity, FIRST_DOOR + d, (task->doors >> d & 1U) != 0 ? 1 + (int32_t)WH_SHARE_EMPTY : 0,
             command->seq);
    }
    if (has_several(machine)) {
        note_robots(activity, machine, task, state, command->seq);
    } else {
        note(activity, 0, task->robot ? 1 + (int32_t)share : 0, command->seq);
    }
    activity->last.task = *task;
    activity->last.share = share;
    activity->last.is_known = true;
}

wh_share_t wh_activity_count(wh_activity_t *activity, const wh_machine_t *machine, const wh_task_t *task,
                             const wh_command_t *command, const wh_state_t *state) {
    if (!goes_on(activity, task, command, state)) {
        note_all(activity, machine, task, command, state);
    }
    ++activity->shares[activity->last.share];
    return activity->last.share;
}

void wh_activity_repeat(wh_activity_t *activity, int64_t slices) {
    activity->shares[activity->last.share] += slices;
}

wh_share_t wh_activity_share(const wh_task_t *task, const wh_state_t *state) {
    wh_share_t share = task->moves ? WH_SHARE_EMPTY : task->share;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        if (state->grippers[g].wafer != WH_NONE && (task->carried >> g & 1U) != 0) {
            share = WH_SHARE_LOADED;
        }
    }
    return share;
}

void wh_activity_end(wh_activity_t *activity, int64_t slice) {
    for (size_t resource = 0; resource < WH_RESOURCES; ++resource) {
        note(activity, resource, 0, is_state(resource) ? slice : slice + 1);
    }
    activity->last.is_known = false;
}

void wh_activity_free(wh_activity_t *activity) {
    free(activity->intervals);
    memset(activity, 0, sizeof *activity);
}
