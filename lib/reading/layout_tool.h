/* A cell whose robots are times alone: it needs no places, and nothing in it is looked at but times. */
#ifndef WH_READING_LAYOUT_TOOL_H
#define WH_READING_LAYOUT_TOOL_H

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
 * those that a pump may have there. */
void wh_layout_read_clockwork(wh_reader_t *reader, wh_flow_station_t *station,
                              const wh_reader_field_t *pump_fields);

#endif
