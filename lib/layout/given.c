#include "given.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "layout_internal.h"

/* One text, taken apart: NAME.FIELD=VALUE, or FIELD=VALUE. */
typedef struct {
    const char *text;
    char name[WH_NAME_SIZE]; /* empty: none */
    char field[WH_NAME_SIZE];
    double value;
} given_t;

static void refuse(lua_State *L, const given_t *given, const char *why) {
    lua_pushfstring(L, "--error %s: %s", given->text, why);
    (void)lua_error(L);
}

/* False if it does not fit. */
static bool take_word(char word[WH_NAME_SIZE], const char *from, const char *to) {
    const size_t length = (size_t)(to - from);
    if (length >= WH_NAME_SIZE) {
        return false;
    }
    memcpy(word, from, length);
    word[length] = '\0';
    return true;
}

/* What stands before the equals sign; false if it does not fit. */
static bool take_names(given_t *given, const char *equals) {
    const char *point = equals;
    while (point > given->text && *point != '.') {
        --point;
    }
    const bool named = *point == '.';
    return take_word(given->name, given->text, named ? point : given->text) &&
           take_word(given->field, named ? point + 1 : given->text, equals);
}

/* A name may have points and equals signs in it: the last ones count. */
static void take_apart(lua_State *L, given_t *given) {
    const char *equals = strrchr(given->text, '=');
    if (!equals || !take_names(given, equals)) {
        refuse(L, given, "no error (expected NAME.FIELD=VALUE, such as A.x=0.12)");
    } else {
        char *end = NULL;
        given->value = strtod(equals + 1, &end);
        if (end == equals + 1 || *end != '\0' || !isfinite(given->value)) {
            refuse(L, given, "no number (expected NAME.FIELD=VALUE, such as A.x=0.12)");
        }
    }
}

static void check_range(lua_State *L, const given_t *given, double least, double most, const char *unit) {
    if (given->value < least || given->value > most) {
        char why[100];
        (void)snprintf(why, sizeof why, "out of range (expected %g to %g %s)", least, most, unit);
        refuse(L, given, why);
    }
}

/* Of wafers, as wh_errors_teaching_name of stations; the first three are mm, the others degrees. */
static const char *wafer_name(size_t part) {
    static const char *const names[] = {"dx", "dy", "dz", "tilt_x", "tilt_y", "turn"};
    return names[part];
}

static size_t find_part(const char *name_of(size_t part), const char *field) {
    size_t part = 0;
    while (part < WH_SPREADS && strcmp(name_of(part), field) != 0) {
        ++part;
    }
    return part;
}

static void give_part(lua_State *L, const given_t *given, wh_displacement_t *all, int32_t index,
                      size_t axis) {
    const double most = axis < 3 ? WH_ERRORS_MOST_MM : WH_ERRORS_MOST_DEG;
    if (index == WH_NONE) {
        refuse(L, given,
               "nothing of the layout has that name (expected a station's, a wafer's, a gripper's)");
    }
    check_range(L, given, -most, most, axis < 3 ? "mm" : "degrees");
    *wh_displacement_part(&all[index], axis) = (wh_real_t)given->value;
}

static void give_valve(lua_State *L, const wh_layout_t *layout, const given_t *given, wh_given_t *to) {
    const int32_t gripper = wh_layout_find_gripper(layout, given->name);
    const double longest = WH_STUDY_LAG_SLICES * (double)layout->slice_us / 1e6;
    if (gripper == WH_NONE) {
        refuse(L, given, "no gripper of the layout has that name (expected GRIPPER.valve=SECONDS)");
    }
    check_range(L, given, 0, longest < WH_ERRORS_MOST_S ? longest : WH_ERRORS_MOST_S, "s");
    to->valves[gripper] = (wh_real_t)given->value;
}

static void give(lua_State *L, const wh_layout_t *layout, given_t *given, wh_given_t *to) {
    take_apart(L, given);
    const size_t station = find_part(wh_errors_teaching_name, given->field);
    const size_t wafer = find_part(wafer_name, given->field);
    if (station < WH_SPREADS) {
        give_part(L, given, to->stations, wh_layout_find_station(layout, given->name), station);
    } else if (wafer < WH_SPREADS) {
        give_part(L, given, to->wafers, wh_layout_find_wafer(layout, given->name), wafer);
    } else if (strcmp(given->field, "valve") == 0) {
        give_valve(L, layout, given, to);
    } else if (strcmp(given->field, "vacuum") == 0 && given->name[0] == '\0') {
        check_range(L, given, 0, WH_ERRORS_MOST_S, "s");
        to->vacuum = (wh_real_t)given->value;
    } else {
        refuse(
            L, given,
            "no such error (expected of a station x, y, z, roll, pitch, yaw, of a wafer dx, dy, dz, tilt_x, "
            "tilt_y, turn, of a gripper valve, or vacuum)");
    }
}

void wh_layout_give_errors(lua_State *L, wh_layout_t *layout, const char *const texts[], size_t count) {
    wh_errors_t *errors = wh_layout_memory(L, 1, sizeof *errors);
    wh_given_t *to = wh_layout_memory(L, 1, sizeof *to);
    to->wafers = wh_layout_memory(L, layout->wafer_count, sizeof *to->wafers);
    to->stations = wh_layout_memory(L, layout->station_count, sizeof *to->stations);
    for (size_t i = 0; i < count; ++i) {
        given_t given = {.text = texts[i]};
        give(L, layout, &given, to);
    }
    errors->given = to;
    layout->errors = errors;
}
