#include "hold.h"

#define MM_PER_M WH_REAL(1000.0)
/* pi / 4 times silicon, 2.329e-6 kg/mm^3. */
#define DISC WH_REAL(1.8291923225526571e-6)

wh_pads_t wh_pads_none(void) {
    const wh_pads_t pads = {0, 0, 0, 0};
    return pads;
}

static bool is_within(wh_real_t value, wh_real_t most) {
    return value >= 0 && value <= most;
}

static bool is_finite(const wh_pads_t *pads) {
    return wh_real_is_finite(pads->friction) && wh_real_is_finite(pads->force) &&
           wh_real_is_finite(pads->mass) && wh_real_is_finite(pads->gravity);
}

static bool are_pads(const wh_pads_t *pads) {
    return is_within(pads->friction, 100) && is_within(pads->force, WH_REAL(1e6)) &&
           is_within(pads->gravity, 1000) && is_within(pads->mass, 1000) && pads->mass >= WH_REAL(1e-6);
}

static bool is_none(const wh_pads_t *pads) {
    return pads->mass == 0 && pads->friction == 0 && pads->force == 0 && pads->gravity == 0;
}

wh_status_t wh_pads_validate(const wh_pads_t *pads) {
    if (!pads) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!is_finite(pads)) {
        return WH_STATUS_NOT_FINITE;
    }
    return are_pads(pads) || is_none(pads) ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

wh_real_t wh_wafer_mass(wh_real_t diameter, wh_real_t thickness) {
    return DISC * diameter * diameter * thickness;
}

wh_hold_t wh_hold_judge(const wh_pads_t *pads, wh_real_t level, const wh_mat3_t *base_from_gripper,
                        const wh_vec3_t *acceleration) {
    const wh_vec3_t n = wh_mat3_column(base_from_gripper, 2);
    wh_vec3_t needed = *acceleration;
    needed.z += MM_PER_M * pads->gravity;
    const wh_real_t along = wh_vec3_dot(&needed, &n);
    const wh_vec3_t normal = wh_vec3_scale(along, &n);
    const wh_vec3_t across = wh_vec3_subtract(&needed, &normal);
    const wh_real_t drawn = MM_PER_M * pads->force * level / pads->mass;
    wh_hold_t hold;
    if (drawn + along < 0) {
        hold.asked = -along;
        hold.carried = drawn;
    } else {
        hold.asked = wh_vec3_norm(&across);
        hold.carried = pads->friction * (drawn + along);
    }
    if (!wh_real_is_finite(hold.asked + hold.carried)) {
        hold.asked = WH_REAL_LARGEST;
        hold.carried = 0;
    }
    hold.slips = hold.asked > hold.carried;
    return hold;
}

/* The second difference; it takes the differences first, because they are small and exact. */
static wh_vec3_t acceleration_of(const wh_carry_t *carry, const wh_vec3_t *centre, wh_real_t dt) {
    const wh_vec3_t now = wh_vec3_subtract(centre, &carry->before[0]);
    const wh_vec3_t then = wh_vec3_subtract(&carry->before[0], &carry->before[1]);
    const wh_vec3_t gained = wh_vec3_subtract(&now, &then);
    return wh_vec3(gained.x / dt / dt, gained.y / dt / dt, gained.z / dt / dt);
}

bool wh_carry_update(wh_carry_t *carry, const wh_pads_t *pads, wh_real_t level,
                     const wh_mat3_t *base_from_gripper, const wh_vec3_t *centre, wh_real_t dt,
                     wh_hold_t *hold) {
    static const wh_carry_t nothing = {{{0, 0, 0}, {0, 0, 0}}, 0, false};
    static const wh_hold_t unknown = {0, 0, false};
    const bool slipped = carry->slips;
    *hold = unknown;
    if (!centre) {
        *carry = nothing;
        return false;
    }
    if (carry->known == 2) {
        const wh_vec3_t acceleration = acceleration_of(carry, centre, dt);
        *hold = wh_hold_judge(pads, level, base_from_gripper, &acceleration);
    } else {
        ++carry->known;
    }
    carry->before[1] = carry->before[0];
    carry->before[0] = *centre;
    carry->slips = hold->slips;
    return hold->slips && !slipped;
}
