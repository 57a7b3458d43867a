/* Within the listing of a layout: what its parts share. */
#ifndef WH_PRINT_LAYOUT_TABLE_INTERNAL_H
#define WH_PRINT_LAYOUT_TABLE_INTERNAL_H

#include "../text/grid.h"
#include "layout_print.h"

/* What every part of the listing is given. */
typedef struct {
    const wh_feasibility_t *check;
    const wh_layout_t *layout;
    const wh_style_t *style;
    FILE *out;
} wh_listing_t;

/* Prints a table under its title and frees it; nothing when it has no rows. 0, or -1. */
int wh_listing_finish(const wh_listing_t *listing, const char *title, wh_grid_t *grid);

/* Vacuum and pads, and the faults that are there from the beginning. 0, or -1. */
int wh_listing_print_physics(const wh_listing_t *listing);

#endif
