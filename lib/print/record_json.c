#include "record_json.h"

#include <inttypes.h>
#include <string.h>

#include "../math/trig.h"
#include "../sim/faults.h"
#include "record_json_internal.h"
#include "record_names.h"

/* The format's number: goes up when a key changes its meaning or leaves. */
#define FORMAT 1

static json_t *vector(wh_json_writer_t *writer, wh_vec3_t v) {
    json_t *list = json_array();
    wh_json_append(writer, list, wh_json_real((double)v.x));
    wh_json_append(writer, list, wh_json_real((double)v.y));
    wh_json_append(writer, list, wh_json_real((double)v.z));
    return list;
}

static json_t *matrix(wh_json_writer_t *writer, const wh_mat3_t *m) {
    json_t *rows = json_array();
    for (size_t row = 0; row < 3; ++row) {
        wh_json_append(writer, rows, vector(writer, wh_mat3_row(m, row)));
    }
    return rows;
}

static json_t *command(wh_json_writer_t *writer, size_t i) {
    const wh_command_record_t *from = &wh_json_record(writer)->commands[i];
    json_t *object = json_object();
    wh_json_put(writer, object, "line", json_integer(from->line));
    wh_json_put(writer, object, "text", wh_json_text(from->text));
    wh_json_put(writer, object, "error", json_integer((json_int_t)from->error));
    wh_json_put(writer, object, "begin_s", wh_json_real(from->begin_s));
    wh_json_put(writer, object, "end_s", wh_json_real(from->end_s));
    wh_json_put(writer, object, "split", wh_json_split(writer, from->shares));
    if (from->message) {
        wh_json_put(writer, object, "message", wh_json_text(from->message));
    }
    return object;
}

static void put_place(wh_json_writer_t *writer, json_t *object, const wh_place_t *place) {
    const bool lies = place->station != WH_NONE;
    wh_json_put(writer, object, "station",
                wh_json_text(wh_record_station_name(wh_json_record(writer), place->station)));
    wh_json_put(writer, object, "slot", lies ? json_integer(place->slot) : json_null());
    wh_json_put(writer, object, "dx", lies ? wh_json_real((double)place->dx) : json_null());
    wh_json_put(writer, object, "dy", lies ? wh_json_real((double)place->dy) : json_null());
    wh_json_put(writer, object, "dz", lies ? wh_json_real((double)place->dz) : json_null());
    wh_json_put(writer, object, "tilt_deg",
                lies ? wh_json_real((double)wh_deg_from_rad(place->tilt)) : json_null());
}

/* Where the notch points, about the station's z from its x; about base's for a wafer in no slot. */
static double notch_deg(const wh_layout_t *layout, const wh_wafer_record_t *wafer) {
    wh_real_t sine = 0;
    wh_real_t cosine = 1;
    wh_sin_cos((wh_real_t)layout->notch, &sine, &cosine);
    const wh_vec3_t notch = {cosine, sine, 0};
    wh_vec3_t direction = wh_mat3_transform(&wafer->base_from_wafer.R, &notch);
    if (wafer->place.station != WH_NONE) {
        direction =
            wh_mat3_transform_back(&layout->places[wafer->place.station].base_from_station.R, &direction);
    }
    return (double)wh_deg_from_rad(wh_atan2(direction.y, direction.x));
}

static json_t *wafer(wh_json_writer_t *writer, size_t i) {
    const wh_wafer_record_t *from = &wh_json_record(writer)->wafers[i];
    json_t *object = json_object();
    wh_json_put(writer, object, "name",
                wh_json_text(wh_record_wafer_name(wh_json_record(writer), (int32_t)i)));
    wh_json_put(writer, object, "holder",
                wh_json_text(wh_record_gripper_name(wh_json_record(writer), from->holder)));
    put_place(writer, object, &from->place);
    wh_json_put(writer, object, "notch_deg", wh_json_real(notch_deg(wh_json_record(writer)->layout, from)));
    wh_json_put(writer, object, "position", vector(writer, from->base_from_wafer.r));
    wh_json_put(writer, object, "rotation", matrix(writer, &from->base_from_wafer.R));
    return object;
}

static json_t *margins(wh_json_writer_t *writer, const wh_proximity_t *measured) {
    json_t *object = json_object();
    wh_json_put(writer, object, "projz", wh_json_real((double)measured->margin_projz));
    wh_json_put(writer, object, "projxy", wh_json_real((double)measured->margin_projxy));
    wh_json_put(writer, object, "planar", wh_json_real((double)measured->margin_planar));
    return object;
}

static json_t *failed_conditions(wh_json_writer_t *writer, unsigned failed) {
    static const char *const names[] = {"projz", "projxy", "planar"};
    static const unsigned bits[] = {WH_FAILED_PROJZ, WH_FAILED_PROJXY, WH_FAILED_PLANAR};
    json_t *list = json_array();
    for (size_t i = 0; i < 3; ++i) {
        if (failed & bits[i]) {
            wh_json_append(writer, list, json_string(names[i]));
        }
    }
    return list;
}

static json_t *measured_utime(const wh_json_writer_t *writer, const wh_event_t *event) {
    const wh_layout_t *layout = wh_json_record(writer)->layout;
    return layout ? json_integer((json_int_t)event->measured_slice * layout->slice_us) : json_null();
}

static void put_measured(wh_json_writer_t *writer, json_t *object, const wh_event_t *event) {
    const wh_proximity_t *measured = &event->measured;
    wh_json_put(writer, object, "dr_proj_z", wh_json_real((double)measured->dr_proj_z));
    wh_json_put(writer, object, "dr_proj_xy", vector(writer, measured->dr_proj_xy));
    wh_json_put(writer, object, "dr_proj_xy_norm", wh_json_real((double)measured->dr_proj_xy_norm));
    wh_json_put(writer, object, "n1_proj_n2", wh_json_real((double)measured->n1_proj_n2));
    wh_json_put(writer, object, "margins", margins(writer, measured));
    wh_json_put(writer, object, "failed", failed_conditions(writer, measured->failed));
    wh_json_put(writer, object, "measured_utime", measured_utime(writer, event));
}

static bool is_unmeasured(wh_event_kind_t kind) {
    static const uint32_t kinds = 1U << WH_EVENT_BAD_INPUT | 1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED |
                                  1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_SLIPPED |
                                  1U << WH_EVENT_VACUUM_LOST | 1U << WH_EVENT_FAULT_ARMED |
                                  1U << WH_EVENT_FAULT_CLEARED;
    return (kinds >> (unsigned)kind & 1U) != 0;
}

/* The same keys for an event that measured nothing. */
static void put_unmeasured(wh_json_writer_t *writer, json_t *object) {
    static const char *const keys[] = {"dr_proj_z", "dr_proj_xy", "dr_proj_xy_norm", "n1_proj_n2",
                                       "margins",   "failed",     "measured_utime"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; ++i) {
        wh_json_put(writer, object, keys[i], json_null());
    }
}

static json_t *part_names(wh_json_writer_t *writer, const int32_t parts[2]) {
    json_t *list = json_array();
    for (size_t i = 0; i < 2; ++i) {
        const wh_layout_t *layout = wh_json_record(writer)->layout;
        wh_json_append(writer, list, wh_json_text(layout ? wh_layout_part_name(layout, parts[i]) : NULL));
    }
    return list;
}

/* A tilt in degrees, as everywhere in the result. */
static json_t *found(const wh_event_t *event, wh_real_t value) {
    const bool turned = event->kind == WH_EVENT_PLACED_ASKEW;
    return wh_json_real((double)(turned ? wh_deg_from_rad(value) : value));
}

/* What was found against which limit, between which parts, by which fault. */
static void put_found(wh_json_writer_t *writer, json_t *object, const wh_event_t *event) {
    static const uint32_t with_parts =
        1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED | 1U << WH_EVENT_TOO_CLOSE;
    static const uint32_t with_values = 1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_PLACED_OFF_CENTRE |
                                        1U << WH_EVENT_PLACED_ASKEW | 1U << WH_EVENT_SETTLED |
                                        1U << WH_EVENT_SLIPPED | 1U << WH_EVENT_VACUUM_LOST;
    static const uint32_t of_faults = 1U << WH_EVENT_FAULT_ARMED | 1U << WH_EVENT_FAULT_CLEARED;
    const uint32_t kind = 1U << (unsigned)event->kind;
    if (kind & with_parts) {
        wh_json_put(writer, object, "parts", part_names(writer, event->parts));
        wh_json_put(writer, object, "at", vector(writer, event->at));
    }
    if (kind & with_values) {
        wh_json_put(writer, object, "value", found(event, event->value));
        wh_json_put(writer, object, "limit", found(event, event->limit));
    }
    if (kind & of_faults) {
        wh_json_put(writer, object, "fault", json_integer(event->parts[0] + 1));
        wh_json_put(writer, object, "fault_kind",
                    json_string(wh_fault_name((wh_fault_kind_t)event->parts[1])));
    }
}

/* What only this kind of event has. */
static void put_particulars(wh_json_writer_t *writer, json_t *object, const wh_event_t *event) {
    switch ((int)event->kind) {
    case WH_EVENT_HANDED_OVER:
        wh_json_put(writer, object, "from",
                    wh_json_text(wh_record_gripper_name(wh_json_record(writer), event->other)));
        break;
    case WH_EVENT_CONTESTED:
        wh_json_put(writer, object, "holder",
                    wh_json_text(wh_record_gripper_name(wh_json_record(writer), event->other)));
        break;
    case WH_EVENT_SLOT_OCCUPIED:
        wh_json_put(writer, object, "other",
                    wh_json_text(wh_record_wafer_name(wh_json_record(writer), event->other)));
        break;
    case WH_EVENT_RELEASED_UNSUPPORTED:
        wh_json_put(writer, object, "height", wh_json_real((double)event->height));
        break;
    case WH_EVENT_BAD_INPUT:
        wh_json_put(writer, object, "status", json_integer((json_int_t)event->status));
        wh_json_put(writer, object, "message", json_string(wh_status_text(event->status)));
        break;
    default:
        put_found(writer, object, event);
        break;
    }
}

static json_t *event(wh_json_writer_t *writer, size_t i) {
    const wh_event_record_t *from = &wh_json_record(writer)->events[i];
    json_t *object = json_object();
    wh_json_put(writer, object, "utime", json_integer(from->utime));
    wh_json_put(writer, object, "kind", json_string(wh_event_name(from->event.kind)));
    wh_json_put(writer, object, "wafer",
                wh_json_text(wh_record_wafer_name(wh_json_record(writer), from->event.wafer)));
    wh_json_put(writer, object, "gripper",
                wh_json_text(wh_record_gripper_name(wh_json_record(writer), from->event.gripper)));
    if (is_unmeasured(from->event.kind)) {
        put_unmeasured(writer, object);
    } else {
        put_measured(writer, object, &from->event);
    }
    put_particulars(writer, object, &from->event);
    return object;
}

static json_t *expectation(wh_json_writer_t *writer, size_t i) {
    const wh_expectation_record_t *from = &wh_json_record(writer)->expectations[i];
    json_t *object = json_object();
    wh_json_put(writer, object, "line", json_integer(from->line));
    wh_json_put(writer, object, "text", wh_json_text(from->text));
    wh_json_put(writer, object, "ok", json_boolean(from->ok));
    return object;
}

static void put_head(wh_json_writer_t *writer, json_t *root) {
    const wh_record_t *record = wh_json_record(writer);
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, record->hash);
    wh_json_put(writer, root, "format", json_integer(FORMAT));
    wh_json_put(writer, root, "ok", json_boolean(record->ok));
    if (record->failure) {
        wh_json_put(writer, root, "failure", wh_json_text(record->failure));
    }
    wh_json_put(writer, root, "script", wh_json_text(record->script));
    wh_json_put(writer, root, "layout", wh_json_text(record->layout ? record->layout->path : NULL));
    wh_json_put(writer, root, "slices", json_integer(record->slices));
    wh_json_put(writer, root, "missed", json_integer(record->missed));
    wh_json_put(writer, root, "simulated_s", wh_json_real(record->simulated_s));
    wh_json_put(writer, root, "wall_s", wh_json_real(record->wall_s));
    wh_json_put(writer, root, "hash", json_string(hash));
    wh_json_put_sums(writer, root);
}

/* One kind's smallest gap; nulls where nothing came near. */
static json_t *clearance(wh_json_writer_t *writer, size_t kind) {
    const wh_clearance_t *from = &wh_json_record(writer)->clearances[kind];
    const wh_layout_t *layout = wh_json_record(writer)->layout;
    const wh_real_t limit = layout->world.limits[kind];
    const bool found = from->parts[0] != WH_NONE;
    json_t *object = json_object();
    wh_json_put(writer, object, "kind", json_string(wh_clearance_name((wh_clearance_kind_t)kind)));
    wh_json_put(writer, object, "gap", found ? wh_json_real((double)from->gap) : json_null());
    wh_json_put(writer, object, "limit", limit > 0 ? wh_json_real((double)limit) : json_null());
    wh_json_put(writer, object, "utime",
                found ? json_integer((json_int_t)from->slice * layout->slice_us) : json_null());
    wh_json_put(writer, object, "parts", found ? part_names(writer, from->parts) : json_null());
    wh_json_put(writer, object, "at", found ? vector(writer, from->at) : json_null());
    return object;
}

static void put_lists(wh_json_writer_t *writer, json_t *root) {
    const wh_record_t *record = wh_json_record(writer);
    const size_t wafers = record->layout ? record->layout->wafer_count : 0;
    wh_json_put(writer, root, "commands", wh_json_list(writer, command, record->command_count));
    wh_json_put(writer, root, "wafers", wh_json_list(writer, wafer, wafers));
    wh_json_put(writer, root, "events", wh_json_list(writer, event, record->event_count));
    if (record->checked) {
        wh_json_put(writer, root, "clearances", wh_json_list(writer, clearance, WH_CLEARANCES));
    }
    if (record->checked && record->curves) {
        wh_json_put_curves(writer, root);
    }
    wh_json_put(writer, root, "expectations", wh_json_list(writer, expectation, record->expectation_count));
    wh_json_put_figures(writer, root);
}

json_t *wh_record_to_json(const wh_record_t *record) {
    wh_json_writer_t writer = {record, false};
    json_t *root = json_object();
    put_head(&writer, root);
    put_lists(&writer, root);
    if (writer.failed) {
        json_decref(root);
        return NULL;
    }
    return root;
}

int wh_record_print_json(const wh_record_t *record, FILE *out) {
    json_t *root = wh_record_to_json(record);
    const int status = root ? wh_json_print(root, out) : -1;
    json_decref(root);
    return status;
}
