/* The document's marks: events that have a place in the cell. */
#include <string.h>

#include "document_internal.h"

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

static void put_mark(wh_json_text_t *text, const wh_layout_t *layout, const wh_mark_t *mark) {
    char words[3 * WH_PART_NAME_SIZE];
    describe(layout, &mark->event, words, sizeof words);
    wh_json_text_begin(text, NULL, '{');
    wh_json_text_number(text, "t", (double)mark->utime / 1e6, 6, false);
    wh_json_text_string(text, "kind", wh_event_name(mark->event.kind));
    wh_json_text_value(text, "text", wh_json_text(words));
    if (mark->has_place) {
        wh_json_text_begin(text, "at", '[');
        wh_json_text_number(text, NULL, mark->at.x, 0, true);
        wh_json_text_number(text, NULL, mark->at.y, 0, true);
        wh_json_text_number(text, NULL, mark->at.z, 0, true);
        wh_json_text_end(text, ']');
    } else {
        wh_json_text_value(text, "at", json_null());
    }
    wh_json_text_end(text, '}');
}

void wh_document_put_marks(wh_json_text_t *text, const wh_signals_t *signals) {
    wh_json_text_begin(text, "marks", '[');
    for (size_t i = 0; i < signals->mark_count; ++i) {
        put_mark(text, signals->layout, &signals->marks[i]);
    }
    wh_json_text_end(text, ']');
}
