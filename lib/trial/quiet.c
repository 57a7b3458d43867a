#include "quiet.h"

#include "../grasp/passive.h"

/* ------------------------------------------------------------------------------------------------ at rest */

static bool is_same(wh_real_t a, wh_real_t b) {
    return a <= b && a >= b;
}

static bool is_same_place(const wh_vec3_t *a, const wh_vec3_t *b) {
    return is_same(a->x, b->x) && is_same(a->y, b->y) && is_same(a->z, b->z);
}

static wh_grip_kind_t kind_of(const wh_simulator_t *simulator, size_t g) {
    return simulator->given.gripping ? simulator->given.grips.parts.grips[g].kind : WH_GRIP_VACUUM;
}

static bool holds(const wh_simulator_t *simulator, size_t g) {
    return simulator->table.storage.grippers[g].wafer != WH_NONE;
}

/* A level stands once the next slice would give its bits again. */
static bool does_vacuum_stand(const wh_simulator_t *simulator, size_t g) {
    const wh_vacuum_fault_t sound = wh_vacuum_sound();
    const wh_vacuum_t *now = &simulator->physics.vacuum[g];
    wh_vacuum_t next = *now;
    const int32_t valve = wh_vacuum_before(&simulator->vacuum, &sound, now->command, holds(simulator, g),
                                           simulator->slice_s, &next);
    (void)wh_vacuum_after(&simulator->vacuum, &sound, holds(simulator, g), simulator->slice_s, &next);
    return valve == simulator->table.storage.grippers[g].valve && is_same(next.level, now->level) &&
           next.on == now->on && next.waits == now->waits;
}

static bool does_plunger_stand(const wh_simulator_t *simulator, size_t g) {
    const wh_grip_phase_t phase = simulator->physics.grips[g].phase;
    return simulator->table.storage.grippers[g].valve == WH_VALVE_CLOSED
               ? phase == WH_GRIP_OPEN
               : phase == WH_GRIP_CLOSED || phase == WH_GRIP_JAMMED || phase == WH_GRIP_MISSED;
}

static bool does_grip_stand(const wh_simulator_t *simulator, size_t g) {
    switch (kind_of(simulator, g)) {
    case WH_GRIP_VACUUM:
        return does_vacuum_stand(simulator, g);
    case WH_GRIP_EDGE:
        return does_plunger_stand(simulator, g);
    case WH_GRIP_PASSIVE:
        break;
    }
    return true;
}

/* A wafer on pads asks for something else in each slice while it moves, and in the two after. */
static bool does_hold_stand(const wh_simulator_t *simulator, size_t g, bool moves) {
    const wh_gripper_t *gripper = &simulator->table.storage.grippers[g];
    const wh_carry_t *now = &simulator->physics.carry[g];
    const bool is_passive = kind_of(simulator, g) == WH_GRIP_PASSIVE;
    const wh_pads_t pads = is_passive ? wh_passive_pads(&simulator->pads) : simulator->pads;
    if (!(pads.mass > 0) || !holds(simulator, g) || kind_of(simulator, g) == WH_GRIP_EDGE) {
        return true;
    }
    if (moves || now->known == 0) {
        return !moves;
    }
    const wh_vec3_t *centre = &simulator->table.storage.wafers[gripper->wafer].base_from_wafer.r;
    wh_carry_t next = *now;
    wh_hold_t hold;
    (void)wh_carry_update(&next, &pads, simulator->physics.vacuum[g].level, &gripper->base_from_gripper.R,
                          centre, simulator->slice_s, &hold);
    return now->known == 2 && next.slips == now->slips && is_same_place(&now->before[0], centre) &&
           is_same_place(&now->before[1], centre);
}

static bool does_gripper_stand(const wh_simulator_t *simulator, size_t g, int32_t valve, bool moves) {
    const wh_gripper_t *gripper = &simulator->table.storage.grippers[g];
    return valve == simulator->physics.told[g] && gripper->approach.wafer == WH_NONE &&
           gripper->contest.wafer == WH_NONE && does_grip_stand(simulator, g) &&
           does_hold_stand(simulator, g, moves);
}

static int64_t least_of(int64_t a, int64_t b) {
    return a < b ? a : b;
}

/* A fault that waits for its time does nothing until then, and nothing once it is over. */
static int64_t until_fault(const wh_simulator_t *simulator, const wh_command_t *last) {
    const wh_faults_t *faults = &simulator->physics.faults;
    int64_t slices = last->fault_count > 0 ? 0 : INT64_MAX;
    for (size_t i = 0; i < faults->count; ++i) {
        const wh_fault_slot_t *slot = &faults->slots[i];
        if (slot->phase == WH_FAULT_WAITING) {
            slices = least_of(slices, least_of(slot->fault.from, slot->fault.until) - last->seq - 1);
        } else if (slot->phase != WH_FAULT_FREE && slot->phase != WH_FAULT_OVER) {
            slices = 0;
        }
    }
    return slices;
}

/* Nothing was ordered, and nothing goes on by itself. */
static bool is_idle(const wh_simulator_t *simulator, const wh_command_t *last) {
    const wh_physics_state_t *physics = &simulator->physics;
    return simulator->table.slice > 0 && last->scan.kind == WH_SCAN_KEEP &&
           last->latch.kind == WH_LATCH_KEEP && !physics->scan.armed && physics->scan.sample_count == 0 &&
           !physics->latches.armed && physics->latches.latch_count == 0;
}

static bool do_doors_stand(const wh_quiet_t *quiet, const wh_simulator_t *simulator, const wh_command_t *last,
                           uint32_t axes) {
    const size_t first = simulator->given.doors.first;
    bool stand = (quiet->doors & axes) == 0;
    for (size_t d = 0; simulator->given.moving && d < simulator->given.doors.count && stand; ++d) {
        stand = is_same(simulator->physics.doors.at[d], last->axes[first + d]);
    }
    return stand;
}

/* --------------------------------------------------------------------------------------------- distances */

/* A moving gripper with its wafer, or with its empty blade. */
typedef struct {
    const wh_quiet_t *quiet;
    const wh_simulator_t *simulator;
    uint32_t axes;
    size_t g;
    wh_vec3_t at;
    wh_real_t margin; /* nothing happens between things that are farther from each other */
    wh_real_t way;    /* how far its wafer, or its origin, comes in a slice */
    bool is_stroke;   /* what stands does not matter: wh_quiet_room has looked at it */
} mover_t;

static wh_real_t margin_of(const wh_simulator_t *simulator) {
    const wh_grasp_config_t *config = &simulator->table.config;
    const wh_real_t rim = wh_real_max(config->tolerance.projxy, 25);
    return wh_real_max(rim, config->near_projxy) +
           wh_real_max(config->near_projz, 2 * config->tolerance.projz) + 2 * simulator->cell.thickness + 1;
}

/* How far the gripper's wafer, or its origin, comes in a slice. */
static wh_real_t way_of(const mover_t *mover, size_t g) {
    const wh_gripper_t *gripper = &mover->simulator->table.storage.grippers[g];
    const wh_real_t lever = gripper->wafer == WH_NONE ? 0 : wh_vec3_norm(&gripper->gripper_from_wafer.r);
    const uint32_t axes = mover->axes & mover->quiet->movers[g];
    wh_real_t way = 0;
    for (size_t axis = 0; axes >> axis != 0; ++axis) {
        const wh_quiet_axis_t *by = &mover->quiet->by_axis[g][axis];
        way += (axes >> axis & 1U) != 0 ? by->way + lever * by->turn : 0;
    }
    return way;
}

/* The slices until two things may be near that are so far apart and come together by `way` in each. */
static int64_t slices_until(const mover_t *mover, wh_real_t distance, wh_real_t way) {
    const wh_real_t slices = (distance - mover->margin) / way;
    if (!(slices > 0)) {
        return 0;
    }
    return slices < WH_REAL(1e9) ? (int64_t)slices : INT64_MAX;
}

/* Both are on one robot, and stay as high above each other as they are: its arms go up together. */
static bool go_together(const mover_t *mover, int32_t other) {
    const wh_machine_t *machine = mover->quiet->machine;
    const wh_mount_t *one = &machine->mounts[mover->g], *two = &machine->mounts[other];
    if (one->axis != WH_NONE || two->axis != WH_NONE || one->robot != two->robot) {
        return false;
    }
    return one->arm == two->arm || !wh_machine_arm(machine, mover->g, NULL)->chain.has_flip;
}

/* Nothing happens between two that are so far above each other. */
static int64_t slices_above(const mover_t *mover, const wh_vec3_t *place) {
    const wh_gripper_t *gripper = &mover->simulator->table.storage.grippers[mover->g];
    const wh_grasp_config_t *config = &mover->simulator->table.config;
    const wh_vec3_t up = wh_mat3_column(&gripper->base_from_gripper.R, 2);
    const wh_vec3_t from = wh_vec3_subtract(place, &mover->at);
    const wh_real_t least = wh_real_max(config->near_projz, 2 * config->tolerance.projz) +
                            2 * mover->simulator->cell.thickness + 1;
    return wh_real_abs(wh_vec3_dot(&up, &from)) > least ? INT64_MAX : 0;
}

/* Until it is near to a place that gripper `other` carries; WH_NONE: the place stands. */
static int64_t until_place(const mover_t *mover, const wh_vec3_t *place, int32_t other) {
    const wh_vec3_t from = wh_vec3_subtract(place, &mover->at);
    if (other != WH_NONE && go_together(mover, other)) {
        return slices_above(mover, place);
    }
    if (mover->is_stroke && (other == WH_NONE || (mover->axes & mover->quiet->movers[other]) == 0)) {
        return INT64_MAX;
    }
    const wh_real_t way = mover->way + (other == WH_NONE ? 0 : way_of(mover, (size_t)other));
    return slices_until(mover, wh_vec3_norm(&from), way);
}

/* Until it is near to the middle of a slot. */
static int64_t until_slots(const mover_t *mover, const wh_station_t *station) {
    const wh_vec3_t up = wh_mat3_column(&station->base_from_station.R, 2);
    const wh_real_t top = (wh_real_t)(station->slots - 1) * station->pitch;
    const wh_vec3_t from = wh_vec3_subtract(&mover->at, &station->base_from_station.r);
    const wh_real_t height = wh_real_max(wh_vec3_dot(&up, &from), 0);
    const wh_vec3_t along = wh_vec3_scale(height < top ? height : top, &up);
    const wh_vec3_t aside = wh_vec3_subtract(&from, &along);
    return slices_until(mover, wh_vec3_norm(&aside), mover->way);
}

/* Its z is base's, to the last bit. */
static bool is_level(const wh_mat3_t *R) {
    return is_same(R->m[2][0], 0) && is_same(R->m[2][1], 0) && is_same(R->m[2][2], 1);
}

/* It keeps its height: a wafer that it holds goes through no wafer and no level slot, and an empty blade
 * that looks for none through nothing. */
static bool keeps_height(const mover_t *mover) {
    const wh_gripper_t *gripper = &mover->simulator->table.storage.grippers[mover->g];
    return (mover->axes & mover->quiet->lifters[mover->g]) == 0 && is_level(&gripper->base_from_gripper.R);
}

/* A gripper that would take a wafer if it came to one. */
static bool is_looking(const wh_simulator_t *simulator, size_t g) {
    return !holds(simulator, g) && (simulator->table.storage.grippers[g].valve == WH_VALVE_OPEN ||
                                    kind_of(simulator, g) == WH_GRIP_PASSIVE);
}

/* Slots matter to what is put into them; a chuck's own does not. */
static int64_t until_stations(const mover_t *mover) {
    const wh_cell_t *cell = &mover->simulator->cell;
    const bool is_passive = kind_of(mover->simulator, mover->g) == WH_GRIP_PASSIVE;
    const bool is_flat = keeps_height(mover) && !is_passive;
    const bool matter = is_passive || (holds(mover->simulator, mover->g) && !mover->is_stroke);
    int64_t slices = INT64_MAX;
    for (size_t s = 0; matter && s < cell->count; ++s) {
        const wh_station_t *station = &cell->stations[s];
        const bool matters = is_passive || (station->chuck != (int32_t)mover->g &&
                                            !(is_flat && is_level(&station->base_from_station.R)));
        slices = matters ? least_of(slices, until_slots(mover, station)) : slices;
    }
    return slices;
}

static int64_t until_wafers(const mover_t *mover) {
    const wh_grasp_storage_t *storage = &mover->simulator->table.storage;
    const bool matters = is_looking(mover->simulator, mover->g) || !keeps_height(mover);
    int64_t slices = INT64_MAX;
    for (size_t w = 0; matters && w < storage->wafer_count && slices > 0; ++w) {
        const wh_wafer_t *wafer = &storage->wafers[w];
        if (wafer->holder != (int32_t)mover->g) {
            slices = least_of(slices, until_place(mover, &wafer->base_from_wafer.r, wafer->holder));
        }
    }
    return slices;
}

/* Other grippers without a wafer may look for one. */
static int64_t until_grippers(const mover_t *mover) {
    const wh_grasp_storage_t *storage = &mover->simulator->table.storage;
    int64_t slices = INT64_MAX;
    for (size_t g = 0; holds(mover->simulator, mover->g) && g < storage->gripper_count; ++g) {
        if (g != mover->g && is_looking(mover->simulator, g)) {
            slices =
                least_of(slices, until_place(mover, &storage->grippers[g].base_from_gripper.r, (int32_t)g));
        }
    }
    return slices;
}

static int64_t until_near(const mover_t *mover) {
    const int64_t slices = least_of(until_stations(mover), until_grippers(mover));
    return slices > 0 ? least_of(slices, until_wafers(mover)) : 0;
}

/* By the way that its axis goes up or down, where that is known. */
static int64_t until_stroke_ends(const mover_t *mover, const wh_quiet_stroke_t *stroke) {
    mover_t own = *mover;
    size_t axis = WH_AXES;
    if (!stroke) {
        return 0;
    }
    const wh_real_t room =
        wh_quiet_room(mover->quiet, mover->simulator, mover->axes, stroke->still, mover->g, &axis);
    own.is_stroke = true;
    const int64_t slices = room > 0 ? until_near(&own) : 0;
    return slices > 0 ? least_of(slices, stroke->within(stroke->user, axis, room)) : 0;
}

/* --------------------------------------------------------------------------------------------- the slices */

static int64_t until_mover(const mover_t *mover, const wh_quiet_stroke_t *stroke) {
    const int64_t slices = until_near(mover);
    return slices > 0 ? slices : until_stroke_ends(mover, stroke);
}

int64_t wh_quiet_slices(const wh_quiet_t *quiet, const wh_simulator_t *simulator, const wh_command_t *last,
                        uint32_t axes, const wh_quiet_stroke_t *stroke) {
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    int64_t slices = is_idle(simulator, last) && do_doors_stand(quiet, simulator, last, axes)
                         ? until_fault(simulator, last)
                         : 0;
    for (size_t g = 0; g < storage->gripper_count && slices > 0; ++g) {
        const bool moves = (axes & quiet->movers[g]) != 0;
        slices = does_gripper_stand(simulator, g, last->grippers[g].valve, moves) ? slices : 0;
    }
    for (size_t g = 0; g < storage->gripper_count && slices > 0; ++g) {
        if ((axes & quiet->movers[g]) == 0) {
            continue;
        }
        const wh_gripper_t *gripper = &storage->grippers[g];
        const wh_vec3_t *at = gripper->wafer == WH_NONE ? &gripper->base_from_gripper.r
                                                        : &storage->wafers[gripper->wafer].base_from_wafer.r;
        mover_t mover = {quiet, simulator, axes, g, *at, margin_of(simulator), 0, false};
        mover.way = way_of(&mover, g);
        slices = least_of(slices, until_mover(&mover, stroke));
    }
    return slices;
}

/* The grasp table carries it like this. */
static void carry(const wh_gripper_t *gripper, wh_wafer_t *wafer) {
    wh_pose_compose_to(&gripper->base_from_gripper, &gripper->gripper_from_wafer, &wafer->base_from_wafer);
    if (!wh_mat3_is_orthonormal(&wafer->base_from_wafer.R)) {
        wh_mat3_orthonormalise(&wafer->base_from_wafer.R);
    }
}

void wh_quiet_pass(wh_simulator_t *simulator, const wh_command_t *command, int64_t slices) {
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    for (size_t g = 0; g < storage->gripper_count; ++g) {
        wh_gripper_t *gripper = &storage->grippers[g];
        gripper->base_from_gripper = command->grippers[g].base_from_gripper;
        if (gripper->wafer != WH_NONE) {
            carry(gripper, &storage->wafers[gripper->wafer]);
        }
    }
    simulator->table.slice += (uint64_t)slices;
    simulator->last_seq = command->seq;
    simulator->last_utime = command->utime;
    simulator->event_count = 0;
}
