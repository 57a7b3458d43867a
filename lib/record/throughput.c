#include "throughput.h"

#include <stdlib.h>

#include "../text/array.h"

static bool does_count(const wh_record_t *record, const wh_put_record_t *put) {
    return record->layout->stations[put->station].counts;
}

/* For each wafer: 1 + the last cycle in which a put counted that is no row any more; 0 without one. */
static size_t *counted_before(const wh_record_t *record) {
    const size_t wafers = record->layout ? record->layout->wafer_count : 0;
    size_t *counted = wh_array_new(wafers, sizeof *counted);
    for (size_t w = 0; record->dropped.puts_of && w < wafers; ++w) {
        counted[w] = record->dropped.puts_of[w].cycle;
    }
    return counted;
}

size_t *wh_throughput_cycle_wafers(const wh_record_t *record) {
    size_t *wafers = wh_array_new(record->cycle_count, sizeof *wafers), *counted = counted_before(record);
    size_t after = 0; /* the number of cycles that have begun */
    for (size_t i = 0; i < record->cycle_count; ++i) {
        wafers[i] = record->cycles[i].wafers;
    }
    for (size_t i = 0; i < record->put_count; ++i) {
        const wh_put_record_t *put = &record->puts[i];
        while (after < record->cycle_count && record->cycles[after].begin < put->slice) {
            ++after;
        }
        if (after > 0 && does_count(record, put) && counted[put->wafer] != after) {
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

/* Counts from the second cycle on, or the first if it is the only one; cycles without a slice do not
 * count. */
static void count_cycles(const wh_record_t *record, wh_throughput_t *throughput) {
    size_t *wafers = wh_throughput_cycle_wafers(record);
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

static bool counts_anywhere(const wh_layout_t *layout) {
    bool counts = false;
    for (size_t s = 0; s < layout->station_count; ++s) {
        counts = counts || layout->stations[s].counts;
    }
    return counts;
}

/* True if a wafer was put twice at places where puts count. */
static bool is_put_twice(const wh_record_t *record) {
    bool *seen = wh_array_new(record->layout->wafer_count, sizeof *seen);
    bool twice = record->dropped.is_twice;
    for (size_t w = 0; record->dropped.puts_of && w < record->layout->wafer_count; ++w) {
        seen[w] = record->dropped.puts_of[w].is_put;
    }
    for (size_t i = 0; i < record->put_count; ++i) {
        const wh_put_record_t *put = &record->puts[i];
        if (does_count(record, put)) {
            twice = twice || seen[put->wafer];
            seen[put->wafer] = true;
        }
    }
    free(seen);
    return twice;
}

static wh_figure_t judge_rate(const wh_record_t *record, const wh_throughput_t *throughput) {
    const bool stands[] = {[WH_FIGURE_PARTIAL] = record->is_partial,
                           [WH_FIGURE_UNTOLD] = record->is_untold,
                           [WH_FIGURE_FAILED] = !record->ok,
                           [WH_FIGURE_ALONE] = (record->layout->timed && (record->flow || record->log)) ||
                                               (record->layout->tool && record->flow),
                           [WH_FIGURE_NO_TIME] = throughput->slices == 0,
                           [WH_FIGURE_NOWHERE] = !counts_anywhere(record->layout),
                           [WH_FIGURE_NO_WAFER] = throughput->wafers == 0,
                           [WH_FIGURE_TWICE] = throughput->first == 0 && is_put_twice(record)};
    size_t reason = 0;
    while (reason < sizeof stands && !stands[reason]) {
        ++reason;
    }
    return reason < sizeof stands ? (wh_figure_t)reason : WH_FIGURE_GIVEN;
}

wh_throughput_t wh_throughput(const wh_record_t *record) {
    wh_throughput_t throughput = {WH_FIGURE_NO_CELL, 0, 0, 0, 0, 0, 0, 0};
    if (!record->layout) {
        return throughput;
    }
    throughput.puts = record->dropped.puts + record->put_count;
    count_cycles(record, &throughput);
    if (throughput.first == 0) {
        throughput.slices = record->slices;
        throughput.wafers = record->dropped.wafers;
        for (size_t i = 0; i < record->put_count; ++i) {
            throughput.wafers += does_count(record, &record->puts[i]) ? 1 : 0;
        }
    }
    throughput.seconds = wh_throughput_seconds(record, throughput.slices);
    throughput.figure = judge_rate(record, &throughput);
    if (throughput.figure == WH_FIGURE_GIVEN) {
        throughput.wafers_per_hour = 3600 * (double)throughput.wafers / throughput.seconds;
    }
    return throughput;
}

const char *wh_throughput_reason(wh_figure_t figure) {
    static const char *const texts[] = {
        [WH_FIGURE_GIVEN] = NULL,
        [WH_FIGURE_NO_CELL] = "there is no cell",
        [WH_FIGURE_PARTIAL] = "the log has not the whole run as it was",
        [WH_FIGURE_UNTOLD] = "the log does not tell if the run passed",
        [WH_FIGURE_FAILED] = "the run failed",
        [WH_FIGURE_ALONE] = "robots that are times alone carry wafers, too; the flow tells its own rate",
        [WH_FIGURE_NO_TIME] = "nothing moved",
        [WH_FIGURE_NOWHERE] = "no station is known to count",
        [WH_FIGURE_NO_WAFER] = "no wafer was put into a station that counts",
        [WH_FIGURE_TWICE] =
            "a wafer was put twice into stations that count, and no cycle() says when one is over",
    };
    return texts[figure];
}
