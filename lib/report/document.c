#include "document.h"

#include <math.h>
#include <string.h>

#include "../math/config.h"
#include "../record/quaternion.h"
#include "../view/scene.h"
#include "document_internal.h"

#define FORMAT 2

double wh_document_seconds(const wh_signals_t *signals, int64_t slice) {
    return (double)(slice * signals->layout->slice_us) / 1e6;
}

static void put_text(wh_json_text_t *text, const char *key, const char *value) {
    wh_json_text_value(text, key, wh_json_text(value));
}

static void put_exact(wh_json_text_t *text, const char *key, double value) {
    wh_json_text_number(text, key, value, 0, true);
}

static void put_list(wh_json_text_t *text, const char *key, const double values[], size_t count) {
    wh_json_text_begin(text, key, '[');
    for (size_t i = 0; i < count; ++i) {
        put_exact(text, NULL, values[i]);
    }
    wh_json_text_end(text, ']');
}

static void put_point(wh_json_text_t *text, const char *key, const wh_vec3_t *point) {
    const double values[] = {point->x, point->y, point->z};
    put_list(text, key, values, 3);
}

void wh_document_put_pose(wh_json_text_t *text, const wh_pose_t *pose) {
    double q[4];
    wh_quaternion_from_matrix(&pose->R, NULL, q);
    put_point(text, "r", &pose->r);
    put_list(text, "q", q, 4);
}

void wh_document_put_each(wh_json_text_t *text, const wh_document_t *document, const char *key, size_t count,
                          wh_document_put_t *put) {
    wh_json_text_begin(text, key, '[');
    for (size_t i = 0; i < count; ++i) {
        put(text, document, i);
    }
    wh_json_text_end(text, ']');
}

void wh_document_put_index(wh_json_text_t *text, const char *key, int32_t index) {
    put_exact(text, key, index == WH_NONE ? HUGE_VAL : index);
}

/* --------------------------------------------------------------------------------------------------- head */

static void put_parameters(wh_json_text_t *text, const wh_document_t *document) {
    json_t *object = json_object();
    for (size_t i = 0; i < document->parameter_count; ++i) {
        const char *parameter = document->parameters[i];
        const size_t name = strcspn(parameter, "=");
        char key[256];
        (void)snprintf(key, sizeof key, "%.*s", (int)name, parameter);
        (void)json_object_set_new(object, key, wh_json_text(parameter[name] ? parameter + name + 1 : ""));
    }
    wh_json_text_value(text, "parameters", object);
}

static void put_note(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    put_text(text, NULL, document->notes[i]);
}

static void put_head(wh_json_text_t *text, const wh_document_t *document) {
    const wh_signals_t *signals = document->signals;
    wh_json_text_integer(text, "format", FORMAT);
    put_text(text, "title", document->title);
    put_text(text, "version", WH_VERSION);
    put_text(text, "reproduce", document->reproduce);
    put_parameters(text, document);
    put_text(text, "source", document->source);
    wh_document_put_each(text, document, "notes", document->note_count, put_note);
    wh_json_text_value(text, "run", json_incref(document->run));
    put_exact(text, "slice_s", wh_document_seconds(signals, 1));
    wh_json_text_integer(text, "slices", signals->last > 0 ? signals->last : 0);
    put_exact(text, "begin_s", wh_document_seconds(signals, signals->first));
    put_exact(text, "duration_s", wh_document_seconds(signals, signals->last));
}

/* -------------------------------------------------------------------------------------------------- names */

void wh_document_name_axis(const wh_layout_t *layout, size_t axis, char *name, size_t size) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "R", "Z", "yaw"};
    (void)snprintf(name, size, "%s", axis < WH_ROBOT_AXES ? names[axis] : "chuck");
    for (size_t g = 0; axis >= WH_ROBOT_AXES && g < layout->machine.gripper_count; ++g) {
        if (layout->machine.mounts[g].axis == (int32_t)axis) {
            (void)snprintf(name, size, "%s chuck", layout->grippers[g].name);
        }
    }
}

/* Null if the value is not known: a chuck's, or any of a log without its layout. */
static void put_known(wh_json_text_t *text, const char *key, bool known, double value) {
    put_exact(text, key, known ? value : HUGE_VAL);
}

static void put_axis(wh_json_text_t *text, const wh_document_t *document, size_t axis) {
    const wh_layout_t *layout = document->signals->layout;
    const wh_machine_t *machine = &layout->machine;
    const wh_travel_t travel = axis < WH_ROBOT_AXES ? machine->robot.travel[axis] : (wh_travel_t){0, 0};
    const double speed = axis < machine->axis_count ? wh_machine_limits(machine, axis)->speed : 0;
    char name[WH_NAME_SIZE + 8];
    wh_document_name_axis(layout, axis, name, sizeof name);
    wh_json_text_begin(text, NULL, '{');
    put_text(text, "name", name);
    wh_json_text_string(text, "unit", axis == WH_AXIS_R || axis == WH_AXIS_Z ? "mm" : "rad");
    put_known(text, "low", travel.max > travel.min, travel.min);
    put_known(text, "high", travel.max > travel.min, travel.max);
    put_known(text, "speed", speed > 0, speed);
    wh_json_text_end(text, '}');
}

static void put_wafer_name(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    put_text(text, NULL, document->signals->layout->wafers[i].name);
}

static void put_gripper_name(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    put_text(text, NULL, document->signals->layout->grippers[i].name);
}

static void put_station_name(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    put_text(text, NULL, document->signals->layout->stations[i].name);
}

static void put_names(wh_json_text_t *text, const wh_document_t *document) {
    const wh_layout_t *layout = document->signals->layout;
    wh_json_text_begin(text, "names", '{');
    wh_document_put_each(text, document, "wafers", layout->wafer_count, put_wafer_name);
    wh_document_put_each(text, document, "grippers", layout->machine.gripper_count, put_gripper_name);
    wh_document_put_each(text, document, "stations", layout->station_count, put_station_name);
    wh_document_put_each(text, document, "axes", document->signals->axis_count, put_axis);
    wh_json_text_end(text, '}');
}

/* --------------------------------------------------------------------------------------------------- cell */

static void put_wafer(wh_json_text_t *text, const wh_layout_t *layout) {
    wh_json_text_begin(text, "wafer", '{');
    put_exact(text, "diameter", layout->wafer_diameter);
    put_exact(text, "thickness", layout->wafer_thickness);
    put_exact(text, "notch", layout->notch);
    wh_json_text_end(text, '}');
}

/* On the robot the pose is the gripper's in the end-effector's frame, of a chuck the station's in base. */
static void put_mount(wh_json_text_t *text, const wh_document_t *document, size_t g) {
    const wh_mount_t *mount = &document->signals->layout->machine.mounts[g];
    const wh_pose_t identity = wh_pose_identity();
    const wh_pose_t *on_robot = mount->is_shifted ? &mount->effector_from_gripper : &identity;
    wh_json_text_begin(text, NULL, '{');
    wh_document_put_index(text, "axis", mount->axis);
    wh_document_put_pose(text, mount->axis == WH_NONE ? on_robot : &mount->base_from_station);
    wh_json_text_end(text, '}');
}

static void put_link(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    (void)document;
    wh_json_text_string(text, NULL, wh_signals_link_names[i]);
}

static void put_machine(wh_json_text_t *text, const wh_document_t *document) {
    const wh_layout_t *layout = document->signals->layout;
    const wh_arm_t *arm = &layout->shapes.arm;
    wh_json_text_begin(text, "machine", '{');
    wh_document_put_each(text, document, "grippers", layout->machine.gripper_count, put_mount);
    wh_document_put_each(text, document, "links", WH_SIGNALS_LINKS, put_link);
    wh_json_text_begin(text, "arm", '{');
    put_exact(text, "reach", arm->reach);
    put_exact(text, "link", arm->link);
    wh_json_text_value(text, "right_handed", json_boolean(arm->right_handed));
    wh_json_text_end(text, '}');
    wh_json_text_end(text, '}');
}

static void put_limits(wh_json_text_t *text, const wh_grasp_config_t *grasp) {
    wh_json_text_begin(text, "limits", '{');
    put_exact(text, "projz", grasp->tolerance.projz);
    put_exact(text, "projxy", grasp->tolerance.projxy);
    put_exact(text, "planar", grasp->tolerance.planar);
    put_exact(text, "near_projz", grasp->near_projz);
    put_exact(text, "near_projxy", grasp->near_projxy);
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
            wh_document_put_pose(text, &pose);
            wh_json_text_end(text, '}');
        }
    }
    wh_json_text_end(text, ']');
}

/* -------------------------------------------------------------------------------------------------- marks */

static void append(char *text, size_t size, const char *before, const char *part) {
    const size_t length = strlen(text);
    if (part) {
        (void)snprintf(text + length, size - length, "%s%s", before, part);
    }
}

static const char *wafer_name(const wh_layout_t *layout, int32_t wafer) {
    return wafer >= 0 && (size_t)wafer < layout->wafer_count ? layout->wafers[wafer].name : NULL;
}

static const char *gripper_name(const wh_layout_t *layout, int32_t gripper) {
    return gripper >= 0 && (size_t)gripper < layout->machine.gripper_count ? layout->grippers[gripper].name
                                                                           : NULL;
}

static bool is_contact(wh_event_kind_t kind) {
    return kind == WH_EVENT_HIT || kind == WH_EVENT_UNDECIDED || kind == WH_EVENT_TOO_CLOSE;
}

/* Such as "near miss: Wafer 1, EE" or "hit: A ledge 3 left and EE finger right". */
static void describe(const wh_layout_t *layout, const wh_event_t *event, char *text, size_t size) {
    (void)snprintf(text, size, "%s", wh_event_name(event->kind));
    for (char *c = text; *c; ++c) {
        if (*c == '_') {
            *c = ' ';
        }
    }
    if (is_contact(event->kind)) {
        append(text, size, ": ", wh_layout_part_name(layout, event->parts[0]));
        append(text, size, " and ", wh_layout_part_name(layout, event->parts[1]));
        return;
    }
    const char *wafer = wafer_name(layout, event->wafer);
    append(text, size, ": ", wafer);
    append(text, size, wafer ? ", " : ": ", gripper_name(layout, event->gripper));
}

static void put_mark(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    const wh_mark_t *mark = &document->signals->marks[i];
    char words[3 * WH_PART_NAME_SIZE];
    describe(document->signals->layout, &mark->event, words, sizeof words);
    wh_json_text_begin(text, NULL, '{');
    wh_json_text_number(text, "t", (double)mark->utime / 1e6, 6, false);
    wh_json_text_string(text, "kind", wh_event_name(mark->event.kind));
    put_text(text, "text", words);
    if (mark->has_place) {
        put_point(text, "at", &mark->at);
    } else {
        wh_json_text_value(text, "at", json_null());
    }
    wh_json_text_end(text, '}');
}

int wh_document_write(const wh_document_t *document, FILE *out) {
    wh_json_text_t text = {.out = out};
    const wh_signals_t *signals = document->signals;
    wh_json_text_begin(&text, NULL, '{');
    put_head(&text, document);
    put_names(&text, document);
    put_wafer(&text, signals->layout);
    put_machine(&text, document);
    put_limits(&text, &signals->layout->grasp);
    put_slots(&text, signals->layout);
    wh_document_put_thinning(&text, signals);
    wh_document_put_tracks(&text, document);
    wh_document_put_each(&text, document, "marks", signals->mark_count, put_mark);
    wh_json_text_value(&text, "scene", wh_scene_make(signals, document->title, false));
    wh_json_text_end(&text, '}');
    fputc('\n', out);
    return text.failed || fflush(out) != 0 || ferror(out) ? -1 : 0;
}
