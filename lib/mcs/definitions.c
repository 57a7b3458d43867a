#include "definitions.h"

#include "../layout/layout_fields.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "native.h"

static void push_fields(lua_State *L, const wh_reader_field_t *fields) {
    lua_newtable(L);
    for (lua_Integer i = 0; fields[i].name; ++i) {
        lua_createtable(L, 0, 4);
        wh_lua_set_text(L, "name", fields[i].name);
        wh_lua_set_text(L, "type", fields[i].type);
        wh_lua_set_text(L, "text", fields[i].text);
        wh_lua_set_boolean(L, "required", fields[i].required);
        lua_rawseti(L, -2, i + 1);
    }
}

/* native.classes(): the tables of layouts, a list of { name, text, fields }; fields is a list of
 * { name, type, text, required }. */
static int list_classes(lua_State *L) {
    lua_newtable(L);
    for (lua_Integer i = 0; wh_layout_classes[i].name; ++i) {
        lua_createtable(L, 0, 3);
        wh_lua_set_text(L, "name", wh_layout_classes[i].name);
        wh_lua_set_text(L, "text", wh_layout_classes[i].text);
        push_fields(L, wh_layout_classes[i].fields);
        lua_setfield(L, -2, "fields");
        lua_rawseti(L, -2, i + 1);
    }
    return 1;
}

const luaL_Reg wh_mcs_definition_functions[] = {{"classes", list_classes}, {NULL, NULL}};

/* Runs protected; the argument is where the text goes. */
static int define(lua_State *L) {
    char **text = lua_touserdata(L, 1);
    wh_mcs_push_definitions(L);
    lua_call(L, 0, 1);
    *text = wh_text_copy(luaL_checkstring(L, -1));
    return 0;
}

char *wh_definitions_make(wh_sandbox_result_t *result) {
    static wh_mcs_t mcs;
    wh_record_t record = {0};
    char *text = NULL;
    wh_sandbox_t *sandbox = wh_sandbox_new(NULL);
    if (!sandbox) {
        *result = (wh_sandbox_result_t){.status = WH_SANDBOX_MEMORY, .message = "not enough memory"};
        return NULL;
    }
    if (wh_mcs_open(&mcs, sandbox, "definitions", &record, result)) {
        (void)wh_sandbox_protect(wh_sandbox_state(sandbox), define, &text, result);
        wh_mcs_close(&mcs);
        wh_record_free(&record);
    }
    wh_sandbox_free(sandbox);
    return text;
}
