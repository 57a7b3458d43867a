/* The cell's judgement of a release or of a chuck's hand-over, and how a wafer then comes to lie. */
#include "station.h"

/* A wafer that is nearer to its slot's plane than this, mm, lies on it. */
#define SUPPORT_TOUCH WH_REAL(1e-3)

/* Finds the support below a wafer, the nearest slot's plane or base's floor, and its distance. A wafer less
 * than projz below a plane is on it. If a wafer is in no slot, although it is at most half a pitch above
 * that plane, the reason is its tilt. */
static void find_support(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, wh_event_t *said) {
    bool found = false;
    said->height = base_from_wafer->r.z;
    for (size_t s = 0; s < cell->count; ++s) {
        const wh_station_t *station = &cell->stations[s];
        for (int32_t slot = 1; slot <= station->slots; ++slot) {
            const wh_place_t place = wh_cell_measure(cell, station, slot, base_from_wafer);
            const wh_real_t aside = wh_real_sqrt(place.dx * place.dx + place.dy * place.dy);
            if (aside < cell->tolerance.projxy && place.dz > -cell->tolerance.projz &&
                (!found || place.dz < said->height)) {
                said->height = place.dz;
                said->value = place.dz < station->pitch / 2 ? place.tilt : 0;
                found = true;
            }
        }
    }
}

/* True if a wafer lies in exactly this slot. A wafer that a blade holds over the slot is only passing. */
static bool occupies(const wh_cell_t *cell, const wh_wafer_t *wafer, const wh_place_t *place) {
    wh_place_t other;
    return (wafer->holder == WH_NONE || wafer->holder == cell->stations[place->station].chuck) &&
           wh_cell_locate(cell, &wafer->base_from_wafer, &other) && other.station == place->station &&
           other.slot == place->slot;
}

static int32_t find_other(const wh_cell_t *cell, const wh_grasp_t *table, int32_t wafer,
                          const wh_place_t *place) {
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        if ((int32_t)w != wafer && occupies(cell, &table->storage.wafers[w], place)) {
            return (int32_t)w;
        }
    }
    return WH_NONE;
}

/* A copy of the list's events[release] as another kind, appended to the list; null if it is full. */
static wh_event_t *append_as(size_t release, wh_event_list_t *list, wh_event_kind_t kind) {
    if (list->count >= list->capacity) {
        return NULL;
    }
    wh_event_t *said = &list->events[list->count++];
    *said = list->events[release];
    said->kind = kind;
    return said;
}

static void judge_unsupported(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list,
                              size_t release) {
    const int32_t wafer = list->events[release].wafer;
    wh_event_t *said = append_as(release, list, WH_EVENT_RELEASED_UNSUPPORTED);
    if (said != NULL) {
        find_support(cell, &table->storage.wafers[wafer].base_from_wafer, said);
    }
}

/* True if it was released in the air over its slot; it reports that. */
static bool judge_drop(const wh_cell_t *cell, wh_event_list_t *list, size_t release,
                       const wh_place_t *place) {
    if (!(cell->drop > 0) || place->dz <= cell->drop) {
        return false;
    }
    wh_event_t *said = append_as(release, list, WH_EVENT_RELEASED_UNSUPPORTED);
    if (said != NULL) {
        said->height = place->dz;
        said->value = 0;
        said->limit = cell->drop;
    }
    return true;
}

static void judge_occupied(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list,
                           size_t release, const wh_place_t *place) {
    const int32_t other = find_other(cell, table, list->events[release].wafer, place);
    wh_event_t *said = other == WH_NONE ? NULL : append_as(release, list, WH_EVENT_SLOT_OCCUPIED);
    if (said != NULL) {
        said->other = other;
    }
}

/* Reports that `found` is above a limit, if there is one. */
static void judge_limit(wh_event_list_t *list, size_t release, wh_event_kind_t kind, wh_real_t found,
                        wh_real_t limit) {
    wh_event_t *said = limit > 0 && found > limit ? append_as(release, list, kind) : NULL;
    if (said != NULL) {
        said->value = found;
        said->limit = limit;
    }
}

static void judge_placing(const wh_cell_t *cell, wh_event_list_t *list, size_t placing,
                          const wh_place_t *place) {
    const wh_real_t aside = wh_real_sqrt(place->dx * place->dx + place->dy * place->dy);
    judge_limit(list, placing, WH_EVENT_PLACED_OFF_CENTRE, aside, cell->off_centre);
    judge_limit(list, placing, WH_EVENT_PLACED_ASKEW, place->tilt, cell->askew);
}

static void judge_release(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list,
                          size_t release) {
    const int32_t wafer = list->events[release].wafer;
    wh_place_t place;
    const bool lies = wh_cell_locate(cell, &table->storage.wafers[wafer].base_from_wafer, &place);
    if (!lies || !(place.dz > -cell->tolerance.projz)) {
        judge_unsupported(cell, table, list, release);
    } else if (!judge_drop(cell, list, release, &place)) {
        judge_occupied(cell, table, list, release, &place);
    }
    if (lies) {
        judge_placing(cell, list, release, &place);
    }
}

/* A chuck that takes a wafer over is judged like a slot, as it stands now: a stage may have moved it. */
static void judge_handover(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list,
                           size_t handover) {
    const wh_event_t *said = &list->events[handover];
    wh_station_t chuck = {.base_from_station = table->storage.grippers[said->gripper].base_from_gripper};
    for (size_t s = 0; s < cell->count; ++s) {
        if (cell->stations[s].chuck == said->gripper) {
            const wh_place_t place =
                wh_cell_measure(cell, &chuck, 1, &table->storage.wafers[said->wafer].base_from_wafer);
            judge_placing(cell, list, handover, &place);
            return;
        }
    }
}

size_t wh_cell_judge(const wh_cell_t *cell, const wh_grasp_t *table, wh_event_list_t *list) {
    const size_t count = list->count;
    for (size_t i = 0; i < count; ++i) {
        if (list->events[i].kind == WH_EVENT_RELEASED) {
            judge_release(cell, table, list, i);
        } else if (list->events[i].kind == WH_EVENT_HANDED_OVER) {
            judge_handover(cell, table, list, i);
        }
    }
    return list->count - count;
}

/* ----------------------------------------------------------------------------------------------- settling */

/* Turns R by the smallest rotation that takes its third column to n, which is less than a right angle
 * away. */
static void turn_towards(wh_mat3_t *R, const wh_vec3_t *n) {
    const wh_vec3_t from = wh_mat3_column(R, 2);
    const wh_vec3_t axis = wh_vec3_cross(&from, n); /* its length is the sine of the angle */
    const wh_real_t share = 1 / (1 + wh_vec3_dot(&from, n));
    for (size_t column = 0; column < 3; ++column) {
        const wh_vec3_t v = wh_mat3_column(R, column);
        const wh_vec3_t aside = wh_vec3_cross(&axis, &v);
        const wh_real_t along = share * wh_vec3_dot(&axis, &v);
        const wh_real_t cosine = wh_vec3_dot(&from, n);
        R->m[0][column] = cosine * v.x + aside.x + along * axis.x;
        R->m[1][column] = cosine * v.y + aside.y + along * axis.y;
        R->m[2][column] = cosine * v.z + aside.z + along * axis.z;
    }
    wh_mat3_orthonormalise(R);
}

/* Turns a wafer about the centre of the face that it lies on. */
static void lay_flat(const wh_cell_t *cell, wh_face_t lies_on, const wh_vec3_t *up, wh_pose_t *pose) {
    wh_pose_t face;
    wh_face_frame(pose, cell->thickness, lies_on, &face);
    turn_towards(&face.R, up);
    wh_face_frame(&face, cell->thickness, lies_on, pose);
}

/* A wafer within the tolerance below its plane is on its support. */
static bool is_supported(const wh_cell_t *cell, const wh_place_t *place) {
    return place->dz < 0 && place->dz > -cell->tolerance.projz;
}

/* A wafer above its plane comes to lie only if wafers settle, and so does one that leans with its centre in
 * the plane; a wafer below has been stopped by a support. */
static bool comes_to_lie(const wh_cell_t *cell, const wh_place_t *place) {
    const bool sinks = place->dz > 0 || (place->dz >= 0 && place->tilt > 0);
    return sinks ? cell->settle : is_supported(cell, place);
}

static void settle(const wh_cell_t *cell, wh_grasp_t *table, wh_event_list_t *list, size_t release) {
    const int32_t wafer = list->events[release].wafer;
    wh_place_t place;
    wh_pose_t pose = table->storage.wafers[wafer].base_from_wafer;
    if (!wh_cell_locate(cell, &pose, &place) || !comes_to_lie(cell, &place)) {
        return;
    }
    const wh_vec3_t up = wh_mat3_column(&cell->stations[place.station].base_from_station.R, 2);
    const wh_vec3_t down = wh_vec3_scale(place.dz, &up);
    pose.r = wh_vec3_subtract(&pose.r, &down);
    if (cell->settle) {
        lay_flat(cell, place.face, &up, &pose);
    }
    const bool moved = wh_grasp_place(table, (size_t)wafer, &pose) == WH_OK;
    wh_event_t *said = moved && place.dz > 0 ? append_as(release, list, WH_EVENT_SETTLED) : NULL;
    if (said != NULL) {
        said->value = place.dz;
    }
}

void wh_cell_settle(const wh_cell_t *cell, wh_grasp_t *table, wh_event_list_t *list) {
    const size_t count = list->count;
    for (size_t i = 0; i < count; ++i) {
        if (list->events[i].kind == WH_EVENT_RELEASED) {
            settle(cell, table, list, i);
        }
    }
}

bool wh_cell_stops(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, const wh_pose_t *next) {
    wh_place_t place;
    if (!wh_cell_locate(cell, base_from_wafer, &place) ||
        (place.dz < -SUPPORT_TOUCH && !is_supported(cell, &place))) {
        return false;
    }
    return wh_cell_measure(cell, &cell->stations[place.station], place.slot, next).dz < SUPPORT_TOUCH;
}
