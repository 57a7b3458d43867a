/* The columns of a field log: by a map, or those of `waferhand csv`. */
#ifndef WH_LOOP_FIELD_MAP_H
#define WH_LOOP_FIELD_MAP_H

#include "field.h"

/* An axis's name in maps: as in commands; with several robots, and beside them, as in tables. */
void wh_field_axis_name(const wh_layout_t *layout, size_t axis, char *name, size_t size);

/* Finds out the separator that the map says; a comma. False, with the field's message, if the map is none. */
bool wh_field_map_separator(wh_field_log_t *field, const wh_sandbox_limits_t *limits, char *separator);

/* Fills in the sources of an open file, whose first line is read. False, with the field's message: a column
 * is missing, unknown or named twice. */
bool wh_field_map_read(wh_field_log_t *field, const wh_sandbox_limits_t *limits);

/* Likewise by the names of `waferhand csv`. */
bool wh_field_map_usual(wh_field_log_t *field);

#endif
