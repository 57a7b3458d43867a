#include "gripping.h"

#include <string.h>

#include "../grasp/passive.h"
#include "../math/hash.h"
#include "setting_internal.h"
#include "simulator.h"

/* True if even the full vacuum cannot carry a wafer's weight below pads that look down. */
static bool drops(const wh_pads_t *pads, const wh_mat3_t *base_from_gripper) {
    return pads->mass > 0 && pads->force < -pads->mass * pads->gravity * base_from_gripper->m[2][2];
}

static wh_grip_kind_t kind_of(const wh_simulator_t *simulator, size_t g) {
    return simulator->given.grips.parts.grips[g].kind;
}

/* A copy of a simulator has its own table, and states of its own. Pads that cannot carry count as
 * closed. */
static wh_status_t step(void *of, const wh_gripper_input_t inputs[], wh_event_list_t *list) {
    wh_simulator_t *simulator = of;
    wh_gripper_input_t *acting = simulator->inputs;
    double speeds[WH_GRIPPERS];
    const size_t count = simulator->table.storage.gripper_count;
    if (inputs != acting) {
        memcpy(acting, inputs, count * sizeof *acting);
    }
    for (size_t g = 0; g < count; ++g) {
        if (acting[g].valve == WH_VALVE_OPEN && kind_of(simulator, g) == WH_GRIP_VACUUM &&
            drops(&simulator->pads, &acting[g].base_from_gripper.R)) {
            acting[g].valve = WH_VALVE_CLOSED;
        }
        speeds[g] = wh_faults_plunger(&simulator->physics.faults, g);
    }
    simulator->given.grips.table = &simulator->table;
    simulator->given.grips.parts.states = simulator->physics.grips;
    simulator->given.grips.parts.speeds = speeds;
    const wh_status_t status = wh_grips_step(&simulator->given.grips, acting, list);
    simulator->given.grips.parts.speeds = NULL;
    return status;
}

/* The sensor is off while a plunger moves through its window. */
static bool senses(const wh_simulator_t *simulator, size_t g) {
    const wh_edge_t *edge = &simulator->given.grips.parts.grips[g].edge;
    const wh_grip_state_t *state = &simulator->physics.grips[g];
    return kind_of(simulator, g) == WH_GRIP_EDGE
               ? (state->phase == WH_GRIP_CLOSED || state->phase == WH_GRIP_JAMMED) &&
                     state->s >= edge->gripped_from && state->s <= edge->gripped_to
               : simulator->table.storage.grippers[g].wafer != WH_NONE;
}

static void sense(void *of) {
    wh_simulator_t *simulator = of;
    for (size_t g = 0; g < simulator->table.storage.gripper_count; ++g) {
        if (kind_of(simulator, g) != WH_GRIP_VACUUM) {
            simulator->physics.vacuum[g].level = 0;
            simulator->physics.vacuum[g].on = senses(simulator, g);
        }
    }
}

static wh_status_t complete(const void *of, const wh_gripper_t grippers[], wh_grip_state_t states[]) {
    const wh_simulator_t *simulator = of;
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    return wh_grips_complete(&simulator->given.grips.parts, grippers, storage->gripper_count,
                             storage->wafer_count, states);
}

/* True if the wafer of this gripper, whose pads look down, still lies in its slot: nothing hangs on
 * them. */
static bool lies_below(const wh_simulator_t *simulator, const wh_gripper_t *gripper) {
    const wh_pose_t *wafer = &simulator->table.storage.wafers[gripper->wafer].base_from_wafer;
    return gripper->base_from_gripper.R.m[2][2] < 0 && wh_cell_stops(&simulator->cell, wafer, wafer);
}

static bool carries(void *of, size_t g, wh_hold_t *hold) {
    wh_simulator_t *simulator = of;
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    const wh_gripper_t *gripper = &storage->grippers[g];
    const wh_grip_kind_t kind = kind_of(simulator, g);
    const wh_pads_t pads = kind == WH_GRIP_PASSIVE ? wh_passive_pads(&simulator->pads) : simulator->pads;
    const wh_vec3_t *centre =
        gripper->wafer == WH_NONE || kind == WH_GRIP_EDGE || lies_below(simulator, gripper)
            ? NULL
            : &storage->wafers[gripper->wafer].base_from_wafer.r;
    return pads.mass > 0 &&
           wh_carry_update(&simulator->physics.carry[g], &pads, simulator->physics.vacuum[g].level,
                           &gripper->base_from_gripper.R, centre, simulator->slice_s, hold);
}

static uint64_t hash_edge(uint64_t hash, const wh_edge_t *edge) {
    const double numbers[] = {edge->radius,    edge->rest,      edge->plunger,      edge->alpha,
                              edge->clearance, edge->retracted, edge->gripped_from, edge->gripped_to,
                              edge->end,       edge->speed};
    return wh_hash_doubles(hash, numbers, sizeof numbers / sizeof numbers[0]);
}

static uint64_t hash_shape(uint64_t hash, const wh_edge_wafer_t *shape) {
    const double numbers[] = {shape->radius, shape->depth,   shape->opening,
                              shape->bottom, shape->notch_x, shape->notch_y};
    return wh_hash_doubles(hash, numbers, sizeof numbers / sizeof numbers[0]);
}

uint64_t wh_gripping_hash(const wh_grips_parts_t *parts, size_t gripper_count, size_t wafer_count,
                          uint64_t hash) {
    bool has_edge = false;
    for (size_t g = 0; g < gripper_count; ++g) {
        hash = wh_hash_int(hash, (int32_t)parts->grips[g].kind);
        if (parts->grips[g].kind == WH_GRIP_EDGE) {
            hash = hash_edge(hash, &parts->grips[g].edge);
            has_edge = true;
        }
    }
    for (size_t w = 0; has_edge && w < wafer_count; ++w) {
        hash = hash_shape(hash, &parts->shapes[w]);
    }
    for (size_t s = 0; s < parts->support_count; ++s) {
        hash = wh_hash_pose(hash, &parts->supports[s]);
    }
    return hash;
}

static uint64_t hash_parts(const wh_grips_t *grips, uint64_t hash) {
    const wh_grasp_storage_t *storage = &grips->table->storage;
    hash = wh_hash_real(hash, grips->parts.thickness);
    return wh_gripping_hash(&grips->parts, storage->gripper_count, storage->wafer_count, hash);
}

static uint32_t mask_without_vacuum(const wh_simulator_t *simulator) {
    uint32_t mask = 0;
    for (size_t g = 0; g < simulator->table.storage.gripper_count; ++g) {
        mask |= kind_of(simulator, g) == WH_GRIP_VACUUM ? 0 : UINT32_C(1) << g;
    }
    return mask;
}

wh_status_t wh_simulator_set_grips(wh_simulator_t *simulator, const wh_grips_parts_t *parts) {
    static const wh_gripping_calls_t calls = {step, sense, carries, complete, hash_parts};
    wh_status_t status = wh_simulator_check_setting(simulator, parts);
    if (status != WH_OK) {
        return status;
    }
    const wh_real_t apart = parts->thickness - simulator->cell.thickness;
    if (apart > 0 || apart < 0 || !wh_is_slice(simulator->slice_s, parts->dt)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_grips_parts_t own = *parts;
    own.states = simulator->physics.grips;
    own.speeds = NULL;
    status = wh_grips_init(&simulator->given.grips, &own, &simulator->table);
    if (status == WH_OK) {
        simulator->given.gripping = &calls;
        simulator->given.no_vacuum = mask_without_vacuum(simulator);
        simulator->given.hash = wh_physics_state_hash_given;
    }
    return status;
}
