/* Holding: the acceleration that a gripper's pads can hold, against the one that the motion requires.
 *
 * Coulomb's law. In a gripper that moves with acceleration a under gravity g, with its normal n (e3,
 * towards the wafer), a wafer of mass m needs the force m (a - g) from its gripper. Along the pads this is
 * friction:
 *
 *     |(a - g) - ((a - g).n) n|  <=  friction * (force * level / m + (a - g).n)
 *
 * where the bracket, times m, is the force between wafer and pads. If that would be negative, the wafer
 * lifts off: -(a - g).n > force * level / m. Both are given as a required acceleration and one that can be
 * held, in mm/s^2; the wafer slips if and only if the first is above the second. An infinite acceleration
 * slips, too: it gives the largest number against 0. A slip is only reported: the wafer stays with its
 * gripper.
 */
#ifndef WH_GRASP_HOLD_H
#define WH_GRASP_HOLD_H

#include "vacuum.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(hold);

/* The properties of the pads and the wafer. They must not change during a run; with a mass of 0 holding is
 * not checked. */
typedef struct {
    wh_real_t friction; /* coefficient of friction, 0 to 100 */
    wh_real_t force;    /* of the full vacuum, N, 0 to 1e6 */
    wh_real_t mass;     /* of a wafer, kg, 1e-6 to 1e3 */
    wh_real_t gravity;  /* along -z of base, m/s^2, 0 to 1e3 */
} wh_pads_t;

/* The verdict. */
typedef struct {
    wh_real_t asked, carried; /* mm/s^2 */
    bool slips;               /* asked > carried */
} wh_hold_t;

/* A held wafer's motion: the centre of its back face in the last two slices. */
typedef struct {
    wh_vec3_t before[2]; /* base, mm; the last slice's, then the one before; 0 if not known */
    int32_t known;       /* the number of known entries, 0 to 2 */
    bool slips;          /* the last verdict */
} wh_carry_t;

/* Pads without any wafer to watch. */
wh_pads_t wh_pads_none(void) WH_SYMBOL(wh_pads_none);

/* Returns WH_OK, WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_FINITE or WH_STATUS_OUT_OF_RANGE. A mass of 0
 * passes if everything else is 0. */
wh_status_t wh_pads_validate(const wh_pads_t *pads) WH_SYMBOL(wh_pads_validate);

/* The mass in kg of a disc of silicon (2.329 g/cm3) of this size in mm: 0.1276 for 300 mm and 0.775 mm. */
wh_real_t wh_wafer_mass(wh_real_t diameter, wh_real_t thickness) WH_SYMBOL(wh_wafer_mass);

/* The verdict on one instant: `acceleration` of the wafer in base, mm/s^2. Nothing is checked; the mass
 * must be above 0. Cost: a square root and three divisions. */
wh_hold_t wh_hold_judge(const wh_pads_t *pads, wh_real_t level, const wh_mat3_t *base_from_gripper,
                        const wh_vec3_t *acceleration) WH_SYMBOL(wh_hold_judge);

/* Judges one slice of a gripper whose wafer's centre is now at `centre` (null: it holds none). The
 * acceleration is the second difference of three positions over slices of `dt` s, so the first two slices
 * after a pick are not judged. `hold` gets the verdict, all zero if there is none. Returns true when a slip
 * begins. Nothing is checked. */
bool wh_carry_update(wh_carry_t *carry, const wh_pads_t *pads, wh_real_t level,
                     const wh_mat3_t *base_from_gripper, const wh_vec3_t *centre, wh_real_t dt,
                     wh_hold_t *hold) WH_SYMBOL(wh_carry_update);

WH_HEADER_END

#endif
