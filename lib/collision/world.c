/* A world's description and memory. What happens in a slice is in world_move.c, world_near.c and
 * world_pair.c. */
#include "world.h"

#include <string.h>

#include "world_internal.h"

/* Slices in a bin of the curves at the start. */
#define FIRST_BIN 10

const char *wh_clearance_name(wh_clearance_kind_t kind) {
    static const char *const names[WH_CLEARANCES] = {"blade_wafer_above", "blade_wafer_below", "blade_other",
                                                     "wafer_wafer",       "wafer_ledge",       "wafer_other",
                                                     "arm_other",         "arm_itself"};
    return (unsigned)kind < WH_CLEARANCES ? names[kind] : "unknown";
}

/* -------------------------------------------------------------------------------------------- description */

static bool hangs(const wh_part_t *part) {
    return part->kind != WH_PART_FIXED && part->kind != WH_PART_LEDGE;
}

static bool owner_fits(const wh_world_config_t *config, const wh_part_t *part) {
    switch (part->kind) {
    case WH_PART_FIXED:
        return true;
    case WH_PART_LEDGE:
        return wh_is_index(part->owner, config->cell->count) &&
               wh_is_index(part->slot - 1, (size_t)config->cell->stations[part->owner].slots);
    case WH_PART_ARM:
        return wh_is_index(part->owner, WH_ARM_BODIES);
    case WH_PART_BLADE:
    case WH_PART_CHUCK:
        return wh_is_index(part->owner, config->gripper_count);
    case WH_PART_WAFER:
        break;
    }
    return false;
}

static size_t count_hanging(const wh_world_config_t *config) {
    size_t count = 0;
    for (size_t i = 0; i < config->part_count; ++i) {
        count += hangs(&config->parts[i]) ? 1 : 0;
    }
    return count;
}

static wh_status_t validate_parts(const wh_world_config_t *config, int32_t *part) {
    for (size_t i = 0; i < config->part_count; ++i) {
        const wh_part_t *p = &config->parts[i];
        const bool in_order = i == 0 || hangs(p) || !hangs(&config->parts[i - 1]);
        const wh_status_t status = wh_convex_validate(&p->convex);
        *part = (int32_t)i;
        if (!in_order || !owner_fits(config, p)) {
            return WH_STATUS_OUT_OF_RANGE;
        }
        if (status != WH_OK) {
            return status;
        }
    }
    *part = WH_NONE;
    return WH_OK;
}

static bool exceeds_capacity(const wh_world_config_t *config) {
    return config->gripper_count > WH_WORLD_GRIPPERS || count_hanging(config) > WH_WORLD_MOVING ||
           config->part_count > 1000000 || config->wafer_count > 1000000;
}

wh_status_t wh_world_validate(const wh_world_config_t *config, int32_t *part) {
    int32_t unused = WH_NONE;
    int32_t *const where = part ? part : &unused;
    *where = WH_NONE;
    if (!config || !config->cell || (!config->parts && config->part_count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (exceeds_capacity(config)) {
        return WH_STATUS_BAD_CAPACITY;
    }
    const wh_status_t status = validate_parts(config, where);
    return status == WH_OK ? wh_convex_validate(&config->wafer) : status;
}

/* ------------------------------------------------------------------------------------------------- memory */

/* Where the arrays begin in the block of memory. Their sizes are rounded up, so that the next one is
 * aligned. */
typedef struct {
    size_t items, hanging, movers, pairs;
    size_t nodes_at, boxes_at, codes_at, order_at, leaf_at, wafers_at, movers_at, pairs_at, near_at, end;
} plan_t;

static size_t take(size_t *at, size_t count, size_t size) {
    const size_t begin = *at;
    *at += (count * size + 15) / 16 * 16;
    return begin;
}

static plan_t plan_memory(const wh_world_config_t *config) {
    plan_t plan;
    size_t at = 0;
    plan.hanging = count_hanging(config);
    plan.items = config->part_count - plan.hanging + config->wafer_count;
    plan.movers = plan.hanging + config->gripper_count;
    plan.pairs = plan.movers * (plan.movers > 0 ? plan.movers - 1 : 0) / 2;
    (void)take(&at, 1, sizeof(wh_world_t));
    plan.nodes_at = take(&at, wh_tree_nodes(plan.items), sizeof(wh_box_t));
    plan.boxes_at = take(&at, plan.items, sizeof(wh_box_t));
    plan.codes_at = take(&at, plan.items, sizeof(uint64_t));
    plan.order_at = take(&at, plan.items, sizeof(int32_t));
    plan.leaf_at = take(&at, plan.items, sizeof(int32_t));
    plan.wafers_at = take(&at, config->wafer_count, sizeof(wh_pose_t));
    plan.movers_at = take(&at, plan.movers, sizeof(wh_mover_t));
    plan.pairs_at = take(&at, plan.pairs, sizeof(wh_mover_pair_t));
    plan.near_at = take(&at, plan.movers * WH_NEAR_CAPACITY, sizeof(wh_pair_t));
    plan.end = at;
    return plan;
}

size_t wh_world_bytes(const wh_world_config_t *config) {
    return plan_memory(config).end;
}

static void *part_of(void *memory, size_t at) {
    return (unsigned char *)memory + at;
}

static wh_world_t *lay_out(const wh_world_config_t *config, const plan_t *plan, void *memory) {
    wh_world_t *world = memory;
    memset(world, 0, sizeof *world);
    world->config = config;
    world->fixed_count = config->part_count - plan->hanging;
    world->tree.nodes = part_of(memory, plan->nodes_at);
    world->tree.codes = part_of(memory, plan->codes_at);
    world->tree.order = part_of(memory, plan->order_at);
    world->tree.leaf_of = part_of(memory, plan->leaf_at);
    world->tree.count = plan->items;
    world->boxes = part_of(memory, plan->boxes_at);
    world->wafers = part_of(memory, plan->wafers_at);
    world->movers = part_of(memory, plan->movers_at);
    world->mover_count = plan->movers;
    world->pairs = part_of(memory, plan->pairs_at);
    world->near = part_of(memory, plan->near_at);
    return world;
}

/* ------------------------------------------------------------------------------------------------- set-up */

static void set_up_boxes(wh_world_t *world, const wh_wafer_t wafers[]) {
    const wh_world_config_t *config = world->config;
    for (size_t i = 0; i < world->fixed_count; ++i) {
        const wh_convex_t *convex = &config->parts[i].convex;
        wh_convex_bounds(convex, &convex->body_from_shape, &world->boxes[i].low, &world->boxes[i].high);
    }
    for (size_t w = 0; w < config->wafer_count; ++w) {
        world->wafers[w] = wafers[w].base_from_wafer;
        const wh_pose_t base_from_shape = wh_pose_compose(&world->wafers[w], &config->wafer.body_from_shape);
        wh_box_t *box = &world->boxes[world->fixed_count + w];
        wh_convex_bounds(&config->wafer, &base_from_shape, &box->low, &box->high);
    }
    wh_tree_build(&world->tree, world->boxes);
}

static int32_t body_of(const wh_part_t *part) {
    return part->kind == WH_PART_ARM ? part->owner : wh_world_gripper_body((size_t)part->owner);
}

static void set_up_mover(wh_world_t *world, size_t index, int32_t part, int32_t body) {
    wh_mover_t *mover = &world->movers[index];
    memset(mover, 0, sizeof *mover);
    mover->part = part;
    mover->body = body;
    mover->near = &world->near[index * WH_NEAR_CAPACITY];
    mover->radius = wh_convex_radius(part == WH_NONE ? &world->config->wafer : wh_world_convex(world, part));
}

static void set_up_movers(wh_world_t *world) {
    const wh_world_config_t *config = world->config;
    const size_t hanging = config->part_count - world->fixed_count;
    for (size_t i = 0; i < hanging; ++i) {
        const size_t part = world->fixed_count + i;
        set_up_mover(world, i, (int32_t)part, body_of(&config->parts[part]));
    }
    for (size_t g = 0; g < config->gripper_count; ++g) {
        set_up_mover(world, hanging + g, WH_NONE, wh_world_held_body(g));
        world->held[g] = WH_NONE;
        world->left[g].wafer = WH_NONE;
    }
}

/* Movers that stand for a held wafer may meet anything, whichever wafer it is. */
static bool never_meet(const wh_world_t *world, const wh_mover_t *a, const wh_mover_t *b) {
    return a->part != WH_NONE && b->part != WH_NONE &&
           wh_world_belong_together(&world->config->parts[a->part], &world->config->parts[b->part]);
}

static void set_up_pairs(wh_world_t *world) {
    for (size_t a = 0; a < world->mover_count; ++a) {
        for (size_t b = a + 1; b < world->mover_count; ++b) {
            if (!never_meet(world, &world->movers[a], &world->movers[b])) {
                wh_mover_pair_t *pair = &world->pairs[world->pair_count++];
                memset(pair, 0, sizeof *pair);
                pair->a = (int32_t)a;
                pair->b = (int32_t)b;
            }
        }
    }
}

wh_world_t *wh_world_init(const wh_world_config_t *config, const wh_world_input_t *input, void *memory,
                          size_t bytes) {
    const plan_t plan = plan_memory(config);
    if (!memory || bytes < plan.end) {
        return NULL;
    }
    wh_world_t *world = lay_out(config, &plan, memory);
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        world->clearances[kind].gap = WH_CLEARANCE_RANGE;
        world->clearances[kind].parts[0] = world->clearances[kind].parts[1] = WH_NONE;
    }
    world->curves.first = input->slice;
    world->curves.slices = FIRST_BIN;
    set_up_boxes(world, input->wafers);
    set_up_movers(world);
    set_up_pairs(world);
    const wh_look_t look = {world, input, NULL};
    wh_world_move(&look);
    wh_world_move(&look); /* now `before` and `now` are the same */
    return world;
}

const wh_clearance_t *wh_world_clearances(const wh_world_t *world) {
    return world->clearances;
}

const wh_curves_t *wh_world_curves(const wh_world_t *world) {
    return &world->curves;
}

const wh_world_counters_t *wh_world_counters(const wh_world_t *world) {
    return &world->counters;
}
