#include "record_print.h"

#include <stdlib.h>

#include "../math/trig.h"
#include "../record/throughput.h"
#include "../sim/faults.h"
#include "../text/json.h"

/* The format's number: goes up when a key changes its meaning or leaves. */
#define FORMAT 1

/* ----------------------------------------------------------------------------------------------- commands */

static json_t *seconds(const wh_record_t *record, int64_t slices) {
    return wh_json_real(wh_throughput_seconds(record, slices));
}

/* What a time went into. */
static json_t *split_of(const wh_record_t *record, const int64_t shares[WH_SHARES]) {
    return wh_json_add(json_object(), "motion_s loaded_s empty_s vacuum_s handover_s waiting_s",
                       seconds(record, shares[WH_SHARE_LOADED] + shares[WH_SHARE_EMPTY]),
                       seconds(record, shares[WH_SHARE_LOADED]), seconds(record, shares[WH_SHARE_EMPTY]),
                       seconds(record, shares[WH_SHARE_VACUUM]), seconds(record, shares[WH_SHARE_HANDOVER]),
                       seconds(record, shares[WH_SHARE_WAITING]), NULL);
}

static json_t *command(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_command_record_t *from = &record->commands[i];
    json_t *object = wh_json_add(json_object(), "line text error begin_s end_s split",
                                 json_integer(from->line), wh_json_text(from->text),
                                 json_integer((json_int_t)from->error), wh_json_real(from->begin_s),
                                 wh_json_real(from->end_s), split_of(record, from->shares), NULL);
    if (from->message) {
        wh_json_put_text(object, "message", from->message);
    }
    return object;
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void put_place(const wh_record_t *record, json_t *object, const wh_place_t *place) {
    const bool lies = place->station != WH_NONE;
    (void)wh_json_add(object, "station slot dx dy dz tilt_deg",
                      wh_json_text(wh_record_station_name(record, place->station)),
                      lies ? json_integer(place->slot) : json_null(),
                      lies ? wh_json_real((double)place->dx) : json_null(),
                      lies ? wh_json_real((double)place->dy) : json_null(),
                      lies ? wh_json_real((double)place->dz) : json_null(),
                      lies ? wh_json_real((double)wh_deg_from_rad(place->tilt)) : json_null(), NULL);
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
    json_t *object =
        wh_json_add(json_object(), "name holder", wh_json_text(wh_record_wafer_name(record, (int32_t)i)),
                    wh_json_text(wh_record_gripper_name(record, from->holder)), NULL);
    put_place(record, object, &from->place);
    (void)wh_json_add(object, "notch_deg position rotation", wh_json_real(notch_deg(record->layout, from)),
                      wh_json_vector(from->base_from_wafer.r), wh_json_matrix(&from->base_from_wafer.R),
                      NULL);
    return object;
}

/* ------------------------------------------------------------------------------------------------- events */

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

static void put_measured(const wh_record_t *record, json_t *object, const wh_event_t *event) {
    const wh_proximity_t *measured = &event->measured;
    (void)wh_json_add(
        object, "dr_proj_z dr_proj_xy dr_proj_xy_norm n1_proj_n2 margins failed measured_utime",
        wh_json_real(measured->dr_proj_z), wh_json_vector(measured->dr_proj_xy),
        wh_json_real(measured->dr_proj_xy_norm), wh_json_real(measured->n1_proj_n2),
        wh_json_add(json_object(), "projz projxy planar", wh_json_real(measured->margin_projz),
                    wh_json_real(measured->margin_projxy), wh_json_real(measured->margin_planar), NULL),
        failed_conditions(measured->failed),
        record->layout ? json_integer((json_int_t)event->measured_slice * record->layout->slice_us)
                       : json_null(),
        NULL);
}

static bool is_unmeasured(wh_event_kind_t kind) {
    static const uint32_t kinds = 1U << WH_EVENT_BAD_INPUT | 1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED |
                                  1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_SLIPPED |
                                  1U << WH_EVENT_VACUUM_LOST | 1U << WH_EVENT_FAULT_ARMED |
                                  1U << WH_EVENT_FAULT_CLEARED;
    return (kinds >> (unsigned)kind & 1U) != 0;
}

static json_t *part_name(const wh_record_t *record, int32_t part) {
    return wh_json_text(record->layout ? wh_layout_part_name(record->layout, part) : NULL);
}

static json_t *part_names(const wh_record_t *record, const int32_t parts[2]) {
    return json_pack("[o, o]", part_name(record, parts[0]), part_name(record, parts[1]));
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
        (void)wh_json_add(object, "parts at", part_names(record, event->parts), wh_json_vector(event->at),
                          NULL);
    }
    if (kind & with_values) {
        (void)wh_json_add(object, "value limit", found(event, event->value), found(event, event->limit),
                          NULL);
    }
    if (kind & of_faults) {
        (void)wh_json_add(object, "fault fault_kind", json_integer(event->parts[0] + 1),
                          wh_json_text(wh_fault_name((wh_fault_kind_t)event->parts[1])), NULL);
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
        (void)wh_json_add(object, "status message", json_integer((json_int_t)event->status),
                          wh_json_text(wh_record_error_text(event->status)), NULL);
        break;
    default:
        put_found(record, object, event);
        break;
    }
}

static json_t *event(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_event_record_t *from = &record->events[i];
    json_t *object = wh_json_add(json_object(), "utime kind wafer gripper", json_integer(from->utime),
                                 wh_json_text(wh_event_name(from->event.kind)),
                                 wh_json_text(wh_record_wafer_name(record, from->event.wafer)),
                                 wh_json_text(wh_record_gripper_name(record, from->event.gripper)), NULL);
    if (is_unmeasured(from->event.kind)) {
        /* The same keys for an event that measured nothing. */
        (void)wh_json_add(
            object, "dr_proj_z dr_proj_xy dr_proj_xy_norm n1_proj_n2 margins failed measured_utime",
            json_null(), json_null(), json_null(), json_null(), json_null(), json_null(), json_null(), NULL);
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
    return wh_json_add(json_object(), "kind gap limit utime parts at",
                       wh_json_text(wh_clearance_name((wh_clearance_kind_t)kind)),
                       found ? wh_json_real((double)from->gap) : json_null(),
                       limit > 0 ? wh_json_real((double)limit) : json_null(),
                       found ? json_integer((json_int_t)from->slice * layout->slice_us) : json_null(),
                       found ? part_names(record, from->parts) : json_null(),
                       found ? wh_json_vector(from->at) : json_null(), NULL);
}

/* The smallest gap in each bin, by the time at which it ends; null where it was wider than what is kept. Only
 * of a kind that was ever near. */
static json_t *curve(const void *subject, size_t kind) {
    const wh_record_t *record = subject;
    const wh_curves_t *curves = record->curves;
    if (record->clearances[kind].parts[0] == WH_NONE) {
        return NULL;
    }
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
    (void)wh_json_add(object, "kind times_s gaps", wh_json_text(wh_clearance_name((wh_clearance_kind_t)kind)),
                      times, gaps, NULL);
    return object;
}

/* --------------------------------------------------------------------------------------------- throughput */

static json_t *throughput(const wh_record_t *record) {
    const wh_throughput_t found = wh_throughput(record);
    return wh_json_add(json_object(), "wafers seconds wafers_per_hour first_cycle last_cycle puts rule",
                       json_integer((json_int_t)found.wafers), wh_json_real(found.seconds),
                       wh_json_real(found.wafers_per_hour),
                       found.first > 0 ? json_integer((json_int_t)found.first) : json_null(),
                       found.first > 0 ? json_integer((json_int_t)found.last) : json_null(),
                       json_integer((json_int_t)found.puts), wh_json_text(wh_throughput_rule(found.rank)),
                       NULL);
}

/* ------------------------------------------------------------------------------------------------- cycles */

static json_t *cycle(const wh_record_t *record, size_t i, size_t wafers) {
    const wh_cycle_record_t *from = &record->cycles[i];
    return wh_json_add(json_object(), "line name begin_s end_s wafers", json_integer(from->line),
                       from->name[0] != '\0' ? wh_json_text(from->name) : json_null(),
                       seconds(record, from->begin), seconds(record, wh_throughput_cycle_end(record, i)),
                       json_integer((json_int_t)wafers), NULL);
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
    if (interval->who == WH_BUSY_WAFER) {
        return wh_json_text(wh_record_wafer_name(record, interval->what - 1));
    }
    return json_string(interval->who == WH_BUSY_VALVE ? "open" : shares[interval->what - 1]);
}

static json_t *interval(const wh_record_t *record, const wh_busy_span_t *from) {
    static const char *const resources[] = {"robot", "chuck", "gripper", "valve"};
    return wh_json_add(json_object(), "resource gripper from_s to_s what", wh_json_text(resources[from->who]),
                       wh_json_text(wh_record_gripper_name(record, from->gripper)),
                       seconds(record, from->begin), seconds(record, from->end), interval_what(record, from),
                       NULL);
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

/* By station and axis; null where the axis was not looked at. */
static json_t *reach(const void *subject, size_t i) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    const wh_record_t *record = subject;
    const size_t axis = i % WH_ROBOT_AXES;
    const wh_travel_margin_t *from = &record->reach[i / WH_ROBOT_AXES].axes[axis];
    const bool turns = axis == WH_AXIS_THETA || axis == WH_AXIS_YAW;
    if (from->slot == 0) {
        return NULL;
    }
    return wh_json_add(json_object(), "station slot axis margin at end unit",
                       wh_json_text(wh_record_station_name(record, (int32_t)(i / WH_ROBOT_AXES))),
                       json_integer(from->slot), wh_json_text(names[axis]),
                       wh_json_real((double)(turns ? wh_deg_from_rad(from->margin) : from->margin)),
                       wh_json_real((double)(turns ? wh_deg_from_rad(from->at) : from->at)),
                       wh_json_text(from->is_max ? "max" : "min"), wh_json_text(turns ? "deg" : "mm"), NULL);
}

/* ---------------------------------------------------------------------------------------------------- all */

static json_t *expectation(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_expectation_record_t *from = &record->expectations[i];
    return wh_json_add(json_object(), "line text ok", json_integer(from->line), wh_json_text(from->text),
                       json_boolean(from->ok), NULL);
}

static void put_head(const wh_record_t *record, json_t *root) {
    wh_json_put_integer(root, "format", FORMAT);
    wh_json_put(root, "ok", record->is_untold ? json_null() : json_boolean(record->ok));
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
    const size_t stations = record->layout && record->reach ? record->layout->station_count : 0;
    wh_json_put(root, "commands", wh_json_list(command, record, record->command_count));
    wh_json_put(root, "wafers", wh_json_list(wafer, record, wafers));
    wh_json_put(root, "events", wh_json_list(event, record, record->event_count));
    if (record->checked) {
        wh_json_put(root, "clearances", wh_json_list(clearance, record, WH_CLEARANCES));
    }
    if (record->checked && record->curves) {
        wh_json_put(root, "clearance_curves", wh_json_list(curve, record, WH_CLEARANCES));
    }
    wh_json_put(root, "expectations", wh_json_list(expectation, record, record->expectation_count));
    wh_json_put(root, "cycles", cycles(record));
    wh_json_put(root, "gantt", gantt(record));
    wh_json_put(root, "reach", wh_json_list(reach, record, stations * WH_ROBOT_AXES));
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
