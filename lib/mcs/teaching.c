/* Teaching by a beam: what a blade that carried a wafer through a station's beam tells of where the station
 * is, and the beam. lua/mcs/teaching.lua moves the arm. */
#include "../align/teaching.h"

#include <math.h>
#include <string.h>

#include "../script/wh_module_values.h"
#include "native.h"

/* How well nobody knows where a beam is, nor a station before it was taught, mm. */
#define SD_BEAM 1
#define SD_PLACE 0.5
/* The least deviation of a crossing, mm. */
#define LEAST_SD 0.001

/* Where the gripper was as a beam changed; between two slices its heading is the one's. */
static bool find_place(const wh_mcs_t *mcs, const wh_mcs_crossing_t *crossing, wh_pose_t *base_from_gripper) {
    const wh_mcs_pass_t *pass = &mcs->pass;
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

/* native.begin_teaching(): nothing is measured yet. */
static int begin_teaching(lua_State *L) {
    wh_mcs_with_layout(L)->teaching.count = 0;
    return 0;
}

/* native.add_teaching(x, y): the crossings of the last centring were of the rim of the wafer that the gripper
 * took with its middle at (x, y) of base, heading as the station's x does. Returns how many there are now. */
static int add_teaching(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_mcs_centring_t *passed = &mcs->centring;
    const wh_pose_t *station = &mcs->layout->places[passed->station].base_from_station;
    wh_mcs_teaching_t *teaching = &mcs->teaching;
    for (size_t i = 0; i < passed->count && teaching->count < WH_MCS_LESSONS; ++i) {
        const wh_crossing_t *crossing = &passed->crossings[i].crossing;
        const double jitter = mcs->layout->doors[crossing->beam].jitter;
        const double sd = hypot(crossing->vx, crossing->vy) * jitter;
        wh_teach_measurement_t *lesson = &teaching->lessons[teaching->count];
        memset(lesson, 0, sizeof *lesson);
        lesson->kind = WH_TEACH_CARRIED;
        lesson->sd = sd > LEAST_SD ? sd : LEAST_SD;
        lesson->radius = mcs->layout->wafer_diameter / 2;
        lesson->base_from_pick = *station;
        lesson->base_from_pick.r.x = luaL_checknumber(L, 1);
        lesson->base_from_pick.r.y = luaL_checknumber(L, 2);
        teaching->count += find_place(mcs, &passed->crossings[i], &lesson->base_from_gripper) ? 1 : 0;
    }
    lua_pushinteger(L, (lua_Integer)teaching->count);
    return 1;
}

/* native.solve_teaching(): the last pass's station and its first beam by all that was added: { error = the
 * status, x, y = by how much the station is off in base, mm, sd_x, sd_y, beam_x, beam_y = the beam likewise,
 * largest = what remains of the worst crossing, in deviations }; of an error only that. */
static int solve_teaching(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_mcs_teaching_t *teaching = &mcs->teaching;
    const wh_layout_beam_t *beam = &mcs->layout->beams[mcs->pass.order.first];
    const wh_pose_t *station = &mcs->layout->places[beam->station].base_from_station;
    wh_teach_guess_t guess = wh_teach_guess_at(station, beam->x, beam->y);
    wh_taught_t taught;
    guess.beam = wh_beam_at(station, beam->x, beam->y, beam->low, beam->high);
    guess.sd_beam = SD_BEAM;
    guess.sd_place = SD_PLACE;
    wh_decisions_measured(mcs->decisions, "teaching");
    const wh_status_t status = wh_teach_solve(&guess, teaching->lessons, teaching->count, &taught, NULL);
    lua_createtable(L, 0, 8);
    wh_lua_set_integer(L, "error", status);
    if (status == WH_OK) {
        wh_lua_set_number(L, "x", taught.shift[0]);
        wh_lua_set_number(L, "y", taught.shift[1]);
        wh_lua_set_number(L, "sd_x", taught.sd_shift[0]);
        wh_lua_set_number(L, "sd_y", taught.sd_shift[1]);
        wh_lua_set_number(L, "beam_x", taught.beam_x);
        wh_lua_set_number(L, "beam_y", taught.beam_y);
        wh_lua_set_number(L, "largest", taught.largest);
    }
    return 1;
}

const luaL_Reg wh_mcs_teaching_functions[] = {{"begin_teaching", begin_teaching},
                                              {"add_teaching", add_teaching},
                                              {"solve_teaching", solve_teaching},
                                              {NULL, NULL}};
