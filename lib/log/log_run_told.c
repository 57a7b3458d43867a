/* Takes motion control's messages about a run, slice by slice: commands, expectations, cycles and the
 * verdict. */
#include "log_run_internal.h"

#include <stdlib.h>
#include <string.h>

#include "../link/station_told.h"
#include "../text/array.h"

/* A command begins once, however often a message says so. */
static bool is_running(const wh_log_run_t *run, const waferhand_mcs *told) {
    const int32_t running = run->recorder.running; /* of the task in the message */
    return running != WH_NONE && strcmp(run->record.commands[running].text, told->command) == 0;
}

static void mark(wh_log_run_t *run) {
    run->taken.has_opened_valve = false;
    if (run->signals.layout && run->signals.last > 0) {
        wh_signals_mark(&run->signals);
    }
}

static void take_end(wh_log_run_t *run, const waferhand_mcs *told) {
    if (told->request == 0 && is_running(run, told)) {
        const wh_status_t error = told->phase == WH_LINK_PHASE_DONE ? WH_OK : (wh_status_t)told->error;
        wh_recorder_end(&run->recorder, (double)told->utime / 1e6, error, told->text, run->state.wafers);
        mark(run);
    }
}

/* False for a repeated message, as over a lossy network: its number is known. */
static bool is_new(wh_log_run_t *run, const waferhand_mcs *told) {
    const bool is_cycle = told->phase == WH_LINK_PHASE_CYCLE;
    int32_t *last = is_cycle ? &run->told.last_cycle : &run->told.last_expectation;
    if (told->error > *last) {
        *last = told->error;
        return true;
    }
    for (size_t i = 0; &run->told.items[i].message < told; ++i) {
        const waferhand_mcs *before = &run->told.items[i].message;
        if (before->phase >= WH_LINK_PHASE_MET && (before->phase == WH_LINK_PHASE_CYCLE) == is_cycle &&
            before->error == told->error) {
            return false;
        }
    }
    return true;
}

/* Takes a message about a task; from the first one on there are tasks. */
static void take_turn(wh_log_run_t *run, const waferhand_mcs *told) {
    wh_log_lane_t *lane = wh_log_run_find_lane(run, told->task);
    const bool waits = told->phase == WH_LINK_PHASE_WAITS;
    run->record.has_tasks = true;
    if (lane) {
        lane->axes = waits ? 0 : (uint32_t)told->axes;
        lane->grippers = waits ? 0 : (uint32_t)told->grippers;
    }
    if (waits) {
        wh_recorder_wait(&run->recorder, told->text);
    } else {
        wh_recorder_go_on(&run->recorder);
    }
}

/* Takes the command of a task or of the script; true if the message has one. */
static bool take_command(wh_log_run_t *run, const waferhand_mcs *told) {
    bool is_taken = true;
    wh_log_run_choose_task(run, told->task);
    switch (told->phase) {
    case WH_LINK_PHASE_BEGINS:
        if (!is_running(run, told)) {
            wh_recorder_begin(&run->recorder, told->line, told->command, (double)told->utime / 1e6);
            mark(run);
        }
        break;
    case WH_LINK_PHASE_DONE:
    case WH_LINK_PHASE_FAILED:
        take_end(run, told);
        break;
    case WH_LINK_PHASE_WAITS:
    case WH_LINK_PHASE_ON:
        take_turn(run, told);
        break;
    default:
        is_taken = false;
        break;
    }
    wh_log_run_keep_task(run);
    return is_taken;
}

/* A repeated message is known by its number. */
static void take_station(wh_log_run_t *run, const waferhand_mcs *told) {
    const wh_layout_t *layout = run->cell.layout;
    wh_station_event_record_t event;
    if (told->error > run->told.last_station &&
        wh_station_told_read(told->text, layout->station_count, layout->wafer_count, &event)) {
        run->told.last_station = told->error;
        wh_record_add_station_event(&run->record, &event);
    }
}

static void take_told(wh_log_run_t *run, const waferhand_mcs *told) {
    if (take_command(run, told)) {
        return;
    }
    switch (told->phase) {
    case WH_LINK_PHASE_MET:
    case WH_LINK_PHASE_UNMET:
        if (is_new(run, told)) {
            wh_record_add_expectation(&run->record, told->line, told->text, told->phase == WH_LINK_PHASE_MET);
        }
        break;
    case WH_LINK_PHASE_CYCLE:
        if (is_new(run, told)) {
            wh_record_add_cycle(&run->record, told->line, told->text, told->seq);
        }
        break;
    case WH_LINK_PHASE_STATION:
        take_station(run, told);
        break;
    default:
        break;
    }
}

void wh_log_run_take_told_before(wh_log_run_t *run, int64_t seq) {
    while (run->told.next < run->told.count && run->told.items[run->told.next].message.seq < seq) {
        take_told(run, &run->told.items[run->told.next++].message);
    }
}

void wh_log_run_add_told(wh_log_run_t *run, waferhand_mcs *message) {
    if (message->run == 0 || message->phase == WH_LINK_PHASE_IDLE ||
        message->phase == WH_LINK_PHASE_GOES_ON) {
        (void)waferhand_mcs_decode_cleanup(message);
        return;
    }
    run->told.items =
        wh_array_grow(run->told.items, run->told.count, &run->told.capacity, sizeof *run->told.items);
    run->told.items[run->told.count] = (wh_log_told_t){*message, run->told.count};
    ++run->told.count;
}

static int compare(const void *a, const void *b) {
    const wh_log_told_t *one = a;
    const wh_log_told_t *two = b;
    if (one->message.seq != two->message.seq) {
        return one->message.seq < two->message.seq ? -1 : 1;
    }
    return (one->order > two->order) - (one->order < two->order);
}

void wh_log_run_choose_told(wh_log_run_t *run) {
    size_t kept = 0;
    for (size_t i = 0; i < run->told.count; ++i) {
        if (run->told.items[i].message.run == run->wanted->run) {
            run->told.items[kept++] = run->told.items[i];
        } else {
            (void)waferhand_mcs_decode_cleanup(&run->told.items[i].message);
        }
    }
    run->told.count = kept;
    if (kept > 0) {
        qsort(run->told.items, kept, sizeof *run->told.items, compare);
    }
}

void wh_log_run_judge(wh_log_run_t *run) {
    const char *reason = NULL;
    for (size_t i = 0; i < run->told.count; ++i) {
        if (run->told.items[i].message.phase == WH_LINK_PHASE_OVER) {
            reason = wh_outcome_read(run->told.items[i].message.text, &run->told.outcome);
        }
    }
    if (run->told.outcome.verdict == WH_OUTCOME_FAILED && reason && reason[0] != '\0') {
        run->record.failure = wh_text_copy(reason);
    }
}
