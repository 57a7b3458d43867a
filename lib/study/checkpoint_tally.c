/* A study's tally as JSON. */
#include <math.h>
#include <string.h>

#include "../text/json.h"
#include "checkpoint_internal.h"

/* Whole numbers of 64 bits as JSON has them: 2^63 trials are out of reach. */
static json_t *count(uint64_t value) {
    return json_integer((json_int_t)value);
}

static bool take_count(const json_t *value, uint64_t *number) {
    const json_int_t found = json_integer_value(value);
    *number = (uint64_t)found;
    return json_is_integer(value) && found >= 0;
}

static bool take_key(const json_t *root, const char *key, uint64_t *number) {
    return take_count(json_object_get(root, key), number);
}

/* -------------------------------------------------------------------------------------------------------- sums */

static json_t *put_wide(wh_uint128_t value) {
    return json_pack("[I, I]", (json_int_t)(value >> 64), (json_int_t)(uint64_t)value);
}

static bool take_wide(const json_t *pair, wh_uint128_t *value) {
    const json_t *high = json_array_get(pair, 0);
    const json_t *low = json_array_get(pair, 1);
    *value = (wh_uint128_t)(uint64_t)json_integer_value(high) << 64 | (uint64_t)json_integer_value(low);
    return json_is_integer(high) && json_is_integer(low);
}

static json_t *put_sum(const wh_sum_t *sum) {
    json_t *bins = json_array();
    for (size_t i = 0; i < WH_SUM_BINS; ++i) {
        if (sum->bins[i] > 0) {
            json_array_append_new(bins, json_integer((json_int_t)i));
            json_array_append_new(bins, count(sum->bins[i]));
        }
    }
    return json_pack("{s:o, s:o, s:o, s:I, s:I, s:o}", "count", count(sum->count), "sum",
                     put_wide((wh_uint128_t)sum->sum), "squares", put_wide(sum->squares), "least",
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

static bool take_sum(const json_t *root, wh_sum_t *sum) {
    wh_uint128_t wide = 0;
    const bool sound = take_key(root, "count", &sum->count) &&
                       take_wide(json_object_get(root, "sum"), &wide) &&
                       take_wide(json_object_get(root, "squares"), &sum->squares);
    sum->sum = (wh_int128_t)wide;
    sum->least = json_integer_value(json_object_get(root, "least"));
    sum->most = json_integer_value(json_object_get(root, "most"));
    return sound && sum->least >= -WH_SUM_MOST && sum->most <= WH_SUM_MOST &&
           take_bins(json_object_get(root, "bins"), sum);
}

static json_t *put_wafer(const wh_tally_wafer_t *wafer) {
    json_t *list = json_pack("[o]", count(wafer->elsewhere));
    for (size_t q = 0; q < WH_TALLY_QUANTITIES; ++q) {
        json_array_append_new(list, put_sum(&wafer->of[q]));
    }
    return list;
}

static bool take_wafer(const json_t *list, wh_tally_wafer_t *wafer) {
    bool sound = take_count(json_array_get(list, 0), &wafer->elsewhere);
    for (size_t q = 0; sound && q < WH_TALLY_QUANTITIES; ++q) {
        sound = take_sum(json_array_get(list, q + 1), &wafer->of[q]);
    }
    return sound;
}

/* --------------------------------------------------------------------------------------------------------- rows */

static json_t *put_rows(const wh_tally_rows_t *rows) {
    json_t *list = json_array();
    for (size_t i = 0; i < rows->count; ++i) {
        const wh_tally_row_t *row = &rows->rows[i];
        json_array_append_new(list, json_pack("[i, i, o, o, o, o, I]", row->line, row->place,
                                              wh_json_text(row->text), count(row->named), count(row->seen),
                                              count(row->bad), (json_int_t)row->first));
    }
    return list;
}

static bool take_row(const json_t *list, wh_tally_rows_t *rows) {
    uint64_t named = 0;
    const char *text = json_string_value(json_array_get(list, 2));
    const int line = (int)json_integer_value(json_array_get(list, 0));
    const int place = (int)json_integer_value(json_array_get(list, 1));
    if (!text || !take_count(json_array_get(list, 3), &named)) {
        return false;
    }
    wh_tally_row_t *row = wh_tally_row(rows, line, place, text, named);
    row->first = (uint64_t)json_integer_value(json_array_get(list, 6));
    return take_count(json_array_get(list, 4), &row->seen) && take_count(json_array_get(list, 5), &row->bad);
}

static bool take_rows(const json_t *list, wh_tally_rows_t *rows) {
    bool sound = json_is_array(list);
    for (size_t i = 0; sound && i < json_array_size(list); ++i) {
        sound = take_row(json_array_get(list, i), rows);
    }
    return sound;
}

/* -------------------------------------------------------------------------------------------------------- worst */

/* Infinite is null. */
static json_t *put_worst(const wh_tally_t *tally) {
    json_t *list = json_array();
    for (size_t i = 0; i < tally->worst_count; ++i) {
        const wh_tally_trial_t *trial = &tally->worst[i];
        json_array_append_new(
            list, json_pack("[o, b, o]", count(trial->trial), trial->met, wh_json_real(trial->off)));
    }
    return list;
}

static bool take_worst(const json_t *list, wh_tally_t *tally) {
    bool sound = json_is_array(list) && json_array_size(list) <= WH_STUDY_WORST;
    for (size_t i = 0; sound && i < json_array_size(list); ++i) {
        const json_t *entry = json_array_get(list, i);
        const json_t *off = json_array_get(entry, 2);
        wh_tally_trial_t trial = {.met = json_is_true(json_array_get(entry, 1)), .off = (double)INFINITY};
        if (!json_is_null(off)) {
            trial.off = json_number_value(off);
        }
        sound = take_count(json_array_get(entry, 0), &trial.trial) && off;
        wh_tally_note_worst(tally, &trial);
    }
    return sound;
}

/* ---------------------------------------------------------------------------------------------------- all of it */

static json_t *put_events(const wh_tally_t *tally) {
    json_t *list = json_array();
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        json_array_append_new(list, count(tally->events[kind].trials));
        json_array_append_new(list, count(tally->events[kind].total));
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

json_t *wh_checkpoint_put_tally(const wh_tally_t *tally) {
    json_t *wafers = json_array();
    for (size_t w = 0; w < tally->wafer_count; ++w) {
        json_array_append_new(wafers, put_wafer(&tally->wafers[w]));
    }
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "trials", count(tally->trials), "met",
                     count(tally->met), "ended", count(tally->ended), "whole", count(tally->whole), "events",
                     put_events(tally), "expectations", put_rows(&tally->expectations), "errors",
                     put_rows(&tally->errors), "wafers", wafers, "worst", put_worst(tally));
}

static bool take_counts(const json_t *root, wh_tally_t *tally) {
    return take_key(root, "trials", &tally->trials) && take_key(root, "met", &tally->met) &&
           take_key(root, "ended", &tally->ended) && take_key(root, "whole", &tally->whole);
}

static bool take_wafers(const json_t *list, wh_tally_t *tally) {
    bool sound = json_array_size(list) == tally->wafer_count;
    for (size_t w = 0; sound && w < tally->wafer_count; ++w) {
        sound = take_wafer(json_array_get(list, w), &tally->wafers[w]);
    }
    return sound;
}

bool wh_checkpoint_take_tally(const json_t *root, wh_tally_t *tally) {
    return take_counts(root, tally) && take_events(json_object_get(root, "events"), tally) &&
           take_wafers(json_object_get(root, "wafers"), tally) &&
           take_rows(json_object_get(root, "expectations"), &tally->expectations) &&
           take_rows(json_object_get(root, "errors"), &tally->errors) &&
           take_worst(json_object_get(root, "worst"), tally);
}
