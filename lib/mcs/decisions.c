#include "decisions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* ------------------------------------------------------------------------------------------------------- slices */

static bool make_room(wh_decisions_t *decisions, const wh_command_t *command) {
    const size_t bytes =
        command->gripper_count * sizeof *decisions->poses + command->axis_count * sizeof *decisions->axes;
    if (decisions->slice_count < decisions->slice_capacity) {
        return true;
    }
    size_t poses = (size_t)decisions->slice_capacity;
    size_t axes = poses;
    const size_t wanted = poses > 0 ? 2 * poses : 4096;
    if (wanted > WH_TAPE_BYTES / bytes) {
        decisions->unfit = "the run has too many slices";
        return false;
    }
    decisions->gripper_count = command->gripper_count;
    decisions->axis_count = command->axis_count;
    decisions->poses = wh_array_reserve(decisions->poses, wanted, &poses,
                                        decisions->gripper_count * sizeof *decisions->poses);
    decisions->axes =
        wh_array_reserve(decisions->axes, wanted, &axes, decisions->axis_count * sizeof *decisions->axes);
    decisions->slice_capacity = (int64_t)wanted;
    return true;
}

static void keep_valve(wh_decisions_t *decisions, size_t g, int64_t slice, int32_t valve) {
    const size_t count = decisions->valve_count[g];
    const int32_t before = count > 0 ? decisions->valves[g][count - 1].valve : WH_VALVE_CLOSED;
    if (valve != before) {
        decisions->valves[g] = wh_array_grow(decisions->valves[g], count, &decisions->valve_capacity[g],
                                             sizeof *decisions->valves[g]);
        decisions->valves[g][count] = (wh_decisions_valve_t){slice, valve};
        ++decisions->valve_count[g];
    }
}

void wh_decisions_slice(wh_decisions_t *decisions, const wh_command_t *command) {
    if (!decisions || decisions->unfit) {
        return;
    }
    if (command->fault_count > 0) {
        decisions->unfit = "the script makes faults on purpose";
        return;
    }
    if (!make_room(decisions, command)) {
        return;
    }
    const size_t slice = (size_t)decisions->slice_count++;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        decisions->poses[slice * decisions->gripper_count + g] = command->grippers[g].base_from_gripper;
        keep_valve(decisions, g, command->seq, command->grippers[g].valve);
    }
    memcpy(&decisions->axes[slice * decisions->axis_count], command->axes,
           decisions->axis_count * sizeof *decisions->axes);
}

/* ------------------------------------------------------------------------------------------------------ readings */

static void add_entry(wh_decisions_t *decisions, const wh_decisions_entry_t *entry) {
    decisions->entries = wh_array_grow(decisions->entries, decisions->entry_count, &decisions->entry_capacity,
                                       sizeof *decisions->entries);
    decisions->entries[decisions->entry_count] = *entry;
    decisions->entries[decisions->entry_count].slice = decisions->slice_count;
    ++decisions->entry_count;
}

void wh_decisions_begin(wh_decisions_t *decisions, const wh_segment_t *segment, uint32_t carried) {
    if (decisions) {
        const bool waits = segment->kind == WH_SEGMENT_SENSOR;
        const wh_decisions_entry_t entry = {
            .kind = WH_TAPE_BEGIN, .index = waits ? segment->gripper : WH_NONE, .mask = carried};
        add_entry(decisions, &entry);
    }
}

void wh_decisions_end(wh_decisions_t *decisions, bool done, int32_t lost) {
    if (decisions) {
        const wh_decisions_entry_t entry = {.kind = WH_TAPE_END, .index = lost, .mask = done ? 1 : 0};
        add_entry(decisions, &entry);
    }
}

void wh_decisions_ask(wh_decisions_t *decisions, wh_decisions_kind_t kind, int32_t index, int32_t answer) {
    if (decisions) {
        const wh_decisions_entry_t entry = {.kind = kind, .index = index, .answer = answer};
        add_entry(decisions, &entry);
    }
}

void wh_decisions_claim(wh_decisions_t *decisions, const wh_decisions_claim_t *claim, int32_t verdict) {
    if (decisions) {
        const wh_decisions_entry_t entry = {
            .kind = WH_TAPE_CLAIM, .index = (int32_t)decisions->claim_count, .answer = verdict};
        decisions->claims = wh_array_grow(decisions->claims, decisions->claim_count,
                                          &decisions->claim_capacity, sizeof *decisions->claims);
        decisions->claims[decisions->claim_count++] = *claim;
        add_entry(decisions, &entry);
    }
}

void wh_decisions_measured(wh_decisions_t *decisions, const char *what) {
    if (decisions && !decisions->unfit) {
        decisions->unfit = what;
    }
}

int32_t wh_decisions_judge(const wh_decisions_claim_t *claim, const wh_cell_t *cell,
                           const wh_wafer_t wafers[]) {
    const wh_pose_t *base_from_wafer = &wafers[claim->wafer].base_from_wafer;
    wh_place_t place;
    if (!wh_cell_locate(cell, base_from_wafer, &place) || place.station != claim->station ||
        place.slot != claim->slot) {
        return 0;
    }
    place = wh_station_measure(&cell->stations[claim->station], claim->slot, base_from_wafer);
    return fabs(place.dx - claim->dx) < claim->tolerance && fabs(place.dy - claim->dy) < claim->tolerance ? 2
                                                                                                          : 1;
}

void wh_decisions_free(wh_decisions_t *decisions) {
    free(decisions->poses);
    free(decisions->axes);
    free(decisions->entries);
    free(decisions->claims);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        free(decisions->valves[g]);
    }
    memset(decisions, 0, sizeof *decisions);
}
