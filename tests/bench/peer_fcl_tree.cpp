// FCL's dynamic tree of bounding boxes: wafers as points in it, the neighbourhood as a ball; and a cell's shapes in it.
#include <algorithm>
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

// ------------------------------------------------------------------------------------------------- a cell

enum class Question { contact, nearest, continuous };

fcl::Transform3d transform(const wh_pose_t &pose) {
    fcl::Transform3d at = fcl::Transform3d::Identity();
    at.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&pose.R.m[0][0]);
    at.translation() = fcl::Vector3d(pose.r.x, pose.r.y, pose.r.z);
    return at;
}

std::shared_ptr<fcl::CollisionGeometryd> geometry(const wh_convex_t &convex) {
    const wh_vec3_t &half = convex.half;
    switch (convex.kind) {
    case WH_CONVEX_BOX:
        return std::make_shared<fcl::Boxd>(2 * half.x, 2 * half.y, 2 * half.z);
    case WH_CONVEX_CYLINDER:
        return std::make_shared<fcl::Cylinderd>(half.x, 2 * half.z);
    case WH_CONVEX_CAPSULE:
        return std::make_shared<fcl::Capsuled>(half.x, 2 * half.z);
    case WH_CONVEX_MESH:
        break;
    }
    return nullptr;
}

struct Cell {
    Question question;
    std::vector<std::unique_ptr<Object>> objects;
    std::vector<int32_t> group; // of those that move; WH_NONE: it rests
    std::vector<fcl::Transform3d> before;
    const bool *neighbours;
    fcl::DynamicAABBTreeCollisionManagerd rest;
    bench_near_t *found;
    size_t count, capacity;
    double least;
    int32_t asking; // the mover whose way a box stands for
};

int32_t index_of(const Object *object) {
    return static_cast<int32_t>(reinterpret_cast<intptr_t>(object->getUserData())) - 1;
}

void note(Cell &cell, int32_t a, int32_t b, double gap) {
    if (cell.count < cell.capacity) {
        cell.found[cell.count++] = {a, b, gap};
    }
}

void judge_contact(Cell &cell, Object *a, Object *b) {
    const fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    if (fcl::collide(a, b, request, result) > 0) {
        note(cell, index_of(a), index_of(b), 0);
    }
}

void judge_nearest(Cell &cell, Object *a, Object *b) {
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    const double gap = fcl::distance(a, b, request, result);
    if (gap < cell.least) {
        cell.least = gap;
        cell.count = 0;
        note(cell, index_of(a), index_of(b), gap);
    }
}

void judge_continuous(Cell &cell, Object *a, Object *b) {
    fcl::ContinuousCollisionRequestd request;
    fcl::ContinuousCollisionResultd result;
    request.ccd_motion_type = fcl::CCDM_LINEAR;
    request.ccd_solver_type = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    const auto a_before = cell.before[static_cast<size_t>(index_of(a))];
    const auto b_before = cell.before[static_cast<size_t>(index_of(b))];
    fcl::continuousCollide(a->collisionGeometry().get(), a_before, a->getTransform(),
                           b->collisionGeometry().get(), b_before, b->getTransform(), request, result);
    if (result.is_collide) {
        note(cell, index_of(a), index_of(b), 0);
    }
}

bool is_asked(const Cell &cell, int32_t a, int32_t b) {
    const int32_t one = cell.group[static_cast<size_t>(a)];
    const int32_t two = cell.group[static_cast<size_t>(b)];
    return one != two &&
           !cell.neighbours[static_cast<size_t>(a) * cell.objects.size() + static_cast<size_t>(b)];
}

void judge(Cell &cell, Object *a, Object *b) {
    if (!is_asked(cell, index_of(a), index_of(b))) {
        return;
    }
    if (cell.question == Question::contact) {
        judge_contact(cell, a, b);
    } else if (cell.question == Question::nearest) {
        judge_nearest(cell, a, b);
    } else {
        judge_continuous(cell, a, b);
    }
}

bool on_pair(Object *a, Object *b, void *data) {
    Cell &cell = *static_cast<Cell *>(data);
    Object *mover = cell.objects[static_cast<size_t>(cell.asking)].get();
    judge(cell, mover, index_of(a) == cell.asking ? b : a);
    return false;
}

bool on_near(Object *a, Object *b, void *data, double &least) {
    Cell &cell = *static_cast<Cell *>(data);
    judge(cell, a, b);
    least = cell.least;
    return false;
}

template <Question question> void *build_cell(const bench_cell_t *from) {
    auto *cell = new Cell{};
    std::vector<Object *> all;
    cell->question = question;
    cell->neighbours = from->neighbours;
    cell->group.assign(from->count, WH_NONE);
    for (size_t i = 0; i < from->count; ++i) {
        const auto at = transform(from->base_from_shape[i]);
        cell->objects.push_back(std::make_unique<Object>(geometry(*from->convex[i]), at));
        cell->objects.back()->setUserData(reinterpret_cast<void *>(static_cast<intptr_t>(i + 1)));
        cell->before.push_back(at);
        all.push_back(cell->objects.back().get());
    }
    cell->rest.registerObjects(all);
    cell->rest.setup();
    return cell;
}

void begin_to_move(Cell &cell, const bench_mover_t &mover) {
    const auto shape = static_cast<size_t>(mover.shape);
    Object *object = cell.objects[shape].get();
    if (cell.group[shape] == WH_NONE) {
        cell.rest.unregisterObject(object);
    }
    cell.group[shape] = mover.group;
    cell.before[shape] = transform(mover.before);
    object->setTransform(transform(mover.now));
    object->computeAABB();
}

void end_moving(Cell &cell, const bench_slice_t &slice) {
    for (size_t i = 0; i < cell.objects.size(); ++i) {
        const bool moves =
            std::any_of(slice.movers, slice.movers + slice.count,
                        [i](const bench_mover_t &mover) { return static_cast<size_t>(mover.shape) == i; });
        if (cell.group[i] != WH_NONE && !moves) {
            cell.group[i] = WH_NONE;
            cell.before[i] = cell.objects[i]->getTransform();
            cell.rest.registerObject(cell.objects[i].get());
        }
    }
}

fcl::AABBd bounds(const Cell &cell, int32_t shape) {
    const Object *object = cell.objects[static_cast<size_t>(shape)].get();
    fcl::AABBd box = object->getAABB();
    if (cell.question == Question::continuous) {
        Object before(*object);
        before.setTransform(cell.before[static_cast<size_t>(shape)]);
        before.computeAABB();
        box += before.getAABB();
    }
    return box;
}

void look_at_rest(Cell &cell, int32_t shape) {
    cell.asking = shape;
    Object *object = cell.objects[static_cast<size_t>(shape)].get();
    if (cell.question == Question::nearest) {
        cell.rest.distance(object, &cell, on_near);
    } else if (cell.question == Question::contact) {
        cell.rest.collide(object, &cell, on_pair);
    } else {
        const fcl::AABBd box = bounds(cell, shape);
        const fcl::Vector3d size = box.max_ - box.min_;
        fcl::Transform3d at = fcl::Transform3d::Identity();
        at.translation() = box.center();
        Object way(std::make_shared<fcl::Boxd>(size), at);
        way.setUserData(object->getUserData());
        cell.rest.collide(&way, &cell, on_pair);
    }
}

void look_at_movers(Cell &cell, const bench_slice_t &slice) {
    for (size_t i = 0; i < slice.count; ++i) {
        const fcl::AABBd box = bounds(cell, slice.movers[i].shape);
        for (size_t k = i + 1; k < slice.count; ++k) {
            const fcl::AABBd other = bounds(cell, slice.movers[k].shape);
            const bool is_near =
                cell.question == Question::nearest ? box.distance(other) < cell.least : box.overlap(other);
            if (is_near) {
                judge(cell, cell.objects[static_cast<size_t>(slice.movers[i].shape)].get(),
                      cell.objects[static_cast<size_t>(slice.movers[k].shape)].get());
            }
        }
    }
}

size_t look_at_cell(void *built, const bench_slice_t *slice, bench_near_t found[], size_t capacity) {
    Cell &cell = *static_cast<Cell *>(built);
    cell.found = found;
    cell.count = 0;
    cell.capacity = capacity;
    cell.least = 20;
    end_moving(cell, *slice);
    for (size_t i = 0; i < slice->count; ++i) {
        begin_to_move(cell, slice->movers[i]);
    }
    cell.rest.update();
    for (size_t i = 0; i < slice->count; ++i) {
        look_at_rest(cell, slice->movers[i].shape);
    }
    look_at_movers(cell, *slice);
    return cell.count;
}

void drop_cell(void *built) {
    delete static_cast<Cell *>(built);
}

} // namespace

BENCH_PEER bench_index_peer_t bench_peer = {"FCL, tree", build, look, drop};

BENCH_PEER bench_collider_t bench_cell[] = {
    {"FCL, collide", false, build_cell<Question::contact>, look_at_cell, drop_cell},
    {"FCL, distance", true, build_cell<Question::nearest>, look_at_cell, drop_cell},
    {"FCL, continuous", false, build_cell<Question::continuous>, look_at_cell, drop_cell},
    {nullptr, false, nullptr, nullptr, nullptr}};
