/* A layout's doors: walls that move, which stations have one, and which stations have pins. */
#include <string.h>

#include "../layout/doors.h"
#include "layout_internal.h"

/* Other things that obstacles may be mounted on; no door may have these names. */
static const char *const bodies[] = {"base", "lift", "upper arm", "forearm", "hand", "column", "robot"};

static void check_name(wh_reader_t *reader, const wh_layout_t *layout, const char *name) {
    bool is_taken = wh_layout_find_gripper(layout, name) != WH_NONE ||
                    wh_layout_find_robot(layout, name) != WH_NONE ||
                    wh_layout_find_station(layout, name) != WH_NONE;
    for (size_t i = 0; i < sizeof bodies / sizeof bodies[0]; ++i) {
        is_taken = is_taken || strcmp(name, bodies[i]) == 0;
    }
    if (is_taken) {
        wh_reader_refuse(reader, NULL, name,
                         "a door's name that no gripper, robot, station or body of the arm has");
    }
}

static void read_limits(wh_reader_t *reader, wh_door_t *door) {
    if (wh_reader_has(reader, "seconds")) {
        door->limits = wh_layout_usual_limits(wh_layout_door_fields, false);
        wh_layout_read_seconds(reader, door->travel, &door->limits);
    } else {
        wh_layout_read_limits(reader, &door->limits);
    }
}

static void read_way(wh_reader_t *reader, wh_door_t *door) {
    const wh_vec3_t open = wh_reader_vector(reader, "open", NULL);
    door->travel = wh_vec3_norm(&open);
    if (!(door->travel >= 1 && door->travel <= 5000)) {
        (void)wh_reader_push(reader, "open");
        wh_reader_fail(reader, "open", "where the wall goes as the door opens, 1 to 5000 mm away");
    }
    door->way = wh_vec3_scale(1 / door->travel, &open);
}

static void read_door(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_door_t *entry,
                      wh_door_t *door) {
    wh_convex_t wall;
    memset(&wall, 0, sizeof wall);
    wh_reader_enter(reader, entry->name);
    wh_reader_refuse_unknown(reader, wh_layout_door_fields);
    check_name(reader, layout, entry->name);
    wh_layout_read_shape(reader, layout, entry->name, &wall);
    read_way(reader, door);
    read_limits(reader, door);
    door->is_open = wh_reader_apart(reader, "home") > 0;
    entry->timeout = wh_reader_apart(reader, "timeout");
    wh_reader_leave(reader);
}

static void take_axes(wh_reader_t *reader, wh_machine_t *machine, const wh_door_t *doors, size_t count) {
    if (machine->axis_count + count > WH_AXES) {
        lua_pushinteger(reader->L, (lua_Integer)count);
        wh_reader_fail(reader, NULL, "at most %d doors: the cell's other mechanisms have %d of %d axes",
                       (int)(WH_AXES - machine->axis_count), (int)machine->axis_count, WH_AXES);
    }
    machine->axis_count += count;
    machine->doors = doors;
    machine->door_count = count;
}

/* ------------------------------------------------------------------------------------- whose each one is */

/* The door that the table at which the reader is names; else `fallback`. */
static int32_t read_named(wh_reader_t *reader, const wh_layout_t *layout, int32_t fallback) {
    return wh_reader_has(reader, "door")
               ? wh_layout_read_name(reader, layout, "door", NULL, wh_layout_find_door,
                                     layout->machine.door_count > 0
                                         ? "the name of one of this layout's doors"
                                         : "nothing: the layout has no `doors`, which are walls that move")
               : fallback;
}

/* A station has the pins that are on it, named or not. */
static void check_pins(wh_reader_t *reader, const wh_layout_t *layout, size_t station) {
    char name[WH_NAME_SIZE];
    const int32_t pins = wh_layout_find_pins(layout, (int32_t)station);
    if (!wh_reader_has(reader, "pins")) {
        return;
    }
    wh_reader_text(reader, "pins", NULL, name, sizeof name);
    if (pins == WH_NONE) {
        wh_reader_refuse(reader, "pins", name, "nothing: no gripper with `pins` is on this station");
    } else if (wh_layout_find_gripper(layout, name) != pins) {
        wh_reader_refuse(reader, "pins", name, "%s, which is on this station", layout->grippers[pins].name);
    }
}

/* The robot's own way in may lead through another door. */
static void read_own(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_station_t *station) {
    const bool is_said = wh_reader_enter(reader, "by");
    for (size_t r = 0; station->by && r < layout->robot_count; ++r) {
        station->by[r].door = station->door;
        if (is_said && wh_reader_enter(reader, layout->robots[r].name)) {
            station->by[r].door = read_named(reader, layout, station->door);
            wh_reader_leave(reader);
        }
    }
    if (is_said) {
        wh_reader_leave(reader);
    }
}

static void read_owners(wh_reader_t *reader, wh_layout_t *layout) {
    wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_reader_enter(reader, layout->stations[s].name);
        layout->stations[s].door = read_named(reader, layout, WH_NONE);
        check_pins(reader, layout, s);
        read_own(reader, layout, &layout->stations[s]);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

void wh_layout_read_doors(wh_reader_t *reader, wh_layout_t *layout) {
    if (wh_reader_enter(reader, "doors")) {
        size_t count = 0;
        layout->door_list = wh_layout_read_keys(reader, WH_DOORS, sizeof *layout->door_list, "doors", &count);
        wh_door_t *doors = wh_layout_memory(reader->L, count, sizeof *doors);
        for (size_t d = 0; d < count; ++d) {
            read_door(reader, layout, &layout->door_list[d], &doors[d]);
        }
        take_axes(reader, &layout->machine, doors, count);
        wh_reader_leave(reader);
    }
    read_owners(reader, layout);
}
