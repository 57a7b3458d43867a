#include "ahead.h"

#include <stdio.h>
#include <string.h>

#include "../grasp/restore.h"

static size_t wafer_bytes(const wh_layout_t *layout) {
    return (layout->wafer_count * sizeof(wh_wafer_t) + 15) / 16 * 16;
}

size_t wh_ahead_bytes(const wh_layout_t *layout) {
    return wafer_bytes(layout) + wh_collision_bytes(layout);
}

void wh_ahead_init(wh_ahead_t *ahead, const wh_layout_t *layout, void *memory) {
    memset(ahead, 0, sizeof *ahead);
    ahead->layout = layout;
    ahead->wafers = memory;
    ahead->world_memory = (unsigned char *)memory + wafer_bytes(layout);
}

/* The copy stands where motion control stands. */
static bool begin(wh_ahead_t *ahead, const wh_state_t *state) {
    const wh_layout_t *layout = ahead->layout;
    const wh_grasp_storage_t storage = {.wafers = ahead->wafers,
                                        .wafer_count = layout->wafer_count,
                                        .grippers = ahead->grippers,
                                        .gripper_count = layout->machine.gripper_count};
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        ahead->wafers[w] = state->wafers[w];
    }
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

static void describe(const wh_ahead_t *ahead, const wh_event_t *hit, char *reason) {
    const char *one = wh_layout_part_name(ahead->layout, hit->parts[0]);
    const char *two = wh_layout_part_name(ahead->layout, hit->parts[1]);
    snprintf(reason, WH_REHEARSAL_REASON_BYTES, "%s and %s at %.3f, %.3f, %.3f mm", one ? one : "a part",
             two ? two : "others", (double)hit->at.x, (double)hit->at.y, (double)hit->at.z);
}

bool wh_ahead_judge(void *user, const wh_track_t *begun, const wh_state_t *now, bool first, char *reason) {
    wh_ahead_t *ahead = user;
    wh_track_t track = *begun;
    wh_command_t command = {.fault_count = 0};
    wh_machine_cache_t cache = {.is_taken = false};
    wh_state_t state;
    if (track.segment.kind == WH_SEGMENT_SENSOR || (first && !begin(ahead, now))) {
        return false;
    }
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
