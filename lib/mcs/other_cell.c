#include "other_cell.h"

#include <string.h>

#include "carrying.h"

static void use_layout(wh_mcs_t *mcs, const wh_layout_t *layout) {
    mcs->layout = mcs->real = layout;
    mcs->recorder.layout = layout;
    mcs->recorder.cell = &layout->cell;
}

static wh_status_t start_track(wh_mcs_t *mcs, const wh_layout_t *layout) {
    const wh_status_t status = wh_track_init(&mcs->track, &layout->machine, layout->slice_us);
    if (status == WH_OK) {
        wh_track_take_ways(&mcs->track);
        wh_track_take_vias(&mcs->track);
        wh_carrying_start(&mcs->track, layout);
    }
    return status;
}

wh_status_t wh_other_cell_enter(wh_mcs_t *mcs, const wh_layout_t *layout, wh_simulator_t *simulator) {
    const wh_status_t status = start_track(mcs, layout);
    if (status == WH_OK) {
        use_layout(mcs, layout);
        wh_simulator_view(simulator, &mcs->state);
        mcs->link = &simulator->link;
    }
    return status;
}

void wh_other_cell_place(wh_mcs_t *mcs, const wh_real_t axes[WH_AXES]) {
    const wh_machine_t *machine = &mcs->layout->machine;
    if (axes) {
        memcpy(mcs->track.axes, axes, sizeof mcs->track.axes);
    }
    for (size_t d = 0; d < machine->door_count; ++d) {
        mcs->track.axes[wh_machine_door_axis(machine, d)] = machine->doors[d].travel;
    }
    mcs->recorder.record->event_count = 0;
}

int64_t wh_other_cell_planned(const wh_mcs_t *mcs) {
    const wh_plan_list_t *planned = &mcs->rehearsal.planned;
    int64_t slices = 0;
    for (size_t i = 0; i < planned->count; ++i) {
        slices += planned->segments[i].track.segment_slices;
    }
    return slices;
}

int64_t wh_other_cell_slices(const wh_mcs_t *mcs) {
    return mcs->track.slice;
}

const wh_gripper_t *wh_other_cell_gripper(const wh_mcs_t *mcs, size_t gripper) {
    return &mcs->state.grippers[gripper];
}

void wh_other_cell_leave(wh_mcs_t *mcs, const wh_layout_t *layout) {
    mcs->link = NULL;
    use_layout(mcs, layout);
    (void)start_track(mcs, layout);
    wh_simulator_view(&mcs->local.simulator, &mcs->state);
}
