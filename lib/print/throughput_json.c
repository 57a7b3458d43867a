/* The figures as JSON: wafers per hour, what the time goes into, who is busy when, and reach. */
#include "../math/trig.h"
#include "../record/throughput.h"
#include "record_json_internal.h"
#include "record_names.h"

json_t *wh_json_split(wh_json_writer_t *writer, const int64_t shares[WH_SHARES]) {
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
        wh_json_put(writer, object, parts[i].key,
                    wh_json_real(wh_throughput_seconds(wh_json_record(writer), parts[i].slices)));
    }
    return object;
}

static json_t *throughput(wh_json_writer_t *writer) {
    const wh_throughput_t found = wh_throughput(wh_json_record(writer));
    json_t *object = json_object();
    wh_json_put(writer, object, "wafers", json_integer((json_int_t)found.wafers));
    wh_json_put(writer, object, "seconds", wh_json_real(found.seconds));
    wh_json_put(writer, object, "wafers_per_hour", wh_json_real(found.wafers_per_hour));
    wh_json_put(writer, object, "first_cycle",
                found.first > 0 ? json_integer((json_int_t)found.first) : json_null());
    wh_json_put(writer, object, "last_cycle",
                found.first > 0 ? json_integer((json_int_t)found.last) : json_null());
    wh_json_put(writer, object, "puts", json_integer((json_int_t)found.puts));
    wh_json_put(writer, object, "rule", wh_json_text(wh_record_rank_text(found.rank)));
    return object;
}

void wh_json_put_sums(wh_json_writer_t *writer, json_t *root) {
    wh_json_put(writer, root, "throughput", throughput(writer));
    wh_json_put(writer, root, "split", wh_json_split(writer, wh_json_record(writer)->activity.shares));
}

/* --------------------------------------------------------------------------------------------------- cycles */

static json_t *cycle(wh_json_writer_t *writer, size_t i, size_t wafers) {
    const wh_record_t *record = wh_json_record(writer);
    const wh_cycle_record_t *from = &record->cycles[i];
    json_t *object = json_object();
    wh_json_put(writer, object, "line", json_integer(from->line));
    wh_json_put(writer, object, "name", from->name[0] != '\0' ? wh_json_text(from->name) : json_null());
    wh_json_put(writer, object, "begin_s", wh_json_real(wh_throughput_seconds(record, from->begin)));
    wh_json_put(writer, object, "end_s",
                wh_json_real(wh_throughput_seconds(record, wh_throughput_cycle_end(record, i))));
    wh_json_put(writer, object, "wafers", json_integer((json_int_t)wafers));
    return object;
}

static json_t *cycles(wh_json_writer_t *writer) {
    const wh_record_t *record = wh_json_record(writer);
    size_t *wafers = wh_throughput_cycle_wafers(record, wh_throughput(record).rank);
    json_t *list = json_array();
    for (size_t i = 0; i < record->cycle_count; ++i) {
        wh_json_append(writer, list, cycle(writer, i, wafers[i]));
    }
    free(wafers);
    return list;
}

/* ---------------------------------------------------------------------------------------------------- gantt */

static json_t *interval_what(const wh_json_writer_t *writer, const wh_busy_span_t *interval) {
    static const char *const shares[WH_SHARES] = {"loaded", "empty", "vacuum", "handover", "waiting"};
    switch (interval->who) {
    case WH_BUSY_WAFER:
        return wh_json_text(wh_record_wafer_name(wh_json_record(writer), interval->what - 1));
    case WH_BUSY_VALVE:
        return json_string("open");
    case WH_BUSY_ROBOT:
    case WH_BUSY_CHUCK:
        break;
    }
    return json_string(shares[interval->what - 1]);
}

static json_t *interval(wh_json_writer_t *writer, const wh_busy_span_t *from) {
    static const char *const resources[] = {"robot", "chuck", "gripper", "valve"};
    const wh_record_t *record = wh_json_record(writer);
    json_t *object = json_object();
    wh_json_put(writer, object, "resource", json_string(resources[from->who]));
    wh_json_put(writer, object, "gripper", wh_json_text(wh_record_gripper_name(record, from->gripper)));
    wh_json_put(writer, object, "from_s", wh_json_real(wh_throughput_seconds(record, from->begin)));
    wh_json_put(writer, object, "to_s", wh_json_real(wh_throughput_seconds(record, from->end)));
    wh_json_put(writer, object, "what", interval_what(writer, from));
    return object;
}

/* By resource, then by time. */
static json_t *gantt(wh_json_writer_t *writer) {
    const wh_activity_t *activity = &wh_json_record(writer)->activity;
    json_t *list = json_array();
    for (size_t resource = 0; resource < WH_RESOURCES; ++resource) {
        for (size_t i = 0; i < activity->interval_count; ++i) {
            if (wh_activity_resource(&activity->intervals[i]) == resource) {
                wh_json_append(writer, list, interval(writer, &activity->intervals[i]));
            }
        }
    }
    return list;
}

/* ---------------------------------------------------------------------------------------------------- reach */

static json_t *reach(wh_json_writer_t *writer, int32_t station, size_t axis) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    const wh_travel_margin_t *from = &wh_json_record(writer)->reach[station].axes[axis];
    const bool turns = axis == WH_AXIS_THETA || axis == WH_AXIS_YAW;
    json_t *object = json_object();
    wh_json_put(writer, object, "station",
                wh_json_text(wh_record_station_name(wh_json_record(writer), station)));
    wh_json_put(writer, object, "slot", json_integer(from->slot));
    wh_json_put(writer, object, "axis", json_string(names[axis]));
    wh_json_put(writer, object, "margin",
                wh_json_real((double)(turns ? wh_deg_from_rad(from->margin) : from->margin)));
    wh_json_put(writer, object, "at", wh_json_real((double)(turns ? wh_deg_from_rad(from->at) : from->at)));
    wh_json_put(writer, object, "end", json_string(from->is_max ? "max" : "min"));
    wh_json_put(writer, object, "unit", json_string(turns ? "deg" : "mm"));
    return object;
}

static json_t *reaches(wh_json_writer_t *writer) {
    const wh_record_t *record = wh_json_record(writer);
    const size_t stations = record->reach && record->layout ? record->layout->station_count : 0;
    json_t *list = json_array();
    for (size_t station = 0; station < stations; ++station) {
        for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
            if (record->reach[station].axes[axis].slot != 0) {
                wh_json_append(writer, list, reach(writer, (int32_t)station, axis));
            }
        }
    }
    return list;
}

void wh_json_put_figures(wh_json_writer_t *writer, json_t *root) {
    wh_json_put(writer, root, "cycles", cycles(writer));
    wh_json_put(writer, root, "gantt", gantt(writer));
    wh_json_put(writer, root, "reach", reaches(writer));
}
