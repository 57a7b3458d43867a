#include "frame.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "reason_internal.hpp"
#include "rows_internal.hpp"

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using wh_estimate::tell;

struct moments_t {
    Vector3d touched, known; // centres
    Matrix3d products;       // sum of touched * known'
    Matrix3d spread;         // sum of known * known'
    double used;             // points
};

Vector3d vector_of(const wh_vec3_t &v) {
    return {v.x, v.y, v.z};
}

moments_t moments_of(const wh_frame_point_t *points, size_t count) {
    moments_t moments = {Vector3d::Zero(), Vector3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero(), 0};
    for (size_t i = 0; i < count; ++i) {
        moments.used += points[i].is_set_aside ? 0 : 1;
    }
    for (size_t i = 0; i < count; ++i) {
        if (!points[i].is_set_aside) {
            moments.touched += vector_of(points[i].touched) / moments.used;
            moments.known += vector_of(points[i].known) / moments.used;
        }
    }
    for (size_t i = 0; i < count; ++i) {
        if (!points[i].is_set_aside) {
            const Vector3d touched = vector_of(points[i].touched) - moments.touched;
            const Vector3d known = vector_of(points[i].known) - moments.known;
            moments.products += touched * known.transpose();
            moments.spread += known * known.transpose();
        }
    }
    return moments;
}

/* The rotation with the largest trace of R' * products. */
Matrix3d rotation_of(const Matrix3d &products) {
    const Eigen::JacobiSVD<Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vector3d signs(1, 1, 1);
    signs(2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

void store(const Matrix3d &R, const Vector3d &r, wh_pose_t *pose) {
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            pose->R.m[i][k] = R(i, k);
        }
    }
    pose->r = wh_vec3(r(0), r(1), r(2));
}

/* Fills in rms and largest; returns the sum of squares. */
double measure_residuals(const wh_frame_point_t *points, size_t count, wh_frame_estimate_t *estimate) {
    double squares = 0;
    estimate->largest = -1;
    estimate->used = 0;
    for (size_t i = 0; i < count; ++i) {
        const wh_vec3_t off = wh_frame_residual(estimate, &points[i]);
        const double square = wh_vec3_dot(&off, &off);
        squares += points[i].is_set_aside ? 0 : square;
        estimate->used += points[i].is_set_aside ? 0 : 1;
        if (!points[i].is_set_aside && std::sqrt(square) > estimate->largest) {
            estimate->largest = std::sqrt(square);
            estimate->largest_index = i;
        }
    }
    estimate->set_aside = count - estimate->used;
    estimate->rms = std::sqrt(squares / static_cast<double>(estimate->used));
    return squares;
}

/* ---------------------------------------------------------------------------------------------- set aside */

struct fit_t {
    moments_t moments;
    Matrix3d R;
    Matrix3d turned; // covariance of a small turn about base's axes, where points have a deviation of 1
    double squares;
};

constexpr double least_sd_mm = 1e-6;

Matrix3d crossing(const Vector3d &arm) {
    Matrix3d cross;
    cross << 0, -arm(2), arm(1), arm(2), 0, -arm(0), -arm(1), arm(0), 0;
    return cross;
}

fit_t fit(const wh_frame_point_t *points, size_t count, wh_frame_estimate_t *estimate) {
    fit_t found;
    found.moments = moments_of(points, count);
    found.R = rotation_of(found.moments.products);
    store(found.R, found.moments.touched - found.R * found.moments.known, &estimate->base_from_station);
    found.squares = measure_residuals(points, count, estimate);
    const Matrix3d spread = found.R * found.moments.spread * found.R.transpose();
    found.turned = (spread.trace() * Matrix3d::Identity() - spread).inverse();
    return found;
}

/* The squared distance of a point from its place by the others, in deviations of a point. It is its
 * residual, less its pull on the fit if it is used, or plus the fit's possible error if it is not. A
 * direction that only this point determines does not count. */
double distance_of(const fit_t &found, const wh_frame_estimate_t &estimate, const wh_frame_point_t &point) {
    const Matrix3d cross = crossing(found.R * (vector_of(point.known) - found.moments.known));
    const Matrix3d pull =
        Matrix3d::Identity() / found.moments.used + cross * found.turned * cross.transpose();
    const wh_estimate::own_t own = wh_estimate::own_of(pull);
    const wh_vec3_t off = wh_frame_residual(&estimate, &point);
    const Vector3d along = own.vectors.transpose() * vector_of(off);
    double square = 0;
    for (int k = 0; k < 3; ++k) {
        const double size = own.values(k);
        const double variance = point.is_set_aside ? 1 + size : 1 - size;
        square += variance > 1e-6 ? along(k) * along(k) / variance : 0;
    }
    return square;
}

/* The largest usual squared deviation of a point as seen from others with this number of degrees of
 * freedom, in units of their variance (D. L. Wallace, 1959). */
double rare_square(double freedom) {
    constexpr double most = WH_FRAME_ASIDE_SDS * WH_FRAME_ASIDE_SDS;
    const double part = (freedom - 5.0 / 6) / ((freedom - 2.0 / 3) * (freedom - 2.0 / 3));
    return freedom > 2 ? freedom * std::expm1(std::min(most * part, 600.0)) : HUGE_VAL;
}

/* Sets aside the point that contradicts the others most. */
void drop_worst(wh_frame_point_t *points, size_t count, const fit_t &found,
                const wh_frame_estimate_t &estimate) {
    double most = -1;
    size_t worst = 0;
    for (size_t i = 0; i < count; ++i) {
        const double off = points[i].is_set_aside ? -1 : distance_of(found, estimate, points[i]);
        if (off > most) {
            most = off;
            worst = i;
        }
    }
    points[worst].is_set_aside = true;
}

/* Takes back the point that agrees best with the fit to the others; false if none agrees. */
bool take_back(wh_frame_point_t *points, size_t count, const fit_t &found,
               const wh_frame_estimate_t &estimate) {
    const double freedom = 3 * found.moments.used - 6;
    const double variance = std::max(found.squares / std::max(freedom, 1.0), least_sd_mm * least_sd_mm);
    double least = rare_square(freedom) * variance;
    wh_frame_point_t *best = nullptr;
    for (size_t i = 0; i < count; ++i) {
        const double off = points[i].is_set_aside ? distance_of(found, estimate, points[i]) : HUGE_VAL;
        if (off <= least && points[i].is_set_aside) {
            least = off;
            best = &points[i];
        }
    }
    if (best != nullptr) {
        best->is_set_aside = false;
    }
    return best != nullptr;
}

/* It first leaves out a quarter of the points, the worst ones one by one, so that several wrong ones do not
 * hide one another. Then it takes back all that agree with the others. */
fit_t fit_agreed(wh_frame_point_t *points, size_t count, wh_frame_estimate_t *estimate) {
    const auto most = static_cast<size_t>(WH_FRAME_ASIDE * static_cast<double>(count));
    for (size_t i = 0; i < count; ++i) {
        points[i].is_set_aside = false;
    }
    fit_t found = fit(points, count, estimate);
    for (size_t i = 0; i < most; ++i) {
        drop_worst(points, count, found, *estimate);
        found = fit(points, count, estimate);
    }
    while (take_back(points, count, found, *estimate)) {
        found = fit(points, count, estimate);
    }
    return found;
}

/* Fills in angles and all standard deviations. A small turn w about base's axes moves a known point p, seen
 * from the centre, by w x p. So the covariance of w is variance * inverse(sum of |p|^2 I - p p'). The
 * origin moves with the centre, and with w. */
void fill_in(const fit_t &found, wh_frame_estimate_t *estimate) {
    const Matrix3d &R = found.R;
    const double variance = found.squares / (3 * found.moments.used - 6);
    const Matrix3d turned = variance * found.turned;
    const Matrix3d cross = crossing(R * found.moments.known);
    const Matrix3d shifted =
        variance / found.moments.used * Matrix3d::Identity() + cross * turned * cross.transpose();
    const double roll = std::atan2(R(2, 1), R(2, 2));
    const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
    const double yaw = std::atan2(R(1, 0), R(0, 0));
    Matrix3d turn_of_rates; // a turn about base's axes from the rates of roll, pitch and yaw
    turn_of_rates << std::cos(yaw) * std::cos(pitch), -std::sin(yaw), 0, std::sin(yaw) * std::cos(pitch),
        std::cos(yaw), 0, -std::sin(pitch), 0, 1;
    const Matrix3d inverse = turn_of_rates.inverse();
    const Matrix3d rates = inverse * turned * inverse.transpose();
    const double rpy[3] = {roll, pitch, yaw};
    for (int i = 0; i < 3; ++i) {
        estimate->rpy[i] = rpy[i];
        estimate->rpy_sd[i] = std::sqrt(rates(i, i));
        estimate->at_sd[i] = std::sqrt(shifted(i, i));
    }
}

wh_status_t refuse(wh_frame_estimate_t *estimate, wh_status_t status) {
    estimate->status = status;
    return status;
}

bool is_finite(const wh_frame_point_t *points, size_t count) {
    bool finite = true;
    for (size_t i = 0; i < count; ++i) {
        finite = finite && vector_of(points[i].touched).allFinite() && vector_of(points[i].known).allFinite();
    }
    return finite;
}

} // namespace

wh_vec3_t wh_frame_residual(const wh_frame_estimate_t *estimate, const wh_frame_point_t *point) {
    const wh_vec3_t there = wh_pose_point(&estimate->base_from_station, &point->known);
    return wh_vec3_subtract(&point->touched, &there);
}

wh_status_t wh_frame_estimate(wh_frame_point_t *points, size_t count, wh_frame_estimate_t *estimate) {
    if (points == nullptr || estimate == nullptr) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    *estimate = wh_frame_estimate_t();
    if (count < WH_FRAME_POINTS) {
        tell(estimate->reason, "%zu of at least %d points", count, WH_FRAME_POINTS);
        return refuse(estimate, WH_STATUS_TOO_FEW_POINTS);
    }
    if (!is_finite(points, count)) {
        tell(estimate->reason, "a number is not finite");
        return refuse(estimate, WH_STATUS_NO_FIT);
    }
    const fit_t found = fit_agreed(points, count, estimate);
    const Matrix3d &R = found.R;
    const Vector3d widths = // rms distances from the centre, by direction, the largest first
        (Eigen::JacobiSVD<Matrix3d>(found.moments.spread).singularValues() / found.moments.used).cwiseSqrt();
    if (widths(1) <= WH_FRAME_SPREAD_PART * widths(0)) {
        tell(estimate->reason,
             "the points lie on a line (%.3g mm beside it, rms): touch one more that lies off it, far out",
             widths(1));
        return refuse(estimate, WH_STATUS_NOT_DETERMINED);
    }
    if (estimate->rms > WH_FRAME_MISFIT * widths.norm()) {
        tell(estimate->reason,
             "the touched points lie to one another in another way than on the station: %.3g mm rms, "
             "the most at point %zu; are two mixed up, or is a unit wrong?",
             estimate->rms, estimate->largest_index + 1);
        return refuse(estimate, WH_STATUS_NO_FIT);
    }
    if (widths(1) < WH_FRAME_SPREAD_RMS * estimate->rms) {
        tell(estimate->reason,
             "the points lie within %.3g mm of a line (rms), where the residuals are %.3g mm: touch one "
             "more that lies off it, far out",
             widths(1), estimate->rms);
        return refuse(estimate, WH_STATUS_NOT_DETERMINED);
    }
    if (std::hypot(R(0, 0), R(1, 0)) < 1e-3) {
        tell(estimate->reason, "the station's x points up or down: rpy is not unique");
        return refuse(estimate, WH_STATUS_NOT_DETERMINED);
    }
    fill_in(found, estimate);
    return estimate->status;
}
