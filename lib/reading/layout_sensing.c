/* The edge sensors of a layout's prealigners, and the true rims of its wafers, which they and beams see. */
#include <math.h>
#include <string.h>

#include "../layout/grips.h"
#include "../math/trig.h"
#include "layout_internal.h"

/* The most samples that a chuck may pass in a slice: two less than a state carries, because of rounding to
 * encoder steps. */
#define MOST_PASSED (WH_SCAN_SLICE - 2)

/* ------------------------------------------------------------------------------------------------ sensors */

/* Refuses values that would end each scan early: more samples in a slice than a state carries, or a chuck too
 * fast. */
static void check_speed(wh_reader_t *reader, const wh_layout_t *layout, const wh_sensor_t *sensor) {
    const double speed = layout->machine.chuck_limits.speed;
    const double way = speed * (double)layout->slice_us / 1e6;
    const double most = MOST_PASSED * 2 * WH_PI / way;
    if (speed > WH_SCAN_SPEED || way > 3) {
        wh_reader_fail(
            reader, NULL, "a slower chuck: chuck.speed at most %.6g degrees/s with slices of %lld us",
            wh_deg_from_rad(speed > WH_SCAN_SPEED ? WH_SCAN_SPEED : 3e6 / (double)layout->slice_us),
            (long long)layout->slice_us);
    }
    if (sensor->samples > most) {
        lua_pushinteger(reader->L, sensor->samples);
        wh_reader_fail(reader, "samples",
                       "at most %d: the chuck turns by up to %.6g degrees in a slice, which has room for %d",
                       (int)most, wh_deg_from_rad(way), WH_SCAN_SLICE);
    }
}

static void read_hidden(wh_reader_t *reader, wh_sensor_t *sensor) {
    if (!wh_reader_enter(reader, "hidden")) {
        return;
    }
    const size_t count = wh_reader_list(reader);
    if (count > WH_SENSOR_ARCS) {
        wh_reader_fail(reader, NULL, "at most %d arcs", WH_SENSOR_ARCS);
    }
    for (; (size_t)sensor->hidden_count < count; ++sensor->hidden_count) {
        wh_arc_t *arc = &sensor->hidden[sensor->hidden_count];
        wh_reader_enter_item(reader, sensor->hidden_count + 1);
        wh_reader_refuse_unknown(reader, wh_layout_arc_fields);
        wh_reader_scalars(reader, arc);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

static void check_encoder(wh_reader_t *reader, const wh_sensor_t *sensor) {
    if (sensor->encoder != 0 && sensor->encoder < sensor->samples) {
        lua_pushinteger(reader->L, sensor->encoder);
        wh_reader_fail(reader, "encoder", "0, or a whole number from samples, %d, to %d",
                       (int)sensor->samples, (int)wh_field_find(wh_layout_sensor_fields, "encoder")->most);
    }
}

static void read_believed(wh_reader_t *reader, wh_sensor_error_t *believed) {
    if (wh_reader_open(reader, "believed", wh_layout_believed_fields)) {
        wh_reader_scalars(reader, believed);
        wh_reader_leave(reader);
    }
}

static void read_sensor(wh_reader_t *reader, const wh_layout_t *layout, wh_scanner_t *scanner) {
    wh_sensor_t *sensor = &scanner->sensor;
    const double radius = layout->wafer_diameter / 2;
    *sensor = wh_sensor_nominal(radius);
    wh_reader_scalars(reader, sensor);
    const double longest = 2 * radius < 100 ? 2 * radius : 100;
    wh_reader_scalar_within(reader, "length", sensor, 28 < longest ? 28 : longest, 2, longest);
    check_encoder(reader, sensor);
    scanner->seed = (uint64_t)wh_reader_apart(reader, "seed");
    read_hidden(reader, sensor);
    check_speed(reader, layout, sensor);
}

static void read_station(wh_reader_t *reader, wh_layout_t *layout, size_t s) {
    if (!wh_reader_open(reader, "sensor", wh_layout_sensor_fields)) {
        return;
    }
    if (!layout->stations[s].prealigner) {
        wh_reader_fail(reader, NULL, "nothing: only a station of kind \"prealigner\" has an edge sensor");
    }
    if (layout->wafer_diameter < WH_SENSED_LEAST || layout->wafer_diameter > WH_SENSED_MOST) {
        wh_reader_fail(reader, NULL, "nothing: an edge sensor sees wafers from %d to %d mm, these have %.12g",
                       WH_SENSED_LEAST, WH_SENSED_MOST, layout->wafer_diameter);
    }
    wh_scanner_t *scanner = &layout->scanners[layout->scanner_count];
    scanner->gripper = layout->places[s].chuck;
    scanner->base_from_station = layout->places[s].base_from_station;
    read_sensor(reader, layout, scanner);
    read_believed(reader, &layout->believed[layout->scanner_count]);
    ++layout->scanner_count;
    wh_reader_leave(reader);
}

/* --------------------------------------------------------------------------------------------------- rims */

/* The rim that the layout's `wafer` describes. */
static wh_rim_t nominal_rim(wh_reader_t *reader, const wh_layout_t *layout) {
    wh_bad_field_t bad = {NULL, WH_NONE};
    wh_rim_t rim = wh_rim_nominal(layout->wafer_diameter / 2);
    if (layout->notch_depth > 0) {
        memset(rim.flats, 0, sizeof rim.flats);
        rim.notch = wh_rim_nominal(150).notch;
    }
    rim.notch.depth = layout->notch_depth;
    rim.notch.direction = layout->notch;
    rim.flats[0].direction = layout->notch;
    if (wh_rim_validate(&rim, &bad) != WH_OK) {
        lua_pushnumber(reader->L, layout->notch_depth);
        wh_reader_fail(reader, "wafer.notch.depth",
                       "0, or a depth from 0.27 to 3 mm for an edge sensor, beams or an edge grip");
    }
    return rim;
}

static void read_notch(wh_reader_t *reader, wh_notch_shape_t *notch) {
    if (!wh_reader_open(reader, "notch", wh_layout_rim_notch_fields)) {
        return;
    }
    const wh_notch_shape_t usual = wh_rim_nominal(150).notch;
    wh_reader_scalars(reader, notch);
    wh_reader_scalar_from(reader, "depth", notch, notch->depth > 0 ? notch->depth : usual.depth);
    wh_reader_scalar_from(reader, "bottom", notch, usual.bottom);
    wh_reader_scalar_from(reader, "corner", notch, usual.corner);
    wh_reader_leave(reader);
}

/* Enters each entry of a list of tables with these fields in turn; false behind the last one, or without a
 * list. The list is left then. `i` begins at 0. */
static bool next_entry(wh_reader_t *reader, const char *list, const wh_reader_field_t *fields, size_t most,
                       size_t *i) {
    if (*i > 0) {
        wh_reader_leave(reader);
    } else if (!wh_reader_enter(reader, list)) {
        return false;
    }
    const size_t count = wh_reader_list(reader);
    if (count > most) {
        wh_reader_fail(reader, NULL, "at most %zu of them", most);
    }
    if (*i == count) {
        wh_reader_leave(reader);
        return false;
    }
    ++*i;
    wh_reader_enter_item(reader, (lua_Integer)*i);
    wh_reader_refuse_unknown(reader, fields);
    return true;
}

static void read_flats(wh_reader_t *reader, wh_rim_t *rim) {
    if (wh_reader_has(reader, "flats")) {
        memset(rim->flats, 0, sizeof rim->flats);
    }
    for (size_t i = 0; next_entry(reader, "flats", wh_layout_flat_fields, WH_RIM_FLATS, &i);) {
        wh_flat_shape_t *flat = &rim->flats[i - 1];
        flat->direction = wh_rad_from_deg(wh_reader_apart(reader, "at"));
        flat->length = wh_reader_number(reader, "length", WH_REAL(NAN), 2, 1.4 * rim->radius);
    }
}

static void read_chips(wh_reader_t *reader, wh_rim_t *rim) {
    for (size_t i = 0; next_entry(reader, "chips", wh_layout_chip_fields, WH_RIM_CHIPS, &i);) {
        wh_chip_t *chip = &rim->chips[rim->chip_count];
        chip->direction = wh_rad_from_deg(wh_reader_apart(reader, "at"));
        chip->width = wh_reader_apart(reader, "width");
        chip->depth = wh_reader_number(reader, "depth", WH_REAL(NAN), 0, chip->width < 5 ? chip->width : 5);
        ++rim->chip_count;
    }
}

/* Pushes the value of a wrong field of the notch, given or not; nil for any other field. */
static void push_rim_field(lua_State *L, const wh_rim_t *rim, const char *name) {
    const char *const names[] = {"notch.depth", "notch.bottom", "notch.corner"};
    const double values[] = {rim->notch.depth, rim->notch.bottom, rim->notch.corner};
    lua_pushnil(L);
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        if (strcmp(name, names[i]) == 0) {
            lua_pop(L, 1);
            lua_pushnumber(L, values[i]);
        }
    }
}

static void read_rim(wh_reader_t *reader, const wh_layout_t *layout, wh_rim_t *rim) {
    wh_bad_field_t bad = {NULL, WH_NONE};
    rim->radius = wh_reader_apart_from(reader, "diameter", layout->wafer_diameter) / 2;
    read_notch(reader, &rim->notch);
    read_flats(reader, rim);
    read_chips(reader, rim);
    wh_reader_scalars(reader, rim);
    if (wh_rim_validate(rim, &bad) != WH_OK) {
        push_rim_field(reader->L, rim, bad.name);
        wh_reader_fail(reader, bad.name,
                       "a notch of depth 0, or one from 0.2 mm on whose roundings leave straight flanks, and "
                       "flats shorter than 1.4 radii");
    }
}

static const wh_rim_t *read_wafer(wh_reader_t *reader, const wh_layout_t *layout, const wh_rim_t *nominal) {
    if (!wh_reader_open(reader, "rim", wh_layout_rim_fields)) {
        return nominal;
    }
    if (!wh_layout_has_rims(layout)) {
        wh_reader_fail(reader, NULL,
                       "nothing: no prealigner of this layout has a `sensor` that would see it, no station "
                       "`beams`, no gripper an edge grip");
    }
    wh_rim_t *rim = wh_layout_memory(reader->L, 1, sizeof *rim);
    *rim = *nominal;
    read_rim(reader, layout, rim);
    wh_reader_leave(reader);
    return rim;
}

static void read_rims(wh_reader_t *reader, wh_layout_t *layout) {
    wh_rim_t *nominal = wh_layout_memory(reader->L, 1, sizeof *nominal);
    const wh_rim_t **rims = wh_layout_memory(reader->L, layout->wafer_count, sizeof *rims);
    if (wh_layout_has_rims(layout)) {
        *nominal = nominal_rim(reader, layout);
    }
    layout->nominal_rim = nominal;
    layout->rims = rims;
    size_t said = 0;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        rims[w] = nominal;
        said += layout->wafers[w].carrier == 0 ? 1 : 0;
    }
    if (!wh_reader_enter(reader, "wafers")) {
        return;
    }
    for (size_t w = 0; w < said; ++w) {
        wh_reader_enter_item(reader, (lua_Integer)w + 1);
        rims[w] = read_wafer(reader, layout, nominal);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

void wh_layout_read_sensing(wh_reader_t *reader, wh_layout_t *layout) {
    wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < layout->station_count; ++s) {
        (void)wh_reader_open(reader, layout->stations[s].name, wh_layout_station_fields);
        read_station(reader, layout, s);
        wh_layout_read_beams(reader, layout, s);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
    wh_layout_read_blocks(reader, layout);
    read_rims(reader, layout);
}
