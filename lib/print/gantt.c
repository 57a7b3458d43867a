/* The Gantt table's canvas. */
#include <stdlib.h>
#include <string.h>

#include "gantt.h"

/* How wide the time is drawn: as the terminal, but at least and at most, or as here where there is none. */
#define LEAST_COLUMNS 20
#define MOST_COLUMNS 400
#define PIPED_COLUMNS 100

/* ---------------------------------------------------------------------------------------------------- marks */

const char *wh_gantt_mark(const wh_style_t *style, wh_share_t share) {
    static const char *const ascii[WH_SHARES] = {"#", "-", "v", "x", "."};
    static const char *const utf8[WH_SHARES] = {"█", "▒", "v", "x", "·"};
    return style->utf8 ? utf8[share] : ascii[share];
}

static const char *mark_of(const wh_style_t *style, const wh_busy_span_t *interval) {
    switch (interval->who) {
    case WH_BUSY_WAFER:
        return style->utf8 ? "━" : "=";
    case WH_BUSY_VALVE:
        return "o";
    case WH_BUSY_ROBOT:
    case WH_BUSY_CHUCK:
        break;
    }
    return wh_gantt_mark(style, (wh_share_t)(interval->what - 1));
}

/* ----------------------------------------------------------------------------------------------------- rows */

int wh_gantt_open(wh_gantt_t *gantt, const wh_printer_t *report, size_t label_columns) {
    const size_t wanted = report->style->width > label_columns + LEAST_COLUMNS + 2
                              ? report->style->width - label_columns - 2
                              : LEAST_COLUMNS;
    gantt->report = report;
    gantt->label_columns = label_columns;
    gantt->columns = report->style->width == 0 ? PIPED_COLUMNS
                     : wanted < MOST_COLUMNS   ? wanted
                                               : MOST_COLUMNS;
    gantt->slices = report->record->slices;
    gantt->cells = calloc(gantt->columns, sizeof *gantt->cells);
    return gantt->cells ? 0 : -1;
}

void wh_gantt_close(wh_gantt_t *gantt) {
    wh_gantt_clear(gantt);
    free(gantt->cells);
    gantt->cells = NULL;
}

void wh_gantt_clear(wh_gantt_t *gantt) {
    for (size_t i = 0; gantt->cells && i < gantt->columns; ++i) {
        free(gantt->cells[i].text);
        memset(&gantt->cells[i], 0, sizeof gantt->cells[i]);
    }
}

size_t wh_gantt_column(const wh_gantt_t *gantt, int64_t slice) {
    const double share = (double)slice / (double)gantt->slices;
    const size_t column = (size_t)(share * (double)gantt->columns);
    return column < gantt->columns ? column : gantt->columns - 1;
}

/* How much of a column's time lies within an interval, in columns. */
static double overlap(const wh_gantt_t *gantt, size_t column, const wh_busy_span_t *interval) {
    const double slices = (double)gantt->slices / (double)gantt->columns;
    const double begin = (double)interval->begin / slices;
    const double end = (double)interval->end / slices;
    const double from = begin > (double)column ? begin : (double)column;
    const double to = end < (double)column + 1 ? end : (double)column + 1;
    return to > from ? to - from : 0;
}

void wh_gantt_draw(wh_gantt_t *gantt, const wh_busy_span_t *interval) {
    const size_t last = wh_gantt_column(gantt, interval->end);
    for (size_t column = wh_gantt_column(gantt, interval->begin); column <= last; ++column) {
        wh_gantt_cell_t *cell = &gantt->cells[column];
        const double taken = overlap(gantt, column, interval);
        if (taken > cell->taken) {
            cell->taken = taken;
            cell->mark = mark_of(gantt->report->style, interval);
        }
    }
}

int wh_gantt_write(wh_gantt_t *gantt, size_t first, size_t last, const char *text) {
    char *printable = wh_style_printable(text);
    if (!printable) {
        return -1;
    }
    const size_t wide = wh_style_columns(printable);
    const bool fits = wide > 0 && first < gantt->columns && last <= gantt->columns && first + wide <= last &&
                      !gantt->cells[first].text;
    if (!fits) {
        free(printable);
        return 0;
    }
    gantt->cells[first].text = printable;
    gantt->cells[first].wide = wide;
    return 0;
}

int wh_gantt_print(wh_gantt_t *gantt, const char *label) {
    FILE *out = gantt->report->out;
    char *printable = wh_style_printable(label);
    if (!printable) {
        return -1;
    }
    fprintf(out, "%s%*s", printable, (int)(gantt->label_columns - wh_style_columns(printable) + 2), "");
    free(printable);
    size_t blanks = 0; /* not yet printed: none at the line's end */
    for (size_t i = 0; i < gantt->columns;) {
        const wh_gantt_cell_t *cell = &gantt->cells[i];
        const char *shown = cell->text ? cell->text : cell->mark;
        if (shown) {
            fprintf(out, "%*s%s", (int)blanks, "", shown);
        }
        blanks = shown ? 0 : blanks + 1;
        i += cell->text ? cell->wide : 1;
    }
    fputc('\n', out);
    wh_gantt_clear(gantt);
    return 0;
}
