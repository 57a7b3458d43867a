#include "frame.h"

#include <Eigen/Dense>
#include <cmath>

#include "reason_internal.hpp"

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using wh_estimate::tell;

struct moments_t {
    Vector3d touched, known; // centres
    Matrix3d products;       // sum of touched * known'
    Matrix3d spread;         // sum of known * known'
};

Vector3d vector_of(const wh_vec3_t &v) {
    return {v.x, v.y, v.z};
}

moments_t moments_of(const wh_frame_point_t *points, size_t count) {
    moments_t moments = {Vector3d::Zero(), Vector3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};
    for (size_t i = 0; i < count; ++i) {
        moments.touched += vector_of(points[i].touched) / static_cast<double>(count);
        moments.known += vector_of(points[i].known) / static_cast<double>(count);
    }
    for (size_t i = 0; i < count; ++i) {
        const Vector3d touched = vector_of(points[i].touched) - moments.touched;
        const Vector3d known = vector_of(points[i].known) - moments.known;
        moments.products += touched * known.transpose();
        moments.spread += known * known.transpose();
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
    for (size_t i = 0; i < count; ++i) {
        const wh_vec3_t off = wh_frame_residual(estimate, &points[i]);
        const double square = wh_vec3_dot(&off, &off);
        squares += square;
        if (std::sqrt(square) > estimate->largest) {
            estimate->largest = std::sqrt(square);
            estimate->largest_index = i;
        }
    }
    estimate->rms = std::sqrt(squares / static_cast<double>(count));
    return squares;
}

/* Angles and all standard deviations. A small turn w about base's axes moves a known point p, seen from
 * the centre, by w x p: so the covariance of w is variance * inverse(sum of |p|^2 I - p p'). The origin
 * moves with the centre, and with w. */
void fill_in(const moments_t &moments, const Matrix3d &R, double variance, size_t count,
             wh_frame_estimate_t *estimate) {
    const Matrix3d spread = R * moments.spread * R.transpose();
    const Matrix3d turned = variance * (spread.trace() * Matrix3d::Identity() - spread).inverse();
    const Vector3d arm = R * moments.known;
    Matrix3d cross;
    cross << 0, -arm(2), arm(1), arm(2), 0, -arm(0), -arm(1), arm(0), 0;
    const Matrix3d shifted =
        variance / static_cast<double>(count) * Matrix3d::Identity() + cross * turned * cross.transpose();
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

wh_status_t wh_frame_estimate(const wh_frame_point_t *points, size_t count, wh_frame_estimate_t *estimate) {
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
    const moments_t moments = moments_of(points, count);
    const Vector3d widths = // rms distances from the centre, by direction, the largest first
        (Eigen::JacobiSVD<Matrix3d>(moments.spread).singularValues() / static_cast<double>(count))
            .cwiseSqrt();
    const Matrix3d R = rotation_of(moments.products);
    store(R, moments.touched - R * moments.known, &estimate->base_from_station);
    const double squares = measure_residuals(points, count, estimate);
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
    fill_in(moments, R, squares / static_cast<double>(3 * count - 6), count, estimate);
    return estimate->status;
}
