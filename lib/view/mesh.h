/* Triangles of a cell's parts, for looking at: mm in the frame of the body that they are part of.
 *
 * Host code: ends the program if out of memory.
 */
#ifndef WH_VIEW_MESH_H
#define WH_VIEW_MESH_H

#include "../collision/convex.h"

/* Zero it to begin with. `vertices` are in order x, y, z and the normal's x, y, z; `indices` three a
 * triangle, counter-clockwise seen from outside. */
typedef struct {
    float (*vertices)[6];
    size_t vertex_count, vertex_capacity;
    uint32_t *indices;
    size_t index_count, index_capacity;
} wh_mesh_t;

/* Adds a shape at a place in the body's frame; round ones have 48 corners. A mesh is shown as the hull of its
 * points, of at most 512 that lie outermost. */
void wh_mesh_add_convex(wh_mesh_t *mesh, const wh_convex_t *convex, const wh_pose_t *body_from_shape);

/* Adds a wafer in its own frame: a disc from its back face up, with a notch of 90 degrees and this depth (0:
 * none) in the direction `notch` (rad about z from x). */
void wh_mesh_add_wafer(wh_mesh_t *mesh, double radius, double thickness, double notch, double depth);

/* The convex hull of a mesh's points. */
void wh_mesh_add_hull(wh_mesh_t *mesh, const wh_convex_t *convex, const wh_pose_t *body_from_shape);

void wh_mesh_free(wh_mesh_t *mesh);

#endif
