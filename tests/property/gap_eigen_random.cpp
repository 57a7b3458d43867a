/* The gap compared with an independent way to the nearest points: from a point of one shape to the
 * nearest of the other and back, again and again (J. von Neumann's alternating projections). It
 * uses Eigen's arithmetic and closed forms for the nearest point of a box, a cylinder and a
 * capsule. Shapes stand in any pose. */
/* Plain alone: under sanitizers gap_test and gap_random call the same functions, without Eigen. */
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "support/support.h"

extern "C" {
#include "collision/gap.h"
}
#include "support/convex.h"

namespace {

using Vector = Eigen::Vector3d;

struct Body {
    wh_convex_t shape;
    wh_pose_t pose;
    Eigen::Matrix3d R;
    Vector r;

    Body(wh_convex_kind_t kind, double reach)
        : shape(wh_test_random_shape(kind, nullptr)), pose(wh_test_random_pose(reach)) {
        for (int i = 0; i < 9; ++i) {
            R(i / 3, i % 3) = pose.R.m[i / 3][i % 3];
        }
        r = Vector(pose.r.x, pose.r.y, pose.r.z);
    }

    Vector nearest(const Vector &point) const {
        const Vector half(shape.half.x, shape.half.y, shape.half.z);
        Vector p = R.transpose() * (point - r);
        if (shape.kind == WH_CONVEX_BOX) {
            p = p.cwiseMin(half).cwiseMax(-half);
        } else if (shape.kind == WH_CONVEX_CYLINDER) {
            p.head(2) *= std::min(1.0, half.x() / std::max(p.head(2).norm(), 1e-300));
            p.z() = std::clamp(p.z(), -half.z(), half.z());
        } else {
            const Vector on_axis(0, 0, std::clamp(p.z(), -half.z(), half.z()));
            const Vector out = p - on_axis;
            p = on_axis + out * std::min(1.0, half.x() / std::max(out.norm(), 1e-300));
        }
        return R * p + r;
    }
};

/* The distance; negative if the search has not ended, or if there is none. */
double distance(const Body &a, const Body &b) {
    Vector on_a = a.nearest(b.r);
    for (int i = 0; i < 20000; ++i) {
        const Vector on_b = b.nearest(on_a);
        const Vector next = a.nearest(on_b);
        const Vector way = on_b - next;
        const double apart = way.norm();
        if (apart < 1e-6) {
            return -1;
        }
        const double left = (on_a - next).norm();
        on_a = next;
        if (left < 1e-12) {
            return apart;
        }
    }
    return -1;
}

void the_gap_is_the_distance(void **) {
    double worst = 0;
    int compared = 0;
    int skipped = 0;
    wh_rounds_t rounds = WH_ROUNDS(500, 20000, 0.7);
    while (wh_round(&rounds)) {
        const int i = rounds.number;
        const Body a(static_cast<wh_convex_kind_t>(i % 3), 150);
        const Body b(static_cast<wh_convex_kind_t>(i / 3 % 3), 150);
        wh_gap_t gap;
        wh_gap_measure(&a.shape, &a.pose, &b.shape, &b.pose, 1e9, wh_vec3(0, 0, 0), &gap);
        assert_int_not_equal(gap.state, WH_GAP_UNDECIDED);
        if (gap.state != WH_GAP_CLEAR) {
            continue;
        }
        const double want = distance(a, b);
        if (want < 0) {
            ++skipped;
            continue;
        }
        ++compared;
        worst = std::max(worst, std::fabs(want - gap.gap));
    }
    std::printf("%d gaps differ by at most %.3g mm, %d converged too slowly\n", compared, worst, skipped);
    assert_true(compared > rounds.made / 2 && skipped <= 2 + compared / 100);
    assert_true(worst < 1e-5);
}

/* The other way calls it a hit if it finds a point of both. */
void a_hit_has_a_common_point(void **) {
    int hits = 0;
    wh_rounds_t rounds = WH_ROUNDS(200, 3000, 0.2);
    while (wh_round(&rounds)) {
        const int i = rounds.number;
        const Body a(static_cast<wh_convex_kind_t>(i % 3), 60);
        const Body b(static_cast<wh_convex_kind_t>(i / 3 % 3), 60);
        wh_gap_t gap;
        wh_gap_measure(&a.shape, &a.pose, &b.shape, &b.pose, 1e9, wh_vec3(0, 0, 0), &gap);
        if (gap.state != WH_GAP_HIT) {
            continue;
        }
        ++hits;
        const Vector at(gap.at.x, gap.at.y, gap.at.z);
        assert_true((a.nearest(at) - at).norm() < 1e-6);
        assert_true((b.nearest(at) - at).norm() < 1e-6);
    }
    std::printf("%d hits\n", hits);
    assert_true(hits > rounds.made / 7);
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_gap_is_the_distance),
        cmocka_unit_test(a_hit_has_a_common_point),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
