/* Stations: stacks of slots, and where in them a wafer lies.
 *
 * A station's frame has its origin where slot 1 holds the centre of a wafer's back face, x the way the
 * end-effector enters, z up through the slots. Slot k (from 1) is at (k - 1) pitch along z. A prealigner is a
 * station with one slot, the plane of its chuck. Lengths in mm, angles in rad. No heap; nothing here changes
 * its arguments but the results.
 */
#ifndef WH_CELL_STATION_H
#define WH_CELL_STATION_H

#include "../grasp/grasp.h"

typedef struct {
    wh_pose_t base_from_station;
    int32_t slots;   /* 1 to 1000 */
    wh_real_t pitch; /* mm, > 0; also of a single slot, whose reach is half of it up and down */
    int32_t chuck;   /* the gripper that holds what lies here, or WH_NONE: plain slots */
} wh_station_t;

/* The caller's stations, in an order that decides between equally near slots. */
typedef struct {
    const wh_station_t *stations;
    size_t count;
    wh_tolerance_t tolerance; /* projxy and planar bound what still lies in a slot */
    wh_real_t off_centre; /* a wafer set down farther beside a slot's centre is reported, mm; 0: none is */
    wh_real_t askew;      /* one tilted more against it, rad; 0: none is */
    bool settle;          /* a wafer let go comes to lie on its support: see wh_cell_settle */
} wh_cell_t;

/* Where a wafer lies: in slot `slot` (from 1) of station `station` (from 0), measured in that slot's frame.
 */
typedef struct {
    int32_t station, slot;
    wh_real_t dx, dy, dz; /* mm */
    wh_real_t tilt;       /* rad, between the wafer's normal and the slot's z */
} wh_place_t;

/* base_from_slot. `slot` is not checked; the rotation is the station's. */
wh_pose_t wh_station_slot(const wh_station_t *station, int32_t slot);

/* Measures a wafer in a slot's frame, near or far; `place->station` is set to WH_NONE. Arguments are not
 * checked. */
wh_place_t wh_station_measure(const wh_station_t *station, int32_t slot, const wh_pose_t *base_from_wafer);

/* The nearest slot with |dz| < pitch/2, |(dx, dy)| < tolerance.projxy and cos(tilt) > tolerance.planar; of
 * equally near ones the first. False when the wafer lies in none; `place` is then unchanged. Cost: linear in
 * the stations. */
bool wh_cell_locate(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, wh_place_t *place);

/* Looks at the releases in a step's events and appends what the cell has to say of them:
 * WH_EVENT_RELEASED_UNSUPPORTED when the wafer lies in no slot, `height` being how far it is above the
 * nearest slot below it within tolerance.projxy, or else above base's z = 0 (below it: negative);
 * WH_EVENT_SLOT_OCCUPIED when another wafer, free or held by the station's chuck, lies in the same slot (`other`
 * is its index, the lowest); WH_EVENT_PLACED_OFF_CENTRE and WH_EVENT_PLACED_ASKEW when it lies in one beyond the cell's
 * limits. All else is the release's. Three at most for each release are appended while the list has room. Returns how
 * many were. Arguments are not checked. Cost: linear in the list without a release; each release adds wafers times
 * stations, or all slots. */
size_t wh_cell_judge(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list);

/* With cell->settle, after wh_cell_judge: each wafer that a release in the list left above the plane of the slot that it
 * lies in comes to lie on it: its centre moves down along the slot's z to the plane, and it turns by the smallest
 * rotation that takes its normal to z. WH_EVENT_SETTLED, with the release's values and `value` the way down, is
 * appended while the list has room. One that lies in no slot, or below the plane, stays. Cost: linear in the list;
 * each such wafer adds the stations and wh_grasp_place. */
void wh_cell_settle(const wh_cell_t *cell, wh_grasp_t *table, wh_event_list_t *list);

#endif
