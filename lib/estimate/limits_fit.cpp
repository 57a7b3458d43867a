#include "limits_internal.hpp"

#include <algorithm>

#include "../motion/profile.h"

namespace wh_estimate {

constexpr double tukey = 4.685;
constexpr double median_to_sd = 1.4826;
constexpr double nearly = 0.97;

static double seconds_of(const double p[parameter_count], double distance) {
    const wh_limits_t limits = {std::exp(p[0]), std::exp(p[1]), std::exp(p[2])};
    wh_profile_t profile;
    return wh_profile_plan(&profile, distance, &limits) == WH_OK ? profile.duration + p[3] : HUGE_VAL;
}

double rest_of(const data_t &data, const model_t &model, size_t i) {
    return data.moves[i].seconds - seconds_of(model.p, data.moves[i].distance);
}

/* The value that this part of the first `count` sizes does not exceed. */
static double quantile(data_t &data, size_t count, double part) {
    const auto place = static_cast<size_t>(part * static_cast<double>(count - 1));
    std::nth_element(data.sizes, data.sizes + place, data.sizes + count);
    return data.sizes[place];
}

/* ------------------------------------------------------------------------------------------------ descent */

limit_rows_t rows_of(const data_t &data, const model_t &model, double later) {
    constexpr double step = 1e-6;
    limit_rows_t rows;
    for (size_t i = 0; i < data.count; ++i) {
        limit_rows_t::vector_t row = limit_rows_t::vector_t::Zero();
        for (int k = 0; data.weights[i] > 0 && k < limit_count; ++k) {
            model_t more = model;
            model_t less = model;
            more.p[k] += step;
            less.p[k] -= step;
            row(k) = model.is_free[k] ? (rest_of(data, less, i) - rest_of(data, more, i)) / (2 * step) : 0;
        }
        row(WH_LIMIT_DELAY) = model.is_free[WH_LIMIT_DELAY] ? 1 : 0;
        if (data.weights[i] > 0) {
            const double root = std::sqrt(data.weights[i]);
            rows.add(root * row, root * (later > 0 ? later : rest_of(data, model, i)));
        }
    }
    rows.solve();
    return rows;
}

double squares_of(const data_t &data, const model_t &model) {
    double squares = 0;
    for (size_t i = 0; i < data.count; ++i) {
        if (data.weights[i] > 0) {
            const double rest = rest_of(data, model, i);
            squares += data.weights[i] * rest * rest;
        }
    }
    return squares;
}

model_t stepped(const model_t &from, const limit_rows_t::vector_t &step) {
    model_t to = from;
    for (int k = 0; k < parameter_count; ++k) {
        const double most = k == WH_LIMIT_DELAY ? HUGE_VAL : 1;
        to.p[k] += from.is_free[k] ? std::clamp(step(k), -most, most) : 0;
    }
    return to;
}

double peak_of(const data_t &data, const model_t &model, int limit) {
    const wh_limits_t limits = {std::exp(model.p[0]), std::exp(model.p[1]), std::exp(model.p[2])};
    double most = 0;
    for (size_t i = 0; i < data.count; ++i) {
        wh_profile_t profile;
        if (data.is_used[i] && wh_profile_plan(&profile, data.moves[i].distance, &limits) == WH_OK) {
            const double peaks[limit_count] = {profile.speed, profile.acceleration, profile.jerk};
            most = std::max(most, peaks[limit]);
        }
    }
    return most;
}

/* ------------------------------------------------------------------------------------------------- starts */

constexpr double factors[] = {1.02, 1.2, 1.6, 2.5, 5, 12, 40};
constexpr int factor_count = sizeof factors / sizeof factors[0];
constexpr int start_count = 4;

static double deviation_sum(const data_t &data, const model_t &model) {
    double sum = 0;
    for (size_t i = 0; i < data.count; ++i) {
        sum += data.is_used[i] ? std::abs(rest_of(data, model, i)) : 0;
    }
    return sum;
}

/* Keeps the best starts; the first is the very best. */
static void keep_start(model_t starts[start_count], const model_t &model) {
    for (int i = 0; i < start_count; ++i) {
        if (model.squares < starts[i].squares) {
            std::copy_backward(starts + i, starts + start_count - 1, starts + start_count);
            starts[i] = model;
            return;
        }
    }
}

/* The models on a grid whose times have the least sum of deviations; `free` says which limits exist. */
static void find_starts(const data_t &data, unsigned free, model_t starts[start_count]) {
    std::fill(starts, starts + start_count, model_t{{}, {}, HUGE_VAL});
    int most[limit_count];
    for (int k = 0; k < limit_count; ++k) {
        most[k] = (free >> k & 1U) != 0 ? factor_count : 1;
    }
    for (int at = 0; at < most[0] * most[1] * most[2]; ++at) {
        const int place[limit_count] = {at % most[0], at / most[0] % most[1], at / most[0] / most[1]};
        model_t model = {};
        for (int k = 0; k < limit_count; ++k) {
            model.is_free[k] = most[k] > 1;
            model.p[k] = model.is_free[k] ? std::log(data.scale[k] * factors[place[k]]) : data.beyond[k];
        }
        model.is_free[WH_LIMIT_DELAY] = data.with_delay;
        model.squares = deviation_sum(data, model);
        keep_start(starts, model);
    }
}

void fit_set(const data_t &data, unsigned set, model_t *best) {
    model_t starts[start_count];
    find_starts(data, set, starts);
    best->squares = HUGE_VAL;
    for (model_t &start : starts) {
        descend(data, &start, 40);
        *best = start.squares < best->squares ? start : *best;
    }
}

/* ------------------------------------------------------------------------------------------------- robust */

/* The standard deviation of the residuals by their median. */
static double deviation_of(data_t &data, const model_t &model) {
    for (size_t i = 0; i < data.count; ++i) {
        data.sizes[i] = std::abs(rest_of(data, model, i));
    }
    return std::max(median_to_sd * quantile(data, data.count, 0.5), least_sd_s);
}

/* Tukey's weights; returns the sum of his losses, from 0 to 1 each. */
static double weigh(data_t &data, const model_t &model, double deviation) {
    double loss = 0;
    for (size_t i = 0; i < data.count; ++i) {
        const double part = rest_of(data, model, i) / (tukey * deviation);
        const double left = part * part < 1 ? 1 - part * part : 0;
        data.weights[i] = left * left;
        loss += 1 - left * left * left;
    }
    return loss;
}

/* Sets weights of 1 for moves that are near enough, otherwise 0. Returns their number. */
static size_t set_aside(data_t &data, const model_t &model, double deviation) {
    size_t used = 0;
    for (size_t i = 0; i < data.count; ++i) {
        data.is_used[i] = std::abs(rest_of(data, model, i)) <= tukey * deviation;
        data.weights[i] = data.is_used[i] ? 1 : 0;
        used += data.is_used[i] ? 1 : 0;
    }
    return used;
}

/* The model of all three limits that most moves agree with, found by robust weights from the best
 * starts. */
static model_t find_agreed(data_t &data) {
    model_t starts[start_count];
    double deviation = HUGE_VAL;
    std::fill(data.is_used, data.is_used + data.count, true);
    find_starts(data, 7U, starts);
    for (model_t &start : starts) {
        for (int round = 0; round < 8; ++round) {
            (void)weigh(data, start, deviation_of(data, start));
            descend(data, &start, 6);
        }
        deviation = std::min(deviation, deviation_of(data, start));
    }
    const model_t *best = starts;
    double least = HUGE_VAL;
    for (const model_t &start : starts) {
        const double loss = weigh(data, start, deviation);
        if (loss < least) {
            least = loss;
            best = &start;
        }
    }
    return *best;
}

/* The least values that the quickest moves need; a twentieth of all exceed them. */
static void find_scales(data_t &data) {
    const double of_rest[limit_count] = {1, 4, 32}; /* d = v t, a t^2 / 4, j t^3 / 32 */
    for (int k = 0; k < limit_count; ++k) {
        for (size_t i = 0; i < data.count; ++i) {
            data.sizes[i] = of_rest[k] * data.moves[i].distance / std::pow(data.moves[i].seconds, k + 1);
        }
        data.scale[k] = quantile(data, data.count, 0.95);
        data.beyond[k] = std::log(*std::max_element(data.sizes, data.sizes + data.count)) + 4 + 6 * (k + 1);
    }
}

/* Looks for a better fit from those that lack limits: it sets each lacking limit to the moves' largest
 * value. */
static void improve(const data_t &data, model_t *all) {
    for (unsigned set = 1; set <= all_limits; ++set) {
        model_t model;
        fit_set(data, set, &model);
        const model_t lacking = model;
        for (int k = 0; k < limit_count; ++k) {
            model.p[k] = model.is_free[k] ? model.p[k] : std::log(nearly * peak_of(data, lacking, k));
            model.is_free[k] = true;
        }
        descend(data, &model, 60);
        *all = model.squares < all->squares ? model : *all;
    }
}

size_t fit_agreed(data_t &data, model_t *all, double *sd) {
    size_t used = data.count;
    find_scales(data);
    *all = find_agreed(data);
    *sd = deviation_of(data, *all);
    for (int round = 0; round < 4 && used >= WH_LIMITS_MOVES; ++round) {
        used = set_aside(data, *all, *sd);
        descend(data, all, 60);
        if (round == 0) {
            improve(data, all);
        }
        const double freedom = static_cast<double>(used) - (data.with_delay ? 4 : 3);
        *sd = std::max(std::sqrt(all->squares / std::max(freedom, 1.0)), least_sd_s);
    }
    return used;
}

} // namespace wh_estimate
