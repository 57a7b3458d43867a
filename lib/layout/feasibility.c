#include "feasibility.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../collision/gap.h"
#include "../math/trig.h"
#include "../text/array.h"

/* How many of the wafers in no slot are named; the others are counted. */
#define NAMED_STRAYS 20
/* Gaps above this are all the same, mm. */
#define FAR WH_REAL(1e4)

const char *wh_finding_name(wh_finding_kind_t kind) {
    static const char *const names[] = {"contact", "reach", "links", "wafer", "entry", "ledges"};
    return names[kind];
}

/* Adds a finding without parts. */
__attribute__((format(printf, 4, 5))) static wh_finding_t *add_finding(wh_feasibility_t *check,
                                                                       wh_finding_kind_t kind,
                                                                       int32_t station, const char *format,
                                                                       ...) {
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

/* ------------------------------------------------------------------------------------------------ at home */

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

/* ------------------------------------------------------------------------------------------------ contact */

/* Checks all that rests against the robot at home, as at the start of a run. */
static void check_contact(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    const size_t bytes = wh_world_bytes(&layout->world);
    void *memory = wh_array_new(1, bytes);
    wh_wafer_t *wafers = wh_array_new(layout->wafer_count, sizeof *wafers);
    wh_gripper_t grippers[WH_GRIPPERS];
    int32_t parts[2];
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        wafers[w].base_from_wafer = layout->start[w].base_from_wafer;
        wafers[w].holder = WH_NONE;
    }
    memset(grippers, 0, sizeof grippers);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        grippers[g].base_from_gripper = check->base_from_grippers[g];
        grippers[g].wafer = WH_NONE;
        grippers[g].valve = WH_VALVE_CLOSED;
    }
    const wh_world_input_t input = {0, wafers, grippers, check->base_from_effector};
    if (wh_world_check_rest(wh_world_init(&layout->world, &input, memory, bytes), &input, parts)) {
        wh_finding_t *finding =
            add_finding(check, WH_FINDING_CONTACT, WH_NONE, "%s and %s touch before anything moves",
                        wh_layout_part_name(layout, parts[0]), wh_layout_part_name(layout, parts[1]));
        memcpy(finding->parts, parts, sizeof parts);
    }
    free(wafers);
    free(memory);
}

/* base_from_gripper with the end-effector level in a slot, heading in. */
static wh_pose_t pose_in_slot(const wh_station_t *station, int32_t slot) {
    const wh_pose_t base_from_slot = wh_station_slot(station, slot);
    const wh_real_t x = base_from_slot.R.m[0][0];
    const wh_real_t y = base_from_slot.R.m[1][0];
    const wh_real_t length = wh_real_sqrt(x * x + y * y);
    const wh_pose_t level = {{{{x / length, -y / length, 0}, {y / length, x / length, 0}, {0, 0, 1}}},
                             base_from_slot.r};
    return level;
}

/* -------------------------------------------------------------------------------------------------- reach */

/* One of the four places to reach at a station: in the first or last slot, or before it. */
typedef struct {
    size_t station;
    int32_t slot;
    bool before; /* at the start of the way in */
    wh_pose_t pose;
} corner_t;

/* The end-effector's pose at `height` above the corner; the wrist follows from it. */
static wh_status_t find_effector(const wh_layout_t *layout, const corner_t *corner, wh_real_t height,
                                 wh_pose_t *base_from_effector) {
    const wh_machine_t *machine = &layout->machine;
    const wh_real_t heading = wh_atan2(corner->pose.R.m[1][0], corner->pose.R.m[0][0]);
    wh_vec3_t at = corner->pose.r;
    wh_real_t axes[WH_ROBOT_AXES];
    at.z += height;
    const wh_status_t status = wh_machine_inverse(machine, (size_t)layout->stations[corner->station].effector,
                                                  &at, heading, machine->robot.home, axes);
    if (status == WH_OK) {
        wh_robot_forward(axes, base_from_effector);
    }
    return status;
}

static void check_corner(wh_feasibility_t *check, const corner_t *corner) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *station = &layout->stations[corner->station];
    const char *where = corner->before ? "the way into " : "";
    wh_pose_t base_from_effector;
    wh_status_t status = find_effector(layout, corner, station->offset, &base_from_effector);
    if (status == WH_OK) {
        status = find_effector(layout, corner, station->offset - station->stroke, &base_from_effector);
    }
    if (status != WH_OK) {
        (void)add_finding(check, WH_FINDING_REACH, (int32_t)corner->station, "%s%s slot %d: %s", where,
                          station->name, (int)corner->slot, wh_status_text(status));
    } else if (!wh_arm_reaches(&layout->shapes.arm, &base_from_effector)) {
        (void)add_finding(check, WH_FINDING_LINKS, (int32_t)corner->station,
                          "%s%s slot %d: two links of %.4g mm do not reach the wrist", where, station->name,
                          (int)corner->slot, (double)layout->shapes.arm.link);
    }
}

static void check_reach(wh_feasibility_t *check, size_t station) {
    const wh_station_t *place = &check->layout->places[station];
    const wh_real_t retract = check->layout->stations[station].retract;
    if (!check->layout->stations[station].taught) {
        return;
    }
    for (int32_t slot = 1; slot <= place->slots; slot += place->slots > 1 ? place->slots - 1 : 1) {
        for (int before = 0; before < 2; ++before) {
            corner_t corner = {station, slot, before == 1, pose_in_slot(place, slot)};
            if (corner.before) {
                const wh_vec3_t in = wh_mat3_column(&corner.pose.R, 0);
                const wh_vec3_t way = wh_vec3_scale(retract, &in);
                corner.pose.r = wh_vec3_subtract(&corner.pose.r, &way);
            }
            check_corner(check, &corner);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- room */

/* The least gap found so far, between a part of the blade and something at rest. */
typedef struct {
    const wh_layout_t *layout;
    int32_t gripper; /* serves the station */
    wh_pose_t base_from_gripper;
    wh_real_t least;
    bool found;
} room_t;

static void measure_part(room_t *room, const wh_part_t *blade, const wh_convex_t *other,
                         const wh_pose_t *base_from_other) {
    const wh_pose_t base_from_blade =
        wh_pose_compose(&room->base_from_gripper, &blade->convex.body_from_shape);
    wh_gap_t gap;
    wh_gap_measure(&blade->convex, &base_from_blade, other, base_from_other, FAR, wh_vec3(0, 0, 1), &gap);
    const wh_real_t found = gap.state == WH_GAP_CLEAR ? gap.gap : 0;
    room->least = !room->found || found < room->least ? found : room->least;
    room->found = true;
}

/* Measures between all parts of the blade and one thing. */
static void measure(room_t *room, const wh_convex_t *other, const wh_pose_t *base_from_other) {
    const wh_world_config_t *world = &room->layout->world;
    for (size_t i = 0; i < world->part_count; ++i) {
        if (world->parts[i].kind == WH_PART_BLADE && world->parts[i].owner == room->gripper) {
            measure_part(room, &world->parts[i], other, base_from_other);
        }
    }
}

static room_t enter(const wh_layout_t *layout, size_t station, int32_t slot, wh_real_t height) {
    room_t room = {.layout = layout, .gripper = layout->stations[station].effector};
    room.base_from_gripper = pose_in_slot(&layout->places[station], slot);
    room.base_from_gripper.r.z += height;
    return room;
}

/* The gap from a blade that entered below slot `slot` to a wafer in slot `other`. */
static bool measure_wafer(const wh_layout_t *layout, size_t station, int32_t slot, int32_t other,
                          wh_real_t *found) {
    const wh_layout_station_t *s = &layout->stations[station];
    room_t room = enter(layout, station, slot, s->offset - s->stroke);
    const wh_pose_t base_from_slot = wh_station_slot(&layout->places[station], other);
    const wh_pose_t base_from_wafer = wh_pose_compose(&base_from_slot, &layout->world.wafer.body_from_shape);
    measure(&room, &layout->world.wafer, &base_from_wafer);
    *found = room.least;
    return room.found;
}

/* The gap from a blade at the slot's height to what carries the wafer: the ledges of the first slot, or the
 * chuck. */
static bool measure_support(const wh_feasibility_t *check, size_t station, wh_real_t *found) {
    const wh_layout_t *layout = check->layout;
    const wh_station_t *place = &layout->places[station];
    room_t room = enter(layout, station, 1, 0);
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        const wh_part_t *part = &layout->world.parts[i];
        const bool ledge = part->kind == WH_PART_LEDGE && part->owner == (int32_t)station && part->slot == 1;
        const bool chuck = part->kind == WH_PART_CHUCK && part->owner == place->chuck;
        if (ledge || chuck) {
            const wh_pose_t base_from_part = wh_feasibility_place(check, (int32_t)i);
            measure(&room, &part->convex, &base_from_part);
        }
    }
    *found = room.least;
    return room.found;
}

static void say_entry(wh_feasibility_t *check, size_t station, const char *which) {
    const wh_layout_station_t *s = &check->layout->stations[station];
    (void)add_finding(check, WH_FINDING_ENTRY, (int32_t)station,
                      "%s: entering %.4g mm below a slot, the blade touches the wafer %s; pitch %.4g mm, "
                      "blade %.4g mm",
                      s->name, (double)(s->stroke - s->offset), which,
                      (double)check->layout->places[station].pitch,
                      (double)check->layout->shapes.blade.thickness);
}

static void check_room(wh_feasibility_t *check, size_t station) {
    const wh_layout_t *layout = check->layout;
    const wh_station_t *place = &layout->places[station];
    const wh_layout_station_t *s = &layout->stations[station];
    wh_entry_t *entry = &check->entries[station];
    entry->has_above = measure_wafer(layout, station, 1, 1, &entry->above);
    if (place->slots > 1) {
        entry->has_below = measure_wafer(layout, station, 2, 1, &entry->below);
    }
    entry->has_beside = measure_support(check, station, &entry->beside);
    if (entry->has_above && !(entry->above > 0)) {
        say_entry(check, station, "in it");
    }
    if (entry->has_below && !(entry->below > 0)) {
        say_entry(check, station, "below");
    }
    if (entry->has_beside && !(entry->beside > 0)) {
        (void)add_finding(check, WH_FINDING_LEDGES, (int32_t)station,
                          "%s: the blade touches %s as it rises through the slot", s->name,
                          s->prealigner ? "the chuck" : "the ledges");
    }
}

/* ------------------------------------------------------------------------------------------------- wafers */

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
            (void)add_finding(
                check, WH_FINDING_WAFER, wafer->station,
                "%s lies in no slot: it is %.4g mm beside and %.4g mm above the plane of %s slot %d",
                wafer->name, (double)wh_real_sqrt(place.dx * place.dx + place.dy * place.dy),
                (double)place.dz, layout->stations[wafer->station].name, (int)wafer->slot);
        }
    }
    if (strays > NAMED_STRAYS) {
        (void)add_finding(check, WH_FINDING_WAFER, WH_NONE, "%zu more wafers lie in no slot",
                          strays - NAMED_STRAYS);
    }
}

/* ---------------------------------------------------------------------------------------------------- all */

void wh_feasibility(wh_feasibility_t *check, const wh_layout_t *layout) {
    memset(check, 0, sizeof *check);
    check->layout = layout;
    check->has_parts = layout->part_names != NULL;
    check->entries = wh_array_new(layout->station_count, sizeof *check->entries);
    go_home(check);
    if (check->has_parts) {
        check_contact(check);
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        check_reach(check, s);
        if (check->has_parts) {
            check_room(check, s);
        }
    }
    check_wafers(check);
}

void wh_feasibility_free(wh_feasibility_t *check) {
    free(check->entries);
    free(check->findings);
    memset(check, 0, sizeof *check);
}
