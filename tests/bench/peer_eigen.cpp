// The check written with Eigen, in the ways that one might: each rejects what it can as early as its form allows.
#include <Eigen/Dense>
#include <Eigen/StdVector>
#include <vector>

#include "bench/peers.h"

namespace {

using Vec = Eigen::Vector3d;

Vec vec(const wh_vec3_t &v) {
    return {v.x, v.y, v.z};
}

Eigen::Matrix3d mat(const wh_mat3_t &m) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&m.m[0][0]);
}

// ------------------------------------------------------------------------------------ one structure for each wafer
struct Pose {
    Eigen::Matrix3d R;
    Vec r;
    explicit Pose(const wh_pose_t &pose) : R(mat(pose.R)), r(vec(pose.r)) {
    }
};

// Each form: whether a pair is ready.
struct Literal {
    static constexpr const char *name = "literal";
    static bool ready(const Pose &w, const Pose &g, const wh_tolerance_t &t) {
        const Vec dr = w.r - g.r;
        const Vec n1 = w.R.col(2);
        const double n1_proj_n2 = n1.dot(g.R.col(2));
        const double dr_proj_z = dr.dot(n1);
        const Vec dr_proj_xy = w.R.transpose() * dr;
        return std::abs(dr_proj_z) < t.projz && dr_proj_xy.head<2>().norm() < t.projxy &&
               n1_proj_n2 > t.planar;
    }
};

struct Squared {
    static constexpr const char *name = "squared";
    static bool ready(const Pose &w, const Pose &g, const wh_tolerance_t &t) {
        const Vec dr = w.r - g.r;
        const double z = dr.dot(w.R.col(2));
        if (!(z * z < t.projz * t.projz)) {
            return false;
        }
        const double x = dr.dot(w.R.col(0));
        const double y = dr.dot(w.R.col(1));
        return x * x + y * y < t.projxy * t.projxy && w.R.col(2).dot(g.R.col(2)) > t.planar;
    }
};

struct Expression {
    static constexpr const char *name = "matrix";
    static bool ready(const Pose &w, const Pose &g, const wh_tolerance_t &t) {
        const Vec p = w.R.transpose() * (w.r - g.r);
        return (std::abs(p.z()) < t.projz) & (p.head<2>().squaredNorm() < t.projxy * t.projxy) &
               (w.R.col(2).dot(g.R.col(2)) > t.planar);
    }
};

struct Poses {
    std::vector<Pose, Eigen::aligned_allocator<Pose>> wafers;
    wh_tolerance_t tolerance;
};

void *build_poses(const wh_pose_t *wafers, size_t count, const wh_tolerance_t *tolerance) {
    auto *built = new Poses{{}, *tolerance};
    for (size_t w = 0; w < count; ++w) {
        built->wafers.emplace_back(wafers[w]);
    }
    return built;
}

template <typename Form> uint64_t count_poses(void *built, const wh_pose_t *grippers, size_t gripper_count) {
    const Poses &poses = *static_cast<Poses *>(built);
    uint64_t ready = 0;
    for (size_t g = 0; g < gripper_count; ++g) {
        const Pose gripper(grippers[g]);
        for (const Pose &wafer : poses.wafers) {
            ready += Form::ready(wafer, gripper, poses.tolerance);
        }
    }
    return ready;
}

template <typename Built> void drop(void *built) {
    delete static_cast<Built *>(built);
}

// --------------------------------------------------------------------------------------------- structure of arrays
struct Arrays {
    Eigen::ArrayXd x, y, z;                    // of the origin
    Eigen::ArrayXd n_x, n_y, n_z;              // n1
    Eigen::Array<double, Eigen::Dynamic, 6> e; // e1 and e2
    wh_tolerance_t tolerance;
};

void *build_arrays(const wh_pose_t *wafers, size_t count, const wh_tolerance_t *tolerance) {
    const auto n = static_cast<Eigen::Index>(count);
    auto *built = new Arrays{Eigen::ArrayXd(n),
                             Eigen::ArrayXd(n),
                             Eigen::ArrayXd(n),
                             Eigen::ArrayXd(n),
                             Eigen::ArrayXd(n),
                             Eigen::ArrayXd(n),
                             {},
                             *tolerance};
    built->e.resize(n, 6);
    for (Eigen::Index w = 0; w < n; ++w) {
        const wh_pose_t &pose = wafers[w];
        built->x[w] = pose.r.x;
        built->y[w] = pose.r.y;
        built->z[w] = pose.r.z;
        built->n_x[w] = pose.R.m[0][2];
        built->n_y[w] = pose.R.m[1][2];
        built->n_z[w] = pose.R.m[2][2];
        for (int i = 0; i < 6; ++i) {
            built->e(w, i) = pose.R.m[i % 3][i / 3];
        }
    }
    return built;
}

bool ready_at(const Arrays &a, Eigen::Index w, const Vec &r, const Vec &n2) {
    const Vec dr(a.x[w] - r.x(), a.y[w] - r.y(), a.z[w] - r.z());
    const double x = dr.x() * a.e(w, 0) + dr.y() * a.e(w, 1) + dr.z() * a.e(w, 2);
    const double y = dr.x() * a.e(w, 3) + dr.y() * a.e(w, 4) + dr.z() * a.e(w, 5);
    return x * x + y * y < a.tolerance.projxy * a.tolerance.projxy &&
           n2.x() * a.n_x[w] + n2.y() * a.n_y[w] + n2.z() * a.n_z[w] > a.tolerance.planar;
}

// |dr_proj_z| of 64 wafers in one expression; most blocks have no wafer within its limit.
uint64_t count_blocks(void *built, const wh_pose_t *grippers, size_t gripper_count) {
    constexpr Eigen::Index block = 64;
    const Arrays &a = *static_cast<Arrays *>(built);
    Eigen::Array<double, Eigen::Dynamic, 1, 0, block, 1> distance;
    uint64_t ready = 0;
    for (size_t g = 0; g < gripper_count; ++g) {
        const Vec r = vec(grippers[g].r);
        const Vec n2 = mat(grippers[g].R).col(2);
        for (Eigen::Index begin = 0; begin < a.x.size(); begin += block) {
            const Eigen::Index n = std::min(block, a.x.size() - begin);
            distance = ((a.x.segment(begin, n) - r.x()) * a.n_x.segment(begin, n) +
                        (a.y.segment(begin, n) - r.y()) * a.n_y.segment(begin, n) +
                        (a.z.segment(begin, n) - r.z()) * a.n_z.segment(begin, n))
                           .abs();
            if (!(distance.minCoeff() < a.tolerance.projz)) {
                continue;
            }
            for (Eigen::Index i = 0; i < n; ++i) {
                ready += distance[i] < a.tolerance.projz && ready_at(a, begin + i, r, n2);
            }
        }
    }
    return ready;
}

// All conditions of all wafers in one expression, with |dr_proj_xy|^2 = |dr|^2 - dr_proj_z^2.
uint64_t count_whole(void *built, const wh_pose_t *grippers, size_t gripper_count) {
    const Arrays &a = *static_cast<Arrays *>(built);
    const wh_tolerance_t &t = a.tolerance;
    uint64_t ready = 0;
    for (size_t g = 0; g < gripper_count; ++g) {
        const Vec r = vec(grippers[g].r);
        const Vec n2 = mat(grippers[g].R).col(2);
        const auto z = (a.x - r.x()) * a.n_x + (a.y - r.y()) * a.n_y + (a.z - r.z()) * a.n_z;
        const auto far =
            (a.x - r.x()).square() + (a.y - r.y()).square() + (a.z - r.z()).square() - z.square();
        ready += static_cast<uint64_t>((z.abs() < t.projz && far < t.projxy * t.projxy &&
                                        n2.x() * a.n_x + n2.y() * a.n_y + n2.z() * a.n_z > t.planar)
                                           .count());
    }
    return ready;
}

} // namespace

BENCH_PEER bench_check_peer_t bench_peer = {
    {{Literal::name, build_poses, count_poses<Literal>, drop<Poses>},
     {Squared::name, build_poses, count_poses<Squared>, drop<Poses>},
     {Expression::name, build_poses, count_poses<Expression>, drop<Poses>},
     {"arrays/blocks", build_arrays, count_blocks, drop<Arrays>},
     {"arrays/whole", build_arrays, count_whole, drop<Arrays>},
     {}}};
