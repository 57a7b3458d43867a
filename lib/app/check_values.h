/* What a file of checks sees of a recorded run: its JSON as Lua tables that know their names. */
#ifndef WH_APP_CHECK_VALUES_H
#define WH_APP_CHECK_VALUES_H

#include <jansson.h>
#include <lua.h>

/* Pushes a value; null is nil. A field that an object of its kind never has, and a place behind a list's
 * end, raise an error that names what there is: nil would make many an expectation true. Raises if
 * memory runs out. */
void wh_check_push(lua_State *L, json_t *value);

/* Lua's ipairs, which ends such a list where it ends. */
int wh_check_ipairs(lua_State *L);

/* The table below the one at the top has those fields alone that it has now, and those that are the keys of
 * the one at the top, which is taken off. */
void wh_check_make_strict(lua_State *L);

/* Puts a name into the set at the top. */
void wh_check_set_name(lua_State *L, const char *name);

#endif
