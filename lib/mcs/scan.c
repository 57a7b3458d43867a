/* The scanner: the codes of a station's slots, as two beams in front of the stack see the wafers.
 *
 *   The beams stand upright in the station's frame as motion control believes it, for the arm goes there:
 *   at x = -0.6 and y = +-0.6 of a wafer's radius, near the edge that the arm comes to. Sweeping along z,
 *   each notes the heights of the faces that it passes: of a wafer the back, or where wafers lie face down
 *   the face that looks at the slots. A wafer belongs to the slots nearest to its two heights.
 *   0 empty    no wafer belongs to the slot
 *   1 single   one does, level to half the pitch
 *   2 double   more than one does
 *   4 crossed  one belongs to it whose two heights differ by half the pitch or more, or that only one
 *              beam sees: it lies askew, or so far aside that the blade must not go in
 * Wafers on the arm are not in the station; those on its chuck are. */
#include <string.h>

#include "native.h"

#define BEAM_SHARE 0.6

enum { CODE_EMPTY = 0, CODE_SINGLE = 1, CODE_DOUBLE = 2, CODE_CROSSED = 4 };

/* What the beams see of one wafer: a height above slot 1 for each beam that it breaks. */
typedef struct {
    double height[2];
    bool seen[2];
} sight_t;

/* Where a beam passes a wafer's back face, in the station's frame. */
static bool pass_beam(const wh_pose_t *station_from_wafer, double radius, double x, double y,
                      double *height) {
    const wh_vec3_t n = wh_mat3_column(&station_from_wafer->R, 2);
    const wh_vec3_t *r = &station_from_wafer->r;
    if (!(n.z > 0.1)) {
        return false; /* on edge or upside down: nothing that lies in a slot */
    }
    const double dx = x - r->x;
    const double dy = y - r->y;
    const double dz = -(n.x * dx + n.y * dy) / n.z;
    *height = r->z + dz;
    return dx * dx + dy * dy + dz * dz <= radius * radius;
}

static sight_t look_at(const wh_mcs_t *mcs, const wh_station_t *place, const wh_wafer_t *wafer) {
    const double radius = mcs->layout->wafer_diameter / 2;
    wh_pose_t face = wafer->base_from_wafer;
    if (mcs->layout->has_faces) {
        wh_face_frame(&wafer->base_from_wafer, mcs->layout->cell.thickness,
                      wh_face_towards(&wafer->base_from_wafer, &place->base_from_station), &face);
    }
    const wh_pose_t station_from_wafer = wh_pose_relative(&place->base_from_station, &face);
    sight_t sight;
    for (int beam = 0; beam < 2; ++beam) {
        const double y = (beam == 0 ? -BEAM_SHARE : BEAM_SHARE) * radius;
        sight.seen[beam] =
            pass_beam(&station_from_wafer, radius, -BEAM_SHARE * radius, y, &sight.height[beam]);
    }
    return sight;
}

/* The slot (from 0) nearest to a height that is within the sweep, else -1. */
static int nearest_slot(const wh_station_t *place, double height) {
    const double at = height / place->pitch + 0.5;
    return at >= 0 && at < place->slots ? (int)at : -1;
}

static int code_with(int before, bool crossed) {
    if (crossed || before == CODE_CROSSED) {
        return CODE_CROSSED;
    }
    return before == CODE_EMPTY ? CODE_SINGLE : CODE_DOUBLE;
}

static void mark_range(int codes[], int one, int other, bool crossed) {
    const int low = one < other ? one : other;
    const int high = one < other ? other : one;
    for (int slot = low; slot <= high; ++slot) {
        codes[slot] = code_with(codes[slot], crossed);
    }
}

static void mark_wafer(const wh_station_t *place, const sight_t *sight, int codes[]) {
    int slots[2];
    for (int beam = 0; beam < 2; ++beam) {
        slots[beam] = sight->seen[beam] ? nearest_slot(place, sight->height[beam]) : -1;
    }
    if (slots[0] >= 0 && slots[1] >= 0) {
        const double apart = sight->height[1] - sight->height[0];
        mark_range(codes, slots[0], slots[1], apart * apart >= place->pitch * place->pitch / 4);
    } else if (slots[0] >= 0 || slots[1] >= 0) {
        const int slot = slots[slots[0] >= 0 ? 0 : 1];
        mark_range(codes, slot, slot, true);
    }
}

/* native.scan(station, robot, shift): a list of codes by slot, of the wafers as they lie now; of a station
 * that a host has moved by `shift`, see native.shift. */
static int scan(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const size_t station = (size_t)wh_mcs_index(L, 1, mcs->layout->station_count);
    const size_t robot = (size_t)luaL_checkinteger(L, 2) - 1;
    wh_station_t believed = mcs->layout->places[station];
    const wh_station_t *place = &believed;
    believed.base_from_station = wh_mcs_believed_station(L, 3, mcs, station, robot);
    int codes[WH_LAYOUT_SLOTS] = {CODE_EMPTY};
    wh_decisions_measured(mcs->decisions, "MAP");
    wh_sandbox_charge(L, mcs->state.wafer_count);
    for (size_t w = 0; w < mcs->state.wafer_count; ++w) {
        const wh_wafer_t *wafer = &mcs->state.wafers[w];
        if (wafer->holder == WH_NONE || wafer->holder == place->chuck) {
            const sight_t sight = look_at(mcs, place, wafer);
            mark_wafer(place, &sight, codes);
        }
    }
    lua_createtable(L, place->slots, 0);
    for (int slot = 0; slot < place->slots; ++slot) {
        lua_pushinteger(L, codes[slot]);
        lua_rawseti(L, -2, slot + 1);
    }
    return 1;
}

const luaL_Reg wh_mcs_scan_functions[] = {{"scan", scan}, {NULL, NULL}};
