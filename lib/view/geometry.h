/* Convex shapes as Drake's viewer takes them: mm become m, rotations unit quaternions, doubles floats.
 *
 * The viewer ends if a length is not above 0, or a quaternion's length differs from 1 by more than 1e-5. No
 * shape that wh_convex_validate passes yields either.
 *
 * Host code: ends the program if out of memory.
 */
#ifndef WH_VIEW_GEOMETRY_H
#define WH_VIEW_GEOMETRY_H

#include <waferhand_viewer_geometry.h>

#include "../collision/convex.h"

/* As a screen has it (sRGB), 0 to 1. */
typedef struct {
    float rgba[4];
} wh_view_colour_t;

/* waferhand_viewer_geometry.type. */
enum { WH_VIEW_BOX = 1, WH_VIEW_SPHERE, WH_VIEW_CYLINDER, WH_VIEW_TRIANGLES, WH_VIEW_CAPSULE };

/* A pose as the messages have it: m, and w, x, y, z with w >= 0. */
void wh_view_put_pose(const wh_pose_t *pose, float position[3], float quaternion[4]);

/* Fills in a geometry; wh_view_geometry_free frees its numbers. A mesh becomes its hull, as in a report, or
 * with `as_box` the box around it along its own axes. A capsule without a straight part is a ball. */
void wh_view_geometry_make(const wh_convex_t *convex, const wh_pose_t *body_from_shape,
                           const wh_view_colour_t *colour, bool as_box, waferhand_viewer_geometry *geometry);

void wh_view_geometry_free(waferhand_viewer_geometry *geometry);

#endif
