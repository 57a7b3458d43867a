/* Between the files of lib/view. */
#ifndef WH_VIEW_CELL_INTERNAL_H
#define WH_VIEW_CELL_INTERNAL_H

#include "cell.h"
#include "geometry.h"

/* One more body, without shapes, at base; `name` may be null: the folder's. Returns its index. */
size_t wh_view_add_body(wh_view_cell_t *cell, const char *folder, const char *name);

/* One more shape of the body that was added last. */
void wh_view_add_shape(wh_view_cell_t *cell, const wh_convex_t *convex, const wh_pose_t *body_from_shape,
                       const wh_view_colour_t *colour);

/* Makes `draw` of the bodies, once all are there. */
void wh_view_draw_open(wh_view_cell_t *cell);

/* A body's place. */
void wh_view_place(wh_view_cell_t *cell, size_t body, const wh_pose_t *base_from_body);

#endif
