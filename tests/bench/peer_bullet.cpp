// Bullet: discs that float apart, without gravity and without contacts, and a blade that is moved. It does more than we do: it
// integrates motion, and keeps its broad phase up to date.
#include <BulletDynamics/Dynamics/btSimpleDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <memory>
#include <vector>

#include "bench/peers.h"

namespace {

// btSimpleDynamicsWorld has no islands and no sleep, and keeps fewer promises.
template <typename Dynamics> struct World {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    Dynamics world{&dispatcher, &broadphase, &solver, &configuration};
    btCylinderShapeZ disc{btVector3(0.15F, 0.15F, 0.0004F)};
    btBoxShape blade{btVector3(0.04F, 0.09F, 0.0015F)};
    std::vector<std::unique_ptr<btRigidBody>> bodies;
    void add(btCollisionShape *shape, float mass, const btVector3 &at) {
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, btVector3(1, 1, 1));
        info.m_startWorldTransform.setOrigin(at);
        bodies.push_back(std::make_unique<btRigidBody>(info));
        world.addRigidBody(bodies.back().get(), 1, 0); // meets nothing
    }
    ~World() {
        for (auto &body : bodies) {
            world.removeRigidBody(body.get());
        }
    }
};

template <typename Dynamics, int state> void *build(size_t wafers) {
    auto *made = new World<Dynamics>;
    made->world.setGravity(btVector3(0, 0, 0));
    made->world.setForceUpdateAllAabbs(false);
    made->world.getSolverInfo().m_numIterations = 1;
    made->world.getDispatchInfo().m_useContinuous = false;
    made->add(&made->blade, 0, btVector3(0, 0, -1));
    made->bodies[0]->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    made->bodies[0]->forceActivationState(DISABLE_DEACTIVATION);
    for (size_t w = 0; w < wafers; ++w) {
        made->add(&made->disc, 0.1F, btVector3(static_cast<float>(w), 0, 0));
        made->bodies.back()->forceActivationState(state);
    }
    return made;
}

template <typename Dynamics> uint64_t step(void *world, const wh_pose_t *gripper) {
    auto &made = *static_cast<World<Dynamics> *>(world);
    const auto to_m = [](double mm) { return static_cast<float>(mm * 1e-3); };
    made.bodies[0]->getWorldTransform().setOrigin(
        btVector3(to_m(gripper->r.x), to_m(gripper->r.y), to_m(gripper->r.z)));
    return static_cast<uint64_t>(made.world.stepSimulation(0.001F, 0));
}

template <typename Dynamics> void drop(void *world) {
    delete static_cast<World<Dynamics> *>(world);
}

} // namespace

using Full = btDiscreteDynamicsWorld;
using Simple = btSimpleDynamicsWorld;

BENCH_PEER bench_step_peer_t bench_peer = {
    {{"Bullet", build<Full, DISABLE_DEACTIVATION>, step<Full>, drop<Full>},
     {"Bullet, simple world", build<Simple, DISABLE_DEACTIVATION>, step<Simple>, drop<Simple>},
     {"Bullet, asleep", build<Full, ISLAND_SLEEPING>, step<Full>, drop<Full>},
     {}}};
