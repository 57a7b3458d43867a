#include "geometry_internal.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "../math/philox.h"

namespace wh_estimate {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int starts = 60;
constexpr int touches_of_a_start = 6;
constexpr double median_to_sd =
    1 / 1.5382; /* median length of a vector with a deviation of 1 in three directions */

/* ---------------------------------------------------------------------------------------------- the model */

static Matrix3d about(int axis, double angle) {
    return Eigen::AngleAxisd(angle, Vector3d::Unit(axis)).toRotationMatrix();
}

Matrix3d tilt_of(const double p[WH_GEOMETRY_PARAMETERS]) {
    return about(0, p[WH_GEOMETRY_TILT_X]) * about(1, p[WH_GEOMETRY_TILT_Y]);
}

Vector3d point_of(const double p[WH_GEOMETRY_PARAMETERS], const double axes[WH_ROBOT_AXES], jacobian_t *by) {
    double at[WH_ROBOT_AXES]; /* positions of the axes */
    for (int i = 0; i < WH_ROBOT_AXES; ++i) {
        at[i] = p[WH_GEOMETRY_SCALE + i] * axes[i] + (i == WH_AXIS_YAW ? 0 : p[WH_GEOMETRY_ZERO + i]);
    }
    const Matrix3d tilt = tilt_of(p);
    const Matrix3d arm = tilt * about(2, at[WH_AXIS_THETA]);
    const Matrix3d wrist = arm * about(2, at[WH_AXIS_YAW]);
    const Vector3d tool = wrist * Vector3d(p[WH_GEOMETRY_TOOL_X], p[WH_GEOMETRY_TOOL_Y], 0);
    const Vector3d reach = arm * Vector3d(at[WH_AXIS_R], 0, at[WH_AXIS_Z]) + tool;
    if (by != nullptr) {
        const Vector3d column = tilt.col(2);
        by->setZero();
        by->col(WH_GEOMETRY_X) = Vector3d::UnitX();
        by->col(WH_GEOMETRY_Y) = Vector3d::UnitY();
        by->col(WH_GEOMETRY_TILT_X) = Vector3d::UnitX().cross(reach);
        by->col(WH_GEOMETRY_TILT_Y) = tilt.col(1).cross(reach);
        by->col(WH_GEOMETRY_ZERO + WH_AXIS_THETA) = column.cross(reach);
        by->col(WH_GEOMETRY_ZERO + WH_AXIS_R) = arm.col(0);
        by->col(WH_GEOMETRY_ZERO + WH_AXIS_Z) = column;
        by->col(WH_GEOMETRY_TOOL_X) = wrist.col(0);
        by->col(WH_GEOMETRY_TOOL_Y) = wrist.col(1);
        for (int i = 0; i < WH_ROBOT_AXES; ++i) {
            Vector3d moved = by->col(WH_GEOMETRY_ZERO + i);
            moved = i == WH_AXIS_YAW ? column.cross(tool) : moved;
            by->col(WH_GEOMETRY_SCALE + i) = axes[i] * moved;
        }
    }
    return Vector3d(p[WH_GEOMETRY_X], p[WH_GEOMETRY_Y], 0) + reach;
}

Vector3d rest_of(const geometry_t &model, const wh_touch_t &touch) {
    return Vector3d(touch.touched.x, touch.touched.y, touch.touched.z) -
           point_of(model.p, touch.axes, nullptr);
}

static jacobian_t jacobian_of(const geometry_t &model, const double axes[WH_ROBOT_AXES]) {
    jacobian_t by;
    (void)point_of(model.p, axes, &by);
    for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
        if (!model.is_free[k]) {
            by.col(k).setZero();
        }
    }
    return by;
}

/* ------------------------------------------------------------------------------------------ least squares */

void add_touch(geometry_rows_t *rows, const geometry_t &model, const double axes[WH_ROBOT_AXES],
               const Vector3d &rest) {
    const jacobian_t by = jacobian_of(model, axes);
    for (int i = 0; i < 3; ++i) {
        rows->add(by.row(i).transpose(), rest(i));
    }
}

geometry_rows_t rows_of(const touches_t &data, const geometry_t &model) {
    geometry_rows_t rows;
    for (size_t i = 0; i < data.count; ++i) {
        if (data.weights[i] > 0) {
            const double root = std::sqrt(data.weights[i]);
            const jacobian_t by = root * jacobian_of(model, data.touches[i].axes);
            const Vector3d rest = root * rest_of(model, data.touches[i]);
            for (int k = 0; k < 3; ++k) {
                rows.add(by.row(k).transpose(), rest(k));
            }
        }
    }
    rows.solve();
    return rows;
}

double squares_of(const touches_t &data, const geometry_t &model) {
    double squares = 0;
    for (size_t i = 0; i < data.count; ++i) {
        if (data.weights[i] > 0) {
            squares += data.weights[i] * rest_of(model, data.touches[i]).squaredNorm();
        }
    }
    return squares;
}

geometry_t stepped(const geometry_t &from, const geometry_rows_t::vector_t &step) {
    geometry_t to = from;
    for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
        to.p[k] += from.is_free[k] ? step(k) : 0;
    }
    return to;
}

/* ------------------------------------------------------------------------------------------------- starts */

/* For a level column x and y are linear in four pairs of numbers: place, direction times r, direction times
 * the zero of r, and direction times the tool. */
using level_rows_t = rows_t<level_parameters>;

static void add_level(level_rows_t *rows, const wh_touch_t &touch, double weight, double reach) {
    const double theta = touch.axes[WH_AXIS_THETA];
    const double wrist = theta + touch.axes[WH_AXIS_YAW];
    const double r = touch.axes[WH_AXIS_R] / reach;
    level_rows_t::vector_t x;
    level_rows_t::vector_t y;
    x << 1, 0, r * std::cos(theta), -r * std::sin(theta), std::cos(theta), -std::sin(theta), std::cos(wrist),
        -std::sin(wrist);
    y << 0, 1, r * std::sin(theta), r * std::cos(theta), std::sin(theta), std::cos(theta), std::sin(wrist),
        std::cos(wrist);
    rows->add(weight * x, weight * touch.touched.x);
    rows->add(weight * y, weight * touch.touched.y);
}

/* The mean length of r, and the mean height of the points minus z, of touches with a weight. */
static void means_of(const touches_t &data, double *reach, double *height) {
    double weights = 0;
    *reach = 0;
    *height = 0;
    for (size_t i = 0; i < data.count; ++i) {
        const wh_touch_t &touch = data.touches[i];
        weights += data.weights[i];
        *reach += data.weights[i] * std::abs(touch.axes[WH_AXIS_R]);
        *height += data.weights[i] * (touch.touched.z - touch.axes[WH_AXIS_Z]);
    }
    *reach = std::max(*reach / weights, 1.0);
    *height /= weights;
}

static geometry_t level_of(const level_rows_t::vector_t &pairs, double heading, double reach, double height) {
    const Vector2d ahead(std::cos(heading), std::sin(heading));
    const Vector2d left(-ahead(1), ahead(0));
    const Vector2d along = pairs.segment<2>(2) / reach - ahead;
    geometry_t model = {};
    model.p[WH_GEOMETRY_X] = pairs(0);
    model.p[WH_GEOMETRY_Y] = pairs(1);
    model.p[WH_GEOMETRY_ZERO + WH_AXIS_THETA] = heading;
    model.p[WH_GEOMETRY_ZERO + WH_AXIS_R] = ahead.dot(pairs.segment<2>(4) + reach * along);
    model.p[WH_GEOMETRY_ZERO + WH_AXIS_Z] = height;
    model.p[WH_GEOMETRY_TOOL_X] = ahead.dot(pairs.segment<2>(6));
    model.p[WH_GEOMETRY_TOOL_Y] = left.dot(pairs.segment<2>(6));
    for (int k = 0; k < WH_GEOMETRY_PARAMETERS; ++k) {
        model.p[k] = k >= WH_GEOMETRY_SCALE ? 1 : model.p[k];
        model.is_free[k] = k < WH_GEOMETRY_SCALE && k != WH_GEOMETRY_ZERO + WH_AXIS_YAW;
    }
    return model;
}

/* Starts from the touches with a weight. If r has one length, the direction is that of both pairs
 * together. */
static geometry_t find_start(const touches_t &data) {
    double reach;
    double height;
    means_of(data, &reach, &height);
    level_rows_t rows;
    for (size_t i = 0; i < data.count; ++i) {
        if (data.weights[i] > 0) {
            add_level(&rows, data.touches[i], data.weights[i], reach);
        }
    }
    rows.solve();
    const level_rows_t::vector_t pairs = rows.step(0);
    const Vector2d both = pairs.segment<2>(2) + pairs.segment<2>(4);
    geometry_t alone = level_of(pairs, std::atan2(pairs(3), pairs(2)), reach, height);
    geometry_t together = level_of(pairs, std::atan2(both(1), both(0)), reach, height);
    return squares_of(data, alone) < squares_of(data, together) ? alone : together;
}

/* Sets weights of 1 for six touches that the start's number draws, otherwise 0. */
static void draw(touches_t &data, uint32_t start) {
    std::fill(data.weights, data.weights + data.count, 0);
    const uint32_t key[2] = {0, 0};
    int drawn = 0;
    for (uint32_t i = 0; drawn < touches_of_a_start; ++i) {
        const uint32_t counter[4] = {start, i, 0, 0};
        const size_t place = wh_philox(counter, key).words[0] % data.count;
        drawn += data.weights[place] > 0 ? 0 : 1;
        data.weights[place] = 1;
    }
}

/* ------------------------------------------------------------------------------------------------- robust */

/* The standard deviation of a coordinate, from the median of the residuals' lengths; it is too small for
 * few touches (P. J. Rousseeuw, 1984). */
static double deviation_of(touches_t &data, const geometry_t &model) {
    for (size_t i = 0; i < data.count; ++i) {
        data.sizes[i] = rest_of(model, data.touches[i]).norm();
    }
    double *middle = data.sizes + data.count / 2;
    std::nth_element(data.sizes, middle, data.sizes + data.count);
    return std::max(median_to_sd * (1 + 5 / static_cast<double>(data.count)) * *middle, least_sd_mm);
}

/* Tukey's weights. */
static void weigh(touches_t &data, const geometry_t &model, double deviation) {
    for (size_t i = 0; i < data.count; ++i) {
        const double part = rest_of(model, data.touches[i]).norm() / (WH_GEOMETRY_ASIDE_SDS * deviation);
        const double left = part < 1 ? 1 - part * part : 0;
        data.weights[i] = left * left;
    }
}

/* The geometry that most touches agree with, found by robust weights from the best of many starts. */
static geometry_t find_agreed(touches_t &data, bool with_scales) {
    geometry_t best = {};
    double least = HUGE_VAL;
    for (uint32_t start = 0; start <= starts; ++start) {
        if (start == 0) {
            std::fill(data.weights, data.weights + data.count, 1);
        } else {
            draw(data, start);
        }
        geometry_t model = find_start(data);
        descend(data, &model, 12);
        const double deviation = deviation_of(data, model);
        if (deviation < least) {
            least = deviation;
            best = model;
        }
    }
    std::fill(best.is_free + WH_GEOMETRY_SCALE, best.is_free + WH_GEOMETRY_PARAMETERS, with_scales);
    for (int round = 0; round < 10; ++round) {
        weigh(data, best, deviation_of(data, best));
        descend(data, &best, 6);
    }
    return best;
}

Matrix3d pull_of(const geometry_rows_t &rows, const geometry_t &model, const wh_touch_t &touch) {
    constexpr double unknown = 1e4;
    const jacobian_t by = jacobian_of(model, touch.axes);
    Eigen::Matrix<double, WH_GEOMETRY_PARAMETERS, 3> pulls;
    for (int i = 0; i < 3; ++i) {
        pulls.col(i) = rows.pull(by.row(i).transpose()) + unknown * rows.unseen_part(by.row(i).transpose());
    }
    return pulls.transpose().lazyProduct(pulls); /* a general product would link to the heap */
}

/* The distance of a touch, in deviations, minus its own pull on the fit, or plus the fit's possible error
 * without it. Directions that only this touch determines do not count. */
static double distance_of(const touches_t &data, const geometry_rows_t &rows, const geometry_t &model,
                          size_t i) {
    constexpr double alone = 1e-6;
    const wh_touch_t &touch = data.touches[i];
    const own_t own = own_of(pull_of(rows, model, touch));
    const Vector3d along = own.vectors.transpose() * rest_of(model, touch);
    double square = 0;
    for (int k = 0; k < 3; ++k) {
        const double pull = own.values(k);
        const double variance = data.is_used[i] ? 1 - pull : 1 + pull;
        square += variance > alone ? along(k) * along(k) / variance : 0;
    }
    return std::sqrt(square);
}

/* Decides which touches are used, and sets their weights. Returns their number; `is_same` is set if they
 * are the same as before. */
static size_t set_aside(touches_t &data, const geometry_t &model, double sd, bool *is_same) {
    const geometry_rows_t rows = rows_of(data, model);
    size_t used = 0;
    *is_same = true;
    for (size_t i = 0; i < data.count; ++i) {
        const bool is_near = distance_of(data, rows, model, i) <= WH_GEOMETRY_ASIDE_SDS * sd;
        *is_same = *is_same && is_near == data.is_used[i];
        data.sizes[i] = is_near ? 1 : 0;
        used += is_near ? 1 : 0;
    }
    for (size_t i = 0; i < data.count; ++i) {
        data.is_used[i] = data.sizes[i] > 0;
        data.weights[i] = data.sizes[i];
    }
    return used;
}

size_t fit_agreed(touches_t &data, bool with_scales, geometry_t *model, double *sd) {
    size_t used = data.count;
    bool is_same = false;
    *model = find_agreed(data, with_scales);
    *sd = deviation_of(data, *model);
    for (size_t i = 0; i < data.count; ++i) {
        data.is_used[i] = rest_of(*model, data.touches[i]).norm() <= WH_GEOMETRY_ASIDE_SDS * *sd;
        data.weights[i] = data.is_used[i] ? 1 : 0;
    }
    for (int round = 0; round < 8 && !is_same && used >= WH_GEOMETRY_TOUCHES; ++round) {
        descend(data, model, 60);
        used = set_aside(data, *model, *sd, &is_same);
        model->squares = squares_of(data, *model);
        const double freedom = 3 * static_cast<double>(used) - rows_of(data, *model).rank();
        *sd = std::max(std::sqrt(model->squares / std::max(freedom, 1.0)), least_sd_mm);
    }
    descend(data, model, 60);
    return used;
}

} // namespace wh_estimate
