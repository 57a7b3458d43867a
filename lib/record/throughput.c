#include "throughput.h"

#include <stdlib.h>

#include "../text/array.h"

static wh_rank_t rank_of(const wh_record_t *record, const wh_put_record_t *put) {
    const wh_layout_station_t *station = &record->layout->stations[put->station];
    if (station->prealigner) {
        return WH_RANK_PREALIGNER;
    }
    if (station->foup) {
        return WH_RANK_FOUP;
    }
    return record->layout->places[put->station].slots > 1 ? WH_RANK_SEVERAL : WH_RANK_SINGLE;
}

static wh_rank_t highest_rank(const wh_record_t *record) {
    wh_rank_t highest = WH_RANK_NONE;
    for (size_t i = 0; i < record->put_count; ++i) {
        const wh_rank_t rank = rank_of(record, &record->puts[i]);
        highest = rank > highest ? rank : highest;
    }
    return highest;
}

size_t *wh_throughput_cycle_wafers(const wh_record_t *record, wh_rank_t rank) {
    size_t *wafers = wh_array_new(record->cycle_count, sizeof *wafers);
    /* By wafer: 1 + the last cycle in which it counted. */
    size_t *counted = wh_array_new(record->layout ? record->layout->wafer_count : 0, sizeof *counted);
    size_t after = 0; /* how many cycles have begun */
    for (size_t i = 0; i < record->put_count; ++i) {
        const wh_put_record_t *put = &record->puts[i];
        while (after < record->cycle_count && record->cycles[after].begin < put->slice) {
            ++after;
        }
        if (after > 0 && rank_of(record, put) == rank && counted[put->wafer] != after) {
            counted[put->wafer] = after;
            ++wafers[after - 1];
        }
    }
    free(counted);
    return wafers;
}

int64_t wh_throughput_cycle_end(const wh_record_t *record, size_t cycle) {
    return cycle + 1 < record->cycle_count ? record->cycles[cycle + 1].begin : record->slices;
}

double wh_throughput_seconds(const wh_record_t *record, int64_t slices) {
    return record->layout ? (double)(slices * record->layout->slice_us) / 1e6 : 0;
}

static int64_t cycle_slices(const wh_record_t *record, size_t cycle) {
    return wh_throughput_cycle_end(record, cycle) - record->cycles[cycle].begin;
}

/* Counts from the second cycle on, or the first if there is no other; cycles without a slice are none. */
static void count_cycles(const wh_record_t *record, wh_throughput_t *throughput) {
    size_t *wafers = wh_throughput_cycle_wafers(record, throughput->rank);
    bool settling = true;
    for (size_t i = 0; i < record->cycle_count; ++i) {
        if (cycle_slices(record, i) == 0) {
            continue;
        }
        if (settling && throughput->first != 0) {
            settling = false;
            throughput->wafers = 0;
            throughput->slices = 0;
            throughput->first = 0;
        }
        throughput->first = throughput->first == 0 ? i + 1 : throughput->first;
        throughput->last = i + 1;
        throughput->wafers += wafers[i];
        throughput->slices += cycle_slices(record, i);
    }
    free(wafers);
}

static void count_run(const wh_record_t *record, wh_throughput_t *throughput) {
    for (size_t i = 0; i < record->put_count; ++i) {
        throughput->wafers += rank_of(record, &record->puts[i]) == throughput->rank ? 1 : 0;
    }
    throughput->slices = record->slices;
}

wh_throughput_t wh_throughput(const wh_record_t *record) {
    wh_throughput_t throughput = {WH_RANK_NONE, 0, 0, 0, 0, 0, 0, 0};
    if (!record->layout) {
        return throughput;
    }
    throughput.rank = highest_rank(record);
    throughput.puts = record->put_count;
    count_cycles(record, &throughput);
    if (throughput.first == 0) {
        count_run(record, &throughput);
    }
    throughput.seconds = wh_throughput_seconds(record, throughput.slices);
    if (throughput.slices > 0) {
        throughput.wafers_per_hour = 3600 * (double)throughput.wafers / throughput.seconds;
    }
    return throughput;
}

const char *wh_throughput_rule(wh_rank_t rank) {
    static const char *const texts[] = {
        [WH_RANK_NONE] = NULL,
        [WH_RANK_PREALIGNER] = "puts onto prealigners",
        [WH_RANK_SINGLE] = "puts into stations with one slot",
        [WH_RANK_SEVERAL] = "puts into stations with several slots",
        [WH_RANK_FOUP] = "puts into FOUPs",
    };
    return texts[rank];
}
