#include "feasibility.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "feasibility_internal.h"

/* So many wafers in no slot are named, and the others counted. */
#define NAMED_STRAYS 20

const char *wh_finding_name(wh_finding_kind_t kind) {
    static const char *const names[] = {"contact", "reach", "links", "wafer", "entry", "ledges"};
    return names[kind];
}

wh_finding_t *wh_feasibility_add(wh_feasibility_t *check, wh_finding_kind_t kind, int32_t station,
                                 const char *format, ...) {
    check->findings = wh_array_grow(check->findings, check->count, &check->capacity, sizeof *check->findings);
    wh_finding_t *finding = &check->findings[check->count++];
    finding->kind = kind;
    finding->station = station;
    finding->parts[0] = finding->parts[1] = WH_NONE;
    va_list values;
    va_start(values, format);
    (void)vsnprintf(finding->text, sizeof finding->text, format, values);
    va_end(values);
    return finding;
}

/* --------------------------------------------------------------------------------------------------- at home */

static void go_home(wh_feasibility_t *check) {
    const wh_machine_t *machine = &check->layout->machine;
    wh_real_t axes[WH_AXES] = {0};
    memcpy(axes, machine->robot.home, sizeof machine->robot.home);
    wh_robot_forward(axes, &check->base_from_effector);
    wh_machine_grippers(machine, axes, check->base_from_grippers);
    wh_arm_place(&check->layout->shapes.arm, &check->base_from_effector, check->base_from_arm);
}

wh_pose_t wh_feasibility_place(const wh_feasibility_t *check, int32_t part) {
    const wh_world_config_t *world = &check->layout->world;
    if ((size_t)part >= world->part_count) {
        const wh_pose_t *wafer = &check->layout->start[(size_t)part - world->part_count].base_from_wafer;
        return wh_pose_compose(wafer, &world->wafer.body_from_shape);
    }
    const wh_part_t *from = &world->parts[part];
    switch (from->kind) {
    case WH_PART_ARM:
        return wh_pose_compose(&check->base_from_arm[from->owner], &from->convex.body_from_shape);
    case WH_PART_BLADE:
    case WH_PART_CHUCK:
        return wh_pose_compose(&check->base_from_grippers[from->owner], &from->convex.body_from_shape);
    case WH_PART_FIXED:
    case WH_PART_LEDGE:
    case WH_PART_WAFER:
        break;
    }
    return from->convex.body_from_shape;
}

/* --------------------------------------------------------------------------------------------------- contact */

static void look_at_rest(wh_feasibility_t *check, const wh_grasp_t *table, void *memory) {
    const wh_layout_t *layout = check->layout;
    const wh_world_input_t input = {table->slice, table->storage.wafers, table->storage.grippers,
                                    check->base_from_effector};
    int32_t parts[2];
    wh_world_t *world = wh_world_init(&layout->world, &input, memory, wh_world_bytes(&layout->world));
    if (!world || !wh_world_check_rest(world, &input, parts)) {
        return;
    }
    wh_finding_t *finding =
        wh_feasibility_add(check, WH_FINDING_CONTACT, WH_NONE, "%s and %s touch before anything moves",
                           wh_layout_part_name(layout, parts[0]), wh_layout_part_name(layout, parts[1]));
    memcpy(finding->parts, parts, sizeof parts);
}

/* Everything that rests and the robot at home, as a run begins. */
static void check_contact(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_grasp_t table;
    const size_t bytes = layout->wafer_count * sizeof(wh_wafer_t);
    const wh_grasp_storage_t storage = {.wafers = malloc(bytes + 1),
                                        .wafer_count = layout->wafer_count,
                                        .grippers = grippers,
                                        .gripper_count = layout->machine.gripper_count};
    void *memory = malloc(wh_world_bytes(&layout->world));
    check->out_of_memory = check->out_of_memory || !storage.wafers || !memory;
    if (storage.wafers && memory) {
        memcpy(storage.wafers, layout->start, bytes);
        if (wh_grasp_init(&table, &layout->grasp, &storage) == WH_OK) {
            for (size_t g = 0; g < storage.gripper_count; ++g) {
                grippers[g].base_from_gripper = check->base_from_grippers[g];
            }
            look_at_rest(check, &table, memory);
        }
    }
    free(storage.wafers);
    free(memory);
}

/* ---------------------------------------------------------------------------------------------------- wafers */

static void check_wafers(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    size_t strays = 0;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const wh_layout_wafer_t *wafer = &layout->wafers[w];
        wh_place_t place;
        ++check->entries[wafer->station].wafers;
        if (!wh_cell_locate(&layout->cell, &layout->start[w].base_from_wafer, &place) &&
            ++strays <= NAMED_STRAYS) {
            place = wh_station_measure(&layout->places[wafer->station], wafer->slot,
                                       &layout->start[w].base_from_wafer);
            (void)wh_feasibility_add(
                check, WH_FINDING_WAFER, wafer->station,
                "%s lies in no slot: it is %.4g mm beside and %.4g mm above the plane of %s slot %d",
                wafer->name, (double)wh_real_sqrt(place.dx * place.dx + place.dy * place.dy),
                (double)place.dz, layout->stations[wafer->station].name, (int)wafer->slot);
        }
    }
    if (strays > NAMED_STRAYS) {
        (void)wh_feasibility_add(check, WH_FINDING_WAFER, WH_NONE, "%zu more wafers lie in no slot",
                                 strays - NAMED_STRAYS);
    }
}

/* ------------------------------------------------------------------------------------------------------- all */

bool wh_feasibility(wh_feasibility_t *check, const wh_layout_t *layout) {
    memset(check, 0, sizeof *check);
    check->layout = layout;
    check->has_parts = layout->part_names != NULL;
    check->entries = calloc(layout->station_count + 1, sizeof *check->entries);
    if (!check->entries) {
        return false;
    }
    go_home(check);
    if (check->has_parts) {
        check_contact(check);
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_feasibility_reach(check, s);
        if (check->has_parts) {
            wh_feasibility_room(check, s);
        }
    }
    check_wafers(check);
    return !check->out_of_memory;
}

void wh_feasibility_free(wh_feasibility_t *check) {
    free(check->entries);
    free(check->findings);
    memset(check, 0, sizeof *check);
}
