/* A cell whose robots are times alone: it needs no places, and nothing in it is looked at but times. */
#ifndef WH_READING_LAYOUT_TOOL_H
#define WH_READING_LAYOUT_TOOL_H

#include "../flow/tool.h"
#include "../script/reader.h"

/* True if the robots of the layout at which the reader is are of kind "timed"; raises if some are and others are
 * not. */
bool wh_layout_is_timed(wh_reader_t *reader);

/* Reads such a cell: its robots' times and its stations. The tool lives as long as the Lua state. Raises the first
 * fault. */
const wh_flow_tool_t *wh_layout_read_tool(wh_reader_t *reader);

/* Whole microseconds of a time in s. */
int64_t wh_layout_us(double seconds);

extern const wh_reader_field_t wh_layout_timed_fields[];
extern const wh_reader_field_t wh_layout_timed_robot_fields[];
extern const wh_reader_field_t wh_layout_timed_station_fields[];
extern const wh_reader_field_t wh_layout_timed_by_fields[];
extern const wh_reader_field_t wh_layout_timed_door_fields[];
extern const wh_reader_field_t wh_layout_clean_fields[];
extern const wh_reader_field_t wh_layout_pump_fields[];

#endif
