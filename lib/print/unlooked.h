/* Lines about what the runs of a sweep, or the scripts of a test, have left out, though they may be ok. */
#ifndef WH_PRINT_UNLOOKED_H
#define WH_PRINT_UNLOOKED_H

#include <stddef.h>
#include <stdio.h>

#include "../study/sweep.h"

typedef struct {
    const char *before; /* of each line: "! ", or "# " for TAP */
    const char *what;   /* "run" or "script" */
    size_t unchecked;   /* nobody looked for collisions, though robots have axes */
    size_t timed;       /* the robots are times alone */
    size_t partly;      /* some are, beside robots with axes */
    size_t cut;         /* its flow was cut with wafers not at their ends */
} wh_print_unlooked_t;

/* Counts a run of a sweep, if it was played. */
void wh_print_unlooked_add(wh_print_unlooked_t *unlooked, const wh_sweep_point_t *point);

/* Prints a line for each that is not 0. */
void wh_print_unlooked(const wh_print_unlooked_t *unlooked, FILE *out);

#endif
