/* string: formatted texts show no address, every loop is charged, patterns use pattern.c, and scripts
 * cannot reach the metatable of strings. */
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "pattern.h"
#include "sandbox_internal.h"

/* ------------------------------------------------------------------ rep, format and arithmetic on strings */

/* Lua's own rep takes as long to repeat an empty text as any other. The memory cap bounds everything
 * else. */
static int string_rep(lua_State *L) {
    size_t length = 0, separator = 0;
    luaL_checklstring(L, 1, &length);
    luaL_checkinteger(L, 2);
    luaL_optlstring(L, 3, "", &separator);
    if (length == 0 && separator == 0) {
        lua_pushliteral(L, "");
        return 1;
    }
    return wh_library_call_stock(L);
}

/* The letter of a conversion, past flags, width and precision; text is past the '%'. */
static const char *conversion_letter(const char *text, const char *end) {
    while (text < end && strchr("-+ #0123456789.", *text) != NULL && *text != '\0') {
        ++text;
    }
    return text;
}

/* Replaces an argument of string.format whose text would show an address or the sign of a NaN. */
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
            break; /* Lua's own format raises the error */
        }
        settle_argument(L, *text++, argument);
    }
    return wh_library_call_stock(L);
}

/* "10" ^ 0.5: a power of strings does not reach the virtual machine's own '^'. */
static int power_of_strings(lua_State *L) {
    int is_number[2] = {0, 0};
    lua_settop(L, 2);
    lua_tonumberx(L, 1, &is_number[0]);
    const double exponent = lua_tonumberx(L, 2, &is_number[1]);
    if (is_number[0] && is_number[1] && !(exponent - exponent == 0 && exponent == floor(exponent))) {
        return luaL_error(L, "'^' needs a whole-number exponent; got %f", exponent);
    }
    return wh_library_call_stock(L);
}

/* ----------------------------------------------------------------------------------------- find and match */

/* Converts a start that may count from the end into an offset from the subject's begin; beyond the end if
 * there is none. */
static size_t start_offset(lua_Integer start, size_t length) {
    if (start > 0) {
        return (size_t)start - 1;
    }
    if (start == 0 || start < -(lua_Integer)length) {
        return 0;
    }
    return length + (size_t)start;
}

static bool is_plain(const char *pattern, size_t length) {
    for (size_t i = 0; i < length; ++i) {
        if (pattern[i] != '\0' && strchr("^$*+?.([%-", pattern[i]) != NULL) {
            return false;
        }
    }
    return true;
}

static int find_plain(lua_State *L, const char *subject, size_t length, size_t start) {
    size_t wanted_length = 0;
    const char *const wanted = lua_tolstring(L, 2, &wanted_length);
    wh_sandbox_charge(L, (length - start + wanted_length) >> 4);
    const char *const found =
        wanted_length == 0 ? subject + start : memmem(subject + start, length - start, wanted, wanted_length);
    if (found == NULL) {
        luaL_pushfail(L);
        return 1;
    }
    lua_pushinteger(L, found - subject + 1);
    lua_pushinteger(L, found - subject + (lua_Integer)wanted_length);
    return 2;
}

static int push_found(wh_pattern_t *matcher, const char *begin, const char *end, bool positions) {
    wh_pattern_settle(matcher);
    if (!positions) {
        return wh_pattern_push_captures(matcher, begin, end);
    }
    lua_pushinteger(matcher->L, begin - matcher->subject + 1);
    lua_pushinteger(matcher->L, end - matcher->subject);
    return wh_pattern_push_captures(matcher, NULL, NULL) + 2;
}

/* find and match push different values. Only find has a plain search. */
static int search(lua_State *L, bool find) {
    size_t length = 0, pattern_length = 0;
    const char *const subject = luaL_checklstring(L, 1, &length);
    const char *pattern = luaL_checklstring(L, 2, &pattern_length);
    const size_t start = start_offset(luaL_optinteger(L, 3, 1), length);
    if (start > length) {
        luaL_pushfail(L);
        return 1;
    }
    wh_sandbox_charge(L, pattern_length >> 4);
    if (find && (lua_toboolean(L, 4) || is_plain(pattern, pattern_length))) {
        return find_plain(L, subject, length, start);
    }
    wh_pattern_t matcher;
    wh_pattern_init(&matcher, L, subject, length, pattern, pattern_length);
    const bool anchored = *pattern == '^';
    pattern += anchored;
    for (const char *at = subject + start; at <= matcher.subject_end; ++at) {
        const char *const end = wh_pattern_match(&matcher, at, pattern);
        if (end != NULL) {
            return push_found(&matcher, at, end, find);
        }
        if (anchored) {
            break;
        }
    }
    wh_pattern_settle(&matcher);
    luaL_pushfail(L);
    return 1;
}

static int string_find(lua_State *L) {
    return search(L, true);
}

static int string_match(lua_State *L) {
    return search(L, false);
}

/* ------------------------------------------------------------------------------------------------- gmatch */

typedef struct {
    wh_pattern_t matcher;
    const char *at, *pattern, *last_end;
} walk_t;

/* Upvalues: the subject and the pattern, into which the walk points, and the walk. */
static int gmatch_step(lua_State *L) {
    walk_t *const walk = lua_touserdata(L, lua_upvalueindex(3));
    walk->matcher.L = L;
    walk->matcher.steps = 0;
    for (const char *at = walk->at; at <= walk->matcher.subject_end; ++at) {
        const char *const end = wh_pattern_match(&walk->matcher, at, walk->pattern);
        if (end != NULL && end != walk->last_end) {
            walk->at = walk->last_end = end;
            return push_found(&walk->matcher, at, end, false);
        }
    }
    wh_pattern_settle(&walk->matcher);
    return 0;
}

static int string_gmatch(lua_State *L) {
    size_t length = 0, pattern_length = 0;
    const char *const subject = luaL_checklstring(L, 1, &length);
    const char *const pattern = luaL_checklstring(L, 2, &pattern_length);
    const size_t start = start_offset(luaL_optinteger(L, 3, 1), length);
    lua_settop(L, 2);
    walk_t *const walk = lua_newuserdatauv(L, sizeof *walk, 0);
    wh_pattern_init(&walk->matcher, L, subject, length, pattern, pattern_length);
    walk->at = subject + (start <= length ? start : length + 1);
    walk->pattern = pattern;
    walk->last_end = NULL;
    lua_pushcclosure(L, gmatch_step, 3);
    return 1;
}

/* --------------------------------------------------------------------------------------------------- gsub */

enum { ARG_REPLACEMENT = 3 };

static void add_capture(wh_pattern_t *matcher, luaL_Buffer *made, char digit, const char *begin,
                        const char *end) {
    if (digit == '0') {
        luaL_addlstring(made, begin, (size_t)(end - begin));
    } else if (digit == '%') {
        luaL_addchar(made, '%');
    } else if (isdigit((unsigned char)digit)) {
        wh_pattern_push_capture(matcher, digit - '1', begin, end);
        luaL_tolstring(matcher->L, -1, NULL); /* a position is a number */
        lua_remove(matcher->L, -2);
        luaL_addvalue(made);
    } else {
        luaL_error(matcher->L, "invalid use of '%%' in replacement string");
    }
}

static void add_text(wh_pattern_t *matcher, luaL_Buffer *made, const char *begin, const char *end) {
    size_t length = 0;
    const char *text = lua_tolstring(matcher->L, ARG_REPLACEMENT, &length);
    const char *const text_end = text + length;
    const char *percent = NULL;
    wh_sandbox_charge(matcher->L, length >> 4);
    while ((percent = memchr(text, '%', (size_t)(text_end - text))) != NULL) {
        luaL_addlstring(made, text, (size_t)(percent - text));
        add_capture(matcher, made, percent + 1 < text_end ? percent[1] : '\0', begin, end);
        text = percent + 2;
    }
    luaL_addlstring(made, text, (size_t)(text_end - text));
}

/* The value from a function or a table is on top of the stack. Returns true if it replaces the match. */
static bool add_value(lua_State *L, luaL_Buffer *made, const char *begin, const char *end) {
    if (!lua_toboolean(L, -1)) {
        lua_pop(L, 1);
        luaL_addlstring(made, begin, (size_t)(end - begin));
        return false;
    }
    if (!lua_isstring(L, -1)) {
        luaL_error(L, "invalid replacement value (a %s)", luaL_typename(L, -1));
    }
    luaL_addvalue(made);
    return true;
}

static bool add_replacement(wh_pattern_t *matcher, luaL_Buffer *made, const char *begin, const char *end) {
    lua_State *const L = matcher->L;
    switch (lua_type(L, ARG_REPLACEMENT)) {
    case LUA_TFUNCTION:
        lua_pushvalue(L, ARG_REPLACEMENT);
        lua_call(L, wh_pattern_push_captures(matcher, begin, end), 1);
        return add_value(L, made, begin, end);
    case LUA_TTABLE:
        wh_pattern_push_capture(matcher, 0, begin, end);
        lua_gettable(L, ARG_REPLACEMENT);
        return add_value(L, made, begin, end);
    default:
        add_text(matcher, made, begin, end);
        return true;
    }
}

/* Writes the result into `made` and returns the number of matches. It sets *changed if the result differs
 * from the subject. */
static lua_Integer substitute(wh_pattern_t *matcher, luaL_Buffer *made, const char *pattern, lua_Integer most,
                              bool *changed) {
    const bool anchored = *pattern == '^';
    const char *at = matcher->subject, *last_end = NULL;
    lua_Integer count = 0;
    pattern += anchored;
    while (count < most) {
        const char *const end = wh_pattern_match(matcher, at, pattern);
        if (end != NULL && end != last_end) {
            ++count;
            *changed |= add_replacement(matcher, made, at, end);
            at = last_end = end;
        } else if (at < matcher->subject_end) {
            luaL_addchar(made, *at++);
        } else {
            break;
        }
        if (anchored) {
            break;
        }
    }
    wh_pattern_settle(matcher);
    luaL_addlstring(made, at, (size_t)(matcher->subject_end - at));
    return count;
}

static int string_gsub(lua_State *L) {
    size_t length = 0, pattern_length = 0;
    const char *const subject = luaL_checklstring(L, 1, &length);
    const char *const pattern = luaL_checklstring(L, 2, &pattern_length);
    const int type = lua_type(L, ARG_REPLACEMENT);
    const lua_Integer most = luaL_optinteger(L, 4, (lua_Integer)length + 1);
    luaL_argexpected(
        L, type == LUA_TNUMBER || type == LUA_TSTRING || type == LUA_TFUNCTION || type == LUA_TTABLE,
        ARG_REPLACEMENT, "string/function/table");
    wh_pattern_t matcher;
    luaL_Buffer made;
    bool changed = false;
    wh_pattern_init(&matcher, L, subject, length, pattern, pattern_length);
    luaL_buffinit(L, &made);
    const lua_Integer count = substitute(&matcher, &made, pattern, most, &changed);
    luaL_pushresult(&made);
    if (!changed) {
        lua_pushvalue(L, 1);
    }
    lua_pushinteger(L, count);
    return 2;
}

/* ------------------------------------------------------------------------------------------------ opening */

/* Arithmetic on strings scans them for numbers, so it is charged. */
void wh_library_open_string(lua_State *L) {
    static const luaL_Reg wrapped[] = {{"__pow", power_of_strings}, {NULL, NULL}};
    static const char *const arithmetic[] = {"__add", "__sub", "__mul",  "__div",
                                             "__mod", "__unm", "__idiv", NULL};
    lua_pushliteral(L, "");
    lua_getmetatable(L, -1);
    wh_library_charge_strings(L, arithmetic, 4);
    wh_library_set(L, wrapped);
    lua_pushboolean(L, false);
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 2);
}

const luaL_Reg wh_library_string[] = {
    {"find", string_find}, {"match", string_match}, {"gmatch", string_gmatch},
    {"gsub", string_gsub}, {"rep", string_rep},     {"format", string_format},
    {NULL, NULL}};
