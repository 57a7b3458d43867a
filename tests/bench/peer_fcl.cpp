// FCL on a wafer as a cylinder and a blade as a box: whether a pair collides, and how far apart it is.
#include <fcl/fcl.h>
#include <memory>
#include <vector>

#include "bench/peers.h"

namespace {

using Object = fcl::CollisionObjectd;

fcl::Transform3d transform(const wh_pose_t &pose, double up) {
    fcl::Transform3d at = fcl::Transform3d::Identity();
    at.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&pose.R.m[0][0]);
    at.translation() = fcl::Vector3d(pose.r.x, pose.r.y, pose.r.z + up);
    return at;
}

struct Objects {
    std::vector<std::unique_ptr<Object>> wafers;
    Object blade{std::make_shared<fcl::Boxd>(80, 180, 3)};
};

void *build(const wh_pose_t *wafers, size_t count, const wh_tolerance_t *) {
    auto *objects = new Objects;
    const auto disc = std::make_shared<fcl::Cylinderd>(150, 0.775);
    for (size_t w = 0; w < count; ++w) {
        objects->wafers.push_back(std::make_unique<Object>(disc, transform(wafers[w], 0.3875)));
    }
    return objects;
}

template <typename Ask>
uint64_t count(void *built, const wh_pose_t *grippers, size_t gripper_count, Ask ask) {
    Objects &objects = *static_cast<Objects *>(built);
    uint64_t touching = 0;
    for (size_t g = 0; g < gripper_count; ++g) {
        objects.blade.setTransform(transform(grippers[g], -1.5));
        for (const auto &wafer : objects.wafers) {
            touching += ask(wafer.get(), &objects.blade);
        }
    }
    return touching;
}

uint64_t collide(void *built, const wh_pose_t *grippers, size_t gripper_count) {
    return count(built, grippers, gripper_count, [](Object *a, Object *b) {
        const fcl::CollisionRequestd request;
        fcl::CollisionResultd result;
        return fcl::collide(a, b, request, result) > 0;
    });
}

uint64_t distance(void *built, const wh_pose_t *grippers, size_t gripper_count) {
    return count(built, grippers, gripper_count, [](Object *a, Object *b) {
        const fcl::DistanceRequestd request;
        fcl::DistanceResultd result;
        return fcl::distance(a, b, request, result) <= 0;
    });
}

void drop(void *built) {
    delete static_cast<Objects *>(built);
}

} // namespace

BENCH_PEER bench_check_peer_t bench_peer = {
    {{"FCL, collide", build, collide, drop}, {"FCL, distance", build, distance, drop}, {}}};
