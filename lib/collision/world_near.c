/* The things at rest near a moving part: a list that is valid until the part has moved by its reach. */
#include "world_internal.h"

/* How much farther than for its list a mover with nothing near looks for things at rest, mm. */
#define AHEAD WH_REAL(100.0)

static wh_side_t side_of_part(const wh_world_config_t *config, int32_t part) {
    wh_side_t side = {.part = part, .kind = WH_PART_WAFER, .convex = &config->wafer};
    if ((size_t)part < config->part_count) {
        side.kind = config->parts[part].kind;
        side.owner = config->parts[part].owner;
        side.slot = config->parts[part].slot;
        side.convex = &config->parts[part].convex;
    } else {
        side.owner = part - (int32_t)config->part_count;
    }
    return side;
}

/* The slice begins where the one before ended. */
static void place(const wh_world_t *world, wh_mover_t *mover) {
    const wh_body_t *body = &world->bodies[mover->body];
    const wh_convex_t *convex = wh_world_convex(world, mover->part);
    if (!mover->is_placed) {
        mover->before =
            mover->was_placed ? mover->now : wh_pose_compose(&body->before, &convex->body_from_shape);
        mover->now = wh_pose_compose(&body->now, &convex->body_from_shape);
        mover->is_placed = true;
    }
}

const wh_side_t *wh_world_side_of_mover(const wh_world_t *world, wh_mover_t *mover) {
    wh_side_t *side = &mover->side;
    if (!side->convex || side->part != mover->part) {
        *side = side_of_part(world->config, mover->part);
        side->body = &world->bodies[mover->body];
        side->before = &mover->before;
        side->now = &mover->now;
    }
    place(world, mover);
    side->motion = mover->motion;
    side->bulge = mover->bulge;
    side->gone = mover->gone[WH_GONE_ANYWHERE];
    return side;
}

wh_side_t wh_world_side_of_item(const wh_world_t *world, int32_t item) {
    wh_side_t side = side_of_part(world->config, wh_world_part_of_item(world, item));
    side.now = side.kind == WH_PART_WAFER ? &world->shapes[side.owner] : &side.convex->body_from_shape;
    side.before = side.now;
    return side;
}

void wh_world_place_shape(wh_world_t *world, size_t wafer) {
    world->shapes[wafer] = wh_pose_compose(&world->wafers[wafer], &world->config->wafer.body_from_shape);
}

wh_box_t wh_world_box(const wh_side_t *side) {
    wh_box_t box;
    wh_convex_bounds(side->convex, side->now, &box.low, &box.high);
    return box;
}

/* The separation of two boxes along base's axes; `axis` is the one with the largest gap. */
static wh_real_t box_gap(const wh_box_t *a, const wh_box_t *b, wh_vec3_t *axis) {
    const wh_real_t gaps[6] = {b->low.x - a->high.x, a->low.x - b->high.x, b->low.y - a->high.y,
                               a->low.y - b->high.y, b->low.z - a->high.z, a->low.z - b->high.z};
    size_t best = 0;
    for (size_t i = 1; i < 6; ++i) {
        best = gaps[i] > gaps[best] ? i : best;
    }
    const wh_real_t sign = best % 2 == 0 ? 1 : -1;
    *axis = wh_vec3(best / 2 == 0 ? sign : 0, best / 2 == 1 ? sign : 0, best / 2 == 2 ? sign : 0);
    return gaps[best];
}

static wh_box_t box_before(const wh_world_t *world, wh_mover_t *mover) {
    wh_box_t box;
    place(world, mover);
    wh_convex_bounds(wh_world_convex(world, mover->part), &mover->before, &box.low, &box.high);
    return box;
}

/* Finds the things within a margin, which is halved until all of them have room. If there is no room even
 * for the range of clearances, the list has the things that can be touched in this slice, and it is for
 * this slice only. */
static size_t find_near(wh_world_t *world, wh_mover_t *mover, const wh_box_t *box, int32_t found[]) {
    wh_real_t margin = wh_world_margin(mover);
    const wh_real_t least = mover->motion + WH_NEAR_LEAST + WH_GAP_TOUCH;
    for (;;) {
        const wh_box_t grown = wh_box_grown(box, margin);
        const size_t count = wh_tree_find(&world->tree, &grown, found, WH_NEAR_CAPACITY);
        mover->reach = wh_world_reach(mover, margin);
        mover->crowd = count > WH_NEAR_CAPACITY ? count : 0;
        if (mover->crowd == 0 || margin <= least) {
            return mover->crowd > 0 ? WH_NEAR_CAPACITY : count;
        }
        margin = margin / 2 > least ? margin / 2 : least;
    }
}

/* Looks much farther if the list is empty: most parts are far from all that rests most of the time. The lists
 * of the way that it finds are empty, too. */
static void look_ahead(const wh_world_t *world, wh_mover_t *mover, const wh_box_t *box) {
    int32_t found[1];
    const wh_box_t grown = wh_box_grown(box, wh_world_margin(mover) + AHEAD);
    if (wh_tree_find(&world->tree, &grown, found, 1) == 0) {
        mover->clear = AHEAD - mover->motion - WH_GAP_TOUCH;
    }
}

static wh_part_kind_t kind_of_item(const wh_world_t *world, int32_t item) {
    return (size_t)item < world->fixed_count ? world->config->parts[item].kind : WH_PART_WAFER;
}

/* True if the two cannot matter. The item at rest and the mover are both known, or the item stands and the
 * mover is a door in its frame. */
static bool may_pass(const wh_world_t *world, const wh_mover_t *mover, int32_t item) {
    return (mover->kind == WH_PART_DOOR && kind_of_item(world, item) != WH_PART_WAFER) ||
           wh_world_is_known(world, mover->part, wh_world_part_of_item(world, item));
}

/* Takes the old list's knowledge of a thing. Returns false if it was not on that list. */
static bool take_over(const wh_pair_t known[], size_t count, wh_pair_t *near) {
    for (size_t i = 0; i < count; ++i) {
        if (known[i].other == near->other) {
            *near = known[i];
            return true;
        }
    }
    return false;
}

void wh_world_list_anew(wh_world_t *world, wh_mover_t *mover) {
    int32_t found[WH_NEAR_CAPACITY];
    wh_pair_t known[WH_NEAR_CAPACITY];
    const wh_box_t box = box_before(world, mover);
    const size_t known_count = mover->near_count;
    for (size_t i = 0; i < known_count; ++i) {
        known[i] = mover->near[i];
    }
    const size_t count = find_near(world, mover, &box, found);
    mover->near_count = 0;
    mover->clear = 0;
    if (count == 0) {
        look_ahead(world, mover, &box);
    }
    for (size_t i = 0; i < count; ++i) {
        if (may_pass(world, mover, found[i])) {
            continue;
        }
        wh_pair_t *near = &mover->near[mover->near_count++];
        near->other = found[i];
        near->worth = wh_world_worth_of(world->config, mover, kind_of_item(world, found[i]), WH_NONE);
        if (!take_over(known, known_count, near)) {
            const wh_box_t other = wh_tree_box(&world->tree, found[i]);
            near->slack = box_gap(&box, &other, &near->axis);
            near->step = near->again = 0;
            near->exact = -1;
            near->way = WH_GONE_ANYWHERE;
            near->since = wh_world_since(mover->gone[near->way]) - mover->motion;
        }
    }
    ++world->counters.relisted;
}
