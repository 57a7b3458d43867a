#include "field.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "../text/utf8.h"
#include "field_map.h"

/* The largest time, s, and the largest number of an axis. */
#define LATEST 1e9
#define LARGEST 1e6

static bool open_rows(wh_field_log_t *field, const wh_sandbox_limits_t *limits) {
    wh_rows_form_t form = {.has_comments = true, .most_bytes = WH_FIELD_BYTES};
    if (field->map && !wh_field_map_separator(field, limits, &form.separator)) {
        return false;
    }
    form.finds_tabs = form.separator == '\0';
    if (!wh_rows_open(&field->rows, field->path, &form) || !wh_rows_read(&field->rows)) {
        (void)snprintf(field->message, sizeof field->message, "%s", field->rows.message);
        if (field->message[0] == '\0') {
            (void)snprintf(field->message, sizeof field->message,
                           "%.300s: it is empty (expected a line that names the columns)", field->path);
        }
        return false;
    }
    field->column_count = field->rows.count;
    memcpy(field->names, field->rows.fields, field->column_count * sizeof *field->names);
    return true;
}

bool wh_field_open(wh_field_log_t *field, const char *path, const char *map, const wh_layout_t *layout,
                   const wh_sandbox_limits_t *limits) {
    field->layout = layout;
    field->path = path;
    field->map = map;
    return open_rows(field, limits) && (map ? wh_field_map_read(field, limits) : wh_field_map_usual(field));
}

/* --------------------------------------------------------------------------------------------------- rows */

static bool refuse_value(wh_field_log_t *field, size_t column, const char *expected) {
    char shown[80];
    const char *text = field->rows.fields[column];
    wh_utf8_visible(shown, sizeof shown, text[0] != '\0' ? text : "nothing");
    (void)snprintf(field->message, sizeof field->message, "%.300s:%zu: %.100s: %s (expected %s)", field->path,
                   field->rows.line, field->names[column], shown, expected);
    return false;
}

/* A number as the log writes it: with a point, or with a comma and no point. */
static bool read_number(const wh_field_log_t *field, char *text, double *number) {
    char *comma = field->has_commas ? strchr(text, ',') : NULL;
    if (field->has_commas && strchr(text, '.')) {
        return false;
    }
    if (comma) {
        *comma = '.';
    }
    const bool good = wh_rows_number(text, -1e300, 1e300, number);
    if (comma) {
        *comma = ','; /* a message shows it as it stands */
    }
    return good;
}

static bool refuse_number(wh_field_log_t *field, size_t column) {
    const char *text = field->rows.fields[column];
    const bool may_be_comma =
        !field->has_commas && strspn(text, "+-0123456789,") == strlen(text) && strchr(text, ',');
    return refuse_value(field, column,
                        may_be_comma        ? "a number; with decimal = \",\" in a map a comma is its point"
                        : field->has_commas ? "a number with a comma, as the map's `decimal` says"
                                            : "a number");
}

static bool take_number(wh_field_log_t *field, const wh_field_source_t *source, double most, double *number) {
    double read = 0;
    if (!source->is_constant && !read_number(field, field->rows.fields[source->column], &read)) {
        return refuse_number(field, source->column);
    }
    *number = source->is_constant ? source->offset : read * source->scale + source->offset;
    if (!(fabs(*number) <= most)) {
        char expected[80];
        (void)snprintf(expected, sizeof expected, "a number that is at most %g once it is scaled", most);
        return refuse_value(field, source->column, expected);
    }
    return true;
}

static bool take_axis(wh_field_log_t *field, size_t axis) {
    const wh_field_source_t *source = &field->axes[axis];
    double number = 0;
    if (!take_number(field, source, LARGEST, &number)) {
        return false;
    }
    const bool is_in_degrees = wh_layout_axis_turns(field->layout, axis) && !source->is_angle_in_rad;
    field->q[axis] = is_in_degrees ? wh_rad_from_deg(number) : number;
    return true;
}

/* A text that says on or off. */
static bool take_text(wh_field_log_t *field, wh_field_source_t *source, bool *is_on) {
    const char *text = field->rows.fields[source->column];
    *is_on = strcmp(text, source->on) == 0;
    source->has_been_on = source->has_been_on || *is_on;
    if (*is_on || source->off[0] == '\0' || strcmp(text, source->off) == 0) {
        return true;
    }
    char expected[2 * WH_FIELD_ON + 40];
    (void)snprintf(expected, sizeof expected, "%s or %s, the map's `on` and `off`", source->on, source->off);
    return refuse_value(field, source->column, expected);
}

/* Sets bit `bit` if the source says on. */
static bool take_bit(wh_field_log_t *field, wh_field_source_t *source, size_t bit, uint32_t *bits) {
    bool is_on = source->offset != 0;
    double number = 0;
    if (!source->is_constant && source->on[0] != '\0') {
        if (!take_text(field, source, &is_on)) {
            return false;
        }
    } else if (!source->is_constant) {
        if (!wh_rows_number(field->rows.fields[source->column], 0, 1, &number) ||
            (number != 0 && number != 1)) {
            return refuse_value(field, source->column, "0 or 1; a map's `on` names another text");
        }
        is_on = (number != 0) != source->is_turned;
    }
    *bits |= is_on ? 1U << bit : 0;
    return true;
}

static bool take_bits(wh_field_log_t *field) {
    bool good = true;
    field->on = field->sensed = 0;
    for (size_t g = 0; good && g < field->layout->machine.gripper_count; ++g) {
        good =
            take_bit(field, &field->valves[g], g, &field->on) &&
            ((field->has_sensors >> g & 1U) == 0 || take_bit(field, &field->sensors[g], g, &field->sensed));
    }
    return good;
}

static bool take_time(wh_field_log_t *field) {
    const bool is_first = field->line == 0;
    const double before_s = field->time_s;
    if (!take_number(field, &field->time, LATEST, &field->time_s)) {
        return false;
    }
    if (!is_first && field->time_s <= before_s) {
        char expected[80];
        (void)snprintf(expected, sizeof expected, "a time after %.10g s, that of line %zu", before_s,
                       field->line);
        return refuse_value(field, field->time.column, expected);
    }
    return true;
}

bool wh_field_read(wh_field_log_t *field) {
    if (field->message[0] != '\0') {
        return false;
    }
    if (!wh_rows_read(&field->rows)) {
        (void)snprintf(field->message, sizeof field->message, "%s", field->rows.message);
        return false;
    }
    if (field->rows.count != field->column_count) {
        (void)snprintf(field->message, sizeof field->message,
                       "%.300s:%zu: %zu fields (expected %zu, as in the first line)", field->path,
                       field->rows.line, field->rows.count, field->column_count);
        return false;
    }
    bool good = take_time(field);
    for (size_t axis = 0; good && axis < field->layout->machine.axis_count; ++axis) {
        good = take_axis(field, axis);
    }
    field->line = field->rows.line;
    return good && take_bits(field);
}

static bool was_never_on(const wh_field_source_t *source) {
    return source->on[0] != '\0' && source->off[0] == '\0' && !source->has_been_on;
}

const wh_field_source_t *wh_field_find_never_on(const wh_field_log_t *field, size_t *gripper,
                                                bool *is_sensor) {
    for (*gripper = 0; *gripper < field->layout->machine.gripper_count; ++*gripper) {
        const wh_field_source_t *both[] = {&field->valves[*gripper], &field->sensors[*gripper]};
        for (size_t i = 0; i < 2; ++i) {
            if (was_never_on(both[i])) {
                *is_sensor = i == 1;
                return both[i];
            }
        }
    }
    return NULL;
}

void wh_field_close(wh_field_log_t *field) {
    wh_rows_close(&field->rows);
}
