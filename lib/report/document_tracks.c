/* The document's tracks and marks. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/document_internal.h"
#include "report/utf8.h"

/* Decimals that add a hundredth of what thinning leaves, or less. */
enum { DECIMALS_S = 6, DECIMALS_MM = 4, DECIMALS_RAD = 6, DECIMALS_SHARE = 5, DECIMALS_PLANAR = 9 };

static bool is_rad(size_t axis) {
    return axis != WH_AXIS_R && axis != WH_AXIS_Z;
}

/* ------------------------------------------------------------------------------------------------- thinning */

typedef struct {
    double mm, rad, link_mm, link_rad, mm_per_s, rad_per_s, vacuum, projz;
    int64_t of, kept;
} sums_t;

static void count(sums_t *sums, const wh_thin_t *thin, double *linear, double *turn) {
    sums->of += thin->of;
    sums->kept += (int64_t)thin->count;
    *linear = thin->tolerance > *linear ? thin->tolerance : *linear;
    if (turn) {
        *turn = thin->turn > *turn ? thin->turn : *turn;
    }
}

static sums_t sum_up(const wh_trace_t *trace) {
    sums_t sums = {0};
    for (size_t g = 0; g < trace->layout->machine.gripper_count; ++g) {
        count(&sums, &trace->grippers[g], &sums.mm, &sums.rad);
        count(&sums, &trace->vacuum[g], &sums.vacuum, NULL);
        count(&sums, &trace->proximity[g], &sums.projz, NULL);
    }
    for (size_t i = 0; i < WH_TRACE_LINKS; ++i) {
        count(&sums, &trace->links[i], &sums.link_mm, &sums.link_rad);
    }
    for (size_t axis = 0; axis < trace->axis_count; ++axis) {
        count(&sums, &trace->axes[axis], is_rad(axis) ? &sums.rad : &sums.mm, NULL);
        count(&sums, &trace->speeds[axis], is_rad(axis) ? &sums.rad_per_s : &sums.mm_per_s, NULL);
    }
    return sums;
}

/* What rounding adds, and the half that points which are inserted take. */
static void put_tolerance(wh_json_text_t *text, const char *key, double thinned) {
    wh_json_text_number(text, key, thinned / WH_TRACE_SHARE, 9, false);
}

void wh_document_put_thinning(wh_json_text_t *text, const wh_trace_t *trace) {
    const sums_t sums = sum_up(trace);
    wh_json_text_begin(text, "thinning", '{');
    put_tolerance(text, "mm", sums.mm);
    put_tolerance(text, "rad", sums.rad);
    put_tolerance(text, "mm_per_s", sums.mm_per_s);
    put_tolerance(text, "rad_per_s", sums.rad_per_s);
    put_tolerance(text, "vacuum", sums.vacuum);
    put_tolerance(text, "link_mm", sums.link_mm);
    put_tolerance(text, "link_rad", sums.link_rad);
    put_tolerance(text, "projz", 2 * sums.projz);
    put_tolerance(text, "projxy", 2 * sums.projz / WH_TRACE_PROJXY_SCALE);
    put_tolerance(text, "planar", 2 * sums.projz / WH_TRACE_PLANAR_SCALE);
    wh_json_text_integer(text, "of", sums.of);
    wh_json_text_integer(text, "kept", sums.kept);
    wh_json_text_end(text, '}');
}

/* -------------------------------------------------------------------------------------------------- tracks */

static void put_times(wh_json_text_t *text, const wh_trace_t *trace, const char *key, const wh_thin_t *thin) {
    wh_json_text_begin(text, key, '[');
    for (size_t i = 0; i < thin->count; ++i) {
        wh_json_text_number(text, NULL, wh_document_seconds(trace, thin->points[i].slice), DECIMALS_S, false);
    }
    wh_json_text_end(text, ']');
}

/* Numbers `first` to `first + width - 1` of each point, over `scale`; null where the point's tag is WH_NONE. */
static void put_values(wh_json_text_t *text, const char *key, const wh_thin_t *thin, size_t first,
                       size_t width, int decimals, double scale) {
    wh_json_text_begin(text, key, '[');
    for (size_t i = 0; i < thin->count; ++i) {
        const wh_thin_point_t *point = &thin->points[i];
        for (size_t k = first; k < first + width; ++k) {
            const double value = point->tag == WH_NONE ? HUGE_VAL : point->values[k] / scale;
            wh_json_text_number(text, NULL, value, decimals, point->exact);
        }
    }
    wh_json_text_end(text, ']');
}

static void put_poses(wh_json_text_t *text, const wh_trace_t *trace, const wh_thin_t *thin,
                      const char *name) {
    wh_json_text_begin(text, NULL, '{');
    if (name) {
        wh_json_text_string(text, "name", name);
    }
    put_times(text, trace, "t", thin);
    put_values(text, "r", thin, 0, 3, DECIMALS_MM, 1);
    put_values(text, "q", thin, 3, 4, DECIMALS_RAD, 1);
    wh_json_text_end(text, '}');
}

static void put_robot(wh_json_text_t *text, const wh_trace_t *trace) {
    static const char *const names[WH_TRACE_LINKS] = {"lift", "upper arm", "forearm", "hand"};
    wh_json_text_begin(text, "grippers", '[');
    for (size_t g = 0; g < trace->layout->machine.gripper_count; ++g) {
        put_poses(text, trace, &trace->grippers[g], NULL);
    }
    wh_json_text_end(text, ']');
    wh_json_text_begin(text, "links", '[');
    for (size_t i = 0; i < WH_TRACE_LINKS; ++i) {
        if (trace->links[i].count > 0) {
            put_poses(text, trace, &trace->links[i], names[i]);
        }
    }
    wh_json_text_end(text, ']');
    wh_json_text_begin(text, "axes", '[');
    for (size_t axis = 0; axis < trace->axis_count; ++axis) {
        wh_json_text_begin(text, NULL, '{');
        put_times(text, trace, "t", &trace->axes[axis]);
        put_values(text, "v", &trace->axes[axis], 0, 1, is_rad(axis) ? DECIMALS_RAD : DECIMALS_MM, 1);
        put_times(text, trace, "speed_t", &trace->speeds[axis]);
        put_values(text, "speed", &trace->speeds[axis], 0, 1, is_rad(axis) ? DECIMALS_RAD : DECIMALS_MM, 1);
        wh_json_text_end(text, '}');
    }
    wh_json_text_end(text, ']');
}

/* --------------------------------------------------------------------------------------------------- wafers */

static void put_stay(wh_json_text_t *text, const wh_trace_t *trace, const wh_stay_t *stay) {
    wh_json_text_begin(text, NULL, '{');
    wh_json_text_number(text, "t", wh_document_seconds(trace, stay->slice), DECIMALS_S, false);
    if (stay->holder == WH_NONE) {
        wh_json_text_value(text, "holder", json_null());
    } else {
        wh_json_text_integer(text, "holder", stay->holder);
    }
    wh_document_put_pose(text, &stay->pose);
    wh_json_text_end(text, '}');
}

/* Indices of the stays by wafer, each wafer's in order of time: the list holds them in order of time alone. */
static size_t *sort_stays(const wh_trace_t *trace, size_t *ends) {
    size_t *sorted = calloc(trace->stay_count + 1, sizeof *sorted);
    if (!sorted) {
        abort();
    }
    for (size_t i = 0; i < trace->stay_count; ++i) {
        ++ends[trace->stays[i].wafer];
    }
    for (size_t w = 1; w < trace->layout->wafer_count; ++w) {
        ends[w] += ends[w - 1];
    }
    for (size_t i = trace->stay_count; i > 0; --i) {
        sorted[--ends[trace->stays[i - 1].wafer]] = i - 1;
    }
    return sorted;
}

static void put_wafers(wh_json_text_t *text, const wh_trace_t *trace) {
    const size_t wafers = trace->layout->wafer_count;
    size_t *begins = calloc(wafers + 1, sizeof *begins);
    if (!begins) {
        abort();
    }
    size_t *sorted = sort_stays(trace, begins);
    begins[wafers] = trace->stay_count;
    wh_json_text_begin(text, "wafers", '[');
    for (size_t w = 0; w < wafers; ++w) {
        wh_json_text_begin(text, NULL, '[');
        for (size_t i = begins[w]; i < begins[w + 1]; ++i) {
            put_stay(text, trace, &trace->stays[sorted[i]]);
        }
        wh_json_text_end(text, ']');
    }
    wh_json_text_end(text, ']');
    free(sorted);
    free(begins);
}

/* -------------------------------------------------------------------------------------------------- signals */

static void put_steps(wh_json_text_t *text, const wh_trace_t *trace, const char *key,
                      const wh_steps_t lists[]) {
    wh_json_text_begin(text, key, '[');
    for (size_t g = 0; g < trace->layout->machine.gripper_count; ++g) {
        wh_json_text_begin(text, NULL, '{');
        wh_json_text_begin(text, "t", '[');
        for (size_t i = 0; i < lists[g].count; ++i) {
            wh_json_text_number(text, NULL, wh_document_seconds(trace, lists[g].steps[i].slice), DECIMALS_S,
                                false);
        }
        wh_json_text_end(text, ']');
        wh_json_text_begin(text, "v", '[');
        for (size_t i = 0; i < lists[g].count; ++i) {
            wh_json_text_integer(text, NULL, lists[g].steps[i].value);
        }
        wh_json_text_end(text, ']');
        wh_json_text_end(text, '}');
    }
    wh_json_text_end(text, ']');
}

static void put_vacuum(wh_json_text_t *text, const wh_trace_t *trace) {
    wh_json_text_begin(text, "vacuum", '[');
    for (size_t g = 0; g < trace->layout->machine.gripper_count; ++g) {
        wh_json_text_begin(text, NULL, '{');
        put_times(text, trace, "t", &trace->vacuum[g]);
        put_values(text, "v", &trace->vacuum[g], 0, 1, DECIMALS_SHARE, 1);
        wh_json_text_end(text, '}');
    }
    wh_json_text_end(text, ']');
}

static void put_nearest(wh_json_text_t *text, const wh_thin_t *thin) {
    wh_json_text_begin(text, "wafer", '[');
    for (size_t i = 0; i < thin->count; ++i) {
        if (thin->points[i].tag == WH_NONE) {
            wh_json_text_value(text, NULL, json_null());
        } else {
            wh_json_text_integer(text, NULL, thin->points[i].tag);
        }
    }
    wh_json_text_end(text, ']');
}

static void put_proximity(wh_json_text_t *text, const wh_trace_t *trace) {
    wh_json_text_begin(text, "proximity", '[');
    for (size_t g = 0; g < trace->layout->machine.gripper_count; ++g) {
        const wh_thin_t *thin = &trace->proximity[g];
        wh_json_text_begin(text, NULL, '{');
        put_times(text, trace, "t", thin);
        put_nearest(text, thin);
        put_values(text, "dr_proj_z", thin, 0, 1, DECIMALS_RAD, 1);
        put_values(text, "dr_proj_xy", thin, 1, 1, DECIMALS_MM, WH_TRACE_PROJXY_SCALE);
        put_values(text, "n1_proj_n2", thin, 2, 1, DECIMALS_PLANAR, WH_TRACE_PLANAR_SCALE);
        wh_json_text_end(text, '}');
    }
    wh_json_text_end(text, ']');
}

/* ----------------------------------------------------------------------------------------------- clearances */

static void put_clearance(wh_json_text_t *text, const wh_document_t *document, size_t kind) {
    const wh_curves_t *curves = document->record->curves;
    const wh_trace_t *trace = document->trace;
    const double limit = (double)trace->layout->world.limits[kind];
    wh_json_text_begin(text, NULL, '{');
    wh_json_text_string(text, "pair", wh_clearance_name((wh_clearance_kind_t)kind));
    wh_json_text_number(text, "limit", limit > 0 ? limit : HUGE_VAL, 0, true);
    wh_json_text_begin(text, "t", '[');
    for (size_t bin = 0; bin < curves->count; ++bin) {
        const int64_t slice = (int64_t)(curves->first + (bin + 1) * curves->slices);
        wh_json_text_number(text, NULL, wh_document_seconds(trace, slice), DECIMALS_S, false);
    }
    wh_json_text_end(text, ']');
    wh_json_text_begin(text, "gap", '[');
    for (size_t bin = 0; bin < curves->count; ++bin) {
        const double gap = (double)curves->gaps[kind][bin];
        wh_json_text_number(text, NULL, gap < (double)WH_CLEARANCE_RANGE ? gap : HUGE_VAL, 0, true);
    }
    wh_json_text_end(text, ']');
    wh_json_text_end(text, '}');
}

static void put_clearances(wh_json_text_t *text, const wh_document_t *document) {
    const wh_record_t *record = document->record;
    wh_json_text_begin(text, "clearances", '[');
    for (size_t kind = 0; record->checked && record->curves && kind < WH_CLEARANCES; ++kind) {
        if (record->clearances[kind].parts[0] != WH_NONE) {
            put_clearance(text, document, kind);
        }
    }
    wh_json_text_end(text, ']');
}

void wh_document_put_tracks(wh_json_text_t *text, const wh_document_t *document) {
    const wh_trace_t *trace = document->trace;
    wh_json_text_begin(text, "tracks", '{');
    put_robot(text, trace);
    put_wafers(text, trace);
    put_steps(text, trace, "valves", trace->valves);
    put_steps(text, trace, "sensors", trace->sensors);
    put_vacuum(text, trace);
    put_proximity(text, trace);
    put_clearances(text, document);
    wh_json_text_end(text, '}');
}
