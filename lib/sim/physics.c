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
        state->grips[g].wafer = WH_NONE;
    }
    for (size_t i = 0; physics && i < physics->fault_count; ++i) {
        const wh_fault_request_t request = {(int32_t)i, physics->faults[i]};
        wh_faults_take(&state->faults, &request, 1);
    }
}

uint32_t wh_physics_state_sensors(const wh_physics_state_t *state, size_t gripper_count) {
    uint32_t sensors = 0;
    for (size_t g = 0; g < gripper_count && g < WH_GRIPPERS; ++g) {
        sensors |= state->vacuum[g].on ? 1U << g : 0U;
    }
    return wh_faults_sensors(&state->faults, sensors);
}

/* --------------------------------------------------------------------------------------------------- hash */

/* It is out of line, because a small copy matters more than a fast one in this file. */
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
    return vacuum->command == gripper->valve && vacuum->on == holds && vacuum->level == (holds ? 1 : 0) &&
           vacuum->waits == 0;
}

static uint64_t hash_vacuum(uint64_t hash, size_t g, const wh_vacuum_t *vacuum) {
    const int32_t head[] = {1, (int32_t)g};
    const int32_t rest[] = {vacuum->command, vacuum->on ? 1 : 0};
    hash = hash_ints(hash, head, 2);
    const int32_t debounce[] = {8, (int32_t)g, vacuum->waits};
    hash = hash_real(hash, vacuum->level);
    hash = hash_ints(hash, rest, 2);
    return vacuum->waits > 0 ? hash_ints(hash, debounce, 3) : hash;
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

uint64_t wh_physics_state_hash_plain(const wh_physics_state_t *state, const wh_grasp_t *table) {
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
    return hash;
}
