#include <algorithm>

#include "geometry_internal.hpp"
#include "reason_internal.hpp"

namespace wh_estimate {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double rare_of(double freedom) {
    constexpr double five_squared = 25;
    const double part = (freedom - 5.0 / 6) / ((freedom - 2.0 / 3) * (freedom - 2.0 / 3));
    return freedom > 2 ? std::sqrt(freedom * std::expm1(five_squared * part)) : HUGE_VAL;
}

namespace {

constexpr double heading_misfit = 0.02; /* rad */
/* Controllers tell angles to 0.001 degrees: headings that agree to their rounding have this spread, rad. */
constexpr double rounding = 1e-5;
constexpr double most_scale_sds = 6;

/* The zero of yaw by a touch's heading: the direction of the tool's x as seen from the turned column, minus
 * theta and yaw. */
double yaw_zero_of(const double *p, const wh_touch_t &touch) {
    const Matrix3d tilt = tilt_of(p);
    const double x = std::cos(touch.heading);
    const double y = std::sin(touch.heading);
    const double z = -(tilt(0, 2) * x + tilt(1, 2) * y) / tilt(2, 2); /* level with the blade */
    const Vector3d ahead = tilt.transpose() * Vector3d(x, y, z);
    const double theta = p[WH_GEOMETRY_SCALE + WH_AXIS_THETA] * touch.axes[WH_AXIS_THETA] + p[theta_zero];
    const double yaw = p[WH_GEOMETRY_SCALE + WH_AXIS_YAW] * touch.axes[WH_AXIS_YAW];
    return std::remainder(std::atan2(ahead(1), ahead(0)) - theta - yaw, full_turn);
}

/* The axes that turn the tool, whose scales may still be wrong. */
constexpr int turning[2] = {WH_AXIS_THETA, WH_AXIS_YAW};
constexpr int slope_rounds = 3;

/* The headings' values, each minus the median of all. */
struct headings_t {
    double rests[WH_GEOMETRY_MOST_TOUCHES];
    double sizes[WH_GEOMETRY_MOST_TOUCHES]; /* to be sorted */
    size_t touches[WH_GEOMETRY_MOST_TOUCHES];
    bool is_used[WH_GEOMETRY_MOST_TOUCHES];
    size_t count, used;
    double middle, mean, sd;
    double mean_sd;   /* of the median and the mean together */
    double slopes[2]; /* their dependence on the turning axes; it is removed from the rests */
};

double middle_of(double *values, size_t count) {
    std::nth_element(values, values + count / 2, values + count);
    return values[count / 2];
}

/* Subtracts the median from the rests. */
void centre_rests(headings_t *headings) {
    std::copy(headings->rests, headings->rests + headings->count, headings->sizes);
    const double middle = middle_of(headings->sizes, headings->count);
    for (size_t i = 0; i < headings->count; ++i) {
        headings->rests[i] -= middle;
        headings->sizes[i] = std::abs(headings->rests[i]);
    }
    headings->middle += middle;
}

void read_headings(const touches_t &data, const double *p, headings_t *headings) {
    double x = 0;
    double y = 0;
    for (size_t i = 0; i < data.count; ++i) {
        if (data.is_used[i] && !std::isnan(data.touches[i].heading)) {
            headings->rests[headings->count] = yaw_zero_of(p, data.touches[i]);
            headings->touches[headings->count] = i;
            x += std::cos(headings->rests[headings->count]);
            y += std::sin(headings->rests[headings->count]);
            ++headings->count;
        }
    }
    const double about = std::atan2(y, x);
    for (size_t i = 0; i < headings->count; ++i) {
        headings->rests[i] = std::remainder(headings->rests[i] - about, full_turn);
    }
    headings->middle = about;
    if (headings->count > 0) {
        centre_rests(headings);
    }
}

/* Sets headings aside, and takes the mean of the others. */
void average(headings_t *headings) {
    const auto count = static_cast<double>(headings->count);
    headings->sd = 1.4826 * (1 + 5 / count) * middle_of(headings->sizes, headings->count);
    headings->sd = std::max(headings->sd, rounding);
    headings->mean = 0;
    for (int round = 0; round < 4; ++round) {
        const double most = WH_GEOMETRY_ASIDE_SDS * headings->sd;
        const double centre = headings->mean;
        double sum = 0;
        double squares = 0;
        headings->used = 0;
        for (size_t i = 0; i < headings->count; ++i) {
            const double rest = headings->rests[i];
            headings->is_used[i] = std::abs(rest - centre) <= most;
            headings->used += headings->is_used[i] ? 1 : 0;
            sum += headings->is_used[i] ? rest : 0;
            squares += headings->is_used[i] ? rest * rest : 0;
        }
        const auto used = static_cast<double>(headings->used);
        headings->mean = sum / used;
        headings->sd = std::sqrt((squares - sum * headings->mean) / std::max(used - 1, 1.0));
        headings->sd = std::max(headings->sd, 1e-9);
    }
    headings->mean_sd = headings->sd / std::sqrt(static_cast<double>(headings->used));
}

/* The touches determine the scales of the turning axes with some accuracy. The headings add a slope to a
 * scale, and the zero of yaw refers to the place where yaw and theta are 0. If the touches do not determine
 * a scale, the headings alone determine the slope. */
void take_slopes(const touches_t &data, const wh_geometry_estimate_t &estimate, headings_t *headings) {
    Matrix3d products = Matrix3d::Zero();
    Vector3d sums = Vector3d::Zero();
    for (size_t i = 0; i < headings->count; ++i) {
        const double *axes = data.touches[headings->touches[i]].axes;
        const Vector3d by(1, axes[turning[0]], axes[turning[1]]);
        products += headings->is_used[i] ? Matrix3d(by.lazyProduct(by.transpose())) : Matrix3d::Zero();
        sums += headings->is_used[i] ? Vector3d(by * headings->rests[i]) : Vector3d::Zero();
    }
    const double variance = headings->sd * headings->sd;
    for (int k = 0; k < 2; ++k) {
        const double sd = std::max(estimate.values[WH_GEOMETRY_SCALE + turning[k]].sd, 1e-12);
        const double weight = std::isfinite(sd) ? variance / (sd * sd) : 0;
        products(k + 1, k + 1) += weight;
        sums(k + 1) -= weight * headings->slopes[k];
    }
    const double size = products(0, 0) * products(1, 1) * products(2, 2);
    if (!(products.determinant() > 1e-12 * size)) { /* an axis did not move */
        headings->mean_sd = HUGE_VAL;
        return;
    }
    const Matrix3d inverse = products.inverse();
    const Vector3d step = inverse.lazyProduct(sums); /* a general product would link to the heap */
    for (size_t i = 0; i < headings->count; ++i) {
        const double *axes = data.touches[headings->touches[i]].axes;
        headings->rests[i] -= step(1) * axes[turning[0]] + step(2) * axes[turning[1]];
    }
    headings->slopes[0] += step(1);
    headings->slopes[1] += step(2);
    centre_rests(headings);
    average(headings);
    headings->mean_sd = std::sqrt(variance * inverse(0, 0));
}

/* True if a slope exceeds the accuracy with which the touches determine the scale of its axis. */
bool contradicts_scale(const wh_geometry_estimate_t &estimate, const headings_t &headings) {
    bool is_off = false;
    for (int k = 0; k < 2; ++k) {
        const double sd = estimate.values[WH_GEOMETRY_SCALE + turning[k]].sd;
        is_off = is_off || (std::isfinite(sd) && std::abs(headings.slopes[k]) > most_scale_sds * sd + 1e-9);
    }
    return is_off;
}

/* True if the headings depend on an axis, which the mean would not show. */
bool goes_with(const touches_t &data, const headings_t &headings, int axis) {
    double products = 0;
    double spread = 0;
    double mean = 0;
    for (size_t i = 0; i < headings.count; ++i) {
        mean += headings.is_used[i] ? data.touches[headings.touches[i]].axes[axis] : 0;
    }
    mean /= static_cast<double>(headings.used);
    for (size_t i = 0; i < headings.count; ++i) {
        const double off = data.touches[headings.touches[i]].axes[axis] - mean;
        products += headings.is_used[i] ? off * headings.rests[i] : 0;
        spread += headings.is_used[i] ? off * off : 0;
    }
    const double freedom = static_cast<double>(headings.used) - 2;
    const double left = headings.sd * headings.sd * (freedom + 1) - products * products / spread;
    return spread > 1e-6 && products * products / spread > left / freedom * std::pow(rare_of(freedom), 2);
}

wh_status_t judge_headings(const touches_t &data, const headings_t &headings,
                           wh_geometry_estimate_t *estimate) {
    if (static_cast<double>(headings.count - headings.used) >
        WH_GEOMETRY_ASIDE * static_cast<double>(headings.count)) {
        tell(estimate->reason, "%zu of %zu headings disagree with the others", headings.count - headings.used,
             headings.count);
        return WH_STATUS_NO_FIT;
    }
    const bool contradict = estimate->has_scales ? contradicts_scale(*estimate, headings)
                                                 : goes_with(data, headings, WH_AXIS_YAW) ||
                                                       goes_with(data, headings, WH_AXIS_THETA);
    if (headings.sd > heading_misfit || contradict) {
        tell(estimate->reason,
             "the headings do not go with theta and yaw: residuals of %.3g degrees rms; is yaw told the "
             "other way round, or its scale off?",
             headings.sd * 360 / full_turn);
        return WH_STATUS_NO_FIT;
    }
    return WH_OK;
}

} // namespace

wh_status_t fit_headings(touches_t &data, wh_geometry_estimate_t *estimate) {
    headings_t headings = {};
    wh_estimate_value_t &zero = estimate->values[yaw_zero];
    const wh_estimate_value_t &theta = estimate->values[theta_zero];
    read_headings(data, estimate->fitted, &headings);
    if (headings.count < WH_GEOMETRY_HEADINGS) {
        return WH_OK;
    }
    average(&headings);
    for (int round = 0; estimate->has_scales && round < slope_rounds; ++round) {
        take_slopes(data, *estimate, &headings);
    }
    estimate->headings = headings.used;
    estimate->headings_aside = headings.count - headings.used;
    estimate->heading_rms = headings.sd;
    for (size_t i = 0; i < headings.count; ++i) {
        data.touches[headings.touches[i]].is_heading_set_aside = !headings.is_used[i];
    }
    const wh_status_t status = judge_headings(data, headings, estimate);
    zero.value = std::remainder(headings.middle + headings.mean, full_turn);
    zero.sd = std::hypot(headings.mean_sd, theta.sd);
    zero.is_determined = theta.is_determined && zero.sd <= WH_GEOMETRY_ANGLE_SD;
    estimate->fitted[yaw_zero] = zero.value;
    return status;
}

} // namespace wh_estimate
