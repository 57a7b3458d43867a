#include "script/collision.h"

static void look(void *user, const wh_command_t *command, const wh_grasp_t *table, wh_event_list_t *list) {
    wh_collision_t *collision = user;
    wh_pose_t grippers[WH_GRIPPERS];
    wh_pose_t effector;
    for (size_t g = 0; g < command->gripper_count; ++g) {
        grippers[g] = command->grippers[g].base_from_gripper;
    }
    /* The table has judged the grippers' poses, but nobody the axes. */
    wh_robot_forward(command->axes, &effector);
    if (wh_pose_validate(&effector) == WH_OK) {
        collision->base_from_effector = effector;
    }
    if (collision->world) {
        wh_world_step(collision->world, table, &collision->base_from_effector, grippers, list);
    } else {
        collision->world = wh_world_init(&collision->layout->world, table, &collision->base_from_effector,
                                         grippers, collision->memory, wh_collision_bytes(collision->layout));
    }
}

static void placed(void *user, const wh_grasp_t *table, int32_t wafer) {
    wh_collision_t *collision = user;
    if (collision->world) {
        wh_world_place(collision->world, table, wafer);
    }
}

size_t wh_collision_bytes(const wh_layout_t *layout) {
    return wh_world_bytes(&layout->world);
}

void wh_collision_attach(wh_collision_t *collision, const wh_layout_t *layout, wh_simulator_t *simulator,
                         void *memory) {
    collision->layout = layout;
    collision->memory = memory;
    collision->world = NULL;
    wh_robot_forward(layout->machine.robot.home, &collision->base_from_effector);
    simulator->observer = (wh_observer_t){look, placed, collision};
}
