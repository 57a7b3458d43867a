/* One slice of the world: everything is moved, then each pair that is near is judged. */
#include "world_internal.h"

/* A pair that was so far apart needs no look: nothing that is kept or judged could come of it. */
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

void wh_world_step(wh_world_t *world, const wh_grasp_t *table, const wh_pose_t *base_from_effector,
                   const wh_pose_t base_from_grippers[], wh_event_list_t *list) {
    const wh_look_t look = {world, table, list};
    wh_world_move(&look, base_from_effector, base_from_grippers);
    for (size_t i = 0; i < world->mover_count; ++i) {
        judge_rest(&look, &world->movers[i]);
    }
    for (size_t i = 0; i < world->pair_count; ++i) {
        judge_movers(&look, &world->pairs[i]);
    }
    wh_world_settle(&look);
    wh_world_draw_curves(&look);
}
