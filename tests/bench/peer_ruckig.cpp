// ruckig: a move of all axes at once from rest to rest, synchronised in time. It does more than we do: any state of motion at
// both ends, for which rest is one case.
#include <ruckig/ruckig.hpp>

#include "bench/peers.h"

namespace {

struct Planner {
    virtual double plan(const double from[], const double to[]) = 0;
    virtual ~Planner() = default;
};

template <size_t Axes> struct Fixed final : Planner {
    ruckig::Ruckig<Axes> planner;
    ruckig::InputParameter<Axes> input;
    ruckig::Trajectory<Axes> trajectory;
    explicit Fixed(const wh_limits_t limits[]) {
        for (size_t i = 0; i < Axes; ++i) {
            input.max_velocity[i] = limits[i].speed;
            input.max_acceleration[i] = limits[i].acceleration;
            input.max_jerk[i] = limits[i].jerk;
        }
    }
    double plan(const double from[], const double to[]) override {
        for (size_t i = 0; i < Axes; ++i) {
            input.current_position[i] = from[i];
            input.target_position[i] = to[i];
        }
        return planner.calculate(input, trajectory) == ruckig::Result::Working ? trajectory.get_duration()
                                                                               : -1;
    }
};

void *build(size_t axes, const wh_limits_t limits[]) {
    Planner *planner = axes == 1 ? static_cast<Planner *>(new Fixed<1>(limits)) : new Fixed<4>(limits);
    return planner;
}

double plan(void *planner, const double from[], const double to[]) {
    return static_cast<Planner *>(planner)->plan(from, to);
}

void drop(void *planner) {
    delete static_cast<Planner *>(planner);
}

} // namespace

BENCH_PEER bench_profile_peer_t bench_peer = {"ruckig", build, plan, drop};
