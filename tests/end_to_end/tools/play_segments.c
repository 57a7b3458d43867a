/* Plays what `waferhand run --segments` wrote, with the library alone, as a firmware test would. The file's hash is that of
 * double; float has its own. */
#include <stdio.h>

#include PLAYED

static wh_wafer_t wafers[sizeof played_wafers / sizeof played_wafers[0]];
static wh_gripper_t grippers[WH_GRIPPERS];
static wh_grasp_t table;
static wh_track_t track;

static wh_status_t step(void) {
    wh_pose_t poses[WH_GRIPPERS];
    wh_gripper_input_t inputs[WH_GRIPPERS];
    wh_machine_grippers(&played_machine, track.axes, poses);
    for (size_t g = 0; g < played_machine.gripper_count; ++g) {
        inputs[g].base_from_gripper = poses[g];
        inputs[g].valve = track.valves[g];
    }
    return wh_grasp_step(&table, inputs, NULL);
}

static uint32_t sensors(void) {
    uint32_t on = 0;
    for (size_t g = 0; g < played_machine.gripper_count; ++g) {
        on |= grippers[g].wafer == WH_NONE ? 0U : 1U << g;
    }
    return on;
}

static wh_status_t play(const wh_segment_t *segment) {
    wh_status_t status = wh_track_begin(&track, segment);
    while (status == WH_OK && wh_track_next(&track, sensors()) == WH_TRACK_MOVING) {
        status = step();
    }
    return status;
}

static wh_status_t play_all(void) {
    wh_grasp_storage_t storage = {.wafers = wafers,
                                  .wafer_count = played_wafer_count,
                                  .grippers = grippers,
                                  .gripper_count = played_machine.gripper_count};
    for (size_t w = 0; w < played_wafer_count; ++w) {
        wafers[w].base_from_wafer = played_wafers[w];
    }
    wh_status_t status = wh_grasp_init(&table, &played_config, &storage);
    if (status == WH_OK) {
        status = wh_track_init(&track, &played_machine, played_slice_us);
    }
    for (size_t i = 0; i < played_segment_count && status == WH_OK; ++i) {
        status = play(&played_segments[i]);
    }
    return status;
}

int main(void) {
    const wh_status_t status = play_all();
    const uint64_t hash = wh_grasp_hash(&table);
    const bool exact = sizeof(wh_real_t) == sizeof(double);
    if (status != WH_OK) {
        printf("%s after %lld slices\n", wh_status_text(status), (long long)track.slice);
    }
    printf("%s transfer %016llx\n", exact ? "double" : "float", (unsigned long long)hash);
    return status == WH_OK && (!exact || (track.slice == played_slices && hash == played_hash)) ? 0 : 1;
}
