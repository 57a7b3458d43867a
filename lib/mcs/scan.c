/* The scanner: the view of a MAP's beams on the wafers as they lie now. The beams stand in the station's
 * frame as motion control believes it, because the arm goes there. Wafers on the arm are not in the
 * station; those on its chuck are. */
#include <string.h>

#include "native.h"
#include "slot_codes.h"

/* The face that looks at the slots, in the station's frame. */
static wh_pose_t find_face(const wh_mcs_t *mcs, const wh_station_t *place, const wh_wafer_t *wafer) {
    wh_pose_t face = wafer->base_from_wafer;
    if (mcs->layout->has_faces) {
        wh_face_frame(&wafer->base_from_wafer, mcs->layout->cell.thickness,
                      wh_face_towards(&wafer->base_from_wafer, &place->base_from_station), &face);
    }
    return wh_pose_relative(&place->base_from_station, &face);
}

void wh_mcs_see_slots(const wh_mcs_t *mcs, const wh_station_t *place, const wh_mapping_t *mapping,
                      int codes[WH_LAYOUT_SLOTS]) {
    const wh_slot_beams_t beams = {mapping, place->slots, place->pitch, mcs->layout->wafer_diameter / 2};
    memset(codes, 0, WH_LAYOUT_SLOTS * sizeof *codes);
    for (size_t w = 0; w < mcs->state.wafer_count; ++w) {
        const wh_wafer_t *wafer = &mcs->state.wafers[w];
        if (wafer->holder == WH_NONE || wafer->holder == place->chuck) {
            const wh_pose_t face = find_face(mcs, place, wafer);
            wh_slot_codes_add(&beams, &face, mcs->layout->wafers[w].thickness, codes);
        }
    }
}

/* native.scan(station, robot, shift): a list of codes by slot, for the wafers as they lie now. For a
 * station that a host has moved by `shift`, see native.shift. */
static int scan_slots(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const size_t station = (size_t)wh_mcs_index(L, 1, mcs->layout->station_count);
    const size_t robot = (size_t)luaL_checkinteger(L, 2) - 1;
    wh_station_t believed = mcs->layout->places[station];
    const wh_station_t *place = &believed;
    believed.base_from_station = wh_mcs_believed_station(L, 3, mcs, station, robot);
    int codes[WH_LAYOUT_SLOTS];
    wh_decisions_measured(mcs->wanted.decisions, "MAP");
    wh_decisions_visit(mcs->wanted.decisions, (int32_t)station, (int32_t)robot);
    wh_sandbox_charge(L, mcs->state.wafer_count);
    wh_mcs_see_slots(mcs, place, &mcs->layout->mapping, codes);
    lua_createtable(L, place->slots, 0);
    for (int slot = 0; slot < place->slots; ++slot) {
        lua_pushinteger(L, codes[slot]);
        lua_rawseti(L, -2, slot + 1);
    }
    return 1;
}

const luaL_Reg wh_mcs_scan_functions[] = {{"scan", scan_slots}, {NULL, NULL}};
