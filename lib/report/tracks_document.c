#include "tracks_document.h"

#include <math.h>
#include <string.h>

#include "../layout/axes.h"
#include "../layout/grips.h"
#include "../text/array.h"
#include "notes_document.h"
#include "put.h"

/* -------------------------------------------------------------------------------------------------- marks */

static void append(char *text, size_t size, const char *before, const char *part) {
    const size_t length = strlen(text);
    if (part) {
        (void)snprintf(text + length, size - length, "%s%s", before, part);
    }
}

/* Writes, for example, "near miss: Wafer 1, EE" or "hit: A ledge 3 left and EE finger right". */
static void describe(const wh_record_t *record, const wh_event_t *event, char *text, size_t size) {
    wh_text_words(text, size, wh_event_name(event->kind));
    if (wh_record_is_contact(event->kind)) {
        append(text, size, ": ", wh_layout_part_name(record->layout, event->parts[0]));
        append(text, size, " and ", wh_layout_part_name(record->layout, event->parts[1]));
        return;
    }
    const char *wafer = wh_record_wafer_name(record, event->wafer);
    append(text, size, ": ", wafer);
    append(text, size, wafer ? ", " : ": ", wh_record_gripper_name(record, event->gripper));
}

static void put_mark(wh_json_text_t *text, const wh_document_t *document, size_t i) {
    const wh_mark_t *mark = &document->signals->marks[i];
    char words[3 * WH_PART_NAME_SIZE];
    describe(document->record, &mark->event, words, sizeof words);
    wh_json_text_begin(text, NULL, '{');
    wh_json_text_number(text, "t", (double)mark->utime / 1e6, 6, false);
    wh_json_text_string(text, "kind", wh_event_name(mark->event.kind));
    wh_put_text(text, "text", words);
    if (mark->has_place) {
        wh_put_point(text, "at", &mark->at);
    } else {
        wh_json_text_value(text, "at", json_null());
    }
    wh_json_text_end(text, '}');
}

void wh_marks_put(wh_json_text_t *text, const wh_document_t *document, wh_tracks_written_t *written) {
    wh_json_text_begin(text, "marks", '[');
    for (; written->marks < document->signals->mark_count; ++written->marks) {
        put_mark(text, document, written->marks);
    }
    wh_json_text_end(text, ']');
}

/* ------------------------------------------------------------------------------------------------- curves */

/* With these numbers of decimals rounding adds at most a hundredth of what thinning leaves. A slope's error
 * counts for up to 4 s. */
enum { DECIMALS_S = 6, DECIMALS_OWN_MM = 4, DECIMALS_OWN = 6 };

typedef struct {
    int value, slope;
} decimals_t;

static const decimals_t decimals_mm = {4, 3};
static const decimals_t decimals_rad = {7, 6};
static const decimals_t decimals_level = {5, 4};
static const decimals_t decimals_measure[WH_MEASURES] = {{6, 5}, {4, 3}, {9, 9}};

/* A writing: where to, its subject, and how much was written before. */
typedef struct {
    wh_json_text_t *text;
    const wh_document_t *document;
    const wh_signals_t *signals;
    wh_tracks_written_t *written;
} tracks_t;

static void put_second(const tracks_t *tracks, const char *key, int64_t slice) {
    wh_json_text_number(tracks->text, key, wh_signals_seconds(tracks->signals, slice), DECIMALS_S, false);
}

/* The first point that is due. */
static size_t first_due(size_t written, const wh_points_t *list) {
    return written > 0 && written <= list->count ? written - 1 : 0;
}

/* Where a curve breaks off, a null stands one slice after its last point. */
static void put_times(const tracks_t *tracks, const wh_points_t *list, size_t first) {
    wh_json_text_begin(tracks->text, "t", '[');
    for (size_t i = first; i < list->count; ++i) {
        put_second(tracks, NULL, list->points[i].slice);
        if (list->points[i].ends) {
            put_second(tracks, NULL, list->points[i].slice + 1);
        }
    }
    wh_json_text_end(tracks->text, ']');
}

/* `count` of each point's numbers from `first` on, times `scale`. */
typedef struct {
    const char *key;
    size_t first, count;
    double scale;
    int decimals;
    bool exact; /* as the points are; otherwise always rounded */
} column_t;

static void put_numbers(wh_json_text_t *text, const wh_points_t *list, size_t first, const column_t *of) {
    wh_json_text_begin(text, of->key, '[');
    for (size_t i = first; i < list->count; ++i) {
        const double *numbers = wh_points_numbers(list, i) + of->first;
        for (size_t k = 0; k < of->count; ++k) {
            wh_json_text_number(text, NULL, numbers[k] * of->scale, of->decimals,
                                of->exact && list->points[i].exact);
        }
        if (list->points[i].ends) {
            wh_put_index(text, NULL, WH_NONE);
        }
    }
    wh_json_text_end(text, ']');
}

static void put_curve(const tracks_t *tracks, const char *key, const wh_path_t *curve, decimals_t decimals,
                      size_t *written) {
    const double slices_a_second = 1e6 / (double)tracks->signals->layout->slice_us;
    const column_t values = {"v", 0, 1, 1, decimals.value, true};
    const column_t slopes = {"slope", 1, 1, slices_a_second, decimals.slope, false};
    const size_t first = first_due(*written, &curve->list);
    wh_json_text_begin(tracks->text, key, '{');
    put_times(tracks, &curve->list, first);
    put_numbers(tracks->text, &curve->list, first, &values);
    put_numbers(tracks->text, &curve->list, first, &slopes);
    wh_json_text_end(tracks->text, '}');
    *written = curve->list.count;
}

static decimals_t decimals_of_axis(const wh_signals_t *signals, size_t axis) {
    return wh_layout_axis_turns(signals->layout, axis) ? decimals_rad : decimals_mm;
}

static void put_axis(const tracks_t *tracks, size_t axis) {
    put_curve(tracks, NULL, &tracks->signals->axes[axis], decimals_of_axis(tracks->signals, axis),
              &tracks->written->axes[axis]);
}

static void put_own(const tracks_t *tracks, size_t g) {
    static const column_t places = {"r", 0, 3, 1, DECIMALS_OWN_MM, true};
    static const column_t turns = {"q", 3, 4, 1, DECIMALS_OWN, true};
    const wh_points_t *own = &tracks->signals->own[g].list;
    const size_t first = first_due(tracks->written->own[g], own);
    wh_json_text_begin(tracks->text, NULL, '{');
    put_times(tracks, own, first);
    put_numbers(tracks->text, own, first, &places);
    put_numbers(tracks->text, own, first, &turns);
    wh_json_text_end(tracks->text, '}');
    tracks->written->own[g] = own->count;
}

static void put_vacuum(const tracks_t *tracks, size_t g) {
    put_curve(tracks, NULL, &tracks->signals->vacuum[g], decimals_level, &tracks->written->vacuum[g]);
}

static void put_proximity(const tracks_t *tracks, size_t g) {
    static const char *const names[WH_MEASURES] = {"dr_proj_z", "dr_proj_xy", "n1_proj_n2"};
    wh_json_text_begin(tracks->text, NULL, '{');
    for (size_t m = 0; m < WH_MEASURES; ++m) {
        put_curve(tracks, names[m], &tracks->signals->proximity[g][m], decimals_measure[m],
                  &tracks->written->proximity[g][m]);
    }
    wh_json_text_end(tracks->text, '}');
}

/* -------------------------------------------------------------------------------------------------- steps */

/* The list of stays is sorted by time alone. Looking through it for each wafer costs less than writing it. */
static void put_stays(const tracks_t *tracks, size_t w) {
    const wh_signals_t *signals = tracks->signals;
    wh_json_text_begin(tracks->text, NULL, '[');
    for (size_t i = tracks->written->stays; i < signals->stay_count; ++i) {
        const wh_stay_t *stay = &signals->stays[i];
        if (stay->wafer == (int32_t)w) {
            wh_json_text_begin(tracks->text, NULL, '{');
            put_second(tracks, "t", stay->slice);
            wh_put_index(tracks->text, "holder", stay->holder);
            wh_put_pose(tracks->text, &stay->pose);
            wh_json_text_end(tracks->text, '}');
        }
    }
    wh_json_text_end(tracks->text, ']');
}

/* Passive pads have no valve. */
static size_t count_steps(const wh_signals_t *signals, const wh_steps_t lists[], size_t g) {
    const bool has_none = lists == signals->valves && signals->layout->grips[g].kind == WH_GRIP_PASSIVE;
    return has_none ? 0 : lists[g].count;
}

static void put_steps_of(const tracks_t *tracks, const wh_step_t steps[], size_t first, size_t count) {
    wh_json_text_begin(tracks->text, NULL, '{');
    wh_json_text_begin(tracks->text, "t", '[');
    for (size_t i = first; i < count; ++i) {
        put_second(tracks, NULL, steps[i].slice);
    }
    wh_json_text_end(tracks->text, ']');
    wh_json_text_begin(tracks->text, "v", '[');
    for (size_t i = first; i < count; ++i) {
        wh_put_index(tracks->text, NULL, steps[i].value);
    }
    wh_json_text_end(tracks->text, ']');
    wh_json_text_end(tracks->text, '}');
}

/* WH_NONE is null. */
static void put_steps(const tracks_t *tracks, const char *key, const wh_steps_t lists[], size_t written[]) {
    wh_json_text_begin(tracks->text, key, '[');
    for (size_t g = 0; g < tracks->signals->layout->machine.gripper_count; ++g) {
        const size_t count = count_steps(tracks->signals, lists, g);
        put_steps_of(tracks, lists[g].steps, written[g], count);
        written[g] = count;
    }
    wh_json_text_end(tracks->text, ']');
}

/* ------------------------------------------------------------------------------------------------- tracks */

/* A pair that never came near is not in the document. */
static void put_clearance(const tracks_t *tracks, size_t kind) {
    const wh_document_t *document = tracks->document;
    wh_json_text_t *text = tracks->text;
    if (document->record->clearances[kind].parts[0] == WH_NONE) {
        return;
    }
    const wh_curves_t *curves = document->record->curves;
    const double limit = tracks->signals->layout->world.limits[kind];
    wh_json_text_begin(text, NULL, '{');
    wh_json_text_string(text, "pair", wh_clearance_name((wh_clearance_kind_t)kind));
    wh_json_text_number(text, "limit", limit > 0 ? limit : HUGE_VAL, 0, true);
    wh_json_text_begin(text, "t", '[');
    for (size_t bin = 0; bin < curves->count; ++bin) {
        put_second(tracks, NULL, (int64_t)wh_curves_end(curves, bin));
    }
    wh_json_text_end(text, ']');
    wh_json_text_begin(text, "gap", '[');
    for (size_t bin = 0; bin < curves->count; ++bin) {
        const double gap = curves->gaps[kind][bin];
        wh_json_text_number(text, NULL, gap < WH_CLEARANCE_RANGE ? gap : HUGE_VAL, 0, true);
    }
    wh_json_text_end(text, ']');
    wh_json_text_end(text, '}');
}

/* A list: `put` writes each of its elements, from 0 to count - 1. */
typedef void put_t(const tracks_t *tracks, size_t i);

static void put_each(const tracks_t *tracks, const char *key, size_t count, put_t *put) {
    wh_json_text_begin(tracks->text, key, '[');
    for (size_t i = 0; i < count; ++i) {
        put(tracks, i);
    }
    wh_json_text_end(tracks->text, ']');
}

void wh_tracks_put(wh_json_text_t *text, const wh_document_t *document, wh_tracks_written_t *written) {
    const wh_signals_t *signals = document->signals;
    const tracks_t tracks = {text, document, signals, written};
    const size_t grippers = signals->layout->machine.gripper_count;
    const bool has_gaps = document->record->curves && wh_notes_document_looked(document->record);
    wh_json_text_begin(text, "tracks", '{');
    put_each(&tracks, "axes", signals->axis_count, put_axis);
    put_each(&tracks, "grippers", grippers, put_own);
    put_each(&tracks, "wafers", signals->layout->wafer_count, put_stays);
    written->stays = signals->stay_count;
    put_steps(&tracks, "valves", signals->valves, written->valves);
    put_steps(&tracks, "sensors", signals->sensors, written->sensors);
    put_steps(&tracks, "nearest", signals->nearest, written->nearest);
    put_each(&tracks, "vacuum", grippers, put_vacuum);
    put_each(&tracks, "proximity", grippers, put_proximity);
    put_each(&tracks, "clearances", has_gaps ? WH_CLEARANCES : 0, put_clearance);
    wh_json_text_end(text, '}');
}

/* ---------------------------------------------------------------------------------- of a run that goes on */

void wh_tracks_note(const wh_signals_t *signals, wh_tracks_written_t *written) {
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        written->axes[axis] = signals->axes[axis].list.count;
    }
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        written->own[g] = signals->own[g].list.count;
        written->vacuum[g] = signals->vacuum[g].list.count;
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            written->proximity[g][m] = signals->proximity[g][m].list.count;
        }
        written->valves[g] = count_steps(signals, signals->valves, g);
        written->sensors[g] = signals->sensors[g].count;
        written->nearest[g] = signals->nearest[g].count;
    }
    written->stays = signals->stay_count;
    written->marks = signals->mark_count;
}

bool wh_tracks_have_news(const wh_signals_t *signals, const wh_tracks_written_t *written) {
    bool news = signals->stay_count > written->stays || signals->mark_count > written->marks;
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        news = news || count_steps(signals, signals->valves, g) > written->valves[g] ||
               signals->sensors[g].count > written->sensors[g] ||
               signals->nearest[g].count > written->nearest[g];
    }
    return news;
}

bool wh_tracks_are_anew(const wh_signals_t *signals, const wh_tracks_written_t *written) {
    bool anew = false;
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        anew = anew || signals->axes[axis].list.count < written->axes[axis];
    }
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        anew = anew || signals->own[g].list.count < written->own[g] ||
               signals->vacuum[g].list.count < written->vacuum[g];
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            anew = anew || signals->proximity[g][m].list.count < written->proximity[g][m];
        }
    }
    return anew;
}

/* --------------------------------------------------------------------------------------------- at present */

static void put_last(wh_json_text_t *text, const wh_path_t *curve, int decimals) {
    double value = 0;
    const bool is_there = wh_path_last(curve, &value);
    wh_json_text_number(text, NULL, is_there ? value : HUGE_VAL, decimals, false);
}

static void put_own_now(wh_json_text_t *text, const wh_thin_t *own) {
    if (own->of == 0) {
        wh_json_text_value(text, NULL, json_null());
        return;
    }
    wh_json_text_begin(text, NULL, '{');
    wh_json_text_begin(text, "r", '[');
    for (size_t i = 0; i < WH_THIN_WIDTH; ++i) {
        if (i == 3) {
            wh_json_text_end(text, ']');
            wh_json_text_begin(text, "q", '[');
        }
        wh_json_text_number(text, NULL, own->last.values[i], i < 3 ? DECIMALS_OWN_MM : DECIMALS_OWN, false);
    }
    wh_json_text_end(text, ']');
    wh_json_text_end(text, '}');
}

static void put_proximity_now(wh_json_text_t *text, const wh_signals_t *signals, size_t g) {
    wh_json_text_begin(text, NULL, '[');
    for (size_t m = 0; m < WH_MEASURES; ++m) {
        put_last(text, &signals->proximity[g][m], decimals_measure[m].value);
    }
    wh_json_text_end(text, ']');
}

void wh_tracks_put_now(wh_json_text_t *text, const char *key, const wh_signals_t *signals) {
    const size_t grippers = signals->layout->machine.gripper_count;
    wh_json_text_begin(text, key, '{');
    wh_json_text_number(text, "t", wh_signals_seconds(signals, signals->last), DECIMALS_S, false);
    wh_json_text_begin(text, "axes", '[');
    for (size_t axis = 0; axis < signals->axis_count; ++axis) {
        put_last(text, &signals->axes[axis], decimals_of_axis(signals, axis).value);
    }
    wh_json_text_end(text, ']');
    wh_json_text_begin(text, "grippers", '[');
    for (size_t g = 0; g < grippers; ++g) {
        put_own_now(text, &signals->own[g]);
    }
    wh_json_text_end(text, ']');
    wh_json_text_begin(text, "vacuum", '[');
    for (size_t g = 0; g < grippers; ++g) {
        put_last(text, &signals->vacuum[g], decimals_level.value);
    }
    wh_json_text_end(text, ']');
    wh_json_text_begin(text, "proximity", '[');
    for (size_t g = 0; g < grippers; ++g) {
        put_proximity_now(text, signals, g);
    }
    wh_json_text_end(text, ']');
    wh_json_text_end(text, '}');
}
