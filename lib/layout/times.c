#include "times.h"

#include "../math/hash.h"

bool wh_layout_takes_time(const wh_layout_t *layout) {
    bool is_any = false;
    for (size_t s = 0; s < layout->station_count; ++s) {
        is_any = is_any || layout->stations[s].times;
    }
    return is_any;
}

wh_flow_side_t wh_layout_side_of(const wh_layout_t *layout, size_t station, size_t robot) {
    const wh_layout_station_t *of = &layout->stations[station];
    if (!of->times || !of->times->of.is_lock) {
        return WH_FLOW_BOTH;
    }
    return of->by ? of->by[robot].side : of->times->side;
}

static uint64_t hash_times(uint64_t hash, const wh_layout_times_t *times) {
    const wh_flow_station_t *of = &times->of;
    const int64_t numbers[] = {of->process_us,      of->window_us,           of->clean_after,
                               of->clean_us,        of->cleans_full ? 1 : 0, of->idle_us,
                               of->is_lock ? 1 : 0, (int64_t)of->side,       of->pump_us[0],
                               of->pump_us[1],      of->empty_pump_us[0],    of->empty_pump_us[1],
                               times->doors,        times->side_doors[0],    times->side_doors[1],
                               (int64_t)times->side};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
        hash = wh_hash_word(hash, (uint64_t)numbers[i]);
    }
    return wh_flow_hash_recipes(of, hash);
}

/* Nothing if there are none. */
static uint64_t hash_recipes(const wh_layout_t *layout, uint64_t hash) {
    for (int32_t i = 0; layout->recipes && i < layout->recipes->count; ++i) {
        hash = wh_hash_text(hash, layout->recipes->names[i]);
    }
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        if (layout->wafers[w].recipe > 0) {
            hash = wh_hash_word(wh_hash_word(hash, w), (uint64_t)layout->wafers[w].recipe);
        }
    }
    return hash;
}

uint64_t wh_layout_hash_times(const wh_layout_t *layout, uint64_t hash) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_layout_station_t *station = &layout->stations[s];
        if (station->times) {
            hash = hash_times(wh_hash_word(wh_hash_text(hash, "times"), s), station->times);
        }
        for (size_t r = 0; station->times && station->by && r < layout->robot_count; ++r) {
            hash = wh_hash_int(hash, (int32_t)station->by[r].side);
        }
    }
    return hash_recipes(layout, hash);
}
