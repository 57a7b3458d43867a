/* A cell whose robots are times alone: it needs no places, and nothing in it is looked at but times. */
#ifndef WH_READING_LAYOUT_TOOL_H
#define WH_READING_LAYOUT_TOOL_H

#include "../flow/load_port.h"
#include "../flow/tool.h"
#include "../layout/times.h"
#include "../script/reader.h"

/* True if all robots of the layout at which the reader is are of kind "timed"; and if some are, and others
 * are not. */
bool wh_layout_is_timed(wh_reader_t *reader);
bool wh_layout_is_mixed(const wh_reader_t *reader);

/* Reads such a cell: its robots' times and its stations. The tool lives as long as the Lua state. Raises
 * the first fault. */
const wh_flow_tool_t *wh_layout_read_tool(wh_reader_t *reader);

/* A tool of the layout's robots and stations by their names; nothing else of it is read. It lives as long as
 * the Lua state. */
wh_flow_tool_t *wh_timed_open_tool(wh_reader_t *reader);

/* Whole microseconds of a time in s. */
int64_t wh_layout_us(double seconds);

/* ---- shared by the files that read such a cell and its flows; each raises the first fault */

/* The longest time of a station or a robot, s. */
#define WH_TIMED_LONGEST_S WH_LAYOUT_LONGEST_S

typedef struct {
    char name[WH_NAME_SIZE];
} wh_timed_name_t;

/* The keys of the table at which the reader is, in the order of their bytes; `what` says what they name. */
const wh_timed_name_t *wh_timed_read_names(wh_reader_t *reader, const char *what, size_t *count);

/* A time of at most WH_TIMED_LONGEST_S; `fallback` in s, NAN: it must be there. */
int64_t wh_timed_read_us(wh_reader_t *reader, const char *field, double fallback);

/* The number of the station of this name, which stands in this field. */
int32_t wh_timed_find_station(wh_reader_t *reader, const wh_flow_tool_t *tool, const char *field,
                              const char *name);

/* A time by its row. */
int64_t wh_layout_read_us(wh_reader_t *reader, const char *field);

/* `at`: the stations' places, for robots with a speed. */
void wh_timed_read_robot(wh_reader_t *reader, wh_flow_tool_t *tool, int32_t robot, const wh_vec3_t at[]);

/* `process`, `window`, `clean`, `pump` and `state` of the station at which the reader is; `pump_fields` are
 * those that a pump may have there. Its recipes are kept. */
void wh_layout_read_clockwork(wh_reader_t *reader, wh_flow_station_t *station, wh_flow_recipes_t *recipes,
                              const wh_reader_field_t *pump_fields);

/* The times of a load port's steps and its state, WH_NONE without the field, from the table at which the
 * reader is. */
void wh_layout_read_port_steps(wh_reader_t *reader, wh_load_port_of_t *of);

/* Reads a number, or a table of numbers by recipe with `default`, by the row of the field. Returns the number
 * for wafers without a recipe, and has that of each recipe in `by`, number 1 first. `is_table`: some of them
 * may differ. */
double wh_layout_read_by_recipe(wh_reader_t *reader, const char *field, wh_flow_recipes_t *recipes,
                                double by[WH_FLOW_RECIPES], bool *is_table);

/* The number of the recipe of this name, which stands in this field; an unknown name is refused with those
 * that there are. And that of the field `recipe`, 0 without it. */
int32_t wh_layout_find_recipe(const wh_reader_t *reader, const wh_flow_recipes_t *recipes, const char *field,
                              const char *name);
int32_t wh_layout_read_recipe(wh_reader_t *reader, const wh_flow_recipes_t *recipes);

#endif
