/* Random wafers on random chucks: the errors of a scan's circle, notch and flats, compared with the
 * truth and with the stated deviations; verdicts; the circle by Eigen; and scans, rims and sensors
 * that are invalid. */
/* Plain alone: under sanitizers align_test and scanning_test call the same functions of lib/align,
 * without a minute of Eigen. */
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "support/support.h"

#include "align/align.h"
#include "align/calibration.h"

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double rad = pi / 180;
constexpr double um = 1e-3;
constexpr int samples = 3600;

/* The wafer that is scanned, and the chuck and sensor that scan it. */
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

/* With flats fewer samples count. If half of a turn is hidden, only the stated deviations say how
 * many fewer. */
void the_centre_is_as_near_as_it_says(void **) {
    static const struct {
        double degrees, limit, of_flats;
    } cases[] = {{0, 0.7 * um, 1 * um}, {60, 1 * um, 2 * um}, {180, 2.5 * um, INFINITY}};
    Errors errors[3];
    wh_rounds_t rounds = WH_ROUNDS(8, 500, 0.12);
    while (wh_round(&rounds)) {
        for (size_t i = 0; i < 3; ++i) {
            Chuck chuck = draw(rounds.number);
            hide(chuck, cases[i].degrees);
            Scan scan(chuck);
            wh_circle_t circle;
            const bool flat = chuck.rim.notch.depth == 0;
            const wh_status_t status = scan.fit(circle);
            if (status == WH_STATUS_CENTRE_NOT_SURE && flat && i == 2) {
                continue; /* flats and chips leave less than half of the visible rim */
            }
            assert_int_equal(status, WH_OK);
            errors[i].see(circle, chuck.placement, flat ? cases[i].of_flats : cases[i].limit);
        }
    }
    for (size_t i = 0; i < 3; ++i) {
        errors[i].finish(cases[i].degrees);
    }
}

/* ------------------------------------------------------------------------------------------------ Eigen */

/* Solves least squares with three unknowns by orthogonal factors: Eigen's rotations turn each row,
 * with its right side, into the triangle. The matrices have a fixed size, so they compile quickly. */
struct Triangle {
    Eigen::Matrix4d r = Eigen::Matrix4d::Zero();

    void add(Eigen::RowVector4d row) {
        for (int i = 0; i < 3; ++i) {
            Eigen::JacobiRotation<double> turn;
            turn.makeGivens(r(i, i), row(i));
            for (int k = i; k < 4; ++k) {
                const double upper = r(i, k);
                r(i, k) = turn.c() * upper - turn.s() * row(k);
                row(k) = turn.s() * upper + turn.c() * row(k);
            }
        }
    }
    Eigen::Vector3d solve() const {
        return r.topLeftCorner<3, 3>().triangularView<Eigen::Upper>().solve(r.topRightCorner<3, 1>());
    }
    /* The inverse root of the normal equations' matrix. */
    Eigen::Matrix3d inverse() const {
        const Eigen::Matrix3d upper = r.topLeftCorner<3, 3>().inverse();
        return upper * upper.transpose();
    }
};

/* Gauss-Newton steps by orthogonal factors of all rows, from the truth, with the C library's sines. */
struct Oracle {
    Eigen::Vector3d at;
    Eigen::Matrix3d inverse;
    double scatter = 0;

    Oracle(const Chuck &chuck, const Scan &scan)
        : at(chuck.placement.x, chuck.placement.y, chuck.rim.radius) {
        for (int round = 0; round < 6; ++round) {
            Triangle rows;
            double weights = 0;
            double squares = 0;
            for (size_t i = 0; i < samples; ++i) {
                const double weight = scan.rays[i].weight;
                weights += weight;
                if (weight > 0) {
                    const Eigen::RowVector4d row =
                        std::sqrt(weight) * row_of(scan.points[i], scan.scan.offset);
                    squares += row(3) * row(3);
                    rows.add(row);
                }
            }
            at += rows.solve();
            scatter = std::sqrt(squares / (weights - 3));
            inverse = rows.inverse();
        }
    }
    /* The derivatives, and the error of the point. */
    Eigen::RowVector4d row_of(const wh_rim_point_t &point, double offset) const {
        const double c = std::cos(point.angle);
        const double s = std::sin(point.angle);
        const double q = offset + at(0) * s - at(1) * c;
        const double root = std::sqrt(at(2) * at(2) - q * q);
        return {c - q * s / root, s + q * c / root, at(2) / root,
                point.radius - (at(0) * c + at(1) * s + root)};
    }
};

/* With normal noise, Tukey's weights see this part of the mean square: the integrals of w x^2 and
 * w, cut at 6 deviations. */
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

/* The squared sums of 24 blocks compared with the sum of squares, if they exceed twice the value
 * for noise. */
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
    const double seen = seen_by_tukey();
    double position = 0;
    double deviation = 0;
    wh_rounds_t rounds = WH_ROUNDS(6, 101, 0.1);
    while (wh_round(&rounds)) {
        Chuck chuck = draw(rounds.number);
        hide(chuck, rounds.number % 3 * 90);
        Scan scan(chuck);
        wh_circle_t circle;
        assert_int_equal(scan.fit(circle), WH_OK);
        const Oracle oracle(chuck, scan);
        const double scatter = oracle.scatter / std::sqrt(seen);
        const double inflation = inflated(scan);
        const Eigen::Vector3d fitted(circle.x, circle.y, circle.radius);
        const Eigen::Vector3d stated(circle.sd_x, circle.sd_y, circle.sd_radius);
        const Eigen::Vector3d wanted = scatter * std::sqrt(inflation) * oracle.inverse.diagonal().cwiseSqrt();
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
        solver.computeDirect(oracle.inverse.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
        const double largest = scatter * std::sqrt(inflation) * std::sqrt(solver.eigenvalues()(1));
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

/* Up to 2 mm wide, at most half as deep: shallower than a notch, however many there are. */
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

/* One chip at a place where it takes away some of the notch. */
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

/* The verdicts on a group of wafers, compared with the truth. */
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
        assert_true(unsure <= expected + 3 * std::sqrt(expected) + 2); /* by chance some groups have more */
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

/* Never wrong: the centre by 10 um, the turn by 0.05 degrees, or one of them by 6 of its deviations. */
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
    constexpr size_t count = sizeof crowds / sizeof crowds[0];
    Verdicts verdicts[count];
    wh_rounds_t rounds = WH_ROUNDS(4, 251, 0.5);
    while (wh_round(&rounds)) {
        for (size_t i = 0; i < count; ++i) {
            Chuck chuck = draw(crowds[i].flat ? 3 : 0);
            chuck.trial.trial = static_cast<uint64_t>(rounds.number);
            chuck.rim.chip_count = 0;
            chuck.rim.transmission = crowds[i].glass;
            chuck.sensor.noise = crowds[i].noise;
            hide(chuck, crowds[i].degrees);
            crowds[i].spoil(chuck.rim);
            Scan scan(chuck);
            verdicts[i].see(estimate(chuck, scan), chuck);
        }
    }
    for (size_t i = 0; i < count; ++i) {
        verdicts[i].finish(crowds[i]);
    }
}

/* --------------------------------------------------------------------------------------- notches and samples */

/* A whole turn of a clean wafer with a notch at 0 and, if `both`, another one: how many samples there are, and where they fall. */
wh_align_result_t verdict_on_notches(double radius, int count, double phase, bool both) {
    static std::vector<wh_rim_point_t> points(4000);
    static std::vector<wh_rim_ray_t> rays(4000);
    const wh_rim_t nominal = wh_rim_nominal(radius);
    wh_rim_t rims[2] = {nominal, nominal};
    rims[0].notch.depth += wh_test_uniform(0, 0.2);
    rims[1].notch.depth += wh_test_uniform(0, 0.2);
    rims[0].notch.corner = rims[1].notch.corner = wh_test_uniform(0, 0.2);
    rims[1].notch.direction = wh_test_uniform(0.1, 2 * pi - 0.1);
    const wh_placement_t placement = {3, 1, 0.5};
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * pi * (i + phase) / count;
        const double one = wh_rim_distance(&rims[0], &placement, 0, angle);
        const double other = wh_rim_distance(&rims[1], &placement, 0, angle);
        points[static_cast<size_t>(i)] = {
            angle, (both ? std::min(one, other) : one) + 1e-3 * wh_test_uniform(-1, 1), WH_SIGHT_RIM};
    }
    const wh_sensor_t sensor = wh_sensor_nominal(radius);
    const wh_align_limits_t limits = wh_align_limits_default();
    const wh_rim_scan_t scan = {points.data(), static_cast<size_t>(count), 0, 0};
    wh_align_result_t result;
    assert_int_equal(wh_align_estimate(&scan, &sensor, &nominal, &limits, rays.data(), &result), WH_OK);
    return result;
}

/* However few samples there are, two notches are never one; and with as many as marks.h asks for, a clean notch is always sure. */
void two_notches_are_never_one(void **) {
    int told = 0, open = 0, enough = 0;
    wh_rounds_t rounds = WH_ROUNDS(60, 20000, 0.1);
    while (wh_round(&rounds)) {
        const bool large = wh_test_below(2) == 1;
        const int needed =
            large ? 3105 : 2091; // 0.31 mm apart where the rim is farthest, 3.2 mm off the middle
        const int count = 600 + static_cast<int>(wh_test_below(3300));
        const double phase = wh_test_uniform(0, 1);
        const wh_align_result_t two = verdict_on_notches(large ? 150 : 100, count, phase, true);
        assert_int_not_equal(two.verdict, WH_OK);
        assert_true(count < needed || two.verdict == WH_STATUS_TWO_NOTCHES);
        told += two.verdict == WH_STATUS_TWO_NOTCHES ? 1 : 0;
        const wh_align_result_t one = verdict_on_notches(large ? 150 : 100, count, phase, false);
        assert_true(one.verdict == WH_OK || (count < needed && one.verdict == WH_STATUS_NOTCH_NOT_SURE));
        open += one.verdict == WH_OK ? 0 : 1;
        enough += count >= needed ? 1 : 0;
        const wh_notch_seen_t &seen = one.notch_seen;
        assert_true(one.verdict != WH_OK ||
                    (seen.depth == one.notch.depth && seen.off == 0 &&
                     std::min(seen.flanks[0], seen.flanks[1]) >= WH_NOTCH_FLANK_LEAST));
    }
    std::printf("two notches: told %d times of %d; one: open %d times, %d scans had enough samples\n", told,
                rounds.made, open, enough);
    assert_true(told >= enough && enough > rounds.made / 10);
}

/* ------------------------------------------------------------------------------------------- marks by Eigen */

/* Straight lines in the circle's frame compared with samples: the distance of each sample outside
 * its line, along its ray, times the root of its weight. A line is where n(a) . P = h, with the
 * normal's direction a. */
struct Lines {
    struct Sample {
        Eigen::Vector2d from, along; /* the ray */
        double radius, root;
        int side;
    };
    std::vector<Sample> taken;
    bool vee; /* unknowns: axis, apex, half opening; else a chord's axis, height, and one without effect */
    double half = 0, part = 0; /* the known values of the opening */

    /* T is double or complex: the value at x + i h gives the exact derivatives at x. */
    template <class T> T off(const Eigen::Matrix<T, 3, 1> &x, const Sample &sample) const {
        const T turned = vee ? x(0) + static_cast<double>(sample.side) * (x(2) - pi / 2) + pi : x(0);
        const T nx = std::cos(turned);
        const T ny = std::sin(turned);
        const T beyond =
            nx * (x(1) * std::cos(x(0)) - sample.from.x()) + ny * (x(1) * std::sin(x(0)) - sample.from.y());
        return sample.radius - beyond / (nx * sample.along.x() + ny * sample.along.y());
    }
    /* The derivatives at x, and the value there. */
    Eigen::RowVector4d row_of(const Eigen::Vector3d &x, const Sample &sample) const {
        Eigen::RowVector4d row(0, 0, 0, off(x, sample));
        for (int p = 0; p < (vee ? 3 : 2); ++p) {
            Eigen::Vector3cd at(x(0), x(1), x(2));
            at(p) += std::complex<double>(0, 1e-30);
            row(p) = off(at, sample).imag() / 1e-30;
        }
        return sample.root * row;
    }
    /* The minimum that Gauss-Newton steps find from a start nearby. */
    Eigen::Vector3d minimum(Eigen::Vector3d x) const {
        for (int round = 0; round < 12; ++round) {
            Triangle rows;
            for (const Sample &sample : taken) {
                rows.add(row_of(x, sample));
            }
            rows.add(vee ? Eigen::RowVector4d(0, 0, part, part * (x(2) - half))
                         : Eigen::RowVector4d(0, 0, 1, 0));
            x -= rows.solve();
        }
        return x;
    }
    Sample sample(const Scan &scan, const wh_circle_t &circle, size_t i) const {
        const double a = scan.points[i].angle;
        const Eigen::Vector2d along(std::cos(a), std::sin(a));
        const Eigen::Vector2d from(-scan.scan.offset * std::sin(a) - circle.x,
                                   scan.scan.offset * std::cos(a) - circle.y);
        return {from, along, scan.points[i].radius, 1, 1};
    }
};

/* The samples of the dent about a direction. It ends after three samples in a row on the circle. */
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

/* The least squares with the weights that a V, given by x, gives to the samples of the notch; the
 * number of samples that count. */
Eigen::Vector3d after(const Eigen::Vector3d &x, const Scan &scan, const wh_circle_t &circle, size_t &used) {
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
    const Eigen::Vector3d start = x + Eigen::Vector3d(1e-4, 0.02, -0.01);
    return lines.minimum(start);
}

/* The differences of direction (rad), apex (mm) and opening (rad) from Eigen's; -1 if there is no
 * such V, because the samples that count change from step to step. */
double notch_off(const Scan &scan, const wh_align_result_t &result) {
    const wh_notch_t &notch = result.notch;
    const double half = notch.opening / 2;
    const double below = wh_rim_nominal(150).notch.bottom * (1 / std::sin(half) - 1);
    const Eigen::Vector3d x(notch.direction, result.circle.radius - notch.depth - below, half);
    size_t used = 0;
    const Eigen::Vector3d found = after(x, scan, result.circle, used);
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
    const Eigen::Vector3d x(flat.direction,
                            std::sqrt(circle.radius * circle.radius - flat.length * flat.length / 4), 0);
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
    const Eigen::Vector3d start = x + Eigen::Vector3d(1e-4, 0.02, 0);
    return (lines.minimum(start) - x).cwiseAbs().maxCoeff();
}

wh_align_result_t estimate(const Chuck &chuck, Scan &scan);

/* With the weights that the fitted marks give to their samples. */
void the_marks_are_eigens(void **) {
    double largest[2] = {0, 0};
    int compared[2] = {0, 0};
    int others[2] = {0, 0};
    wh_rounds_t rounds = WH_ROUNDS(8, 101, 0.12);
    while (wh_round(&rounds)) {
        const int wafer = rounds.number;
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
        assert_true(compared[kind] > 0 && compared[kind] > 5 * (others[kind] - 1));
        assert_true(largest[kind] <= 1e-9);
    }
}

/* Most samples may have the same pixels. */
void a_wafer_in_the_middle_is_told(void **) {
    double worst = 0;
    wh_rounds_t rounds = WH_ROUNDS(8, 2000, 0.1);
    while (wh_round(&rounds)) {
        Chuck chuck = draw(rounds.number);
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

/* Without noise, or with less than a pixel of it, many neighbours have the same pixels, and the
 * more so near the middle. */
void a_scan_is_no_better_than_its_pixels(void **) {
    static const double noises[] = {0.0, 0.5 * um, 2 * um};
    double worst[3] = {0, 0, 0};
    wh_rounds_t rounds = WH_ROUNDS(8, 2000, 0.12);
    while (wh_round(&rounds)) {
        for (size_t i = 0; i < 3; ++i) {
            Chuck chuck = draw(rounds.number);
            const double nearer = std::pow(10, wh_test_uniform(-5, 0));
            chuck.placement.x *= nearer;
            chuck.placement.y *= nearer;
            chuck.sensor.noise = noises[i];
            chuck.sensor.pixel = wh_test_below(2) ? 7 * um : 14 * um;
            Scan scan(chuck);
            wh_circle_t circle;
            const wh_status_t status = scan.fit(circle);
            if (status == WH_STATUS_BAD_SCAN && nearer < 2e-3) {
                continue; /* all samples are equal */
            }
            assert_int_equal(status, WH_OK);
            const double off = std::hypot(circle.x - chuck.placement.x, circle.y - chuck.placement.y);
            worst[i] = std::max(worst[i], off / circle.sd_centre);
        }
    }
    for (size_t i = 0; i < 3; ++i) {
        std::printf("%.1f um of noise: off by at most %.2f deviations\n", noises[i] / um, worst[i]);
        assert_true(worst[i] <= 6);
    }
}

/* ------------------------------------------------------------------------------------------- calibration */

/* Scans of a known wafer in two places, turned both ways, from a controller that assumes no error. */
struct Reference {
    Chuck chuck;
    std::vector<std::vector<wh_rim_point_t>> points;
    std::vector<wh_calibration_scan_t> scans;
    wh_rim_point_t work[samples];
    wh_rim_ray_t rays[samples];

    /* The second place is 14 mm from the first one, with the axis about half way; `off` is the
     * error of the way. */
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

/* A sensor with errors of 0.1 mm, 20 us and 0.1 %, and a known wafer about 1 mm from the axis. */
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

/* The largest error in units of its deviation. */
double off_by(const wh_calibration_t &found, const wh_sensor_error_t &truth) {
    return std::max({std::fabs(found.error.offset - truth.offset) / found.sd_offset,
                     std::fabs(found.error.zero - truth.zero) / found.sd_zero,
                     std::fabs(found.error.gain - truth.gain) / found.sd_gain,
                     std::fabs(found.error.latency - truth.latency) / found.sd_latency});
}

/* The error of another wafer's centre, 10 mm from the axis. */
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

/* With a way known exactly, and known to 0.5 um: the largest error of all centres. */
void a_calibrated_sensor_tells_the_centre(void **) {
    static const double ways[] = {0.0, 0.5 * um};
    double before = 0;
    double after = 0;
    double deviations = 0;
    wh_rounds_t rounds = WH_ROUNDS(6, 202, 0.12);
    while (wh_round(&rounds)) {
        const double sd_way = ways[rounds.number % 2];
        const Chuck chuck = draw_off_sensor();
        Reference reference(chuck, wh_test_uniform(-2, 2) * sd_way);
        wh_calibration_t found;
        int32_t bad = 7;
        assert_int_equal(reference.solve(sd_way, found, &bad), WH_OK);
        deviations = std::max(deviations, off_by(found, chuck.sensor.error));
        before = std::max(before, centre_off(chuck, {0, 0, 0, 0}));
        after = std::max(after, centre_off(chuck, found.error));
    }
    std::printf("centre off by at most %.2f um, %.3f um calibrated; errors by %.2f deviations\n", before / um,
                after / um, deviations);
    assert_true(before > 7 * um);
    assert_true(after <= 2 * um);
    assert_true(deviations <= 6);
}

/* Its verdict on scans with one error; nothing has changed. */
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
        case 7: /* moved by 10 % less than it reports */
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

/* Puts one error into the scan; returns the fit's verdict. */
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
    wh_rounds_t rounds = WH_ROUNDS(12, 240, 0.05);
    while (wh_round(&rounds)) {
        const uint32_t way = static_cast<uint32_t>(rounds.number) % 12;
        Chuck chuck = draw(rounds.number);
        Scan scan(chuck);
        wh_circle_t circle;
        std::memset(&circle, 0x5a, sizeof circle);
        const wh_circle_t before = circle;
        const wh_status_t wanted = spoil(scan, way);
        const wh_status_t status = scan.fit(circle);
        if (status != wanted) {
            print_error("way %u: %s\n", static_cast<unsigned>(way), wh_status_name(status));
        }
        assert_int_equal(status, wanted);
        assert_memory_equal(&circle, &before, sizeof circle);
    }
}

/* A field, and one value on each side of its range. */
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
        cmocka_unit_test(two_notches_are_never_one),
        cmocka_unit_test(what_is_no_scan_is_refused),
        cmocka_unit_test(wrong_rims_and_sensors_are_named),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
