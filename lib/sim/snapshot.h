/* Snapshots of a simulator: taken between two slices, and continued later without any difference.
 *
 * In memory: Everything that a run depends on is in the simulator and in the caller's arrays of wafers and
 * grippers. A snapshot is a copy of these three:
 *
 *     wh_simulator_t saved = simulator;
 *     memcpy(saved_wafers, wafers, sizeof wafers);
 *     memcpy(saved_grippers, grippers, sizeof grippers);
 *
 * Copied back to their old addresses, with wh_simulator_relink after it if the table has buckets, they put
 * the run back to that slice. With arrays of its own the copy is a second simulator, for example for a look
 * ahead:
 *
 *     const wh_grasp_storage_t storage = {saved_wafers, WAFERS, saved_grippers, GRIPPERS, NULL, 0};
 *     status = wh_simulator_relink(&saved, &storage);
 *
 * As bytes, for a file or a transfer: wh_simulator_save and wh_simulator_load. The bytes are equal on
 * machines of either byte order and with any compiler. They name their version, number type and cell. A
 * snapshot does not contain the observer, which keeps its own data; the bytes do not contain the last
 * slice's events. It uses no heap and no static data.
 */
#ifndef WH_SIM_SNAPSHOT_H
#define WH_SIM_SNAPSHOT_H

#include "simulator.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(snapshot);

/* Goes up when the bytes change. Those of version 4 are read, too: they are of encounters with backs. With
 * more than WH_SNAPSHOT_FEW_DOORS doors the bytes are longer, and of version 6: programs that know only
 * fewer doors refuse them by that number. Where vacuum sensors have a debounce the bytes are longer by 2 for
 * each gripper; their cell's description has it. */
#define WH_SNAPSHOT_VERSION 5
#define WH_SNAPSHOT_BACKS 4
#define WH_SNAPSHOT_MANY 6
#define WH_SNAPSHOT_FEW_DOORS 8

/* The most bytes of a snapshot: a constant, for use as an array size. For 25 wafers and 2 grippers 10222 in
 * double, of which 5248 are for faults and 160 for more than 8 doors, and 6086 in float; with the counts of
 * a bare target 10062 and 6006. */
#define WH_SNAPSHOT_SIZE(wafer_count, gripper_count)                                                         \
    (1094 + WH_DOORS * sizeof(wh_real_t) + (12 * sizeof(wh_real_t) + 4) * WH_CAST(size_t, wafer_count) +     \
     (57 * sizeof(wh_real_t) + 122) * WH_CAST(size_t, gripper_count) +                                       \
     (37 * sizeof(wh_real_t) + 32) * WH_FAULTS)

/* Makes a copied simulator use these arrays, which hold copies of the original's wafers and grippers, and
 * fills the buckets. If the arrays differ from the earlier ones, `observer` is cleared, because its `user`
 * belongs to the original; set it again. It refuses, and changes nothing: null pointers; a simulator that
 * was never initialised (WH_STATUS_NOT_INITIALISED); other counts than the table's, or too few buckets but
 * not 0 (WH_STATUS_BAD_CAPACITY); wafers and grippers that wh_grasp_restore refuses, with its status. Cost:
 * linear in wafers and grippers. */
wh_status_t wh_simulator_relink(wh_simulator_t *simulator, const wh_grasp_storage_t *storage)
    WH_SYMBOL(wh_simulator_relink);

/* The number of bytes that wh_simulator_save writes now, at most WH_SNAPSHOT_SIZE. Faults increase it. It
 * is 0 for a simulator that was never initialised. */
size_t wh_simulator_saved_size(const wh_simulator_t *simulator) WH_SYMBOL(wh_simulator_saved_size);

/* Writes a snapshot into bytes[0 .. capacity - 1], and its length into *size. It refuses, and writes
 * nothing: WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_INITIALISED, or WH_STATUS_BAD_CAPACITY for less room than
 * wh_simulator_saved_size. Cost: a few nanoseconds for each byte; 1 kB of stack. */
wh_status_t wh_simulator_save(const wh_simulator_t *simulator, uint8_t bytes[], size_t capacity, size_t *size)
    WH_SYMBOL(wh_simulator_save);

/* True if the simulator can have this state, which wh_physics_state_validate has accepted. No vacuum
 * sensor waits longer than the debounce. Without edge sensors there must be no scan, and without beams no
 * latch. There must be as many doors as it has; without other grips all plungers must be open. No argument
 * may be null. Cost: linear in grippers. */
bool wh_simulator_may_have(const wh_simulator_t *simulator, const wh_physics_state_t *state)
    WH_SYMBOL(wh_simulator_may_have);

/* Working memory, from the caller. wh_simulator_load reads the state into it and checks it before the
 * simulator changes. Its content does not matter. The arrays have as many entries as the simulator's, and
 * must not be the simulator's own. */
typedef struct {
    wh_wafer_t *wafers;
    wh_gripper_t *grippers;
    wh_physics_state_t physics;
} wh_snapshot_room_t;

/* Sets an initialised simulator to the state that wh_simulator_save wrote, counters included. It must have
 * the same configuration, physics, stations and counts; the faults at the start of its run do not matter.
 * Equal commands then yield the bits that they would have yielded there. Errors, which leave the simulator
 * unchanged:
 *   WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_INITIALISED
 *   WH_STATUS_OVERLAP         the room's arrays share bytes with each other or the simulator's own
 *   WH_STATUS_OTHER_SNAPSHOT  of another version or number type, or of a simulator that differs in any of the
 *                             above
 *   WH_STATUS_DAMAGED         fewer or more bytes than were written, or one that has changed; or a state that
 *                             no simulator can be in (a holder that does not hold, numbers that are none)
 * For any bytes, nothing beyond them is read. There is no protection against deliberate changes: with a
 * correct checksum at the end, bytes can make any state that a simulator can have. Cost: that of
 * wh_simulator_save, and wh_grasp_restore; 1 kB of stack. */
wh_status_t wh_simulator_load(wh_simulator_t *simulator, const uint8_t bytes[], size_t size,
                              wh_snapshot_room_t *room) WH_SYMBOL(wh_simulator_load);

WH_HEADER_END

#endif
