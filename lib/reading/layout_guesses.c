/* Given numbers that are valid and look as if they were in another unit: in radians, in metres or per
 * metre, in milliseconds, or in micrometres a second. The rows of layout_fields.c say where they may stand
 * and in which unit. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../math/trig.h"
#include "layout_internal.h"

#define CLASS "waferhand."

/* An angle this near to a multiple of 30 or 45 degrees in radians was probably meant in radians. Numbers
 * of a quarter turn and more are often given with two digits. */
#define NEAR_RAD 1e-3
#define NEAR_ROUNDED 2e-3

/* An axis whose whole travel is less was probably meant in radians, degrees, or in metres, mm. */
#define SHORT_TURN 20
#define SHORT_WAY 10

/* All sizes of a body in metres are below this, mm. */
#define SMALL_BODY 2

/* No length is so many times shorter than its default, but in metres. */
#define SHORT_LENGTH 500

/* Robots and rails in metres stand nearer to base's origin than this, mm; gaps in metres are below it. */
#define NEAR_PLACE 5
#define SMALL_GAP 0.02

/* No wafer robot is so many times slower than usual. Radians are a 57th of the degrees, metres a
 * thousandth of the mm. */
#define SLOW_TURNING 50
#define SLOW_STRAIGHT 100

/* Nor is one so many times faster. Micrometres and millidegrees are a thousand times as many. */
#define FAST 200

/* From so many seconds on a time was probably meant in milliseconds: by the field. */
static const struct {
    const char *name;
    double seconds;
} long_times[] = {{"slice", 0.1}, {"vacuum_delay", 20}, {"timeout", 60}, {"wait", 100},
                  {"build", 10},  {"vent", 10},         {"seconds", 100}};

/* The usual limits of an axis. */
typedef struct {
    const char *name; /* the field that is its table, or the class of that table */
    double limits[3]; /* speed, acceleration, jerk; 0: not looked at */
} usual_t;

static const usual_t usual_axes[] = {
    {"theta", {300, 1000, 10000}},   {"r", {1000, 5000, 50000}},
    {"z", {400, 2000, 20000}},       {"yaw", {360, 1500, 15000}},
    {"forearm", {360, 1500, 15000}}, {"rail", {1000, 3000, 30000}},
    {"tilt", {10, 50, 500}},         {"flip", {180, 720, 7200}},
    {"chuck", {360, 1500, 15000}},   {"flipper", {180, 720, 7200}},
    {"stage", {50, 500, 5000}},      {"pins", {50, 500, 5000}},
    {"loaded", {1000, 2000, 20000}}, {NULL, {0, 0, 0}},
};

/* A walk over the tables that were given. The texts are in the Lua table at `list`. */
typedef struct {
    wh_reader_t *reader;
    int list;
} walk_t;

__attribute__((format(printf, 3, 4))) static void add(const walk_t *walk, const char *field,
                                                      const char *format, ...) {
    lua_State *L = walk->reader->L;
    const char *path = walk->reader->path;
    char text[200];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    lua_pushfstring(L, "%s%s%s: %s", path, path[0] && field[0] && field[0] != '[' ? "." : "", field, text);
    lua_rawseti(L, walk->list, (lua_Integer)lua_rawlen(L, walk->list) + 1);
}

static bool says(const wh_reader_field_t *row, const char *word) {
    return strstr(row->text, word) != NULL;
}

/* ------------------------------------------------------------------------------------------------- angles */

static bool is_of_angle(const wh_reader_field_t *row) {
    return says(row, "degrees") && !says(row, "degrees/s") && !says(row, "degrees or mm");
}

/* The degrees that a number in radians probably means; 0: none. */
static int degrees_meant(double value) {
    for (int degrees = 30; degrees <= 360; degrees += 15) {
        const double off = fabs(fabs(value) - (double)wh_rad_from_deg(degrees));
        if (off < (degrees < 90 ? NEAR_RAD : NEAR_ROUNDED) && (degrees % 30 == 0 || degrees % 45 == 0)) {
            return value < 0 ? -degrees : degrees;
        }
    }
    return 0;
}

static void look_at_angle(const walk_t *walk, const char *field, double value) {
    const int degrees = degrees_meant(value);
    if (degrees != 0) {
        add(walk, field, "%.10g looks like radians (expected degrees: %d)", value, degrees);
    }
}

/* --------------------------------------------------------------------------------------------------- axes */

static const usual_t *find_usual(const char *name) {
    const usual_t *usual = usual_axes;
    while (usual->name && strcmp(usual->name, name) != 0) {
        ++usual;
    }
    return usual;
}

/* The number in a field of the table on top of the stack; NaN if there is none. */
static double number_in(const walk_t *walk, const char *field) {
    lua_State *L = walk->reader->L;
    const double value =
        wh_reader_push(walk->reader, field) == LUA_TNUMBER ? lua_tonumber(L, -1) : (double)NAN;
    lua_pop(L, 1);
    return value;
}

static void look_at_limits(const walk_t *walk, const usual_t *usual, bool turns) {
    static const char *const names[] = {"speed", "acceleration", "jerk"};
    static const char *const per[] = {"s", "s^2", "s^3"};
    for (size_t i = 0; i < 3; ++i) {
        const double value = number_in(walk, names[i]);
        if (value < usual->limits[i] / (turns ? SLOW_TURNING : SLOW_STRAIGHT)) {
            add(walk, names[i], "%.10g looks like %s/%s (expected %s/%s; usual are %.10g)", value,
                turns ? "rad" : "m", per[i], turns ? "degrees" : "mm", per[i], usual->limits[i]);
        } else if (usual->limits[i] > 0 && value > usual->limits[i] * FAST) {
            add(walk, names[i], "%.10g looks like %s/%s (expected %s/%s; usual are %.10g)", value,
                turns ? "millidegrees" : "um", per[i], turns ? "degrees" : "mm", per[i], usual->limits[i]);
        }
    }
}

static void look_at_travel(const walk_t *walk, bool turns) {
    const double travel = number_in(walk, "max") - number_in(walk, "min");
    if (travel > 0 && travel < (turns ? SHORT_TURN : SHORT_WAY)) {
        add(walk, "max", "%.10g, %.10g above min, looks like %s (expected %s)", number_in(walk, "max"),
            travel, turns ? "radians" : "metres", turns ? "degrees" : "mm");
    }
}

/* Looks at the table of an axis, on top of the stack: that of a field with this name. */
static void look_at_axis(const walk_t *walk, const char *name, const wh_reader_field_t *rows) {
    const usual_t *usual = find_usual(name);
    const wh_reader_field_t *speed = rows;
    while (speed->name && strcmp(speed->name, "speed") != 0) {
        ++speed;
    }
    if (usual->name && speed->name) {
        const bool turns = says(speed, "degrees/s");
        look_at_limits(walk, usual, turns);
        if (strcmp(name, "tilt") != 0) {
            look_at_travel(walk, turns);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ lengths */

/* A length, or a speed, far below its row's default, or below what its kind may be. */
static void look_at_length(const walk_t *walk, const char *name, const wh_reader_field_t *row, double value) {
    char unit[WH_FIELD_UNIT_BYTES];
    wh_field_unit(row, unit);
    const bool is_scalar = row->kind == WH_SCALAR_NUMBER && isfinite(row->usual) && row->usual > 0;
    const bool is_gap = strcmp(name, "clearance") == 0;
    const bool is_rail = says(row, "rail stands for it");
    const double least = is_scalar ? row->usual / SHORT_LENGTH
                         : is_gap  ? SMALL_GAP
                         : is_rail ? NEAR_PLACE
                                   : 0;
    if (strncmp(unit, "mm", 2) == 0 && value != 0 && fabs(value) < least) {
        add(walk, row->name, "%.10g looks like %s (expected %s)", value,
            unit[2] == '\0' ? "metres" : unit + 1, unit);
    }
}

/* The cleans of a station and the stays in it may be long. */
static void look_at_time(const walk_t *walk, const char *name, const wh_reader_field_t *row, double value) {
    char unit[WH_FIELD_UNIT_BYTES];
    wh_field_unit(row, unit);
    for (size_t i = 0; i < sizeof long_times / sizeof long_times[0]; ++i) {
        if (strcmp(unit, "s") == 0 && strcmp(row->name, long_times[i].name) == 0 &&
            strcmp(name, "clean") != 0 && value >= long_times[i].seconds) {
            add(walk, row->name, "%.10g looks like milliseconds (expected s)", value);
        }
    }
}

/* The place of a robot, on top of the stack. */
static void look_at_place(const walk_t *walk, const char *field) {
    lua_State *L = walk->reader->L;
    double most = 0;
    for (lua_Integer i = 1; i <= 3; ++i) {
        lua_rawgeti(L, -1, i);
        most = fmax(most, fabs(lua_tonumber(L, -1)));
        lua_pop(L, 1);
    }
    if (most > 0 && most < NEAR_PLACE) {
        add(walk, field, "%.10g at most looks like metres (expected mm)", most);
    }
}

/* ------------------------------------------------------------------------------------------------- bodies */

static void look_at_sizes(const walk_t *walk, const char *field) {
    lua_State *L = walk->reader->L;
    double most = 0;
    for (lua_Integer i = 1; i <= 3; ++i) {
        lua_rawgeti(L, -1, i);
        most = fmax(most, lua_tonumber(L, -1));
        lua_pop(L, 1);
    }
    if (most < SMALL_BODY) {
        add(walk, field, "%.10g at most looks like metres (expected mm)", most);
    }
}

/* --------------------------------------------------------------------------------------------------- walk */

static const wh_reader_field_t *fields_of(const char *type) {
    const char *name = strstr(type, CLASS);
    const wh_layout_class_t *class = wh_layout_classes;
    const size_t length = name ? strcspn(name + strlen(CLASS), "[]>|") : 0;
    while (name && class->name &&
           !(strlen(class->name) == length && memcmp(class->name, name + strlen(CLASS), length) == 0)) {
        ++class;
    }
    return name ? class->fields : NULL;
}

static void look_at_table(const walk_t *walk, const char *name, const wh_reader_field_t *rows);

/* The value on top of the stack, of a field or of one of its entries, becomes the table being read. */
static void look_into(const walk_t *walk, const char *key, const char *name, const wh_reader_field_t *rows) {
    wh_reader_t *reader = walk->reader;
    const size_t length = strlen(reader->path);
    if (lua_type(reader->L, -1) == LUA_TTABLE) {
        luaL_checkstack(reader->L, 10, "layout nested too deeply");
        (void)snprintf(reader->path + length, sizeof reader->path - length, "%s%s",
                       length > 0 && key[0] != '[' ? "." : "", key);
        look_at_table(walk, name, rows);
        reader->path[length] = '\0';
    }
}

/* A table by names or a list, on top of the stack. */
static void look_at_entries(const walk_t *walk, const char *field, const wh_reader_field_t *rows) {
    lua_State *L = walk->reader->L;
    wh_reader_t *reader = walk->reader;
    const size_t length = strlen(reader->path);
    (void)snprintf(reader->path + length, sizeof reader->path - length, "%s%s", length > 0 ? "." : "", field);
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        char key[80];
        if (lua_type(L, -2) == LUA_TSTRING) {
            (void)snprintf(key, sizeof key, "%.60s", lua_tostring(L, -2));
        } else {
            (void)snprintf(key, sizeof key, "[%lld]", (long long)lua_tointeger(L, -2));
        }
        look_into(walk, key, field, rows);
    }
    reader->path[length] = '\0';
}

static void look_at_triple(const walk_t *walk, const wh_reader_field_t *row) {
    lua_State *L = walk->reader->L;
    if (strcmp(row->name, "box") == 0) {
        look_at_sizes(walk, row->name);
    }
    if (says(row, "where the robot stands")) {
        look_at_place(walk, row->name);
    }
    for (lua_Integer i = 1; i <= 3 && is_of_angle(row); ++i) {
        char field[40];
        (void)snprintf(field, sizeof field, "%s[%d]", row->name, (int)i);
        lua_rawgeti(L, -1, i);
        look_at_angle(walk, field, lua_tonumber(L, -1));
        lua_pop(L, 1);
    }
}

/* Looks at the field of the table `name` whose value is on top of the stack. */
static void look_at_field(const walk_t *walk, const char *name, const wh_reader_field_t *row) {
    lua_State *L = walk->reader->L;
    const wh_reader_field_t *rows = fields_of(row->type);
    if (lua_type(L, -1) == LUA_TNUMBER && is_of_angle(row)) {
        look_at_angle(walk, row->name, lua_tonumber(L, -1));
    } else if (lua_type(L, -1) == LUA_TNUMBER) {
        look_at_length(walk, name, row, lua_tonumber(L, -1));
        look_at_time(walk, name, row, lua_tonumber(L, -1));
    } else if (lua_type(L, -1) != LUA_TTABLE) {
        return;
    } else if (rows && (strncmp(row->type, "table<", 6) == 0 || strstr(row->type, "[]"))) {
        look_at_entries(walk, row->name, rows);
    } else if (rows) {
        look_into(walk, row->name, row->name, rows);
    } else if (strcmp(row->type, "number[]") == 0) {
        look_at_triple(walk, row);
    }
}

static void look_at_table(const walk_t *walk, const char *name, const wh_reader_field_t *rows) {
    lua_State *L = walk->reader->L;
    for (const wh_reader_field_t *row = rows; row->name; ++row) {
        (void)wh_reader_push(walk->reader, row->name);
        look_at_field(walk, name, row);
        lua_pop(L, 1);
    }
    look_at_axis(walk, name, rows);
}

static int compare_texts(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

void wh_layout_guess_units(wh_reader_t *reader, wh_layout_t *layout) {
    lua_State *L = reader->L;
    const walk_t walk = {reader, lua_gettop(L) + 1};
    lua_newtable(L);
    lua_pushvalue(L, -2);
    look_at_table(&walk, "", wh_layout_top_fields);
    lua_pop(L, 1);
    layout->guess_count = (size_t)lua_rawlen(L, -1);
    layout->guesses = wh_layout_memory(L, layout->guess_count, sizeof *layout->guesses);
    for (size_t i = 0; i < layout->guess_count; ++i) {
        lua_rawgeti(L, -1, (lua_Integer)i + 1);
        const char *text = lua_tostring(L, -1);
        layout->guesses[i] = memcpy(wh_layout_memory(L, strlen(text) + 1, 1), text, strlen(text) + 1);
        lua_pop(L, 1);
    }
    qsort(layout->guesses, layout->guess_count, sizeof *layout->guesses, compare_texts);
    lua_pop(L, 1);
}
