/* Snapshots of a simulator: taken between two slices, and taken up again as if nothing had come between.
 *
 * In memory. All that a run depends on stands in the simulator and in the caller's arrays of wafers and
 * grippers. A snapshot is a copy of these three:
 *
 *     wh_simulator_t saved = simulator;
 *     memcpy(saved_wafers, wafers, sizeof wafers);
 *     memcpy(saved_grippers, grippers, sizeof grippers);
 *
 * Copied back to the same addresses, with wh_simulator_relink after it if the table has buckets, the run is
 * where it was. With arrays of its own the copy is a second simulator, such as for a look ahead:
 *
 *     const wh_grasp_storage_t storage = {saved_wafers, WAFERS, saved_grippers, GRIPPERS, NULL, 0};
 *     status = wh_simulator_relink(&saved, &storage);
 *
 * As bytes, for a file or a wire: wh_simulator_save and wh_simulator_load. They are the same on machines of
 * either byte order and with any compiler, and say of themselves which version, number type and cell they
 * belong to. Not in a snapshot are the observer (what it keeps is its own), and, of bytes, the last slice's
 * events. No heap, nothing static.
 */
#ifndef WH_SIM_SNAPSHOT_H
#define WH_SIM_SNAPSHOT_H

#include "simulator.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(snapshot);

/* Goes up when the bytes change. */
#define WH_SNAPSHOT_VERSION 4

/* The most bytes of a snapshot: a constant, for an array. For 25 wafers and 2 grippers 10058 in double, of
 * which 5248 are for faults, and 6002 in float. */
#define WH_SNAPSHOT_SIZE(wafer_count, gripper_count)                                                         \
    (1094 + WH_DOORS * sizeof(wh_real_t) + (12 * sizeof(wh_real_t) + 4) * (size_t)(wafer_count) +            \
     (57 * sizeof(wh_real_t) + 120) * (size_t)(gripper_count) + (37 * sizeof(wh_real_t) + 32) * WH_FAULTS)

/* Makes a copied simulator use these arrays, which hold copies of the original's wafers and grippers, and
 * fills the buckets. If the arrays are others than before, `observer` is cleared, for its `user` belongs to
 * the original; set it anew. Refused, everything unchanged: null pointers; a simulator that was never
 * initialised (WH_STATUS_NOT_INITIALISED); other counts than the table's, or too few buckets but not 0
 * (WH_STATUS_BAD_CAPACITY); wafers and grippers that wh_grasp_restore refuses, with its status. Cost: linear
 * in wafers and grippers. */
wh_status_t wh_simulator_relink(wh_simulator_t *simulator, const wh_grasp_storage_t *storage)
    WH_SYMBOL(wh_simulator_relink);

/* How many bytes wh_simulator_save writes now, at most WH_SNAPSHOT_SIZE. Faults that were brought add to it.
 * 0 for a simulator that was never initialised. */
size_t wh_simulator_saved_size(const wh_simulator_t *simulator) WH_SYMBOL(wh_simulator_saved_size);

/* Writes a snapshot into bytes[0 .. capacity - 1], and its length into *size. Refused, nothing written:
 * WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_INITIALISED, or WH_STATUS_BAD_CAPACITY for less room than
 * wh_simulator_saved_size. Cost: a few nanoseconds a byte; 1 kB of stack. */
wh_status_t wh_simulator_save(const wh_simulator_t *simulator, uint8_t bytes[], size_t capacity, size_t *size)
    WH_SYMBOL(wh_simulator_save);

/* True if the simulator can have such a state, which wh_physics_state_validate has accepted: without edge
 * sensors no scan, without beams no latch, as many doors as it has, and without other grips open plungers
 * alone. No argument may be null. Cost: linear in grippers. */
bool wh_simulator_may_have(const wh_simulator_t *simulator, const wh_physics_state_t *state)
    WH_SYMBOL(wh_simulator_may_have);

/* Room to work in, the caller's: wh_simulator_load reads the state into it and looks whether it is sound,
 * before the simulator changes. What stands in it does not matter. The arrays have as many entries as the
 * simulator's, and are not the simulator's own. */
typedef struct {
    wh_wafer_t *wafers;
    wh_gripper_t *grippers;
    wh_physics_state_t physics;
} wh_snapshot_room_t;

/* Sets an initialised simulator to the state that wh_simulator_save wrote, counters included. It must have
 * the same configuration, physics, stations and counts; the faults at the start of its run do not matter. The
 * same commands then yield the same bits as they would have there. Refused, the simulator unchanged:
 *   WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_INITIALISED
 *   WH_STATUS_BAD_CAPACITY    the room begins with the simulator's own arrays
 *   WH_STATUS_OTHER_SNAPSHOT  of another version or number type, or of a simulator that differs in any of the
 *                             above
 *   WH_STATUS_DAMAGED         fewer or more bytes than were written, or one that has changed; or a state that
 *                             no simulator can be in (a holder that does not hold, numbers that are none)
 * Whatever the bytes are, nothing beyond them is read. Against changes on purpose there is no seal: who makes
 * the sum at the end right can make any state that a simulator can be in. Cost: as wh_simulator_save, and
 * wh_grasp_restore; 1 kB of stack. */
wh_status_t wh_simulator_load(wh_simulator_t *simulator, const uint8_t bytes[], size_t size,
                              wh_snapshot_room_t *room) WH_SYMBOL(wh_simulator_load);

WH_HEADER_END

#endif
