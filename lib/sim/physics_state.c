/* All of a state: the parts of every simulator (physics.c), and the parts that only some have. */
#include "../math/hash.h"
#include "physics.h"

/* ----------------------------------------------------------------------------------------------- validity */

static bool is_valve(int32_t valve) {
    return valve == WH_VALVE_OPEN || valve == WH_VALVE_CLOSED;
}

static bool is_place(const wh_vec3_t *place) {
    return wh_real_is_finite(place->x) && wh_real_is_finite(place->y) && wh_real_is_finite(place->z);
}

static bool is_carried(const wh_carry_t *carry) {
    return carry->known >= 0 && carry->known <= 2;
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
    const bool good = vacuum->level >= 0 && vacuum->level <= 1 && vacuum->waits <= WH_VACUUM_DEBOUNCE &&
                      is_carried(carry) && (unsigned)state->grips[g].phase <= WH_GRIP_OPENING;
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

/* The limits of a scan's turn and of a latch's part, as bits. Bits have the order of numbers, so a
 * processor without doubles needs no function for them here. */
#define TURN_MOST UINT64_C(0x40c3880000000000)     /* 1e4 */
#define PART_MOST UINT64_C(0x3ff0000000000000)     /* 1 */
#define TURN_INFINITE UINT64_C(0x7ff0000000000000) /* larger values are NaN */

static bool is_between(int64_t value, int64_t least, int64_t most) {
    return value >= least && value <= most;
}

/* True if the values fit an order; before the first order there are none. */
static bool is_ordered(const wh_scan_t *scan, size_t gripper_count) {
    const int32_t most = WH_SCAN_TURNS * WH_SENSOR_SAMPLES;
    const int64_t reach = (int64_t)WH_SCAN_REACH * WH_SENSOR_SAMPLES;
    const bool none = (scan->gripper | scan->count) == 0 && scan->first == 0;
    const bool some = wh_is_index(scan->gripper, gripper_count) && is_between(scan->count, -most, most) &&
                      is_between(scan->first, -reach, reach);
    return scan->number > 0 ? some : none;
}

static wh_status_t check_scan(const wh_scan_t *scan, size_t gripper_count) {
    const uint64_t turn = wh_double_bits(scan->turn) & (UINT64_MAX >> 1);
    if (turn >= TURN_INFINITE) {
        return WH_STATUS_NOT_FINITE;
    }
    if (!is_ordered(scan, gripper_count) || !is_sampled(scan)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const int32_t count = scan->count < 0 ? -scan->count : scan->count;
    const bool goes_on = scan->taken < count && turn < TURN_MOST;
    const bool good = is_between(scan->taken, scan->sample_count, count) &&
                      (scan->armed ? goes_on : wh_double_bits(scan->turn) == 0);
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

static bool are_latches(const wh_latch_t latches[], int32_t count, const wh_latches_t *all, bool waiting) {
    bool good = true;
    for (int32_t i = 0; good && i < count; ++i) {
        const wh_latch_t *latch = &latches[i];
        good = is_between(latch->beam, all->first, (int64_t)all->first + all->count - 1) &&
               (latch->edge == WH_CROSSING_IN || latch->edge == WH_CROSSING_OUT) &&
               wh_double_bits(latch->part) <= PART_MOST &&
               (waiting ? latch->slice > all->slice : is_between(latch->slice, 1, all->slice));
    }
    return good;
}

/* True if all is zero, as before the first order. */
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

static wh_status_t check_doors(const wh_doors_t *doors) {
    bool good = doors->count >= 0 && doors->count <= WH_DOORS;
    for (int32_t d = 0; good && d < WH_DOORS; ++d) {
        const wh_real_t most = d < doors->count ? WH_FAULT_REACH : 0;
        if (!wh_real_is_finite(doors->at[d])) {
            return WH_STATUS_NOT_FINITE;
        }
        good = doors->at[d] >= 0 && doors->at[d] <= most;
    }
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
    status = status == WH_OK ? check_doors(&state->doors) : status;
    return status == WH_OK ? wh_faults_validate(&state->faults, gripper_count, wafer_count) : status;
}

/* --------------------------------------------------------------------------------------------------- hash */

static uint64_t hash_scan(uint64_t hash, const wh_scan_t *scan) {
    const int32_t head[] = {4, (int32_t)scan->number, scan->armed ? 1 : 0, scan->gripper, scan->count};
    hash = wh_hash_ints(hash, head, 5);
    hash = wh_hash_word(hash, (uint64_t)scan->first);
    hash = wh_hash_word(hash, (uint64_t)(int64_t)scan->taken);
    hash = wh_hash_word(hash, wh_double_bits(scan->turn));
    hash = wh_hash_word(hash, (uint64_t)(int64_t)scan->sample_count);
    return wh_hash_ints(hash, scan->samples, (size_t)scan->sample_count);
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
    hash = wh_hash_ints(hash, head, sizeof head / sizeof head[0]);
    hash = wh_hash_word(hash, (uint64_t)all->slice);
    for (int32_t i = 0; i < all->waiting_count + all->latch_count; ++i) {
        const wh_latch_t *latch =
            i < all->waiting_count ? &all->waiting[i] : &all->latches[i - all->waiting_count];
        const int64_t which = 2 * (int64_t)latch->beam + (int64_t)latch->edge;
        hash = wh_hash_word(hash, (uint64_t)which);
        hash = wh_hash_word(hash, (uint64_t)latch->slice);
        hash = wh_hash_word(hash, wh_double_bits(latch->part));
    }
    return hash;
}

static uint64_t hash_grip(uint64_t hash, size_t g, const wh_grip_state_t *state) {
    const int32_t head[] = {6, (int32_t)g, (int32_t)state->phase, state->wafer};
    const wh_edge_wafer_t *lying = &state->lying;
    const double numbers[] = {lying->radius,  lying->x,      lying->y,       lying->depth,
                              lying->opening, lying->bottom, lying->notch_x, lying->notch_y};
    hash = wh_hash_ints(hash, head, 4);
    hash = wh_hash_doubles(hash, &state->s, 1);
    hash = wh_hash_doubles(hash, &state->excess, 1);
    if (state->phase == WH_GRIP_CLOSING && state->wafer != WH_NONE) {
        hash = wh_hash_real(hash, state->x);
        hash = wh_hash_real(hash, state->y);
        hash = wh_hash_doubles(hash, numbers, sizeof numbers / sizeof numbers[0]);
    }
    return hash;
}

static uint64_t hash_grips(uint64_t hash, const wh_physics_state_t *state, size_t gripper_count) {
    for (size_t g = 0; g < gripper_count && g < WH_GRIPPERS; ++g) {
        if (state->grips[g].phase != WH_GRIP_OPEN) {
            hash = hash_grip(hash, g, &state->grips[g]);
        }
    }
    return hash;
}

static uint64_t hash_doors(uint64_t hash, const wh_doors_t *doors) {
    for (int32_t d = 0; d < doors->count; ++d) {
        if (doors->at[d] > 0) {
            const int32_t head[] = {7, d};
            hash = wh_hash_real(wh_hash_ints(hash, head, 2), doors->at[d]);
        }
    }
    return hash;
}

uint64_t wh_physics_state_hash_given(const wh_physics_state_t *state, size_t gripper_count, uint64_t hash) {
    hash = state->scan.number > 0 ? hash_scan(hash, &state->scan) : hash;
    hash = state->latches.number > 0 ? hash_latches(hash, &state->latches) : hash;
    hash = hash_grips(hash, state, gripper_count);
    return hash_doors(hash, &state->doors);
}

uint64_t wh_physics_state_hash(const wh_physics_state_t *state, const wh_grasp_t *table) {
    const uint64_t hash = wh_physics_state_hash_plain(state, table);
    return wh_physics_state_hash_given(state, table->storage.gripper_count, hash);
}
