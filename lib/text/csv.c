#include "csv.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "array.h"
#include "nearest.h"
#include "output.h"
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

/* --------------------------------------------------------------------------------------------- the file */

bool wh_csv_refuse_file(wh_csv_t *csv, const char *why) {
    (void)snprintf(csv->message, sizeof csv->message, "%.300s: %s", csv->path, why);
    return false;
}

static bool load(wh_csv_t *csv) {
    struct stat status;
    if (stat(csv->path, &status) != 0) {
        return wh_csv_refuse_file(csv, strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) {
        return wh_csv_refuse_file(csv, "it is no regular file");
    }
    FILE *file = fopen(csv->path, "rb");
    if (!file) {
        return wh_csv_refuse_file(csv, strerror(errno));
    }
    csv->bytes = wh_memory_need(malloc(WH_CSV_BYTES + 2));
    csv->size = fread(csv->bytes, 1, WH_CSV_BYTES + 1, file);
    const bool failed = ferror(file) != 0;
    (void)fclose(file);
    csv->bytes[csv->size] = '\0';
    if (failed) {
        return wh_csv_refuse_file(csv, "it cannot be read");
    }
    if (csv->size > WH_CSV_BYTES) {
        return wh_csv_refuse_file(csv, "it has more than 16777216 bytes");
    }
    if (memchr(csv->bytes, '\0', csv->size)) {
        return wh_csv_refuse_file(csv, "it has a byte 0 (expected text)");
    }
    wh_output_keep(csv->path);
    return true;
}

/* ----------------------------------------------------------------------------------------------- fields */

static bool is_blank(char byte) {
    return byte == ' ' || byte == '\t';
}

static bool ends_line(const char *at) {
    return *at == '\n' || *at == '\0' || (at[0] == '\r' && at[1] == '\n');
}

/* Reads a field in quotes; the first quote was passed. It moves the text together. Returns null if it is
 * not closed. */
static char *pass_quoted(wh_csv_t *csv, char *at) {
    char *to = at;
    for (; *at != '"' || at[1] == '"'; ++at) {
        if (ends_line(at)) {
            (void)refuse(csv, "a quote is not closed (expected a \" on this line)");
            return NULL;
        }
        at += *at == '"' ? 1 : 0;
        *to++ = *at;
    }
    for (++at; is_blank(*at); ++at) {
    }
    if (*at != ',' && !ends_line(at)) {
        (void)refuse(csv, "something stands behind a quote (expected a comma or the line's end)");
        return NULL;
    }
    *to = '\0';
    return at;
}

/* Reads the field at csv->at. It passes the comma after it; `is_last` is set if there is none. Returns null
 * if it is refused. */
static char *take_field(wh_csv_t *csv, bool *is_last) {
    char *field = csv->at;
    for (; is_blank(*field); ++field) {
    }
    char *end = NULL;
    char *at = NULL;
    if (*field == '"') {
        at = pass_quoted(csv, ++field);
    } else {
        for (at = field; *at != ',' && !ends_line(at); ++at) {
        }
        for (end = at; end > field && is_blank(end[-1]); --end) {
        }
    }
    if (!at) {
        return NULL;
    }
    *is_last = *at != ',';
    csv->at = at + (*at == '\r' ? 2 : *at != '\0');
    if (end) {
        *end = '\0';
    }
    return field;
}

/* Splits the next line that is not blank. Returns false at the end, or if it is refused. */
static bool split_line(wh_csv_t *csv, char *fields[WH_CSV_COLUMNS], size_t *count) {
    for (csv->line = csv->next_line; is_blank(*csv->at) || (*csv->at != '\0' && ends_line(csv->at));
         ++csv->at) {
        csv->line += *csv->at == '\n';
    }
    if (*csv->at == '\0') {
        return false;
    }
    bool is_last = false;
    for (*count = 0; !is_last; ++*count) {
        if (*count == WH_CSV_COLUMNS) {
            return refuse(csv, "more than %d fields", WH_CSV_COLUMNS);
        }
        fields[*count] = take_field(csv, &is_last);
        if (!fields[*count]) {
            return false;
        }
    }
    csv->next_line = csv->line + 1;
    return true;
}

/* ---------------------------------------------------------------------------------------------- columns */

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
    char *fields[WH_CSV_COLUMNS];
    *csv = (wh_csv_t){.path = path, .columns = columns, .column_count = count, .next_line = 1};
    if (!load(csv)) {
        return false;
    }
    csv->at = csv->bytes + (strncmp(csv->bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0);
    if (!split_line(csv, fields, &csv->field_count)) {
        return csv->message[0] == '\0'
                   ? wh_csv_refuse_file(csv, "it is empty (expected a line that names the columns)")
                   : false;
    }
    for (size_t i = 0; i < csv->field_count; ++i) {
        if (!take_name(csv, fields[i], i)) {
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

/* ------------------------------------------------------------------------------------------------- rows */

static bool take_number(wh_csv_t *csv, size_t column, const char *text) {
    const wh_csv_column_t *of = &csv->columns[column];
    char expected[96];
    char *end = NULL;
    const bool is_decimal = text[0] != '\0' && text[strspn(text, "+-.0123456789eE")] == '\0';
    const double value = is_decimal ? strtod(text, &end) : (double)NAN;
    if (!end || *end != '\0' || !(value >= of->least && value <= of->most)) {
        (void)snprintf(expected, sizeof expected, "a number from %.10g to %.10g", of->least, of->most);
        return refuse_value(csv, column, text, expected);
    }
    csv->numbers[column] = value;
    return true;
}

static bool is_name(const char *text) {
    const size_t size = strlen(text);
    bool good = size >= 1 && size < WH_CSV_TEXT;
    for (size_t bytes = 1; good && *text != '\0'; text += bytes) {
        bytes = wh_utf8_bytes(text);
        good = bytes > 0 && wh_utf8_control_bytes(text) == 0;
    }
    return good;
}

static bool take_value(wh_csv_t *csv, size_t column, const char *text) {
    const wh_csv_column_t *of = &csv->columns[column];
    if (!of->is_text) {
        return (of->may_lack && text[0] == '\0') || take_number(csv, column, text);
    }
    csv->texts[column] = text;
    return is_name(text) || refuse_value(csv, column, text, "a name of 1 to 63 bytes of UTF-8");
}

bool wh_csv_read(wh_csv_t *csv) {
    char *fields[WH_CSV_COLUMNS];
    size_t count = 0;
    if (csv->message[0] != '\0' || !split_line(csv, fields, &count)) {
        return false;
    }
    if (count != csv->field_count) {
        return refuse(csv, "%zu fields (expected %zu, as in the first line)", count, csv->field_count);
    }
    for (size_t i = 0; i < csv->column_count; ++i) {
        csv->numbers[i] = (double)NAN;
        csv->texts[i] = NULL;
    }
    for (size_t i = 0; i < count; ++i) {
        if (!take_value(csv, csv->order[i], fields[i])) {
            return false;
        }
    }
    return true;
}

void wh_csv_close(wh_csv_t *csv) {
    free(csv->bytes);
    csv->bytes = csv->at = NULL;
}
