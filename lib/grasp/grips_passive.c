/* Passive pads within a step, and what a wafer lies on. */
#include "grasp_internal.h"
#include "grips_internal.h"
#include "passive.h"

static wh_passive_t rules_of(const wh_grips_t *grips) {
    wh_passive_t rules;
    rules.tolerance = grips->table->config.tolerance;
    rules.check = grips->table->config.check;
    rules.thickness = grips->parts.thickness;
    return rules;
}

/* Where the pads were in the last slice. */
static const wh_pose_t *begin_of(const wh_turn_t *turn) {
    return turn->grips->table->slice == 1 ? &turn->input->base_from_gripper
                                          : &turn->gripper->base_from_gripper;
}

static wh_passive_change_t ask(const wh_turn_t *turn, int32_t support, wh_passive_wafer_t *wafer) {
    const wh_passive_t rules = rules_of(turn->grips);
    const wh_pose_t *plane = support == WH_NONE ? NULL : &turn->grips->parts.supports[support];
    wh_passive_change_t change = WH_PASSIVE_STAYS;
    (void)wh_passive_step(&rules, begin_of(turn), &turn->input->base_from_gripper, plane, wafer, &change);
    return change;
}

void wh_passive_turn_move(const wh_turn_t *turn) {
    if (turn->gripper->wafer == WH_NONE) {
        return;
    }
    wh_wafer_t *wafer = &wh_turn_wafers(turn)[turn->gripper->wafer];
    for (size_t s = 0; s < turn->grips->parts.support_count; ++s) {
        wh_passive_wafer_t after = {.carried = true};
        after.base_from_wafer = wafer->base_from_wafer;
        after.gripper_from_wafer = turn->gripper->gripper_from_wafer;
        if (ask(turn, (int32_t)s, &after) == WH_PASSIVE_LEFT) {
            wafer->base_from_wafer = after.base_from_wafer;
            wh_turn_let_go(turn);
            return;
        }
    }
    wh_grasp_carry(wafer, &turn->input->base_from_gripper, &turn->gripper->gripper_from_wafer);
}

static void see(const wh_grips_t *grips, const wh_pose_t *base_from_wafer, const wh_pose_t *plane,
                wh_pose_t *base_from_face) {
    const wh_real_t thickness = grips->parts.thickness;
    wh_face_frame(base_from_wafer, thickness, wh_face_seen(base_from_wafer, thickness, plane),
                  base_from_face);
}

/* How far this wafer's face is above a plane, along the plane's e3. */
static wh_real_t height_over(const wh_grips_t *grips, const wh_pose_t *base_from_wafer,
                             const wh_pose_t *plane) {
    wh_pose_t face;
    see(grips, base_from_wafer, plane, &face);
    const wh_vec3_t dr = wh_vec3_subtract(&face.r, &plane->r);
    const wh_vec3_t n = wh_mat3_column(&plane->R, 2);
    return wh_vec3_dot(&dr, &n);
}

static bool is_over(const wh_grips_t *grips, const wh_pose_t *base_from_wafer, const wh_pose_t *plane) {
    wh_pose_t face;
    wh_proximity_t p;
    see(grips, base_from_wafer, plane, &face);
    wh_proximity_values(&face, plane, &grips->table->config.tolerance, &p);
    return (p.failed & ~(unsigned)WH_FAILED_PROJZ) == 0;
}

int32_t wh_grips_support(const wh_grips_t *grips, size_t wafer) {
    const wh_wafer_t *lying = &grips->table->storage.wafers[wafer];
    int32_t best = WH_NONE;
    wh_real_t least = grips->table->config.tolerance.projz;
    for (size_t s = 0; s < grips->parts.support_count && lying->holder == WH_NONE; ++s) {
        const wh_pose_t *plane = &grips->parts.supports[s];
        const wh_real_t height = height_over(grips, &lying->base_from_wafer, plane);
        if (height >= -WH_GRIPS_FLAT && height < least && is_over(grips, &lying->base_from_wafer, plane)) {
            best = (int32_t)s;
            least = height;
        }
    }
    return best;
}

/* A free wafer after this slice, if these pads alone were there. */
static bool would_take(const wh_turn_t *turn, size_t w, wh_passive_wafer_t *after) {
    const wh_wafer_t *wafer = &wh_turn_wafers(turn)[w];
    if (wafer->holder != WH_NONE || wafer->released_by != WH_NONE) {
        return false;
    }
    after->base_from_wafer = wafer->base_from_wafer;
    after->gripper_from_wafer = wh_pose_identity();
    after->carried = false;
    return ask(turn, wh_grips_support(turn->grips, w), after) == WH_PASSIVE_TAKEN;
}

void wh_passive_turn_pick(const wh_turn_t *turn) {
    wh_passive_wafer_t best = {0};
    wh_real_t least = 0;
    size_t found = turn->grips->table->storage.wafer_count;
    for (size_t w = 0; w < turn->grips->table->storage.wafer_count; ++w) {
        wh_passive_wafer_t after;
        if (would_take(turn, w, &after)) {
            const wh_real_t height =
                height_over(turn->grips, &wh_turn_wafers(turn)[w].base_from_wafer, begin_of(turn));
            if (!best.carried || height < least) {
                best = after;
                least = height;
                found = w;
            }
        }
    }
    if (best.carried) {
        wh_turn_wafers(turn)[found].base_from_wafer = best.base_from_wafer;
        turn->gripper->gripper_from_wafer = best.gripper_from_wafer;
        wh_turn_take(turn, found);
    }
}
