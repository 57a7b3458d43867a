#include "sum.h"

#include <math.h>
#include <string.h>

#define UNIT (1.0 / 1073741824.0)
#define Z 1.959963984540054

int64_t wh_sum_whole(double value) {
    const double scaled = floor(value * 1073741824.0 + 0.5);
    if (!(scaled > -(double)WH_SUM_MOST)) {
        return -WH_SUM_MOST;
    }
    return scaled < (double)WH_SUM_MOST ? (int64_t)scaled : WH_SUM_MOST;
}

/* --------------------------------------------------------------------------------------------------- bins */

static uint32_t side_of(uint64_t size) {
    uint32_t doublings = 0;
    while (size >> doublings >= 128) {
        ++doublings;
    }
    return 64 * doublings + (uint32_t)(size >> doublings);
}

/* Bins in the order of their values: the negative ones first, backwards. */
static uint32_t bin_of(int64_t whole) {
    return whole < 0 ? WH_SUM_SIDE - 1 - side_of((uint64_t)-whole) : WH_SUM_SIDE + side_of((uint64_t)whole);
}

static double middle_of_side(uint32_t side) {
    if (side < 128) {
        return side;
    }
    const uint32_t doublings = (side - 64) / 64;
    const uint64_t first = (uint64_t)((side - 64) % 64 + 64) << doublings;
    return (double)first + (double)((UINT64_C(1) << doublings) - 1) / 2;
}

static double middle_of(uint32_t bin) {
    return bin < WH_SUM_SIDE ? -middle_of_side(WH_SUM_SIDE - 1 - bin) : middle_of_side(bin - WH_SUM_SIDE);
}

static double half_width_of(uint32_t bin) {
    const uint32_t side = bin < WH_SUM_SIDE ? WH_SUM_SIDE - 1 - bin : bin - WH_SUM_SIDE;
    return side < 128 ? 0.5 : (double)(UINT64_C(1) << (side - 64) / 64) / 2;
}

/* ------------------------------------------------------------------------------------------------- adding */

static void widen(wh_sum_t *sum, int64_t least, int64_t most) {
    sum->least = sum->count == 0 || least < sum->least ? least : sum->least;
    sum->most = sum->count == 0 || most > sum->most ? most : sum->most;
}

void wh_sum_add(wh_sum_t *sum, double value) {
    const int64_t whole = wh_sum_whole(value);
    widen(sum, whole, whole);
    ++sum->count;
    sum->sum += whole;
    sum->squares += (wh_uint128_t)((wh_int128_t)whole * whole);
    ++sum->bins[bin_of(whole)];
}

void wh_sum_merge(wh_sum_t *sum, const wh_sum_t *other) {
    if (other->count == 0) {
        return;
    }
    widen(sum, other->least, other->most);
    sum->count += other->count;
    sum->sum += other->sum;
    sum->squares += other->squares;
    for (uint32_t i = 0; i < WH_SUM_BINS; ++i) {
        sum->bins[i] += other->bins[i];
    }
}

/* ------------------------------------------------------------------------------------------------ figures */

double wh_sum_mean(const wh_sum_t *sum) {
    return sum->count == 0 ? 0 : (double)sum->sum / (double)sum->count * UNIT;
}

/* Takes squares about a whole number near the mean: exact until the two last steps. Unsigned products wrap,
 * and the wrapped result is right. */
double wh_sum_deviation(const wh_sum_t *sum) {
    if (sum->count < 2) {
        return 0;
    }
    const wh_int128_t n = (wh_int128_t)sum->count;
    const wh_int128_t about = sum->sum / n;
    const wh_int128_t rest = sum->sum - about * n;
    const wh_uint128_t apart = sum->squares - 2 * (wh_uint128_t)about * (wh_uint128_t)sum->sum +
                               (wh_uint128_t)n * (wh_uint128_t)about * (wh_uint128_t)about;
    const double squares = (double)apart - (double)rest * (double)rest / (double)n;
    return squares > 0 ? sqrt(squares / (double)(n - 1)) * UNIT : 0;
}

double wh_sum_least(const wh_sum_t *sum) {
    return (double)sum->least * UNIT;
}

double wh_sum_most(const wh_sum_t *sum) {
    return (double)sum->most * UNIT;
}

double wh_sum_quantile(const wh_sum_t *sum, uint32_t permille) {
    const wh_uint128_t wanted = (wh_uint128_t)sum->count * permille;
    wh_uint128_t seen = 0;
    for (uint32_t bin = 0; sum->count > 0 && bin < WH_SUM_BINS; ++bin) {
        seen += sum->bins[bin];
        if (sum->bins[bin] > 0 && seen * 1000 >= wanted) {
            const double middle = middle_of(bin);
            const double least = (double)sum->least;
            const double most = (double)sum->most;
            return (middle < least ? least : middle > most ? most : middle) * UNIT;
        }
    }
    return 0;
}

/* A bin's values are taken as spread evenly over it. */
void wh_sum_histogram(const wh_sum_t *sum, double low, double high, double counts[], size_t count) {
    const double step = (high - low) / (double)count;
    memset(counts, 0, count * sizeof *counts);
    for (uint32_t bin = 0; bin < WH_SUM_BINS && sum->count > 0; ++bin) {
        if (sum->bins[bin] == 0) {
            continue;
        }
        const double middle = middle_of(bin) * UNIT;
        const double half = half_width_of(bin) * UNIT;
        const double first = fmax(middle - half, low);
        const double last = fmin(middle + half, high);
        for (size_t i = 0; i < count; ++i) {
            const double from = fmax(first, low + step * (double)i);
            const double to = fmin(last, low + step * (double)(i + 1));
            counts[i] += to > from ? (double)sum->bins[bin] * (to - from) / (last - first) : 0;
        }
    }
}

wh_confidence_t wh_wilson_interval(uint64_t hits, uint64_t trials) {
    if (trials == 0) {
        const wh_confidence_t unknown = {0, 0, 1};
        return unknown;
    }
    const double n = (double)trials;
    const double p = (double)hits / n;
    const double centre = p + Z * Z / (2 * n);
    const double reach = Z * sqrt(p * (1 - p) / n + Z * Z / (4 * n * n));
    const double scale = 1 + Z * Z / n;
    const wh_confidence_t interval = {p, hits == 0 ? 0 : (centre - reach) / scale,
                                      hits == trials ? 1 : (centre + reach) / scale};
    return interval;
}
