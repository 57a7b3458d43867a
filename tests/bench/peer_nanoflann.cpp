// nanoflann: a k-d tree over the wafers' origins; those within the neighbourhood's radius of the gripper are looked at.
#include <memory>
#include <nanoflann.hpp>
#include <vector>

#include "bench/peers.h"
#include "bench/scene.h"

namespace {

struct Cloud {
    const std::vector<wh_pose_t> &wafers;
    size_t kdtree_get_point_count() const {
        return wafers.size();
    }
    double kdtree_get_pt(size_t index, size_t axis) const {
        const wh_vec3_t &r = wafers[index].r;
        return axis == 0 ? r.x : axis == 1 ? r.y : r.z;
    }
    template <class Box> bool kdtree_get_bbox(Box &) const {
        return false;
    }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3>;

struct Built {
    std::vector<wh_pose_t> wafers;
    wh_grasp_config_t config;
    Cloud cloud{wafers};
    Tree tree{3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10)};
    std::vector<std::pair<uint32_t, double>> found;
    Built(const wh_pose_t *poses, size_t count, const wh_grasp_config_t *config_)
        : wafers(poses, poses + count), config(*config_) {
    }
};

void *build(const wh_pose_t *wafers, size_t count, const wh_grasp_config_t *config) {
    auto *built = new Built(wafers, count, config);
    built->tree.buildIndex();
    return built;
}

uint64_t look(void *built_, const wh_pose_t *grippers, size_t gripper_count) {
    Built &built = *static_cast<Built *>(built_);
    const double squared = built.config.near_projz * built.config.near_projz +
                           built.config.near_projxy * built.config.near_projxy;
    const nanoflann::SearchParams unsorted(32, 0, false);
    uint64_t seen = 0;
    for (size_t g = 0; g < gripper_count; ++g) {
        built.found.clear();
        const double at[3] = {grippers[g].r.x, grippers[g].r.y, grippers[g].r.z};
        // A little more, for rotations that are orthonormal to 1e-6 only.
        (void)built.tree.radiusSearch(at, squared * 1.00001, built.found, unsorted);
        for (const auto &one : built.found) {
            seen += bench_look(&built.wafers[one.first], &grippers[g], &built.config);
        }
    }
    return seen;
}

void drop(void *built) {
    delete static_cast<Built *>(built);
}

} // namespace

BENCH_PEER bench_index_peer_t bench_peer = {BENCH_NAME, build, look, drop};
