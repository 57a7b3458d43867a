#include "app/record_json.h"

#include <inttypes.h>
#include <jansson.h>
#include <string.h>

#include "app/record_names.h"
#include "motion/trig.h"
#include "sim/faults.h"

/* The format's number: goes up when a key changes its meaning or leaves. */
#define FORMAT 1

/* What is being written, and whether any value could not be made. */
typedef struct {
    const wh_record_t *record;
    bool failed;
} writer_t;

static void put(writer_t *writer, json_t *object, const char *key, json_t *value) {
    if (json_object_set_new(object, key, value) != 0) {
        writer->failed = true;
    }
}

static void append(writer_t *writer, json_t *list, json_t *value) {
    if (json_array_append_new(list, value) != 0) {
        writer->failed = true;
    }
}

static json_t *real(double value) {
    return wh_real_is_finite((wh_real_t)value) ? json_real(value) : json_null();
}

/* How long the valid UTF-8 character at `text` is: 0 when there is none. */
static size_t character_bytes(const char *text) {
    const size_t left = strlen(text);
    for (size_t bytes = 1; bytes <= 4 && bytes <= left; ++bytes) {
        json_t *character = json_stringn(text, bytes);
        if (character) {
            json_decref(character);
            return bytes;
        }
    }
    return 0;
}

static json_t *repaired_text(const char *text) {
    static const char replacement[] = "\xef\xbf\xbd";
    char *repaired = malloc(3 * strlen(text) + 1);
    if (!repaired) {
        return NULL;
    }
    char *to = repaired;
    while (*text != '\0') {
        const size_t bytes = character_bytes(text);
        memcpy(to, bytes > 0 ? text : replacement, bytes > 0 ? bytes : 3);
        to += bytes > 0 ? bytes : 3;
        text += bytes > 0 ? bytes : 1;
    }
    json_t *value = json_stringn(repaired, (size_t)(to - repaired));
    free(repaired);
    return value;
}

static json_t *text_or_null(const char *text) {
    if (!text) {
        return json_null();
    }
    json_t *value = json_string(text);
    return value ? value : repaired_text(text);
}

static json_t *vector(writer_t *writer, wh_vec3_t v) {
    json_t *list = json_array();
    append(writer, list, real((double)v.x));
    append(writer, list, real((double)v.y));
    append(writer, list, real((double)v.z));
    return list;
}

static json_t *matrix(writer_t *writer, const wh_mat3_t *m) {
    json_t *rows = json_array();
    for (size_t row = 0; row < 3; ++row) {
        append(writer, rows, vector(writer, wh_mat3_row(m, row)));
    }
    return rows;
}

static json_t *command(writer_t *writer, size_t i) {
    const wh_command_record_t *from = &writer->record->commands[i];
    json_t *object = json_object();
    put(writer, object, "line", json_integer(from->line));
    put(writer, object, "text", text_or_null(from->text));
    put(writer, object, "error", json_integer((json_int_t)from->error));
    put(writer, object, "begin_s", real(from->begin_s));
    put(writer, object, "end_s", real(from->end_s));
    if (from->message) {
        put(writer, object, "message", text_or_null(from->message));
    }
    return object;
}

static void put_place(writer_t *writer, json_t *object, const wh_place_t *place) {
    const bool lies = place->station != WH_NONE;
    put(writer, object, "station", text_or_null(wh_record_station_name(writer->record, place->station)));
    put(writer, object, "slot", lies ? json_integer(place->slot) : json_null());
    put(writer, object, "dx", lies ? real((double)place->dx) : json_null());
    put(writer, object, "dy", lies ? real((double)place->dy) : json_null());
    put(writer, object, "dz", lies ? real((double)place->dz) : json_null());
    put(writer, object, "tilt_deg", lies ? real((double)wh_deg_from_rad(place->tilt)) : json_null());
}

static json_t *wafer(writer_t *writer, size_t i) {
    const wh_wafer_record_t *from = &writer->record->wafers[i];
    json_t *object = json_object();
    put(writer, object, "name", text_or_null(wh_record_wafer_name(writer->record, (int32_t)i)));
    put(writer, object, "holder", text_or_null(wh_record_gripper_name(writer->record, from->holder)));
    put_place(writer, object, &from->place);
    put(writer, object, "position", vector(writer, from->base_from_wafer.r));
    put(writer, object, "rotation", matrix(writer, &from->base_from_wafer.R));
    return object;
}

static json_t *margins(writer_t *writer, const wh_proximity_t *measured) {
    json_t *object = json_object();
    put(writer, object, "projz", real((double)measured->margin_projz));
    put(writer, object, "projxy", real((double)measured->margin_projxy));
    put(writer, object, "planar", real((double)measured->margin_planar));
    return object;
}

static json_t *failed_conditions(writer_t *writer, unsigned failed) {
    static const char *const names[] = {"projz", "projxy", "planar"};
    static const unsigned bits[] = {WH_FAILED_PROJZ, WH_FAILED_PROJXY, WH_FAILED_PLANAR};
    json_t *list = json_array();
    for (size_t i = 0; i < 3; ++i) {
        if (failed & bits[i]) {
            append(writer, list, json_string(names[i]));
        }
    }
    return list;
}

static json_t *measured_utime(const writer_t *writer, const wh_event_t *event) {
    const wh_layout_t *layout = writer->record->layout;
    return layout ? json_integer((json_int_t)event->measured_slice * layout->slice_us) : json_null();
}

static void put_measured(writer_t *writer, json_t *object, const wh_event_t *event) {
    const wh_proximity_t *measured = &event->measured;
    put(writer, object, "dr_proj_z", real((double)measured->dr_proj_z));
    put(writer, object, "dr_proj_xy", vector(writer, measured->dr_proj_xy));
    put(writer, object, "dr_proj_xy_norm", real((double)measured->dr_proj_xy_norm));
    put(writer, object, "n1_proj_n2", real((double)measured->n1_proj_n2));
    put(writer, object, "margins", margins(writer, measured));
    put(writer, object, "failed", failed_conditions(writer, measured->failed));
    put(writer, object, "measured_utime", measured_utime(writer, event));
}

static bool is_unmeasured(wh_event_kind_t kind) {
    static const uint32_t kinds = 1U << WH_EVENT_BAD_INPUT | 1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED |
                                  1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_SLIPPED |
                                  1U << WH_EVENT_VACUUM_LOST | 1U << WH_EVENT_FAULT_ARMED |
                                  1U << WH_EVENT_FAULT_CLEARED;
    return (kinds >> (unsigned)kind & 1U) != 0;
}

/* The same keys for an event that measured nothing. */
static void put_unmeasured(writer_t *writer, json_t *object) {
    static const char *const keys[] = {"dr_proj_z", "dr_proj_xy", "dr_proj_xy_norm", "n1_proj_n2",
                                       "margins",   "failed",     "measured_utime"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; ++i) {
        put(writer, object, keys[i], json_null());
    }
}

static json_t *part_names(writer_t *writer, const int32_t parts[2]) {
    json_t *list = json_array();
    for (size_t i = 0; i < 2; ++i) {
        const wh_layout_t *layout = writer->record->layout;
        append(writer, list, text_or_null(layout ? wh_layout_part_name(layout, parts[i]) : NULL));
    }
    return list;
}

/* What only this kind of event has. */
static void put_particulars(writer_t *writer, json_t *object, const wh_event_t *event) {
    switch ((int)event->kind) {
    case WH_EVENT_HANDED_OVER:
        put(writer, object, "from", text_or_null(wh_record_gripper_name(writer->record, event->other)));
        break;
    case WH_EVENT_CONTESTED:
        put(writer, object, "holder", text_or_null(wh_record_gripper_name(writer->record, event->other)));
        break;
    case WH_EVENT_SLOT_OCCUPIED:
        put(writer, object, "other", text_or_null(wh_record_wafer_name(writer->record, event->other)));
        break;
    case WH_EVENT_RELEASED_UNSUPPORTED:
        put(writer, object, "height", real((double)event->height));
        break;
    case WH_EVENT_BAD_INPUT:
        put(writer, object, "status", json_integer((json_int_t)event->status));
        put(writer, object, "message", json_string(wh_status_text(event->status)));
        break;
    case WH_EVENT_PLACED_OFF_CENTRE:
    case WH_EVENT_PLACED_ASKEW:
    case WH_EVENT_SETTLED:
    case WH_EVENT_SLIPPED:
    case WH_EVENT_VACUUM_LOST:
        put(writer, object, "value", real((double)event->value));
        put(writer, object, "limit", real((double)event->limit));
        break;
    case WH_EVENT_HIT:
    case WH_EVENT_UNDECIDED:
        put(writer, object, "parts", part_names(writer, event->parts));
        put(writer, object, "at", vector(writer, event->at));
        break;
    case WH_EVENT_TOO_CLOSE:
        put(writer, object, "parts", part_names(writer, event->parts));
        put(writer, object, "at", vector(writer, event->at));
        put(writer, object, "value", real((double)event->value));
        put(writer, object, "limit", real((double)event->limit));
        break;
    case WH_EVENT_FAULT_ARMED:
    case WH_EVENT_FAULT_CLEARED:
        put(writer, object, "fault", json_integer(event->parts[0] + 1));
        put(writer, object, "fault_kind", json_string(wh_fault_name((wh_fault_kind_t)event->parts[1])));
        break;
    default:
        break;
    }
}

static json_t *event(writer_t *writer, size_t i) {
    const wh_event_record_t *from = &writer->record->events[i];
    json_t *object = json_object();
    put(writer, object, "utime", json_integer(from->utime));
    put(writer, object, "kind", json_string(wh_event_name(from->event.kind)));
    put(writer, object, "wafer", text_or_null(wh_record_wafer_name(writer->record, from->event.wafer)));
    put(writer, object, "gripper", text_or_null(wh_record_gripper_name(writer->record, from->event.gripper)));
    if (is_unmeasured(from->event.kind)) {
        put_unmeasured(writer, object);
    } else {
        put_measured(writer, object, &from->event);
    }
    put_particulars(writer, object, &from->event);
    return object;
}

static json_t *expectation(writer_t *writer, size_t i) {
    const wh_expectation_record_t *from = &writer->record->expectations[i];
    json_t *object = json_object();
    put(writer, object, "line", json_integer(from->line));
    put(writer, object, "text", text_or_null(from->text));
    put(writer, object, "ok", json_boolean(from->ok));
    return object;
}

typedef json_t *element_t(writer_t *writer, size_t i);

static json_t *list_of(writer_t *writer, element_t *element, size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; ++i) {
        append(writer, list, element(writer, i));
    }
    return list;
}

static void put_head(writer_t *writer, json_t *root) {
    const wh_record_t *record = writer->record;
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, record->hash);
    put(writer, root, "format", json_integer(FORMAT));
    put(writer, root, "ok", json_boolean(record->ok));
    if (record->failure) {
        put(writer, root, "failure", text_or_null(record->failure));
    }
    put(writer, root, "script", text_or_null(record->script));
    put(writer, root, "layout", text_or_null(record->layout ? record->layout->path : NULL));
    put(writer, root, "slices", json_integer(record->slices));
    put(writer, root, "missed", json_integer(record->missed));
    put(writer, root, "simulated_s", real(record->simulated_s));
    put(writer, root, "wall_s", real(record->wall_s));
    put(writer, root, "hash", json_string(hash));
}

/* One kind's smallest gap; nulls where nothing came near. */
static json_t *clearance(writer_t *writer, size_t kind) {
    const wh_clearance_t *from = &writer->record->clearances[kind];
    const wh_layout_t *layout = writer->record->layout;
    const wh_real_t limit = layout->world.limits[kind];
    const bool found = from->parts[0] != WH_NONE;
    json_t *object = json_object();
    put(writer, object, "kind", json_string(wh_clearance_name((wh_clearance_kind_t)kind)));
    put(writer, object, "gap", found ? real((double)from->gap) : json_null());
    put(writer, object, "limit", limit > 0 ? real((double)limit) : json_null());
    put(writer, object, "utime",
        found ? json_integer((json_int_t)from->slice * layout->slice_us) : json_null());
    put(writer, object, "parts", found ? part_names(writer, from->parts) : json_null());
    put(writer, object, "at", found ? vector(writer, from->at) : json_null());
    return object;
}

static void put_lists(writer_t *writer, json_t *root) {
    const wh_record_t *record = writer->record;
    const size_t wafers = record->layout ? record->layout->wafer_count : 0;
    put(writer, root, "commands", list_of(writer, command, record->command_count));
    put(writer, root, "wafers", list_of(writer, wafer, wafers));
    put(writer, root, "events", list_of(writer, event, record->event_count));
    if (record->checked) {
        put(writer, root, "clearances", list_of(writer, clearance, WH_CLEARANCES));
    }
    put(writer, root, "expectations", list_of(writer, expectation, record->expectation_count));
}

static int dump(const json_t *value, FILE *out) {
    return json_dumpf(value, out, JSON_ENCODE_ANY | JSON_REAL_PRECISION(17));
}

static int dump_list(const json_t *list, FILE *out) {
    size_t i;
    json_t *element;
    int status = 0;
    fputs("[", out);
    json_array_foreach(list, i, element) {
        fputs(i == 0 ? "\n    " : ",\n    ", out);
        status |= dump(element, out);
    }
    fputs(json_array_size(list) > 0 ? "\n  ]" : "]", out);
    return status;
}

/* Root's members a line each and its lists' elements a line each: for grep, diff and the eye. */
static int dump_root(json_t *root, FILE *out) {
    const char *key, *before = "{\n  ";
    json_t *value;
    int status = 0;
    json_object_foreach(root, key, value) {
        fprintf(out, "%s\"%s\": ", before, key);
        status |= json_is_array(value) ? dump_list(value, out) : dump(value, out);
        before = ",\n  ";
    }
    fputs("\n}\n", out);
    return status != 0 || fflush(out) != 0 || ferror(out) ? -1 : 0;
}

int wh_record_print_json(const wh_record_t *record, FILE *out) {
    writer_t writer = {record, false};
    json_t *root = json_object();
    put_head(&writer, root);
    put_lists(&writer, root);
    const int status = writer.failed ? -1 : dump_root(root, out);
    json_decref(root);
    return status;
}
