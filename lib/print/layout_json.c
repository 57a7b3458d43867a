#include "../math/trig.h"
#include "../text/json_values.h"
#include "layout_print.h"

#define FORMAT 1

/* What is being written, and whether any value could not be made. */
typedef struct {
    const wh_feasibility_t *check;
    bool failed;
} writer_t;

static void put(writer_t *writer, json_t *object, const char *key, json_t *value) {
    if (json_object_set_new(object, key, value) != 0) {
        writer->failed = true;
    }
}

static void put_real(writer_t *writer, json_t *object, const char *key, wh_real_t value) {
    put(writer, object, key, wh_real_is_finite(value) ? json_real((double)value) : json_null());
}

static void append(writer_t *writer, json_t *list, json_t *value) {
    if (json_array_append_new(list, value) != 0) {
        writer->failed = true;
    }
}

static json_t *vector(writer_t *writer, wh_vec3_t v) {
    json_t *list = json_array();
    append(writer, list, json_real((double)v.x));
    append(writer, list, json_real((double)v.y));
    append(writer, list, json_real((double)v.z));
    return list;
}

static void put_pose(writer_t *writer, json_t *object, const wh_pose_t *pose) {
    json_t *rows = json_array();
    for (size_t row = 0; row < 3; ++row) {
        append(writer, rows, vector(writer, wh_mat3_row(&pose->R, row)));
    }
    put(writer, object, "at", vector(writer, pose->r));
    put(writer, object, "rotation", rows);
}

/* ------------------------------------------------------------------------------------------------ the machine */

static json_t *axis(writer_t *writer, size_t i) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    const wh_robot_t *robot = &writer->check->layout->machine.robot;
    const wh_real_t unit = i == WH_AXIS_THETA || i == WH_AXIS_YAW ? wh_deg_from_rad(1) : 1;
    json_t *object = json_object();
    put(writer, object, "name", json_string(names[i]));
    put_real(writer, object, "min", robot->travel[i].min * unit);
    put_real(writer, object, "max", robot->travel[i].max * unit);
    put_real(writer, object, "home", robot->home[i] * unit);
    put_real(writer, object, "speed", robot->limits[i].speed * unit);
    put_real(writer, object, "acceleration", robot->limits[i].acceleration * unit);
    put_real(writer, object, "jerk", robot->limits[i].jerk * unit);
    return object;
}

static json_t *gripper(writer_t *writer, size_t i) {
    const wh_layout_t *layout = writer->check->layout;
    const wh_layout_gripper_t *from = &layout->grippers[i];
    json_t *object = json_object();
    put(writer, object, "name", wh_json_text(from->name));
    put(writer, object, "on",
        wh_json_text(from->station == WH_NONE ? "robot" : layout->stations[from->station].name));
    put(writer, object, "valve", wh_json_text(from->valve));
    if (layout->machine.mounts[i].is_shifted) {
        put_pose(writer, object, &layout->machine.mounts[i].effector_from_gripper);
    }
    return object;
}

/* --------------------------------------------------------------------------------------------------- stations */

static void put_gap(writer_t *writer, json_t *object, const char *key, bool has, wh_real_t gap) {
    put(writer, object, key, has ? json_real((double)gap) : json_null());
}

static json_t *station(writer_t *writer, size_t i) {
    const wh_layout_t *layout = writer->check->layout;
    const wh_layout_station_t *from = &layout->stations[i];
    const wh_entry_t *entry = &writer->check->entries[i];
    const char *kind = from->foup ? "foup" : "slots";
    json_t *object = json_object();
    json_t *room = json_object();
    put(writer, object, "name", wh_json_text(from->name));
    put(writer, object, "kind", json_string(from->prealigner ? "prealigner" : kind));
    put_pose(writer, object, &layout->places[i].base_from_station);
    put(writer, object, "slots", json_integer(layout->places[i].slots));
    put_real(writer, object, "pitch", layout->places[i].pitch);
    put_real(writer, object, "stroke", from->stroke);
    put_real(writer, object, "offset", from->offset);
    put_real(writer, object, "retract", from->retract);
    put_real(writer, object, "pickup_speed", from->pickup_speed);
    put(writer, object, "taught", json_boolean(from->taught));
    put(writer, object, "effector", wh_json_text(layout->grippers[from->effector].name));
    put(writer, object, "wafers", json_integer((json_int_t)entry->wafers));
    put_gap(writer, room, "above", entry->has_above, entry->above);
    put_gap(writer, room, "below", entry->has_below, entry->below);
    put_gap(writer, room, "beside", entry->has_beside, entry->beside);
    put(writer, object, "room", room);
    return object;
}

/* ------------------------------------------------------------------------------------------------------ shapes */

static json_t *shapes(writer_t *writer) {
    const wh_shapes_t *from = &writer->check->layout->shapes;
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
            put(writer, object, sizes[i].shape, json_object());
        }
        put_real(writer, json_object_get(object, sizes[i].shape), sizes[i].size, sizes[i].value);
    }
    put(writer, json_object_get(object, "arm"), "right_handed", json_boolean(from->arm.right_handed));
    return object;
}

static json_t *part(writer_t *writer, size_t i) {
    static const char *const kinds[] = {"wall", "ledge", "arm", "blade", "chuck", "wafer"};
    static const char *const shapes_of[] = {"box", "cylinder", "capsule", "mesh"};
    const wh_layout_t *layout = writer->check->layout;
    const wh_part_t *from = &layout->world.parts[i];
    const wh_pose_t pose = wh_feasibility_place(writer->check, (int32_t)i);
    json_t *object = json_object();
    put(writer, object, "name", wh_json_text(layout->part_names[i]));
    put(writer, object, "kind", json_string(kinds[from->kind]));
    put(writer, object, "shape", json_string(shapes_of[from->convex.kind]));
    put(writer, object, "half",
        from->convex.kind == WH_CONVEX_MESH ? json_null() : vector(writer, from->convex.half));
    put_pose(writer, object, &pose);
    return object;
}

static json_t *clearances(writer_t *writer) {
    json_t *object = json_object();
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        put_real(writer, object, wh_clearance_name((wh_clearance_kind_t)kind),
                 writer->check->layout->world.limits[kind]);
    }
    return object;
}

/* -------------------------------------------------------------------------------------------------------- all */

static json_t *wafer(writer_t *writer, size_t i) {
    const wh_layout_t *layout = writer->check->layout;
    const wh_layout_wafer_t *from = &layout->wafers[i];
    json_t *object = json_object();
    put(writer, object, "name", wh_json_text(from->name));
    put(writer, object, "station", wh_json_text(layout->stations[from->station].name));
    put(writer, object, "slot", json_integer(from->slot));
    return object;
}

static void put_physics(writer_t *writer, json_t *root) {
    const wh_vacuum_config_t *from = &writer->check->layout->physics.vacuum;
    const wh_pads_t *pads = &writer->check->layout->physics.pads;
    json_t *vacuum = json_object();
    put_real(writer, vacuum, "build", from->build);
    put_real(writer, vacuum, "vent", from->vent);
    put_real(writer, vacuum, "idle", from->idle);
    put_real(writer, vacuum, "sensor_on", from->on);
    put_real(writer, vacuum, "sensor_off", from->off);
    put_real(writer, vacuum, "release", from->release);
    put(writer, root, "vacuum", vacuum);
    if (pads->mass > 0) {
        json_t *object = json_object();
        put_real(writer, object, "friction", pads->friction);
        put_real(writer, object, "force", pads->force);
        put_real(writer, object, "mass", pads->mass);
        put_real(writer, object, "gravity", pads->gravity);
        put(writer, root, "pads", object);
    } else {
        put(writer, root, "pads", json_null());
    }
}

static json_t *fault(writer_t *writer, size_t i) {
    const wh_layout_t *layout = writer->check->layout;
    const wh_fault_t *from = &layout->physics.faults[i];
    const double slice_s = (double)layout->slice_us / 1e6;
    const bool endless = from->until == WH_FAULT_FOREVER;
    const bool targeted = from->target != WH_NONE;
    const bool of_wafer = wh_fault_is_of_wafer(from->kind);
    json_t *object = json_object();
    put(writer, object, "kind", json_string(wh_fault_name(from->kind)));
    put(writer, object, "gripper",
        wh_json_text(targeted && !of_wafer ? layout->grippers[from->target].name : NULL));
    put(writer, object, "wafer",
        wh_json_text(targeted && of_wafer ? layout->wafers[from->target].name : NULL));
    put(writer, object, "from_s", json_real((double)(from->from - 1) * slice_s));
    put(writer, object, "until_s", endless ? json_null() : json_real((double)(from->until - 1) * slice_s));
    put_real(writer, object, "value", from->value);
    return object;
}

static json_t *finding(writer_t *writer, size_t i) {
    const wh_layout_t *layout = writer->check->layout;
    const wh_finding_t *from = &writer->check->findings[i];
    const bool of_station = from->station != WH_NONE;
    json_t *object = json_object();
    put(writer, object, "kind", json_string(wh_finding_name(from->kind)));
    put(writer, object, "text", wh_json_text(from->text));
    put(writer, object, "station", wh_json_text(of_station ? layout->stations[from->station].name : NULL));
    if (from->parts[0] != WH_NONE) {
        json_t *parts = json_array();
        append(writer, parts, wh_json_text(wh_layout_part_name(layout, from->parts[0])));
        append(writer, parts, wh_json_text(wh_layout_part_name(layout, from->parts[1])));
        put(writer, object, "parts", parts);
    }
    return object;
}

static void put_list(writer_t *writer, json_t *root, const char *key, json_t *element(writer_t *, size_t),
                     size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; ++i) {
        append(writer, list, element(writer, i));
    }
    put(writer, root, key, list);
}

static void put_checks(writer_t *writer, json_t *root) {
    const wh_layout_t *layout = writer->check->layout;
    json_t *tolerance = json_object();
    put(writer, root, "wafer_diameter", json_real(layout->wafer_diameter));
    put(writer, root, "wafer_thickness", json_real(layout->wafer_thickness));
    put(writer, root, "notch_deg", json_real((double)wh_deg_from_rad((wh_real_t)layout->notch)));
    put(writer, root, "notch_depth", json_real(layout->notch_depth));
    put(writer, tolerance, "name", json_string(layout->tolerance_name));
    put_real(writer, tolerance, "projz", layout->grasp.tolerance.projz);
    put_real(writer, tolerance, "projxy", layout->grasp.tolerance.projxy);
    put_real(writer, tolerance, "planar", layout->grasp.tolerance.planar);
    put(writer, root, "tolerance", tolerance);
    put(writer, root, "check", json_string(layout->grasp.check == WH_CHECK_SWEPT ? "swept" : "sampled"));
    put(writer, root, "slice_s", json_real((double)layout->slice_us / 1e6));
    put(writer, root, "seat", json_boolean(layout->grasp.seat));
    put(writer, root, "settle", json_boolean(layout->cell.settle));
    put(writer, root, "collision", json_boolean(layout->collision));
}

int wh_layout_print_json(const wh_feasibility_t *check, FILE *out) {
    const wh_layout_t *layout = check->layout;
    writer_t writer = {check, false};
    json_t *root = json_object();
    put(&writer, root, "format", json_integer(FORMAT));
    put(&writer, root, "ok", json_boolean(check->count == 0));
    put(&writer, root, "layout", wh_json_text(layout->path));
    put_checks(&writer, root);
    put_list(&writer, root, "axes", axis, WH_ROBOT_AXES);
    put_list(&writer, root, "grippers", gripper, layout->machine.gripper_count);
    put_list(&writer, root, "stations", station, layout->station_count);
    put_list(&writer, root, "wafers", wafer, layout->wafer_count);
    put_physics(&writer, root);
    put_list(&writer, root, "faults", fault, layout->physics.fault_count);
    put(&writer, root, "shapes", shapes(&writer));
    put_list(&writer, root, "parts", part, layout->world.part_count);
    put(&writer, root, "clearance", clearances(&writer));
    put_list(&writer, root, "findings", finding, check->count);
    const int status = writer.failed ? -1 : wh_json_print(root, out);
    json_decref(root);
    return status;
}
