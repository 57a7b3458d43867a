#include "field_run.h"

#include <stdio.h>
#include <string.h>

/* A row this near to a slice's time is that slice: a share of a slice. */
#define AT_SLICE 1e-3

/* The row before the present one. */
typedef struct {
    double time_s;
    wh_real_t q[WH_AXES];
    uint32_t on;
} row_t;

static row_t row_of(const wh_field_log_t *field) {
    row_t row = {.time_s = field->time_s, .on = field->on};
    memcpy(row.q, field->q, sizeof row.q);
    return row;
}

static double slice_s(const wh_field_run_t *run) {
    return (double)run->plant->layout->slice_us / 1e6;
}

double wh_field_time(const wh_field_run_t *run) {
    return run->first_s + (double)(wh_plant_slice(run->plant) - 1) * slice_s(run);
}

/* Keeps the first text of its kind, with its line. */
static void note(size_t *line, char to[WH_PLANT_TEXT], const char *text, size_t at) {
    if (*line == 0) {
        *line = at;
        memcpy(to, text, WH_PLANT_TEXT);
    }
}

static bool play_slice(wh_field_run_t *run, const wh_real_t q[], uint32_t on) {
    char text[WH_PLANT_TEXT];
    const wh_status_t taken = wh_plant_move(run->plant, q, on, text);
    if (taken != WH_OK) {
        note(&run->refused_line, run->refused, text, run->field->line);
    } else if (text[0] != '\0') {
        note(&run->jumped_line, run->jumped, text, run->field->line);
    }
    run->status = wh_plant_step(run->plant);
    if (run->status == WH_OK && run->stepped) {
        run->stepped(run->stepped_user, &run->plant->command, run->field->line);
    }
    return run->status == WH_OK;
}

/* A slice between two rows. */
static bool play_between(wh_field_run_t *run, const row_t *from, double share) {
    const wh_field_log_t *field = run->field;
    wh_real_t q[WH_AXES];
    for (size_t axis = 0; axis < field->layout->machine.axis_count; ++axis) {
        q[axis] = from->q[axis] + share * (field->q[axis] - from->q[axis]);
    }
    return play_slice(run, q, from->on);
}

/* Plays all slices up to the present row. */
static bool play_to_row(wh_field_run_t *run, const row_t *from) {
    const wh_field_log_t *field = run->field;
    const double reach_s = AT_SLICE * slice_s(run);
    const int64_t before = wh_plant_slice(run->plant);
    double at_s = wh_field_time(run) + slice_s(run);
    bool good = true;
    while (good && at_s <= field->time_s + reach_s) {
        good = at_s >= field->time_s - reach_s
                   ? play_slice(run, field->q, field->on)
                   : play_between(run, from, (at_s - from->time_s) / (field->time_s - from->time_s));
        at_s = wh_field_time(run) + slice_s(run);
    }
    run->between += wh_plant_slice(run->plant) == before ? 1 : 0;
    return good;
}

/* ------------------------------------------------------------------------------------------------ sensors */

static void open_difference(wh_field_sensor_t *sensor, const wh_field_log_t *field, bool logged) {
    if (!sensor->is_open || sensor->open_logged != logged) {
        sensor->is_open = true;
        sensor->open_line = field->line;
        sensor->open_s = field->time_s;
        sensor->open_logged = logged;
    }
}

static void compare_sensor(const wh_field_run_t *run, wh_field_sensor_t *sensor, bool logged,
                           bool simulated) {
    const wh_field_log_t *field = run->field;
    if (logged == simulated) {
        sensor->is_open = false;
        return;
    }
    ++sensor->rows;
    open_difference(sensor, field, logged);
    const double lasts_s = field->time_s - sensor->open_s;
    if (!sensor->is_there && (run->options.within_s == 0 || lasts_s > run->options.within_s)) {
        sensor->is_there = true;
        sensor->line = sensor->open_line;
        sensor->time_s = sensor->open_s;
        sensor->logged = logged;
    }
}

static void compare_sensors(wh_field_run_t *run) {
    const uint32_t simulated = run->plant->simulation->server.state.sensors;
    for (size_t g = 0; g < run->field->layout->machine.gripper_count; ++g) {
        if ((run->field->has_sensors >> g & 1U) != 0) {
            compare_sensor(run, &run->sensors[g], (run->field->sensed >> g & 1U) != 0,
                           (simulated >> g & 1U) != 0);
        }
    }
}

size_t wh_field_first_sensor(const wh_field_run_t *run) {
    const size_t count = run->field->layout->machine.gripper_count;
    size_t first = count;
    for (size_t g = 0; g < count; ++g) {
        const bool is_earlier = first == count || run->sensors[g].time_s < run->sensors[first].time_s;
        first = run->sensors[g].is_there && is_earlier ? g : first;
    }
    return first;
}

/* ------------------------------------------------------------------------------------------------ whole */

static void note_gap(wh_field_run_t *run, const row_t *from) {
    const double gap_s = run->field->time_s - from->time_s;
    run->holes += gap_s > run->options.gap_s ? 1 : 0;
    if (gap_s > run->longest_s) {
        run->longest_s = gap_s;
        run->longest_line = run->field->line;
    }
}

static void note_moves(const wh_field_run_t *run) {
    if (run->moves) {
        wh_field_moves_take(run->moves, run->field->time_s, run->field->q);
    }
}

bool wh_field_play(wh_field_run_t *run) {
    wh_field_log_t *field = run->field;
    if (!wh_field_read(field)) {
        return false;
    }
    run->first_s = field->time_s;
    bool good = play_slice(run, field->q, field->on);
    row_t before = row_of(field);
    for (run->rows = 1; good; ++run->rows) {
        run->last_s = field->time_s;
        compare_sensors(run);
        note_moves(run);
        if (!wh_field_read(field)) {
            break;
        }
        note_gap(run, &before);
        good = play_to_row(run, &before);
        before = row_of(field);
    }
    return good && field->message[0] == '\0';
}
