/* The smallest gaps over time. The judgement finds those of moving parts, slice by slice. At a bin's end
 * all near pairs that may count are measured again, also those that did not move in the bin. */
#include "world_internal.h"

/* The smallest gaps at a bin's end, so far. */
typedef struct {
    wh_real_t least[WH_CLEARANCES];
    wh_real_t most[WH_WORTHS]; /* wh_world_most_of them: a larger gap does not count */
} now_t;

static void weigh(now_t *now) {
    for (size_t i = 0; i < WH_WORTHS; ++i) {
        now->most[i] = wh_world_most_of((wh_worth_t)i, now->least);
    }
}

/* Measures a pair, unless its remaining `slack` says that it does not count. The result is known from then
 * on. If `b` is null, the other one rests and is the item near->other. */
static void measure(const wh_look_t *look, wh_mover_t *a, wh_mover_t *b, wh_pair_t *near, now_t *now) {
    wh_world_t *world = look->world;
    if (near->slack - (wh_world_gone(near, a, b) - near->since) > now->most[near->worth]) {
        return;
    }
    wh_side_t item;
    const wh_side_t *one = wh_world_side_of_mover(world, a);
    const wh_side_t *two = &item;
    if (b) {
        two = wh_world_side_of_mover(world, b);
    } else {
        item = wh_world_side_of_item(world, near->other);
    }
    const wh_clearance_kind_t kind = wh_world_clearance_of(look, one, two);
    if (kind == WH_CLEARANCES || wh_world_may_touch(look, one, two)) {
        return;
    }
    wh_real_t *least = &now->least[kind];
    if (near->exact < one->gone + two->gone) {
        wh_gap_t gap;
        wh_gap_follow(one->convex, one->now, two->convex, two->now, *least, near->axis,
                      wh_world_start(world, one->part, two->part), &gap);
        wh_world_take_gap(near, one, two, &gap, *least);
        wh_world_remember(near, a, b);
        wh_world_keep_clearance(look, kind, one, two, &gap);
    }
    const wh_real_t found = near->slack > 0 ? near->slack : 0;
    if (found < *least) {
        *least = found;
        weigh(now);
    }
}

static void measure_rest(const wh_look_t *look, wh_mover_t *mover, now_t *now) {
    if (mover->part == WH_NONE) {
        return;
    }
    wh_world_list_near(look->world, mover);
    for (size_t i = 0; i < mover->near_count; ++i) {
        measure(look, mover, NULL, &mover->near[i], now);
    }
}

static void measure_pair(const wh_look_t *look, wh_mover_pair_t *pair, now_t *now) {
    wh_mover_t *a = &look->world->movers[pair->a];
    wh_mover_t *b = &look->world->movers[pair->b];
    if (a->part != WH_NONE && b->part != WH_NONE) {
        measure(look, a, b, &pair->near, now);
    }
}

/* Makes one bin out of each two. */
static void halve(wh_curves_t *curves) {
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        wh_real_t *gaps = curves->gaps[kind];
        for (size_t bin = 0; bin < WH_CURVE_BINS / 2; ++bin) {
            gaps[bin] = gaps[2 * bin] < gaps[2 * bin + 1] ? gaps[2 * bin] : gaps[2 * bin + 1];
        }
    }
    curves->count = WH_CURVE_BINS / 2;
    curves->slices *= 2;
}

static void close_bin(wh_curves_t *curves, const wh_real_t least[], const wh_real_t now[]) {
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        curves->gaps[kind][curves->count] = least[kind] < now[kind] ? least[kind] : now[kind];
    }
    ++curves->count;
    if (curves->count == WH_CURVE_BINS) {
        halve(curves);
    }
}

/* The gaps at a bin's end are those at the next one's begin, also for parts that do not move then. If they
 * are larger, pairs count that did not count before. */
static void begin_bin(wh_world_t *world, const wh_real_t now[]) {
    double more = 0;
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        const double grown = (double)(now[kind] - world->gaps.least[kind]);
        more = grown > more ? grown : more;
        world->gaps.least[kind] = now[kind];
    }
    wh_world_weigh(world);
    for (size_t i = 0; more > 0 && i < world->pair_count; ++i) {
        world->due.of[i] -= more;
    }
    for (size_t block = 0; more > 0 && block < wh_world_blocks(world->pair_count); ++block) {
        world->due.soonest[block] -= more; /* the least of them all the same */
    }
}

void wh_world_copy_curves(const wh_world_t *world, wh_curves_t *curves) {
    *curves = world->curves;
    curves->last = world->slice;
    if (world->slice > curves->first + curves->count * curves->slices) {
        for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
            curves->gaps[kind][curves->count] = world->gaps.least[kind];
        }
        ++curves->count;
    }
}

/* If slices are lost, as in a free run, their bins show the values after them. */
void wh_world_draw_curves(const wh_look_t *look) {
    wh_world_t *world = look->world;
    wh_curves_t *curves = &world->curves;
    now_t now;
    if (look->input->slice < curves->first + (curves->count + 1) * curves->slices) {
        return;
    }
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        now.least[kind] = WH_CLEARANCE_RANGE;
    }
    weigh(&now);
    for (size_t i = 0; i < world->mover_count; ++i) {
        measure_rest(look, &world->movers[i], &now);
    }
    for (size_t i = 0; i < world->pair_count; ++i) {
        measure_pair(look, &world->pairs[i], &now);
    }
    while (look->input->slice >= curves->first + (curves->count + 1) * curves->slices) {
        close_bin(curves, world->gaps.least, now.least);
    }
    begin_bin(world, now.least);
}
