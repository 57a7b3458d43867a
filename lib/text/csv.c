#include "csv.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "nearest.h"
#include "utf8.h"

/* The most characters of a field in a message. */
#define SHOWN 80

__attribute__((format(printf, 2, 3))) static bool refuse(wh_csv_t *csv, const char *format, ...) {
    va_list arguments;
    const int length = snprintf(csv->message, sizeof csv->message, "%.300s:%zu: ", csv->path, csv->line);
    va_start(arguments, format);
    (void)vsnprintf(csv->message + length, sizeof csv->message - (size_t)length, format, arguments);
    va_end(arguments);
    return false;
}

/* The rows' message becomes the table's. Returns false. */
static bool pass_on(wh_csv_t *csv) {
    memcpy(csv->message, csv->rows.message, sizeof csv->message);
    return false;
}

static bool refuse_value(wh_csv_t *csv, size_t column, const char *text, const char *expected) {
    char shown[SHOWN];
    wh_utf8_visible(shown, sizeof shown, text[0] != '\0' ? text : "nothing");
    return refuse(csv, "%s: %s (expected %s)", csv->columns[column].name, shown, expected);
}

bool wh_csv_refuse(wh_csv_t *csv, size_t column, const char *expected) {
    char number[32];
    const char *text = csv->texts[column];
    if (!csv->columns[column].is_text) {
        (void)snprintf(number, sizeof number, "%.10g", csv->numbers[column]);
        text = number;
    }
    return refuse_value(csv, column, text, expected);
}

bool wh_csv_refuse_file(wh_csv_t *csv, const char *why) {
    (void)wh_rows_refuse_file(&csv->rows, why);
    return pass_on(csv);
}

/* The next line that is not blank. False at the end, or if it is refused. */
static bool read_line(wh_csv_t *csv) {
    const bool read = wh_rows_read(&csv->rows);
    csv->line = csv->rows.line;
    if (!read) {
        return pass_on(csv);
    }
    return csv->rows.count <= WH_CSV_COLUMNS || refuse(csv, "more than %d fields", WH_CSV_COLUMNS);
}

/* ------------------------------------------------------------------------------------------------ columns */

static bool refuse_name(wh_csv_t *csv, const char *name) {
    const char *names[WH_CSV_COLUMNS];
    char list[200] = "";
    char meant[WH_NEAREST_TEXT];
    char shown[SHOWN];
    size_t length = 0;
    for (size_t i = 0; i < csv->column_count; ++i) {
        names[i] = csv->columns[i].name;
        length += (size_t)snprintf(list + length, sizeof list - length, "%s%s", i > 0 ? ", " : "", names[i]);
    }
    wh_utf8_visible(shown, sizeof shown, name[0] != '\0' ? name : "nothing");
    return refuse(csv, "%s: no such column (expected %s%s)", shown, list,
                  wh_text_did_you_mean(meant, "; ", "", wh_text_nearest(name, names, csv->column_count)));
}

static bool take_name(wh_csv_t *csv, const char *name, size_t field) {
    for (size_t i = 0; i < csv->column_count; ++i) {
        if (strcmp(csv->columns[i].name, name) != 0) {
            continue;
        }
        if (csv->has[i]) {
            return refuse(csv, "%s: this column is there twice", name);
        }
        csv->has[i] = true;
        csv->order[field] = i;
        return true;
    }
    return refuse_name(csv, name);
}

bool wh_csv_open(wh_csv_t *csv, const char *path, const wh_csv_column_t *columns, size_t count) {
    static const wh_rows_form_t form = {.separator = ',', .most_bytes = WH_CSV_BYTES};
    *csv = (wh_csv_t){.path = path, .columns = columns, .column_count = count};
    if (!wh_rows_open(&csv->rows, path, &form)) {
        return pass_on(csv);
    }
    if (!read_line(csv)) {
        return csv->message[0] == '\0'
                   ? wh_csv_refuse_file(csv, "it is empty (expected a line that names the columns)")
                   : false;
    }
    csv->field_count = csv->rows.count;
    for (size_t i = 0; i < csv->field_count; ++i) {
        if (!take_name(csv, csv->rows.fields[i], i)) {
            return false;
        }
    }
    for (size_t i = 0; i < count; ++i) {
        if (!csv->has[i] && !columns[i].may_lack) {
            return refuse(csv, "no column is named %s", columns[i].name);
        }
    }
    return true;
}

/* --------------------------------------------------------------------------------------------------- rows */

static bool take_number(wh_csv_t *csv, size_t column, const char *text) {
    const wh_csv_column_t *of = &csv->columns[column];
    char expected[96];
    if (!wh_rows_number(text, of->least, of->most, &csv->numbers[column])) {
        (void)snprintf(expected, sizeof expected, "a number from %.10g to %.10g", of->least, of->most);
        return refuse_value(csv, column, text, expected);
    }
    return true;
}

static bool take_value(wh_csv_t *csv, size_t column, const char *text) {
    const wh_csv_column_t *of = &csv->columns[column];
    if (!of->is_text) {
        return (of->may_lack && text[0] == '\0') || take_number(csv, column, text);
    }
    csv->texts[column] = text;
    return wh_rows_is_name(text, WH_CSV_TEXT - 1) ||
           refuse_value(csv, column, text, "a name of 1 to 63 bytes of UTF-8");
}

bool wh_csv_read(wh_csv_t *csv) {
    if (csv->message[0] != '\0' || !read_line(csv)) {
        return false;
    }
    if (csv->rows.count != csv->field_count) {
        return refuse(csv, "%zu fields (expected %zu, as in the first line)", csv->rows.count,
                      csv->field_count);
    }
    for (size_t i = 0; i < csv->column_count; ++i) {
        csv->numbers[i] = (double)NAN;
        csv->texts[i] = NULL;
    }
    for (size_t i = 0; i < csv->rows.count; ++i) {
        if (!take_value(csv, csv->order[i], csv->rows.fields[i])) {
            return false;
        }
    }
    return true;
}

void wh_csv_close(wh_csv_t *csv) {
    wh_rows_close(&csv->rows);
}
