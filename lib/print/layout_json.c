#include "../math/trig.h"
#include "../text/json.h"
#include "layout_print.h"

#define FORMAT 1

static void put_pose(json_t *object, const wh_pose_t *pose) {
    (void)wh_json_add(object, "at rotation", wh_json_vector(pose->r), wh_json_matrix(&pose->R), NULL);
}

/* -------------------------------------------------------------------------------------------- the machine */

static json_t *axis(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    const wh_robot_t *robot = &layout->machine.robot;
    const wh_real_t unit = i == WH_AXIS_THETA || i == WH_AXIS_YAW ? wh_deg_from_rad(1) : 1;
    return wh_json_add(json_object(), "name min max home speed acceleration jerk", wh_json_text(names[i]),
                       wh_json_real(robot->travel[i].min * unit), wh_json_real(robot->travel[i].max * unit),
                       wh_json_real(robot->home[i] * unit), wh_json_real(robot->limits[i].speed * unit),
                       wh_json_real(robot->limits[i].acceleration * unit),
                       wh_json_real(robot->limits[i].jerk * unit), NULL);
}

static json_t *gripper(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_layout_gripper_t *from = &layout->grippers[i];
    json_t *object =
        wh_json_add(json_object(), "name on valve", wh_json_text(from->name),
                    wh_json_text(from->station == WH_NONE ? "robot" : layout->stations[from->station].name),
                    wh_json_text(from->valve), NULL);
    if (layout->machine.mounts[i].is_shifted) {
        put_pose(object, &layout->machine.mounts[i].effector_from_gripper);
    }
    return object;
}

/* ----------------------------------------------------------------------------------------------- stations */

static json_t *gap_of(bool has, wh_real_t gap) {
    return has ? wh_json_real(gap) : json_null();
}

static json_t *station(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *from = &layout->stations[i];
    const wh_entry_t *entry = &check->entries[i];
    const char *kind = from->foup ? "foup" : "slots";
    const wh_station_t *place = &layout->places[i];
    json_t *room =
        wh_json_add(json_object(), "above below beside", gap_of(entry->has_above, entry->above),
                    gap_of(entry->has_below, entry->below), gap_of(entry->has_beside, entry->beside), NULL);
    return wh_json_add(
        json_object(),
        "name kind at rotation slots pitch stroke offset retract pickup_speed taught effector wafers room",
        wh_json_text(from->name), wh_json_text(from->prealigner ? "prealigner" : kind),
        wh_json_vector(place->base_from_station.r), wh_json_matrix(&place->base_from_station.R),
        json_integer(place->slots), wh_json_real(place->pitch), wh_json_real(from->stroke),
        wh_json_real(from->offset), wh_json_real(from->retract), wh_json_real(from->pickup_speed),
        json_boolean(from->taught), wh_json_text(layout->grippers[from->effector].name),
        json_integer((json_int_t)entry->wafers), room, NULL);
}

/* ------------------------------------------------------------------------------------------------- shapes */

static json_t *shapes(const wh_shapes_t *from) {
    json_t *blade = wh_json_add(json_object(), "thickness half_width finger length palm",
                                wh_json_real(from->blade.thickness), wh_json_real(from->blade.half_width),
                                wh_json_real(from->blade.finger), wh_json_real(from->blade.length),
                                wh_json_real(from->blade.palm), NULL);
    json_t *ledge = wh_json_add(json_object(), "inner outer thickness length",
                                wh_json_real(from->ledge.inner), wh_json_real(from->ledge.outer),
                                wh_json_real(from->ledge.thickness), wh_json_real(from->ledge.length), NULL);
    json_t *arm = wh_json_add(json_object(), "reach link right_handed", wh_json_real(from->arm.reach),
                              wh_json_real(from->arm.link), json_boolean(from->arm.right_handed), NULL);
    json_t *foup = wh_json_add(json_object(), "room wall floor roof", wh_json_real(from->shell.room),
                               wh_json_real(from->shell.wall), wh_json_real(from->shell.floor),
                               wh_json_real(from->shell.roof), NULL);
    json_t *chuck = wh_json_add(json_object(), "radius height body", wh_json_real(from->chuck.radius),
                                wh_json_real(from->chuck.height), wh_json_real(from->chuck.body), NULL);
    return wh_json_add(json_object(), "blade ledge arm foup chuck", blade, ledge, arm, foup, chuck, NULL);
}

static json_t *part(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    static const char *const kinds[] = {"wall", "ledge", "arm", "blade", "chuck", "wafer"};
    static const char *const shapes_of[] = {"box", "cylinder", "capsule", "mesh"};
    const wh_layout_t *layout = check->layout;
    const wh_part_t *from = &layout->world.parts[i];
    const wh_pose_t pose = wh_feasibility_place(check, (int32_t)i);
    json_t *object = wh_json_add(
        json_object(), "name kind shape half", wh_json_text(layout->part_names[i]),
        wh_json_text(kinds[from->kind]), wh_json_text(shapes_of[from->convex.kind]),
        from->convex.kind == WH_CONVEX_MESH ? json_null() : wh_json_vector(from->convex.half), NULL);
    put_pose(object, &pose);
    return object;
}

static json_t *clearances(const wh_layout_t *layout) {
    json_t *object = json_object();
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        wh_json_put_real(object, wh_clearance_name((wh_clearance_kind_t)kind), layout->world.limits[kind]);
    }
    return object;
}

/* ---------------------------------------------------------------------------------------------------- all */

static json_t *wafer(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_layout_wafer_t *from = &layout->wafers[i];
    return wh_json_add(json_object(), "name station slot", wh_json_text(from->name),
                       wh_json_text(layout->stations[from->station].name), json_integer(from->slot), NULL);
}

static json_t *vacuum(const wh_vacuum_config_t *from) {
    return wh_json_add(json_object(), "build vent idle sensor_on sensor_off release",
                       wh_json_real(from->build), wh_json_real(from->vent), wh_json_real(from->idle),
                       wh_json_real(from->on), wh_json_real(from->off), wh_json_real(from->release), NULL);
}

static json_t *pads(const wh_pads_t *from) {
    return from->mass > 0 ? wh_json_add(json_object(), "friction force mass gravity",
                                        wh_json_real(from->friction), wh_json_real(from->force),
                                        wh_json_real(from->mass), wh_json_real(from->gravity), NULL)
                          : json_null();
}

static json_t *fault(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_fault_t *from = &layout->physics.faults[i];
    const double slice_s = (double)layout->slice_us / 1e6;
    const bool endless = from->until == WH_FAULT_FOREVER;
    const bool targeted = from->target != WH_NONE;
    const bool of_wafer = wh_fault_is_of_wafer(from->kind);
    return wh_json_add(json_object(), "kind gripper wafer from_s until_s value",
                       wh_json_text(wh_fault_name(from->kind)),
                       wh_json_text(targeted && !of_wafer ? layout->grippers[from->target].name : NULL),
                       wh_json_text(targeted && of_wafer ? layout->wafers[from->target].name : NULL),
                       wh_json_real((double)(from->from - 1) * slice_s),
                       endless ? json_null() : json_real((double)(from->until - 1) * slice_s),
                       wh_json_real(from->value), NULL);
}

static json_t *finding(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    const wh_layout_t *layout = check->layout;
    const wh_finding_t *from = &check->findings[i];
    const bool of_station = from->station != WH_NONE;
    json_t *object =
        wh_json_add(json_object(), "kind text station", wh_json_text(wh_finding_name(from->kind)),
                    wh_json_text(from->text),
                    wh_json_text(of_station ? layout->stations[from->station].name : NULL), NULL);
    if (from->parts[0] != WH_NONE) {
        wh_json_put(object, "parts",
                    json_pack("[o, o]", wh_json_text(wh_layout_part_name(layout, from->parts[0])),
                              wh_json_text(wh_layout_part_name(layout, from->parts[1]))));
    }
    return object;
}

static void put_checks(const wh_layout_t *layout, json_t *root) {
    const wh_tolerance_t *from = &layout->grasp.tolerance;
    json_t *tolerance =
        wh_json_add(json_object(), "name projz projxy planar", wh_json_text(layout->tolerance_name),
                    wh_json_real(from->projz), wh_json_real(from->projxy), wh_json_real(from->planar), NULL);
    (void)wh_json_add(root, "wafer_diameter wafer_thickness notch_deg notch_depth",
                      wh_json_real(layout->wafer_diameter), wh_json_real(layout->wafer_thickness),
                      wh_json_real((double)wh_deg_from_rad((wh_real_t)layout->notch)),
                      wh_json_real(layout->notch_depth), NULL);
    (void)wh_json_add(root, "tolerance check slice_s seat settle collision", tolerance,
                      wh_json_text(layout->grasp.check == WH_CHECK_SWEPT ? "swept" : "sampled"),
                      wh_json_real((double)layout->slice_us / 1e6), json_boolean(layout->grasp.seat),
                      json_boolean(layout->cell.settle), json_boolean(layout->collision), NULL);
}

int wh_layout_print_json(const wh_feasibility_t *check, FILE *out) {
    const wh_layout_t *layout = check->layout;
    json_t *root = json_object();
    wh_json_put_integer(root, "format", FORMAT);
    wh_json_put(root, "ok", json_boolean(check->count == 0));
    wh_json_put_text(root, "layout", layout->path);
    put_checks(layout, root);
    wh_json_put(root, "axes", wh_json_list(axis, layout, WH_ROBOT_AXES));
    wh_json_put(root, "grippers", wh_json_list(gripper, layout, layout->machine.gripper_count));
    wh_json_put(root, "stations", wh_json_list(station, check, layout->station_count));
    wh_json_put(root, "wafers", wh_json_list(wafer, layout, layout->wafer_count));
    wh_json_put(root, "vacuum", vacuum(&layout->physics.vacuum));
    wh_json_put(root, "pads", pads(&layout->physics.pads));
    wh_json_put(root, "faults", wh_json_list(fault, layout, layout->physics.fault_count));
    wh_json_put(root, "shapes", shapes(&layout->shapes));
    wh_json_put(root, "parts", wh_json_list(part, check, layout->world.part_count));
    wh_json_put(root, "clearance", clearances(layout));
    wh_json_put(root, "findings", wh_json_list(finding, check, check->count));
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
