#include "record_print.h"

#include <stdlib.h>

#include "../math/trig.h"
#include "../record/throughput.h"
#include "../sim/faults.h"
#include "../text/json.h"

/* The format's number: goes up when a key changes its meaning or leaves. */
#define FORMAT 1

/* ----------------------------------------------------------------------------------------------- commands */

/* What a time went into. */
static json_t *split_of(const wh_record_t *record, const int64_t shares[WH_SHARES]) {
    const struct {
        const char *key;
        int64_t slices;
    } parts[] = {{"motion_s", shares[WH_SHARE_LOADED] + shares[WH_SHARE_EMPTY]},
                 {"loaded_s", shares[WH_SHARE_LOADED]},
                 {"empty_s", shares[WH_SHARE_EMPTY]},
                 {"vacuum_s", shares[WH_SHARE_VACUUM]},
                 {"handover_s", shares[WH_SHARE_HANDOVER]},
                 {"waiting_s", shares[WH_SHARE_WAITING]}};
    json_t *object = json_object();
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; ++i) {
        wh_json_put_real(object, parts[i].key, wh_throughput_seconds(record, parts[i].slices));
    }
    return object;
}

static json_t *command(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_command_record_t *from = &record->commands[i];
    json_t *object = json_object();
    wh_json_put_integer(object, "line", from->line);
    wh_json_put_text(object, "text", from->text);
    wh_json_put_integer(object, "error", (json_int_t)from->error);
    wh_json_put_real(object, "begin_s", from->begin_s);
    wh_json_put_real(object, "end_s", from->end_s);
    wh_json_put(object, "split", split_of(record, from->shares));
    if (from->message) {
        wh_json_put_text(object, "message", from->message);
    }
    return object;
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void put_place(const wh_record_t *record, json_t *object, const wh_place_t *place) {
    const bool lies = place->station != WH_NONE;
    wh_json_put_text(object, "station", wh_record_station_name(record, place->station));
    wh_json_put(object, "slot", lies ? json_integer(place->slot) : json_null());
    wh_json_put(object, "dx", lies ? wh_json_real((double)place->dx) : json_null());
    wh_json_put(object, "dy", lies ? wh_json_real((double)place->dy) : json_null());
    wh_json_put(object, "dz", lies ? wh_json_real((double)place->dz) : json_null());
    wh_json_put(object, "tilt_deg", lies ? wh_json_real((double)wh_deg_from_rad(place->tilt)) : json_null());
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

static json_t *wafer(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_wafer_record_t *from = &record->wafers[i];
    json_t *object = json_object();
    wh_json_put_text(object, "name", wh_record_wafer_name(record, (int32_t)i));
    wh_json_put_text(object, "holder", wh_record_gripper_name(record, from->holder));
    put_place(record, object, &from->place);
    wh_json_put_real(object, "notch_deg", notch_deg(record->layout, from));
    wh_json_put(object, "position", wh_json_vector(from->base_from_wafer.r));
    wh_json_put(object, "rotation", wh_json_matrix(&from->base_from_wafer.R));
    return object;
}

/* ------------------------------------------------------------------------------------------------- events */

static json_t *margins(const wh_proximity_t *measured) {
    json_t *object = json_object();
    wh_json_put_real(object, "projz", measured->margin_projz);
    wh_json_put_real(object, "projxy", measured->margin_projxy);
    wh_json_put_real(object, "planar", measured->margin_planar);
    return object;
}

static json_t *failed_conditions(unsigned failed) {
    static const char *const names[] = {"projz", "projxy", "planar"};
    static const unsigned bits[] = {WH_FAILED_PROJZ, WH_FAILED_PROJXY, WH_FAILED_PLANAR};
    json_t *list = json_array();
    for (size_t i = 0; i < 3; ++i) {
        if (failed & bits[i]) {
            wh_json_append(list, json_string(names[i]));
        }
    }
    return list;
}

static json_t *measured_utime(const wh_record_t *record, const wh_event_t *event) {
    const wh_layout_t *layout = record->layout;
    return layout ? json_integer((json_int_t)event->measured_slice * layout->slice_us) : json_null();
}

static void put_measured(const wh_record_t *record, json_t *object, const wh_event_t *event) {
    const wh_proximity_t *measured = &event->measured;
    wh_json_put_real(object, "dr_proj_z", measured->dr_proj_z);
    wh_json_put(object, "dr_proj_xy", wh_json_vector(measured->dr_proj_xy));
    wh_json_put_real(object, "dr_proj_xy_norm", measured->dr_proj_xy_norm);
    wh_json_put_real(object, "n1_proj_n2", measured->n1_proj_n2);
    wh_json_put(object, "margins", margins(measured));
    wh_json_put(object, "failed", failed_conditions(measured->failed));
    wh_json_put(object, "measured_utime", measured_utime(record, event));
}

static bool is_unmeasured(wh_event_kind_t kind) {
    static const uint32_t kinds = 1U << WH_EVENT_BAD_INPUT | 1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED |
                                  1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_SLIPPED |
                                  1U << WH_EVENT_VACUUM_LOST | 1U << WH_EVENT_FAULT_ARMED |
                                  1U << WH_EVENT_FAULT_CLEARED;
    return (kinds >> (unsigned)kind & 1U) != 0;
}

/* The same keys for an event that measured nothing. */
static void put_unmeasured(json_t *object) {
    static const char *const keys[] = {"dr_proj_z", "dr_proj_xy", "dr_proj_xy_norm", "n1_proj_n2",
                                       "margins",   "failed",     "measured_utime"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; ++i) {
        wh_json_put(object, keys[i], json_null());
    }
}

static json_t *part_names(const wh_record_t *record, const int32_t parts[2]) {
    json_t *list = json_array();
    const wh_layout_t *layout = record->layout;
    for (size_t i = 0; i < 2; ++i) {
        wh_json_append(list, wh_json_text(layout ? wh_layout_part_name(layout, parts[i]) : NULL));
    }
    return list;
}

/* A tilt in degrees, as everywhere in the result. */
static json_t *found(const wh_event_t *event, wh_real_t value) {
    const bool turned = event->kind == WH_EVENT_PLACED_ASKEW;
    return wh_json_real((double)(turned ? wh_deg_from_rad(value) : value));
}

/* What was found against which limit, between which parts, by which fault. */
static void put_found(const wh_record_t *record, json_t *object, const wh_event_t *event) {
    static const uint32_t with_parts =
        1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED | 1U << WH_EVENT_TOO_CLOSE;
    static const uint32_t with_values = 1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_PLACED_OFF_CENTRE |
                                        1U << WH_EVENT_PLACED_ASKEW | 1U << WH_EVENT_SETTLED |
                                        1U << WH_EVENT_SLIPPED | 1U << WH_EVENT_VACUUM_LOST;
    static const uint32_t of_faults = 1U << WH_EVENT_FAULT_ARMED | 1U << WH_EVENT_FAULT_CLEARED;
    const uint32_t kind = 1U << (unsigned)event->kind;
    if (kind & with_parts) {
        wh_json_put(object, "parts", part_names(record, event->parts));
        wh_json_put(object, "at", wh_json_vector(event->at));
    }
    if (kind & with_values) {
        wh_json_put(object, "value", found(event, event->value));
        wh_json_put(object, "limit", found(event, event->limit));
    }
    if (kind & of_faults) {
        wh_json_put_integer(object, "fault", event->parts[0] + 1);
        wh_json_put_text(object, "fault_kind", wh_fault_name((wh_fault_kind_t)event->parts[1]));
    }
}

/* What only this kind of event has. */
static void put_particulars(const wh_record_t *record, json_t *object, const wh_event_t *event) {
    switch ((int)event->kind) {
    case WH_EVENT_HANDED_OVER:
        wh_json_put_text(object, "from", wh_record_gripper_name(record, event->other));
        break;
    case WH_EVENT_CONTESTED:
        wh_json_put_text(object, "holder", wh_record_gripper_name(record, event->other));
        break;
    case WH_EVENT_SLOT_OCCUPIED:
        wh_json_put_text(object, "other", wh_record_wafer_name(record, event->other));
        break;
    case WH_EVENT_RELEASED_UNSUPPORTED:
        wh_json_put_real(object, "height", event->height);
        break;
    case WH_EVENT_BAD_INPUT:
        wh_json_put_integer(object, "status", (json_int_t)event->status);
        wh_json_put_text(object, "message", wh_record_error_text(event->status));
        break;
    default:
        put_found(record, object, event);
        break;
    }
}

static json_t *event(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_event_record_t *from = &record->events[i];
    json_t *object = json_object();
    wh_json_put_integer(object, "utime", from->utime);
    wh_json_put_text(object, "kind", wh_event_name(from->event.kind));
    wh_json_put_text(object, "wafer", wh_record_wafer_name(record, from->event.wafer));
    wh_json_put_text(object, "gripper", wh_record_gripper_name(record, from->event.gripper));
    if (is_unmeasured(from->event.kind)) {
        put_unmeasured(object);
    } else {
        put_measured(record, object, &from->event);
    }
    put_particulars(record, object, &from->event);
    return object;
}

/* --------------------------------------------------------------------------------------------- clearances */

/* One kind's smallest gap; nulls where nothing came near. */
static json_t *clearance(const void *subject, size_t kind) {
    const wh_record_t *record = subject;
    const wh_clearance_t *from = &record->clearances[kind];
    const wh_layout_t *layout = record->layout;
    const wh_real_t limit = layout->world.limits[kind];
    const bool found = from->parts[0] != WH_NONE;
    json_t *object = json_object();
    wh_json_put_text(object, "kind", wh_clearance_name((wh_clearance_kind_t)kind));
    wh_json_put(object, "gap", found ? wh_json_real((double)from->gap) : json_null());
    wh_json_put(object, "limit", limit > 0 ? wh_json_real((double)limit) : json_null());
    wh_json_put(object, "utime",
                found ? json_integer((json_int_t)from->slice * layout->slice_us) : json_null());
    wh_json_put(object, "parts", found ? part_names(record, from->parts) : json_null());
    wh_json_put(object, "at", found ? wh_json_vector(from->at) : json_null());
    return object;
}

/* The smallest gap in each bin, by the time at which it ends; null where it was wider than what is kept. */
static json_t *curve(const wh_record_t *record, size_t kind) {
    const wh_curves_t *curves = record->curves;
    const int64_t slice_us = record->layout->slice_us;
    json_t *object = json_object();
    json_t *times = json_array();
    json_t *gaps = json_array();
    for (size_t bin = 0; bin < curves->count; ++bin) {
        const int64_t slice = (int64_t)(curves->first + (bin + 1) * curves->slices);
        const wh_real_t gap = curves->gaps[kind][bin];
        wh_json_append(times, wh_json_real((double)(slice * slice_us) / 1e6));
        wh_json_append(gaps, gap < WH_CLEARANCE_RANGE ? wh_json_real((double)gap) : json_null());
    }
    wh_json_put_text(object, "kind", wh_clearance_name((wh_clearance_kind_t)kind));
    wh_json_put(object, "times_s", times);
    wh_json_put(object, "gaps", gaps);
    return object;
}

/* Of the kinds that were ever near. */
static json_t *curves(const wh_record_t *record) {
    json_t *list = json_array();
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        if (record->clearances[kind].parts[0] != WH_NONE) {
            wh_json_append(list, curve(record, kind));
        }
    }
    return list;
}

/* --------------------------------------------------------------------------------------------- throughput */

static json_t *throughput(const wh_record_t *record) {
    const wh_throughput_t found = wh_throughput(record);
    json_t *object = json_object();
    wh_json_put_integer(object, "wafers", (json_int_t)found.wafers);
    wh_json_put_real(object, "seconds", found.seconds);
    wh_json_put_real(object, "wafers_per_hour", found.wafers_per_hour);
    wh_json_put(object, "first_cycle", found.first > 0 ? json_integer((json_int_t)found.first) : json_null());
    wh_json_put(object, "last_cycle", found.first > 0 ? json_integer((json_int_t)found.last) : json_null());
    wh_json_put_integer(object, "puts", (json_int_t)found.puts);
    wh_json_put_text(object, "rule", wh_throughput_rule(found.rank));
    return object;
}

/* ------------------------------------------------------------------------------------------------- cycles */

static json_t *cycle(const wh_record_t *record, size_t i, size_t wafers) {
    const wh_cycle_record_t *from = &record->cycles[i];
    json_t *object = json_object();
    wh_json_put_integer(object, "line", from->line);
    wh_json_put(object, "name", from->name[0] != '\0' ? wh_json_text(from->name) : json_null());
    wh_json_put_real(object, "begin_s", wh_throughput_seconds(record, from->begin));
    wh_json_put_real(object, "end_s", wh_throughput_seconds(record, wh_throughput_cycle_end(record, i)));
    wh_json_put_integer(object, "wafers", (json_int_t)wafers);
    return object;
}

static json_t *cycles(const wh_record_t *record) {
    size_t *wafers = wh_throughput_cycle_wafers(record, wh_throughput(record).rank);
    json_t *list = json_array();
    for (size_t i = 0; i < record->cycle_count; ++i) {
        wh_json_append(list, cycle(record, i, wafers[i]));
    }
    free(wafers);
    return list;
}

/* -------------------------------------------------------------------------------------------------- gantt */

static json_t *interval_what(const wh_record_t *record, const wh_busy_span_t *interval) {
    static const char *const shares[WH_SHARES] = {"loaded", "empty", "vacuum", "handover", "waiting"};
    switch (interval->who) {
    case WH_BUSY_WAFER:
        return wh_json_text(wh_record_wafer_name(record, interval->what - 1));
    case WH_BUSY_VALVE:
        return json_string("open");
    case WH_BUSY_ROBOT:
    case WH_BUSY_CHUCK:
        break;
    }
    return json_string(shares[interval->what - 1]);
}

static json_t *interval(const wh_record_t *record, const wh_busy_span_t *from) {
    static const char *const resources[] = {"robot", "chuck", "gripper", "valve"};
    json_t *object = json_object();
    wh_json_put_text(object, "resource", resources[from->who]);
    wh_json_put_text(object, "gripper", wh_record_gripper_name(record, from->gripper));
    wh_json_put_real(object, "from_s", wh_throughput_seconds(record, from->begin));
    wh_json_put_real(object, "to_s", wh_throughput_seconds(record, from->end));
    wh_json_put(object, "what", interval_what(record, from));
    return object;
}

/* By resource, then by time. */
static json_t *gantt(const wh_record_t *record) {
    const wh_activity_t *activity = &record->activity;
    json_t *list = json_array();
    for (size_t resource = 0; resource < WH_RESOURCES; ++resource) {
        for (size_t i = 0; i < activity->interval_count; ++i) {
            if (wh_activity_resource(&activity->intervals[i]) == resource) {
                wh_json_append(list, interval(record, &activity->intervals[i]));
            }
        }
    }
    return list;
}

/* -------------------------------------------------------------------------------------------------- reach */

static json_t *reach(const wh_record_t *record, int32_t station, size_t axis) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    const wh_travel_margin_t *from = &record->reach[station].axes[axis];
    const bool turns = axis == WH_AXIS_THETA || axis == WH_AXIS_YAW;
    json_t *object = json_object();
    wh_json_put_text(object, "station", wh_record_station_name(record, station));
    wh_json_put_integer(object, "slot", from->slot);
    wh_json_put_text(object, "axis", names[axis]);
    wh_json_put_real(object, "margin", (double)(turns ? wh_deg_from_rad(from->margin) : from->margin));
    wh_json_put_real(object, "at", (double)(turns ? wh_deg_from_rad(from->at) : from->at));
    wh_json_put_text(object, "end", from->is_max ? "max" : "min");
    wh_json_put_text(object, "unit", turns ? "deg" : "mm");
    return object;
}

static json_t *reaches(const wh_record_t *record) {
    const size_t stations = record->reach && record->layout ? record->layout->station_count : 0;
    json_t *list = json_array();
    for (size_t station = 0; station < stations; ++station) {
        for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
            if (record->reach[station].axes[axis].slot != 0) {
                wh_json_append(list, reach(record, (int32_t)station, axis));
            }
        }
    }
    return list;
}

/* ---------------------------------------------------------------------------------------------------- all */

static json_t *expectation(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_expectation_record_t *from = &record->expectations[i];
    json_t *object = json_object();
    wh_json_put_integer(object, "line", from->line);
    wh_json_put_text(object, "text", from->text);
    wh_json_put(object, "ok", json_boolean(from->ok));
    return object;
}

static void put_head(const wh_record_t *record, json_t *root) {
    wh_json_put_integer(root, "format", FORMAT);
    wh_json_put(root, "ok", json_boolean(record->ok));
    if (record->failure) {
        wh_json_put_text(root, "failure", record->failure);
    }
    wh_json_put_text(root, "script", record->script);
    wh_json_put_text(root, "layout", record->layout ? record->layout->path : NULL);
    wh_json_put_integer(root, "slices", record->slices);
    wh_json_put_integer(root, "missed", record->missed);
    wh_json_put_real(root, "simulated_s", record->simulated_s);
    wh_json_put_real(root, "wall_s", record->wall_s);
    wh_json_put(root, "hash", json_sprintf("%016llx", (unsigned long long)record->hash));
    wh_json_put(root, "throughput", throughput(record));
    wh_json_put(root, "split", split_of(record, record->activity.shares));
}

static void put_lists(const wh_record_t *record, json_t *root) {
    const size_t wafers = record->layout ? record->layout->wafer_count : 0;
    wh_json_put(root, "commands", wh_json_list(command, record, record->command_count));
    wh_json_put(root, "wafers", wh_json_list(wafer, record, wafers));
    wh_json_put(root, "events", wh_json_list(event, record, record->event_count));
    if (record->checked) {
        wh_json_put(root, "clearances", wh_json_list(clearance, record, WH_CLEARANCES));
    }
    if (record->checked && record->curves) {
        wh_json_put(root, "clearance_curves", curves(record));
    }
    wh_json_put(root, "expectations", wh_json_list(expectation, record, record->expectation_count));
    wh_json_put(root, "cycles", cycles(record));
    wh_json_put(root, "gantt", gantt(record));
    wh_json_put(root, "reach", reaches(record));
}

json_t *wh_record_to_json(const wh_record_t *record) {
    json_t *root = json_object();
    put_head(record, root);
    put_lists(record, root);
    return root;
}

int wh_record_print_json(const wh_record_t *record, FILE *out) {
    json_t *root = wh_record_to_json(record);
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
