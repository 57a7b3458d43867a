/* What may touch what, and which clearance a pair counts for. */
#include "world_internal.h"

static bool is_on_robot(const wh_part_t *part) {
    return part->kind == WH_PART_ARM || part->kind == WH_PART_BLADE;
}

/* The part's place in the chain of the arm. Blades hang on the hand. */
static int32_t link_of(const wh_part_t *part) {
    return part->kind == WH_PART_ARM ? part->owner : (int32_t)WH_ARM_BODIES;
}

bool wh_world_belong_together(const wh_part_t *a, const wh_part_t *b) {
    if (a->kind == WH_PART_CHUCK && b->kind == WH_PART_CHUCK) {
        return true;
    }
    if (!is_on_robot(a) || !is_on_robot(b)) {
        return false;
    }
    const int32_t apart = link_of(a) - link_of(b);
    return apart >= -1 && apart <= 1;
}

bool wh_world_is_known(const wh_world_t *world, int32_t one, int32_t other) {
    const bool *known = world->config->known;
    return known && known[one] && known[other];
}

static bool is_gripper(const wh_side_t *side) {
    return side->kind == WH_PART_BLADE || side->kind == WH_PART_CHUCK;
}

static const wh_wafer_t *wafer_of(const wh_look_t *look, const wh_side_t *side) {
    return &look->input->wafers[side->owner];
}

/* True if a wafer at this pose lies in the ledge's slot, or on the gripper's chuck, and not below its
 * plane. */
static bool is_upon(const wh_look_t *look, const wh_pose_t *base_from_wafer, const wh_side_t *support) {
    const wh_cell_t *cell = look->world->config->cell;
    wh_place_t place;
    if (!wh_cell_locate(cell, base_from_wafer, &place) || place.dz < -cell->tolerance.projz) {
        return false;
    }
    if (support->kind == WH_PART_LEDGE) {
        return place.station == support->owner && place.slot == support->slot;
    }
    return support->kind == WH_PART_CHUCK && cell->stations[place.station].chuck == support->owner;
}

/* True if the wafer lies there at both ends of the slice. A wafer that comes through from below does not. */
static bool lies_in(const wh_look_t *look, const wh_side_t *wafer, const wh_side_t *support) {
    const wh_pose_t *now = &look->world->wafers[wafer->owner];
    return is_upon(look, now, support) && (!wafer->body || is_upon(look, &wafer->body->before, support));
}

/* Puts the wafer of a pair first, so that each rule is written once. */
static void put_in_order(const wh_side_t **a, const wh_side_t **b) {
    const bool swap = (*b)->kind == WH_PART_WAFER && (*a)->kind != WH_PART_WAFER;
    const wh_side_t *const first = swap ? *b : *a;
    *b = swap ? *a : *b;
    *a = first;
}

/* True if somebody has the wafer from whom a gripper may take it with a closed valve: another gripper, or a
 * chuck on which it lies, held or not. */
static bool is_offered(const wh_look_t *look, const wh_wafer_t *wafer) {
    const wh_cell_t *cell = look->world->config->cell;
    wh_place_t place;
    return wafer->holder != WH_NONE || (wh_cell_locate(cell, &wafer->base_from_wafer, &place) &&
                                        cell->stations[place.station].chuck != WH_NONE);
}

/* True if gripper and wafer are meant to come together: they are within reach, and the gripper takes or
 * gives. */
static bool do_business(const wh_look_t *look, const wh_side_t *wafer, const wh_side_t *gripper) {
    const wh_grasp_config_t *grasp = look->world->config->grasp;
    const wh_gripper_t *state = &look->input->grippers[gripper->owner];
    const wh_wafer_t *w = wafer_of(look, wafer);
    const wh_vec3_t dr = wh_vec3_subtract(&w->base_from_wafer.r, &state->base_from_gripper.r);
    const wh_vec3_t local = wh_mat3_transform_back(&state->base_from_gripper.R, &dr);
    const wh_real_t limit = grasp->tolerance.projxy;
    const bool beside = local.x * local.x + local.y * local.y > limit * limit;
    if (beside || wh_real_abs(local.z) > grasp->near_projz) {
        return false;
    }
    /* Let go in this slice: the world keeps it as held until the slice is over. */
    const bool released = look->world->held[gripper->owner] == wafer->owner;
    return state->valve == WH_VALVE_OPEN || gripper->kind == WH_PART_CHUCK || released ||
           look->world->left[gripper->owner].wafer == wafer->owner || is_offered(look, w);
}

bool wh_world_may_touch(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b) {
    put_in_order(&a, &b);
    if (a->kind != WH_PART_WAFER) {
        return false;
    }
    if (is_gripper(b)) {
        return wafer_of(look, a)->holder == b->owner || do_business(look, a, b) || lies_in(look, a, b);
    }
    return b->kind == WH_PART_LEDGE && lies_in(look, a, b);
}

/* --------------------------------------------------------------------------------------------- clearances */

/* For a gripper's part and a wafer that it does not hold. */
static wh_clearance_kind_t wafer_and_gripper(const wh_look_t *look, const wh_side_t *wafer,
                                             const wh_side_t *gripper) {
    if (do_business(look, wafer, gripper)) {
        return WH_CLEARANCES;
    }
    if (gripper->kind == WH_PART_CHUCK) {
        return WH_CLEARANCE_WAFER_OTHER;
    }
    return wafer->now.r.z > gripper->now.r.z ? WH_CLEARANCE_BLADE_WAFER_ABOVE
                                             : WH_CLEARANCE_BLADE_WAFER_BELOW;
}

static wh_clearance_kind_t of_wafer(const wh_look_t *look, const wh_side_t *wafer, const wh_side_t *other) {
    switch (other->kind) {
    case WH_PART_WAFER:
        return WH_CLEARANCE_WAFER_WAFER;
    case WH_PART_LEDGE:
        return WH_CLEARANCE_WAFER_LEDGE;
    case WH_PART_BLADE:
    case WH_PART_CHUCK:
        return wafer_and_gripper(look, wafer, other);
    case WH_PART_ARM:
        return wafer->body ? WH_CLEARANCE_ARM_ITSELF : WH_CLEARANCE_ARM_OTHER;
    case WH_PART_FIXED:
        break;
    }
    return WH_CLEARANCE_WAFER_OTHER;
}

wh_clearance_kind_t wh_world_clearance_of(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b) {
    put_in_order(&a, &b);
    if (a->kind == WH_PART_WAFER) {
        return of_wafer(look, a, b);
    }
    const bool a_arm = a->kind == WH_PART_ARM;
    const bool b_arm = b->kind == WH_PART_ARM;
    if ((a_arm || a->kind == WH_PART_BLADE) && (b_arm || b->kind == WH_PART_BLADE)) {
        return WH_CLEARANCE_ARM_ITSELF;
    }
    if (a_arm || b_arm) {
        return WH_CLEARANCE_ARM_OTHER;
    }
    return a->kind == WH_PART_BLADE || b->kind == WH_PART_BLADE ? WH_CLEARANCE_BLADE_OTHER : WH_CLEARANCES;
}
