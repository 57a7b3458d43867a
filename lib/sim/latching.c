#include "latching.h"

#include <string.h>

#include "../math/hash.h"
#include "simulator.h"

/* What is drawn for a latch, by name. */
#define DRAW_JITTER UINT32_C(0x4C410001)

/* ----------------------------------------------------------------------------------------------- validity */

static wh_status_t check_delay(double delay, double most) {
    if (delay - delay != 0) {
        return WH_STATUS_NOT_FINITE;
    }
    return delay >= 0 && delay <= most ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

static wh_status_t check_beam(const wh_door_beam_t *door) {
    wh_status_t status = wh_beam_validate(&door->beam);
    status = status == WH_OK ? check_delay(door->delay_on, 0.01) : status;
    status = status == WH_OK ? check_delay(door->delay_off, 0.01) : status;
    if (door->stuck != WH_BEAM_WORKS && door->stuck != WH_BEAM_DARK && door->stuck != WH_BEAM_LIT) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    return status == WH_OK ? check_delay(door->jitter, 0.001) : status;
}

/* What the arrays hold; they are there, and as long as these counts say. */
static wh_status_t check_entries(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count) {
    wh_status_t status = WH_OK;
    for (size_t b = 0; status == WH_OK && b < latching->beam_count; ++b) {
        status = check_beam(&latching->beams[b]);
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

/* Behind those that come no later. */
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

static double delay_of(const wh_latching_t *latching, const wh_latches_t *latches, size_t b, bool broken) {
    const wh_door_beam_t *door = &latching->beams[b];
    double delay = broken ? door->delay_on : door->delay_off;
    if (door->jitter > 0) {
        const wh_trial_t trial = {door->seed, latches->number};
        delay += door->jitter * wh_deviate_normal(&trial, DRAW_JITTER, latches->crossings);
    }
    return delay > 0 ? delay : 0;
}

static void cross(const wh_latching_t *latching, wh_latches_t *latches, size_t b, double part, bool broken,
                  double slice_s) {
    const double due = part + delay_of(latching, latches, b, broken) / slice_s;
    /* The end of a slice belongs to it. */
    int64_t later = (int64_t)due;
    later -= later > 0 && due <= (double)later ? 1 : 0;
    const wh_latch_t latch = {(int32_t)b, broken ? WH_CROSSING_IN : WH_CROSSING_OUT, latches->slice + later,
                              due - (double)later};
    ++latches->crossings;
    queue(latches, &latch);
}

/* The most changes of a beam that are looked for in a slice. */
#define MOST_CHANGES (2 * WH_LATCHES)

static void look_at_beam(const wh_latching_t *latching, wh_latches_t *latches, size_t b,
                         const wh_shade_t shades[], size_t count, double slice_s) {
    const uint32_t bit = UINT32_C(1) << b;
    bool broken = (latches->broken & bit) != 0;
    double part = 0;
    int changes = 0;
    while (changes < MOST_CHANGES && wh_beam_next(&latching->beams[b].beam, shades, count, &part, &broken)) {
        cross(latching, latches, b, part, broken, slice_s);
        ++changes;
    }
    latches->lost += changes == MOST_CHANGES ? 1 : 0;
    latches->broken = broken ? latches->broken | bit : latches->broken & ~bit;
}

/* Moves what is due from the waiting ones to those of the slice. */
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

/* How the beams are while they are armed. */
static void note_broken(const wh_latching_t *latching, const wh_shade_t shades[], size_t count,
                        wh_latches_t *latches) {
    for (int32_t i = 0; i < latches->count; ++i) {
        const size_t b = (size_t)latches->first + (size_t)i;
        double part = 1;
        bool broken = false;
        (void)wh_beam_next(&latching->beams[b].beam, shades, count, &part, &broken);
        if (latching->beams[b].stuck != WH_BEAM_WORKS) {
            broken = latching->beams[b].stuck == WH_BEAM_DARK;
        }
        latches->broken |= broken ? UINT32_C(1) << b : 0;
    }
}

void wh_latching_step(const wh_latching_t *latching, const wh_pose_t before[], const wh_grasp_t *table,
                      wh_real_t slice_s, const wh_latch_order_t *order, wh_latches_t *latches) {
    latches->latch_count = 0;
    if (!latches->armed && order->kind != WH_LATCH_ARM) {
        return;
    }
    wh_shade_t shades[WH_SHADES];
    const size_t count = gather_shades(latching, before, table, shades);
    if (latches->armed) {
        ++latches->slice;
        for (int32_t i = 0; i < latches->count; ++i) {
            const size_t b = (size_t)latches->first + (size_t)i;
            if (latching->beams[b].stuck == WH_BEAM_WORKS) {
                look_at_beam(latching, latches, b, shades, count, (double)slice_s);
            }
        }
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
        note_broken(latching, shades, count, latches);
    }
}

/* --------------------------------------------------------------------------------------------------- hash */

static uint64_t hash_doubles(uint64_t hash, const double values[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        hash = wh_hash_word(hash, bits);
    }
    return hash;
}

uint64_t wh_latching_hash(const wh_latching_t *latching, size_t gripper_count, size_t wafer_count,
                          uint64_t hash) {
    for (size_t b = 0; b < latching->beam_count; ++b) {
        const wh_door_beam_t *door = &latching->beams[b];
        const wh_beam_t *beam = &door->beam;
        const double values[] = {beam->x,        beam->y,         beam->z,     beam->ex,
                                 beam->ey,       beam->ez,        beam->low,   beam->high,
                                 door->delay_on, door->delay_off, door->jitter};
        hash = hash_doubles(hash, values, sizeof values / sizeof values[0]);
        hash = wh_hash_int(wh_hash_word(hash, door->seed), (int32_t)door->stuck);
    }
    for (size_t g = 0; latching->blades && g < gripper_count; ++g) {
        const wh_blade_outline_t *blade = &latching->blades[g];
        hash = wh_hash_int(hash, blade->count);
        hash = hash_doubles(hash, blade->x, (size_t)blade->count);
        hash = hash_doubles(hash, blade->y, (size_t)blade->count);
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
        wh_latching_step(&simulator->latching, before, table, simulator->slice_s, &command->latch,
                         &simulator->physics.latches);
    }
    return status;
}

wh_status_t wh_simulator_set_latching(wh_simulator_t *simulator, const wh_latching_t *latching) {
    static const wh_latching_calls_t calls = {wh_latching_check, step_around, wh_latching_hash};
    if (!simulator || !latching) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (simulator->mark != WH_SIMULATOR_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    if (simulator->table.slice > 0) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    const wh_status_t status = wh_latching_validate(latching, storage->gripper_count, storage->wafer_count);
    if (status == WH_OK) {
        simulator->latching = *latching;
        simulator->beams = latching->beam_count > 0 ? &calls : NULL;
    }
    return status;
}
