#include "given.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/beam_errors.h"
#include "../layout/grips.h"
#include "../reading/layout_read.h"

/* One text, taken apart: NAME.FIELD=VALUE, or FIELD=VALUE. */
typedef struct {
    const char *text;
    char name[2 * WH_NAME_SIZE]; /* empty: none */
    char field[WH_NAME_SIZE];
    double value;
} given_t;

static void refuse_error(lua_State *L, const given_t *given, const char *why) {
    lua_pushfstring(L, "--error %s: %s", given->text, why);
    (void)lua_error(L);
}

/* False if it does not fit. */
static bool take_word(char *word, size_t size, const char *from, const char *to) {
    const size_t length = (size_t)(to - from);
    if (length >= size) {
        return false;
    }
    memcpy(word, from, length);
    word[length] = '\0';
    return true;
}

/* Takes the names before the equals sign; false if they do not fit. */
static bool take_names(given_t *given, const char *equals) {
    const char *point = equals;
    while (point > given->text && *point != '.') {
        --point;
    }
    const bool named = *point == '.';
    return take_word(given->name, sizeof given->name, given->text, named ? point : given->text) &&
           take_word(given->field, sizeof given->field, named ? point + 1 : given->text, equals);
}

/* A name may have points and equals signs in it: the last ones count. */
static void take_apart(lua_State *L, given_t *given) {
    const char *equals = strrchr(given->text, '=');
    if (!equals || !take_names(given, equals)) {
        refuse_error(L, given, "no error (expected NAME.FIELD=VALUE, such as A.x=0.12)");
    } else {
        char *end = NULL;
        given->value = strtod(equals + 1, &end);
        if (end == equals + 1 || *end != '\0' || !isfinite(given->value)) {
            refuse_error(L, given, "no number (expected NAME.FIELD=VALUE, such as A.x=0.12)");
        }
    }
}

static void check_range(lua_State *L, const given_t *given, double least, double most, const char *unit) {
    if (given->value < least || given->value > most) {
        char why[100];
        (void)snprintf(why, sizeof why, "out of range (expected %g to %g %s)", least, most, unit);
        refuse_error(L, given, why);
    }
}

/* The name of a wafer's error, like wh_errors_teaching_name for stations. The first three are mm, the others
 * degrees. */
static const char *wafer_name(size_t part) {
    static const char *const names[] = {"dx", "dy", "dz", "tilt_x", "tilt_y", "turn"};
    return names[part];
}

/* The place of the error of "STATION.ROBOT", one of several robots that serves the station, or WH_NONE. */
static int32_t find_taught(const wh_layout_t *layout, const char *name) {
    for (size_t s = 0; layout->robot_count > 1 && s < layout->station_count; ++s) {
        const wh_layout_station_t *station = &layout->stations[s];
        const size_t length = strlen(station->name);
        for (size_t r = 0; r < layout->robot_count; ++r) {
            if (station->by[r].serves && strncmp(name, station->name, length) == 0 && name[length] == '.' &&
                strcmp(name + length + 1, layout->robots[r].name) == 0) {
                return (int32_t)(s * layout->robot_count + r);
            }
        }
    }
    return WH_NONE;
}

static size_t find_part(const char *name_of(size_t part), const char *field) {
    size_t part = 0;
    while (part < WH_SPREADS && strcmp(name_of(part), field) != 0) {
        ++part;
    }
    return part;
}

/* Gives the error of one of several robots alone. */
static void give_taught(lua_State *L, const given_t *given, wh_vec3_t *taught, size_t axis) {
    wh_real_t *const parts[] = {&taught->x, &taught->y, &taught->z};
    if (axis >= 3) {
        refuse_error(L, given, "a station is turned for all of its robots (expected x, y or z)");
    } else {
        check_range(L, given, -WH_ERRORS_MOST_MM, WH_ERRORS_MOST_MM, "mm");
        *parts[axis] = (wh_real_t)given->value;
    }
}

static void give_part(lua_State *L, const given_t *given, wh_displacement_t *all, int32_t index,
                      size_t axis) {
    const bool is_turn = strcmp(given->field, wafer_name(WH_SPREADS - 1)) == 0;
    const double most = axis < 3 ? WH_ERRORS_MOST_MM : is_turn ? WH_ERRORS_MOST_TURN_DEG : WH_ERRORS_MOST_DEG;
    if (index == WH_NONE) {
        refuse_error(L, given,
                     "nothing of the layout has that name (expected a station's, a wafer's, a gripper's)");
    }
    check_range(L, given, -most, most, axis < 3 ? "mm" : "degrees");
    *wh_displacement_part(&all[index], axis) = (wh_real_t)given->value;
}

static void give_valve(lua_State *L, const wh_layout_t *layout, const given_t *given, wh_given_t *to) {
    const int32_t gripper = wh_layout_find_gripper(layout, given->name);
    const double longest = WH_STUDY_LAG_SLICES * (double)layout->slice_us / 1e6;
    if (gripper == WH_NONE) {
        refuse_error(L, given, "no gripper of the layout has that name (expected GRIPPER.valve=SECONDS)");
    }
    check_range(L, given, 0, longest < WH_ERRORS_MOST_S ? longest : WH_ERRORS_MOST_S, "s");
    to->valves[gripper] = (wh_real_t)given->value;
}

static int find_rim_draw(const char *field) {
    int draw = 0;
    while (draw < (int)WH_RIM_DRAWS && strcmp(wh_rim_draw_name((wh_rim_draw_t)draw), field) != 0) {
        ++draw;
    }
    return draw;
}

/* Gives an error of a wafer's rim, like a draw of a trial. */
static void give_rim(lua_State *L, const wh_layout_t *layout, const given_t *given, wh_given_t *to,
                     wh_rim_draw_t draw) {
    const int32_t wafer = wh_layout_find_wafer(layout, given->name);
    const double most = wh_rim_draw_most(draw);
    if (wafer == WH_NONE) {
        refuse_error(L, given, "no wafer of the layout has that name (expected WAFER.FIELD=VALUE)");
    }
    if (!wh_layout_has_rims(layout)) {
        refuse_error(
            L, given,
            "no prealigner of the layout has a sensor that would see it, no station beams, no gripper an "
            "edge grip (expected one)");
    }
    if (!wh_rim_draw_concerns(draw, layout->rims[wafer])) {
        refuse_error(L, given, "the wafer's rim has no such thing (expected what it has)");
    }
    check_range(L, given, wh_rim_draw_is_size(draw) ? 0 : -most, most, wh_rim_draw_unit(draw));
    to->rims[wafer][draw] = given->value;
}

/* Gives an error of a beam, like a draw of a trial. False if there is no beam of that name, or no such
 * error. */
static bool give_beam(lua_State *L, const wh_layout_t *layout, const given_t *given, wh_given_t *to) {
    const int32_t beam = wh_layout_find_beam(layout, given->name);
    int draw = 0;
    while (draw < (int)WH_BEAM_DRAWS && strcmp(wh_beam_draw_name((wh_beam_draw_t)draw), given->field) != 0) {
        ++draw;
    }
    if (beam == WH_NONE || draw == (int)WH_BEAM_DRAWS) {
        return false;
    }
    const wh_beam_draw_t of = (wh_beam_draw_t)draw;
    const double most = wh_beam_draw_most(of);
    check_range(L, given, wh_beam_draw_is_size(of) ? 0 : -most, most, wh_beam_draw_unit(of));
    if (!wh_beam_draw_fits(of, &layout->beams[beam], given->value)) {
        refuse_error(L, given,
                     "together with what the layout has of the beam that is out of range (expected less)");
    }
    to->beams[beam][draw] = given->value;
    return true;
}

/* Checks that all given errors of a rim together leave a valid rim, and that each has an effect. */
static void check_rim(lua_State *L, const wh_layout_t *layout, given_t *given, const wh_given_t *to) {
    take_apart(L, given);
    const int draw = find_rim_draw(given->field);
    const int beside = draw == (int)WH_RIM_CHIP_WIDTH || draw == (int)WH_RIM_CHIP_AT ? (int)WH_RIM_CHIP_DEPTH
                       : draw == (int)WH_RIM_SADDLE_AT                               ? (int)WH_RIM_SADDLE
                                                                                     : (int)WH_RIM_DRAWS;
    if (draw == (int)WH_RIM_DRAWS) {
        return;
    }
    const int32_t wafer = wh_layout_find_wafer(layout, given->name);
    if (beside < (int)WH_RIM_DRAWS && to->rims[wafer][beside] == 0) {
        refuse_error(L, given,
                     beside == (int)WH_RIM_SADDLE ? "there is no saddle (expected one, with WAFER.saddle)"
                                                  : "there is no chip (expected one, with WAFER.chip_depth)");
    }
    if (!wh_rim_draw_leaves_rim(to->rims[wafer], layout->rims[wafer])) {
        refuse_error(L, given, "what is given of the rim leaves none (expected smaller errors)");
    }
    wh_rim_t changed = *layout->rims[wafer];
    (void)wh_rim_draw_apply(to->rims[wafer], &changed);
    if (!wh_layout_edges_take(layout, &changed)) {
        refuse_error(L, given, "no edge grip takes a wafer with such a rim (expected smaller errors)");
    }
}

/* The times of all vacuum sensors. False if it is none of them. */
static bool give_time(lua_State *L, given_t *given, wh_given_t *to) {
    const bool is_vacuum = strcmp(given->field, "vacuum") == 0;
    if (given->name[0] != '\0' || (!is_vacuum && strcmp(given->field, "debounce") != 0)) {
        return false;
    }
    check_range(L, given, 0, WH_ERRORS_MOST_S, "s");
    *(is_vacuum ? &to->vacuum : &to->debounce) = (wh_real_t)given->value;
    return true;
}

static void give(lua_State *L, const wh_layout_t *layout, given_t *given, wh_given_t *to) {
    take_apart(L, given);
    const int rim = find_rim_draw(given->field);
    const size_t station = find_part(wh_errors_teaching_name, given->field);
    const size_t wafer = find_part(wafer_name, given->field);
    if (give_beam(L, layout, given, to) || give_time(L, given, to)) {
        return;
    }
    const int32_t taught = station < WH_SPREADS ? find_taught(layout, given->name) : WH_NONE;
    if (taught != WH_NONE) {
        give_taught(L, given, &to->taught[taught], station);
    } else if (station < WH_SPREADS) {
        give_part(L, given, to->stations, wh_layout_find_station(layout, given->name), station);
    } else if (wafer < WH_SPREADS) {
        give_part(L, given, to->wafers, wh_layout_find_wafer(layout, given->name), wafer);
    } else if (rim < (int)WH_RIM_DRAWS) {
        give_rim(L, layout, given, to, (wh_rim_draw_t)rim);
    } else if (strcmp(given->field, "valve") == 0) {
        give_valve(L, layout, given, to);
    } else {
        refuse_error(
            L, given,
            "no such error (expected of a station x, y, z, roll, pitch, yaw, of a wafer dx, dy, dz, tilt_x, "
            "tilt_y, turn, of its rim what a study draws, of a beam such as A.beam1 dx, dy, late, of a "
            "gripper valve, or vacuum or debounce)");
    }
}

void wh_layout_give_errors(lua_State *L, wh_layout_t *layout, const char *const texts[], size_t count) {
    wh_errors_t *errors = wh_layout_memory(L, 1, sizeof *errors);
    wh_given_t *to = wh_layout_memory(L, 1, sizeof *to);
    to->wafers = wh_layout_memory(L, layout->wafer_count, sizeof *to->wafers);
    to->rims = wh_layout_memory(L, layout->wafer_count, sizeof *to->rims);
    to->stations = wh_layout_memory(L, layout->station_count, sizeof *to->stations);
    to->taught = wh_layout_memory(L, layout->station_count * layout->robot_count, sizeof *to->taught);
    errors->robot_count = layout->robot_count;
    for (size_t i = 0; i < count; ++i) {
        given_t given = {.text = texts[i]};
        give(L, layout, &given, to);
    }
    for (size_t i = 0; i < count; ++i) {
        given_t given = {.text = texts[i]};
        check_rim(L, layout, &given, to);
    }
    errors->given = to;
    layout->errors = errors;
}
