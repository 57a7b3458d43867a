#include "horizon_internal.h"

#define NO_WAFER UINT32_MAX

/* A cell's shortest edge as a power of two of the unit: 16 mm. */
#define SMALLEST 10U

static uint32_t *heads_of(const wh_grasp_t *table) {
    return &table->storage.buckets[WH_INDEX_HORIZONS + WH_HORIZON_WORDS * table->storage.gripper_count];
}

static uint32_t *node_of(const wh_grasp_t *table, size_t w) {
    return heads_of(table) + 2 * (table->storage.wafer_count + w);
}

/* A distance in units, rounded up, at most half of a word. */
static uint32_t units_of(wh_real_t mm) {
    const uint32_t most = UINT32_C(1) << 30;
    const uint32_t units = (uint32_t)wh_index_whole(WH_INDEX_UNITS * mm + 1);
    return units < most ? units : most;
}

/* A place along an axis in units, counted upwards from 2^31 below zero. A larger place gives a larger
 * number, and the difference of two does not exceed their distance, except for rounding to units. */
static uint32_t place_of(wh_real_t mm) {
    return (UINT32_C(1) << 31) + (uint32_t)wh_index_whole(WH_INDEX_UNITS * mm);
}

static uint32_t key_of(uint32_t x, uint32_t y, uint32_t z) {
    uint32_t key = x * UINT32_C(0x9e3779b1) + y * UINT32_C(0x85ebca77) + z * UINT32_C(0xc2b2ae3d);
    key = (key ^ (key >> 15)) * UINT32_C(0x2c1b3c6d);
    return key ^ (key >> 13);
}

/* Maps a key to one of `count` numbers. */
static size_t share_of(uint32_t key, uint64_t count) {
    return (size_t)((key * count) >> 32);
}

static uint32_t *head_of(const wh_grasp_t *table, uint32_t key) {
    return &heads_of(table)[share_of(key, 2 * (uint64_t)table->storage.wafer_count)];
}

static uint32_t shift_of(const wh_grasp_t *table, size_t axis) {
    return table->storage.buckets[WH_INDEX_SHIFTS + axis] & 31;
}

static uint32_t key_at(const wh_grasp_t *table, const wh_vec3_t *r) {
    return key_of(place_of(r->x) >> shift_of(table, 0), place_of(r->y) >> shift_of(table, 1),
                  place_of(r->z) >> shift_of(table, 2));
}

/* The reach of a disc of this radius and half this height along an axis of base; a rotation that is almost
 * one lets it reach a little farther. */
static void widen(wh_grasp_t *table, const wh_mat3_t *R, const wh_near_limits_t *limits) {
    const wh_real_t loose = 8 * WH_ROTATION_TOLERANCE * (limits->projz + limits->projxy);
    for (size_t axis = 0; axis < 3; ++axis) {
        const wh_real_t *row = R->m[axis];
        const wh_real_t reach = wh_real_abs(row[2]) * limits->projz +
                                wh_real_sqrt(row[0] * row[0] + row[1] * row[1]) * limits->projxy;
        const uint32_t extent = units_of(reach + loose);
        uint32_t *widest = &table->storage.buckets[WH_INDEX_EXTENTS + axis];
        *widest = extent > *widest ? extent : *widest;
    }
}

/* A cell is as long as the widest neighbourhood, so that a search checks two along an axis. It is longer if
 * wafers that are put down tilted later would need too many cells. */
static void choose_edges(wh_grasp_t *table, const wh_near_limits_t *limits) {
    const uint32_t large = units_of((limits->projz + limits->projxy) / 8);
    for (size_t axis = 0; axis < 3; ++axis) {
        const uint32_t extent = table->storage.buckets[WH_INDEX_EXTENTS + axis];
        uint32_t shift = SMALLEST;
        for (uint32_t edge = SMALLEST; edge < 31; ++edge) {
            shift += (1U << edge) / 2 < extent || (1U << edge) < large ? 1 : 0;
        }
        table->storage.buckets[WH_INDEX_SHIFTS + axis] = shift;
    }
}

static void insert(wh_grasp_t *table, size_t w) {
    uint32_t *node = node_of(table, w);
    node[1] = key_at(table, &table->storage.wafers[w].base_from_wafer.r);
    uint32_t *head = head_of(table, node[1]);
    node[0] = *head;
    *head = (uint32_t)w;
}

static void take_out(wh_grasp_t *table, size_t w) {
    uint32_t *link = head_of(table, node_of(table, w)[1]);
    for (size_t i = 0; i < table->storage.wafer_count && *link < table->storage.wafer_count; ++i) {
        if (*link == w) {
            *link = node_of(table, w)[0];
            return;
        }
        link = node_of(table, *link);
    }
}

void wh_index_fill(wh_grasp_t *table) {
    const wh_grasp_storage_t *storage = &table->storage;
    const wh_near_limits_t limits = wh_index_limits(table);
    storage->buckets[0] = 0;
    storage->buckets[1] = 0;
    storage->buckets[2] = 0;
    storage->buckets[WH_INDEX_FOUND] = UINT32_MAX;
    for (size_t w = 0; w < storage->wafer_count; ++w) {
        widen(table, &storage->wafers[w].base_from_wafer.R, &limits);
        heads_of(table)[2 * w] = NO_WAFER;
        heads_of(table)[2 * w + 1] = NO_WAFER;
    }
    choose_edges(table, &limits);
    for (size_t w = 0; w < storage->wafer_count; ++w) {
        insert(table, w);
    }
    wh_horizon_reset(table);
}

void wh_index_reinsert(wh_grasp_t *table, size_t wafer) {
    const wh_near_limits_t limits = wh_index_limits(table);
    take_out(table, wafer);
    insert(table, wafer);
    widen(table, &table->storage.wafers[wafer].base_from_wafer.R, &limits);
    wh_horizon_reset(table);
}

/* A box of cells, from the first one along each axis. */
typedef struct {
    uint32_t first[3], count[3];
} box_t;

/* Returns false when there are more than `most` cells along this axis. Two units are added for the rounding
 * of the two places. */
static bool span(const wh_grasp_t *table, box_t *box, size_t axis, wh_real_t from, wh_real_t to,
                 uint32_t margin, size_t most) {
    const uint32_t extent = table->storage.buckets[WH_INDEX_EXTENTS + axis] & (uint32_t)INT32_MAX;
    const uint32_t half = extent + margin + 2;
    const uint32_t shift = shift_of(table, axis);
    const uint32_t least = place_of(from < to ? from : to);
    const uint32_t greatest = from == to ? least : place_of(from < to ? to : from);
    const uint32_t first = (least > half ? least - half : 0U) >> shift;
    const uint32_t last = (greatest < UINT32_MAX - half ? greatest + half : UINT32_MAX) >> shift;
    if (last - first >= most) {
        return false;
    }
    box->first[axis] = first;
    box->count[axis] = last - first + 1;
    return true;
}

/* The cells around the way. Returns false if checking all wafers is less work. */
static bool enclose(const wh_grasp_t *table, const wh_vec3_t *from, const wh_vec3_t *to, wh_real_t margin,
                    box_t *box) {
    const size_t most = table->storage.wafer_count;
    const uint32_t units = units_of(margin);
    if (!span(table, box, 0, from->x, to->x, units, most) ||
        !span(table, box, 1, from->y, to->y, units, most) ||
        !span(table, box, 2, from->z, to->z, units, most)) {
        return false;
    }
    const uint64_t level = (uint64_t)box->count[0] * box->count[1];
    return level <= most && level * box->count[2] <= most;
}

/* Appends the cell's wafers to the `count` found so far; returns the new count, one more than all if there
 * are too many. */
static size_t list_cell(wh_grasp_t *table, uint32_t key, size_t count) {
    const size_t all = table->storage.wafer_count;
    uint32_t *listed = heads_of(table) + 4 * all;
    size_t w = *head_of(table, key);
    for (size_t i = 0; i < all && w < all && count <= all; ++i) {
        const uint32_t *node = node_of(table, w);
        if (node[1] == key) {
            if (count < all) {
                listed[count] = (uint32_t)w;
            }
            ++count;
        }
        w = node[0];
    }
    return count;
}

/* Appends the wafers of a column of cells. */
static size_t list_column(wh_grasp_t *table, const box_t *box, uint32_t x, uint32_t y, size_t count) {
    for (uint32_t i = 0; i < box->count[2]; ++i) {
        count = list_cell(table, key_of(x, y, box->first[2] + i), count);
    }
    return count;
}

static size_t list_box(wh_grasp_t *table, const box_t *box) {
    size_t count = 0;
    for (uint32_t i = 0; i < box->count[0]; ++i) {
        for (uint32_t j = 0; j < box->count[1]; ++j) {
            count = list_column(table, box, box->first[0] + i, box->first[1] + j, count);
        }
    }
    return count;
}

wh_found_t wh_index_found(const wh_grasp_t *table) {
    wh_found_t near = wh_index_all(table);
    if (table->storage.buckets[WH_INDEX_FOUND + 1] <= near.count) {
        near.listed = heads_of(table) + 4 * near.count;
        near.count = table->storage.buckets[WH_INDEX_FOUND + 1];
    }
    return near;
}

wh_found_t wh_index_search(wh_grasp_t *table, size_t g, const wh_vec3_t *from, const wh_vec3_t *to,
                           wh_real_t margin) {
    box_t box;
    const bool small = enclose(table, from, to, margin, &box);
    table->storage.buckets[WH_INDEX_FOUND] = (uint32_t)g;
    table->storage.buckets[WH_INDEX_FOUND + 1] = small ? (uint32_t)list_box(table, &box) : UINT32_MAX;
    return wh_index_found(table);
}
