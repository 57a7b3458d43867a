/* Whether the robot gets to a station's slots, and what room its blade has there. */
#include "../collision/gap.h"
#include "../math/trig.h"
#include "feasibility_internal.h"

/* Farther than this nobody asks, mm. */
#define FAR WH_REAL(1e4)

wh_pose_t wh_feasibility_entry(const wh_station_t *station, int32_t slot) {
    const wh_pose_t base_from_slot = wh_station_slot(station, slot);
    const wh_real_t x = base_from_slot.R.m[0][0];
    const wh_real_t y = base_from_slot.R.m[1][0];
    const wh_real_t length = wh_real_sqrt(x * x + y * y);
    const wh_pose_t level = {{{{x / length, -y / length, 0}, {y / length, x / length, 0}, {0, 0, 1}}},
                             base_from_slot.r};
    return level;
}

/* ----------------------------------------------------------------------------------------------------- reach */

/* One of the four corners of a station: first or last slot, in it or before it. */
typedef struct {
    size_t station;
    int32_t slot;
    bool before; /* where the way in begins */
    wh_pose_t pose;
} corner_t;

/* The end-effector's pose, from which the wrist follows. */
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
        (void)wh_feasibility_add(check, WH_FINDING_REACH, (int32_t)corner->station, "%s%s slot %d: %s", where,
                                 station->name, (int)corner->slot, wh_status_text(status));
    } else if (!wh_arm_reaches(&layout->shapes.arm, &base_from_effector)) {
        (void)wh_feasibility_add(check, WH_FINDING_LINKS, (int32_t)corner->station,
                                 "%s%s slot %d: two links of %.4g mm do not reach the wrist", where,
                                 station->name, (int)corner->slot, (double)layout->shapes.arm.link);
    }
}

void wh_feasibility_reach(wh_feasibility_t *check, size_t station) {
    const wh_station_t *place = &check->layout->places[station];
    const wh_real_t retract = check->layout->stations[station].retract;
    if (!check->layout->stations[station].taught) {
        return;
    }
    for (int32_t slot = 1; slot <= place->slots; slot += place->slots > 1 ? place->slots - 1 : 1) {
        for (int before = 0; before < 2; ++before) {
            corner_t corner = {station, slot, before == 1, wh_feasibility_entry(place, slot)};
            if (corner.before) {
                const wh_vec3_t in = wh_mat3_column(&corner.pose.R, 0);
                const wh_vec3_t way = wh_vec3_scale(retract, &in);
                corner.pose.r = wh_vec3_subtract(&corner.pose.r, &way);
            }
            check_corner(check, &corner);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------ room */

/* The least gap found so far, between a blade's part and something at rest. */
typedef struct {
    const wh_layout_t *layout;
    int32_t gripper; /* that serves the station */
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

/* Between the blade and one thing. */
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
    room.base_from_gripper = wh_feasibility_entry(&layout->places[station], slot);
    room.base_from_gripper.r.z += height;
    return room;
}

/* Entered below slot `slot`, to a wafer in slot `other`. */
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

/* At the slot's height, to what carries the wafer: ledges of the first slot, or the chuck. */
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
    (void)wh_feasibility_add(
        check, WH_FINDING_ENTRY, (int32_t)station,
        "%s: entering %.4g mm below a slot, the blade touches the wafer %s; pitch %.4g mm, "
        "blade %.4g mm",
        s->name, (double)(s->stroke - s->offset), which, (double)check->layout->places[station].pitch,
        (double)check->layout->shapes.blade.thickness);
}

void wh_feasibility_room(wh_feasibility_t *check, size_t station) {
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
        (void)wh_feasibility_add(check, WH_FINDING_LEDGES, (int32_t)station,
                                 "%s: the blade touches %s as it rises through the slot", s->name,
                                 s->prealigner ? "the chuck" : "the ledges");
    }
}
