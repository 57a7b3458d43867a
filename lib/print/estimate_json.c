#include <stdlib.h>

#include "../math/trig.h"
#include "../text/array.h"
#include "../text/json.h"
#include "estimate_print.h"

#define FORMAT 1

/* The outcome: 0 and OK, or the error and its reason. */
static json_t *outcome(const char *name, wh_status_t status, const char *reason) {
    return wh_json_set(json_object(), "name %s error %d status %s reason %s", name, (int)status,
                       wh_status_name(status), reason[0] != '\0' ? reason : NULL);
}

static json_t *numbers(const double *values, size_t count, double unit) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; ++i) {
        wh_json_append(list, wh_json_real(values[i] * unit));
    }
    return list;
}

/* Takes over `lua`, of open_memstream. */
static int print(const char *path, bool ok, const char *key, json_t *list, char *lua, FILE *out) {
    json_t *root = wh_json_set(json_object(), "format %d file %s ok %i", FORMAT, path, ok);
    wh_json_put(root, key, list);
    (void)wh_json_set(root, "lua %s", lua);
    free(lua);
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}

/* ------------------------------------------------------------------------------------------------- frames */

static json_t *residual(const void *subject, size_t i) {
    const wh_station_points_t *station = subject;
    const wh_vec3_t off = wh_frame_residual(&station->estimate, &station->points[i]);
    return wh_json_set(json_object(), "line %lld dx %g dy %g dz %g", (long long)station->lines[i], off.x,
                       off.y, off.z);
}

static json_t *points_aside(const wh_station_points_t *station) {
    json_t *lines = json_array();
    for (size_t i = 0; i < station->count; ++i) {
        if (station->points[i].is_set_aside) {
            wh_json_append(lines, json_integer((json_int_t)station->lines[i]));
        }
    }
    return lines;
}

static json_t *station(const void *subject, size_t i) {
    const wh_point_table_t *table = subject;
    const wh_station_points_t *from = &table->stations[i];
    const wh_frame_estimate_t *frame = &from->estimate;
    const double deg = wh_deg_from_rad(1);
    json_t *object = outcome(from->name, frame->status, frame->reason);
    (void)wh_json_set(object, "points %lld", (long long)from->count);
    if (frame->status != WH_OK) {
        return object;
    }
    (void)wh_json_add(object, "at at_sd rpy rpy_sd", wh_json_vector(frame->base_from_station.r),
                      numbers(frame->at_sd, 3, 1), numbers(frame->rpy, 3, deg),
                      numbers(frame->rpy_sd, 3, deg), NULL);
    (void)wh_json_set(object, "rms %g largest %g largest_line %lld", frame->rms, frame->largest,
                      (long long)from->lines[frame->largest_index]);
    wh_json_put(object, "set_aside_lines", points_aside(from));
    wh_json_put(object, "residuals", wh_json_list(residual, from, from->count));
    return object;
}

int wh_frames_print_json(const wh_point_table_t *table, FILE *out) {
    char *lua = NULL;
    size_t size = 0;
    bool ok = true;
    for (size_t i = 0; i < table->count; ++i) {
        ok = ok && table->stations[i].estimate.status == WH_OK;
    }
    FILE *text = wh_memory_need(open_memstream(&lua, &size));
    wh_frames_print_lua(table, text);
    (void)fclose(text);
    return print(table->csv.path, ok, "stations", wh_json_list(station, table, table->count), lua, out);
}

/* ------------------------------------------------------------------------------------------------- limits */

/* A limit that is not determined is null, with its least value, or null. */
static void put_limit(json_t *object, const wh_limits_estimate_t *limits, int k) {
    const wh_estimate_value_t *value = &limits->values[k];
    const bool told = value->is_determined;
    json_t *limit = wh_json_set(json_object(), "value %g sd %g", told ? value->value : HUGE_VAL,
                                told ? value->sd : HUGE_VAL);
    if (k < WH_LIMIT_DELAY) {
        const bool is_bound = !told && limits->at_least[k] > 0;
        (void)wh_json_set(limit, "at_least %g", is_bound ? limits->at_least[k] : HUGE_VAL);
    }
    wh_json_put(object, wh_limit_name(k), limit);
}

static json_t *axis(const void *subject, size_t i) {
    const wh_move_table_t *table = subject;
    const wh_axis_moves_t *from = &table->axes[i];
    const wh_limits_estimate_t *limits = &from->estimate;
    if (from->count == 0) {
        return NULL;
    }
    json_t *object = outcome(wh_table_axis_name(i), limits->status, limits->reason);
    json_t *aside = json_array();
    for (size_t k = 0; k < from->count; ++k) {
        if (from->moves[k].is_set_aside) {
            wh_json_append(aside, json_integer((json_int_t)from->lines[k]));
        }
    }
    (void)wh_json_set(object, "moves %lld", (long long)from->count);
    wh_json_put(object, "set_aside_lines", aside);
    if (limits->status == WH_OK) {
        for (int k = 0; k < WH_LIMIT_PARAMETERS; ++k) {
            put_limit(object, limits, k);
        }
        (void)wh_json_set(object, "shortest %g longest %g rms_s %g", limits->shortest, limits->longest,
                          limits->rms);
        wh_json_put(object, "looks_simulated", json_boolean(wh_axis_moves_look_simulated(from)));
    }
    return object;
}

int wh_limits_print_json(const wh_move_table_t *table, FILE *out) {
    char *lua = NULL;
    size_t size = 0;
    bool ok = true;
    for (size_t i = 0; i < WH_TABLE_AXES; ++i) {
        ok = ok && table->axes[i].estimate.status == WH_OK && table->axes[i].estimate.reason[0] == '\0';
    }
    FILE *text = wh_memory_need(open_memstream(&lua, &size));
    wh_limits_print_lua(table, text);
    (void)fclose(text);
    return print(table->csv.path, ok, "axes", wh_json_list(axis, table, WH_TABLE_AXES), lua, out);
}

/* ----------------------------------------------------------------------------------------------- geometry */

/* The lines that were set aside: touches, or headings of touches. */
static json_t *lines_aside(const wh_touch_table_t *table, bool of_headings) {
    json_t *lines = json_array();
    for (size_t i = 0; i < table->count; ++i) {
        const wh_touch_t *touch = &table->touches[i];
        if (of_headings ? touch->is_heading_set_aside : touch->is_set_aside) {
            wh_json_append(lines, json_integer((json_int_t)table->lines[i]));
        }
    }
    return lines;
}

static json_t *touch(const void *subject, size_t i) {
    const wh_touch_table_t *table = subject;
    const wh_geometry_estimate_t *found = &table->estimate;
    const wh_vec3_t off = wh_geometry_residual(found, &table->touches[i]);
    json_t *object = wh_json_set(json_object(), "line %lld dx %g dy %g dz %g", (long long)table->lines[i],
                                 off.x, off.y, off.z);
    if (found->is_base_determined) {
        wh_json_put(object, "in_base",
                    wh_json_vector(wh_geometry_in_base(found, &table->touches[i].touched)));
    }
    return object;
}

static void put_geometry(json_t *object, const wh_touch_table_t *table) {
    const wh_geometry_estimate_t *found = &table->estimate;
    for (int k = 0; k < (found->has_scales ? WH_GEOMETRY_PARAMETERS : WH_GEOMETRY_SCALE); ++k) {
        double unit;
        const wh_estimate_value_t *value = &found->values[k];
        (void)wh_geometry_unit(k, &unit);
        wh_json_put(object, wh_geometry_name(k),
                    wh_json_set(json_object(), "value %g sd %g",
                                value->is_determined ? value->value * unit : HUGE_VAL,
                                value->is_determined ? value->sd * unit : HUGE_VAL));
    }
    if (found->is_base_determined) {
        json_t *base = json_object();
        (void)wh_json_add(base, "at rpy", wh_json_vector(found->points_from_base.r),
                          numbers(found->base_rpy, 3, wh_deg_from_rad(1)), NULL);
        wh_json_put(object, "base", base);
    }
    (void)wh_json_set(object, "rms %g largest %g largest_line %lld headings %lld heading_rms %g", found->rms,
                      found->largest, (long long)table->lines[found->largest_index],
                      (long long)found->headings,
                      found->headings > 0 ? wh_deg_from_rad(found->heading_rms) : HUGE_VAL);
    wh_json_put(object, "residuals", wh_json_list(touch, table, table->count));
}

int wh_geometry_print_json(const wh_touch_table_t *table, FILE *out) {
    const wh_geometry_estimate_t *found = &table->estimate;
    char *lua = NULL;
    size_t size = 0;
    const bool ok = found->status == WH_OK && found->reason[0] == '\0';
    json_t *root =
        wh_json_set(json_object(), "format %d file %s ok %i error %d status %s reason %s touches %lld",
                    FORMAT, table->csv.path, ok, (int)found->status, wh_status_name(found->status),
                    found->reason[0] != '\0' ? found->reason : NULL, (long long)table->count);
    (void)wh_json_add(root, "set_aside_lines set_aside_headings", lines_aside(table, false),
                      lines_aside(table, true), NULL);
    if (found->status == WH_OK) {
        put_geometry(root, table);
    }
    FILE *text = wh_memory_need(open_memstream(&lua, &size));
    wh_geometry_print_lua(table, text);
    (void)fclose(text);
    (void)wh_json_set(root, "lua %s", lua);
    free(lua);
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
