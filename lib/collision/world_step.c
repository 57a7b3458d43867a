/* The judgement of a world: in a slice, after everything has moved; and at rest, before a run. */
#include "world_internal.h"

/* The most things near a part that are checked before a run. */
#define MOST_NEAR 256

/* --------------------------------------------------------------------------------------------- in a slice */

static void judge_rest(const wh_look_t *look, wh_mover_t *mover) {
    wh_world_t *world = look->world;
    if (mover->part == WH_NONE || !(mover->motion > 0)) {
        return;
    }
    wh_world_list_near(world, mover);
    world->counters.pairs += mover->near_count;
    if (mover->crowd > 0) {
        wh_world_report_crowd(look, wh_world_side_of_mover(world, mover), mover->crowd);
    }
    for (size_t i = 0; i < mover->near_count; ++i) {
        wh_pair_t *near = &mover->near[i];
        if (!wh_world_is_far(world, near, mover, NULL)) {
            const wh_side_t *a = wh_world_side_of_mover(world, mover);
            const wh_side_t b = wh_world_side_of_item(world, near->other);
            wh_world_judge(look, a, &b, near);
            wh_world_remember(near, mover, NULL);
        }
    }
}

/* True for a wafer and parts of the gripper that holds it: they may touch, and no clearance counts between
 * them. */
static bool hold_each_other(const wh_look_t *look, const wh_mover_pair_t *pair) {
    const wh_world_t *world = look->world;
    const wh_world_config_t *config = world->config;
    const size_t hanging = wh_world_hanging(world);
    if ((size_t)pair->a >= hanging || (size_t)pair->b < hanging) {
        return false;
    }
    const wh_part_t *hung = &config->parts[world->movers[pair->a].part];
    const int32_t wafer = world->movers[pair->b].part - (int32_t)config->part_count;
    return (hung->kind == WH_PART_BLADE || hung->kind == WH_PART_CHUCK) &&
           look->input->wafers[wafer].holder == hung->owner;
}

/* A slack that is used up within this number of slices at the present motion is computed again. If that
 * does not help, the next time is after this number of slices. */
#define SOON 16

/* The sum of all ways is much larger than the true approach of two movers side by side. */
static void ask_anew(wh_world_t *world, wh_mover_t *a, wh_mover_t *b, wh_pair_t *near) {
    const wh_real_t soon = SOON * (a->motion + b->motion);
    if (near->slack - world->gaps.worth[near->worth] > soon || world->step < near->again) {
        return;
    }
    const wh_side_t *one = wh_world_side_of_mover(world, a);
    const wh_side_t *two = wh_world_side_of_mover(world, b);
    const wh_real_t apart = wh_gap_along(one->convex, one->now, two->convex, two->now, near->axis);
    near->again = apart > near->slack + soon ? 0 : world->step + SOON;
    near->slack = apart > near->slack ? apart : near->slack;
    near->exact = -1;
}

static void judge_movers(const wh_look_t *look, wh_mover_pair_t *pair) {
    wh_world_t *world = look->world;
    wh_mover_t *a = &world->movers[pair->a];
    wh_mover_t *b = &world->movers[pair->b];
    if (wh_world_is_far(world, &pair->near, a, b)) {
        ask_anew(world, a, b, &pair->near);
        return;
    }
    if (wh_world_is_known(world, a->part, b->part)) {
        return;
    }
    const wh_side_t *one = wh_world_side_of_mover(world, a);
    const wh_side_t *two = wh_world_side_of_mover(world, b);
    ++world->counters.pairs;
    wh_world_judge(look, one, two, &pair->near);
    wh_world_remember(&pair->near, a, b);
}

/* Sums of ways are rounded, so a pair is judged when this much is left, mm. */
#define EARLY 0.01

static bool both_stand(const wh_world_t *world, const wh_mover_pair_t *pair) {
    return !world->bodies[world->movers[pair->a].body].has_gone &&
           !world->bodies[world->movers[pair->b].body].has_gone;
}

/* Judges a pair. Returns the distance that must still close before the pair matters. It is infinite while
 * they hold each other, because the knowledge of a wafer is forgotten when it is taken or released, and while
 * both stand, because all pairs are due when a body begins to go. */
static double judge_pair(const wh_look_t *look, wh_mover_pair_t *pair) {
    const wh_world_t *world = look->world;
    const wh_mover_t *movers = world->movers;
    const wh_real_t worth = world->gaps.worth[pair->near.worth];
    if (!(wh_world_slack(pair, movers) > worth)) {
        if (hold_each_other(look, pair)) {
            return (double)WH_WORLD_NOWHERE;
        }
        if (movers[pair->a].motion + movers[pair->b].motion > 0) {
            judge_movers(look, pair);
        }
    }
    return both_stand(world, pair) ? (double)WH_WORLD_NOWHERE
                                   : (double)(wh_world_slack(pair, movers) - worth);
}

/* The least of a block, in halves: a processor compares several at once. */
static double least_of(const double due[]) {
    double least[WH_WORLD_BLOCK / 2];
    for (size_t i = 0; i < WH_WORLD_BLOCK / 2; ++i) {
        least[i] = due[i] < due[i + WH_WORLD_BLOCK / 2] ? due[i] : due[i + WH_WORLD_BLOCK / 2];
    }
    for (size_t half = WH_WORLD_BLOCK / 4; half > 0; half /= 2) {
        for (size_t i = 0; i < half; ++i) {
            least[i] = least[i] < least[i + half] ? least[i] : least[i + half];
        }
    }
    return least[0];
}

/* Judges a pair of a block if it is due; the last block may have fewer. */
static void judge_due(const wh_look_t *look, size_t index, double *due) {
    const wh_world_t *world = look->world;
    if (!(world->due.gone < *due) && index < world->pair_count) {
        const double next = world->due.gone + judge_pair(look, &world->pairs[index]) - EARLY;
        *due = next > 0 ? next : 0; /* also if it is no number */
    }
}

/* Judges the pairs of a block that are due, the first of which has this number: in fours, because most are
 * not. */
static void judge_block(const wh_look_t *look, size_t first, double due[]) {
    const double gone = look->world->due.gone;
    for (size_t i = 0; i < WH_WORLD_BLOCK; i += 4) {
        if (gone < due[i] && gone < due[i + 1] && gone < due[i + 2] && gone < due[i + 3]) {
            continue;
        }
        for (size_t k = i; k < i + 4; ++k) {
            judge_due(look, first + k, &due[k]);
        }
    }
}

/* Most pairs are so far apart that they need no judgement for many slices. */
static void judge_pairs(const wh_look_t *look) {
    const wh_world_t *world = look->world;
    for (size_t block = 0; block < wh_world_blocks(world->pair_count); ++block) {
        if (!(world->due.gone < world->due.soonest[block])) {
            double *const due = world->due.of + block * WH_WORLD_BLOCK;
            judge_block(look, block * WH_WORLD_BLOCK, due);
            world->due.soonest[block] = least_of(due);
        }
    }
}

static void judge_all(const wh_look_t *look) {
    wh_world_t *world = look->world;
    for (size_t i = 0; i < world->mover_count; ++i) {
        judge_rest(look, &world->movers[i]);
    }
    judge_pairs(look);
}

void wh_world_step(wh_world_t *world, const wh_world_input_t *input, wh_event_list_t *list) {
    const wh_look_t look = {world, input, list};
    world->slice = input->slice;
    world->step = wh_world_next_step(world);
    wh_world_move(&look);
    if (world->still.is_any_gone) {
        judge_all(&look);
    }
    wh_world_settle(&look);
    if (!world->config->known) {
        wh_world_draw_curves(&look);
    }
}

/* ------------------------------------------------------------------------------------------- before a run */

static bool cut(const wh_side_t *a, const wh_side_t *b) {
    wh_gap_t gap;
    wh_gap_measure(a->convex, a->now, b->convex, b->now, 0, wh_vec3(0, 0, 0), &gap);
    return gap.state == WH_GAP_HIT || gap.state == WH_GAP_UNDECIDED;
}

/* The pairs found; the first `capacity` of them are kept. */
typedef struct {
    int32_t (*pairs)[2];
    size_t count, capacity;
} contacts_t;

static void add_contact(contacts_t *contacts, const wh_side_t *a, const wh_side_t *b) {
    if (contacts->count < contacts->capacity) {
        contacts->pairs[contacts->count][0] = a->part;
        contacts->pairs[contacts->count][1] = b->part;
    }
    ++contacts->count;
}

/* Adds the things at rest that this part overlaps, if they come after item `self`, so that two wafers make
 * one pair. Fixed parts may overlap each other, because one thing may consist of several. */
static void add_rest(const wh_look_t *look, const wh_side_t *a, int32_t self, contacts_t *contacts) {
    const int32_t fixed_count = (int32_t)look->world->fixed_count;
    int32_t found[MOST_NEAR];
    const wh_box_t box = wh_world_box(a);
    const size_t count = wh_tree_find(&look->world->tree, &box, found, MOST_NEAR);
    for (size_t i = 0; i < count && i < MOST_NEAR; ++i) {
        const wh_side_t b = wh_world_side_of_item(look->world, found[i]);
        const bool is_new = found[i] < fixed_count || found[i] > self;
        if (is_new && !wh_world_may_touch(look, a, &b) && cut(a, &b)) {
            add_contact(contacts, a, &b);
        }
    }
}

static void add_pair(const wh_look_t *look, const wh_mover_pair_t *pair, contacts_t *contacts) {
    wh_mover_t *a = &look->world->movers[pair->a];
    wh_mover_t *b = &look->world->movers[pair->b];
    if (a->part == WH_NONE || b->part == WH_NONE) {
        return;
    }
    const wh_side_t *one = wh_world_side_of_mover(look->world, a);
    const wh_side_t *two = wh_world_side_of_mover(look->world, b);
    if (!wh_world_may_touch(look, one, two) && cut(one, two)) {
        add_contact(contacts, one, two);
    }
}

size_t wh_world_check_rest(wh_world_t *world, const wh_world_input_t *input, int32_t pairs[][2],
                           size_t capacity) {
    const wh_look_t look = {world, input, NULL};
    contacts_t contacts = {pairs, 0, capacity};
    for (size_t w = 0; w < world->config->wafer_count; ++w) {
        const int32_t item = wh_world_item_of_wafer(world, (int32_t)w);
        wh_world_place_shape(world, w);
        const wh_side_t a = wh_world_side_of_item(world, item);
        add_rest(&look, &a, item, &contacts);
    }
    for (size_t i = 0; i < world->mover_count; ++i) {
        if (world->movers[i].part != WH_NONE) {
            const wh_side_t *a = wh_world_side_of_mover(world, &world->movers[i]);
            add_rest(&look, a, WH_NONE, &contacts);
        }
    }
    for (size_t i = 0; i < world->pair_count; ++i) {
        add_pair(&look, &world->pairs[i], &contacts);
    }
    return contacts.count;
}
