/* string: no address in a formatted text, no loop that nobody pays for, and a metatable out of reach. */
#include <math.h>
#include <string.h>

#include "sandbox_internal.h"

/* Repeating nothing takes Lua's own rep as long as repeating something; all else its memory bounds. */
static int string_rep(lua_State *L) {
    size_t length = 0, separator = 0;
    luaL_checklstring(L, 1, &length);
    luaL_checkinteger(L, 2);
    luaL_optlstring(L, 3, "", &separator);
    if (length == 0 && separator == 0) {
        lua_pushliteral(L, "");
        return 1;
    }
    return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

/* The letter of the conversion that begins after a '%', past flags, width and precision. */
static const char *conversion_letter(const char *text, const char *end) {
    while (text < end && strchr("-+ #0123456789.", *text) != NULL && *text != '\0') {
        ++text;
    }
    return text;
}

/* Makes an argument of string.format safe to show for this conversion. */
static void settle_argument(lua_State *L, char letter, int argument) {
    const int type = lua_type(L, argument);
    if (letter == 'p') {
        luaL_error(L, "'%%p' is refused: an address differs from run to run");
    } else if (letter == 's' && type > LUA_TBOOLEAN) {
        wh_library_tostring(L, argument, NULL);
        lua_replace(L, argument);
    } else if (type == LUA_TNUMBER && !lua_isinteger(L, argument)) {
        const double value = lua_tonumber(L, argument);
        if (value != value) {
            lua_pushnumber(L, (lua_Number)NAN); /* without the sign that 0/0 has on some machines */
            lua_replace(L, argument);
        }
    }
}

static int string_format(lua_State *L) {
    size_t length = 0;
    const char *text = luaL_checklstring(L, 1, &length);
    const char *const end = text + length;
    const int arguments = lua_gettop(L);
    int argument = 1;
    wh_sandbox_charge(L, length >> 3);
    while ((text = memchr(text, '%', (size_t)(end - text))) != NULL) {
        if (++text < end && *text == '%') {
            ++text;
            continue;
        }
        text = conversion_letter(text, end);
        if (text >= end || ++argument > arguments) {
            break; /* Lua's own format knows what to say */
        }
        settle_argument(L, *text++, argument);
    }
    return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

/* "10" ^ 0.5 does not pass through the virtual machine's own '^'. */
static int power_of_strings(lua_State *L) {
    int is_number[2] = {0, 0};
    lua_settop(L, 2);
    lua_tonumberx(L, 1, &is_number[0]);
    const double exponent = lua_tonumberx(L, 2, &is_number[1]);
    if (is_number[0] && is_number[1] && !(exponent - exponent == 0 && exponent == floor(exponent))) {
        return luaL_error(L, "'^' needs a whole-number exponent; got %f", exponent);
    }
    return lua_tocfunction(L, lua_upvalueindex(1))(L);
}

static void close_over(lua_State *L, const char *name, lua_CFunction wrapper) {
    lua_getfield(L, -1, name);
    lua_pushcclosure(L, wrapper, 1);
    lua_setfield(L, -2, name);
}

/* Arithmetic on strings reads a number from each. */
static void settle_metatable(lua_State *L) {
    static const char *const arithmetic[] = {"__add", "__sub", "__mul",  "__div",
                                             "__mod", "__unm", "__idiv", NULL};
    lua_pushliteral(L, "");
    lua_getmetatable(L, -1);
    wh_library_charge_strings(L, arithmetic, 4);
    close_over(L, "__pow", power_of_strings);
    lua_pushboolean(L, false);
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 2);
}

void wh_library_open_string(lua_State *L, bool trust) {
    static const char *const scanning[] = {"pack", "unpack", "packsize", NULL};
    lua_getglobal(L, LUA_STRLIBNAME);
    close_over(L, "rep", string_rep);
    close_over(L, "format", string_format);
    wh_library_charge_strings(L, scanning, 4);
    if (!trust) {
        lua_pushnil(L);
        lua_setfield(L, -2, "dump");
    }
    lua_pop(L, 1);
    settle_metatable(L);
}
