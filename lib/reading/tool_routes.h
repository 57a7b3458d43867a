/* Routes of wafers through a tool of times alone: those that a layout has, and those of a flow. */
#ifndef WH_READING_TOOL_ROUTES_H
#define WH_READING_TOOL_ROUTES_H

#include "layout_tool.h"

/* The longest time of a flow and of a route's step, s: ten years. */
#define WH_FLOW_LONGEST_S 3.2e8

/* A time of at most WH_FLOW_LONGEST_S; `fallback` in s, NAN: it must be there. */
int64_t wh_flow_read_us(wh_reader_t *reader, const char *field, double fallback);

/* How many entries the table at which the reader is has, beside the known fields. Others are refused. */
size_t wh_timed_count_entries(wh_reader_t *reader, const wh_reader_field_t *known);

/* The text that is entry `index` of the table at which the reader is, "" if there is none; refused if it
 * is something else. */
const char *wh_timed_read_entry(wh_reader_t *reader, size_t index, char text[WH_NAME_SIZE]);

/* Reads the route of this name in the table at which the reader is. Raises the first fault; the route must
 * then be closed. */
void wh_timed_read_route(wh_reader_t *reader, const wh_flow_tool_t *tool, const char *name,
                         wh_flow_route_t *route);

/* Refuses a wanted field where a robot that is times alone comes to the station, or all are. */
void wh_flow_refuse_timed(wh_reader_t *reader, const wh_flow_tool_t *tool, int32_t station, const char *field,
                          bool is_wanted);

/* Reads `routes` of a layout, if there are any, into a tool whose stations are read. */
void wh_timed_read_routes(wh_reader_t *reader, wh_flow_tool_t *tool);

extern const wh_reader_field_t wh_flow_step_fields[];
extern const wh_reader_field_t wh_flow_route_fields[];

#endif
