/* Within the report: the canvas of the Gantt table, one row at a time, time along the line. */
#ifndef WH_PRINT_GANTT_H
#define WH_PRINT_GANTT_H

#include "print_internal.h"

typedef struct {
    const char *mark; /* one column wide, or null: blank */
    double taken;     /* how much of the column the mark's interval takes */
    char *text;       /* printed from here on instead of the marks, over `wide` columns */
    size_t wide;
} wh_gantt_cell_t;

typedef struct {
    const wh_printer_t *report;
    size_t label_columns, columns;
    int64_t slices; /* from the first column to the last: the run's, above 0 */
    wh_gantt_cell_t *cells;
} wh_gantt_t;

/* What stands for a share, one column wide. */
const char *wh_gantt_mark(const wh_style_t *style, wh_share_t share);

/* An empty row as wide as the terminal leaves beside labels of so many columns, 100 columns without one. -1 when memory
 * is out. To be closed. */
int wh_gantt_open(wh_gantt_t *gantt, const wh_printer_t *report, size_t label_columns);
void wh_gantt_close(wh_gantt_t *gantt);

/* Empties the row. */
void wh_gantt_clear(wh_gantt_t *gantt);

/* The column in which a slice ends. */
size_t wh_gantt_column(const wh_gantt_t *gantt, int64_t slice);

/* Draws an interval; a column shows what takes most of its time. */
void wh_gantt_draw(wh_gantt_t *gantt, const wh_busy_span_t *interval);

/* Writes a text over the marks from column `first` on if it fits before `last`; else nothing. -1 when memory is out. */
int wh_gantt_write(wh_gantt_t *gantt, size_t first, size_t last, const char *text);

/* Prints the row behind its label, and empties it. -1 when memory is out. */
int wh_gantt_print(wh_gantt_t *gantt, const char *label);

#endif
