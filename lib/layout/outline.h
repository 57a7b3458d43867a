/* The outline of a convex part, seen from above or from the side. */
#ifndef WH_LAYOUT_OUTLINE_H
#define WH_LAYOUT_OUTLINE_H

#include "../collision/convex.h"

/* From above: x to the right, y up. From the side, along base's y: x to the right, z up. */
typedef enum { WH_VIEW_TOP, WH_VIEW_SIDE } wh_projection_t;

/* A point of the picture, mm; y points down. */
typedef struct {
    double x, y;
} wh_spot_t;

/* Corners in order. The outline owns `spots`. Start with all zero; the memory is kept from use to use. */
typedef struct {
    wh_spot_t *spots;
    size_t count, capacity;
} wh_outline_t;

/* The place of a point in the picture. */
wh_spot_t wh_outline_spot(wh_projection_t view, wh_vec3_t r);

/* The convex hull of the part as seen. Circles have 48 corners. Ends the program if out of memory. Cost:
 * n log n in the points of a mesh. */
void wh_outline_draw(wh_outline_t *outline, wh_projection_t view, const wh_convex_t *convex,
                     const wh_pose_t *base_from_shape);

void wh_outline_free(wh_outline_t *outline);

#endif
