#include "layout.h"

#include <string.h>

#include "words.h"

/* -------------------------------------------------------------------------------------------------- names */

/* The index of the item with that name; each of them begins with its name. WH_NONE if there is none. */
static int32_t find(const void *items, size_t count, size_t size, const char *name) {
    for (size_t i = 0; i < count; ++i) {
        if (strcmp((const char *)items + i * size, name) == 0) {
            return (int32_t)i;
        }
    }
    return WH_NONE;
}

double wh_layout_debounce_ms(const wh_layout_t *layout) {
    return (double)layout->physics.vacuum.debounce * (double)layout->slice_us / 1000;
}

int32_t wh_layout_find_station(const wh_layout_t *layout, const char *name) {
    return find(layout->stations, layout->station_count, sizeof *layout->stations, name);
}

int32_t wh_layout_find_gripper(const wh_layout_t *layout, const char *name) {
    return find(layout->grippers, layout->machine.gripper_count, sizeof layout->grippers[0], name);
}

int32_t wh_layout_find_wafer(const wh_layout_t *layout, const char *name) {
    return find(layout->wafers, layout->wafer_count, sizeof *layout->wafers, name);
}

int32_t wh_layout_find_door(const wh_layout_t *layout, const char *name) {
    return find(layout->door_list, layout->machine.door_count, sizeof *layout->door_list, name);
}

int32_t wh_layout_find_beam(const wh_layout_t *layout, const char *name) {
    return *name != '\0' ? find(layout->beams, layout->beam_count, sizeof *layout->beams, name) : WH_NONE;
}

int32_t wh_layout_find_robot(const wh_layout_t *layout, const char *name) {
    return find(layout->robots, layout->robot_count, sizeof *layout->robots, name);
}

const char *wh_layout_part_name(const wh_layout_t *layout, int32_t part) {
    if (part < 0 || !layout->part_names) {
        return NULL;
    }
    if ((size_t)part < layout->world.part_count) {
        return layout->part_names[part];
    }
    const size_t wafer = (size_t)part - layout->world.part_count;
    return wafer < layout->wafer_count ? layout->wafers[wafer].name : NULL;
}

/* ---------------------------------------------------------------------------------- what belongs to what */

void wh_layout_place(wh_layout_t *layout) {
    layout->cell.stations = layout->places;
    layout->cell.count = layout->station_count;
    layout->cell.tolerance = layout->grasp.tolerance;
}

bool wh_layout_is_pins(const wh_layout_t *layout, size_t gripper) {
    const wh_mount_t *mount = &layout->machine.mounts[gripper];
    return mount->axis != WH_NONE && mount->kind == WH_MOUNT_PINS;
}

bool wh_layout_is_flipper(const wh_layout_t *layout, size_t gripper) {
    const wh_mount_t *mount = &layout->machine.mounts[gripper];
    return mount->axis != WH_NONE && mount->kind == WH_MOUNT_FLIPPER;
}

int32_t wh_layout_find_pins(const wh_layout_t *layout, int32_t station) {
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        if (layout->grippers[g].station == station && wh_layout_is_pins(layout, g)) {
            return (int32_t)g;
        }
    }
    return WH_NONE;
}

const char *wh_layout_station_kind(const wh_layout_station_t *station) {
    const int usual = station->foup ? 2 : station->flipper ? 3 : 0;
    return wh_layout_station_words[station->prealigner ? 1 : station->port ? WH_LAYOUT_LOAD_PORT : usual];
}

int32_t wh_layout_door_of(const wh_layout_t *layout, size_t station, size_t robot) {
    const wh_layout_station_t *at = &layout->stations[station];
    return at->by ? at->by[robot].door : at->door;
}

bool wh_layout_is_shared(const wh_layout_t *layout) {
    return layout->robot_count > 1 || layout->timed;
}

bool wh_layout_is_served(const wh_layout_t *layout, size_t station) {
    const wh_layout_approach_t *by = layout->stations[station].by;
    bool is_any = !by || !layout->timed;
    for (size_t r = 0; by && r < layout->robot_count; ++r) {
        is_any = is_any || by[r].serves;
    }
    return is_any;
}

int32_t wh_layout_first_gripper(const wh_layout_t *layout, size_t robot) {
    size_t g = 0;
    while (layout->grippers[g].station != WH_NONE || layout->machine.mounts[g].robot != robot) {
        ++g;
    }
    return (int32_t)g;
}

wh_vec3_t wh_layout_aside(const wh_layout_t *layout, size_t station, size_t robot) {
    const wh_layout_approach_t *by = layout->stations[station].by;
    return by ? by[robot].aside : wh_vec3(0, 0, 0);
}

const wh_layout_vias_t *wh_layout_vias_of(const wh_layout_t *layout, size_t station, size_t robot) {
    const wh_layout_station_t *at = &layout->stations[station];
    return at->by ? &at->by[robot].vias : &at->vias;
}
