/* Beams at the stations' doors, faces that a probe touches, and the latches that they give while a robot
 * moves there.
 *
 * A command arms some of the beams. From the end of that slice on each beam that is broken or gets free gives
 * a latch, once its delay has passed: the slice and the part of the slice in which it came. A controller that
 * knows where its axes were then has the crossing (wh_beam_crossing), and from crossings the wafer's centre
 * (align/centring.h). Crossings lie within slices and are found there, so slices of any length give the same
 * latches, as far as the motion is the same.
 *
 * What breaks beams: wafers that grippers hold, by their true rims, and blades, by their outlines; both move
 * as their gripper does. A wafer that is taken within a slice counts as held from its begin on. Wafers that
 * nobody holds lie in slots, not in doors: they break no beam.
 *
 * A face to be touched gives latches as a beam does: one as the probe's switch closes, one as it opens, both
 * without delay. Where the switch closes is off by an error that is drawn for each arming.
 *
 * A simulator has beams after wh_simulator_set_latching (simulator.h). A firmware that does not call it does
 * not link this file, nor lib/align.
 */
#ifndef WH_SIM_LATCHING_H
#define WH_SIM_LATCHING_H

#include "../align/beam.h"
#include "../align/touch.h"
#include "../grasp/grasp.h"
#include "../math/deviate.h"
#include "../motion/machine.h"
#include "faults.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(latching);

/* The most latches that wait or come in one slice. */
#define WH_LATCHES 16

/* What a beam says that is broken down: always the same, so it gives no latch. */
typedef enum WH_FOUR_BYTES { WH_BEAM_WORKS, WH_BEAM_DARK, WH_BEAM_LIT } wh_beam_stuck_t;

/* What an entry among the beams is. */
typedef enum WH_FOUR_BYTES { WH_DOOR_LIGHT, WH_DOOR_TOUCH } wh_door_kind_t;

/* A beam with its electronics; or a face that the probe of a gripper touches: then stuck dark is closed,
 * stuck lit is open, and `beam`, delays and jitter do not count. */
typedef struct {
    wh_beam_t beam;
    double delay_on, delay_off; /* from being broken, or free, to the latch, s, 0 to 0.01 */
    double jitter;              /* standard deviation of both, s, 0 to 0.001; no delay is below 0 */
    uint64_t seed;              /* names the jitter, with the number of the arming and of the crossing */
    wh_beam_stuck_t stuck;
    wh_door_kind_t kind;
    wh_touch_face_t touch; /* this and the following only of WH_DOOR_TOUCH */
    int32_t gripper;       /* that carries the probe */
    double noise; /* of a touch, standard deviation, mm, 0 to 0.1; named by the seed and the arming */
} wh_door_beam_t;

/* What does not change during a run: the caller's arrays. */
typedef struct {
    const wh_door_beam_t *beams;
    size_t beam_count;                /* up to WH_BEAMS; none: no order is taken */
    const wh_rim_t *const *rims;      /* by wafer; many may have the same */
    const wh_blade_outline_t *blades; /* by gripper; null: none has an outline */
} wh_latching_t;

typedef enum WH_FOUR_BYTES {
    WH_LATCH_KEEP, /* as it is: an order of all zero */
    WH_LATCH_ARM,
    WH_LATCH_DISARM /* latches that wait are dropped */
} wh_latch_order_kind_t;

/* What a command says of the beams. */
typedef struct {
    wh_latch_order_kind_t kind;
    int32_t first, count; /* ARM: which beams, at least 1; latches that wait are dropped */
} wh_latch_order_t;

typedef struct {
    int32_t beam;
    wh_crossing_edge_t edge;
    int64_t slice; /* when it comes: the first after arming is 1 */
    double part;   /* of that slice, 0 to 1 */
} wh_latch_t;

/* The beams after the last slice. All zero before the first. */
typedef struct {
    uint32_t number; /* how many times beams have been armed */
    bool armed;
    int32_t first, count;
    int64_t slice;         /* since arming */
    uint32_t crossings;    /* since arming, of all beams: they name the jitter */
    uint32_t lost;         /* since arming: no place was left for a latch */
    uint32_t broken;       /* bit b: beam b */
    int32_t waiting_count; /* crossed, but not due */
    int32_t latch_count;
    wh_latch_t waiting[WH_LATCHES]; /* by time, then in the order of beams */
    wh_latch_t latches[WH_LATCHES]; /* of this slice, likewise */
} wh_latches_t;

/* WH_OK, or what is wrong for a cell with these counts: WH_STATUS_NULL_ARGUMENT; WH_STATUS_BAD_CAPACITY for
 * more than WH_BEAMS beams or WH_GRIPPERS grippers; what wh_beam_validate, wh_touch_validate,
 * wh_blade_outline_validate and wh_rim_validate say; WH_STATUS_NOT_FINITE and WH_STATUS_OUT_OF_RANGE for a
 * delay, a noise, a kind, or the gripper of a probe. Without beams rims and
 * blades do not count. Cost: wh_rim_validate for each wafer. */
wh_status_t wh_latching_validate(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count)
    WH_SYMBOL(wh_latching_validate);

/* WH_OK for an order that can be taken, else WH_STATUS_OUT_OF_RANGE. No argument may be null. */
wh_status_t wh_latching_check(const wh_latching_t *latching, const wh_latch_order_t *order)
    WH_SYMBOL(wh_latching_check);

/* After a slice of `slice_s` seconds, above 0: looks for crossings in it and gives the latches that are due,
 * then takes the order, which wh_latching_check has accepted. `before` has the grippers' poses at the slice's
 * begin, `table` the rest, at its end. A beam that is broken while it is armed gives no latch for that. The
 * faults of beams and probes count that act in this slice. No argument may be null. Cost: with nothing armed
 * that of two assignments; else for each beam wh_beam_next over the blades and the wafers that are held, and
 * 100 ns a latch for jitter. */
void wh_latching_step(const wh_latching_t *latching, const wh_pose_t before[], const wh_grasp_t *table,
                      const wh_faults_t *faults, wh_real_t slice_s, const wh_latch_order_t *order,
                      wh_latches_t *latches) WH_SYMBOL(wh_latching_step);

/* Continues a hash (math/hash.h) with all that the latches of a run depend on. Nothing is checked. Cost: 13
 * words for each beam, 50 for each wafer, and two for each point of an outline. */
uint64_t wh_latching_hash(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count,
                          uint64_t hash) WH_SYMBOL(wh_latching_hash);

/* How a simulator reaches the functions above, so that one without beams does not link them. */
typedef struct {
    wh_status_t (*check)(const wh_latching_t *latching, const wh_latch_order_t *order);
    /* Steps the rest of a wh_simulator_t by a wh_command_t, then its beams. */
    wh_status_t (*around)(void *simulator, const void *command,
                          wh_status_t (*rest)(void *simulator, const void *command));
    uint64_t (*hash)(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count, uint64_t hash);
} wh_latching_calls_t;

WH_HEADER_END

#endif
