#include "rehearsal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../grasp/restore.h"
#include "../layout/collision.h"
#include "../layout/travel.h"
#include "../text/array.h"

void wh_rehearsal_begin(wh_rehearsal_t *rehearsal, const wh_track_t *track, bool is_judged) {
    rehearsal->is_on = true;
    rehearsal->is_judged = is_judged;
    rehearsal->kept = *track;
    rehearsal->count = 0;
}

void wh_rehearsal_add(wh_rehearsal_t *rehearsal, const wh_planned_t *planned) {
    rehearsal->segments = wh_array_grow(rehearsal->segments, rehearsal->count, &rehearsal->capacity,
                                        sizeof *rehearsal->segments);
    rehearsal->segments[rehearsal->count++] = *planned;
}

void wh_rehearsal_end(wh_rehearsal_t *rehearsal, wh_track_t *track) {
    if (rehearsal->is_on) {
        *track = rehearsal->kept;
        rehearsal->is_on = false;
    }
}

void wh_rehearsal_free(wh_rehearsal_t *rehearsal) {
    free(rehearsal->segments);
    rehearsal->segments = NULL;
    rehearsal->count = rehearsal->capacity = 0;
}

/* -------------------------------------------------------------------------------------------------- reach */

static void note_axis(const wh_travel_t *travel, wh_real_t at, int32_t slot, wh_travel_margin_t *least) {
    const bool is_max = travel->max - at < at - travel->min;
    const wh_real_t margin = is_max ? travel->max - at : at - travel->min;
    if (least->slot == 0 || margin < least->margin) {
        least->margin = margin > 0 ? margin : 0;
        least->at = at;
        least->is_max = is_max;
        least->slot = slot;
    }
}

void wh_rehearsal_note_reach(const wh_rehearsal_t *rehearsal, const wh_track_t *track, wh_record_t *record) {
    const wh_travel_t *travel = track->machine->robot.travel;
    wh_real_t least_R = 0;
    if (rehearsal->reach_slot == 0) {
        return;
    }
    wh_travel_margin_t *least = record->reach[rehearsal->reach_station].axes;
    if (track->segment.kind == WH_SEGMENT_LINE && wh_travel_passes_axis(&track->plan.line, &least_R)) {
        note_axis(&travel[WH_AXIS_R], least_R, rehearsal->reach_slot, &least[WH_AXIS_R]);
    }
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        note_axis(&travel[axis], track->axes[axis], rehearsal->reach_slot, &least[axis]);
    }
}

/* -------------------------------------------------------------------------------------------------- ahead */

/* The copy of the cell. */
typedef struct {
    const wh_layout_t *layout;
    wh_nominal_t *nominal; /* null: no trial */
    bool is_begun;         /* the cell's state could be copied for this command */
    wh_simulator_t simulator;
    wh_collision_t collision;
    wh_gripper_t grippers[WH_GRIPPERS];
    void *world_memory;
    wh_wafer_t wafers[];
} ahead_t;

static size_t own_bytes(const wh_layout_t *layout) {
    return (sizeof(ahead_t) + layout->wafer_count * sizeof(wh_wafer_t) + 15) / 16 * 16;
}

size_t wh_rehearsal_ahead_bytes(const wh_layout_t *layout) {
    return own_bytes(layout) + wh_collision_bytes(layout);
}

/* The copy stands where motion control stands. */
static bool begin(ahead_t *ahead, const wh_state_t *state) {
    const wh_layout_t *layout = ahead->layout;
    const wh_grasp_storage_t storage = {.wafers = ahead->wafers,
                                        .wafer_count = layout->wafer_count,
                                        .grippers = ahead->grippers,
                                        .gripper_count = layout->machine.gripper_count};
    memcpy(ahead->wafers, state->wafers, layout->wafer_count * sizeof *ahead->wafers);
    if (wh_simulator_init(&ahead->simulator, &layout->grasp, &storage, &layout->cell) != WH_OK ||
        wh_grasp_restore(&ahead->simulator.table, (uint64_t)state->seq, state->wafers, state->grippers) !=
            WH_OK) {
        return false;
    }
    wh_collision_attach(&ahead->collision, layout, &ahead->simulator, ahead->world_memory);
    return true;
}

static const wh_event_t *find_hit(const wh_state_t *state) {
    for (size_t i = 0; i < state->event_count; ++i) {
        if (state->events[i].kind == WH_EVENT_HIT || state->events[i].kind == WH_EVENT_UNDECIDED) {
            return &state->events[i];
        }
    }
    return NULL;
}

static void describe(const ahead_t *ahead, const wh_event_t *hit, char *reason) {
    const char *one = wh_layout_part_name(ahead->layout, hit->parts[0]);
    const char *two = wh_layout_part_name(ahead->layout, hit->parts[1]);
    snprintf(reason, WH_REHEARSAL_REASON_BYTES, "%s and %s at %.3f, %.3f, %.3f mm", one ? one : "a part",
             two ? two : "others", (double)hit->at.x, (double)hit->at.y, (double)hit->at.z);
}

static bool judge(void *user, const wh_track_t *begun, const wh_state_t *now, bool first, char *reason) {
    ahead_t *ahead = user;
    wh_track_t track = *begun;
    wh_command_t command = {.fault_count = 0};
    wh_machine_cache_t cache = {.is_taken = false};
    wh_state_t state = *now;
    if (first && ahead->nominal) {
        wh_nominal_believe(ahead->nominal, now, &state);
    }
    ahead->is_begun = first ? begin(ahead, &state) : ahead->is_begun;
    if (!ahead->is_begun) {
        snprintf(reason, WH_REHEARSAL_REASON_BYTES, "nothing can be said, the cell's state was refused");
        return true;
    }
    if (track.segment.kind == WH_SEGMENT_SENSOR) {
        return false; /* nothing moves */
    }
    track.machine = &ahead->layout->machine;
    while (wh_track_next(&track, 0) == WH_TRACK_MOVING) {
        wh_command_from_track(&command, &cache, &track);
        (void)wh_simulator_step(&ahead->simulator, &command, &state);
        const wh_event_t *hit = find_hit(&state);
        if (hit) {
            describe(ahead, hit, reason);
            return true;
        }
    }
    return false;
}

void wh_rehearsal_look_ahead(wh_rehearsal_t *rehearsal, const wh_layout_t *layout, wh_nominal_t *nominal,
                             void *memory) {
    ahead_t *ahead = memory;
    memset(ahead, 0, sizeof *ahead);
    ahead->layout = layout;
    ahead->nominal = nominal;
    ahead->world_memory = (unsigned char *)memory + own_bytes(layout);
    rehearsal->look_ahead = judge;
    rehearsal->look_ahead_user = ahead;
}
