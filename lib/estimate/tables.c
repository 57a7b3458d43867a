#include "tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "../text/array.h"

/* The largest place and distance; beyond it, a double cannot resolve 1e-9 mm. */
#define LARGEST 1e6
#define MOST_SECONDS 1e5
/* Times that were rounded to 1 ms scatter by up to 0.58 ms; those of a real axis by more. */
#define SIMULATED_S 0.6e-3

/* ------------------------------------------------------------------------------------------------- points */

enum { STATION, TOUCHED_X, TOUCHED_Y, TOUCHED_Z, KNOWN_X, KNOWN_Y, KNOWN_Z, POINT_COLUMNS };

static const wh_csv_column_t point_columns[POINT_COLUMNS] = {
    [STATION] = {"station", 0, 0, true, false},
    [TOUCHED_X] = {"touched_x", -LARGEST, LARGEST, false, false},
    [TOUCHED_Y] = {"touched_y", -LARGEST, LARGEST, false, false},
    [TOUCHED_Z] = {"touched_z", -LARGEST, LARGEST, false, false},
    [KNOWN_X] = {"x", -LARGEST, LARGEST, false, false},
    [KNOWN_Y] = {"y", -LARGEST, LARGEST, false, false},
    [KNOWN_Z] = {"z", -LARGEST, LARGEST, false, false},
};

/* The station of a name, or a new one; null if there are too many. */
static wh_station_points_t *find_station(wh_point_table_t *table, const char *name) {
    for (size_t i = table->count; i-- > 0;) {
        if (strcmp(table->stations[i].name, name) == 0) {
            return &table->stations[i];
        }
    }
    if (table->count == WH_TABLE_STATIONS) {
        return NULL;
    }
    table->stations = wh_array_grow(table->stations, table->count, &table->capacity, sizeof *table->stations);
    wh_station_points_t *station = &table->stations[table->count++];
    *station = (wh_station_points_t){.name = name};
    return station;
}

static bool add_point(wh_point_table_t *table) {
    const double *n = table->csv.numbers;
    wh_station_points_t *station = find_station(table, table->csv.texts[STATION]);
    if (!station) {
        return wh_csv_refuse(&table->csv, STATION, "at most 1000 stations in a table");
    }
    const size_t i = station->count;
    station->points = wh_array_grow(station->points, i, &station->capacity, sizeof *station->points);
    station->lines = wh_array_grow(station->lines, i, &station->line_capacity, sizeof *station->lines);
    station->points[i] = (wh_frame_point_t){.touched = {n[TOUCHED_X], n[TOUCHED_Y], n[TOUCHED_Z]},
                                            .known = {n[KNOWN_X], n[KNOWN_Y], n[KNOWN_Z]}};
    station->lines[i] = table->csv.line;
    ++station->count;
    return true;
}

/* Concludes a table that was read to its end. */
static wh_status_t conclude(wh_csv_t *csv, bool has_rows) {
    if (csv->message[0] == '\0' && !has_rows) {
        (void)wh_csv_refuse_file(csv, "it has no line of measurements");
    }
    return csv->message[0] == '\0' ? WH_OK : WH_STATUS_BAD_TABLE;
}

wh_status_t wh_point_table_open(wh_point_table_t *table, const char *path) {
    bool good = wh_csv_open(&table->csv, path, point_columns, POINT_COLUMNS);
    while (good && wh_csv_read(&table->csv)) {
        good = add_point(table);
    }
    return conclude(&table->csv, table->count > 0);
}

bool wh_point_table_estimate(wh_point_table_t *table) {
    bool is_determined = true;
    for (size_t i = 0; i < table->count; ++i) {
        wh_station_points_t *station = &table->stations[i];
        is_determined =
            wh_frame_estimate(station->points, station->count, &station->estimate) == WH_OK && is_determined;
    }
    return is_determined;
}

void wh_point_table_close(wh_point_table_t *table) {
    for (size_t i = 0; i < table->count; ++i) {
        free(table->stations[i].points);
        free(table->stations[i].lines);
    }
    free(table->stations);
    table->stations = NULL;
    table->count = table->capacity = 0;
    wh_csv_close(&table->csv);
}

/* -------------------------------------------------------------------------------------------------- moves */

enum { AXIS, FROM, TO, SECONDS, MOVE_COLUMNS };

static const wh_csv_column_t move_columns[MOVE_COLUMNS] = {
    [AXIS] = {"axis", 0, 0, true, false},
    [FROM] = {"from", -LARGEST, LARGEST, false, false},
    [TO] = {"to", -LARGEST, LARGEST, false, false},
    [SECONDS] = {"seconds", 1e-6, MOST_SECONDS, false, false},
};

static const char *const axis_names[WH_TABLE_AXES] = {
    [WH_AXIS_THETA] = "theta", [WH_AXIS_R] = "r", [WH_AXIS_Z] = "z", [WH_AXIS_YAW] = "yaw", "chuck"};

const char *wh_table_axis_name(size_t axis) {
    return axis_names[axis];
}

bool wh_table_axis_turns(size_t axis) {
    return axis != WH_AXIS_R && axis != WH_AXIS_Z;
}

static bool add_move(wh_move_table_t *table) {
    wh_csv_t *csv = &table->csv;
    size_t axis = 0;
    while (axis < WH_TABLE_AXES && strcmp(axis_names[axis], csv->texts[AXIS]) != 0) {
        ++axis;
    }
    if (axis == WH_TABLE_AXES) {
        return wh_csv_refuse(csv, AXIS, "theta, r, z, yaw or chuck");
    }
    const double distance = fabs(csv->numbers[TO] - csv->numbers[FROM]);
    if (distance < 1e-9) {
        return wh_csv_refuse(csv, TO, "another place than `from`");
    }
    wh_axis_moves_t *moves = &table->axes[axis];
    const size_t i = moves->count;
    if (i == WH_LIMITS_MOST_MOVES) {
        return wh_csv_refuse(csv, AXIS, "at most 10000 moves of an axis");
    }
    moves->moves = wh_array_grow(moves->moves, i, &moves->capacity, sizeof *moves->moves);
    moves->lines = wh_array_grow(moves->lines, i, &moves->line_capacity, sizeof *moves->lines);
    moves->moves[i] = (wh_timed_move_t){distance, csv->numbers[SECONDS], false};
    moves->lines[i] = csv->line;
    ++moves->count;
    return true;
}

wh_status_t wh_move_table_open(wh_move_table_t *table, const char *path) {
    bool good = wh_csv_open(&table->csv, path, move_columns, MOVE_COLUMNS);
    bool has_rows = false;
    while (good && wh_csv_read(&table->csv)) {
        good = add_move(table);
        has_rows = true;
    }
    return conclude(&table->csv, has_rows);
}

bool wh_move_table_estimate(wh_move_table_t *table, bool with_delay) {
    bool is_determined = true;
    for (size_t axis = 0; axis < WH_TABLE_AXES; ++axis) {
        wh_axis_moves_t *moves = &table->axes[axis];
        if (moves->count > 0) {
            const wh_status_t status =
                wh_limits_estimate(moves->moves, moves->count, with_delay, &moves->estimate);
            is_determined = is_determined && status == WH_OK && moves->estimate.reason[0] == '\0';
        }
    }
    return is_determined;
}

bool wh_axis_moves_look_simulated(const wh_axis_moves_t *moves) {
    const wh_limits_estimate_t *estimate = &moves->estimate;
    return estimate->status == WH_OK && estimate->set_aside == 0 && moves->count >= WH_LIMITS_MOVES &&
           estimate->rms <= SIMULATED_S;
}

void wh_move_table_close(wh_move_table_t *table) {
    for (size_t axis = 0; axis < WH_TABLE_AXES; ++axis) {
        free(table->axes[axis].moves);
        free(table->axes[axis].lines);
        table->axes[axis] = (wh_axis_moves_t){.count = 0};
    }
    wh_csv_close(&table->csv);
}

/* ------------------------------------------------------------------------------------------------ touches */

enum { THERE_X = WH_ROBOT_AXES, THERE_Y, THERE_Z, HEADING, TOUCH_COLUMNS };

static const wh_csv_column_t touch_columns[TOUCH_COLUMNS] = {
    [WH_AXIS_THETA] = {"theta", -LARGEST, LARGEST, false, false},
    [WH_AXIS_R] = {"r", -LARGEST, LARGEST, false, false},
    [WH_AXIS_Z] = {"z", -LARGEST, LARGEST, false, false},
    [WH_AXIS_YAW] = {"yaw", -LARGEST, LARGEST, false, false},
    [THERE_X] = {"touched_x", -LARGEST, LARGEST, false, false},
    [THERE_Y] = {"touched_y", -LARGEST, LARGEST, false, false},
    [THERE_Z] = {"touched_z", -LARGEST, LARGEST, false, false},
    [HEADING] = {"heading", -LARGEST, LARGEST, false, true},
};

static bool add_touch(wh_touch_table_t *table) {
    const double *n = table->csv.numbers;
    const size_t i = table->count;
    if (i == WH_GEOMETRY_MOST_TOUCHES) {
        return wh_csv_refuse(&table->csv, WH_AXIS_THETA, "at most 1000 touches in a table");
    }
    table->touches = wh_array_grow(table->touches, i, &table->capacity, sizeof *table->touches);
    table->lines = wh_array_grow(table->lines, i, &table->line_capacity, sizeof *table->lines);
    wh_touch_t *touch = &table->touches[i];
    *touch = (wh_touch_t){.touched = {n[THERE_X], n[THERE_Y], n[THERE_Z]}};
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        touch->axes[axis] = wh_table_axis_turns(axis) ? wh_rad_from_deg(n[axis]) : n[axis];
    }
    touch->heading = wh_rad_from_deg(n[HEADING]);
    table->lines[i] = table->csv.line;
    ++table->count;
    return true;
}

wh_status_t wh_touch_table_open(wh_touch_table_t *table, const char *path) {
    bool good = wh_csv_open(&table->csv, path, touch_columns, TOUCH_COLUMNS);
    while (good && wh_csv_read(&table->csv)) {
        good = add_touch(table);
    }
    return conclude(&table->csv, table->count > 0);
}

bool wh_touch_table_estimate(wh_touch_table_t *table, bool with_scales) {
    const wh_status_t status =
        wh_geometry_estimate(table->touches, table->count, with_scales, &table->estimate);
    return status == WH_OK && table->estimate.reason[0] == '\0';
}

void wh_touch_table_close(wh_touch_table_t *table) {
    free(table->touches);
    free(table->lines);
    table->touches = NULL;
    table->lines = NULL;
    table->count = table->capacity = table->line_capacity = 0;
    wh_csv_close(&table->csv);
}
