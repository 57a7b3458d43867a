/* Passes through the beams at stations' doors, from the states. Each pass is estimated again when its
 * beams are disarmed; motion control disarms them after its own estimate. */
#include <math.h>
#include <string.h>

#include "log_run_internal.h"

/* The most that a crossing's distance from the rim counts, mm. */
#define FARTHEST 50.0

static bool is_order(const wh_layout_t *layout, const wh_latches_t *latches) {
    return latches->first >= 0 && latches->count > 0 && (size_t)latches->first < layout->beam_count &&
           (size_t)latches->count <= layout->beam_count - (size_t)latches->first &&
           layout->doors[latches->first].kind == WH_DOOR_LIGHT;
}

/* True if the latch is from the order's beams, and not later than its slice. */
static bool is_latch_sound(const wh_latch_t *latch, const wh_latches_t *of) {
    return latch->beam >= of->first && latch->beam < of->first + of->count &&
           (latch->edge == WH_CROSSING_IN || latch->edge == WH_CROSSING_OUT) && latch->slice > 0 &&
           latch->slice <= of->slice && latch->part >= 0 && latch->part <= 1;
}

/* Checks the latches: a log may hold any data. */
static bool are_sound(const wh_latches_t *latches, int64_t seq) {
    bool sound = latches->slice >= 0 && latches->slice < seq;
    for (int32_t i = 0; latches->armed && i < latches->latch_count; ++i) {
        sound = sound && is_latch_sound(&latches->latches[i], latches);
    }
    return sound;
}

static void drop(wh_log_run_t *run) {
    for (size_t g = 0; run->passes.are_any && g < WH_GRIPPERS; ++g) {
        wh_pass_free(&run->passes.of[g]);
        memset(&run->passes.of[g], 0, sizeof run->passes.of[g]);
    }
    run->passes.are_any = false;
}

/* A log does not tell the gripper of a pass: it may be any gripper on a robot that has a wafer. */
static void begin_passes(wh_log_run_t *run, const wh_latches_t *latches) {
    const wh_layout_t *layout = run->cell.layout;
    for (size_t g = 0; is_order(layout, latches) && g < run->state.gripper_count; ++g) {
        const bool is_on_robot = layout->machine.mounts[g].axis == WH_NONE;
        if (is_on_robot && run->state.grippers[g].wafer != WH_NONE) {
            const int32_t station = layout->beams[latches->first].station;
            run->passes.are_any = true;
            run->passes.of[g] = (wh_pass_t){.order = {WH_LATCH_ARM, latches->first, latches->count},
                                            .station = station,
                                            .gripper = (int32_t)g,
                                            .believed = wh_pass_station(layout, station, (int32_t)g),
                                            .number = latches->number,
                                            .before = latches->number - 1,
                                            .seq = run->state.seq,
                                            .armed_seq = run->state.seq - latches->slice,
                                            .goes_on = true};
        }
    }
}

static void hear(wh_log_run_t *run) {
    for (size_t g = 0; run->passes.are_any && g < run->state.gripper_count; ++g) {
        if (run->passes.of[g].goes_on) {
            wh_pass_stand(&run->passes.of[g], run->state.seq, &run->state.grippers[g].base_from_gripper);
            wh_pass_hear(&run->passes.of[g], &run->state);
        }
    }
}

/* The mean distance of the crossings from the expected rim on this gripper, mm. */
static double distance_of(const wh_pass_t *pass, const wh_layout_t *layout) {
    wh_pass_crossing_t crossings[WH_CROSSINGS];
    int64_t missed = 0;
    double sum = 0;
    const size_t count = wh_pass_crossings(pass, layout, crossings, &missed);
    for (size_t k = 0; k < count; ++k) {
        const wh_crossing_t *at = &crossings[k].crossing;
        sum += fmin(fabs(sqrt(at->x * at->x + at->y * at->y) - layout->wafer_diameter / 2), FARTHEST);
    }
    return count > 0 ? sum / (double)count : FARTHEST;
}

/* The pass whose crossings are nearest to the rim of its gripper's wafer, or null. */
static const wh_pass_t *find_pass(const wh_log_run_t *run) {
    const wh_pass_t *found = NULL;
    double least = 2 * FARTHEST;
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        const wh_pass_t *pass = &run->passes.of[g];
        const double distance = pass->goes_on ? distance_of(pass, run->cell.layout) : least;
        if (distance < least) {
            least = distance;
            found = pass;
        }
    }
    return found;
}

static int32_t command_with(const wh_log_run_t *run, int32_t gripper) {
    for (size_t i = 0; i < run->lane_count; ++i) {
        if ((run->lanes[i].grippers >> gripper & 1U) != 0 && run->lanes[i].running != WH_NONE) {
            return run->lanes[i].running;
        }
    }
    return run->record.has_tasks ? WH_NONE : run->recorder.running;
}

static void estimate(wh_log_run_t *run) {
    const wh_layout_t *layout = run->cell.layout;
    const wh_pass_t *pass = find_pass(run);
    if (!pass) {
        return;
    }
    wh_centring_record_t centring;
    const wh_centring_t known = wh_centring_known(layout, &pass->order, layout->wafer_diameter / 2);
    wh_centring_estimate(pass, layout, &known, &centring);
    centring.command = command_with(run, pass->gripper);
    centring.wafer = run->state.grippers[pass->gripper].wafer;
    centring.repeated = true;
    if (!pass->skipped) {
        centring.lacking = pass->seq - pass->armed_seq + 1 - (int64_t)pass->place_count;
    }
    wh_record_add_centring(&run->record, &centring);
}

void wh_log_run_hear_passes(wh_log_run_t *run) {
    const wh_latches_t *latches = &run->state.physics->latches;
    const bool is_same = latches->number == run->passes.number;
    const bool sound = are_sound(latches, run->state.seq);
    if (is_same && sound && !latches->armed) {
        estimate(run);
    }
    if (!is_same || !sound || !latches->armed) {
        drop(run);
    }
    if (!is_same && sound && latches->armed) {
        begin_passes(run, latches);
    }
    run->passes.number = latches->number;
    hear(run);
}

void wh_log_run_close_passes(wh_log_run_t *run) {
    drop(run);
}
