/* The smallest gaps over time. The judgement finds those of what moves, slice by slice. At a bin's end all
 * that is near is measured again, without the lists of what is near: also what has not moved in the bin. */
#include <string.h>

#include "world_internal.h"

static void measure(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b, wh_vec3_t guess,
                    wh_real_t least[]) {
    const wh_clearance_kind_t kind = wh_world_clearance_of(look, a, b);
    wh_gap_t gap;
    if (kind == WH_CLEARANCES || wh_world_may_touch(look, a, b)) {
        return;
    }
    wh_gap_measure(a->convex, a->now, b->convex, b->now, least[kind], guess, &gap);
    const wh_real_t found = gap.state == WH_GAP_CLEAR ? gap.gap : 0;
    least[kind] = found < least[kind] ? found : least[kind];
}

static void measure_rest(const wh_look_t *look, wh_mover_t *mover, wh_real_t least[]) {
    int32_t found[WH_NEAR_CAPACITY];
    if (mover->part == WH_NONE) {
        return;
    }
    const wh_side_t a = wh_world_side_of_mover(look->world, mover);
    const wh_box_t around = wh_world_box(&a);
    const wh_box_t box = wh_box_grown(&around, WH_CLEARANCE_RANGE);
    const size_t count = wh_tree_find(&look->world->tree, &box, found, WH_NEAR_CAPACITY);
    for (size_t i = 0; i < count && i < WH_NEAR_CAPACITY; ++i) {
        const wh_side_t b = wh_world_side_of_item(look->world, found[i]);
        measure(look, &a, &b, wh_vec3(0, 0, 1), least);
    }
}

static void measure_pair(const wh_look_t *look, const wh_mover_pair_t *pair, wh_real_t least[]) {
    wh_mover_t *a = &look->world->movers[pair->a];
    wh_mover_t *b = &look->world->movers[pair->b];
    if (a->part != WH_NONE && b->part != WH_NONE &&
        wh_world_slack(pair, look->world->movers) < WH_CLEARANCE_RANGE) {
        const wh_side_t one = wh_world_side_of_mover(look->world, a);
        const wh_side_t two = wh_world_side_of_mover(look->world, b);
        measure(look, &one, &two, pair->near.axis, least);
    }
}

/* Makes one bin of each two. */
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

/* The gaps at a bin's end are those at the next one's begin: also of what does not move then. */
static void begin_bin(wh_world_t *world, const wh_real_t now[]) {
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        world->least[kind] = now[kind];
    }
    wh_world_weigh(world);
    memset(world->due, 0, world->pair_count * sizeof *world->due);
}

/* If slices are lost, as in a free-running run, their bins show what came after them. */
void wh_world_draw_curves(const wh_look_t *look) {
    wh_world_t *world = look->world;
    wh_curves_t *curves = &world->curves;
    wh_real_t now[WH_CLEARANCES];
    if (look->input->slice < curves->first + (curves->count + 1) * curves->slices) {
        return;
    }
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        now[kind] = WH_CLEARANCE_RANGE;
    }
    for (size_t i = 0; i < world->mover_count; ++i) {
        measure_rest(look, &world->movers[i], now);
    }
    for (size_t i = 0; i < world->pair_count; ++i) {
        measure_pair(look, &world->pairs[i], now);
    }
    while (look->input->slice >= curves->first + (curves->count + 1) * curves->slices) {
        close_bin(curves, world->least, now);
    }
    begin_bin(world, now);
}
