#include "carrying.h"

#include <string.h>

#include "../grasp/passive.h"
#include "../layout/grips.h"
#include "../math/trig.h"
#include "../sim/slice.h"

/* The places before and after a motion, while everything stands: a difference of the third order needs
 * four. */
#define PLACES 4

/* Limits are measured over at least this time, us. */
#define LEAST_US 1000

bool wh_carrying_matters(const wh_layout_t *layout) {
    return wh_layout_has_loaded(layout) || wh_layout_has_passive(layout);
}

bool wh_carrying_is_full(const wh_slowness_t *slowness) {
    return slowness->pace == 1 && slowness->share.speed == 1 && slowness->share.acceleration == 1;
}

void wh_carrying_start(wh_track_t *track, const wh_layout_t *layout) {
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        if (layout->grips[g].kind == WH_GRIP_PASSIVE) {
            track->valves[g] = WH_VALVE_OPEN;
        }
    }
}

static bool moves_axes(const wh_segment_t *segment) {
    return segment->kind == WH_SEGMENT_AXES || segment->kind == WH_SEGMENT_LINE ||
           segment->kind == WH_SEGMENT_WAY || segment->kind == WH_SEGMENT_VIA;
}

/* ---------------------------------------------------------------------------------------- along a segment */

/* Steps through a segment, and then stands. */
typedef struct {
    wh_track_t track;
    wh_command_t command;
    wh_machine_cache_t cache;
    int64_t slices; /* the slices stepped through, including standing ones */
    int64_t rest;   /* the slices still to come after the segment */
} walk_t;

static void begin_walk(walk_t *walk, const wh_track_t *begun, int64_t stride) {
    memset(walk, 0, sizeof *walk);
    walk->track = *begun;
    walk->rest = PLACES * stride;
    wh_command_from_track(&walk->command, &walk->cache, &walk->track);
}

static bool walk_on(walk_t *walk) {
    const bool goes = wh_track_next(&walk->track, 0) == WH_TRACK_MOVING;
    walk->rest -= goes ? 0 : 1;
    if (goes) {
        wh_command_from_track(&walk->command, &walk->cache, &walk->track);
    }
    ++walk->slices;
    return goes || walk->rest >= 0;
}

static const wh_pose_t *gripper_pose_of(const walk_t *walk, size_t g) {
    return &walk->command.grippers[g].base_from_gripper;
}

/* ----------------------------------------------------------------------------------------------- `loaded` */

/* The last differences of a gripper's places, of each order, and the largest. */
typedef struct {
    wh_vec3_t last[PLACES];
    wh_real_t most[PLACES];
} differences_t;

static void begin_differences(differences_t *differences, const wh_vec3_t *at) {
    memset(differences, 0, sizeof *differences);
    differences->last[0] = *at;
}

static void note_difference(differences_t *differences, const wh_vec3_t *at) {
    wh_vec3_t now = *at;
    for (size_t order = 0; order < PLACES; ++order) {
        const wh_vec3_t last = differences->last[order];
        differences->last[order] = now;
        differences->most[order] = wh_real_max(differences->most[order], wh_vec3_norm(&now));
        now = wh_vec3_subtract(&now, &last);
    }
}

/* The ratio by which a motion with these differences is too fast for these limits: 1 or less is allowed. */
static wh_real_t excess_over(const wh_limits_t *loaded, const wh_real_t most[PLACES], wh_real_t dt) {
    wh_real_t excess = 0;
    if (loaded->speed > 0) {
        excess = most[1] / dt / loaded->speed;
    }
    if (loaded->acceleration > 0) {
        excess = wh_real_max(excess, wh_real_sqrt(most[2] / (dt * dt) / loaded->acceleration));
    }
    if (loaded->jerk > 0) {
        excess = wh_real_max(excess, wh_cbrt(most[3] / (dt * dt * dt) / loaded->jerk));
    }
    return excess;
}

static wh_real_t excess_of(const wh_track_t *begun, const wh_layout_t *layout, uint32_t loaded,
                           int64_t *slices) {
    const size_t count = layout->machine.gripper_count;
    const int64_t stride = (LEAST_US + begun->slice_us - 1) / begun->slice_us;
    differences_t differences[WH_GRIPPERS];
    walk_t walk;
    wh_real_t excess = 0;
    begin_walk(&walk, begun, stride);
    for (size_t g = 0; g < count; ++g) {
        begin_differences(&differences[g], &gripper_pose_of(&walk, g)->r);
    }
    while (walk_on(&walk)) {
        for (size_t g = 0; walk.slices % stride == 0 && g < count; ++g) {
            note_difference(&differences[g], &gripper_pose_of(&walk, g)->r);
        }
    }
    *slices += walk.slices;
    for (size_t g = 0; g < count; ++g) {
        const wh_limits_t limits = wh_layout_loaded(layout, g);
        if ((loaded >> g & 1U) != 0) {
            const wh_real_t dt = (wh_real_t)(stride * begun->slice_us) / WH_REAL(1e6);
            excess = wh_real_max(excess, excess_over(&limits, differences[g].most, dt));
        }
    }
    return excess;
}

static wh_status_t begin_slowly(wh_track_t *track, const wh_segment_t *segment,
                                const wh_slowness_t *slowness) {
    const wh_real_t pace = slowness->pace;
    wh_segment_t slowed = *segment;
    wh_slow_t room;
    if (wh_carrying_is_full(slowness)) {
        return wh_track_begin(track, segment);
    }
    slowed.speed *= pace;
    slowed.acceleration *= pace * pace;
    return wh_track_begin_slowly(track, &slowed, slowness, &room);
}

/* Slices cut a slower motion at other places, so its differences are not exactly those expected
 * from its pace. */
#define MOST_TRIES 50
#define MARGIN WH_REAL(1e-4)

wh_status_t wh_carrying_begin(wh_track_t *track, const wh_layout_t *layout, const wh_segment_t *segment,
                              wh_slowness_t *slowness, uint32_t loaded, int64_t *slices) {
    wh_status_t status = begin_slowly(track, segment, slowness);
    *slices = 0;
    for (int i = 0; loaded != 0 && moves_axes(segment) && status == WH_OK && i < MOST_TRIES; ++i) {
        const wh_real_t excess = excess_of(track, layout, loaded, slices);
        if (!(excess > 1)) {
            break;
        }
        slowness->pace /= excess * (1 + MARGIN);
        status = begin_slowly(track, segment, slowness);
    }
    return status;
}

/* ----------------------------------------------------------------------------------------------- friction */

/* The axes of the last three slices. */
typedef struct {
    wh_real_t of[3][WH_AXES];
} stands_t;

static void remember_place(stands_t *stands, const wh_track_t *track) {
    memmove(stands->of[0], stands->of[1], 2 * sizeof stands->of[0]);
    memcpy(stands->of[2], track->axes, sizeof stands->of[2]);
}

/* The change of a gripper's speed by this axis alone, as mm in one slice and the next. */
static wh_real_t speed_share_of(const wh_machine_t *machine, const stands_t *stands, size_t axis, size_t g) {
    wh_vec3_t at[3];
    for (size_t i = 0; i < 3; ++i) {
        wh_real_t axes[WH_AXES];
        wh_pose_t poses[WH_GRIPPERS];
        memcpy(axes, stands->of[1], sizeof axes);
        axes[axis] = stands->of[i][axis];
        wh_machine_grippers(machine, axes, poses);
        at[i] = poses[g].r;
    }
    const wh_vec3_t before = wh_vec3_subtract(&at[1], &at[0]);
    const wh_vec3_t after = wh_vec3_subtract(&at[2], &at[1]);
    const wh_vec3_t change = wh_vec3_subtract(&after, &before);
    return wh_vec3_norm(&change);
}

/* If no axis moves the wafer's middle, the axis that moves most turns its pads. */
static size_t find_axis(const wh_machine_t *machine, const stands_t *stands, size_t g, bool turns) {
    size_t most = 0;
    wh_real_t largest = 0;
    for (size_t axis = 0; axis < machine->axis_count; ++axis) {
        const wh_real_t share = turns ? wh_real_abs(stands->of[2][axis] - stands->of[1][axis])
                                      : speed_share_of(machine, stands, axis, g);
        if (share > largest) {
            largest = share;
            most = axis;
        }
    }
    return most;
}

/* For any direction: |a| needs a cos and takes friction * a sin from the pressing force, or the other
 * way round. */
static wh_real_t enough_for(const wh_pads_t *pads, const wh_mat3_t *base_from_gripper) {
    return wh_passive_limit(pads, base_from_gripper) / wh_real_sqrt(1 + pads->friction * pads->friction);
}

/* Holding by the pads' friction alone, judged in each slice like in the simulator. */
typedef struct {
    wh_pads_t pads;
    wh_carry_t carry;
} holding_t;

/* Begins with a gripper that stands before the segment. */
static void begin_holding(holding_t *holding, const wh_layout_t *layout, const wh_pose_t *pose,
                          wh_real_t dt) {
    wh_hold_t hold;
    memset(holding, 0, sizeof *holding);
    holding->pads = wh_passive_pads(&layout->physics.pads);
    for (int i = 0; i < 3; ++i) {
        (void)wh_carry_update(&holding->carry, &holding->pads, 0, &pose->R, &pose->r, dt, &hold);
    }
}

static void judge_holding(holding_t *holding, const walk_t *walk, const stands_t *stands, size_t g,
                          wh_carrying_slip_t *slip) {
    const wh_pose_t *pose = gripper_pose_of(walk, g);
    const wh_real_t dt = (wh_real_t)walk->track.slice_us / WH_REAL(1e6);
    wh_hold_t hold;
    (void)wh_carry_update(&holding->carry, &holding->pads, 0, &pose->R, &pose->r, dt, &hold);
    if (hold.slips && (slip->gripper == WH_NONE || hold.asked - hold.carried > slip->asked - slip->held)) {
        slip->gripper = (int32_t)g;
        slip->asked = hold.asked;
        slip->held = hold.carried;
        slip->enough = enough_for(&holding->pads, &pose->R);
        slip->axis = find_axis(walk->track.machine, stands, g, slip->enough < 1);
    }
}

bool wh_carrying_slips(const wh_track_t *begun, const wh_layout_t *layout, uint32_t loaded,
                       wh_carrying_slip_t *slip) {
    holding_t holdings[WH_GRIPPERS];
    stands_t stands = {{{0}}};
    walk_t walk;
    uint32_t passive = 0;
    slip->gripper = WH_NONE;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        passive |= layout->grips[g].kind == WH_GRIP_PASSIVE ? loaded & 1U << g : 0;
    }
    if (passive == 0 || !moves_axes(&begun->segment)) {
        return false;
    }
    begin_walk(&walk, begun, 1);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        begin_holding(&holdings[g], layout, gripper_pose_of(&walk, g),
                      (wh_real_t)begun->slice_us / WH_REAL(1e6));
    }
    for (int i = 0; i < 3; ++i) {
        remember_place(&stands, &walk.track);
    }
    while (walk_on(&walk)) {
        remember_place(&stands, &walk.track);
        for (size_t g = 0; passive >> g != 0; ++g) {
            if ((passive >> g & 1U) != 0) {
                judge_holding(&holdings[g], &walk, &stands, g, slip);
            }
        }
    }
    return slip->gripper != WH_NONE;
}
