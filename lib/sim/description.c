/* The description of a simulator, as a hash: a snapshot tells its simulator by it. */
#include "description_internal.h"

#include "../math/hash.h"

static uint64_t hash_tolerance(uint64_t hash, const wh_tolerance_t *tolerance) {
    hash = wh_hash_real(hash, tolerance->projz);
    hash = wh_hash_real(hash, tolerance->projxy);
    return wh_hash_real(hash, tolerance->planar);
}

static uint64_t hash_config(uint64_t hash, const wh_grasp_config_t *config) {
    hash = hash_tolerance(hash, &config->tolerance);
    hash = wh_hash_int(hash, (int32_t)config->check);
    hash = wh_hash_int(hash, config->seat ? 1 : 0);
    hash = wh_hash_real(hash, config->near_projz);
    return wh_hash_real(hash, config->near_projxy);
}

static uint64_t hash_physics(uint64_t hash, const wh_simulator_t *simulator) {
    const wh_vacuum_config_t *vacuum = &simulator->vacuum;
    const wh_pads_t *pads = &simulator->pads;
    const wh_real_t values[] = {simulator->slice_s, vacuum->build, vacuum->vent,    vacuum->idle,
                                vacuum->on,         vacuum->off,   vacuum->release, pads->friction,
                                pads->force,        pads->mass,    pads->gravity};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        hash = wh_hash_real(hash, values[i]);
    }
    return vacuum->debounce > 0 ? wh_hash_int(hash, vacuum->debounce) : hash;
}

static uint64_t hash_cell(uint64_t hash, const wh_cell_t *cell) {
    hash = hash_tolerance(hash, &cell->tolerance);
    hash = wh_hash_real(hash, cell->off_centre);
    hash = wh_hash_real(hash, cell->askew);
    hash = wh_hash_int(hash, cell->settle ? 1 : 0);
    hash = cell->drop > 0 ? wh_hash_real(hash, cell->drop) : hash;
    hash = cell->thickness > 0 ? wh_hash_real(wh_hash_int(hash, 2), cell->thickness) : hash;
    for (size_t s = 0; s < cell->count; ++s) {
        hash = wh_hash_pose(hash, &cell->stations[s].base_from_station);
        hash = wh_hash_int(hash, cell->stations[s].slots);
        hash = wh_hash_real(hash, cell->stations[s].pitch);
        hash = wh_hash_int(hash, cell->stations[s].chuck);
    }
    return hash;
}

uint64_t wh_simulator_describe(const wh_simulator_t *simulator) {
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    uint64_t hash = hash_config(WH_HASH_START, &simulator->table.config);
    hash = hash_physics(hash, simulator);
    hash = hash_cell(hash, &simulator->cell);
    hash = wh_hash_word(hash, (uint64_t)storage->wafer_count);
    hash = wh_hash_word(hash, (uint64_t)storage->gripper_count);
    hash = simulator->given.gripping ? simulator->given.gripping->hash(&simulator->given.grips, hash) : hash;
    hash = simulator->given.moving ? simulator->given.moving->hash(&simulator->given.doors, hash) : hash;
    hash = simulator->given.scans
               ? simulator->given.scans->hash(&simulator->given.scanning, storage->wafer_count, hash)
               : hash;
    return simulator->given.beams
               ? simulator->given.beams->hash(&simulator->given.latching, storage->gripper_count,
                                              storage->wafer_count, hash)
               : hash;
}
