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

static bool make_room(wh_tape_t *tape, const wh_command_t *command) {
    const size_t bytes =
        command->gripper_count * sizeof *tape->poses + command->axis_count * sizeof *tape->axes;
    if (tape->slice_count < tape->slice_capacity) {
        return true;
    }
    const int64_t wanted = tape->slice_capacity > 0 ? 2 * tape->slice_capacity : 4096;
    if ((size_t)wanted > WH_TAPE_BYTES / bytes) {
        tape->unfit = "the run has too many slices";
        return false;
    }
    tape->gripper_count = command->gripper_count;
    tape->axis_count = command->axis_count;
    tape->poses = enlarge(tape->poses, (size_t)wanted * tape->gripper_count * sizeof *tape->poses);
    tape->axes = enlarge(tape->axes, (size_t)wanted * tape->axis_count * sizeof *tape->axes);
    tape->slice_capacity = wanted;
    return true;
}

static void keep_valve(wh_tape_t *tape, size_t g, int64_t slice, int32_t valve) {
    const size_t count = tape->valve_count[g];
    const int32_t before = count > 0 ? tape->valves[g][count - 1].valve : WH_VALVE_CLOSED;
    if (valve != before) {
        tape->valves[g] =
            wh_record_grow(tape->valves[g], count, &tape->valve_capacity[g], sizeof *tape->valves[g]);
        tape->valves[g][count] = (wh_tape_valve_t){slice, valve};
        ++tape->valve_count[g];
    }
}

void wh_tape_slice(wh_tape_t *tape, const wh_command_t *command) {
    if (!tape || tape->unfit) {
        return;
    }
    if (command->fault_count > 0) {
        tape->unfit = "the script makes faults on purpose";
        return;
    }
    if (!make_room(tape, command)) {
        return;
    }
    const size_t slice = (size_t)tape->slice_count++;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        tape->poses[slice * tape->gripper_count + g] = command->grippers[g].base_from_gripper;
        keep_valve(tape, g, command->seq, command->grippers[g].valve);
    }
    memcpy(&tape->axes[slice * tape->axis_count], command->axes, tape->axis_count * sizeof *tape->axes);
}

/* ------------------------------------------------------------------------------------------------------ readings */

static void add_entry(wh_tape_t *tape, const wh_tape_entry_t *entry) {
    tape->entries =
        wh_record_grow(tape->entries, tape->entry_count, &tape->entry_capacity, sizeof *tape->entries);
    tape->entries[tape->entry_count] = *entry;
    tape->entries[tape->entry_count].slice = tape->slice_count;
    ++tape->entry_count;
}

void wh_tape_begin(wh_tape_t *tape, const wh_segment_t *segment, uint32_t carried) {
    if (tape) {
        const bool waits = segment->kind == WH_SEGMENT_SENSOR;
        const wh_tape_entry_t entry = {
            .kind = WH_TAPE_BEGIN, .index = waits ? segment->gripper : WH_NONE, .mask = carried};
        add_entry(tape, &entry);
    }
}

void wh_tape_end(wh_tape_t *tape, bool done, int32_t lost) {
    if (tape) {
        const wh_tape_entry_t entry = {.kind = WH_TAPE_END, .index = lost, .mask = done ? 1 : 0};
        add_entry(tape, &entry);
    }
}

void wh_tape_ask(wh_tape_t *tape, wh_tape_kind_t kind, int32_t index, int32_t answer) {
    if (tape) {
        const wh_tape_entry_t entry = {.kind = kind, .index = index, .answer = answer};
        add_entry(tape, &entry);
    }
}

void wh_tape_claim(wh_tape_t *tape, const wh_tape_claim_t *claim, int32_t verdict) {
    if (tape) {
        const wh_tape_entry_t entry = {
            .kind = WH_TAPE_CLAIM, .index = (int32_t)tape->claim_count, .answer = verdict};
        tape->claims =
            wh_record_grow(tape->claims, tape->claim_count, &tape->claim_capacity, sizeof *tape->claims);
        tape->claims[tape->claim_count++] = *claim;
        add_entry(tape, &entry);
    }
}

void wh_tape_measured(wh_tape_t *tape, const char *what) {
    if (tape && !tape->unfit) {
        tape->unfit = what;
    }
}

int32_t wh_tape_judge(const wh_tape_claim_t *claim, const wh_cell_t *cell, const wh_wafer_t wafers[]) {
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

void wh_tape_free(wh_tape_t *tape) {
    free(tape->poses);
    free(tape->axes);
    free(tape->entries);
    free(tape->claims);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        free(tape->valves[g]);
    }
    memset(tape, 0, sizeof *tape);
}
