/* A layout's `study`: the widths of the errors. */
#include <math.h>
#include <string.h>

#include "../layout/beam_errors.h"
#include "../layout/grips.h"
#include "../script/wh_module_values.h"
#include "layout_internal.h"

/* --------------------------------------------------------------------------------------------------- read */

wh_shape_t wh_layout_read_spread_shape(wh_reader_t *reader, wh_shape_t fallback) {
    return (wh_shape_t)wh_reader_apart_from(reader, "shape", fallback);
}

static const char *const placement_names[] = {"dx", "dy", "dz", "tilt", "turn", NULL};

/* Reads a width for each name, with its own default and the table's shape. */
static void read_spreads(wh_reader_t *reader, const char *const names[], wh_spreads_t *spreads) {
    for (size_t i = 0; names[i]; ++i) {
        wh_spread_t *spread = &spreads->of[i];
        spread->shape = wh_layout_read_spread_shape(reader, spread->shape);
        spread->width = wh_reader_apart_from(reader, names[i], spread->width);
    }
}

/* ------------------------------------------------------------------------------------------------- timing */

static void read_valve(wh_reader_t *reader, const wh_layout_t *layout, wh_spread_t *valve) {
    valve->width = wh_reader_apart_from(reader, "valve", valve->width);
    const double most = wh_spread_reach(valve);
    if (most * 1e6 / (double)layout->slice_us > WH_STUDY_LAG_SLICES) {
        lua_pushnumber(reader->L, valve->width);
        wh_reader_fail(reader, "valve", "delays of at most %d slices of %lld us, %s", WH_STUDY_LAG_SLICES,
                       (long long)layout->slice_us,
                       valve->shape == WH_SHAPE_NORMAL ? "which is 8.6 standard deviations" : "all of them");
    }
}

static void read_timing(wh_reader_t *reader, const wh_layout_t *layout, wh_errors_t *errors) {
    errors->vacuum.shape = wh_layout_read_spread_shape(reader, errors->vacuum.shape);
    errors->vacuum.width = wh_reader_apart(reader, "vacuum");
    errors->process.shape = errors->vacuum.shape;
    errors->process.width = wh_reader_apart(reader, "process");
    errors->port.shape = errors->vacuum.shape;
    errors->port.width = wh_reader_apart(reader, "port");
    errors->debounce.shape = errors->vacuum.shape;
    errors->debounce.width = wh_reader_apart(reader, "debounce");
    errors->valves[0].shape = errors->vacuum.shape;
    read_valve(reader, layout, &errors->valves[0]);
    for (size_t g = 1; g < layout->machine.gripper_count; ++g) {
        errors->valves[g] = errors->valves[0];
    }
}

/* --------------------------------------------------------------------------------------------------- rims */

static void refuse_width(const wh_reader_t *reader, const wh_spread_t *spread, wh_rim_draw_t draw,
                         const char *wafer) {
    lua_pushnumber(reader->L, spread->width);
    wh_reader_fail(reader, wh_rim_draw_name(draw),
                   "a width that leaves %s a rim, whatever is drawn: %s of it either way", wafer,
                   spread->shape == WH_SHAPE_NORMAL ? "8.6 standard deviations" : "all");
}

/* The first draw that, at its largest, changes this rim so that an edge grip cannot take it. */
static wh_rim_draw_t too_wide_for_edges(const wh_layout_t *layout, const wh_rim_spreads_t *spreads,
                                        const wh_rim_t *rim) {
    for (int i = 0; i < (int)WH_RIM_WIDTHS; ++i) {
        const double reach =
            wh_rim_draw_concerns((wh_rim_draw_t)i, rim) ? (double)wh_spread_reach(&spreads->of[i]) : 0;
        for (int sign = -1; sign <= 1; sign += 2) {
            double drawn[WH_RIM_DRAWS] = {0};
            wh_rim_t changed = *rim;
            drawn[i] = sign * reach;
            if (i <= (int)WH_RIM_NOTCH_BOTTOM && wh_rim_draw_apply(drawn, &changed) &&
                !wh_layout_edges_take(layout, &changed)) {
                return (wh_rim_draw_t)i;
            }
        }
    }
    return WH_RIM_DRAWS;
}

/* Checks the widths. No draw may give a rim values that rims cannot have. */
static void check_rim(const wh_reader_t *reader, const wh_layout_t *layout, size_t wafer,
                      const wh_rim_spreads_t *spreads) {
    const wh_rim_draw_t wide = wh_rim_draw_too_wide(spreads, layout->rims[wafer]);
    if (wide != WH_RIM_DRAWS) {
        refuse_width(reader, &spreads->of[wide], wide, layout->wafers[wafer].name);
    }
    const wh_rim_draw_t much = too_wide_for_edges(layout, spreads, layout->rims[wafer]);
    if (much != WH_RIM_DRAWS) {
        lua_pushnumber(reader->L, spreads->of[much].width);
        wh_reader_fail(
            reader, wh_rim_draw_name(much),
            "a width that leaves %s a wafer for an edge grip, whatever is drawn: within 2 mm of "
            "wafer.diameter, with a notch of 0.2 mm to a hundredth of that and of 85 to 120 degrees",
            layout->wafers[wafer].name);
    }
}

/* True if one of these wafers has what the draw changes. */
static bool concerns_any(const wh_layout_t *layout, size_t first, size_t end, wh_rim_draw_t draw) {
    bool any = false;
    for (size_t w = first; w < end; ++w) {
        any = any || wh_rim_draw_concerns(draw, layout->rims[w]);
    }
    return any;
}

static void check_concerned(const wh_reader_t *reader, const wh_layout_t *layout, size_t first, size_t end,
                            wh_rim_draw_t draw, wh_real_t width) {
    const char *name = wh_rim_draw_name(draw);
    if (wh_reader_has(reader, name) && width > 0 && !concerns_any(layout, first, end, draw)) {
        lua_pushnumber(reader->L, width);
        wh_reader_fail(reader, name, "0: no wafer here has %s",
                       draw == WH_RIM_CHIP_DEPTH || draw == WH_RIM_CHIP_WIDTH ? "room for a chip more"
                       : draw == WH_RIM_FLAT || draw == WH_RIM_SECOND_FLAT    ? "such a flat"
                                                                              : "a notch");
    }
}

/* Reads the table of widths for the wafers from `first` on; none of them means anything without a sensor,
 * beams or an edge grip. */
static void read_rim_widths(wh_reader_t *reader, const wh_layout_t *layout, size_t first, size_t end,
                            wh_rim_spreads_t *spreads) {
    if (!wh_layout_has_rims(layout)) {
        wh_reader_fail(
            reader, NULL,
            "nothing: no prealigner of this layout has a `sensor` that would see it, no station `beams`, no "
            "gripper an edge grip that would meet it");
    }
    for (size_t i = 0; i < WH_RIM_WIDTHS; ++i) {
        const wh_rim_draw_t draw = (wh_rim_draw_t)i;
        wh_spread_t *spread = &spreads->of[i];
        spread->shape = wh_layout_read_spread_shape(reader, spread->shape);
        spread->width = wh_reader_apart_from(reader, wh_rim_draw_name(draw), spread->width);
        check_concerned(reader, layout, first, end, draw, spread->width);
    }
    if (spreads->of[WH_RIM_CHIP_WIDTH].width > 0 && !(spreads->of[WH_RIM_CHIP_DEPTH].width > 0)) {
        lua_pushnumber(reader->L, spreads->of[WH_RIM_CHIP_DEPTH].width);
        wh_reader_fail(reader, "chip_depth", "a width above 0 beside chip_width");
    }
    for (size_t w = first; w < end; ++w) {
        check_rim(reader, layout, w, spreads);
    }
}

/* -------------------------------------------------------------------------------------------------- beams */

/* Refuses a width if a draw could then give a beam values that no beam can have. */
static void check_width(const wh_reader_t *reader, const wh_layout_t *layout, size_t b, wh_beam_draw_t draw,
                        const wh_spread_t *spread) {
    const double reach = wh_spread_reach(spread);
    const bool down = wh_beam_draw_is_size(draw) || wh_beam_draw_fits(draw, &layout->beams[b], -reach);
    if (spread->width > 0 && !(down && wh_beam_draw_fits(draw, &layout->beams[b], reach))) {
        lua_pushnumber(reader->L, spread->width);
        wh_reader_fail(reader, wh_beam_draw_name(draw),
                       "a width that leaves %s with at most %.6g %s, whatever is drawn: %s of it",
                       layout->beams[b].name, wh_beam_draw_most(draw), wh_beam_draw_unit(draw),
                       spread->shape == WH_SHAPE_NORMAL ? "8.6 standard deviations" : "all");
    }
}

static void read_beam_widths(wh_reader_t *reader, const wh_layout_t *layout, int32_t station,
                             wh_beam_spreads_t *spreads) {
    size_t count = 0;
    for (size_t i = 0; i < WH_BEAM_DRAWS; ++i) {
        const wh_beam_draw_t draw = (wh_beam_draw_t)i;
        wh_spread_t *spread = &spreads->of[i];
        spread->shape = wh_layout_read_spread_shape(reader, spread->shape);
        spread->width = wh_reader_apart_from(reader, wh_beam_draw_name(draw), spread->width);
    }
    for (size_t b = 0; b < layout->beam_count; ++b) {
        const bool is_its = station == WH_NONE || layout->beams[b].station == station;
        if (!is_its || layout->doors[b].kind != WH_DOOR_LIGHT) {
            continue;
        }
        ++count;
        for (size_t i = 0; i < WH_BEAM_DRAWS; ++i) {
            check_width(reader, layout, b, (wh_beam_draw_t)i, &spreads->of[i]);
        }
    }
    if (count == 0) {
        wh_reader_fail(reader, NULL, "nothing: there are no `beams` that would be off");
    }
}

/* ------------------------------------------------------------------------------------- one by one by name */

/* A table whose keys are names of the layout's wafers, stations or grippers. */
typedef struct {
    const char *field, *what;
    const wh_reader_field_t *known; /* the fields of each of its tables */
    const void *items;              /* each begins with its name */
    size_t size, count;
    wh_layout_find_t *find;
    void (*read)(wh_reader_t *reader, wh_layout_t *layout, size_t index);
} section_t;

static void read_wafer(wh_reader_t *reader, wh_layout_t *layout, size_t index) {
    read_spreads(reader, placement_names, &layout->errors->wafers[index]);
}

static void read_own_rim(wh_reader_t *reader, wh_layout_t *layout, size_t index) {
    read_rim_widths(reader, layout, index, index + 1, &layout->errors->rims[index]);
}

static void read_own_beams(wh_reader_t *reader, wh_layout_t *layout, size_t index) {
    for (size_t b = 0; b < layout->beam_count; ++b) {
        if (layout->beams[b].station == (int32_t)index) {
            read_beam_widths(reader, layout, (int32_t)index, &layout->errors->beams[b]);
        }
    }
    if (wh_layout_beams_at(layout, index).count == 0) {
        wh_reader_fail(reader, NULL, "nothing: this station has no `beams`");
    }
}

static void read_station(wh_reader_t *reader, wh_layout_t *layout, size_t index) {
    read_spreads(reader, wh_errors_teaching_names, &layout->errors->stations[index]);
}

static void read_gripper(wh_reader_t *reader, wh_layout_t *layout, size_t index) {
    wh_spread_t *valve = &layout->errors->valves[index];
    valve->shape = wh_layout_read_spread_shape(reader, valve->shape);
    read_valve(reader, layout, valve);
}

/* Refuses the first key, by name, that names nothing of the layout; and a key that is no text. */
static void refuse_strangers(const wh_reader_t *reader, const wh_layout_t *layout, const section_t *section) {
    lua_State *L = reader->L;
    const char *first = NULL;
    size_t first_length = 0;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) != LUA_TSTRING) {
            lua_pushvalue(L, -2);
            wh_reader_fail(reader, NULL, "tables by the name of a %s", section->what);
        }
        size_t length = 0;
        const char *name = lua_tolstring(L, -2, &length);
        if ((!first || strcmp(name, first) < 0) && section->find(layout, wh_lua_word(L, -2)) == WH_NONE) {
            first = name;
            first_length = length;
        }
    }
    if (first) {
        lua_pushlstring(L, first, first_length);
        wh_reader_fail(reader, NULL, "the name of a %s of this layout", section->what);
    }
}

static void read_section(wh_reader_t *reader, wh_layout_t *layout, const section_t *section) {
    if (!wh_reader_enter(reader, section->field)) {
        return;
    }
    for (size_t i = 0; i < section->count; ++i) {
        if (wh_reader_open(reader, (const char *)section->items + i * section->size, section->known)) {
            section->read(reader, layout, i);
            wh_reader_leave(reader);
        }
    }
    refuse_strangers(reader, layout, section);
    wh_reader_leave(reader);
}

/* ---------------------------------------------------------------------------------------------- all of it */

static void read_rims_for_all(wh_reader_t *reader, wh_layout_t *layout, wh_shape_t shape) {
    wh_rim_spreads_t rims;
    for (size_t i = 0; i < WH_RIM_WIDTHS; ++i) {
        rims.of[i] = (wh_spread_t){0, shape};
    }
    if (wh_reader_open(reader, "rim", wh_layout_rim_width_fields)) {
        read_rim_widths(reader, layout, 0, layout->wafer_count, &rims);
        wh_reader_leave(reader);
    }
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        layout->errors->rims[w] = rims;
    }
}

static void read_beams_for_all(wh_reader_t *reader, wh_layout_t *layout, wh_shape_t shape) {
    wh_beam_spreads_t beams;
    for (size_t i = 0; i < WH_BEAM_DRAWS; ++i) {
        beams.of[i] = (wh_spread_t){0, shape};
    }
    if (wh_reader_open(reader, "beam", wh_layout_beam_width_fields)) {
        read_beam_widths(reader, layout, WH_NONE, &beams);
        wh_reader_leave(reader);
    }
    for (size_t b = 0; b < layout->beam_count; ++b) {
        layout->errors->beams[b] = beams;
    }
}

static void read_for_all(wh_reader_t *reader, wh_layout_t *layout, wh_shape_t shape) {
    wh_spreads_t placement = {{{0, shape}}};
    for (size_t i = 1; i < WH_SPREADS; ++i) {
        placement.of[i] = placement.of[0];
    }
    wh_spreads_t teaching = placement;
    layout->errors->vacuum.shape = shape;
    wh_reader_open_section(reader, "placement", wh_layout_placement_fields);
    read_spreads(reader, placement_names, &placement);
    wh_reader_leave(reader);
    wh_reader_open_section(reader, "teaching", wh_layout_teaching_fields);
    read_spreads(reader, wh_errors_teaching_names, &teaching);
    wh_reader_leave(reader);
    wh_reader_open_section(reader, "timing", wh_layout_timing_fields);
    read_timing(reader, layout, layout->errors);
    wh_reader_leave(reader);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        layout->errors->wafers[w] = placement;
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        layout->errors->stations[s] = teaching;
    }
}

/* An error of the taught place turns the blade of an arm without a wrist; on an arm that tilts it turns the
 * blade out of its plane. */
static void refuse_beside(wh_reader_t *reader, const wh_layout_t *layout) {
    for (size_t s = 0; layout->robot_count > 1 && s < layout->station_count; ++s) {
        const wh_spread_t *widths = layout->errors->stations[s].of;
        for (size_t r = 0; r < layout->robot_count; ++r) {
            const wh_chain_t *chain = &layout->robots[r].carrier.chain;
            const double widest = fmax(widths[0].width, fmax(widths[1].width, widths[2].width));
            if (layout->stations[s].by[r].serves && chain->kind == WH_CHAIN_TRZ && chain->has_tilt &&
                widest > 0) {
                lua_pushnumber(reader->L, widest);
                wh_reader_fail(reader, "teaching",
                               "0 as x, y and z of %s: %s tilts, and its blade points along the arm",
                               layout->stations[s].name, layout->robots[r].name);
            }
        }
    }
}

/* Robots that are times alone stand nowhere: processes alone are drawn. */
static void read_timed_study(wh_reader_t *reader, wh_layout_t *layout) {
    if (!wh_reader_open(reader, "study", wh_layout_timed_study_fields)) {
        return;
    }
    wh_errors_t *errors = wh_layout_memory(reader->L, 1, sizeof *errors);
    layout->errors = errors;
    const wh_shape_t shape = wh_layout_read_spread_shape(reader, WH_SHAPE_NORMAL);
    wh_reader_open_section(reader, "timing", wh_layout_timed_timing_fields);
    errors->process.shape = wh_layout_read_spread_shape(reader, shape);
    errors->process.width = wh_reader_apart(reader, "process");
    wh_reader_leave(reader);
    wh_reader_leave(reader);
}

void wh_layout_read_study(wh_reader_t *reader, wh_layout_t *layout) {
    const section_t sections[] = {
        {"wafers", "wafer", wh_layout_placement_fields, layout->wafers, sizeof *layout->wafers,
         layout->wafer_count, wh_layout_find_wafer, read_wafer},
        {"stations", "station", wh_layout_teaching_fields, layout->stations, sizeof *layout->stations,
         layout->station_count, wh_layout_find_station, read_station},
        {"rims", "wafer", wh_layout_rim_width_fields, layout->wafers, sizeof *layout->wafers,
         layout->wafer_count, wh_layout_find_wafer, read_own_rim},
        {"beams", "station", wh_layout_beam_width_fields, layout->stations, sizeof *layout->stations,
         layout->station_count, wh_layout_find_station, read_own_beams},
        {"grippers", "gripper", wh_layout_valve_fields, layout->grippers, sizeof layout->grippers[0],
         layout->machine.gripper_count, wh_layout_find_gripper, read_gripper}};
    if (layout->tool) {
        read_timed_study(reader, layout);
        return;
    }
    if (!wh_reader_open(reader, "study", wh_layout_study_fields)) {
        return;
    }
    wh_errors_t *errors = wh_layout_memory(reader->L, 1, sizeof *errors);
    errors->wafers = wh_layout_memory(reader->L, layout->wafer_count, sizeof *errors->wafers);
    errors->stations = wh_layout_memory(reader->L, layout->station_count, sizeof *errors->stations);
    errors->rims = wh_layout_memory(reader->L, layout->wafer_count, sizeof *errors->rims);
    errors->robot_count = layout->robot_count;
    layout->errors = errors;
    const wh_shape_t shape = wh_layout_read_spread_shape(reader, WH_SHAPE_NORMAL);
    read_for_all(reader, layout, shape);
    read_rims_for_all(reader, layout, shape);
    read_beams_for_all(reader, layout, shape);
    for (size_t i = 0; i < sizeof sections / sizeof sections[0]; ++i) {
        read_section(reader, layout, &sections[i]);
    }
    refuse_beside(reader, layout);
    wh_reader_leave(reader);
}
