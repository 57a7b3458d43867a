/* Several segments at once: each task of a script has a lane, and all advance in the same slice. */
#include <stdlib.h>
#include <string.h>

#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "../text/clock.h"
#include "counted.h"
#include "flow_held.h"
#include "native.h"
#include "playing.h"

/* ------------------------------------------------------------------------------------------------- slices */

static void take_axes(wh_mcs_t *mcs, const wh_lane_t *lane) {
    for (size_t axis = 0; axis < WH_AXES && lane->axes >> axis != 0; ++axis) {
        if ((lane->axes >> axis & 1U) != 0) {
            mcs->track.axes[axis] = lane->track.axes[axis];
        }
    }
}

static void take_valves(wh_mcs_t *mcs, const wh_lane_t *lane) {
    const wh_segment_t *segment = &lane->track.segment;
    for (size_t g = 0; segment->kind == WH_SEGMENT_VALVES && g < mcs->layout->machine.gripper_count; ++g) {
        if (segment->valves[g] != WH_NONE) {
            mcs->track.valves[g] = segment->valves[g];
        }
    }
}

/* Its segment stands still for now, or has not begun. */
static bool stands(const wh_mcs_t *mcs, const wh_lane_t *lane) {
    return lane->is_held || (mcs->lanes->held_axes != 0 && wh_mcs_is_held_back(mcs, lane));
}

void wh_mcs_stop_lane(wh_mcs_t *mcs, wh_lane_t *lane, wh_status_t after) {
    lane->stop.after = after;
    if (lane->stop.ramp.is_on) {
        return;
    }
    if (lane->is_busy && !stands(mcs, lane) && wh_mcs_begin_ramp(mcs, &lane->stop.ramp, &lane->track)) {
        return;
    }
    lane->told = after;
    lane->status = after == WH_OK ? WH_STATUS_STOPPED : lane->status;
    lane->is_busy = lane->is_drawn = lane->is_held = false;
}

/* The next slice of a segment that was stopped and slows down. False: it stands, and has ended. */
static bool draw_stopped(wh_mcs_t *mcs, wh_lane_t *lane) {
    lane->is_drawn = wh_ramp_next(&lane->stop.ramp, &lane->track);
    if (!lane->is_drawn) {
        take_axes(mcs, lane);
        lane->stop.ramp.is_on = false;
        lane->is_busy = false;
        lane->told = lane->stop.after;
        lane->status = lane->stop.after == WH_OK ? WH_STATUS_STOPPED : WH_OK;
    }
    return lane->is_drawn;
}

/* Asks each running segment for the next slice. A finished segment takes none: its end has exactly its
 * target's bits. True if any is finished. */
static bool draw_lanes(wh_mcs_t *mcs) {
    bool is_any_over = false;
    for (size_t i = 0; i < mcs->lanes->count; ++i) {
        wh_lane_t *lane = &mcs->lanes->of[i];
        if (!lane->is_busy || lane->is_drawn || stands(mcs, lane)) {
            continue;
        }
        if (lane->stop.ramp.is_on) {
            is_any_over = !draw_stopped(mcs, lane) || is_any_over;
            continue;
        }
        lane->state = wh_track_next(&lane->track, wh_mcs_sensors(mcs, &lane->awaited));
        lane->is_drawn = lane->state == WH_TRACK_MOVING;
        if (!lane->is_drawn) {
            lane->is_busy = false;
            lane->status = WH_OK;
            take_axes(mcs, lane);
            is_any_over = true;
        }
    }
    return is_any_over;
}

static void tell_recorder(wh_mcs_t *mcs) {
    wh_recorder_t *recorder = &mcs->recorder;
    recorder->part_count = 0;
    for (size_t i = 0; i < mcs->lanes->count; ++i) {
        const wh_lane_t *lane = &mcs->lanes->of[i];
        const int32_t command = (int32_t)i == mcs->lanes->current ? recorder->running : lane->running;
        if (lane->is_busy || command != WH_NONE) {
            static const wh_task_t waiting = {.share = WH_SHARE_WAITING};
            const bool is_held_back = mcs->lanes->held_axes != 0 && wh_mcs_is_held_back(mcs, lane);
            const bool goes = lane->is_busy && !is_held_back;
            recorder->parts[recorder->part_count++] =
                (wh_recorder_part_t){command, goes ? lane->task : waiting, lane->grippers};
        }
    }
}

/* The state of a slice that ends a segment decides what comes next. */
static void await_ends(const wh_mcs_t *mcs) {
    bool is_any_last = false;
    for (size_t i = 0; mcs->wanted.partners.lossy && i < mcs->lanes->count; ++i) {
        const wh_lane_t *lane = &mcs->lanes->of[i];
        is_any_last =
            is_any_last || (lane->is_busy && lane->track.segment_slice == lane->track.segment_slices);
    }
    if (is_any_last) {
        mcs->wanted.partners.lossy->await(mcs->wanted.partners.user);
    }
}

void wh_mcs_show_lanes(wh_mcs_t *mcs) {
    for (size_t i = 0; i < mcs->lanes->count; ++i) {
        if (mcs->lanes->of[i].is_busy && !stands(mcs, &mcs->lanes->of[i])) {
            take_axes(mcs, &mcs->lanes->of[i]);
            take_valves(mcs, &mcs->lanes->of[i]);
        }
    }
    tell_recorder(mcs);
}

/* Plays one slice of all running segments. A refused slice has not taken place, and its segments are given
 * up where they were. */
static wh_status_t play_slice(wh_mcs_t *mcs) {
    wh_real_t before[WH_AXES];
    memcpy(before, mcs->track.axes, sizeof before);
    wh_mcs_show_lanes(mcs);
    for (size_t i = 0; i < mcs->lanes->count; ++i) {
        mcs->lanes->of[i].is_drawn = false;
    }
    ++mcs->track.slice;
    await_ends(mcs);
    const wh_status_t status = wh_mcs_play_slice(mcs, before);
    mcs->recorder.part_count = 0;
    for (size_t i = 0; i < mcs->lanes->count; ++i) {
        wh_vacuum_watch_slice(&mcs->lanes->of[i].watch, mcs->state.sensors);
    }
    if (mcs->lanes->flow && mcs->wanted.listener.flow_slice) {
        mcs->wanted.listener.flow_slice(mcs->wanted.listener.user, mcs);
    }
    return status;
}

/* Stops the segments that move one of these axes; WH_MCS_ALL: all segments. */
static void give_up_segments(wh_mcs_t *mcs, uint32_t axes, wh_status_t status, bool may_slow_down) {
    for (size_t i = 0; i < mcs->lanes->count; ++i) {
        wh_lane_t *lane = &mcs->lanes->of[i];
        if (lane->is_busy && (axes == WH_MCS_ALL || (lane->axes & axes) != 0)) {
            if (status == WH_STATUS_STOPPED && may_slow_down) {
                wh_mcs_stop_lane(mcs, lane, WH_OK);
                continue;
            }
            lane->status = status;
            lane->is_busy = lane->is_drawn = lane->stop.ramp.is_on = false;
        }
    }
}

/* Stops what robots do whose controllers have ended that. */
static void give_up_refused(wh_mcs_t *mcs) {
    for (size_t robot = 0; robot < WH_MCS_ROBOTS; ++robot) {
        const bool is_refused = (mcs->stop.refused >> robot & 1U) != 0;
        const uint32_t axes = is_refused ? wh_mcs_robot_axes(&mcs->layout->machine, robot) : 0;
        for (size_t i = 0; i < mcs->lanes->count; ++i) {
            wh_lane_t *lane = &mcs->lanes->of[i];
            if (lane->is_busy && (lane->axes & axes) != 0) {
                lane->refused = (int32_t)robot + 1;
                lane->is_busy = lane->is_drawn = lane->stop.ramp.is_on = false;
            }
        }
    }
    mcs->stop.refused = 0;
}

/* After slices have gone out: takes a STOP that has come, and the answer to the last slice. A slice that was
 * given up because of a STOP is not a separate reason. */
static void take_end(wh_mcs_t *mcs, wh_status_t status) {
    uint32_t axes = 0;
    give_up_refused(mcs);
    if (wh_mcs_stop_has_come(mcs)) {
        mcs->lanes->stopped_by = wh_mcs_take_stop(mcs, &axes);
        give_up_segments(mcs, axes, WH_STATUS_STOPPED, status == WH_OK);
        wh_mcs_release_stopped(mcs, axes);
        if (axes == WH_MCS_ALL) {
            wh_mcs_end_waits(mcs, WH_STATUS_STOPPED, mcs->lanes->stopped_by);
        }
    }
    if (status != WH_OK && axes != WH_MCS_ALL) {
        give_up_segments(mcs, WH_MCS_ALL, status, false);
        wh_mcs_note_refused(mcs, status);
        mcs->lanes->stopped_by = NULL;
    }
}

/* Plays at most as many slices as are charged at once. True if no more may go out. */
static bool play_charge(wh_mcs_t *mcs, wh_status_t *status) {
    bool is_over = false;
    for (int64_t i = 0; i < WH_MCS_SLICES_PER_CHARGE && !is_over; ++i) {
        i += i > 0 ? wh_mcs_leave_out(mcs, WH_MCS_SLICES_PER_CHARGE - 1 - i) : 0;
        is_over = draw_lanes(mcs);
        *status = is_over ? WH_OK : play_slice(mcs);
        is_over = is_over || *status != WH_OK || wh_mcs_stop_has_come(mcs) || mcs->stop.is_called;
        if (wh_sandbox_stopping(mcs->sandbox)) {
            break;
        }
    }
    return is_over;
}

/* native.advance(): slices go out until a segment is over, or all were given up, or a job has come. At
 * least one segment must run. */
static int advance_lanes(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    mcs->stop.is_called = false;
    wh_status_t status = wh_mcs_is_told_to_stop(mcs) ? WH_OK : wh_mcs_resume(mcs);
    bool is_over = status != WH_OK || wh_mcs_is_told_to_stop(mcs);
    while (!is_over) {
        const int64_t first = mcs->track.slice;
        const double begin = wh_clock_seconds();
        is_over = play_charge(mcs, &status);
        mcs->recorder.record->wall_s += wh_clock_seconds() - begin;
        wh_sandbox_charge(L, wh_mcs_steps(mcs->track.slice - first));
    }
    take_end(mcs, status);
    return 0;
}

/* -------------------------------------------------------------------------------------------------- lanes */

void wh_mcs_free_lanes(wh_mcs_t *mcs) {
    for (int32_t i = 0; mcs->lanes && i < WH_MCS_LANES; ++i) {
        if (i != mcs->lanes->current) { /* whose plans the rehearsal has */
            free(mcs->lanes->of[i].planned.segments);
        }
    }
    free(mcs->lanes);
    mcs->lanes = NULL;
}

static wh_lane_t *current_lane(const wh_mcs_t *mcs) {
    return &mcs->lanes->of[mcs->lanes->current];
}

static void tell_turn(const wh_mcs_t *mcs, const char *what) {
    if (mcs->wanted.partners.turn) {
        mcs->wanted.partners.turn(mcs->wanted.partners.user, mcs, what);
    }
    if (mcs->wanted.listener.turn) {
        mcs->wanted.listener.turn(mcs->wanted.listener.user, mcs, what);
    }
}

/* native.waits(text): from now on the task waits for the thing that the text names; nil: it waits
 * no more. */
static int wait_for(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const char *what = lua_isnil(L, 1) ? NULL : wh_lua_whole_text(L, 1);
    if (!mcs->lanes) {
        return 0;
    }
    if (what) {
        wh_recorder_wait(&mcs->recorder, what);
    } else {
        wh_recorder_go_on(&mcs->recorder);
    }
    tell_turn(mcs, what);
    return 0;
}

/* native.open_lanes(): from now on there are tasks. */
static int open_lanes(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    if (!mcs->lanes) {
        wh_decisions_measured(mcs->wanted.decisions, "tasks");
        mcs->lanes = wh_array_new(1, sizeof *mcs->lanes);
        mcs->lanes->count = 1;
        for (size_t i = 0; i < WH_MCS_LANES; ++i) {
            mcs->lanes->of[i].running = WH_NONE;
        }
        mcs->recorder.record->has_tasks = true;
        tell_turn(mcs, NULL);
    }
    return 0;
}

/* native.switch(lane, number): lanes count from 1; the script's lane is 1, and its number 0. The kept data
 * of a command belongs to its task. */
static int switch_lane(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_of(L);
    const int32_t to = wh_mcs_index(L, 1, WH_MCS_LANES);
    wh_lane_t *lane = current_lane(mcs);
    lane->running = mcs->recorder.running;
    lane->planned = mcs->rehearsal.planned;
    memcpy(lane->callers, mcs->running.callers, sizeof lane->callers);
    memcpy(lane->module, mcs->running.module, sizeof lane->module);
    memcpy(lane->word, mcs->running.word, sizeof lane->word);
    mcs->lanes->current = to;
    mcs->lanes->count = (size_t)to < mcs->lanes->count ? mcs->lanes->count : (size_t)to + 1;
    lane = current_lane(mcs);
    lane->number = (int32_t)luaL_checkinteger(L, 2);
    mcs->recorder.number = lane->number;
    mcs->recorder.running = lane->running;
    mcs->rehearsal.planned = lane->planned;
    memcpy(mcs->running.callers, lane->callers, sizeof mcs->running.callers);
    memcpy(mcs->running.module, lane->module, sizeof mcs->running.module);
    memcpy(mcs->running.word, lane->word, sizeof mcs->running.word);
    return 0;
}

static uint32_t grippers_of_robot(const wh_machine_t *machine, int32_t robot) {
    uint32_t grippers = 0;
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const bool is_its = machine->mounts[g].axis == WH_NONE && machine->mounts[g].robot == robot;
        grippers |= is_its ? 1U << g : 0;
    }
    return grippers;
}

/* native.hold_mechanisms(robot, chucks, pins and doors...): the running command has these, the robot from 1,
 * false: none; doors count on from the grippers. Its segments move these. After this call it no longer
 * waits. */
static int hold_mechanisms(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_machine_t *machine = &mcs->layout->machine;
    wh_lane_t alone = {0};
    wh_lane_t *lane = mcs->lanes ? current_lane(mcs) : &alone;
    const int32_t robot = lua_toboolean(L, 1) ? wh_mcs_index(L, 1, wh_machine_robots(machine)) : WH_NONE;
    lane->axes = robot != WH_NONE ? wh_mcs_robot_axes(machine, (size_t)robot) : 0;
    lane->grippers = grippers_of_robot(machine, robot);
    for (int i = 2; i <= lua_gettop(L); ++i) {
        const int32_t g = wh_mcs_index(L, i, machine->gripper_count + machine->door_count);
        const bool is_door = (size_t)g >= machine->gripper_count;
        lane->axes |= is_door ? 1U << wh_machine_door_axis(machine, (size_t)g - machine->gripper_count)
                              : wh_mount_moved_by(&machine->mounts[g]);
        lane->grippers |= is_door ? 0 : 1U << g;
    }
    mcs->running.axes = lane->axes;
    if (mcs->lanes) {
        wh_recorder_go_on(&mcs->recorder);
    }
    if (mcs->lanes && lane->axes != 0) {
        tell_turn(mcs, NULL);
    }
    return 0;
}

/* native.start(segment or the number of a planned one): the segment runs from the next slice on, in
 * this task's lane. */
static int start_segment(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_lane_t *lane = current_lane(mcs);
    const wh_track_t stands = mcs->track;
    wh_planned_t planned;
    wh_mcs_begin_segment(L, mcs, &planned);
    lane->track = mcs->track;
    mcs->track = stands;
    wh_mcs_check_segment(L, mcs, &planned.track.segment, lane->axes);
    lane->kept = wh_mcs_keep_segment(mcs, &lane->track, &planned, lane->axes);
    lane->task = planned.task;
    wh_activity_narrow(&lane->task, &mcs->layout->machine, lane->axes);
    lane->awaited = planned.awaited;
    lane->watch = (wh_vacuum_watch_t){.watched = planned.may_lose & lane->grippers & mcs->state.sensors};
    lane->is_busy = true;
    lane->is_drawn = false;
    wh_mcs_note_held_back(mcs, lane);
    return 0;
}

/* native.runs(lane): true while the lane's segment runs. Without a lane: true while any segment runs. */
static int push_runs(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    bool is_any = false;
    if (!lua_isnoneornil(L, 1)) {
        lua_pushboolean(L, mcs->lanes->of[wh_mcs_index(L, 1, WH_MCS_LANES)].is_busy);
        return 1;
    }
    for (size_t i = 0; mcs->lanes && i < WH_MCS_LANES; ++i) {
        is_any = is_any || mcs->lanes->of[i].is_busy;
    }
    lua_pushboolean(L, is_any);
    return 1;
}

/* native.outcome(): the result of this task's segment, as native.play returns it; raises if it was
 * given up. */
static int push_outcome(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_lane_t *lane = current_lane(mcs);
    const int32_t refused = lane->refused;
    lane->refused = 0;
    if (refused > 0) {
        wh_mcs_raise_condition(L, mcs, (size_t)refused - 1);
    }
    if (lane->status == WH_STATUS_STOPPED && mcs->lanes->stopped_by) {
        wh_mcs_raise(L, mcs, WH_STATUS_STOPPED, mcs->lanes->stopped_by);
    } else if (lane->status != WH_OK) {
        wh_mcs_raise_refused(L, mcs, lane->status);
    }
    const int32_t lost = wh_vacuum_watch_lost(&lane->watch, mcs->track.valves, mcs->state.gripper_count);
    lua_pushboolean(L, lane->state == WH_TRACK_DONE);
    if (lost == WH_NONE) {
        return 1;
    }
    lua_pushinteger(L, lost + 1);
    return 2;
}

/* native.drop_segment(): stops this task's segment. */
static int drop_segment(lua_State *L) {
    wh_lane_t *lane = current_lane(wh_mcs_with_layout(L));
    lane->is_busy = lane->is_drawn = lane->stop.ramp.is_on = false;
    return 0;
}

/* native.free_lane(lane): a task has ended. */
static int free_lane(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_lane_t *lane = &mcs->lanes->of[wh_mcs_index(L, 1, WH_MCS_LANES)];
    free(lane->planned.segments);
    *lane = (wh_lane_t){.running = WH_NONE};
    return 0;
}

const luaL_Reg wh_mcs_lane_functions[] = {{"open_lanes", open_lanes},
                                          {"switch", switch_lane},
                                          {"hold_mechanisms", hold_mechanisms},
                                          {"waits", wait_for},
                                          {"start", start_segment},
                                          {"advance", advance_lanes},
                                          {"runs", push_runs},
                                          {"outcome", push_outcome},
                                          {"drop_segment", drop_segment},
                                          {"free_lane", free_lane},
                                          {NULL, NULL}};
