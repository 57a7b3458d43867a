#include "lines.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../grasp/event.h"
#include "../math/status.h"
#include "../text/array.h"

enum { MET = 1, WHOLE = 2, ENDED = 4 };

/* The count of a line's numbers before the one for how far off it is. */
enum { NUMBERS = 10 };

void wh_trial_lines_free(wh_trial_lines_t *lines) {
    free(lines->lines);
    free(lines->ends);
    memset(lines, 0, sizeof *lines);
}

double *wh_trial_lines_add(wh_trial_lines_t *lines, const wh_trial_line_t *line, size_t wafer_count) {
    const size_t width = wafer_count * WH_TRIAL_LINE_ENDS;
    lines->wafer_count = wafer_count;
    lines->lines = wh_array_grow(lines->lines, lines->count, &lines->capacity, sizeof *lines->lines);
    lines->ends = wh_array_reserve(lines->ends, (lines->count + 1) * width + 1, &lines->end_capacity,
                                   sizeof *lines->ends);
    lines->lines[lines->count] = *line;
    return &lines->ends[lines->count++ * width];
}

void wh_trial_lines_merge(wh_trial_lines_t *lines, const wh_trial_lines_t *other) {
    const size_t width = other->wafer_count * WH_TRIAL_LINE_ENDS;
    for (size_t i = 0; i < other->count; ++i) {
        double *ends = wh_trial_lines_add(lines, &other->lines[i], other->wafer_count);
        memcpy(ends, &other->ends[i * width], width * sizeof *ends);
    }
}

/* ------------------------------------------------------------------------------------------------ sorting */

typedef struct {
    uint64_t trial;
    size_t from;
} place_t;

static int compare(const void *a, const void *b) {
    const place_t *one = a;
    const place_t *other = b;
    return (one->trial > other->trial) - (one->trial < other->trial);
}

void wh_trial_lines_sort(wh_trial_lines_t *lines) {
    wh_trial_lines_t sorted = {0};
    const size_t width = lines->wafer_count * WH_TRIAL_LINE_ENDS;
    place_t *places = wh_array_new(lines->count, sizeof *places);
    for (size_t i = 0; i < lines->count; ++i) {
        places[i] = (place_t){lines->lines[i].trial, i};
    }
    qsort(places, lines->count, sizeof *places, compare);
    for (size_t i = 0; i < lines->count; ++i) {
        const size_t from = places[i].from;
        double *ends = wh_trial_lines_add(&sorted, &lines->lines[from], lines->wafer_count);
        memcpy(ends, &lines->ends[from * width], width * sizeof *ends);
    }
    free(places);
    wh_trial_lines_free(lines);
    *lines = sorted;
}

uint64_t wh_trial_lines_below(const wh_trial_lines_t *lines, uint64_t trial) {
    uint64_t count = 0;
    for (size_t i = 0; i < lines->count; ++i) {
        count += lines->lines[i].trial < trial ? 1 : 0;
    }
    return count;
}

/* --------------------------------------------------------------------------------------------------- text */

static void put(FILE *out, uint64_t value, char after) {
    fprintf(out, "%llx%c", (unsigned long long)value, after);
}

static void put_real(FILE *out, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(out, bits, ' ');
}

char *wh_trial_lines_text(const wh_trial_lines_t *lines) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = wh_memory_need(open_memstream(&text, &size));
    const size_t width = lines->wafer_count * WH_TRIAL_LINE_ENDS;
    for (size_t i = 0; i < lines->count; ++i) {
        const wh_trial_line_t *line = &lines->lines[i];
        put(out, line->trial, ' ');
        put(out, (line->met ? MET : 0U) | (line->whole ? WHOLE : 0U) | (line->ended ? ENDED : 0U), ' ');
        put(out, line->missed, ' ');
        put(out, line->errors, ' ');
        put(out, line->complaints, ' ');
        put(out, line->elsewhere, ' ');
        put(out, line->kinds, ' ');
        put(out, line->missed_line, ' ');
        put(out, line->error, ' ');
        put(out, line->error_line, ' ');
        put_real(out, line->off);
        for (size_t f = 0; f < WH_FLOW_SUM_FIGURES; ++f) {
            put_real(out, line->flow[f]);
        }
        for (size_t e = 0; e < width; ++e) {
            put_real(out, lines->ends[i * width + e]);
        }
    }
    if (fclose(out) != 0) {
        wh_memory_out();
    }
    return text;
}

/* Takes a number off the text; none is left when the text is at its end. */
static bool take(const char **text, uint64_t *value) {
    char *end = NULL;
    *value = strtoull(*text, &end, 16);
    const bool taken = end != *text && *end == ' ';
    *text = taken ? end + 1 : *text;
    return taken;
}

static bool take_real(const char **text, double *value) {
    uint64_t bits;
    const bool taken = take(text, &bits);
    memcpy(value, &bits, sizeof bits);
    return taken;
}

bool wh_trial_lines_read(wh_trial_lines_t *lines, const char *text, size_t wafer_count) {
    bool sound = true;
    while (sound && *text != '\0') {
        uint64_t numbers[NUMBERS] = {0};
        double off = 0;
        for (size_t i = 0; sound && i < NUMBERS; ++i) {
            sound = take(&text, &numbers[i]);
        }
        sound = sound && take_real(&text, &off);
        wh_trial_line_t line = {numbers[0],
                                (numbers[1] & MET) != 0,
                                (numbers[1] & WHOLE) != 0,
                                (numbers[1] & ENDED) != 0,
                                (uint32_t)numbers[2],
                                (uint32_t)numbers[3],
                                (uint32_t)numbers[4],
                                (uint32_t)numbers[5],
                                (uint32_t)numbers[6],
                                (uint32_t)numbers[7],
                                (uint32_t)numbers[8],
                                (uint32_t)numbers[9],
                                off,
                                {0}};
        for (size_t f = 0; sound && f < WH_FLOW_SUM_FIGURES; ++f) {
            sound = take_real(&text, &line.flow[f]);
        }
        double *ends = wh_trial_lines_add(lines, &line, wafer_count);
        for (size_t e = 0; sound && e < wafer_count * WH_TRIAL_LINE_ENDS; ++e) {
            sound = take_real(&text, &ends[e]);
        }
    }
    return sound;
}

/* ---------------------------------------------------------------------------------------------------- why */

/* A reason that is being put together. */
typedef struct {
    char *text;
    size_t size, length;
} reason_t;

__attribute__((format(printf, 2, 3))) static void add_reason(reason_t *reason, const char *format, ...) {
    va_list arguments;
    char one[100];
    va_start(arguments, format);
    (void)vsnprintf(one, sizeof one, format, arguments);
    va_end(arguments);
    if (reason->length < reason->size) {
        reason->length += (size_t)snprintf(reason->text + reason->length, reason->size - reason->length,
                                           "%s%s", reason->length > 0 ? ", " : "", one);
    }
}

static const char *plural(uint32_t count) {
    return count == 1 ? "" : "s";
}

/* A script may also end by an error of its own. */
static void name_error(const wh_trial_line_t *trial, char *text, size_t size) {
    if (trial->error == 0) {
        (void)snprintf(text, size, "an error");
    } else {
        (void)snprintf(text, size, "%u %s in line %u", trial->error,
                       wh_status_name((wh_status_t)trial->error), trial->error_line);
    }
}

/* Adds the errors that stopped the commands of a trial. */
static void add_errors(reason_t *reason, const wh_trial_line_t *trial) {
    char error[80];
    name_error(trial, error, sizeof error);
    if (trial->ended) {
        add_reason(reason, "ended by %s", error);
    } else if (trial->errors > 0) {
        add_reason(reason, "%u command%s failed%s%s", trial->errors, plural(trial->errors),
                   trial->error > 0 ? ": " : "", trial->error > 0 ? error : "");
    }
}

void wh_trial_line_why(const wh_trial_line_t *trial, char *why, size_t size) {
    reason_t reason = {why, size, 0};
    why[0] = '\0';
    if (trial->met) {
        return;
    }
    add_errors(&reason, trial);
    if (trial->missed > 0) {
        add_reason(&reason, "line %u missed", trial->missed_line);
    }
    if (trial->missed > 1) {
        add_reason(&reason, "%u more", trial->missed - 1);
    }
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        if ((trial->kinds >> kind & 1U) != 0) {
            add_reason(&reason, "%s", wh_event_name((wh_event_kind_t)kind));
        }
    }
    if (trial->elsewhere > 0) {
        add_reason(&reason, "%u wafer%s elsewhere", trial->elsewhere, plural(trial->elsewhere));
    }
}
