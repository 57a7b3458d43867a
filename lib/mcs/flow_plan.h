/* Reads what a script says of a flow. */
#ifndef WH_MCS_FLOW_PLAN_H
#define WH_MCS_FLOW_PLAN_H

#include <lua.h>

#include "../flow/figures.h"
#include "../layout/layout.h"
#include "../script/reader.h"

/* Reads lots, routes and rule from the table on top of the stack into a zero flow, and finishes the plan.
 * Raises the first fault; the flow must then be closed. `layout`: whose carriers lots name. */
void wh_flow_read(wh_reader_t *reader, const wh_flow_tool_t *tool, const wh_layout_t *layout,
                  wh_flow_t *flow);

/* Reads the field `rule` of that table, once lots and routes are read. */
void wh_flow_read_rule(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_plan_t *plan);

/* The fields of the table and of those in it. */
extern const wh_reader_field_t wh_flow_fields[];
extern const wh_reader_field_t wh_flow_lot_fields[];
extern const wh_reader_field_t wh_flow_down_fields[];
extern const wh_reader_field_t wh_flow_list_fields[];

#endif
