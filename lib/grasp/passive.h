/* Passive supports: pads without a valve, on which a wafer lies by its weight, such as pins, ledges, blades
 * in vacuum.
 *
 * A wafer touches pads, or a support such as a slot, with its contact plane: the face towards them
 * (face.h), measured at its centre. For pads at a pose with e3 = n2 and a support with its z:
 *
 *     lift   = (r_pads - r_face) . n2          how far the pads' plane is above the contact plane, mm
 *     height = (r_face - r_support) . z        how far the contact plane is above the support's plane, mm
 *
 * One slice moves the pads from `begin` to `end`.
 *   taken  A wafer that is not carried is taken if lift <= flat at the begin and lift >= 0 at the end,
 *          and (7) and (8) of proximity.h hold between that face and the pads; (6) does not count. It comes
 *          up along n2 by lift, to the pads' plane, and is carried. If a support is there and height <= 0 at
 *          the end after that, both would carry it: it is supported, stays where it was, and is not taken.
 *   left   A carried wafer moves with the pads, as gripper_from_wafer says. If a support is there, height
 *          >= -flat at the begin and height <= 0 at the end, and (7) and (8) hold between that face and the
 *          support, it is left there: it comes up along z to height 0.
 * `flat` is WH_PASSIVE_FLAT: pads that stop within rounding of a support's plane neither miss the wafer nor
 * pass the support when they move on. With sampled checking all of it is tested at the slice's end. With
 * swept checking the instant counts: the pads' position is linear between begin and end, and their rotation
 * follows grasp.h. At the instant at which lift, or height, reaches 0 (to 2^-50 of the slice), (7) and (8)
 * are tested. A wafer that is taken is carried from there to the slice's end, and one that is left stays at
 * its place then. At most one of the two happens to a wafer in a slice. All these comparisons include
 * equality, except (7) and (8), which are strict.
 *
 * The face is the one that looks at the plane at the instant that is asked, so pads that turn over within a
 * slice are asked with one face at the begin and perhaps with the other one at the end. Planes that pass each
 * other several times in a slice are looked at where they stand at its begin and at its end: an even number
 * of times is none, and of an odd number halving finds one way down through the plane, not always the first.
 * With slices in which a blade goes up and down again nothing is said of what lies between.
 *
 * Friction alone holds a wafer on the way: wh_passive_limit has the acceleration.
 *
 * It uses no heap, and no state except the caller's. A firmware that calls none of these functions does not
 * link them. Stack on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_passive_step                 984   1080     536    616
 *     size of wh_passive_t                      40             20
 *     size of wh_passive_wafer_t               200            100
 */
#ifndef WH_GRASP_PASSIVE_H
#define WH_GRASP_PASSIVE_H

#include "grasp.h"
#include "hold.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(passive);

/* Things apart by less than this, mm, touch: it covers rounding. */
#if defined(WH_FLOAT)
#define WH_PASSIVE_FLAT WH_REAL(1e-3)
#else
#define WH_PASSIVE_FLAT WH_REAL(1e-6)
#endif

/* The friction of ceramic pads on silicon, for use without other data. */
#define WH_PASSIVE_FRICTION WH_REAL(0.2)

/* The fixed values. */
typedef struct {
    wh_tolerance_t tolerance; /* only projxy and planar count */
    wh_check_t check;
    wh_real_t thickness; /* of the wafer, mm, 0 to WH_FACE_THICKEST; 0: only its back is seen */
} wh_passive_t;

/* One wafer. */
typedef struct {
    wh_pose_t base_from_wafer;
    wh_pose_t gripper_from_wafer; /* valid while it is carried */
    bool carried;
} wh_passive_wafer_t;

typedef enum WH_FOUR_BYTES { WH_PASSIVE_STAYS, WH_PASSIVE_TAKEN, WH_PASSIVE_LEFT } wh_passive_change_t;

/* Steps one slice of one wafer between these pads and this support (null: there is none), by the rules
 * above. `change` receives the result. It refuses, and changes nothing: null pointers
 * (WH_STATUS_NULL_ARGUMENT), poses that do not pass wh_pose_validate, gripper_from_wafer only while it
 * counts, a tolerance that wh_tolerance_validate refuses, a thickness that is not finite
 * (WH_STATUS_NOT_FINITE) or out of its range, an unknown `check` (WH_STATUS_OUT_OF_RANGE), or swept
 * checking if it is not built (WH_STATUS_NOT_BUILT). Cost: about 300 products; with swept checking 50 times
 * 100 more if a plane is passed. */
wh_status_t wh_passive_step(const wh_passive_t *passive, const wh_pose_t *begin, const wh_pose_t *end,
                            const wh_pose_t *base_from_support, wh_passive_wafer_t *wafer,
                            wh_passive_change_t *change) WH_SYMBOL(wh_passive_step);

/* The values by which passive pads hold: these pads, or for no pads (mass 0) pads of WH_PASSIVE_FRICTION
 * under 9.81 m/s^2. The weight is that of a wafer of 1 kg; its mass does not count. They have no force.
 * Nothing is checked. */
wh_pads_t wh_passive_pads(const wh_pads_t *pads) WH_SYMBOL(wh_passive_pads);

/* The largest acceleration along the pads, mm/s^2, that friction alone can hold in every direction of their
 * plane: 1000 (friction * g . n2 - |g across|), with g upwards. At or below 0 it can hold none, on pads
 * that are steep or look down. Above it a wafer slips (hold.h, at a level of 0). Only the pads' friction
 * and gravity count. Nothing is checked. Cost: a square root. */
wh_real_t wh_passive_limit(const wh_pads_t *pads, const wh_mat3_t *base_from_gripper)
    WH_SYMBOL(wh_passive_limit);

WH_HEADER_END

#endif
