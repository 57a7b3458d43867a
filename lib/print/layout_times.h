/* The stations of a layout that take time: rows of a table, and JSON. */
#ifndef WH_PRINT_LAYOUT_TIMES_H
#define WH_PRINT_LAYOUT_TIMES_H

#include <jansson.h>

#include "../flow/clock.h"
#include "../layout/layout.h"
#include "../text/grid.h"

/* The columns behind the station's name. */
#define WH_LAYOUT_TIMES_COLUMNS "station;process s{0,6};window s{0,6};clean;pump;when a run begins"

void wh_layout_times_fill(const wh_layout_t *layout, wh_grid_t *grid);

/* { process, window (null: none), clean, pump (null: none) }, times in s; what goes by recipe in
 * `by_recipe`. */
json_t *wh_layout_times_to_json(const wh_layout_t *layout, const wh_layout_times_t *times);

#endif
