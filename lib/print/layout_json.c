#include <math.h>
#include <string.h>

#include "../layout/axes.h"
#include "../layout/grips.h"
#include "../layout/layout_fields.h"
#include "../layout/words.h"
#include "../math/trig.h"
#include "../text/json.h"
#include "layout_ports.h"
#include "layout_print.h"
#include "layout_times.h"

#define FORMAT 1

static void put_pose(json_t *object, const wh_pose_t *pose) {
    (void)wh_json_add(object, "at rotation", wh_json_vector(pose->r), wh_json_matrix(&pose->R), NULL);
}

static json_t *scalar(const wh_reader_field_t *row, const void *of) {
    const double value = wh_field_get(row, of);
    return row->kind == WH_SCALAR_SWITCH  ? json_boolean(value > 0)
           : row->kind == WH_SCALAR_WORD  ? wh_json_text(row->words[(size_t)value])
           : row->kind == WH_SCALAR_WHOLE ? json_integer((json_int_t)value)
                                          : wh_json_real(value);
}

/* Puts the members of a struct that have these names, which blanks separate. */
static json_t *put_scalars(json_t *object, const wh_reader_field_t *rows, const void *of, const char *names) {
    while (*names) {
        const wh_reader_field_t *row = rows;
        const size_t length = strcspn(names, " ");
        while (strlen(row->name) != length || strncmp(row->name, names, length) != 0) {
            ++row;
        }
        wh_json_put(object, row->name, scalar(row, of));
        names += length + strspn(names + length, " ");
    }
    return object;
}

/* Each member of a struct by its field's name, in the order of the rows. */
static json_t *scalars(const wh_reader_field_t *rows, const void *of) {
    json_t *object = json_object();
    for (const wh_reader_field_t *row = rows; row->name; ++row) {
        if (wh_field_is_member(row)) {
            wh_json_put(object, row->name, scalar(row, of));
        }
    }
    return object;
}

/* -------------------------------------------------------------------------------------------- the machine */

static json_t *axis(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_machine_t *machine = &layout->machine;
    const wh_real_t unit = wh_axis_turns(machine, i) ? wh_deg_from_rad(1) : 1;
    const wh_limits_t *limits = wh_machine_limits(machine, i);
    const wh_travel_t *travel = wh_machine_travel(machine, i);
    wh_real_t home[WH_AXES];
    if (!wh_axis_exists(machine, i)) {
        return NULL;
    }
    wh_machine_home(machine, home);
    size_t own = 0;
    const int32_t robot = wh_machine_robot_of(machine, i, &own);
    json_t *object = json_object();
    if (layout->robot_count > 1) {
        (void)wh_json_set(object, "robot %s", layout->robots[robot].name);
    }
    return wh_json_set(object, "name %s min %g max %g home %g speed %g acceleration %g jerk %g",
                       wh_axis_name(machine, i), travel->min * unit, travel->max * unit, home[i] * unit,
                       limits->speed * unit, limits->acceleration * unit, limits->jerk * unit);
}

/* Puts the slides of a chuck on a stage, and of pins. */
static void put_slides(json_t *object, const wh_mount_t *mount) {
    if (wh_mount_axes(mount) > 0 && mount->kind == WH_MOUNT_STAGE) {
        wh_json_put(object, "stage", wh_json_set(json_object(), "travel %g", mount->travel.max));
    } else if (wh_mount_axes(mount) > 0 && mount->kind == WH_MOUNT_PINS) {
        wh_json_put(object, "pins",
                    wh_json_set(json_object(), "up %g down %g", mount->travel.max, -mount->travel.min));
    }
}

/* Puts the grip of a gripper that has another one than vacuum. */
static void put_grip(json_t *object, const wh_grip_t *grip) {
    const wh_edge_t *edge = &grip->edge;
    if (grip->kind == WH_GRIP_VACUUM) {
        return;
    }
    (void)wh_json_set(object, "grip %s", wh_layout_grip_name(grip->kind));
    if (grip->kind == WH_GRIP_EDGE) {
        const wh_reader_field_t *rows = wh_layout_edge_grip_fields;
        json_t *values = put_scalars(json_object(), rows, edge,
                                     "rest plunger alpha clearance retracted gripped_from gripped_to");
        (void)wh_json_set(values, "stroke %g", edge->end - edge->retracted);
        wh_json_put(object, "edge", put_scalars(values, rows, edge, "speed"));
    }
}

static json_t *door(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_door_t *from = &layout->machine.doors[i];
    const wh_vec3_t open = wh_vec3_scale(from->travel, &from->way);
    json_t *object =
        wh_json_set(json_object(), "name %s home %s speed %g acceleration %g jerk %g timeout %g",
                    layout->door_list[i].name, wh_layout_door_words[from->is_open], from->limits.speed,
                    from->limits.acceleration, from->limits.jerk, layout->door_list[i].timeout);
    wh_json_put(object, "open", json_pack("[f, f, f]", open.x, open.y, open.z));
    return object;
}

static json_t *gripper(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_layout_gripper_t *from = &layout->grippers[i];
    json_t *object =
        wh_json_set(json_object(), "name %s on %s valve %s", from->name,
                    from->station == WH_NONE ? layout->robots[layout->machine.mounts[i].robot].name
                                             : layout->stations[from->station].name,
                    from->valve);
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, layout->machine.mounts[i].robot, NULL);
    if (from->station == WH_NONE && carrier && carrier->second) {
        (void)wh_json_set(object, carrier->chain.kind == WH_CHAIN_SCARA ? "wrist %d" : "arm %d",
                          layout->machine.mounts[i].arm + 1);
    }
    if (layout->machine.mounts[i].is_shifted) {
        put_pose(object, &layout->machine.mounts[i].effector_from_gripper);
    }
    put_slides(object, &layout->machine.mounts[i]);
    put_grip(object, &layout->grips[i]);
    return object;
}

/* ----------------------------------------------------------------------------------------------- stations */

static json_t *sensor(const wh_sensor_t *from) {
    json_t *object = put_scalars(json_object(), wh_layout_sensor_fields, from,
                                 "samples pixel length at encoder noise tilt offset zero gain latency");
    return wh_json_set(object, "hidden %d", from->hidden_count);
}

static json_t *beam(const wh_layout_t *layout, size_t b) {
    const wh_reader_field_t *rows = wh_layout_beam_fields;
    const wh_layout_beam_t *from = &layout->beams[b];
    json_t *object = put_scalars(json_object(), rows, from, "x y low high delay_on delay_off");
    (void)wh_json_set(object, "jitter %g", layout->doors[b].jitter);
    return wh_json_set(put_scalars(object, rows, from, "dx dy late"), "stuck %s",
                       wh_layout_beam_stuck_words[layout->doors[b].stuck]);
}

static json_t *beams_at(const wh_layout_t *layout, size_t s) {
    const wh_latch_order_t order = wh_layout_beams_at(layout, s);
    json_t *list = json_array();
    for (int32_t i = 0; i < order.count; ++i) {
        (void)json_array_append_new(list, beam(layout, (size_t)order.first + (size_t)i));
    }
    return list;
}

/* Puts those of several robots that come there, and the one that does so unless a command says otherwise. */
static json_t *servers(const wh_layout_t *layout, const wh_layout_station_t *station) {
    json_t *list = json_array();
    for (size_t r = 0; r < layout->robot_count; ++r) {
        if (station->by[r].serves) {
            (void)json_array_append_new(list,
                                        wh_json_set(json_object(), "robot %s unless_told %i",
                                                    layout->robots[r].name, station->robot == (int32_t)r));
        }
    }
    return list;
}

/* Robots beside those with axes, and the stations to which they come. */
static json_t *timed_robots(const wh_flow_tool_t *timed) {
    json_t *list = json_array();
    for (size_t r = 0; r < timed->robot_count; ++r) {
        json_t *stations = json_array();
        for (size_t s = 0; s < timed->station_count; ++s) {
            if (timed->serves[wh_flow_of(timed, (int32_t)r, (int32_t)s)]) {
                (void)json_array_append_new(stations, wh_json_text(timed->stations[s].name));
            }
        }
        json_t *robot =
            wh_json_set(json_object(), "robot %s arms %d", timed->robots[r].name, (int)timed->robots[r].arms);
        wh_json_put(robot, "stations", stations);
        (void)json_array_append_new(list, robot);
    }
    return list;
}

static json_t *station(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *from = &layout->stations[i];
    const wh_entry_t *entry = &check->entries[i];
    const wh_station_t *place = &layout->places[i];
    json_t *object = wh_json_set(json_object(), "name %s kind %s", from->name, wh_layout_station_kind(from));
    put_pose(object, &place->base_from_station);
    (void)wh_json_set(object, "slots %d pitch %g", place->slots, place->pitch);
    (void)put_scalars(object, wh_layout_station_fields, from, "stroke offset retract pickup_speed taught");
    (void)wh_json_set(object, "by_axes %i effector %s counts %i wafers %lld", from->by_axes,
                      layout->grippers[from->effector].name, from->counts, (json_int_t)entry->wafers);
    json_t *room = wh_json_set(
        json_object(), "above %g below %g beside %g before %g lifted %g",
        entry->has_above ? entry->above : HUGE_VAL, entry->has_below ? entry->below : HUGE_VAL,
        entry->has_beside ? entry->beside : HUGE_VAL, entry->has_before ? entry->before : HUGE_VAL,
        entry->has_lifted ? entry->lifted : HUGE_VAL);
    wh_json_put(object, "room", room);
    const wh_scanner_t *scanner = wh_layout_scanner(layout, place->chuck);
    (void)json_object_set_new(object, "sensor", scanner ? sensor(&scanner->sensor) : json_null());
    (void)json_object_set_new(object, "beams", beams_at(layout, i));
    (void)json_object_set_new(object, "centre", json_boolean(from->centre));
    if (from->by) {
        wh_json_put(object, "by", servers(layout, from));
    }
    if (from->times) {
        wh_json_put(object, "times", wh_layout_times_to_json(layout, from->times));
    }
    if (from->port) {
        wh_json_put(object, "port", wh_layout_port_to_json(from->port));
    }
    return object;
}

/* ------------------------------------------------------------------------------------------------- shapes */

static json_t *shapes(const wh_shapes_t *from) {
    return wh_json_add(
        json_object(), "blade ledge arm foup chuck", scalars(wh_layout_blade_fields, &from->blade),
        scalars(wh_layout_ledge_fields, &from->ledge), scalars(wh_layout_arm_fields, &from->arm),
        scalars(wh_layout_foup_fields, &from->shell), scalars(wh_layout_spindle_fields, &from->chuck), NULL);
}

static json_t *part(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    static const char *const kinds[] = {"wall", "ledge", "arm", "blade", "chuck", "door", "wafer"};
    static const char *const shapes_of[] = {"box", "cylinder", "capsule", "mesh"};
    const wh_layout_t *layout = check->layout;
    const wh_part_t *from = &layout->world.parts[i];
    const wh_pose_t pose = wh_feasibility_place(check, (int32_t)i);
    json_t *object = wh_json_set(json_object(), "name %s kind %s shape %s", layout->part_names[i],
                                 kinds[from->kind], shapes_of[from->convex.kind]);
    wh_json_put(object, "half",
                from->convex.kind == WH_CONVEX_MESH ? json_null() : wh_json_vector(from->convex.half));
    if (from->convex.kind == WH_CONVEX_MESH) {
        wh_json_put(object, "extent", wh_json_vector(wh_feasibility_extent(&from->convex)));
    }
    put_pose(object, &pose);
    return object;
}

static json_t *clearances(const wh_layout_t *layout) {
    json_t *object = json_object();
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        wh_json_put(object, wh_clearance_name((wh_clearance_kind_t)kind),
                    wh_json_real(layout->world.limits[kind]));
    }
    return object;
}

/* ---------------------------------------------------------------------------------------------------- all */

static json_t *wafer(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_layout_wafer_t *from = &layout->wafers[i];
    return wh_json_set(json_object(), "name %s station %s slot %d", from->name,
                       layout->stations[from->station].name, from->slot);
}

/* The debounce, in ms, stands in it only if there is one. */
static json_t *vacuum(const wh_layout_t *layout) {
    const wh_vacuum_config_t *from = &layout->physics.vacuum;
    json_t *object = scalars(wh_layout_vacuum_fields, from);
    return from->debounce > 0 ? wh_json_set(object, "debounce %g", wh_layout_debounce_ms(layout)) : object;
}

static json_t *pads(const wh_pads_t *from) {
    return from->mass > 0 ? scalars(wh_layout_pads_fields, from) : json_null();
}

/* Null for a thing that the fault does not concern. */
static void put_target(json_t *object, const char *key, bool is_its, const char *name) {
    wh_json_put(object, key, is_its ? wh_json_text(name) : json_null());
}

/* The door, the station, the beam or the robot that a fault concerns. */
static void put_place(json_t *object, const wh_layout_t *layout, const wh_fault_t *from) {
    if (wh_fault_is_of_door(from->kind)) {
        put_target(object, "door", true, layout->door_list[from->target].name);
    } else if (wh_fault_is_of_station(from->kind)) {
        put_target(object, "station", true, layout->stations[from->target].name);
    } else if (wh_fault_is_of_beam(from->kind)) {
        const int32_t station = layout->beams[from->target].station;
        const int32_t first = wh_layout_beams_at(layout, (size_t)station).first;
        put_target(object, "station", true, layout->stations[station].name);
        (void)wh_json_set(object, "beam %d", from->target - first + 1);
    } else if (wh_fault_is_of_controller(from->kind)) {
        put_target(object, "robot", true, layout->robots[from->target].name);
    }
}

static json_t *fault(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_fault_t *from = &layout->physics.faults[i];
    const double slice_s = (double)layout->slice_us / 1e6;
    const bool endless = from->until == WH_FAULT_FOREVER;
    const bool of_wafer = wh_fault_is_of_wafer(from->kind);
    const bool of_place = wh_fault_is_of_door(from->kind) || wh_fault_is_of_beam(from->kind) ||
                          wh_fault_is_of_station(from->kind) || wh_fault_is_of_controller(from->kind);
    const bool of_gripper = from->target != WH_NONE && !of_wafer && !of_place;
    json_t *object = wh_json_set(json_object(), "kind %s", wh_fault_name(from->kind));
    put_target(object, "gripper", of_gripper, of_gripper ? layout->grippers[from->target].name : "");
    put_target(object, "wafer", of_wafer, of_wafer ? layout->wafers[from->target].name : "");
    put_place(object, layout, from);
    return wh_json_set(object, "from_s %g until_s %g value %g", (double)(from->from - 1) * slice_s,
                       endless ? HUGE_VAL : (double)(from->until - 1) * slice_s, from->value);
}

static json_t *finding(const wh_feasibility_t *check, size_t i) {
    const wh_layout_t *layout = check->layout;
    const wh_finding_t *from = &check->findings[i];
    json_t *object =
        wh_json_set(json_object(), "kind %s text %s station %s slot %lld", wh_finding_name(from->kind),
                    from->text, from->station == WH_NONE ? NULL : layout->stations[from->station].name,
                    from->slot > 0 ? from->slot : WH_JSON_NONE);
    if (from->parts[0] != WH_NONE) {
        wh_json_put(object, "parts",
                    json_pack("[o, o]", wh_json_text(wh_layout_part_name(layout, from->parts[0])),
                              wh_json_text(wh_layout_part_name(layout, from->parts[1]))));
    }
    return object;
}

/* Puts the findings that are warnings, or those that are not. */
static json_t *findings(const wh_feasibility_t *check, bool warnings) {
    json_t *list = json_array();
    for (size_t i = 0; i < check->count; ++i) {
        if (check->findings[i].is_warning == warnings) {
            json_array_append_new(list, finding(check, i));
        }
    }
    return list;
}

static json_t *corrections(const wh_corrections_t *from) {
    return wh_json_set(json_object(), "x %g y %g z %g turn_deg %g", from->x, from->y, from->z,
                       from->turn_deg);
}

static void put_checks(const wh_layout_t *layout, json_t *root) {
    const wh_tolerance_t *from = &layout->grasp.tolerance;
    json_t *tolerance = wh_json_set(json_object(), "name %s", layout->tolerance_name);
    (void)put_scalars(tolerance, wh_layout_tolerance_fields, from, "projz projxy planar");
    json_t *defaults = json_array();
    for (size_t i = 0; i < WH_TOLERANCE_LIMITS; ++i) {
        if (layout->tolerance_default[i]) {
            json_array_append_new(defaults, json_string(wh_layout_tolerance_fields[i].name));
        }
    }
    wh_json_put(tolerance, "defaults", defaults);
    (void)wh_json_set(root, "wafer_diameter %g wafer_thickness %g notch_deg %g notch_depth %g",
                      layout->wafer_diameter, layout->wafer_thickness,
                      layout->notch_depth > 0 ? wh_deg_from_rad(layout->notch) : HUGE_VAL,
                      layout->notch_depth);
    wh_json_put(root, "tolerance", tolerance);
    (void)wh_json_set(root, "check %s slice_s %g seat %i settle %i collision %i",
                      wh_layout_check_words[layout->grasp.check], (double)layout->slice_us / 1e6,
                      layout->grasp.seat, layout->cell.settle, layout->collision);
}

int wh_layout_print_json(const wh_feasibility_t *check, FILE *out) {
    const wh_layout_t *layout = check->layout;
    json_t *root =
        wh_json_set(json_object(), "format %d ok %i layout %s", FORMAT, check->wrong == 0, layout->path);
    put_checks(layout, root);
    (void)wh_json_add(root, "axes grippers stations wafers vacuum pads faults",
                      wh_json_list(axis, layout, wh_machine_robot_axes(&layout->machine)),
                      wh_json_list(gripper, layout, layout->machine.gripper_count),
                      wh_json_list(station, check, layout->station_count),
                      wh_json_list(wafer, layout, layout->wafer_count), vacuum(layout),
                      pads(&layout->physics.pads), wh_json_list(fault, layout, layout->physics.fault_count),
                      NULL);
    if (layout->machine.door_count > 0) {
        wh_json_put(root, "doors", wh_json_list(door, layout, layout->machine.door_count));
    }
    if (layout->timed) {
        wh_json_put(root, "times_alone", timed_robots(layout->timed));
    }
    if (layout->carrier_count > 0) {
        wh_json_put(root, "carriers", wh_json_list(wh_layout_carrier_to_json, layout, layout->carrier_count));
    }
    (void)wh_json_add(root, "corrections shapes parts clearance findings warnings",
                      corrections(&layout->corrections), shapes(&layout->shapes),
                      wh_json_list(part, check, layout->world.part_count), clearances(layout),
                      findings(check, false), findings(check, true), NULL);
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
