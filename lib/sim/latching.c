#include "latching.h"

#include <string.h>

#include "../math/hash.h"
#include "setting_internal.h"
#include "simulator.h"

/* Names of the random numbers for a latch and for a touch. */
#define DRAW_JITTER UINT32_C(0x4C410001)
#define DRAW_TOUCH UINT32_C(0x4C410002)

/* ----------------------------------------------------------------------------------------------- validity */

static wh_status_t check_delay(double delay, double most) {
    if (delay - delay != 0) {
        return WH_STATUS_NOT_FINITE;
    }
    return delay >= 0 && delay <= most ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

static wh_status_t check_light(const wh_door_beam_t *door) {
    wh_status_t status = wh_beam_validate(&door->beam);
    status = status == WH_OK ? check_delay(door->delay_on, 0.01) : status;
    status = status == WH_OK ? check_delay(door->delay_off, 0.01) : status;
    return status == WH_OK ? check_delay(door->jitter, 0.001) : status;
}

static wh_status_t check_touch(const wh_door_beam_t *door, size_t gripper_count) {
    if (door->kind != WH_DOOR_TOUCH || !wh_is_index(door->gripper, gripper_count)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = wh_touch_validate(&door->touch);
    return status == WH_OK ? check_delay(door->noise, 0.1) : status;
}

static wh_status_t check_beam(const wh_door_beam_t *door, size_t gripper_count) {
    if (door->stuck != WH_BEAM_WORKS && door->stuck != WH_BEAM_DARK && door->stuck != WH_BEAM_LIT) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return door->kind == WH_DOOR_LIGHT ? check_light(door) : check_touch(door, gripper_count);
}

/* Checks the arrays' entries; the arrays exist and have these lengths. */
static wh_status_t check_entries(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count) {
    wh_status_t status = WH_OK;
    for (size_t b = 0; status == WH_OK && b < latching->beam_count; ++b) {
        status = check_beam(&latching->beams[b], gripper_count);
    }
    for (size_t g = 0; status == WH_OK && latching->blades && g < gripper_count; ++g) {
        status = wh_blade_outline_validate(&latching->blades[g]);
    }
    for (size_t w = 0; status == WH_OK && w < wafer_count; ++w) {
        status = wh_rim_validate(latching->rims[w], NULL);
    }
    return status;
}

wh_status_t wh_latching_validate(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count) {
    if (!latching) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (latching->beam_count == 0) {
        return WH_OK;
    }
    if (!latching->beams || (!latching->rims && wafer_count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (latching->beam_count > WH_BEAMS || gripper_count > WH_GRIPPERS) {
        return WH_STATUS_BAD_CAPACITY;
    }
    return check_entries(latching, gripper_count, wafer_count);
}

wh_status_t wh_latching_check(const wh_latching_t *latching, const wh_latch_order_t *order) {
    if (order->kind != WH_LATCH_ARM) {
        const bool known = order->kind == WH_LATCH_KEEP || order->kind == WH_LATCH_DISARM;
        return known ? WH_OK : WH_STATUS_OUT_OF_RANGE;
    }
    const int64_t end = (int64_t)order->first + order->count;
    const bool good = order->first >= 0 && order->count >= 1 && end <= (int64_t)latching->beam_count;
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

/* ------------------------------------------------------------------------------------------ what is there */

static size_t gather_shades(const wh_latching_t *latching, const wh_pose_t before[], const wh_grasp_t *table,
                            wh_shade_t shades[WH_SHADES]) {
    size_t count = 0;
    for (size_t g = 0; g < table->storage.gripper_count && count + 2 <= WH_SHADES; ++g) {
        const wh_gripper_t *gripper = &table->storage.grippers[g];
        const wh_slice_motion_t motion = wh_slice_motion_between(&before[g], &gripper->base_from_gripper);
        if (latching->blades && latching->blades[g].count > 0) {
            const wh_shade_t blade = {.motion = motion, .outline = &latching->blades[g]};
            shades[count] = blade;
            ++count;
        }
        if (gripper->wafer != WH_NONE) {
            const wh_shade_t wafer = {.motion = motion,
                                      .gripper_from_wafer = &gripper->gripper_from_wafer,
                                      .rim = latching->rims[gripper->wafer]};
            shades[count] = wafer;
            ++count;
        }
    }
    return count;
}

/* ----------------------------------------------------------------------------------------------- latches */

static bool is_earlier(const wh_latch_t *a, const wh_latch_t *b) {
    return a->slice < b->slice || (a->slice == b->slice && a->part < b->part);
}

/* Puts the latch behind those that come no later. */
static void queue(wh_latches_t *latches, const wh_latch_t *latch) {
    if (latches->waiting_count == WH_LATCHES) {
        ++latches->lost;
        return;
    }
    int32_t place = latches->waiting_count;
    while (place > 0 && is_earlier(latch, &latches->waiting[place - 1])) {
        latches->waiting[place] = latches->waiting[place - 1];
        --place;
    }
    latches->waiting[place] = *latch;
    ++latches->waiting_count;
}

/* The causes that may change a beam or a switch in a slice. */
typedef struct {
    const wh_pose_t *before; /* by gripper */
    const wh_grasp_t *table;
    const wh_faults_t *faults;
    double slice_s;
    wh_shade_t shades[WH_SHADES];
    size_t count;
} passing_t;

static double delay_of(const wh_latching_t *latching, const wh_latches_t *latches, const passing_t *sight,
                       size_t b, bool broken) {
    const wh_door_beam_t *door = &latching->beams[b];
    const wh_fault_t *late = wh_faults_find(sight->faults, WH_FAULT_BEAM_LATE, (int32_t)b);
    if (door->kind == WH_DOOR_TOUCH) {
        return 0;
    }
    double delay = broken ? door->delay_on : door->delay_off;
    if (door->jitter > 0) {
        const wh_trial_t trial = {door->seed, latches->number};
        delay += door->jitter * wh_deviate_normal(&trial, DRAW_JITTER, latches->crossings);
    }
    delay = delay > 0 ? delay : 0;
    return late ? delay + (double)late->value : delay;
}

static void cross(const wh_latching_t *latching, wh_latches_t *latches, const passing_t *sight, size_t b,
                  double part, bool broken) {
    const double due = part + delay_of(latching, latches, sight, b, broken) / sight->slice_s;
    /* The instant at the end of a slice belongs to that slice. */
    int64_t later = (int64_t)due;
    later -= later > 0 && due <= (double)later ? 1 : 0;
    const wh_latch_t latch = {(int32_t)b, broken ? WH_CROSSING_IN : WH_CROSSING_OUT, latches->slice + later,
                              due - (double)later};
    ++latches->crossings;
    queue(latches, &latch);
}

/* The fixed signal of a beam that is broken down, by itself or by a fault. */
static wh_beam_stuck_t stuck_of(const wh_latching_t *latching, const wh_faults_t *faults, size_t b) {
    const wh_door_beam_t *door = &latching->beams[b];
    const bool touch = door->kind == WH_DOOR_TOUCH;
    const int32_t target = touch ? door->gripper : (int32_t)b;
    if (door->stuck != WH_BEAM_WORKS) {
        return door->stuck;
    }
    if (wh_faults_find(faults, touch ? WH_FAULT_PROBE_CLOSED : WH_FAULT_BEAM_DARK, target)) {
        return WH_BEAM_DARK;
    }
    if (wh_faults_find(faults, touch ? WH_FAULT_PROBE_OPEN : WH_FAULT_BEAM_LIT, target)) {
        return WH_BEAM_LIT;
    }
    return WH_BEAM_WORKS;
}

/* The distance before its ball meets a face at which a switch closes; it is constant during an arming. */
static double early_by(const wh_door_beam_t *door, const wh_latches_t *latches, size_t b) {
    const wh_trial_t trial = {door->seed, latches->number};
    return door->noise > 0 ? door->noise * wh_deviate_normal(&trial, DRAW_TOUCH, (uint32_t)b) : 0;
}

/* wh_beam_next, for either kind. */
static bool next_change(const wh_latching_t *latching, const wh_latches_t *latches, const passing_t *sight,
                        size_t b, double *part, bool *broken) {
    const wh_door_beam_t *door = &latching->beams[b];
    if (door->kind == WH_DOOR_LIGHT) {
        return wh_beam_next(&door->beam, sight->shades, sight->count, part, broken);
    }
    const wh_gripper_t *gripper = &sight->table->storage.grippers[door->gripper];
    return wh_touch_next(&door->touch, &sight->before[door->gripper], &gripper->base_from_gripper,
                         early_by(door, latches, b), part, broken);
}

/* The most changes of a beam that are searched in a slice. */
#define MOST_CHANGES (2 * WH_LATCHES)

static void set_broken(wh_latches_t *latches, size_t b, bool broken) {
    const uint32_t bit = UINT32_C(1) << b;
    latches->broken = broken ? latches->broken | bit : latches->broken & ~bit;
}

static void look_at_beam(const wh_latching_t *latching, wh_latches_t *latches, size_t b,
                         const passing_t *sight) {
    bool broken = (latches->broken >> b & 1U) != 0;
    double part = 0;
    int changes = 0;
    while (changes < MOST_CHANGES && next_change(latching, latches, sight, b, &part, &broken)) {
        cross(latching, latches, sight, b, part, broken);
        ++changes;
    }
    latches->lost += changes == MOST_CHANGES ? 1 : 0;
    set_broken(latches, b, broken);
}

/* The fault that breaks it down may have begun in this slice. */
static void keep_stuck(const wh_latching_t *latching, wh_latches_t *latches, size_t b, const passing_t *sight,
                       bool broken) {
    if ((latches->broken >> b & 1U) != (broken ? 1U : 0U)) {
        cross(latching, latches, sight, b, 0, broken);
    }
    set_broken(latches, b, broken);
}

/* Evaluates all armed beams. */
static void look_at_beams(const wh_latching_t *latching, wh_latches_t *latches, const passing_t *sight) {
    for (int32_t i = 0; i < latches->count; ++i) {
        const size_t b = (size_t)latches->first + (size_t)i;
        const wh_beam_stuck_t stuck = stuck_of(latching, sight->faults, b);
        if (stuck == WH_BEAM_WORKS) {
            look_at_beam(latching, latches, b, sight);
        } else {
            keep_stuck(latching, latches, b, sight, stuck == WH_BEAM_DARK);
        }
    }
}

/* Moves the latches that are due from the waiting ones to those of the slice. */
static void give_out(wh_latches_t *latches) {
    int32_t due = 0;
    while (due < latches->waiting_count && latches->waiting[due].slice <= latches->slice) {
        latches->latches[due] = latches->waiting[due];
        ++due;
    }
    latches->latch_count = due;
    latches->waiting_count -= due;
    for (int32_t i = 0; i < latches->waiting_count; ++i) {
        latches->waiting[i] = latches->waiting[i + due];
    }
}

/* The beams' states while they are armed. */
static void note_broken(const wh_latching_t *latching, const passing_t *sight, wh_latches_t *latches) {
    for (int32_t i = 0; i < latches->count; ++i) {
        const size_t b = (size_t)latches->first + (size_t)i;
        const wh_beam_stuck_t stuck = stuck_of(latching, sight->faults, b);
        double part = 1;
        bool broken = false;
        (void)next_change(latching, latches, sight, b, &part, &broken);
        set_broken(latches, b, stuck == WH_BEAM_WORKS ? broken : stuck == WH_BEAM_DARK);
    }
}

void wh_latching_step(const wh_latching_t *latching, const wh_pose_t before[], const wh_grasp_t *table,
                      const wh_faults_t *faults, wh_real_t slice_s, const wh_latch_order_t *order,
                      wh_latches_t *latches) {
    latches->latch_count = 0;
    if (!latches->armed && order->kind != WH_LATCH_ARM) {
        return;
    }
    passing_t sight = {.before = before, .table = table, .faults = faults, .slice_s = (double)slice_s};
    sight.count = gather_shades(latching, before, table, sight.shades);
    if (latches->armed) {
        ++latches->slice;
        look_at_beams(latching, latches, &sight);
        give_out(latches);
    }
    if (order->kind == WH_LATCH_DISARM) {
        latches->armed = false;
        latches->waiting_count = 0;
    }
    if (order->kind == WH_LATCH_ARM) {
        latches->armed = true;
        ++latches->number;
        latches->first = order->first;
        latches->count = order->count;
        latches->slice = 0;
        latches->crossings = 0;
        latches->lost = 0;
        latches->broken = 0;
        latches->waiting_count = 0;
        note_broken(latching, &sight, latches);
    }
}

/* --------------------------------------------------------------------------------------------------- hash */

static uint64_t hash_touch(const wh_door_beam_t *door, uint64_t hash) {
    const wh_touch_face_t *touch = &door->touch;
    const double values[] = {touch->along, touch->aside, touch->radius, door->noise};
    hash = wh_hash_int(wh_hash_int(hash, (int32_t)door->kind), door->gripper);
    hash = wh_hash_doubles(wh_hash_doubles(hash, touch->middle, 3), touch->normal, 3);
    hash = wh_hash_doubles(wh_hash_doubles(hash, touch->edge, 3), touch->ball, 3);
    return wh_hash_doubles(hash, values, sizeof values / sizeof values[0]);
}

uint64_t wh_latching_hash(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count,
                          uint64_t hash) {
    for (size_t b = 0; b < latching->beam_count; ++b) {
        const wh_door_beam_t *door = &latching->beams[b];
        const wh_beam_t *beam = &door->beam;
        const double values[] = {beam->x,        beam->y,         beam->z,     beam->ex,
                                 beam->ey,       beam->ez,        beam->low,   beam->high,
                                 door->delay_on, door->delay_off, door->jitter};
        hash = wh_hash_doubles(hash, values, sizeof values / sizeof values[0]);
        hash = wh_hash_int(wh_hash_word(hash, door->seed), (int32_t)door->stuck);
        hash = door->kind == WH_DOOR_TOUCH ? hash_touch(door, hash) : hash;
    }
    for (size_t g = 0; latching->blades && g < gripper_count; ++g) {
        const wh_blade_outline_t *blade = &latching->blades[g];
        hash = wh_hash_int(hash, blade->count);
        hash = wh_hash_doubles(hash, blade->x, (size_t)blade->count);
        hash = wh_hash_doubles(hash, blade->y, (size_t)blade->count);
    }
    for (size_t w = 0; w < wafer_count; ++w) {
        hash = wh_rim_hash(latching->rims[w], hash);
    }
    return hash;
}

/* ----------------------------------------------------------------------------------------- in a simulator */

static wh_status_t step_around(void *of, const void *by,
                               wh_status_t (*rest)(void *simulator, const void *command)) {
    wh_simulator_t *simulator = of;
    const wh_command_t *command = by;
    wh_pose_t before[WH_GRIPPERS];
    const wh_grasp_t *table = &simulator->table;
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        before[g] = table->storage.grippers[g].base_from_gripper;
    }
    const wh_status_t status = rest(simulator, command);
    if (status == WH_OK) {
        wh_latching_step(&simulator->given.latching, before, table, &simulator->physics.faults,
                         simulator->slice_s, &command->latch, &simulator->physics.latches);
    }
    return status;
}

wh_status_t wh_simulator_set_latching(wh_simulator_t *simulator, const wh_latching_t *latching) {
    static const wh_latching_calls_t calls = {wh_latching_check, step_around, wh_latching_hash};
    wh_status_t status = wh_simulator_check_setting(simulator, latching);
    if (status != WH_OK) {
        return status;
    }
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    status = wh_latching_validate(latching, storage->gripper_count, storage->wafer_count);
    if (status == WH_OK) {
        simulator->given.latching = *latching;
        simulator->given.beams = latching->beam_count > 0 ? &calls : NULL;
        simulator->given.hash = wh_physics_state_hash_given;
    }
    return status;
}
