/* The proximity check: may this gripper take this wafer?
 *
 * Equations (1)-(8) of "Implementation of pick-and-place algorithms for the purposes of wafer handling
 * robotics simulations". The wafer's origin is the centre of its back face and its e3 = n1 points out of the
 * front face; the gripper's origin is the centre of its contact plane and its e3 = n2 points towards the
 * wafer. Both poses are seen from base.
 *
 *     dr = r_w - r_g                  (1)    ready <=> |dr_proj_z|  < eps_projz   (6)
 *     n1_proj_n2 = n1 . n2            (2)          and |dr_proj_xy| < eps_projxy  (7)
 *     dr_proj_z  = dr . n1            (3)          and n1_proj_n2   > eps_planar  (8)
 *     dr_proj_xy = R_w^T dr           (4)
 *     |dr_proj_xy| = sqrt(x^2 + y^2)  (5)    of (4)
 *
 * All three comparisons are strict: a value equal to its limit fails.
 */
#ifndef WH_GRASP_PROXIMITY_H
#define WH_GRASP_PROXIMITY_H

#include "../math/pose.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(proximity);

/* The three limits: eps_projz in (0, 1e6] mm, eps_projxy in [1e-6, 1e6] mm, eps_planar in [0, 1). */
typedef struct {
    wh_real_t projz, projxy, planar;
} wh_tolerance_t;

/* Between slices a wafer is taken well inside the window, within this share of eps_projz, so that rounding
 * cannot put it outside again. */
#define WH_SWEEP_INSIDE WH_REAL(0.998)

/* Conditions that did not hold, as bits of wh_proximity_t.failed. */
enum { WH_FAILED_PROJZ = 1, WH_FAILED_PROJXY = 2, WH_FAILED_PLANAR = 4 };

/* Every value of (1)-(5), and the verdict. A margin is the distance of the value inside its limit: mm for
 * projz and projxy, a cosine for planar. A positive margin means that the condition holds, zero that it
 * just fails. */
typedef struct {
    wh_vec3_t dr;              /* (1), base, mm */
    wh_real_t n1_proj_n2;      /* (2) */
    wh_real_t dr_proj_z;       /* (3), mm */
    wh_vec3_t dr_proj_xy;      /* (4), in the wafer's frame, mm */
    wh_real_t dr_proj_xy_norm; /* (5), mm */
    wh_real_t margin_projz, margin_projxy, margin_planar;
    unsigned failed; /* WH_FAILED_* bits; 0 when ready */
    bool ready;
} wh_proximity_t;

/* The paper's reference parameters, "paper": 0.5 mm, 50 mm, 0.99. The last is 8.1 degrees, which lets the
 * rim of a 300 mm wafer be 21 mm out of plane: see wh_proximity_rim_gap. */
wh_tolerance_t wh_tolerance_paper(void) WH_SYMBOL(wh_tolerance_paper);

/* "strict": 0.5 mm, 5 mm, 0.99998; the rim of a 300 mm wafer is out of plane by less than 1 mm. */
wh_tolerance_t wh_tolerance_strict(void) WH_SYMBOL(wh_tolerance_strict);

/* The number of presets, and one of them: `index` is 0 to WH_TOLERANCE_PRESETS - 1; any other value gives
 * null and leaves `tolerance` unchanged. Returns the preset's name, a constant string. */
#define WH_TOLERANCE_PRESETS 2
const char *wh_tolerance_preset(size_t index, wh_tolerance_t *tolerance) WH_SYMBOL(wh_tolerance_preset);

/* WH_STATUS_BAD_TOLERANCE when a limit is NaN or out of the range given at wh_tolerance_t. */
wh_status_t wh_tolerance_validate(const wh_tolerance_t *tolerance) WH_SYMBOL(wh_tolerance_validate);

/* Measures for people: all values, margins and reasons. It refuses null pointers, poses that do not pass
 * wh_pose_validate, bad tolerances, and poses so far apart that the square of their distance is not finite
 * (WH_STATUS_NOT_FINITE: about 1e154 mm, 1e19 in float); `result` is then unchanged. Cost: about 100
 * products and a square root. */
wh_status_t wh_proximity_measure(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                                 const wh_tolerance_t *tolerance, wh_proximity_t *result)
    WH_SYMBOL(wh_proximity_measure);

/* The verdict alone, for the inner loop: it equals wh_proximity_measure's, bit for bit. No argument is
 * checked: poses and tolerance must be valid, except that a NaN anywhere gives false. Cost: 3 products if
 * the wafer is too high or too low, 15 within the limit (6), and a square root near the limit (7). It is in
 * the header so that compilers put it into the caller's loop; for hundreds of wafers and more at once see
 * batch/batch.h. */
static inline bool wh_proximity_ready(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                                      const wh_tolerance_t *tolerance) {
    const wh_mat3_t *w = &base_from_wafer->R;
    const wh_mat3_t *g = &base_from_gripper->R;
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_wafer->r, &base_from_gripper->r);
    const wh_vec3_t n1 = wh_mat3_column(w, 2);
    if (!(wh_real_abs(wh_vec3_dot(&dr, &n1)) < tolerance->projz)) {
        return false;
    }
    const wh_real_t x = w->m[0][0] * dr.x + w->m[1][0] * dr.y + w->m[2][0] * dr.z;
    const wh_real_t y = w->m[0][1] * dr.x + w->m[1][1] * dr.y + w->m[2][1] * dr.z;
    const wh_vec3_t n2 = wh_mat3_column(g, 2);
    if (!wh_real_root_below(x * x + y * y, tolerance->projxy) ||
        !(wh_vec3_dot(&n1, &n2) > tolerance->planar)) {
        return false;
    }
    /* (1)-(8) never use the gripper's first two axes; a NaN there shows in their product. */
    const wh_real_t across = g->m[0][0] * g->m[0][1] + g->m[1][0] * g->m[1][1] + g->m[2][0] * g->m[2][1];
    return across - across == 0;
}

/* Computes margins, failed conditions and verdict again from the values (1)-(5) in `measured`, for example
 * after a transfer in a message. Arguments are not checked; a NaN fails its condition. */
void wh_proximity_judge(const wh_tolerance_t *tolerance, wh_proximity_t *measured)
    WH_SYMBOL(wh_proximity_judge);

/* The distance of the farthest point of a wafer's rim (radius in mm) from the gripper's contact plane. The
 * centre's distance (3) hides this number when the wafer is tilted. Arguments are not checked. Cost: one
 * square root. */
wh_real_t wh_proximity_rim_gap(const wh_pose_t *base_from_wafer, const wh_pose_t *base_from_gripper,
                               wh_real_t radius) WH_SYMBOL(wh_proximity_rim_gap);

WH_HEADER_END

#endif
