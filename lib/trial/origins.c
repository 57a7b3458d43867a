#include "origins.h"

void wh_origins_begin(wh_origins_t *origins, const wh_layout_t *layout, wh_pose_t lain[],
                      const wh_state_t *state) {
    origins->layout = layout;
    origins->lain = lain;
    origins->wafer_count = state->wafer_count;
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        origins->held[g] = origins->of[g].wafer = WH_NONE;
    }
    wh_origins_look(origins, state);
}

void wh_origins_look(wh_origins_t *origins, const wh_state_t *state) {
    for (size_t w = 0; w < state->wafer_count && state->wafer_count == origins->wafer_count; ++w) {
        origins->lain[w] = state->wafers[w].base_from_wafer;
    }
    for (size_t g = 0; g < state->gripper_count; ++g) {
        origins->held[g] = state->grippers[g].wafer;
    }
}

/* The gripper that held the wafer before this slice, or WH_NONE. */
static int32_t find_holder(const wh_origins_t *origins, size_t gripper_count, int32_t wafer) {
    for (size_t g = 0; g < gripper_count; ++g) {
        if (origins->held[g] == wafer) {
            return (int32_t)g;
        }
    }
    return WH_NONE;
}

/* A wafer on a chuck lies in its station; one that another blade held lay nowhere. */
static void note_taken(wh_origins_t *origins, const wh_state_t *state, size_t g, int32_t wafer) {
    const int32_t holder = find_holder(origins, state->gripper_count, wafer);
    wh_origin_t *origin = &origins->of[g];
    if (holder == WH_NONE) {
        origin->wafer = wafer;
        origin->base_from_wafer = origins->lain[wafer];
    } else if (origins->layout->grippers[holder].station != WH_NONE) {
        origin->wafer = wafer;
        origin->base_from_wafer = state->wafers[wafer].base_from_wafer;
    } else {
        origin->wafer = WH_NONE;
    }
}

/* A fault moves wafers that nobody holds. */
static bool has_fault(const wh_state_t *state) {
    bool found = false;
    for (size_t i = 0; i < state->event_count; ++i) {
        const wh_event_kind_t kind = state->events[i].kind;
        found = found || kind == WH_EVENT_FAULT_ARMED || kind == WH_EVENT_FAULT_CLEARED;
    }
    return found;
}

void wh_origins_hear(wh_origins_t *origins, const wh_state_t *state) {
    if (state->wafer_count != origins->wafer_count) {
        return;
    }
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const int32_t wafer = state->grippers[g].wafer;
        if (wafer != WH_NONE && wafer != origins->held[g]) {
            note_taken(origins, state, g, wafer);
        }
    }
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const int32_t was = origins->held[g];
        if (was != WH_NONE) {
            origins->lain[was] = state->wafers[was].base_from_wafer;
        }
        origins->held[g] = state->grippers[g].wafer;
    }
    if (has_fault(state)) {
        wh_origins_look(origins, state);
    }
}

const wh_pose_t *wh_origins_find(const wh_origins_t *origins, int32_t gripper) {
    const wh_origin_t *origin = &origins->of[gripper];
    const int32_t held = origins->held[gripper];
    return held != WH_NONE && origin->wafer == held ? &origin->base_from_wafer : NULL;
}
