/* Reports for a person: one line with the file, what was found, what was expected, and what holds. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "outputs_internal.h"

/* Of a longer path its end is shown. */
#define SHOWN_PATH 200

/* A line under construction; what does not fit is cut. */
typedef struct {
    char *text;
    size_t size, used;
} line_t;

static void add(line_t *line, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void add(line_t *line, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(line->text + line->used, line->size - line->used, format, arguments);
    va_end(arguments);
    line->used += length < 0 ? 0 : (size_t)length;
    if (line->used > line->size - 1) {
        line->used = line->size - 1;
    }
}

/* Bytes of UTF-8 pass, control characters do not: the report is one line whatever the file is called. */
static void add_path(line_t *line, const char *path) {
    const size_t length = strlen(path);
    if (length > SHOWN_PATH) {
        add(line, "...");
        path += length - SHOWN_PATH;
    }
    for (; *path != '\0'; ++path) {
        const unsigned char byte = (unsigned char)*path;
        add(line, "%c", byte < 0x20 || byte == 0x7f ? '?' : *path);
    }
}

static void add_valves(line_t *line, const wh_outputs_t *outputs) {
    for (size_t i = 0; i < outputs->count; ++i) {
        add(line, " %d", (int)outputs->valves[i]);
    }
}

static const char *plural(size_t count) {
    return count == 1 ? "" : "s";
}

static void add_values(line_t *line, const wh_outputs_look_t *look) {
    if (look->oversize) {
        add(line, "more than %d bytes", WH_OUTPUTS_BYTES);
    } else {
        add(line, "%zu value%s", look->found, plural(look->found));
    }
}

static const char *kind(const wh_outputs_look_t *look) {
    return look->folder ? "a directory" : "not a regular file";
}

static void add_found(line_t *line, const wh_outputs_look_t *look) {
    switch (look->condition) {
    case WH_OUTPUTS_MISSING:
        add(line, "missing");
        break;
    case WH_OUTPUTS_UNREADABLE:
        add(line, "cannot be read: %s", strerrordesc_np(look->error));
        break;
    case WH_OUTPUTS_NO_FILE:
        add(line, "%s", kind(look));
        break;
    case WH_OUTPUTS_EMPTY:
        add(line, "empty");
        break;
    case WH_OUTPUTS_GARBLED:
        add(line, "value %zu is \"%s\"", look->found + 1, look->text);
        break;
    case WH_OUTPUTS_GOOD:
    case WH_OUTPUTS_SHORT:
    case WH_OUTPUTS_LONG:
    case WH_OUTPUTS_CONDITIONS:
    default:
        add_values(line, look);
        break;
    }
}

void wh_outputs_describe(wh_outputs_t *outputs, const wh_outputs_look_t *look) {
    line_t line = {.text = outputs->report, .size = sizeof outputs->report};
    add_path(&line, outputs->path);
    add(&line, ": ");
    if (look->condition == WH_OUTPUTS_GOOD) {
        add(&line, "good again, the valves are");
        add_valves(&line, outputs);
        return;
    }
    add_found(&line, look);
    add(&line, " (expected %zu value%s, each 0 or 1); the valves stay", outputs->count,
        plural(outputs->count));
    add_valves(&line, outputs);
}

const char *wh_outputs_condition_name(wh_outputs_condition_t condition) {
    static const char *const names[WH_OUTPUTS_CONDITIONS] = {"good",  "missing", "unreadable", "no file",
                                                             "empty", "short",   "long",       "garbled"};
    return (unsigned)condition < WH_OUTPUTS_CONDITIONS ? names[condition] : "unknown";
}
