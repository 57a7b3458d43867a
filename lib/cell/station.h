/* Stations: stacks of slots, and the place of a wafer in them.
 *
 * A station's frame has its origin at slot 1, where the centre of a wafer's back face lies. Its x is the
 * direction in which the end-effector enters; its z points up through the slots. Slot k (from 1) is at (k -
 * 1) pitch along z. A prealigner is a station with one slot, the plane of its chuck. A wafer that lies face
 * down lies there with its front face. In a cell with a `thickness` the face towards the slot is measured
 * (grasp/face.h). Lengths are in mm, angles in rad. It uses no heap; the functions change nothing but their
 * results.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_cell_validate                 72    200      24    112
 *     stack of wh_station_slot                  56     56       8     20
 *     stack of wh_station_measure              336    336     168    200
 *     stack of wh_cell_locate                  536    544     296    336
 *     stack of wh_cell_judge                   800    792     472    504
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
    wh_real_t pitch; /* mm, above 0, up to 1e6; a single slot has one, too: half of it up and down */
    int32_t chuck;   /* the gripper that holds the wafer here; WH_NONE: plain slots */
} wh_station_t;

/* The caller's stations. If two slots are equally near, the earlier station's counts. */
typedef struct {
    const wh_station_t *stations;
    size_t count;
    wh_tolerance_t tolerance; /* a wafer within projxy and planar lies in a slot */
    wh_real_t off_centre;     /* a wafer set down farther from a slot's centre is reported, mm, up to 1e6 */
    wh_real_t askew;          /* a wafer set down with more tilt is reported, rad, up to 10; 0: never */
    bool settle;              /* a released wafer comes to lie on its support: see wh_cell_settle */
    /* of a wafer, mm, up to WH_FACE_THICKEST; 0: only back faces are used, and a wafer that lies face down
     * lies in no slot */
    wh_real_t thickness;
    wh_real_t drop; /* a wafer released higher above its slot is reported, mm, up to 1e6; 0: never */
} wh_cell_t;

/* The place of a wafer: slot `slot` (from 1) of station `station` (from 0), measured in that slot's
 * frame. */
typedef struct {
    int32_t station, slot;
    wh_real_t dx, dy, dz; /* mm */
    wh_real_t tilt;       /* rad, between the slot's z and the normal of the face's frame */
    wh_face_t face;       /* the face towards the slot, which is measured; the front of a wafer face down */
} wh_place_t;

/* A wafer that a gripper pushes through a slot or another wafer, or an empty blade that goes through one. */
typedef struct {
    int32_t wafer; /* that is pushed; WH_NONE: none */
    int32_t station, slot;
    bool goes_up;
    int32_t other; /* the wafer that something goes through; WH_NONE: none, or a slot */
} wh_passing_t;

/* Returns WH_OK, or the reason why the functions below cannot use this cell with a table of `gripper_count`
 * grippers. WH_STATUS_NULL_ARGUMENT: a null cell, or null stations with a count that is not 0.
 * WH_STATUS_BAD_CAPACITY: more than INT32_MAX stations. WH_STATUS_BAD_TOLERANCE: a tolerance that
 * wh_tolerance_validate refuses, unless there is no station. WH_STATUS_OUT_OF_RANGE: another number outside
 * the ranges above, also NaN. A station's pose that wh_pose_validate refuses gives its status. Stations may
 * overlap: each wafer then lies in the nearest of all slots, and WH_EVENT_SLOT_OCCUPIED comes only for two
 * wafers in one slot. wh_simulator_init calls this. Cost: wh_pose_validate for each station. */
wh_status_t wh_cell_validate(const wh_cell_t *cell, size_t gripper_count) WH_SYMBOL(wh_cell_validate);

/* base_from_slot. `slot` is not checked; the rotation is the station's. Cost: 3 products. */
wh_pose_t wh_station_slot(const wh_station_t *station, int32_t slot) WH_SYMBOL(wh_station_slot);

/* Measures a wafer's back face in a slot's frame, at any distance. It sets `station` to WH_NONE. Arguments
 * are not checked. Cost: 39 products, a square root and wh_atan2. */
wh_place_t wh_station_measure(const wh_station_t *station, int32_t slot, const wh_pose_t *base_from_wafer)
    WH_SYMBOL(wh_station_measure);

/* wh_station_measure of the face towards the slot. Cost: 3 products more with a thickness. */
wh_place_t wh_cell_measure(const wh_cell_t *cell, const wh_station_t *station, int32_t slot,
                           const wh_pose_t *base_from_wafer) WH_SYMBOL(wh_cell_measure);

/* The nearest slot with |dz| < pitch/2, |(dx, dy)| < tolerance.projxy and cos(tilt) > tolerance.planar; of
 * equally near ones the first. Returns false if the wafer lies in none; `place` is then unchanged.
 * Arguments are not checked: wh_cell_validate must accept the cell, also for the two functions below. Cost:
 * wh_station_measure and about 15 products for each station. */
bool wh_cell_locate(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, wh_place_t *place)
    WH_SYMBOL(wh_cell_locate);

/* Judges the releases among a step's events, and appends the cell's events for them while the list has
 * room:
 *   - WH_EVENT_RELEASED_UNSUPPORTED: the wafer lies in no slot, or tolerance.projz or more below the plane of
 *     its slot, where no ledge is. `height` is its height above the nearest slot below it within
 *     tolerance.projxy, or else above base's z = 0 (negative below it). Less than tolerance.projz below a
 *     slot it is on that slot, and its height negative. If it would lie there but for its tilt, `value` is
 *     that, rad; else 0. Or it is over its slot, but let go higher than the cell's `drop`: then `limit` is
 *     that, else 0;
 *   - WH_EVENT_SLOT_OCCUPIED: another wafer, free or held by the station's chuck, lies in the same slot.
 *     `other` is its index, the lowest;
 *   - WH_EVENT_PLACED_OFF_CENTRE, WH_EVENT_PLACED_ASKEW: the wafer lies in a slot beyond the cell's limits,
 *     or in the hand-over of a step a station's chuck has taken it beyond them, as the chuck then stands.
 * The other fields are the release's, or the hand-over's. Each adds at most three. Returns the number of
 * appended events. Arguments are not checked. Cost: linear in the list without a release; each release adds
 * wafers times stations, or all slots; each hand-over the stations.
 */
size_t wh_cell_judge(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list)
    WH_SYMBOL(wh_cell_judge);

/* True if a support stops a wafer that moves from the first pose to the next. The wafer reaches the plane
 * of its slot, or passes down through it, or is already less than tolerance.projz below it. Within 1e-3 mm
 * counts as at the plane. Arguments are not checked; numbers that are not finite give false. Cost:
 * wh_cell_locate and wh_station_measure. */
bool wh_cell_stops(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, const wh_pose_t *next)
    WH_SYMBOL(wh_cell_stops);

/* Call it after wh_cell_judge. A released wafer less than tolerance.projz below the plane of its slot was
 * stopped by the support: its face's centre moves up along the slot's z to the plane. With cell->settle a
 * released wafer above the plane sinks onto it: that centre moves down. In both cases, and in the plane,
 * with cell->settle the wafer turns about that centre by the smallest rotation that takes the face's normal
 * to z. A wafer in no slot, or farther below the plane, stays at its place. Appends WH_EVENT_SETTLED for a
 * wafer that moved down, with the release's values and `value` the distance, while the list has room. Cost:
 * linear in the list; each released wafer adds the stations, and wh_grasp_place if it moves. */
void wh_cell_settle(const wh_cell_t *cell, wh_grasp_t *table, wh_event_list_t *list)
    WH_SYMBOL(wh_cell_settle);

/* True if a wafer that `gripper` holds goes through a slot between the two poses, however far they are
 * apart: down, for a support would have taken it at the plane, or up, for the ledges are in its way. The
 * centre of the face that looks at the slot then passes the height tolerance.projz below its plane, or on
 * the way up twice that. At that instant of a straight way it is over the slot as wh_cell_locate has it:
 * by projxy, and by planar with the tilt of `next`. A wafer that goes up and stops with its other face
 * within the ledges is not told. The first slot on the way counts. The chuck that holds the wafer is no
 * support. `passing`, but for `wafer`, then says where; else it is unchanged. Arguments are not checked;
 * numbers that are not finite give false. Cost: 6 products for each station, with a thickness 9 more;
 * wh_station_measure for each plane that is passed, up to the first. */
bool wh_cell_passes(const wh_cell_t *cell, int32_t gripper, const wh_pose_t *base_from_wafer,
                    const wh_pose_t *next, wh_passing_t *passing) WH_SYMBOL(wh_cell_passes);

/* True if a wafer goes through another one in a slice; each has its pose as the slice begins and as it ends,
 * and goes straight between. The middle of the first passes the other one's middle on the way up, or on the
 * way down the height tolerance.projz below that, both along the other one's normal. There it is nearer to
 * the other one's centre than 25 mm, or than tolerance.projxy if that is more: wafers whose rims alone meet
 * do not count. Without a thickness the back faces stand for the middles. Arguments are not checked; numbers
 * that are not finite give false. Cost: 30 products. */
bool wh_cell_wafer_crosses(const wh_cell_t *cell, const wh_pose_t wafer[2], const wh_pose_t other[2],
                           bool *goes_up) WH_SYMBOL(wh_cell_wafer_crosses);

/* Likewise, if a gripper goes through a wafer: along its own normal its contact plane passes the height
 * tolerance.projz above the face that looks at it, up or down. */
bool wh_cell_blade_crosses(const wh_cell_t *cell, const wh_pose_t blade[2], const wh_pose_t other[2],
                           bool *goes_up) WH_SYMBOL(wh_cell_blade_crosses);

/* Before a step of the table: true if the gripper, with these inputs, would go through a wafer: with the
 * wafer that it holds, else with its empty blade. `passing` then says which one, and which way; else it is
 * unchanged. The first wafer counts. Not looked at: the first slice, a slice without a motion along the
 * gripper's normal, an empty blade that goes down, and one that goes together with a gripper that is not in
 * `shut` (bit g): two blades of a wrist may be described in one place though they point away from each other.
 * Cost: 9 products; with such a motion a comparison for each wafer. */
bool wh_cell_meets(const wh_cell_t *cell, const wh_grasp_t *table, const wh_gripper_input_t inputs[],
                   uint32_t shut, size_t gripper, wh_passing_t *passing) WH_SYMBOL(wh_cell_meets);

/* Before a step of the table: which wafers these inputs, checked or not, would push through a slot or another
 * wafer, and which of the grippers in `shut` (bit g) would go through one with an empty blade; one entry of
 * `passing` for each gripper. False: none. Cost: wh_cell_passes for each wafer that is held, wh_cell_meets
 * for each gripper. */
bool wh_cell_begin_passing(const wh_cell_t *cell, const wh_grasp_t *table, const wh_gripper_input_t inputs[],
                           uint32_t shut, wh_passing_t passing[]) WH_SYMBOL(wh_cell_begin_passing);

/* After that step: appends WH_EVENT_PUSHED_THROUGH for each of them that is beyond its slot or wafer indeed,
 * while the list has room. The gripper is the one that held the wafer as the step began. Cost:
 * wh_station_measure for each of them. */
void wh_cell_end_passing(const wh_cell_t *cell, const wh_grasp_t *table, const wh_passing_t passing[],
                         wh_event_list_t *list) WH_SYMBOL(wh_cell_end_passing);

WH_HEADER_END

#endif
