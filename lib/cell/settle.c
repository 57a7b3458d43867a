/* What was let go above its support comes to lie on it. */
#include "cell_internal.h"

/* Turns R by the smallest rotation that takes its third column to n, which is less than a right angle away. */
static void turn_towards(wh_mat3_t *R, const wh_vec3_t *n) {
    const wh_vec3_t from = wh_mat3_column(R, 2);
    const wh_vec3_t axis = wh_vec3_cross(&from, n); /* as long as the sine of the angle */
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

static void settle(const wh_cell_t *cell, wh_grasp_t *table, wh_event_list_t *list, size_t release) {
    const int32_t wafer = list->events[release].wafer;
    wh_place_t place;
    wh_pose_t pose = table->storage.wafers[wafer].base_from_wafer;
    if (!wh_cell_locate(cell, &pose, &place) || !(place.dz > 0)) {
        return;
    }
    const wh_vec3_t up = wh_mat3_column(&cell->stations[place.station].base_from_station.R, 2);
    const wh_vec3_t down = wh_vec3_scale(place.dz, &up);
    pose.r = wh_vec3_subtract(&pose.r, &down);
    turn_towards(&pose.R, &up);
    const bool moved = wh_grasp_place(table, (size_t)wafer, &pose) == WH_OK;
    wh_event_t *said = moved ? wh_cell_append(release, list, WH_EVENT_SETTLED) : NULL;
    if (said != NULL) {
        said->value = place.dz;
    }
}

void wh_cell_settle(const wh_cell_t *cell, wh_grasp_t *table, wh_event_list_t *list) {
    const size_t count = list->count;
    for (size_t i = 0; cell->settle && i < count; ++i) {
        if (list->events[i].kind == WH_EVENT_RELEASED) {
            settle(cell, table, list, i);
        }
    }
}
