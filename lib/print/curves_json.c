/* The JSON report's curves of the smallest gaps. */
#include "record_json_internal.h"

/* The smallest gap in each bin, by the time at which it ends; null where it was wider than what is kept. */
static json_t *curve(wh_json_writer_t *writer, size_t kind) {
    const wh_curves_t *curves = wh_json_record(writer)->curves;
    const int64_t slice_us = wh_json_record(writer)->layout->slice_us;
    json_t *object = json_object();
    json_t *times = json_array();
    json_t *gaps = json_array();
    for (size_t bin = 0; bin < curves->count; ++bin) {
        const int64_t slice = (int64_t)(curves->first + (bin + 1) * curves->slices);
        const wh_real_t gap = curves->gaps[kind][bin];
        wh_json_append(writer, times, wh_json_real((double)(slice * slice_us) / 1e6));
        wh_json_append(writer, gaps, gap < WH_CLEARANCE_RANGE ? wh_json_real((double)gap) : json_null());
    }
    wh_json_put(writer, object, "kind", json_string(wh_clearance_name((wh_clearance_kind_t)kind)));
    wh_json_put(writer, object, "times_s", times);
    wh_json_put(writer, object, "gaps", gaps);
    return object;
}

void wh_json_put_curves(wh_json_writer_t *writer, json_t *root) {
    json_t *list = json_array();
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        if (wh_json_record(writer)->clearances[kind].parts[0] != WH_NONE) {
            wh_json_append(writer, list, curve(writer, kind));
        }
    }
    wh_json_put(writer, root, "clearance_curves", list);
}
