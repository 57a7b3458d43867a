#include "decisions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../record/record.h"

static void *enlarge(void *memory, size_t bytes) {
    void *grown = realloc(memory, bytes);
    if (!grown) {
        abort();
    }
    return grown;
}

/* ------------------------------------------------------------------------------------------------------- slices */

static bool make_room(wh_decisions_t *decisions, const wh_command_t *command) {
    const size_t bytes =
        command->gripper_count * sizeof *decisions->poses + command->axis_count * sizeof *decisions->axes;
    if (decisions->slice_count < decisions->slice_capacity) {
        return true;
    }
    const int64_t wanted = decisions->slice_capacity > 0 ? 2 * decisions->slice_capacity : 4096;
    if ((size_t)wanted > WH_DECISIONS_BYTES / bytes) {
        decisions->unfit = "the run has too many slices";
        return false;
    }
    decisions->gripper_count = command->gripper_count;
    decisions->axis_count = command->axis_count;
    decisions->poses =
        enlarge(decisions->poses, (size_t)wanted * decisions->gripper_count * sizeof *decisions->poses);
    decisions->axes =
        enlarge(decisions->axes, (size_t)wanted * decisions->axis_count * sizeof *decisions->axes);
    decisions->slice_capacity = wanted;
    return true;
}

static void keep_valve(wh_decisions_t *decisions, size_t g, int64_t slice, int32_t valve) {
    const size_t count = decisions->valve_count[g];
    const int32_t before = count > 0 ? decisions->valves[g][count - 1].valve : WH_VALVE_CLOSED;
    if (valve != before) {
        decisions->valves[g] = wh_record_grow(decisions->valves[g], count, &decisions->valve_capacity[g],
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

void wh_decisions_read(wh_decisions_t *decisions, wh_decisions_kind_t kind, int32_t index, int32_t answer) {
    if (decisions) {
        decisions->entries = wh_record_grow(decisions->entries, decisions->entry_count,
                                            &decisions->entry_capacity, sizeof *decisions->entries);
        decisions->entries[decisions->entry_count++] =
            (wh_decisions_entry_t){kind, index, answer, decisions->slice_count};
    }
}

void wh_decisions_claim(wh_decisions_t *decisions, const wh_decisions_claim_t *claim, int32_t verdict) {
    if (decisions) {
        decisions->claims = wh_record_grow(decisions->claims, decisions->claim_count,
                                           &decisions->claim_capacity, sizeof *decisions->claims);
        decisions->claims[decisions->claim_count] = *claim;
        wh_decisions_read(decisions, WH_DECISION_CLAIM, (int32_t)decisions->claim_count++, verdict);
    }
}

void wh_decisions_measured(wh_decisions_t *decisions, const char *what) {
    if (decisions && !decisions->unfit) {
        decisions->unfit = what;
    }
}

void wh_vacuum_watch_begin(wh_vacuum_watch_t *watch, uint32_t watched) {
    watch->watched = watched;
    watch->was_off = 0;
}

void wh_vacuum_watch_slice(wh_vacuum_watch_t *watch, uint32_t sensors) {
    watch->was_off |= ~sensors;
}

int32_t wh_vacuum_watch_lost(const wh_vacuum_watch_t *watch, const int32_t valves[], size_t gripper_count) {
    for (size_t g = 0; g < gripper_count; ++g) {
        if ((watch->watched & watch->was_off & 1U << g) != 0 && valves[g] == WH_VALVE_OPEN) {
            return (int32_t)g;
        }
    }
    return WH_NONE;
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
