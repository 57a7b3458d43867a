/* Teaching finds where a station is, and its beam, from a blade that carried a wafer through the beam, or
 * from a probe that touched the station's block. lua/mcs/teaching.lua moves the arm. */
#include "../align/teaching.h"

#include <math.h>
#include <string.h>

#include "../script/wh_module_values.h"
#include "native.h"

/* The deviation of a beam's place, and of a station's before it was taught, mm. */
#define SD_BEAM 1
#define SD_PLACE 0.5
/* The least deviation of a crossing, mm. */
#define LEAST_SD 0.001

/* The gripper's place when a beam changed; between two slices it has the heading of the first. */
static bool find_place(const wh_mcs_t *mcs, const wh_pass_crossing_t *crossing,
                       wh_pose_t *base_from_gripper) {
    const wh_pass_t *pass = &mcs->measuring.pass;
    const double slices = crossing->time * 1e6 / (double)mcs->layout->slice_us - (double)pass->armed_seq;
    const size_t slice = (size_t)slices;
    if (slice + 1 >= pass->place_count) {
        return false;
    }
    const wh_pose_t *before = &pass->places[slice];
    const wh_vec3_t way = wh_vec3_subtract(&pass->places[slice + 1].r, &before->r);
    const wh_vec3_t moved = wh_vec3_scale((wh_real_t)(slices - (double)slice), &way);
    *base_from_gripper = *before;
    base_from_gripper->r = wh_vec3_add(&before->r, &moved);
    return true;
}

/* native.begin_teaching(station, shift, gripper): nothing is measured yet. Returns the guess for the
 * gripper's robot: the station's pose from the layout, or as a host has set it, see native.shift. Also
 * returns the pose that the robot believes; in a trial it may have been taught another one. */
static int begin_teaching(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const size_t station = (size_t)wh_mcs_index(L, 1, mcs->layout->station_count);
    const int32_t gripper = wh_mcs_index(L, 3, mcs->layout->machine.gripper_count);
    const size_t robot = mcs->layout->machine.mounts[gripper].robot;
    wh_mcs_teaching_t *teaching = &mcs->measuring.teaching;
    teaching->count = 0;
    teaching->base_from_station = wh_mcs_believed_station(L, 2, mcs, station, robot);
    wh_lua_push_pose(L, &teaching->base_from_station);
    const wh_vec3_t drawn = wh_mcs_drawn_aside(mcs, station, robot);
    teaching->base_from_station.r = wh_vec3_add(&teaching->base_from_station.r, &drawn);
    wh_lua_push_pose(L, &teaching->base_from_station);
    return 2;
}

/* native.way_in(station, robot): for a robot with its own way in the pose whose x is that way, else nil; and
 * the station's pose; both from the layout. */
static int push_way_in(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const int32_t robot = wh_mcs_index(L, 2, wh_machine_robots(&mcs->layout->machine));
    const wh_layout_approach_t *by = mcs->layout->stations[station].by;
    const wh_pose_t *place = &mcs->layout->places[station].base_from_station;
    const wh_pose_t own = {by ? by[robot].R : place->R, place->r};
    if (by && by[robot].is_turned) {
        wh_lua_push_pose(L, &own);
    } else {
        lua_pushnil(L);
    }
    wh_lua_push_pose(L, place);
    return 2;
}

/* native.add_teaching(x, y, heading): adds the crossings of the last centring: of the rim of the wafer
 * that the gripper took with its middle at (x, y) of base and this heading, rad (without it the heading of
 * the station's x). Returns the number of crossings now. */
static int add_teaching(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_centring_record_t *passed = &mcs->measuring.centring;
    wh_mcs_teaching_t *teaching = &mcs->measuring.teaching;
    for (size_t i = 0; i < passed->count && teaching->count < WH_MCS_LESSONS; ++i) {
        const wh_crossing_t *crossing = &passed->crossings[i].crossing;
        const double jitter = mcs->layout->doors[crossing->beam].jitter;
        const double sd = sqrt(crossing->vx * crossing->vx + crossing->vy * crossing->vy) * jitter;
        wh_teach_measurement_t *lesson = &teaching->lessons[teaching->count];
        memset(lesson, 0, sizeof *lesson);
        lesson->kind = WH_TEACH_CARRIED;
        lesson->sd = sd > LEAST_SD ? sd : LEAST_SD;
        lesson->radius = mcs->layout->wafer_diameter / 2;
        lesson->base_from_pick = teaching->base_from_station;
        lesson->base_from_pick.r.x = luaL_checknumber(L, 1);
        lesson->base_from_pick.r.y = luaL_checknumber(L, 2);
        if (!lua_isnoneornil(L, 3)) {
            lesson->base_from_pick.R = wh_mat3_about_z(luaL_checknumber(L, 3));
        }
        teaching->count += find_place(mcs, &passed->crossings[i], &lesson->base_from_gripper) ? 1 : 0;
    }
    lua_pushinteger(L, (lua_Integer)teaching->count);
    return 1;
}

/* --------------------------------------------------------------------------------------------- by touch */

static const wh_layout_block_t *block_of(lua_State *L, const wh_mcs_t *mcs, int32_t *station) {
    *station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const wh_layout_block_t *block = &mcs->layout->stations[*station].block;
    luaL_argcheck(L, block->is_there, 1, "no block to touch");
    return block;
}

static void set_triple(lua_State *L, const char *name, const double values[3]) {
    lua_createtable(L, 3, 0);
    for (int i = 0; i < 3; ++i) {
        lua_pushnumber(L, values[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, name);
}

/* native.block(station): the block that a probe touches there: { at, size = in the station's frame, mm,
 * gripper = with the probe, ball = its centre in that gripper's frame, radius = its own }. */
static int push_block(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    int32_t station = 0;
    const wh_layout_block_t *block = block_of(L, mcs, &station);
    const wh_layout_probe_t *probe = &mcs->layout->probe;
    lua_createtable(L, 0, 5);
    set_triple(L, "at", block->at);
    set_triple(L, "size", block->size);
    set_triple(L, "ball", probe->at);
    wh_lua_set_number(L, "radius", probe->radius);
    wh_lua_set_index(L, "gripper", probe->gripper);
    return 1;
}

/* native.touched(): { closed = if the switch that was armed is closed now, latched = if it has closed since,
 * missed = latches that no state brought, skipped = if slices were lost meanwhile, so that the ball's place
 * is not known }. */
static int push_touched(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_pass_t *pass = &mcs->measuring.pass;
    const uint32_t bit = UINT32_C(1) << pass->order.first;
    wh_decisions_measured(mcs->wanted.decisions, "what a probe feels");
    lua_createtable(L, 0, 3);
    wh_lua_set_boolean(L, "closed", (mcs->state.physics->latches.broken & bit) != 0);
    wh_lua_set_boolean(L, "latched", pass->latch_count > 0 && pass->latches[0].edge == WH_CROSSING_IN);
    wh_lua_set_integer(L, "missed", pass->missed);
    wh_lua_set_boolean(L, "skipped", pass->skipped);
    return 1;
}

/* native.add_touch(station, face): adds the touch of the pass's first latch, at this face of the block,
 * from 1. Returns false if motion control cannot tell where the gripper was then. */
static int add_touch(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    int32_t station = 0;
    const wh_layout_block_t *block = block_of(L, mcs, &station);
    const wh_layout_probe_t *probe = &mcs->layout->probe;
    const wh_block_face_t face = wh_layout_block_face(block, (size_t)wh_mcs_index(L, 2, WH_BLOCK_FACES));
    const wh_latch_t *latch = &mcs->measuring.pass.latches[0];
    const double slice_s = (double)mcs->layout->slice_us / 1e6;
    const double since = (double)(latch->slice - 1) + latch->part;
    const wh_pass_crossing_t at = {.time = ((double)mcs->measuring.pass.armed_seq + since) * slice_s};
    wh_mcs_teaching_t *teaching = &mcs->measuring.teaching;
    wh_teach_measurement_t lesson = {.kind = WH_TEACH_TOUCH,
                                     .sd = probe->noise > LEAST_SD ? probe->noise : LEAST_SD,
                                     .x = probe->at[0],
                                     .y = probe->at[1],
                                     .z = probe->at[2],
                                     .radius = probe->radius,
                                     .distance = face.sign * face.middle[face.axis]};
    lesson.normal[face.axis] = face.sign;
    const bool is_known = mcs->measuring.pass.latch_count > 0 && teaching->count < WH_MCS_LESSONS &&
                          find_place(mcs, &at, &lesson.base_from_gripper);
    if (is_known) {
        teaching->lessons[teaching->count] = lesson;
        ++teaching->count;
    }
    lua_pushboolean(L, is_known);
    return 1;
}

/* native.arm_touch(station, face): from the end of the next slice on the probe's switch latches at this face
 * of the station's block, and the way of its gripper is remembered. */
static int arm_touch(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    int32_t station = 0;
    (void)block_of(L, mcs, &station);
    const size_t face = (size_t)wh_mcs_index(L, 2, WH_BLOCK_FACES);
    const int32_t gripper = mcs->layout->probe.gripper;
    const wh_pose_t believed = wh_pass_station(mcs->layout, station, gripper);
    wh_mcs_arm(mcs, wh_layout_face_at(mcs->layout, (size_t)station, face), station, gripper, &believed);
    return 0;
}

/* -------------------------------------------------------------------------------------------- the whole */

/* The believed places of the station, and of the beam if there was one: as in the layout. */
static wh_teach_guess_t guess_of(const wh_layout_t *layout, const wh_pass_t *pass,
                                 const wh_pose_t *believed) {
    const int32_t first = pass->order.first;
    const wh_layout_beam_t *beam = &layout->beams[first];
    wh_teach_guess_t guess = wh_teach_guess_at(believed, beam->x, beam->y);
    if (layout->doors[first].kind == WH_DOOR_LIGHT) {
        guess.beam = wh_pass_beam(layout, first, &pass->believed);
    }
    guess.sd_beam = SD_BEAM;
    guess.sd_place = SD_PLACE;
    return guess;
}

/* native.solve_teaching(): the last pass's station and its first beam from all that was added: { error = the
 * status, x, y, z = the station's offset in base, mm, yaw = rad, sd_x, sd_y, sd_z, sd_yaw, beam_x, beam_y =
 * the beam likewise, largest = the residual of the worst measurement, in deviations }; with an error only
 * `error`. */
static int solve_teaching(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_mcs_teaching_t *teaching = &mcs->measuring.teaching;
    const wh_teach_guess_t guess = guess_of(mcs->layout, &mcs->measuring.pass, &teaching->base_from_station);
    wh_taught_t taught;
    wh_decisions_measured(mcs->wanted.decisions, "teaching");
    const wh_status_t status = wh_teach_solve(&guess, teaching->lessons, teaching->count, &taught, NULL);
    lua_createtable(L, 0, 12);
    wh_lua_set_integer(L, "error", status);
    if (status == WH_OK) {
        wh_lua_set_number(L, "x", taught.shift[0]);
        wh_lua_set_number(L, "y", taught.shift[1]);
        wh_lua_set_number(L, "z", taught.shift[2]);
        wh_lua_set_number(L, "yaw", taught.yaw);
        wh_lua_set_number(L, "sd_x", taught.sd_shift[0]);
        wh_lua_set_number(L, "sd_y", taught.sd_shift[1]);
        wh_lua_set_number(L, "sd_z", taught.sd_shift[2]);
        wh_lua_set_number(L, "sd_yaw", taught.sd_yaw);
        wh_lua_set_number(L, "beam_x", taught.beam_x);
        wh_lua_set_number(L, "beam_y", taught.beam_y);
        wh_lua_set_number(L, "largest", taught.largest);
    }
    return 1;
}

const luaL_Reg wh_mcs_teaching_functions[] = {{"begin_teaching", begin_teaching},
                                              {"add_teaching", add_teaching},
                                              {"solve_teaching", solve_teaching},
                                              {"block", push_block},
                                              {"arm_touch", arm_touch},
                                              {"touched", push_touched},
                                              {"add_touch", add_touch},
                                              {"way_in", push_way_in},
                                              {NULL, NULL}};
