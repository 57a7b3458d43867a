#include "physics.h"

#include <string.h>

#include "../math/hash.h"

wh_physics_t wh_physics_default(void) {
    wh_physics_t physics;
    memset(&physics, 0, sizeof physics);
    physics.slice_s = WH_SLICE_S;
    physics.vacuum = wh_vacuum_ideal();
    physics.pads = wh_pads_none();
    return physics;
}

wh_status_t wh_physics_validate(const wh_physics_t *physics, size_t gripper_count, size_t wafer_count) {
    if (!physics) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (gripper_count > WH_GRIPPERS) {
        return WH_STATUS_BAD_CAPACITY;
    }
    const bool sliced = physics->slice_s > 0 && physics->slice_s <= 1;
    const bool fits = sliced && physics->fault_count <= WH_FAULTS;
    wh_status_t status = fits ? wh_vacuum_validate(&physics->vacuum) : WH_STATUS_OUT_OF_RANGE;
    if (status == WH_OK) {
        status = wh_pads_validate(&physics->pads);
    }
    for (size_t i = 0; status == WH_OK && i < physics->fault_count; ++i) {
        status = wh_fault_validate(&physics->faults[i], gripper_count, wafer_count);
    }
    return status;
}

void wh_physics_state_start(wh_physics_state_t *state, const wh_physics_t *physics) {
    memset(state, 0, sizeof *state);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        state->vacuum[g] = wh_vacuum_start();
        state->told[g] = WH_VALVE_CLOSED;
    }
    for (size_t i = 0; physics && i < physics->fault_count; ++i) {
        const wh_fault_request_t request = {(int32_t)i, physics->faults[i]};
        wh_faults_take(&state->faults, &request, 1);
    }
}

/* ----------------------------------------------------------------------------------------------- validity */

static bool is_valve(int32_t valve) {
    return valve == WH_VALVE_OPEN || valve == WH_VALVE_CLOSED;
}

static bool is_place(const wh_vec3_t *place) {
    return wh_real_is_finite(place->x) && wh_real_is_finite(place->y) && wh_real_is_finite(place->z);
}

static wh_status_t check_gripper(const wh_physics_state_t *state, size_t g) {
    const wh_vacuum_t *vacuum = &state->vacuum[g];
    const wh_carry_t *carry = &state->carry[g];
    if (!is_valve(vacuum->command) || !is_valve(state->told[g])) {
        return WH_STATUS_BAD_VALVE;
    }
    if (!is_place(&carry->before[0]) || !is_place(&carry->before[1])) {
        return WH_STATUS_NOT_FINITE;
    }
    const bool good = vacuum->level >= 0 && vacuum->level <= 1 && carry->known >= 0 && carry->known <= 2;
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

/* The largest number of a sample's pixels. */
#define MOST_PIXELS 100000

static bool is_sampled(const wh_scan_t *scan) {
    bool good = scan->sample_count >= 0 && scan->sample_count <= WH_SCAN_SLICE;
    for (int32_t i = 0; good && i < WH_SCAN_SLICE; ++i) {
        const int32_t sample = scan->samples[i];
        good = sample >= 0 && sample <= (i < scan->sample_count ? MOST_PIXELS : 0);
    }
    return good;
}

/* The magnitude of a scan's turn and of a latch's part, as bits, which have the order of numbers: a processor
 * without doubles needs no function for them here. */
#define TURN_MOST UINT64_C(0x40c3880000000000)     /* 1e4 */
#define PART_MOST UINT64_C(0x3ff0000000000000)     /* 1 */
#define TURN_INFINITE UINT64_C(0x7ff0000000000000) /* beyond are those that are no number */

static uint64_t bits_of_turn(const wh_scan_t *scan) {
    uint64_t bits;
    memcpy(&bits, &scan->turn, sizeof bits);
    return bits;
}

static bool is_between(int64_t value, int64_t least, int64_t most) {
    return value >= least && value <= most;
}

/* What was ordered; before the first order nothing. */
static bool is_ordered(const wh_scan_t *scan, size_t gripper_count) {
    const int32_t most = WH_SCAN_TURNS * WH_SENSOR_SAMPLES;
    const int64_t reach = (int64_t)WH_SCAN_REACH * WH_SENSOR_SAMPLES;
    const bool none = (scan->gripper | scan->count) == 0 && scan->first == 0;
    const bool some = wh_is_index(scan->gripper, gripper_count) && is_between(scan->count, -most, most) &&
                      is_between(scan->first, -reach, reach);
    return scan->number > 0 ? some : none;
}

static wh_status_t check_scan(const wh_scan_t *scan, size_t gripper_count) {
    const uint64_t turn = bits_of_turn(scan) & (UINT64_MAX >> 1);
    if (turn >= TURN_INFINITE) {
        return WH_STATUS_NOT_FINITE;
    }
    if (!is_ordered(scan, gripper_count) || !is_sampled(scan)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const int32_t count = scan->count < 0 ? -scan->count : scan->count;
    const bool goes_on = scan->taken < count && turn < TURN_MOST;
    const bool good = is_between(scan->taken, scan->sample_count, count) &&
                      (scan->armed ? goes_on : bits_of_turn(scan) == 0);
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

static bool are_latches(const wh_latch_t latches[], int32_t count, const wh_latches_t *all, bool waiting) {
    bool good = true;
    for (int32_t i = 0; good && i < count; ++i) {
        const wh_latch_t *latch = &latches[i];
        uint64_t part;
        memcpy(&part, &latch->part, sizeof part);
        good = is_between(latch->beam, all->first, (int64_t)all->first + all->count - 1) &&
               (latch->edge == WH_CROSSING_IN || latch->edge == WH_CROSSING_OUT) && part <= PART_MOST &&
               (waiting ? latch->slice > all->slice : is_between(latch->slice, 1, all->slice));
    }
    return good;
}

/* Before the first order all is zero. */
static bool are_untouched(const wh_latches_t *latches) {
    return !latches->armed && (latches->first | latches->count) == 0 && latches->slice == 0 &&
           (latches->crossings | latches->lost | latches->broken) == 0 &&
           (latches->waiting_count | latches->latch_count) == 0;
}

static bool are_beams(const wh_latches_t *latches) {
    return is_between(latches->first, 0, WH_BEAMS - 1) &&
           is_between(latches->count, 1, WH_BEAMS - latches->first) && latches->slice >= 0 &&
           latches->broken >> (uint32_t)(latches->first + latches->count) == 0;
}

static wh_status_t check_latches(const wh_latches_t *latches) {
    const bool good = latches->number == 0
                          ? are_untouched(latches)
                          : are_beams(latches) &&
                                is_between(latches->waiting_count, 0, latches->armed ? WH_LATCHES : 0) &&
                                is_between(latches->latch_count, 0, WH_LATCHES) &&
                                are_latches(latches->waiting, latches->waiting_count, latches, true) &&
                                are_latches(latches->latches, latches->latch_count, latches, false);
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

wh_status_t wh_physics_state_validate(const wh_physics_state_t *state, size_t gripper_count,
                                      size_t wafer_count) {
    if (!state) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (gripper_count > WH_GRIPPERS) {
        return WH_STATUS_BAD_CAPACITY;
    }
    for (size_t g = 0; g < gripper_count; ++g) {
        const wh_status_t status = check_gripper(state, g);
        if (status != WH_OK) {
            return status;
        }
    }
    wh_status_t status = check_scan(&state->scan, gripper_count);
    status = status == WH_OK ? check_latches(&state->latches) : status;
    return status == WH_OK ? wh_faults_validate(&state->faults, gripper_count, wafer_count) : status;
}

uint32_t wh_physics_state_sensors(const wh_physics_state_t *state, size_t gripper_count) {
    uint32_t sensors = 0;
    for (size_t g = 0; g < gripper_count && g < WH_GRIPPERS; ++g) {
        sensors |= state->vacuum[g].on ? 1U << g : 0U;
    }
    return wh_faults_sensors(&state->faults, sensors);
}

/* --------------------------------------------------------------------------------------------------- hash */

/* Out of line: in this file a small copy counts for more than a fast one. */
static WH_OUT_OF_LINE uint64_t hash_word(uint64_t hash, uint64_t word) {
    return wh_hash_word(hash, word);
}

static WH_OUT_OF_LINE uint64_t hash_real(uint64_t hash, wh_real_t value) {
    return wh_hash_real(hash, value);
}

static uint64_t hash_ints(uint64_t hash, const int32_t values[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        hash = hash_word(hash, (uint64_t)(int64_t)values[i]);
    }
    return hash;
}

static uint64_t hash_vec3(uint64_t hash, const wh_vec3_t *v) {
    hash = hash_real(hash, v->x);
    hash = hash_real(hash, v->y);
    return hash_real(hash, v->z);
}

static uint64_t hash_pose(uint64_t hash, const wh_pose_t *pose) {
    for (size_t row = 0; row < 3; ++row) {
        const wh_vec3_t of_row = wh_mat3_row(&pose->R, row);
        hash = hash_vec3(hash, &of_row);
    }
    return hash_vec3(hash, &pose->r);
}

static bool is_plain(const wh_vacuum_t *vacuum, const wh_gripper_t *gripper) {
    const bool holds = gripper->wafer != WH_NONE;
    return vacuum->command == gripper->valve && vacuum->on == holds && vacuum->level == (holds ? 1 : 0);
}

static uint64_t hash_vacuum(uint64_t hash, size_t g, const wh_vacuum_t *vacuum) {
    const int32_t head[] = {1, (int32_t)g};
    const int32_t rest[] = {vacuum->command, vacuum->on ? 1 : 0};
    hash = hash_ints(hash, head, 2);
    hash = hash_real(hash, vacuum->level);
    return hash_ints(hash, rest, 2);
}

static uint64_t hash_carry(uint64_t hash, size_t g, const wh_carry_t *carry) {
    const int32_t head[] = {2, (int32_t)g, carry->known};
    hash = hash_ints(hash, head, 3);
    hash = hash_vec3(hash, &carry->before[0]);
    hash = hash_vec3(hash, &carry->before[1]);
    return wh_hash_int(hash, carry->slips ? 1 : 0);
}

static uint64_t hash_slot(uint64_t hash, size_t i, const wh_fault_slot_t *slot) {
    const wh_fault_t *fault = &slot->fault;
    const int32_t head[] = {
        3, (int32_t)i, (int32_t)slot->phase, (int32_t)fault->kind, fault->target, fault->other};
    hash = hash_ints(hash, head, 6);
    hash = hash_real(hash, fault->value);
    hash = hash_pose(hash, &fault->offset);
    hash = hash_word(hash, (uint64_t)fault->from);
    hash = hash_word(hash, (uint64_t)fault->until);
    hash = hash_pose(hash, &slot->before);
    return hash_pose(hash, &slot->placed);
}

static uint64_t hash_scan(uint64_t hash, const wh_scan_t *scan) {
    const int32_t head[] = {4, (int32_t)scan->number, scan->armed ? 1 : 0, scan->gripper, scan->count};
    hash = hash_ints(hash, head, 5);
    hash = hash_word(hash, (uint64_t)scan->first);
    hash = hash_word(hash, (uint64_t)(int64_t)scan->taken);
    hash = hash_word(hash, bits_of_turn(scan));
    hash = hash_word(hash, (uint64_t)(int64_t)scan->sample_count);
    return hash_ints(hash, scan->samples, (size_t)scan->sample_count);
}

static uint64_t hash_latches(uint64_t hash, const wh_latches_t *all) {
    const int32_t head[] = {5,
                            (int32_t)all->number,
                            all->armed ? 1 : 0,
                            all->first,
                            all->count,
                            (int32_t)all->crossings,
                            (int32_t)all->lost,
                            (int32_t)all->broken,
                            all->waiting_count,
                            all->latch_count};
    hash = hash_ints(hash, head, sizeof head / sizeof head[0]);
    hash = hash_word(hash, (uint64_t)all->slice);
    for (int32_t i = 0; i < all->waiting_count + all->latch_count; ++i) {
        const wh_latch_t *latch =
            i < all->waiting_count ? &all->waiting[i] : &all->latches[i - all->waiting_count];
        uint64_t part;
        memcpy(&part, &latch->part, sizeof part);
        const int64_t which = 2 * (int64_t)latch->beam + (int64_t)latch->edge;
        hash = hash_word(hash, (uint64_t)which);
        hash = hash_word(hash, (uint64_t)latch->slice);
        hash = hash_word(hash, part);
    }
    return hash;
}

static uint64_t hash_sensing(uint64_t hash, const wh_physics_state_t *state) {
    hash = state->scan.number > 0 ? hash_scan(hash, &state->scan) : hash;
    return state->latches.number > 0 ? hash_latches(hash, &state->latches) : hash;
}

uint64_t wh_physics_state_hash(const wh_physics_state_t *state, const wh_grasp_t *table) {
    const size_t gripper_count = table->storage.gripper_count;
    uint64_t hash = wh_grasp_hash(table);
    for (size_t g = 0; g < gripper_count && g < WH_GRIPPERS; ++g) {
        if (!is_plain(&state->vacuum[g], &table->storage.grippers[g])) {
            hash = hash_vacuum(hash, g, &state->vacuum[g]);
        }
    }
    for (size_t g = 0; g < gripper_count && g < WH_GRIPPERS; ++g) {
        if (state->carry[g].known > 0) {
            hash = hash_carry(hash, g, &state->carry[g]);
        }
    }
    for (size_t i = 0; i < state->faults.count; ++i) {
        if (state->faults.slots[i].phase != WH_FAULT_FREE) {
            hash = hash_slot(hash, i, &state->faults.slots[i]);
        }
    }
    return hash_sensing(hash, state);
}
