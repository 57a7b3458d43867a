/* Convex shapes: boxes, cylinders, capsules and convex meshes, each at its place in a body.
 *
 * A shape has its own frame. Its centre is at the origin (a mesh: wherever its points are); its axis, if it
 * has one, is z. Poses are those of the shape: base_from_shape = base_from_body * body_from_shape, which
 * the caller multiplies once for many questions. Units: mm. No function here keeps a reference to an
 * argument or allocates, and all are reentrant. They use only sqrt and fabs of libm, so the bits are equal
 * on every machine. They exist in double only.
 */
#ifndef WH_COLLISION_CONVEX_H
#define WH_COLLISION_CONVEX_H

#include "../math/pose.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(convex);

/* The thinnest and the largest shape, and the most points of a mesh. */
#define WH_CONVEX_THINNEST 0.01
#define WH_CONVEX_LARGEST 1e5
#define WH_CONVEX_POINTS 65536

typedef enum WH_FOUR_BYTES {
    WH_CONVEX_BOX,
    WH_CONVEX_CYLINDER,
    WH_CONVEX_CAPSULE,
    WH_CONVEX_MESH
} wh_convex_kind_t;

/* A plain struct: copy it freely. Fields that a kind does not name are ignored. */
typedef struct {
    wh_convex_kind_t kind;
    /* BOX: half lengths; CYLINDER: x radius, z half height; CAPSULE: x radius, z half length of the axis
     * between its two balls (0: one ball). */
    wh_vec3_t half;
    /* MESH: the caller's points, which must outlive the shape; it is their convex hull. */
    const wh_vec3_t *points;
    size_t point_count;
    /* The shape's place in its body's frame. */
    wh_pose_t body_from_shape;
} wh_convex_t;

/* WH_OK if the shape is valid; all other functions here, and those of gap.h, need that.
 * WH_STATUS_NULL_ARGUMENT (the shape, or the points of a mesh); WH_STATUS_NOT_FINITE;
 * WH_STATUS_NOT_A_ROTATION (body_from_shape); WH_STATUS_OUT_OF_RANGE: no such kind, a half length or radius
 * below WH_CONVEX_THINNEST / 2, a coordinate or length above WH_CONVEX_LARGEST, a mesh of fewer than 4 or
 * more than WH_CONVEX_POINTS points, or flatter than WH_CONVEX_THINNEST. Cost: linear in the points. */
wh_status_t wh_convex_validate(const wh_convex_t *shape) WH_SYMBOL(wh_convex_validate);

/* A point of the shape (base) that lies farthest in a direction (base, of any length). If there are many:
 * the middle of a box's or a cylinder's face or edge, the first of a mesh's points; for the zero direction
 * any point of the shape. Cost: 10 ns, for a mesh linear in its points. */
wh_vec3_t wh_convex_support(const wh_convex_t *shape, const wh_pose_t *base_from_shape, wh_vec3_t direction)
    WH_SYMBOL(wh_convex_support);

/* The radius of the smallest ball about the BODY's origin that holds the shape. Cost: a square root; linear
 * in the points of a mesh. */
wh_real_t wh_convex_radius(const wh_convex_t *shape) WH_SYMBOL(wh_convex_radius);

/* The smallest box along base's axes that holds the shape, to rounding. Cost: three square roots; linear in
 * the points of a mesh. */
void wh_convex_bounds(const wh_convex_t *shape, const wh_pose_t *base_from_shape, wh_vec3_t *low,
                      wh_vec3_t *high) WH_SYMBOL(wh_convex_bounds);

WH_HEADER_END

#endif
