/* (1)-(5) and the pose algebra compared with fixed-size Eigen: an independent implementation of the
 * same products. The difference is counted in units of 2^-53 (float: 2^-24) times the sum of the
 * absolute terms. */
/* Plain alone: under sanitizers proximity_test and pose_test call the same functions, without Eigen. */
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "support/support.h"

extern "C" {
#include "grasp/proximity.h"
}
#include "support/pose.h"

namespace {

using Matrix = Eigen::Matrix<wh_real_t, 3, 3>;
using Vector = Eigen::Matrix<wh_real_t, 3, 1>;

constexpr int pairs = 1000000;
/* Sums in the same order do not differ, and the double build adds in the same order. Eigen's
 * vectorised products add in another order: then either side may be off by one rounding for each of
 * up to four terms. */
constexpr double allowed_reordered = 8;
#if defined(WH_FLOAT)
constexpr double allowed = allowed_reordered;
#else
constexpr double allowed = 4;
#endif

Matrix matrix(const wh_mat3_t &R) {
    Matrix m;
    m << R.m[0][0], R.m[0][1], R.m[0][2], R.m[1][0], R.m[1][1], R.m[1][2], R.m[2][0], R.m[2][1], R.m[2][2];
    return m;
}

Vector vector(const wh_vec3_t &v) {
    return Vector(v.x, v.y, v.z);
}

/* The largest difference seen so far of one quantity, in the units above. */
struct Worst {
    double ratio = 0;

    void see(wh_real_t a, wh_real_t b, wh_real_t terms) {
        const double difference = std::fabs(static_cast<double>(a) - static_cast<double>(b));
        if (!(difference == 0)) {
            ratio = std::max(ratio, difference / (WH_TEST_ROUNDING * static_cast<double>(terms)));
        }
        if (!std::isfinite(difference)) {
            ratio = std::numeric_limits<double>::infinity();
        }
    }
    void see(const wh_vec3_t &a, const Vector &b, const Vector &terms) {
        see(a.x, b.x(), terms.x());
        see(a.y, b.y(), terms.y());
        see(a.z, b.z(), terms.z());
    }
    void see(const wh_mat3_t &a, const Matrix &b, const Matrix &terms) {
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                see(a.m[i][j], b(i, j), terms(i, j));
            }
        }
    }
    void finish(const char *name, double most = allowed) const {
        std::printf("%-16s at most %.3f of %.0f allowed\n", name, ratio, most);
        assert_true(ratio <= most);
    }
};

/* Half of the pairs are close to each other, so that cancellation shows. */
void draw(int pair, wh_pose_t &a, wh_pose_t &b) {
    a = wh_test_random_pose(1000);
    b = wh_test_random_pose(1000);
    if (pair % 2) {
        const wh_pose_t beside = wh_test_random_pose(60);
        b = wh_pose_compose(&a, &beside);
    }
}

void measured_values_are_eigens(void **) {
    const wh_tolerance_t paper = wh_tolerance_paper();
    Worst dr, planar, z, xy, norm;
    wh_rounds_t rounds = WH_ROUNDS(1000, pairs, 0.4);
    while (wh_round(&rounds)) {
        wh_pose_t wafer, gripper;
        draw(rounds.number, wafer, gripper);
        wh_proximity_t p;
        assert_int_equal(wh_proximity_measure(&wafer, &gripper, &paper, &p), WH_OK);
        const Matrix R_w = matrix(wafer.R);
        const Matrix R_g = matrix(gripper.R);
        const Vector r_w = vector(wafer.r);
        const Vector r_g = vector(gripper.r);
        const Vector d = r_w - r_g;
        const Vector n1 = R_w.col(2);
        const Vector n2 = R_g.col(2);
        const Vector in_wafer = R_w.transpose() * d;
        const Vector terms = R_w.cwiseAbs().transpose() * d.cwiseAbs();
        const wh_real_t in_plane = in_wafer.head(2).norm();
        dr.see(p.dr, d, r_w.cwiseAbs() + r_g.cwiseAbs());
        planar.see(p.n1_proj_n2, n1.dot(n2), n1.cwiseAbs().dot(n2.cwiseAbs()));
        z.see(p.dr_proj_z, d.dot(n1), terms.z());
        xy.see(p.dr_proj_xy, in_wafer, terms);
        norm.see(p.dr_proj_xy_norm, in_plane, terms.head(2).norm());
    }
    dr.finish("dr");
    planar.finish("n1_proj_n2");
    z.finish("dr_proj_z");
    xy.finish("dr_proj_xy");
    norm.finish("|dr_proj_xy|");
}

void pose_algebra_is_eigens(void **) {
    Worst compose_R, compose_r, relative_R, relative_r;
    wh_rounds_t rounds = WH_ROUNDS(1000, pairs, 0.4);
    while (wh_round(&rounds)) {
        wh_pose_t a, b;
        draw(rounds.number, a, b);
        const wh_pose_t product = wh_pose_compose(&a, &b);
        const wh_pose_t quotient = wh_pose_relative(&a, &b);
        const Matrix A = matrix(a.R);
        const Matrix B = matrix(b.R);
        const Vector ra = vector(a.r);
        const Vector rb = vector(b.r);
        const Vector between = rb - ra;
        compose_R.see(product.R, A * B, A.cwiseAbs() * B.cwiseAbs());
        compose_r.see(product.r, A * rb + ra, A.cwiseAbs() * rb.cwiseAbs() + ra.cwiseAbs());
        relative_R.see(quotient.R, A.transpose() * B, A.cwiseAbs().transpose() * B.cwiseAbs());
        relative_r.see(quotient.r, A.transpose() * between, A.cwiseAbs().transpose() * between.cwiseAbs());
    }
    compose_R.finish("compose, R", allowed_reordered);
    compose_r.finish("compose, r", allowed_reordered);
    relative_R.finish("relative, R", allowed_reordered);
    relative_r.finish("relative, r", allowed_reordered);
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(measured_values_are_eigens),
        cmocka_unit_test(pose_algebra_is_eigens),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
