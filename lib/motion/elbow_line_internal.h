/* A SCARA's straight line; internal to the room. */
#ifndef WH_MOTION_ELBOW_LINE_INTERNAL_H
#define WH_MOTION_ELBOW_LINE_INTERNAL_H

#include "chain_line.h"

/* Completes a line whose `kind`, `from` and `to` (as from) are set. `step` is in the column's plane and
 * along the column. Returns the status of wh_chain_line_plan. */
wh_status_t wh_elbow_line_plan(wh_chain_line_t *line, const wh_chain_t *chain, const wh_vec3_t *step,
                               const wh_line_caps_t *caps) WH_SYMBOL(wh_elbow_line_plan);

/* Writes the arm's axes at `along` mm from the start. The others in q stay unchanged. */
void wh_elbow_line_axes(const wh_chain_line_t *line, wh_real_t along, wh_real_t q[WH_CHAIN_AXES])
    WH_SYMBOL(wh_elbow_line_axes);

#endif
