#include "doors.h"

#include <string.h>

#include "../math/hash.h"
#include "setting_internal.h"

wh_door_set_t wh_door_set(const wh_machine_t *machine) {
    const wh_door_set_t set = {machine->doors, machine->door_count, wh_machine_door_axis(machine, 0)};
    return set;
}

void wh_doors_start(const wh_door_set_t *set, wh_doors_t *doors) {
    memset(doors, 0, sizeof *doors);
    doors->count = (int32_t)set->count;
    for (size_t d = 0; d < set->count; ++d) {
        doors->at[d] = wh_door_home(&set->doors[d]);
    }
}

/* Commands of a healthy door exceed its speed by rounding alone. */
#define ROUNDING WH_REAL(1.001)

/* The greatest way of the door in this slice, mm. */
static wh_real_t most_of(const wh_door_t *door, int32_t d, const wh_faults_t *faults, wh_real_t slice_s) {
    wh_real_t speed = door->limits.speed * ROUNDING;
    for (size_t i = 0; i < faults->count; ++i) {
        const wh_fault_t *fault = &faults->slots[i].fault;
        const bool is_its = fault->kind == WH_FAULT_COMMAND_LOST || fault->target == d;
        if (faults->slots[i].phase != WH_FAULT_ACTING || !is_its) {
            continue;
        }
        if (fault->kind == WH_FAULT_COMMAND_LOST || fault->kind == WH_FAULT_DOOR_STUCK) {
            speed = 0;
        } else if (fault->kind == WH_FAULT_DOOR_SLOW && fault->value < speed) {
            speed = fault->value;
        }
    }
    return speed * slice_s;
}

void wh_doors_step(const wh_door_set_t *set, const wh_faults_t *faults, const wh_real_t axes[],
                   size_t axis_count, wh_real_t slice_s, wh_doors_t *doors) {
    for (size_t d = 0; d < set->count && set->first + d < axis_count; ++d) {
        const wh_real_t most = most_of(&set->doors[d], (int32_t)d, faults, slice_s);
        const wh_real_t apart = axes[set->first + d] - doors->at[d];
        if (wh_real_abs(apart) <= most) {
            doors->at[d] = axes[set->first + d];
        } else if (wh_real_is_finite(apart)) {
            doors->at[d] += apart > 0 ? most : -most;
        }
    }
}

uint64_t wh_door_set_hash(const wh_door_set_t *set, uint64_t hash) {
    for (size_t d = 0; d < set->count; ++d) {
        const wh_door_t *door = &set->doors[d];
        hash = wh_hash_vec3(hash, &door->way);
        hash = wh_hash_real(hash, door->travel);
        hash = wh_hash_real(hash, door->limits.speed);
        hash = wh_hash_int(hash, door->is_open ? 1 : 0);
    }
    return hash;
}

/* ----------------------------------------------------------------------------------------- in a simulator */

static void step(void *of, const void *by) {
    wh_simulator_t *simulator = of;
    const wh_command_t *command = by;
    wh_doors_step(&simulator->given.doors, &simulator->physics.faults, command->axes, command->axis_count,
                  simulator->slice_s, &simulator->physics.doors);
}

wh_status_t wh_simulator_set_doors(wh_simulator_t *simulator, const wh_door_set_t *set) {
    static const wh_doors_calls_t calls = {step, wh_door_set_hash};
    const wh_status_t status = wh_simulator_check_setting(simulator, set);
    if (status != WH_OK) {
        return status;
    }
    if (set->count > WH_DOORS || (set->count > 0 && !set->doors)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    simulator->given.doors = *set;
    simulator->given.moving = set->count > 0 ? &calls : NULL;
    simulator->given.hash = wh_physics_state_hash_given;
    wh_doors_start(set, &simulator->physics.doors);
    return WH_OK;
}
