#include "grasp.h"

#include "../math/hash.h"
#include "grasp_internal.h"
#include "index_internal.h"

wh_grasp_config_t wh_grasp_config_default(void) {
    wh_grasp_config_t config;
    config.tolerance = wh_tolerance_paper();
    config.check = WH_CHECK_SAMPLED;
    config.seat = false;
    config.near_projz = WH_REAL(4.5);
    config.near_projxy = 2 * config.tolerance.projxy;
    return config;
}

static wh_status_t validate_config(const wh_grasp_config_t *config) {
    const bool near_good = config->near_projz > 0 && config->near_projz <= WH_REAL(1e6) &&
                           config->near_projxy > 0 && config->near_projxy <= WH_REAL(1e6);
    if (config->check != WH_CHECK_SAMPLED && config->check != WH_CHECK_SWEPT) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return near_good ? wh_tolerance_validate(&config->tolerance) : WH_STATUS_BAD_TOLERANCE;
}

size_t wh_grasp_buckets(size_t wafer_count, size_t gripper_count) {
    const size_t most = (size_t)INT32_MAX / 16;
    if (!WH_INDEX_BUILT || wafer_count > most || gripper_count > most) {
        return 0;
    }
    return WH_GRASP_BUCKETS(wafer_count, gripper_count);
}

static wh_status_t validate_array(bool given, size_t count) {
    if (!given && count > 0) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    return count > INT32_MAX ? WH_STATUS_BAD_CAPACITY : WH_OK;
}

static wh_status_t validate_buckets(const wh_grasp_storage_t *storage) {
    const wh_status_t status = validate_array(storage->buckets != NULL, storage->bucket_count);
    if (status != WH_OK || storage->bucket_count == 0) {
        return status;
    }
    const size_t needed = wh_grasp_buckets(storage->wafer_count, storage->gripper_count);
    return needed > 0 && needed <= storage->bucket_count ? WH_OK : WH_STATUS_BAD_CAPACITY;
}

static wh_status_t validate_storage(const wh_grasp_storage_t *storage) {
    wh_status_t status = validate_array(storage->wafers != NULL, storage->wafer_count);
    if (status == WH_OK) {
        status = validate_array(storage->grippers != NULL, storage->gripper_count);
    }
    if (status == WH_OK) {
        status = validate_buckets(storage);
    }
    for (size_t w = 0; w < storage->wafer_count && status == WH_OK; ++w) {
        status = wh_pose_validate(&storage->wafers[w].base_from_wafer);
    }
    return status;
}

/* Table and arrays share no byte. */
static bool are_apart(const wh_grasp_t *table, const wh_grasp_storage_t *storage) {
    const size_t used =
        storage->bucket_count > 0 ? wh_grasp_buckets(storage->wafer_count, storage->gripper_count) : 0;
    const wh_extent_t all[] = {{table, sizeof *table},
                               {storage->wafers, storage->wafer_count * sizeof *storage->wafers},
                               {storage->grippers, storage->gripper_count * sizeof *storage->grippers},
                               {storage->buckets, used * sizeof *storage->buckets}};
    bool apart = true;
    for (size_t i = 0; i + 1 < sizeof all / sizeof all[0]; ++i) {
        for (size_t k = i + 1; k < sizeof all / sizeof all[0]; ++k) {
            apart = apart && !wh_extents_overlap(all[i], all[k]);
        }
    }
    return apart;
}

static void clear_encounter(wh_encounter_t *encounter) {
    static const wh_encounter_t zero = {0};
    *encounter = zero;
    encounter->wafer = WH_NONE;
    encounter->holder = WH_NONE;
}

static void clear_gripper(wh_gripper_t *gripper) {
    gripper->base_from_gripper = wh_pose_identity();
    gripper->gripper_from_wafer = wh_pose_identity();
    clear_encounter(&gripper->approach);
    clear_encounter(&gripper->contest);
    gripper->wafer = WH_NONE;
    gripper->valve = WH_VALVE_CLOSED;
}

static void clear_grippers(wh_gripper_t grippers[], size_t count) {
    for (size_t g = 0; g < count; ++g) {
        clear_gripper(&grippers[g]);
    }
}

static void free_wafers(wh_wafer_t wafers[], size_t count) {
    for (size_t w = 0; w < count; ++w) {
        wafers[w].holder = WH_NONE;
        wafers[w].released_by = WH_NONE;
    }
}

static void begin(wh_grasp_t *table, const wh_grasp_config_t *config, const wh_grasp_storage_t *storage) {
    static const wh_grasp_counters_t none = {0};
    table->config = *config;
    table->slice = 0;
    table->counters = none;
    table->storage = *storage;
    table->mark = WH_GRASP_MARK;
    table->grips = 0;
}

wh_status_t wh_grasp_init(wh_grasp_t *table, const wh_grasp_config_t *config,
                          const wh_grasp_storage_t *storage) {
    if (!table || !config || !storage) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = validate_config(config);
    if (status == WH_OK && !wh_grasp_is_built(config, storage->bucket_count)) {
        status = WH_STATUS_NOT_BUILT;
    }
    if (status == WH_OK) {
        status = validate_storage(storage);
    }
    if (status == WH_OK && !are_apart(table, storage)) {
        status = WH_STATUS_OVERLAP;
    }
    if (status != WH_OK) {
        return status;
    }
    begin(table, config, storage);
    free_wafers(storage->wafers, storage->wafer_count);
    clear_grippers(storage->grippers, storage->gripper_count);
    wh_index_build(table);
    WH_ASSERT_CONSISTENT(table);
    return WH_OK;
}

static wh_status_t may_place(const wh_grasp_t *table, size_t wafer, const wh_pose_t *base_from_wafer) {
    if (!base_from_wafer) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (wafer >= table->storage.wafer_count) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    if (table->storage.wafers[wafer].holder != WH_NONE) {
        return WH_STATUS_HELD;
    }
    return wh_pose_validate(base_from_wafer);
}

static void forget(wh_encounter_t *approach, int32_t wafer) {
    if (approach->wafer == wafer) {
        approach->wafer = WH_NONE;
    }
}

wh_status_t wh_grasp_place(wh_grasp_t *table, size_t wafer, const wh_pose_t *base_from_wafer) {
    if (!table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (table->mark != WH_GRASP_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    const wh_status_t status = may_place(table, wafer, base_from_wafer);
    if (status != WH_OK) {
        ++table->counters.refused;
        return status;
    }
    table->storage.wafers[wafer].base_from_wafer = *base_from_wafer;
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        forget(&table->storage.grippers[g].approach, (int32_t)wafer);
    }
    wh_index_move(table, wafer);
    WH_ASSERT_CONSISTENT(table);
    return WH_OK;
}

wh_status_t wh_grasp_wafer(const wh_grasp_t *table, size_t wafer, wh_pose_t *base_from_wafer,
                           int32_t *holder) {
    if (!table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (table->mark != WH_GRASP_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    if (wafer >= table->storage.wafer_count) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    if (base_from_wafer) {
        *base_from_wafer = table->storage.wafers[wafer].base_from_wafer;
    }
    if (holder) {
        *holder = table->storage.wafers[wafer].holder;
    }
    return WH_OK;
}

wh_status_t wh_grasp_held(const wh_grasp_t *table, size_t gripper, int32_t *wafer) {
    if (!table || !wafer) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (table->mark != WH_GRASP_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    if (gripper >= table->storage.gripper_count) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    *wafer = table->storage.grippers[gripper].wafer;
    return WH_OK;
}

static bool is_paired_wafer(const wh_grasp_storage_t *storage, size_t w) {
    const wh_wafer_t *wafer = &storage->wafers[w];
    if (wafer->holder == WH_NONE) {
        return true;
    }
    return wh_is_index(wafer->holder, storage->gripper_count) &&
           storage->grippers[wafer->holder].wafer == (int32_t)w;
}

static bool is_paired_gripper(const wh_grasp_storage_t *storage, size_t g) {
    const wh_gripper_t *gripper = &storage->grippers[g];
    if (gripper->wafer == WH_NONE) {
        return true;
    }
    return wh_is_index(gripper->wafer, storage->wafer_count) &&
           storage->wafers[gripper->wafer].holder == (int32_t)g;
}

static bool names_wafer_or_none(const wh_encounter_t *encounter, size_t wafer_count) {
    return encounter->wafer == WH_NONE || wh_is_index(encounter->wafer, wafer_count);
}

bool wh_grasp_is_consistent(const wh_grasp_t *table) {
    const wh_grasp_storage_t *storage = &table->storage;
    if (table->mark != WH_GRASP_MARK) {
        return false;
    }
    for (size_t w = 0; w < storage->wafer_count; ++w) {
        if (!is_paired_wafer(storage, w) || storage->wafers[w].released_by != WH_NONE) {
            return false;
        }
    }
    for (size_t g = 0; g < storage->gripper_count; ++g) {
        if (!is_paired_gripper(storage, g) ||
            !names_wafer_or_none(&storage->grippers[g].approach, storage->wafer_count) ||
            !names_wafer_or_none(&storage->grippers[g].contest, storage->wafer_count)) {
            return false;
        }
    }
    return true;
}

static uint64_t hash_encounter(uint64_t hash, const wh_encounter_t *encounter) {
    hash = wh_hash_int(hash, encounter->wafer);
    if (encounter->wafer == WH_NONE) {
        return hash;
    }
    const wh_proximity_t *p = &encounter->measured;
    hash = wh_hash_int(hash, encounter->holder);
    hash = wh_hash_word(hash, wh_encounter_stamp(encounter));
    hash = wh_hash_vec3(hash, &p->dr);
    hash = wh_hash_real(hash, p->n1_proj_n2);
    hash = wh_hash_real(hash, p->dr_proj_z);
    hash = wh_hash_vec3(hash, &p->dr_proj_xy);
    return wh_hash_real(hash, p->dr_proj_xy_norm);
}

static uint64_t hash_gripper(uint64_t hash, const wh_gripper_t *gripper) {
    hash = wh_hash_pose(hash, &gripper->base_from_gripper);
    hash = wh_hash_int(hash, gripper->valve);
    hash = wh_hash_int(hash, gripper->wafer);
    if (gripper->wafer != WH_NONE) {
        hash = wh_hash_pose(hash, &gripper->gripper_from_wafer);
    }
    hash = hash_encounter(hash, &gripper->approach);
    return hash_encounter(hash, &gripper->contest);
}

uint64_t wh_grasp_hash(const wh_grasp_t *table) {
    uint64_t hash = wh_hash_word(WH_HASH_START, table->slice);
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        hash = wh_hash_pose(hash, &table->storage.wafers[w].base_from_wafer);
        hash = wh_hash_int(hash, table->storage.wafers[w].holder);
    }
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        hash = hash_gripper(hash, &table->storage.grippers[g]);
    }
    return hash;
}
