/* The present places of everything, and the parts that rest. */
#include <string.h>

#include "world_internal.h"

/* A gripper has left its released wafer when it has moved this far sideways, mm. */
#define LEFT_BEHIND WH_REAL(1.0)

int32_t wh_world_gripper_body(size_t gripper) {
    return (int32_t)((size_t)WH_ARM_BODIES * WH_WORLD_ARMS + gripper);
}

int32_t wh_world_held_body(size_t gripper) {
    return (int32_t)(WH_ARM_BODIES * WH_WORLD_ARMS + WH_WORLD_GRIPPERS + gripper);
}

int32_t wh_world_door_body(size_t door) {
    return (int32_t)(WH_ARM_BODIES * WH_WORLD_ARMS + 2 * WH_WORLD_GRIPPERS + door);
}

int32_t wh_world_part_of_item(const wh_world_t *world, int32_t item) {
    const size_t wafer = (size_t)item - world->fixed_count;
    return (size_t)item < world->fixed_count ? item : (int32_t)(world->config->part_count + wafer);
}

int32_t wh_world_item_of_wafer(const wh_world_t *world, int32_t wafer) {
    return (int32_t)(world->fixed_count + (size_t)wafer);
}

const wh_convex_t *wh_world_convex(const wh_world_t *world, int32_t part) {
    const wh_world_config_t *config = world->config;
    return (size_t)part < config->part_count ? &config->parts[part].convex : &config->wafer;
}

/* ------------------------------------------------------------------------------------------------- motion */

/* The square of the Frobenius norm of two rotations' difference. */
static wh_real_t spread_of(const wh_mat3_t *a, const wh_mat3_t *b) {
    wh_real_t sum = 0;
    for (size_t i = 0; i < 9; ++i) {
        const wh_real_t d = a->m[i / 3][i % 3] - b->m[i / 3][i % 3];
        sum += d * d;
    }
    return sum;
}

/* An upper bound of the angle between two rotations. The norm of the matrices' difference is 2 sqrt(2)
 * sin(angle / 2), and asin(s) <= s (1 + (pi/2 - 1) s^2) for s from 0 to 1, with equality at both ends. */
static wh_real_t angle_of(wh_real_t spread) {
    const wh_real_t s = wh_real_sqrt(spread / 8);
    return s < 1 ? 2 * s * (1 + WH_REAL(0.5708) * s * s) : WH_REAL(3.1416);
}

static wh_real_t upright_change(const wh_mat3_t *a, const wh_mat3_t *b) {
    const wh_vec3_t change =
        wh_vec3(a->m[2][0] - b->m[2][0], a->m[2][1] - b->m[2][1], a->m[2][2] - b->m[2][2]);
    return wh_vec3_norm(&change);
}

/* Takes the body's present place. */
static void move_body(wh_world_t *world, int32_t number, const wh_pose_t *now) {
    wh_body_t *body = &world->bodies[number];
    if (body->rests && memcmp(&body->now, now, sizeof *now) == 0) {
        return;
    }
    const bool stands = wh_arm_is_at(&body->now, now);
    if (stands && !body->has_gone) {
        body->rests = true;
        return;
    }
    body->before = body->now;
    if (stands) {
        body->has_gone = false;
        body->way = body->turn = body->lean = 0;
        return;
    }
    world->still.is_any_gone = true;
    world->still.begins = world->still.begins || !body->has_gone;
    body->has_gone = true;
    body->rests = false;
    body->now = *now;
    const wh_vec3_t way = wh_vec3_subtract(&body->now.r, &body->before.r);
    body->way = wh_vec3_norm(&way);
    const wh_real_t spread = spread_of(&body->now.R, &body->before.R);
    body->turn = spread > 0 ? angle_of(spread) : 0;
    body->lean = spread > 0 ? upright_change(&body->now.R, &body->before.R) : 0;
}

/* Nothing need be compared body by body for an arm that rests, and is told so. */
static void move_arm(wh_world_t *world, size_t arm, const wh_pose_t base_from_arm[]) {
    wh_world_still_t *still = &world->still;
    const size_t first = arm * WH_ARM_BODIES;
    const size_t bytes = WH_ARM_BODIES * sizeof base_from_arm[0];
    if (!still->has_parts[arm] ||
        (still->rests[arm] && memcmp(&still->told[first], &base_from_arm[first], bytes) == 0)) {
        return;
    }
    memcpy(&still->told[first], &base_from_arm[first], bytes);
    still->rests[arm] = true;
    for (size_t i = first; i < first + WH_ARM_BODIES; ++i) {
        if (world->bodies[i].has_parts) {
            move_body(world, (int32_t)i, &base_from_arm[i]);
            still->rests[arm] = still->rests[arm] && world->bodies[i].rests;
        }
    }
}

/* Returns the largest way of a point of it, mm. */
static wh_real_t move_mover(wh_world_t *world, wh_mover_t *mover) {
    const wh_body_t *body = &world->bodies[mover->body];
    if (mover->part == WH_NONE) {
        return 0;
    }
    mover->was_placed = mover->is_placed;
    mover->is_placed = false;
    if (!body->has_gone) {
        mover->motion = mover->bulge = mover->rise = 0;
        return 0;
    }
    mover->motion = body->way + body->turn * mover->radius;
    mover->bulge = body->turn * body->turn * mover->radius / 8;
    mover->rise = wh_real_abs(body->now.r.z - body->before.r.z) + body->lean * mover->radius;
    mover->gone[WH_GONE_ANYWHERE] = wh_world_add(mover->gone[WH_GONE_ANYWHERE], mover->motion);
    mover->gone[WH_GONE_UPRIGHT] = wh_world_add(mover->gone[WH_GONE_UPRIGHT], mover->rise);
    mover->reach -= mover->motion;
    mover->clear -= mover->motion;
    return mover->motion;
}

/* --------------------------------------------------------------------------------------- taken and let go */

static wh_mover_t *mover_of_gripper(wh_world_t *world, size_t gripper) {
    return &world->movers[wh_world_hanging(world) + gripper];
}

/* Forgets the known values of this mover's pairs with other movers. */
static void forget_pairs(wh_world_t *world, const wh_mover_t *mover) {
    const int32_t index = (int32_t)(mover - world->movers);
    for (size_t i = 0; i < world->pair_count; ++i) {
        if (world->pairs[i].a == index || world->pairs[i].b == index) {
            wh_world_forget(world, &world->pairs[i]);
        }
    }
}

static void relist_all(wh_world_t *world) {
    for (size_t i = 0; i < world->mover_count; ++i) {
        world->movers[i].reach = -1;
        world->movers[i].clear = 0;
    }
}

static void begin_to_carry(wh_world_t *world, size_t gripper, int32_t wafer) {
    wh_mover_t *mover = mover_of_gripper(world, gripper);
    const wh_box_t nothing = wh_box_empty();
    world->held[gripper] = wafer;
    mover->part = (int32_t)(world->config->part_count + (size_t)wafer);
    wh_body_t *body = &world->bodies[mover->body];
    *body = (wh_body_t){.before = world->wafers[wafer], .now = world->wafers[wafer]};
    wh_tree_set(&world->tree, wh_world_item_of_wafer(world, wafer), &nothing);
    mover->near_count = 0;
    mover->is_placed = mover->was_placed = false;
    mover->motion = mover->bulge = mover->rise = 0;
    forget_pairs(world, mover);
    relist_all(world);
}

/* The gripper releases its wafer, and stays beside it for now. */
static void end_carrying(wh_world_t *world, size_t gripper) {
    world->left[gripper].wafer = world->held[gripper];
    world->left[gripper].at = world->bodies[wh_world_gripper_body(gripper)].now.r;
    world->held[gripper] = WH_NONE;
    mover_of_gripper(world, gripper)->part = WH_NONE;
    forget_pairs(world, mover_of_gripper(world, gripper));
}

/* Removes the known values of an item that has moved from the lists. */
static void forget_item(wh_world_t *world, int32_t item) {
    for (size_t m = 0; m < world->mover_count; ++m) {
        wh_mover_t *mover = &world->movers[m];
        for (size_t i = 0; i < mover->near_count; ++i) {
            if (mover->near[i].other == item) {
                wh_world_lose(&mover->near[i]);
                mover->near[i].axis = wh_vec3(0, 0, 0);
            }
        }
    }
}

/* Puts a wafer into the tree at its present place. */
static void lay_down(wh_world_t *world, int32_t wafer) {
    const int32_t item = wh_world_item_of_wafer(world, wafer);
    wh_world_place_shape(world, (size_t)wafer);
    const wh_side_t side = wh_world_side_of_item(world, item);
    const wh_box_t box = wh_world_box(&side);
    wh_tree_set(&world->tree, item, &box);
    forget_item(world, item);
    relist_all(world);
    ++world->set_down;
}

static bool is_carried(const wh_world_t *world, int32_t wafer) {
    for (size_t g = 0; g < world->config->gripper_count; ++g) {
        if (world->held[g] == wafer) {
            return true;
        }
    }
    return false;
}

static void rebuild(wh_world_t *world) {
    for (size_t i = 0; i < world->tree.count; ++i) {
        world->boxes[i] = wh_tree_box(&world->tree, (int32_t)i);
    }
    wh_tree_build(&world->tree, world->boxes);
    world->set_down = 0;
}

void wh_world_settle(const wh_look_t *look) {
    wh_world_t *world = look->world;
    for (size_t g = 0; g < world->config->gripper_count; ++g) {
        const int32_t wafer = world->held[g];
        if (wafer != WH_NONE && look->input->grippers[g].wafer != wafer) {
            end_carrying(world, g);
            if (!is_carried(world, wafer)) {
                lay_down(world, wafer);
            }
        }
    }
    if (world->set_down >= WH_REST_REBUILD) {
        rebuild(world);
    }
}

void wh_world_place(wh_world_t *world, int32_t wafer, const wh_pose_t *base_from_wafer) {
    if (!is_carried(world, wafer)) {
        world->wafers[wafer] = *base_from_wafer;
        lay_down(world, wafer);
    }
}

/* ---------------------------------------------------------------------------------------------- the slice */

static void take_wafers(const wh_look_t *look) {
    wh_world_t *world = look->world;
    for (size_t g = 0; g < world->config->gripper_count; ++g) {
        const int32_t wafer = look->input->grippers[g].wafer;
        if (wafer == WH_NONE || wafer == world->held[g]) {
            continue;
        }
        for (size_t other = 0; other < world->config->gripper_count; ++other) {
            if (world->held[other] == wafer) {
                end_carrying(world, other);
            }
        }
        begin_to_carry(world, g, wafer);
        world->still.is_any_gone = world->still.begins = true;
    }
}

static void move_held(const wh_look_t *look) {
    wh_world_t *world = look->world;
    for (size_t g = 0; g < world->config->gripper_count; ++g) {
        const int32_t wafer = world->held[g];
        if (wafer != WH_NONE) {
            world->wafers[wafer] = look->input->wafers[wafer].base_from_wafer;
            move_body(world, wh_world_held_body(g), &world->wafers[wafer]);
        }
    }
}

/* Ends a gripper's permission to touch its released wafer, once it has moved sideways from there. */
static void leave_behind(wh_world_t *world, size_t gripper) {
    const wh_vec3_t *r = &world->bodies[wh_world_gripper_body(gripper)].now.r;
    wh_left_t *left = &world->left[gripper];
    const wh_real_t dx = r->x - left->at.x;
    const wh_real_t dy = r->y - left->at.y;
    if (dx * dx + dy * dy > LEFT_BEHIND * LEFT_BEHIND) {
        left->wafer = WH_NONE;
    }
}

/* Takes the present places of all bodies. */
static void move_bodies(const wh_look_t *look) {
    wh_world_t *world = look->world;
    world->still.is_any_gone = world->still.begins = false;
    for (size_t arm = 0; arm < wh_world_arms(world->config); ++arm) {
        move_arm(world, arm, look->input->base_from_arm);
    }
    for (size_t g = 0; g < world->config->gripper_count; ++g) {
        move_body(world, wh_world_gripper_body(g), &look->input->grippers[g].base_from_gripper);
        leave_behind(world, g);
    }
    for (size_t d = 0; d < world->config->door_count; ++d) {
        move_body(world, wh_world_door_body(d), &look->input->base_from_door[d]);
    }
    take_wafers(look);
    move_held(look);
}

/* Pairs of two movers that stood are not due until one of them goes. */
static void wake_pairs(wh_world_t *world) {
    for (size_t i = 0; i < world->pair_count; ++i) {
        world->due.of[i] = 0;
    }
    for (size_t block = 0; block < wh_world_blocks(world->pair_count); ++block) {
        world->due.soonest[block] = 0;
    }
}

/* A mover whose body rests knows that it has no motion. */
void wh_world_move(const wh_look_t *look) {
    wh_world_t *world = look->world;
    move_bodies(look);
    if (!world->still.is_any_gone && world->still.is_known) {
        return;
    }
    wh_real_t most = 0;
    for (size_t i = 0; i < world->mover_count; ++i) {
        wh_mover_t *mover = &world->movers[i];
        if (!world->bodies[mover->body].rests) {
            const wh_real_t motion = move_mover(world, mover);
            most = motion > most ? motion : most;
        }
    }
    world->still.is_known = !world->still.is_any_gone;
    world->due.gone = wh_world_add(world->due.gone, 2 * most);
    if (world->still.begins) {
        wake_pairs(world);
    }
}

void wh_world_jump(wh_world_t *world, const wh_world_input_t *input) {
    const wh_look_t look = {world, input, NULL};
    world->slice = input->slice;
    world->step = wh_world_next_step(world);
    wh_world_move(&look);
    wh_world_move(&look); /* `before` and `now` become equal */
}
