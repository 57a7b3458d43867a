#include "rows.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "array.h"
#include "output.h"
#include "utf8.h"

bool wh_rows_refuse(wh_rows_t *rows, const char *format, ...) {
    va_list arguments;
    const int length = snprintf(rows->message, sizeof rows->message, "%.300s:%zu: ", rows->path, rows->line);
    va_start(arguments, format);
    (void)vsnprintf(rows->message + length, sizeof rows->message - (size_t)length, format, arguments);
    va_end(arguments);
    return false;
}

bool wh_rows_refuse_file(wh_rows_t *rows, const char *why) {
    (void)snprintf(rows->message, sizeof rows->message, "%.300s: %s", rows->path, why);
    return false;
}

/* ----------------------------------------------------------------------------------------------- the file */

static bool take_bytes(wh_rows_t *rows, FILE *file, size_t told) {
    char why[80];
    const size_t room = told < rows->form.most_bytes ? told : rows->form.most_bytes;
    rows->bytes = wh_memory_need(malloc(room + 2));
    rows->size = fread(rows->bytes, 1, room + 1, file);
    rows->bytes[rows->size] = '\0';
    if (ferror(file)) {
        return wh_rows_refuse_file(rows, "it cannot be read");
    }
    if (rows->size > rows->form.most_bytes) {
        (void)snprintf(why, sizeof why, "it has more than %zu bytes", rows->form.most_bytes);
        return wh_rows_refuse_file(rows, why);
    }
    if (rows->size > room) {
        return wh_rows_refuse_file(rows, "it grows while it is read");
    }
    return memchr(rows->bytes, '\0', rows->size)
               ? wh_rows_refuse_file(rows, "it has a byte 0 (expected text)")
               : true;
}

static bool load(wh_rows_t *rows) {
    struct stat status;
    if (stat(rows->path, &status) != 0) {
        return wh_rows_refuse_file(rows, strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) {
        return wh_rows_refuse_file(rows, "it is no regular file");
    }
    FILE *file = fopen(rows->path, "rb");
    if (!file) {
        return wh_rows_refuse_file(rows, strerror(errno));
    }
    const bool taken = take_bytes(rows, file, (size_t)status.st_size);
    (void)fclose(file);
    if (taken) {
        wh_output_keep(rows->path);
    }
    return taken;
}

/* ------------------------------------------------------------------------------------------------- fields */

/* A tab that separates is no blank. */
static bool is_blank(const wh_rows_t *rows, char byte) {
    return byte == ' ' || (byte == '\t' && rows->form.separator != '\t');
}

static bool ends_line(const char *at) {
    return *at == '\n' || *at == '\0' || (at[0] == '\r' && at[1] == '\n');
}

static const char *separator_name(const wh_rows_t *rows, char text[4]) {
    (void)snprintf(text, 4, "%c", rows->form.separator);
    return rows->form.separator == ',' ? "comma" : rows->form.separator == '\t' ? "tab" : text;
}

/* Reads a field in quotes; the first quote was passed. It moves the text together. Returns null if it is
 * not closed. */
static char *pass_quoted(wh_rows_t *rows, char *at) {
    char *to = at, name[4];
    for (; *at != '"' || at[1] == '"'; ++at) {
        if (ends_line(at)) {
            (void)wh_rows_refuse(rows, "a quote is not closed (expected a \" on this line)");
            return NULL;
        }
        at += *at == '"' ? 1 : 0;
        *to++ = *at;
    }
    for (++at; is_blank(rows, *at); ++at) {
    }
    if (*at != rows->form.separator && !ends_line(at)) {
        (void)wh_rows_refuse(rows, "something stands behind a quote (expected a %s or the line's end)",
                             separator_name(rows, name));
        return NULL;
    }
    *to = '\0';
    return at;
}

/* Reads the field at rows->at. It passes the separator after it; `is_last` is set if there is none. Returns
 * null if it is refused. */
static char *take_field(wh_rows_t *rows, bool *is_last) {
    char *field = rows->at;
    for (; is_blank(rows, *field); ++field) {
    }
    char *end = NULL;
    char *at = NULL;
    if (*field == '"') {
        at = pass_quoted(rows, ++field);
    } else {
        for (at = field; *at != rows->form.separator && !ends_line(at); ++at) {
        }
        for (end = at; end > field && is_blank(rows, end[-1]); --end) {
        }
    }
    if (!at) {
        return NULL;
    }
    *is_last = *at != rows->form.separator;
    rows->at = at + (*at == '\r' ? 2 : *at != '\0');
    if (end) {
        *end = '\0';
    }
    return field;
}

/* Passes blank lines and comments. False at the end of the file. */
static bool find_row(wh_rows_t *rows) {
    rows->line = rows->next_line;
    while (*rows->at != '\0') {
        const char *line = rows->at;
        for (; is_blank(rows, *line); ++line) {
        }
        if (rows->form.has_comments && rows->at[0] == '#') {
            line += strcspn(line, "\n");
        } else if (!ends_line(line)) {
            return true;
        }
        line += *line == '\r' ? 1 : 0;
        rows->line += *line == '\n';
        rows->at += line - rows->at + (*line == '\n');
    }
    return false;
}

static void find_separator(wh_rows_t *rows) {
    rows->form.separator = rows->form.separator == '\0' ? ',' : rows->form.separator;
    if (rows->form.finds_tabs && find_row(rows)) {
        const size_t length = strcspn(rows->at, "\n");
        if (memchr(rows->at, '\t', length) && !memchr(rows->at, ',', length)) {
            rows->form.separator = '\t';
        }
    }
    rows->next_line = rows->form.finds_tabs ? rows->line : rows->next_line;
}

bool wh_rows_open(wh_rows_t *rows, const char *path, const wh_rows_form_t *form) {
    *rows = (wh_rows_t){.path = path, .form = *form, .next_line = 1};
    if (!load(rows)) {
        return false;
    }
    rows->ends_whole = rows->size == 0 || rows->bytes[rows->size - 1] == '\n';
    rows->at = rows->bytes + (strncmp(rows->bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0);
    find_separator(rows);
    return true;
}

bool wh_rows_read(wh_rows_t *rows) {
    if (rows->message[0] != '\0' || !find_row(rows)) {
        return false;
    }
    bool is_last = false;
    for (rows->count = 0; !is_last; ++rows->count) {
        if (rows->count == WH_ROWS_FIELDS) {
            return wh_rows_refuse(rows, "more than %d fields", WH_ROWS_FIELDS);
        }
        rows->fields[rows->count] = take_field(rows, &is_last);
        if (!rows->fields[rows->count]) {
            return false;
        }
    }
    rows->next_line = rows->line + 1;
    return true;
}

void wh_rows_close(wh_rows_t *rows) {
    free(rows->bytes);
    rows->bytes = rows->at = NULL;
}

/* ------------------------------------------------------------------------------------------------- values */

bool wh_rows_number(const char *text, double least, double most, double *value) {
    char *end = NULL;
    if (text[0] == '\0' || text[strspn(text, "+-.0123456789eE")] != '\0') {
        return false;
    }
    const double number = strtod(text, &end);
    if (*end != '\0' || !(number >= least && number <= most)) {
        return false;
    }
    *value = number;
    return true;
}

bool wh_rows_is_name(const char *text, size_t most) {
    const size_t size = strlen(text);
    bool good = size >= 1 && size <= most;
    for (size_t bytes = 1; good && *text != '\0'; text += bytes) {
        bytes = wh_utf8_bytes(text);
        good = bytes > 0 && wh_utf8_control_bytes(text) == 0;
    }
    return good;
}
