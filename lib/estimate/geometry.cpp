#include "geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>

#include "../math/trig.h"
#include "geometry_internal.hpp"
#include "reason_internal.hpp"

namespace {

using namespace wh_estimate;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double most_pull = 100; /* at the arm's length: factor of an error of the touches in a number */
constexpr double nearly_alone =
    0.3; /* of its error that the fit takes over, for a touch that may be the only one */

const char *const axis_names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};

/* A fit that most touches agree with. */
struct agreed_t {
    geometry_t model;
    geometry_rows_t rows;
    double sd;    /* of a coordinate of one touch */
    double reach; /* rms distance of the touching point from the column */
};

/* ------------------------------------------------------------------------------------------- what is told */

bool is_angle(int k) {
    return k == WH_GEOMETRY_TILT_X || k == WH_GEOMETRY_TILT_Y || k == theta_zero || k == yaw_zero;
}

bool is_told(const agreed_t &fit, const geometry_rows_t &rows, int k) {
    const double deviation = rows.deviation(k);
    const bool is_length = !is_angle(k) && k < WH_GEOMETRY_SCALE;
    const double turning = is_angle(k) ? WH_GEOMETRY_ANGLE_SD : WH_GEOMETRY_SCALE_SD;
    const double most = is_length ? WH_GEOMETRY_LENGTH_SD : turning;
    return fit.model.is_free[k] && deviation * fit.sd <= most &&
           deviation * (is_length ? 1 : fit.reach) <= most_pull;
}

/* The largest share of a touch's error that the fit takes over. */
double largest_pull(const agreed_t &fit, const wh_touch_t &touch) {
    return own_of(pull_of(fit.rows, fit.model, touch)).values(2);
}

/* Sets is_determined; lone[k] is the number of the only touch that determines k, from 1, or 0. Only few
 * touches can be of this kind. */
void judge_values(touches_t &data, const agreed_t &fit, wh_geometry_estimate_t *estimate, size_t *lone) {
    for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
        estimate->values[k].is_determined = is_told(fit, fit.rows, k);
        lone[k] = 0;
    }
    for (size_t i = 0; i < data.count; ++i) {
        if (data.is_used[i] && largest_pull(fit, data.touches[i]) > nearly_alone) {
            data.weights[i] = 0;
            const geometry_rows_t others = rows_of(data, fit.model);
            data.weights[i] = 1;
            for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
                if (estimate->values[k].is_determined && !is_told(fit, others, k)) {
                    estimate->values[k].is_determined = false;
                    lone[k] = i + 1;
                }
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------- what is missing */

/* The reason why a number is not determined: sets of axes to move, as bits, or one of these values, or a
 * touch number added to LONE. */
enum { MORE = 0, NOTHING = 16, HEADINGS = 17, LONE = 32 };

/* Adds the touches again with an axis moved, in both directions. */
void add_moved(const touches_t &data, const agreed_t &fit, unsigned axes, geometry_rows_t *rows) {
    const double ways[WH_ROBOT_AXES] = {full_turn / 6, 100, 100, full_turn / 4};
    for (size_t i = 0; i < data.count; ++i) {
        for (int way = -1; data.is_used[i] && way <= 1; way += 2) {
            double moved[WH_ROBOT_AXES];
            for (int k = 0; k < WH_ROBOT_AXES; ++k) {
                moved[k] = data.touches[i].axes[k] + ((axes >> k & 1U) != 0 ? way * ways[k] : 0);
            }
            add_touch(rows, fit.model, moved, Vector3d::Zero());
        }
    }
}

/* The equations if there were further touches with these axes moved: one by one, and together. */
geometry_rows_t rows_with(const touches_t &data, const agreed_t &fit, unsigned axes) {
    geometry_rows_t rows;
    add_moved(data, fit, 0, &rows);
    add_moved(data, fit, axes, &rows);
    for (unsigned k = 0; k < WH_ROBOT_AXES; ++k) {
        add_moved(data, fit, axes & 1U << k, &rows);
    }
    rows.solve();
    return rows;
}

/* For each number that is not determined, finds the fewest axes that must move. */
void find_missing(const touches_t &data, const agreed_t &fit, const wh_geometry_estimate_t &estimate,
                  size_t *missing) {
    static const unsigned sets[] = {0, 8, 1, 2, 4, 9, 10, 3, 12, 5, 6, 11, 13, 14, 7, 15};
    for (const unsigned set : sets) {
        const geometry_rows_t rows = rows_with(data, fit, set);
        for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
            if (fit.model.is_free[k] && !estimate.values[k].is_determined && missing[k] == NOTHING &&
                is_told(fit, rows, k)) {
                missing[k] = set;
            }
        }
    }
}

void tell_moves(size_t missing, char *reason) {
    static const char *const moves[WH_ROBOT_AXES] = {"with theta turned", "at other r", "at other z",
                                                     "with yaw turned"};
    const char *between = " touches ";
    for (size_t k = 0; k < WH_ROBOT_AXES; ++k) {
        if ((missing >> k & 1U) != 0) {
            tell(reason, "%s%s", between, moves[k]);
            between = " and ";
        }
    }
}

void tell_way(size_t missing, char *reason) {
    if (missing > LONE) {
        tell(reason, " touches like number %zu, which alone tells it", missing - LONE);
    } else if (missing == HEADINGS) {
        tell(reason, " the tool's heading, in %d touches or more", WH_GEOMETRY_HEADINGS);
    } else if (missing == MORE || missing == NOTHING) {
        tell(reason, " many more touches, farther apart");
    } else {
        tell_moves(missing, reason);
    }
}

/* Names the numbers that lack the same measurements as `first`, and marks them as named. */
void name_numbers(const size_t *missing, int first, bool *is_named, char *reason) {
    const char *before = "";
    for (int k = first; k < WH_GEOMETRY_PARAMETERS; ++k) {
        if (!is_named[k] && missing[k] == missing[first]) {
            tell(reason, "%s%s", before, wh_geometry_name(k));
            is_named[k] = true;
            before = ", ";
        }
    }
}

void tell_missing(const size_t *missing, wh_geometry_estimate_t *estimate) {
    bool is_named[WH_GEOMETRY_PARAMETERS];
    for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
        is_named[k] = estimate->values[k].is_determined || (k >= WH_GEOMETRY_SCALE && !estimate->has_scales);
    }
    for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
        if (!is_named[k]) {
            tell(estimate->reason, "%s", estimate->reason[0] != '\0' ? "; " : "");
            name_numbers(missing, k, is_named, estimate->reason);
            tell(estimate->reason, ":");
            tell_way(missing[k], estimate->reason);
        }
    }
}

/* ------------------------------------------------------------------------------------------ what is wrong */

wh_status_t check(const wh_touch_t *touches, size_t count, wh_geometry_estimate_t *estimate) {
    if (count > WH_GEOMETRY_MOST_TOUCHES) {
        tell(estimate->reason, "%zu touches, of at most %d", count, WH_GEOMETRY_MOST_TOUCHES);
        return WH_STATUS_BAD_CAPACITY;
    }
    for (size_t i = 0; i < count; ++i) {
        const wh_touch_t &touch = touches[i];
        const double turn = touch.axes[WH_AXIS_YAW];
        const double heading = std::isnan(touch.heading) ? 0 : touch.heading;
        const Vector3d angles(touch.axes[WH_AXIS_THETA], turn, heading);
        const Eigen::Matrix<double, 5, 1> lengths = {touch.axes[WH_AXIS_R], touch.axes[WH_AXIS_Z],
                                                     touch.touched.x, touch.touched.y, touch.touched.z};
        if (!(angles.allFinite() && angles.cwiseAbs().maxCoeff() <= WH_TRIG_MAX_RAD && lengths.allFinite() &&
              lengths.cwiseAbs().maxCoeff() <= 1e6)) {
            tell(estimate->reason, "touch %zu: a number is not finite, or too large", i + 1);
            return WH_STATUS_OUT_OF_RANGE;
        }
    }
    if (count < WH_GEOMETRY_TOUCHES) {
        tell(estimate->reason, "%zu of at least %d touches", count, WH_GEOMETRY_TOUCHES);
        return WH_STATUS_TOO_FEW_POINTS;
    }
    return WH_OK;
}

/* The apparent error of the scale of an axis, and how often that is beyond chance. */
struct scale_t {
    double off, rareness;
};

agreed_t with_scale(const touches_t &data, const agreed_t &fit, int axis) {
    agreed_t scaled = fit;
    scaled.model.is_free[WH_GEOMETRY_SCALE + axis] = true;
    scaled.rows = rows_of(data, scaled.model);
    return scaled;
}

scale_t scale_of(const touches_t &data, const agreed_t &fit, int axis) {
    const agreed_t scaled = with_scale(data, fit, axis);
    const double deviation = scaled.rows.deviation(WH_GEOMETRY_SCALE + axis);
    const double off = scaled.rows.step(0)(WH_GEOMETRY_SCALE + axis);
    double freedom = -scaled.rows.rank();
    for (size_t i = 0; i < data.count; ++i) {
        freedom += data.weights[i] > 0 ? 3 : 0;
    }
    if (!std::isfinite(deviation) || freedom < 1) {
        return {off, 0};
    }
    const double fewer = off / deviation * (off / deviation);
    const double left = std::max(squares_of(data, fit.model) - fewer, 0.0) / freedom;
    return {off, std::sqrt(fewer / std::max(left, least_sd_mm * least_sd_mm)) / rare_of(freedom)};
}

/* True if this does not depend on a single touch. */
bool is_off_without_any(touches_t &data, const agreed_t &fit, int axis) {
    const agreed_t scaled = with_scale(data, fit, axis);
    bool is_off = true;
    for (size_t i = 0; is_off && i < data.count; ++i) {
        if (data.is_used[i] && largest_pull(scaled, data.touches[i]) > nearly_alone) {
            data.weights[i] = 0;
            is_off = scale_of(data, fit, axis).rareness > 1;
            data.weights[i] = 1;
        }
    }
    return is_off;
}

/* The axis whose scale is most surely wrong; -1 if none is. */
int find_scale(touches_t &data, const agreed_t &fit, double *off) {
    int found = -1;
    double most = 1;
    for (int axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const scale_t scale = scale_of(data, fit, axis);
        if (scale.rareness > most && is_off_without_any(data, fit, axis)) {
            most = scale.rareness;
            found = axis;
            *off = scale.off;
        }
    }
    return found;
}

wh_status_t judge(touches_t &data, const agreed_t &fit, wh_geometry_estimate_t *estimate) {
    const double lean = std::acos(std::min(tilt_of(fit.model.p)(2, 2), 1.0));
    double off = 0;
    if (estimate->rms > WH_GEOMETRY_MISFIT * fit.reach) {
        tell(estimate->reason,
             "the points lie to one another in another way than the axes say: residuals of %.3g mm rms, "
             "the most at touch %zu; is an axis told the other way round, or a unit wrong?",
             estimate->rms, estimate->largest_index + 1);
        return WH_STATUS_NO_FIT;
    }
    if (lean > WH_GEOMETRY_MOST_TILT && is_told(fit, fit.rows, WH_GEOMETRY_TILT_X) &&
        is_told(fit, fit.rows, WH_GEOMETRY_TILT_Y)) {
        tell(estimate->reason, "the column would lean by %.3g degrees: are x, y and z mixed up?",
             lean * 360 / full_turn);
        return WH_STATUS_NO_FIT;
    }
    const int scale = estimate->has_scales ? -1 : find_scale(data, fit, &off);
    if (scale >= 0) {
        tell(estimate->reason, "the scale of %s seems to be off by %.2g %%: fit the scales as well",
             axis_names[scale], 100 * off);
        return WH_STATUS_NO_FIT;
    }
    return WH_OK;
}

/* ---------------------------------------------------------------------------------------------- the whole */

wh_status_t fit_touches(touches_t &data, agreed_t *fit, wh_geometry_estimate_t *estimate) {
    estimate->used = wh_estimate::fit_agreed(data, estimate->has_scales, &fit->model, &fit->sd);
    estimate->set_aside = data.count - estimate->used;
    for (size_t i = 0; i < data.count; ++i) {
        data.touches[i].is_set_aside = !data.is_used[i];
    }
    if (static_cast<double>(estimate->set_aside) > WH_GEOMETRY_ASIDE * static_cast<double>(data.count)) {
        tell(estimate->reason, "%zu of %zu touches agree with no geometry that the others agree with",
             estimate->set_aside, data.count);
        return WH_STATUS_NO_FIT;
    }
    if (estimate->used < WH_GEOMETRY_TOUCHES) {
        tell(estimate->reason, "%zu of at least %d touches, %zu more were set aside", estimate->used,
             WH_GEOMETRY_TOUCHES, estimate->set_aside);
        return WH_STATUS_TOO_FEW_POINTS;
    }
    return WH_OK;
}

/* Computes residuals, and the distance of the point from the column. */
void measure(const touches_t &data, agreed_t *fit, wh_geometry_estimate_t *estimate) {
    const auto used = static_cast<double>(estimate->used);
    double squares = 0;
    for (size_t i = 0; i < data.count; ++i) {
        if (data.is_used[i]) {
            const double off = rest_of(fit->model, data.touches[i]).norm();
            const Vector3d from = tilt_of(fit->model.p).transpose() *
                                  (point_of(fit->model.p, data.touches[i].axes, nullptr) -
                                   Vector3d(fit->model.p[WH_GEOMETRY_X], fit->model.p[WH_GEOMETRY_Y], 0));
            squares += from.head<2>().squaredNorm();
            if (off >= estimate->largest) {
                estimate->largest = off;
                estimate->largest_index = i;
            }
        }
    }
    fit->reach = std::sqrt(squares / used);
    fit->rows = rows_of(data, fit->model);
    estimate->rms = std::sqrt(fit->model.squares / used);
}

void store_base(wh_geometry_estimate_t *estimate) {
    static const int needed[] = {WH_GEOMETRY_X,      WH_GEOMETRY_Y, WH_GEOMETRY_TILT_X,
                                 WH_GEOMETRY_TILT_Y, theta_zero,    WH_GEOMETRY_ZERO + WH_AXIS_Z};
    const double *p = estimate->fitted;
    const Matrix3d tilt = tilt_of(p);
    const Matrix3d R = tilt * Eigen::AngleAxisd(p[theta_zero], Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d r =
        Vector3d(p[WH_GEOMETRY_X], p[WH_GEOMETRY_Y], 0) + p[WH_GEOMETRY_ZERO + WH_AXIS_Z] * tilt.col(2);
    estimate->is_base_determined = true;
    for (const int k : needed) {
        estimate->is_base_determined = estimate->is_base_determined && estimate->values[k].is_determined;
    }
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            estimate->points_from_base.R.m[i][k] = R(i, k);
        }
    }
    estimate->points_from_base.r = wh_vec3(r(0), r(1), r(2));
    estimate->base_rpy[0] = std::atan2(R(2, 1), R(2, 2));
    estimate->base_rpy[1] = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
    estimate->base_rpy[2] = std::atan2(R(1, 0), R(0, 0));
}

/* The measurements that the zero of yaw lacks, if it is not determined. */
size_t missing_of_yaw(const wh_geometry_estimate_t &estimate, const size_t *missing) {
    if (estimate.headings == 0) {
        return HEADINGS;
    }
    return estimate.values[theta_zero].is_determined ? static_cast<size_t>(MORE) : missing[theta_zero];
}

bool is_any_determined(const wh_geometry_estimate_t &estimate) {
    bool is_any = false;
    for (const wh_estimate_value_t &value : estimate.values) {
        is_any = is_any || value.is_determined;
    }
    return is_any;
}

wh_status_t conclude(touches_t &data, agreed_t &fit, wh_geometry_estimate_t *estimate) {
    size_t missing[WH_GEOMETRY_PARAMETERS];
    size_t lone[WH_GEOMETRY_PARAMETERS];
    for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
        const double found = fit.model.p[k];
        estimate->fitted[k] = k == theta_zero ? std::remainder(found, full_turn) : found;
        estimate->values[k] = {estimate->fitted[k], fit.sd * fit.rows.deviation(k), false};
    }
    judge_values(data, fit, estimate, lone);
    for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
        missing[k] = lone[k] > 0 ? LONE + lone[k] : static_cast<size_t>(NOTHING);
    }
    find_missing(data, fit, *estimate, missing);
    const wh_status_t status = wh_estimate::fit_headings(data, estimate);
    if (status != WH_OK) {
        return status;
    }
    missing[yaw_zero] = missing_of_yaw(*estimate, missing);
    store_base(estimate);
    tell_missing(missing, estimate);
    return is_any_determined(*estimate) ? WH_OK : WH_STATUS_NOT_DETERMINED;
}

} // namespace

const char *wh_geometry_name(int number) {
    static const char *const names[WH_GEOMETRY_PARAMETERS] = {
        "x",        "y",      "tilt_x", "tilt_y",      "zero_theta", "zero_r",  "zero_z",
        "zero_yaw", "tool_x", "tool_y", "scale_theta", "scale_r",    "scale_z", "scale_yaw"};
    return names[number];
}

wh_vec3_t wh_geometry_residual(const wh_geometry_estimate_t *estimate, const wh_touch_t *touch) {
    const Vector3d there = point_of(estimate->fitted, touch->axes, nullptr);
    return wh_vec3(touch->touched.x - there(0), touch->touched.y - there(1), touch->touched.z - there(2));
}

wh_vec3_t wh_geometry_in_base(const wh_geometry_estimate_t *estimate, const wh_vec3_t *point) {
    const wh_pose_t there = {wh_pose_identity().R, *point};
    return wh_pose_relative(&estimate->points_from_base, &there).r;
}

wh_status_t wh_geometry_estimate(wh_touch_t *touches, size_t count, bool with_scales,
                                 wh_geometry_estimate_t *estimate) {
    if (touches == nullptr || estimate == nullptr) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    *estimate = wh_geometry_estimate_t();
    estimate->has_scales = with_scales;
    estimate->status = check(touches, count, estimate);
    if (estimate->status == WH_OK) {
        touches_t data;
        agreed_t fit;
        data.touches = touches;
        data.count = count;
        for (size_t i = 0; i < count; ++i) {
            touches[i].is_heading_set_aside = false;
        }
        estimate->status = fit_touches(data, &fit, estimate);
        if (estimate->status == WH_OK) {
            measure(data, &fit, estimate);
            estimate->status = judge(data, fit, estimate);
        }
        if (estimate->status == WH_OK) {
            estimate->status = conclude(data, fit, estimate);
        }
    }
    return estimate->status;
}
