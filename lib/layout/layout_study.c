/* A layout's `study`: how wide the errors are that the trials of a study draw. */
#include <string.h>

#include "layout_internal.h"

static const char *const shapes[] = {"normal", "uniform", NULL};
static const char *const placement_fields[WH_PLACEMENT_FIELDS] = {"dx", "dy", "dz", "tilt", "turn"};
static const char *const teaching_fields[WH_TEACHING_FIELDS] = {"x", "y", "z", "roll", "pitch", "yaw"};

/* What a field may be at most: mm, then degrees. */
#define MOST_MM 100
#define MOST_DEG 45
#define MOST_S 1

static wh_shape_t read_shape(wh_reader_t *reader, wh_shape_t fallback) {
    return (wh_shape_t)wh_reader_choice(reader, "shape", (int)fallback, shapes);
}

/* The fields of the table being read, each with its fallback's width and the table's shape. */
static void read_fields(wh_reader_t *reader, const char *const names[], size_t count, size_t lengths,
                        wh_spread_t of[]) {
    for (size_t i = 0; i < count; ++i) {
        const wh_shape_t shape = read_shape(reader, of[i].shape);
        of[i].width = wh_reader_number(reader, names[i], of[i].width, 0, i < lengths ? MOST_MM : MOST_DEG);
        of[i].shape = shape;
    }
}

static void read_placement(wh_reader_t *reader, wh_placement_t *placement) {
    wh_reader_refuse_unknown(reader, "dx dy dz tilt turn shape");
    read_fields(reader, placement_fields, WH_PLACEMENT_FIELDS, 3, placement->of);
}

static void read_teaching(wh_reader_t *reader, wh_teaching_t *teaching) {
    wh_reader_refuse_unknown(reader, "x y z roll pitch yaw shape");
    read_fields(reader, teaching_fields, WH_TEACHING_FIELDS, 3, teaching->of);
}

/* ------------------------------------------------------------------------------------------------------- timing */

/* A normal deviate stays below this many standard deviations: see math/deviate.h. */
#define MOST_DEVIATIONS 8.6

static void read_valve(wh_reader_t *reader, const wh_layout_t *layout, wh_spread_t *valve) {
    valve->width = wh_reader_number(reader, "valve", valve->width, 0, MOST_S);
    const double most = (valve->shape == WH_SHAPE_NORMAL ? MOST_DEVIATIONS : 1) * valve->width;
    if (most * 1e6 / (double)layout->slice_us > WH_STUDY_LAG_SLICES) {
        lua_pushnumber(reader->L, valve->width);
        wh_reader_fail(reader, "valve", "delays of at most %d slices of %lld us, %s", WH_STUDY_LAG_SLICES,
                       (long long)layout->slice_us,
                       valve->shape == WH_SHAPE_NORMAL ? "which is 8.6 standard deviations" : "all of them");
    }
}

static void read_timing(wh_reader_t *reader, const wh_layout_t *layout, wh_errors_t *errors) {
    wh_reader_refuse_unknown(reader, "valve vacuum shape");
    errors->vacuum.shape = read_shape(reader, errors->vacuum.shape);
    errors->vacuum.width = wh_reader_number(reader, "vacuum", 0, 0, MOST_S);
    errors->valves[0].shape = errors->vacuum.shape;
    read_valve(reader, layout, &errors->valves[0]);
    for (size_t g = 1; g < layout->machine.gripper_count; ++g) {
        errors->valves[g] = errors->valves[0];
    }
}

/* -------------------------------------------------------------------------------------------- one by one by name */

/* Tables by the names of something of the layout. */
typedef struct {
    const char *field, *what;
    const char *(*name)(const wh_layout_t *layout, size_t index);
    void (*read)(wh_reader_t *reader, wh_layout_t *layout, size_t index);
} section_t;

static const char *wafer_name(const wh_layout_t *layout, size_t index) {
    return layout->wafers[index].name;
}

static const char *station_name(const wh_layout_t *layout, size_t index) {
    return layout->stations[index].name;
}

static const char *gripper_name(const wh_layout_t *layout, size_t index) {
    return layout->grippers[index].name;
}

static void read_wafer(wh_reader_t *reader, wh_layout_t *layout, size_t index) {
    read_placement(reader, &layout->errors->wafers[index]);
}

static void read_station(wh_reader_t *reader, wh_layout_t *layout, size_t index) {
    read_teaching(reader, &layout->errors->stations[index]);
}

static void read_gripper(wh_reader_t *reader, wh_layout_t *layout, size_t index) {
    wh_spread_t *valve = &layout->errors->valves[index];
    wh_reader_refuse_unknown(reader, "valve shape");
    valve->shape = read_shape(reader, valve->shape);
    read_valve(reader, layout, valve);
}

static bool is_name(const wh_layout_t *layout, const section_t *section, size_t count, const char *name) {
    size_t i = 0;
    while (i < count && strcmp(section->name(layout, i), name) != 0) {
        ++i;
    }
    return i < count;
}

/* How many keys the table being read has, all of them texts. */
static size_t count_keys(const wh_reader_t *reader, const section_t *section) {
    lua_State *L = reader->L;
    size_t count = 0;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) != LUA_TSTRING) {
            lua_pushvalue(L, -2);
            wh_reader_fail(reader, NULL, "tables by the name of a %s", section->what);
        }
        ++count;
    }
    return count;
}

/* Of the keys that name nothing the first. */
static void refuse_stranger(const wh_reader_t *reader, const wh_layout_t *layout, const section_t *section,
                            size_t count) {
    lua_State *L = reader->L;
    const char *first = "";
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        const char *name = lua_tostring(L, -2);
        if ((!first[0] || strcmp(name, first) < 0) && !is_name(layout, section, count, name)) {
            first = name;
        }
    }
    lua_pushstring(L, first);
    wh_reader_fail(reader, NULL, "the name of a %s of this layout", section->what);
}

static void read_section(wh_reader_t *reader, wh_layout_t *layout, const section_t *section, size_t count) {
    if (!wh_reader_enter(reader, section->field)) {
        return;
    }
    size_t found = 0;
    for (size_t i = 0; i < count; ++i) {
        if (wh_reader_enter(reader, section->name(layout, i))) {
            section->read(reader, layout, i);
            wh_reader_leave(reader);
            ++found;
        }
    }
    if (found != count_keys(reader, section)) {
        refuse_stranger(reader, layout, section, count);
    }
    wh_reader_leave(reader);
}

/* ------------------------------------------------------------------------------------------------------ all of it */

static wh_placement_t placement_of(wh_shape_t shape) {
    wh_placement_t placement = {{{0, WH_SHAPE_NORMAL}}};
    for (size_t i = 0; i < WH_PLACEMENT_FIELDS; ++i) {
        placement.of[i].shape = shape;
    }
    return placement;
}

static wh_teaching_t teaching_of(wh_shape_t shape) {
    wh_teaching_t teaching = {{{0, WH_SHAPE_NORMAL}}};
    for (size_t i = 0; i < WH_TEACHING_FIELDS; ++i) {
        teaching.of[i].shape = shape;
    }
    return teaching;
}

static void read_for_all(wh_reader_t *reader, wh_layout_t *layout, wh_shape_t shape) {
    wh_placement_t placement = placement_of(shape);
    wh_teaching_t teaching = teaching_of(shape);
    layout->errors->vacuum.shape = shape;
    if (wh_reader_enter(reader, "placement")) {
        read_placement(reader, &placement);
        wh_reader_leave(reader);
    }
    if (wh_reader_enter(reader, "teaching")) {
        read_teaching(reader, &teaching);
        wh_reader_leave(reader);
    }
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        layout->errors->valves[g].shape = shape;
    }
    if (wh_reader_enter(reader, "timing")) {
        read_timing(reader, layout, layout->errors);
        wh_reader_leave(reader);
    }
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        layout->errors->wafers[w] = placement;
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        layout->errors->stations[s] = teaching;
    }
}

void wh_layout_read_study(wh_reader_t *reader, wh_layout_t *layout) {
    static const section_t wafers = {"wafers", "wafer", wafer_name, read_wafer};
    static const section_t stations = {"stations", "station", station_name, read_station};
    static const section_t grippers = {"grippers", "gripper", gripper_name, read_gripper};
    if (!wh_reader_enter(reader, "study")) {
        return;
    }
    wh_reader_refuse_unknown(reader, "shape placement teaching timing wafers stations grippers");
    wh_errors_t *errors = wh_layout_memory(reader->L, 1, sizeof *errors);
    errors->wafers = wh_layout_memory(reader->L, layout->wafer_count, sizeof *errors->wafers);
    errors->stations = wh_layout_memory(reader->L, layout->station_count, sizeof *errors->stations);
    layout->errors = errors;
    read_for_all(reader, layout, read_shape(reader, WH_SHAPE_NORMAL));
    read_section(reader, layout, &wafers, layout->wafer_count);
    read_section(reader, layout, &stations, layout->station_count);
    read_section(reader, layout, &grippers, layout->machine.gripper_count);
    wh_reader_leave(reader);
}
