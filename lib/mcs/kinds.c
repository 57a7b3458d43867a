/* Plans of known kinds: where time is counted, a command of a known kind is not planned again.
 *
 * A kind is all that its plan goes by. Here that is the bits of the axes and valves that the command has, and
 * the part of its robot's speeds; lua/mcs/kinds.lua compares the rest. */
#include <string.h>

#include "../layout/grips.h"
#include "native.h"

typedef struct {
    uint32_t axes, grippers; /* bits: whose places and valves follow */
    wh_real_t at[WH_AXES];   /* the others are 0 */
    int32_t valves[WH_GRIPPERS];
    double override;
} stand_t;

typedef struct {
    stand_t stand;
    uint64_t spent; /* of the budget, by planning it */
    size_t count;
    wh_planned_t planned[];
} kind_t;

/* Others' axes and valves change no plan: passive pads would, and are not kept. */
static void take_stand(const wh_mcs_t *mcs, size_t robot, stand_t *stand) {
    const wh_lane_t *lane = mcs->lanes ? wh_mcs_current_lane(mcs) : NULL;
    memset(stand, 0, sizeof *stand);
    stand->axes = lane ? lane->axes : UINT32_MAX;
    stand->grippers = lane ? lane->grippers : UINT32_MAX;
    for (size_t axis = 0; axis < mcs->layout->machine.axis_count; ++axis) {
        stand->at[axis] = (stand->axes >> axis & 1U) != 0 ? mcs->track.axes[axis] : 0;
    }
    for (size_t g = 0; g < mcs->layout->machine.gripper_count; ++g) {
        stand->valves[g] = (stand->grippers >> g & 1U) != 0 ? mcs->track.valves[g] : WH_NONE;
    }
    stand->override = mcs->armed.controllers[robot].override;
}

static bool is_same_stand(const stand_t *a, const stand_t *b) {
    return a->axes == b->axes && a->grippers == b->grippers && memcmp(a->at, b->at, sizeof a->at) == 0 &&
           memcmp(a->valves, b->valves, sizeof a->valves) == 0 &&
           memcmp(&a->override, &b->override, sizeof a->override) == 0;
}

static bool are_kept(const wh_mcs_t *mcs) {
    return mcs->local.counted && !mcs->rehearsal.look_ahead && !wh_layout_has_passive(mcs->layout);
}

/* native.keep_kind(robot): the last rehearsal as a kind, for native.take_kind; nil where none is kept. */
static int keep_kind(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_plan_list_t *planned = &mcs->rehearsal.planned;
    const size_t robot = (size_t)wh_mcs_index(L, 1, WH_MCS_ROBOTS);
    if (!are_kept(mcs)) {
        return 0;
    }
    kind_t *kind = lua_newuserdatauv(L, sizeof *kind + planned->count * sizeof *kind->planned, 0);
    take_stand(mcs, robot, &kind->stand);
    kind->spent = wh_sandbox_spent(mcs->sandbox) - mcs->rehearsal.spent;
    kind->count = planned->count;
    if (planned->count > 0) {
        memcpy(kind->planned, planned->segments, planned->count * sizeof *kind->planned);
    }
    return 1;
}

/* native.take_kind(kind, robot): true if its plan is that of the robot as it stands now; then it can be
 * played like one that was rehearsed. It costs the budget as much as planning it did. */
static int take_kind(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const kind_t *kind = lua_touserdata(L, 1);
    stand_t stand;
    luaL_argexpected(L, kind, 1, "kind");
    take_stand(mcs, (size_t)wh_mcs_index(L, 2, WH_MCS_ROBOTS), &stand);
    const bool is_known = is_same_stand(&stand, &kind->stand);
    if (is_known) {
        wh_rehearsal_take(&mcs->rehearsal, kind->planned, kind->count);
        wh_sandbox_charge(L, kind->spent);
    }
    lua_pushboolean(L, is_known);
    return 1;
}

typedef bool are_alike_t(lua_State *L, int a, int b);

/* The values, at these stack indices, are the same one, or numbers of the same bits. */
static bool is_same_value(lua_State *L, int a, int b) {
    if (lua_type(L, a) == LUA_TNUMBER && lua_type(L, b) == LUA_TNUMBER) {
        const lua_Number one = lua_tonumber(L, a), other = lua_tonumber(L, b);
        return lua_isinteger(L, a) == lua_isinteger(L, b) && memcmp(&one, &other, sizeof one) == 0;
    }
    return lua_rawequal(L, a, b);
}

/* Each field of table `a` is alike in `b`, and `b` has as many. The indices are from the bottom. */
static bool have_alike_fields(lua_State *L, int a, int b, are_alike_t *are_alike) {
    const int top = lua_gettop(L);
    lua_Integer count = 0;
    bool is_alike = true;
    for (lua_pushnil(L); is_alike && lua_next(L, a) != 0; ++count) {
        lua_pushvalue(L, top + 1);
        (void)lua_rawget(L, b);
        is_alike = are_alike(L, top + 2, top + 3);
        lua_settop(L, top + 1);
    }
    lua_settop(L, top);
    for (lua_pushnil(L); is_alike && lua_next(L, b) != 0; lua_pop(L, 1)) {
        is_alike = --count >= 0;
    }
    lua_settop(L, top);
    return is_alike && count == 0;
}

static bool is_same_field(lua_State *L, int a, int b) {
    return is_same_value(L, a, b) ||
           (lua_istable(L, a) && lua_istable(L, b) && have_alike_fields(L, a, b, is_same_value));
}

/* native.is_alike(a, b): the tables have the same fields, to the bit, those of tables in them included. */
static int is_alike(lua_State *L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    luaL_checktype(L, 2, LUA_TTABLE);
    lua_settop(L, 2);
    lua_pushboolean(L, have_alike_fields(L, 1, 2, is_same_field));
    return 1;
}

const luaL_Reg wh_mcs_kind_functions[] = {
    {"keep_kind", keep_kind}, {"take_kind", take_kind}, {"is_alike", is_alike}, {NULL, NULL}};
