/* Wafers and grippers that the benches share: FOUP-like columns of 25 at 10 mm pitch, or single
 * ones, on a square grid 500 mm wide. Each wafer lies a little aside from its nominal pose and is
 * turned a little. The scene is the same on every machine. */
#ifndef WH_TESTS_BENCH_SCENE_H
#define WH_TESTS_BENCH_SCENE_H

#include <stdlib.h>

#include <waferhand.h>

#include "support/random.h"

enum { BENCH_COLUMN = 25, BENCH_PITCH = 10, BENCH_GRID = 500 };

static inline double bench_uniform(uint64_t *state, double low, double high) {
    return low + (high - low) * (double)(wh_test_splitmix(state) >> 11) / 9007199254740992.0;
}

/* Turned by `yaw`, then tilted by a small angle about a level axis. */
static inline wh_pose_t bench_pose(uint64_t *state, double x, double y, double z, double tilt) {
    double s;
    double c;
    wh_sin_cos(bench_uniform(state, -3, 3), &s, &c);
    const double a = bench_uniform(state, -tilt, tilt);
    const double b = bench_uniform(state, -tilt, tilt);
    wh_pose_t pose = {{{{c, -s, b}, {s, c, -a}, {a * s - b * c, a * c + b * s, 1}}}, {x, y, z}};
    for (int i = 0; i < 3; ++i) {
        wh_mat3_orthonormalise(&pose.R);
    }
    return pose;
}

/* Level, turned by `yaw`. */
static inline wh_pose_t bench_level(double yaw, const wh_vec3_t *at) {
    wh_pose_t pose = wh_pose_identity();
    wh_sin_cos(yaw, &pose.R.m[1][0], &pose.R.m[0][0]);
    pose.R.m[0][1] = -pose.R.m[1][0];
    pose.R.m[1][1] = pose.R.m[0][0];
    pose.r = *at;
    return pose;
}

/* The number of columns along a side of the square. */
static inline size_t bench_side(size_t count, size_t column) {
    size_t side = 1;
    while (side * side * column < count) {
        ++side;
    }
    return side;
}

/* The caller frees them. */
static inline wh_pose_t *bench_wafers(size_t count, size_t column) {
    uint64_t state = 1;
    wh_pose_t *wafers = (wh_pose_t *)malloc(count * sizeof *wafers);
    const size_t side = bench_side(count, column);
    for (size_t w = 0; wafers && w < count; ++w) {
        const size_t place = w / column;
        const double x = (double)(place % side * BENCH_GRID) + bench_uniform(&state, -2, 2);
        const double y = (double)(place / side * BENCH_GRID) + bench_uniform(&state, -2, 2);
        wafers[w] = bench_pose(&state, x, y, (double)(w % column * BENCH_PITCH), 0.002);
    }
    return wafers;
}

/* The value nearest to `x` that is among columns on a square of that width. */
static inline double bench_among(double x, double width) {
    const double low = -BENCH_GRID / 2.0;
    return x < low ? low : x > width + low ? width + low : x;
}

/* Slices of a gripper at 400 mm/s and 1 ms. It moves straight and level from one random point among
 * the columns to another, up to 700 mm away along x and y. Its height is between two slots, so it
 * comes near wafers (within 4.5 and 100 mm) but never takes one. One leg in `turns` also turns, at
 * 0.4 rad/s; 0: none. */
static inline void bench_path(wh_pose_t *poses, size_t count, size_t side, size_t column, size_t turns) {
    const double step = 0.4;
    const double width = (double)(side * BENCH_GRID);
    uint64_t state = 3;
    wh_vec3_t at = wh_vec3(width / 2, width / 2, 0);
    double yaw = 0;
    for (size_t done = 0, leg = 0; done < count; ++leg) {
        const double rate = turns > 0 && leg % turns == 0 ? 0.0004 : 0;
        const double dx = bench_among(at.x + bench_uniform(&state, -700, 700), width) - at.x;
        const double dy = bench_among(at.y + bench_uniform(&state, -700, 700), width) - at.y;
        const double distance = wh_real_sqrt(dx * dx + dy * dy);
        at.z =
            (double)(wh_test_splitmix(&state) % (column + 1)) * BENCH_PITCH - bench_uniform(&state, 1.5, 8.5);
        for (double gone = 0; gone < distance && done < count; gone += step, ++done) {
            at.x += dx / distance * step;
            at.y += dy / distance * step;
            yaw = rate > 0 && yaw > 3 ? -3 : yaw + rate;
            poses[done] = bench_level(yaw, &at);
        }
    }
}

/* A gripper at another place among the columns in each slice. */
static inline void bench_teleport(wh_pose_t *poses, size_t count, size_t side, size_t column) {
    uint64_t state = 4;
    const double width = (double)(side * BENCH_GRID);
    for (size_t done = 0; done < count; ++done) {
        const double x = bench_uniform(&state, -BENCH_GRID / 2.0, width - BENCH_GRID / 2.0);
        const double y = bench_uniform(&state, -BENCH_GRID / 2.0, width - BENCH_GRID / 2.0);
        const double z = (double)(wh_test_splitmix(&state) % (column + 1)) * BENCH_PITCH;
        poses[done] = bench_pose(&state, x, y, z - bench_uniform(&state, 1.5, 8.5), 0);
    }
}

/* 1 for a wafer in the gripper's neighbourhood, plus 2^32 if it is ready. */
static inline uint64_t bench_look(const wh_pose_t *wafer, const wh_pose_t *gripper,
                                  const wh_grasp_config_t *config) {
    const wh_vec3_t dr = wh_vec3_subtract(&wafer->r, &gripper->r);
    const wh_vec3_t n1 = wh_mat3_column(&wafer->R, 2);
    const double z = wh_real_abs(wh_vec3_dot(&dr, &n1));
    if (!(z < config->near_projz)) {
        return 0;
    }
    const wh_vec3_t p = wh_mat3_transform_back(&wafer->R, &dr);
    const double xy = wh_real_sqrt(p.x * p.x + p.y * p.y);
    const wh_vec3_t n2 = wh_mat3_column(&gripper->R, 2);
    const bool ready = z < config->tolerance.projz && xy < config->tolerance.projxy &&
                       wh_vec3_dot(&n1, &n2) > config->tolerance.planar;
    return (xy < config->near_projxy) + ((uint64_t)ready << 32);
}

#endif
