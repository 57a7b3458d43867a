/* A layout and its findings: tables for people, JSON for programs. */
#ifndef WH_PRINT_LAYOUT_PRINT_H
#define WH_PRINT_LAYOUT_PRINT_H

#include <stdio.h>

#include "../survey/feasibility.h"
#include "../text/style.h"

/* Each returns 0, or -1 if `out` does not take it. */
int wh_layout_print_table(const wh_feasibility_t *check, FILE *out, const wh_style_t *style);

/* One object; its numbers, read back, are the same doubles. Lengths in mm, angles in degrees. */
int wh_layout_print_json(const wh_feasibility_t *check, FILE *out);

#endif
