#include "../math/hash.h"
#include "layout.h"

static uint64_t hash_text(uint64_t hash, const char *text) {
    for (const char *c = text; *c; ++c) {
        hash = wh_hash_word(hash, (unsigned char)*c);
    }
    return wh_hash_word(hash, 0);
}

static uint64_t hash_reals(uint64_t hash, const wh_real_t reals[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        hash = wh_hash_real(hash, reals[i]);
    }
    return hash;
}

static uint64_t hash_limits(uint64_t hash, const wh_limits_t *limits) {
    return hash_reals(hash, (const wh_real_t[]){limits->speed, limits->acceleration, limits->jerk}, 3);
}

static uint64_t hash_checks(uint64_t hash, const wh_layout_t *layout) {
    const wh_grasp_config_t *grasp = &layout->grasp;
    const wh_real_t reals[] = {grasp->tolerance.projz, grasp->tolerance.projxy, grasp->tolerance.planar,
                               grasp->near_projz, grasp->near_projxy};
    hash = hash_reals(hash, reals, sizeof reals / sizeof reals[0]);
    hash = wh_hash_int(hash, (int32_t)grasp->check);
    hash = wh_hash_int(hash, grasp->seat ? 1 : 0);
    return wh_hash_word(hash, (uint64_t)layout->slice_us);
}

static uint64_t hash_machine(uint64_t hash, const wh_layout_t *layout) {
    const wh_machine_t *machine = &layout->machine;
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const wh_travel_t *travel = &machine->robot.travel[axis];
        hash = hash_reals(hash, (const wh_real_t[]){travel->min, travel->max, machine->robot.home[axis]}, 3);
        hash = hash_limits(hash, &machine->robot.limits[axis]);
    }
    hash = hash_limits(hash, &machine->chuck_limits);
    if (layout->transit > 0) {
        hash = wh_hash_real(hash_text(hash, "transit"), layout->transit);
    }
    hash = wh_hash_word(hash, machine->axis_count);
    hash = wh_hash_word(hash, machine->gripper_count);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        hash = hash_text(hash, layout->grippers[g].name);
        hash = wh_hash_int(hash, machine->mounts[g].axis);
        hash = wh_hash_pose(hash, &machine->mounts[g].base_from_station);
        if (machine->mounts[g].is_shifted) {
            hash = wh_hash_pose(hash, &machine->mounts[g].effector_from_gripper);
        }
    }
    return hash;
}

static uint64_t hash_stations(uint64_t hash, const wh_layout_t *layout) {
    hash = wh_hash_word(hash, layout->station_count);
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_station_t *place = &layout->places[s];
        hash = hash_text(hash, layout->stations[s].name);
        hash = wh_hash_pose(hash, &place->base_from_station);
        hash = wh_hash_int(hash, place->slots);
        hash = wh_hash_real(hash, place->pitch);
        hash = wh_hash_int(hash, place->chuck);
    }
    return hash;
}

/* Only what is set, so that layouts without it keep their hash. */
static uint64_t hash_placing(uint64_t hash, const wh_cell_t *cell) {
    if (cell->settle || cell->off_centre > 0 || cell->askew > 0) {
        hash = wh_hash_int(hash, cell->settle ? 1 : 0);
        hash = wh_hash_real(hash, cell->off_centre);
        hash = wh_hash_real(hash, cell->askew);
    }
    return hash;
}

/* Only what differs from the paper's gripper, so that a layout without these sections keeps its hash. */
static uint64_t hash_vacuum(uint64_t hash, const wh_vacuum_config_t *vacuum) {
    const wh_vacuum_config_t ideal = wh_vacuum_ideal();
    const wh_real_t values[] = {vacuum->build, vacuum->vent, vacuum->idle,
                                vacuum->on,    vacuum->off,  vacuum->release};
    const wh_real_t usual[] = {ideal.build, ideal.vent, ideal.idle, ideal.on, ideal.off, ideal.release};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        if (values[i] != usual[i]) {
            hash = wh_hash_real(hash_text(hash, "vacuum"), values[i]);
            hash = wh_hash_word(hash, i);
        }
    }
    return hash;
}

static uint64_t hash_pads(uint64_t hash, const wh_pads_t *pads) {
    if (pads->mass > 0) {
        hash = hash_text(hash, "pads");
        const wh_real_t reals[] = {pads->friction, pads->force, pads->mass, pads->gravity};
        hash = hash_reals(hash, reals, 4);
    }
    return hash;
}

static uint64_t hash_fault(uint64_t hash, const wh_fault_t *fault) {
    hash = hash_text(hash, wh_fault_name(fault->kind));
    hash = wh_hash_int(hash, fault->target);
    hash = wh_hash_int(hash, fault->other);
    hash = wh_hash_real(hash, fault->value);
    hash = wh_hash_pose(hash, &fault->offset);
    hash = wh_hash_word(hash, (uint64_t)fault->from);
    return wh_hash_word(hash, (uint64_t)fault->until);
}

/* Recordings and messages carry this hash: what is new goes behind, and only where it differs from the
 * default. */
uint64_t wh_layout_hash(const wh_layout_t *layout) {
    uint64_t hash = hash_checks(WH_HASH_START, layout);
    hash = hash_machine(hash, layout);
    hash = hash_stations(hash, layout);
    hash = wh_hash_word(hash, layout->wafer_count);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        hash = hash_text(hash, layout->wafers[w].name);
        hash = wh_hash_pose(hash, &layout->start[w].base_from_wafer);
    }
    hash = hash_vacuum(hash, &layout->physics.vacuum);
    hash = hash_pads(hash, &layout->physics.pads);
    for (size_t i = 0; i < layout->physics.fault_count; ++i) {
        hash = hash_fault(hash, &layout->physics.faults[i]);
    }
    hash = hash_placing(hash, &layout->cell);
    if (layout->scanner_count > 0) {
        const wh_scanning_t scanning = wh_layout_scanning(layout);
        hash = wh_scanning_hash(&scanning, layout->wafer_count, hash_text(hash, "sensor"));
    }
    if (layout->beam_count > 0) {
        const wh_latching_t latching = wh_layout_latching(layout);
        hash = wh_latching_hash(&latching, layout->machine.gripper_count, layout->wafer_count,
                                hash_text(hash, "beams"));
    }
    return hash;
}
