/* Beams at the stations' doors, faces that a probe touches, and the latches that they give while a robot
 * moves there.
 *
 * A command arms some of the beams. From the end of that slice on each beam that breaks or becomes free
 * gives a latch after its delay: the slice and the part of the slice in which it came. A controller that
 * knows the position of its axes at that time computes the crossing (wh_beam_crossing), and from crossings
 * the wafer's centre (align/centring.h). Crossings lie within slices and are found there, so slices of any
 * length give equal latches if the motion is equal.
 *
 * Beams are broken by wafers that grippers hold, with their true rims, and by blades, with their outlines;
 * both move with their gripper. A wafer that is taken within a slice counts as held from the slice's begin
 * on. Wafers that nobody holds lie in slots, not in doors, so they break no beam.
 *
 * A face to be touched gives latches like a beam: one when the probe's switch closes, one when it opens,
 * both without delay. The place where the switch closes has an error that is drawn for each arming.
 *
 * A simulator has beams after wh_simulator_set_latching (simulator.h). A firmware that does not call it
 * does not link this file, nor lib/align.
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

/* The signal of a beam that is broken down: it never changes, so it gives no latch. */
typedef enum WH_FOUR_BYTES { WH_BEAM_WORKS, WH_BEAM_DARK, WH_BEAM_LIT } wh_beam_stuck_t;

/* The kind of an entry among the beams. */
typedef enum WH_FOUR_BYTES { WH_DOOR_LIGHT, WH_DOOR_TOUCH } wh_door_kind_t;

/* A beam with its electronics, or a face that the probe of a gripper touches. For a face stuck dark means
 * closed and stuck lit means open, and `beam`, delays and jitter are ignored. */
typedef struct {
    wh_beam_t beam;
    double delay_on, delay_off; /* from the change to broken, or to free, to the latch, s, 0 to 0.01 */
    double jitter;              /* standard deviation of both, s, 0 to 0.001; no delay is below 0 */
    uint64_t seed;              /* names the jitter, with the number of the arming and of the crossing */
    wh_beam_stuck_t stuck;
    wh_door_kind_t kind;
    wh_touch_face_t touch; /* this and the following members only for WH_DOOR_TOUCH */
    int32_t gripper;       /* the gripper that carries the probe */
    double noise;          /* of a touch, standard deviation, mm, 0 to 0.1; seed and arming name it */
} wh_door_beam_t;

/* The fixed values of a run: the caller's arrays. */
typedef struct {
    const wh_door_beam_t *beams;
    size_t beam_count;                /* up to WH_BEAMS; with none, no order is accepted */
    const wh_rim_t *const *rims;      /* for each wafer; several may share one */
    const wh_blade_outline_t *blades; /* for each gripper; null: none has an outline */
} wh_latching_t;

typedef enum WH_FOUR_BYTES {
    WH_LATCH_KEEP, /* no order; a zeroed order is this */
    WH_LATCH_ARM,
    WH_LATCH_DISARM /* latches that wait are dropped */
} wh_latch_order_kind_t;

/* The order of a command to the beams. */
typedef struct {
    wh_latch_order_kind_t kind;
    int32_t first, count; /* ARM: the beams, at least 1; latches that wait are dropped */
} wh_latch_order_t;

typedef struct {
    int32_t beam;
    wh_crossing_edge_t edge;
    int64_t slice; /* the slice in which it comes: the first after arming is 1 */
    double part;   /* the part of that slice, 0 to 1 */
} wh_latch_t;

/* The beams after the last slice. All zero before the first. */
typedef struct {
    uint32_t number; /* the number of armings */
    bool armed;
    int32_t first, count;
    int64_t slice;         /* since arming */
    uint32_t crossings;    /* since arming, of all beams; they name the jitter */
    uint32_t lost;         /* since arming: latches for which there was no place */
    uint32_t broken;       /* bit b: beam b */
    int32_t waiting_count; /* crossed, but not yet due */
    int32_t latch_count;
    wh_latch_t waiting[WH_LATCHES]; /* by time, then in the order of beams */
    wh_latch_t latches[WH_LATCHES]; /* latches of this slice, in that order */
} wh_latches_t;

/* Returns WH_OK, or the error for a cell with these counts: WH_STATUS_NULL_ARGUMENT; WH_STATUS_BAD_CAPACITY
 * for more than WH_BEAMS beams or WH_GRIPPERS grippers; the status of wh_beam_validate, wh_touch_validate,
 * wh_blade_outline_validate and wh_rim_validate; WH_STATUS_NOT_FINITE and WH_STATUS_OUT_OF_RANGE for a
 * delay, a noise, a kind, or the gripper of a probe. Without beams rims and blades are ignored. Cost:
 * wh_rim_validate for each wafer. */
wh_status_t wh_latching_validate(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count)
    WH_SYMBOL(wh_latching_validate);

/* Returns WH_OK for an order that can be accepted, otherwise WH_STATUS_OUT_OF_RANGE. No argument may be
 * null. */
wh_status_t wh_latching_check(const wh_latching_t *latching, const wh_latch_order_t *order)
    WH_SYMBOL(wh_latching_check);

/* Call it after a slice of `slice_s` seconds, above 0. It finds crossings in the slice and gives the
 * latches that are due. Then it takes the order, which wh_latching_check has accepted. `before` has the
 * grippers' poses at the slice's begin, `table` has everything else, at its end. A beam that is already
 * broken when it is armed gives no latch for that. Those faults of beams and probes count that act in this
 * slice. No argument may be null. Cost: two assignments if nothing is armed; otherwise wh_beam_next for
 * each beam over the blades and the held wafers, and 100 ns for each latch for jitter. */
void wh_latching_step(const wh_latching_t *latching, const wh_pose_t before[], const wh_grasp_t *table,
                      const wh_faults_t *faults, wh_real_t slice_s, const wh_latch_order_t *order,
                      wh_latches_t *latches) WH_SYMBOL(wh_latching_step);

/* Continues a hash (math/hash.h) with all fixed values that a run's latches depend on. Nothing is checked.
 * Cost: 13 words for each beam, 50 for each wafer, and two for each point of an outline. */
uint64_t wh_latching_hash(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count,
                          uint64_t hash) WH_SYMBOL(wh_latching_hash);

/* A simulator calls the functions above through these pointers, so that one without beams does not link
 * them. */
typedef struct {
    wh_status_t (*check)(const wh_latching_t *latching, const wh_latch_order_t *order);
    /* Steps everything else of a wh_simulator_t by a wh_command_t, then its beams. */
    wh_status_t (*around)(void *simulator, const void *command,
                          wh_status_t (*rest)(void *simulator, const void *command));
    uint64_t (*hash)(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count, uint64_t hash);
} wh_latching_calls_t;

WH_HEADER_END

#endif
