#include "relations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* From dz on, quantities have no sign: tilt and off. */
#define SIGNED_ENDS 3

size_t wh_relations_wafers(size_t cause_count, size_t wafer_count) {
    const size_t room = cause_count > 0 ? WH_RELATION_MOST / (cause_count * (WH_RELATION_ENDS + 3)) : 0;
    return wafer_count < room ? wafer_count : room;
}

void wh_relations_need(wh_relations_t *relations, size_t cause_count, size_t wafer_count) {
    if (relations->cause_count > 0 || cause_count == 0) {
        return;
    }
    relations->cause_count = cause_count;
    relations->wafer_count = wafer_count;
    relations->drawn = wh_array_new(cause_count, sizeof *relations->drawn);
    relations->all = wh_array_new(cause_count, sizeof *relations->all);
    relations->failed = wh_array_new(cause_count, sizeof *relations->failed);
    relations->there = wh_array_new(cause_count * wafer_count, sizeof *relations->there);
    relations->products =
        wh_array_new(cause_count * wafer_count * WH_RELATION_ENDS, sizeof *relations->products);
}

void wh_relations_free(wh_relations_t *relations) {
    free(relations->drawn);
    free(relations->all);
    free(relations->failed);
    free(relations->there);
    free(relations->products);
    memset(relations, 0, sizeof *relations);
}

/* ------------------------------------------------------------------------------------------------- adding */

static int64_t size_of(int64_t whole) {
    return whole < 0 ? -whole : whole;
}

static void add_sums(wh_relation_sums_t *sums, int64_t whole) {
    sums->values += whole;
    sums->sizes += size_of(whole);
    sums->squares += (wh_uint128_t)((wh_int128_t)whole * whole);
}

void wh_relations_add(wh_relations_t *relations, bool failed) {
    for (size_t i = 0; i < relations->cause_count; ++i) {
        const int64_t whole = wh_sum_whole(relations->drawn[i]);
        add_sums(&relations->all[i], whole);
        if (failed) {
            add_sums(&relations->failed[i], whole);
        }
    }
}

static wh_int128_t *product_of(const wh_relations_t *relations, size_t cause, size_t wafer, size_t quantity) {
    return &relations->products[(wafer * WH_RELATION_ENDS + quantity) * relations->cause_count + cause];
}

void wh_relations_add_wafer(wh_relations_t *relations, size_t wafer, const double ends[WH_RELATION_ENDS]) {
    int64_t wholes[WH_RELATION_ENDS];
    for (size_t q = 0; q < WH_RELATION_ENDS; ++q) {
        wholes[q] = wh_sum_whole(ends[q]);
    }
    for (size_t i = 0; i < relations->cause_count; ++i) {
        const int64_t whole = wh_sum_whole(relations->drawn[i]);
        add_sums(&relations->there[wafer * relations->cause_count + i], whole);
        for (size_t q = 0; q < WH_RELATION_ENDS; ++q) {
            *product_of(relations, i, wafer, q) +=
                (wh_int128_t)wholes[q] * (q < SIGNED_ENDS ? whole : size_of(whole));
        }
    }
}

/* ---------------------------------------------------------------------------------------------- all of it */

size_t wh_relations_size(const wh_relations_t *relations) {
    const size_t lists = 2 + relations->wafer_count;
    return relations->cause_count * (3 * lists + relations->wafer_count * WH_RELATION_ENDS);
}

static wh_int128_t *number_of(wh_relation_sums_t *sums, size_t i) {
    wh_relation_sums_t *sum = &sums[i / 3];
    return i % 3 == 0 ? &sum->values : i % 3 == 1 ? &sum->sizes : (wh_int128_t *)&sum->squares;
}

wh_int128_t *wh_relations_number(const wh_relations_t *relations, size_t i) {
    const size_t list = 3 * relations->cause_count;
    const size_t sums = list * (2 + relations->wafer_count);
    if (i >= sums) {
        return &relations->products[i - sums];
    }
    return i < list       ? number_of(relations->all, i)
           : i < 2 * list ? number_of(relations->failed, i - list)
                          : number_of(relations->there, i - 2 * list);
}

void wh_relations_merge(wh_relations_t *relations, const wh_relations_t *other) {
    wh_relations_need(relations, other->cause_count, other->wafer_count);
    for (size_t i = 0; i < wh_relations_size(other); ++i) {
        *wh_relations_number(relations, i) += *wh_relations_number(other, i);
    }
}

/* ------------------------------------------------------------------------------------------- correlations */

/* The sum of (x - mean) (y - mean) over n pairs, from plain sums. It is exact until the last step: products
 * wrap, and the wrapped result is right. */
static double centred(uint64_t n, wh_int128_t x, wh_int128_t y, wh_int128_t xy) {
    const wh_int128_t count = (wh_int128_t)n;
    const wh_int128_t near_x = x / count;
    const wh_int128_t near_y = y / count;
    const wh_uint128_t apart = (wh_uint128_t)xy - (wh_uint128_t)near_x * (wh_uint128_t)y -
                               (wh_uint128_t)near_y * (wh_uint128_t)x +
                               (wh_uint128_t)count * (wh_uint128_t)near_x * (wh_uint128_t)near_y;
    const double rest = (double)(x - near_x * count) * (double)(y - near_y * count) / (double)n;
    return (double)(wh_int128_t)apart - rest;
}

/* The value of the standard normal that is exceeded, on both sides together, with this probability. */
static double normal_bound(double beyond) {
    double low = 0;
    double high = 40;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        if (erfc(middle / sqrt(2.0)) > beyond) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

static wh_correlation_t correlate(const wh_relations_t *relations, uint64_t n, double products, double xx,
                                  double yy) {
    const wh_correlation_t unknown = {false, 0, 0, 0};
    if (n < (uint64_t)2 * WH_RELATION_FEWEST || !(xx > 0) || !(yy > 0)) {
        return unknown;
    }
    const double told =
        (double)relations->cause_count * (2 + (double)(relations->wafer_count * WH_RELATION_ENDS));
    const double reach = normal_bound(0.05 / told) / sqrt((double)n - 3);
    const double r = fmax(-1, fmin(1, products / sqrt(xx) / sqrt(yy)));
    const double middle = atanh(r);
    const wh_correlation_t known = {true, r, fmin(r, tanh(middle - reach)), fmax(r, tanh(middle + reach))};
    return known;
}

wh_correlation_t wh_relations_failing(const wh_relations_t *relations, size_t cause, bool by_size,
                                      uint64_t trials, uint64_t failed) {
    const wh_correlation_t unknown = {false, 0, 0, 0};
    if (failed < WH_RELATION_FEWEST || trials - failed < WH_RELATION_FEWEST) {
        return unknown;
    }
    const wh_relation_sums_t *all = &relations->all[cause];
    const wh_relation_sums_t *bad = &relations->failed[cause];
    const wh_int128_t x = by_size ? all->sizes : all->values;
    const wh_int128_t count = (wh_int128_t)failed;
    return correlate(relations, trials, centred(trials, x, count, by_size ? bad->sizes : bad->values),
                     centred(trials, x, x, (wh_int128_t)all->squares), centred(trials, count, count, count));
}

wh_correlation_t wh_relations_end(const wh_relations_t *relations, size_t cause, size_t wafer,
                                  size_t quantity, const wh_sum_t *end) {
    const wh_correlation_t unknown = {false, 0, 0, 0};
    if (end->count == 0) {
        return unknown;
    }
    const wh_relation_sums_t *there = &relations->there[wafer * relations->cause_count + cause];
    const wh_int128_t x = quantity < SIGNED_ENDS ? there->values : there->sizes;
    return correlate(relations, end->count,
                     centred(end->count, x, end->sum, *product_of(relations, cause, wafer, quantity)),
                     centred(end->count, x, x, (wh_int128_t)there->squares),
                     centred(end->count, end->sum, end->sum, (wh_int128_t)end->squares));
}
