/* Tells programs of a replay. */
#include <stdio.h>

#include "../text/json.h"
#include "replayed.h"

static json_t *difference_to_json(const wh_replay_run_t *run) {
    if (run->slices.differing == 0) {
        return json_null();
    }
    const wh_replay_difference_t *from = &run->difference;
    return wh_json_add(json_object(), "slice what recorded replayed", json_integer(from->slice),
                       wh_json_text(from->what), wh_json_real(from->recorded), wh_json_real(from->replayed),
                       NULL);
}

static json_t *outcome_to_json(const wh_replay_run_t *run) {
    const wh_run_told_t *told = &run->over.outcome;
    if (told->verdict == WH_OUTCOME_UNTOLD && !run->over.is_wrong) {
        return json_null();
    }
    return wh_json_add(json_object(),
                       "verdict reason contradicts commands expectations met cycles expectations_lost",
                       wh_json_text(wh_outcome_word(told->verdict)), wh_json_text(run->over.reason),
                       json_boolean(run->over.is_wrong), json_integer(told->commands),
                       json_integer(told->expectations), json_integer(told->met), json_integer(told->cycles),
                       json_integer(wh_reading_lost_expectations(run)), NULL);
}

static json_t *run_to_json(const void *subject, size_t i) {
    const wh_replay_run_t *run = &((const wh_replay_t *)subject)->runs[i];
    json_t *object = wh_json_add(
        json_object(), "run first_slice last_slice compared differing unanswered last_unanswered",
        wh_json_hash((uint64_t)run->run), json_integer(run->first_slice), json_integer(run->last_slice),
        json_integer(run->slices.compared), json_integer(run->slices.differing),
        json_integer(run->slices.unanswered), json_integer(run->slices.last_unanswered), NULL);
    return wh_json_add(object,
                       "outside_valves taken_up skipped lost_end missed refused other_layout doubtful "
                       "collisions_not_compared begins_in_part goes_on_from over hash outcome "
                       "first_difference",
                       json_integer(run->slices.outside_valves), json_integer(run->slices.taken_up),
                       json_integer(run->slices.skipped), json_integer(wh_reading_lost_end(run)),
                       json_integer(run->slices.missed), json_integer(run->refused),
                       json_integer(run->homeless.is_other_layout ? run->homeless.count : 0),
                       json_integer(run->slices.doubtful), json_integer(run->collisions),
                       json_boolean(run->begins_in_part),
                       run->goes_on_from != 0 ? wh_json_hash((uint64_t)run->goes_on_from) : json_null(),
                       json_boolean(run->over.is_told), wh_json_hash(run->hash), outcome_to_json(run),
                       difference_to_json(run), NULL);
}

static json_t *gap_to_json(const void *subject, size_t i) {
    const wh_log_numbers_t *numbers = subject;
    return wh_json_add(json_object(), "from to", json_integer((json_int_t)numbers->gaps[i].from),
                       json_integer((json_int_t)numbers->gaps[i].to), NULL);
}

static json_t *damage_to_json(const void *subject, size_t i) {
    const wh_reading_t *reading = subject;
    return wh_json_add(json_object(), "from to", json_integer((json_int_t)reading->damages[i].from),
                       json_integer((json_int_t)reading->damages[i].to), NULL);
}

static void put_recording(const wh_replay_recording_t *recording, json_t *root) {
    const bool tells = recording->version > 0;
    (void)wh_json_add(root, "version id first_part part closed goes_on program changed",
                      json_integer(tells ? recording->version : 1),
                      tells ? wh_json_hash((uint64_t)recording->id) : json_null(),
                      tells ? json_integer(recording->first_part) : json_null(),
                      tells ? json_integer(recording->part) : json_null(),
                      tells ? json_boolean(recording->closed != WH_RECORDING_BEGINS) : json_null(),
                      tells ? json_boolean(recording->closed == WH_RECORDING_GOES_ON) : json_null(),
                      tells ? wh_json_text(recording->program) : json_null(),
                      json_boolean(recording->is_changed), NULL);
}

static void put_losses(const wh_replay_t *replay, json_t *root) {
    json_t *first = json_object();
    for (size_t i = 0; i < WH_REPLAY_LOSSES; ++i) {
        wh_json_put(root, wh_reading_losses[i].key, json_integer((json_int_t)replay->heard.losses[i].count));
        if (replay->heard.losses[i].count > 0) {
            wh_json_put(first, wh_reading_losses[i].key,
                        json_integer((json_int_t)replay->heard.losses[i].first));
        }
    }
    wh_json_put(root, "first_bytes", first);
    wh_json_put(root, "proximities_not_compared", json_integer((json_int_t)replay->heard.proximities));
    wh_json_put(root, "runs_left_out", json_integer((json_int_t)replay->runs_left_out));
}

static void put_file(const wh_reading_t *reading, json_t *root) {
    const wh_log_numbers_t *numbers = &reading->numbers;
    const size_t named =
        reading->damage_count < WH_READING_DAMAGES ? (size_t)reading->damage_count : WH_READING_DAMAGES;
    (void)wh_json_add(root, "events_missing events_doubled events_out_of_order events_misnumbered",
                      json_integer((json_int_t)wh_log_numbers_missing(numbers)),
                      json_integer((json_int_t)numbers->doubled), json_integer((json_int_t)numbers->moved),
                      json_integer((json_int_t)numbers->misnumbered), NULL);
    wh_json_put(root, "gaps", wh_json_list(gap_to_json, numbers, numbers->gap_count));
    wh_json_put(root, "damaged", json_integer((json_int_t)reading->damage_count));
    wh_json_put(root, "damage", wh_json_list(damage_to_json, reading, named));
    wh_json_put(root, "frames_damaged", json_integer((json_int_t)reading->broken));
    wh_json_put(root, "cut_at", reading->is_cut ? json_integer((json_int_t)reading->cut_at) : json_null());
}

static json_t *path_to_json(const void *subject, size_t i) {
    return wh_json_text(((const wh_log_files_t *)subject)->paths[i]);
}

int wh_replayed_print_json(const wh_replayed_t *result) {
    json_t *root = wh_json_add(
        json_object(), "format ok verdict reason lenient file events", json_integer(2),
        json_boolean(result->verdict == WH_READING_SAME), wh_json_text(wh_reading_word(result->verdict)),
        wh_json_text(result->reason[0] ? result->reason : NULL), json_boolean(result->is_lenient),
        wh_json_text(result->path), json_integer((json_int_t)result->reading->events), NULL);
    wh_json_put(root, "files", wh_json_list(path_to_json, result->files, result->files->count));
    wh_json_put(root, "files_not_closed", json_integer((json_int_t)result->replay->files.open_files));
    put_recording(&result->replay->recording, root);
    put_losses(result->replay, root);
    put_file(result->reading, root);
    wh_json_put(root, "runs", wh_json_list(run_to_json, result->replay, result->replay->run_count));
    const int status = wh_json_print(root, stdout);
    json_decref(root);
    return status;
}
