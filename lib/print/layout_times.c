/* The stations of a layout that take time: as a table, and as JSON. */
#include "layout_times.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../layout/times.h"
#include "../text/json.h"

/* s; infinite: there is none. */
static double seconds(int64_t us) {
    return us == WH_FLOW_NEVER ? HUGE_VAL : (double)us / 1e6;
}

/* --------------------------------------------------------------------------------------------- as a table */

/* ", oxide 75, nitride 50": what goes by recipe, where it differs from the usual. */
static void say_recipes(const wh_layout_t *layout, const wh_flow_station_t *of,
                        double (*get)(const wh_flow_treatment_t *), char text[], size_t size) {
    const wh_flow_treatment_t usual = wh_flow_treatment(of, 0);
    size_t used = strlen(text);
    for (int32_t i = 0; of->has_recipes && i < layout->recipes->count && used < size; ++i) {
        const double value = get(&of->by_recipe[i]);
        if (value != get(&usual)) {
            used +=
                (size_t)snprintf(text + used, size - used, ", %s %.10g", layout->recipes->names[i], value);
        }
    }
}

static double process_of(const wh_flow_treatment_t *treatment) {
    return seconds(treatment->process_us);
}

static double after_of(const wh_flow_treatment_t *treatment) {
    return treatment->clean_after;
}

static double idle_of(const wh_flow_treatment_t *treatment) {
    return seconds(treatment->idle_us);
}

static void put_process(const wh_layout_t *layout, wh_grid_t *grid, const wh_flow_station_t *of) {
    char text[300];
    (void)snprintf(text, sizeof text, "%.10g", seconds(of->process_us));
    if (!of->has_recipes && of->process_us > 0) {
        wh_grid_number(grid, 1, WH_INK_PLAIN, seconds(of->process_us));
    } else if (wh_flow_is_processing(of)) {
        say_recipes(layout, of, process_of, text, sizeof text);
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", text);
    }
}

static void put_clean(const wh_layout_t *layout, wh_grid_t *grid, size_t column,
                      const wh_flow_station_t *of) {
    char when[500] = "";
    if (of->clean_after > 0) {
        (void)snprintf(when, sizeof when, "after %d wafer%s", (int)of->clean_after,
                       of->clean_after == 1 ? "" : "s");
        say_recipes(layout, of, after_of, when, sizeof when);
    }
    if (of->idle_us != WH_FLOW_NEVER) {
        const size_t length = strlen(when);
        (void)snprintf(when + length, sizeof when - length, "%safter %.10g s without", length > 0 ? ", " : "",
                       seconds(of->idle_us));
        say_recipes(layout, of, idle_of, when, sizeof when);
    }
    if (of->clean_us > 0) {
        wh_grid_text(grid, column, WH_INK_PLAIN, "%.10g s %s%s", seconds(of->clean_us), when,
                     of->cleans_full ? ", around the last one" : "");
    }
}

static void put_pump(wh_grid_t *grid, size_t column, const wh_flow_station_t *of) {
    if (of->is_lock) {
        wh_grid_text(grid, column, WH_INK_PLAIN, "down %.10g s, up %.10g s; empty %.10g and %.10g s",
                     seconds(of->pump_us[WH_FLOW_VACUUM]), seconds(of->pump_us[WH_FLOW_ATMOSPHERE]),
                     seconds(of->empty_pump_us[WH_FLOW_VACUUM]),
                     seconds(of->empty_pump_us[WH_FLOW_ATMOSPHERE]));
        wh_grid_text(grid, column + 1, WH_INK_PLAIN, "%s", wh_flow_side_words[of->side]);
    }
}

void wh_layout_times_fill(const wh_layout_t *layout, wh_grid_t *grid) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_layout_times_t *times = layout->stations[s].times;
        if (!times) {
            continue;
        }
        wh_grid_named_row(grid, layout->stations[s].name);
        put_process(layout, grid, &times->of);
        if (times->of.window_us != WH_FLOW_NEVER) {
            wh_grid_number(grid, 2, WH_INK_PLAIN, seconds(times->of.window_us));
        }
        put_clean(layout, grid, 3, &times->of);
        put_pump(grid, 4, &times->of);
    }
}

/* ------------------------------------------------------------------------------------------------ as JSON */

static json_t *clean(const wh_flow_station_t *of) {
    return of->clean_us > 0 ? wh_json_set(json_object(), "after %lld idle %g seconds %g empty %i",
                                          of->clean_after > 0 ? (json_int_t)of->clean_after : WH_JSON_NONE,
                                          seconds(of->idle_us), seconds(of->clean_us), !of->cleans_full)
                            : json_null();
}

static json_t *pump(const wh_flow_station_t *of) {
    return of->is_lock
               ? wh_json_set(json_object(), "down %g up %g empty_down %g empty_up %g state %s",
                             seconds(of->pump_us[WH_FLOW_VACUUM]), seconds(of->pump_us[WH_FLOW_ATMOSPHERE]),
                             seconds(of->empty_pump_us[WH_FLOW_VACUUM]),
                             seconds(of->empty_pump_us[WH_FLOW_ATMOSPHERE]), wh_flow_side_words[of->side])
               : json_null();
}

/* By the names of recipes. */
static json_t *recipes(const wh_layout_t *layout, const wh_flow_station_t *of) {
    json_t *object = json_object();
    for (int32_t i = 0; i < layout->recipes->count; ++i) {
        const wh_flow_treatment_t *by = &of->by_recipe[i];
        wh_json_put(object, layout->recipes->names[i],
                    wh_json_set(json_object(), "process %g after %lld idle %g", seconds(by->process_us),
                                by->clean_after > 0 ? (json_int_t)by->clean_after : WH_JSON_NONE,
                                seconds(by->idle_us)));
    }
    return object;
}

json_t *wh_layout_times_to_json(const wh_layout_t *layout, const wh_layout_times_t *times) {
    json_t *object = wh_json_set(json_object(), "process %g window %g", seconds(times->of.process_us),
                                 seconds(times->of.window_us));
    if (times->of.has_recipes) {
        wh_json_put(object, "by_recipe", recipes(layout, &times->of));
    }
    return wh_json_add(object, "clean pump", clean(&times->of), pump(&times->of), NULL);
}
