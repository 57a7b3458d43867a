/* The document's tracks: all that changes over time. */
#include <math.h>

#include "document_internal.h"

/* With so many decimals rounding adds at most a hundredth of what thinning leaves. A slope's error counts for
 * up to 4 s. */
enum { DECIMALS_S = 6, DECIMALS_OWN_MM = 4, DECIMALS_OWN = 6 };

typedef struct {
    int value, slope;
} decimals_t;

static const decimals_t decimals_mm = {4, 3};
static const decimals_t decimals_rad = {7, 6};
static const decimals_t decimals_level = {5, 4};
static const decimals_t decimals_measure[WH_MEASURES] = {{6, 5}, {4, 3}, {9, 9}};

static bool is_rad(size_t axis) {
    return axis != WH_AXIS_R && axis != WH_AXIS_Z;
}

/* ----------------------------------------------------------------------------------------------- thinning */

typedef struct {
    double mm, rad, own_mm, own_rad, vacuum, measured[WH_MEASURES];
    int64_t of, kept;
} sums_t;

static void count(sums_t *sums, const wh_path_t *curve, double *tolerance) {
    sums->of += curve->of;
    sums->kept += (int64_t)curve->list.count;
    *tolerance = fmax(curve->list.tolerance, *tolerance);
}

static sums_t sum_up(const wh_signals_t *signals) {
    sums_t sums = {0};
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        const wh_thin_t *own = &signals->own[g];
        count(&sums, &signals->vacuum[g], &sums.vacuum);
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            count(&sums, &signals->proximity[g][m], &sums.measured[m]);
        }
        sums.of += own->of;
        sums.kept += (int64_t)own->list.count;
        if (own->list.count > 0) {
            sums.own_mm = fmax(own->list.tolerance, sums.own_mm);
            sums.own_rad = fmax(own->turn, sums.own_rad);
        }
    }
    for (size_t axis = 0; axis < signals->axis_count; ++axis) {
        count(&sums, &signals->axes[axis], is_rad(axis) ? &sums.rad : &sums.mm);
    }
    return sums;
}

/* The greatest distance between a gripper's origin and where its axes' curves put it: R and Z off, and theta
 * off at the robot's full reach. */
static double gripper_mm(const wh_signals_t *signals, const sums_t *sums) {
    double reach = signals->layout->machine.robot.travel[WH_AXIS_R].max;
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        const wh_mount_t *mount = &signals->layout->machine.mounts[g];
        reach += mount->is_shifted ? wh_vec3_norm(&mount->effector_from_gripper.r) : 0;
    }
    const double across = sums->mm + reach * sums->rad;
    return fmax(sqrt(across * across + sums->mm * sums->mm), sums->own_mm);
}

/* The tolerance as it is told: with what rounding adds. */
static void put_tolerance(wh_json_text_t *text, const char *key, double thinned) {
    wh_json_text_number(text, key, thinned / WH_SIGNALS_SHARE, 9, false);
}

void wh_document_put_thinning(wh_json_text_t *text, const wh_signals_t *signals) {
    const sums_t sums = sum_up(signals);
    wh_json_text_begin(text, "thinning", '{');
    put_tolerance(text, "mm", sums.mm);
    put_tolerance(text, "rad", sums.rad);
    put_tolerance(text, "gripper_mm", gripper_mm(signals, &sums));
    put_tolerance(text, "gripper_rad", fmax(2 * sums.rad, sums.own_rad));
    put_tolerance(text, "vacuum", sums.vacuum);
    /* Twice: points that are inserted may take as much again. */
    put_tolerance(text, "projz", 2 * sums.measured[WH_MEASURE_PROJZ]);
    put_tolerance(text, "projxy", 2 * sums.measured[WH_MEASURE_PROJXY]);
    put_tolerance(text, "planar", 2 * sums.measured[WH_MEASURE_PLANAR]);
    wh_json_text_integer(text, "of", sums.of);
    wh_json_text_integer(text, "kept", sums.kept);
    wh_json_text_end(text, '}');
}

/* ------------------------------------------------------------------------------------------------- curves */

static void put_second(wh_json_text_t *text, const char *key, const wh_signals_t *signals, int64_t slice) {
    wh_json_text_number(text, key, wh_document_seconds(signals, slice), DECIMALS_S, false);
}

/* Where a curve breaks off, a null stands one slice after its last point. */
static void put_times(wh_json_text_t *text, const wh_signals_t *signals, const wh_points_t *list) {
    wh_json_text_begin(text, "t", '[');
    for (size_t i = 0; i < list->count; ++i) {
        put_second(text, NULL, signals, list->points[i].slice);
        if (list->points[i].ends) {
            put_second(text, NULL, signals, list->points[i].slice + 1);
        }
    }
    wh_json_text_end(text, ']');
}

/* Some of each point's numbers, `count` from `first` on, times `scale`. */
typedef struct {
    const char *key;
    size_t first, count;
    double scale;
    int decimals;
    bool exact; /* as the points are; else always rounded */
} column_t;

static void put_numbers(wh_json_text_t *text, const wh_points_t *list, const column_t *of) {
    wh_json_text_begin(text, of->key, '[');
    for (size_t i = 0; i < list->count; ++i) {
        const double *numbers = wh_points_numbers(list, i) + of->first;
        for (size_t k = 0; k < of->count; ++k) {
            wh_json_text_number(text, NULL, numbers[k] * of->scale, of->decimals,
                                of->exact && list->points[i].exact);
        }
        if (list->points[i].ends) {
            wh_document_put_index(text, NULL, WH_NONE);
        }
    }
    wh_json_text_end(text, ']');
}

static void put_curve(wh_json_text_t *text, const wh_signals_t *signals, const char *key,
                      const wh_path_t *curve, decimals_t decimals) {
    const double slices_a_second = 1e6 / (double)signals->layout->slice_us;
    const column_t values = {"v", 0, 1, 1, decimals.value, true};
    const column_t slopes = {"slope", 1, 1, slices_a_second, decimals.slope, false};
    wh_json_text_begin(text, key, '{');
    put_times(text, signals, &curve->list);
    put_numbers(text, &curve->list, &values);
    put_numbers(text, &curve->list, &slopes);
    wh_json_text_end(text, '}');
}

static void put_axis(wh_json_text_t *text, const wh_document_t *document, size_t axis) {
    const wh_path_t *curve = &document->signals->axes[axis];
    put_curve(text, document->signals, NULL, curve, is_rad(axis) ? decimals_rad : decimals_mm);
}

/* ---------------------------------------------------------------------------------------------- own poses */

static void put_own(wh_json_text_t *text, const wh_document_t *document, size_t g) {
    static const column_t places = {"r", 0, 3, 1, DECIMALS_OWN_MM, true};
    static const column_t turns = {"q", 3, 4, 1, DECIMALS_OWN, true};
    const wh_points_t *own = &document->signals->own[g].list;
    wh_json_text_begin(text, NULL, '{');
    put_times(text, document->signals, own);
    put_numbers(text, own, &places);
    put_numbers(text, own, &turns);
    wh_json_text_end(text, '}');
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void put_stay(wh_json_text_t *text, const wh_signals_t *signals, const wh_stay_t *stay) {
    wh_json_text_begin(text, NULL, '{');
    put_second(text, "t", signals, stay->slice);
    wh_document_put_index(text, "holder", stay->holder);
    wh_document_put_pose(text, &stay->pose);
    wh_json_text_end(text, '}');
}

/* The list of stays is sorted by time alone. Looking through it for each wafer costs less than writing it. */
static void put_wafer(wh_json_text_t *text, const wh_document_t *document, size_t w) {
    const wh_signals_t *signals = document->signals;
    wh_json_text_begin(text, NULL, '[');
    for (size_t i = 0; i < signals->stay_count; ++i) {
        if (signals->stays[i].wafer == (int32_t)w) {
            put_stay(text, signals, &signals->stays[i]);
        }
    }
    wh_json_text_end(text, ']');
}

/* ------------------------------------------------------------------------------------------------ signals */

/* WH_NONE is null. */
static void put_steps(wh_json_text_t *text, const wh_signals_t *signals, const char *key,
                      const wh_steps_t lists[]) {
    wh_json_text_begin(text, key, '[');
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        wh_json_text_begin(text, NULL, '{');
        wh_json_text_begin(text, "t", '[');
        for (size_t i = 0; i < lists[g].count; ++i) {
            put_second(text, NULL, signals, lists[g].steps[i].slice);
        }
        wh_json_text_end(text, ']');
        wh_json_text_begin(text, "v", '[');
        for (size_t i = 0; i < lists[g].count; ++i) {
            wh_document_put_index(text, NULL, lists[g].steps[i].value);
        }
        wh_json_text_end(text, ']');
        wh_json_text_end(text, '}');
    }
    wh_json_text_end(text, ']');
}

static void put_vacuum(wh_json_text_t *text, const wh_document_t *document, size_t g) {
    put_curve(text, document->signals, NULL, &document->signals->vacuum[g], decimals_level);
}

static void put_proximity(wh_json_text_t *text, const wh_document_t *document, size_t g) {
    static const char *const names[WH_MEASURES] = {"dr_proj_z", "dr_proj_xy", "n1_proj_n2"};
    const wh_path_t *curves = document->signals->proximity[g];
    wh_json_text_begin(text, NULL, '{');
    for (size_t m = 0; m < WH_MEASURES; ++m) {
        put_curve(text, document->signals, names[m], &curves[m], decimals_measure[m]);
    }
    wh_json_text_end(text, '}');
}

/* --------------------------------------------------------------------------------------------- clearances */

/* Nothing of a pair that never came near. */
static void put_clearance(wh_json_text_t *text, const wh_document_t *document, size_t kind) {
    if (document->record->clearances[kind].parts[0] == WH_NONE) {
        return;
    }
    const wh_curves_t *curves = document->record->curves;
    const wh_signals_t *signals = document->signals;
    const double limit = (double)signals->layout->world.limits[kind];
    wh_json_text_begin(text, NULL, '{');
    wh_json_text_string(text, "pair", wh_clearance_name((wh_clearance_kind_t)kind));
    wh_json_text_number(text, "limit", limit > 0 ? limit : HUGE_VAL, 0, true);
    wh_json_text_begin(text, "t", '[');
    for (size_t bin = 0; bin < curves->count; ++bin) {
        put_second(text, NULL, signals, (int64_t)(curves->first + (bin + 1) * curves->slices));
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

void wh_document_put_tracks(wh_json_text_t *text, const wh_document_t *document) {
    const wh_signals_t *signals = document->signals;
    const size_t grippers = signals->layout->machine.gripper_count;
    const bool has_gaps = document->record->checked && document->record->curves;
    wh_json_text_begin(text, "tracks", '{');
    wh_document_put_each(text, document, "axes", signals->axis_count, put_axis);
    wh_document_put_each(text, document, "grippers", grippers, put_own);
    wh_document_put_each(text, document, "wafers", signals->layout->wafer_count, put_wafer);
    put_steps(text, signals, "valves", signals->valves);
    put_steps(text, signals, "sensors", signals->sensors);
    put_steps(text, signals, "nearest", signals->nearest);
    wh_document_put_each(text, document, "vacuum", grippers, put_vacuum);
    wh_document_put_each(text, document, "proximity", grippers, put_proximity);
    wh_document_put_each(text, document, "clearances", has_gaps ? WH_CLEARANCES : 0, put_clearance);
    wh_json_text_end(text, '}');
}
