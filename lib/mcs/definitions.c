#include "definitions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/layout_fields.h"
#include "../reading/layout_tool.h"
#include "../reading/tool_routes.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "flow_plan.h"
#include "native.h"

bool wh_definitions_has_range(const wh_reader_field_t *row) {
    return row->least < row->most && !row->words && strcmp(row->type, "boolean") != 0;
}

bool wh_definitions_usual(const wh_reader_field_t *row, double value, char *text, size_t size) {
    if (row->otherwise || row->required || !isfinite(value)) {
        (void)snprintf(text, size, "%s", row->otherwise ? row->otherwise : "");
        return row->otherwise != NULL;
    }
    if (row->words) {
        (void)snprintf(text, size, "\"%s\"", row->words[(size_t)value]);
    } else if (strcmp(row->type, "boolean") == 0) {
        (void)snprintf(text, size, "%s", value > 0 ? "true" : "false");
    } else {
        (void)snprintf(text, size, "%.12g", value);
    }
    return true;
}

static void push_fields(lua_State *L, const wh_reader_field_t *fields) {
    lua_newtable(L);
    for (lua_Integer i = 0; fields[i].name; ++i) {
        char type[200], usual[200];
        const double value = fields[i].kind == WH_SCALAR_BY_HAND ? WH_FIELD_FOLLOWS : fields[i].usual;
        lua_createtable(L, 0, 7);
        wh_lua_set_text(L, "name", fields[i].name);
        wh_field_type(&fields[i], type, sizeof type);
        wh_lua_set_text(L, "type", type);
        wh_lua_set_text(L, "text", fields[i].text);
        wh_lua_set_boolean(L, "required", fields[i].required);
        if (wh_definitions_has_range(&fields[i])) {
            wh_lua_set_number(L, "least", fields[i].least);
            wh_lua_set_number(L, "most", fields[i].most);
        }
        if (wh_definitions_usual(&fields[i], value, usual, sizeof usual)) {
            wh_lua_set_text(L, "usual", usual);
        }
        lua_rawseti(L, -2, i + 1);
    }
}

const wh_layout_class_t wh_flow_classes[] = {
    {"timed_layout", "A cell whose robots are times alone.", wh_layout_timed_fields},
    {"timed_study", "The errors that trials of such a cell draw.", wh_layout_timed_study_fields},
    {"timed_timing", "Widths of times in it.", wh_layout_timed_timing_fields},
    {"timed_robot", "A robot that is times alone.", wh_layout_timed_robot_fields},
    {"timed_station", "A station of such a cell.", wh_layout_timed_station_fields},
    {"timed_by", "How one of several robots comes to it.", wh_layout_timed_by_fields},
    {"timed_door", "Times of a door.", wh_layout_timed_door_fields},
    {"timed_way", "How a robot that is times alone comes to a station of a cell with axes.",
     wh_layout_timed_way_fields},
    {"pump", "Times of a load lock.", wh_layout_pump_fields},
    {"flow", "Lots along their routes.", wh_flow_fields},
    {"lot", "Wafers that arrive together.", wh_flow_lot_fields},
    {"step", "One station of a route, or parallel ones, by numbers from 1.", wh_flow_step_fields},
    {"route", "Steps by numbers from 1: a station's name or a waferhand.step.", wh_flow_route_fields},
    {"lists", "Each robot's transfers in order.", wh_flow_list_fields},
    {"down", "A station, at 1, that fails for a while; or a robot that begins nothing meanwhile.",
     wh_flow_down_fields},
    {NULL, NULL, NULL}};

static void push_classes(lua_State *L, const wh_layout_class_t *classes, lua_Integer first) {
    for (lua_Integer i = 0; classes[i].name; ++i) {
        lua_createtable(L, 0, 3);
        wh_lua_set_text(L, "name", classes[i].name);
        wh_lua_set_text(L, "text", classes[i].text);
        push_fields(L, classes[i].fields);
        lua_setfield(L, -2, "fields");
        lua_rawseti(L, -2, first + i);
    }
}

/* native.classes(): the tables of layouts and flows, a list of { name, text, fields }; fields is a list of
 * { name, type, text, required, least and most of a number, usual = the default in words }. */
static int list_classes(lua_State *L) {
    lua_Integer count = 0;
    while (wh_layout_classes[count].name) {
        ++count;
    }
    lua_newtable(L);
    push_classes(L, wh_layout_classes, 1);
    push_classes(L, wh_flow_classes, count + 1);
    return 1;
}

const luaL_Reg wh_mcs_definition_functions[] = {{"classes", list_classes}, {NULL, NULL}};

/* Runs protected; the argument is where the text goes. */
static int define_words(lua_State *L) {
    char **text = lua_touserdata(L, 1);
    wh_mcs_push_definitions(L);
    lua_call(L, 0, 1);
    *text = wh_text_copy(luaL_checkstring(L, -1));
    return 0;
}

char *wh_definitions_make(wh_sandbox_result_t *result) {
    wh_mcs_t *mcs = wh_array_new(1, sizeof *mcs);
    wh_record_t record = {0};
    char *text = NULL;
    wh_sandbox_t *sandbox = wh_sandbox_new(NULL);
    if (!sandbox) {
        *result = (wh_sandbox_result_t){.status = WH_SANDBOX_MEMORY, .message = "not enough memory"};
        free(mcs);
        return NULL;
    }
    if (wh_mcs_open(mcs, sandbox, "definitions", &record, result)) {
        (void)wh_sandbox_protect(wh_sandbox_state(sandbox), define_words, &text, result);
        wh_mcs_close(mcs);
        wh_record_free(&record);
    }
    wh_sandbox_free(sandbox);
    free(mcs);
    return text;
}
