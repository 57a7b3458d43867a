#include "activity.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* -------------------------------------------------------------------------------------------------- tasks */

wh_task_t wh_activity_motion(const wh_machine_t *machine, const bool moving[WH_AXES], wh_share_t share) {
    bool robot = false;
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        robot = robot || moving[axis];
    }
    wh_task_t task = {share, robot, robot, 0};
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const int32_t axis = machine->mounts[g].axis;
        const bool carried = axis == WH_NONE ? robot : moving[axis];
        task.moves = task.moves || carried;
        task.carried |= carried ? 1U << g : 0;
    }
    task.robot = robot || !task.moves;
    return task;
}

static wh_share_t share_standing(const wh_segment_t *segment, bool for_vacuum) {
    if (segment->kind == WH_SEGMENT_VALVES) {
        return WH_SHARE_HANDOVER;
    }
    return segment->kind == WH_SEGMENT_SENSOR || for_vacuum ? WH_SHARE_VACUUM : WH_SHARE_WAITING;
}

wh_task_t wh_activity_task(const wh_track_t *track, const wh_segment_t *segment, bool for_vacuum) {
    const bool is_line = segment->kind == WH_SEGMENT_LINE;
    const bool is_motion = is_line || segment->kind == WH_SEGMENT_AXES || segment->kind == WH_SEGMENT_WAY;
    bool moving[WH_AXES] = {false};
    for (size_t axis = 0; is_motion && axis < WH_AXES; ++axis) {
        moving[axis] =
            is_line ? axis < WH_ROBOT_AXES : wh_real_abs(segment->target[axis] - track->axes[axis]) > 0;
    }
    wh_task_t task = wh_activity_motion(track->machine, moving, share_standing(segment, for_vacuum));
    /* A motion of no length is one, but keeps nobody busy. */
    task.robot = task.robot && (task.moves || !is_motion);
    task.moves = is_motion;
    return task;
}

/* ----------------------------------------------------------------------------------------------- counting */

/* True for a wafer that is held and for a valve: of both a slice tells how they are at its end. The robot and
 * a chuck are busy during the slice. */
static bool is_state(size_t resource) {
    return resource > 0 && (resource - 1) % 3 != 0;
}

static void add_interval(wh_activity_t *activity, size_t resource, int64_t end) {
    const size_t beside_robot = resource > 0 ? resource - 1 : 0;
    if (end == activity->open[resource].begin) {
        return;
    }
    activity->intervals = wh_array_grow(activity->intervals, activity->interval_count,
                                        &activity->interval_capacity, sizeof *activity->intervals);
    activity->intervals[activity->interval_count++] =
        (wh_busy_span_t){.who = resource == 0 ? WH_BUSY_ROBOT : (wh_busy_t)(WH_BUSY_CHUCK + beside_robot % 3),
                         .gripper = resource == 0 ? WH_NONE : (int32_t)(beside_robot / 3),
                         .what = activity->open[resource].what,
                         .begin = activity->open[resource].begin,
                         .end = end};
}

size_t wh_activity_resource(const wh_busy_span_t *interval) {
    return interval->who == WH_BUSY_ROBOT
               ? 0
               : (size_t)(3 * interval->gripper + (int32_t)interval->who - (int32_t)WH_BUSY_CHUCK + 1);
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

/* `turns`: it is a chuck that turns. */
static void note_gripper(wh_activity_t *activity, size_t g, bool turns, const wh_command_t *command,
                         int32_t held) {
    const size_t first = 1 + 3 * g;
    const wh_share_t share = held != WH_NONE ? WH_SHARE_LOADED : WH_SHARE_EMPTY;
    note(activity, first, turns ? 1 + (int32_t)share : 0, command->seq);
    note(activity, first + 1, held + 1, command->seq);
    note(activity, first + 2, command->grippers[g].valve == WH_VALVE_OPEN ? 1 : 0, command->seq);
}

/* True if the slice is like the one counted last. */
static bool goes_on(const wh_activity_t *activity, const wh_task_t *task, const wh_command_t *command,
                    const wh_state_t *state) {
    const wh_task_t *last = &activity->last.task;
    bool same = activity->last.is_known && task->share == last->share && task->moves == last->moves &&
                task->robot == last->robot && task->carried == last->carried;
    for (size_t g = 0; same && g < state->gripper_count; ++g) {
        same = state->grippers[g].wafer == activity->last.held[g] &&
               command->grippers[g].valve == activity->last.valves[g];
    }
    return same;
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
    note(activity, 0, task->robot ? 1 + (int32_t)share : 0, command->seq);
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
