/* manual_tables SCRIPT FILE...: runs a Lua script that writes the tables of the manual's chapters anew; see
 * manual_tables.lua beside this file. The script gets what the program goes by: `classes`, the tables of
 * layouts and flows with the rows of their fields, `statuses`, the errors, and `axes`, the usual robot's. */
#include <lauxlib.h>
#include <lualib.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bodies/shapes.h"
#include "grasp/edge.h"
#include "layout/layout.h"
#include "layout/layout_fields.h"
#include "math/status.h"
#include "math/trig.h"
#include "mcs/definitions.h"

/* Defaults that a struct has before it is read, for wafers of 300 mm. */
static wh_tolerance_t tolerance;
static wh_grasp_config_t grasp;
static wh_vacuum_config_t vacuum;
static wh_edge_t edge;
static wh_shapes_t shapes;
static wh_sensor_t sensor;
static wh_notch_shape_t notch;

static const struct {
    const wh_reader_field_t *fields;
    const void *kept;
} begun[] = {{wh_layout_tolerance_fields, &tolerance},  {wh_layout_near_fields, &grasp},
             {wh_layout_vacuum_fields, &vacuum},        {wh_layout_edge_grip_fields, &edge},
             {wh_layout_blade_fields, &shapes.blade},   {wh_layout_arm_fields, &shapes.arm},
             {wh_layout_ledge_fields, &shapes.ledge},   {wh_layout_foup_fields, &shapes.shell},
             {wh_layout_spindle_fields, &shapes.chuck}, {wh_layout_sensor_fields, &sensor},
             {wh_layout_rim_notch_fields, &notch}};

static void begin_all(void) {
    wh_robot_t robot;
    wh_robot_default(&robot);
    tolerance = wh_tolerance_paper();
    grasp = wh_grasp_config_default();
    vacuum = wh_vacuum_delayed();
    edge = wh_edge_default(150);
    shapes = wh_shapes_default(300, 0.775, robot.travel[WH_AXIS_R].max, robot.travel[WH_AXIS_Z].min);
    sensor = wh_sensor_nominal(150);
    notch = wh_rim_nominal(150).notch;
}

static void set_text(lua_State *L, const char *key, const char *text) {
    lua_pushstring(L, text);
    lua_setfield(L, -2, key);
}

static void set_number(lua_State *L, const char *key, double value) {
    lua_pushnumber(L, value);
    lua_setfield(L, -2, key);
}

/* The value without the field; NaN: the row does not say it, and the field's struct does not begin with it. */
static double find_usual(const wh_reader_field_t *row, const wh_reader_field_t *fields) {
    double value = row->kind == WH_SCALAR_BY_HAND ? WH_FIELD_FOLLOWS : row->usual;
    for (size_t i = 0; i < sizeof begun / sizeof begun[0]; ++i) {
        if (begun[i].fields == fields && wh_field_is_member(row) && !isfinite(value)) {
            value = wh_field_get(row, begun[i].kept);
        }
    }
    return value;
}

/* The default as a layout has it; nothing where there is none, or the field is required. */
static void set_usual(lua_State *L, const wh_reader_field_t *row, double value) {
    char text[200];
    if (wh_definitions_usual(row, value, text, sizeof text)) {
        set_text(L, "usual", text);
    }
}

static void push_row(lua_State *L, const wh_reader_field_t *row, const wh_reader_field_t *fields) {
    char type[200], unit[WH_FIELD_UNIT_BYTES];
    lua_newtable(L);
    wh_field_type(row, type, sizeof type);
    wh_field_unit(row, unit);
    set_text(L, "name", row->name);
    set_text(L, "type", type);
    set_text(L, "text", row->text);
    set_text(L, "unit", unit);
    lua_pushboolean(L, row->required);
    lua_setfield(L, -2, "required");
    if (wh_definitions_has_range(row)) {
        set_number(L, "least", row->least);
        set_number(L, "most", row->most);
    }
    set_usual(L, row, find_usual(row, fields));
}

static void push_classes(lua_State *L, const wh_layout_class_t *classes) {
    for (const wh_layout_class_t *class = classes; class->name; ++class) {
        lua_newtable(L);
        set_text(L, "name", class->name);
        set_text(L, "text", class->text);
        lua_newtable(L);
        for (lua_Integer i = 0; class->fields[i].name; ++i) {
            push_row(L, &class->fields[i], class->fields);
            lua_rawseti(L, -2, i + 1);
        }
        lua_setfield(L, -2, "fields");
        lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
    }
}

/* The axes of the usual robot: { name, turns, and travel, home and limits as a layout has them }. */
static void push_axes(lua_State *L) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    wh_robot_t robot;
    wh_robot_default(&robot);
    lua_newtable(L);
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        const bool turns = i == WH_AXIS_THETA || i == WH_AXIS_YAW;
        const double unit = turns ? wh_deg_from_rad(1) : 1;
        lua_newtable(L);
        set_text(L, "name", names[i]);
        lua_pushboolean(L, turns);
        lua_setfield(L, -2, "turns");
        set_number(L, "least", unit * robot.travel[i].min);
        set_number(L, "most", unit * robot.travel[i].max);
        set_number(L, "home", unit * robot.home[i]);
        set_number(L, "speed", unit * robot.limits[i].speed);
        set_number(L, "acceleration", unit * robot.limits[i].acceleration);
        set_number(L, "jerk", unit * robot.limits[i].jerk);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static void push_statuses(lua_State *L) {
    static const struct {
        int number;
        const char *name, *text;
    } statuses[] = {
#define WH_STATUS(number, name, text) {number, #name, text},
#include "math/status.def"
#undef WH_STATUS
    };
    lua_newtable(L);
    for (size_t i = 0; i < sizeof statuses / sizeof statuses[0]; ++i) {
        lua_newtable(L);
        set_number(L, "number", statuses[i].number);
        set_text(L, "name", statuses[i].name);
        set_text(L, "text", statuses[i].text);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

int main(int argc, char **argv) {
    lua_State *L = luaL_newstate();
    int status = 2;
    if (L && argc > 2) {
        luaL_openlibs(L);
        begin_all();
        lua_newtable(L);
        push_classes(L, wh_layout_classes);
        push_classes(L, wh_flow_classes);
        lua_setglobal(L, "classes");
        push_statuses(L);
        lua_setglobal(L, "statuses");
        push_axes(L);
        lua_setglobal(L, "axes");
        if (luaL_loadfile(L, argv[1]) == LUA_OK) {
            for (int i = 2; i < argc; ++i) {
                lua_pushstring(L, argv[i]);
            }
            status = lua_pcall(L, argc - 2, 0, 0) == LUA_OK ? 0 : 1;
        }
        if (lua_gettop(L) > 0) {
            fprintf(stderr, "%s\n", lua_tostring(L, -1));
        }
        lua_close(L);
    }
    return status;
}
