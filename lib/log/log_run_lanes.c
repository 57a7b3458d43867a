/* Several commands at once in a log: the command of each task, its mechanisms, and its share of each
 * slice. */
#include "log_run_internal.h"

wh_log_lane_t *wh_log_run_find_lane(wh_log_run_t *run, int32_t task) {
    wh_log_lane_t *found = NULL;
    for (size_t i = 0; i < run->lane_count; ++i) {
        found = run->lanes[i].task == task ? &run->lanes[i] : found;
    }
    return found;
}

void wh_log_run_choose_task(wh_log_run_t *run, int32_t task) {
    const wh_log_lane_t *lane = wh_log_run_find_lane(run, task);
    run->recorder.number = task;
    run->recorder.running = lane ? lane->running : WH_NONE;
}

void wh_log_run_keep_task(wh_log_run_t *run) {
    wh_recorder_t *recorder = &run->recorder;
    wh_log_lane_t *lane = wh_log_run_find_lane(run, recorder->number);
    if (lane && recorder->running == WH_NONE) {
        *lane = run->lanes[--run->lane_count];
    } else if (lane && lane->running != recorder->running) {
        *lane = (wh_log_lane_t){.task = recorder->number, .running = recorder->running};
    } else if (!lane && recorder->running != WH_NONE && run->lane_count < WH_RECORDER_PARTS) {
        run->lanes[run->lane_count++] =
            (wh_log_lane_t){.task = recorder->number, .running = recorder->running};
    }
    if (run->record.has_tasks) {
        recorder->running = WH_NONE;
    } else {
        wh_log_run_choose_task(run, 0);
    }
}

void wh_log_run_set_parts(wh_log_run_t *run) {
    wh_recorder_t *recorder = &run->recorder;
    recorder->part_count = run->record.has_tasks ? run->lane_count : 0;
    for (size_t i = 0; i < recorder->part_count; ++i) {
        recorder->parts[i] =
            (wh_recorder_part_t){.command = run->lanes[i].running, .grippers = run->lanes[i].grippers};
    }
}

/* The reason why its command stands still in a slice, as far as valves tell. */
static wh_share_t share_standing(const wh_log_run_t *run, const wh_log_lane_t *lane) {
    const wh_state_t *state = &run->state;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const bool switches = state->physics->told[g] != run->taken.last.grippers[g].valve;
        if (switches && (lane->grippers >> g & 1U) != 0) {
            return WH_SHARE_HANDOVER;
        }
    }
    return lane->has_opened_valve ? WH_SHARE_VACUUM : WH_SHARE_WAITING;
}

static void note_valves(const wh_log_run_t *run, wh_log_lane_t *lane, const bool moving[WH_AXES]) {
    const wh_state_t *state = &run->state;
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        lane->has_opened_valve = lane->has_opened_valve && !(moving[axis] && axis != WH_AXIS_Z);
    }
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const bool waits = wh_log_run_begins_wait(run, g) && (lane->grippers >> g & 1U) != 0;
        lane->has_opened_valve = lane->has_opened_valve || waits;
    }
}

void wh_log_run_count_parts(wh_log_run_t *run, const bool moving[WH_AXES]) {
    const wh_machine_t *machine = &run->cell.layout->machine;
    wh_recorder_t *recorder = &run->recorder;
    recorder->task = (wh_task_t){.share = WH_SHARE_WAITING};
    for (size_t i = 0; i < recorder->part_count; ++i) {
        wh_log_lane_t *lane = &run->lanes[i];
        bool own[WH_AXES];
        for (size_t axis = 0; axis < WH_AXES; ++axis) {
            own[axis] = moving[axis] && (lane->axes >> axis & 1U) != 0;
        }
        wh_task_t *task = &recorder->parts[i].task;
        *task = wh_activity_motion(machine, own, share_standing(run, lane));
        wh_activity_narrow(task, machine, lane->axes);
        note_valves(run, lane, own);
    }
}
