/* Within the grid: its memory, which grid.c fills and grid_print.c prints. */
#ifndef WH_TEXT_GRID_INTERNAL_H
#define WH_TEXT_GRID_INTERNAL_H

#include "grid.h"

/* A cell is empty, a text (not null) or a number. */
typedef struct {
    char *text;
    double number;
    bool is_number;
    wh_ink_t ink;
} wh_grid_cell_t;

typedef struct {
    char *heading;
    bool to_right;
    bool glued; /* stays beside the column before it where there is room */
    wh_grid_digits_t digits;
    int decimals; /* what the numbers so far need */
    size_t width; /* known after measure_columns */
} wh_grid_column_t;

struct wh_grid {
    wh_style_t style;
    size_t keys;
    wh_grid_column_t columns[WH_GRID_COLUMNS];
    size_t column_count;
    wh_grid_cell_t *cells; /* row by row */
    size_t row_count, row_capacity;
    bool failed;
};

#endif
