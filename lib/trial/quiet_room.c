/* How far a gripper may go up or down until something may be decided. The heights of what it comes to tell
 * that, not how far off it is. */
#include "../grasp/face.h"
#include "quiet.h"

/* Rounding, mm. */
#define SURE WH_REAL(1e-3)

/* A place this near to a wafer's centre is within its rim, whatever its size: cell/meeting.c. */
#define OVER WH_REAL(25)

typedef struct {
    const wh_simulator_t *simulator;
    const wh_quiet_t *quiet;
    uint32_t axes;
    const wh_gripper_t *gripper;
    size_t g;
    bool looks; /* it would take a wafer */
} stroke_t;

static wh_real_t least_of(wh_real_t a, wh_real_t b) {
    return a < b ? a : b;
}

/* Something happens between heights within `within`, or at them, to what is within `aside` of an axis: the
 * way until both may hold. `from` leads from it, `up` is its normal. */
static wh_real_t room_of(const wh_vec3_t *from, const wh_vec3_t *up, wh_real_t room, wh_real_t aside) {
    const wh_real_t height = wh_vec3_dot(up, from);
    const wh_real_t square = wh_vec3_dot(from, from) - height * height;
    const wh_real_t beside = (square > 0 ? wh_real_sqrt(square) : 0) - aside;
    return room > beside ? room : beside;
}

static bool stands(const stroke_t *stroke, int32_t gripper) {
    return gripper == WH_NONE || (stroke->quiet->movers[gripper] & stroke->axes) == 0;
}

/* The two faces of a wafer, of which one looks at a gripper. */
static void faces_of(const wh_simulator_t *simulator, const wh_pose_t *base_from_wafer, wh_vec3_t faces[2]) {
    const wh_vec3_t n = wh_mat3_column(&base_from_wafer->R, 2);
    const wh_vec3_t through = wh_vec3_scale(simulator->cell.thickness, &n);
    faces[0] = base_from_wafer->r;
    faces[1] = wh_vec3_add(&base_from_wafer->r, &through);
}

/* A gripper takes a wafer, or tells that it nearly did, within these distances. */
static wh_real_t room_to_take(const wh_simulator_t *simulator, const wh_pose_t *base_from_wafer,
                              const wh_vec3_t *gripper) {
    const wh_grasp_config_t *config = &simulator->table.config;
    const wh_vec3_t n = wh_mat3_column(&base_from_wafer->R, 2);
    const wh_real_t height = wh_real_max(config->near_projz, 2 * config->tolerance.projz);
    const wh_real_t aside = wh_real_max(config->near_projxy, config->tolerance.projxy);
    wh_vec3_t faces[2];
    wh_real_t room = WH_REAL(1e9);
    faces_of(simulator, base_from_wafer, faces);
    for (size_t i = 0; i < 2; ++i) {
        const wh_vec3_t from = wh_vec3_subtract(gripper, &faces[i]);
        room = least_of(room, room_of(&from, &n, wh_real_abs(wh_vec3_dot(&n, &from)) - height, aside));
    }
    return room;
}

static wh_real_t over_of(const wh_simulator_t *simulator) {
    return wh_real_max(simulator->cell.tolerance.projxy, OVER);
}

/* An empty blade goes through a wafer where it passes this height over the face that it sees. */
static wh_real_t room_of_blade(const stroke_t *stroke, const wh_pose_t *other) {
    const wh_pose_t *blade = &stroke->gripper->base_from_gripper;
    const wh_vec3_t up = wh_mat3_column(&blade->R, 2);
    const wh_real_t plane = stroke->simulator->cell.tolerance.projz;
    wh_vec3_t faces[2];
    wh_real_t room = WH_REAL(1e9);
    faces_of(stroke->simulator, other, faces);
    for (size_t i = 0; i < 2; ++i) {
        const wh_vec3_t from = wh_vec3_subtract(&blade->r, &faces[i]);
        room = least_of(room, room_of(&from, &up, wh_real_abs(wh_vec3_dot(&up, &from) - plane),
                                      over_of(stroke->simulator)));
    }
    return room;
}

/* A held wafer goes through another one where their middles pass two heights, one up and one down. */
static wh_real_t room_of_wafer(const stroke_t *stroke, const wh_pose_t *own, const wh_pose_t *other) {
    const wh_cell_t *cell = &stroke->simulator->cell;
    const wh_vec3_t n = wh_mat3_column(&own->R, 2), up = wh_mat3_column(&other->R, 2);
    const wh_vec3_t tilt = wh_vec3_subtract(&n, &up), lean = wh_vec3_scale(cell->thickness / 2, &tilt);
    const wh_vec3_t apart = wh_vec3_subtract(&own->r, &other->r), from = wh_vec3_add(&apart, &lean);
    const wh_real_t height = wh_vec3_dot(&up, &from);
    const wh_real_t room =
        least_of(wh_real_abs(height + SURE) - SURE, wh_real_abs(height + cell->tolerance.projz));
    return room_of(&from, &up, room, over_of(stroke->simulator));
}

static wh_real_t room_to_wafers(const stroke_t *stroke) {
    const wh_grasp_storage_t *storage = &stroke->simulator->table.storage;
    const int32_t held = stroke->gripper->wafer;
    wh_real_t room = WH_REAL(1e9);
    for (size_t w = 0; w < storage->wafer_count && room > 0; ++w) {
        const wh_wafer_t *wafer = &storage->wafers[w];
        if ((int32_t)w == held || !stands(stroke, wafer->holder)) {
            continue;
        }
        const wh_pose_t *other = &wafer->base_from_wafer;
        room = least_of(room, held == WH_NONE
                                  ? room_of_blade(stroke, other)
                                  : room_of_wafer(stroke, &storage->wafers[held].base_from_wafer, other));
        if (stroke->looks) {
            room =
                least_of(room, room_to_take(stroke->simulator, other, &stroke->gripper->base_from_gripper.r));
        }
    }
    return room;
}

/* Until the face passes the plane at which it is through a slot, on its way up or down: cell/passing.c. */
static wh_real_t room_to_planes(const wh_cell_t *cell, const wh_station_t *station, wh_real_t height) {
    const wh_real_t projz = cell->tolerance.projz;
    const wh_real_t most = wh_real_max(station->pitch / 4, projz);
    const wh_real_t depths[2] = {projz, least_of(2 * projz, most)};
    wh_real_t room = WH_REAL(1e9);
    for (size_t i = 0; i < 2; ++i) {
        const wh_real_t at = height + depths[i];
        const wh_real_t slot = station->slots > 1 ? at / station->pitch : 0;
        const wh_real_t last = (wh_real_t)(station->slots - 1);
        const wh_real_t low = slot > 0 ? (slot < last ? (wh_real_t)(int64_t)slot : last) : 0;
        const wh_real_t high = low < last ? low + 1 : last;
        room = least_of(room, wh_real_abs(at - low * station->pitch));
        room = least_of(room, wh_real_abs(at - high * station->pitch));
    }
    return room;
}

static wh_real_t room_to_stations(const stroke_t *stroke) {
    const wh_cell_t *cell = &stroke->simulator->cell;
    const wh_pose_t *own = &stroke->simulator->table.storage.wafers[stroke->gripper->wafer].base_from_wafer;
    wh_vec3_t faces[2];
    wh_real_t room = WH_REAL(1e9);
    faces_of(stroke->simulator, own, faces);
    for (size_t s = 0; s < cell->count && room > 0; ++s) {
        const wh_station_t *station = &cell->stations[s];
        const wh_vec3_t up = wh_mat3_column(&station->base_from_station.R, 2);
        for (size_t i = 0; i < 2 && station->chuck != (int32_t)stroke->g; ++i) {
            const wh_vec3_t from = wh_vec3_subtract(&faces[i], &station->base_from_station.r);
            room = least_of(room, room_of(&from, &up, room_to_planes(cell, station, wh_vec3_dot(&up, &from)),
                                          cell->tolerance.projxy + 1));
        }
    }
    return room;
}

static bool is_passive(const wh_simulator_t *simulator, size_t g) {
    return simulator->given.gripping && simulator->given.grips.parts.grips[g].kind == WH_GRIP_PASSIVE;
}

/* Others without a wafer may look for one. */
static wh_real_t room_to_grippers(const stroke_t *stroke) {
    const wh_grasp_storage_t *storage = &stroke->simulator->table.storage;
    const wh_pose_t *own = &storage->wafers[stroke->gripper->wafer].base_from_wafer;
    wh_real_t room = WH_REAL(1e9);
    for (size_t g = 0; g < storage->gripper_count && room > 0; ++g) {
        const wh_gripper_t *other = &storage->grippers[g];
        const bool looks = g != stroke->g && other->wafer == WH_NONE && stands(stroke, (int32_t)g) &&
                           (other->valve == WH_VALVE_OPEN || is_passive(stroke->simulator, g));
        room =
            looks ? least_of(room, room_to_take(stroke->simulator, own, &other->base_from_gripper.r)) : room;
    }
    return room;
}

/* The only axis that moves the gripper, if it lifts it and does not turn it; WH_AXES: there is none. */
static size_t lifting_axis(const wh_quiet_t *quiet, uint32_t axes, uint32_t still, size_t g) {
    const uint32_t its = axes & quiet->movers[g] & ~still;
    size_t axis = 0;
    while (axis < WH_AXES && (its >> axis & 1U) == 0) {
        ++axis;
    }
    const bool is_only = axis < WH_AXES && its >> axis == 1;
    const bool lifts = is_only && (quiet->lifters[g] & its) != 0 && !(quiet->by_axis[g][axis].turn > 0);
    return lifts ? axis : WH_AXES;
}

wh_real_t wh_quiet_room(const wh_quiet_t *quiet, const wh_simulator_t *simulator, uint32_t axes,
                        uint32_t still, size_t g, size_t *axis) {
    const wh_gripper_t *gripper = &simulator->table.storage.grippers[g];
    const bool holds = gripper->wafer != WH_NONE;
    const stroke_t stroke = {simulator, quiet, axes, gripper, g, !holds && gripper->valve == WH_VALVE_OPEN};
    const bool is_vacuum =
        !simulator->given.gripping || simulator->given.grips.parts.grips[g].kind == WH_GRIP_VACUUM;
    *axis = lifting_axis(quiet, axes, still, g);
    if (*axis == WH_AXES || !is_vacuum) {
        return 0;
    }
    wh_real_t room = room_to_wafers(&stroke);
    room = holds && room > 0 ? least_of(room, room_to_stations(&stroke)) : room;
    room = holds && room > 0 ? least_of(room, room_to_grippers(&stroke)) : room;
    return room > SURE ? room - SURE : 0;
}
