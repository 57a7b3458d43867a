#include "proximity_message.h"

#include <string.h>

static int32_t find_nearest(const wh_state_t *state, const wh_gripper_t *gripper) {
    int32_t nearest = WH_NONE;
    wh_real_t least = 0;
    for (size_t w = 0; w < state->wafer_count; ++w) {
        const wh_vec3_t dr =
            wh_vec3_subtract(&state->wafers[w].base_from_wafer.r, &gripper->base_from_gripper.r);
        const wh_real_t square = wh_vec3_dot(&dr, &dr);
        if (nearest == WH_NONE || square < least) {
            nearest = (int32_t)w;
            least = square;
        }
    }
    return nearest;
}

static void put_gripper(const wh_state_t *state, size_t g, const wh_tolerance_t *tolerance,
                        waferhand_proximity *message) {
    const wh_gripper_t *gripper = &state->grippers[g];
    const int32_t nearest = find_nearest(state, gripper);
    wh_proximity_t p;
    message->wafer[g] = nearest;
    message->valve[g] = (int8_t)gripper->valve;
    if (nearest == WH_NONE || wh_proximity_measure(&state->wafers[nearest].base_from_wafer,
                                                   &gripper->base_from_gripper, tolerance, &p) != WH_OK) {
        return;
    }
    message->dr_proj_z[g] = p.dr_proj_z;
    message->dr_proj_xy[g][0] = p.dr_proj_xy.x;
    message->dr_proj_xy[g][1] = p.dr_proj_xy.y;
    message->dr_proj_xy[g][2] = p.dr_proj_xy.z;
    message->dr_proj_xy_norm[g] = p.dr_proj_xy_norm;
    message->n1_proj_n2[g] = p.n1_proj_n2;
    message->ready[g] = p.ready ? 1 : 0;
    message->holds[g] = gripper->wafer == nearest ? 1 : 0;
}

void wh_link_proximity_to_message(const wh_state_t *state, const wh_link_identity_t *identity,
                                  const wh_tolerance_t *tolerance, waferhand_proximity *message) {
    memset(message, 0, sizeof *message);
    message->utime = state->utime;
    message->seq = state->seq;
    message->run = identity->run;
    message->layout_hash = (int64_t)identity->layout_hash;
    message->eps_projz = tolerance->projz;
    message->eps_projxy = tolerance->projxy;
    message->eps_planar = tolerance->planar;
    message->gripper_count = (int32_t)state->gripper_count;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        put_gripper(state, g, tolerance, message);
    }
}
