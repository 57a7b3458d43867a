/* Stations: stacks of slots, and where in them a wafer lies.
 *
 * A station's frame has its origin at slot 1, where the centre of a wafer's back face lies. Its x is the way
 * in of the end-effector; its z points up through the slots. Slot k (from 1) is at (k - 1) pitch along z. A
 * prealigner is a station with one slot, the plane of its chuck. A wafer that lies face down lies there with
 * its front face: in a cell with a `thickness` all is asked of the face that looks at the slot
 * (grasp/face.h).
 * Lengths in mm, angles in rad. No heap; the functions change nothing but their results.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_cell_validate                 72    200      24    112
 *     stack of wh_station_slot                  56     56       8     20
 *     stack of wh_station_measure              336    336     168    200
 *     stack of wh_cell_locate                  536    544     296    336
 *     stack of wh_cell_judge                   728    728     432    472
 *     stack of wh_cell_settle                  864    872     480    520
 *     size of wh_station_t                     120             60
 *     size of wh_cell_t                         72             40
 *     size of wh_place_t                        48             28
 */
#ifndef WH_CELL_STATION_H
#define WH_CELL_STATION_H

#include "../grasp/face.h"
#include "../grasp/grasp.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(station);

typedef struct {
    wh_pose_t base_from_station;
    int32_t slots;   /* 1 to 1000 */
    wh_real_t pitch; /* mm, above 0, up to 1e6; a single slot too has one: half of it up and down */
    int32_t chuck;   /* the gripper that holds what lies here; WH_NONE: plain slots */
} wh_station_t;

/* The caller's stations. Of equally near slots the one of the earlier station counts. */
typedef struct {
    const wh_station_t *stations;
    size_t count;
    wh_tolerance_t tolerance; /* a wafer within projxy and planar lies in a slot */
    wh_real_t off_centre;     /* a wafer set down farther from a slot's centre is reported, mm, up to 1e6 */
    wh_real_t askew;          /* a wafer set down with more tilt is reported, rad, up to 10; 0: none is */
    bool settle;              /* a released wafer comes to lie on its support: see wh_cell_settle */
    /* of a wafer, mm, up to WH_FACE_THICKEST; 0: back faces alone are looked at, and a wafer that lies face
       down lies in no slot */
    wh_real_t thickness;
    wh_real_t drop; /* a wafer let go higher above its slot is reported, mm, up to 1e6; 0: none is */
} wh_cell_t;

/* Where a wafer lies: in slot `slot` (from 1) of station `station` (from 0), measured in that slot's
 * frame. */
typedef struct {
    int32_t station, slot;
    wh_real_t dx, dy, dz; /* mm */
    wh_real_t tilt;       /* rad, between the slot's z and the normal of the face's frame */
    wh_face_t face;       /* that looks at the slot: what is measured; the front of a wafer face down */
} wh_place_t;

/* WH_OK, or why the functions below cannot use this cell beside a table of so many grippers: a null cell, or
 * null stations where count is not 0 (WH_STATUS_NULL_ARGUMENT); more than INT32_MAX stations
 * (WH_STATUS_BAD_CAPACITY); a tolerance that wh_tolerance_validate refuses, unless there is no station
 * (WH_STATUS_BAD_TOLERANCE); another number outside the ranges above, NaN too (WH_STATUS_OUT_OF_RANGE); a
 * station's pose that wh_pose_validate refuses, with its status. Stations may overlap: each wafer then lies
 * in the nearest slot of all, and WH_EVENT_SLOT_OCCUPIED comes only for two wafers in one and the same slot.
 * wh_simulator_init asks this. Cost: wh_pose_validate for each station. */
wh_status_t wh_cell_validate(const wh_cell_t *cell, size_t gripper_count) WH_SYMBOL(wh_cell_validate);

/* base_from_slot. `slot` is not checked; the rotation is the station's. Cost: 3 products. */
wh_pose_t wh_station_slot(const wh_station_t *station, int32_t slot) WH_SYMBOL(wh_station_slot);

/* Measures a wafer's back face in a slot's frame, near or far. Sets `station` to WH_NONE. Arguments are not
 * checked. Cost: 39 products, a square root and wh_atan2. */
wh_place_t wh_station_measure(const wh_station_t *station, int32_t slot, const wh_pose_t *base_from_wafer)
    WH_SYMBOL(wh_station_measure);

/* wh_station_measure of the face that looks at the slot. Cost: with a thickness 3 products more. */
wh_place_t wh_cell_measure(const wh_cell_t *cell, const wh_station_t *station, int32_t slot,
                           const wh_pose_t *base_from_wafer) WH_SYMBOL(wh_cell_measure);

/* The nearest slot with |dz| < pitch/2, |(dx, dy)| < tolerance.projxy and cos(tilt) > tolerance.planar; of
 * equally near ones the first. False if the wafer lies in none; `place` is then unchanged. Arguments are not
 * checked: the cell is one that wh_cell_validate accepts, as for the two functions below. Cost:
 * wh_station_measure and about 15 products for each station. */
bool wh_cell_locate(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, wh_place_t *place)
    WH_SYMBOL(wh_cell_locate);

/* Looks at the releases among a step's events, and appends what the cell says of them while the list has
 * room:
 *   - WH_EVENT_RELEASED_UNSUPPORTED: the wafer lies in no slot. `height` is its height above the nearest slot
 *     below it within tolerance.projxy, or else above base's z = 0 (negative below it). Less than
 *     tolerance.projz below a slot it is on that slot, and its height negative. If it would lie there but
 *     for its tilt, `value` is that, rad; else 0. Or it is over its slot, but let go higher than the cell's
 *     `drop`: then `limit` is that, else 0;
 *   - WH_EVENT_SLOT_OCCUPIED: another wafer, free or held by the station's chuck, lies in the same slot.
 *     `other` is its index, the lowest;
 *   - WH_EVENT_PLACED_OFF_CENTRE, WH_EVENT_PLACED_ASKEW: the wafer lies in a slot beyond the cell's limits.
 * The other fields are the release's. Each release adds at most three. Returns how many were appended.
 * Arguments are not checked. Cost: linear in the list without a release; each release adds wafers times
 * stations, or all slots.
 */
size_t wh_cell_judge(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list)
    WH_SYMBOL(wh_cell_judge);

/* True if a wafer that moves from the first pose to the next comes to the plane of the slot in which it lies,
 * or goes down through it, or is less than tolerance.projz below it already (at the plane is what is within
 * 1e-3 mm): a support stops it. Arguments are not checked; numbers that are not finite give false. Cost:
 * wh_cell_locate and wh_station_measure. */
bool wh_cell_stops(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, const wh_pose_t *next)
    WH_SYMBOL(wh_cell_stops);

/* Call it after wh_cell_judge. A released wafer less than tolerance.projz below the plane of its slot was
 * stopped by the support: its face's centre comes up along the slot's z to the plane. With cell->settle a
 * released wafer above the plane comes to lie on it: that centre moves down. In both cases, with
 * cell->settle, the wafer turns about that centre by the smallest rotation that takes the face's normal to
 * z. A wafer in no slot, or farther below the plane, stays. Appends WH_EVENT_SETTLED for a wafer that went
 * down, with the release's values and `value` the way down, while the list has room. Cost: linear in the
 * list; each released wafer adds the stations, and wh_grasp_place if it moves. */
void wh_cell_settle(const wh_cell_t *cell, wh_grasp_t *table, wh_event_list_t *list)
    WH_SYMBOL(wh_cell_settle);

WH_HEADER_END

#endif
