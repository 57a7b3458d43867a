/* Planning: where the axes must go, segments as Lua asks for them, and rehearsals. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../layout/axes.h"
#include "../layout/transit.h"
#include "../layout/travel.h"
#include "../math/trig.h"
#include "../script/wh_module_values.h"
#include "carrying.h"
#include "native.h"
#include "playing.h"

/* native.axes(): where all axes stand, rad and mm. */
static int read_axes(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_lua_push_numbers(L, mcs->track.axes, mcs->layout->machine.axis_count);
    return 1;
}

/* Raises the error of a request, the table at stack index 1. Its `where` and its `target` say where the arm
 * would be: "on the way into A slot 3". */
static void refuse(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const char *reason) {
    lua_getfield(L, 1, "where");
    if (lua_isstring(L, -1) && lua_getfield(L, 1, "target") == LUA_TTABLE) {
        lua_getfield(L, -1, "station");
        lua_getfield(L, -2, "slot");
        lua_pushfstring(L, "%s %s slot %d%s%s", lua_tostring(L, -4), lua_tostring(L, -2),
                        (int)lua_tointeger(L, -1), reason[0] ? ": " : "", reason);
        reason = lua_tostring(L, -1);
    }
    wh_mcs_raise(L, mcs, status, reason[0] ? reason : NULL);
}

/* Of a goal that is before a slot, the request's `place` says how a robot with a carrier comes there: the
 * table at stack index 2 has it. The flip stays as it is at these axes. False: it has none. */
static bool read_pose(lua_State *L, const wh_travel_goal_t *goal, const wh_carrier_t *carrier,
                      const wh_real_t axes[], wh_pose_t *pose, wh_chain_choice_t *choice) {
    if (lua_getfield(L, 2, "place") != LUA_TTABLE) {
        return false;
    }
    pose->R = wh_mat3_about_z(goal->heading);
    pose->r = goal->at;
    *choice = wh_carrier_choice(carrier, axes);
    lua_getfield(L, -1, "rail");
    choice->rail = luaL_checknumber(L, -1);
    lua_getfield(L, -2, "elbow");
    choice->elbow = (wh_elbow_t)luaL_checkinteger(L, -1);
    if (lua_getfield(L, -3, "rotation") == LUA_TTABLE) {
        for (int i = 0; i < 9; ++i) {
            lua_rawgeti(L, -1, i + 1);
            pose->R.m[i / 3][i % 3] = luaL_checknumber(L, -1);
            lua_pop(L, 1);
        }
    }
    if (carrier->chain.has_flip) {
        wh_chain_turn_over(&pose->R, choice->flip);
    }
    return true;
}

/* native.inverse(request): the axes with the gripper of request.to there, from request.from, or from where
 * they stand. */
static int find_axes(lua_State *L) {
    static const char *const fields[] = {"x", "y", "z", "heading"};
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_machine_t *machine = &mcs->layout->machine;
    wh_real_t to[4], from[WH_AXES], axes[WH_AXES];
    wh_pose_t pose;
    wh_chain_choice_t choice;
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 1);
    memcpy(from, mcs->track.axes, sizeof from);
    lua_getfield(L, 1, "from");
    if (lua_istable(L, -1)) {
        wh_mcs_read_numbers(L, lua_gettop(L), from, machine->axis_count);
    }
    lua_settop(L, 1);
    lua_getfield(L, 1, "to");
    for (size_t i = 0; i < 4; ++i) {
        lua_getfield(L, 2, fields[i]);
        to[i] = luaL_checknumber(L, -1);
    }
    lua_getfield(L, 2, "gripper");
    wh_travel_goal_t goal = {(size_t)wh_mcs_index(L, -1, machine->gripper_count),
                             wh_vec3(to[0], to[1], to[2]), to[3], NULL, NULL};
    size_t first;
    const wh_carrier_t *carrier = wh_machine_carrier(machine, machine->mounts[goal.gripper].robot, &first);
    if (carrier && read_pose(L, &goal, carrier, &from[first], &pose, &choice)) {
        goal.pose = &pose;
        goal.choice = &choice;
    }
    memcpy(axes, from, sizeof axes);
    const wh_status_t status = wh_travel_find(mcs->layout, &goal, from, axes);
    if (status != WH_OK) {
        char reason[WH_TRAVEL_BYTES];
        wh_travel_say_point(mcs->layout, &goal, from, reason);
        refuse(L, mcs, status, reason);
    }
    wh_lua_push_numbers(L, axes, machine->axis_count);
    return 1;
}

/* ------------------------------------------------------------------------------------------------ reading */

static void read_axes_field(lua_State *L, const wh_mcs_t *mcs, wh_segment_t *segment) {
    segment->kind = WH_SEGMENT_AXES;
    wh_mcs_read_numbers(L, lua_gettop(L), segment->target, mcs->layout->machine.axis_count);
}

/* A leg that turns must be within the transit as a whole: by via points nothing comes in by itself. */
static void check_legs(lua_State *L, wh_mcs_t *mcs, size_t robot, const wh_segment_t *segment) {
    const wh_layout_t *layout = mcs->layout;
    size_t first = 0;
    (void)wh_machine_carrier(&layout->machine, robot, &first);
    const wh_real_t *from = &mcs->track.axes[first];
    for (size_t i = 0; i <= segment->point_count; ++i) {
        const wh_real_t *to = i < segment->point_count ? segment->points[i].q : &segment->target[first];
        wh_transit_t transit;
        if (wh_transit_leaves(layout, robot, from, to, &transit)) {
            char reason[WH_TRAVEL_BYTES];
            snprintf(
                reason, sizeof reason,
                "leg %zu by `via` turns with r at %.6g mm: beyond `%s%s.transit` of %.10g mm nothing may",
                i + 1, transit.r, layout->robot_count > 1 ? "robots." : "", layout->robots[robot].name,
                layout->robots[robot].transit);
            refuse(L, mcs, WH_STATUS_OUT_OF_REACH, reason);
        }
        from = to;
    }
}

/* Where the robot turns before a point or behind it, the arm is within the circle before it may go on. */
static void limit_corners(wh_mcs_t *mcs, size_t robot, const wh_segment_t *segment) {
    const wh_layout_t *layout = mcs->layout;
    size_t first = 0;
    (void)wh_machine_carrier(&layout->machine, robot, &first);
    const wh_real_t *from = &mcs->track.axes[first];
    for (size_t i = 0; i < segment->point_count; ++i) {
        wh_via_point_t *point = &mcs->via_points[i];
        const bool is_last = i + 1 == segment->point_count;
        const wh_real_t *to = is_last ? &segment->target[first] : mcs->via_points[i + 1].q;
        memset(point->reach, 0, sizeof point->reach);
        if (wh_transit_corner(layout, robot, from, point->q, to, point->reach)) {
            point->reach[0] = wh_real_max(point->reach[0], WH_SLACK_MM);
            point->reach[1] = wh_real_max(point->reach[1], WH_SLACK_MM);
        }
        from = point->q;
    }
}

/* A point at the top of the stack: the robot's own axes in order, and `blend`. */
static void read_point(lua_State *L, wh_via_point_t *point, size_t axis_count) {
    for (size_t axis = 0; axis < axis_count; ++axis) {
        lua_rawgeti(L, -1, (lua_Integer)axis + 1);
        point->q[axis] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
    lua_getfield(L, -1, "blend");
    point->blend = luaL_checknumber(L, -1);
    lua_pop(L, 1);
}

/* The request's `via`, a list of points, and the `robot` that goes by them. False: it has none. */
static bool read_vias(lua_State *L, wh_mcs_t *mcs, wh_segment_t *segment) {
    lua_settop(L, 1);
    if (lua_getfield(L, 1, "via") != LUA_TTABLE) {
        return false;
    }
    lua_getfield(L, 2, "robot");
    const size_t robot = (size_t)wh_mcs_index(L, -1, mcs->layout->robot_count);
    lua_settop(L, 2);
    size_t first;
    const wh_carrier_t *carrier = wh_machine_carrier(&mcs->layout->machine, robot, &first);
    segment->kind = WH_SEGMENT_VIA;
    segment->gripper = wh_layout_first_gripper(mcs->layout, robot);
    segment->points = mcs->via_points;
    segment->point_count = (size_t)lua_rawlen(L, -1);
    for (size_t i = 0; i < segment->point_count && i < WH_VIA_POINTS; ++i) {
        lua_rawgeti(L, 2, (lua_Integer)i + 1);
        read_point(L, &mcs->via_points[i], carrier ? carrier->axis_count : WH_ROBOT_AXES);
        lua_pop(L, 1);
    }
    lua_settop(L, 1);
    check_legs(L, mcs, robot, segment);
    limit_corners(mcs, robot, segment);
    return true;
}

static void read_line_field(lua_State *L, wh_segment_t *segment) {
    wh_real_t *const parts[] = {&segment->travel.x, &segment->travel.y, &segment->travel.z};
    segment->kind = WH_SEGMENT_LINE;
    for (int i = 0; i < 3; ++i) {
        lua_rawgeti(L, -1, i + 1);
        *parts[i] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
    lua_getfield(L, 1, "speed");
    segment->speed = luaL_optnumber(L, -1, 0);
    lua_getfield(L, 1, "acceleration");
    segment->acceleration = luaL_optnumber(L, -1, 0);
    lua_getfield(L, 1, "gripper");
    segment->gripper = (int32_t)luaL_optinteger(L, -1, 0) - 1;
    lua_pop(L, 3);
}

static void read_valves_field(lua_State *L, wh_segment_t *segment) {
    segment->kind = WH_SEGMENT_VALVES;
    for (int g = 0; g < WH_GRIPPERS; ++g) {
        lua_rawgeti(L, -1, g + 1);
        segment->valves[g] = (int32_t)luaL_optinteger(L, -1, WH_NONE);
        lua_pop(L, 1);
    }
}

static void read_sensor_field(lua_State *L, wh_segment_t *segment) {
    segment->kind = WH_SEGMENT_SENSOR;
    segment->gripper = (int32_t)luaL_checkinteger(L, -1) - 1;
    lua_getfield(L, 1, "timeout");
    segment->seconds = luaL_checknumber(L, -1);
    lua_pop(L, 1);
}

/* By via points, within the transit, or straight there. */
static void read_motion(lua_State *L, wh_mcs_t *mcs, wh_segment_t *segment) {
    read_axes_field(L, mcs, segment);
    if (!read_vias(L, mcs, segment) && lua_getfield(L, 1, "stays") != LUA_TBOOLEAN) {
        wh_transit_keep(mcs->layout, mcs->track.axes, segment);
    }
}

/* The segment table at stack index 1: one of axes, line (with speed, acceleration and the gripper that
 * goes), valves, dwell, sensor (with timeout), arrives (likewise). Raises if it is none. */
static wh_segment_t read_segment(lua_State *L, wh_mcs_t *mcs, wh_awaited_t *awaited) {
    static const char *const kinds[] = {"axes", "line", "valves", "dwell", "sensor", "arrives"};
    wh_segment_t segment = wh_track_blank(&mcs->track);
    size_t kind = 0;
    luaL_checktype(L, 1, LUA_TTABLE);
    while (kind < 6 && lua_getfield(L, 1, kinds[kind]) == LUA_TNIL) {
        lua_pop(L, 1);
        ++kind;
    }
    switch (kind) {
    case 0:
        read_motion(L, mcs, &segment);
        break;
    case 1:
        read_line_field(L, &segment);
        break;
    case 2:
        read_valves_field(L, &segment);
        break;
    case 3:
        segment.seconds = luaL_checknumber(L, -1);
        break;
    case 4:
        read_sensor_field(L, &segment);
        break;
    case 5:
        wh_mcs_await_arrival(L, mcs, &segment, awaited);
        break;
    default:
        luaL_error(L, "a segment needs one of axes, line, valves, dwell, sensor, arrives");
    }
    lua_settop(L, 1);
    return segment;
}

/* ----------------------------------------------------------------------------------------------- planning */

/* A wafer could be lost from what the segment carries, and from a gripper on the robot in any segment. */
static uint32_t may_lose(const wh_machine_t *machine, const wh_task_t *task) {
    uint32_t grippers = task->carried;
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        grippers |= machine->mounts[g].axis == WH_NONE ? 1U << g : 0;
    }
    return grippers;
}

static void refuse_segment(lua_State *L, wh_mcs_t *mcs, wh_status_t status, const wh_segment_t *segment) {
    char reason[WH_TRAVEL_BYTES] = "";
    if (status == WH_STATUS_BAD_SEGMENT) {
        snprintf(reason, sizeof reason, "it would take more than 1e6 s");
    } else if (segment->kind == WH_SEGMENT_AXES || segment->kind == WH_SEGMENT_VIA) {
        wh_travel_say_axes(mcs->layout, segment->target, reason);
    } else if (segment->kind == WH_SEGMENT_WAY) {
        wh_travel_say_axes(mcs->layout, segment->target, reason);
        if (reason[0] == '\0') {
            wh_transit_say(mcs->layout, mcs->track.axes, segment, reason, sizeof reason);
        }
    } else if (segment->kind == WH_SEGMENT_LINE) {
        wh_travel_say_line(mcs->layout, segment->gripper, mcs->track.axes, &segment->travel, reason);
    }
    refuse(L, mcs, status, reason);
}

/* Motion control reckons with a wafer where a valve is open. Passive pads have none: the request at stack
 * index 1 tells of what the pattern has done (`told`, by gripper), else their sensor does. */
static uint32_t find_loaded(lua_State *L, wh_mcs_t *mcs) {
    uint32_t loaded = 0;
    const int told = lua_getfield(L, 1, "told");
    for (size_t g = 0; g < mcs->layout->machine.gripper_count; ++g) {
        bool carries = mcs->track.valves[g] == WH_VALVE_OPEN;
        if (mcs->layout->grips[g].kind == WH_GRIP_PASSIVE) {
            if (told == LUA_TTABLE && lua_rawgeti(L, -1, (lua_Integer)g + 1) == LUA_TBOOLEAN) {
                carries = lua_toboolean(L, -1) != 0;
            } else {
                carries = (mcs->state.sensors >> g & 1U) != 0;
                wh_decisions_read(mcs->decisions, WH_DECISION_SENSOR, (int32_t)g, carries);
            }
            lua_settop(L, 2);
        }
        loaded |= carries ? 1U << g : 0;
    }
    lua_settop(L, 1);
    return loaded;
}

static void refuse_slip(lua_State *L, wh_mcs_t *mcs, const wh_carrying_slip_t *slip) {
    const wh_layout_t *layout = mcs->layout;
    const char *name = layout->grippers[slip->gripper].name;
    char axis[2 * WH_NAME_SIZE], reason[8 * WH_NAME_SIZE];
    wh_layout_name_axis(layout, slip->axis, axis, sizeof axis);
    const int digits = slip->asked - slip->held < 1 ? 4 : 0; /* else both would read the same */
    if (slip->enough >= 1) {
        snprintf(reason, sizeof reason,
                 "%s asks the wafer on %s for %.*f mm/s^2, friction holds %.*f (expected loaded = { "
                 "acceleration = %.0f } or less, of %s or of its robot)",
                 axis, name, digits, slip->asked, digits, slip->held, floor(slip->enough), name);
    } else {
        snprintf(
            reason, sizeof reason,
            "%s makes the pads of %s so steep that the wafer slides: it is asked for %.0f mm/s^2, friction "
            "holds %.0f",
            axis, name, slip->asked, slip->held);
    }
    refuse(L, mcs, WH_STATUS_SLIP_AHEAD, reason);
}

/* Begins the segment as slowly as wafers that are carried ask for. */
static wh_status_t begin_carrying(lua_State *L, wh_mcs_t *mcs, const wh_segment_t *segment) {
    const uint32_t loaded = find_loaded(L, mcs);
    wh_carrying_slip_t slip;
    int64_t slices;
    const wh_status_t status = wh_carrying_begin(&mcs->track, mcs->layout, segment, loaded, &slices);
    wh_sandbox_charge(L, wh_mcs_steps(slices));
    if (status == WH_OK && wh_carrying_slips(&mcs->track, mcs->layout, loaded, &slip)) {
        refuse_slip(L, mcs, &slip);
    }
    return status;
}

void wh_mcs_plan_segment(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned) {
    planned->awaited = (wh_awaited_t){WH_AWAITED_VACUUM, 0};
    const wh_segment_t segment = read_segment(L, mcs, &planned->awaited);
    lua_getfield(L, 1, "vacuum");
    const bool for_vacuum = segment.kind == WH_SEGMENT_DWELL && lua_toboolean(L, -1) != 0;
    lua_pop(L, 1);
    planned->task = wh_activity_task(&mcs->track, &segment, for_vacuum);
    if (planned->awaited.kind != WH_AWAITED_VACUUM) {
        planned->task.share = WH_SHARE_WAITING;
    }
    planned->may_lose = may_lose(mcs->track.machine, &planned->task);
    const wh_status_t status = wh_carrying_matters(mcs->layout) ? begin_carrying(L, mcs, &segment)
                                                                : wh_track_begin(&mcs->track, &segment);
    if (status != WH_OK) {
        refuse_segment(L, mcs, status, &segment);
    }
    planned->track = mcs->track;
}

/* What the other tasks play. */
static size_t find_others(const wh_mcs_t *mcs, wh_other_t others[WH_OTHERS]) {
    const wh_record_t *record = mcs->recorder.record;
    size_t count = 0;
    for (size_t i = 0; mcs->lanes && i < WH_MCS_LANES && count < WH_OTHERS; ++i) {
        const wh_lane_t *lane = &mcs->lanes->of[i];
        if (lane->is_busy && (int32_t)i != mcs->lanes->current) {
            const char *text = lane->running != WH_NONE ? record->commands[lane->running].text : NULL;
            others[count++] = (wh_other_t){&lane->track, lane->is_drawn, lane->axes, text};
        }
    }
    return count;
}

/* Of the segment that was just planned; without one, of what the others do when the command is over. */
static void look_ahead(lua_State *L, wh_mcs_t *mcs, const wh_track_t *track) {
    const wh_rehearsal_t *rehearsal = &mcs->rehearsal;
    const bool is_first = rehearsal->planned.count == 0;
    char reason[WH_REHEARSAL_REASON_BYTES] = "";
    wh_other_t others[WH_OTHERS];
    int64_t slices = 0;
    if (!rehearsal->is_judged || !rehearsal->look_ahead || (is_first && !track)) {
        return;
    }
    const wh_ahead_start_t start = {&mcs->state, others, is_first ? find_others(mcs, others) : 0};
    if (rehearsal->look_ahead(rehearsal->look_ahead_user, track, is_first ? &start : NULL, &slices, reason)) {
        if (!track) { /* no request is to blame */
            wh_mcs_raise(L, mcs, WH_STATUS_COLLISION_AHEAD, reason);
        }
        refuse(L, mcs, WH_STATUS_COLLISION_AHEAD, reason);
    }
    wh_sandbox_charge(L, wh_mcs_steps(track ? track->segment_slices : slices));
}

/* native.look_on(): at the end of a rehearsal; what others play goes on to its end beside what was
 * planned. */
static int look_on(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    luaL_argcheck(L, mcs->rehearsal.is_on, 1, "no rehearsal goes on");
    look_ahead(L, mcs, NULL);
    return 0;
}

/* native.plan(segment): within a rehearsal; the number by which the segment can then be played as it was
 * planned. */
static int plan(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_planned_t planned;
    luaL_argcheck(L, mcs->rehearsal.is_on, 1, "no rehearsal goes on");
    wh_mcs_plan_segment(L, mcs, &planned);
    look_ahead(L, mcs, &mcs->track);
    wh_track_skip(&mcs->track);
    wh_rehearsal_note_reach(&mcs->rehearsal, &mcs->track, mcs->recorder.record);
    wh_rehearsal_add(&mcs->rehearsal, &planned);
    lua_pushinteger(L, (lua_Integer)mcs->rehearsal.planned.count);
    return 1;
}

/* native.try_segment(segment): within a rehearsal; raises if the segment could not be planned from where the
 * rehearsed ones end, and plans nothing. */
static int try_segment(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_track_t kept = mcs->track;
    wh_planned_t unused;
    luaL_argcheck(L, mcs->rehearsal.is_on, 1, "no rehearsal goes on");
    wh_mcs_plan_segment(L, mcs, &unused);
    mcs->track = kept;
    return 0;
}

/* native.rehearse(on, judged): from now on segments are only planned, and looked at for collisions if judged;
 * off: everything is where it was. */
static int rehearse(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_rehearsal_end(&mcs->rehearsal, &mcs->track);
    if (lua_toboolean(L, 1)) {
        wh_rehearsal_begin(&mcs->rehearsal, &mcs->track, lua_toboolean(L, 2) != 0);
    }
    return 0;
}

/* native.reach(station, slot, robot): what is rehearsed from now on goes there; without arguments: the
 * reach is no longer noted. */
static int set_reach(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const size_t stations = mcs->layout->station_count;
    mcs->rehearsal.reach_slot = (int32_t)luaL_optinteger(L, 2, 0);
    if (mcs->rehearsal.reach_slot != 0) {
        mcs->rehearsal.reach_station = wh_mcs_index(L, 1, stations);
        mcs->rehearsal.reach_robot = (size_t)wh_mcs_index(L, 3, wh_machine_robots(&mcs->layout->machine));
        wh_record_begin_reach(mcs->recorder.record, stations);
    }
    return 0;
}

const luaL_Reg wh_mcs_plan_functions[] = {
    {"axes", read_axes}, {"inverse", find_axes},       {"rehearse", rehearse}, {"look_on", look_on},
    {"plan", plan},      {"try_segment", try_segment}, {"reach", set_reach},   {NULL, NULL}};
