/* The rows of a played run: their order, and the motions that they describe. */
#include "played_internal.h"

static bool is_motion(wh_played_kind_t kind) {
    return kind < WH_PLAYED_VALVES;
}

static bool begins(wh_played_kind_t kind) {
    return kind <= WH_PLAYED_VALVES || kind == WH_PLAYED_PLACE;
}

/* A row that goes on with the one that began last. */
static bool goes_on(wh_played_kind_t kind, wh_played_kind_t begun) {
    return is_motion(begun) || (begun == WH_PLAYED_PLACE && kind == WH_PLAYED_MORE);
}

/* A row that begins something does so within the run, not before the one before it. */
static bool is_in_time(const wh_played_t *run, const wh_played_row_t *row, int64_t after) {
    int64_t least = 0;
    if (is_motion(row->kind)) {
        least = 1;
    }
    return row->after >= after && row->after < run->slices && row->slices >= least &&
           row->slices <= run->slices - row->after;
}

wh_status_t wh_played_check_rows(const wh_played_t *run) {
    int64_t after = 0;
    wh_played_kind_t begun = WH_PLAYED_VALVES;
    for (size_t i = 0; i < run->row_count; ++i) {
        const wh_played_row_t *row = &run->rows[i];
        if ((uint32_t)row->kind > WH_PLAYED_PLACE ||
            !(begins(row->kind) ? is_in_time(run, row, after) : goes_on(row->kind, begun))) {
            return WH_STATUS_OUT_OF_RANGE;
        }
        if (begins(row->kind)) {
            after = row->after;
            begun = row->kind;
        }
    }
    return WH_OK;
}

/* The next value of a motion. */
typedef struct {
    const wh_played_row_t *row, *end; /* the row that it is in, and the end of all rows */
    size_t at;
    bool is_short; /* there were too few */
} values_t;

static bool goes_on_with(const values_t *values, wh_played_kind_t kind) {
    return values->row + 1 != values->end && values->row[1].kind == kind;
}

static wh_real_t next_value(values_t *values) {
    if (values->at == WH_PLAYED_VALUES) {
        if (!goes_on_with(values, WH_PLAYED_MORE)) {
            values->is_short = true;
            return 0;
        }
        ++values->row;
        values->at = 0;
    }
    const wh_real_t value = values->row->values[values->at];
    ++values->at;
    return value;
}

static wh_vec3_t next_vector(values_t *values) {
    wh_vec3_t v;
    v.x = next_value(values);
    v.y = next_value(values);
    v.z = next_value(values);
    return v;
}

static void read_targets(values_t *values, uint32_t bits, wh_real_t target[WH_AXES]) {
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        if ((bits >> axis & 1U) != 0) {
            target[axis] = next_value(values);
        }
    }
}

static void read_line(values_t *values, wh_segment_t *segment) {
    segment->kind = WH_SEGMENT_LINE;
    segment->travel = next_vector(values);
    segment->speed = next_value(values);
    segment->acceleration = next_value(values);
}

static void read_motion(values_t *values, wh_segment_t *segment) {
    const wh_played_row_t *row = values->row;
    segment->gripper = row->gripper;
    if (row->kind == WH_PLAYED_LINE) {
        read_line(values, segment);
        return;
    }
    segment->kind = row->kind == WH_PLAYED_VIA ? WH_SEGMENT_VIA : WH_SEGMENT_AXES;
    if (row->kind == WH_PLAYED_WAY) {
        segment->kind = WH_SEGMENT_WAY;
        segment->reach = next_value(values);
        segment->reach2 = next_value(values);
    }
    read_targets(values, row->bits, segment->target);
}

/* A point has as many axes as the motion. */
static void read_point(values_t *values, uint32_t bits, wh_via_point_t *point) {
    size_t own = 0;
    point->blend = next_value(values);
    point->reach[0] = next_value(values);
    point->reach[1] = next_value(values);
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        if ((bits >> axis & 1U) != 0 && own < WH_CARRIER_AXES) {
            point->q[own] = next_value(values);
            ++own;
        }
    }
}

static void read_slowness(values_t *values, wh_slowness_t *slowness) {
    slowness->share.speed = next_value(values);
    slowness->share.acceleration = next_value(values);
    slowness->pace = next_value(values);
}

/* Reads the rows that belong to a motion, up to its last. False if there are more points than it may have. */
static bool read_rest(values_t *values, uint32_t bits, wh_played_plan_t *plan) {
    for (;;) {
        if (goes_on_with(values, WH_PLAYED_SLOW)) {
            ++values->row;
            values->at = 0;
            read_slowness(values, &plan->slowness);
            plan->is_slow = true;
        } else if (goes_on_with(values, WH_PLAYED_POINT)) {
            if (plan->segment.kind != WH_SEGMENT_VIA || plan->segment.point_count == WH_VIA_POINTS) {
                return false;
            }
            ++values->row;
            values->at = 0;
            read_point(values, bits, &plan->points[plan->segment.point_count]);
            ++plan->segment.point_count;
        } else {
            return !goes_on_with(values, WH_PLAYED_MORE);
        }
    }
}

wh_status_t wh_played_read(const wh_played_t *run, const wh_track_t *track, size_t *row,
                           wh_played_plan_t *plan) {
    const wh_played_row_t *first = &run->rows[*row];
    values_t values = {first, &run->rows[run->row_count], 0, false};
    const size_t axes = run->machine->axis_count;
    const uint32_t all = UINT32_MAX >> (32U - (uint32_t)axes);
    plan->segment = wh_track_blank(track);
    plan->is_slow = false;
    if (first->bits == 0 || (first->bits & ~all) != 0) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    read_motion(&values, &plan->segment);
    const bool good = read_rest(&values, first->bits, plan) && !values.is_short;
    if (plan->segment.kind == WH_SEGMENT_VIA) {
        plan->segment.points = plan->points;
    }
    *row = (size_t)(values.row - run->rows) + 1;
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}
