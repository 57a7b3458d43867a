/* What a firmware links for a part of the library: PART is none, check, table or simulator. Built only to be weighed. */
#include <waferhand.h>

enum { WAFERS = 25, GRIPPERS = 2 };
#define none 0
#define check 1
#define table 2
#define simulator 3

#if PART == check
wh_pose_t wafer;
wh_pose_t gripper;

int main(void) {
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    return wh_proximity_ready(&wafer, &gripper, &tolerance);
}
#elif PART == table
static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[GRIPPERS];
static wh_gripper_input_t inputs[GRIPPERS];
static wh_event_t events[GRIPPERS * WH_EVENTS_PER_GRIPPER];
static wh_grasp_t grasp;

int main(void) {
    wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, 0, 0};
    wh_event_list_t list = {events, GRIPPERS * WH_EVENTS_PER_GRIPPER, 0};
    if (wh_grasp_init(&grasp, &config, &storage) != WH_OK) {
        return 1;
    }
    return (int)wh_grasp_step(&grasp, inputs, &list);
}
#elif PART == simulator
static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[GRIPPERS];
static wh_station_t stations[1];
static wh_simulator_t sim;
static wh_command_t command;
static wh_state_t state;

int main(void) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, GRIPPERS, 0, 0};
    const wh_cell_t cell = {.stations = stations, .count = 1, .tolerance = config.tolerance};
    if (wh_simulator_init(&sim, &config, &storage, &cell) != WH_OK) {
        return 1;
    }
    return (int)wh_simulator_step(&sim, &command, &state);
}
#else
int main(void) {
    return 0;
}
#endif
