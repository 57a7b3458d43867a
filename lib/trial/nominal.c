#include "nominal.h"

#include <string.h>

#include "../grasp/restore.h"

size_t wh_nominal_bytes(const wh_layout_t *layout) {
    return (sizeof(wh_nominal_t) + (2 * layout->wafer_count + wh_layout_seen(layout)) * sizeof(wh_wafer_t) +
            15) /
           16 * 16;
}

wh_nominal_t *wh_nominal_begin(void *memory, const wh_layout_t *layout, const wh_layout_t *real) {
    wh_nominal_t *nominal = memory;
    memset(nominal, 0, wh_nominal_bytes(layout));
    nominal->layout = layout;
    nominal->real = real;
    nominal->next = &nominal->wafers[layout->wafer_count];
    nominal->grips.seen = &nominal->wafers[2 * layout->wafer_count];
    const wh_grasp_storage_t storage = {.wafers = nominal->wafers,
                                        .wafer_count = layout->wafer_count,
                                        .grippers = nominal->grippers,
                                        .gripper_count = layout->machine.gripper_count};
    memcpy(nominal->wafers, layout->start, layout->wafer_count * sizeof *nominal->wafers);
    const bool good =
        wh_simulator_init(&nominal->simulator, &layout->grasp, &storage, &layout->cell) == WH_OK &&
        wh_layout_give_grips(layout, &nominal->simulator, &nominal->grips) == WH_OK;
    return good ? nominal : NULL;
}

void wh_nominal_slice(wh_nominal_t *nominal, const wh_command_t *command) {
    wh_command_t taught = *command;
    wh_state_t state;
    taught.fault_count = 0;
    wh_machine_update(&nominal->layout->machine, command->axes, &nominal->cache, taught.grippers);
    for (size_t g = 0; g < command->gripper_count; ++g) {
        taught.grippers[g].valve = command->grippers[g].valve;
    }
    (void)wh_simulator_step(&nominal->simulator, &taught, &state);
}

/* ---------------------------------------------------------------------------------------------- believing */

static bool lies_in_the_same_slot(const wh_nominal_t *nominal, const wh_pose_t *believed,
                                  const wh_pose_t *truth) {
    wh_place_t here;
    wh_place_t there;
    const bool is_here = wh_cell_locate(&nominal->layout->cell, believed, &here);
    const bool is_there = wh_cell_locate(&nominal->real->cell, truth, &there);
    return is_here == is_there && (!is_here || (here.station == there.station && here.slot == there.slot));
}

static bool agrees_with_truth(const wh_nominal_t *nominal, size_t w, const wh_state_t *truth) {
    const wh_wafer_t *believed = &nominal->wafers[w];
    const wh_wafer_t *real = &truth->wafers[w];
    return believed->holder == real->holder &&
           (real->holder != WH_NONE ||
            lies_in_the_same_slot(nominal, &believed->base_from_wafer, &real->base_from_wafer));
}

/* The middle of the wafer's slot as taught; a wafer that lies in no slot stays where it is. */
static wh_pose_t taught_place(const wh_nominal_t *nominal, const wh_pose_t *truth) {
    wh_place_t place;
    wh_pose_t taught = *truth;
    if (wh_cell_locate(&nominal->real->cell, truth, &place)) {
        const wh_pose_t slot = wh_station_slot(&nominal->layout->places[place.station], place.slot);
        wh_face_frame(&slot, nominal->layout->cell.thickness, place.face, &taught);
    }
    return taught;
}

/* Copies the gripper of the true cell, at its believed place; encounters in progress are not copied. */
static void correct_gripper(wh_gripper_t *gripper, const wh_gripper_t *real) {
    const wh_pose_t base_from_gripper = gripper->base_from_gripper;
    *gripper = *real;
    gripper->base_from_gripper = base_from_gripper;
    memset(&gripper->approach, 0, sizeof gripper->approach);
    gripper->approach.wafer = gripper->approach.holder = WH_NONE;
    gripper->contest = gripper->approach;
}

/* False if no table can be in that state. */
static bool correct_nominal(wh_nominal_t *nominal, const wh_state_t *truth) {
    const wh_grasp_t *table = &nominal->simulator.table;
    memcpy(nominal->next, nominal->wafers, truth->wafer_count * sizeof *nominal->next);
    memcpy(nominal->next_grippers, nominal->grippers, sizeof nominal->next_grippers);
    for (size_t g = 0; g < truth->gripper_count; ++g) {
        correct_gripper(&nominal->next_grippers[g], nominal->grippers[g].wafer == truth->grippers[g].wafer
                                                        ? &nominal->grippers[g]
                                                        : &truth->grippers[g]);
    }
    for (size_t w = 0; w < truth->wafer_count; ++w) {
        const int32_t holder = truth->wafers[w].holder;
        if (agrees_with_truth(nominal, w, truth)) {
            continue;
        }
        nominal->next[w] = truth->wafers[w];
        const wh_gripper_t *gripper = holder == WH_NONE ? NULL : &nominal->next_grippers[holder];
        nominal->next[w].base_from_wafer =
            gripper ? wh_pose_compose(&gripper->base_from_gripper, &gripper->gripper_from_wafer)
                    : taught_place(nominal, &truth->wafers[w].base_from_wafer);
    }
    return wh_grasp_restore(&nominal->simulator.table, table->slice, nominal->next, nominal->next_grippers) ==
           WH_OK;
}

/* A plunger's sensors tell its phase. */
static void correct_grips(wh_nominal_t *nominal, const wh_state_t *truth) {
    wh_grip_state_t *grips = nominal->simulator.physics.grips;
    for (size_t g = 0; g < truth->gripper_count; ++g) {
        if (grips[g].phase != truth->physics->grips[g].phase) {
            grips[g] = truth->physics->grips[g];
        }
    }
}

void wh_nominal_believe(wh_nominal_t *nominal, const wh_state_t *truth, wh_state_t *believed) {
    bool all = true;
    for (size_t w = 0; all && w < truth->wafer_count; ++w) {
        all = agrees_with_truth(nominal, w, truth);
    }
    *believed = *truth;
    if (!all && !correct_nominal(nominal, truth)) {
        return;
    }
    correct_grips(nominal, truth);
    believed->physics = &nominal->simulator.physics;
    believed->wafers = nominal->wafers;
    believed->grippers = nominal->grippers;
}
