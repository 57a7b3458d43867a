/* The judgement of one pair for one slice. Three ways prove that the pair stayed apart: a plane, the gaps
 * against the distances moved, or dividing the slice. */
#include "world_internal.h"

/* The most steps of a divided slice before the check gives up. */
#define MOST_STEPS 256

/* The most halvings of a step: a shorter one is below any distance that matters. */
#define MOST_HALVINGS 40

/* ---------------------------------------------------------------------------------------------- far apart */

/* The greatest distance along the axis that a turn in this slice can move a point of the mover. */
static wh_real_t turned_along(const wh_body_t *body, wh_real_t radius, const wh_vec3_t *axis) {
    if (!(body->turn > 0)) {
        return 0;
    }
    const wh_vec3_t before = wh_mat3_transform_back(&body->before.R, axis);
    const wh_vec3_t now = wh_mat3_transform_back(&body->now.R, axis);
    const wh_vec3_t change = wh_vec3_subtract(&now, &before);
    return wh_vec3_norm(&change) * radius;
}

static wh_real_t gone_along(const wh_body_t *body, const wh_vec3_t *axis) {
    const wh_vec3_t way = wh_vec3_subtract(&body->now.r, &body->before.r);
    return wh_vec3_dot(&way, axis);
}

/* The greatest loss of separation in this slice, along the pair's axis, which leads from a to b. */
static wh_real_t lost_along(const wh_world_t *world, const wh_pair_t *near, const wh_mover_t *a,
                            const wh_mover_t *b) {
    const wh_body_t *body = &world->bodies[a->body];
    wh_real_t lost = gone_along(body, &near->axis) + turned_along(body, a->radius, &near->axis);
    if (b) {
        body = &world->bodies[b->body];
        lost += turned_along(body, b->radius, &near->axis) - gone_along(body, &near->axis);
    }
    return lost;
}

static wh_real_t moved(const wh_pair_t *near, const wh_mover_t *mover) {
    return near->way == WH_GONE_UPRIGHT ? mover->rise : mover->motion;
}

bool wh_world_is_far(const wh_world_t *world, wh_pair_t *near, const wh_mover_t *a, const wh_mover_t *b) {
    const wh_real_t slack = near->slack - (wh_world_gone(near, a, b) - near->since);
    if (slack > world->gaps.worth[near->worth]) {
        return true;
    }
    if (!(slack > WH_WORLD_UNKNOWN)) {
        return false;
    }
    const wh_real_t bulge = a->bulge + (b ? b->bulge : 0);
    const wh_real_t before = slack + moved(near, a) + (b ? moved(near, b) : 0) - WH_WORLD_BLUR;
    near->slack = before - lost_along(world, near, a, b);
    near->exact = -1;
    wh_world_remember(near, a, b);
    return before - bulge > 0 && near->slack - bulge > 0 && near->slack > world->gaps.worth[near->worth];
}

/* ----------------------------------------------------------------------------------------- between slices */

/* base_from_shape at time t of the slice, 0 to 1. */
static wh_pose_t shape_at(const wh_side_t *side, wh_real_t t) {
    if (!side->body) {
        return *side->now;
    }
    const wh_body_t *body = side->body;
    wh_pose_t pose = body->now;
    for (size_t i = 0; i < 9; ++i) {
        const wh_real_t from = body->before.R.m[i / 3][i % 3];
        pose.R.m[i / 3][i % 3] = from + t * (body->now.R.m[i / 3][i % 3] - from);
    }
    wh_mat3_orthonormalise(&pose.R);
    wh_mat3_orthonormalise(&pose.R);
    const wh_vec3_t way = wh_vec3_subtract(&body->now.r, &body->before.r);
    const wh_vec3_t gone = wh_vec3_scale(t, &way);
    pose.r = wh_vec3_add(&body->before.r, &gone);
    return wh_pose_compose(&pose, &side->convex->body_from_shape);
}

/* The time after t for which the pair stays apart, given its gap and axis at t. It is as long as the axis
 * still separates them (found by halving), and at least as long as their points need to close the gap. */
static wh_real_t safe_step(const wh_side_t *a, const wh_side_t *b, wh_real_t t, wh_real_t motion,
                           const wh_gap_t *gap) {
    const wh_real_t least = (gap->gap > WH_GAP_TOUCH ? gap->gap : WH_GAP_TOUCH) / motion;
    const wh_real_t bulge = a->bulge + b->bulge;
    wh_real_t step = 1 - t;
    for (int halvings = 0; halvings < MOST_HALVINGS && step > least; ++halvings) {
        const wh_pose_t at_a = shape_at(a, t + step);
        const wh_pose_t at_b = shape_at(b, t + step);
        const wh_real_t end = wh_gap_along(a->convex, &at_a, b->convex, &at_b, gap->axis);
        const wh_real_t apart = end < gap->gap ? end : gap->gap;
        if (apart - bulge * step * step > -WH_GAP_TOUCH) {
            return step;
        }
        step /= 2;
    }
    return least;
}

/* Goes through the slice in steps that cannot reach contact, as long as there is a gap. */
static wh_gap_state_t divide(wh_world_t *world, const wh_side_t *a, const wh_side_t *b, wh_real_t motion,
                             wh_gap_t *gap) {
    wh_real_t t = 0;
    ++world->counters.divided;
    for (int step = 0; step < MOST_STEPS; ++step) {
        const wh_pose_t at_a = shape_at(a, t);
        const wh_pose_t at_b = shape_at(b, t);
        wh_gap_measure(a->convex, &at_a, b->convex, &at_b, motion, gap->axis, gap);
        if (gap->state == WH_GAP_HIT || gap->state == WH_GAP_UNDECIDED || t >= 1) {
            return gap->state;
        }
        t += safe_step(a, b, t, motion, gap);
        t = t < 1 ? t : 1;
    }
    return WH_GAP_UNDECIDED;
}

/* The pair's state within the slice, given its gap at the end. */
static wh_gap_state_t judge_between(wh_world_t *world, const wh_side_t *a, const wh_side_t *b,
                                    const wh_gap_t *end, wh_gap_t *worst) {
    const wh_real_t motion = a->motion + b->motion;
    const wh_real_t bulge = a->bulge + b->bulge;
    *worst = *end;
    if (!(motion > WH_GAP_TOUCH)) {
        return end->state;
    }
    if (end->state == WH_GAP_CLEAR || end->state == WH_GAP_TOUCHING) {
        const wh_real_t start = wh_gap_along(a->convex, a->before, b->convex, b->before, end->axis);
        const wh_real_t stop = wh_gap_along(a->convex, a->now, b->convex, b->now, end->axis);
        if (start - bulge > -WH_GAP_TOUCH && stop - bulge > -WH_GAP_TOUCH) {
            return end->state;
        }
    }
    wh_gap_t begin;
    wh_gap_measure(a->convex, a->before, b->convex, b->before, motion, end->axis, &begin);
    if (begin.state == WH_GAP_CLEAR && begin.gap + end->gap > motion) {
        return end->state;
    }
    worst->axis = begin.axis;
    return divide(world, a, b, motion, worst);
}

/* ---------------------------------------------------------------------------------------- what came of it */

static wh_event_t *append(const wh_look_t *look, wh_event_kind_t kind, const wh_side_t *a, const wh_side_t *b,
                          const wh_gap_t *gap) {
    static const wh_event_t blank = {.wafer = WH_NONE, .gripper = WH_NONE, .other = WH_NONE};
    if (!look->list || look->list->count >= look->list->capacity) {
        return NULL;
    }
    wh_event_t *event = &look->list->events[look->list->count++];
    *event = blank;
    event->kind = kind;
    event->slice = event->measured_slice = look->input->slice;
    event->at = gap->at;
    event->parts[0] = a->part;
    event->parts[1] = b->part;
    for (int i = 0; i < 2; ++i) {
        const wh_side_t *side = i == 0 ? a : b;
        if (side->kind == WH_PART_WAFER && event->wafer == WH_NONE) {
            event->wafer = side->owner;
        } else if (side->kind == WH_PART_BLADE || side->kind == WH_PART_CHUCK) {
            event->gripper = side->owner;
        }
    }
    return event;
}

/* Returns the event; null if it was reported earlier, or there is no room. */
static wh_event_t *report_contact(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b,
                                  const wh_gap_t *gap, wh_gap_state_t state) {
    const bool is_hit = state == WH_GAP_HIT;
    bool *reported = is_hit ? &look->world->reported.hit : &look->world->reported.undecided;
    wh_event_t *event =
        *reported ? NULL : append(look, is_hit ? WH_EVENT_HIT : WH_EVENT_UNDECIDED, a, b, gap);
    *reported = true;
    return event;
}

void wh_world_report_crowd(const wh_look_t *look, const wh_side_t *a, size_t crowd) {
    if (!look->world->reported.hit) {
        const wh_gap_t nowhere = {.at = a->now->r};
        const wh_side_t nothing = {.part = WH_NONE, .kind = WH_PART_FIXED};
        wh_event_t *event = report_contact(look, a, &nothing, &nowhere, WH_GAP_UNDECIDED);
        if (event) {
            event->value = (wh_real_t)crowd;
            event->limit = WH_NEAR_CAPACITY;
        }
    }
}

void wh_world_keep_clearance(const wh_look_t *look, wh_clearance_kind_t kind, const wh_side_t *a,
                             const wh_side_t *b, const wh_gap_t *gap) {
    wh_world_t *world = look->world;
    wh_clearance_t *least = &world->clearances[kind];
    const wh_real_t limit = world->config->limits[kind];
    const wh_real_t found = gap->state == WH_GAP_CLEAR ? gap->gap : 0;
    if (!(found < least->gap - WH_SAME_GAP)) {
        return;
    }
    least->gap = found;
    least->slice = look->input->slice;
    least->parts[0] = a->part;
    least->parts[1] = b->part;
    least->at = gap->at;
    if (!wh_clearance_is_kept(found, limit) && !world->reported.too_close[kind]) {
        wh_event_t *event = append(look, WH_EVENT_TOO_CLOSE, a, b, gap);
        world->reported.too_close[kind] = true;
        if (event) {
            event->value = found;
            event->limit = limit;
        }
    }
}

/* Keeps the clearance of a judged pair, which the curves' bin has seen, too. */
static void keep_clearance(const wh_look_t *look, wh_clearance_kind_t kind, const wh_side_t *a,
                           const wh_side_t *b, const wh_gap_t *gap) {
    wh_world_t *world = look->world;
    const wh_real_t found = gap->state == WH_GAP_CLEAR ? gap->gap : 0;
    if (kind == WH_CLEARANCES) {
        return;
    }
    if (found < world->gaps.least[kind]) {
        world->gaps.least[kind] = found;
        wh_world_weigh(world);
    }
    wh_world_keep_clearance(look, kind, a, b, gap);
}

/* ---------------------------------------------------------------------------------------------- judgement */

/* True if the plane that separated the pair last still does, by at least `needed` at the slice's end. The
 * separation at the end of the last step is that at the begin of this one. */
static bool is_parted(const wh_world_t *world, const wh_side_t *a, const wh_side_t *b, wh_real_t needed,
                      wh_pair_t *near) {
    const wh_vec3_t axis = near->axis;
    if (axis.x == 0 && axis.y == 0 && axis.z == 0) {
        return false;
    }
    const wh_real_t bulge = a->bulge + b->bulge;
    const bool is_known = near->step != 0 && near->step + 1 == world->step;
    const wh_real_t begin =
        is_known ? near->parted : wh_gap_along(a->convex, a->before, b->convex, b->before, axis);
    const wh_real_t end = wh_gap_along(a->convex, a->now, b->convex, b->now, axis);
    near->parted = end;
    near->step = world->step;
    const bool apart = begin - bulge > 0 && end - bulge > 0 && end >= needed;
    if (apart) {
        near->slack = end;
        near->exact = -1;
    }
    return apart;
}

static void measure(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b, wh_clearance_kind_t kind,
                    wh_pair_t *near) {
    wh_world_t *world = look->world;
    wh_gap_t gap;
    wh_gap_t worst;
    const wh_real_t enough = 2 * (a->motion + b->motion) + WH_REAL(5.0);
    const wh_real_t wanted = kind == WH_CLEARANCES ? 0 : world->gaps.least[kind];
    wh_gap_follow(a->convex, a->now, b->convex, b->now, enough > wanted ? enough : wanted, near->axis,
                  wh_world_start(world, a->part, b->part), &gap);
    ++world->counters.measured;
    wh_world_take_gap(near, a, b, &gap, enough > wanted ? enough : wanted);
    keep_clearance(look, kind, a, b, &gap);
    if (world->reported.hit) {
        return;
    }
    const wh_gap_state_t state = judge_between(world, a, b, &gap, &worst);
    if (state == WH_GAP_HIT || state == WH_GAP_UNDECIDED) {
        (void)report_contact(look, a, b, &worst, state);
    }
    if (state == WH_GAP_HIT) { /* the hit was between two slices */
        worst.state = WH_GAP_HIT;
        keep_clearance(look, kind, a, b, &worst);
    }
}

void wh_world_judge(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b, wh_pair_t *near) {
    wh_world_t *world = look->world;
    const wh_clearance_kind_t kind = wh_world_clearance_of(look, a, b);
    const wh_real_t least = kind == WH_CLEARANCES ? 0 : world->gaps.least[kind];
    if ((world->reported.hit && kind == WH_CLEARANCES) || is_parted(world, a, b, least - WH_SAME_GAP, near)) {
        ++world->counters.planes;
    } else if (wh_world_may_touch(look, a, b)) {
        wh_world_lose(near);
    } else {
        measure(look, a, b, kind, near);
    }
}
