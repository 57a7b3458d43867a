#include "decisions_ways.h"

#include <math.h>
#include <string.h>

/* Rounding changes a height by less, mm. */
#define SURE 1e-6

static wh_decisions_way_t *way_of(const wh_decisions_t *decisions, size_t gripper, int64_t slice) {
    const size_t stretch = (size_t)(slice - 1) / WH_DECISIONS_STRETCH;
    return &decisions->ways[stretch * decisions->gripper_count + gripper];
}

static const wh_pose_t *pose_at_slice(const wh_decisions_t *decisions, size_t gripper, int64_t slice) {
    return &decisions->poses[(size_t)(slice - 1) * decisions->gripper_count + gripper];
}

static bool differs_in_bits(wh_real_t a, wh_real_t b) {
    return a < b || a > b;
}

static bool turns_between(const wh_mat3_t *from, const wh_mat3_t *to) {
    bool found = false;
    for (int i = 0; i < 9; ++i) {
        found = found || differs_in_bits(from->m[i / 3][i % 3], to->m[i / 3][i % 3]);
    }
    return found;
}

bool wh_decisions_is_still(const wh_pose_t *from, const wh_pose_t *to) {
    return !turns_between(&from->R, &to->R) && !differs_in_bits(from->r.x, to->r.x) &&
           !differs_in_bits(from->r.y, to->r.y) && !differs_in_bits(from->r.z, to->r.z);
}

static void include_pose(wh_decisions_way_t *way, const wh_pose_t *pose) {
    way->low = wh_vec3(fmin(way->low.x, pose->r.x), fmin(way->low.y, pose->r.y), fmin(way->low.z, pose->r.z));
    way->high =
        wh_vec3(fmax(way->high.x, pose->r.x), fmax(way->high.y, pose->r.y), fmax(way->high.z, pose->r.z));
    way->turns = way->turns || turns_between(&way->R, &pose->R);
}

void wh_decisions_widen(wh_decisions_t *decisions, size_t gripper, int64_t slice) {
    wh_decisions_way_t *way = way_of(decisions, gripper, slice);
    if ((slice - 1) % WH_DECISIONS_STRETCH == 0) {
        const wh_pose_t *first = pose_at_slice(decisions, gripper, slice > 1 ? slice - 1 : slice);
        *way = (wh_decisions_way_t){first->r, first->r, first->R, false};
    }
    include_pose(way, pose_at_slice(decisions, gripper, slice));
}

static double length_of(wh_vec3_t v) {
    return sqrt(wh_vec3_dot(&v, &v));
}

/* True if something within `reach` of a place may be over one of the station's slots. */
static bool is_near(const wh_cell_t *cell, const wh_station_t *station, const wh_vec3_t *place,
                    double reach) {
    const wh_vec3_t up = wh_mat3_column(&station->base_from_station.R, 2);
    const wh_vec3_t from = wh_vec3_subtract(place, &station->base_from_station.r);
    const double height = wh_vec3_dot(&up, &from);
    const double top = (station->slots - 1) * station->pitch;
    const double beyond = height < 0 ? -height : height > top ? height - top : 0;
    const double aside = sqrt(fmax(wh_vec3_dot(&from, &from) - height * height, 0));
    return aside <= cell->tolerance.projxy + reach + SURE &&
           beyond <= 2 * cell->tolerance.projz + reach + SURE;
}

/* True if one of the station's planes, less projz or twice that, lies between the lowest and the highest
 * place of a wafer that does not turn. */
static bool is_between(const wh_cell_t *cell, const wh_station_t *station, const wh_decisions_way_t *way,
                       const wh_vec3_t *gripper_from_wafer, double slack) {
    const wh_vec3_t up = wh_mat3_column(&station->base_from_station.R, 2);
    const wh_vec3_t middle = wh_vec3((way->low.x + way->high.x) / 2, (way->low.y + way->high.y) / 2,
                                     (way->low.z + way->high.z) / 2);
    const wh_vec3_t aside = wh_mat3_transform(&way->R, gripper_from_wafer);
    const wh_vec3_t wafer = wh_vec3_add(&middle, &aside);
    const wh_vec3_t from = wh_vec3_subtract(&wafer, &station->base_from_station.r);
    const double half = (fabs(up.x) * (way->high.x - way->low.x) + fabs(up.y) * (way->high.y - way->low.y) +
                         fabs(up.z) * (way->high.z - way->low.z)) /
                            2 +
                        slack + SURE;
    const double down = wh_vec3_dot(&up, &from) + cell->tolerance.projz;
    const double rise = down + cell->tolerance.projz;
    return floor((down - half) / station->pitch) < floor((down + half) / station->pitch) ||
           floor((rise - half) / station->pitch) < floor((rise + half) / station->pitch);
}

bool wh_decisions_may_pass(const wh_decisions_t *decisions, const wh_cell_t *cell, size_t gripper,
                           int64_t slice, const wh_vec3_t *gripper_from_wafer, const wh_vec3_t *at,
                           const wh_vec3_t *run) {
    const wh_decisions_way_t *way = way_of(decisions, gripper, slice);
    const double moved = length_of(wh_vec3_subtract(at, run));
    const double across = length_of(wh_vec3_subtract(&way->high, &way->low));
    /* A chuck goes with its station, which is turned, too: what is farther from `run` moves more. */
    const double turned = moved > 0 ? 2 * (length_of(wh_vec3_subtract(&way->low, run)) + across) : 0;
    const double reach = across + moved + turned + length_of(*gripper_from_wafer) + cell->thickness;
    bool may = false;
    for (size_t s = 0; s < cell->count && !may; ++s) {
        const wh_station_t *station = &cell->stations[s];
        may =
            station->chuck != (int32_t)gripper && is_near(cell, station, &way->low, reach) &&
            (way->turns || moved > 0 || is_between(cell, station, way, gripper_from_wafer, cell->thickness));
    }
    return may;
}

/* ------------------------------------------------------------------------------------------------ wafers */

/* Where a wafer or a blade may be in a stretch: a box around its middle, and how far beyond it. */
typedef struct {
    wh_vec3_t middle, half;
    double beyond;
    bool turns;
} room_t;

static room_t room_of_gripper(const wh_decisions_t *decisions, const wh_state_t *state, size_t g,
                              int64_t slice, const double slack[WH_GRIPPERS]) {
    const wh_decisions_way_t *way = way_of(decisions, g, slice);
    const wh_vec3_t sum = wh_vec3_add(&way->low, &way->high), all = wh_vec3_subtract(&way->high, &way->low);
    room_t room = {wh_vec3_scale(0.5, &sum), wh_vec3_scale(0.5, &all), slack[g], way->turns};
    if (state->grippers[g].wafer != WH_NONE) {
        const wh_vec3_t *offset = &state->grippers[g].gripper_from_wafer.r;
        const wh_vec3_t aside = wh_mat3_transform(&way->R, offset);
        room.middle = wh_vec3_add(&room.middle, &aside);
        room.beyond += way->turns ? 2 * length_of(*offset) : 0;
    }
    return room;
}

static room_t room_of_wafer(const wh_decisions_t *decisions, const wh_state_t *state, size_t w, int64_t slice,
                            const double slack[WH_GRIPPERS]) {
    const wh_wafer_t *wafer = &state->wafers[w];
    const room_t still = {wafer->base_from_wafer.r, wh_vec3(0, 0, 0), 0, false};
    return wafer->holder == WH_NONE ? still
                                    : room_of_gripper(decisions, state, (size_t)wafer->holder, slice, slack);
}

/* True if some place of the one may be as high over the other as where it would go through. */
static bool may_cross(const wh_cell_t *cell, const room_t *one, const room_t *other, const wh_vec3_t *up) {
    const wh_vec3_t way = wh_vec3_subtract(&one->middle, &other->middle);
    const wh_vec3_t half = wh_vec3_add(&one->half, &other->half);
    const double beyond = one->beyond + other->beyond + 2 * cell->thickness + cell->tolerance.projz + SURE;
    const double over = fmax(cell->tolerance.projxy, 25);
    const double high = fabs(up->x) * half.x + fabs(up->y) * half.y + fabs(up->z) * half.z + beyond;
    return length_of(way) <= length_of(half) + beyond + over &&
           (one->turns || other->turns || fabs(wh_vec3_dot(up, &way)) <= high + 1e-3);
}

bool wh_decisions_may_meet(const wh_decisions_t *decisions, const wh_cell_t *cell, const wh_state_t *state,
                           size_t gripper, int64_t slice, const double slack[WH_GRIPPERS]) {
    const wh_decisions_way_t *way = way_of(decisions, gripper, slice);
    const room_t room = room_of_gripper(decisions, state, gripper, slice, slack);
    const int32_t held = state->grippers[gripper].wafer;
    const bool moves = way->turns || length_of(room.half) + room.beyond > 0;
    bool may = false;
    for (size_t w = 0; w < state->wafer_count && moves && !may; ++w) {
        const wh_vec3_t up =
            wh_mat3_column(held == WH_NONE ? &way->R : &state->wafers[w].base_from_wafer.R, 2);
        const room_t other = room_of_wafer(decisions, state, w, slice, slack);
        may = (int32_t)w != held && may_cross(cell, &room, &other, &up);
    }
    return may;
}
