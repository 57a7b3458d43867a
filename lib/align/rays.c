/* The parts common to all fits: the sines of a scan, and its dents. */
#include "rays_internal.h"

#include "angle_internal.h"

/* ---------------------------------------------------------------------------------------------- the sines */

/* Sine and cosine of a step of at most SMALL_STEP turn the ray before; every FRESH rays both are computed
 * again. */
#define SMALL_STEP 0.02
#define FRESH 32

static void turn_ray(const wh_rim_ray_t *before, double angle, wh_rim_ray_t *ray) {
    const double square = angle * angle;
    const double sine = angle * (1 - square / 6 * (1 - square / 20));
    const double versine = square / 2 * (1 - square / 12 * (1 - square / 30));
    ray->cosine = before->cosine - (before->cosine * versine + before->sine * sine);
    ray->sine = before->sine - (before->sine * versine - before->cosine * sine);
}

void wh_rays_begin(const wh_rim_scan_t *scan, wh_rim_ray_t *rays) {
    for (size_t i = 0; i < scan->count; ++i) {
        const wh_rim_point_t *point = &scan->points[i];
        const double by = i % FRESH == 0 ? 1 : point->angle - scan->points[i - 1].angle;
        if (fabs(by) < SMALL_STEP) {
            turn_ray(&rays[i - 1], by, &rays[i]);
        } else {
            wh_align_sin_cos(point->angle, &rays[i].sine, &rays[i].cosine);
        }
        rays[i].weight = point->sight == WH_SIGHT_RIM ? 1 : 0;
        rays[i].residual = 0;
    }
}

/* ---------------------------------------------------------------------------------------------- the dents */

#define LEAST_DEPTH 0.05
#define DEVIATIONS 6
/* A mark's depth grows by at most this from one sample to the next. */
#define STEEP 0.5
/* This number of samples on the circle, or without a view of the rim, does not split a dent. */
#define BRIDGE 2

/* A run during the walk. */
typedef struct {
    wh_dents_t *found;
    wh_dent_t dent;
    size_t bridge;
} walk_t;

static void finish(walk_t *walk) {
    wh_dents_t *found = walk->found;
    if (walk->dent.count > 0) {
        walk->dent.count -= walk->bridge;
        if (found->count < WH_DENTS) {
            found->dents[found->count] = walk->dent;
            ++found->count;
        } else {
            found->whole = false;
        }
    }
    walk->dent.count = 0;
    walk->bridge = 0;
}

/* A single sample far below its neighbours is light through glass. */
static double depth_of(const wh_scanned_t *of, size_t i) {
    const size_t count = of->scan->count;
    const double before = 0 - of->rays[(i + count - 1) % count].residual;
    const double after = 0 - of->rays[(i + 1) % count].residual;
    const double most = (before > after ? before : after) + STEEP;
    const double depth = 0 - of->rays[i].residual;
    return depth < most ? depth : most;
}

/* Adds a sample that belongs to the dent. */
static void lengthen(walk_t *walk, const wh_scanned_t *of, size_t i) {
    if (walk->dent.count == 0) {
        walk->dent.first = i;
        walk->dent.depth = 0;
    }
    const double depth = depth_of(of, i);
    walk->dent.depth = depth > walk->dent.depth ? depth : walk->dent.depth;
    ++walk->dent.count;
    walk->bridge = 0;
}

static void meet(walk_t *walk, const wh_scanned_t *of, size_t i, double least) {
    const bool is_in = of->scan->points[i].sight == WH_SIGHT_RIM && of->rays[i].residual < -least;
    if (is_in && wh_scanned_counts(of, i)) {
        lengthen(walk, of, i);
    } else if (is_in && walk->dent.count > 0) { /* light, or a dent that is deeper than a mark */
        ++walk->dent.count;
        walk->bridge = 0;
    } else if (walk->dent.count > 0) {
        ++walk->dent.count;
        ++walk->bridge;
    }
    if (walk->bridge > BRIDGE) {
        finish(walk);
    }
}

/* A run may continue from the last sample to the first, so the walk begins after samples on the circle. */
static size_t begin_at(const wh_scanned_t *of) {
    size_t on = 0;
    for (size_t i = 0; i < of->scan->count; ++i) {
        on = of->rays[i].weight > 0 ? on + 1 : 0;
        if (on > BRIDGE) {
            return i;
        }
    }
    return 0;
}

wh_dents_t wh_dents_find(const wh_scanned_t *of) {
    wh_dents_t found;
    found.count = 0;
    found.whole = true;
    walk_t walk = {&found, {0, 0, 0}, 0};
    const double least = DEVIATIONS * of->circle->scatter;
    const size_t count = of->scan->count;
    const size_t begin = begin_at(of);
    for (size_t k = 0; k < count; ++k) {
        const size_t i = begin + k < count ? begin + k : begin + k - count;
        meet(&walk, of, i, least > LEAST_DEPTH ? least : LEAST_DEPTH);
    }
    finish(&walk);
    return found;
}
