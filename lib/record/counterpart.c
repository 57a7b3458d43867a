#include "counterpart.h"

/* The share of a limit that the value uses; all of it if the limit allows nothing. */
static wh_real_t share(wh_real_t value, wh_real_t limit) {
    if (limit > 0) {
        return value / limit;
    }
    return value > 0 ? (wh_real_t)DBL_MAX : 0;
}

/* Above this part of a limit a share is above `least`, whatever rounding does. So most wafers need no
 * division. */
#define SURELY ((wh_real_t)1.00001)

/* The largest share, or any number above `least` if it is not below that. */
static wh_real_t largest_share(const wh_pose_t *wafer, const wh_pose_t *gripper,
                               const wh_tolerance_t *tolerance, wh_real_t least) {
    const wh_vec3_t dr = wh_vec3_subtract(&wafer->r, &gripper->r);
    const wh_vec3_t n1 = wh_mat3_column(&wafer->R, 2);
    const wh_vec3_t n2 = wh_mat3_column(&gripper->R, 2);
    const wh_real_t away = wh_real_abs(wh_vec3_dot(&dr, &n1));
    if (tolerance->projz > 0 && away > SURELY * tolerance->projz * least) {
        return (wh_real_t)DBL_MAX;
    }
    const wh_real_t z = share(away, tolerance->projz);
    if (z >= least) {
        return z;
    }
    const wh_vec3_t in_wafer = wh_mat3_transform_back(&wafer->R, &dr);
    const wh_real_t xy =
        share(wh_real_sqrt(in_wafer.x * in_wafer.x + in_wafer.y * in_wafer.y), tolerance->projxy);
    const wh_real_t planar = share(1 - wh_vec3_dot(&n1, &n2), 1 - tolerance->planar);
    return wh_real_max(z, wh_real_max(xy, planar));
}

static const wh_pose_t *see(const wh_cell_t *cell, const wh_pose_t *wafer, const wh_pose_t *gripper,
                            wh_pose_t *room) {
    if (!(cell->thickness > 0)) {
        return wafer;
    }
    wh_face_frame(wafer, cell->thickness, wh_face_towards(wafer, gripper), room);
    return room;
}

int32_t wh_counterpart(const wh_state_t *state, size_t g, const wh_cell_t *cell, const int32_t *candidates,
                       size_t count) {
    const wh_gripper_t *gripper = &state->grippers[g];
    int32_t found = gripper->wafer;
    wh_real_t least = (wh_real_t)DBL_MAX;
    for (size_t i = 0; i < count && gripper->wafer == WH_NONE; ++i) {
        const int32_t wafer = candidates ? candidates[i] : (int32_t)i;
        wh_pose_t room;
        const wh_real_t largest = largest_share(
            see(cell, &state->wafers[wafer].base_from_wafer, &gripper->base_from_gripper, &room),
            &gripper->base_from_gripper, &cell->tolerance, least);
        if (found == WH_NONE || largest < least) {
            found = wafer;
            least = largest;
        }
    }
    return found;
}
