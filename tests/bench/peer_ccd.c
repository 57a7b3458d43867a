/* libccd on a wafer as a cylinder and a blade as a box: checks whether they overlap, by MPR and by GJK. */
#include <ccd/ccd.h>
#include <ccd/quat.h>
#include <stdlib.h>

#include "bench/peers.h"

typedef struct {
    ccd_vec3_t half; /* the blade; the wafer: its radius twice, and half its thickness */
    ccd_vec3_t columns[3];
    ccd_vec3_t at;
    bool round;
} shape_t;

typedef struct {
    shape_t *wafers;
    size_t count;
} shapes_t;

static shape_t shape(const wh_pose_t *pose, bool round) {
    shape_t made = {.round = round};
    ccdVec3Set(&made.half, round ? 150 : 40, round ? 150 : 90, round ? 0.3875 : 1.5);
    for (size_t i = 0; i < 3; ++i) {
        ccdVec3Set(&made.columns[i], pose->R.m[0][i], pose->R.m[1][i], pose->R.m[2][i]);
    }
    /* The wafer's origin is in its back face, the blade's in its pads' plane. */
    ccdVec3Set(&made.at, pose->r.x, pose->r.y, pose->r.z + (round ? 0.3875 : -1.5));
    return made;
}

static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *point) {
    const shape_t *s = object;
    const double x = ccdVec3Dot(direction, &s->columns[0]);
    const double y = ccdVec3Dot(direction, &s->columns[1]);
    const double z = ccdVec3Dot(direction, &s->columns[2]);
    double reach[3] = {x < 0 ? -s->half.v[0] : s->half.v[0], y < 0 ? -s->half.v[1] : s->half.v[1],
                       z < 0 ? -s->half.v[2] : s->half.v[2]};
    if (s->round) {
        const double size = wh_real_sqrt(x * x + y * y);
        reach[0] = size > 0 ? s->half.v[0] * x / size : 0;
        reach[1] = size > 0 ? s->half.v[0] * y / size : 0;
    }
    *point = s->at;
    for (size_t i = 0; i < 3; ++i) {
        ccd_vec3_t part = s->columns[i];
        ccdVec3Scale(&part, reach[i]);
        ccdVec3Add(point, &part);
    }
}

static void center(const void *object, ccd_vec3_t *point) {
    *point = ((const shape_t *)object)->at;
}

static void *build(const wh_pose_t *wafers, size_t count, const wh_tolerance_t *tolerance) {
    (void)tolerance;
    shapes_t *shapes = malloc(sizeof *shapes);
    shapes->wafers = malloc(count * sizeof *shapes->wafers);
    shapes->count = count;
    for (size_t w = 0; w < count; ++w) {
        shapes->wafers[w] = shape(&wafers[w], true);
    }
    return shapes;
}

static uint64_t count(void *built, const wh_pose_t *grippers, size_t gripper_count,
                      int (*overlap)(const void *, const void *, const ccd_t *)) {
    const shapes_t *shapes = built;
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = support;
    ccd.support2 = support;
    ccd.center1 = center;
    ccd.center2 = center;
    ccd.max_iterations = 100;
    uint64_t touching = 0;
    for (size_t g = 0; g < gripper_count; ++g) {
        const shape_t blade = shape(&grippers[g], false);
        for (size_t w = 0; w < shapes->count; ++w) {
            touching += overlap(&shapes->wafers[w], &blade, &ccd) != 0;
        }
    }
    return touching;
}

static uint64_t count_mpr(void *built, const wh_pose_t *grippers, size_t gripper_count) {
    return count(built, grippers, gripper_count, ccdMPRIntersect);
}

static uint64_t count_gjk(void *built, const wh_pose_t *grippers, size_t gripper_count) {
    return count(built, grippers, gripper_count, ccdGJKIntersect);
}

static void drop(void *built) {
    shapes_t *shapes = built;
    free(shapes->wafers);
    free(shapes);
}

BENCH_PEER bench_check_peer_t bench_peer = {
    {{"libccd, MPR", build, count_mpr, drop}, {"libccd, GJK", build, count_gjk, drop}, {0}}};
