/* math: the library's own trigonometry, a random generator with a fixed seed, and no function of libm that
 * differs between machines. */
#include <math.h>

#include "../math/trig.h"
#include "sandbox_internal.h"

/* The largest angle for which wh_sin is accurate, rad. */
#define ANGLE_LIMIT 1e5
/* Any constant is possible, but it must never change. */
#define RANDOM_SEED 20240229

static double check_within(lua_State *L, int argument, double limit) {
    const double value = luaL_checknumber(L, argument);
    if (!(fabs(value) <= limit)) {
        lua_pushfstring(L, "number from %f to %f expected, got %f", -limit, limit, value);
        luaL_argerror(L, argument, lua_tostring(L, -1));
    }
    return value;
}

static int math_sin(lua_State *L) {
    lua_pushnumber(L, wh_sin(check_within(L, 1, ANGLE_LIMIT)));
    return 1;
}

static int math_cos(lua_State *L) {
    lua_pushnumber(L, wh_cos(check_within(L, 1, ANGLE_LIMIT)));
    return 1;
}

static int math_tan(lua_State *L) {
    double sine = 0, cosine = 0;
    wh_sin_cos(check_within(L, 1, ANGLE_LIMIT), &sine, &cosine);
    lua_pushnumber(L, sine / cosine);
    return 1;
}

/* sqrt(1 - x^2) without cancellation near 1. */
static double complement(double x) {
    return sqrt((1 - x) * (1 + x));
}

static int math_asin(lua_State *L) {
    const double x = check_within(L, 1, 1);
    lua_pushnumber(L, wh_atan2(x, complement(x)));
    return 1;
}

static int math_acos(lua_State *L) {
    const double x = check_within(L, 1, 1);
    lua_pushnumber(L, wh_atan2(complement(x), x));
    return 1;
}

static int math_atan(lua_State *L) {
    const double y = luaL_checknumber(L, 1);
    lua_pushnumber(L, wh_atan2(y, luaL_optnumber(L, 2, 1)));
    return 1;
}

static int math_randomseed(lua_State *L) {
    luaL_argcheck(L, !lua_isnone(L, 1), 1, "a seed is needed: without one, no two runs would be the same");
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, 0);
    return 0;
}

void wh_library_start_random(lua_State *L) {
    lua_getglobal(L, LUA_MATHLIBNAME);
    lua_getfield(L, -1, "randomseed");
    lua_pushinteger(L, RANDOM_SEED);
    lua_pushinteger(L, 0);
    lua_call(L, 2, 0);
    lua_pop(L, 1);
}

const luaL_Reg wh_library_math[] = {{"sin", math_sin},
                                    {"cos", math_cos},
                                    {"tan", math_tan},
                                    {"asin", math_asin},
                                    {"acos", math_acos},
                                    {"atan", math_atan},
                                    {"randomseed", math_randomseed},
                                    /* absent: they differ between machines */
                                    {"exp", NULL},
                                    {"log", NULL},
                                    {"log10", NULL},
                                    {"pow", NULL},
                                    {"cosh", NULL},
                                    {"sinh", NULL},
                                    {"tanh", NULL},
                                    {"frexp", NULL},
                                    {"ldexp", NULL},
                                    {NULL, NULL}};
