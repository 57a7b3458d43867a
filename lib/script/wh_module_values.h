/* Converts the library's values to and from Lua, with errors that name their field: for the module `wh`,
 * and for motion control's own module. */
#ifndef WH_SCRIPT_WH_MODULE_INTERNAL_H
#define WH_SCRIPT_WH_MODULE_INTERNAL_H

#include <lauxlib.h>
#include <lua.h>

#include "../grasp/grasp.h"
#include "../motion/machine.h"

#if defined(WH_FLOAT)
#error "waferhand: the Lua module's numbers are double; build it and the library without WH_FLOAT"
#endif
#if LUA_VERSION_NUM != 504 || LUA_FLOAT_TYPE != LUA_FLOAT_DOUBLE
#error "waferhand: the Lua module needs Lua 5.4 with double numbers"
#endif

/* The path of a value within an argument, such as inputs[2].pose.R, as a chain of the callers' locals. */
typedef struct wh_field {
    const struct wh_field *of; /* null: the field is the whole argument */
    const char *name;          /* null: an entry of a list; "": an argument without a name */
    lua_Integer index;         /* of the entry, from 1; of a whole argument its number */
} wh_field_t;

/* The text at a stack index of Lua, for looking up a name. If the value is no text or has a byte 0, after
 * which C would not read on, it is empty, and so names nothing. Lua owns it. */
const char *wh_lua_word(lua_State *L, int index);

/* Puts \x00 for each byte 0 of the text at a stack index, so that C reads all of it. */
const char *wh_lua_whole_text(lua_State *L, int index);

/* Makes room for this number of arguments, nil for missing ones; raises if there are more that are not
 * nil. */
void wh_lua_take_at_most(lua_State *L, int count);

static inline wh_field_t wh_lua_argument(const char *name, int number) {
    const wh_field_t field = {NULL, name, number};
    return field;
}

static inline wh_field_t wh_lua_field(const wh_field_t *of, const char *name) {
    const wh_field_t field = {of, name, 0};
    return field;
}

static inline wh_field_t wh_lua_entry(const wh_field_t *of, lua_Integer index) {
    const wh_field_t field = {of, NULL, index};
    return field;
}

/* Raises "bad argument #n to 'f' (path: what)"; `what` is formatted as by lua_pushfstring. It never
 * returns. */
int wh_lua_refuse(lua_State *L, const wh_field_t *at, const char *what, ...);

/* Raises the status of wh_pose_validate. If a number is not finite, the error names that number. It never
 * returns. */
int wh_lua_refuse_pose(lua_State *L, const wh_field_t *at, const wh_pose_t *pose, wh_status_t status);

/* Refuse a value at an absolute stack index that is not a table, and own keys that are not in `names` (null
 * at its end), or not in 1 to `count`. They push nothing. */
void wh_lua_check_record(lua_State *L, int index, const wh_field_t *at, const char *const *names);
void wh_lua_check_list(lua_State *L, int index, const wh_field_t *at, lua_Integer count);

/* The readers take the value on top of the stack and pop it, or refuse it. */
wh_real_t wh_lua_take_number(lua_State *L, const wh_field_t *at);
lua_Integer wh_lua_take_integer(lua_State *L, const wh_field_t *at, lua_Integer first, lua_Integer last,
                                const char *expected);
/* The index of a wafer or a gripper: 1 to `count` in Lua, one less in the result. */
size_t wh_lua_take_index(lua_State *L, const wh_field_t *at, size_t count);
/* Three numbers and three by three; the library checks later whether they are a pose. */
void wh_lua_take_pose(lua_State *L, const wh_field_t *at, wh_pose_t *pose);
/* Refuses what wh_pose_validate refuses. */
void wh_lua_take_valid_pose(lua_State *L, const wh_field_t *at, wh_pose_t *pose);
/* Refuses what wh_tolerance_validate refuses; nil is "paper". */
wh_tolerance_t wh_lua_take_tolerance(lua_State *L, const wh_field_t *at);

/* A field of the table at an absolute index, or `otherwise` if it is nil. */
wh_real_t wh_lua_get_number(lua_State *L, int index, const wh_field_t *of, const char *name,
                            wh_real_t otherwise);

/* Sets a field of the table on top of the stack. */
void wh_lua_set_number(lua_State *L, const char *name, wh_real_t value);
void wh_lua_set_integer(lua_State *L, const char *name, int64_t value);
void wh_lua_set_boolean(lua_State *L, const char *name, bool value);
void wh_lua_set_text(lua_State *L, const char *name, const char *text);
void wh_lua_set_index(lua_State *L, const char *name, int32_t index);
void wh_lua_set_triple(lua_State *L, const char *name, const wh_vec3_t *v);

void wh_lua_push_pose(lua_State *L, const wh_pose_t *pose);
void wh_lua_push_tolerance(lua_State *L, const wh_tolerance_t *tolerance);
/* Pushes the library's index plus one, or nil for WH_NONE. */
void wh_lua_push_index(lua_State *L, int32_t index);

/* Pushes a list. */
void wh_lua_push_numbers(lua_State *L, const wh_real_t numbers[], size_t count);

void wh_lua_push_proximity(lua_State *L, const wh_proximity_t *p);
void wh_lua_push_event(lua_State *L, const wh_event_t *event);

/* wh.cell. */
int wh_lua_cell(lua_State *L);

/* Defines the type of cells in this state. */
void wh_lua_open_cell(lua_State *L);

#endif
