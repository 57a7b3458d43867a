#include "paces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "crew.h"

static bool refuse_paces(const wh_paces_t *paces, const char *why) {
    fprintf(stderr, "%s: %s\n", paces->run.script, why);
    return false;
}

/* Takes over the numbers, which are the row's then. */
static void add_pace(wh_paces_t *paces, const wh_layout_t *layout, size_t *which, size_t count) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = wh_memory_need(open_memstream(&text, &size));
    for (size_t i = 0; i < count; ++i) {
        char name[WH_LAYOUT_PACED_BYTES];
        wh_layout_name_paced(layout, which[i], name);
        fprintf(out, "%s%s", i > 0 ? " + " : "", name);
    }
    (void)fclose(out);
    paces->paces = wh_array_grow(paces->paces, paces->count, &paces->capacity, sizeof *paces->paces);
    paces->paces[paces->count++] = (wh_paced_run_t){
        .name = text, .which = which, .which_count = count, .point = {.verdict = WH_SWEEP_UNDONE}};
}

static bool is_known(const wh_paces_t *paces, const size_t which[], size_t count) {
    bool known = false;
    for (size_t i = 0; i < paces->count; ++i) {
        known = known || (paces->paces[i].which_count == count &&
                          memcmp(paces->paces[i].which, which, count * sizeof *which) == 0);
    }
    return known;
}

/* The parallel stations of a step that take time, in the order of the cell, if there are several. */
static void add_step(wh_paces_t *paces, const wh_layout_t *layout, const wh_flow_step_t *step) {
    const size_t stations = layout->tool ? layout->tool->station_count : layout->station_count;
    size_t *which = wh_array_new(step->station_count + 1, sizeof *which), count = 0;
    for (size_t s = 0; s < stations; ++s) {
        const size_t number =
            wh_flow_step_has(step, (int32_t)s) ? wh_layout_paced_station(layout, s) : SIZE_MAX;
        if (number != SIZE_MAX) {
            which[count++] = number;
        }
    }
    if (count > 1 && !is_known(paces, which, count)) {
        add_pace(paces, layout, which, count);
    } else {
        free(which);
    }
}

static void add_all(wh_paces_t *paces, const wh_record_t *record) {
    const wh_layout_t *layout = record->layout;
    const wh_flow_plan_t *plan = record->flow ? &record->flow->plan : NULL;
    const size_t count = layout ? wh_layout_paced(layout) : 0;
    for (size_t i = 0; i < count; ++i) {
        size_t *which = wh_array_new(1, sizeof *which);
        which[0] = i;
        add_pace(paces, layout, which, 1);
    }
    for (size_t r = 0; layout && plan && r < plan->route_count; ++r) {
        for (size_t k = 1; k < plan->routes[r].step_count; ++k) {
            add_step(paces, layout, &plan->routes[r].steps[k]);
        }
    }
}

/* The run as it is tells which mechanisms and stations there are, and which of them are parallel. */
static bool play_base(wh_paces_t *paces) {
    wh_script_run_t *run = wh_array_new(1, sizeof *run);
    wh_sweep_point_play(&paces->run, run, &paces->base);
    add_all(paces, &run->record);
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
    options.faster = paces->paces[i].which;
    options.faster_count = paces->paces[i].which_count;
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
        free(paces->paces[i].name);
        free(paces->paces[i].which);
    }
    free(paces->paces);
}
