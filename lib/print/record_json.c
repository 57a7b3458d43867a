#include "record_print.h"

#include <math.h>
#include <stdlib.h>

#include "../layout/axes.h"
#include "../layout/grips.h"
#include "../layout/ports.h"
#include "../layout/times.h"
#include "../math/trig.h"
#include "../record/steady.h"
#include "../text/json.h"

/* The format's number: goes up when a key changes its meaning or leaves. */
#define FORMAT 2

/* ----------------------------------------------------------------------------------------------- commands */

/* The parts of a time. */
static json_t *split_of(const wh_record_t *record, const int64_t shares[WH_SHARES]) {
    static const char *const keys[WH_SHARES] = {"loaded_s", "empty_s", "vacuum_s", "handover_s", "waiting_s"};
    const int64_t motion = shares[WH_SHARE_LOADED] + shares[WH_SHARE_EMPTY];
    json_t *object = wh_json_set(json_object(), "motion_s %g", wh_throughput_seconds(record, motion));
    for (size_t share = 0; share < WH_SHARES; ++share) {
        wh_json_put(object, keys[share], wh_json_real(wh_throughput_seconds(record, shares[share])));
    }
    return object;
}

static json_t *command(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_command_record_t *from = &record->commands[i];
    json_t *object = wh_json_set(json_object(), "line %d text %s error %d begin_s %g end_s %g", from->line,
                                 from->text, (int)from->error, from->begin_s, from->end_s);
    if (record->has_tasks) {
        (void)wh_json_set(object, "task %d", (int)from->task);
    }
    wh_json_put(object, "split", split_of(record, from->shares));
    return from->message ? wh_json_set(object, "message %s", from->message) : object;
}

/* ------------------------------------------------------------------------------------------------- wafers */

/* Where the notch of wafer `w` points, about the station's z from its x; about base's for a wafer in no slot.
 * Infinite if there is none. A wafer's own rim tells, where edge sensors see it. */
static double notch_deg(const wh_layout_t *layout, const wh_wafer_record_t *wafer, size_t w) {
    const wh_rim_t *rim =
        (layout->scanner_count > 0 || layout->edge_wafers) && layout->rims ? layout->rims[w] : NULL;
    const double depth = rim ? rim->notch.depth : layout->notch_depth;
    wh_real_t sine = 0;
    wh_real_t cosine = 1;
    if (!(depth > 0)) {
        return HUGE_VAL;
    }
    wh_sin_cos((wh_real_t)(rim ? rim->notch.direction : layout->notch), &sine, &cosine);
    const wh_vec3_t notch = {cosine, sine, 0};
    wh_vec3_t direction = wh_mat3_transform(&wafer->base_from_wafer.R, &notch);
    if (wafer->place.station != WH_NONE) {
        direction =
            wh_mat3_transform_back(&layout->places[wafer->place.station].base_from_station.R, &direction);
    }
    return wh_deg_from_rad(wh_atan2(direction.y, direction.x));
}

static json_t *wafer(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_wafer_record_t *from = &record->wafers[i];
    const wh_place_t *place = &from->place;
    const bool lies = place->station != WH_NONE;
    json_t *object =
        wh_json_set(json_object(),
                    "name %s holder %s station %s slot %lld dx %g dy %g dz %g tilt_deg %g notch_deg %g "
                    "face %s",
                    wh_record_wafer_name(record, (int32_t)i), wh_record_gripper_name(record, from->holder),
                    wh_record_station_name(record, place->station), lies ? place->slot : WH_JSON_NONE,
                    lies ? place->dx : HUGE_VAL, lies ? place->dy : HUGE_VAL, lies ? place->dz : HUGE_VAL,
                    lies ? wh_deg_from_rad(place->tilt) : HUGE_VAL, notch_deg(record->layout, from, i),
                    wh_layout_face_of(&from->base_from_wafer));
    return wh_json_add(object, "position rotation", wh_json_vector(from->base_from_wafer.r),
                       wh_json_matrix(&from->base_from_wafer.R), NULL);
}

/* --------------------------------------------------------------------------------------------- clearances */

/* One kind's smallest gap; nulls where nothing came near. */
static json_t *clearance(const void *subject, size_t kind) {
    const wh_record_t *record = subject;
    const wh_clearance_t *from = &record->clearances[kind];
    const wh_layout_t *layout = record->layout;
    const wh_real_t limit = layout->world.limits[kind];
    const bool found = from->parts[0] != WH_NONE;
    json_t *object = wh_json_set(json_object(), "kind %s gap %g limit %g utime %lld",
                                 wh_clearance_name((wh_clearance_kind_t)kind), found ? from->gap : HUGE_VAL,
                                 limit > 0 ? limit : HUGE_VAL,
                                 found ? (json_int_t)from->slice * layout->slice_us : WH_JSON_NONE);
    return wh_json_add(object, "parts at", found ? wh_parts_to_json(record, from->parts) : json_null(),
                       found ? wh_json_vector(from->at) : json_null(), NULL);
}

/* The smallest gap in each bin, by the bin's end time; null where it was wider than the gaps that are kept.
 * Only kinds that were ever near appear. */
static json_t *curve(const void *subject, size_t kind) {
    const wh_record_t *record = subject;
    const wh_curves_t *curves = record->curves;
    if (record->clearances[kind].parts[0] == WH_NONE) {
        return NULL;
    }
    json_t *object = wh_json_set(json_object(), "kind %s", wh_clearance_name((wh_clearance_kind_t)kind));
    json_t *times = json_array();
    json_t *gaps = json_array();
    for (size_t bin = 0; bin < curves->count; ++bin) {
        const int64_t slice = (int64_t)wh_curves_end(curves, bin);
        const wh_real_t gap = curves->gaps[kind][bin];
        wh_json_append(times, wh_json_real(wh_throughput_seconds(record, slice)));
        wh_json_append(gaps, wh_json_real(gap < WH_CLEARANCE_RANGE ? gap : HUGE_VAL));
    }
    return wh_json_add(object, "times_s gaps", times, gaps, NULL);
}

/* --------------------------------------------------------------------------------------------- throughput */

/* The stations where a put wafer counts as done. */
static json_t *counting(const wh_record_t *record) {
    json_t *list = json_array();
    for (size_t s = 0; record->layout && s < record->layout->station_count; ++s) {
        if (record->layout->stations[s].counts) {
            wh_json_append(list, wh_json_text(record->layout->stations[s].name));
        }
    }
    return list;
}

json_t *wh_throughput_to_json(const wh_record_t *record) {
    const wh_throughput_t found = wh_throughput(record);
    const bool given = found.figure == WH_FIGURE_GIVEN;
    json_t *object = wh_json_set(
        json_object(),
        "wafers_per_hour %g reason %s wafers %lld seconds %g first_cycle %lld last_cycle %lld puts %lld",
        given ? found.wafers_per_hour : HUGE_VAL, wh_throughput_reason(found.figure),
        (json_int_t)found.wafers, found.seconds, found.first > 0 ? (json_int_t)found.first : WH_JSON_NONE,
        found.first > 0 ? (json_int_t)found.last : WH_JSON_NONE, (json_int_t)found.puts);
    wh_json_put(object, "counting", counting(record));
    return object;
}

static json_t *steady_cycle(const wh_record_t *record) {
    static const char *const fields =
        "wafers_per_hour %g reason %s found %i begin_s %g end_s %g wafers %lld times %lld cycle %lld "
        "first_command %lld commands %lld";
    const wh_steady_cycle_t steady = wh_steady_cycle(record);
    if (steady.found != WH_STEADY_FOUND) {
        return wh_json_set(json_object(), fields, HUGE_VAL, wh_steady_reason(steady.found), false, HUGE_VAL,
                           HUGE_VAL, WH_JSON_NONE, WH_JSON_NONE, WH_JSON_NONE, WH_JSON_NONE, WH_JSON_NONE);
    }
    return wh_json_set(json_object(), fields,
                       steady.figure == WH_FIGURE_GIVEN ? steady.wafers_per_hour : HUGE_VAL,
                       wh_throughput_reason(steady.figure), true, wh_throughput_seconds(record, steady.begin),
                       wh_throughput_seconds(record, steady.end), (json_int_t)steady.wafers,
                       (json_int_t)steady.times, steady.mark > 0 ? (json_int_t)steady.mark : WH_JSON_NONE,
                       (json_int_t)steady.first, (json_int_t)steady.count);
}

/* ------------------------------------------------------------------------------------------------- cycles */

static json_t *cycle(const wh_record_t *record, size_t i, size_t wafers) {
    const wh_cycle_record_t *from = &record->cycles[i];
    return wh_json_set(json_object(), "line %d name %s begin_s %g end_s %g wafers %lld", from->line,
                       from->name[0] != '\0' ? from->name : NULL, wh_throughput_seconds(record, from->begin),
                       wh_throughput_seconds(record, wh_throughput_cycle_end(record, i)), (json_int_t)wafers);
}

static json_t *cycles(const wh_record_t *record) {
    size_t *wafers = wh_throughput_cycle_wafers(record);
    json_t *list = json_array();
    for (size_t i = 0; i < record->cycle_count; ++i) {
        wh_json_append(list, cycle(record, i, wafers[i]));
    }
    free(wafers);
    return list;
}

/* -------------------------------------------------------------------------------------------------- gantt */

static const char *interval_what(const wh_record_t *record, const wh_busy_span_t *interval) {
    static const char *const shares[WH_SHARES] = {"loaded", "empty", "vacuum", "handover", "waiting"};
    if (interval->who == WH_BUSY_WAFER) {
        return wh_record_wafer_name(record, interval->what - 1);
    }
    return interval->who == WH_BUSY_VALVE ? "open" : shares[interval->what - 1];
}

static json_t *interval(const wh_record_t *record, const wh_busy_span_t *from) {
    static const char *const resources[] = {"robot", "chuck", "gripper", "valve", "door"};
    const wh_layout_t *layout = record->layout;
    const char *name = NULL;
    if (from->who == WH_BUSY_DOOR) {
        name = layout->door_list[from->gripper].name;
    } else if (from->who != WH_BUSY_ROBOT) {
        name = wh_record_gripper_name(record, from->gripper);
    } else if (layout->robot_count > 1) {
        name = layout->robots[from->gripper].name;
    }
    return wh_json_set(json_object(), "resource %s gripper %s from_s %g to_s %g what %s",
                       resources[from->who], name, wh_throughput_seconds(record, from->begin),
                       wh_throughput_seconds(record, from->end), interval_what(record, from));
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

/* -------------------------------------------------------------------------------------------------- waits */

static json_t *wait_of(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_wait_record_t *from = &record->waits[i];
    return wh_json_set(json_object(), "task %d command %s for %s from_s %g to_s %g", (int)from->task,
                       from->command == WH_NONE ? NULL : record->commands[from->command].text, from->what,
                       wh_throughput_seconds(record, from->begin), wh_throughput_seconds(record, from->end));
}

/* -------------------------------------------------------------------------------------------------- reach */

/* By station and axis; null where the axis was not checked. */
static json_t *reach(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_machine_t *machine = &record->layout->machine;
    const size_t count = wh_machine_robot_axes(machine);
    const size_t axis = i % count;
    const wh_travel_margin_t *from = &record->reach[i / count].axes[axis];
    const bool turns = wh_axis_turns(machine, axis);
    char label[WH_NAME_SIZE + 16];
    if (from->slot == 0 || !wh_axis_exists(machine, axis)) {
        return NULL;
    }
    return wh_json_set(json_object(), "station %s slot %d axis %s margin %g at %g end %s unit %s",
                       wh_record_station_name(record, (int32_t)(i / count)), from->slot,
                       wh_layout_axis_label(record->layout, axis, label, sizeof label),
                       turns ? wh_deg_from_rad(from->margin) : from->margin,
                       turns ? wh_deg_from_rad(from->at) : from->at, from->is_max ? "max" : "min",
                       turns ? "deg" : "mm");
}

/* ---------------------------------------------------------------------------------------------------- all */

static json_t *expectation(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_expectation_record_t *from = &record->expectations[i];
    return wh_json_set(json_object(), "line %d text %s ok %i", from->line, from->text, from->ok);
}

static json_t *log_note(const void *subject, size_t i) {
    return wh_json_text(((const wh_record_log_t *)subject)->notes[i]);
}

static json_t *log_of(const wh_record_log_t *log) {
    json_t *object = wh_json_set(json_object(), "verdict %s reason %s id %llx part %lld", log->verdict,
                                 log->reason[0] ? log->reason : NULL, (unsigned long long)log->id,
                                 log->has_id ? log->part : WH_JSON_NONE);
    if (!log->has_id) {
        wh_json_put(object, "id", json_null());
    }
    if (log->is_part) {
        wh_json_put(object, "is_part", json_true());
    }
    wh_json_put(object, "notes", wh_json_list(log_note, log, log->note_count));
    return object;
}

static json_t *given_error(const void *subject, size_t i) {
    return wh_json_text(((const wh_record_t *)subject)->errors[i]);
}

/* How it ended, and what it was a run of, as far as it was none without errors. */
static void put_verdict(const wh_record_t *record, json_t *root) {
    const bool moved_nothing = wh_record_moved_nothing(record);
    wh_json_put(root, "ok", record->is_untold || moved_nothing ? json_null() : json_boolean(record->ok));
    if (moved_nothing) {
        wh_json_put(root, "nothing_moved", json_true());
    }
    if (record->failure) {
        (void)wh_json_set(root, "failure %s", record->failure);
    }
    if (record->error_count > 0) {
        wh_json_put(root, "errors", wh_json_list(given_error, record, record->error_count));
    }
    if (record->trial) {
        wh_json_put(root, "trial",
                    wh_json_set(json_object(), "trial %lld seed %lld", (json_int_t)record->trial->trial,
                                (json_int_t)record->trial->seed));
    }
    if (record->log) {
        wh_json_put(root, "log", log_of(record->log));
    }
}

/* Nothing was looked for in the slices that were left out; it matters where something moved. */
static json_t *counted_of(const wh_record_t *record) {
    const wh_counted_record_t *counted = &record->counted;
    const bool is_unlooked = record->checked && counted->moving > 0;
    json_t *object =
        wh_json_set(json_object(), "played %lld left_out %lld moving %lld commands %lld not_looked_for %s",
                    (json_int_t)(record->slices - counted->left_out), (json_int_t)counted->left_out,
                    (json_int_t)counted->moving, (json_int_t)counted->commands,
                    is_unlooked ? WH_RECORD_COUNTED_UNLOOKED : NULL);
    return counted->is_verified ? wh_json_set(object, "stretches %lld verified %lld",
                                              (json_int_t)counted->stretches, (json_int_t)counted->verified)
                                : object;
}

static void put_head(const wh_record_t *record, json_t *root) {
    (void)wh_json_set(root, "format %d", FORMAT);
    put_verdict(record, root);
    (void)wh_json_set(root, "script %s layout %s slices %lld missed %lld simulated_s %g wall_s %g hash %llx",
                      record->script, record->layout ? record->layout->path : NULL,
                      (json_int_t)record->slices, (json_int_t)record->missed, record->simulated_s,
                      record->wall_s, (unsigned long long)record->hash);
    if (record->crowded > 0) {
        (void)wh_json_set(root, "crowded_slices %lld", (json_int_t)record->crowded);
    }
    wh_json_put(root, "not_looked_for", wh_json_text(record->unlooked));
    if (record->times_alone) {
        wh_json_put(root, "times_alone", wh_json_text(record->times_alone));
    }
    if (record->counted.is_wanted) {
        wh_json_put(root, "counted", counted_of(record));
    }
    if (record->never_came) {
        wh_json_put(root, "never_came", wh_json_text(record->never_came));
    }
    wh_json_put(root, "steady_cycle", steady_cycle(record));
    wh_json_put(root, "throughput", wh_throughput_to_json(record));
    wh_json_put(root, "split", split_of(record, record->activity.shares));
}

/* A cell without stations that take time tells nothing of them. */
static void put_stations(const wh_record_t *record, json_t *root) {
    if (record->station_event_count > 0 ||
        (record->layout && (wh_layout_takes_time(record->layout) || wh_layout_has_ports(record->layout)))) {
        wh_json_put(root, "station_events",
                    wh_json_list(wh_station_event_to_json, record, record->station_event_count));
    }
}

static void put_lists(const wh_record_t *record, json_t *root) {
    const size_t wafers = record->layout ? record->layout->wafer_count : 0;
    const size_t stations = record->layout && record->reach ? record->layout->station_count : 0;
    const size_t robot_axes = record->layout ? wh_machine_robot_axes(&record->layout->machine) : 0;
    wh_json_put(root, "commands", wh_json_list(command, record, record->command_count));
    wh_json_put(root, "wafers", wh_json_list(wafer, record, wafers));
    wh_json_put(root, "events", wh_json_list(wh_event_to_json, record, record->event_count));
    put_stations(record, root);
    if (record->checked) {
        wh_json_put(root, "clearances", wh_json_list(clearance, record, WH_CLEARANCES));
    }
    if (record->checked && record->curves) {
        wh_json_put(root, "clearance_curves", wh_json_list(curve, record, WH_CLEARANCES));
    }
    wh_json_put(root, "expectations", wh_json_list(expectation, record, record->expectation_count));
    wh_json_put(root, "cycles", cycles(record));
    wh_json_put(root, "gantt", gantt(record));
    if (record->has_tasks) {
        wh_json_put(root, "waits", wh_json_list(wait_of, record, record->wait_count));
    }
    wh_json_put(root, "reach", wh_json_list(reach, record, stations * robot_axes));
}

static void put_centrings(const wh_record_t *record, json_t *root) {
    if (record->layout && record->layout->beam_count > 0) {
        wh_json_put(root, "centrings", wh_json_list(wh_centring_to_json, record, record->centring_count));
    }
    if (record->centrings_left_out > 0) {
        (void)wh_json_set(root, "centrings_left_out %lld", (json_int_t)record->centrings_left_out);
    }
}

json_t *wh_record_to_json(const wh_record_t *record) {
    json_t *root = json_object();
    put_head(record, root);
    if (record->flow && record->flow->figures.tool) {
        wh_json_put(root, "flow", wh_flow_to_json(record->flow));
    }
    put_lists(record, root);
    put_centrings(record, root);
    return root;
}

int wh_record_print_json(const wh_record_t *record, FILE *out) {
    json_t *root = wh_record_to_json(record);
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
