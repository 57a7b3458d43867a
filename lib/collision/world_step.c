/* The judgement of a world: in a slice, after everything has moved; and at rest, before a run. */
#include "world_internal.h"

/* The most things near a part that are checked before a run. */
#define MOST_NEAR 256

/* --------------------------------------------------------------------------------------------- in a slice */

/* A pair that was so far apart needs no check: no result could come of it. */
static bool is_far(wh_pair_t *near, wh_real_t motion) {
    near->slack -= motion;
    return near->slack > WH_CLEARANCE_RANGE;
}

static void judge_rest(const wh_look_t *look, wh_mover_t *mover) {
    wh_world_t *world = look->world;
    if (mover->part == WH_NONE || !(mover->motion > 0)) {
        return;
    }
    wh_world_list_near(world, mover);
    const wh_side_t a = wh_world_side_of_mover(world, mover);
    if (mover->crowded) {
        wh_world_report_crowd(look, &a);
    }
    world->counters.pairs += mover->near_count;
    for (size_t i = 0; i < mover->near_count; ++i) {
        wh_pair_t *near = &mover->near[i];
        if (!is_far(near, mover->motion)) {
            const wh_side_t b = wh_world_side_of_item(world, near->other);
            wh_world_judge(look, &a, &b, near);
        }
    }
}

static void judge_movers(const wh_look_t *look, wh_mover_pair_t *pair) {
    wh_world_t *world = look->world;
    const wh_mover_t *a = &world->movers[pair->a];
    const wh_mover_t *b = &world->movers[pair->b];
    if (a->part == WH_NONE || b->part == WH_NONE || !(a->motion + b->motion > 0) ||
        is_far(&pair->near, a->motion + b->motion)) {
        return;
    }
    const wh_side_t one = wh_world_side_of_mover(world, a);
    const wh_side_t two = wh_world_side_of_mover(world, b);
    ++world->counters.pairs;
    wh_world_judge(look, &one, &two, &pair->near);
}

void wh_world_step(wh_world_t *world, const wh_world_input_t *input, wh_event_list_t *list) {
    const wh_look_t look = {world, input, list};
    wh_world_move(&look);
    for (size_t i = 0; i < world->mover_count; ++i) {
        judge_rest(&look, &world->movers[i]);
    }
    for (size_t i = 0; i < world->pair_count; ++i) {
        judge_movers(&look, &world->pairs[i]);
    }
    wh_world_settle(&look);
    wh_world_draw_curves(&look);
}

/* ------------------------------------------------------------------------------------------- before a run */

static bool cut(const wh_side_t *a, const wh_side_t *b) {
    wh_gap_t gap;
    wh_gap_measure(a->convex, &a->now, b->convex, &b->now, 0, wh_vec3(0, 0, 0), &gap);
    return gap.state == WH_GAP_HIT || gap.state == WH_GAP_UNDECIDED;
}

/* Finds the first thing at rest that this part overlaps. Fixed parts may overlap each other: one thing may be
 * made of several. */
static bool cuts_rest(const wh_look_t *look, const wh_side_t *a, int32_t self, int32_t *part) {
    int32_t found[MOST_NEAR];
    const wh_box_t box = wh_world_box(a);
    const size_t count = wh_tree_find(&look->world->tree, &box, found, MOST_NEAR);
    for (size_t i = 0; i < count && i < MOST_NEAR; ++i) {
        const wh_side_t b = wh_world_side_of_item(look->world, found[i]);
        if (found[i] != self && !wh_world_may_touch(look, a, &b) && cut(a, &b)) {
            *part = b.part;
            return true;
        }
    }
    return false;
}

static bool mover_cuts(const wh_look_t *look, const wh_mover_t *mover, int32_t parts[2]) {
    if (mover->part == WH_NONE) {
        return false;
    }
    const wh_side_t a = wh_world_side_of_mover(look->world, mover);
    parts[0] = a.part;
    return cuts_rest(look, &a, WH_NONE, &parts[1]);
}

static bool pair_cuts(const wh_look_t *look, const wh_mover_pair_t *pair, int32_t parts[2]) {
    const wh_mover_t *a = &look->world->movers[pair->a];
    const wh_mover_t *b = &look->world->movers[pair->b];
    if (a->part == WH_NONE || b->part == WH_NONE) {
        return false;
    }
    const wh_side_t one = wh_world_side_of_mover(look->world, a);
    const wh_side_t two = wh_world_side_of_mover(look->world, b);
    parts[0] = one.part;
    parts[1] = two.part;
    return !wh_world_may_touch(look, &one, &two) && cut(&one, &two);
}

bool wh_world_check_rest(wh_world_t *world, const wh_world_input_t *input, int32_t parts[2]) {
    const wh_look_t look = {world, input, NULL};
    bool found = false;
    for (size_t w = 0; !found && w < world->config->wafer_count; ++w) {
        const int32_t item = wh_world_item_of_wafer(world, (int32_t)w);
        const wh_side_t a = wh_world_side_of_item(world, item);
        parts[0] = a.part;
        found = cuts_rest(&look, &a, item, &parts[1]);
    }
    for (size_t i = 0; !found && i < world->mover_count; ++i) {
        found = mover_cuts(&look, &world->movers[i], parts);
    }
    for (size_t i = 0; !found && i < world->pair_count; ++i) {
        found = pair_cuts(&look, &world->pairs[i], parts);
    }
    return found;
}
