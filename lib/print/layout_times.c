/* The stations of a layout that take time: as a table, and as JSON. */
#include "layout_times.h"

#include <math.h>
#include <stdio.h>

#include "../layout/times.h"
#include "../text/json.h"

/* s; infinite: there is none. */
static double seconds(int64_t us) {
    return us == WH_FLOW_NEVER ? HUGE_VAL : (double)us / 1e6;
}

/* --------------------------------------------------------------------------------------------- as a table */

static void put_clean(wh_grid_t *grid, size_t column, const wh_flow_station_t *of) {
    char when[80] = "";
    int length = 0;
    if (of->clean_after > 0) {
        length = snprintf(when, sizeof when, "after %d wafer%s", (int)of->clean_after,
                          of->clean_after == 1 ? "" : "s");
    }
    if (of->idle_us != WH_FLOW_NEVER) {
        snprintf(when + length, sizeof when - (size_t)length, "%safter %.10g s without",
                 length > 0 ? ", " : "", seconds(of->idle_us));
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
        if (times->of.process_us > 0) {
            wh_grid_number(grid, 1, WH_INK_PLAIN, seconds(times->of.process_us));
        }
        if (times->of.window_us != WH_FLOW_NEVER) {
            wh_grid_number(grid, 2, WH_INK_PLAIN, seconds(times->of.window_us));
        }
        put_clean(grid, 3, &times->of);
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

json_t *wh_layout_times_to_json(const wh_layout_times_t *times) {
    json_t *object = wh_json_set(json_object(), "process %g window %g", seconds(times->of.process_us),
                                 seconds(times->of.window_us));
    return wh_json_add(object, "clean pump", clean(&times->of), pump(&times->of), NULL);
}
