/* The messages to a live page, as JSON. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../print/record_print.h"
#include "../sim/faults.h"
#include "../text/array.h"
#include "live_kept.h"

/* -------------------------------------------------------------------------------------------------- lists */

typedef json_t *entry_t(const wh_live_kept_t *kept, size_t i);

/* A command that runs has no end. */
static json_t *command(const wh_live_kept_t *kept, size_t i) {
    const wh_command_record_t *from = &kept->record.commands[i];
    return wh_json_set(json_object(), "line %d text %s task %d error %d begin_s %g end_s %g message %s",
                       from->line, from->text, (int)from->task, (int)from->error, from->begin_s, from->end_s,
                       from->message);
}

static json_t *event(const wh_live_kept_t *kept, size_t i) {
    return wh_event_to_json(&kept->record, i);
}

static json_t *expectation(const wh_live_kept_t *kept, size_t i) {
    const wh_expectation_record_t *from = &kept->record.expectations[i];
    return wh_json_set(json_object(), "line %d text %s ok %i", from->line, from->text, from->ok);
}

static json_t *station(const wh_live_kept_t *kept, size_t i) {
    return wh_station_event_to_json(&kept->record, i);
}

static double seconds(const wh_live_kept_t *kept, int64_t slice) {
    return (double)(slice * kept->record.layout->slice_us) / 1e6;
}

static json_t *wait_of(const wh_live_kept_t *kept, size_t i) {
    const wh_wait_record_t *from = &kept->record.waits[i];
    return wh_json_set(json_object(), "task %d for %s from_s %g to_s %g", (int)from->task, from->what,
                       seconds(kept, from->begin), from->is_open ? HUGE_VAL : seconds(kept, from->end));
}

static json_t *frame(const wh_live_kept_t *kept, size_t i) {
    const wh_live_frame_t *from = &kept->frames[i];
    const char kind[] = {from->kind, '\0'};
    return wh_json_set(json_object(), "at_s %g port %s kind %s text %s", (double)from->utime / 1e6,
                       from->port, kind, from->text);
}

static const struct {
    const char *name;
    entry_t *entry;
} lists[WH_LIVE_LISTS] = {
    [WH_LIVE_COMMANDS] = {"commands", command},
    [WH_LIVE_EVENTS] = {"events", event},
    [WH_LIVE_EXPECTATIONS] = {"expectations", expectation},
    [WH_LIVE_STATIONS] = {"station_events", station},
    [WH_LIVE_WAITS] = {"waits", wait_of},
    [WH_LIVE_FRAMES] = {"frames", frame},
};

static size_t count_of(const wh_live_kept_t *kept, size_t list) {
    const size_t counts[WH_LIVE_LISTS] = {
        [WH_LIVE_COMMANDS] = kept->record.command_count,
        [WH_LIVE_EVENTS] = kept->record.event_count,
        [WH_LIVE_EXPECTATIONS] = kept->record.expectation_count,
        [WH_LIVE_STATIONS] = kept->record.station_event_count,
        [WH_LIVE_WAITS] = kept->record.wait_count,
        [WH_LIVE_FRAMES] = kept->frame_count,
    };
    return counts[list];
}

static json_t *list_from(const wh_live_kept_t *kept, size_t list, size_t first) {
    json_t *made = json_array();
    for (size_t i = first; i < count_of(kept, list); ++i) {
        wh_json_append(made, lists[list].entry(kept, i));
    }
    return made;
}

/* -------------------------------------------------------------------------------------------------- state */

static json_t *fault(const void *nothing, size_t i) {
    (void)nothing;
    return json_string(wh_fault_name((wh_fault_kind_t)i));
}

/* Those that are times alone stand behind the others. */
static json_t *robots_of(const wh_layout_t *layout) {
    json_t *list = json_array();
    for (size_t r = 0; r < layout->robot_count; ++r) {
        wh_json_append(list, wh_json_text(layout->robots[r].name));
    }
    for (size_t r = 0; layout->timed && r < layout->timed->robot_count; ++r) {
        wh_json_append(list, wh_json_text(layout->timed->robots[r].name));
    }
    return list;
}

static json_t *state_of(const wh_live_kept_t *kept, const wh_live_state_t *state) {
    json_t *object = wh_json_set(
        json_object(), "rate %g pace %g over %i dropped %i control %s paces %i paused %i stands %i held %i",
        state->rate > 0 ? state->rate : HUGE_VAL, state->pace >= 0 ? state->pace : HUGE_VAL, kept->is_over,
        kept->has_dropped, state->control, state->paces, state->is_paused, state->stands, kept->is_held);
    (void)wh_json_set(object, "held_robots %s", kept->held);
    if (state->lists_robots) {
        wh_json_put(object, "robots", robots_of(kept->record.layout));
    }
    if (state->lists_faults) {
        wh_json_put(object, "faults", wh_json_list(fault, NULL, WH_FAULT_KINDS));
    }
    return kept->is_over ? wh_json_set(object, "good %i failure %s", kept->is_good, kept->failure) : object;
}

/* -------------------------------------------------------------------------------------------------- whole */

static const char *const notes[] = {
    "This cell is live. Its curves are read some 60 times a second; at events they are exact.",
    "Scans of edge sensors and centrings are not shown while a cell is live; --report has them.",
};

static json_t *run_of(const wh_live_kept_t *kept) {
    json_t *run = json_object();
    for (size_t list = 0; list < WH_LIVE_LISTS; ++list) {
        wh_json_put(run, lists[list].name, list_from(kept, list, 0));
    }
    return run;
}

char *wh_live_kept_document(const wh_live_kept_t *kept, const wh_live_state_t *state, uint64_t next,
                            size_t *size) {
    char *text = NULL;
    if (!kept->record.layout) {
        return NULL;
    }
    json_t *run = run_of(kept);
    FILE *out = wh_memory_need(open_memstream(&text, size));
    const wh_document_t document = {.title = state->title,
                                    .reproduce = state->reproduce,
                                    .source = "live",
                                    .notes = notes,
                                    .note_count = sizeof notes / sizeof notes[0],
                                    .run = run,
                                    .record = &kept->record,
                                    .signals = &kept->signals,
                                    .is_live = true};
    (void)fprintf(out, "{\"next\":%" PRIu64 ",\"id\":\"%s\",\"state\":", next, state->id);
    json_t *told = state_of(kept, state);
    (void)json_dumpf(told, out, JSON_COMPACT);
    (void)fputs(",\"document\":", out);
    (void)wh_document_write(&document, out);
    (void)fputs("}", out);
    (void)fclose(out);
    json_decref(told);
    json_decref(run);
    return wh_memory_need(text);
}

/* ------------------------------------------------------------------------------------------------ growing */

static void put_lists(wh_json_text_t *text, wh_live_kept_t *kept) {
    wh_json_text_begin(text, "lists", '{');
    for (size_t list = 0; list < WH_LIVE_LISTS; ++list) {
        if (kept->due[list] < count_of(kept, list)) {
            wh_json_text_begin(text, lists[list].name, '{');
            wh_json_text_integer(text, "from", (long long)kept->due[list]);
            wh_json_text_value(text, "list", list_from(kept, list, kept->due[list]));
            wh_json_text_end(text, '}');
        }
        kept->due[list] = count_of(kept, list);
    }
    wh_json_text_end(text, '}');
}

/* A message is one line. */
static char *one_line(char *text) {
    for (char *c = strchr(text, '\n'); c; c = strchr(c, '\n')) {
        *c = ' ';
    }
    return text;
}

char *wh_live_kept_growth(wh_live_kept_t *kept, const wh_live_state_t *state) {
    char *made = NULL;
    size_t size = 0;
    wh_json_text_t text = {.out = wh_memory_need(open_memstream(&made, &size))};
    const wh_document_t document = {.record = &kept->record, .signals = &kept->signals};
    wh_json_text_begin(&text, NULL, '{');
    wh_tracks_put(&text, &document, &kept->written);
    wh_marks_put(&text, &document, &kept->written);
    put_lists(&text, kept);
    wh_tracks_put_now(&text, "now", &kept->signals);
    wh_json_text_value(&text, "state", state_of(kept, state));
    wh_json_text_end(&text, '}');
    (void)fclose(text.out);
    kept->has_news = false;
    return one_line(wh_memory_need(made));
}

char *wh_live_kept_now(const wh_live_kept_t *kept) {
    char *made = NULL;
    size_t size = 0;
    wh_json_text_t text = {.out = wh_memory_need(open_memstream(&made, &size))};
    wh_tracks_put_now(&text, NULL, &kept->signals);
    (void)fclose(text.out);
    return one_line(wh_memory_need(made));
}
