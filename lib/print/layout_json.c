#include "../math/trig.h"
#include "../text/json.h"
#include "layout_print.h"

#define FORMAT 1

static void put_pose(json_t *object, const wh_pose_t *pose) {
    wh_json_put(object, "at", wh_json_vector(pose->r));
    wh_json_put(object, "rotation", wh_json_matrix(&pose->R));
}

/* -------------------------------------------------------------------------------------------- the machine */

static json_t *axis(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    const wh_robot_t *robot = &layout->machine.robot;
    const wh_real_t unit = i == WH_AXIS_THETA || i == WH_AXIS_YAW ? wh_deg_from_rad(1) : 1;
    json_t *object = json_object();
    wh_json_put_text(object, "name", names[i]);
    wh_json_put_real(object, "min", robot->travel[i].min * unit);
    wh_json_put_real(object, "max", robot->travel[i].max * unit);
    wh_json_put_real(object, "home", robot->home[i] * unit);
    wh_json_put_real(object, "speed", robot->limits[i].speed * unit);
    wh_json_put_real(object, "acceleration", robot->limits[i].acceleration * unit);
    wh_json_put_real(object, "jerk", robot->limits[i].jerk * unit);
    return object;
}

static json_t *gripper(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_layout_gripper_t *from = &layout->grippers[i];
    json_t *object = json_object();
    wh_json_put_text(object, "name", from->name);
    wh_json_put_text(object, "on", from->station == WH_NONE ? "robot" : layout->stations[from->station].name);
    wh_json_put_text(object, "valve", from->valve);
    if (layout->machine.mounts[i].is_shifted) {
        put_pose(object, &layout->machine.mounts[i].effector_from_gripper);
    }
    return object;
}

/* ----------------------------------------------------------------------------------------------- stations */

static void put_gap(json_t *object, const char *key, bool has, wh_real_t gap) {
    wh_json_put(object, key, has ? json_real((double)gap) : json_null());
}

static json_t *station(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *from = &layout->stations[i];
    const wh_entry_t *entry = &check->entries[i];
    const char *kind = from->foup ? "foup" : "slots";
    json_t *object = json_object();
    json_t *room = json_object();
    wh_json_put_text(object, "name", from->name);
    wh_json_put_text(object, "kind", from->prealigner ? "prealigner" : kind);
    put_pose(object, &layout->places[i].base_from_station);
    wh_json_put_integer(object, "slots", layout->places[i].slots);
    wh_json_put_real(object, "pitch", layout->places[i].pitch);
    wh_json_put_real(object, "stroke", from->stroke);
    wh_json_put_real(object, "offset", from->offset);
    wh_json_put_real(object, "retract", from->retract);
    wh_json_put_real(object, "pickup_speed", from->pickup_speed);
    wh_json_put(object, "taught", json_boolean(from->taught));
    wh_json_put_text(object, "effector", layout->grippers[from->effector].name);
    wh_json_put_integer(object, "wafers", (json_int_t)entry->wafers);
    put_gap(room, "above", entry->has_above, entry->above);
    put_gap(room, "below", entry->has_below, entry->below);
    put_gap(room, "beside", entry->has_beside, entry->beside);
    wh_json_put(object, "room", room);
    return object;
}

/* ------------------------------------------------------------------------------------------------- shapes */

static json_t *shapes(const wh_shapes_t *from) {
    const struct {
        const char *shape, *size;
        wh_real_t value;
    } sizes[] = {
        {"blade", "thickness", from->blade.thickness},
        {"blade", "half_width", from->blade.half_width},
        {"blade", "finger", from->blade.finger},
        {"blade", "length", from->blade.length},
        {"blade", "palm", from->blade.palm},
        {"ledge", "inner", from->ledge.inner},
        {"ledge", "outer", from->ledge.outer},
        {"ledge", "thickness", from->ledge.thickness},
        {"ledge", "length", from->ledge.length},
        {"arm", "reach", from->arm.reach},
        {"arm", "link", from->arm.link},
        {"foup", "room", from->shell.room},
        {"foup", "wall", from->shell.wall},
        {"foup", "floor", from->shell.floor},
        {"foup", "roof", from->shell.roof},
        {"chuck", "radius", from->chuck.radius},
        {"chuck", "height", from->chuck.height},
        {"chuck", "body", from->chuck.body},
    };
    json_t *object = json_object();
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        if (!json_object_get(object, sizes[i].shape)) {
            wh_json_put(object, sizes[i].shape, json_object());
        }
        wh_json_put_real(json_object_get(object, sizes[i].shape), sizes[i].size, sizes[i].value);
    }
    wh_json_put(json_object_get(object, "arm"), "right_handed", json_boolean(from->arm.right_handed));
    return object;
}

static json_t *part(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    static const char *const kinds[] = {"wall", "ledge", "arm", "blade", "chuck", "wafer"};
    static const char *const shapes_of[] = {"box", "cylinder", "capsule", "mesh"};
    const wh_layout_t *layout = check->layout;
    const wh_part_t *from = &layout->world.parts[i];
    const wh_pose_t pose = wh_feasibility_place(check, (int32_t)i);
    json_t *object = json_object();
    wh_json_put_text(object, "name", layout->part_names[i]);
    wh_json_put_text(object, "kind", kinds[from->kind]);
    wh_json_put_text(object, "shape", shapes_of[from->convex.kind]);
    wh_json_put(object, "half",
                from->convex.kind == WH_CONVEX_MESH ? json_null() : wh_json_vector(from->convex.half));
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
    json_t *object = json_object();
    wh_json_put_text(object, "name", from->name);
    wh_json_put_text(object, "station", layout->stations[from->station].name);
    wh_json_put_integer(object, "slot", from->slot);
    return object;
}

static void put_physics(const wh_layout_t *layout, json_t *root) {
    const wh_vacuum_config_t *from = &layout->physics.vacuum;
    const wh_pads_t *pads = &layout->physics.pads;
    json_t *vacuum = json_object();
    wh_json_put_real(vacuum, "build", from->build);
    wh_json_put_real(vacuum, "vent", from->vent);
    wh_json_put_real(vacuum, "idle", from->idle);
    wh_json_put_real(vacuum, "sensor_on", from->on);
    wh_json_put_real(vacuum, "sensor_off", from->off);
    wh_json_put_real(vacuum, "release", from->release);
    wh_json_put(root, "vacuum", vacuum);
    if (pads->mass > 0) {
        json_t *object = json_object();
        wh_json_put_real(object, "friction", pads->friction);
        wh_json_put_real(object, "force", pads->force);
        wh_json_put_real(object, "mass", pads->mass);
        wh_json_put_real(object, "gravity", pads->gravity);
        wh_json_put(root, "pads", object);
    } else {
        wh_json_put(root, "pads", json_null());
    }
}

static json_t *fault(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_fault_t *from = &layout->physics.faults[i];
    const double slice_s = (double)layout->slice_us / 1e6;
    const bool endless = from->until == WH_FAULT_FOREVER;
    const bool targeted = from->target != WH_NONE;
    const bool of_wafer = wh_fault_is_of_wafer(from->kind);
    json_t *object = json_object();
    wh_json_put_text(object, "kind", wh_fault_name(from->kind));
    wh_json_put_text(object, "gripper", targeted && !of_wafer ? layout->grippers[from->target].name : NULL);
    wh_json_put_text(object, "wafer", targeted && of_wafer ? layout->wafers[from->target].name : NULL);
    wh_json_put_real(object, "from_s", (double)(from->from - 1) * slice_s);
    wh_json_put(object, "until_s", endless ? json_null() : json_real((double)(from->until - 1) * slice_s));
    wh_json_put_real(object, "value", from->value);
    return object;
}

static json_t *finding(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    const wh_layout_t *layout = check->layout;
    const wh_finding_t *from = &check->findings[i];
    const bool of_station = from->station != WH_NONE;
    json_t *object = json_object();
    wh_json_put_text(object, "kind", wh_finding_name(from->kind));
    wh_json_put_text(object, "text", from->text);
    wh_json_put_text(object, "station", of_station ? layout->stations[from->station].name : NULL);
    if (from->parts[0] != WH_NONE) {
        wh_json_put(object, "parts",
                    json_pack("[o, o]", wh_json_text(wh_layout_part_name(layout, from->parts[0])),
                              wh_json_text(wh_layout_part_name(layout, from->parts[1]))));
    }
    return object;
}

static void put_checks(const wh_layout_t *layout, json_t *root) {
    json_t *tolerance = json_object();
    wh_json_put_real(root, "wafer_diameter", layout->wafer_diameter);
    wh_json_put_real(root, "wafer_thickness", layout->wafer_thickness);
    wh_json_put_real(root, "notch_deg", (double)wh_deg_from_rad((wh_real_t)layout->notch));
    wh_json_put_real(root, "notch_depth", layout->notch_depth);
    wh_json_put_text(tolerance, "name", layout->tolerance_name);
    wh_json_put_real(tolerance, "projz", layout->grasp.tolerance.projz);
    wh_json_put_real(tolerance, "projxy", layout->grasp.tolerance.projxy);
    wh_json_put_real(tolerance, "planar", layout->grasp.tolerance.planar);
    wh_json_put(root, "tolerance", tolerance);
    wh_json_put_text(root, "check", layout->grasp.check == WH_CHECK_SWEPT ? "swept" : "sampled");
    wh_json_put_real(root, "slice_s", (double)layout->slice_us / 1e6);
    wh_json_put(root, "seat", json_boolean(layout->grasp.seat));
    wh_json_put(root, "settle", json_boolean(layout->cell.settle));
    wh_json_put(root, "collision", json_boolean(layout->collision));
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
    put_physics(layout, root);
    wh_json_put(root, "faults", wh_json_list(fault, layout, layout->physics.fault_count));
    wh_json_put(root, "shapes", shapes(&layout->shapes));
    wh_json_put(root, "parts", wh_json_list(part, check, layout->world.part_count));
    wh_json_put(root, "clearance", clearances(layout));
    wh_json_put(root, "findings", wh_json_list(finding, check, check->count));
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
