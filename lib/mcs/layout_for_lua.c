/* A layout as lua/mcs sees it: a table of what motion control may know of the cell. */
#include "../flow/clock.h"
#include "../layout/axes.h"
#include "../layout/layout_fields.h"
#include "../layout/ports.h"
#include "../layout/times.h"
#include "../layout/words.h"
#include "../script/wh_module_values.h"
#include "native.h"

/* True if its slots lie exactly above one another, to the last bit. */
static bool is_upright(const wh_station_t *place) {
    const wh_vec3_t up = wh_mat3_column(&place->base_from_station.R, 2);
    return !(wh_real_abs(up.x) > 0 || wh_real_abs(up.y) > 0);
}

/* robot: the robot that serves it by default, nil: a command must name one; by: for each robot the gripper
 * that serves it, or false. */
static void push_servers(lua_State *L, const wh_layout_t *layout, const wh_layout_station_t *station) {
    wh_lua_set_index(L, "robot", station->by ? station->robot : 0);
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const bool serves = !station->by || station->by[r].serves;
        if (serves) {
            lua_pushinteger(L, (station->by ? station->by[r].effector : station->effector) + 1);
        } else {
            lua_pushboolean(L, false);
        }
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -2, "by");
}

/* doors: by robot the door of the station, or false; nil: there is none, also for robots that are times
 * alone. */
static void push_doors_of(lua_State *L, const wh_layout_t *layout, size_t station) {
    bool is_any = false;
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const int32_t door = wh_layout_door_of(layout, station, r);
        if (door == WH_NONE) {
            lua_pushboolean(L, false);
        } else {
            lua_pushinteger(L, door + 1);
        }
        lua_rawseti(L, -2, (lua_Integer)r + 1);
        is_any = is_any || door != WH_NONE;
    }
    for (int32_t r = 0; layout->timed && r < (int32_t)layout->timed->robot_count; ++r) {
        is_any = is_any || layout->timed->doors[wh_flow_of(layout->timed, r, (int32_t)station)].is_real;
    }
    if (!is_any) {
        lua_pop(L, 1);
        lua_pushnil(L);
    }
    lua_setfield(L, -2, "doors");
}

/* takes_time; is_port, of a load port; and of a load lock sides: by robot where it comes; door_sides: by
 * door. */
static void push_times(lua_State *L, const wh_layout_t *layout, size_t station) {
    const wh_layout_times_t *times = layout->stations[station].times;
    wh_lua_set_boolean(L, "takes_time", times || layout->stations[station].port);
    wh_lua_set_boolean(L, "is_port", layout->stations[station].port != NULL);
    if (!times || !times->of.is_lock) {
        return;
    }
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const wh_flow_side_t side = wh_layout_side_of(layout, station, r);
        if (side == WH_FLOW_BOTH) {
            lua_pushboolean(L, false);
        } else {
            lua_pushstring(L, wh_flow_side_words[side]);
        }
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -2, "sides");
    lua_newtable(L);
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        if ((times->doors >> d & 1U) != 0) {
            const bool is_vacuum = (times->side_doors[WH_FLOW_VACUUM] >> d & 1U) != 0;
            lua_pushstring(L, wh_flow_side_words[is_vacuum ? WH_FLOW_VACUUM : WH_FLOW_ATMOSPHERE]);
            lua_rawseti(L, -2, (lua_Integer)d + 1);
        }
    }
    lua_setfield(L, -2, "door_sides");
}

/* A point: the robot's axes that the layout gives, by number from 1, rad and mm; and blend. */
static void push_via(lua_State *L, const wh_layout_via_t *via) {
    lua_createtable(L, WH_CARRIER_AXES, 1);
    for (size_t axis = 0; axis < WH_CARRIER_AXES; ++axis) {
        if (via->is_given[axis]) {
            lua_pushnumber(L, via->point.q[axis]);
            lua_rawseti(L, -2, (lua_Integer)axis + 1);
        }
    }
    wh_lua_set_number(L, "blend", via->point.blend);
}

/* vias: by robot the list of its points. */
static void push_vias(lua_State *L, const wh_layout_t *layout, size_t station) {
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const wh_layout_vias_t *vias = wh_layout_vias_of(layout, station, r);
        lua_createtable(L, (int)vias->count, 0);
        for (size_t i = 0; i < vias->count; ++i) {
            push_via(L, &vias->at[i]);
            lua_rawseti(L, -2, (lua_Integer)i + 1);
        }
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -2, "vias");
}

/* beams: for each robot the number of the station's beams on its way in; centres: whether its PUT corrects by
 * their result. */
static void push_beams_of(lua_State *L, const wh_layout_t *layout, size_t station) {
    lua_createtable(L, (int)layout->robot_count, 0);
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        lua_pushinteger(L, wh_layout_beams_of(layout, station, r).count);
        lua_rawseti(L, -3, (lua_Integer)r + 1);
        lua_pushboolean(L, wh_layout_centres(layout, station, r));
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -3, "centres");
    lua_setfield(L, -2, "beams");
}

/* Each scalar of a struct by its field's name; angles in degrees. */
static void push_scalars(lua_State *L, const wh_reader_field_t *rows, const void *of) {
    for (const wh_reader_field_t *row = rows; row->name; ++row) {
        const double value = wh_field_get(row, of);
        if (row->kind == WH_SCALAR_SWITCH) {
            wh_lua_set_boolean(L, row->name, value > 0);
        } else if (row->kind == WH_SCALAR_WORD) {
            wh_lua_set_text(L, row->name, row->words[(size_t)value]);
        } else if (wh_field_is_member(row)) {
            wh_lua_set_number(L, row->name, value);
        }
    }
}

static void push_station(lua_State *L, const wh_layout_t *layout, size_t index) {
    const wh_layout_station_t *station = &layout->stations[index];
    const wh_station_t *place = &layout->places[index];
    lua_createtable(L, 0, 30);
    push_scalars(L, wh_layout_station_fields, station);
    wh_lua_set_number(L, "pitch", place->pitch);
    wh_lua_set_boolean(L, "release_default", station->release_default);
    wh_lua_set_text(L, "name", station->name);
    wh_lua_set_index(L, "index", (int32_t)index);
    wh_lua_set_integer(L, "slots", place->slots);
    wh_lua_set_index(L, "chuck", place->chuck);
    wh_lua_set_index(L, "pins", wh_layout_find_pins(layout, (int32_t)index));
    wh_lua_set_index(L, "effector", station->effector);
    push_servers(L, layout, station);
    push_doors_of(L, layout, index);
    push_times(L, layout, index);
    push_vias(L, layout, index);
    wh_lua_set_boolean(L, "upright", is_upright(place));
    wh_lua_set_boolean(L, "flipper", station->flipper);
    if (station->face != WH_STATION_ANY_FACE) {
        wh_lua_set_text(L, "face", wh_layout_face_name(station->face));
    }
    wh_lua_set_number(L, "radius", layout->wafer_diameter / 2);
    wh_lua_set_number(L, "notch", layout->notch);
    push_beams_of(L, layout, index);
    wh_lua_set_boolean(L, "block", station->block.is_there);
    const wh_scanner_t *scanner = wh_layout_scanner(layout, place->chuck);
    if (scanner) {
        wh_mcs_push_edge_sensor(L, layout, scanner);
        lua_setfield(L, -2, "sensor");
    }
}

/* edge: { travel: the time of the whole stroke, s, clearance, mm, and the ends of the plunger's window and
 * stroke: `to` and `stop`, mm }. */
static void push_edge(lua_State *L, const wh_edge_t *edge) {
    lua_createtable(L, 0, 4);
    wh_lua_set_number(L, "to", edge->gripped_to);
    wh_lua_set_number(L, "stop", edge->end);
    wh_lua_set_number(L, "travel", (edge->end - edge->retracted) / edge->speed);
    wh_lua_set_number(L, "clearance", edge->clearance);
    lua_setfield(L, -2, "edge");
}

/* { name, on_robot, axis, grip, edge }; for a chuck on a stage, pins and a flipper's clamp also `kind` and
 * its travel, `low` and `high`. */
static void push_gripper(lua_State *L, const wh_layout_t *layout, size_t g) {
    const wh_mount_t *mount = &layout->machine.mounts[g];
    lua_createtable(L, 0, 3);
    wh_lua_set_text(L, "name", layout->grippers[g].name);
    wh_lua_set_boolean(L, "on_robot", layout->grippers[g].station == WH_NONE);
    if (layout->grippers[g].station == WH_NONE) {
        wh_lua_set_index(L, "robot", mount->robot);
    }
    wh_lua_set_index(L, "axis", mount->axis);
    wh_lua_set_index(L, "arm", mount->arm);
    wh_lua_set_text(L, "grip", wh_layout_grip_name(layout->grips[g].kind));
    if (layout->grips[g].kind == WH_GRIP_EDGE) {
        push_edge(L, &layout->grips[g].edge);
    }
    if (wh_mount_axes(mount) > 0 && mount->kind != WH_MOUNT_CHUCK) {
        wh_lua_set_text(L, "kind", wh_layout_mount_words[mount->kind]);
        wh_lua_set_number(L, "low", mount->travel.min);
        wh_lua_set_number(L, "high", mount->travel.max);
    }
}

/* { name, axis, travel, timeout }. */
static void push_door(lua_State *L, const wh_layout_t *layout, size_t door) {
    const wh_machine_t *machine = &layout->machine;
    lua_createtable(L, 0, 4);
    wh_lua_set_text(L, "name", layout->door_list[door].name);
    wh_lua_set_index(L, "axis", (int32_t)wh_machine_door_axis(machine, door));
    wh_lua_set_number(L, "travel", machine->doors[door].travel);
    wh_lua_set_number(L, "timeout", layout->door_list[door].timeout);
}

/* For two arms or wrists: arms, the indices of their own axes; headings, the direction of each arm with
 * theta at 0; and whether they retract before the robot turns. With a transit they retract on its ways. */
static void push_arms(lua_State *L, const wh_carrier_t *carrier, size_t first, bool has_transit) {
    const bool is_wrist = carrier->chain.kind == WH_CHAIN_SCARA;
    lua_createtable(L, 2, 0);
    lua_pushinteger(L, (lua_Integer)first + (is_wrist ? WH_AXIS_YAW : WH_AXIS_R) + 1);
    lua_rawseti(L, -2, 1);
    lua_pushinteger(L, (lua_Integer)first + (lua_Integer)carrier->axis_count);
    lua_rawseti(L, -2, 2);
    lua_setfield(L, -2, "arms");
    if (!is_wrist) {
        const wh_real_t headings[] = {carrier->chain.arm_heading, carrier->second->chain.arm_heading};
        wh_lua_push_numbers(L, headings, 2);
        lua_setfield(L, -2, "headings");
    }
    wh_lua_set_boolean(L, "retracts", !is_wrist && !has_transit);
}

/* { name, first: the index of the robot's first axis, home: by its own axes, axes: for each axis, in
 * order, its name, its index and whether it turns }. */
static void push_robot(lua_State *L, const wh_layout_t *layout, size_t robot) {
    const wh_machine_t *machine = &layout->machine;
    size_t first;
    const wh_carrier_t *carrier = wh_machine_carrier(machine, robot, &first);
    const size_t count = carrier ? carrier->axis_count : WH_ROBOT_AXES;
    wh_real_t home[WH_AXES];
    wh_machine_home(machine, home);
    lua_createtable(L, 0, 4);
    wh_lua_set_text(L, "name", layout->robots[robot].name);
    wh_lua_set_index(L, "first", (int32_t)first);
    wh_lua_set_boolean(L, "is_usual", wh_layout_is_usual(layout, robot));
    wh_lua_push_numbers(L, &home[first], count);
    lua_setfield(L, -2, "home");
    lua_createtable(L, (int)count, 0);
    for (size_t axis = first; axis < first + count; ++axis) {
        if (wh_axis_exists(machine, axis)) {
            lua_createtable(L, 0, 3);
            wh_lua_set_text(L, "name", wh_axis_name(machine, axis));
            wh_lua_set_index(L, "index", (int32_t)axis);
            wh_lua_set_boolean(L, "turns", wh_axis_turns(machine, axis));
            lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
        }
    }
    lua_setfield(L, -2, "axes");
    if (carrier && carrier->second) {
        push_arms(L, carrier, first, layout->robots[robot].transit > 0);
    }
}

/* The time from a valve's closing until its gripper lets go, s. */
static double time_to_vent(const wh_vacuum_config_t *vacuum) {
    return vacuum->vent > 0 ? -vacuum->vent * wh_ln(vacuum->release) : 0;
}

/* timed_robots: the names of those beside robots with axes. */
static void push_timed(lua_State *L, const wh_layout_t *layout) {
    const size_t count = layout->timed ? layout->timed->robot_count : 0;
    lua_createtable(L, (int)count, 0);
    for (size_t r = 0; r < count; ++r) {
        lua_pushstring(L, layout->timed->robots[r].name);
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -2, "timed_robots");
}

/* { path, patterns (or nil), timed_robots, slice, sampled, homed, seat, thickness, vent, tolerance, robots in
 * order, corrections: the largest ones, by a command's field, the turn in degrees, grippers and doors in
 * order, stations by name }: lengths in mm, other angles in rad, times in s. */
void wh_mcs_push_layout(lua_State *L, const wh_layout_t *layout) {
    lua_createtable(L, 0, 9);
    wh_lua_set_text(L, "path", layout->path);
    if (layout->patterns) {
        wh_lua_set_text(L, "patterns", layout->patterns);
    }
    wh_lua_set_number(L, "slice", (double)layout->slice_us / 1e6);
    wh_lua_set_boolean(L, "sampled", layout->grasp.check == WH_CHECK_SAMPLED);
    wh_lua_set_boolean(L, "homed", layout->homed);
    wh_lua_set_boolean(L, "seat", layout->grasp.seat);
    wh_lua_set_boolean(L, "timed", layout->tool != NULL);
    push_timed(L, layout);
    wh_lua_set_number(L, "thickness", layout->wafer_thickness);
    wh_lua_set_number(L, "vent", time_to_vent(&layout->physics.vacuum));
    wh_lua_push_tolerance(L, &layout->grasp.tolerance);
    lua_setfield(L, -2, "tolerance");
    lua_createtable(L, 0, (int)layout->station_count);
    for (size_t s = 0; s < layout->station_count; ++s) {
        push_station(L, layout, s);
        lua_setfield(L, -2, layout->stations[s].name);
    }
    lua_setfield(L, -2, "stations");
    lua_createtable(L, (int)layout->machine.gripper_count, 0);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        push_gripper(L, layout, g);
        lua_rawseti(L, -2, (lua_Integer)g + 1);
    }
    lua_setfield(L, -2, "grippers");
    lua_createtable(L, (int)layout->machine.door_count, 0);
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        push_door(L, layout, d);
        lua_rawseti(L, -2, (lua_Integer)d + 1);
    }
    lua_setfield(L, -2, "doors");
    lua_createtable(L, (int)layout->robot_count, 0);
    for (size_t r = 0; r < layout->robot_count; ++r) {
        push_robot(L, layout, r);
        lua_rawseti(L, -2, (lua_Integer)r + 1);
    }
    lua_setfield(L, -2, "robots");
    lua_createtable(L, 0, 4);
    wh_lua_set_number(L, "dx", layout->corrections.x);
    wh_lua_set_number(L, "dy", layout->corrections.y);
    wh_lua_set_number(L, "dz", layout->corrections.z);
    wh_lua_set_number(L, "turn", layout->corrections.turn_deg);
    lua_setfield(L, -2, "corrections");
    lua_createtable(L, (int)layout->carrier_count, 0);
    for (size_t c = 0; c < layout->carrier_count; ++c) {
        lua_pushstring(L, layout->carriers[c].name);
        lua_rawseti(L, -2, (lua_Integer)c + 1);
    }
    lua_setfield(L, -2, "carriers");
}
