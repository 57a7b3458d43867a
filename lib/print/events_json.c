#include "../sim/faults.h"
#include "../text/json.h"
#include "record_print.h"

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
    json_t *margins = wh_json_set(json_object(), "projz %g projxy %g planar %g", measured->margin_projz,
                                  measured->margin_projxy, measured->margin_planar);
    (void)wh_json_add(object, "dr_proj_xy margins failed", wh_json_vector(measured->dr_proj_xy), margins,
                      failed_conditions(measured->failed), NULL);
    (void)wh_json_set(object, "face %s dr_proj_z %g dr_proj_xy_norm %g n1_proj_n2 %g measured_utime %lld",
                      event->face == WH_FACE_FRONT ? "front" : "back", measured->dr_proj_z,
                      measured->dr_proj_xy_norm, measured->n1_proj_n2,
                      record->layout ? (json_int_t)event->measured_slice * record->layout->slice_us
                                     : WH_JSON_NONE);
}

static bool is_unmeasured(wh_event_kind_t kind) {
    static const uint32_t kinds = 1U << WH_EVENT_BAD_INPUT | 1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED |
                                  1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_SLIPPED |
                                  1U << WH_EVENT_VACUUM_LOST | 1U << WH_EVENT_FAULT_ARMED |
                                  1U << WH_EVENT_FAULT_CLEARED | 1U << WH_EVENT_PUSHED_THROUGH;
    return (kinds >> (unsigned)kind & 1U) != 0;
}

static json_t *part_name(const wh_record_t *record, int32_t part) {
    return wh_json_text(record->layout ? wh_layout_part_name(record->layout, part) : NULL);
}

json_t *wh_parts_to_json(const wh_record_t *record, const int32_t parts[2]) {
    return json_pack("[o, o]", part_name(record, parts[0]), part_name(record, parts[1]));
}

/* Puts the finding: the value with its limit, the parts, the fault. */
static void put_found(const wh_record_t *record, json_t *object, const wh_event_t *event) {
    static const uint32_t with_values = 1U << WH_EVENT_TOO_CLOSE | 1U << WH_EVENT_PLACED_OFF_CENTRE |
                                        1U << WH_EVENT_PLACED_ASKEW | 1U << WH_EVENT_SETTLED |
                                        1U << WH_EVENT_SLIPPED | 1U << WH_EVENT_VACUUM_LOST |
                                        1U << WH_EVENT_PUSHED_THROUGH;
    static const uint32_t of_faults = 1U << WH_EVENT_FAULT_ARMED | 1U << WH_EVENT_FAULT_CLEARED;
    const uint32_t kind = 1U << (unsigned)event->kind;
    if (wh_record_is_contact(event->kind)) {
        (void)wh_json_add(object, "parts at", wh_parts_to_json(record, event->parts),
                          wh_json_vector(event->at), NULL);
    }
    if (event->kind == WH_EVENT_PUSHED_THROUGH && event->other != WH_NONE) {
        (void)wh_json_set(object, "other %s", wh_record_wafer_name(record, event->other));
    }
    if (kind & with_values) {
        /* A tilt in degrees, as everywhere in the result. */
        const bool turned = event->kind == WH_EVENT_PLACED_ASKEW;
        (void)wh_json_set(object, "value %g limit %g", turned ? wh_deg_from_rad(event->value) : event->value,
                          turned ? wh_deg_from_rad(event->limit) : event->limit);
    }
    if (kind & of_faults) {
        (void)wh_json_set(object, "fault %d fault_kind %s", event->parts[0] + 1,
                          wh_fault_name((wh_fault_kind_t)event->parts[1]));
    }
}

/* Puts the members that only this kind of event has. */
static void put_particulars(const wh_record_t *record, json_t *object, const wh_event_t *event) {
    switch ((int)event->kind) {
    case WH_EVENT_HANDED_OVER:
        (void)wh_json_set(object, "from %s", wh_record_gripper_name(record, event->other));
        break;
    case WH_EVENT_CONTESTED:
        (void)wh_json_set(object, "holder %s", wh_record_gripper_name(record, event->other));
        break;
    case WH_EVENT_SLOT_OCCUPIED:
        (void)wh_json_set(object, "other %s", wh_record_wafer_name(record, event->other));
        break;
    case WH_EVENT_RELEASED_UNSUPPORTED:
        (void)wh_json_set(object, "height %g", event->height);
        if (event->value > 0) {
            (void)wh_json_set(object, "value %g", wh_deg_from_rad(event->value));
        }
        if (event->limit > 0) {
            (void)wh_json_set(object, "limit %g", event->limit);
        }
        break;
    case WH_EVENT_BAD_INPUT:
        (void)wh_json_set(object, "status %d message %s", (int)event->status,
                          wh_record_error_text(event->status));
        break;
    default:
        put_found(record, object, event);
        break;
    }
}

json_t *wh_event_to_json(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_event_record_t *from = &record->events[i];
    json_t *object =
        wh_json_set(json_object(), "utime %lld kind %s wafer %s gripper %s", (json_int_t)from->utime,
                    wh_event_name(from->event.kind), wh_record_wafer_name(record, from->event.wafer),
                    wh_record_gripper_name(record, from->event.gripper));
    /* An event that measured nothing has the same keys. */
    (void)wh_json_add(object,
                      "dr_proj_z dr_proj_xy dr_proj_xy_norm n1_proj_n2 margins failed measured_utime face",
                      json_null(), json_null(), json_null(), json_null(), json_null(), json_null(),
                      json_null(), json_null(), NULL);
    if (!is_unmeasured(from->event.kind)) {
        put_measured(record, object, &from->event);
    }
    put_particulars(record, object, &from->event);
    if (from->seat.is_there) {
        const wh_seat_t *seat = &from->seat;
        wh_json_put(
            object, "seat",
            wh_json_set(json_object(), "dx %g dy %g s %g held %i", seat->x, seat->y, seat->s, seat->is_held));
    }
    return object;
}
