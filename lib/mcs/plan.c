/* Planning: where the axes must go, and rehearsals. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../layout/along_arm.h"
#include "../layout/axes.h"
#include "../layout/links.h"
#include "../layout/transit.h"
#include "../layout/travel.h"
#include "../math/trig.h"
#include "../script/wh_module_values.h"
#include "../text/clock.h"
#include "carrying.h"
#include "native.h"
#include "playing.h"

/* native.axes(): where all axes stand, rad and mm. */
static int read_axes(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_lua_push_numbers(L, mcs->track.axes, mcs->layout->machine.axis_count);
    return 1;
}

/* True if the request at stack index 1 leads a blade to a station that is not the station's effector:
 * `gripper`, or that of its target if it is WH_NONE. The lengths of the links are those for the effector. */
static bool is_of_another_blade(lua_State *L, const wh_mcs_t *mcs, int32_t gripper) {
    const int top = lua_gettop(L);
    bool is_another = false;
    if (lua_getfield(L, 1, "target") == LUA_TTABLE) {
        lua_getfield(L, top + 1, "station");
        lua_getfield(L, top + 1, "gripper");
        const int32_t station = wh_layout_find_station(mcs->layout, luaL_optstring(L, top + 2, ""));
        const int32_t leads = gripper == WH_NONE ? (int32_t)luaL_optinteger(L, top + 3, 0) - 1 : gripper;
        is_another = station == WH_NONE || mcs->layout->stations[station].effector != leads;
    }
    lua_settop(L, top);
    return is_another;
}

/* Within a command: refuses axes at which a robot's links would not reach. All stations are looked at
 * before a run. */
static void check_links(lua_State *L, wh_mcs_t *mcs, int32_t gripper, const wh_real_t from[],
                        const wh_real_t to[]) {
    char reason[WH_LINKS_BYTES];
    if (mcs->recorder.running != WH_NONE && !wh_links_reach(mcs->layout, from, to, reason) &&
        !is_of_another_blade(L, mcs, gripper)) {
        wh_mcs_refuse_request(L, mcs, WH_STATUS_OUT_OF_REACH, reason);
    }
}

/* For a goal before a slot, the request's `place`, in the table at stack index 2, says how a robot with a
 * carrier comes there. The flip stays as it is at these axes. False: there is no `place`. */
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

/* Appends to a reason the needed heading of the blade of an arm without a wrist in the slot of
 * request.target. The request is at index 1. */
static void say_along_arm(lua_State *L, const wh_mcs_t *mcs, const wh_travel_goal_t *goal,
                          char reason[WH_TRAVEL_BYTES]) {
    const wh_carrier_t *carrier =
        wh_machine_carrier(&mcs->layout->machine, mcs->layout->machine.mounts[goal->gripper].robot, NULL);
    if (!carrier || !goal->pose || lua_getfield(L, 1, "target") != LUA_TTABLE) {
        return;
    }
    (void)lua_getfield(L, -1, "station");
    (void)lua_getfield(L, -2, "slot");
    const int32_t station = wh_layout_find_station(mcs->layout, luaL_optstring(L, -2, ""));
    if (station == WH_NONE || !lua_isinteger(L, -1)) {
        return;
    }
    const wh_pose_t slot = wh_station_slot(&mcs->layout->places[station], (int32_t)lua_tointeger(L, -1));
    const double along = wh_along_arm(&carrier->chain, (double)goal->choice->rail, &slot.r);
    const double heading = (double)wh_atan2(goal->pose->R.m[1][0], goal->pose->R.m[0][0]);
    const size_t used = strlen(reason);
    (void)snprintf(reason + used, WH_TRAVEL_BYTES - used,
                   "; the blade comes in at %.6f degrees, and straight into the slot are %.6f",
                   (double)wh_deg_from_rad((wh_real_t)heading), (double)wh_deg_from_rad((wh_real_t)along));
}

/* native.inverse(request): the axes that bring the gripper to request.to, from request.from or from their
 * present places. */
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
        if (status == WH_STATUS_NOT_ALONG_ARM) {
            say_along_arm(L, mcs, &goal, reason);
        }
        wh_mcs_refuse_request(L, mcs, status, reason);
    }
    check_links(L, mcs, (int32_t)goal.gripper, from, axes);
    wh_lua_push_numbers(L, axes, machine->axis_count);
    return 1;
}

/* ----------------------------------------------------------------------------------------------- planning */

/* A wafer could be lost from a gripper that the segment carries, and from a gripper on the robot in any
 * segment. */
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
    } else if (segment->kind == WH_SEGMENT_AXES || segment->kind == WH_SEGMENT_VIA ||
               segment->kind == WH_SEGMENT_WAY) {
        wh_travel_say_axes(mcs->layout, segment->target, reason);
        if (reason[0] != '\0') { /* of axes that were named, and no point */
            status = status == WH_STATUS_OUT_OF_REACH ? WH_STATUS_LIMIT_EXCEEDED : status;
        } else if (segment->kind == WH_SEGMENT_WAY) {
            wh_transit_say(mcs->layout, mcs->track.axes, segment, reason, sizeof reason);
        }
    } else if (segment->kind == WH_SEGMENT_LINE) {
        wh_travel_say_line(mcs->layout, segment->gripper, mcs->track.axes, &segment->travel, reason);
    }
    wh_mcs_refuse_request(L, mcs, status, reason);
}

/* Motion control assumes a wafer where a valve is open. Passive pads have no valve: for them the request
 * at stack index 1 says what the pattern has done (`told`, by gripper), else their sensor decides. */
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
                wh_decisions_read(mcs->wanted.decisions, WH_DECISION_SENSOR, (int32_t)g, carries);
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
    const int digits = slip->asked - slip->held < 1 ? 4 : 0; /* else both would print alike */
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
    wh_mcs_refuse_request(L, mcs, WH_STATUS_SLIP_AHEAD, reason);
}

/* The parts of the limits that the segment at stack index 1 may use, in `share` = { speed, acceleration }. */
static wh_slowness_t read_share(lua_State *L) {
    wh_slowness_t slowness = {{1, 1}, 1};
    if (lua_getfield(L, 1, "share") == LUA_TTABLE) {
        lua_rawgeti(L, -1, 1);
        lua_rawgeti(L, -2, 2);
        slowness.share = (wh_motion_share_t){luaL_checknumber(L, -2), luaL_checknumber(L, -1)};
    }
    lua_settop(L, 1);
    return slowness;
}

/* Begins the segment as slowly as the carried wafers need. */
static wh_status_t begin_carrying(lua_State *L, wh_mcs_t *mcs, const wh_segment_t *segment,
                                  wh_slowness_t *slowness) {
    const uint32_t loaded = wh_carrying_matters(mcs->layout) ? find_loaded(L, mcs) : 0;
    wh_carrying_slip_t slip;
    int64_t slices;
    const wh_status_t status =
        wh_carrying_begin(&mcs->track, mcs->layout, segment, slowness, loaded, &slices);
    wh_sandbox_charge(L, wh_mcs_steps(slices));
    if (status == WH_OK && wh_carrying_slips(&mcs->track, mcs->layout, loaded, &slip)) {
        refuse_slip(L, mcs, &slip);
    }
    return status;
}

/* The links are stretched most at one end of a segment, or at a point between them. */
static void check_segment_links(lua_State *L, wh_mcs_t *mcs, const wh_segment_t *segment,
                                const wh_real_t from[]) {
    wh_track_t end = mcs->track;
    size_t first = 0, count = WH_ROBOT_AXES;
    if (segment->kind == WH_SEGMENT_VALVES || segment->kind == WH_SEGMENT_DWELL ||
        segment->kind == WH_SEGMENT_SENSOR) {
        return;
    }
    if (segment->kind == WH_SEGMENT_VIA) {
        const wh_mount_t *mount = &mcs->layout->machine.mounts[segment->gripper];
        const wh_carrier_t *carrier = wh_machine_carrier(&mcs->layout->machine, mount->robot, &first);
        count = carrier ? carrier->axis_count : count;
    }
    wh_track_skip(&end);
    for (size_t i = 0; segment->kind == WH_SEGMENT_VIA && i < segment->point_count; ++i) {
        wh_real_t axes[WH_AXES];
        memcpy(axes, end.axes, sizeof axes);
        memcpy(&axes[first], segment->points[i].q, count * sizeof axes[0]);
        check_links(L, mcs, WH_NONE, from, axes);
    }
    check_links(L, mcs, WH_NONE, from, end.axes);
}

void wh_mcs_plan_segment(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned) {
    wh_real_t from[WH_AXES];
    memcpy(from, mcs->track.axes, sizeof from);
    planned->awaited = (wh_awaited_t){WH_AWAITED_VACUUM, 0};
    const wh_segment_t segment = wh_mcs_read_segment(L, mcs, &planned->awaited);
    lua_getfield(L, 1, "vacuum");
    const bool for_vacuum = segment.kind == WH_SEGMENT_DWELL && lua_toboolean(L, -1) != 0;
    lua_pop(L, 1);
    planned->task = wh_activity_task(&mcs->track, &segment, for_vacuum);
    if (planned->awaited.kind != WH_AWAITED_VACUUM) {
        planned->task.share = WH_SHARE_WAITING;
    }
    planned->may_lose = may_lose(mcs->track.machine, &planned->task);
    planned->slowness = read_share(L);
    memcpy(planned->points, mcs->running.via_points, sizeof planned->points);
    const bool is_plain = wh_carrying_is_full(&planned->slowness) && !wh_carrying_matters(mcs->layout);
    const wh_status_t status = is_plain ? wh_track_begin(&mcs->track, &segment)
                                        : begin_carrying(L, mcs, &segment, &planned->slowness);
    if (status != WH_OK) {
        refuse_segment(L, mcs, status, &segment);
    }
    check_segment_links(L, mcs, &segment, from);
    planned->track = mcs->track;
}

/* Finds the segments that the other tasks play. */
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

/* Looks ahead for the segment that was just planned; without one, for the others' segments after the
 * command's end. */
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
    const double begin = wh_clock_seconds();
    const bool collides =
        rehearsal->look_ahead(rehearsal->look_ahead_user, track, is_first ? &start : NULL, &slices, reason);
    mcs->recorder.record->wall_s += wh_clock_seconds() - begin;
    if (collides) {
        if (!track) { /* no request is the cause */
            wh_mcs_raise(L, mcs, WH_STATUS_COLLISION_AHEAD, reason);
        }
        wh_mcs_refuse_request(L, mcs, WH_STATUS_COLLISION_AHEAD, reason);
    }
    wh_sandbox_charge(L, wh_mcs_steps(track ? track->segment_slices : slices));
}

/* native.look_on(): at the end of a rehearsal; the others' segments go on to their end beside the
 * planned ones. */
static int look_on(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    luaL_argcheck(L, mcs->rehearsal.is_on, 1, "no rehearsal goes on");
    look_ahead(L, mcs, NULL);
    return 0;
}

/* native.plan(segment): within a rehearsal; returns the number with which the planned segment can be
 * played. */
static int plan_segment(lua_State *L) {
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

/* native.try_segment(segment): within a rehearsal; raises if the segment could not be planned from the end
 * of the rehearsed ones, and plans nothing. */
static int try_segment(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_track_t kept = mcs->track;
    wh_planned_t unused;
    luaL_argcheck(L, mcs->rehearsal.is_on, 1, "no rehearsal goes on");
    wh_mcs_plan_segment(L, mcs, &unused);
    mcs->track = kept;
    return 0;
}

/* native.rehearse(on, judged): from now on segments are only planned, and checked for collisions if judged;
 * off: everything is back where it was. */
static int rehearse_segments(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_rehearsal_end(&mcs->rehearsal, &mcs->track);
    if (lua_toboolean(L, 1)) {
        wh_rehearsal_begin(&mcs->rehearsal, &mcs->track, lua_toboolean(L, 2) != 0);
        mcs->rehearsal.spent = wh_sandbox_spent(mcs->sandbox);
    }
    return 0;
}

/* native.reach(station, slot, robot): the following rehearsed segments go there; without arguments:
 * the reach is no longer noted. */
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

/* ------------------------------------------------------------------------------------------- whole turns */

/* One turn, rad. */
static const wh_real_t turn = 2 * WH_PI;

/* Theta of the robot, from 1, at stack index 2. */
static size_t theta_of(lua_State *L, const wh_mcs_t *mcs) {
    const wh_machine_t *machine = &mcs->layout->machine;
    size_t first;
    (void)wh_machine_carrier(machine, (size_t)wh_mcs_index(L, 2, wh_machine_robots(machine)), &first);
    return first + WH_AXIS_THETA;
}

/* native.windings(theta, robot): the places farthest below and above theta, within its travel, at which
 * the robot points the same way: a list of none to two, rad. Thetas between them have more room than
 * both. */
static int list_windings(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_travel_t *travel = wh_machine_travel(&mcs->layout->machine, theta_of(L, mcs));
    const wh_real_t theta = luaL_checknumber(L, 1);
    const wh_real_t turns[2] = {floor((theta - travel->min + WH_SLACK_RAD) / turn),
                                floor((travel->max - theta + WH_SLACK_RAD) / turn)};
    lua_newtable(L);
    for (int i = 0; i < 2; ++i) {
        if (turns[i] >= 1) {
            lua_pushnumber(L, theta + (i == 0 ? -turns[i] : turns[i]) * turn);
            lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
        }
    }
    return 1;
}

/* native.stand(theta, robot): the next rehearsal begins there; without theta: at home. */
static int stand_robot(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const size_t theta = theta_of(L, mcs);
    wh_real_t home[WH_AXES];
    wh_machine_home(&mcs->layout->machine, home);
    mcs->track.axes[theta] = luaL_optnumber(L, 1, home[theta]);
    return 0;
}

const luaL_Reg wh_mcs_plan_functions[] = {
    {"axes", read_axes},  {"inverse", find_axes},      {"rehearse", rehearse_segments},
    {"look_on", look_on}, {"plan", plan_segment},      {"try_segment", try_segment},
    {"reach", set_reach}, {"windings", list_windings}, {"stand", stand_robot},
    {NULL, NULL}};
