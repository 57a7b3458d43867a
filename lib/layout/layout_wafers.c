/* A layout's wafers: their names and where they lie when a run begins. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "layout_internal.h"

static void read_position(wh_reader_t *reader, const wh_layout_t *layout, const wh_layout_wafer_t *wafer,
                          wh_pose_t *base_from_wafer) {
    static const wh_vec3_t none = {0, 0, 0};
    const wh_pose_t base_from_slot = wh_station_slot(&layout->places[wafer->station], wafer->slot);
    const wh_vec3_t rpy = wh_reader_vector(reader, "rpy", &none);
    wh_pose_t slot_from_wafer;
    slot_from_wafer.r.x = wh_reader_number(reader, "dx", 0, -1000, 1000);
    slot_from_wafer.r.y = wh_reader_number(reader, "dy", 0, -1000, 1000);
    slot_from_wafer.r.z = wh_reader_number(reader, "dz", 0, -1000, 1000);
    slot_from_wafer.R = wh_mat3_from_rpy_deg(rpy.x, rpy.y, rpy.z);
    *base_from_wafer = wh_pose_compose(&base_from_slot, &slot_from_wafer);
}

static void read_wafer(wh_reader_t *reader, wh_layout_t *layout, size_t w) {
    char station[WH_NAME_SIZE];
    char fallback[WH_NAME_SIZE];
    wh_layout_wafer_t *wafer = &layout->wafers[w];
    wh_reader_refuse_unknown(reader, "name station slot dx dy dz rpy");
    snprintf(fallback, sizeof fallback, "Wafer %zu", w + 1);
    wh_reader_text(reader, "name", fallback, wafer->name, sizeof wafer->name);
    wh_reader_text(reader, "station", NULL, station, sizeof station);
    wafer->station = wh_layout_find_station(layout, station);
    if (wafer->station == WH_NONE) {
        lua_pushstring(reader->L, station);
        wh_reader_fail(reader, "station", "the name of a station of this layout");
    }
    wafer->slot = wh_reader_whole(reader, "slot", 0, 1, layout->places[wafer->station].slots);
    read_position(reader, layout, wafer, &layout->start[w].base_from_wafer);
}

/* What is sorted: wafers stay where they are. */
typedef struct {
    const wh_layout_wafer_t *wafer;
} entry_t;

static int compare_names(const void *a, const void *b) {
    const wh_layout_wafer_t *one = ((const entry_t *)a)->wafer;
    const wh_layout_wafer_t *two = ((const entry_t *)b)->wafer;
    const int order = strcmp(one->name, two->name);
    return order != 0 ? order : (one < two ? -1 : 1);
}

static int compare_slots(const void *a, const void *b) {
    const wh_layout_wafer_t *one = ((const entry_t *)a)->wafer;
    const wh_layout_wafer_t *two = ((const entry_t *)b)->wafer;
    if (one->station != two->station) {
        return one->station < two->station ? -1 : 1;
    }
    if (one->slot != two->slot) {
        return one->slot < two->slot ? -1 : 1;
    }
    return one < two ? -1 : 1;
}

static void fail_at(wh_reader_t *reader, const wh_layout_t *layout, const wh_layout_wafer_t *wafer,
                    const char *field, const char *expected) {
    char path[40];
    snprintf(path, sizeof path, "[%d].%s", (int)(wafer - layout->wafers) + 1, field);
    wh_reader_fail(reader, path, "%s", expected);
}

/* Sorting puts wafers that share something side by side. */
static void refuse_same_name(wh_reader_t *reader, const wh_layout_t *layout, entry_t *order) {
    qsort(order, layout->wafer_count, sizeof *order, compare_names);
    for (size_t i = 1; i < layout->wafer_count; ++i) {
        if (strcmp(order[i - 1].wafer->name, order[i].wafer->name) == 0) {
            lua_pushstring(reader->L, order[i].wafer->name);
            fail_at(reader, layout, order[i].wafer, "name", "a name that no other wafer has");
        }
    }
}

static void refuse_same_slot(wh_reader_t *reader, const wh_layout_t *layout, entry_t *order) {
    qsort(order, layout->wafer_count, sizeof *order, compare_slots);
    for (size_t i = 1; i < layout->wafer_count; ++i) {
        const wh_layout_wafer_t *wafer = order[i].wafer;
        const wh_layout_wafer_t *before = order[i - 1].wafer;
        if (before->station == wafer->station && before->slot == wafer->slot) {
            char expected[200];
            snprintf(expected, sizeof expected, "a slot of %s of its own; \"%s\" lies in this one",
                     layout->stations[wafer->station].name, before->name);
            lua_pushinteger(reader->L, wafer->slot);
            fail_at(reader, layout, wafer, "slot", expected);
        }
    }
}

void wh_layout_read_wafers(wh_reader_t *reader, wh_layout_t *layout) {
    if (!wh_reader_enter(reader, "wafers")) {
        return;
    }
    const size_t count = wh_reader_list(reader);
    if (count > WH_LAYOUT_WAFERS) {
        wh_reader_fail(reader, NULL, "at most %d wafers", WH_LAYOUT_WAFERS);
    }
    layout->wafers = wh_layout_memory(reader->L, count, sizeof *layout->wafers);
    layout->start = wh_layout_memory(reader->L, count, sizeof *layout->start);
    for (; layout->wafer_count < count; ++layout->wafer_count) {
        wh_reader_enter_item(reader, (lua_Integer)layout->wafer_count + 1);
        read_wafer(reader, layout, layout->wafer_count);
        wh_reader_leave(reader);
    }
    entry_t *order = wh_layout_memory(reader->L, count, sizeof *order);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        order[w].wafer = &layout->wafers[w];
    }
    refuse_same_name(reader, layout, order);
    refuse_same_slot(reader, layout, order);
    wh_reader_leave(reader);
}
