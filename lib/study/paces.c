#include "paces.h"

#include <math.h>
#include <stdlib.h>

#include "../text/array.h"
#include "crew.h"

static bool refuse_paces(const wh_paces_t *paces, const char *why) {
    fprintf(stderr, "%s: %s\n", paces->run.script, why);
    return false;
}

/* The run as it is tells which mechanisms and stations there are. */
static bool play_base(wh_paces_t *paces) {
    wh_script_run_t *run = wh_array_new(1, sizeof *run);
    wh_sweep_point_play(&paces->run, run, &paces->base);
    const wh_layout_t *layout = run->record.layout;
    paces->count = layout ? wh_layout_paced(layout) : 0;
    paces->paces = wh_array_new(paces->count, sizeof *paces->paces);
    for (size_t i = 0; i < paces->count; ++i) {
        wh_layout_name_paced(layout, i, paces->paces[i].name);
        paces->paces[i].point.verdict = WH_SWEEP_UNDONE;
    }
    wh_script_run_close(run);
    free(run);
    if (paces->base.verdict == WH_SWEEP_BAD) {
        fprintf(stderr, "%s\n", paces->base.reason);
        return false;
    }
    return paces->count > 0 || refuse_paces(paces, "nothing of its cell could be faster");
}

static void play(void *user, size_t i, wh_script_run_t *run) {
    wh_paces_t *paces = user;
    wh_script_run_options_t options = paces->run;
    options.faster = i + 1;
    options.faster_share = paces->share;
    wh_sweep_point_play(&options, run, &paces->paces[i].point);
    wh_script_run_close(run);
}

static double gain_of(const wh_sweep_point_t *base, const wh_sweep_point_t *point) {
    if (base->verdict != WH_SWEEP_OK || point->verdict != WH_SWEEP_OK) {
        return HUGE_VAL;
    }
    return isfinite(base->wafers_per_hour) && isfinite(point->wafers_per_hour)
               ? point->wafers_per_hour / base->wafers_per_hour - 1
               : base->simulated_s / point->simulated_s - 1;
}

/* Infinite gains are none. */
static bool comes_before(const wh_paced_run_t *a, const wh_paced_run_t *b) {
    return isfinite(a->gain) && (!isfinite(b->gain) || a->gain > b->gain);
}

/* Equal gains stay in the order of the cell. */
static void sort(wh_paces_t *paces) {
    for (size_t i = 1; i < paces->count; ++i) {
        const wh_paced_run_t one = paces->paces[i];
        size_t at = i;
        while (at > 0 && comes_before(&one, &paces->paces[at - 1])) {
            paces->paces[at] = paces->paces[at - 1];
            --at;
        }
        paces->paces[at] = one;
    }
}

bool wh_paces_play(wh_paces_t *paces, size_t threads) {
    if (!play_base(paces) || !wh_crew_play(paces->count, threads, play, paces)) {
        return false;
    }
    for (size_t i = 0; i < paces->count; ++i) {
        paces->paces[i].gain = gain_of(&paces->base, &paces->paces[i].point);
    }
    sort(paces);
    return true;
}

void wh_paces_close(wh_paces_t *paces) {
    wh_sweep_point_free(&paces->base);
    for (size_t i = 0; paces->paces && i < paces->count; ++i) {
        wh_sweep_point_free(&paces->paces[i].point);
    }
    free(paces->paces);
}
