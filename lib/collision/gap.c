#include "gap_internal.h"

#include <ccd/ccd.h>

#if !defined(CCD_DOUBLE)
#error "waferhand: needs a libccd in double precision"
#endif

/* Ten times the need of the hardest pairs. */
static const wh_gap_budget_t usual = {500, 2000};
/* The most turns of the axis of a shallow overlap; each is a search of its own. */
static const int turns = 30;
/* Larger than any length here. */
static const wh_real_t far_away = 1e30;

/* ------------------------------------------------------------------------------------------ along an axis */

/* Returns the gap that the axis proves. `at` is the middle between the two points that are farthest along
 * it. */
static wh_real_t along(const wh_gap_pair_t *pair, const wh_vec3_t *axis, wh_vec3_t *at) {
    const wh_vec3_t back = wh_vec3_scale(-1, axis);
    const wh_vec3_t on_a = wh_convex_support(pair->a, pair->base_from_a, *axis);
    const wh_vec3_t on_b = wh_convex_support(pair->b, pair->base_from_b, back);
    const wh_vec3_t between = wh_vec3_subtract(&on_b, &on_a);
    *at = wh_vec3_scale(WH_REAL(0.5), &between);
    *at = wh_vec3_add(&on_a, at);
    return wh_vec3_dot(&between, axis);
}

wh_real_t wh_gap_along(const wh_convex_t *a, const wh_pose_t *base_from_a, const wh_convex_t *b,
                       const wh_pose_t *base_from_b, wh_vec3_t axis) {
    const wh_gap_pair_t pair = {a, b, base_from_a, base_from_b, {0, 0, 0}, NULL};
    wh_vec3_t at;
    return along(&pair, &axis, &at);
}

/* Keeps the axis if it proves more than the current one. */
static void try_axis(const wh_gap_pair_t *pair, const wh_vec3_t *axis, wh_gap_bounds_t *bounds) {
    wh_vec3_t at;
    const wh_real_t lower = along(pair, axis, &at);
    if (lower > bounds->lower) {
        bounds->lower = lower;
        bounds->axis = *axis;
        bounds->at = bounds->upper < far_away ? bounds->at : at;
    }
}

/* Returns false for the zero vector and for one that is not finite. */
static bool to_unit(wh_vec3_t *v) {
    const wh_real_t length = wh_vec3_norm(v);
    if (!(length > 0 && length < far_away)) {
        return false;
    }
    *v = wh_vec3_scale(1 / length, v);
    return true;
}

static wh_vec3_t centre_in_base(const wh_convex_t *shape, const wh_pose_t *base_from_shape) {
    const wh_vec3_t centre = wh_convex_centre(shape);
    return wh_pose_point(base_from_shape, &centre);
}

/* Tries the normals of a shape's flat faces on the side of the other shape's centre. They are columns of the
 * rotation: all three of a box, z of a cylinder. */
static void try_faces(const wh_gap_pair_t *pair, const wh_convex_t *shape, const wh_pose_t *base_from_shape,
                      const wh_vec3_t *towards_b, wh_gap_bounds_t *bounds) {
    const bool is_box = shape->kind == WH_CONVEX_BOX;
    const size_t end = is_box || shape->kind == WH_CONVEX_CYLINDER ? 3 : 0;
    for (size_t column = is_box ? 0 : 2; column < end; ++column) {
        wh_vec3_t normal = wh_mat3_column(&base_from_shape->R, column);
        if (wh_vec3_dot(&normal, towards_b) < 0) {
            normal = wh_vec3_scale(-1, &normal);
        }
        if (to_unit(&normal)) {
            try_axis(pair, &normal, bounds);
        }
    }
}

/* Tries the axes that cost little: the line between the centres, and faces. */
static void try_easy_axes(const wh_gap_pair_t *pair, wh_gap_bounds_t *bounds) {
    const wh_vec3_t from = centre_in_base(pair->a, pair->base_from_a);
    const wh_vec3_t to = centre_in_base(pair->b, pair->base_from_b);
    wh_vec3_t towards_b = wh_vec3_subtract(&to, &from);
    if (!to_unit(&towards_b)) {
        towards_b = wh_vec3(0, 0, 1);
    }
    try_axis(pair, &towards_b, bounds);
    try_faces(pair, pair->a, pair->base_from_a, &towards_b, bounds);
    try_faces(pair, pair->b, pair->base_from_b, &towards_b, bounds);
}

/* ------------------------------------------------------------------------------------------------- libccd */

/* A shape with some thickness taken off its surface, as libccd sees it. When the budget is spent, its
 * points move away from the other shape's. libccd has no bound of its own here; this ends its search. */
typedef struct {
    wh_convex_t shape;
    const wh_pose_t *base_from_shape;
    wh_vec3_t centre;
    wh_real_t shrunk; /* the scale of a mesh about its centre */
    int *left;
    wh_vec3_t *asked; /* the last direction, only for a */
} core_t;

static core_t core_of(const wh_convex_t *shape, const wh_pose_t *base_from_shape, wh_real_t taken, int *left,
                      wh_vec3_t *asked) {
    core_t core = {*shape, base_from_shape, centre_in_base(shape, base_from_shape), 1, left, asked};
    core.shape.half.x -= taken;
    core.shape.half.y -= taken;
    core.shape.half.z -= shape->kind == WH_CONVEX_CAPSULE ? 0 : taken;
    if (shape->kind == WH_CONVEX_MESH) {
        wh_convex_t about = *shape;
        about.body_from_shape = wh_pose_identity();
        about.body_from_shape.r = wh_convex_centre(shape);
        about.body_from_shape.r = wh_vec3_scale(-1, &about.body_from_shape.r);
        core.shrunk = 1 - taken / wh_convex_radius(&about);
    }
    return core;
}

static void core_support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *point) {
    const core_t *core = object;
    const wh_vec3_t d = {direction->v[0], direction->v[1], direction->v[2]};
    if (core->asked != NULL) {
        *core->asked = d;
    }
    wh_vec3_t found;
    if (--*core->left < 0) {
        const wh_vec3_t away = wh_vec3_scale(-far_away, &d);
        found = wh_vec3_add(&core->centre, &away);
    } else {
        const wh_vec3_t farthest = wh_convex_support(&core->shape, core->base_from_shape, d);
        wh_vec3_t out = wh_vec3_subtract(&farthest, &core->centre);
        out = wh_vec3_scale(core->shrunk, &out);
        found = core->shrunk < 1 ? wh_vec3_add(&core->centre, &out) : farthest;
    }
    ccdVec3Set(point, found.x, found.y, found.z);
}

static void core_centre(const void *object, ccd_vec3_t *centre) {
    const core_t *core = object;
    ccdVec3Set(centre, core->centre.x, core->centre.y, core->centre.z);
}

/* Returns HIT if the cores overlap, CLEAR if not, UNDECIDED if `supports` calls were too few. `*asked` is
 * the last direction, which separates cores that are clear. */
static wh_gap_state_t cores_overlap(const wh_gap_pair_t *pair, wh_real_t taken, int supports,
                                    wh_vec3_t *asked) {
    int left = supports;
    const core_t a = core_of(pair->a, pair->base_from_a, taken, &left, asked);
    const core_t b = core_of(pair->b, pair->base_from_b, taken, &left, NULL);
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = core_support;
    ccd.support2 = core_support;
    ccd.center1 = core_centre;
    ccd.center2 = core_centre;
    ccd.mpr_tolerance = 1e-6;
    const bool overlap = ccdMPRIntersect(&a, &b, &ccd) != 0;
    if (left < 0) {
        return WH_GAP_UNDECIDED;
    }
    return overlap ? WH_GAP_HIT : WH_GAP_CLEAR;
}

/* ------------------------------------------------------------------------------------------------ contact */

/* Turns the axis of a shallow overlap until it proves the least depth nearby. b is moved along the axis
 * until it is just clear. The axis between the nearest points is then never worse, because their distance
 * is at most that along the first axis. */
static void turn_axis(const wh_gap_pair_t *pair, int steps, wh_gap_bounds_t *bounds) {
    for (int turn = 0; turn < turns && bounds->lower < -WH_GAP_TOUCH; ++turn) {
        const wh_real_t before = bounds->lower;
        wh_gap_pair_t apart = *pair;
        apart.start = NULL;
        apart.shift = wh_vec3_scale(WH_GAP_TOUCH / 10 - before, &bounds->axis);
        wh_gap_bounds_t moved = {-far_away, far_away, bounds->axis, {0, 0, 0}};
        wh_nearest_bounds(&apart, far_away, steps, &moved);
        try_axis(pair, &moved.axis, bounds);
        if (!(bounds->lower > before)) {
            return;
        }
    }
}

/* Asks libccd whether two shapes overlap with `taken` mm off the surface of each. If an axis separates
 * them, tries that axis. */
static wh_gap_state_t ask(const wh_gap_pair_t *pair, wh_real_t taken, int supports, wh_gap_bounds_t *bounds) {
    wh_vec3_t asked = {0, 0, 0};
    const wh_gap_state_t answer = cores_overlap(pair, taken, supports, &asked);
    if (answer == WH_GAP_CLEAR && to_unit(&asked)) {
        try_axis(pair, &asked, bounds);
    }
    return answer;
}

/* The state of two shapes if no axis proves a depth of at most WH_GAP_TOUCH yet: HIT, or CLEAR if an axis
 * proves it now. */
static wh_gap_state_t overlap(const wh_gap_pair_t *pair, const wh_gap_budget_t *budget,
                              wh_gap_bounds_t *bounds) {
    const bool mesh = pair->a->kind == WH_CONVEX_MESH || pair->b->kind == WH_CONVEX_MESH;
    wh_gap_state_t answer = ask(pair, WH_GAP_TOUCH / 2, budget->supports, bounds);
    if (answer == WH_GAP_UNDECIDED || (answer == WH_GAP_HIT && !mesh)) {
        return answer;
    }
    turn_axis(pair, budget->steps, bounds);
    if (bounds->lower < -WH_GAP_TOUCH) {
        answer = ask(pair, WH_GAP_CORE, budget->supports, bounds);
    }
    if (bounds->lower < -WH_GAP_TOUCH) {
        return answer == WH_GAP_CLEAR ? WH_GAP_UNDECIDED : answer;
    }
    return WH_GAP_CLEAR;
}

/* The state of two shapes that no axis proves to be apart. */
static wh_gap_state_t contact(const wh_gap_pair_t *pair, const wh_gap_budget_t *budget,
                              wh_gap_bounds_t *bounds) {
    if (bounds->lower < -WH_GAP_TOUCH) {
        const wh_gap_state_t state = overlap(pair, budget, bounds);
        if (state != WH_GAP_CLEAR) {
            return state;
        }
    }
    return bounds->upper <= WH_GAP_TOUCH + WH_GAP_TIGHT ? WH_GAP_TOUCHING : WH_GAP_UNDECIDED;
}

/* ------------------------------------------------------------------------------------------------ measure */

static wh_gap_state_t measure(const wh_gap_pair_t *pair, wh_real_t enough, const wh_gap_budget_t *budget,
                              wh_gap_bounds_t *bounds) {
    if (!(bounds->lower > WH_GAP_TOUCH)) {
        try_easy_axes(pair, bounds);
    }
    if (bounds->lower > enough) {
        return WH_GAP_CLEAR;
    }
    wh_nearest_bounds(pair, enough, budget->steps, bounds);
    if (bounds->lower > WH_GAP_TOUCH) {
        return WH_GAP_CLEAR;
    }
    return contact(pair, budget, bounds);
}

static bool is_pose(const wh_pose_t *pose) {
    return wh_pose_validate(pose) == WH_OK && wh_vec3_norm(&pose->r) <= WH_GAP_FARTHEST;
}

void wh_gap_measure_within(const wh_gap_pair_t *pair, wh_real_t enough, wh_vec3_t guess,
                           const wh_gap_budget_t *budget, wh_gap_t *gap) {
    const wh_real_t above = enough > WH_GAP_TOUCH ? enough : WH_GAP_TOUCH;
    const wh_gap_bounds_t nothing = {-far_away, far_away, {0, 0, 0}, {0, 0, 0}};
    wh_gap_bounds_t bounds = nothing;
    gap->state = WH_GAP_UNDECIDED;
    if (to_unit(&guess)) {
        try_axis(pair, &guess, &bounds);
    }
    if (bounds.lower > above && bounds.lower < far_away) {
        gap->state = WH_GAP_CLEAR;
    } else if (is_pose(pair->base_from_a) && is_pose(pair->base_from_b)) {
        gap->state = measure(pair, above, budget, &bounds);
    } else {
        bounds = nothing;
    }
    gap->gap = gap->state == WH_GAP_CLEAR ? bounds.lower : 0;
    gap->axis = bounds.axis;
    gap->at = bounds.at;
}

void wh_gap_measure(const wh_convex_t *a, const wh_pose_t *base_from_a, const wh_convex_t *b,
                    const wh_pose_t *base_from_b, wh_real_t enough, wh_vec3_t guess, wh_gap_t *gap) {
    const wh_gap_pair_t pair = {a, b, base_from_a, base_from_b, {0, 0, 0}, NULL};
    wh_gap_measure_within(&pair, enough, guess, &usual, gap);
}

void wh_gap_follow(const wh_convex_t *a, const wh_pose_t *base_from_a, const wh_convex_t *b,
                   const wh_pose_t *base_from_b, wh_real_t enough, wh_vec3_t guess, wh_gap_start_t *start,
                   wh_gap_t *gap) {
    const wh_gap_pair_t pair = {a, b, base_from_a, base_from_b, {0, 0, 0}, start};
    wh_gap_measure_within(&pair, enough, guess, &usual, gap);
}
