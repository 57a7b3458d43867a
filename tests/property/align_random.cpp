/* Random wafers on random chucks: how far circle, notch and flats of a scan are from the truth and from what is
 * stated; verdicts; the circle by Eigen; and scans, rims and sensors that are none. WH_ALIGN_WAFERS=n takes so many wafers. */
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <unsupported/Eigen/NonLinearOptimization>
#include <vector>

#include "support/support.h"

#include "align/align.h"
#include "align/calibration.h"

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double rad = pi / 180;
constexpr double um = 1e-3;
constexpr int samples = 3600;

int wafers() {
    const char *text = std::getenv("WH_ALIGN_WAFERS");
    return text == nullptr ? 500 / WH_TEST_SHARE : std::max(1, std::atoi(text));
}

/* What a scan is taken of, and with what. */
struct Chuck {
    wh_rim_t rim;
    wh_placement_t placement;
    wh_sensor_t sensor;
    wh_trial_t trial;
    int64_t first;
    int way;
};

struct Scan {
    std::vector<wh_rim_point_t> points;
    std::vector<wh_rim_ray_t> rays;
    wh_rim_scan_t scan;
    explicit Scan(const Chuck &chuck) : Scan(chuck, chuck.sensor.error) {
    }
    Scan(const Chuck &chuck, const wh_sensor_error_t &believed) : points(samples), rays(samples) {
        for (size_t i = 0; i < samples; ++i) {
            const double turn =
                wh_sensor_angle(&chuck.sensor, chuck.first + chuck.way * static_cast<int64_t>(i));
            const wh_glance_t glance = {turn, chuck.way * 2 * pi, chuck.trial, static_cast<uint32_t>(i)};
            const int32_t sample = wh_sensor_read(&chuck.sensor, &chuck.rim, &chuck.placement, &glance);
            points[i] = wh_sensor_point(&chuck.sensor, &believed, &glance, sample);
        }
        scan = {points.data(), points.size(), believed.offset, chuck.sensor.pixel};
    }
    Scan(const Scan &) = delete;
    Scan &operator=(const Scan &) = delete;
    wh_status_t fit(wh_circle_t &circle) {
        return wh_circle_fit(&scan, rays.data(), &circle);
    }
};

wh_rim_t draw_notched() {
    wh_rim_t rim = wh_rim_nominal(150);
    rim.notch.depth += wh_test_uniform(0, 0.25);
    rim.notch.opening += wh_test_uniform(-1, 5) * rad;
    rim.notch.corner = wh_test_uniform(0, 0.2);
    return rim;
}

/* The secondary flat is a quarter or half of a turn away. */
wh_rim_t draw_flat() {
    wh_rim_t rim = wh_rim_nominal(75);
    if (wh_test_below(2)) {
        rim.flats[1].length = 37.5;
        rim.flats[1].direction = wh_test_below(2) ? -pi / 2 : pi;
    }
    return rim;
}

/* Noise of 5 um. A wafer in four has flats. */
Chuck draw(int wafer) {
    Chuck chuck;
    const bool flat = wafer % 4 == 3;
    chuck.rim = flat ? draw_flat() : draw_notched();
    chuck.sensor = wh_sensor_nominal(chuck.rim.radius);
    chuck.rim.radius += wh_test_uniform(-0.1, 0.1);
    chuck.rim.bow = wh_test_uniform(-0.2, 0.2);
    chuck.rim.chip_count = static_cast<int32_t>(wh_test_below(3));
    for (int32_t i = 0; i < chuck.rim.chip_count; ++i) {
        wh_chip_t &chip = chuck.rim.chips[i];
        chip.direction = wh_test_uniform(-pi, pi);
        chip.width = wh_test_uniform(0.2, 4);
        chip.depth = wh_test_uniform(0.2, 1) * std::min(chip.width, 2.0);
    }
    const double e = (flat ? 7 : 10) * std::sqrt(wh_test_uniform(0, 1));
    const double phi = wh_test_uniform(-pi, pi);
    chuck.placement = {e * std::cos(phi), e * std::sin(phi), wh_test_uniform(-pi, pi)};
    wh_sensor_t &sensor = chuck.sensor;
    sensor.direction = wh_test_uniform(-pi, pi);
    sensor.encoder = wh_test_below(2) ? 65536 : 0;
    sensor.noise = 5 * um;
    sensor.tilt = wh_test_uniform(-0.05, 0.05);
    sensor.error = {wh_test_uniform(-0.2, 0.2), wh_test_uniform(-0.2, 0.2), wh_test_uniform(-1e-3, 1e-3),
                    wh_test_uniform(-1e-4, 1e-4)};
    sensor.hidden[0].from = wh_test_uniform(-pi, pi);
    chuck.trial = {wh_test_random(), static_cast<uint64_t>(wafer)};
    chuck.first = static_cast<int64_t>(wh_test_below(samples));
    chuck.way = wh_test_below(2) ? 1 : -1;
    wh_bad_field_t bad = {nullptr, WH_NONE};
    assert_int_equal(wh_rim_validate(&chuck.rim, &bad), WH_OK);
    assert_int_equal(wh_sensor_validate(&chuck.sensor, &bad), WH_OK);
    return chuck;
}

void hide(Chuck &chuck, double degrees) {
    chuck.sensor.hidden_count = degrees > 0 ? 1 : 0;
    chuck.sensor.hidden[0].width = degrees * rad;
}

/* -------------------------------------------------------------------------------------------- the truth */

/* The worst of all wafers, and the mean square in units of the stated deviations. */
struct Errors {
    double centre = 0, deviations = 0, squares = 0;
    int count = 0;

    void see(const wh_circle_t &circle, const wh_placement_t &truth, double limit) {
        const double x = circle.x - truth.x;
        const double y = circle.y - truth.y;
        const double off = std::hypot(x, y);
        assert_true(off <= limit);
        centre = std::max(centre, off);
        deviations = std::max(
            {deviations, off / circle.sd_centre, std::fabs(x) / circle.sd_x, std::fabs(y) / circle.sd_y});
        squares += std::pow(x / circle.sd_x, 2) + std::pow(y / circle.sd_y, 2);
        ++count;
    }
    void finish(double degrees) const {
        const double honest = std::sqrt(squares / (2 * count));
        std::printf("%3.0f degrees hidden: %d wafers, centre off by at most %.3f um, %.2f deviations of 6, "
                    "%.3f in the root mean square\n",
                    degrees, count, centre / um, deviations, honest);
        assert_true(deviations <= 6);
        assert_true(std::fabs(honest - 1) <= 0.1 + 3 / std::sqrt(count));
    }
};

/* With flats fewer samples count. With half of a turn hidden the stated deviations alone say how many less. */
void the_centre_is_as_near_as_it_says(void **) {
    static const struct {
        double degrees, limit, of_flats;
    } cases[] = {{0, 0.7 * um, 1 * um}, {60, 1 * um, 2 * um}, {180, 2.5 * um, INFINITY}};
    for (const auto &one : cases) {
        wh_test_seed();
        Errors errors;
        for (int wafer = 0; wafer < wafers(); ++wafer) {
            Chuck chuck = draw(wafer);
            hide(chuck, one.degrees);
            Scan scan(chuck);
            wh_circle_t circle;
            const bool flat = chuck.rim.notch.depth == 0;
            const wh_status_t status = scan.fit(circle);
            if (status == WH_STATUS_CENTRE_NOT_SURE && flat && one.degrees == 180) {
                continue; /* flats and chips leave less than half of what is seen */
            }
            assert_int_equal(status, WH_OK);
            errors.see(circle, chuck.placement, flat ? one.of_flats : one.limit);
        }
        errors.finish(one.degrees);
    }
}

/* ------------------------------------------------------------------------------------------------ Eigen */

/* Gauss and Newton by orthogonal factors of all rows, from the truth, with sines of the C library. */
struct Oracle {
    Eigen::Vector3d at;
    Eigen::Matrix3d inverse;
    double scatter = 0;

    Oracle(const Chuck &chuck, const Scan &scan)
        : at(chuck.placement.x, chuck.placement.y, chuck.rim.radius) {
        Eigen::Matrix<double, Eigen::Dynamic, 3> rows(samples, 3);
        Eigen::VectorXd off(samples);
        for (int round = 0; round < 6; ++round) {
            double weights = 0;
            for (int i = 0; i < samples; ++i) {
                const auto place = static_cast<size_t>(i);
                const double root = std::sqrt(scan.rays[place].weight);
                weights += scan.rays[place].weight;
                fill(scan.points[place], scan.scan.offset, rows, off, i);
                rows.row(i) *= root;
                off(i) = root > 0 ? root * off(i) : 0;
            }
            at += rows.colPivHouseholderQr().solve(off);
            scatter = std::sqrt(off.squaredNorm() / (weights - 3));
        }
        inverse = (rows.transpose() * rows).inverse();
    }
    void fill(const wh_rim_point_t &point, double offset, Eigen::Matrix<double, Eigen::Dynamic, 3> &rows,
              Eigen::VectorXd &off, int i) const {
        const double c = std::cos(point.angle);
        const double s = std::sin(point.angle);
        const double q = offset + at(0) * s - at(1) * c;
        const double root = std::sqrt(at(2) * at(2) - q * q);
        rows.row(i) << c - q * s / root, s + q * c / root, at(2) / root;
        off(i) = point.radius - (at(0) * c + at(1) * s + root);
    }
};

/* Of normal noise, Tukey's weights see this part of the mean square: the integrals of w x^2 and w, cut at 6
 * deviations. */
double seen_by_tukey() {
    double squares = 0;
    double weights = 0;
    for (int i = -6000; i <= 6000; ++i) {
        const double x = i * 1e-3;
        const double w = std::pow(1 - x * x / 36, 2) * std::exp(-x * x / 2);
        squares += w * x * x;
        weights += w;
    }
    return squares / weights;
}

/* The squares of the sums of 24 blocks against the sum of the squares, if they are more than double of noise's. */
double inflated(const Scan &scan) {
    std::vector<double> weighted;
    for (const wh_rim_ray_t &ray : scan.rays) {
        if (ray.weight > 0) {
            weighted.push_back(ray.weight * ray.residual);
        }
    }
    const Eigen::Map<Eigen::VectorXd> all(weighted.data(), static_cast<Eigen::Index>(weighted.size()));
    const Eigen::Index size = all.size() / 24 + 1;
    double blocks = 0;
    for (Eigen::Index first = 0; first < all.size(); first += size) {
        blocks += std::pow(all.segment(first, std::min(size, all.size() - first)).sum(), 2);
    }
    const double times = blocks / all.squaredNorm() * 24 / 21;
    return times > 2 ? times : 1;
}

void the_fit_is_eigens(void **) {
    wh_test_seed();
    const double seen = seen_by_tukey();
    double position = 0;
    double deviation = 0;
    for (int wafer = 0; wafer < wafers() / 5 + 1; ++wafer) {
        Chuck chuck = draw(wafer);
        hide(chuck, wafer % 3 * 90);
        Scan scan(chuck);
        wh_circle_t circle;
        assert_int_equal(scan.fit(circle), WH_OK);
        const Oracle oracle(chuck, scan);
        const double scatter = oracle.scatter / std::sqrt(seen);
        const double inflation = inflated(scan);
        const Eigen::Vector3d fitted(circle.x, circle.y, circle.radius);
        const Eigen::Vector3d stated(circle.sd_x, circle.sd_y, circle.sd_radius);
        const Eigen::Vector3d wanted = scatter * std::sqrt(inflation) * oracle.inverse.diagonal().cwiseSqrt();
        const double largest =
            scatter * std::sqrt(inflation) *
            std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(oracle.inverse.topLeftCorner<2, 2>())
                          .eigenvalues()(1));
        position = std::max(position, (fitted - oracle.at).cwiseAbs().maxCoeff());
        deviation =
            std::max({deviation, (stated - wanted).cwiseQuotient(wanted).cwiseAbs().maxCoeff(),
                      std::fabs(circle.sd_centre / largest - 1), std::fabs(circle.scatter / scatter - 1),
                      std::fabs(circle.inflation / inflation - 1)});
        assert_true(circle.used > 0 && circle.used <= circle.seen && circle.seen <= scan.points.size());
    }
    std::printf("off Eigen's by at most %.2e mm; the deviations by a part of %.2e\n", position, deviation);
    assert_true(position <= 1e-9);
    assert_true(deviation <= 1e-4);
}

/* ------------------------------------------------------------------------------------------------ the whole */

/* Up to 2 mm wide, at most half as deep: less than a notch, whatever their number. */
void chip(wh_rim_t &rim) {
    rim.chip_count = 1 + static_cast<int32_t>(wh_test_below(3));
    for (int32_t i = 0; i < rim.chip_count; ++i) {
        wh_chip_t &one = rim.chips[i];
        one.direction = wh_test_uniform(-pi, pi);
        one.width = wh_test_uniform(0.2, 2);
        one.depth = wh_test_uniform(0.1, 0.5) * one.width;
    }
}

/* Wider and deeper than a notch, some of them. */
void chip_deeply(wh_rim_t &rim) {
    chip(rim);
    for (int32_t i = 0; i < rim.chip_count; ++i) {
        rim.chips[i].width = wh_test_uniform(0.5, 5);
        rim.chips[i].depth = wh_test_uniform(0.2, 1) * std::min(rim.chips[i].width, 2.5);
    }
}

/* One chip, where it takes away some of the notch. */
void chip_the_notch(wh_rim_t &rim) {
    chip(rim);
    rim.chip_count = 1;
    rim.chips[0].direction = rim.notch.direction + wh_test_uniform(-2.5, 2.5) / rim.radius;
}

void leave(wh_rim_t &) {
}

struct Crowd {
    const char *name;
    double noise, glass, degrees;
    void (*spoil)(wh_rim_t &);
    bool flat;
    double unsure; /* at most, a part */
};

/* What the verdicts of a crowd of wafers were worth. */
struct Verdicts {
    double largest = 0, deviations = 0, squares = 0, in_deviations = 0;
    int sure = 0, unsure = 0;

    void see(const wh_align_result_t &result, const Chuck &chuck) {
        if (result.verdict != WH_OK) {
            assert_int_not_equal(result.verdict, WH_STATUS_NO_NOTCH);
            ++unsure;
            return;
        }
        const double off =
            std::hypot(result.circle.x - chuck.placement.x, result.circle.y - chuck.placement.y);
        const double turn = std::fabs(std::remainder(result.turn - chuck.placement.turn, 2 * pi));
        assert_true(off <= 10 * um && off <= 6 * result.circle.sd_centre);
        assert_true(turn <= 0.05 * rad && turn <= 6 * result.sd_turn);
        largest = std::max(largest, turn / rad);
        deviations = std::max({deviations, off / result.circle.sd_centre, turn / result.sd_turn});
        squares += std::pow(turn / rad, 2);
        in_deviations += std::pow(turn / result.sd_turn, 2);
        ++sure;
    }
    void finish(const Crowd &crowd) const {
        const double honest = std::sqrt(in_deviations / sure);
        std::printf(
            "%s: %d sure, %d not; turn off by %.5f degrees rms, %.5f at most; %.2f deviations, %.3f rms\n",
            crowd.name, sure, unsure, std::sqrt(squares / sure), largest, deviations, honest);
        const double expected = crowd.unsure * (sure + unsure);
        assert_true(unsure <= expected + 3 * std::sqrt(expected) + 2); /* by chance some crowds have more */
        assert_true(std::fabs(honest - 1) <= 0.1 + 3 / std::sqrt(sure));
    }
};

wh_align_result_t estimate(const Chuck &chuck, Scan &scan) {
    wh_rim_t nominal = wh_rim_nominal(chuck.rim.notch.depth > 0 ? 150 : 75);
    nominal.flats[1] = chuck.rim.flats[1];
    nominal.transmission = chuck.rim.transmission;
    const wh_align_limits_t limits = wh_align_limits_default();
    wh_align_result_t result;
    assert_int_equal(
        wh_align_estimate(&scan.scan, &chuck.sensor, &nominal, &limits, scan.rays.data(), &result), WH_OK);
    return result;
}

/* Never wrong: the centre off by 10 um, the turn by 0.05 degrees, or one of them by 6 of its deviations. */
void a_verdict_is_right_or_not_sure(void **) {
    static const Crowd crowds[] = {
        {"clean", 5 * um, 0, 0, leave, false, 0.001},
        {"flats", 5 * um, 0, 0, leave, true, 0.001},
        {"chipped", 5 * um, 0, 0, chip, false, 0.02},
        {"20 um of noise", 20 * um, 0, 0, leave, false, 0.001},
        {"noise, chipped", 20 * um, 0, 0, chip, false, 0.02},
        {"glass", 5 * um, 0.5, 0, leave, false, 0.02},
        {"glass, chipped", 5 * um, 0.5, 0, chip, false, 0.02},
        {"glass, noise", 20 * um, 0.5, 0, leave, false, 0.5},
        {"glass, noise, chipped", 20 * um, 0.5, 0, chip, false, 0.5},
        {"deeply chipped", 5 * um, 0, 0, chip_deeply, false, 0.05},
        {"a chipped notch", 5 * um, 0, 0, chip_the_notch, false, 0.6},
        {"noise, a chipped notch", 20 * um, 0, 0, chip_the_notch, false, 0.5},
        {"half hidden", 5 * um, 0, 180, leave, false, 0.6},
        {"half hidden, chipped", 5 * um, 0, 180, chip, false, 0.6},
    };
    for (const Crowd &crowd : crowds) {
        wh_test_seed();
        Verdicts verdicts;
        for (int wafer = 0; wafer < wafers() / 2 + 1; ++wafer) {
            Chuck chuck = draw(crowd.flat ? 3 : 0);
            chuck.trial.trial = static_cast<uint64_t>(wafer);
            chuck.rim.chip_count = 0;
            chuck.rim.transmission = crowd.glass;
            chuck.sensor.noise = crowd.noise;
            hide(chuck, crowd.degrees);
            crowd.spoil(chuck.rim);
            Scan scan(chuck);
            verdicts.see(estimate(chuck, scan), chuck);
        }
        verdicts.finish(crowd);
    }
}

/* ------------------------------------------------------------------------------------------- marks by Eigen */

/* Straight lines in the circle's frame against samples: how far along its ray each sample is outside of its line, times
 * the root of its weight. A line is where n(a) . P = h, with the normal's direction a. */
struct Lines {
    using Scalar = double;
    using InputType = Eigen::VectorXd;
    using ValueType = Eigen::VectorXd;
    using JacobianType = Eigen::MatrixXd;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
    struct Sample {
        Eigen::Vector2d from, along; /* the ray */
        double radius, root;
        int side;
    };
    std::vector<Sample> taken;
    bool vee; /* three unknowns: axis, apex, half of the opening; else two: a chord's axis and height */
    double half = 0, part = 0; /* what is known of the opening */

    int inputs() const {
        return vee ? 3 : 2;
    }
    int values() const {
        return static_cast<int>(taken.size()) + (vee ? 1 : 0);
    }
    /* Of a T, double or complex: what it is at x + i h tells the derivatives at x exactly. */
    template <class T> T off(const Eigen::Matrix<T, Eigen::Dynamic, 1> &x, const Sample &sample) const {
        const T turned = vee ? x(0) + static_cast<double>(sample.side) * (x(2) - pi / 2) + pi : x(0);
        const T nx = std::cos(turned);
        const T ny = std::sin(turned);
        const T beyond =
            nx * (x(1) * std::cos(x(0)) - sample.from.x()) + ny * (x(1) * std::sin(x(0)) - sample.from.y());
        return sample.radius - beyond / (nx * sample.along.x() + ny * sample.along.y());
    }
    int df(const InputType &x, JacobianType &by) const {
        for (Eigen::Index p = 0; p < x.size(); ++p) {
            Eigen::VectorXcd at = x.cast<std::complex<double>>();
            at(p) += std::complex<double>(0, 1e-30);
            for (size_t i = 0; i < taken.size(); ++i) {
                by(static_cast<Eigen::Index>(i), p) = taken[i].root * off(at, taken[i]).imag() / 1e-30;
            }
            if (vee) {
                by(values() - 1, p) = p == 2 ? part : 0;
            }
        }
        return 0;
    }
    int operator()(const InputType &x, ValueType &out) const {
        for (size_t i = 0; i < taken.size(); ++i) {
            out(static_cast<Eigen::Index>(i)) = taken[i].root * off(x, taken[i]);
        }
        if (vee) {
            out(values() - 1) = part * (x(2) - half);
        }
        return 0;
    }
    Sample sample(const Scan &scan, const wh_circle_t &circle, size_t i) const {
        const double a = scan.points[i].angle;
        const Eigen::Vector2d along(std::cos(a), std::sin(a));
        const Eigen::Vector2d from(-scan.scan.offset * std::sin(a) - circle.x,
                                   scan.scan.offset * std::cos(a) - circle.y);
        return {from, along, scan.points[i].radius, 1, 1};
    }
    /* Levenberg and Marquardt's minimum from a start. */
    InputType minimum(InputType x) const {
        Lines lines = *this;
        Eigen::LevenbergMarquardt<Lines> solver(lines);
        solver.parameters.ftol = solver.parameters.xtol = solver.parameters.gtol = 0;
        solver.minimize(x);
        /* It ends where the sum of squares does not change any more, that is half of the digits: full steps tell the rest. */
        Eigen::VectorXd off_line(values());
        Eigen::MatrixXd by(values(), x.size());
        for (int again = 0; again < 4; ++again) {
            (*this)(x, off_line);
            df(x, by);
            x -= by.colPivHouseholderQr().solve(off_line);
        }
        return x;
    }
};

/* The samples of the dent about a direction, and of three next to each other on the circle it is no more. */
std::vector<size_t> dent_at(const Scan &scan, const wh_circle_t &circle, double direction) {
    const double least = std::max(6 * circle.scatter, 0.05);
    size_t middle = 0;
    double nearest = INFINITY;
    for (size_t i = 0; i < samples; ++i) {
        const double a = scan.points[i].angle;
        const double x = scan.points[i].radius * std::cos(a) - scan.scan.offset * std::sin(a) - circle.x;
        const double y = scan.points[i].radius * std::sin(a) + scan.scan.offset * std::cos(a) - circle.y;
        const double away = std::fabs(std::remainder(std::atan2(y, x) - direction, 2 * pi));
        middle = away < nearest ? i : middle;
        nearest = std::min(nearest, away);
    }
    std::vector<size_t> dent;
    for (const size_t by : {size_t{1}, size_t{samples - 1}}) {
        std::vector<size_t> side;
        size_t last = 0;
        for (size_t i = middle, out = 0; out < 3; i = (i + by) % samples) {
            side.push_back(i);
            out = scan.rays[i].residual < -least ? 0 : out + 1;
            last = out == 0 ? side.size() : last;
        }
        side.resize(last);
        if (by == 1) {
            dent = side;
        } else {
            dent.insert(dent.begin(), side.rbegin(), side.rend() - 1); /* the middle is there */
        }
    }
    return dent;
}

double tukey(double off, double scatter) {
    const double part = off / (6 * scatter);
    return std::fabs(part) < 1 ? 1 - part * part : 0; /* the root of the weight */
}

/* The least squares with the weights that a V, which is x, gives to the samples of the notch; how many count. */
Eigen::VectorXd after(const Eigen::VectorXd &x, const Scan &scan, const wh_circle_t &circle, size_t &used) {
    const double bottom = wh_rim_nominal(150).notch.bottom;
    const double full = circle.radius - x(1) - bottom * (1 / std::sin(x(2)) - 1);
    Lines lines;
    lines.vee = true;
    lines.half = (90 / 2. + 0.75) * rad;
    lines.part = circle.scatter / (0.75 * rad);
    for (const size_t i : dent_at(scan, circle, x(0))) {
        Lines::Sample sample = lines.sample(scan, circle, i);
        const Eigen::Vector2d rim = sample.from + sample.radius * sample.along;
        sample.side = rim.y() * std::cos(x(0)) - rim.x() * std::sin(x(0)) < 0 ? -1 : 1;
        const double off = lines.off(x, sample);
        const double depth = off - scan.rays[i].residual;
        sample.root = tukey(off, circle.scatter);
        if (depth >= 0.08 * full && depth <= 0.7 * full && sample.root > 0) {
            lines.taken.push_back(sample);
        }
    }
    used = lines.taken.size();
    Eigen::VectorXd start = x;
    start(0) += 1e-4;
    start(1) += 0.02;
    start(2) -= 0.01;
    return lines.minimum(start);
}

/* How far direction (rad), apex (mm) and opening (rad) are from Eigen's; -1 if there is no such V, since the samples that
 * count come and go. */
double notch_off(const Scan &scan, const wh_align_result_t &result) {
    const wh_notch_t &notch = result.notch;
    const double half = notch.opening / 2;
    const double below = wh_rim_nominal(150).notch.bottom * (1 / std::sin(half) - 1);
    Eigen::VectorXd x(3);
    x << notch.direction, result.circle.radius - notch.depth - below, half;
    size_t used = 0;
    const Eigen::VectorXd found = after(x, scan, result.circle, used);
    const double off = (found - x).cwiseAbs().maxCoeff();
    if (off > 1e-9 && (after(found, scan, result.circle, used) - found).cwiseAbs().maxCoeff() > 1e-9) {
        return -1;
    }
    assert_int_equal(used, notch.used);
    return off;
}

double flat_off(const Scan &scan, const wh_circle_t &circle, const wh_flat_t &flat) {
    Lines lines;
    lines.vee = false;
    Eigen::VectorXd x(2);
    x << flat.direction, std::sqrt(circle.radius * circle.radius - flat.length * flat.length / 4);
    const std::vector<size_t> dent = dent_at(scan, circle, flat.direction);
    for (size_t k = 3; k + 3 < dent.size(); ++k) {
        Lines::Sample sample = lines.sample(scan, circle, dent[k]);
        sample.root = tukey(lines.off(x, sample), circle.scatter);
        if (sample.root > 0) {
            lines.taken.push_back(sample);
        }
    }
    if (lines.taken.size() != flat.used) {
        return -1;
    }
    Eigen::VectorXd start = x;
    start(0) += 1e-4;
    start(1) += 0.02;
    return (lines.minimum(start) - x).cwiseAbs().maxCoeff();
}

wh_align_result_t estimate(const Chuck &chuck, Scan &scan);

/* With the weights that the fitted marks give to their samples. */
void the_marks_are_eigens(void **) {
    wh_test_seed();
    double largest[2] = {0, 0};
    int compared[2] = {0, 0};
    int others[2] = {0, 0};
    for (int wafer = 0; wafer < wafers() / 5 + 1; ++wafer) {
        Chuck chuck = draw(wafer % 2 ? 3 : 0);
        chuck.rim.chip_count = 0;
        chuck.sensor.noise = (wafer % 4 < 2 ? 5 : 20) * um;
        Scan scan(chuck);
        const wh_align_result_t result = estimate(chuck, scan);
        for (int f = 0; f < 2 && result.verdict == WH_OK; ++f) {
            const bool vee = wafer % 2 == 0;
            if (vee ? f == 1 : result.flats[f].length == 0) {
                continue;
            }
            const double off = vee ? notch_off(scan, result) : flat_off(scan, result.circle, result.flats[f]);
            ++(off < 0 ? others : compared)[vee];
            largest[vee] = std::max(largest[vee], off);
        }
    }
    std::printf("off Eigen's by at most %.2e mm or rad in %d notches (%d have none), %.2e in %d "
                "flats (%d)\n",
                largest[1], compared[1], others[1], largest[0], compared[0], others[0]);
    for (int kind = 0; kind < 2; ++kind) {
        assert_true(compared[kind] > 5 * others[kind]);
        assert_true(largest[kind] <= 1e-9);
    }
}

/* Most samples may count the same pixels. */
void a_wafer_in_the_middle_is_told(void **) {
    wh_test_seed();
    double worst = 0;
    for (int wafer = 0; wafer < 4 * wafers(); ++wafer) {
        Chuck chuck = draw(wafer);
        const double nearer = wh_test_uniform(0, 2e-3);
        chuck.placement.x *= nearer;
        chuck.placement.y *= nearer;
        Scan scan(chuck);
        wh_circle_t circle;
        assert_int_equal(scan.fit(circle), WH_OK);
        const double off = std::hypot(circle.x - chuck.placement.x, circle.y - chuck.placement.y);
        worst = std::max(worst, off / circle.sd_centre);
    }
    std::printf("in the middle: off by at most %.2f deviations\n", worst);
    assert_true(worst <= 6);
}

/* Without noise, or with less than a pixel of it, many neighbours count the same pixels: the more the nearer to the middle. */
void a_scan_is_no_better_than_its_pixels(void **) {
    wh_test_seed();
    for (const double noise : {0.0, 0.5 * um, 2 * um}) {
        double worst = 0;
        double squares = 0;
        for (int wafer = 0; wafer < 4 * wafers(); ++wafer) {
            Chuck chuck = draw(wafer);
            const double nearer = std::pow(10, wh_test_uniform(-5, 0));
            chuck.placement.x *= nearer;
            chuck.placement.y *= nearer;
            chuck.sensor.noise = noise;
            chuck.sensor.pixel = wh_test_below(2) ? 7 * um : 14 * um;
            Scan scan(chuck);
            wh_circle_t circle;
            const wh_status_t status = scan.fit(circle);
            if (status == WH_STATUS_BAD_SCAN && nearer < 2e-3) {
                continue; /* all samples the same */
            }
            assert_int_equal(status, WH_OK);
            const double off = std::hypot(circle.x - chuck.placement.x, circle.y - chuck.placement.y);
            worst = std::max(worst, off / circle.sd_centre);
            squares += std::pow(off / circle.sd_centre, 2) / (4 * wafers());
        }
        std::printf("%.1f um of noise: off by at most %.2f deviations, %.2f in the root mean square\n",
                    noise / um, worst, std::sqrt(squares));
        assert_true(worst <= 6);
    }
}

/* ------------------------------------------------------------------------------------------- calibration */

/* Scans of a known wafer in two places, both ways of turning, as a controller has them that believes in no error. */
struct Reference {
    Chuck chuck;
    std::vector<std::vector<wh_rim_point_t>> points;
    std::vector<wh_calibration_scan_t> scans;
    wh_rim_point_t work[samples];
    wh_rim_ray_t rays[samples];

    /* The second place is 14 mm from the first one, the axis about half way; `off` is how wrong the way is. */
    Reference(const Chuck &with, double off) : chuck(with), points(4) {
        static const wh_sensor_error_t none = {0, 0, 0, 0};
        const double to = wh_test_uniform(-pi, pi);
        const double wrong = wh_test_uniform(-pi, pi);
        for (size_t i = 0; i < 4; ++i) {
            Chuck at = chuck;
            const double along = i < 2 ? 0 : 14;
            at.way = i % 2 ? -1 : 1;
            at.trial.trial += i;
            at.placement.x += (along - 7) * std::cos(to) + (i < 2 ? 0 : off * std::cos(wrong));
            at.placement.y += (along - 7) * std::sin(to) + (i < 2 ? 0 : off * std::sin(wrong));
            const Scan scan(at, none);
            points[i] = scan.points;
            scans.push_back({points[i].data(), points[i].size(), at.way * 2 * pi, along * std::cos(to),
                             along * std::sin(to)});
        }
    }
    wh_status_t solve(double sd_way, wh_calibration_t &found, int32_t *bad) {
        return wh_calibration_solve(&chuck.sensor, chuck.rim.radius, sd_way, scans.data(), scans.size(), work,
                                    rays, &found, bad);
    }
};

/* A sensor off by 0.1 mm, 20 us and 0.1 %, and a known wafer about 1 mm from the axis. */
Chuck draw_off_sensor() {
    Chuck chuck = draw(0);
    chuck.sensor.error = {wh_test_uniform(-0.1, 0.1), wh_test_uniform(-0.2, 0.2),
                          wh_test_uniform(-1e-3, 1e-3), wh_test_uniform(-20e-6, 20e-6)};
    chuck.rim.chip_count = 0;
    chuck.rim.bow = 0;
    chuck.placement.x /= 10;
    chuck.placement.y /= 10;
    return chuck;
}

/* By how many of its deviations it is off at most. */
double off_by(const wh_calibration_t &found, const wh_sensor_error_t &truth) {
    return std::max({std::fabs(found.error.offset - truth.offset) / found.sd_offset,
                     std::fabs(found.error.zero - truth.zero) / found.sd_zero,
                     std::fabs(found.error.gain - truth.gain) / found.sd_gain,
                     std::fabs(found.error.latency - truth.latency) / found.sd_latency});
}

/* How far the centre of another wafer, 10 mm off, is from the truth. */
double centre_off(const Chuck &of, const wh_sensor_error_t &believed) {
    Chuck chuck = of;
    const double phi = wh_test_uniform(-pi, pi);
    chuck.placement = {10 * std::cos(phi), 10 * std::sin(phi), wh_test_uniform(-pi, pi)};
    chuck.rim.radius = 150 + wh_test_uniform(-0.1, 0.1);
    Scan scan(chuck, believed);
    wh_circle_t circle;
    assert_int_equal(scan.fit(circle), WH_OK);
    return std::hypot(circle.x - chuck.placement.x, circle.y - chuck.placement.y);
}

/* With a way that is known to 0, and to 0.5 um: the worst of all centres. */
void a_calibrated_sensor_tells_the_centre(void **) {
    for (const double sd_way : {0.0, 0.5 * um}) {
        wh_test_seed();
        double before = 0;
        double after = 0;
        double deviations = 0;
        for (int round = 0; round < wafers() / 5 + 1; ++round) {
            const Chuck chuck = draw_off_sensor();
            Reference reference(chuck, wh_test_uniform(-2, 2) * sd_way);
            wh_calibration_t found;
            int32_t bad = 7;
            assert_int_equal(reference.solve(sd_way, found, &bad), WH_OK);
            deviations = std::max(deviations, off_by(found, chuck.sensor.error));
            before = std::max(before, centre_off(chuck, {0, 0, 0, 0}));
            after = std::max(after, centre_off(chuck, found.error));
        }
        std::printf("way known to %.1f um: centre off by at most %.2f um, %.3f um calibrated; errors by %.2f "
                    "deviations\n",
                    sd_way / um, before / um, after / um, deviations);
        assert_true(before > 7 * um);
        assert_true(after <= 2 * um);
        assert_true(deviations <= 6);
    }
}

/* What it has to say of scans that are wrong in one way; nothing has changed. */
void what_calibrates_nothing_is_refused(void **) {
    wh_test_seed();
    static const wh_status_t wanted[] = {
        WH_STATUS_TOO_FEW_SAMPLES, WH_STATUS_OUT_OF_RANGE,    WH_STATUS_NOT_FINITE,
        WH_STATUS_OUT_OF_RANGE,    WH_STATUS_NULL_ARGUMENT,   WH_STATUS_CENTRE_NOT_SURE,
        WH_STATUS_CENTRE_NOT_SURE, WH_STATUS_CENTRE_NOT_SURE, WH_STATUS_BAD_SCAN,
        WH_STATUS_CENTRE_NOT_SURE, WH_STATUS_CENTRE_NOT_SURE};
    static const int32_t wanted_bad[] = {WH_NONE, 1, 2, 3, 1, WH_NONE, WH_NONE, WH_NONE, 2, WH_NONE, WH_NONE};
    for (size_t way = 0; way < sizeof wanted / sizeof wanted[0]; ++way) {
        Reference reference(draw_off_sensor(), 0);
        std::vector<wh_calibration_scan_t> &scans = reference.scans;
        switch (way) {
        case 0:
            scans.pop_back();
            break;
        case 1:
            scans[1].speed = -101;
            break;
        case 2:
            scans[2].way_x = NAN;
            break;
        case 3:
            scans[3].count = WH_SENSOR_SAMPLES + 1;
            break;
        case 4:
            scans[1].points = nullptr;
            break;
        case 5: /* not moved */
            scans[2].way_x = scans[3].way_x = scans[2].way_y = scans[3].way_y = 0;
            break;
        case 6: /* the chuck turned one way only */
            scans[1].speed = scans[3].speed = scans[0].speed;
            break;
        case 7: /* moved by 10 % less than it says */
            scans[2].way_x *= 1.1, scans[3].way_x *= 1.1, scans[2].way_y *= 1.1, scans[3].way_y *= 1.1;
            break;
        case 8:
            reference.points[2][7].radius = NAN;
            break;
        case 9: /* another wafer */
            reference.chuck.rim.radius += 1.5;
            break;
        default: /* one of two scans of a place is of another place */
            scans[3].way_x += 0.1;
        }
        wh_calibration_t found;
        std::memset(&found, 0x5a, sizeof found);
        const wh_calibration_t before = found;
        int32_t bad = 7;
        const wh_status_t status = reference.solve(1 * um, found, &bad);
        if (status != wanted[way] || bad != wanted_bad[way]) {
            print_error("way %u: %s, scan %d\n", static_cast<unsigned>(way), wh_status_name(status), bad);
        }
        assert_int_equal(status, wanted[way]);
        assert_int_equal(bad, wanted_bad[way]);
        assert_memory_equal(&found, &before, sizeof found);
    }
}

/* -------------------------------------------------------------------------------------------- bad input */

/* Makes the scan wrong in one way; what the fit has to say of it. */
wh_status_t spoil(Scan &scan, uint32_t way) {
    const size_t i = 1 + wh_test_below(samples - 2);
    wh_rim_point_t &point = scan.points[i];
    static const double none[] = {NAN, INFINITY, -INFINITY};
    static const double bad_radius[] = {NAN, INFINITY, -INFINITY, 0.99, 1000.01, -150};
    static const double bad_offset[] = {NAN, INFINITY, -1.001, 1.001};
    static const double bad_pixel[] = {NAN, INFINITY, -1e-9, 0.1001};
    switch (way) {
    case 0:
        point.angle = none[wh_test_below(3)];
        return WH_STATUS_BAD_SCAN;
    case 1:
        point.sight = WH_SIGHT_RIM;
        point.radius = bad_radius[wh_test_below(6)];
        return WH_STATUS_BAD_SCAN;
    case 2:
        point.angle = scan.points[i + 1].angle;
        return WH_STATUS_BAD_SCAN;
    case 3:
        std::swap(point.angle, scan.points[i - 1].angle);
        return WH_STATUS_BAD_SCAN;
    case 4:
        scan.points.back().angle =
            scan.points[0].angle + (point.angle > scan.points[0].angle ? 2 : -2) * 3.1416;
        return WH_STATUS_BAD_SCAN;
    case 5:
        scan.scan.offset = bad_offset[wh_test_below(4)];
        return WH_STATUS_OUT_OF_RANGE;
    case 6:
        scan.scan.pixel = bad_pixel[wh_test_below(4)];
        return WH_STATUS_OUT_OF_RANGE;
    case 7:
        scan.scan.count = WH_SENSOR_SAMPLES + 1;
        return WH_STATUS_OUT_OF_RANGE;
    case 8:
        scan.scan.count = wh_test_below(WH_SCAN_LEAST);
        return WH_STATUS_TOO_FEW_SAMPLES;
    case 9:
        for (size_t k = WH_SCAN_LEAST - 1; k < samples; ++k) {
            scan.points[k].sight = wh_test_below(2) ? WH_SIGHT_NOTHING : WH_SIGHT_COVERED;
        }
        return WH_STATUS_TOO_FEW_SAMPLES;
    case 10:
        for (wh_rim_point_t &each : scan.points) {
            each.radius = 150;
        }
        return WH_STATUS_BAD_SCAN;
    default:
        for (wh_rim_point_t &each : scan.points) {
            each.radius = wh_test_uniform(140, 160);
        }
        return WH_STATUS_CENTRE_NOT_SURE;
    }
}

void what_is_no_scan_is_refused(void **) {
    wh_test_seed();
    for (uint32_t round = 0; round < 240; ++round) {
        Chuck chuck = draw(static_cast<int>(round));
        Scan scan(chuck);
        wh_circle_t circle;
        std::memset(&circle, 0x5a, sizeof circle);
        const wh_circle_t before = circle;
        const wh_status_t wanted = spoil(scan, round % 12);
        const wh_status_t status = scan.fit(circle);
        if (status != wanted) {
            print_error("way %u: %s\n", static_cast<unsigned>(round % 12), wh_status_name(status));
        }
        assert_int_equal(status, wanted);
        assert_memory_equal(&circle, &before, sizeof circle);
    }
}

/* A field, and one value on each side of what it may be. */
struct Field {
    double *value;
    const char *name;
    int32_t index;
    double below, above;
};

template <class Thing>
void each_field_is_looked_at(Thing &thing, const std::vector<Field> &fields,
                             wh_status_t (*validate)(const Thing *, wh_bad_field_t *)) {
    assert_int_equal(validate(&thing, nullptr), WH_OK);
    assert_int_equal(validate(nullptr, nullptr), WH_STATUS_NULL_ARGUMENT);
    for (const Field &field : fields) {
        const double good = *field.value;
        for (const double wrong :
             {field.below, field.above, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
            *field.value = wrong;
            wh_bad_field_t bad = {nullptr, -7};
            assert_int_equal(validate(&thing, &bad),
                             std::isfinite(wrong) ? WH_STATUS_OUT_OF_RANGE : WH_STATUS_NOT_FINITE);
            assert_string_equal(bad.name, field.name);
            assert_int_equal(bad.index, field.index);
        }
        *field.value = good;
    }
    assert_int_equal(validate(&thing, nullptr), WH_OK);
}

void wrong_rims_and_sensors_are_named(void **) {
    wh_rim_t rim = wh_rim_nominal(150);
    rim.chip_count = 2;
    rim.chips[0] = rim.chips[1] = {1, 2, 1};
    each_field_is_looked_at<wh_rim_t>(rim,
                                      {{&rim.radius, "radius", WH_NONE, 9.9, 300.1},
                                       {&rim.notch.depth, "notch.depth", WH_NONE, 0.19, 3.1},
                                       {&rim.notch.direction, "notch.direction", WH_NONE, -6.3, 6.3},
                                       {&rim.notch.opening, "notch.opening", WH_NONE, 0.99, 2.11},
                                       {&rim.notch.bottom, "notch.bottom", WH_NONE, -0.1, 2.1},
                                       {&rim.notch.corner, "notch.corner", WH_NONE, -0.1, 1.1},
                                       {&rim.flats[0].length, "flats.length", 0, 1.9, 210.1},
                                       {&rim.flats[1].direction, "flats.direction", 1, -6.3, 6.3},
                                       {&rim.chips[0].direction, "chips.direction", 0, -6.3, 6.3},
                                       {&rim.chips[0].width, "chips.width", 0, 0, 30.1},
                                       {&rim.chips[1].depth, "chips.depth", 1, -0.1, 2.1},
                                       {&rim.bow, "bow", WH_NONE, -2.1, 2.1},
                                       {&rim.saddle, "saddle", WH_NONE, -2.1, 2.1},
                                       {&rim.saddle_direction, "saddle_direction", WH_NONE, -6.3, 6.3},
                                       {&rim.transmission, "transmission", WH_NONE, -0.1, 0.91}},
                                      wh_rim_validate);
    wh_sensor_t sensor = wh_sensor_nominal(150);
    sensor.hidden_count = 2;
    sensor.hidden[0] = sensor.hidden[1] = {0, 1};
    each_field_is_looked_at<wh_sensor_t>(sensor,
                                         {{&sensor.direction, "direction", WH_NONE, -6.3, 6.3},
                                          {&sensor.middle, "middle", WH_NONE, 9.9, 300.1},
                                          {&sensor.length, "length", WH_NONE, 1.9, 100.1},
                                          {&sensor.pixel, "pixel", WH_NONE, 0.0009, 0.11},
                                          {&sensor.noise, "noise", WH_NONE, -0.01, 0.11},
                                          {&sensor.tilt, "tilt", WH_NONE, -0.51, 0.51},
                                          {&sensor.error.offset, "error.offset", WH_NONE, -1.1, 1.1},
                                          {&sensor.error.zero, "error.zero", WH_NONE, -1.1, 1.1},
                                          {&sensor.error.gain, "error.gain", WH_NONE, -0.011, 0.011},
                                          {&sensor.error.latency, "error.latency", WH_NONE, -0.0011, 0.0011},
                                          {&sensor.hidden[0].from, "hidden.from", 0, -6.3, 6.3},
                                          {&sensor.hidden[1].width, "hidden.width", 1, 0, 6.3}},
                                         wh_sensor_validate);
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_centre_is_as_near_as_it_says),
        cmocka_unit_test(a_wafer_in_the_middle_is_told),
        cmocka_unit_test(a_scan_is_no_better_than_its_pixels),
        cmocka_unit_test(the_fit_is_eigens),
        cmocka_unit_test(the_marks_are_eigens),
        cmocka_unit_test(a_calibrated_sensor_tells_the_centre),
        cmocka_unit_test(what_calibrates_nothing_is_refused),
        cmocka_unit_test(a_verdict_is_right_or_not_sure),
        cmocka_unit_test(what_is_no_scan_is_refused),
        cmocka_unit_test(wrong_rims_and_sensors_are_named),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
