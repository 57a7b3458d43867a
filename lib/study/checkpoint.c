#include "checkpoint.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"
#include "../text/json.h"
#include "../text/output.h"
#include "identity.h"

#define FORMAT 9
/* The first byte of a state. */
#define BEGIN '{'
/* The check stands behind all bytes that it covers: `,"check":"0123456789abcdef"}`. */
#define CHECK_BYTES 28
#define READ_BYTES 65536

/* --------------------------------------------------------------------------------------------------- sums */

/* Whole numbers of 64 bits as JSON has them: 2^63 trials are out of reach. */
static bool take_count(const json_t *value, uint64_t *number) {
    const json_int_t found = json_integer_value(value);
    *number = (uint64_t)found;
    return json_is_integer(value) && found >= 0;
}

static json_t *put_sum(const wh_sum_t *sum) {
    const wh_uint128_t total = (wh_uint128_t)sum->sum;
    json_t *bins = json_array();
    for (size_t i = 0; i < WH_SUM_BINS; ++i) {
        if (sum->bins[i] > 0) {
            wh_json_append(bins, json_integer((json_int_t)i));
            wh_json_append(bins, json_integer((json_int_t)sum->bins[i]));
        }
    }
    return json_pack("{s:I, s:[I, I], s:[I, I], s:I, s:I, s:o}", "count", (json_int_t)sum->count, "sum",
                     (json_int_t)(total >> 64), (json_int_t)(uint64_t)total, "squares",
                     (json_int_t)(sum->squares >> 64), (json_int_t)(uint64_t)sum->squares, "least",
                     (json_int_t)sum->least, "most", (json_int_t)sum->most, "bins", bins);
}

static bool take_bins(const json_t *bins, wh_sum_t *sum) {
    uint64_t total = 0;
    bool sound = json_array_size(bins) % 2 == 0;
    for (size_t i = 0; sound && i < json_array_size(bins); i += 2) {
        uint64_t bin = 0;
        sound = take_count(json_array_get(bins, i), &bin) && bin < WH_SUM_BINS &&
                take_count(json_array_get(bins, i + 1), &sum->bins[bin]);
        total += sound ? sum->bins[bin] : 0;
    }
    return sound && total == sum->count;
}

static bool take_sum(json_t *root, wh_sum_t *sum) {
    json_int_t count, high, low, high_squares, low_squares, least, most;
    json_t *bins;
    if (json_unpack(root, "{s:I, s:[I, I], s:[I, I], s:I, s:I, s:o}", "count", &count, "sum", &high, &low,
                    "squares", &high_squares, &low_squares, "least", &least, "most", &most, "bins",
                    &bins) != 0) {
        return false;
    }
    sum->count = (uint64_t)count;
    sum->sum = (wh_int128_t)((wh_uint128_t)(uint64_t)high << 64 | (uint64_t)low);
    sum->squares = (wh_uint128_t)(uint64_t)high_squares << 64 | (uint64_t)low_squares;
    sum->least = least;
    sum->most = most;
    return count >= 0 && least >= -WH_SUM_MOST && most <= WH_SUM_MOST && take_bins(bins, sum);
}

static json_t *put_wafer(const void *subject, size_t w) {
    const wh_tally_wafer_t *wafer = &((const wh_tally_t *)subject)->wafers[w];
    json_t *list = json_pack("[I]", (json_int_t)wafer->elsewhere);
    for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
        wh_json_append(list, put_sum(&wafer->of[q]));
    }
    return list;
}

static bool take_wafers(const json_t *list, wh_tally_t *tally) {
    bool sound = json_array_size(list) == tally->wafer_count;
    for (size_t w = 0; sound && w < tally->wafer_count; ++w) {
        const json_t *wafer = json_array_get(list, w);
        sound = take_count(json_array_get(wafer, 0), &tally->wafers[w].elsewhere);
        for (size_t q = 0; sound && q < WH_TALLY_QUANTITIES; ++q) {
            sound = take_sum(json_array_get(wafer, q + 1), &tally->wafers[w].of[q]);
        }
    }
    return sound;
}

/* --------------------------------------------------------------------------------------------------- rows */

static json_t *put_row(const void *subject, size_t i) {
    const wh_tally_row_t *row = &((const wh_tally_rows_t *)subject)->rows[i];
    return json_pack("[i, b, i, o, I, I, I, I]", row->line, row->is_implied, row->place,
                     wh_json_text(row->text), (json_int_t)row->named, (json_int_t)row->seen,
                     (json_int_t)row->bad, (json_int_t)row->first);
}

static bool take_rows(const json_t *list, wh_tally_rows_t *rows) {
    bool sound = json_is_array(list);
    for (size_t i = 0; sound && i < json_array_size(list); ++i) {
        wh_tally_row_t key = {0};
        int is_implied;
        const char *text;
        json_int_t named, seen, bad, first;
        sound = json_unpack(json_array_get(list, i), "[i, b, i, s, I, I, I, I]", &key.line, &is_implied,
                            &key.place, &text, &named, &seen, &bad, &first) == 0 &&
                named >= 0 && seen >= 0 && bad >= 0;
        if (sound) {
            key.is_implied = is_implied != 0;
            wh_tally_row_t *row = wh_tally_row(rows, &key, text, (uint64_t)named);
            row->seen = (uint64_t)seen;
            row->bad = (uint64_t)bad;
            row->first = (uint64_t)first;
        }
    }
    return sound;
}

/* Infinite is null. */
static json_t *put_worst(const void *subject, size_t i) {
    const wh_tally_trial_t *trial = &((const wh_tally_t *)subject)->worst[i];
    json_t *flow = json_array();
    for (size_t f = 0; f < WH_FLOW_SUM_FIGURES; ++f) {
        wh_json_append(flow, wh_json_real(trial->flow[f]));
    }
    return json_pack("[I, b, o, b, I, I, I, I, I, I, I, o]", (json_int_t)trial->trial, trial->met,
                     wh_json_real(trial->off), trial->ended, (json_int_t)trial->missed,
                     (json_int_t)trial->errors, (json_int_t)trial->elsewhere, (json_int_t)trial->kinds,
                     (json_int_t)trial->missed_line, (json_int_t)trial->error, (json_int_t)trial->error_line,
                     flow);
}

/* Null is NaN. */
static double real_of(const json_t *value) {
    return json_is_null(value) ? (double)NAN : json_number_value(value);
}

static bool take_worst(const json_t *list, wh_tally_t *tally) {
    bool sound = json_is_array(list) && json_array_size(list) <= WH_STUDY_WORST;
    for (size_t i = 0; sound && i < json_array_size(list); ++i) {
        json_int_t number;
        json_int_t counts[7];
        int met, ended;
        const json_t *off, *flow;
        sound = json_unpack(json_array_get(list, i), "[I, b, o, b, I, I, I, I, I, I, I, o]", &number, &met,
                            &off, &ended, &counts[0], &counts[1], &counts[2], &counts[3], &counts[4],
                            &counts[5], &counts[6], &flow) == 0 &&
                number >= 0 && json_array_size(flow) == WH_FLOW_SUM_FIGURES;
        if (sound) {
            wh_tally_trial_t trial = {.trial = (uint64_t)number,
                                      .met = met != 0,
                                      .ended = ended != 0,
                                      .missed = (uint32_t)counts[0],
                                      .errors = (uint32_t)counts[1],
                                      .elsewhere = (uint32_t)counts[2],
                                      .kinds = (uint32_t)counts[3],
                                      .missed_line = (uint32_t)counts[4],
                                      .error = (uint32_t)counts[5],
                                      .error_line = (uint32_t)counts[6],
                                      .off = json_is_null(off) ? (double)INFINITY : json_number_value(off)};
            for (size_t f = 0; f < WH_FLOW_SUM_FIGURES; ++f) {
                trial.flow[f] = real_of(json_array_get(flow, f));
            }
            wh_tally_note_worst(tally, &trial);
        }
    }
    return sound;
}

static json_t *put_events(const wh_tally_t *tally) {
    json_t *list = json_array();
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        wh_json_append(list, json_integer((json_int_t)tally->events[kind].trials));
        wh_json_append(list, json_integer((json_int_t)tally->events[kind].total));
    }
    return list;
}

static bool take_events(const json_t *list, wh_tally_t *tally) {
    bool sound = json_array_size(list) == (size_t)2 * WH_EVENT_KINDS;
    for (size_t kind = 0; sound && kind < WH_EVENT_KINDS; ++kind) {
        sound = take_count(json_array_get(list, 2 * kind), &tally->events[kind].trials) &&
                take_count(json_array_get(list, 2 * kind + 1), &tally->events[kind].total);
    }
    return sound;
}

/* High and low halves. */
static json_t *put_relation(const void *subject, size_t i) {
    const wh_uint128_t number = (wh_uint128_t)*wh_relations_number(subject, i);
    return json_pack("[I, I]", (json_int_t)(number >> 64), (json_int_t)(uint64_t)number);
}

/* Without any trial there may be none. */
static bool take_relations(const wh_study_t *study, const json_t *list, wh_tally_t *tally) {
    wh_relations_t *relations = &tally->relations;
    const size_t count = json_array_size(list);
    if (count == 0 && tally->trials == 0) {
        return json_is_array(list);
    }
    wh_tally_need_relations(tally, study);
    bool sound = json_is_array(list) && count == wh_relations_size(relations);
    for (size_t i = 0; sound && i < count; ++i) {
        json_int_t high, low;
        sound = json_unpack(json_array_get(list, i), "[I, I]", &high, &low) == 0;
        if (sound) {
            *wh_relations_number(relations, i) =
                (wh_int128_t)((wh_uint128_t)(uint64_t)high << 64 | (uint64_t)low);
        }
    }
    return sound;
}

static json_t *put_lines(const wh_trial_lines_t *lines) {
    char *text = wh_trial_lines_text(lines);
    json_t *made = json_string(text);
    free(text);
    return made;
}

/* The counts of a flow's trials, which stand before its sums. */
#define FLOW_COUNTS 5

static json_t *put_flow(const wh_flow_sums_t *flow) {
    if (!flow) {
        return json_null();
    }
    json_t *list =
        json_pack("[I, I, I, I, I]", (json_int_t)flow->trials, (json_int_t)flow->unfinished,
                  (json_int_t)flow->unsteady, (json_int_t)flow->no_cycle, (json_int_t)flow->clipped);
    for (size_t f = 0; f < WH_FLOW_SUM_FIGURES; ++f) {
        wh_json_append(list, put_sum(&flow->of[f]));
    }
    return list;
}

/* A flow that was cut has no makespan, and all of these. */
static bool are_waits_possible(const wh_flow_sums_t *flow) {
    const uint64_t count = flow->of[WH_FLOW_SUM_ROBOTS_WAIT].count;
    return count <= flow->trials && count >= flow->of[WH_FLOW_SUM_MAKESPAN].count &&
           flow->of[WH_FLOW_SUM_WAFERS_WAIT].count == count && flow->of[WH_FLOW_SUM_LATE].count == count;
}

/* True if so many trials can have these counts. */
static bool is_flow_possible(const wh_flow_sums_t *flow, uint64_t trials) {
    return flow->trials == trials && flow->unfinished <= trials && flow->no_cycle <= trials &&
           flow->clipped <= trials && flow->unsteady <= trials - flow->no_cycle &&
           flow->of[WH_FLOW_SUM_MAKESPAN].count == trials - flow->unfinished &&
           flow->of[WH_FLOW_SUM_CYCLE].count == trials - flow->no_cycle &&
           flow->of[WH_FLOW_SUM_PER_HOUR].count == trials - flow->no_cycle && are_waits_possible(flow);
}

static bool take_flow(const wh_study_t *study, const json_t *list, wh_tally_t *tally) {
    if (!study->has_flow || tally->trials == 0) {
        return json_is_null(list);
    }
    wh_flow_sums_t *flow = wh_tally_need_flow(tally);
    uint64_t *const counts[FLOW_COUNTS] = {&flow->trials, &flow->unfinished, &flow->unsteady, &flow->no_cycle,
                                           &flow->clipped};
    bool sound = json_array_size(list) == FLOW_COUNTS + WH_FLOW_SUM_FIGURES;
    for (size_t i = 0; sound && i < FLOW_COUNTS; ++i) {
        sound = take_count(json_array_get(list, i), counts[i]);
    }
    for (size_t i = 0; sound && i < WH_FLOW_SUM_FIGURES; ++i) {
        sound = take_sum(json_array_get(list, FLOW_COUNTS + i), &flow->of[i]);
    }
    return sound && is_flow_possible(flow, tally->trials);
}

static json_t *put_tally(const wh_tally_t *tally) {
    return json_pack("{s:I, s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "trials",
                     (json_int_t)tally->trials, "met", (json_int_t)tally->met, "ended",
                     (json_int_t)tally->ended, "whole", (json_int_t)tally->whole, "events", put_events(tally),
                     "expectations", wh_json_list(put_row, &tally->expectations, tally->expectations.count),
                     "errors", wh_json_list(put_row, &tally->errors, tally->errors.count), "wafers",
                     wh_json_list(put_wafer, tally, tally->wafer_count), "worst",
                     wh_json_list(put_worst, tally, tally->worst_count), "relations",
                     wh_json_list(put_relation, &tally->relations, wh_relations_size(&tally->relations)),
                     "lines", put_lines(&tally->lines), "flow", put_flow(tally->flow));
}

static bool take_counts(const json_t *root, wh_tally_t *tally) {
    return take_count(json_object_get(root, "trials"), &tally->trials) &&
           take_count(json_object_get(root, "met"), &tally->met) &&
           take_count(json_object_get(root, "ended"), &tally->ended) &&
           take_count(json_object_get(root, "whole"), &tally->whole);
}

static bool take_lines(const json_t *lines, wh_tally_t *tally) {
    return json_is_string(lines) &&
           wh_trial_lines_read(&tally->lines, json_string_value(lines), tally->wafer_count);
}

static bool are_rows_possible(const wh_tally_rows_t *rows, uint64_t trials) {
    bool possible = true;
    for (size_t i = 0; i < rows->count; ++i) {
        const wh_tally_row_t *row = &rows->rows[i];
        possible = possible && row->bad <= row->seen && row->seen <= trials;
    }
    return possible;
}

static bool are_events_possible(const wh_tally_t *tally) {
    bool possible = true;
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        const wh_tally_event_t *event = &tally->events[kind];
        possible = possible && event->trials <= tally->trials && event->trials <= event->total;
    }
    return possible;
}

static bool are_wafers_possible(const wh_tally_t *tally) {
    bool possible = true;
    for (size_t w = 0; w < tally->wafer_count; ++w) {
        const wh_tally_wafer_t *wafer = &tally->wafers[w];
        possible = possible && wafer->elsewhere <= tally->trials &&
                   wafer->of[0].count <= tally->trials - wafer->elsewhere;
    }
    return possible;
}

/* True if so many trials can have these counts. Else the check was made of what is no result. */
static bool is_possible(const wh_study_t *study, const wh_tally_t *tally) {
    bool possible = tally->met <= tally->trials && tally->ended <= tally->trials &&
                    tally->whole <= tally->trials && are_rows_possible(&tally->expectations, tally->trials) &&
                    are_rows_possible(&tally->errors, tally->trials) && are_events_possible(tally) &&
                    are_wafers_possible(tally);
    for (size_t i = 0; i < tally->worst_count; ++i) {
        possible = possible && tally->worst[i].trial < study->trials;
    }
    return possible;
}

static bool take_tally(const wh_study_t *study, const json_t *root, wh_tally_t *tally) {
    return take_counts(root, tally) && take_lines(json_object_get(root, "lines"), tally) &&
           take_events(json_object_get(root, "events"), tally) &&
           take_wafers(json_object_get(root, "wafers"), tally) &&
           take_rows(json_object_get(root, "expectations"), &tally->expectations) &&
           take_rows(json_object_get(root, "errors"), &tally->errors) &&
           take_worst(json_object_get(root, "worst"), tally) && is_possible(study, tally) &&
           take_flow(study, json_object_get(root, "flow"), tally) &&
           take_relations(study, json_object_get(root, "relations"), tally);
}

/* ------------------------------------------------------------------------------------------------- trials */

static json_t *put_stretch(const void *subject, size_t i) {
    const wh_stretch_t *stretch = &((const wh_stretches_t *)subject)->items[i];
    return json_pack("[I, I]", (json_int_t)stretch->first, (json_int_t)(stretch->first + stretch->count - 1));
}

/* False, and the message says why, if they are not a study's, or if one of them is beyond this study. */
static bool take_stretch(const wh_study_t *study, const json_t *pair, wh_stretches_t *done, char *message,
                         size_t size) {
    uint64_t first, last;
    if (json_array_size(pair) != 2 || !take_count(json_array_get(pair, 0), &first) ||
        !take_count(json_array_get(pair, 1), &last) || last < first) {
        return false;
    }
    if (last >= study->trials) {
        snprintf(message, size, "of a longer study: its trial %llu is done (expected at least %llu trials)",
                 (unsigned long long)last, (unsigned long long)last + 1);
        return false;
    }
    const wh_stretch_t stretch = {first, last - first + 1};
    return wh_stretches_add(done, stretch);
}

/* False, with a message, if trials are done without lines, although their lines are wanted now. */
static bool has_lines(const wh_study_t *study, const wh_progress_t *progress, char *message, size_t size) {
    const uint64_t wanted = wh_stretches_below(&progress->done, study->lines);
    const uint64_t found = wh_trial_lines_below(&progress->tally.lines, study->lines);
    if (found == wanted) {
        return true;
    }
    snprintf(message, size,
             "has lines of %llu trials, and %llu are done (expected a file that a study "
             "with --csv wrote, or --csv without it)",
             (unsigned long long)found, (unsigned long long)wanted);
    return false;
}

static bool take_progress(const wh_study_t *study, const json_t *root, wh_progress_t *progress, char *message,
                          size_t size) {
    const json_t *done = json_object_get(root, "done");
    bool sound = json_is_array(done);
    for (size_t i = 0; sound && i < json_array_size(done); ++i) {
        sound = take_stretch(study, json_array_get(done, i), &progress->done, message, size);
    }
    return sound && take_tally(study, json_object_get(root, "tally"), &progress->tally) &&
           progress->tally.trials == progress->done.trials && has_lines(study, progress, message, size);
}

/* ------------------------------------------------------------------------------------------------- check */

static void write_check(const char *text, size_t size, char check[CHECK_BYTES + 1]) {
    uint64_t hash = WH_HASH_START;
    for (size_t i = 0; i < size; ++i) {
        hash = wh_hash_word(hash, (unsigned char)text[i]);
    }
    (void)snprintf(check, CHECK_BYTES + 1, ",\"check\":\"%016llx\"}", (unsigned long long)hash);
}

/* Puts the check in place of the text's last bracket. */
static char *with_check(char *text) {
    const size_t size = strlen(text) - 1;
    char *made = wh_array_new(size + CHECK_BYTES + 1, 1);
    (void)snprintf(made, size + 1, "%s", text);
    write_check(text, size, made + size);
    free(text);
    return made;
}

/* True if the text ends with the check of the bytes before it; else the message says that it is damaged. */
static bool is_whole(const char *text, size_t size, char *message, size_t message_size) {
    char check[CHECK_BYTES + 1];
    if (size == 0 || text[0] != BEGIN) {
        snprintf(message, message_size, "damaged (expected a study's state)");
        return false;
    }
    while (size > 0 && (text[size - 1] == '\n' || text[size - 1] == '\r')) {
        --size;
    }
    const char *end = size > CHECK_BYTES ? text + size - CHECK_BYTES : NULL;
    if (!end || memcmp(end, ",\"check\":\"", 10) != 0) {
        snprintf(message, message_size,
                 "damaged, or of an older version (expected a study's state, with its check at the end)");
        return false;
    }
    write_check(text, size - CHECK_BYTES, check);
    if (memcmp(end, check, CHECK_BYTES) != 0) {
        snprintf(message, message_size,
                 "damaged: something in it was changed (its check is %.16s, expected %.16s)", end + 10,
                 check + 10);
        return false;
    }
    return true;
}

/* ----------------------------------------------------------------------------------------- there and back */

char *wh_checkpoint_text(const wh_study_t *study, const wh_progress_t *progress) {
    json_t *root = json_pack("{s:i, s:o, s:o, s:o}", "format", FORMAT, "study", wh_study_identity(study),
                             "done", wh_json_list(put_stretch, &progress->done, progress->done.count),
                             "tally", put_tally(&progress->tally));
    char *text = json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(root);
    return text ? with_check(text) : NULL;
}

static bool take(const wh_study_t *study, const json_t *root, wh_progress_t *progress, char *message,
                 size_t size) {
    const json_t *format = json_object_get(root, "format");
    snprintf(message, size, "damaged (expected a study's state)");
    if (json_is_integer(format) && json_integer_value(format) != FORMAT) {
        snprintf(message, size, "of another version: its format is %lld (expected %d)",
                 (long long)json_integer_value(format), FORMAT);
        return false;
    }
    bool sound =
        json_is_integer(format) && wh_study_is_same(json_object_get(root, "study"), study, message, size);
    if (sound) {
        wh_progress_t taken;
        wh_progress_init(&taken, study);
        sound = take_progress(study, root, &taken, message, size);
        if (sound) {
            wh_progress_merge(progress, &taken);
        }
        wh_progress_free(&taken);
    }
    return sound;
}

bool wh_checkpoint_read(const wh_study_t *study, const char *text, size_t size, wh_progress_t *progress,
                        char *message, size_t message_size) {
    if (!is_whole(text, size, message, message_size)) {
        return false;
    }
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, NULL);
    const bool sound = take(study, root, progress, message, message_size);
    json_decref(root);
    return sound;
}

bool wh_checkpoint_save(const char *path, const char *text) {
    wh_output_t output = {0};
    if (!wh_output_open(&output, path)) {
        return false;
    }
    (void)fputs(text, output.file);
    return wh_output_commit(&output);
}

/* The file's bytes, to be freed; null, with errno, if it cannot be read. A file that does not begin as a
 * state is not read further: a device may have no end. */
static char *read_all(FILE *file, size_t *size) {
    char *text = NULL;
    size_t capacity = 0;
    *size = 0;
    for (size_t got = 1; got > 0; *size += got) {
        text = wh_array_reserve(text, *size + READ_BYTES, &capacity, 1);
        got = fread(text + *size, 1, READ_BYTES, file);
        if (got > 0 && text[0] != BEGIN) {
            *size += got;
            break;
        }
    }
    if (ferror(file)) {
        free(text);
        return NULL;
    }
    return text;
}

wh_checkpoint_found_t wh_checkpoint_load(const char *path, const wh_study_t *study, wh_progress_t *progress) {
    char message[1200] = "";
    size_t size = 0;
    FILE *file = fopen(path, "r");
    if (!file && errno == ENOENT) {
        return WH_CHECKPOINT_NONE;
    }
    char *text = file ? read_all(file, &size) : NULL;
    if (!text) {
        snprintf(message, sizeof message, "%s (expected a file that can be read)", strerror(errno));
    }
    const bool read = text && wh_checkpoint_read(study, text, size, progress, message, sizeof message);
    if (!read) {
        fprintf(stderr, "--state %s: %s\n", path, message);
    }
    if (file) {
        fclose(file);
    }
    free(text);
    return read ? WH_CHECKPOINT_READ : WH_CHECKPOINT_REFUSED;
}

char *wh_checkpoint_default_path(const wh_study_t *study) {
    char name[40];
    char path[PATH_MAX];
    json_t *identity = wh_study_identity(study);
    char *text = json_dumps(identity, JSON_COMPACT);
    uint64_t hash = WH_HASH_START;
    for (const char *c = text; *c; ++c) {
        hash = wh_hash_word(hash, (unsigned char)*c);
    }
    hash = wh_hash_word(hash, study->trials);
    free(text);
    json_decref(identity);
    snprintf(name, sizeof name, "study-%016llx", (unsigned long long)hash);
    wh_output_state_path(name, path, sizeof path);
    return path[0] != '\0' && wh_output_make_folders(path) ? wh_text_copy(path) : NULL;
}
