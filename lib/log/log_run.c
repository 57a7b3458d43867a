/* One run of a log: its record and its signals, as motion control would have kept them. */
#include "log_run.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* No cell has anything farther away, mm or rad. */
#define FARTHEST 1e9

/* --------------------------------------------------------------------------------------------------- file */

__attribute__((format(printf, 2, 3))) static void note(wh_log_run_t *run, const char *format, ...) {
    char *text = run->text[run->note_count];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof run->text[0], format, values);
    va_end(values);
    run->notes[run->note_count++] = text;
}

/* Says why there is nothing to show: the file, then the reason. */
__attribute__((format(printf, 2, 3))) static bool refuse(wh_log_run_t *run, const char *format, ...) {
    const int length = snprintf(run->message, sizeof run->message, "%.300s: ", run->options.path);
    va_list values;
    va_start(values, format);
    (void)vsnprintf(run->message + length, sizeof run->message - (size_t)length, format, values);
    va_end(values);
    return false;
}

static bool wants(const wh_log_run_t *run) {
    return run->options.number == 0 || run->options.number == run->run_count;
}

static int compare(const void *a, const void *b) {
    const wh_log_boundary_t *one = a;
    const wh_log_boundary_t *two = b;
    if (one->run != two->run) {
        return one->run < two->run ? -1 : 1;
    }
    return (one->seq > two->seq) - (one->seq < two->seq);
}

static bool is_boundary(const wh_log_run_t *run) {
    const wh_log_boundary_t now = {run->run, run->seq};
    return run->boundary_count > 0 &&
           bsearch(&now, run->boundaries, run->boundary_count, sizeof now, compare) != NULL;
}

/* -------------------------------------------------------------------------------------------------- a run */

static void drop_run(wh_log_run_t *run) {
    wh_signals_close(&run->signals);
    wh_record_free(&run->record);
    memset(&run->recorder, 0, sizeof run->recorder);
    memset(&run->state, 0, sizeof run->state);
    free(run->collision.memory);
    memset(&run->collision, 0, sizeof run->collision);
}

static void watch_collisions(wh_log_run_t *run) {
    const wh_layout_t *layout = run->cell.layout;
    if (run->cell.is_whole && layout->collision) {
        run->collision.memory = wh_array_new(wh_collision_bytes(layout), 1);
        run->collision.layout = layout;
        wh_robot_forward(layout->machine.robot.home, &run->collision.base_from_effector);
    }
}

static void begin_run(wh_log_run_t *run) {
    drop_run(run);
    if (run->next_cell.layout) {
        wh_log_layout_free(&run->cell);
        run->cell = run->next_cell;
        memset(&run->next_cell, 0, sizeof run->next_cell);
    }
    run->gaps = 0;
    run->refused = 0;
    if (!run->cell.layout) {
        return;
    }
    wh_recorder_open(&run->recorder, &run->record, run->options.path);
    run->recorder.layout = run->cell.layout;
    run->recorder.cell = &run->cell.layout->cell;
    watch_collisions(run);
    if (run->begin.is_there) {
        wh_recorder_begin(&run->recorder, run->begin.line, run->begin.text, 0);
        run->begin.is_there = false;
    }
}

/* ----------------------------------------------------------------------------------------------- commands */

static void begin_command(wh_log_run_t *run, const waferhand_mcs *message, bool ours) {
    if (ours && run->signals.layout) {
        wh_recorder_begin(&run->recorder, message->line, message->command, (double)message->utime / 1e6);
        return;
    }
    run->begin.is_there = true;
    run->begin.line = message->line;
    (void)snprintf(run->begin.text, sizeof run->begin.text, "%s", message->command);
}

static void end_command(wh_log_run_t *run, const waferhand_mcs *message) {
    const bool done = message->phase == WH_LINK_PHASE_DONE;
    wh_recorder_end(&run->recorder, (double)message->utime / 1e6, done ? WH_OK : (wh_status_t)message->error,
                    message->text, run->state.wafers);
}

/* The text of the running command, or null. */
static const char *running_text(const wh_log_run_t *run) {
    return run->recorder.running == WH_NONE ? NULL : run->record.commands[run->recorder.running].text;
}

/* A command begins once, however often that is said. */
static bool is_running(const wh_log_run_t *run, const waferhand_mcs *message) {
    const char *text = running_text(run);
    return text && strcmp(text, message->command) == 0;
}

static void take_mcs(wh_log_run_t *run, const waferhand_mcs *message) {
    const bool ours = run->is_wanted && run->recorder.record && message->run == run->run;
    const bool ended = message->phase == WH_LINK_PHASE_DONE || message->phase == WH_LINK_PHASE_FAILED;
    if (message->phase == WH_LINK_PHASE_BEGINS && !(ours && is_running(run, message))) {
        begin_command(run, message, ours);
    } else if (ended && ours && is_running(run, message)) {
        end_command(run, message);
    }
}

/* ------------------------------------------------------------------------------------------------- slices */

static bool is_told_to_wait(const wh_log_run_t *run) {
    const char *text = running_text(run);
    return !text || strncmp(text, "WAIT", 4) == 0;
}

/* What the robot stood still for in a slice, as far as valves and sensors tell. */
static wh_share_t share_standing(const wh_log_run_t *run, const int32_t valves[], const wh_state_t *state) {
    bool waits = false;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        if (valves[g] != run->told.grippers[g].valve) {
            return WH_SHARE_HANDOVER;
        }
        waits = waits || (valves[g] == WH_VALVE_OPEN && (state->sensors >> g & 1U) == 0);
    }
    return waits && !is_told_to_wait(run) ? WH_SHARE_VACUUM : WH_SHARE_WAITING;
}

static wh_task_t task_of(const wh_log_run_t *run, const double axes[], const int32_t valves[],
                         const wh_state_t *state) {
    bool moving[WH_AXES];
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        moving[axis] = wh_real_abs(axes[axis] - run->told.axes[axis]) > 0;
    }
    return wh_activity_motion(&run->cell.layout->machine, moving, share_standing(run, valves, state));
}

static void count_slice(wh_log_run_t *run, int64_t seq, const double axes[]) {
    const wh_state_t *state = &run->state;
    run->recorder.task = task_of(run, axes, state->physics->told, state);
    run->told.seq = seq;
    memcpy(run->told.axes, axes, sizeof run->told.axes);
    for (size_t g = 0; g < state->gripper_count; ++g) {
        run->told.grippers[g].valve = state->physics->told[g];
    }
    wh_recorder_slice(&run->recorder, &run->told, state);
}

static void start(wh_log_run_t *run, bool from_the_beginning) {
    const wh_machine_t *machine = &run->cell.layout->machine;
    wh_signals_begin(&run->signals, run->cell.layout, from_the_beginning && run->cell.is_whole);
    memset(&run->told, 0, sizeof run->told);
    memcpy(run->told.axes, machine->robot.home, sizeof machine->robot.home);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        run->told.grippers[g].valve = WH_VALVE_CLOSED;
    }
}

/* The axes of the state's command, if that is the last one that came; else where they were. */
static bool find_axes(const wh_log_run_t *run, const waferhand_state *message, double axes[]) {
    const waferhand_command *command = &run->command;
    bool known = run->has_command && command->run == message->run && command->seq == message->seq;
    for (int32_t axis = 0; known && axis < command->axis_count; ++axis) {
        known = wh_real_abs(command->axis_position[axis]) < FARTHEST;
    }
    memcpy(axes, run->told.axes, sizeof run->told.axes);
    for (int32_t axis = 0; known && axis < command->axis_count; ++axis) {
        axes[axis] = command->axis_position[axis];
    }
    return known;
}

static void take_slice(wh_log_run_t *run, const waferhand_state *message) {
    double axes[WH_AXES];
    const bool known = find_axes(run, message, axes);
    if (!run->signals.layout) {
        start(run, message->seq == 1);
    }
    run->gaps += run->seq > 0 && message->seq > run->seq + 1 ? 1 : 0;
    run->seq = message->seq;
    run->hash = (uint64_t)message->hash;
    run->missed = message->missed;
    count_slice(run, message->seq, axes);
    if (run->collision.memory) {
        wh_collision_observe(&run->collision, &run->state);
    }
    wh_signals_slice(&run->signals, known ? axes : NULL, (size_t)run->command.axis_count, &run->state);
    if (is_boundary(run)) {
        wh_signals_mark(&run->signals);
    }
}

static bool is_place(const wh_pose_t *pose) {
    return wh_pose_validate(pose) == WH_OK && wh_real_abs(pose->r.x) < FARTHEST &&
           wh_real_abs(pose->r.y) < FARTHEST && wh_real_abs(pose->r.z) < FARTHEST;
}

static bool is_index(int32_t index, size_t count) {
    return index == WH_NONE || (index >= 0 && (size_t)index < count);
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

static void take_state(wh_log_run_t *run, const waferhand_state *message) {
    const wh_layout_t *layout = run->cell.layout;
    const bool refusal = message->status != WH_OK;
    const bool is_new = message->seq > run->seq && (!refusal || message->seq > run->refused);
    if (!layout || !is_new || (uint64_t)message->layout_hash != run->cell.hash ||
        wh_link_state_from_message(message, &layout->grasp.tolerance, &run->arrays, &run->state) != WH_OK ||
        !is_sound(&run->state, layout)) {
        return;
    }
    wh_recorder_events(&run->recorder, &run->state);
    if (refusal) {
        run->refused = message->seq;
    } else {
        take_slice(run, message);
    }
}

static void finish_run(wh_log_run_t *run) {
    const wh_recorder_end_t end = {run->state.wafers, run->hash, run->missed, run->collision.world};
    if (run->recorder.running != WH_NONE) {
        run->record.commands[run->recorder.running].end_s = wh_recorder_now(&run->recorder);
    }
    wh_recorder_finish(&run->recorder, &end);
    wh_signals_finish(&run->signals);
}

/* ----------------------------------------------------------------------------------------------- messages */

static void on_cell(wh_log_run_t *run) {
    waferhand_cell message;
    if (!wh_link_decode_cell(run->log.data, run->log.size, &message)) {
        return;
    }
    const uint64_t hash = (uint64_t)message.layout_hash;
    const wh_log_layout_t *last = run->next_cell.layout ? &run->next_cell : &run->cell;
    if (!last->layout || last->hash != hash) {
        wh_log_layout_t made;
        if (wh_log_layout_make(&made, &message, &run->options.layout)) {
            wh_log_layout_free(&run->next_cell);
            run->next_cell = made;
        }
    }
    (void)waferhand_cell_decode_cleanup(&message);
}

static void on_command(wh_log_run_t *run) {
    wh_command_t checked;
    run->has_command = wh_link_decode_command(run->log.data, run->log.size, &run->command) &&
                       wh_link_command_from_message(&run->command, &checked) == WH_OK;
}

static void on_state(wh_log_run_t *run) {
    waferhand_state message;
    if (!wh_link_decode_state(run->log.data, run->log.size, &message)) {
        return;
    }
    if (message.run != run->run && message.status == WH_OK && message.seq > 0) {
        ++run->run_count;
        run->run = message.run;
        run->seq = 0;
        run->is_wanted = wants(run);
        if (run->is_wanted) {
            begin_run(run);
        }
    }
    if (message.run == run->run && run->is_wanted) {
        take_state(run, &message);
    }
    (void)waferhand_state_decode_cleanup(&message);
}

static void on_mcs(wh_log_run_t *run) {
    waferhand_mcs message;
    if (wh_link_decode_mcs(run->log.data, run->log.size, &message)) {
        take_mcs(run, &message);
        (void)waferhand_mcs_decode_cleanup(&message);
    }
}

static void take_event(wh_log_run_t *run) {
    static const struct {
        const char *channel;
        void (*take)(wh_log_run_t *run);
    } channels[] = {{WH_CHANNEL_CELL, on_cell},
                    {WH_CHANNEL_COMMAND, on_command},
                    {WH_CHANNEL_STATE, on_state},
                    {WH_CHANNEL_MCS, on_mcs}};
    const bool fits = run->log.size > 0 && run->log.size <= WH_LINK_DATAGRAM;
    for (size_t i = 0; fits && i < sizeof channels / sizeof channels[0]; ++i) {
        if (strcmp(channels[i].channel, run->log.channel) == 0) {
            channels[i].take(run);
        }
    }
}

/* ---------------------------------------------------------------------------------------------- the whole */

static void note_boundary(wh_log_run_t *run) {
    waferhand_mcs message;
    if (!wh_link_decode_mcs(run->log.data, run->log.size, &message)) {
        return;
    }
    run->boundaries =
        wh_array_grow(run->boundaries, run->boundary_count, &run->boundary_capacity, sizeof *run->boundaries);
    const wh_log_boundary_t boundary = {message.run, message.seq};
    if (message.phase != WH_LINK_PHASE_GOES_ON) {
        run->boundaries[run->boundary_count++] = boundary;
    }
    (void)waferhand_mcs_decode_cleanup(&message);
}

/* The first pass over the log. It finds the first cell, for the cell is told once a second and a recording
 * may begin before that. And it notes the slices with which commands begin and end, for an end may be told
 * after the next slice. */
static void look_ahead(wh_log_run_t *run, FILE *file) {
    wh_log_open(&run->log, file);
    while (wh_log_next(&run->log) == WH_LOG_EVENT) {
        const bool fits = run->log.size > 0 && run->log.size <= WH_LINK_DATAGRAM;
        if (fits && !run->next_cell.layout && strcmp(run->log.channel, WH_CHANNEL_CELL) == 0) {
            on_cell(run);
        } else if (fits && strcmp(run->log.channel, WH_CHANNEL_MCS) == 0) {
            note_boundary(run);
        }
    }
    if (run->boundary_count > 0) {
        qsort(run->boundaries, run->boundary_count, sizeof *run->boundaries, compare);
    }
    rewind(file);
}

static wh_log_result_t read_events(wh_log_run_t *run, FILE *file) {
    wh_log_result_t result;
    wh_log_open(&run->log, file);
    while ((result = wh_log_next(&run->log)) == WH_LOG_EVENT) {
        take_event(run);
    }
    return result;
}

static void tell(wh_log_run_t *run, wh_log_result_t result) {
    note(run, "From a log: what the script expected and its cycles are not in it.");
    if (!run->cell.is_whole) {
        note(run, "Shapes are the defaults of 300 mm wafers: %.140s.", run->cell.note);
    }
    if (run->gaps > 0) {
        note(run, "%zu stretches of slices are not in the log.", run->gaps);
    }
    if (result == WH_LOG_CUT || result == WH_LOG_DAMAGED) {
        note(run, "The log is %s at byte %" PRIu64 ": shown up to there.",
             result == WH_LOG_CUT ? "cut off" : "damaged", run->log.offset);
    }
}

static bool refuse_log(wh_log_run_t *run, wh_log_result_t result) {
    if (run->log.count == 0 && result != WH_LOG_END) {
        return refuse(run, "no LCM event log (expected one, or a script)");
    }
    if (!run->cell.layout && !run->next_cell.layout) {
        return refuse(run, "no cell in it (expected WAFERHAND_CELL, which a simulator tells once a second)");
    }
    if (run->options.number > 0 && run->run_count > 0) {
        return refuse(run, "no run %zu in it (expected 1 to %zu)", run->options.number, run->run_count);
    }
    return refuse(run, "no run in it (expected states on WAFERHAND_STATE, in %" PRIu64 " events)",
                  run->log.count);
}

bool wh_log_run_read(wh_log_run_t *run, const wh_log_run_options_t *options) {
    memset(run, 0, sizeof *run);
    run->options = *options;
    FILE *file = wh_log_file(options->path);
    if (!file) {
        return refuse(run, "%s (expected an LCM event log, or a script)", strerror(errno));
    }
    look_ahead(run, file);
    const wh_log_result_t result = read_events(run, file);
    (void)fclose(file);
    if (!run->signals.layout || run->signals.last <= 0) {
        return refuse_log(run, result);
    }
    finish_run(run);
    tell(run, result);
    return true;
}

void wh_log_run_close(wh_log_run_t *run) {
    drop_run(run);
    wh_log_layout_free(&run->cell);
    wh_log_layout_free(&run->next_cell);
    free(run->boundaries);
    run->boundaries = NULL;
}
