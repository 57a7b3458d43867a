#include "gap_internal.h"

/* A point of each kernel; `between` goes from a's to b's. */
typedef struct {
    wh_vec3_t in_a, in_b;    /* in the shape's frame */
    wh_vec3_t on_a, between; /* in base */
} pair_point_t;

/* Up to four points, with the weights whose sum gives the point nearest to the origin. */
typedef struct {
    pair_point_t points[4];
    wh_real_t weights[4];
    size_t count;
} simplex_t;

/* The kernel's point, in the shape's frame. */
static wh_vec3_t kernel_point(const wh_convex_t *shape, const wh_pose_t *pose, const wh_vec3_t *direction) {
    const wh_vec3_t d = wh_mat3_transform_back(&pose->R, direction);
    return wh_convex_kernel_support(shape, &d);
}

static void place(const wh_gap_pair_t *pair, pair_point_t *point) {
    point->on_a = wh_pose_point(pair->base_from_a, &point->in_a);
    wh_vec3_t on_b = wh_pose_point(pair->base_from_b, &point->in_b);
    on_b = wh_vec3_add(&on_b, &pair->shift);
    point->between = wh_vec3_subtract(&on_b, &point->on_a);
}

/* The point of a farthest along the axis, and the one of b farthest against it. */
static pair_point_t support(const wh_gap_pair_t *pair, const wh_vec3_t *axis) {
    const wh_vec3_t back = wh_vec3_scale(-1, axis);
    pair_point_t point;
    point.in_a = kernel_point(pair->a, pair->base_from_a, axis);
    point.in_b = kernel_point(pair->b, pair->base_from_b, &back);
    place(pair, &point);
    return point;
}

/* ---------------------------------------------------------------- the origin in the plane of a few points */

static bool weigh_line(const wh_vec3_t *a, const wh_vec3_t *b, wh_real_t weights[4]) {
    const wh_vec3_t along = wh_vec3_subtract(b, a);
    const wh_real_t length = wh_vec3_dot(&along, &along);
    weights[0] = wh_vec3_dot(b, &along);
    weights[1] = -wh_vec3_dot(a, &along);
    return length > 0 && weights[0] > 0 && weights[1] > 0;
}

static wh_real_t volume(const wh_vec3_t *a, const wh_vec3_t *b, const wh_vec3_t *c) {
    const wh_vec3_t cross = wh_vec3_cross(b, c);
    return wh_vec3_dot(a, &cross);
}

static bool weigh_triangle(const wh_vec3_t *a, const wh_vec3_t *b, const wh_vec3_t *c, wh_real_t weights[4]) {
    const wh_vec3_t ab = wh_vec3_subtract(b, a);
    const wh_vec3_t ac = wh_vec3_subtract(c, a);
    const wh_vec3_t bc = wh_vec3_subtract(c, b);
    const wh_vec3_t normal = wh_vec3_cross(&ab, &ac);
    weights[0] = volume(&normal, b, &bc);
    weights[1] = -volume(&normal, a, &ac);
    weights[2] = volume(&normal, a, &ab);
    return weights[0] > 0 && weights[1] > 0 && weights[2] > 0;
}

static bool weigh_tetrahedron(const wh_vec3_t *const p[4], wh_real_t weights[4]) {
    weights[0] = volume(p[1], p[2], p[3]);
    weights[1] = -volume(p[0], p[2], p[3]);
    weights[2] = volume(p[0], p[1], p[3]);
    weights[3] = -volume(p[0], p[1], p[2]);
    if (weights[0] < 0) {
        for (size_t i = 0; i < 4; ++i) {
            weights[i] = -weights[i];
        }
    }
    return weights[0] > 0 && weights[1] > 0 && weights[2] > 0 && weights[3] > 0;
}

/* Some points of a simplex, and the point nearest to the origin in the line, plane or space through them. */
typedef struct {
    size_t count;
    size_t index[4];
    wh_real_t weights[4]; /* their sum is 1 */
    wh_vec3_t nearest;
    wh_real_t squared; /* the square of its distance */
} part_t;

/* False unless the nearest point lies between the points. */
static bool weigh(const simplex_t *simplex, part_t *part) {
    const wh_vec3_t *const any = &simplex->points[0].between;
    const wh_vec3_t *p[4] = {any, any, any, any};
    for (size_t i = 0; i < part->count; ++i) {
        p[i] = &simplex->points[part->index[i]].between;
    }
    bool within = true;
    part->weights[0] = 1;
    if (part->count == 2) {
        within = weigh_line(p[0], p[1], part->weights);
    } else if (part->count == 3) {
        within = weigh_triangle(p[0], p[1], p[2], part->weights);
    } else if (part->count == 4) {
        within = weigh_tetrahedron(p, part->weights);
    }
    if (!within) {
        return false;
    }
    wh_real_t sum = 0;
    for (size_t i = 0; i < part->count; ++i) {
        sum += part->weights[i];
    }
    part->nearest = wh_vec3(0, 0, 0);
    for (size_t i = 0; i < part->count; ++i) {
        part->weights[i] /= sum;
        const wh_vec3_t term = wh_vec3_scale(part->weights[i], p[i]);
        part->nearest = wh_vec3_add(&part->nearest, &term);
    }
    part->squared = part->count == 4 ? 0 : wh_vec3_dot(&part->nearest, &part->nearest);
    return true;
}

/* Chooses the points whose bits are set in `chosen`, and the last one. */
static void choose(part_t *part, unsigned chosen, size_t last) {
    part->count = 0;
    for (size_t i = 0; i < last; ++i) {
        if ((chosen >> i & 1U) != 0) {
            part->index[part->count++] = i;
        }
    }
    part->index[part->count++] = last;
}

/* Looks for the nearest point in each part that has the last point; the others were checked earlier. It
 * skips parts of a part whose own nearest point lies within it. The simplex becomes the best part. Returns
 * its squared distance. */
static wh_real_t reduce(simplex_t *simplex, wh_vec3_t *nearest) {
    if (simplex->count == 1) {
        simplex->weights[0] = 1;
        *nearest = simplex->points[0].between;
        return wh_vec3_dot(nearest, nearest);
    }
    const size_t last = simplex->count - 1;
    part_t best = {.count = 0};
    unsigned within = 0;
    for (unsigned chosen = 1U << last; chosen-- > 0;) {
        part_t part;
        choose(&part, chosen, last);
        if ((best.count == 0 || (chosen & ~within) != 0) && weigh(simplex, &part)) {
            within = best.count == 0 || part.squared < best.squared ? chosen : within;
            best = within == chosen ? part : best;
        }
    }
    for (size_t i = 0; i < best.count; ++i) {
        simplex->points[i] = simplex->points[best.index[i]]; /* index[i] >= i */
        simplex->weights[i] = best.weights[i];
    }
    simplex->count = best.count;
    *nearest = best.nearest;
    return best.squared;
}

/* ------------------------------------------------------------------------------------------- step by step */

static bool has(const simplex_t *simplex, const pair_point_t *point) {
    for (size_t i = 0; i < simplex->count; ++i) {
        const wh_vec3_t *there = &simplex->points[i].between;
        if (there->x == point->between.x && there->y == point->between.y && there->z == point->between.z) {
            return true;
        }
    }
    return false;
}

/* The direction of the nearest point, taken across the line or plane that the points span. The nearest point
 * itself has rounding errors along long thin triangles, which would turn the direction. */
static wh_vec3_t across(const simplex_t *simplex, const wh_vec3_t *nearest) {
    if (simplex->count != 2 && simplex->count != 3) {
        return *nearest;
    }
    const wh_vec3_t *first = &simplex->points[0].between;
    const wh_vec3_t along = wh_vec3_subtract(&simplex->points[1].between, first);
    wh_vec3_t normal;
    if (simplex->count == 3) {
        const wh_vec3_t beside = wh_vec3_subtract(&simplex->points[2].between, first);
        normal = wh_vec3_cross(&along, &beside);
    } else {
        const wh_vec3_t side = wh_vec3_cross(&along, nearest);
        normal = wh_vec3_cross(&side, &along);
    }
    const wh_real_t squared = wh_vec3_dot(&normal, &normal);
    const wh_real_t part = wh_vec3_dot(&normal, nearest);
    const wh_real_t whole = wh_vec3_dot(nearest, nearest);
    if (!(part * part > squared * whole / 2)) {
        return *nearest;
    }
    return wh_vec3_scale(part / squared, &normal);
}

/* The middle between the two surfaces, or of their overlap. Given are a unit axis between the points of the
 * kernels, and their distance. */
static wh_vec3_t middle(const wh_gap_pair_t *pair, const simplex_t *simplex, const wh_vec3_t *axis,
                        wh_real_t distance) {
    wh_vec3_t on_a = {0, 0, 0};
    for (size_t i = 0; i < simplex->count; ++i) {
        const wh_vec3_t term = wh_vec3_scale(simplex->weights[i], &simplex->points[i].on_a);
        on_a = wh_vec3_add(&on_a, &term);
    }
    const wh_real_t of_a = wh_convex_round(pair->a);
    const wh_real_t of_b = wh_convex_round(pair->b);
    const wh_real_t first = distance - of_b > -of_a ? distance - of_b : -of_a;
    const wh_real_t last = distance + of_b < of_a ? distance + of_b : of_a;
    const wh_vec3_t out = wh_vec3_scale((first + last) / 2, axis);
    return wh_vec3_add(&on_a, &out);
}

/* Adds a point. Returns the distance of the nearest point of the rest. */
static wh_real_t add(simplex_t *simplex, const pair_point_t *point, wh_vec3_t *nearest) {
    simplex->points[simplex->count++] = *point;
    return wh_real_sqrt(reduce(simplex, nearest));
}

/* Takes the simplex's nearest point into upper bound and axis. Returns false if it is not nearer than the
 * known one. */
static bool narrow(const wh_gap_pair_t *pair, const simplex_t *simplex, const wh_vec3_t *nearest,
                   wh_real_t distance, wh_vec3_t *axis, wh_gap_bounds_t *bounds) {
    const wh_real_t upper = distance - wh_convex_round(pair->a) - wh_convex_round(pair->b);
    if (distance > 0) {
        *axis = across(simplex, nearest);
        *axis = wh_vec3_scale(1 / wh_vec3_norm(axis), axis);
    }
    if (!(upper < bounds->upper)) {
        return false;
    }
    bounds->upper = upper;
    bounds->at = middle(pair, simplex, axis, distance);
    return true;
}

/* The distance of the nearest point of all points, if it lies within them, as it usually still does.
 * Otherwise the points are added one after the other. */
static wh_real_t add_all(simplex_t *simplex, const pair_point_t points[], size_t count, wh_vec3_t *nearest) {
    part_t part = {.count = count, .index = {0, 1, 2}};
    for (size_t i = 0; i < count; ++i) {
        simplex->points[i] = points[i];
    }
    if (weigh(simplex, &part)) {
        simplex->count = count;
        for (size_t i = 0; i < count; ++i) {
            simplex->weights[i] = part.weights[i];
        }
        *nearest = part.nearest;
        return wh_real_sqrt(part.squared);
    }
    wh_real_t distance = 0;
    simplex->count = 0;
    for (size_t i = 0; i < count; ++i) {
        distance = add(simplex, &points[i], nearest);
    }
    return distance;
}

/* Begins with the final points of the last search. If the shapes meet now, those points say nothing. */
static void begin(const wh_gap_pair_t *pair, simplex_t *simplex, wh_vec3_t *axis, wh_gap_bounds_t *bounds) {
    const wh_gap_start_t *start = pair->start;
    pair_point_t points[3];
    wh_vec3_t nearest;
    if (!start || start->count == 0) {
        return;
    }
    for (size_t i = 0; i < start->count; ++i) {
        points[i].in_a = start->on_a[i];
        points[i].in_b = start->on_b[i];
        place(pair, &points[i]);
    }
    const wh_real_t distance = add_all(simplex, points, start->count, &nearest);
    if (!(distance > 0) || !narrow(pair, simplex, &nearest, distance, axis, bounds)) {
        simplex->count = 0;
    }
}

static void leave(const simplex_t *simplex, wh_gap_start_t *start) {
    if (!start || simplex->count == 0) {
        return;
    }
    start->count = simplex->count < 4 ? simplex->count : 0;
    for (size_t i = 0; i < start->count; ++i) {
        start->on_a[i] = simplex->points[i].in_a;
        start->on_b[i] = simplex->points[i].in_b;
    }
}

void wh_nearest_bounds(const wh_gap_pair_t *pair, wh_real_t enough, int steps, wh_gap_bounds_t *bounds) {
    const wh_real_t round = wh_convex_round(pair->a) + wh_convex_round(pair->b);
    simplex_t simplex = {.count = 0};
    wh_vec3_t axis = bounds->axis;
    begin(pair, &simplex, &axis, bounds);
    for (int step = 0; step < steps; ++step) {
        const pair_point_t point = support(pair, &axis);
        const wh_real_t lower = wh_vec3_dot(&point.between, &axis) - round;
        if (!(lower <= bounds->lower)) {
            bounds->lower = lower;
            bounds->axis = axis;
        }
        if (bounds->lower > enough || bounds->upper - bounds->lower <= WH_GAP_TIGHT ||
            has(&simplex, &point)) {
            break;
        }
        wh_vec3_t nearest;
        const wh_real_t distance = add(&simplex, &point, &nearest);
        if (!narrow(pair, &simplex, &nearest, distance, &axis, bounds) || simplex.count == 4 ||
            !(distance > 0)) {
            break;
        }
    }
    leave(&simplex, pair->start);
}
