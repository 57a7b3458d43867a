/* Errors that are given by name, as run --error has them: "A.x=0.12". */
#ifndef WH_LAYOUT_GIVEN_H
#define WH_LAYOUT_GIVEN_H

#include "layout.h"

/* The layout's errors are from now on these, and nothing is drawn: of a station x, y, z (mm), roll, pitch,
 * yaw (deg), of several robots also x, y, z of one alone, "A.ROBOT.x"; of a wafer dx, dy, dz (mm), tilt_x,
 * tilt_y, turn (deg), and what wh_rim_draw_name has; of a beam ("LL.beam1") dx, dy (mm), late (s); of a
 * gripper valve (s); and "vacuum" (s) without a name. What no text names is 0; the last text that names an
 * error counts. The memory is L's. Raises "--error TEXT: what is wrong (expected ...)". Cost: linear in
 * texts, times stations and wafers. */
void wh_layout_give_errors(lua_State *L, wh_layout_t *layout, const char *const texts[], size_t count);

#endif
