/* Takes a run's slices as the replay has them: whole states into the record and its signals. */
#include "log_run_internal.h"

#include <string.h>

/* No cell has anything farther away, mm or rad. */
#define FARTHEST 1e9

/* The reason why the robot stood still in a slice, as far as valves tell. */
static wh_share_t share_standing(const wh_log_run_t *run, const wh_state_t *state) {
    for (size_t g = 0; g < state->gripper_count; ++g) {
        if (state->physics->told[g] != run->taken.last.grippers[g].valve) {
            return WH_SHARE_HANDOVER;
        }
    }
    return run->taken.has_opened_valve ? WH_SHARE_VACUUM : WH_SHARE_WAITING;
}

bool wh_log_run_begins_wait(const wh_log_run_t *run, size_t g) {
    return run->state.physics->told[g] != run->taken.last.grippers[g].valve;
}

static void note_valves(wh_log_run_t *run, const wh_state_t *state, const bool moving[WH_AXES]) {
    const bool carried = moving[WH_AXIS_THETA] || moving[WH_AXIS_R] || moving[WH_AXIS_YAW];
    run->taken.has_opened_valve = run->taken.has_opened_valve && !carried;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        run->taken.has_opened_valve = run->taken.has_opened_valve || wh_log_run_begins_wait(run, g);
        run->taken.last.grippers[g].valve = state->physics->told[g];
    }
}

static void count_slice(wh_log_run_t *run, int64_t seq, const double axes[]) {
    const wh_state_t *state = &run->state;
    bool moving[WH_AXES];
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        moving[axis] = wh_real_abs(axes[axis] - run->taken.last.axes[axis]) > 0;
    }
    run->recorder.task = wh_activity_motion(&run->cell.layout->machine, moving, share_standing(run, state));
    if (run->record.has_tasks) {
        wh_log_run_count_parts(run, moving);
    }
    note_valves(run, state, moving);
    run->taken.last.seq = seq;
    memcpy(run->taken.last.axes, axes, sizeof run->taken.last.axes);
    wh_recorder_slice(&run->recorder, &run->taken.last, state);
}

static void start(wh_log_run_t *run, bool from_the_beginning) {
    const wh_machine_t *machine = &run->cell.layout->machine;
    if (!run->options.only_slices) {
        wh_signals_begin(&run->signals, run->cell.layout, from_the_beginning && run->cell.is_whole);
    }
    memset(&run->taken.last, 0, sizeof run->taken.last);
    wh_machine_home(machine, run->taken.last.axes);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        run->taken.last.grippers[g].valve = WH_VALVE_CLOSED;
    }
}

/* Finds the command's axes, if they are known; else the last ones. */
static bool find_axes(const wh_log_run_t *run, const waferhand_command *command, double axes[]) {
    wh_command_t checked;
    bool known = command && wh_link_command_from_message(command, &checked) == WH_OK;
    for (int32_t axis = 0; known && axis < command->axis_count; ++axis) {
        known = wh_real_abs(command->axis_position[axis]) < FARTHEST;
    }
    memcpy(axes, run->taken.last.axes, sizeof run->taken.last.axes);
    for (int32_t axis = 0; known && axis < command->axis_count; ++axis) {
        axes[axis] = command->axis_position[axis];
    }
    return known;
}

/* Takes the slice's numbers. Slices that never reached the simulator are in no log. */
static void count_gap(wh_log_run_t *run, int64_t seq, int64_t missed) {
    const int64_t more = missed - run->taken.missed;
    run->taken.gaps += run->taken.seq > 0 && seq - run->taken.seq - 1 > more ? 1 : 0;
    run->taken.seq = seq;
    run->taken.missed = missed;
}

/* Adds the slice to the record and the signals; the axes that are known are `count`. */
static void record_slice(wh_log_run_t *run, int64_t seq, const double axes[], size_t count) {
    const bool is_whole = count == run->cell.layout->machine.axis_count;
    count_slice(run, seq, axes);
    wh_log_run_hear_passes(run);
    if (run->collision.memory) {
        wh_collision_observe(&run->collision, is_whole ? axes : NULL, &run->state);
    }
    wh_signals_slice(&run->signals, count > 0 ? axes : NULL, count, &run->state);
}

/* Takes the slice of run->state. */
static void take_slice(wh_log_run_t *run, const waferhand_command *command, int64_t missed, uint64_t hash) {
    const int64_t seq = run->state.seq;
    double axes[WH_AXES];
    if (!run->taken.is_any) {
        run->taken.is_any = true;
        start(run, seq == 1);
    }
    const bool known = find_axes(run, command, axes);
    const bool whole = known && (size_t)command->axis_count == run->cell.layout->machine.axis_count;
    count_gap(run, seq, missed);
    run->taken.hash = hash;
    if (!run->options.only_slices) {
        record_slice(run, seq, axes, known ? (size_t)command->axis_count : 0);
    }
    if (run->options.listener) {
        run->options.listener(run->options.user, run->cell.layout, whole ? axes : NULL, &run->state,
                              run->taken.hash);
    }
}

static bool is_near(const wh_vec3_t *r) {
    return wh_real_abs(r->x) < FARTHEST && wh_real_abs(r->y) < FARTHEST && wh_real_abs(r->z) < FARTHEST;
}

static bool is_place(const wh_pose_t *pose) {
    return wh_pose_validate(pose) == WH_OK && is_near(&pose->r);
}

static bool is_index(int32_t index, size_t count) {
    return index == WH_NONE || wh_is_index(index, count);
}

static bool are_wafers_sound(const wh_state_t *state) {
    bool sound = true;
    for (size_t w = 0; sound && w < state->wafer_count; ++w) {
        sound = is_index(state->wafers[w].holder, state->gripper_count) &&
                is_place(&state->wafers[w].base_from_wafer);
    }
    return sound;
}

static bool are_grippers_sound(const wh_state_t *state) {
    bool sound = true;
    for (size_t g = 0; sound && g < state->gripper_count; ++g) {
        const wh_gripper_t *gripper = &state->grippers[g];
        sound = is_index(gripper->wafer, state->wafer_count) && is_place(&gripper->base_from_gripper) &&
                (gripper->wafer == WH_NONE || is_place(&gripper->gripper_from_wafer));
    }
    return sound;
}

/* True if a simulator could have sent this state: its indices and numbers are used from here on. */
static bool is_sound(const wh_state_t *state, const wh_layout_t *layout) {
    return state->wafer_count == layout->wafer_count &&
           state->gripper_count == layout->machine.gripper_count && state->seq > 0 &&
           state->seq < INT64_MAX / layout->slice_us &&
           wh_physics_state_validate(state->physics, state->gripper_count, state->wafer_count) == WH_OK &&
           are_wafers_sound(state) && are_grippers_sound(state);
}

void wh_log_run_on_state(void *user, const waferhand_command *command, const waferhand_state *message) {
    wh_log_run_t *run = user;
    const wh_layout_t *layout = run->cell.layout;
    const bool is_recorded = !run->options.only_slices;
    if (is_recorded) {
        wh_log_run_take_told_before(run, message->seq);
    }
    if (wh_link_state_from_message(message, &layout->grasp.tolerance, &run->arrays, &run->state) != WH_OK ||
        !is_sound(&run->state, layout) ||
        !wh_layout_complete_grips(layout, run->arrays.grippers, &run->arrays.physics)) {
        return;
    }
    if (is_recorded) {
        wh_log_run_set_parts(run);
        wh_recorder_events(&run->recorder, &run->state);
    }
    if (message->status == WH_OK) {
        take_slice(run, command, message->missed, (uint64_t)message->hash);
    }
}

/* Rotations of a simulator's own state are sound; its commands may have led anywhere. */
static bool is_all_near(const wh_state_t *state) {
    bool near = true;
    for (size_t g = 0; near && g < state->gripper_count; ++g) {
        near = is_near(&state->grippers[g].base_from_gripper.r);
    }
    for (size_t w = 0; near && w < state->wafer_count; ++w) {
        near = is_near(&state->wafers[w].base_from_wafer.r);
    }
    return near;
}

/* A slice for the record, from a simulator's own state. Its wafers are kept: motion control's messages of
 * the time before the next slice are about them. */
static void record_stepped(wh_log_run_t *run, const waferhand_command *command,
                           const wh_protocol_server_t *server) {
    const wh_state_t *state = &server->state;
    wh_log_run_take_told_before(run, state->seq);
    if (!is_all_near(state)) {
        return;
    }
    run->state = *state;
    wh_log_run_set_parts(run);
    wh_recorder_events(&run->recorder, state);
    take_slice(run, command, server->missed, run->replay.run->hash);
    memcpy(run->arrays.wafers, state->wafers, state->wafer_count * sizeof *run->arrays.wafers);
    run->state.wafers = run->arrays.wafers;
}

void wh_log_run_on_stepped(void *user, const waferhand_command *command, const wh_protocol_server_t *server) {
    wh_log_run_t *run = user;
    if (!run->options.only_slices) {
        record_stepped(run, command, server);
        return;
    }
    run->state = server->state;
    take_slice(run, command, server->missed, run->replay.run->hash);
}
