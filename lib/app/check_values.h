/* A recorded run for a file of checks: its JSON as Lua tables that know their names. */
#ifndef WH_APP_CHECK_VALUES_H
#define WH_APP_CHECK_VALUES_H

#include <jansson.h>
#include <lua.h>

/* Pushes a value; null is nil. A field that an object of its kind never has, and a place behind a list's
 * end, raise an error that lists the valid ones: with nil many expectations would be true. Raises if memory
 * runs out. */
void wh_check_push(lua_State *L, json_t *value);

/* A function for Lua: makes its argument, a table, such a list, and returns it. */
int wh_check_make_list(lua_State *L);

/* Like Lua's ipairs, and ends at the end of such a list. */
int wh_check_ipairs(lua_State *L);

/* Fixes the fields of the table below the top one: it has only its present fields and the keys of the top
 * table, which is popped. */
void wh_check_make_strict(lua_State *L);

/* Puts a name into the set at the top. */
void wh_check_set_name(lua_State *L, const char *name);

#endif
