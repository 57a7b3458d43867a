/* Centring on the way: the beams at a station's door are armed with the next slice's command, the latches
 * that the states bring are collected, and the wafer's centre on its blade is found from them.
 *
 * Motion control remembers where it commanded the blade to be, slice by slice, from the arming on. A latch
 * comes after its delay, so the crossing was where the blade was then. */
#include <math.h>
#include <stdlib.h>

#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "native.h"

/* How well a latch's time and a wafer's place are known at best, s and mm. */
#define LEAST_SD_TIME 1e-6
#define BEYOND_CORRECTIONS 5
/* Two places of a wafer that are as near to each other are one, mm. */
#define AGREE 0.02

/* ------------------------------------------------------------------------------------------ what is heard */

static bool is_of(const wh_mcs_pass_t *pass, const wh_latches_t *latches) {
    return pass->armed_seq > 0 && latches->number > pass->before && latches->first == pass->order.first &&
           latches->count == pass->order.count;
}

static void collect(wh_mcs_pass_t *pass, const wh_latches_t *latches, int64_t seq) {
    for (int32_t i = 0; i < latches->latch_count; ++i) {
        if (pass->latch_count < WH_CROSSINGS) {
            pass->latches[pass->latch_count] = latches->latches[i];
        }
        ++pass->latch_count;
    }
    const int64_t given = (int64_t)latches->crossings - latches->lost - latches->waiting_count;
    pass->missed = given - pass->latch_count + latches->lost;
    pass->skipped = latches->armed && latches->slice != seq - pass->armed_seq;
}

void wh_mcs_hear_pass(wh_mcs_pass_t *pass, const wh_state_t *state) {
    const wh_latches_t *latches = &state->physics->latches;
    pass->seq = state->seq;
    pass->number = latches->number;
    if (is_of(pass, latches)) {
        collect(pass, latches, state->seq);
    }
}

void wh_mcs_follow_pass(wh_mcs_pass_t *pass, const wh_command_t *command) {
    if (command->latch.kind == WH_LATCH_ARM) {
        pass->armed_seq = command->seq;
        pass->place_count = 0;
    }
    const int64_t index = command->seq - pass->armed_seq;
    if (pass->armed_seq == 0 || !pass->goes_on || index < 0 || index > (int64_t)pass->place_count) {
        return;
    }
    pass->places = wh_array_grow(pass->places, (size_t)index, &pass->place_capacity, sizeof *pass->places);
    pass->places[index] = command->grippers[pass->gripper].base_from_gripper;
    pass->place_count = (size_t)index + 1;
}

void wh_mcs_free_pass(wh_mcs_pass_t *pass) {
    free(pass->places);
    pass->places = NULL;
    pass->place_count = 0;
    pass->place_capacity = 0;
}

/* ---------------------------------------------------------------------------------------------- crossings */

/* The beam as motion control believes in it. */
static wh_beam_t believed(const wh_layout_t *layout, int32_t b) {
    const wh_layout_beam_t *beam = &layout->beams[b];
    return wh_beam_at(&layout->places[beam->station].base_from_station, beam->x, beam->y, beam->low,
                      beam->high);
}

/* Where the blade was as a latch's beam changed. False if motion control cannot tell. */
static bool find_crossing(const wh_mcs_t *mcs, const wh_latch_t *latch, wh_mcs_crossing_t *found) {
    const wh_mcs_pass_t *pass = &mcs->pass;
    const wh_layout_beam_t *beam = &mcs->layout->beams[latch->beam];
    const double slice_s = (double)mcs->layout->slice_us / 1e6;
    const double delay = latch->edge == WH_CROSSING_IN ? beam->delay_on : beam->delay_off;
    double time = (double)(latch->slice - 1) + latch->part - delay / slice_s;
    time = time > 0 ? time : 0;
    const size_t slice = (size_t)time;
    if (slice + 1 >= pass->place_count) {
        return false;
    }
    const wh_slice_motion_t motion = wh_slice_motion_between(&pass->places[slice], &pass->places[slice + 1]);
    const wh_beam_t line = believed(mcs->layout, latch->beam);
    found->time = ((double)pass->armed_seq + time) * slice_s;
    found->crossing.beam = latch->beam;
    found->crossing.edge = latch->edge;
    return wh_beam_crossing(&line, &motion, time - (double)slice, slice_s, &found->crossing);
}

static void find_crossings(const wh_mcs_t *mcs, wh_mcs_centring_t *centring) {
    const wh_mcs_pass_t *pass = &mcs->pass;
    const int64_t count = pass->latch_count < WH_CROSSINGS ? pass->latch_count : WH_CROSSINGS;
    centring->missed = pass->missed + pass->latch_count - count;
    for (int64_t i = 0; i < count; ++i) {
        if (find_crossing(mcs, &pass->latches[i], &centring->crossings[centring->count])) {
            ++centring->count;
        } else {
            ++centring->missed;
        }
    }
}

/* ------------------------------------------------------------------------------------------- the estimate */

static double field_or(lua_State *L, const char *name, double fallback) {
    lua_getfield(L, 1, name);
    const double value = luaL_optnumber(L, -1, fallback);
    lua_pop(L, 1);
    return value;
}

/* What is known of the wafer before: of the layout, or as the argument's fields say. */
static wh_centring_t known_of(lua_State *L, const wh_mcs_t *mcs) {
    const wh_layout_t *layout = mcs->layout;
    const wh_mcs_pass_t *pass = &mcs->pass;
    wh_centring_t known = wh_centring_nominal(field_or(L, "radius", layout->wafer_diameter / 2));
    known.sd_radius = field_or(L, "sd_radius", layout->wafer_spread / 2);
    const double far = hypot(layout->corrections.x, layout->corrections.y) + BEYOND_CORRECTIONS;
    known.reach = far < known.radius / 3 ? far : known.radius / 3;
    known.sd_time = LEAST_SD_TIME;
    known.agree = AGREE;
    for (int32_t b = pass->order.first; b < pass->order.first + pass->order.count; ++b) {
        const double jitter = layout->doors[b].jitter;
        known.sd_time = jitter > known.sd_time ? jitter : known.sd_time;
        /* Both crossings of a beam have one error: as if each had its own that is larger. */
        const double place = M_SQRT2 * layout->beams[b].sd;
        known.sd_place = place > known.sd_place ? place : known.sd_place;
    }
    if (!(layout->nominal_rim->notch.depth > 0)) {
        known.notch_width = 0;
    }
    known.sd_notch = field_or(L, "sd_notch", -1);
    known.notch_known = known.sd_notch >= 0;
    known.notch_direction = known.notch_known ? field_or(L, "notch", 0) : 0;
    known.sd_notch = known.notch_known ? known.sd_notch : 0;
    return known;
}

static wh_status_t solve(const wh_centring_t *known, wh_mcs_centring_t *centring, bool skipped) {
    wh_crossing_t crossings[WH_CROSSINGS];
    for (size_t i = 0; i < centring->count; ++i) {
        crossings[i] = centring->crossings[i].crossing;
    }
    if (skipped || centring->missed > 0) {
        return WH_STATUS_TOO_FEW_SAMPLES;
    }
    return wh_centring_solve(known, crossings, centring->count, &centring->centres);
}

/* ------------------------------------------------------------------------------------------------ for Lua */

static void push_crossing(lua_State *L, const wh_mcs_t *mcs, const wh_mcs_crossing_t *of,
                          const wh_centre_t *centre, size_t i) {
    static const char *const uses[] = {"rim", "notch", "other"};
    lua_createtable(L, 0, 6);
    wh_lua_set_integer(L, "beam", of->crossing.beam - mcs->pass.order.first + 1);
    wh_lua_set_text(L, "edge", of->crossing.edge == WH_CROSSING_IN ? "in" : "out");
    wh_lua_set_number(L, "x", of->crossing.x);
    wh_lua_set_number(L, "y", of->crossing.y);
    wh_lua_set_number(L, "time", of->time);
    wh_lua_set_text(L, "use", centre ? uses[centre->use[i]] : "none");
}

static void push_centre(lua_State *L, const wh_centre_t *centre) {
    lua_createtable(L, 0, 8);
    wh_lua_set_number(L, "x", centre->x);
    wh_lua_set_number(L, "y", centre->y);
    wh_lua_set_number(L, "radius", centre->radius);
    wh_lua_set_number(L, "sd_x", centre->sd_x);
    wh_lua_set_number(L, "sd_y", centre->sd_y);
    wh_lua_set_number(L, "sd", centre->sd_centre);
    wh_lua_set_number(L, "mismatch", centre->mismatch);
    wh_lua_set_integer(L, "used", centre->used);
}

static void push_centring(lua_State *L, const wh_mcs_t *mcs, const wh_mcs_centring_t *centring) {
    const wh_centre_t *best = centring->centres.count > 0 ? &centring->centres.candidates[0] : NULL;
    lua_createtable(L, 0, 4);
    wh_lua_set_integer(L, "error", centring->status);
    wh_lua_set_integer(L, "missed", centring->missed);
    lua_createtable(L, (int)centring->count, 0);
    for (size_t i = 0; i < centring->count; ++i) {
        push_crossing(L, mcs, &centring->crossings[i], best, i);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "crossings");
    lua_createtable(L, centring->centres.count, 0);
    for (int32_t i = 0; i < centring->centres.count; ++i) {
        push_centre(L, &centring->centres.candidates[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "candidates");
}

void wh_mcs_arm(wh_mcs_t *mcs, wh_latch_order_t order, int32_t station, int32_t gripper) {
    wh_mcs_pass_t *pass = &mcs->pass;
    wh_mcs_free_pass(pass);
    *pass = (wh_mcs_pass_t){.order = order,
                            .station = station,
                            .gripper = gripper,
                            .before = pass->number,
                            .number = pass->number,
                            .seq = pass->seq,
                            .goes_on = true};
    mcs->command.latch = order;
    mcs->unplayed = "beams at a station's door";
}

/* native.arm_beams(station, gripper): from the end of the next slice on the beams at the station's door latch
 * what crosses them, and this gripper's way is remembered. What was collected before is gone. */
static int arm_beams(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const wh_latch_order_t order = wh_layout_beams_at(mcs->layout, (size_t)station);
    luaL_argcheck(L, order.count > 0, 1, "no beams at its door");
    wh_mcs_arm(mcs, order, station, wh_mcs_index(L, 2, mcs->state.gripper_count));
    return 0;
}

/* native.disarm_beams(): with the next slice. */
static int disarm_beams(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    mcs->command.latch = (wh_latch_order_t){.kind = WH_LATCH_DISARM};
    mcs->pass.goes_on = false;
    return 0;
}

/* native.centre { notch = , sd_notch = , radius = , sd_radius = }: where the wafer's centre is on the blade
 * that passed the beams since arm_beams. The notch's direction in the blade's frame, rad, with its deviation,
 * and another radius than the layout's, mm, if they are known. Returns { error = the status, 0 if it is sure,
 * missed = how many latches motion control has not, crossings = in their order { beam = from 1 at that
 * station, edge = "in" or "out", x, y = on the blade, mm, time = s, use = "rim", "notch" or "other" by the
 * first candidate, "none" without one }, candidates = { x, y, radius, sd_x, sd_y, sd, mismatch, used } }. */
static int centre(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    luaL_checktype(L, 1, LUA_TTABLE);
    luaL_argcheck(L, mcs->pass.order.count > 0, 1, "no beams were armed");
    wh_decisions_measured(mcs->decisions, "centring on the way");
    const wh_centring_t known = known_of(L, mcs);
    mcs->centring = (wh_mcs_centring_t){.station = mcs->pass.station, .gripper = mcs->pass.gripper};
    find_crossings(mcs, &mcs->centring);
    mcs->centring.status = solve(&known, &mcs->centring, mcs->pass.skipped);
    if (mcs->partners.centring) {
        mcs->partners.centring(mcs->partners.user, mcs);
    }
    push_centring(L, mcs, &mcs->centring);
    return 1;
}

/* native.beam(station): { x, y } in base, mm: where the station's first beam is, at the height of slot 1, as
 * motion control believes; and as `station` the station's pose, likewise. */
static int push_beam(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const int32_t station = wh_mcs_index(L, 1, mcs->layout->station_count);
    const wh_latch_order_t order = wh_layout_beams_at(mcs->layout, (size_t)station);
    luaL_argcheck(L, order.count > 0, 1, "no beams at its door");
    const wh_beam_t beam = believed(mcs->layout, order.first);
    lua_createtable(L, 0, 2);
    wh_lua_set_number(L, "x", beam.x);
    wh_lua_set_number(L, "y", beam.y);
    return 1;
}

const luaL_Reg wh_mcs_centring_functions[] = {{"beam", push_beam},
                                              {"arm_beams", arm_beams},
                                              {"disarm_beams", disarm_beams},
                                              {"centre", centre},
                                              {NULL, NULL}};
