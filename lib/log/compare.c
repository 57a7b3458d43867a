#include "compare.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"
#include "../text/digits.h"

/* ------------------------------------------------------------------------------------------------ digests */

/* Returns equal bits for every NaN. */
static uint64_t bits_of(double value) {
    return wh_double_bits(isnan(value) ? (double)NAN : value);
}

static void keep(void *user, const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                 uint64_t hash) {
    wh_log_digests_t *digests = user;
    const size_t count = wh_slice_field_count(layout);
    wh_slice_row_take(&digests->row, layout, axes, state);
    uint64_t digest = wh_hash_word(WH_HASH_START, hash);
    for (size_t i = 0; i < count; ++i) {
        digest = wh_hash_word(digest, bits_of(digests->row.values[i]));
    }
    digests->slices =
        wh_array_grow(digests->slices, digests->count, &digests->capacity, sizeof *digests->slices);
    digests->slices[digests->count].seq = state->seq;
    digests->slices[digests->count++].digest = digest;
}

bool wh_compare_read(wh_log_run_t *run, wh_log_run_options_t *options, wh_log_digests_t *digests) {
    options->listener = keep;
    options->user = digests;
    return wh_log_run_read(run, options);
}

void wh_log_digests_free(wh_log_digests_t *digests) {
    free(digests->slices);
    wh_slice_row_free(&digests->row);
    *digests = (wh_log_digests_t){.slices = NULL};
}

/* ---------------------------------------------------------------------------------------------- one slice */

typedef struct {
    int64_t seq;
    double *values; /* null: the slice did not come */
    uint64_t hash;
} wanted_t;

static void take(void *user, const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                 uint64_t hash) {
    wanted_t *wanted = user;
    if (state->seq == wanted->seq && !wanted->values) {
        wanted->values = wh_array_new(wh_slice_field_count(layout), sizeof *wanted->values);
        wanted->hash = hash;
        wh_slice_fields(layout, axes, state, wanted->values);
    }
}

/* Reads a log again for one of its slices. */
static bool read_slice(wh_log_run_t *run, wanted_t *wanted) {
    wh_log_run_t *again = wh_array_new(1, sizeof *again);
    wh_log_run_options_t options = run->options;
    options.only_slices = true;
    options.listener = take;
    options.user = wanted;
    const bool read = wh_log_run_read(again, &options) && wanted->values;
    if (!read) {
        (void)snprintf(run->message, sizeof run->message, "%.300s: slice %" PRId64 " is not there any more",
                       run->options.path, wanted->seq);
    }
    wh_log_run_close(again);
    free(again);
    return read;
}

static void put_value(const wh_layout_t *layout, wh_slice_field_t kind, double value,
                      char text[WH_COMPARE_VALUE]) {
    const char *word = wh_slice_field_word(layout, kind, value);
    char digits[WH_DIGITS];
    wh_digits(value, digits);
    (void)snprintf(text, WH_COMPARE_VALUE, "%s",
                   isnan(value)      ? "none"
                   : !word           ? digits
                   : word[0] == '\0' ? "none"
                                     : word);
}

static void put_hashes(const wanted_t wanted[2], wh_compare_t *found) {
    (void)snprintf(found->field, sizeof found->field, "hash");
    for (size_t i = 0; i < 2; ++i) {
        (void)snprintf(found->values[i], sizeof found->values[i], "%016" PRIx64, wanted[i].hash);
    }
}

bool wh_compare_fields_fit(const wh_layout_t *a, const wh_layout_t *b) {
    const size_t count = wh_slice_field_count(a);
    bool fit = count == wh_slice_field_count(b);
    for (size_t i = 0; i < count && fit; ++i) {
        char names[2][WH_SLICE_FIELD_NAME];
        (void)wh_slice_field_name(a, i, names[0]);
        (void)wh_slice_field_name(b, i, names[1]);
        fit = strcmp(names[0], names[1]) == 0;
    }
    return fit;
}

/* Names the first field that differs. */
static void name_field(wh_log_run_t *const runs[2], const wanted_t wanted[2], wh_compare_t *found) {
    const wh_layout_t *const layouts[2] = {runs[0]->cell.layout, runs[1]->cell.layout};
    const size_t counts[2] = {wh_slice_field_count(layouts[0]), wh_slice_field_count(layouts[1])};
    put_hashes(wanted, found);
    for (size_t i = 0; i < counts[0] && i < counts[1]; ++i) {
        char names[2][WH_SLICE_FIELD_NAME];
        const wh_slice_field_t kind = wh_slice_field_name(layouts[0], i, names[0]);
        const wh_slice_field_t other = wh_slice_field_name(layouts[1], i, names[1]);
        if (strcmp(names[0], names[1]) != 0) {
            (void)snprintf(found->field, sizeof found->field, "field %zu", i + 1);
            (void)snprintf(found->values[0], WH_COMPARE_VALUE, "%.95s", names[0]);
            (void)snprintf(found->values[1], WH_COMPARE_VALUE, "%.95s", names[1]);
            return;
        }
        if (bits_of(wanted[0].values[i]) != bits_of(wanted[1].values[i])) {
            (void)snprintf(found->field, sizeof found->field, "%.95s", names[0]);
            put_value(layouts[0], kind, wanted[0].values[i], found->values[0]);
            put_value(layouts[1], other, wanted[1].values[i], found->values[1]);
            return;
        }
    }
}

/* ---------------------------------------------------------------------------------------------- all of it */

static int64_t number_of(const wh_log_digests_t *digests, size_t i) {
    return i < digests->count ? digests->slices[i].seq : INT64_MAX;
}

/* Goes through both lists, which are in order. Returns whether the first difference is one of values. */
static bool merge(const wh_log_digests_t digests[2], wh_compare_t *found) {
    size_t at[2] = {0, 0};
    bool is_value = false;
    while (at[0] < digests[0].count || at[1] < digests[1].count) {
        const int64_t seqs[2] = {number_of(&digests[0], at[0]), number_of(&digests[1], at[1])};
        const bool both = seqs[0] == seqs[1];
        const size_t side = seqs[1] < seqs[0] ? 1 : 0;
        const bool differs = !both || digests[0].slices[at[0]].digest != digests[1].slices[at[1]].digest;
        found->common += both;
        found->differing += both && differs;
        found->only[side] += !both;
        if (differs && found->slice == 0) {
            found->slice = seqs[side];
            is_value = both;
        }
        ++at[side];
        at[1 - side] += both;
    }
    return is_value;
}

static bool find_value(wh_log_run_t *const runs[2], wh_compare_t *found) {
    wanted_t wanted[2] = {{found->slice, NULL, 0}, {found->slice, NULL, 0}};
    const bool read = read_slice(runs[0], &wanted[0]) && read_slice(runs[1], &wanted[1]);
    if (read) {
        name_field(runs, wanted, found);
    }
    free(wanted[0].values);
    free(wanted[1].values);
    return read;
}

bool wh_compare_runs(wh_log_run_t *const runs[2], const wh_log_digests_t digests[2], wh_compare_t *found) {
    memset(found, 0, sizeof *found);
    const bool is_value = merge(digests, found);
    found->time_s = (double)(found->slice * runs[0]->cell.layout->slice_us) / 1e6;
    if (is_value) {
        return find_value(runs, found);
    }
    if (found->slice > 0) {
        (void)snprintf(found->field, sizeof found->field, "slice");
        for (size_t i = 0; i < 2; ++i) {
            bool has = false;
            for (size_t s = 0; s < digests[i].count; ++s) {
                has = has || digests[i].slices[s].seq == found->slice;
            }
            (void)snprintf(found->values[i], WH_COMPARE_VALUE, "%s", has ? "there" : "not there");
        }
    }
    return true;
}
