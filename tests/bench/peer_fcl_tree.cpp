// FCL's dynamic tree of bounding boxes: wafers as points in it, the neighbourhood as a ball.
#include <fcl/fcl.h>
#include <memory>
#include <vector>

#include "bench/peers.h"
#include "bench/scene.h"

namespace {

using Object = fcl::CollisionObjectd;

struct Built {
    std::vector<wh_pose_t> wafers;
    wh_grasp_config_t config;
    std::vector<std::unique_ptr<Object>> objects;
    fcl::DynamicAABBTreeCollisionManagerd tree;
    std::unique_ptr<Object> ball;
    const wh_pose_t *gripper = nullptr;
    uint64_t seen = 0;
};

bool meet(Object *a, Object *b, void *data) {
    Built &built = *static_cast<Built *>(data);
    const Object *wafer = a == built.ball.get() ? b : a;
    built.seen +=
        bench_look(static_cast<const wh_pose_t *>(wafer->getUserData()), built.gripper, &built.config);
    return false;
}

void *build(const wh_pose_t *wafers, size_t count, const wh_grasp_config_t *config) {
    auto *built = new Built;
    built->wafers.assign(wafers, wafers + count);
    built->config = *config;
    const double radius =
        std::sqrt(config->near_projz * config->near_projz + config->near_projxy * config->near_projxy);
    built->ball = std::make_unique<Object>(std::make_shared<fcl::Sphered>(1.00001 * radius));
    const auto point = std::make_shared<fcl::Sphered>(1e-9);
    std::vector<Object *> all;
    for (wh_pose_t &pose : built->wafers) {
        fcl::Transform3d at = fcl::Transform3d::Identity();
        at.translation() = fcl::Vector3d(pose.r.x, pose.r.y, pose.r.z);
        built->objects.push_back(std::make_unique<Object>(point, at));
        built->objects.back()->setUserData(&pose);
        all.push_back(built->objects.back().get());
    }
    built->tree.registerObjects(all);
    built->tree.setup();
    return built;
}

uint64_t look(void *built_, const wh_pose_t *grippers, size_t gripper_count) {
    Built &built = *static_cast<Built *>(built_);
    built.seen = 0;
    for (size_t g = 0; g < gripper_count; ++g) {
        built.gripper = &grippers[g];
        built.ball->setTranslation(fcl::Vector3d(grippers[g].r.x, grippers[g].r.y, grippers[g].r.z));
        built.ball->computeAABB();
        built.tree.collide(built.ball.get(), &built, meet);
    }
    return built.seen;
}

void drop(void *built) {
    delete static_cast<Built *>(built);
}

} // namespace

BENCH_PEER bench_index_peer_t bench_peer = {"FCL, tree", build, look, drop};
