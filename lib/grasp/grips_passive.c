/* Passive pads within a step, and the supports of wafers. */
#include "grasp_internal.h"
#include "grips_internal.h"
#include "passive.h"

static wh_passive_t rules_of(const wh_grips_t *grips) {
    wh_passive_t rules;
    rules.tolerance = grips->table->config.tolerance;
    rules.check = grips->table->config.check;
    rules.thickness = grips->parts.thickness;
    return rules;
}

/* The pads' pose in the last slice. */
static const wh_pose_t *begin_of(const wh_turn_t *turn) {
    return turn->grips->table->slice == 1 ? &turn->input->base_from_gripper
                                          : &turn->gripper->base_from_gripper;
}

static wh_passive_change_t ask(const wh_turn_t *turn, int32_t support, wh_passive_wafer_t *wafer) {
    const wh_passive_t rules = rules_of(turn->grips);
    const wh_pose_t *plane = support == WH_NONE ? NULL : &turn->grips->parts.supports[support];
    wh_passive_change_t change = WH_PASSIVE_STAYS;
    (void)wh_passive_step(&rules, begin_of(turn), &turn->input->base_from_gripper, plane, wafer, &change);
    return change;
}

/* ------------------------------------------------------------------------------------------- out of reach */

/* More than the rounding error of any sum here, mm, for a part whose coordinates add up to this size. */
#define ROUNDED(size) (1 + 64 * REAL_EPSILON * (size))

#if defined(WH_FLOAT)
#define REAL_EPSILON WH_REAL(FLT_EPSILON)
#else
#define REAL_EPSILON WH_REAL(DBL_EPSILON)
#endif

/* The reach of the pads, or of the wafer on them, in a slice. wh_passive_step neither takes nor leaves a
 * wafer out of reach, so a test of a few products comes before it. */
typedef struct {
    wh_vec3_t begin, end; /* of its origin */
    wh_real_t high;       /* the greatest distance of a face from its wafer's origin, along a normal */
    wh_real_t aside;      /* limit (7), plus the way of the origin */
    wh_real_t turned;     /* the approach of a point beside the origin, for each mm of its distance */
} reach_t;

static wh_real_t sum_of(const wh_vec3_t *v) {
    return wh_real_abs(v->x) + wh_real_abs(v->y) + wh_real_abs(v->z);
}

/* The norm of the difference of two rotations; no vector of length 1 moves farther. */
static wh_real_t turned_between(const wh_mat3_t *a, const wh_mat3_t *b) {
    wh_real_t sum = 0;
    for (size_t i = 0; i < 9; ++i) {
        const wh_real_t d = a->m[i / 3][i % 3] - b->m[i / 3][i % 3];
        sum += d * d;
    }
    return wh_real_sqrt(sum);
}

/* The reach of a body whose origin is `lever` away from the pads' origin. */
static reach_t reach_of(const wh_turn_t *turn, const wh_vec3_t *begin, const wh_vec3_t *end,
                        wh_real_t lever) {
    const wh_pose_t *from = begin_of(turn);
    const wh_pose_t *to = &turn->input->base_from_gripper;
    const wh_vec3_t travel = wh_vec3_subtract(&to->r, &from->r);
    const wh_real_t turned = turned_between(&from->R, &to->R);
    const wh_real_t rounded = ROUNDED(sum_of(begin) + sum_of(end) + lever);
    reach_t reach;
    reach.begin = *begin;
    reach.end = *end;
    reach.turned = turned;
    reach.high = turn->grips->parts.thickness + rounded;
    reach.aside = turn->grips->table->config.tolerance.projxy + sum_of(&travel) + turned * lever + rounded;
    return reach;
}

/* The height of a point above another one along a normal. */
static wh_real_t above(const wh_vec3_t *point, const wh_vec3_t *other, const wh_vec3_t *normal) {
    const wh_vec3_t dr = wh_vec3_subtract(point, other);
    return wh_vec3_dot(&dr, normal);
}

/* True if (7) fails during the whole slice for a wafer with these axes at the slice's begin, `dr` away from
 * a plane. */
static bool is_aside(const reach_t *reach, const wh_mat3_t *axes, const wh_vec3_t *dr) {
    const wh_vec3_t p = wh_mat3_transform_back(axes, dr);
    const wh_real_t most = reach->aside + reach->turned * sum_of(dr);
    return p.x * p.x + p.y * p.y > most * most;
}

/* True if these pads, with this motion, cannot take a wafer that lies there. */
static bool misses_wafer(const wh_turn_t *turn, const reach_t *reach, const wh_pose_t *base_from_wafer) {
    const wh_vec3_t *r = &base_from_wafer->r;
    const wh_vec3_t before = wh_mat3_column(&begin_of(turn)->R, 2);
    const wh_vec3_t after = wh_mat3_column(&turn->input->base_from_gripper.R, 2);
    const wh_vec3_t dr = wh_vec3_subtract(r, &reach->begin);
    return wh_vec3_dot(&dr, &before) < -reach->high || above(r, &reach->end, &after) > reach->high ||
           is_aside(reach, &base_from_wafer->R, &dr);
}

/* True if a carried wafer, with this motion and these axes at the slice's begin, cannot be left there. */
static bool misses_support(const reach_t *reach, const wh_mat3_t *axes, const wh_pose_t *support) {
    const wh_vec3_t up = wh_mat3_column(&support->R, 2);
    const wh_vec3_t dr = wh_vec3_subtract(&reach->begin, &support->r);
    return wh_vec3_dot(&dr, &up) < -reach->high || above(&reach->end, &support->r, &up) > reach->high ||
           is_aside(reach, axes, &dr);
}

/* ----------------------------------------------------------------------------------------------- the turn */

void wh_passive_turn_move(const wh_turn_t *turn) {
    if (turn->gripper->wafer == WH_NONE) {
        return;
    }
    wh_wafer_t *wafer = &wh_turn_wafers(turn)[turn->gripper->wafer];
    const wh_pose_t *held = &turn->gripper->gripper_from_wafer;
    wh_pose_t begin;
    wh_pose_compose_to(begin_of(turn), held, &begin);
    const wh_vec3_t end = wh_pose_point(&turn->input->base_from_gripper, &held->r);
    const reach_t reach = reach_of(turn, &begin.r, &end, sum_of(&held->r));
    for (size_t s = 0; s < turn->grips->parts.support_count; ++s) {
        if (misses_support(&reach, &begin.R, &turn->grips->parts.supports[s])) {
            continue;
        }
        wh_passive_wafer_t after = {.carried = true};
        after.base_from_wafer = wafer->base_from_wafer;
        after.gripper_from_wafer = turn->gripper->gripper_from_wafer;
        if (ask(turn, (int32_t)s, &after) == WH_PASSIVE_LEFT) {
            wafer->base_from_wafer = after.base_from_wafer;
            wh_turn_let_go(turn);
            return;
        }
    }
    wh_grasp_carry(wafer, &turn->input->base_from_gripper, &turn->gripper->gripper_from_wafer);
}

static void see(const wh_grips_t *grips, const wh_pose_t *base_from_wafer, const wh_pose_t *plane,
                wh_pose_t *base_from_face) {
    const wh_real_t thickness = grips->parts.thickness;
    wh_face_frame(base_from_wafer, thickness, wh_face_seen(base_from_wafer, thickness, plane),
                  base_from_face);
}

/* The height of this wafer's face above a plane, along the plane's e3. */
static wh_real_t height_over(const wh_grips_t *grips, const wh_pose_t *base_from_wafer,
                             const wh_pose_t *plane) {
    wh_pose_t face;
    see(grips, base_from_wafer, plane, &face);
    const wh_vec3_t dr = wh_vec3_subtract(&face.r, &plane->r);
    const wh_vec3_t n = wh_mat3_column(&plane->R, 2);
    return wh_vec3_dot(&dr, &n);
}

static bool is_over(const wh_grips_t *grips, const wh_pose_t *base_from_wafer, const wh_pose_t *plane) {
    wh_pose_t face;
    wh_proximity_t p;
    see(grips, base_from_wafer, plane, &face);
    wh_proximity_values(&face, plane, &grips->table->config.tolerance, &p);
    return (p.failed & ~(unsigned)WH_FAILED_PROJZ) == 0;
}

int32_t wh_grips_support(const wh_grips_t *grips, size_t wafer) {
    const wh_wafer_t *lying = &grips->table->storage.wafers[wafer];
    int32_t best = WH_NONE;
    wh_real_t least = grips->table->config.tolerance.projz;
    for (size_t s = 0; s < grips->parts.support_count && lying->holder == WH_NONE; ++s) {
        const wh_pose_t *plane = &grips->parts.supports[s];
        const wh_real_t height = height_over(grips, &lying->base_from_wafer, plane);
        if (height >= -WH_GRIPS_FLAT && height < least && is_over(grips, &lying->base_from_wafer, plane)) {
            best = (int32_t)s;
            least = height;
        }
    }
    return best;
}

/* The state of a free wafer after this slice, if only these pads were there. */
static bool would_take(const wh_turn_t *turn, size_t w, wh_passive_wafer_t *after) {
    const wh_wafer_t *wafer = &wh_turn_wafers(turn)[w];
    if (wafer->holder != WH_NONE || wafer->released_by != WH_NONE) {
        return false;
    }
    after->base_from_wafer = wafer->base_from_wafer;
    after->gripper_from_wafer = wh_pose_identity();
    after->carried = false;
    return ask(turn, wh_grips_support(turn->grips, w), after) == WH_PASSIVE_TAKEN;
}

void wh_passive_turn_pick(const wh_turn_t *turn) {
    wh_passive_wafer_t best = {0};
    wh_real_t least = 0;
    size_t found = turn->grips->table->storage.wafer_count;
    const reach_t reach = reach_of(turn, &begin_of(turn)->r, &turn->input->base_from_gripper.r, 0);
    for (size_t w = 0; w < turn->grips->table->storage.wafer_count; ++w) {
        wh_passive_wafer_t after;
        if (!misses_wafer(turn, &reach, &wh_turn_wafers(turn)[w].base_from_wafer) &&
            would_take(turn, w, &after)) {
            const wh_real_t height =
                height_over(turn->grips, &wh_turn_wafers(turn)[w].base_from_wafer, begin_of(turn));
            if (!best.carried || height < least) {
                best = after;
                least = height;
                found = w;
            }
        }
    }
    if (best.carried) {
        wh_turn_wafers(turn)[found].base_from_wafer = best.base_from_wafer;
        turn->gripper->gripper_from_wafer = best.gripper_from_wafer;
        wh_turn_take(turn, found);
    }
}
