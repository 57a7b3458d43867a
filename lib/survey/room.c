/* How much room blades and wafers have: entered in a slot, in front of a station, and beside each other. */
#include <stdio.h>
#include <string.h>

#include "../collision/gap.h"
#include "feasibility_internal.h"

/* Gaps above this are all the same, mm. */
#define FAR WH_REAL(1e4)

/* ---------------------------------------------------------------------------------------------- measuring */

/* The things that a gripper carries into a station: its blade, and the wafer that it may hold. */
typedef struct {
    const wh_layout_t *layout;
    int32_t gripper;
    wh_pose_t base_from_gripper;
    wh_real_t down, up; /* how far it sweeps below and above its height, mm */
    bool holds;         /* a wafer as well */
} carried_t;

/* The least gap found so far. If gaps are equally bad, a blade's own parts come before parts that hang on
 * it. */
typedef struct {
    wh_real_t least;
    bool found;
    wh_gap_state_t worst; /* CLEAR, TOUCHING or HIT */
    int32_t part;         /* the carried part where the gap is worst; WH_NONE: the wafer */
} room_t;

/* A level shape with all that it sweeps on its way up: exact for boxes and cylinders. */
static wh_convex_t swept(const carried_t *carried, const wh_convex_t *convex) {
    wh_convex_t grown = *convex;
    if (convex->kind == WH_CONVEX_BOX || convex->kind == WH_CONVEX_CYLINDER) {
        grown.half.z += (carried->down + carried->up) / 2;
        grown.body_from_shape.r.z += (carried->up - carried->down) / 2;
    }
    return grown;
}

static void note_gap(room_t *room, int32_t part, wh_gap_state_t state, wh_real_t gap) {
    if (!room->found || state > room->worst || (state == room->worst && gap <= room->least)) {
        room->part = part;
    }
    room->least = !room->found || gap < room->least ? gap : room->least;
    room->worst = state > room->worst ? state : room->worst;
    room->found = true;
}

static void measure_shape(const carried_t *carried, int32_t part, const wh_convex_t *other,
                          const wh_pose_t *base_from_other, room_t *room) {
    const wh_world_config_t *world = &carried->layout->world;
    const wh_convex_t *shape = part == WH_NONE ? &world->wafer : &world->parts[part].convex;
    const wh_convex_t grown = swept(carried, shape);
    const wh_pose_t base_from_shape = wh_pose_compose(&carried->base_from_gripper, &grown.body_from_shape);
    wh_gap_t gap;
    wh_gap_measure(&grown, &base_from_shape, other, base_from_other, FAR, wh_vec3(0, 0, 1), &gap);
    const wh_gap_state_t state = gap.state == WH_GAP_UNDECIDED ? WH_GAP_HIT : gap.state;
    note_gap(room, part, state, state == WH_GAP_CLEAR ? gap.gap : 0);
}

/* Parts that hang on something come last. */
static bool hangs(const wh_part_t *part) {
    return part->kind != WH_PART_FIXED && part->kind != WH_PART_LEDGE;
}

/* Measures between all that is carried and one thing. */
static void measure(const carried_t *carried, const wh_convex_t *other, const wh_pose_t *base_from_other,
                    room_t *room) {
    const wh_world_config_t *world = &carried->layout->world;
    for (size_t i = world->part_count; i > 0 && hangs(&world->parts[i - 1]); --i) {
        const wh_part_t *part = &world->parts[i - 1];
        if (part->kind == WH_PART_BLADE && part->owner == carried->gripper) {
            measure_shape(carried, (int32_t)(i - 1), other, base_from_other, room);
        }
    }
    if (carried->holds) {
        measure_shape(carried, WH_NONE, other, base_from_other, room);
    }
}

/* Measures to a wafer in the middle of a slot of a station there. */
static void measure_wafer_at(const carried_t *carried, const wh_station_t *place, int32_t slot,
                             room_t *room) {
    const wh_layout_t *layout = carried->layout;
    const wh_pose_t base_from_slot = wh_station_slot(place, slot);
    const wh_pose_t base_from_wafer = wh_pose_compose(&base_from_slot, &layout->world.wafer.body_from_shape);
    measure(carried, &layout->world.wafer, &base_from_wafer, room);
}

static void measure_wafer(const carried_t *carried, size_t station, int32_t slot, room_t *room) {
    measure_wafer_at(carried, &carried->layout->places[station], slot, room);
}

/* Along its own normal, as the strokes go. */
static void go_up(wh_pose_t *pose, wh_real_t height) {
    const wh_vec3_t normal = wh_mat3_column(&pose->R, 2);
    const wh_vec3_t up = wh_vec3_scale(height, &normal);
    pose->r = wh_vec3_add(&pose->r, &up);
}

/* The station's gripper, entered in a slot and so much above its plane. */
static carried_t enter(const wh_layout_t *layout, size_t station, int32_t slot, wh_real_t height) {
    carried_t carried = {.layout = layout, .gripper = layout->stations[station].effector};
    carried.base_from_gripper = wh_layout_come_level(layout, &layout->places[station], slot);
    go_up(&carried.base_from_gripper, height);
    return carried;
}

/* -------------------------------------------------------------------------------------------- in the slot */

/* The gap from a blade that entered below slot `slot` of a station there to a wafer in slot `other`. */
static room_t find_entry(const wh_layout_t *layout, size_t station, const wh_station_t *place, int32_t slot,
                         int32_t other) {
    const wh_layout_station_t *s = &layout->stations[station];
    carried_t carried = {.layout = layout, .gripper = s->effector};
    room_t room = {.found = false};
    carried.base_from_gripper = wh_layout_come_level(layout, place, slot);
    go_up(&carried.base_from_gripper, s->offset - s->stroke);
    measure_wafer_at(&carried, place, other, &room);
    return room;
}

/* The place of a station, as if it stood upright there. */
static wh_station_t upright(const wh_layout_t *layout, const wh_station_t *place) {
    wh_station_t level = *place;
    level.base_from_station.R = wh_layout_come_level(layout, place, 1).R;
    return level;
}

/* The gap from a blade at the slot's height to what carries the wafer: the ledges of the first slot, or the
 * chuck. */
static bool find_support(const wh_feasibility_t *check, size_t station, wh_real_t *found) {
    const wh_layout_t *layout = check->layout;
    const wh_station_t *place = &layout->places[station];
    const carried_t carried = enter(layout, station, 1, 0);
    room_t room = {.found = false};
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        const wh_part_t *part = &layout->world.parts[i];
        const bool ledge = part->kind == WH_PART_LEDGE && part->owner == (int32_t)station && part->slot == 1;
        const bool chuck = part->kind == WH_PART_CHUCK && part->owner == place->chuck;
        if (ledge || chuck) {
            const wh_pose_t base_from_part = wh_feasibility_place(check, (int32_t)i);
            measure(&carried, &part->convex, &base_from_part, &room);
        }
    }
    *found = room.least;
    return room.found;
}

/* True if the part hangs on a blade as an obstacle. */
static bool is_hung(const wh_layout_t *layout, int32_t part) {
    return part != WH_NONE && (size_t)part + layout->hung_count >= layout->world.part_count;
}

/* `other`: the slot of a wafer that is touched by a blade entering below `slot`. It is the tilt that takes
 * the room if the same parts would have some at an upright station. */
static void say_cause(const wh_layout_t *layout, size_t station, const room_t *room, int32_t slot,
                      int32_t other, char *cause, size_t size) {
    const wh_station_t *place = &layout->places[station];
    const wh_station_t level = upright(layout, place);
    const wh_real_t room_upright = find_entry(layout, station, &level, slot, other).least;
    if (room_upright > 0) {
        snprintf(cause, size, "it is tilted by %.4g deg, upright it would have %.4g mm",
                 wh_feasibility_tilt(place), (double)room_upright);
    } else if (is_hung(layout, room->part)) {
        snprintf(cause, size, "pitch %.4g mm", (double)place->pitch);
    } else {
        snprintf(cause, size, "pitch %.4g mm, blade %.4g mm", (double)place->pitch,
                 (double)layout->shapes.blade.thickness);
    }
}

static void say_entry(wh_feasibility_t *check, size_t station, const room_t *room, int32_t slot,
                      int32_t other) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *s = &layout->stations[station];
    const bool hits = room->worst == WH_GAP_HIT;
    const bool hung = is_hung(layout, room->part);
    char cause[80];
    say_cause(layout, station, room, slot, other, cause, sizeof cause);
    (void)wh_feasibility_add(check, WH_FINDING_ENTRY, (int32_t)station,
                             "%s: entering %.4g mm below a slot, %s%s%s %s the wafer %s; %s", s->name,
                             (double)(s->stroke - s->offset),
                             hung ? layout->part_names[room->part] : "the blade", hung ? " on " : "",
                             hung ? layout->grippers[s->effector].name : "", hits ? "touches" : "has 0 mm to",
                             slot == other ? "in it" : "below", cause);
    if (!hits) {
        wh_feasibility_warn(check);
    }
}

static void check_entry(wh_feasibility_t *check, size_t station) {
    const wh_layout_t *layout = check->layout;
    const wh_station_t *place = &layout->places[station];
    wh_entry_t *entry = &check->entries[station];
    const room_t above_blade = find_entry(layout, station, place, 1, 1);
    entry->has_above = above_blade.found;
    entry->above = above_blade.least;
    if (entry->has_above && !(entry->above > 0)) {
        say_entry(check, station, &above_blade, 1, 1);
    }
    if (place->slots > 1) {
        const room_t below_blade = find_entry(layout, station, place, 2, 1);
        entry->has_below = below_blade.found;
        entry->below = below_blade.least;
        if (entry->has_below && !(entry->below > 0)) {
            say_entry(check, station, &below_blade, 2, 1);
        }
    }
}

static void check_support(wh_feasibility_t *check, size_t station) {
    const wh_layout_station_t *s = &check->layout->stations[station];
    wh_entry_t *entry = &check->entries[station];
    entry->has_beside = find_support(check, station, &entry->beside);
    if (entry->has_beside && !(entry->beside > 0)) {
        (void)wh_feasibility_add(check, WH_FINDING_LEDGES, (int32_t)station,
                                 "%s: the blade touches %s as it rises through the slot", s->name,
                                 s->prealigner ? "the chuck" : "the ledges");
    }
}

/* -------------------------------------------------------------------------------------- what is asked for */

/* Compares a gap that occurs in each GET or PUT with the layout's limit. A gap of 0 is another finding. */
static void check_gap(wh_feasibility_t *check, size_t station, wh_clearance_kind_t kind, bool has,
                      wh_real_t gap, const char *where) {
    const wh_layout_t *layout = check->layout;
    const wh_real_t limit = layout->world.limits[kind];
    if (has && gap > 0 && limit > 0 && !wh_clearance_is_kept(gap, limit)) {
        (void)wh_feasibility_add(check, WH_FINDING_GAP, (int32_t)station,
                                 "%s: the blade has %.4g mm %s, `clearance.%s` asks for at least %.6g mm",
                                 layout->stations[station].name, (double)gap, where, wh_clearance_name(kind),
                                 (double)limit);
    }
}

static void check_gaps(wh_feasibility_t *check, size_t station) {
    const wh_entry_t *entry = &check->entries[station];
    const bool chuck = check->layout->stations[station].prealigner;
    check_gap(check, station, WH_CLEARANCE_BLADE_WAFER_ABOVE, entry->has_above, entry->above,
              "to the wafer above");
    check_gap(check, station, WH_CLEARANCE_BLADE_WAFER_BELOW, entry->has_below, entry->below,
              "to the wafer below");
    check_gap(check, station, WH_CLEARANCE_BLADE_OTHER, entry->has_beside, entry->beside,
              chuck ? "to the chuck" : "to the ledges");
}

/* -------------------------------------------------------------------------------- in front of the station */

static bool is_on_robot(const wh_layout_t *layout, int32_t gripper) {
    return layout->grippers[gripper].station == WH_NONE;
}

static size_t count_on_robot(const wh_layout_t *layout) {
    size_t count = 0;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        count += is_on_robot(layout, (int32_t)g) ? 1 : 0;
    }
    return count;
}

static void say_before(wh_feasibility_t *check, size_t station, const carried_t *carried, bool is_hit) {
    const wh_layout_station_t *s = &check->layout->stations[station];
    const char *what = carried->holds ? "a wafer on the blade" : "the blade";
    (void)wh_feasibility_add(
        check, WH_FINDING_RETRACT, (int32_t)station,
        is_hit ? "%s: `retract` of %.10g mm%s is too little: in front of the station %s overlaps its wafers"
               : "%s: `retract` of %.10g mm%s leaves 0 mm between %s and the station's wafers",
        s->name, (double)s->retract, s->retract_default ? " (default)" : "", what);
    if (!is_hit) {
        wh_feasibility_warn(check);
    }
}

/* Where the arm turns, a wafer on the blade still stands between walls: a turn may hit them. */
static void check_walls(wh_feasibility_t *check, size_t station, const carried_t *carried, wh_vec3_t in) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *s = &layout->stations[station];
    const wh_convex_t *wafer = &layout->world.wafer;
    const wh_pose_t base_from_wafer = wh_pose_compose(&carried->base_from_gripper, &wafer->body_from_shape);
    wh_real_t least = 0;
    for (size_t i = 0; s->foup && i < layout->world.part_count; ++i) {
        const wh_part_t *part = &layout->world.parts[i];
        if (part->kind == WH_PART_FIXED && part->owner == (int32_t)station) {
            const wh_real_t apart =
                wh_gap_along(wafer, &base_from_wafer, &part->convex, &part->convex.body_from_shape, in);
            least = apart < least ? apart : least;
        }
    }
    if (least < -WH_GAP_TOUCH) {
        (void)wh_feasibility_add(
            check, WH_FINDING_RETRACT, (int32_t)station,
            "%s: `retract` of %.10g mm%s leaves a wafer on the blade %.4g mm deep in the "
            "FOUP, whose walls it may hit as the arm turns",
            s->name, (double)s->retract, s->retract_default ? " (default)" : "", (double)-least);
        wh_feasibility_warn(check);
    }
}

/* Where the straight way begins and ends the arm turns and goes up and down, past all slots. */
static void check_before(wh_feasibility_t *check, size_t station) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *s = &layout->stations[station];
    const wh_station_t *place = &layout->places[station];
    carried_t carried = enter(layout, station, 1, 0);
    const wh_vec3_t in = wh_mat3_column(&carried.base_from_gripper.R, 0);
    const wh_vec3_t way = wh_vec3_scale(s->retract, &in);
    room_t room = {.found = false};
    carried.base_from_gripper.r = wh_vec3_subtract(&carried.base_from_gripper.r, &way);
    carried.down = carried.up = s->stroke + layout->shapes.blade.thickness + layout->shapes.wafer_thickness;
    carried.holds = place->slots > 1 || count_on_robot(layout) > 1;
    measure_wafer(&carried, station, 1, &room);
    check->entries[station].has_before = room.found;
    check->entries[station].before = room.least;
    if (room.found && room.worst != WH_GAP_CLEAR) {
        say_before(check, station, &carried, room.worst == WH_GAP_HIT);
    }
    check_walls(check, station, &carried, in);
}

/* ------------------------------------------------------------------------------------------- other blades */

/* From a gripper's pose to that of another one on the robot: on the same arm, or on the other arm at home.
 * False if the robot does not come there. */
static bool go_over(const wh_layout_t *layout, size_t station, int32_t other, wh_pose_t *pose) {
    const wh_layout_station_t *s = &layout->stations[station];
    const wh_machine_t *machine = &layout->machine;
    const wh_mount_t *mounts = machine->mounts;
    const wh_chain_choice_t choice = {.rail = s->rail, .elbow = s->elbow};
    wh_real_t axes[WH_AXES];
    wh_pose_t poses[WH_GRIPPERS];
    if (mounts[other].arm == mounts[s->effector].arm) {
        const wh_pose_t gripper_from_other = wh_pose_relative(&mounts[s->effector].effector_from_gripper,
                                                              &mounts[other].effector_from_gripper);
        *pose = wh_pose_compose(pose, &gripper_from_other);
        return true;
    }
    wh_machine_home(machine, axes);
    if (wh_machine_bring(machine, (size_t)s->effector, pose, &choice, axes, axes) != WH_OK) {
        return false;
    }
    wh_machine_grippers(machine, axes, poses);
    *pose = poses[other];
    return true;
}

/* The place of another gripper on the robot when the station's gripper has entered a slot, and the room that
 * it sweeps as the station's gripper goes up. False if the robot does not come there. */
static bool beside(const wh_layout_t *layout, size_t station, int32_t slot, int32_t other,
                   carried_t *carried) {
    const wh_layout_station_t *s = &layout->stations[station];
    *carried = enter(layout, station, slot, 0);
    carried->gripper = other;
    carried->down = s->stroke - s->offset;
    carried->up = s->offset;
    carried->holds = true;
    return go_over(layout, station, other, &carried->base_from_gripper);
}

/* The first slot of a station whose wafer it meets, or 0. */
static int32_t meets(const carried_t *carried, size_t station) {
    for (int32_t slot = 1; slot <= carried->layout->places[station].slots; ++slot) {
        room_t room = {.found = false};
        measure_wafer(carried, station, slot, &room);
        if (room.worst == WH_GAP_HIT) {
            return slot;
        }
    }
    return 0;
}

/* Entered in the first or the last slot: all that lies above, or below, is then beside the other blade. */
static void check_beside(wh_feasibility_t *check, size_t station, int32_t other) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *s = &layout->stations[station];
    const int32_t ends[] = {1, layout->places[station].slots};
    for (int i = 0; i < (ends[1] > 1 ? 2 : 1); ++i) {
        carried_t carried;
        const bool comes = beside(layout, station, ends[i], other, &carried);
        const int32_t slot = comes ? meets(&carried, station) : 0;
        if (slot > 0) {
            wh_feasibility_add(check, WH_FINDING_BLADES, (int32_t)station,
                               "%s: with %s in slot %d, %s or a wafer on it touches the wafer in slot %d",
                               s->name, layout->grippers[s->effector].name, (int)ends[i],
                               layout->grippers[other].name, (int)slot)
                ->slot = ends[i];
            return;
        }
    }
}

/* ----------------------------------------------------------------------------------------- other stations */

static wh_box_t box_of_wafer(const wh_layout_t *layout, size_t station, int32_t slot) {
    const wh_convex_t *wafer = &layout->world.wafer;
    const wh_pose_t base_from_slot = wh_station_slot(&layout->places[station], slot);
    const wh_pose_t base_from_wafer = wh_pose_compose(&base_from_slot, &wafer->body_from_shape);
    wh_box_t box;
    wh_convex_bounds(wafer, &base_from_wafer, &box.low, &box.high);
    return box;
}

static wh_vec3_t least(const wh_vec3_t *a, const wh_vec3_t *b) {
    return wh_vec3(a->x < b->x ? a->x : b->x, a->y < b->y ? a->y : b->y, a->z < b->z ? a->z : b->z);
}

static wh_vec3_t greatest(const wh_vec3_t *a, const wh_vec3_t *b) {
    return wh_vec3(wh_real_max(a->x, b->x), wh_real_max(a->y, b->y), wh_real_max(a->z, b->z));
}

/* The box around a station's wafers and the strokes below and above them. */
static wh_box_t box_of(const wh_layout_t *layout, size_t station) {
    const wh_box_t first = box_of_wafer(layout, station, 1);
    const wh_box_t last = box_of_wafer(layout, station, layout->places[station].slots);
    const wh_box_t both = {least(&first.low, &last.low), greatest(&first.high, &last.high)};
    return wh_box_grown(&both, layout->stations[station].stroke + layout->shapes.blade.thickness);
}

/* Finds stations whose wafers interleave: they touch in no slot, but the blade finds no way. */
static void check_neighbour(wh_feasibility_t *check, size_t station, size_t other) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *s = &layout->stations[station];
    for (int32_t slot = 1; slot <= layout->places[station].slots; ++slot) {
        carried_t carried = enter(layout, station, slot, 0);
        carried.down = s->stroke - s->offset;
        carried.up = s->offset;
        const int32_t met = meets(&carried, other);
        if (met > 0) {
            wh_feasibility_add(
                check, WH_FINDING_SPACE, (int32_t)station,
                "%s and %s overlap: entering %s slot %d, the blade touches a wafer in %s slot %d", s->name,
                layout->stations[other].name, s->name, (int)slot, layout->stations[other].name, (int)met)
                ->other = (int32_t)other;
            return;
        }
    }
}

static bool is_said(const wh_feasibility_t *check, size_t station, size_t other) {
    for (size_t i = 0; i < check->count; ++i) {
        const wh_finding_t *finding = &check->findings[i];
        const bool forth = finding->station == (int32_t)station && finding->other == (int32_t)other;
        const bool back = finding->station == (int32_t)other && finding->other == (int32_t)station;
        if (finding->kind == WH_FINDING_SPACE && (forth || back)) {
            return true;
        }
    }
    return false;
}

static void check_neighbours(wh_feasibility_t *check, size_t station) {
    const wh_layout_t *layout = check->layout;
    const wh_box_t box = box_of(layout, station);
    for (size_t other = 0; layout->stations[station].taught && other < layout->station_count; ++other) {
        const wh_box_t around = box_of(layout, other);
        if (other != station && layout->stations[other].taught && wh_box_overlap(&box, &around) &&
            !is_said(check, station, other)) {
            check_neighbour(check, station, other);
        }
    }
}

/* ---------------------------------------------------------------------------------------------------- all */

void wh_feasibility_room(wh_feasibility_t *check, size_t station) {
    const wh_layout_t *layout = check->layout;
    check_entry(check, station);
    check_support(check, station);
    wh_feasibility_lifted(check, station);
    check_gaps(check, station);
    check_before(check, station);
    check_neighbours(check, station);
    for (int32_t g = 0; g < (int32_t)layout->machine.gripper_count; ++g) {
        const int32_t effector = layout->stations[station].effector;
        if (is_on_robot(layout, g) && g != effector &&
            layout->machine.mounts[g].robot == layout->machine.mounts[effector].robot) {
            check_beside(check, station, g);
        }
    }
}
