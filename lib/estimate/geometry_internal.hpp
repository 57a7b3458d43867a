/* Internal to the geometry: the model's place of the touching point, and the search for the values nearest
 * to the touches. */
#ifndef WH_ESTIMATE_GEOMETRY_INTERNAL_HPP
#define WH_ESTIMATE_GEOMETRY_INTERNAL_HPP

#include "geometry.h"
#include "rows_internal.hpp"

namespace wh_estimate {

/* No touch is more exact. */
constexpr double least_sd_mm = 1e-6;

constexpr double full_turn = 6.283185307179586;
constexpr int yaw_zero = WH_GEOMETRY_ZERO + WH_AXIS_YAW;
constexpr int theta_zero = WH_GEOMETRY_ZERO + WH_AXIS_THETA;

/* The zero of yaw does not affect a point's place, so it is never free here. */
using geometry_rows_t = rows_t<WH_GEOMETRY_PARAMETERS>;
using jacobian_t = Eigen::Matrix<double, 3, WH_GEOMETRY_PARAMETERS>;

/* All numbers, and the set that is searched. */
struct geometry_t {
    double p[WH_GEOMETRY_PARAMETERS];
    bool is_free[WH_GEOMETRY_PARAMETERS];
    double squares; /* of the weighted residuals */
};

/* The touches with their weights. */
struct touches_t {
    wh_touch_t *touches;
    size_t count;
    double weights[WH_GEOMETRY_MOST_TOUCHES];
    double sizes[WH_GEOMETRY_MOST_TOUCHES]; /* to be sorted */
    bool is_used[WH_GEOMETRY_MOST_TOUCHES];
};

/* From the frame of the turned column to that of the points: Rx(tilt_x) Ry(tilt_y). */
Eigen::Matrix3d tilt_of(const double p[WH_GEOMETRY_PARAMETERS]);

/* The place of the touching point, and its derivatives by each number, unless `by` is null. */
Eigen::Vector3d point_of(const double p[WH_GEOMETRY_PARAMETERS], const double axes[WH_ROBOT_AXES],
                         jacobian_t *by);

/* The touched point minus the model's. */
Eigen::Vector3d rest_of(const geometry_t &model, const wh_touch_t &touch);

/* Adds the equations of a touch; without a rest if it is null. */
void add_touch(geometry_rows_t *rows, const geometry_t &model, const double axes[WH_ROBOT_AXES],
               const Eigen::Vector3d &rest);

/* These are for the descent. */
geometry_rows_t rows_of(const touches_t &data, const geometry_t &model);
double squares_of(const touches_t &data, const geometry_t &model);
geometry_t stepped(const geometry_t &from, const geometry_rows_t::vector_t &step);

/* The covariance of the fit's prediction for a touch, if touches have a deviation of 1. For a touch that is
 * used, the eigenvalues are the shares of its error that the fit takes over, from 0 to 1. For another one,
 * the covariance is huge in undetermined directions. */
Eigen::Matrix3d pull_of(const geometry_rows_t &rows, const geometry_t &model, const wh_touch_t &touch);

/* Decides which touches are used: those that agree with the geometry that most touches agree with. Returns
 * their number; `sd` is the deviation of a coordinate of one touch. */
size_t fit_agreed(touches_t &data, bool with_scales, geometry_t *model, double *sd);

/* The number of deviations that is as rare as five with a known deviation, if the deviation of normal
 * errors comes from only this number of freedoms (D. L. Wallace, 1959). */
double rare_of(double freedom);

/* The zero of yaw, from the headings of the used touches and the other values in `estimate`; unchanged if
 * there are too few. */
wh_status_t fit_headings(touches_t &data, wh_geometry_estimate_t *estimate);

} // namespace wh_estimate

#endif
