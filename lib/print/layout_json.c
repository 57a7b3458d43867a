#include <math.h>

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
    const wh_limits_t *limits = &robot->limits[i];
    return wh_json_set(json_object(), "name %s min %g max %g home %g speed %g acceleration %g jerk %g",
                       names[i], robot->travel[i].min * unit, robot->travel[i].max * unit,
                       robot->home[i] * unit, limits->speed * unit, limits->acceleration * unit,
                       limits->jerk * unit);
}

static json_t *gripper(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_layout_gripper_t *from = &layout->grippers[i];
    json_t *object =
        wh_json_set(json_object(), "name %s on %s valve %s", from->name,
                    from->station == WH_NONE ? "robot" : layout->stations[from->station].name, from->valve);
    if (layout->machine.mounts[i].is_shifted) {
        put_pose(object, &layout->machine.mounts[i].effector_from_gripper);
    }
    return object;
}

/* ----------------------------------------------------------------------------------------------- stations */

static json_t *sensor(const wh_sensor_t *from) {
    return wh_json_set(json_object(),
                       "samples %d pixel %g length %g at %g encoder %d noise %g tilt %g offset %g zero %g "
                       "gain %g latency %g hidden %d",
                       from->samples, from->pixel, from->length, wh_deg_from_rad(from->direction),
                       from->encoder, from->noise, wh_deg_from_rad(from->tilt), from->error.offset,
                       from->error.zero, from->error.gain, from->error.latency, from->hidden_count);
}

static json_t *beam(const wh_layout_t *layout, size_t b) {
    static const char *const stuck[] = {"no", "dark", "lit"};
    const wh_layout_beam_t *from = &layout->beams[b];
    return wh_json_set(json_object(),
                       "x %g y %g low %g high %g delay_on %g delay_off %g jitter %g dx %g dy %g late %g "
                       "stuck %s",
                       from->x, from->y, from->low, from->high, from->delay_on, from->delay_off,
                       layout->doors[b].jitter, from->dx, from->dy, from->late,
                       stuck[layout->doors[b].stuck]);
}

static json_t *beams_at(const wh_layout_t *layout, size_t s) {
    const wh_latch_order_t order = wh_layout_beams_at(layout, s);
    json_t *list = json_array();
    for (int32_t i = 0; i < order.count; ++i) {
        (void)json_array_append_new(list, beam(layout, (size_t)order.first + (size_t)i));
    }
    return list;
}

static json_t *station(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *from = &layout->stations[i];
    const wh_entry_t *entry = &check->entries[i];
    const char *kind = from->foup ? "foup" : "slots";
    const wh_station_t *place = &layout->places[i];
    json_t *object =
        wh_json_set(json_object(), "name %s kind %s", from->name, from->prealigner ? "prealigner" : kind);
    put_pose(object, &place->base_from_station);
    (void)wh_json_set(object,
                      "slots %d pitch %g stroke %g offset %g retract %g pickup_speed %g taught %i "
                      "effector %s counts %i wafers %lld",
                      place->slots, place->pitch, from->stroke, from->offset, from->retract,
                      from->pickup_speed, from->taught, layout->grippers[from->effector].name, from->counts,
                      (json_int_t)entry->wafers);
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
    return object;
}

/* ------------------------------------------------------------------------------------------------- shapes */

static json_t *shapes(const wh_shapes_t *from) {
    json_t *blade = wh_json_set(json_object(), "thickness %g half_width %g finger %g length %g palm %g",
                                from->blade.thickness, from->blade.half_width, from->blade.finger,
                                from->blade.length, from->blade.palm);
    json_t *ledge = wh_json_set(json_object(), "inner %g outer %g thickness %g length %g", from->ledge.inner,
                                from->ledge.outer, from->ledge.thickness, from->ledge.length);
    json_t *arm = wh_json_set(json_object(), "reach %g link %g right_handed %i", from->arm.reach,
                              from->arm.link, from->arm.right_handed);
    json_t *foup = wh_json_set(json_object(), "room %g wall %g floor %g roof %g", from->shell.room,
                               from->shell.wall, from->shell.floor, from->shell.roof);
    json_t *chuck = wh_json_set(json_object(), "radius %g height %g body %g", from->chuck.radius,
                                from->chuck.height, from->chuck.body);
    return wh_json_add(json_object(), "blade ledge arm foup chuck", blade, ledge, arm, foup, chuck, NULL);
}

static json_t *part(const void *subject, size_t i) {
    const wh_feasibility_t *check = subject;
    static const char *const kinds[] = {"wall", "ledge", "arm", "blade", "chuck", "wafer"};
    static const char *const shapes_of[] = {"box", "cylinder", "capsule", "mesh"};
    const wh_layout_t *layout = check->layout;
    const wh_part_t *from = &layout->world.parts[i];
    const wh_pose_t pose = wh_feasibility_place(check, (int32_t)i);
    json_t *object = wh_json_set(json_object(), "name %s kind %s shape %s", layout->part_names[i],
                                 kinds[from->kind], shapes_of[from->convex.kind]);
    wh_json_put(object, "half",
                from->convex.kind == WH_CONVEX_MESH ? json_null() : wh_json_vector(from->convex.half));
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

static json_t *vacuum(const wh_vacuum_config_t *from) {
    return wh_json_set(json_object(), "build %g vent %g idle %g sensor_on %g sensor_off %g release %g",
                       from->build, from->vent, from->idle, from->on, from->off, from->release);
}

static json_t *pads(const wh_pads_t *from) {
    return from->mass > 0 ? wh_json_set(json_object(), "friction %g force %g mass %g gravity %g",
                                        from->friction, from->force, from->mass, from->gravity)
                          : json_null();
}

static json_t *fault(const void *subject, size_t i) {
    const wh_layout_t *layout = subject;
    const wh_fault_t *from = &layout->physics.faults[i];
    const double slice_s = (double)layout->slice_us / 1e6;
    const bool endless = from->until == WH_FAULT_FOREVER;
    const bool targeted = from->target != WH_NONE;
    const bool of_wafer = wh_fault_is_of_wafer(from->kind);
    return wh_json_set(
        json_object(), "kind %s gripper %s wafer %s from_s %g until_s %g value %g", wh_fault_name(from->kind),
        targeted && !of_wafer ? layout->grippers[from->target].name : NULL,
        targeted && of_wafer ? layout->wafers[from->target].name : NULL, (double)(from->from - 1) * slice_s,
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

/* Those that are warnings, or those that are not. */
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
    json_t *tolerance = wh_json_set(json_object(), "name %s projz %g projxy %g planar %g",
                                    layout->tolerance_name, from->projz, from->projxy, from->planar);
    static const char *const names[WH_TOLERANCE_LIMITS] = {"projz", "projxy", "planar"};
    json_t *defaults = json_array();
    for (size_t i = 0; i < WH_TOLERANCE_LIMITS; ++i) {
        if (layout->tolerance_default[i]) {
            json_array_append_new(defaults, json_string(names[i]));
        }
    }
    wh_json_put(tolerance, "defaults", defaults);
    (void)wh_json_set(root, "wafer_diameter %g wafer_thickness %g notch_deg %g notch_depth %g",
                      layout->wafer_diameter, layout->wafer_thickness,
                      layout->notch_depth > 0 ? wh_deg_from_rad(layout->notch) : HUGE_VAL,
                      layout->notch_depth);
    wh_json_put(root, "tolerance", tolerance);
    (void)wh_json_set(root, "check %s slice_s %g seat %i settle %i collision %i",
                      layout->grasp.check == WH_CHECK_SWEPT ? "swept" : "sampled",
                      (double)layout->slice_us / 1e6, layout->grasp.seat, layout->cell.settle,
                      layout->collision);
}

int wh_layout_print_json(const wh_feasibility_t *check, FILE *out) {
    const wh_layout_t *layout = check->layout;
    json_t *root =
        wh_json_set(json_object(), "format %d ok %i layout %s", FORMAT, check->wrong == 0, layout->path);
    put_checks(layout, root);
    (void)wh_json_add(
        root, "axes grippers stations wafers vacuum pads faults", wh_json_list(axis, layout, WH_ROBOT_AXES),
        wh_json_list(gripper, layout, layout->machine.gripper_count),
        wh_json_list(station, check, layout->station_count), wh_json_list(wafer, layout, layout->wafer_count),
        vacuum(&layout->physics.vacuum), pads(&layout->physics.pads),
        wh_json_list(fault, layout, layout->physics.fault_count), NULL);
    (void)wh_json_add(root, "corrections shapes parts clearance findings warnings",
                      corrections(&layout->corrections), shapes(&layout->shapes),
                      wh_json_list(part, check, layout->world.part_count), clearances(layout),
                      findings(check, false), findings(check, true), NULL);
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
