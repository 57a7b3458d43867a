#include "passes.h"

#include <stdlib.h>

#include "../text/array.h"

/* --------------------------------------------------------------------------------------------- collecting */

static bool is_of(const wh_pass_t *pass, const wh_latches_t *latches) {
    return pass->armed_seq > 0 && latches->number > pass->before && latches->first == pass->order.first &&
           latches->count == pass->order.count;
}

static void collect(wh_pass_t *pass, const wh_latches_t *latches, int64_t seq) {
    for (int32_t i = 0; i < latches->latch_count; ++i) {
        if (pass->latch_count < WH_CROSSINGS) {
            pass->latches[pass->latch_count] = latches->latches[i];
        }
        ++pass->latch_count;
    }
    const int64_t given = (int64_t)latches->crossings - latches->lost - latches->waiting_count;
    pass->missed = given - pass->latch_count + latches->lost;
    pass->skipped = latches->armed && latches->slice != seq - pass->armed_seq;
}

void wh_pass_hear(wh_pass_t *pass, const wh_state_t *state) {
    const wh_latches_t *latches = &state->physics->latches;
    pass->seq = state->seq;
    pass->number = latches->number;
    if (is_of(pass, latches)) {
        collect(pass, latches, state->seq);
    }
}

void wh_pass_stand(wh_pass_t *pass, int64_t seq, const wh_pose_t *base_from_gripper) {
    const int64_t index = seq - pass->armed_seq;
    if (pass->armed_seq == 0 || !pass->goes_on || index < 0 || index > (int64_t)pass->place_count) {
        return;
    }
    pass->places = wh_array_grow(pass->places, (size_t)index, &pass->place_capacity, sizeof *pass->places);
    pass->places[index] = *base_from_gripper;
    pass->place_count = (size_t)index + 1;
}

void wh_pass_follow(wh_pass_t *pass, const wh_command_t *command) {
    if (command->latch.kind == WH_LATCH_ARM) {
        pass->armed_seq = command->seq;
        pass->place_count = 0;
    }
    wh_pass_stand(pass, command->seq, &command->grippers[pass->gripper].base_from_gripper);
}

void wh_pass_free(wh_pass_t *pass) {
    free(pass->places);
    pass->places = NULL;
    pass->place_count = 0;
    pass->place_capacity = 0;
}

/* ---------------------------------------------------------------------------------------------- crossings */

wh_pose_t wh_pass_station(const wh_layout_t *layout, int32_t station, int32_t gripper) {
    const size_t robot = layout->machine.mounts[gripper].robot;
    const wh_vec3_t aside = wh_layout_aside(layout, (size_t)station, robot);
    wh_pose_t base_from_station = layout->places[station].base_from_station;
    base_from_station.r = wh_vec3_add(&base_from_station.r, &aside);
    return base_from_station;
}

wh_beam_t wh_pass_beam(const wh_layout_t *layout, int32_t beam, const wh_pose_t *base_from_station) {
    const wh_layout_beam_t *of = &layout->beams[beam];
    return wh_beam_at(base_from_station, of->x, of->y, of->low, of->high);
}

/* The place of the blade when a latch's beam changed. Returns false if it is not known. */
static bool find_crossing(const wh_pass_t *pass, const wh_layout_t *layout, const wh_latch_t *latch,
                          wh_pass_crossing_t *found) {
    const wh_layout_beam_t *beam = &layout->beams[latch->beam];
    const double slice_s = (double)layout->slice_us / 1e6;
    const double delay = latch->edge == WH_CROSSING_IN ? beam->delay_on : beam->delay_off;
    double time = (double)(latch->slice - 1) + latch->part - delay / slice_s;
    time = time > 0 ? time : 0;
    const size_t slice = (size_t)time;
    if (slice + 1 >= pass->place_count) {
        return false;
    }
    const wh_slice_motion_t motion = wh_slice_motion_between(&pass->places[slice], &pass->places[slice + 1]);
    const wh_beam_t line = wh_pass_beam(layout, latch->beam, &pass->believed);
    found->time = ((double)pass->armed_seq + time) * slice_s;
    found->crossing.beam = latch->beam;
    found->crossing.edge = latch->edge;
    return wh_beam_crossing(&line, &motion, time - (double)slice, slice_s, &found->crossing);
}

size_t wh_pass_crossings(const wh_pass_t *pass, const wh_layout_t *layout,
                         wh_pass_crossing_t crossings[WH_CROSSINGS], int64_t *missed) {
    const int64_t kept = pass->latch_count < WH_CROSSINGS ? pass->latch_count : WH_CROSSINGS;
    size_t count = 0;
    *missed = pass->missed + pass->latch_count - kept;
    for (int64_t i = 0; i < kept; ++i) {
        if (find_crossing(pass, layout, &pass->latches[i], &crossings[count])) {
            ++count;
        } else {
            ++*missed;
        }
    }
    return count;
}
