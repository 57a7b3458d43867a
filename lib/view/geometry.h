/* Bodies and their convex shapes for Drake's viewer: mm become m, rotations become unit quaternions,
 * doubles become floats. One message has the bodies (LOAD), another their places (DRAW).
 *
 * The viewer ends if a length is not above 0, or a quaternion's length differs from 1 by more than 1e-5. A
 * shape that wh_convex_validate passes causes neither.
 *
 * Host code: it ends the program if out of memory.
 */
#ifndef WH_VIEW_GEOMETRY_H
#define WH_VIEW_GEOMETRY_H

#include <waferhand_viewer_draw.h>
#include <waferhand_viewer_load.h>

#include "../collision/convex.h"

/* A screen's colour (sRGB), 0 to 1. */
typedef struct {
    float rgba[4];
} wh_view_colour_t;

/* Converts 0xrrggbb. */
wh_view_colour_t wh_view_colour(uint32_t hex, float opacity);

/* waferhand_viewer_geometry.type. */
enum { WH_VIEW_BOX = 1, WH_VIEW_SPHERE, WH_VIEW_CYLINDER, WH_VIEW_TRIANGLES, WH_VIEW_CAPSULE };

/* A pose for the messages: m, and w, x, y, z with w >= 0. */
void wh_view_put_pose(const wh_pose_t *pose, float position[3], float quaternion[4]);

/* Fills in a geometry; wh_view_geometry_free frees its numbers. A mesh becomes its hull, like in a report,
 * or with `as_box` the box around it along its own axes. A capsule without a straight part is a ball. */
void wh_view_geometry_make(const wh_convex_t *convex, const wh_pose_t *body_from_shape,
                           const wh_view_colour_t *colour, bool as_box, waferhand_viewer_geometry *geometry);

void wh_view_geometry_free(waferhand_viewer_geometry *geometry);

/* Zero it at the beginning. `load` and `draw` are both in the order of the bodies. */
typedef struct {
    waferhand_viewer_load load;
    waferhand_viewer_draw draw;
    size_t capacity;
    float (*places)[7]; /* of each body: position, quaternion */
} wh_view_bodies_t;

/* Adds a body without shapes and returns its index. Its path is "folder::name", or with a null `name` the
 * folder. A name's '/', ':', '%' and any byte that is no printable UTF-8 become %2F and so on, because the
 * viewer's own paths consist of the first two. */
size_t wh_view_bodies_add(wh_view_bodies_t *bodies, const char *folder, const char *name);

/* A new shape of the last added body, all zero; it is valid until the next one. */
waferhand_viewer_geometry *wh_view_bodies_add_shape(wh_view_bodies_t *bodies);

/* Makes `draw` once all bodies exist, each at base. From then on they must not be moved. */
void wh_view_bodies_open(wh_view_bodies_t *bodies);

void wh_view_bodies_place(wh_view_bodies_t *bodies, size_t body, const wh_pose_t *base_from_body);

void wh_view_bodies_free(wh_view_bodies_t *bodies);

#endif
