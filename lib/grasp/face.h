/* Faces: a wafer may lie, and be held, face down.
 *
 * A wafer's frame is at the centre of its back face, and its e3 points out of its front face. A gripper
 * sees the face towards it. With the gripper's e3 = n2 that is the front face if e3 . n2 < 0, otherwise the
 * back face, so e3 . n2 = 0 counts as the back. For the front face equations (1) to (8) (proximity.h) are
 * evaluated with the wafer's frame moved by its thickness along e3 and turned by pi about e1:
 *
 *     base_from_front.r = r + thickness * e3        columns e1, -e2, -e3
 *
 * A change of sign alone would fail each pick of a wafer that lies face down, because 0.775 mm is above
 * eps_projz. A slot sees a wafer like a gripper, with its z as n2. The place of a wafer that lies face down
 * is that of its front face, at height 0 when it lies on the slot's plane.
 *
 * Lengths are in mm. A thickness is 0 to WH_FACE_THICKEST. It uses no heap and no state. wh_grasp_step and
 * the batches use back faces alone: a wafer that shows a gripper its front is never ready there, because
 * its n1_proj_n2 is below 0. A firmware that calls none of these functions does not link them.
 *
 * Bytes of stack on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12 (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_face_measure                 200    344     112    200
 *     stack of wh_face_turn_over               112    136       0     48
 */
#ifndef WH_GRASP_FACE_H
#define WH_GRASP_FACE_H

#include "proximity.h"

WH_HEADER_BEGIN

typedef enum WH_FOUR_BYTES { WH_FACE_BACK, WH_FACE_FRONT } wh_face_t;

#define WH_FACE_THICKEST 100

/* The face towards this gripper, or towards this slot. Nothing is checked. Cost: 3 products. */
wh_face_t wh_face_towards(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper)
    WH_SYMBOL(wh_face_towards);

/* The face that grips and passive pads see: wh_face_towards, or the back in a cell without faces, where a
 * thickness is 0. Nothing is checked. */
static inline wh_face_t wh_face_seen(const wh_pose_t *base_from_wafer, wh_real_t thickness,
                                     const wh_pose_t *base_from_gripper) {
    return thickness > 0 ? wh_face_towards(base_from_wafer, base_from_gripper) : WH_FACE_BACK;
}

/* The centre of that face, in base. Nothing is checked. Cost: 6 products. */
wh_vec3_t wh_face_centre(const wh_pose_t *base_from_wafer, wh_real_t thickness,
                         const wh_pose_t *base_from_gripper) WH_SYMBOL(wh_face_centre);

/* The frame in which a face is seen, written to other memory; for the back it is the wafer's own. Applied
 * again to a front's frame with `face` WH_FACE_FRONT, it gives the wafer's frame back, to rounding. Nothing
 * is checked. Cost: 3 products. */
void wh_face_frame(const wh_pose_t *base_from_wafer, wh_real_t thickness, wh_face_t face,
                   wh_pose_t *base_from_face) WH_SYMBOL(wh_face_frame);

/* wh_proximity_measure of the face towards the gripper; `face` receives that face. It refuses, and leaves
 * both results unchanged: what wh_proximity_measure refuses, with its status; a null `face`
 * (WH_STATUS_NULL_ARGUMENT); a thickness that is NaN or infinite (WH_STATUS_NOT_FINITE) or out of its range
 * (WH_STATUS_OUT_OF_RANGE). For the back face the values are those of wh_proximity_measure, bit for bit. */
wh_status_t wh_face_measure(const wh_pose_t *base_from_wafer, wh_real_t thickness,
                            const wh_pose_t *base_from_gripper, const wh_tolerance_t *tolerance,
                            wh_face_t *face, wh_proximity_t *result) WH_SYMBOL(wh_face_measure);

/* Turns a wafer over, like a wrist's flip or a flipper station: by pi about the x axis of `base_from_axis`,
 * in place. Seen in that frame the place (x, y, z) goes to (x, -y, -z), and seen from its +z a notch at a
 * to -a. Turned over twice, a wafer is at its old place, to 1e-12 mm for each 1,000 mm of its coordinates
 * (1e-3 mm in float). The wafer's rotation stays as orthonormal as before. Nothing is checked. Cost: 15
 * products and a division. */
void wh_face_turn_over(const wh_pose_t *base_from_axis, wh_pose_t *base_from_wafer)
    WH_SYMBOL(wh_face_turn_over);

/* The radius of the space that a wafer of this radius sweeps when it is turned over about an axis. Its
 * centre plane is `height` mm from the axis: sqrt(radius^2 + (|height| + thickness / 2)^2), the distance of
 * its farthest corner. Nothing is checked. Cost: a square root. */
wh_real_t wh_face_swept_radius(wh_real_t radius, wh_real_t thickness, wh_real_t height)
    WH_SYMBOL(wh_face_swept_radius);

WH_HEADER_END

#endif
