#include "flow_sums.h"

#include <math.h>
#include <stdlib.h>

#include "../flow/waits.h"

const char *const wh_flow_sum_names[] = {"makespan_s",    "cycle_s",    "per_hour", "robots_wait_s",
                                         "wafers_wait_s", "late_stays", NULL};

static double without_of(const double without[], wh_flow_sum_t figure) {
    return isnan(without[figure]) ? 0 : without[figure];
}

/* The time for a wafer, s; NaN: there is none. */
static double cycle_of(const wh_flow_result_t *result) {
    return result->period > 0    ? (double)result->cycle_us / 1e6 / result->period
           : result->mean_us > 0 ? result->mean_us / 1e6
                                 : (double)NAN;
}

/* Robots' waits have a cause; those of done wafers have none. */
static void read_waits(const wh_flow_figures_t *of, double figures[WH_FLOW_SUM_FIGURES]) {
    size_t count = 0;
    wh_flow_wait_t *waits = wh_flow_waits(of, &count);
    double robots_us = 0, wafers_us = 0;
    for (size_t i = 0; i < count; ++i) {
        double *const us = waits[i].cause ? &robots_us : &wafers_us;
        *us += waits[i].us;
    }
    free(waits);
    figures[WH_FLOW_SUM_ROBOTS_WAIT] = robots_us / 1e6;
    figures[WH_FLOW_SUM_WAFERS_WAIT] = wafers_us / 1e6;
}

bool wh_flow_sums_read(const wh_flow_t *flow, double figures[WH_FLOW_SUM_FIGURES]) {
    const wh_flow_result_t *result = flow && flow->figures.tool ? &flow->figures.result : NULL;
    for (int i = 0; i < WH_FLOW_SUM_FIGURES; ++i) {
        figures[i] = (double)NAN;
    }
    if (!result || (result->end != WH_FLOW_DONE && result->end != WH_FLOW_CUT)) {
        return false;
    }
    if (result->end == WH_FLOW_DONE && result->lost == 0) {
        figures[WH_FLOW_SUM_MAKESPAN] = (double)result->makespan_us / 1e6;
    }
    figures[WH_FLOW_SUM_CYCLE] = cycle_of(result);
    figures[WH_FLOW_SUM_PER_HOUR] = 3600 / figures[WH_FLOW_SUM_CYCLE];
    read_waits(&flow->figures, figures);
    figures[WH_FLOW_SUM_LATE] = (double)flow->figures.stays.late_count;
    return result->period > 0;
}

/* How long the process would be: a station of times alone has taken over what was drawn, and cut it off. */
static bool is_clipped(const wh_flow_step_t *step, const wh_flow_station_t *station, int32_t recipe,
                       int64_t drawn_us) {
    const int64_t us = wh_flow_step_us(step, station, recipe);
    return us > 0 && (station->off_us != 0 ? us <= 1 : us + drawn_us < 1);
}

bool wh_flow_sums_clips(const wh_flow_t *flow, size_t station, double drawn_s) {
    if (!flow || !flow->figures.tool || station >= flow->tool->station_count || !(drawn_s < 0)) {
        return false;
    }
    const wh_flow_station_t *of = &flow->tool->stations[station];
    for (int32_t w = 0; w < (int32_t)flow->plan.wafer_count; ++w) {
        const int32_t last = wh_flow_last_step(&flow->plan, w);
        for (int32_t k = 1; k <= last; ++k) {
            const wh_flow_step_t *step = wh_flow_step_of(&flow->plan, w, k);
            if (wh_flow_step_has(step, (int32_t)station) &&
                is_clipped(step, of, wh_flow_recipe_of(&flow->plan, w, k), llround(1e6 * drawn_s))) {
                return true;
            }
        }
    }
    return false;
}

double wh_flow_sums_aside(const double figures[], const double without[], wh_flow_sum_t figure) {
    return (figures[figure] - without_of(without, figure)) / WH_FLOW_SUM_SCALE;
}

void wh_flow_sums_add(wh_flow_sums_t *sums, const double figures[], const double without[], bool is_steady,
                      bool is_clipped_once) {
    ++sums->trials;
    sums->clipped += is_clipped_once ? 1 : 0;
    sums->unfinished += isnan(figures[WH_FLOW_SUM_MAKESPAN]) ? 1 : 0;
    sums->no_cycle += isnan(figures[WH_FLOW_SUM_CYCLE]) ? 1 : 0;
    sums->unsteady += !isnan(figures[WH_FLOW_SUM_CYCLE]) && !is_steady ? 1 : 0;
    for (int i = 0; i < WH_FLOW_SUM_FIGURES; ++i) {
        if (!isnan(figures[i])) {
            wh_sum_add(&sums->of[i], wh_flow_sums_aside(figures, without, (wh_flow_sum_t)i));
        }
    }
}

void wh_flow_sums_merge(wh_flow_sums_t *sums, const wh_flow_sums_t *other) {
    sums->trials += other->trials;
    sums->unfinished += other->unfinished;
    sums->unsteady += other->unsteady;
    sums->no_cycle += other->no_cycle;
    sums->clipped += other->clipped;
    for (int i = 0; i < WH_FLOW_SUM_FIGURES; ++i) {
        wh_sum_merge(&sums->of[i], &other->of[i]);
    }
}

wh_flow_spread_t wh_flow_sums_spread(const wh_flow_sums_t *sums, wh_flow_sum_t figure,
                                     const double without[]) {
    const wh_sum_t *of = &sums->of[figure];
    const double from = without_of(without, figure);
    return (wh_flow_spread_t){
        from + WH_FLOW_SUM_SCALE * wh_sum_mean(of), WH_FLOW_SUM_SCALE * wh_sum_deviation(of),
        from + WH_FLOW_SUM_SCALE * wh_sum_least(of), from + WH_FLOW_SUM_SCALE * wh_sum_most(of)};
}

double wh_flow_sums_quantile(const wh_flow_sums_t *sums, wh_flow_sum_t figure, const double without[],
                             uint32_t permille) {
    return without_of(without, figure) + WH_FLOW_SUM_SCALE * wh_sum_quantile(&sums->of[figure], permille);
}
