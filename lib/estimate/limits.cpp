#include "limits.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "../motion/profile.h"
#include "rows_internal.hpp"

namespace {

constexpr int limit_count = 3;
constexpr int parameter_count = WH_LIMIT_PARAMETERS;
constexpr double tukey = 4.685;
constexpr double median_to_sd = 1.4826;
constexpr double needed_variances = 25;
constexpr double largest_sd = 0.05;
constexpr double least_sd_s = 1e-7; /* no clock of a log tells less */

using rows_t = wh_estimate::rows_t<parameter_count>;

/* The limits' logarithms, and the delay. */
struct model_t {
    double p[parameter_count];
    bool is_free[parameter_count];
    double squares; /* of the weighted residuals */
};

/* What all fits of an axis share. */
struct data_t {
    wh_timed_move_t *moves;
    size_t count;
    bool with_delay;
    double scale[limit_count];  /* of the limits: what the quickest moves need at least */
    double beyond[limit_count]; /* logarithm of a limit that no move meets */
    double weights[WH_LIMITS_MOST_MOVES];
    double sizes[WH_LIMITS_MOST_MOVES]; /* to be sorted */
    bool is_used[WH_LIMITS_MOST_MOVES];
};

double seconds_of(const double p[parameter_count], double distance) {
    const wh_limits_t limits = {std::exp(p[0]), std::exp(p[1]), std::exp(p[2])};
    wh_profile_t profile;
    return wh_profile_plan(&profile, distance, &limits) == WH_OK ? profile.duration + p[3] : HUGE_VAL;
}

double rest_of(const data_t &data, const model_t &model, size_t i) {
    return data.moves[i].seconds - seconds_of(model.p, data.moves[i].distance);
}

/* The value that a part of the first `count` sizes does not exceed. */
double quantile(data_t &data, size_t count, double part) {
    const auto place = static_cast<size_t>(part * static_cast<double>(count - 1));
    std::nth_element(data.sizes, data.sizes + place, data.sizes + count);
    return data.sizes[place];
}

/* --------------------------------------------------------------------------------------------------- descent */

/* The equations of a step, towards the times, or towards what all of them would be if they were `later`. */
rows_t rows_of(const data_t &data, const model_t &model, double later = 0) {
    constexpr double step = 1e-6;
    rows_t rows;
    for (size_t i = 0; i < data.count; ++i) {
        rows_t::vector_t row = rows_t::vector_t::Zero();
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

model_t stepped(const model_t &from, const rows_t::vector_t &step) {
    model_t to = from;
    for (int k = 0; k < parameter_count; ++k) {
        const double most = k == WH_LIMIT_DELAY ? HUGE_VAL : 1;
        to.p[k] += from.is_free[k] ? std::clamp(step(k), -most, most) : 0;
    }
    return to;
}

/* Levenberg and Marquardt's, with the weights as they are. */
void descend(const data_t &data, model_t *model, int rounds) {
    double damping = 1e-3;
    model->squares = squares_of(data, *model);
    for (int round = 0; round < rounds; ++round) {
        const rows_t rows = rows_of(data, *model);
        model_t next = *model;
        for (bool is_better = false; !is_better; damping *= is_better ? 0.1 : 10) {
            if (damping > 1e6) {
                return;
            }
            next = stepped(*model, rows.step(damping));
            next.squares = squares_of(data, next);
            is_better = next.squares < model->squares;
        }
        const bool is_done = next.squares > model->squares * (1 - 1e-12);
        *model = next;
        if (is_done) {
            return;
        }
    }
}

/* ---------------------------------------------------------------------------------------------------- starts */

constexpr double factors[] = {1.02, 1.2, 1.6, 2.5, 5, 12, 40};
constexpr int factor_count = sizeof factors / sizeof factors[0];
constexpr int start_count = 4;

double deviation_sum(const data_t &data, const model_t &model) {
    double sum = 0;
    for (size_t i = 0; i < data.count; ++i) {
        sum += data.is_used[i] ? std::abs(rest_of(data, model, i)) : 0;
    }
    return sum;
}

/* Keeps the best, the first being the very best. */
void keep_start(model_t starts[start_count], const model_t &model) {
    for (int i = 0; i < start_count; ++i) {
        if (model.squares < starts[i].squares) {
            std::copy_backward(starts + i, starts + start_count - 1, starts + start_count);
            starts[i] = model;
            return;
        }
    }
}

/* The models on a grid whose times deviate least in sum: `free` says which limits there are. */
void find_starts(const data_t &data, unsigned free, model_t starts[start_count]) {
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

/* ---------------------------------------------------------------------------------------------------- robust */

/* The standard deviation of the residuals by their median. */
double deviation_of(data_t &data, const model_t &model) {
    for (size_t i = 0; i < data.count; ++i) {
        data.sizes[i] = std::abs(rest_of(data, model, i));
    }
    return std::max(median_to_sd * quantile(data, data.count, 0.5), least_sd_s);
}

/* Tukey's weights; returns the sum of his losses, from 0 to 1 each. */
double weigh(data_t &data, const model_t &model, double deviation) {
    double loss = 0;
    for (size_t i = 0; i < data.count; ++i) {
        const double part = rest_of(data, model, i) / (tukey * deviation);
        const double left = part * part < 1 ? 1 - part * part : 0;
        data.weights[i] = left * left;
        loss += 1 - left * left * left;
    }
    return loss;
}

/* Weights of 1 for what is near enough, else 0. Returns how many are. */
size_t set_aside(data_t &data, const model_t &model, double deviation) {
    size_t used = 0;
    for (size_t i = 0; i < data.count; ++i) {
        data.is_used[i] = std::abs(rest_of(data, model, i)) <= tukey * deviation;
        data.weights[i] = data.is_used[i] ? 1 : 0;
        used += data.is_used[i] ? 1 : 0;
    }
    return used;
}

/* The model of all three limits that most moves agree with, by robust weights from the best starts. */
model_t find_agreed(data_t &data) {
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

/* ---------------------------------------------------------------------------------------------- which limits */

constexpr unsigned all_limits = 7U;

/* Fits of each set of limits to the moves that are used, and the deviation of one time. */
struct fits_t {
    model_t of[all_limits + 1]; /* by set; [0] is none */
    size_t used;
    double sd, quantum;
};

void fit_set(const data_t &data, unsigned set, model_t *best) {
    model_t starts[start_count];
    find_starts(data, set, starts);
    best->squares = HUGE_VAL;
    for (model_t &start : starts) {
        descend(data, &start, 40);
        *best = start.squares < best->squares ? start : *best;
    }
}

/* All sets; that of all limits is no worse than any other. */
void fit_sets(const data_t &data, fits_t *fits) {
    model_t &all = fits->of[all_limits];
    descend(data, &all, 60);
    for (unsigned set = 1; set < all_limits; ++set) {
        fit_set(data, set, &fits->of[set]);
        model_t whole = fits->of[set];
        std::fill(whole.is_free, whole.is_free + limit_count, true);
        descend(data, &whole, 40);
        all = whole.squares < all.squares ? whole : all;
    }
}

/* The largest power of ten of which all times are multiples: what the log tells of a second. */
double quantum_of(const data_t &data) {
    for (double per_second = 1; per_second < 1e6; per_second *= 10) {
        bool is_multiple = true;
        for (size_t i = 0; is_multiple && i < data.count; ++i) {
            const double ticks = data.moves[i].seconds * per_second;
            is_multiple = std::abs(ticks - std::round(ticks)) < 1e-6;
        }
        if (is_multiple) {
            return 1 / per_second;
        }
    }
    return 0;
}

bool fits_well(const fits_t &fits, unsigned set) {
    const double more = fits.of[set].squares - fits.of[all_limits].squares;
    return more <= needed_variances * fits.sd * fits.sd;
}

/* No set of limits without this one fits. */
bool is_needed(const fits_t &fits, int limit) {
    bool is_needed = true;
    for (unsigned set = 1; set < all_limits; ++set) {
        is_needed = is_needed && ((set >> limit & 1U) != 0 || !fits_well(fits, set));
    }
    return is_needed;
}

/* The largest speed, acceleration or jerk in the moves that are used. */
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

/* What every set that fits says the limit is at least; 0 if none says anything. */
double at_least(const data_t &data, const fits_t &fits, int limit) {
    double least = HUGE_VAL;
    for (unsigned set = 1; set <= all_limits; ++set) {
        if (fits_well(fits, set)) {
            least = std::min(least, peak_of(data, fits.of[set], limit));
        }
    }
    return std::log(least) > data.beyond[limit] - 1 ? 0 : least;
}

/* Standard deviations, with what it would do if all times were rounded the same way. */
void fill_in(const data_t &data, const fits_t &fits, wh_limits_estimate_t *estimate) {
    const model_t &all = fits.of[all_limits];
    const rows_t rows = rows_of(data, all);
    const rows_t::vector_t rounded =
        fits.quantum > 0 ? rows_of(data, all, fits.quantum / 2).step(0) : rows_t::vector_t::Zero();
    for (int k = 0; k < parameter_count; ++k) {
        wh_estimate_value_t &value = estimate->values[k];
        const bool is_limit = k < limit_count;
        const double sd = std::hypot(fits.sd * rows.deviation(k), rounded(k));
        value.value = is_limit ? std::exp(all.p[k]) : all.p[k];
        value.sd = is_limit ? value.value * sd : sd;
        value.is_determined =
            is_limit ? is_needed(fits, k) && sd < largest_sd : all.is_free[k] && std::isfinite(sd);
        estimate->fitted[k] = value.value;
        estimate->at_least[k] = is_limit && !value.is_determined ? at_least(data, fits, k) : 0;
    }
}

/* ------------------------------------------------------------------------------------------------ what is wrong */

__attribute__((format(printf, 2, 3))) void tell(wh_limits_estimate_t *estimate, const char *format, ...) {
    const size_t length = std::strlen(estimate->reason);
    va_list arguments;
    va_start(arguments, format);
    (void)std::vsnprintf(estimate->reason + length, sizeof estimate->reason - length, format, arguments);
    va_end(arguments);
}

/* The moves' indices, the shortest first. */
void sort_used(const data_t &data, size_t *order) {
    size_t count = 0;
    for (size_t i = 0; i < data.count; ++i) {
        if (data.is_used[i]) {
            order[count++] = i;
        }
    }
    std::sort(order, order + count, [&data](size_t a, size_t b) {
        const double d = data.moves[a].distance;
        const double e = data.moves[b].distance;
        return d < e || (!(e < d) && a < b);
    });
}

/* True if the residuals of neighbours in distance are alike, as they are where the times follow another law. */
bool is_of_another_law(const data_t &data, const fits_t &fits, const size_t *order) {
    const model_t &all = fits.of[all_limits];
    double products = 0;
    for (size_t i = 1; i < fits.used; ++i) {
        products += rest_of(data, all, order[i - 1]) * rest_of(data, all, order[i]);
    }
    const double rms = std::sqrt(all.squares / static_cast<double>(fits.used));
    return rms > std::max(fits.quantum / 2, 10 * least_sd_s) &&
           products / all.squares > 5 / std::sqrt(static_cast<double>(fits.used));
}

size_t count_distances(const data_t &data, const fits_t &fits, const size_t *order) {
    size_t count = 1;
    for (size_t i = 1; i < fits.used; ++i) {
        count += data.moves[order[i]].distance > data.moves[order[i - 1]].distance * (1 + 1e-9) ? 1 : 0;
    }
    return count;
}

/* The delay that the times seem to have although none is fitted; 0 if they seem to have none. */
double find_delay(const data_t &data, const fits_t &fits) {
    model_t delayed = fits.of[all_limits];
    if (data.with_delay) {
        return 0;
    }
    delayed.is_free[WH_LIMIT_DELAY] = true;
    descend(data, &delayed, 60);
    const double fewer = fits.of[all_limits].squares - delayed.squares;
    const double delay = delayed.p[WH_LIMIT_DELAY];
    const double variance = delayed.squares / static_cast<double>(fits.used - limit_count);
    return fewer > needed_variances * variance && std::abs(delay) > std::max(fits.quantum, least_sd_s) ? delay : 0;
}

wh_status_t judge(const data_t &data, const fits_t &fits, const size_t *order, wh_limits_estimate_t *estimate) {
    const double delay = find_delay(data, fits);
    if (delay != 0) {
        tell(estimate, "each time seems to have %.3g s that are not of its profile: fit the delay as well", delay);
        return WH_STATUS_NO_FIT;
    }
    if (is_of_another_law(data, fits, order)) {
        tell(estimate, "the times depend on the distance in another way than a jerk-limited profile's: residuals of "
                       "%.3g s rms that go with the distance", estimate->rms);
        return WH_STATUS_NO_FIT;
    }
    return WH_OK;
}

/* ------------------------------------------------------------------------------------------- which are missing */

/* The shortest distance at which the speed is reached; what rises and falls takes but for the cruise. */
double reaching_distance(const wh_limits_estimate_t &estimate) {
    const double speed = estimate.fitted[WH_LIMIT_SPEED];
    return speed * (wh_limits_seconds(&estimate, estimate.longest) - estimate.fitted[WH_LIMIT_DELAY]) -
           estimate.longest;
}

void tell_missing_of_acceleration(wh_limits_estimate_t *estimate, bool has_speed, bool has_jerk) {
    if (has_speed && !has_jerk) {
        tell(estimate, "acceleration: moves too short to reach the speed, below %.4g; ", reaching_distance(*estimate));
    } else if (has_speed) {
        tell(estimate, "acceleration: no move reaches it before the speed, so any from %.4g on gives these times; ",
             estimate->at_least[WH_LIMIT_ACCELERATION]);
    } else {
        tell(estimate, "acceleration: moves of other lengths, longer than %.4g first; ", estimate->longest);
    }
}

void tell_missing(wh_limits_estimate_t *estimate) {
    const wh_estimate_value_t *values = estimate->values;
    const bool has_speed = values[WH_LIMIT_SPEED].is_determined;
    const bool has_jerk = values[WH_LIMIT_JERK].is_determined;
    if (!has_speed) {
        tell(estimate, "speed: moves that reach it, longer than %.4g; ", estimate->longest);
    }
    if (!values[WH_LIMIT_ACCELERATION].is_determined) {
        tell_missing_of_acceleration(estimate, has_speed, has_jerk);
    }
    if (!has_jerk) {
        tell(estimate, "jerk: short moves, below %.4g; ", estimate->shortest);
    }
    const size_t length = std::strlen(estimate->reason);
    estimate->reason[length >= 2 ? length - 2 : 0] = '\0';
}

/* ------------------------------------------------------------------------------------------------- the whole */

wh_status_t check(const wh_timed_move_t *moves, size_t count, wh_limits_estimate_t *estimate) {
    if (count > WH_LIMITS_MOST_MOVES) {
        tell(estimate, "%zu moves, of at most %d", count, WH_LIMITS_MOST_MOVES);
        return WH_STATUS_BAD_CAPACITY;
    }
    for (size_t i = 0; i < count; ++i) {
        const double d = moves[i].distance;
        const double s = moves[i].seconds;
        if (!(d > 0 && d < 1e9 && s > 0 && s < 1e9)) {
            tell(estimate, "move %zu: a distance and a time above 0 are expected", i + 1);
            return WH_STATUS_OUT_OF_RANGE;
        }
    }
    if (count < WH_LIMITS_MOVES) {
        tell(estimate, "%zu of at least %d moves", count, WH_LIMITS_MOVES);
        return WH_STATUS_TOO_FEW_POINTS;
    }
    return WH_OK;
}

/* What the quickest moves need at least, those that a twentieth of all exceed. */
void find_scales(data_t &data) {
    const double of_rest[limit_count] = {1, 4, 32}; /* d = v t, a t^2 / 4, j t^3 / 32 */
    for (int k = 0; k < limit_count; ++k) {
        for (size_t i = 0; i < data.count; ++i) {
            data.sizes[i] = of_rest[k] * data.moves[i].distance / std::pow(data.moves[i].seconds, k + 1);
        }
        data.scale[k] = quantile(data, data.count, 0.95);
        data.beyond[k] = std::log(*std::max_element(data.sizes, data.sizes + data.count)) + 4 + 6 * (k + 1);
    }
}

wh_status_t fit(data_t &data, fits_t &fits, wh_limits_estimate_t *estimate) {
    model_t &all = fits.of[all_limits];
    find_scales(data);
    all = find_agreed(data);
    double deviation = deviation_of(data, all);
    for (int round = 0; round < 4; ++round) {
        fits.used = set_aside(data, all, deviation);
        if (fits.used < WH_LIMITS_MOVES) {
            break;
        }
        descend(data, &all, 40);
        const double freedom = static_cast<double>(fits.used) - (data.with_delay ? 4 : 3);
        deviation = std::max(std::sqrt(all.squares / freedom), least_sd_s);
    }
    estimate->used = fits.used;
    estimate->set_aside = data.count - fits.used;
    if (static_cast<double>(estimate->set_aside) > WH_LIMITS_ASIDE * static_cast<double>(data.count)) {
        tell(estimate, "%zu of %zu times agree with no profile that the others agree with", estimate->set_aside, data.count);
        return WH_STATUS_NO_FIT;
    }
    if (fits.used < WH_LIMITS_MOVES) {
        tell(estimate, "%zu of at least %d moves, %zu more were set aside", fits.used, WH_LIMITS_MOVES, estimate->set_aside);
        return WH_STATUS_TOO_FEW_POINTS;
    }
    fits.sd = deviation;
    return WH_OK;
}

wh_status_t conclude(data_t &data, fits_t &fits, wh_limits_estimate_t *estimate) {
    size_t order[WH_LIMITS_MOST_MOVES];
    sort_used(data, order);
    fits.quantum = quantum_of(data);
    fit_sets(data, &fits);
    estimate->rms = std::sqrt(fits.of[all_limits].squares / static_cast<double>(fits.used));
    estimate->shortest = data.moves[order[0]].distance;
    estimate->longest = data.moves[order[fits.used - 1]].distance;
    if (estimate->rms < fits.quantum / 2) { /* equal moves have equal errors of rounding */
        fits.sd *= std::sqrt(static_cast<double>(fits.used) / static_cast<double>(count_distances(data, fits, order)));
    }
    const wh_status_t status = judge(data, fits, order, estimate);
    if (status != WH_OK) {
        return status;
    }
    fill_in(data, fits, estimate);
    bool is_any = false;
    bool is_missing = false;
    for (int k = 0; k < limit_count; ++k) {
        is_any = is_any || estimate->values[k].is_determined;
        is_missing = is_missing || !estimate->values[k].is_determined;
    }
    if (is_missing) {
        tell_missing(estimate);
    }
    return is_any ? WH_OK : WH_STATUS_NOT_DETERMINED;
}

} // namespace

double wh_limits_seconds(const wh_limits_estimate_t *estimate, double distance) {
    const wh_limits_t limits = {estimate->fitted[0], estimate->fitted[1], estimate->fitted[2]};
    wh_profile_t profile;
    const bool is_planned = wh_profile_plan(&profile, distance, &limits) == WH_OK;
    return is_planned ? profile.duration + estimate->fitted[WH_LIMIT_DELAY] : std::nan("");
}

wh_status_t wh_limits_estimate(wh_timed_move_t *moves, size_t count, bool with_delay,
                               wh_limits_estimate_t *estimate) {
    if (moves == nullptr || estimate == nullptr) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    *estimate = wh_limits_estimate_t();
    estimate->status = check(moves, count, estimate);
    if (estimate->status == WH_OK) {
        data_t data;
        fits_t fits = {};
        data.moves = moves;
        data.count = count;
        data.with_delay = with_delay;
        estimate->status = fit(data, fits, estimate);
        for (size_t i = 0; i < count; ++i) {
            moves[i].is_set_aside = !data.is_used[i];
        }
        if (estimate->status == WH_OK) {
            estimate->status = conclude(data, fits, estimate);
        }
    }
    return estimate->status;
}
