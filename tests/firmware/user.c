/* A program as a user of the library writes it, in C99 and in C++11. It prints the same lines with
 * every compiler, both of the program and of the library. It needs nothing but the library.
 *
 * Its own arithmetic rounds once in each statement, so that only the library's headers are tested. */
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#if defined(USER_SINGLE_HEADER)
#include <waferhand/grasp/restore.h>
#include <waferhand/math/trig.h>
#include <waferhand/sim/simulator.h>
#else
#include <waferhand.h>
#endif

#define POSES 100000
#define SLICES 400

static uint64_t state = 1;

static wh_real_t random_number(void) {
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (wh_real_t)(int32_t)(state >> 40) / WH_REAL(16777216) - WH_REAL(0.5);
}

/* Poses that are almost level, near the origin. */
static wh_pose_t random_pose(void) {
    wh_pose_t pose;
    const wh_real_t roll = 10 * random_number();
    const wh_real_t pitch = 10 * random_number();
    pose.R = wh_mat3_from_rpy_deg(roll, pitch, 360 * random_number());
    pose.r.x = 40 * random_number();
    pose.r.y = 40 * random_number();
    pose.r.z = random_number();
    return pose;
}

/* Poses at the very limit, where one rounding less changes the verdict. Counts how often header and
 * library differ. */
static int verdicts_that_differ(void) {
    int differ = 0;
    for (int i = 0; i < POSES; ++i) {
        const wh_pose_t wafer = random_pose();
        const wh_pose_t gripper = random_pose();
        wh_tolerance_t tolerance = {WH_REAL(1e6), WH_REAL(1e6), 0};
        wh_proximity_t measured;
        if (wh_proximity_measure(&wafer, &gripper, &tolerance, &measured) != WH_OK) {
            return -1;
        }
        if (i % 2 == 0 && measured.dr_proj_z != 0) {
            tolerance.projz = wh_real_abs(measured.dr_proj_z);
        } else if (measured.dr_proj_xy_norm >= WH_REAL(1e-6)) {
            tolerance.projxy = measured.dr_proj_xy_norm;
        }
        if (wh_proximity_measure(&wafer, &gripper, &tolerance, &measured) != WH_OK) {
            return -1;
        }
        differ += measured.ready != wh_proximity_ready(&wafer, &gripper, &tolerance);
    }
    return differ;
}

/* Layouts that compiler flags could change, so that the library would read them wrongly. */
static void print_sizes(void) {
    printf("sizes %u %u %u %u %u\n", (unsigned)sizeof(wh_status_t), (unsigned)sizeof(wh_check_t),
           (unsigned)sizeof(wh_event_kind_t), (unsigned)sizeof(wh_fault_kind_t), (unsigned)sizeof(bool));
}

/* A wafer on the way up through a slot is taken, drawn onto the pads, carried and released. */
static int play(wh_simulator_t *simulator, wh_wafer_t *wafers, wh_gripper_t *grippers) {
    wh_grasp_config_t config = wh_grasp_config_default();
    wh_grasp_storage_t storage;
    wh_cell_t cell;
    static wh_command_t command;
    static wh_state_t answer;
    int picked = 0;
    memset(&storage, 0, sizeof storage);
    memset(&cell, 0, sizeof cell);
    wafers[0].base_from_wafer = wh_pose_identity();
    wafers[0].base_from_wafer.R = wh_mat3_from_rpy_deg(1, 2, 3);
    storage.wafers = wafers;
    storage.wafer_count = 1;
    storage.grippers = grippers;
    storage.gripper_count = 1;
    config.seat = true;
    if (config.check != WH_CHECK_SAMPLED || wh_simulator_init(simulator, &config, &storage, &cell) != WH_OK) {
        return -1;
    }
    command.gripper_count = 1;
    command.grippers[0].base_from_gripper = wh_pose_identity();
    for (int slice = 1; slice <= SLICES; ++slice) {
        command.seq = slice;
        command.grippers[0].base_from_gripper.r.z = (wh_real_t)(slice - 200) / 64;
        command.grippers[0].valve = slice < 300 ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
        const wh_status_t status = wh_simulator_step(simulator, &command, &answer);
        if (status != WH_OK || answer.status != status) {
            return -1;
        }
        for (size_t i = 0; i < answer.event_count; ++i) {
            const wh_event_kind_t kind = answer.events[i].kind;
            picked += kind == WH_EVENT_PICKED;
            printf("slice %d: %s\n", slice, wh_event_name(answer.events[i].kind));
        }
    }
    return picked;
}

int main(void) {
    static wh_simulator_t simulator;
    static wh_wafer_t wafers[1];
    static wh_gripper_t grippers[1];
    const int differ = verdicts_that_differ();
    const int picked = play(&simulator, wafers, grippers);
    const uint64_t hash = wh_simulator_hash(&simulator);
    print_sizes();
    printf("%d verdicts differ, %d picked, %s\n", differ, picked, wh_status_text(WH_STATUS_BAD_VALVE));
    printf("%s %08lx%08lx\n", wh_version(), (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffU));
    return differ == 0 && picked == 1 && strcmp(wh_version(), WH_VERSION) == 0 ? 0 : 1;
}
