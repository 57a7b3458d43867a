#include "snapshot.h"

#include <string.h>

#include "../grasp/restore.h"
#include "../math/hash.h"
#include "description_internal.h"

static bool is_initialised(const wh_simulator_t *simulator) {
    return simulator->mark == WH_SIMULATOR_MARK && simulator->table.mark == WH_GRASP_MARK;
}

/* ---------------------------------------------------------------------------------------------- in memory */

static bool lacks_arrays(const wh_grasp_storage_t *storage) {
    return (!storage->wafers && storage->wafer_count > 0) ||
           (!storage->grippers && storage->gripper_count > 0) ||
           (!storage->buckets && storage->bucket_count > 0);
}

static wh_status_t check_storage(const wh_grasp_storage_t *ours, const wh_grasp_storage_t *other) {
    if (lacks_arrays(other)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const size_t buckets = wh_grasp_buckets(other->wafer_count, other->gripper_count);
    const bool has_room = other->bucket_count == 0 || (buckets > 0 && other->bucket_count >= buckets);
    const bool fits =
        other->wafer_count == ours->wafer_count && other->gripper_count == ours->gripper_count && has_room;
    return fits ? WH_OK : WH_STATUS_BAD_CAPACITY;
}

/* wh_grasp_restore that does not count a refusal, from arrays that may be the table's own. */
static wh_status_t restore(wh_grasp_t *table, uint64_t slice, const wh_wafer_t wafers[],
                           const wh_gripper_t grippers[]) {
    const uint64_t refused = table->counters.refused;
    const wh_status_t status = wh_grasp_restore(table, slice, wafers, grippers);
    table->counters.refused = refused;
    return status;
}

wh_status_t wh_simulator_relink(wh_simulator_t *simulator, const wh_grasp_storage_t *storage) {
    if (!simulator || !storage) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!is_initialised(simulator)) {
        return WH_STATUS_NOT_INITIALISED;
    }
    wh_grasp_t *table = &simulator->table;
    const wh_grasp_storage_t before = table->storage;
    wh_status_t status = check_storage(&before, storage);
    if (status != WH_OK) {
        return status;
    }
    table->storage = *storage;
    status = restore(table, table->slice, table->storage.wafers, table->storage.grippers);
    if (status != WH_OK) {
        table->storage = before;
    } else if (table->storage.wafers != before.wafers || table->storage.grippers != before.grippers) {
        simulator->observer = (wh_observer_t){NULL, NULL, NULL};
    }
    return status;
}

/* ------------------------------------------------------------------------------------- one way in and out */

/* A stream of bytes; values are written to it or read from it. One function for both directions keeps them
 * consistent. */
typedef struct {
    uint8_t *to; /* null: values are read */
    const uint8_t *from;
    bool is_bad; /* a byte was read that no snapshot has */
} stream_t;

/* The lowest byte first. */
static void pass_bytes(stream_t *stream, uint64_t *value, unsigned count) {
    uint64_t read = 0;
    for (unsigned i = 0; i < count; ++i) {
        if (stream->to) {
            *stream->to = (uint8_t)(*value >> (8 * i));
            ++stream->to;
        } else {
            read |= (uint64_t)*stream->from << (8 * i);
            ++stream->from;
        }
    }
    *value = stream->to ? *value : read;
}

static void pass_int(stream_t *stream, int32_t *value) {
    uint64_t word = (uint32_t)*value;
    pass_bytes(stream, &word, 4);
    const uint32_t bits = (uint32_t)word;
    memcpy(value, &bits, sizeof bits);
}

static void pass_time(stream_t *stream, int64_t *value) {
    uint64_t word = (uint64_t)*value;
    pass_bytes(stream, &word, 8);
    memcpy(value, &word, sizeof word);
}

static void pass_bool(stream_t *stream, bool *value) {
    uint64_t word = 0;
    if (stream->to && *value) { /* the target of a read may not yet be a valid bool */
        word = 1;
    }
    pass_bytes(stream, &word, 1);
    stream->is_bad = stream->is_bad || word > 1;
    *value = word == 1;
}

static void pass_real(stream_t *stream, wh_real_t *value) {
    wh_real_bits_t bits;
    memcpy(&bits, value, sizeof bits);
    uint64_t word = bits;
    pass_bytes(stream, &word, (unsigned)sizeof bits);
    bits = (wh_real_bits_t)word;
    memcpy(value, &bits, sizeof bits);
}

static void pass_vector(stream_t *stream, wh_vec3_t *v) {
    pass_real(stream, &v->x);
    pass_real(stream, &v->y);
    pass_real(stream, &v->z);
}

static void pass_pose(stream_t *stream, wh_pose_t *pose) {
    for (size_t i = 0; i < 9; ++i) {
        pass_real(stream, &pose->R.m[i / 3][i % 3]);
    }
    pass_vector(stream, &pose->r);
}

/* ---------------------------------------------------------------------------------------------- the parts */

static void pass_wafer(stream_t *stream, wh_wafer_t *wafer) {
    pass_pose(stream, &wafer->base_from_wafer);
    pass_int(stream, &wafer->holder);
    wafer->released_by = WH_NONE;
}

static void pass_measured(stream_t *stream, wh_proximity_t *p) {
    uint64_t failed = p->failed;
    pass_vector(stream, &p->dr);
    pass_real(stream, &p->n1_proj_n2);
    pass_real(stream, &p->dr_proj_z);
    pass_vector(stream, &p->dr_proj_xy);
    pass_real(stream, &p->dr_proj_xy_norm);
    pass_real(stream, &p->margin_projz);
    pass_real(stream, &p->margin_projxy);
    pass_real(stream, &p->margin_planar);
    pass_bytes(stream, &failed, 4);
    pass_bool(stream, &p->ready);
    p->failed = (unsigned)failed;
    stream->is_bad = stream->is_bad || failed > (WH_FAILED_PROJZ | WH_FAILED_PROJXY | WH_FAILED_PLANAR) ||
                     !wh_real_is_finite(p->margin_projz) || !wh_real_is_finite(p->margin_projxy) ||
                     !wh_real_is_finite(p->margin_planar);
}

static void pass_encounter(stream_t *stream, wh_encounter_t *encounter) {
    pass_int(stream, &encounter->wafer);
    pass_int(stream, &encounter->holder);
    uint64_t stamp = wh_encounter_stamp(encounter);
    pass_bytes(stream, &stamp, 8);
    wh_encounter_take_stamp(encounter, stamp);
    pass_measured(stream, &encounter->measured);
}

static void pass_gripper(stream_t *stream, wh_gripper_t *gripper) {
    pass_pose(stream, &gripper->base_from_gripper);
    pass_pose(stream, &gripper->gripper_from_wafer);
    pass_int(stream, &gripper->wafer);
    pass_int(stream, &gripper->valve);
    pass_encounter(stream, &gripper->approach);
    pass_encounter(stream, &gripper->contest);
}

/* One gripper's share of the physics. */
typedef struct {
    wh_vacuum_t vacuum;
    wh_carry_t carry;
    int32_t told;
} share_t;

static void pass_share(stream_t *stream, share_t *share) {
    pass_real(stream, &share->vacuum.level);
    pass_int(stream, &share->vacuum.command);
    pass_bool(stream, &share->vacuum.on);
    pass_vector(stream, &share->carry.before[0]);
    pass_vector(stream, &share->carry.before[1]);
    pass_int(stream, &share->carry.known);
    pass_bool(stream, &share->carry.slips);
    pass_int(stream, &share->told);
}

static void pass_wait(stream_t *stream, wh_vacuum_t *vacuum) {
    uint64_t word = vacuum->waits;
    pass_bytes(stream, &word, 2);
    vacuum->waits = (uint16_t)word;
}

static void pass_slot(stream_t *stream, wh_fault_slot_t *slot) {
    wh_fault_t *fault = &slot->fault;
    int32_t kind = (int32_t)fault->kind;
    int32_t phase = (int32_t)slot->phase;
    pass_int(stream, &kind);
    pass_int(stream, &fault->target);
    pass_int(stream, &fault->other);
    pass_real(stream, &fault->value);
    pass_pose(stream, &fault->offset);
    pass_time(stream, &fault->from);
    pass_time(stream, &fault->until);
    pass_int(stream, &phase);
    pass_pose(stream, &slot->before);
    pass_pose(stream, &slot->placed);
    stream->is_bad =
        stream->is_bad || kind < 0 || kind >= WH_FAULT_KINDS || phase < 0 || phase > WH_FAULT_TAKEN;
    fault->kind = stream->is_bad ? WH_FAULT_NO_VACUUM : (wh_fault_kind_t)kind;
    slot->phase = stream->is_bad ? WH_FAULT_FREE : (wh_fault_phase_t)phase;
}

static void pass_double(stream_t *stream, double *value) {
    uint64_t bits;
    memcpy(&bits, value, sizeof bits);
    pass_bytes(stream, &bits, 8);
    memcpy(value, &bits, sizeof bits);
}

/* 293 bytes. */
static void pass_scan(stream_t *stream, wh_scan_t *scan) {
    uint64_t number = scan->number;
    pass_bytes(stream, &number, 4);
    pass_bool(stream, &scan->armed);
    pass_int(stream, &scan->gripper);
    pass_int(stream, &scan->count);
    pass_time(stream, &scan->first);
    pass_int(stream, &scan->taken);
    pass_double(stream, &scan->turn);
    pass_int(stream, &scan->sample_count);
    for (size_t i = 0; i < WH_SCAN_SLICE; ++i) {
        pass_int(stream, &scan->samples[i]);
    }
    scan->number = (uint32_t)number;
}

/* 21 bytes. */
static void pass_latch(stream_t *stream, wh_latch_t *latch) {
    uint64_t edge = 0;
    if (latch->edge == WH_CROSSING_OUT) {
        edge = 1;
    }
    pass_int(stream, &latch->beam);
    pass_bytes(stream, &edge, 1);
    pass_time(stream, &latch->slice);
    pass_double(stream, &latch->part);
    stream->is_bad = stream->is_bad || edge > 1;
    latch->edge = edge == 1 ? WH_CROSSING_OUT : WH_CROSSING_IN;
}

/* 72 bytes, in float 64: the part that wh_grips_complete cannot compute. */
static void pass_grip(stream_t *stream, wh_grip_state_t *state) {
    int32_t phase = (int32_t)state->phase;
    pass_int(stream, &phase);
    pass_int(stream, &state->wafer);
    pass_double(stream, &state->s);
    pass_double(stream, &state->excess);
    pass_double(stream, &state->lying.x);
    pass_double(stream, &state->lying.y);
    pass_double(stream, &state->lying.notch_x);
    pass_double(stream, &state->lying.notch_y);
    pass_real(stream, &state->x);
    pass_real(stream, &state->y);
    stream->is_bad = stream->is_bad || phase < 0 || phase > WH_GRIP_OPENING;
    state->phase = stream->is_bad ? WH_GRIP_OPEN : (wh_grip_phase_t)phase;
}

static void pass_unsigned(stream_t *stream, uint32_t *value) {
    uint64_t word = *value;
    pass_bytes(stream, &word, 4);
    *value = (uint32_t)word;
}

/* 713 bytes. */
static void pass_latches(stream_t *stream, wh_latches_t *latches) {
    pass_unsigned(stream, &latches->number);
    pass_bool(stream, &latches->armed);
    pass_int(stream, &latches->first);
    pass_int(stream, &latches->count);
    pass_time(stream, &latches->slice);
    pass_unsigned(stream, &latches->crossings);
    pass_unsigned(stream, &latches->lost);
    pass_unsigned(stream, &latches->broken);
    pass_int(stream, &latches->waiting_count);
    pass_int(stream, &latches->latch_count);
    for (size_t i = 0; i < WH_LATCHES; ++i) {
        pass_latch(stream, &latches->waiting[i]);
        pass_latch(stream, &latches->latches[i]);
    }
}

/* How many numbers there are of so many doors. */
static size_t numbers_of(int32_t doors) {
    return doors > WH_SNAPSHOT_FEW_DOORS ? (size_t)doors : WH_SNAPSHOT_FEW_DOORS;
}

/* 4 bytes, and the numbers of a simulator with so many doors: a count that is read is not trusted. */
static void pass_doors(stream_t *stream, wh_doors_t *doors, int32_t count) {
    pass_int(stream, &doors->count);
    for (size_t d = 0; d < numbers_of(count); ++d) {
        pass_real(stream, &doors->at[d]);
    }
}

/* --------------------------------------------------------------------------------------------------- ends */

#define HEAD_SIZE 16 /* mark, version, number type, description */
#define SUM_SIZE 8

static uint64_t sum_of(const uint8_t bytes[], size_t size) {
    uint64_t sum = WH_HASH_START;
    for (size_t i = 0; i < size; ++i) {
        sum = wh_hash_word(sum, bytes[i]);
    }
    return sum;
}

#define MARK UINT64_C(0x50414E534857) /* "WHSNAP", first letter first */
#define MARK_SIZE 6

static bool has_debounce(const wh_simulator_t *simulator) {
    return simulator->vacuum.debounce > 0;
}

/* The number of bytes of a snapshot with this number of fault slots. */
static size_t size_with(const wh_simulator_t *simulator, size_t slots) {
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    const size_t waits = has_debounce(simulator) ? 0 : 2 * storage->gripper_count;
    return WH_SNAPSHOT_SIZE(storage->wafer_count, storage->gripper_count) - waits -
           (WH_DOORS - numbers_of(simulator->physics.doors.count)) * sizeof(wh_real_t) -
           (37 * sizeof(wh_real_t) + 32) * (WH_FAULTS - slots);
}

size_t wh_simulator_saved_size(const wh_simulator_t *simulator) {
    return is_initialised(simulator) ? size_with(simulator, simulator->physics.faults.count) : 0;
}

static bool has_many_doors(const wh_simulator_t *simulator) {
    return simulator->physics.doors.count > WH_SNAPSHOT_FEW_DOORS;
}

static void pass_counters(stream_t *stream, wh_grasp_counters_t *counters) {
    uint64_t *const all[] = {&counters->refused,     &counters->picked,      &counters->released,
                             &counters->handed_over, &counters->near_misses, &counters->contested};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
        pass_bytes(stream, all[i], 8);
    }
}

/* ------------------------------------------------------------------------------------------------- saving */

static void save_head(stream_t *stream, const wh_simulator_t *simulator) {
    uint64_t mark = MARK;
    uint64_t version = has_many_doors(simulator) ? WH_SNAPSHOT_MANY : WH_SNAPSHOT_VERSION;
    uint64_t number = sizeof(wh_real_t);
    uint64_t description = wh_simulator_describe(simulator);
    pass_bytes(stream, &mark, MARK_SIZE);
    pass_bytes(stream, &version, 1);
    pass_bytes(stream, &number, 1);
    pass_bytes(stream, &description, 8);
}

static void clear_encounter(wh_encounter_t *encounter) {
    memset(encounter, 0, sizeof *encounter);
    encounter->wafer = WH_NONE;
    encounter->holder = WH_NONE;
}

/* Clears leftovers of the last wafer, which have no meaning, so that equal states have equal bytes. */
static void drop_leftovers(wh_gripper_t *gripper) {
    if (gripper->wafer == WH_NONE) {
        gripper->gripper_from_wafer = wh_pose_identity();
    }
    if (gripper->approach.wafer == WH_NONE) {
        clear_encounter(&gripper->approach);
    }
    if (gripper->contest.wafer == WH_NONE) {
        clear_encounter(&gripper->contest);
    }
}

static void save_table(stream_t *stream, const wh_grasp_t *table) {
    uint64_t slice = table->slice;
    wh_grasp_counters_t counters;
    counters = table->counters;
    pass_bytes(stream, &slice, 8);
    pass_counters(stream, &counters);
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        wh_wafer_t wafer;
        wafer = table->storage.wafers[w];
        pass_wafer(stream, &wafer);
    }
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        wh_gripper_t gripper;
        gripper = table->storage.grippers[g];
        drop_leftovers(&gripper);
        pass_gripper(stream, &gripper);
    }
}

/* Leaves out latches that have passed, which have no meaning, so that equal states have equal bytes. */
static void save_latches(stream_t *stream, const wh_latches_t *from) {
    wh_latches_t latches;
    latches = *from;
    for (int32_t i = latches.waiting_count; i < WH_LATCHES; ++i) {
        memset(&latches.waiting[i], 0, sizeof latches.waiting[i]);
    }
    for (int32_t i = latches.latch_count; i < WH_LATCHES; ++i) {
        memset(&latches.latches[i], 0, sizeof latches.latches[i]);
    }
    pass_latches(stream, &latches);
}

/* Leaves out a place that no longer counts. */
static void save_grip(stream_t *stream, const wh_grip_state_t *from) {
    wh_grip_state_t state;
    state = *from;
    if (state.phase != WH_GRIP_CLOSING || state.wafer == WH_NONE) {
        memset(&state.lying, 0, sizeof state.lying);
        state.x = 0;
        state.y = 0;
    }
    pass_grip(stream, &state);
}

static void save_waits(stream_t *stream, const wh_simulator_t *simulator) {
    for (size_t g = 0; has_debounce(simulator) && g < simulator->table.storage.gripper_count; ++g) {
        wh_vacuum_t vacuum;
        vacuum = simulator->physics.vacuum[g];
        pass_wait(stream, &vacuum);
    }
}

static void save_physics(stream_t *stream, const wh_physics_state_t *physics, size_t gripper_count) {
    for (size_t g = 0; g < gripper_count; ++g) {
        share_t share;
        share.vacuum = physics->vacuum[g];
        share.carry = physics->carry[g];
        share.told = physics->told[g];
        pass_share(stream, &share);
        save_grip(stream, &physics->grips[g]);
    }
    wh_scan_t scan;
    scan = physics->scan;
    pass_scan(stream, &scan);
    save_latches(stream, &physics->latches);
    wh_doors_t doors;
    doors = physics->doors;
    pass_doors(stream, &doors, doors.count);
    uint64_t count = physics->faults.count;
    pass_bytes(stream, &count, 4);
    for (size_t i = 0; i < physics->faults.count; ++i) {
        wh_fault_slot_t slot;
        slot = physics->faults.slots[i];
        pass_slot(stream, &slot);
    }
}

wh_status_t wh_simulator_save(const wh_simulator_t *simulator, uint8_t bytes[], size_t capacity,
                              size_t *size) {
    if (!simulator || !bytes || !size) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!is_initialised(simulator)) {
        return WH_STATUS_NOT_INITIALISED;
    }
    const size_t needed = wh_simulator_saved_size(simulator);
    if (capacity < needed) {
        return WH_STATUS_BAD_CAPACITY;
    }
    stream_t stream = {bytes, NULL, false};
    save_head(&stream, simulator);
    save_table(&stream, &simulator->table);
    save_waits(&stream, simulator);
    save_physics(&stream, &simulator->physics, simulator->table.storage.gripper_count);
    uint64_t sum = sum_of(bytes, needed - SUM_SIZE);
    pass_bytes(&stream, &sum, SUM_SIZE);
    *size = needed;
    return WH_OK;
}

/* ------------------------------------------------------------------------------------------------ loading */

static uint64_t read_bytes(const uint8_t bytes[], unsigned count) {
    stream_t stream = {NULL, bytes, false};
    uint64_t value = 0;
    pass_bytes(&stream, &value, count);
    return value;
}

/* Checks everything but the state itself. */
static wh_status_t check_ends(const wh_simulator_t *simulator, const uint8_t bytes[], size_t size) {
    if (size < HEAD_SIZE + SUM_SIZE || read_bytes(bytes, MARK_SIZE) != MARK) {
        return WH_STATUS_DAMAGED;
    }
    const bool is_known = has_many_doors(simulator)
                              ? bytes[6] == WH_SNAPSHOT_MANY
                              : bytes[6] == WH_SNAPSHOT_VERSION || bytes[6] == WH_SNAPSHOT_BACKS;
    if (!is_known || bytes[7] != sizeof(wh_real_t)) {
        return WH_STATUS_OTHER_SNAPSHOT;
    }
    if (read_bytes(&bytes[size - SUM_SIZE], SUM_SIZE) != sum_of(bytes, size - SUM_SIZE)) {
        return WH_STATUS_DAMAGED;
    }
    if (read_bytes(&bytes[8], 8) != wh_simulator_describe(simulator)) {
        return WH_STATUS_OTHER_SNAPSHOT;
    }
    return size >= size_with(simulator, 0) ? WH_OK : WH_STATUS_DAMAGED;
}

static void load_physics(stream_t *stream, const wh_simulator_t *simulator, wh_physics_state_t *physics) {
    const size_t gripper_count = simulator->table.storage.gripper_count;
    wh_physics_state_start(physics, NULL);
    for (size_t g = 0; has_debounce(simulator) && g < gripper_count; ++g) {
        pass_wait(stream, &physics->vacuum[g]);
    }
    for (size_t g = 0; g < gripper_count; ++g) {
        share_t share;
        memset(&share, 0, sizeof share);
        share.vacuum.waits = physics->vacuum[g].waits;
        pass_share(stream, &share);
        physics->vacuum[g] = share.vacuum;
        physics->carry[g] = share.carry;
        physics->told[g] = share.told;
        pass_grip(stream, &physics->grips[g]);
    }
    pass_scan(stream, &physics->scan);
    pass_latches(stream, &physics->latches);
    pass_doors(stream, &physics->doors, simulator->physics.doors.count);
}

/* False if the number of bytes does not fit these slots. */
static bool load_faults(stream_t *stream, wh_faults_t *faults, const wh_simulator_t *simulator, size_t size) {
    uint64_t count = 0;
    pass_bytes(stream, &count, 4);
    if (count > WH_FAULTS || size != size_with(simulator, (size_t)count)) {
        return false;
    }
    faults->count = (size_t)count;
    for (size_t i = 0; i < faults->count; ++i) {
        pass_slot(stream, &faults->slots[i]);
    }
    return true;
}

/* False if a sensor waits longer than its debounce, or waits without vacuum. */
static bool may_wait(const wh_simulator_t *simulator, const wh_physics_state_t *state) {
    bool good = true;
    for (size_t g = 0; g < simulator->table.storage.gripper_count; ++g) {
        const bool has_vacuum = (simulator->given.no_vacuum >> g & 1U) == 0;
        good = good && state->vacuum[g].waits <= (has_vacuum ? simulator->vacuum.debounce : 0);
    }
    return good;
}

bool wh_simulator_may_have(const wh_simulator_t *simulator, const wh_physics_state_t *state) {
    const wh_simulator_given_t *given = &simulator->given;
    bool good = (given->scans || state->scan.number == 0) && (given->beams || state->latches.number == 0) &&
                (size_t)state->doors.count == given->doors.count && may_wait(simulator, state);
    for (size_t g = 0; !given->gripping && g < simulator->table.storage.gripper_count; ++g) {
        good = good && state->grips[g].phase == WH_GRIP_OPEN;
    }
    return good;
}

/* False for grips that are impossible for the simulator. */
static bool complete_grips(const wh_simulator_t *simulator, wh_snapshot_room_t *room) {
    const wh_gripping_calls_t *gripping = simulator->given.gripping;
    return !gripping || gripping->complete(simulator, room->grippers, room->physics.grips) == WH_OK;
}

/* Reads everything into the room; false if it is not possible. */
static bool load_state(stream_t *stream, const wh_simulator_t *simulator, size_t size,
                       wh_snapshot_room_t *room) {
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    for (size_t w = 0; w < storage->wafer_count; ++w) {
        pass_wafer(stream, &room->wafers[w]);
    }
    for (size_t g = 0; g < storage->gripper_count; ++g) {
        pass_gripper(stream, &room->grippers[g]);
    }
    load_physics(stream, simulator, &room->physics);
    return load_faults(stream, &room->physics.faults, simulator, size) && !stream->is_bad &&
           complete_grips(simulator, room) &&
           wh_physics_state_validate(&room->physics, storage->gripper_count, storage->wafer_count) == WH_OK &&
           wh_simulator_may_have(simulator, &room->physics);
}

/* Loads everything, from bytes whose ends are checked. */
static wh_status_t load(wh_simulator_t *simulator, const uint8_t bytes[], size_t size,
                        wh_snapshot_room_t *room) {
    wh_grasp_t *table = &simulator->table;
    stream_t stream = {NULL, &bytes[HEAD_SIZE], false};
    uint64_t slice = 0;
    wh_grasp_counters_t counters;
    memset(&counters, 0, sizeof counters);
    pass_bytes(&stream, &slice, 8);
    pass_counters(&stream, &counters);
    if (!load_state(&stream, simulator, size, room) ||
        restore(table, slice, room->wafers, room->grippers) != WH_OK) {
        return WH_STATUS_DAMAGED;
    }
    table->counters = counters;
    simulator->physics = room->physics;
    simulator->event_count = 0;
    simulator->has_last = false;
    return WH_OK;
}

static wh_status_t check_room(const wh_grasp_storage_t *storage, const wh_snapshot_room_t *room) {
    if ((!room->wafers && storage->wafer_count > 0) || (!room->grippers && storage->gripper_count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const size_t wafers = storage->wafer_count * sizeof *room->wafers;
    const size_t grippers = storage->gripper_count * sizeof *room->grippers;
    const wh_extent_t all[] = {{room->wafers, wafers},
                               {room->grippers, grippers},
                               {storage->wafers, wafers},
                               {storage->grippers, grippers}};
    bool overlap = wh_extents_overlap(all[0], all[1]);
    for (size_t k = 2; k < 4; ++k) {
        overlap = overlap || wh_extents_overlap(all[0], all[k]) || wh_extents_overlap(all[1], all[k]);
    }
    return overlap ? WH_STATUS_OVERLAP : WH_OK;
}

wh_status_t wh_simulator_load(wh_simulator_t *simulator, const uint8_t bytes[], size_t size,
                              wh_snapshot_room_t *room) {
    if (!simulator || !bytes || !room) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!is_initialised(simulator)) {
        return WH_STATUS_NOT_INITIALISED;
    }
    wh_status_t status = check_room(&simulator->table.storage, room);
    if (status == WH_OK) {
        status = check_ends(simulator, bytes, size);
    }
    return status == WH_OK ? load(simulator, bytes, size, room) : status;
}
