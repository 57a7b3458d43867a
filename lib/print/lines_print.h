/* A run line by line, for other programs: events as JSON, slices as CSV. */
#ifndef WH_PRINT_LINES_PRINT_H
#define WH_PRINT_LINES_PRINT_H

#include <stdio.h>

#include "../record/record.h"

/* Prints the i-th event as one line: the object that stands in `events` of the record as JSON
 * (print/record_print.h). 0, or -1 if `out` does not take it. */
int wh_event_print_line(const wh_record_t *record, size_t i, FILE *out);

/* The head of a table of slices as of RFC 4180, but that lines end with a line feed: "slice", "time s", and
 * the names of log/slice_fields.h. */
void wh_slices_csv_head(const wh_layout_t *layout, FILE *out);

/* A slice's row, of the `values` of its fields. Numbers have the digits that read back as the same double;
 * who holds and what is nearest stand there by name; what is not known or not there is empty. Errors are
 * `out`'s. */
void wh_slices_csv_row(const wh_layout_t *layout, int64_t slice, const double values[], FILE *out);

#endif
