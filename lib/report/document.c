#include "document.h"

#include <math.h>
#include <string.h>

#include "../layout/arms.h"
#include "../layout/axes.h"
#include "../math/config.h"
#include "../scene/scene.h"
#include "../text/array.h"
#include "notes_document.h"
#include "put.h"
#include "scans_document.h"
#include "tracks_document.h"

#define FORMAT 2

/* A list: `put` writes each of its elements, from 0 to count - 1. */
typedef void put_t(wh_json_text_t *text, const wh_document_t *document, size_t i);

static void put_each(wh_json_text_t *text, const wh_document_t *document, const char *key, size_t count,
                     put_t *put) {
    wh_json_text_begin(text, key, '[');
    for (size_t i = 0; i < count; ++i) {
        put(text, document, i);
    }
    wh_json_text_end(text, ']');
}

/* --------------------------------------------------------------------------------------------------- head */

static void put_parameters(wh_json_text_t *text, const wh_document_t *document) {
    json_t *object = json_object();
    for (size_t i = 0; i < document->parameter_count; ++i) {
        const char *parameter = document->parameters[i];
        const size_t name = strcspn(parameter, "=");
        (void)json_object_setn_new(object, parameter, name,
                                   wh_json_text(parameter[name] ? parameter + name + 1 : ""));
    }
    wh_json_text_value(text, "parameters", object);
}

/* A flow by times alone has no slices. */
static void put_span(wh_json_text_t *text, const wh_document_t *document) {
    const wh_signals_t *signals = document->signals;
    if (!signals) {
        wh_put_exact(text, "begin_s", 0);
        wh_put_exact(text, "duration_s", document->record->simulated_s);
        return;
    }
    wh_put_exact(text, "slice_s", wh_signals_seconds(signals, 1));
    wh_json_text_integer(text, "slices", signals->last > 0 ? signals->last : 0);
    wh_put_exact(text, "begin_s", wh_signals_seconds(signals, signals->first));
    wh_put_exact(text, "duration_s", wh_signals_seconds(signals, signals->last));
}

static void put_head(wh_json_text_t *text, const wh_document_t *document) {
    wh_json_text_integer(text, "format", FORMAT);
    wh_put_text(text, "title", document->title);
    wh_put_text(text, "version", WH_VERSION);
    wh_put_text(text, "reproduce", document->reproduce);
    put_parameters(text, document);
    wh_put_text(text, "source", document->source);
    wh_notes_document_put(text, document);
    wh_json_text_value(text, "run", json_incref(document->run));
    put_span(text, document);
}

/* -------------------------------------------------------------------------------------------------- names */

/* Null: the value is not known. It may be a chuck's travel, or the unit and any value of a log without its
 * layout. */
static void put_axis(wh_json_text_t *text, const wh_document_t *document, size_t axis) {
    const wh_layout_t *layout = document->signals->layout;
    const wh_machine_t *machine = &layout->machine;
    const bool is_robots = axis < wh_machine_robot_axes(machine);
    const wh_travel_t travel = is_robots ? *wh_machine_travel(machine, axis) : (wh_travel_t){0, 0};
    const double speed = axis < machine->axis_count ? wh_machine_limits(machine, axis)->speed : 0;
    char name[WH_NAME_SIZE + 8];
    wh_layout_name_axis(layout, axis, name, sizeof name);
    wh_json_text_begin(text, NULL, '{');
    wh_put_text(text, "name", name);
    wh_put_text(text, "unit", wh_layout_axis_unit(layout, axis));
    wh_put_exact(text, "low", travel.max > travel.min ? travel.min : HUGE_VAL);
    wh_put_exact(text, "high", travel.max > travel.min ? travel.max : HUGE_VAL);
    wh_put_exact(text, "speed", speed > 0 ? speed : HUGE_VAL);
    wh_json_text_end(text, '}');
}

static void put_wafer_name(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    wh_put_text(text, NULL, document->signals->layout->wafers[i].name);
}

static void put_gripper_name(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    wh_put_text(text, NULL, document->signals->layout->grippers[i].name);
}

static void put_door_name(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    wh_put_text(text, NULL, document->signals->layout->door_list[i].name);
}

static void put_station_name(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    wh_put_text(text, NULL, document->signals->layout->stations[i].name);
}

static void put_names(wh_json_text_t *text, const wh_document_t *document) {
    const wh_layout_t *layout = document->signals->layout;
    wh_json_text_begin(text, "names", '{');
    put_each(text, document, "wafers", layout->wafer_count, put_wafer_name);
    put_each(text, document, "grippers", layout->machine.gripper_count, put_gripper_name);
    put_each(text, document, "stations", layout->station_count, put_station_name);
    if (layout->machine.door_count > 0) {
        put_each(text, document, "doors", layout->machine.door_count, put_door_name);
    }
    put_each(text, document, "axes", document->signals->axis_count, put_axis);
    wh_json_text_end(text, '}');
}

/* --------------------------------------------------------------------------------------------------- cell */

static void put_wafer(wh_json_text_t *text, const wh_layout_t *layout) {
    wh_json_text_begin(text, "wafer", '{');
    wh_put_exact(text, "diameter", layout->wafer_diameter);
    wh_put_exact(text, "thickness", layout->wafer_thickness);
    if (layout->notch_depth > 0) {
        wh_put_exact(text, "notch", layout->notch);
    }
    wh_json_text_end(text, '}');
}

/* The pose of the robot's grippers is in the end-effector's frame. The pose of a chuck's gripper is the
 * station's in base. */
static void put_mount(wh_json_text_t *text, const wh_document_t *document, size_t g) {
    const wh_mount_t *mount = &document->signals->layout->machine.mounts[g];
    const wh_pose_t identity = wh_pose_identity();
    const wh_pose_t *on_robot = mount->is_shifted ? &mount->effector_from_gripper : &identity;
    wh_json_text_begin(text, NULL, '{');
    wh_put_index(text, "axis", mount->axis);
    if (mount->arm > 0) {
        wh_put_index(text, "arm", mount->arm);
    }
    if (mount->axis == WH_NONE && mount->robot > 0) {
        wh_put_index(text, "robot", mount->robot);
    }
    wh_put_pose(text, mount->axis == WH_NONE ? on_robot : &mount->base_from_station);
    wh_json_text_end(text, '}');
}

static void put_door(wh_json_text_t *text, const wh_document_t *document, size_t d) {
    const wh_machine_t *machine = &document->signals->layout->machine;
    wh_json_text_begin(text, NULL, '{');
    wh_put_index(text, "axis", (int32_t)wh_machine_door_axis(machine, d));
    wh_put_point(text, "way", &machine->doors[d].way);
    wh_json_text_end(text, '}');
}

/* The names of the links, and with several arms the number of each one's body. */
static void put_links(wh_json_text_t *text, const wh_layout_t *layout) {
    int32_t bodies[WH_SIGNALS_LINKS];
    const size_t count = wh_signals_link_bodies(layout, bodies);
    wh_json_text_begin(text, "links", '[');
    for (size_t i = 0; i < count; ++i) {
        char name[2 * WH_NAME_SIZE];
        wh_layout_name_body(layout, (size_t)bodies[i], "column", name, sizeof name);
        wh_json_text_string(text, NULL, name);
    }
    wh_json_text_end(text, ']');
    if (wh_layout_arms(layout) > 1) {
        wh_json_text_begin(text, "bodies", '[');
        for (size_t i = 0; i < count; ++i) {
            wh_json_text_integer(text, NULL, bodies[i]);
        }
        wh_json_text_end(text, ']');
    }
}

/* Where a robot of another kind stands, what its own axes are, and the links of a SCARA. */
static void put_chain(wh_json_text_t *text, const wh_machine_t *machine, const wh_carrier_t *carrier,
                      size_t first) {
    const wh_chain_t *chain = &carrier->chain;
    const wh_pose_t identity = wh_pose_identity();
    wh_json_text_begin(text, "chain", '{');
    wh_put_pose(text, chain->is_placed ? &chain->base_from_robot : &identity);
    wh_json_text_begin(text, "axes", '[');
    for (size_t own = 0; own < carrier->axis_count; ++own) {
        wh_json_text_string(text, NULL, wh_axis_name(machine, first + own));
    }
    wh_json_text_end(text, ']');
    wh_put_exact(text, "flip_height", chain->flip_height);
    wh_json_text_begin(text, "links", '[');
    for (size_t i = 0; chain->kind == WH_CHAIN_SCARA && i < 2; ++i) {
        wh_put_exact(text, NULL, chain->links[i]);
    }
    wh_json_text_end(text, ']');
    wh_json_text_end(text, '}');
}

static void put_lengths(wh_json_text_t *text, const wh_arm_t *arm) {
    wh_json_text_begin(text, "arm", '{');
    wh_put_exact(text, "reach", arm->reach);
    wh_put_exact(text, "link", arm->link);
    wh_json_text_value(text, "right_handed", json_boolean(arm->right_handed));
    wh_json_text_end(text, '}');
}

/* Every arm of several: the arm's name, its robot's first axis, and what else a machine has of one arm. */
static void put_arms(wh_json_text_t *text, const wh_layout_t *layout) {
    wh_json_text_begin(text, "arms", '[');
    for (size_t arm = 0; arm < wh_layout_arms(layout); ++arm) {
        const size_t robot = (size_t)layout->arms[arm].robot;
        size_t first;
        (void)wh_layout_arm(layout, arm, &first);
        wh_json_text_begin(text, NULL, '{');
        wh_json_text_integer(text, "robot", (long long)robot);
        wh_json_text_integer(text, "number", layout->arms[arm].own == WH_ARM_BASE ? 0 : 1);
        wh_json_text_integer(text, "first", (long long)first);
        put_lengths(text, wh_layout_arm_lengths(layout, robot));
        put_chain(text, &layout->machine, wh_machine_carrier(&layout->machine, robot, NULL), first);
        wh_json_text_end(text, '}');
    }
    wh_json_text_end(text, ']');
}

static void put_machine(wh_json_text_t *text, const wh_document_t *document) {
    const wh_layout_t *layout = document->signals->layout;
    wh_json_text_begin(text, "machine", '{');
    put_each(text, document, "grippers", layout->machine.gripper_count, put_mount);
    if (layout->machine.door_count > 0) {
        put_each(text, document, "doors", layout->machine.door_count, put_door);
    }
    put_links(text, layout);
    put_lengths(text, &layout->shapes.arm);
    if (layout->machine.carrier) {
        put_chain(text, &layout->machine, layout->machine.carrier, 0);
    }
    if (wh_layout_arms(layout) > 1) {
        put_arms(text, layout);
    }
    wh_json_text_end(text, '}');
}

static void put_limits(wh_json_text_t *text, const wh_grasp_config_t *grasp) {
    wh_json_text_begin(text, "limits", '{');
    wh_put_exact(text, "projz", grasp->tolerance.projz);
    wh_put_exact(text, "projxy", grasp->tolerance.projxy);
    wh_put_exact(text, "planar", grasp->tolerance.planar);
    wh_put_exact(text, "near_projz", grasp->near_projz);
    wh_put_exact(text, "near_projxy", grasp->near_projxy);
    wh_json_text_end(text, '}');
}

static void put_slots(wh_json_text_t *text, const wh_layout_t *layout) {
    wh_json_text_begin(text, "slots", '[');
    for (size_t s = 0; s < layout->station_count; ++s) {
        for (int32_t slot = 1; slot <= layout->places[s].slots; ++slot) {
            const wh_pose_t pose = wh_station_slot(&layout->places[s], slot);
            wh_json_text_begin(text, NULL, '{');
            wh_json_text_integer(text, "station", (long long)s);
            wh_json_text_integer(text, "slot", slot);
            wh_put_pose(text, &pose);
            wh_json_text_end(text, '}');
        }
    }
    wh_json_text_end(text, ']');
}

/* ----------------------------------------------------------------------------------------------- thinning */

typedef struct {
    double mm, rad, own_mm, own_rad, vacuum, measured[WH_MEASURES];
    int64_t of, kept;
} sums_t;

static void count(sums_t *sums, const wh_path_t *curve, double *tolerance) {
    sums->of += curve->of;
    sums->kept += (int64_t)curve->list.count;
    *tolerance = fmax(curve->list.tolerance, *tolerance);
}

static sums_t sum_up(const wh_signals_t *signals) {
    sums_t sums = {0};
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        const wh_thin_t *own = &signals->own[g];
        count(&sums, &signals->vacuum[g], &sums.vacuum);
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            count(&sums, &signals->proximity[g][m], &sums.measured[m]);
        }
        sums.of += own->of;
        sums.kept += (int64_t)own->list.count;
        if (own->list.count > 0) {
            sums.own_mm = fmax(own->list.tolerance, sums.own_mm);
            sums.own_rad = fmax(own->turn, sums.own_rad);
        }
    }
    for (size_t axis = 0; axis < signals->axis_count; ++axis) {
        const wh_path_t *curve = &signals->axes[axis];
        count(&sums, curve, wh_layout_axis_turns(signals->layout, axis) ? &sums.rad : &sums.mm);
        if (!wh_layout_axis_unit(signals->layout, axis)) { /* it may be in mm as well */
            sums.mm = fmax(curve->list.tolerance, sums.mm);
        }
    }
    return sums;
}

/* The greatest distance between a gripper's origin and the place where its axes' curves put it. R and Z are
 * off, and theta and yaw are off at the robot's full reach. */
static double gripper_mm(const wh_signals_t *signals, const sums_t *sums) {
    const double across = sums->mm + wh_signals_lever(signals->layout) * sums->rad;
    return fmax(sqrt(across * across + sums->mm * sums->mm), sums->own_mm);
}

/* The document gives the tolerance with what rounding adds. */
static void put_tolerance(wh_json_text_t *text, const char *key, double thinned) {
    wh_json_text_number(text, key, thinned / WH_SIGNALS_SHARE, 9, false);
}

static void put_thinning(wh_json_text_t *text, const wh_signals_t *signals) {
    const sums_t sums = sum_up(signals);
    wh_json_text_begin(text, "thinning", '{');
    put_tolerance(text, "mm", sums.mm);
    put_tolerance(text, "rad", sums.rad);
    put_tolerance(text, "gripper_mm", gripper_mm(signals, &sums));
    put_tolerance(text, "gripper_rad", fmax(2 * sums.rad, sums.own_rad));
    put_tolerance(text, "vacuum", sums.vacuum);
    /* Twice, because inserted points may take as much again. */
    put_tolerance(text, "projz", 2 * sums.measured[WH_MEASURE_PROJZ]);
    put_tolerance(text, "projxy", 2 * sums.measured[WH_MEASURE_PROJXY]);
    put_tolerance(text, "planar", 2 * sums.measured[WH_MEASURE_PLANAR]);
    wh_json_text_integer(text, "of", sums.of);
    wh_json_text_integer(text, "kept", sums.kept);
    wh_json_text_end(text, '}');
}

static void put_cell(wh_json_text_t *text, const wh_document_t *document) {
    const wh_signals_t *signals = document->signals;
    wh_tracks_written_t written = {0};
    put_names(text, document);
    put_wafer(text, signals->layout);
    put_machine(text, document);
    put_limits(text, &signals->layout->grasp);
    put_slots(text, signals->layout);
    if (document->is_live) {
        wh_json_text_value(text, "thinning", json_null());
        wh_tracks_put_now(text, "now", signals);
    } else {
        put_thinning(text, signals);
    }
    wh_tracks_put(text, document, &written);
    wh_marks_put(text, document, &written);
    wh_scans_document_put(text, signals, document->record);
    wh_json_text_value(text, "scene", wh_scene_make(signals, document->title, false));
}

int wh_document_write(const wh_document_t *document, FILE *out) {
    wh_json_text_t text = {.out = out};
    wh_json_text_begin(&text, NULL, '{');
    put_head(&text, document);
    if (document->signals) {
        put_cell(&text, document);
    }
    wh_json_text_end(&text, '}');
    fputc('\n', out);
    return text.failed || fflush(out) != 0 || ferror(out) ? -1 : 0;
}
