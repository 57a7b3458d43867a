/* A run line by line, for other programs: events as JSON. */
#ifndef WH_PRINT_LINES_PRINT_H
#define WH_PRINT_LINES_PRINT_H

#include <stdio.h>

#include "../record/record.h"

/* Prints the i-th event as one line: the object that stands in `events` of the record as JSON
 * (print/record_print.h). 0, or -1 if `out` does not take it. */
int wh_event_print_line(const wh_record_t *record, size_t i, FILE *out);

#endif
