#include "wh_module.h"

#include "wh_module_internal.h"

static const struct {
    int number;
    const char *name, *text;
} catalogue[] = {
#define WH_STATUS(number, name, text) {(number), #name, text},
#include "../math/status.def"
#undef WH_STATUS
};

static void push_errors(lua_State *L) {
    lua_newtable(L);
    for (size_t i = 0; i < sizeof catalogue / sizeof catalogue[0]; ++i) {
        lua_createtable(L, 0, 2);
        lua_pushinteger(L, catalogue[i].number);
        lua_setfield(L, -2, "number");
        lua_pushstring(L, catalogue[i].text);
        lua_setfield(L, -2, "text");
        lua_setfield(L, -2, catalogue[i].name);
    }
}

int luaopen_wh(lua_State *L) {
    static const luaL_Reg functions[] = {{"proximity", wh_lua_proximity},
                                         {"rim_gap", wh_lua_rim_gap},
                                         {"tolerance", wh_lua_tolerance},
                                         {"cell", wh_lua_cell},
                                         {NULL, NULL}};
    wh_lua_open_cell(L);
    luaL_newlib(L, functions);
    lua_pushliteral(L, WH_VERSION);
    lua_setfield(L, -2, "version");
    push_errors(L);
    lua_setfield(L, -2, "errors");
    return 1;
}
