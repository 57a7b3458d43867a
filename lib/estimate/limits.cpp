#include "limits.h"

#include <algorithm>
#include <cstring>

#include "../motion/profile.h"
#include "limits_internal.hpp"
#include "reason_internal.hpp"

namespace {

using namespace wh_estimate;

constexpr double needed_variances = 25;
constexpr double largest_sd = 0.05;

/* ------------------------------------------------------------------------------------------- which limits */

/* Fits of each set of limits to the moves that are used, and the deviation of one time. */
struct fits_t {
    model_t of[all_limits + 1]; /* one for each set; [0] is none */
    size_t used;
    double sd, quantum;
};

/* Fits all sets that lack a limit; each also starts from the fit of all limits, near which it may lie. */
void fit_sets(const data_t &data, fits_t *fits) {
    for (unsigned set = 1; set < all_limits; ++set) {
        model_t model = fits->of[all_limits];
        for (int k = 0; k < limit_count; ++k) {
            model.is_free[k] = (set >> k & 1U) != 0;
            model.p[k] = model.is_free[k] ? model.p[k] : data.beyond[k];
        }
        descend(data, &model, 60);
        fit_set(data, set, &fits->of[set]);
        fits->of[set] = model.squares < fits->of[set].squares ? model : fits->of[set];
    }
}

/* The largest power of ten that divides all times: the resolution of the log in seconds. */
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

bool fits_well(const fits_t &fits, const model_t &model) {
    const double more = model.squares - fits.of[all_limits].squares;
    return more <= needed_variances * fits.sd * fits.sd;
}

/* True if no set of limits without this one fits. */
bool is_needed(const fits_t &fits, int limit) {
    bool is_needed = true;
    for (unsigned set = 1; set < all_limits; ++set) {
        is_needed = is_needed && ((set >> limit & 1U) != 0 || !fits_well(fits, fits.of[set]));
    }
    return is_needed;
}

/* The lowest value of a limit if the others follow, from a model that fits with the limit at
 * exp(model.p). */
double lowest_of(const data_t &data, const fits_t &fits, int limit, model_t model) {
    constexpr double far = 10;
    const double lowest = model.p[limit] - far;
    std::fill(model.is_free, model.is_free + limit_count, true);
    model.is_free[limit] = false;
    for (double step = 0.3; step > 0.005;) {
        model_t next = model;
        next.p[limit] -= step;
        descend(data, &next, 60);
        if (!fits_well(fits, next)) {
            step /= 2;
        } else if (next.p[limit] < lowest) {
            return 0;
        } else {
            model = next;
        }
    }
    return std::exp(model.p[limit] - 0.01);
}

/* A lower bound of a limit from every set that fits; 0 if one of them gives none. */
double at_least(const data_t &data, const fits_t &fits, int limit) {
    double least = HUGE_VAL;
    for (unsigned set = 1; set <= all_limits; ++set) {
        model_t model = fits.of[set];
        if (fits_well(fits, model)) {
            const double peak = peak_of(data, model, limit);
            model.p[limit] = std::min(model.p[limit], std::log(peak));
            least = std::min(least, lowest_of(data, fits, limit, model));
        }
    }
    return least;
}

/* Fills in standard deviations, including the effect of rounding all times in one direction. */
void fill_in(const data_t &data, const fits_t &fits, wh_limits_estimate_t *estimate) {
    const model_t &all = fits.of[all_limits];
    const limit_rows_t rows = rows_of(data, all);
    const limit_rows_t::vector_t rounded =
        fits.quantum > 0 ? rows_of(data, all, fits.quantum / 2).step(0) : limit_rows_t::vector_t::Zero();
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

/* ------------------------------------------------------------------------------------------ what is wrong */

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

/* True if the residuals of neighbours in distance are alike, which happens if the times follow another
 * law. */
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
    return fewer > needed_variances * variance && std::abs(delay) > std::max(fits.quantum, least_sd_s) ? delay
                                                                                                       : 0;
}

wh_status_t judge(const data_t &data, const fits_t &fits, const size_t *order,
                  wh_limits_estimate_t *estimate) {
    const double delay = find_delay(data, fits);
    if (delay != 0) {
        tell(estimate->reason,
             "each time seems to have %.3g s that are not of its profile: fit the delay as well", delay);
        return WH_STATUS_NO_FIT;
    }
    if (is_of_another_law(data, fits, order)) {
        tell(estimate->reason,
             "the times depend on the distance in another way than a jerk-limited profile's: residuals of "
             "%.3g s rms that go with the distance",
             estimate->rms);
        return WH_STATUS_NO_FIT;
    }
    return WH_OK;
}

/* -------------------------------------------------------------------------------------- which are missing */

/* The shortest distance at which the speed is reached: the part of rise and fall, without the cruise. */
double reaching_distance(const wh_limits_estimate_t &estimate) {
    const double speed = estimate.fitted[WH_LIMIT_SPEED];
    return speed * (wh_limits_seconds(&estimate, estimate.longest) - estimate.fitted[WH_LIMIT_DELAY]) -
           estimate.longest;
}

/* No profile with this speed and jerk accelerates more, however long its move is. */
double never_reached(const wh_limits_estimate_t &estimate) {
    return std::sqrt(estimate.fitted[WH_LIMIT_SPEED] * estimate.fitted[WH_LIMIT_JERK]);
}

void tell_missing_of_acceleration(wh_limits_estimate_t *estimate, bool has_speed, bool has_jerk) {
    if (has_speed && !has_jerk) {
        tell(estimate->reason, "acceleration: moves too short to reach the speed, below %.4g; ",
             reaching_distance(*estimate));
    } else if (has_speed) {
        tell(estimate->reason,
             "acceleration: no move reaches it before the speed: surely not below %.4g, and any from %.6g on "
             "gives the times of these limits; ",
             estimate->at_least[WH_LIMIT_ACCELERATION], never_reached(*estimate));
    } else {
        tell(estimate->reason, "acceleration: moves of other lengths, longer than %.4g first; ",
             estimate->longest);
    }
}

void tell_missing(wh_limits_estimate_t *estimate) {
    const wh_estimate_value_t *values = estimate->values;
    const bool has_speed = values[WH_LIMIT_SPEED].is_determined;
    const bool has_jerk = values[WH_LIMIT_JERK].is_determined;
    if (!has_speed) {
        tell(estimate->reason, "speed: moves that reach it, longer than %.4g; ", estimate->longest);
    }
    if (!values[WH_LIMIT_ACCELERATION].is_determined) {
        tell_missing_of_acceleration(estimate, has_speed, has_jerk);
    }
    if (!has_jerk) {
        tell(estimate->reason, "jerk: short moves, below %.4g; ", estimate->shortest);
    }
    const size_t length = std::strlen(estimate->reason);
    estimate->reason[length >= 2 ? length - 2 : 0] = '\0';
}

/* ---------------------------------------------------------------------------------------------- the whole */

wh_status_t check(const wh_timed_move_t *moves, size_t count, wh_limits_estimate_t *estimate) {
    if (count > WH_LIMITS_MOST_MOVES) {
        tell(estimate->reason, "%zu moves, of at most %d", count, WH_LIMITS_MOST_MOVES);
        return WH_STATUS_BAD_CAPACITY;
    }
    for (size_t i = 0; i < count; ++i) {
        const double d = moves[i].distance;
        const double s = moves[i].seconds;
        if (!(d > 0 && d < 1e9 && s > 0 && s < 1e9)) {
            tell(estimate->reason, "move %zu: a distance and a time above 0 are expected", i + 1);
            return WH_STATUS_OUT_OF_RANGE;
        }
    }
    if (count < WH_LIMITS_MOVES) {
        tell(estimate->reason, "%zu of at least %d moves", count, WH_LIMITS_MOVES);
        return WH_STATUS_TOO_FEW_POINTS;
    }
    return WH_OK;
}

wh_status_t fit(data_t &data, fits_t &fits, wh_limits_estimate_t *estimate) {
    fits.used = wh_estimate::fit_agreed(data, &fits.of[all_limits], &fits.sd);
    estimate->used = fits.used;
    estimate->set_aside = data.count - fits.used;
    if (static_cast<double>(estimate->set_aside) > WH_LIMITS_ASIDE * static_cast<double>(data.count)) {
        tell(estimate->reason, "%zu of %zu times agree with no profile that the others agree with",
             estimate->set_aside, data.count);
        return WH_STATUS_NO_FIT;
    }
    if (fits.used < WH_LIMITS_MOVES) {
        tell(estimate->reason, "%zu of at least %d moves, %zu more were set aside", fits.used,
             WH_LIMITS_MOVES, estimate->set_aside);
        return WH_STATUS_TOO_FEW_POINTS;
    }
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
    if (estimate->rms < fits.quantum / 2) { /* equal moves have equal rounding errors */
        fits.sd *= std::sqrt(static_cast<double>(fits.used) /
                             static_cast<double>(count_distances(data, fits, order)));
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
