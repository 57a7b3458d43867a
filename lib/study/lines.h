/* The results of single trials, a line each: for a table of them, and for points in a plot. */
#ifndef WH_STUDY_LINES_H
#define WH_STUDY_LINES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "flow_sums.h"

/* Where a wafer lies in its slot (mm, deg): dx, dy, dz, tilt. NaN if it is not where it should be, or lies
 * nowhere. */
#define WH_TRIAL_LINE_ENDS 4

typedef struct {
    uint64_t trial;
    bool met, whole, ended;
    uint32_t missed, errors, complaints; /* expectations, commands, events of the cell */
    uint32_t elsewhere;                  /* wafers */
    uint32_t kinds;                      /* of the complaints: bit wh_event_kind_t of each */
    uint32_t missed_line;                /* of the first expectation that was missed; 0: none */
    uint32_t error, error_line; /* of the command that ended it, else of the first that failed; 0: none */
    double off;                 /* mm, of the wafer that ends farthest off; infinite when one is elsewhere */
    double flow[WH_FLOW_SUM_FIGURES]; /* NaN: it has none, or there was no flow */
} wh_trial_line_t;

/* To be zeroed; `wafer_count` is that of the first line. */
typedef struct {
    size_t count, capacity, end_capacity, wafer_count;
    wh_trial_line_t *lines;
    double *ends; /* of line i from i * wafer_count * WH_TRIAL_LINE_ENDS on */
} wh_trial_lines_t;

/* Memory that runs out ends the program, here and below. */
void wh_trial_lines_free(wh_trial_lines_t *lines);

/* One more; returns the room for how its wafers lie. */
double *wh_trial_lines_add(wh_trial_lines_t *lines, const wh_trial_line_t *line, size_t wafer_count);
void wh_trial_lines_merge(wh_trial_lines_t *lines, const wh_trial_lines_t *other);

/* By trial. */
void wh_trial_lines_sort(wh_trial_lines_t *lines);

/* The number of lines of trials below this one. */
uint64_t wh_trial_lines_below(const wh_trial_lines_t *lines, uint64_t trial);

/* The lines as a text, to be freed: the bits of each number in hexadecimal digits. */
char *wh_trial_lines_text(const wh_trial_lines_t *lines);

/* Adds the lines of such a text. False if the text is not valid; some lines may then have been added. */
bool wh_trial_lines_read(wh_trial_lines_t *lines, const char *text, size_t wafer_count);

/* Why a trial is not ok, in a few words, such as "ended by 42 WAFER_MISSING in line 5, 1 wafer elsewhere".
 * Empty if it is ok. Writes at most `size` bytes. */
#define WH_TRIAL_LINE_WHY 400
void wh_trial_line_why(const wh_trial_line_t *trial, char *why, size_t size);

#endif
