#include "station.h"

#include "../grasp/face.h"
#include "../math/trig.h"

#define MOST_SLOTS 1000

/* Returns false for NaN. */
static bool is_limit(wh_real_t value, wh_real_t most) {
    return value >= 0 && value <= most;
}

static wh_status_t validate_station(const wh_station_t *station, size_t gripper_count) {
    const bool slotted = station->slots >= 1 && station->slots <= MOST_SLOTS && station->pitch > 0 &&
                         station->pitch <= WH_REAL(1e6);
    const bool good = station->chuck == WH_NONE || wh_is_index(station->chuck, gripper_count);
    return slotted && good ? wh_pose_validate(&station->base_from_station) : WH_STATUS_OUT_OF_RANGE;
}

static wh_status_t validate_cell(const wh_cell_t *cell) {
    if (cell->count > INT32_MAX) {
        return WH_STATUS_BAD_CAPACITY;
    }
    if (!is_limit(cell->off_centre, WH_REAL(1e6)) || !is_limit(cell->askew, 10) ||
        !is_limit(cell->thickness, WH_FACE_THICKEST) || !is_limit(cell->drop, WH_REAL(1e6))) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return cell->count == 0 ? WH_OK : wh_tolerance_validate(&cell->tolerance);
}

wh_status_t wh_cell_validate(const wh_cell_t *cell, size_t gripper_count) {
    if (!cell || (!cell->stations && cell->count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = validate_cell(cell);
    for (size_t s = 0; status == WH_OK && s < cell->count; ++s) {
        status = validate_station(&cell->stations[s], gripper_count);
    }
    return status;
}

wh_pose_t wh_station_slot(const wh_station_t *station, int32_t slot) {
    const wh_vec3_t e3 = wh_mat3_column(&station->base_from_station.R, 2);
    const wh_vec3_t up = wh_vec3_scale((wh_real_t)(slot - 1) * station->pitch, &e3);
    wh_pose_t base_from_slot = station->base_from_station;
    base_from_slot.r = wh_vec3_add(&station->base_from_station.r, &up);
    return base_from_slot;
}

wh_place_t wh_station_measure(const wh_station_t *station, int32_t slot, const wh_pose_t *base_from_wafer) {
    const wh_pose_t base_from_slot = wh_station_slot(station, slot);
    const wh_pose_t slot_from_wafer = wh_pose_relative(&base_from_slot, base_from_wafer);
    const wh_mat3_t *R = &slot_from_wafer.R;
    const wh_real_t sine = wh_real_sqrt(R->m[0][2] * R->m[0][2] + R->m[1][2] * R->m[1][2]);
    wh_place_t place;
    place.station = WH_NONE;
    place.slot = slot;
    place.dx = slot_from_wafer.r.x;
    place.dy = slot_from_wafer.r.y;
    place.dz = slot_from_wafer.r.z;
    place.tilt = wh_atan2(sine, R->m[2][2]);
    place.face = WH_FACE_BACK;
    return place;
}

/* The face of a wafer towards the station's slots; for a front, its frame goes into `room`. */
static wh_face_t face_seen(const wh_cell_t *cell, const wh_station_t *station,
                           const wh_pose_t *base_from_wafer, wh_pose_t *room) {
    if (!(cell->thickness > 0) ||
        wh_face_towards(base_from_wafer, &station->base_from_station) == WH_FACE_BACK) {
        return WH_FACE_BACK;
    }
    wh_face_frame(base_from_wafer, cell->thickness, WH_FACE_FRONT, room);
    return WH_FACE_FRONT;
}

wh_place_t wh_cell_measure(const wh_cell_t *cell, const wh_station_t *station, int32_t slot,
                           const wh_pose_t *base_from_wafer) {
    wh_pose_t room;
    const wh_face_t face = face_seen(cell, station, base_from_wafer, &room);
    wh_place_t place = wh_station_measure(station, slot, face == WH_FACE_BACK ? base_from_wafer : &room);
    place.face = face;
    return place;
}

/* The slot whose plane is nearest to a height above slot 1. It compares before it converts: a large height
 * does not fit an integer. */
static int32_t nearest_slot(const wh_station_t *station, wh_real_t height) {
    const wh_real_t position = height / station->pitch + WH_REAL(0.5);
    if (position == position && position >= 0 && position < (wh_real_t)station->slots) {
        return (int32_t)position + 1;
    }
    return position > 0 ? station->slots : 1;
}

static int32_t nearest_slot_of(const wh_station_t *station, const wh_pose_t *base_from_wafer) {
    const wh_vec3_t e3 = wh_mat3_column(&station->base_from_station.R, 2);
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_wafer->r, &station->base_from_station.r);
    return nearest_slot(station, wh_vec3_dot(&e3, &dr));
}

static bool lies_in(const wh_cell_t *cell, const wh_station_t *station, const wh_pose_t *base_from_wafer,
                    const wh_place_t *place) {
    const wh_vec3_t slot_normal = wh_mat3_column(&station->base_from_station.R, 2);
    const wh_vec3_t n1 = wh_mat3_column(&base_from_wafer->R, 2);
    return wh_real_abs(place->dz) < station->pitch / 2 &&
           wh_real_sqrt(place->dx * place->dx + place->dy * place->dy) < cell->tolerance.projxy &&
           wh_vec3_dot(&n1, &slot_normal) > cell->tolerance.planar;
}

bool wh_cell_locate(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, wh_place_t *place) {
    wh_real_t best = 0;
    bool found = false;
    for (size_t s = 0; s < cell->count; ++s) {
        const wh_station_t *station = &cell->stations[s];
        wh_pose_t room;
        const wh_face_t face = face_seen(cell, station, base_from_wafer, &room);
        const wh_pose_t *seen = face == WH_FACE_BACK ? base_from_wafer : &room;
        const int32_t slot = nearest_slot_of(station, seen);
        wh_place_t here = wh_station_measure(station, slot, seen);
        const wh_real_t square = here.dx * here.dx + here.dy * here.dy + here.dz * here.dz;
        if (lies_in(cell, station, seen, &here) && (!found || square < best)) {
            here.station = (int32_t)s;
            here.face = face;
            *place = here;
            best = square;
            found = true;
        }
    }
    return found;
}
