/* Triangles of a cell's parts, for display: mm in the frame of their body.
 *
 * Host code: it ends the program if out of memory.
 */
#ifndef WH_SCENE_MESH_H
#define WH_SCENE_MESH_H

#include "../collision/convex.h"

/* Zero it at the beginning. `vertices` are in the order x, y, z and the normal's x, y, z. `indices` has
 * three for each triangle, counter-clockwise seen from outside. */
typedef struct {
    float (*vertices)[6];
    size_t vertex_count, vertex_capacity;
    uint32_t *indices;
    size_t index_count, index_capacity;
} wh_mesh_t;

/* Adds a shape at a place in the body's frame; round ones have 48 corners. A mesh is shown as the hull of
 * its points, of at most 512 outermost ones. */
void wh_mesh_add_convex(wh_mesh_t *mesh, const wh_convex_t *convex, const wh_pose_t *body_from_shape);

/* Adds a wafer in its own frame: a disc from its back face up, with a notch of 90 degrees and this depth (0:
 * none) in the direction `notch` (rad about z from x). */
void wh_mesh_add_wafer(wh_mesh_t *mesh, double radius, double thickness, double notch, double depth);

/* The convex hull of a mesh's points. */
void wh_mesh_add_hull(wh_mesh_t *mesh, const wh_convex_t *convex, const wh_pose_t *body_from_shape);

void wh_mesh_free(wh_mesh_t *mesh);

#endif
