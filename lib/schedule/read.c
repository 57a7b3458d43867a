#include "read.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "../text/array.h"
#include "../text/nearest.h"
#include "../text/utf8.h"

#define SHOWN 100

/* The most rows: they have numbers of 32 bits, and each has a begin and an end. */
#define MOST_ROWS 1000000000

/* ----------------------------------------------------------------------------------------------- refusals */

__attribute__((format(printf, 2, 3))) static bool refuse(wh_schedule_reader_t *reader, const char *format,
                                                         ...) {
    va_list arguments;
    const int length = snprintf(reader->message, sizeof reader->message, "%.300s:%zu: ", reader->rows.path,
                                reader->rows.line);
    va_start(arguments, format);
    (void)vsnprintf(reader->message + length, sizeof reader->message - (size_t)length, format, arguments);
    va_end(arguments);
    return false;
}

static bool pass_on(wh_schedule_reader_t *reader) {
    (void)snprintf(reader->message, sizeof reader->message, "%s", reader->rows.message);
    return false;
}

static bool refuse_cell(wh_schedule_reader_t *reader, wh_schedule_column_t column,
                        const wh_schedule_cell_t *cell, const char *expected) {
    char shown[SHOWN], theirs[SHOWN] = "";
    if (reader->theirs[column]) {
        char name[SHOWN - 4];
        wh_utf8_visible(name, sizeof name, reader->theirs[column]);
        (void)snprintf(theirs, sizeof theirs, " (%s)", name);
    }
    if (cell->is_number) {
        (void)snprintf(shown, sizeof shown, "%.10g", cell->number);
    } else {
        wh_utf8_visible(shown, sizeof shown, cell->text && cell->text[0] != '\0' ? cell->text : "nothing");
    }
    return refuse(reader, "%s%s: %s (expected %s)", wh_schedule_columns[column], theirs, shown, expected);
}

/* ------------------------------------------------------------------------------------------------- values */

static bool is_empty(const wh_schedule_cell_t *cell) {
    return !cell->is_number && (!cell->text || cell->text[0] == '\0');
}

/* A number that is there, from `least` to `most`. */
static bool take_number(wh_schedule_reader_t *reader, wh_schedule_column_t column,
                        const wh_schedule_cell_t *cell, double least, double most, double *value) {
    char expected[80];
    bool good = cell->is_number;
    *value = cell->number;
    if (!cell->is_number) {
        good = wh_rows_number(cell->text ? cell->text : "", -1e300, 1e300, value);
        *value *= cell->scale == 0 ? 1 : cell->scale;
    }
    if (!good || !(*value >= least && *value <= most)) {
        (void)snprintf(expected, sizeof expected, "a number from %.10g to %.10g", least, most);
        return refuse_cell(reader, column, cell, expected);
    }
    return true;
}

static bool take_time(wh_schedule_reader_t *reader, wh_schedule_column_t column,
                      const wh_schedule_cell_t *cell, double least, int64_t *us) {
    double seconds = 0;
    if (!take_number(reader, column, cell, least, WH_SCHEDULE_LATEST, &seconds)) {
        return false;
    }
    *us = (int64_t)llround(seconds * 1e6);
    return true;
}

static bool take_whole(wh_schedule_reader_t *reader, wh_schedule_column_t column,
                       const wh_schedule_cell_t *cell, double most, int32_t *value) {
    double number = 0;
    char expected[80];
    if (is_empty(cell)) {
        return true;
    }
    if (!take_number(reader, column, cell, 1, most, &number)) {
        return false;
    }
    *value = (int32_t)number;
    (void)snprintf(expected, sizeof expected, "a whole number from 1 to %.0f", most);
    return number == floor(number) || refuse_cell(reader, column, cell, expected);
}

/* A name, if one is there; its number. */
static bool take_name(wh_schedule_reader_t *reader, wh_schedule_column_t column,
                      const wh_schedule_cell_t *cell, wh_schedule_names_t *names, int32_t *number) {
    char text[40];
    const char *name = cell->text;
    *number = WH_FLOW_NONE;
    if (is_empty(cell)) {
        return true;
    }
    if (cell->is_number) {
        (void)snprintf(text, sizeof text, "%.14g", cell->number);
        name = text;
    }
    if (!wh_rows_is_name(name, WH_SCHEDULE_NAME)) {
        return refuse_cell(reader, column, cell, "a name of 1 to 127 bytes of UTF-8");
    }
    *number = wh_schedule_name(names, name);
    return true;
}

static bool take_action(wh_schedule_reader_t *reader, const wh_schedule_cell_t *cell,
                        wh_schedule_action_t *action) {
    char meant[WH_NEAREST_TEXT], expected[200];
    const char *text = cell->text ? cell->text : "";
    for (int i = 0; i < WH_SCHEDULE_ACTIONS && !cell->is_number; ++i) {
        if (strcmp(text, wh_schedule_words[i]) == 0) {
            *action = (wh_schedule_action_t)i;
            return true;
        }
    }
    (void)snprintf(
        expected, sizeof expected,
        "start, pick, place, swap, move, process, clean, pump, open, close or leave%s",
        wh_text_did_you_mean(meant, "; ", "", wh_text_nearest(text, wh_schedule_words, WH_SCHEDULE_ACTIONS)));
    return refuse_cell(reader, WH_SCHEDULE_ACTION, cell, expected);
}

static bool take_side(wh_schedule_reader_t *reader, const wh_schedule_cell_t *cell, wh_flow_side_t *side) {
    const char *text = cell->text ? cell->text : "";
    *side = WH_FLOW_BOTH;
    if (is_empty(cell)) {
        return true;
    }
    if (!cell->is_number && strcmp(text, "vacuum") == 0) {
        *side = WH_FLOW_VACUUM;
    } else if (!cell->is_number && strcmp(text, "atmosphere") == 0) {
        *side = WH_FLOW_ATMOSPHERE;
    } else {
        return refuse_cell(reader, WH_SCHEDULE_VALUE, cell, "vacuum or atmosphere");
    }
    return true;
}

/* --------------------------------------------------------------------------------------------------- rows */

/* By action: the columns that it needs, by their bits. */
#define NEEDS(COLUMN) (1U << (unsigned)(COLUMN))
static const unsigned needs[WH_SCHEDULE_ACTIONS] = {
    [WH_SCHEDULE_START] = NEEDS(WH_SCHEDULE_WAFER),
    [WH_SCHEDULE_LEAVE] = NEEDS(WH_SCHEDULE_WAFER),
    [WH_SCHEDULE_PICK] = NEEDS(WH_SCHEDULE_ROBOT) | NEEDS(WH_SCHEDULE_WAFER),
    [WH_SCHEDULE_PLACE] = NEEDS(WH_SCHEDULE_ROBOT) | NEEDS(WH_SCHEDULE_WAFER),
    [WH_SCHEDULE_SWAP] = NEEDS(WH_SCHEDULE_ROBOT) | NEEDS(WH_SCHEDULE_WAFER) | NEEDS(WH_SCHEDULE_WAFER2),
    [WH_SCHEDULE_MOVE] = NEEDS(WH_SCHEDULE_ROBOT) | NEEDS(WH_SCHEDULE_TO),
    [WH_SCHEDULE_PUMP] = NEEDS(WH_SCHEDULE_VALUE)};

static bool has_needed(wh_schedule_reader_t *reader, const wh_schedule_cell_t cells[],
                       wh_schedule_action_t action) {
    char expected[80];
    for (int i = 0; i < WH_SCHEDULE_COLUMNS; ++i) {
        const bool is_needed = (needs[action] & NEEDS(i)) != 0 || i == WH_SCHEDULE_STATION;
        if (is_needed && is_empty(&cells[i])) {
            (void)snprintf(expected, sizeof expected, "one: it is needed for %s %s",
                           wh_schedule_article(action), wh_schedule_words[action]);
            return refuse_cell(reader, (wh_schedule_column_t)i, &cells[i], expected);
        }
    }
    const bool is_door = action == WH_SCHEDULE_OPEN || action == WH_SCHEDULE_CLOSE;
    return !is_door || !is_empty(&cells[WH_SCHEDULE_ROBOT]) || !is_empty(&cells[WH_SCHEDULE_VALUE]) ||
           refuse_cell(reader, WH_SCHEDULE_ROBOT, &cells[WH_SCHEDULE_ROBOT],
                       "the robot that goes through the door, or its side as value");
}

static bool take_times(wh_schedule_reader_t *reader, const wh_schedule_cell_t cells[],
                       wh_schedule_row_t *row) {
    char expected[80];
    const wh_schedule_cell_t *end = &cells[WH_SCHEDULE_END];
    if (!take_time(reader, WH_SCHEDULE_BEGIN, &cells[WH_SCHEDULE_BEGIN], 0, &row->begin_us)) {
        return false;
    }
    row->end_us = row->begin_us;
    if (is_empty(end) && wh_schedule_is_instant(row->action)) {
        return true;
    }
    if (!take_time(reader, WH_SCHEDULE_END, end, 0, &row->end_us)) {
        return false;
    }
    (void)snprintf(expected, sizeof expected, "its begin, %.10g s, or later", (double)row->begin_us / 1e6);
    return row->end_us >= row->begin_us || refuse_cell(reader, WH_SCHEDULE_END, end, expected);
}

static bool take_names(wh_schedule_reader_t *reader, const wh_schedule_cell_t cells[],
                       wh_schedule_row_t *row) {
    wh_schedule_t *schedule = reader->schedule;
    return take_name(reader, WH_SCHEDULE_ROBOT, &cells[WH_SCHEDULE_ROBOT], &schedule->robots, &row->robot) &&
           take_name(reader, WH_SCHEDULE_WAFER, &cells[WH_SCHEDULE_WAFER], &schedule->wafers, &row->wafer) &&
           take_name(reader, WH_SCHEDULE_WAFER2, &cells[WH_SCHEDULE_WAFER2], &schedule->wafers,
                     &row->wafer2) &&
           take_name(reader, WH_SCHEDULE_STATION, &cells[WH_SCHEDULE_STATION], &schedule->stations,
                     &row->station) &&
           take_name(reader, WH_SCHEDULE_TO, &cells[WH_SCHEDULE_TO], &schedule->stations, &row->to);
}

/* `value`: a recipe's name, or a side. */
static bool take_value(wh_schedule_reader_t *reader, const wh_schedule_cell_t *cell, wh_schedule_row_t *row) {
    row->side = WH_FLOW_BOTH;
    if (row->action != WH_SCHEDULE_START && row->action != WH_SCHEDULE_PROCESS) {
        return take_side(reader, cell, &row->side);
    }
    const bool good = take_name(reader, WH_SCHEDULE_VALUE, cell, &reader->schedule->recipes, &row->recipe);
    row->recipe += 1;
    return good;
}

/* Likewise the columns that its rows go by. */
#define OF_ALL                                                                                               \
    (NEEDS(WH_SCHEDULE_ACTION) | NEEDS(WH_SCHEDULE_STATION) | NEEDS(WH_SCHEDULE_BEGIN) |                     \
     NEEDS(WH_SCHEDULE_END))
#define OF_PLACE (OF_ALL | NEEDS(WH_SCHEDULE_SLOT) | NEEDS(WH_SCHEDULE_WAFER))
#define OF_ACCESS (OF_PLACE | NEEDS(WH_SCHEDULE_ROBOT) | NEEDS(WH_SCHEDULE_ARM))
#define OF_DOOR (OF_ALL | NEEDS(WH_SCHEDULE_ROBOT) | NEEDS(WH_SCHEDULE_VALUE))
static const unsigned uses[WH_SCHEDULE_ACTIONS] = {
    [WH_SCHEDULE_START] = OF_PLACE | NEEDS(WH_SCHEDULE_VALUE),
    [WH_SCHEDULE_LEAVE] = OF_PLACE,
    [WH_SCHEDULE_PICK] = OF_ACCESS,
    [WH_SCHEDULE_PLACE] = OF_ACCESS,
    [WH_SCHEDULE_SWAP] = OF_ACCESS | NEEDS(WH_SCHEDULE_WAFER2),
    [WH_SCHEDULE_MOVE] = OF_ALL | NEEDS(WH_SCHEDULE_ROBOT) | NEEDS(WH_SCHEDULE_TO),
    [WH_SCHEDULE_PROCESS] = OF_PLACE | NEEDS(WH_SCHEDULE_VALUE),
    [WH_SCHEDULE_CLEAN] = OF_PLACE,
    [WH_SCHEDULE_PUMP] = OF_ALL | NEEDS(WH_SCHEDULE_VALUE),
    [WH_SCHEDULE_OPEN] = OF_DOOR,
    [WH_SCHEDULE_CLOSE] = OF_DOOR};

static void note_cells(wh_schedule_reader_t *reader, const wh_schedule_cell_t cells[],
                       wh_schedule_action_t action) {
    for (int i = 0; i < WH_SCHEDULE_COLUMNS; ++i) {
        const unsigned bit = is_empty(&cells[i]) ? 0 : NEEDS(i);
        reader->filled |= bit;
        reader->used |= bit & uses[action];
    }
}

void wh_schedule_note_unused(const wh_schedule_reader_t *reader) {
    for (int i = 0; i < WH_SCHEDULE_COLUMNS; ++i) {
        if ((reader->filled & ~reader->used & NEEDS(i)) != 0) {
            const char *name = reader->theirs[i] ? reader->theirs[i] : wh_schedule_columns[i];
            (void)wh_schedule_name(&reader->schedule->unused, name);
        }
    }
}

/* Cells that the action does not need are left aside, but for their names' being good ones. */
static void leave_aside(wh_schedule_row_t *row) {
    const bool is_access = wh_schedule_is_access(row->action);
    const bool is_door = row->action == WH_SCHEDULE_OPEN || row->action == WH_SCHEDULE_CLOSE;
    const bool is_move = row->action == WH_SCHEDULE_MOVE;
    row->robot = is_access || is_door || is_move ? row->robot : WH_FLOW_NONE;
    row->wafer2 = row->action == WH_SCHEDULE_SWAP ? row->wafer2 : WH_FLOW_NONE;
    row->to = is_move ? row->to : WH_FLOW_NONE;
    row->arm = is_access ? row->arm : 0;
    row->side = is_door || row->action == WH_SCHEDULE_PUMP ? row->side : WH_FLOW_BOTH;
}

bool wh_schedule_add(wh_schedule_reader_t *reader, const wh_schedule_cell_t cells[WH_SCHEDULE_COLUMNS]) {
    wh_schedule_t *schedule = reader->schedule;
    wh_schedule_row_t row = {.line = reader->rows.line, .slot = 1};
    if (!take_action(reader, &cells[WH_SCHEDULE_ACTION], &row.action) ||
        !has_needed(reader, cells, row.action) || !take_times(reader, cells, &row) ||
        !take_names(reader, cells, &row) ||
        !take_whole(reader, WH_SCHEDULE_SLOT, &cells[WH_SCHEDULE_SLOT], WH_SCHEDULE_SLOTS, &row.slot) ||
        !take_whole(reader, WH_SCHEDULE_ARM, &cells[WH_SCHEDULE_ARM], 2, &row.arm) ||
        !take_value(reader, &cells[WH_SCHEDULE_VALUE], &row)) {
        return false;
    }
    if (schedule->count == MOST_ROWS) {
        return refuse(reader, "more than %d rows", MOST_ROWS);
    }
    note_cells(reader, cells, row.action);
    leave_aside(&row);
    schedule->rows = wh_array_grow(schedule->rows, schedule->count, &schedule->capacity, sizeof row);
    schedule->rows[schedule->count++] = row;
    return true;
}

/* --------------------------------------------------------------------------------------------------- file */

bool wh_schedule_open(wh_schedule_reader_t *reader, wh_schedule_t *schedule, const char *path,
                      char separator) {
    const wh_rows_form_t form = {.separator = separator,
                                 .finds_tabs = separator == '\0',
                                 .has_comments = true,
                                 .most_bytes = WH_SCHEDULE_BYTES};
    reader->schedule = schedule;
    schedule->path = wh_text_copy(path);
    if (!wh_rows_open(&reader->rows, path, &form)) {
        return pass_on(reader);
    }
    schedule->ends_whole = reader->rows.ends_whole;
    if (!wh_rows_read(&reader->rows)) {
        if (reader->rows.message[0] == '\0') {
            (void)wh_rows_refuse_file(&reader->rows,
                                      "it is empty (expected a line that names the columns, then rows)");
        }
        return pass_on(reader);
    }
    return true;
}

bool wh_schedule_next(wh_schedule_reader_t *reader, size_t fields) {
    if (!wh_rows_read(&reader->rows)) {
        return pass_on(reader);
    }
    return reader->rows.count == fields ||
           refuse(reader, "%zu fields (expected %zu, as in the first line)", reader->rows.count, fields);
}

static bool refuse_column(wh_schedule_reader_t *reader, const char *name) {
    char shown[SHOWN], meant[WH_NEAREST_TEXT];
    wh_utf8_visible(shown, sizeof shown, name[0] != '\0' ? name : "nothing");
    return refuse(
        reader,
        "%s: no such column (expected robot, action, wafer, station, slot, begin_s, end_s, and perhaps "
        "arm, wafer2, to, value; other names with --columns%s)",
        shown,
        wh_text_did_you_mean(meant, "; ", "",
                             wh_text_nearest(name, wh_schedule_columns, WH_SCHEDULE_COLUMNS)));
}

/* The column of each field of the first line. */
static bool take_columns(wh_schedule_reader_t *reader, size_t columns[WH_ROWS_FIELDS]) {
    static const wh_schedule_column_t needed[] = {WH_SCHEDULE_ACTION, WH_SCHEDULE_STATION, WH_SCHEDULE_BEGIN,
                                                  WH_SCHEDULE_END};
    bool has[WH_SCHEDULE_COLUMNS] = {false};
    for (size_t i = 0; i < reader->rows.count; ++i) {
        size_t column = 0;
        while (column < WH_SCHEDULE_COLUMNS &&
               strcmp(wh_schedule_columns[column], reader->rows.fields[i]) != 0) {
            ++column;
        }
        if (column == WH_SCHEDULE_COLUMNS) {
            return refuse_column(reader, reader->rows.fields[i]);
        }
        if (has[column]) {
            return refuse(reader, "%s: this column is there twice", wh_schedule_columns[column]);
        }
        has[column] = true;
        columns[i] = column;
    }
    for (size_t i = 0; i < sizeof needed / sizeof needed[0]; ++i) {
        if (!has[needed[i]]) {
            return refuse(reader, "no column is named %s", wh_schedule_columns[needed[i]]);
        }
    }
    return true;
}

static bool read_rows(wh_schedule_reader_t *reader) {
    size_t columns[WH_ROWS_FIELDS];
    const size_t fields = reader->rows.count;
    if (!take_columns(reader, columns)) {
        return false;
    }
    while (wh_schedule_next(reader, fields)) {
        wh_schedule_cell_t cells[WH_SCHEDULE_COLUMNS] = {{NULL, 0, false, 0}};
        for (size_t i = 0; i < fields; ++i) {
            cells[columns[i]].text = reader->rows.fields[i];
        }
        if (!wh_schedule_add(reader, cells)) {
            return false;
        }
    }
    if (reader->message[0] == '\0' && reader->schedule->count == 0) {
        (void)wh_rows_refuse_file(&reader->rows, "it has no rows behind its first line");
        return pass_on(reader);
    }
    return reader->message[0] == '\0';
}

bool wh_schedule_read(wh_schedule_t *schedule, const char *path, char message[1600]) {
    wh_schedule_reader_t reader = {.schedule = schedule};
    const bool read = wh_schedule_open(&reader, schedule, path, '\0') && read_rows(&reader);
    if (read) {
        wh_schedule_note_unused(&reader);
        wh_schedule_finish(schedule);
    } else {
        (void)snprintf(message, 1600, "%s", reader.message);
    }
    wh_rows_close(&reader.rows);
    return read;
}
