/* Estimates from measurements: tables for people, JSON for programs, and text that a layout can read. */
#ifndef WH_PRINT_ESTIMATE_PRINT_H
#define WH_PRINT_ESTIMATE_PRINT_H

#include <stdio.h>

#include "../estimate/tables.h"
#include "../text/style.h"

/* Each prints the estimates from an opened table, and returns 0, or -1 if `out` does not take it. JSON is one
 * object; its numbers, read back, are the same doubles. Lengths in mm, angles in degrees. */
int wh_frames_print_table(const wh_point_table_t *table, FILE *out, const wh_style_t *style);
int wh_frames_print_json(const wh_point_table_t *table, FILE *out);
int wh_limits_print_table(const wh_move_table_t *table, FILE *out, const wh_style_t *style);
int wh_limits_print_json(const wh_move_table_t *table, FILE *out);
int wh_geometry_print_table(const wh_touch_table_t *table, FILE *out, const wh_style_t *style);
int wh_geometry_print_json(const wh_touch_table_t *table, FILE *out);

/* The fields of a layout, in Lua. A determined value has as many digits as its standard deviation leaves; an
 * undetermined one is a comment. */
void wh_frames_print_lua(const wh_point_table_t *table, FILE *out);
void wh_limits_print_lua(const wh_move_table_t *table, FILE *out);

/* Prints where the tool sits on the robot. Comments hold the values that have no field in a layout: where its
 * base is in the frame of the touched points, and how its r relates to the controller's. */
void wh_geometry_print_lua(const wh_touch_table_t *table, FILE *out);

/* The unit of a number of a geometry, and the factor from mm or rad to it. */
const char *wh_geometry_unit(int number, double *factor);

/* How a limit is named in layouts, and its unit; of WH_LIMIT_SPEED to WH_LIMIT_DELAY. */
const char *wh_limit_name(int limit);
const char *wh_limit_unit(int limit, bool turns);

#endif
