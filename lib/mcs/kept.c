#include "kept.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "flow_held.h"
#include "native.h"

/* ----------------------------------------------------------------------------------------------- motions */

/* The axes that a segment of kind AXES moves: those whose targets have other bits. */
static uint32_t find_moved(const wh_track_t *begun, size_t axis_count) {
    uint32_t axes = 0;
    for (size_t axis = 0; axis < axis_count; ++axis) {
        const bool is_same =
            memcmp(&begun->axes[axis], &begun->segment.target[axis], sizeof begun->axes[axis]) == 0;
        axes |= is_same ? 0 : 1U << axis;
    }
    return axes;
}

/* All other motions are of one robot. */
static uint32_t find_axes(const wh_track_t *begun) {
    const wh_segment_t *segment = &begun->segment;
    const wh_machine_t *machine = begun->machine;
    if (segment->kind == WH_SEGMENT_AXES) {
        return find_moved(begun, machine->axis_count);
    }
    if (segment->kind == WH_SEGMENT_VALVES || segment->kind == WH_SEGMENT_DWELL ||
        segment->kind == WH_SEGMENT_SENSOR) {
        return 0;
    }
    const size_t robot = segment->gripper != WH_NONE ? machine->mounts[segment->gripper].robot : 0;
    return wh_mcs_robot_axes(machine, robot);
}

size_t wh_mcs_keep_segment(wh_mcs_t *mcs, const wh_track_t *begun, const wh_planned_t *planned,
                           uint32_t axes) {
    wh_mcs_kept_t *kept = &mcs->kept;
    const uint32_t moved = mcs->wanted.keeps_segments ? find_axes(begun) & axes : 0;
    if (moved == 0) {
        return 0;
    }
    kept->motions =
        wh_array_grow(kept->motions, kept->motion_count, &kept->motion_capacity, sizeof *kept->motions);
    wh_kept_motion_t *motion = &kept->motions[kept->motion_count++];
    memset(motion, 0, sizeof *motion);
    motion->segment = begun->segment;
    motion->segment.points = NULL;
    memcpy(motion->points, planned->points, sizeof motion->points);
    motion->slowness = planned->slowness;
    motion->axes = moved;
    motion->after = mcs->track.slice;
    motion->planned = begun->segment_slices;
    motion->command = mcs->recorder.running;
    return kept->motion_count;
}

static void add_slices(wh_mcs_kept_t *kept, size_t number, int64_t slices) {
    if (number > 0) {
        kept->motions[number - 1].slices += slices;
    }
}

/* Keeps where a motion that slows down stands in the slice that goes out. */
static void keep_place(wh_mcs_t *mcs, size_t number) {
    wh_mcs_kept_t *kept = &mcs->kept;
    kept->places =
        wh_array_grow(kept->places, kept->place_count, &kept->place_capacity, sizeof *kept->places);
    wh_kept_place_t *place = &kept->places[kept->place_count++];
    place->seq = mcs->command.seq;
    place->axes = kept->motions[number - 1].axes;
    place->command = kept->motions[number - 1].command;
    memcpy(place->at, mcs->command.axes, sizeof place->at);
}

/* The slices of a segment; of one that slows down, the place in the one slice that goes out. */
static void count_segment(wh_mcs_t *mcs, size_t number, bool slows_down, int64_t slices) {
    if (!slows_down) {
        add_slices(&mcs->kept, number, slices);
    } else if (number > 0 && slices > 0) {
        keep_place(mcs, number);
    }
}

/* Counts slices of all running segments. */
static void count_slices(wh_mcs_t *mcs, int64_t slices) {
    if (!mcs->lanes) {
        count_segment(mcs, mcs->running.kept, mcs->running.slows_down, slices);
    }
    for (size_t i = 0; mcs->lanes && i < mcs->lanes->count; ++i) {
        const wh_lane_t *lane = &mcs->lanes->of[i];
        const bool goes = lane->is_busy && !lane->is_held && !wh_mcs_is_held_back(mcs, lane);
        count_segment(mcs, goes ? lane->kept : 0, lane->stop.ramp.is_on, slices);
    }
}

void wh_mcs_keep_left_out(wh_mcs_t *mcs, int64_t slices) {
    if (mcs->wanted.keeps_segments) {
        count_slices(mcs, slices);
    }
}

/* ------------------------------------------------------------------------------------------------ slices */

/* The command that switches valves in this slice. */
static int32_t find_switcher(const wh_mcs_t *mcs) {
    for (size_t i = 0; mcs->lanes && i < mcs->lanes->count; ++i) {
        const wh_lane_t *lane = &mcs->lanes->of[i];
        if (lane->is_busy && lane->track.segment.kind == WH_SEGMENT_VALVES) {
            return (int32_t)i == mcs->lanes->current ? mcs->recorder.running : lane->running;
        }
    }
    return mcs->recorder.running;
}

static void keep_valves(wh_mcs_t *mcs) {
    wh_mcs_kept_t *kept = &mcs->kept;
    uint32_t open = 0;
    for (size_t g = 0; g < mcs->command.gripper_count; ++g) {
        open |= mcs->command.grippers[g].valve == WH_VALVE_OPEN ? 1U << g : 0;
    }
    if (open != (kept->valves_count > 0 ? kept->valves[kept->valves_count - 1].open : 0)) {
        kept->valves =
            wh_array_grow(kept->valves, kept->valves_count, &kept->valves_capacity, sizeof *kept->valves);
        kept->valves[kept->valves_count++] = (wh_kept_valves_t){mcs->command.seq, open, find_switcher(mcs)};
    }
}

static void keep_faults(wh_mcs_kept_t *kept, const wh_command_t *command) {
    for (size_t i = 0; i < command->fault_count; ++i) {
        kept->faults =
            wh_array_grow(kept->faults, kept->fault_count, &kept->fault_capacity, sizeof *kept->faults);
        kept->faults[kept->fault_count++] = (wh_played_fault_t){command->seq, command->faults[i]};
    }
}

static void keep_orders(wh_mcs_kept_t *kept, const wh_command_t *command) {
    if (command->scan.kind != WH_SCAN_KEEP || command->latch.kind != WH_LATCH_KEEP) {
        kept->orders =
            wh_array_grow(kept->orders, kept->order_count, &kept->order_capacity, sizeof *kept->orders);
        kept->orders[kept->order_count++] = (wh_played_order_t){command->seq, command->scan, command->latch};
    }
}

void wh_mcs_keep_slice(wh_mcs_t *mcs) {
    if (mcs->wanted.keeps_segments) {
        count_slices(mcs, 1);
        keep_valves(mcs);
        keep_faults(&mcs->kept, &mcs->command);
        keep_orders(&mcs->kept, &mcs->command);
    }
}

void wh_mcs_drop_slice(wh_mcs_t *mcs) {
    wh_mcs_kept_t *kept = &mcs->kept;
    const int64_t seq = mcs->command.seq;
    if (!mcs->wanted.keeps_segments) {
        return;
    }
    count_slices(mcs, -1);
    while (kept->place_count > 0 && kept->places[kept->place_count - 1].seq == seq) {
        --kept->place_count;
    }
    while (kept->valves_count > 0 && kept->valves[kept->valves_count - 1].seq == seq) {
        --kept->valves_count;
    }
    while (kept->fault_count > 0 && kept->faults[kept->fault_count - 1].seq == seq) {
        --kept->fault_count;
    }
    while (kept->order_count > 0 && kept->orders[kept->order_count - 1].seq == seq) {
        --kept->order_count;
    }
}

void wh_mcs_free_kept(wh_mcs_kept_t *kept) {
    free(kept->motions);
    free(kept->places);
    free(kept->valves);
    free(kept->faults);
    free(kept->orders);
    *kept = (wh_mcs_kept_t){0};
}
