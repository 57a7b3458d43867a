/* Chains compared with Orocos KDL, which multiplies the joints' frames one by one. Lines of chains,
 * sampled each millisecond, are compared with each axis's limits. */
/* Plain alone: under sanitizers chain_test calls the same functions of lib/motion, without Orocos KDL. */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <vector>

#include "support/support.h"

extern "C" {
#include "math/trig.h"
#include "motion/chain_line.h"
}
#include "support/pose.h"

namespace {

constexpr int chains = 2000;
constexpr int poses = 500; /* of each */
constexpr int lines = 6000;
const char *const names[] = {"TRZY", "TRZ", "SCARA"};

double coin() {
    return static_cast<double>(wh_test_below(2));
}

void set_axis(wh_chain_t &chain, size_t axis, double min, double max, double speed) {
    chain.travel[axis] = {min, max};
    chain.limits[axis] = {speed * wh_test_decades(0.3, 3), 5 * speed * wh_test_decades(0.3, 3),
                          50 * speed * wh_test_decades(0.3, 3)};
    chain.home[axis] = min + (max - min) * wh_test_uniform(0, 1);
}

/* With and without rail, tilt, flip and a mounting place. */
wh_chain_t random_chain(wh_chain_kind_t kind) {
    wh_chain_t chain = {};
    chain.kind = kind;
    chain.has_rail = coin() > 0;
    chain.has_tilt = coin() > 0;
    chain.has_flip = coin() > 0;
    chain.is_placed = coin() > 0;
    chain.base_from_robot =
        wh_test_pose(wh_mat3_about_z(wh_test_uniform(-3, 3)), wh_test_uniform(-2000, 2000),
                     wh_test_uniform(-2000, 2000), wh_test_uniform(-100, 100));
    chain.arm_heading = kind == WH_CHAIN_SCARA ? 0 : coin() * wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
    chain.height = coin() * wh_test_uniform(-20, 20);
    chain.flip_height = wh_test_uniform(-10, 30);
    chain.links[0] = wh_test_uniform(150, 400);
    chain.links[1] = wh_test_uniform(0.8, 1.2) * chain.links[0];
    set_axis(chain, WH_CHAIN_RAIL, -1500, 1500, 1000);
    set_axis(chain, WH_CHAIN_Z, 600, 1300, 400);
    set_axis(chain, WH_CHAIN_TILT_X, -0.1, 0.1, 0.2);
    set_axis(chain, WH_CHAIN_TILT_Y, -0.1, 0.1, 0.2);
    set_axis(chain, WH_CHAIN_THETA, -9.4, 9.4, 5);
    set_axis(chain, WH_CHAIN_REACH, 200, 900, 1000);
    if (kind == WH_CHAIN_SCARA) {
        set_axis(chain, WH_CHAIN_REACH, -3.1, 3.1, 5);
    }
    set_axis(chain, WH_CHAIN_YAW, -9.4, 9.4, 6);
    set_axis(chain, WH_CHAIN_FLIP, -3.2, 3.2, 3);
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        chain.home[axis] = wh_chain_has(&chain, axis) ? chain.home[axis] : 0;
    }
    assert_int_equal(wh_chain_validate(&chain), WH_OK);
    return chain;
}

void random_axes(const wh_chain_t &chain, double q[WH_CHAIN_AXES]) {
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        const wh_travel_t &travel = chain.travel[axis];
        q[axis] = wh_chain_has(&chain, axis) ? wh_test_uniform(travel.min, travel.max) : 0;
    }
    if (chain.kind == WH_CHAIN_TRZY) { /* the turn that inverse gives */
        q[WH_CHAIN_YAW] = wh_test_uniform(-3.14159, 3.14159);
    }
}

KDL::Frame frame_of(const wh_pose_t &pose) {
    const wh_mat3_t &R = pose.R;
    return KDL::Frame(KDL::Rotation(R.m[0][0], R.m[0][1], R.m[0][2], R.m[1][0], R.m[1][1], R.m[1][2],
                                    R.m[2][0], R.m[2][1], R.m[2][2]),
                      KDL::Vector(pose.r.x, pose.r.y, pose.r.z));
}

KDL::Frame up(double z) {
    return KDL::Frame(KDL::Vector(0, 0, z));
}

/* The joints in the order of the axes, all eight of them. */
KDL::Chain kdl_of(const wh_chain_t &chain) {
    using KDL::Frame;
    using KDL::Joint;
    using KDL::Segment;
    KDL::Chain kdl;
    kdl.addSegment(
        Segment(Joint(Joint::None), chain.is_placed ? frame_of(chain.base_from_robot) : Frame::Identity()));
    kdl.addSegment(Segment(Joint(Joint::TransX)));
    kdl.addSegment(Segment(Joint(Joint::TransZ)));
    kdl.addSegment(Segment(Joint(Joint::RotX)));
    kdl.addSegment(Segment(Joint(Joint::RotY)));
    if (chain.kind == WH_CHAIN_SCARA) {
        kdl.addSegment(Segment(Joint(Joint::RotZ), Frame(KDL::Vector(chain.links[0], 0, 0))));
        kdl.addSegment(Segment(Joint(Joint::RotZ), Frame(KDL::Vector(chain.links[1], 0, chain.height))));
    } else {
        kdl.addSegment(Segment(Joint(Joint::RotZ), Frame(KDL::Rotation::RotZ(chain.arm_heading))));
        kdl.addSegment(Segment(Joint(Joint::TransX), up(chain.height)));
    }
    kdl.addSegment(Segment(Joint(Joint::RotZ), up(chain.has_flip ? chain.flip_height : 0)));
    kdl.addSegment(Segment(Joint(Joint::RotX), up(chain.has_flip ? -chain.flip_height : 0)));
    return kdl;
}

/* The largest differences so far. */
struct Off {
    double mm = 0, rad = 0;

    void see(const wh_pose_t &a, const wh_pose_t &b) {
        mm = std::max(mm, wh_test_difference_r(&a, &b));
        rad = std::max(rad, wh_test_difference_R(&a, &b));
    }
};

wh_pose_t pose_of(const KDL::Frame &frame) {
    wh_pose_t pose;
    for (int i = 0; i < 9; ++i) {
        pose.R.m[i / 3][i % 3] = frame.M(i / 3, i % 3);
    }
    pose.r = wh_vec3(frame.p.x(), frame.p.y(), frame.p.z());
    return pose;
}

wh_chain_choice_t choice_at(const double q[WH_CHAIN_AXES]) {
    return {q[WH_CHAIN_RAIL], q[WH_CHAIN_FLIP], q[WH_CHAIN_REACH] < 0 ? WH_ELBOW_LEFT : WH_ELBOW_RIGHT};
}

/* From a start within a third of a turn of q, from which the shorter way round leads back to q. */
void near(const double q[WH_CHAIN_AXES], double near_q[WH_CHAIN_AXES]) {
    std::copy(q, q + WH_CHAIN_AXES, near_q);
    near_q[WH_CHAIN_THETA] += wh_test_uniform(-2, 2);
    near_q[WH_CHAIN_YAW] += wh_test_uniform(-2, 2);
    near_q[WH_CHAIN_REACH] = 0;
}

/* The error of inverse in the axes, except if a straight elbow hides it. */
double axes_missed(const wh_chain_t &chain, const double q[WH_CHAIN_AXES],
                   const double found[WH_CHAIN_AXES]) {
    double most = 0;
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        most = std::max(most, std::fabs(q[axis] - found[axis]));
    }
    const bool is_straight = chain.kind == WH_CHAIN_SCARA && std::fabs(std::sin(q[WH_CHAIN_REACH])) <= 0.01;
    return is_straight ? 0 : most;
}

void compare_with_kdl(wh_chain_kind_t kind) {
    Off forward;
    Off back;
    double missed = 0;
    wh_rounds_t rounds = WH_ROUNDS(32, chains, 0.15);
    while (wh_round(&rounds)) {
        const wh_chain_t chain = random_chain(kind);
        const KDL::Chain kdl = kdl_of(chain);
        KDL::ChainFkSolverPos_recursive solver(kdl);
        KDL::JntArray joints(WH_CHAIN_AXES);
        for (int k = 0; k < poses; k += WH_TEST_SHARE) {
            double q[WH_CHAIN_AXES], near_q[WH_CHAIN_AXES], found[WH_CHAIN_AXES];
            random_axes(chain, q);
            std::copy(q, q + WH_CHAIN_AXES, joints.data.data());
            KDL::Frame frame;
            assert_int_equal(solver.JntToCart(joints, frame), 0);
            const wh_pose_t want = pose_of(frame);
            wh_pose_t pose;
            wh_chain_forward(&chain, q, &pose);
            forward.see(pose, want);
            near(q, near_q);
            const wh_chain_choice_t choice = choice_at(q);
            assert_int_equal(wh_chain_inverse(&chain, &want, &choice, near_q, found), WH_OK);
            wh_chain_forward(&chain, found, &pose);
            back.see(pose, want);
            missed = std::max(missed, axes_missed(chain, q, found));
        }
    }
    std::printf("%s: forward %.2g mm %.2g rad, inverse %.2g mm %.2g rad, axes %.2g\n", names[kind],
                forward.mm, forward.rad, back.mm, back.rad, missed);
    assert_true(forward.mm <= 1e-9 && forward.rad <= 1e-12);
    assert_true(back.mm <= 1e-9 && back.rad <= 1e-12);
    assert_true(missed <= 1e-7);
}

void poses_are_kdls(void **) {
    compare_with_kdl(WH_CHAIN_TRZY);
    compare_with_kdl(WH_CHAIN_TRZ);
    compare_with_kdl(WH_CHAIN_SCARA);
}

/* ------------------------------------------------------------------------------------------------- lines */

/* A step in base: for TRZ along its arm and up, otherwise in any direction. */
wh_vec3_t random_step(const wh_chain_t &chain, const double q[WH_CHAIN_AXES]) {
    const double length = wh_test_decades(1, 500);
    const double lift = coin() * wh_test_uniform(-30, 30);
    const double way = wh_test_uniform(-WH_TEST_PI, WH_TEST_PI);
    if (chain.kind != WH_CHAIN_TRZ) {
        return wh_vec3(length * std::cos(way), length * std::sin(way), lift);
    }
    double ahead[WH_CHAIN_AXES];
    std::copy(q, q + WH_CHAIN_AXES, ahead);
    ahead[WH_CHAIN_REACH] += way > 0 ? length : -length;
    ahead[WH_CHAIN_Z] += lift;
    wh_pose_t from;
    wh_pose_t to;
    wh_chain_forward(&chain, q, &from);
    wh_chain_forward(&chain, ahead, &to);
    return wh_vec3_subtract(&to.r, &from.r);
}

using Axes = std::vector<std::vector<double>>;

Axes sampled(const wh_chain_line_t &line, double apart) {
    Axes axes;
    const int count = static_cast<int>(std::ceil(wh_chain_line_duration(&line) / apart)) + 3;
    for (int k = -3; k <= count; ++k) {
        std::vector<double> q(WH_CHAIN_AXES);
        wh_chain_line_at(&line, k * apart, q.data());
        axes.push_back(q);
    }
    return axes;
}

/* The share of its limits that an axis uses, by divided differences: speed, acceleration, jerk. */
struct Shares {
    double of[3] = {0, 0, 0};

    void see(const Axes &axes, double apart, size_t axis, const wh_limits_t &limits) {
        std::vector<double> row;
        for (const std::vector<double> &q : axes) {
            row.push_back(q[axis]);
        }
        const double most[] = {limits.speed, limits.acceleration, limits.jerk};
        for (int order = 0; order < 3; ++order) {
            for (size_t k = 0; k + 1 < row.size(); ++k) {
                row[k] = (row[k + 1] - row[k]) / apart;
            }
            row.pop_back();
            for (const double value : row) {
                of[order] = std::max(of[order], std::fabs(value) / most[order]);
            }
        }
    }
};

Shares shares_of(const wh_chain_t &chain, const Axes &axes, double apart) {
    Shares shares;
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        if (wh_chain_has(&chain, axis)) {
            shares.see(axes, apart, axis, chain.limits[axis]);
        }
    }
    return shares;
}

/* The distance of a line's samples from it, and whether they stay within travel. */
void see_way(const wh_chain_t &chain, const Axes &axes, const wh_vec3_t &step, Off &off) {
    wh_pose_t start;
    wh_chain_forward(&chain, axes.front().data(), &start);
    const double length = std::sqrt(wh_vec3_dot(&step, &step));
    for (const std::vector<double> &q : axes) {
        wh_pose_t pose;
        wh_chain_forward(&chain, q.data(), &pose);
        const wh_vec3_t gone = wh_vec3_subtract(&pose.r, &start.r);
        const double along = std::clamp(wh_vec3_dot(&gone, &step) / (length * length), 0.0, 1.0);
        const wh_vec3_t on_line = wh_vec3_scale(along, &step);
        wh_pose_t want = start;
        want.r = wh_vec3_add(&start.r, &on_line);
        off.see(pose, want);
        assert_int_equal(wh_chain_check_travel(&chain, q.data()), WH_OK);
    }
}

/* A SCARA does not come near the straight elbow. The limits hold there, too, but rounding shows. */
bool is_bent(const wh_chain_t &chain, const wh_chain_line_t &line) {
    return chain.kind != WH_CHAIN_SCARA || (std::fabs(std::sin(line.from[WH_CHAIN_REACH])) > 0.1 &&
                                            std::fabs(std::sin(line.to[WH_CHAIN_REACH])) > 0.1);
}

void look_at_lines(wh_chain_kind_t kind) {
    Off off;
    Shares shares;
    int planned = 0;
    int slowed = 0;
    double least = 1;
    wh_rounds_t rounds = WH_ROUNDS(100, lines, 0.2);
    while (wh_round(&rounds)) {
        const wh_chain_t chain = random_chain(kind);
        double q[WH_CHAIN_AXES];
        random_axes(chain, q);
        const wh_vec3_t step = random_step(chain, q);
        const wh_line_caps_t caps = {coin() * wh_test_decades(10, 3000), coin() * wh_test_decades(100, 9000)};
        wh_chain_line_t line;
        if (wh_chain_line_plan(&line, &chain, q, &step, &caps) != WH_OK || !is_bent(chain, line)) {
            continue;
        }
        ++planned;
        slowed += line.path.slowed > 1;
        const Axes axes = sampled(line, 1e-3);
        see_way(chain, axes, step, off);
        const Shares own = shares_of(chain, axes, 1e-3);
        if (line.path.slowed > 1 && kind == WH_CHAIN_SCARA) {
            const Shares fine = shares_of(chain, sampled(line, 2e-4), 2e-4);
            least = std::min(least, std::max({fine.of[0], std::sqrt(fine.of[1]), std::cbrt(fine.of[2])}));
        }
        for (int order = 0; order < 3; ++order) {
            shares.of[order] = std::max(shares.of[order], own.of[order]);
        }
    }
    std::printf("%s: %d lines, %d slowed, off %.2g mm %.2g rad, limits used %.12f %.11f %.8f, a slowed one "
                "at least %.3f\n",
                names[kind], planned, slowed, off.mm, off.rad, shares.of[0], shares.of[1], shares.of[2],
                least);
    assert_true(planned > rounds.made / 10);
    assert_true(off.mm <= 1e-9 && off.rad <= 1e-12);
    assert_true(shares.of[0] <= 1 + 1e-9 && shares.of[1] <= 1 + 1e-8 && shares.of[2] <= 1 + 1e-5);
    assert_true(least > 0.9); /* a SCARA is slowed no more than needed */
}

void lines_keep_to_way_and_limits(void **) {
    look_at_lines(WH_CHAIN_TRZY);
    look_at_lines(WH_CHAIN_TRZ);
    look_at_lines(WH_CHAIN_SCARA);
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poses_are_kdls),
        cmocka_unit_test(lines_keep_to_way_and_limits),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
