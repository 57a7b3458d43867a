/* A world's description and memory. world_move.c, world_near.c and world_pair.c have the work of a
 * slice. */
#include "world.h"

#include <string.h>

#include "world_internal.h"

/* Slices in a bin of the curves at the start. */
#define FIRST_BIN 20

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
        return wh_is_index(part->owner, wh_world_arms(config) * WH_ARM_BODIES);
    case WH_PART_BLADE:
    case WH_PART_CHUCK:
        return wh_is_index(part->owner, config->gripper_count);
    case WH_PART_DOOR:
        return wh_is_index(part->owner, config->door_count);
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
    return config->gripper_count > WH_WORLD_GRIPPERS || config->arm_count > WH_WORLD_ARMS ||
           config->door_count > WH_WORLD_DOORS || count_hanging(config) > WH_WORLD_MOVING ||
           config->part_count > 1000000 || config->wafer_count > 1000000;
}

static bool carriers_fit(const wh_world_config_t *config) {
    bool fit = true;
    for (size_t g = 0; config->arm_count > 0 && g < config->gripper_count; ++g) {
        fit = fit && (config->carried_by[g] == WH_WORLD_NO_ARM || config->carried_by[g] < config->arm_count);
    }
    return fit;
}

static bool lacks(const wh_world_config_t *config) {
    return !config->cell || (!config->parts && config->part_count > 0) ||
           (config->arm_count > 0 && (!config->arms || !config->carried_by));
}

wh_status_t wh_world_validate(const wh_world_config_t *config, int32_t *part) {
    int32_t unused = WH_NONE;
    int32_t *const where = part ? part : &unused;
    *where = WH_NONE;
    if (!config || lacks(config)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (exceeds_capacity(config)) {
        return WH_STATUS_BAD_CAPACITY;
    }
    if (!carriers_fit(config)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = validate_parts(config, where);
    return status == WH_OK ? wh_convex_validate(&config->wafer) : status;
}

/* ------------------------------------------------------------------------------------------------- memory */

/* A block of memory that is divided. Sizes are rounded up, so that the next one is aligned. */
typedef struct {
    unsigned char *memory; /* null: the caller asks for the size */
    size_t used;
} block_t;

static void *take(block_t *block, size_t count, size_t size) {
    void *const begin = block->memory ? block->memory + block->used : NULL;
    block->used += (count * size + 15) / 16 * 16;
    return begin;
}

/* Divides memory among what a world needs, the world itself first. Everything but its arrays is blank. */
static void lay_out(const wh_world_config_t *config, block_t *block) {
    const size_t hanging = count_hanging(config);
    const size_t items = config->part_count - hanging + config->wafer_count;
    const size_t movers = hanging + config->gripper_count;
    wh_world_t *world = take(block, 1, sizeof *world);
    wh_tree_t tree = {.count = items};
    tree.nodes = take(block, wh_tree_nodes(items), sizeof *tree.nodes);
    tree.codes = take(block, items, sizeof *tree.codes);
    tree.order = take(block, items, sizeof *tree.order);
    tree.leaf_of = take(block, items, sizeof *tree.leaf_of);
    wh_box_t *boxes = take(block, items, sizeof *boxes);
    wh_pose_t *wafers = take(block, config->wafer_count, sizeof *wafers);
    wh_pose_t *shapes = take(block, config->wafer_count, sizeof *shapes);
    wh_mover_t *all = take(block, movers, sizeof *all);
    wh_mover_pair_t *pairs = take(block, movers * (movers - 1) / 2, sizeof *pairs);
    const size_t blocks = wh_world_blocks(movers * (movers - 1) / 2);
    double *due = take(block, blocks * WH_WORLD_BLOCK, sizeof *due);
    double *soonest = take(block, blocks, sizeof *soonest);
    wh_pair_t *near = take(block, movers * WH_NEAR_CAPACITY, sizeof *near);
    if (world) {
        memset(world, 0, sizeof *world);
        world->config = config;
        world->fixed_count = config->part_count - hanging;
        world->mover_count = movers;
        world->tree = tree;
        world->boxes = boxes;
        world->wafers = wafers;
        world->shapes = shapes;
        world->movers = all;
        world->pairs = pairs;
        world->due.of = due;
        world->due.soonest = soonest;
        world->near = near;
    }
}

size_t wh_world_bytes(const wh_world_config_t *config) {
    block_t block = {NULL, 0};
    lay_out(config, &block);
    return block.used;
}

/* ------------------------------------------------------------------------------------------------- set-up */

static void set_up_boxes(wh_world_t *world, const wh_wafer_t wafers[]) {
    for (size_t w = 0; w < world->config->wafer_count; ++w) {
        world->wafers[w] = wafers[w].base_from_wafer;
        wh_world_place_shape(world, w);
    }
    for (size_t i = 0; i < world->tree.count; ++i) {
        const wh_side_t side = wh_world_side_of_item(world, (int32_t)i);
        world->boxes[i] = wh_world_box(&side);
    }
    wh_tree_build(&world->tree, world->boxes);
}

static int32_t body_of(const wh_part_t *part) {
    if (part->kind == WH_PART_DOOR) {
        return wh_world_door_body((size_t)part->owner);
    }
    return part->kind == WH_PART_ARM ? part->owner : wh_world_gripper_body((size_t)part->owner);
}

static void set_up_mover(wh_world_t *world, size_t index, int32_t part, int32_t body, int32_t arm) {
    wh_mover_t *mover = &world->movers[index];
    memset(mover, 0, sizeof *mover);
    mover->part = part;
    mover->body = body;
    mover->kind = part == WH_NONE ? WH_PART_WAFER : world->config->parts[part].kind;
    mover->arm = arm;
    world->bodies[body].has_parts = true;
    if (mover->kind == WH_PART_ARM) {
        world->still.has_parts[body / (int32_t)WH_ARM_BODIES] = true;
    }
    mover->near = &world->near[index * WH_NEAR_CAPACITY];
    mover->radius = wh_convex_radius(part == WH_NONE ? &world->config->wafer : wh_world_convex(world, part));
}

static void set_up_movers(wh_world_t *world) {
    const wh_world_config_t *config = world->config;
    const size_t hanging = wh_world_hanging(world);
    for (size_t i = 0; i < hanging; ++i) {
        const size_t part = world->fixed_count + i;
        const wh_part_t *hung = &config->parts[part];
        const bool is_carried = hung->kind == WH_PART_ARM || hung->kind == WH_PART_BLADE;
        const int32_t arm = is_carried ? wh_world_arm_of(config, hung->kind, hung->owner) : WH_NONE;
        set_up_mover(world, i, (int32_t)part, body_of(hung), arm);
    }
    for (size_t g = 0; g < config->gripper_count; ++g) {
        const int32_t arm = wh_world_arm_of(config, WH_PART_BLADE, (int32_t)g);
        set_up_mover(world, hanging + g, WH_NONE, wh_world_held_body(g), arm);
        world->held[g] = WH_NONE;
        world->left[g].wafer = WH_NONE;
    }
}

/* Movers for a held wafer may meet anything, because the wafer may be any. */
static bool never_meet(const wh_world_t *world, const wh_mover_t *a, const wh_mover_t *b) {
    return a->part != WH_NONE && b->part != WH_NONE &&
           (wh_world_is_known(world, a->part, b->part) ||
            wh_world_belong_together(world->config, &world->config->parts[a->part],
                                     &world->config->parts[b->part]));
}

/* So that each block is a whole one. */
static void fill_last_block(wh_world_t *world) {
    const size_t end = wh_world_blocks(world->pair_count) * WH_WORLD_BLOCK;
    for (size_t i = world->pair_count; i < end; ++i) {
        world->due.of[i] = (double)WH_WORLD_NOWHERE;
    }
}

static void set_up_pairs(wh_world_t *world) {
    for (size_t a = 0; a < world->mover_count; ++a) {
        for (size_t b = a + 1; b < world->mover_count; ++b) {
            if (!never_meet(world, &world->movers[a], &world->movers[b])) {
                wh_mover_pair_t *pair = &world->pairs[world->pair_count++];
                memset(pair, 0, sizeof *pair);
                pair->a = (int32_t)a;
                pair->b = (int32_t)b;
                wh_world_forget(world, pair);
                const wh_mover_t *other = &world->movers[b];
                pair->near.worth =
                    wh_world_worth_of(world->config, &world->movers[a], other->kind, other->arm);
            }
        }
    }
    fill_last_block(world);
}

wh_world_t *wh_world_init(const wh_world_config_t *config, const wh_world_input_t *input, void *memory,
                          size_t bytes) {
    wh_world_t *world = memory;
    block_t block = {memory, 0};
    if (!memory || bytes < wh_world_bytes(config)) {
        return NULL;
    }
    lay_out(config, &block);
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        const wh_real_t gap = config->known ? config->limits[kind] : WH_CLEARANCE_RANGE;
        world->clearances[kind].gap = world->gaps.least[kind] = gap;
        world->clearances[kind].parts[0] = world->clearances[kind].parts[1] = WH_NONE;
    }
    wh_world_weigh(world);
    world->curves.first = input->slice;
    world->curves.slices = FIRST_BIN;
    set_up_boxes(world, input->wafers);
    set_up_movers(world);
    set_up_pairs(world);
    const wh_look_t look = {world, input, NULL};
    wh_world_move(&look);
    wh_world_move(&look); /* `before` and `now` become equal */
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
