/* The questions about the cell: where wafers are and which gripper holds them, where frames are, which
 * parts came near to each other. Answers that a trial's errors change are noted in the decisions: a script
 * that reads them is run for each trial. */
#include <stdio.h>
#include <string.h>

#include "../layout/words.h"
#include "../math/relation.h"
#include "../math/trig.h"
#include "../script/wh_module_values.h"
#include "native.h"

/* native.utime(): simulated microseconds so far. */
static int read_utime(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    lua_pushinteger(L, wh_mcs_utime(mcs));
    return 1;
}

/* The wafer that the gripper at stack index 1 holds, or WH_NONE. */
static int32_t read_held(lua_State *L, const wh_mcs_t *mcs) {
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    const int32_t wafer = mcs->state.grippers[gripper].wafer;
    wh_decisions_read(mcs->wanted.decisions, WH_DECISION_HELD, gripper, wafer);
    return wafer;
}

/* native.held(gripper): the name of the wafer that it holds, or nil. */
static int find_held(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t wafer = read_held(L, mcs);
    if (wafer == WH_NONE) {
        return 0;
    }
    lua_pushstring(L, mcs->layout->wafers[wafer].name);
    return 1;
}

/* native.wafer_names(most): a list of all, or of the first `most`. */
static int list_wafers(lua_State *L) {
    const wh_layout_t *layout = wh_mcs_with_layout(L)->layout;
    const lua_Integer most = luaL_optinteger(L, 1, WH_LAYOUT_WAFERS);
    const size_t count = layout->wafer_count < (size_t)most ? layout->wafer_count : (size_t)most;
    wh_sandbox_charge(L, count);
    lua_createtable(L, (int)count, 0);
    for (size_t w = 0; w < count; ++w) {
        lua_pushstring(L, layout->wafers[w].name);
        lua_rawseti(L, -2, (lua_Integer)w + 1);
    }
    return 1;
}

/* native.wafer(name): the wafer's index, or nil. */
static int find_wafer(lua_State *L) {
    const wh_layout_t *layout = wh_mcs_with_layout(L)->layout;
    wh_lua_push_index(L, wh_layout_find_wafer(layout, wh_lua_word(L, 1)));
    return 1;
}

static const wh_wafer_t *wafer_argument(lua_State *L, const wh_mcs_t *mcs, int argument) {
    const int32_t wafer = wh_mcs_index(L, argument, mcs->state.wafer_count);
    wh_decisions_look(mcs->wanted.decisions, wafer);
    return &mcs->state.wafers[wafer];
}

/* native.sensor(gripper): true if its vacuum sensor is on. */
static int read_sensor(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    const bool on = (mcs->state.sensors >> gripper & 1U) != 0;
    wh_decisions_read(mcs->wanted.decisions, WH_DECISION_SENSOR, gripper, on);
    lua_pushboolean(L, on);
    return 1;
}

static const char *plunger_word(const wh_grip_state_t *state, const wh_edge_t *edge) {
    const bool is_still = state->phase == WH_GRIP_CLOSING && state->s <= edge->retracted;
    return is_still ? "still" : wh_layout_phase_words[state->phase];
}

/* native.grip(gripper): the state of its edge grip's plunger, a word of lua/mcs/patterns.lua; its place, mm;
 * and how far beyond the clearance a wafer jams, mm. */
static int read_grip(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->layout->machine.gripper_count);
    const wh_edge_t *edge = &mcs->layout->grips[gripper].edge;
    const wh_grip_state_t open = {.s = edge->retracted, .wafer = WH_NONE};
    const wh_grip_state_t *state = mcs->state.physics ? &mcs->state.physics->grips[gripper] : &open;
    wh_decisions_measured(mcs->wanted.decisions, "what a plunger does");
    lua_pushstring(L, plunger_word(state, edge));
    lua_pushnumber(L, state->s);
    lua_pushnumber(L, state->excess);
    return 3;
}

/* native.weight(gripper): the force of its pads and the weight that would hang on them in their present
 * direction, N, if that is more than they carry; else nothing. */
static int read_weight(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    const wh_pads_t *pads = &mcs->layout->physics.pads;
    const wh_real_t down = -mcs->state.grippers[gripper].base_from_gripper.R.m[2][2];
    const wh_real_t weight = pads->mass * pads->gravity * down;
    wh_decisions_measured(mcs->wanted.decisions, "why a wafer was missed");
    if (pads->mass <= 0 || pads->force >= weight || mcs->layout->grips[gripper].kind != WH_GRIP_VACUUM) {
        return 0;
    }
    lua_pushnumber(L, pads->force);
    lua_pushnumber(L, weight);
    return 2;
}

/* native.is_open(gripper): true if its valve is commanded open. */
static int read_valve(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    lua_pushboolean(L, mcs->track.valves[gripper] == WH_VALVE_OPEN);
    return 1;
}

/* native.holder(wafer): the gripper's index, or nil. */
static int find_holder(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t wafer = wh_mcs_index(L, 1, mcs->state.wafer_count);
    const int32_t holder = mcs->state.wafers[wafer].holder;
    wh_decisions_read(mcs->wanted.decisions, WH_DECISION_HOLDER, wafer, holder);
    wh_lua_push_index(L, holder);
    return 1;
}

/* native.measure(wafer, station, slot): dx, dy, dz, tilt_deg in that slot's frame. */
static int measure_wafer(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_wafer_t *wafer = wafer_argument(L, mcs, 1);
    const int32_t index = wh_mcs_index(L, 2, mcs->layout->station_count);
    const wh_station_t *station = &mcs->real->places[index];
    const int32_t slot = wh_mcs_index(L, 3, (size_t)station->slots) + 1;
    wh_decisions_measured(mcs->wanted.decisions, "offset");
    wh_decisions_visit(mcs->wanted.decisions, index, WH_NONE);
    const wh_place_t place = wh_cell_measure(&mcs->real->cell, station, slot, &wafer->base_from_wafer);
    lua_pushnumber(L, place.dx);
    lua_pushnumber(L, place.dy);
    lua_pushnumber(L, place.dz);
    lua_pushnumber(L, wh_deg_from_rad(place.tilt));
    return 4;
}

/* Pushes the station's name and the slot that a wafer lies in, or nothing; returns how many values. */
static int push_place(lua_State *L, const wh_mcs_t *mcs, const wh_pose_t *base_from_wafer) {
    wh_place_t place;
    if (!wh_cell_locate(&mcs->real->cell, base_from_wafer, &place)) {
        return 0;
    }
    lua_pushstring(L, mcs->layout->stations[place.station].name);
    lua_pushinteger(L, place.slot);
    return 2;
}

/* native.locate(wafer): the station's name and the slot, or nil if it lies in none. */
static int locate_wafer(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_decisions_measured(mcs->wanted.decisions, "where a wafer lies");
    return push_place(L, mcs, &wafer_argument(L, mcs, 1)->base_from_wafer);
}

/* native.face(wafer): "up" or "down", by the direction of its front face in base. */
static int read_face(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_decisions_measured(mcs->wanted.decisions, "a wafer's face");
    lua_pushstring(L, wh_layout_face_of(&wafer_argument(L, mcs, 1)->base_from_wafer));
    return 1;
}

/* native.held_face(gripper): "up" or "down" of the wafer that it holds, or nil. A trial may change this only
 * through which gripper holds which wafer. */
static int read_held_face(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t wafer = read_held(L, mcs);
    if (wafer == WH_NONE) {
        return 0;
    }
    lua_pushstring(L, wh_layout_face_of(&mcs->state.wafers[wafer].base_from_wafer));
    return 1;
}

/* native.lies(wafer, station, slot, dx, dy, tolerance): a verdict: 0 if the wafer does not lie in that slot,
 * 1 if it does, 2 if it does with that offset; its offset there and its height; then the name of the station
 * and the slot that it lies in, or nothing. Only the verdict may decide, the rest is for messages. */
static int judge_place(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_decisions_claim_t claim;
    claim.wafer = wh_mcs_index(L, 1, mcs->state.wafer_count);
    claim.station = wh_mcs_index(L, 2, mcs->layout->station_count);
    claim.slot = wh_mcs_index(L, 3, (size_t)mcs->layout->places[claim.station].slots) + 1;
    claim.dx = luaL_checknumber(L, 4);
    claim.dy = luaL_checknumber(L, 5);
    claim.tolerance = luaL_checknumber(L, 6);
    claim.height = mcs->layout->grasp.tolerance.projz;
    const int32_t verdict = wh_decisions_judge(&claim, &mcs->real->cell, mcs->state.wafers);
    wh_decisions_claim(mcs->wanted.decisions, &claim, verdict);
    const wh_pose_t *base_from_wafer = &mcs->state.wafers[claim.wafer].base_from_wafer;
    const wh_place_t place = wh_cell_measure(&mcs->real->cell, &mcs->real->cell.stations[claim.station],
                                             claim.slot, base_from_wafer);
    lua_pushinteger(L, verdict);
    lua_pushnumber(L, place.dx);
    lua_pushnumber(L, place.dy);
    lua_pushnumber(L, place.dz);
    return 4 + push_place(L, mcs, base_from_wafer);
}

/* native.is_elsewhere(wafer's name, station, slot): after a PUT there, true if the wafer lies in another
 * slot; then the name of the station and the slot that it lies in, or nothing, for messages. */
static int judge_put(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_decisions_asked_t put = {.wafer = wh_layout_find_wafer(mcs->layout, wh_lua_word(L, 1)),
                                .gripper = WH_NONE};
    luaL_argcheck(L, put.wafer != WH_NONE, 1, "no such wafer");
    put.station = wh_mcs_index(L, 2, mcs->layout->station_count);
    put.slot = wh_mcs_index(L, 3, (size_t)mcs->layout->places[put.station].slots) + 1;
    const wh_pose_t *place = &mcs->state.wafers[put.wafer].base_from_wafer;
    const bool is_elsewhere = wh_decisions_is_elsewhere(&put, &mcs->real->cell, place);
    wh_decisions_asked(mcs->wanted.decisions, WH_DECISION_PUT, &put, is_elsewhere);
    lua_pushboolean(L, is_elsewhere);
    return 1 + push_place(L, mcs, place);
}

/* native.was_elsewhere(gripper, station, slot): after a GET there, true if the wafer that the gripper
 * holds lay in another slot; then, for messages, the wafer's name, the name of the station and the slot. */
static int judge_get(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_decisions_asked_t get = {.wafer = WH_NONE, .gripper = wh_mcs_index(L, 1, mcs->state.gripper_count)};
    get.station = wh_mcs_index(L, 2, mcs->layout->station_count);
    get.slot = wh_mcs_index(L, 3, (size_t)mcs->layout->places[get.station].slots) + 1;
    const wh_pose_t *place = wh_origins_find(&mcs->heard.origins, get.gripper);
    const bool was_elsewhere = wh_decisions_is_elsewhere(&get, &mcs->real->cell, place);
    wh_decisions_asked(mcs->wanted.decisions, WH_DECISION_GET, &get, was_elsewhere);
    lua_pushboolean(L, was_elsewhere);
    if (!was_elsewhere) {
        return 1;
    }
    lua_pushstring(L, mcs->layout->wafers[mcs->heard.origins.of[get.gripper].wafer].name);
    return 2 + push_place(L, mcs, place);
}

/* native.lies_in(station, slot): the name of a wafer that lies in that slot, or nil. */
static int find_in_slot(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const int32_t slot = wh_mcs_index(L, 2, (size_t)mcs->layout->places[station].slots) + 1;
    wh_sandbox_charge(L, mcs->state.wafer_count);
    wh_decisions_measured(mcs->wanted.decisions, "what lies in a slot");
    for (size_t w = 0; w < mcs->state.wafer_count; ++w) {
        wh_place_t place;
        if (wh_cell_locate(&mcs->real->cell, &mcs->state.wafers[w].base_from_wafer, &place) &&
            place.station == station && place.slot == slot) {
            lua_pushstring(L, mcs->layout->wafers[w].name);
            return 1;
        }
    }
    return 0;
}

/* native.wafer_pose(wafer, gripper): { r, R }, as the module wh takes it; with a gripper the frame of the
 * face that looks at it. */
static int read_wafer_pose(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_pose_t pose = wafer_argument(L, mcs, 1)->base_from_wafer;
    wh_decisions_measured(mcs->wanted.decisions, "a wafer's pose");
    if (!lua_isnoneornil(L, 2) && mcs->layout->has_faces) {
        const wh_pose_t wafer = pose;
        const int32_t gripper = wh_mcs_index(L, 2, mcs->state.gripper_count);
        const wh_pose_t *base_from_gripper = &mcs->state.grippers[gripper].base_from_gripper;
        wh_face_frame(&wafer, mcs->layout->cell.thickness, wh_face_towards(&wafer, base_from_gripper), &pose);
    }
    wh_lua_push_pose(L, &pose);
    return 1;
}

/* native.gripper_pose(gripper, real): its commanded pose, also before the first slice; or, if `real`,
 * its true pose, which a fault may change. */
static int read_gripper_pose(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t gripper = wh_mcs_index(L, 1, mcs->state.gripper_count);
    const bool is_real = lua_toboolean(L, 2) && mcs->state.seq > 0;
    wh_pose_t poses[WH_GRIPPERS];
    if (mcs->layout->grippers[gripper].station != WH_NONE) {
        wh_decisions_measured(mcs->wanted.decisions, "a chuck's pose");
    }
    wh_machine_grippers(&mcs->real->machine, mcs->track.axes, poses);
    wh_lua_push_pose(L, is_real ? &mcs->state.grippers[gripper].base_from_gripper : &poses[gripper]);
    return 1;
}

/* native.slot_pose(station, slot): the true pose of that slot. */
static int read_slot_pose(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t index = wh_mcs_index(L, 1, mcs->layout->station_count);
    const wh_station_t *station = &mcs->real->places[index];
    const wh_pose_t pose = wh_station_slot(station, wh_mcs_index(L, 2, (size_t)station->slots) + 1);
    wh_decisions_measured(mcs->wanted.decisions, "where a slot is");
    wh_decisions_visit(mcs->wanted.decisions, index, WH_NONE);
    wh_lua_push_pose(L, &pose);
    return 1;
}

/* native.relate(first, second): the second of two poses relative to the first: distance, dx, dy, dz, and
 * in degrees the angle, the whole turn, and the heading. The heading is the direction of the second's x
 * about the first's z, from the first's x. */
static int relate_frames(lua_State *L) {
    const wh_field_t arguments[] = {wh_lua_argument("first", 1), wh_lua_argument("second", 2)};
    wh_pose_t poses[2];
    for (int i = 0; i < 2; ++i) {
        lua_pushvalue(L, i + 1);
        wh_lua_take_valid_pose(L, &arguments[i], &poses[i]);
    }
    const wh_relation_t relation = wh_relate(&poses[0], &poses[1]);
    lua_pushnumber(L, relation.distance);
    lua_pushnumber(L, relation.r.x);
    lua_pushnumber(L, relation.r.y);
    lua_pushnumber(L, relation.r.z);
    lua_pushnumber(L, wh_deg_from_rad(relation.angle));
    lua_pushnumber(L, wh_deg_from_rad(relation.turn));
    const wh_vec3_t x = wh_mat3_column(&poses[1].R, 0);
    const wh_vec3_t seen = wh_mat3_transform_back(&poses[0].R, &x);
    lua_pushnumber(L, wh_deg_from_rad(wh_atan2(seen.y, seen.x)));
    return 7;
}

/* --------------------------------------------------------------------------------------------- collisions */

static void set_parts(lua_State *L, const wh_mcs_t *mcs, const int32_t parts[2]) {
    lua_createtable(L, 2, 0);
    for (int i = 0; i < 2; ++i) {
        const char *name = wh_layout_part_name(mcs->layout, parts[i]);
        lua_pushstring(L, name ? name : "nothing");
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "parts");
}

/* Refuses a question about what nobody looks for, or has not looked for in all slices. A budget that leaves
 * collisions out for a first look goes on. */
static void check_looks(lua_State *L, wh_mcs_t *mcs, const char *word, bool looks) {
    const int64_t moving = mcs->recorder.record->counted.moving;
    if (looks && moving > 0) {
        lua_pushfstring(L,
                        "%s: collisions were not looked for in %I slices (expected a run without --counted)",
                        word, (lua_Integer)moving);
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT, lua_tostring(L, -1));
    }
    if (!looks && !mcs->wanted.without_collisions) {
        lua_pushfstring(L, "%s: collisions are not looked for (expected a layout with collision = true)",
                        word);
        wh_mcs_raise(L, mcs, WH_STATUS_BAD_ARGUMENT, lua_tostring(L, -1));
    }
}

/* native.hits(): a list of { kind, parts, at, time } so far. */
static int list_hits(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    check_looks(L, mcs, "hits", mcs->layout->collision);
    lua_newtable(L);
    wh_decisions_measured(mcs->wanted.decisions, "hits");
    for (size_t i = 0; i < mcs->recorder.record->event_count; ++i) {
        const wh_event_record_t *record = &mcs->recorder.record->events[i];
        const wh_event_kind_t kind = record->event.kind;
        if (kind == WH_EVENT_HIT || kind == WH_EVENT_UNDECIDED) {
            lua_createtable(L, 0, 4);
            wh_lua_set_text(L, "kind", wh_event_name(kind));
            set_parts(L, mcs, record->event.parts);
            wh_lua_set_triple(L, "at", &record->event.at);
            wh_lua_set_number(L, "time", (double)record->utime / 1e6);
            lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
        }
    }
    return 1;
}

static int find_question_kind(const char *name) {
    int kind = 0;
    while (kind < WH_CLEARANCES && strcmp(name, wh_clearance_name((wh_clearance_kind_t)kind)) != 0) {
        ++kind;
    }
    return kind;
}

/* native.clearance_kinds(): their names. */
static int list_clearances(lua_State *L) {
    lua_createtable(L, WH_CLEARANCES, 0);
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        lua_pushstring(L, wh_clearance_name((wh_clearance_kind_t)kind));
        lua_rawseti(L, -2, kind + 1);
    }
    return 1;
}

/* native.clearance(kind): { gap, limit, time, parts, at } so far; only `limit` until parts came near. Nil if
 * a budget does not look for collisions, false for an unknown kind. */
static int find_clearance(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int kind = find_question_kind(wh_lua_word(L, 1));
    wh_decisions_measured(mcs->wanted.decisions, "clearance");
    if (kind == WH_CLEARANCES) {
        lua_pushboolean(L, 0);
        return 1;
    }
    check_looks(L, mcs, "clearance", mcs->layout->collision);
    const wh_world_t *world = mcs->local.collision.world; /* from the first slice on */
    if (!world && (!mcs->layout->collision || mcs->wanted.without_collisions)) {
        return 0;
    }
    const wh_clearance_t *least = world ? &wh_world_clearances(world)[kind] : NULL;
    lua_createtable(L, 0, 5);
    wh_lua_set_number(L, "limit", mcs->layout->world.limits[kind]);
    if (least && least->parts[0] != WH_NONE) {
        wh_lua_set_number(L, "gap", least->gap);
        wh_lua_set_number(L, "time", (double)((int64_t)least->slice * mcs->layout->slice_us) / 1e6);
        set_parts(L, mcs, least->parts);
        wh_lua_set_triple(L, "at", &least->at);
    }
    return 1;
}

const luaL_Reg wh_mcs_query_functions[] = {{"utime", read_utime},
                                           {"held", find_held},
                                           {"wafer_names", list_wafers},
                                           {"wafer", find_wafer},
                                           {"sensor", read_sensor},
                                           {"is_open", read_valve},
                                           {"holder", find_holder},
                                           {"measure", measure_wafer},
                                           {"locate", locate_wafer},
                                           {"lies", judge_place},
                                           {"is_elsewhere", judge_put},
                                           {"was_elsewhere", judge_get},
                                           {"lies_in", find_in_slot},
                                           {"face", read_face},
                                           {"held_face", read_held_face},
                                           {"grip", read_grip},
                                           {"weight", read_weight},
                                           {"wafer_pose", read_wafer_pose},
                                           {"gripper_pose", read_gripper_pose},
                                           {"slot_pose", read_slot_pose},
                                           {"relate", relate_frames},
                                           {"hits", list_hits},
                                           {"clearance", find_clearance},
                                           {"clearance_kinds", list_clearances},
                                           {NULL, NULL}};
