/* The rules of contact, and the clearance of a pair. */
#include "world_internal.h"

static bool is_on_robot(const wh_part_t *part) {
    return part->kind == WH_PART_ARM || part->kind == WH_PART_BLADE;
}

/* The part's place in the chain of its arm. Blades hang on the hand. */
static int32_t link_of(const wh_part_t *part) {
    return part->kind == WH_PART_ARM ? part->owner % (int32_t)WH_ARM_BODIES : (int32_t)WH_ARM_BODIES;
}

int32_t wh_world_arm_of(const wh_world_config_t *config, wh_part_kind_t kind, int32_t owner) {
    if (config->arm_count == 0) {
        return 0;
    }
    const int32_t arm =
        kind == WH_PART_ARM ? owner / (int32_t)WH_ARM_BODIES : (int32_t)config->carried_by[owner];
    return arm == WH_WORLD_NO_ARM ? WH_NONE : arm;
}

static bool is_one_robot(const wh_world_config_t *config, int32_t arm, int32_t other) {
    return arm == other ||
           (arm != WH_NONE && other != WH_NONE && config->arms[arm].robot == config->arms[other].robot);
}

/* True for neighbours of two arms of one robot: shared links belong to both arms, and both meet where the
 * second one begins. The hands of two wrists are on one axis, and each one's blade passes the other
 * hand. */
static bool meet_at_robot(const wh_world_config_t *config, int32_t arm, int32_t link, int32_t other,
                          int32_t other_link) {
    const int32_t own = (int32_t)config->arms[arm > other ? arm : other].own;
    const int32_t low = link < other_link ? link : other_link;
    const int32_t high = link < other_link ? other_link : link;
    if (low < own || (low == (int32_t)WH_ARM_HAND && own == low)) {
        return high - low <= 1;
    }
    return low == own && high == own;
}

bool wh_world_belong_together(const wh_world_config_t *config, const wh_part_t *a, const wh_part_t *b) {
    if (a->kind == WH_PART_CHUCK && b->kind == WH_PART_CHUCK) {
        return true;
    }
    if (!is_on_robot(a) || !is_on_robot(b)) {
        return false;
    }
    const int32_t one = wh_world_arm_of(config, a->kind, a->owner);
    const int32_t two = wh_world_arm_of(config, b->kind, b->owner);
    const int32_t apart = link_of(a) - link_of(b);
    if (one == two) {
        return apart >= -1 && apart <= 1;
    }
    return is_one_robot(config, one, two) && meet_at_robot(config, one, link_of(a), two, link_of(b));
}

bool wh_world_is_known(const wh_world_t *world, int32_t one, int32_t other) {
    const bool *known = world->config->known;
    return known && known[one] && known[other];
}

/* A door may touch its frame. */
static bool may_stand(const wh_side_t *a, const wh_side_t *b) {
    const bool a_door = a->kind == WH_PART_DOOR;
    const wh_part_kind_t other = a_door ? b->kind : a->kind;
    return (a_door || b->kind == WH_PART_DOOR) && (other == WH_PART_FIXED || other == WH_PART_LEDGE);
}

static bool is_gripper(const wh_side_t *side) {
    return side->kind == WH_PART_BLADE || side->kind == WH_PART_CHUCK;
}

static const wh_wafer_t *wafer_of(const wh_look_t *look, const wh_side_t *side) {
    return &look->input->wafers[side->owner];
}

/* False if a wafer there is too far from the station sideways to lie in it. */
static bool is_beside(const wh_cell_t *cell, const wh_station_t *station, const wh_pose_t *base_from_wafer) {
    const wh_vec3_t up = wh_mat3_column(&station->base_from_station.R, 2);
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_wafer->r, &station->base_from_station.r);
    const wh_real_t height = wh_vec3_dot(&dr, &up);
    const wh_real_t most = cell->tolerance.projxy + cell->thickness + 1;
    return wh_vec3_dot(&dr, &dr) - height * height > most * most;
}

/* True if a wafer there may lie on a gripper's chuck; WH_NONE: on any. */
static bool may_lie_on(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, int32_t gripper) {
    for (size_t s = 0; s < cell->count; ++s) {
        const wh_station_t *station = &cell->stations[s];
        const bool is_its = gripper == WH_NONE ? station->chuck != WH_NONE : station->chuck == gripper;
        if (is_its && !is_beside(cell, station, base_from_wafer)) {
            return true;
        }
    }
    return false;
}

static bool may_lie_in(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, const wh_side_t *support) {
    return support->kind == WH_PART_LEDGE
               ? !is_beside(cell, &cell->stations[support->owner], base_from_wafer)
               : support->kind == WH_PART_CHUCK && may_lie_on(cell, base_from_wafer, support->owner);
}

/* wh_cell_locate among the stations from the first to the last one that the wafer is not beside. */
static bool locate(const wh_cell_t *cell, const wh_pose_t *base_from_wafer, wh_place_t *place) {
    size_t first = 0, end = cell->count;
    while (first < end && is_beside(cell, &cell->stations[first], base_from_wafer)) {
        ++first;
    }
    while (end > first && is_beside(cell, &cell->stations[end - 1], base_from_wafer)) {
        --end;
    }
    wh_cell_t near = *cell;
    near.stations += first;
    near.count = end - first;
    if (!wh_cell_locate(&near, base_from_wafer, place)) {
        return false;
    }
    place->station += (int32_t)first;
    return true;
}

/* True if a wafer at this pose lies in the ledge's slot, or on the gripper's chuck, and not below its
 * plane. */
static bool is_upon(const wh_look_t *look, const wh_pose_t *base_from_wafer, const wh_side_t *support) {
    const wh_cell_t *cell = look->world->config->cell;
    wh_place_t place;
    if (!may_lie_in(cell, base_from_wafer, support) || !locate(cell, base_from_wafer, &place) ||
        place.dz < -cell->tolerance.projz) {
        return false;
    }
    if (support->kind == WH_PART_LEDGE) {
        return place.station == support->owner && place.slot == support->slot;
    }
    return support->kind == WH_PART_CHUCK && cell->stations[place.station].chuck == support->owner;
}

/* True if the wafer lies there at both ends of the slice. A wafer that passes through from below does
 * not. */
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

/* True if a gripper may take the wafer with a closed valve, because another gripper has it, or a chuck on
 * which it lies, held or not. */
static bool is_offered(const wh_look_t *look, const wh_wafer_t *wafer) {
    const wh_cell_t *cell = look->world->config->cell;
    wh_place_t place;
    return wafer->holder != WH_NONE || (may_lie_on(cell, &wafer->base_from_wafer, WH_NONE) &&
                                        wh_cell_locate(cell, &wafer->base_from_wafer, &place) &&
                                        cell->stations[place.station].chuck != WH_NONE);
}

/* True if gripper and wafer may come together: they are within reach, and the gripper takes or gives. */
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
    /* The wafer was released in this slice; the world keeps it as held until the slice ends. */
    const bool released = look->world->held[gripper->owner] == wafer->owner;
    const bool is_edge = (look->world->config->edges >> (unsigned)gripper->owner & 1U) != 0;
    return state->valve == WH_VALVE_OPEN || is_edge || gripper->kind == WH_PART_CHUCK || released ||
           look->world->left[gripper->owner].wafer == wafer->owner || is_offered(look, w);
}

bool wh_world_may_touch(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b) {
    put_in_order(&a, &b);
    if (a->kind != WH_PART_WAFER) {
        return may_stand(a, b);
    }
    if (is_gripper(b)) {
        return wafer_of(look, a)->holder == b->owner || do_business(look, a, b) || lies_in(look, a, b);
    }
    return b->kind == WH_PART_LEDGE && lies_in(look, a, b);
}

/* --------------------------------------------------------------------------------------------- clearances */

/* The clearance of a gripper's part and a wafer that it does not hold. */
static wh_clearance_kind_t wafer_and_gripper(const wh_look_t *look, const wh_side_t *wafer,
                                             const wh_side_t *gripper) {
    if (do_business(look, wafer, gripper)) {
        return WH_CLEARANCES;
    }
    if (gripper->kind == WH_PART_CHUCK) {
        return WH_CLEARANCE_WAFER_OTHER;
    }
    return wafer->now->r.z > gripper->now->r.z ? WH_CLEARANCE_BLADE_WAFER_ABOVE
                                               : WH_CLEARANCE_BLADE_WAFER_BELOW;
}

/* True if a wafer that moves hangs on the robot of the arm. */
static bool is_own_load(const wh_look_t *look, const wh_side_t *wafer, const wh_side_t *arm) {
    const wh_world_t *world = look->world;
    if (!wafer->body || world->config->arm_count == 0) {
        return wafer->body != NULL;
    }
    const int32_t gripper = (int32_t)(wafer->body - world->bodies) - wh_world_held_body(0);
    const int32_t carrier = wh_world_arm_of(world->config, WH_PART_BLADE, gripper);
    return carrier != WH_NONE &&
           is_one_robot(world->config, carrier, wh_world_arm_of(world->config, WH_PART_ARM, arm->owner));
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
        return is_own_load(look, wafer, other) ? WH_CLEARANCE_ARM_ITSELF : WH_CLEARANCE_ARM_OTHER;
    case WH_PART_DOOR:
    case WH_PART_FIXED:
        break;
    }
    return WH_CLEARANCE_WAFER_OTHER;
}

static bool is_on_arm(const wh_side_t *side) {
    return side->kind == WH_PART_ARM || side->kind == WH_PART_BLADE;
}

static bool are_of_one_robot(const wh_world_config_t *config, const wh_side_t *a, const wh_side_t *b) {
    return is_one_robot(config, wh_world_arm_of(config, a->kind, a->owner),
                        wh_world_arm_of(config, b->kind, b->owner));
}

wh_clearance_kind_t wh_world_clearance_of(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b) {
    put_in_order(&a, &b);
    if (a->kind == WH_PART_WAFER) {
        return of_wafer(look, a, b);
    }
    const bool has_arm = a->kind == WH_PART_ARM || b->kind == WH_PART_ARM;
    const bool has_blade = a->kind == WH_PART_BLADE || b->kind == WH_PART_BLADE;
    if (is_on_arm(a) && is_on_arm(b) && are_of_one_robot(look->world->config, a, b)) {
        return WH_CLEARANCE_ARM_ITSELF;
    }
    if (has_arm) {
        return WH_CLEARANCE_ARM_OTHER;
    }
    return has_blade ? WH_CLEARANCE_BLADE_OTHER : WH_CLEARANCES;
}

/* The clearances that each worth may count for, as bits. */
static const unsigned clearances[WH_WORTHS] = {
    [WH_WORTH_WAFER_WAFER] = 1U << WH_CLEARANCE_WAFER_WAFER,
    [WH_WORTH_WAFER_LEDGE] = 1U << WH_CLEARANCE_WAFER_LEDGE,
    [WH_WORTH_WAFER_OTHER] = 1U << WH_CLEARANCE_WAFER_OTHER,
    [WH_WORTH_BLADE_WAFER] = 1U << WH_CLEARANCE_BLADE_WAFER_ABOVE | 1U << WH_CLEARANCE_BLADE_WAFER_BELOW,
    [WH_WORTH_ARM_ITSELF] = 1U << WH_CLEARANCE_ARM_ITSELF,
    [WH_WORTH_ARM_OTHER] = 1U << WH_CLEARANCE_ARM_OTHER,
    [WH_WORTH_BLADE_OTHER] = 1U << WH_CLEARANCE_BLADE_OTHER,
};

static wh_worth_t worth_of_wafer(wh_part_kind_t other, bool is_one) {
    switch (other) {
    case WH_PART_WAFER:
        return WH_WORTH_WAFER_WAFER;
    case WH_PART_LEDGE:
        return WH_WORTH_WAFER_LEDGE;
    case WH_PART_BLADE:
        return WH_WORTH_BLADE_WAFER;
    case WH_PART_ARM:
        return is_one ? WH_WORTH_ARM_ITSELF : WH_WORTH_ARM_OTHER;
    case WH_PART_CHUCK:
    case WH_PART_DOOR:
    case WH_PART_FIXED:
        break;
    }
    return WH_WORTH_WAFER_OTHER;
}

/* The worth of two parts that are not of one robot. */
static wh_worth_t worth_of_parts(wh_part_kind_t a, wh_part_kind_t b) {
    if (a == WH_PART_ARM || b == WH_PART_ARM) {
        return WH_WORTH_ARM_OTHER;
    }
    return a == WH_PART_BLADE || b == WH_PART_BLADE ? WH_WORTH_BLADE_OTHER : WH_WORTH_NOTHING;
}

wh_worth_t wh_world_worth_of(const wh_world_config_t *config, const wh_mover_t *mover, wh_part_kind_t kind,
                             int32_t arm) {
    const bool is_one = mover->arm != WH_NONE && arm != WH_NONE && is_one_robot(config, mover->arm, arm);
    if (mover->kind == WH_PART_WAFER || kind == WH_PART_WAFER) {
        return worth_of_wafer(mover->kind == WH_PART_WAFER ? kind : mover->kind, is_one);
    }
    return is_one ? WH_WORTH_ARM_ITSELF : worth_of_parts(mover->kind, kind);
}

wh_real_t wh_world_most_of(wh_worth_t worth, const wh_real_t gaps[]) {
    wh_real_t most = 0;
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        const bool counts = (clearances[worth] >> kind & 1U) != 0;
        most = counts && gaps[kind] > most ? gaps[kind] : most;
    }
    return most;
}

void wh_world_weigh(wh_world_t *world) {
    for (size_t i = 0; i < WH_WORTHS; ++i) {
        const wh_real_t most = wh_world_most_of((wh_worth_t)i, world->gaps.least) - WH_SAME_GAP;
        world->gaps.worth[i] = most > 0 ? most : 0;
    }
}
