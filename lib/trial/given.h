/* Errors that are given by name, as run --error has them: "A.x=0.12". */
#ifndef WH_TRIAL_GIVEN_H
#define WH_TRIAL_GIVEN_H

#include <lua.h>

#include "../layout/layout.h"

/* Makes these the layout's errors; nothing is drawn any more. A station has x, y, z (mm), roll, pitch, yaw
 * (deg); with several robots also x, y, z for one alone, "A.ROBOT.x". A wafer has dx, dy, dz (mm), tilt_x,
 * tilt_y, turn (deg), and the names of wh_rim_draw_name. A beam ("LL.beam1") has dx, dy (mm), late (s). A
 * gripper has valve (s). "vacuum" and "debounce" (s) stand without a name. An error that no text names is 0;
 * the last text that names an error counts. The memory is L's. Raises "--error TEXT: what is wrong
 * (expected ...)". Cost: linear in texts, times stations and wafers. */
void wh_layout_give_errors(lua_State *L, wh_layout_t *layout, const char *const texts[], size_t count);

#endif
